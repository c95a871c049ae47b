//! Corner subdivision where a pixel stands out: a cell whose corners and centre differ is divided into four.
//!
//! The report's method with its gaps closed. Every pixel is looked at in its centre first; one that differs
//! from none of its eight neighbours is even and costs that one sample. The others are cells: a cell is looked at
//! in its centre too, so that what lies between corners is not missed; depth is bounded; and the threshold is
//! on relative contrast, (max − min) / (max + min + 2·floor) in any channel, the floor a hundredth of the
//! scene's middling luminance, so that neither exposure nor the height of an edge matters.
//!
//! What a cell can be wrong by is its contrast times its share of the pixel, and dividing it costs the same
//! whatever its size: it is divided where that product is above the threshold, so that every sample is spent
//! where it takes most of the error away. Each level of division asks for four times the contrast.
//!
//! Corners lie on a lattice of 2^depth steps a pixel and are traced once a tile, whichever cells and
//! pixels share them; the centres of the pixels around a tile are traced by it as well. Every value is a
//! function of its lattice point and the pass alone.

mod contrast;

use super::Average;
use crate::math::random::{Items, Stage};
use crate::math::{Color, DVec2, DVec3, Place};
use crate::optics::Camera;
use crate::trace::{PixelValue, Sample, Scratch, Tally, Tile, Tracer, Wants};
use contrast::{Limit, Range};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasherDefault, Hasher};

/// Share of the reference level below which differences do not show.
const FLOOR: f32 = 0.01;

pub(super) fn pass(
    tracer: &Tracer,
    threshold: f64,
    depth: u32,
    pass: u32,
    tile: &mut Tile,
    scratch: &mut Scratch,
    tally: &mut Tally,
) {
    let around = Around::of(tile, &tracer.world.camera);
    let mut lattice = Lattice {
        tracer,
        scratch,
        tally,
        steps: 1 << depth,
        pass,
        items: Items::of(tracer.plan.seed, Stage::Film),
        limit: Limit { threshold: threshold as f32, floor: FLOOR * tracer.reference_level },
        radiances: Vec::with_capacity(2 * around.pixels()),
        samples: Vec::new(),
        whole: Whole::of(tile),
        finer: HashMap::default(),
        cells: Vec::new(),
    };
    lattice.centres(&around);
    let uneven = contrast::uneven(&lattice.radiances, around.width as usize, lattice.limit);
    let (mut is_probe, mut value) = (super::probes(tracer), PixelValue::default());
    for (x, y) in tile.pixels() {
        let probe = is_probe(x, y);
        let centre = around.place(x, y);
        lattice.cells.clear();
        let cells = if uneven[centre as usize] {
            let size = lattice.steps;
            lattice.cell(x * size, y * size, size)
        } else {
            lattice.cells.push((centre, 1.0));
            1
        };
        if lattice.mean(super::wants(tracer, probe), cells, &mut value) {
            tile.add_as(probe, x, y, &value);
        }
    }
}

/// The pixels of a tile and those around it that are in the image.
struct Around {
    x: u32,
    y: u32,
    width: u32,
    height: u32,
}

impl Around {
    fn of(tile: &Tile, camera: &Camera) -> Around {
        let (x, y) = (tile.x.saturating_sub(1), tile.y.saturating_sub(1));
        let width = (tile.x + tile.width + 1).min(camera.width) - x;
        let height = (tile.y + tile.height + 1).min(camera.height) - y;
        Around { x, y, width, height }
    }

    fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The place of the sample in a pixel's centre: these are traced first, row by row.
    fn place(&self, x: u32, y: u32) -> u32 {
        (y - self.y) * self.width + x - self.x
    }
}

struct Lattice<'a> {
    tracer: &'a Tracer<'a>,
    scratch: &'a mut Scratch,
    tally: &'a mut Tally,
    /// Lattice steps a pixel.
    steps: u32,
    pass: u32,
    items: Items,
    limit: Limit,
    /// What has been traced; the tables below hold places in it.
    radiances: Vec<Color>,
    /// The whole samples, where more than their radiance is wanted.
    samples: Vec<Sample>,
    whole: Whole,
    finer: HashMap<u64, u32, BuildHasherDefault<Spread>>,
    /// What a pixel's value is made of: places, with their weights.
    cells: Vec<(u32, f64)>,
}

/// The corners and centres of the tile's pixels and of those around it.
struct Whole {
    x: u32,
    y: u32,
    /// Points in a row: corners and centres.
    row: u32,
    /// Places of the samples plus one.
    places: Vec<u32>,
}

impl Whole {
    fn of(tile: &Tile) -> Whole {
        let (row, rows) = (2 * tile.width + 3, 2 * tile.height + 3);
        Whole { x: tile.x, y: tile.y, row, places: vec![0; row as usize * rows as usize] }
    }

    /// The slot of a point by its coordinates in halves of a pixel.
    fn slot(&mut self, x: u32, y: u32) -> Option<&mut u32> {
        let (column, line) = (x + 1 - 2 * self.x, y + 1 - 2 * self.y);
        self.places.get_mut(line as usize * self.row as usize + column as usize)
    }
}

impl Lattice<'_> {
    /// Traces all centres.
    fn centres(&mut self, around: &Around) {
        let half = self.steps / 2;
        for y in around.y..around.y + around.height {
            for x in around.x..around.x + around.width {
                let place = self.trace(x * self.steps + half, y * self.steps + half);
                if let Some(slot) = self.whole.slot(2 * x + 1, 2 * y + 1) {
                    *slot = place + 1;
                }
            }
        }
    }

    /// Notes what the mean of the cell at (x, y) of `size` lattice steps is made of, weighted by its area, and
    /// returns of how many cells. One that is not divided weighs its centre by a half and its corners by an
    /// eighth each.
    fn cell(&mut self, x: u32, y: u32, size: u32) -> u32 {
        let area = f64::from(size) * f64::from(size);
        let corners =
            [(x, y), (x + size, y), (x, y + size), (x + size, y + size)].map(|(x, y)| self.point(x, y));
        if size == 1 {
            self.cells.extend(corners.map(|corner| (corner, area / 4.0)));
            return 1;
        }
        let half = size / 2;
        let centre = self.point(x + half, y + half);
        if self.differ(&corners, centre, size) {
            let quarters = [(0, 0), (half, 0), (0, half), (half, half)];
            return quarters.into_iter().map(|(dx, dy)| self.cell(x + dx, y + dy, half)).sum();
        }
        self.cells.push((centre, area / 2.0));
        self.cells.extend(corners.map(|corner| (corner, area / 8.0)));
        1
    }

    /// Whether a cell of `size` lattice steps is to be divided.
    fn differ(&self, corners: &[u32; 4], centre: u32, size: u32) -> bool {
        let of = |place: u32| Range::of(self.radiances[place as usize]);
        let all = corners.iter().fold(of(centre), |all, &corner| all.with(of(corner)));
        let share = (size as f32 / self.steps as f32).powi(2);
        self.limit.exceeded(all, share)
    }

    /// The mean of the noted samples but those that were dropped, of so many cells. Whether any is left.
    fn mean(&mut self, wants: Wants, cells: u32, value: &mut PixelValue) -> bool {
        self.cells.retain(|&(place, _)| self.radiances[place as usize].is_finite());
        for &(place, weight) in &self.cells {
            self.tally.note(|recorder| recorder.weigh(place, weight));
        }
        if !self.samples.is_empty() {
            let mut average = Average::of(wants);
            self.cells.iter().for_each(|&(place, weight)| average.add(&self.samples[place as usize], weight));
            return average.value(cells).map(|mean| *value = mean).is_some();
        }
        let (mut sum, mut all) = (DVec3::ZERO, 0.0);
        for &(place, weight) in &self.cells {
            sum += self.radiances[place as usize].as_dvec3() * weight;
            all += weight;
        }
        value.of_radiance(sum * (1.0 / all), cells);
        all > 0.0
    }

    /// The place of a lattice point's sample, traced when it is first asked for.
    fn point(&mut self, x: u32, y: u32) -> u32 {
        let (half, next) = (self.steps / 2, self.radiances.len() as u32);
        let of_halves = (x | y) & (half - 1) == 0;
        if let Some(slot) = of_halves.then(|| self.whole.slot(x / half, y / half)).flatten() {
            if *slot != 0 {
                return *slot - 1;
            }
            *slot = next + 1;
        } else {
            match self.finer.entry(key(x, y)) {
                Entry::Occupied(known) => return *known.get(),
                Entry::Vacant(vacant) => vacant.insert(next),
            };
        }
        self.trace(x, y)
    }

    /// The place of a sample that is traced at a lattice point.
    fn trace(&mut self, x: u32, y: u32) -> u32 {
        let film = DVec2::new(f64::from(x), f64::from(y)) * (1.0 / f64::from(self.steps));
        // Lattice points of different depths are different items.
        let item = key(x, y) ^ u64::from(self.steps) << 58;
        let sequence = self.items.sequence(item, self.pass);
        let sample = self.tracer.sample(film, sequence, self.scratch, self.tally);
        let finite = sample.is_finite();
        if finite {
            self.tally.health.see(sample.radiance);
        } else {
            // A point on the right or lower border of the image is the last pixel's.
            let Camera { width, height, .. } = self.tracer.world.camera;
            let of = |at: u32, size: u32| (at / self.steps).min(size - 1);
            let place = Place { x: of(x, width), y: of(y, height), pass: self.pass };
            self.tally.health.non_finite(place);
        }
        self.radiances.push(if finite { sample.radiance } else { Color::NAN });
        if self.tracer.wants.whole_samples() {
            self.samples.push(*sample);
        }
        self.radiances.len() as u32 - 1
    }
}

fn key(x: u32, y: u32) -> u64 {
    u64::from(y) << 32 | u64::from(x)
}

/// Lattice coordinates are spread by one multiplication.
#[derive(Default)]
struct Spread(u64);

impl Hasher for Spread {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.0 = (self.0.rotate_left(8) ^ u64::from(b)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
    }

    fn write_u64(&mut self, x: u64) {
        let folded = (x ^ x >> 29).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = folded ^ folded >> 32;
    }
}
