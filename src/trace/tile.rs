//! A tile: a rectangle of pixels with what the passes sum up to.
//!
//! Each tile has its own sums, so that tiles are worked on side by side and nothing is shared. Sums
//! are exact: the size of the tiles, the number of threads, and which passes were summed up where
//! change nothing.

mod radiance;
mod sums;

use super::probe::LUMINANCE;
use super::{Parts, Probe, Probes};
use crate::math::{DVec3, Exact, Vec3};
use radiance::Radiance;

/// A pixel's value in one pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelValue {
    pub radiance: DVec3,
    pub direct: DVec3,
    pub reflection: DVec3,
    pub refraction: DVec3,
    pub caustic: DVec3,
    pub indirect: DVec3,
    pub photons: DVec3,
    pub photon_density: f64,
    pub albedo: DVec3,
    pub normal: DVec3,
    pub position: DVec3,
    pub depth: f64,
    /// Index of the object plus one, of the first sample.
    pub object: u32,
    /// Samples, or cells of the adaptive subdivision, that the value is made of.
    pub samples: u32,
    /// What the density estimate's blur adds, by [`Look`](super::Look), to caustic and indirect light; known for
    /// some probes.
    pub bias: Option<[[DVec3; 2]; 2]>,
    /// How two samples at one place differ in what photons did not bring; known for some probes.
    pub pair: Option<DVec3>,
}

/// What the film keeps beyond radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    pub first_hit: bool,
    pub split: bool,
    pub variance: bool,
    pub photons: bool,
    pub bias: bool,
    pub probes: Option<Probes>,
    pub parts: Parts,
    /// Second passes are not to be expected.
    pub one_pass: bool,
}

#[derive(Clone, Copy, Debug, Default)]
struct FirstHitSums {
    albedo: Exact,
    normal: Exact,
    position: Exact,
    /// In x.
    depth: Exact,
    /// Of the first pass.
    object: u32,
}

#[derive(Clone, Copy, Debug, Default)]
struct SplitSums {
    direct: Exact,
    reflection: Exact,
    refraction: Exact,
    caustic: Exact,
    indirect: Exact,
}

#[derive(Clone, Copy, Debug, Default)]
struct PhotonSums {
    /// Of the first pass.
    dots: DVec3,
    /// In x.
    density: Exact,
}

/// The luminance of a pixel's brightest pass in the upper half of a single's bits, rounded up: 1/128 of it too
/// bright at most, and that of the brightest of many is the largest of theirs, in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Brightest(u16);

impl Brightest {
    /// Of a luminance; below 0, as of NaN, it is that of black.
    fn of(luminance: f64) -> Brightest {
        Brightest(((luminance.max(0.0).min(f64::from(f32::MAX)) as f32).to_bits().div_ceil(1 << 16)) as u16)
    }

    fn luminance(self) -> f64 {
        f64::from(f32::from_bits(u32::from(self.0) << 16))
    }
}

/// A pixel's mean, and how far it may be off.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    pub x: u32,
    pub y: u32,
    pub passes: u32,
    pub mean: DVec3,
    /// Of one pass.
    pub variance: DVec3,
    /// Mean luminance without the brightest pass.
    pub others: f64,
}

/// A rectangle of pixels with its sums. Layers that are not kept take no memory.
#[derive(Clone, Debug)]
pub struct Tile {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
    /// The number after that of the last pass that was added.
    pub next: u32,
    /// The pass that is being added.
    pass: u32,
    parts: Parts,
    radiance: Radiance,
    passes: Vec<u32>,
    samples: Vec<u32>,
    split: Vec<SplitSums>,
    first: Vec<FirstHitSums>,
    /// Σ (x − mean)², by Welford's recurrence.
    squares: Vec<DVec3>,
    photons: Vec<PhotonSums>,
    /// For the picture's error: Σ (x − mean)² by channel, and the brightest pass.
    spread: Vec<Vec3>,
    brightest: Vec<Brightest>,
    /// Sums of the estimated bias, and of the passes that looked at it.
    bias: Vec<(Exact, u32)>,
    /// One a square; empty where a square's probe is another tile's.
    probes: Vec<Probe>,
    placed: Option<Probes>,
    /// Whether anything is kept beyond the picture and its error.
    layered: bool,
}

impl Tile {
    /// Of sums that keep these layers, with the share that a pixel has in a probe.
    pub fn bytes_per_pixel(layers: Layers) -> f64 {
        const SIDE: u32 = 64;
        Tile::new(0, 0, SIDE, SIDE, layers).memory_bytes() as f64 / f64::from(SIDE * SIDE)
    }

    pub fn new(x: u32, y: u32, width: u32, height: u32, layers: Layers) -> Tile {
        let n = width as usize * height as usize;
        let squares = |placed: Probes| placed.squares(x, width) * placed.squares(y, height);
        let if_kept = |kept: bool| if kept { n } else { 0 };
        Tile {
            x,
            y,
            width,
            height,
            next: 0,
            pass: 0,
            parts: layers.parts,
            radiance: Radiance::new(n, layers.one_pass),
            passes: vec![0; n],
            samples: vec![0; n],
            split: vec![SplitSums::default(); if_kept(layers.split)],
            first: vec![FirstHitSums::default(); if_kept(layers.first_hit)],
            squares: vec![DVec3::ZERO; if_kept(layers.variance)],
            photons: vec![PhotonSums::default(); if_kept(layers.photons)],
            spread: vec![Vec3::ZERO; if_kept(layers.probes.is_some())],
            brightest: vec![Brightest::default(); if_kept(layers.probes.is_some())],
            bias: vec![(Exact::default(), 0); if_kept(layers.bias)],
            probes: vec![Probe::default(); layers.probes.map_or(0, |placed| squares(placed) as usize)],
            placed: layers.probes,
            layered: Layers { probes: None, parts: Parts::Growing, one_pass: false, ..layers }
                != Layers::default(),
        }
    }

    /// Image coordinates of the tile's pixels, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (x0, y0, w, h) = (self.x, self.y, self.width, self.height);
        (y0..y0 + h).flat_map(move |y| (x0..x0 + w).map(move |x| (x, y)))
    }

    fn index(&self, x: u32, y: u32) -> usize {
        (y - self.y) as usize * self.width as usize + (x - self.x) as usize
    }

    /// The statistics of the tile's probes that have passes.
    pub fn probes(&self) -> impl Iterator<Item = &Probe> {
        self.probes.iter().filter(|probe| probe.passes() > 0)
    }

    /// Values that are added from now on are those of a pass.
    pub fn begin(&mut self, pass: u32) {
        self.pass = pass;
        self.next = pass + 1;
    }

    /// Adds a pass's value to a pixel of the tile, given in image coordinates.
    pub fn add(&mut self, x: u32, y: u32, value: &PixelValue) {
        let probe = self.placed.is_some_and(|placed| placed.is_probe(x, y));
        self.add_as(probe, x, y, value);
    }

    /// The same, where it is known whether the pixel is a probe.
    pub(super) fn add_as(&mut self, probe: bool, x: u32, y: u32, value: &PixelValue) {
        let i = self.index(x, y);
        let before = f64::from(self.passes[i]);
        // Welford 1962: M₂ += (x − old mean)·(x − new mean) = (x − old mean)²·n/(n + 1).
        let off = if before == 0.0 {
            DVec3::ZERO
        } else {
            value.radiance - self.radiance.about(i) * (1.0 / before)
        };
        let square = off * off * (before / (before + 1.0));
        if let (Some(spread), Some(brightest)) = (self.spread.get_mut(i), self.brightest.get_mut(i)) {
            *spread += square.as_vec3();
            *brightest = (*brightest).max(Brightest::of(value.radiance.dot(LUMINANCE)));
        }
        self.radiance.add(i, value.radiance, before == 0.0);
        self.passes[i] += 1;
        self.samples[i] = self.samples[i].saturating_add(value.samples);
        if let Some(placed) = self.placed.filter(|_| probe) {
            let slot = placed.slot([x, y], [self.x, self.y], self.width);
            self.probes[slot].add(x, y, value, self.parts.of(self.pass));
        }
        if self.layered {
            self.add_layers(i, before == 0.0, square, value);
        }
    }

    /// Adds to what is kept beyond the picture and its error; apart, as most renders do without.
    #[inline(never)]
    fn add_layers(&mut self, i: usize, first: bool, square: DVec3, value: &PixelValue) {
        if let Some(squares) = self.squares.get_mut(i) {
            *squares += square;
        }
        if let (Some((sum, looked)), Some([[caustic, indirect], _])) = (self.bias.get_mut(i), value.bias) {
            sum.add(caustic + indirect);
            *looked += 1;
        }
        if let Some(split) = self.split.get_mut(i) {
            split.direct.add(value.direct);
            split.reflection.add(value.reflection);
            split.refraction.add(value.refraction);
            split.caustic.add(value.caustic);
            split.indirect.add(value.indirect);
        }
        if let Some(photons) = self.photons.get_mut(i) {
            photons.density.add(DVec3::X * value.photon_density);
            if first {
                photons.dots = value.photons;
            }
        }
        if let Some(sums) = self.first.get_mut(i) {
            sums.albedo.add(value.albedo);
            sums.normal.add(value.normal);
            sums.position.add(value.position);
            sums.depth.add(DVec3::X * value.depth);
            if first {
                sums.object = value.object;
            }
        }
    }
}

/// A layer of the finished image that can be read off the sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    Radiance,
    Direct,
    Reflection,
    Refraction,
    /// Light that photons brought.
    Caustic,
    Indirect,
    /// The first pass's photons, as dots.
    Photons,
    /// Photons a pass by area, 1/m².
    PhotonDensity,
    /// Of the mean over passes; needs two passes or more.
    Variance,
    /// The standard deviation of the mean over passes; needs two passes or more.
    Noise,
    /// What the density estimate's blur adds to the mean, where that can be told.
    Bias,
    Albedo,
    Normal,
    Position,
    Depth,
    Object,
    /// Samples a pixel over all passes.
    Samples,
    /// Samples a pixel and pass, relative to the most divided pixel: where antialiasing went.
    Edges,
}

impl Tile {
    /// Samples over all pixels and passes.
    pub fn samples(&self) -> u64 {
        self.samples.iter().map(|&samples| u64::from(samples)).sum()
    }

    pub fn memory_bytes(&self) -> usize {
        self.radiance.memory_bytes()
            + self.passes.len() * 2 * size_of::<u32>()
            + self.split.len() * size_of::<SplitSums>()
            + self.first.len() * size_of::<FirstHitSums>()
            + self.squares.len() * size_of::<DVec3>()
            + self.photons.len() * size_of::<PhotonSums>()
            + self.spread.len() * (size_of::<Vec3>() + size_of::<Brightest>())
            + self.bias.len() * size_of::<(Exact, u32)>()
            + self.probes.len() * size_of::<Probe>()
    }

    /// Samples a pass of each pixel.
    pub fn samples_per_pass(&self) -> impl Iterator<Item = f64> {
        self.samples.iter().zip(&self.passes).map(|(&s, &p)| f64::from(s) / f64::from(p.max(1)))
    }

    /// Of each pixel.
    pub fn passes(&self) -> impl Iterator<Item = u32> {
        self.passes.iter().copied()
    }

    /// Of pixels with two passes or more.
    pub fn measured(&self) -> impl Iterator<Item = Measured> {
        let of = |(i, (squares, brightest)): (usize, (&Vec3, &Brightest))| {
            let passes = self.passes[i];
            let sum = self.radiance.sum(i);
            let mean = sum / f64::from(passes);
            let others = (sum.dot(LUMINANCE) - brightest.luminance()) / f64::from(passes - 1);
            let variance = squares.as_dvec3() / f64::from(passes - 1);
            let (x, y) = (self.x + i as u32 % self.width, self.y + i as u32 / self.width);
            Measured { x, y, passes, mean, variance, others }
        };
        self.spread.iter().zip(&self.brightest).enumerate().filter(|(i, _)| self.passes[*i] > 1).map(of)
    }

    /// The mean radiance of the pixel with this number, row by row.
    #[inline]
    pub fn mean(&self, i: usize) -> DVec3 {
        self.radiance.sum(i) / f64::from(self.passes[i].max(1))
    }

    /// The value of a layer at the pixel with this number, row by row; `most` is the largest number of
    /// samples a pixel and pass in the image.
    pub fn value(&self, i: usize, layer: Layer, most: f64) -> DVec3 {
        let passes = f64::from(self.passes[i].max(1));
        let first = || self.first.get(i).copied().unwrap_or_default();
        let split = || self.split.get(i).copied().unwrap_or_default();
        let photons = || self.photons.get(i).copied().unwrap_or_default();
        match layer {
            Layer::Radiance => self.mean(i),
            Layer::Direct => split().direct.value() / passes,
            Layer::Reflection => split().reflection.value() / passes,
            Layer::Refraction => split().refraction.value() / passes,
            Layer::Caustic => split().caustic.value() / passes,
            Layer::Indirect => split().indirect.value() / passes,
            Layer::Photons => photons().dots,
            Layer::PhotonDensity => DVec3::splat(photons().density.value().x / passes),
            Layer::Variance => {
                let squares = self.squares.get(i).copied().unwrap_or_default();
                squares / (passes * (passes - 1.0).max(1.0))
            }
            Layer::Noise => self.value(i, Layer::Variance, most).map(f64::sqrt),
            Layer::Bias => {
                let (sum, looked) = self.bias.get(i).copied().unwrap_or_default();
                sum.value() / f64::from(looked.max(1))
            }
            Layer::Albedo => first().albedo.value() / passes,
            Layer::Normal => first().normal.value() / passes,
            Layer::Position => first().position.value() / passes,
            Layer::Depth => DVec3::splat(first().depth.value().x / passes),
            Layer::Object => DVec3::splat(f64::from(first().object)),
            Layer::Samples => DVec3::splat(f64::from(self.samples[i])),
            Layer::Edges => {
                let floor = 1.0;
                let share = (f64::from(self.samples[i]) / passes - floor) / (most - floor).max(1.0);
                DVec3::splat(share.clamp(0.0, 1.0))
            }
        }
    }
}
