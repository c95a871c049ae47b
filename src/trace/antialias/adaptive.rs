//! Corner subdivision where a pixel stands out: a cell whose corners and centre differ is divided into four.
//!
//! The report's method with its gaps closed. Every pixel is looked at in its centre first; one that differs
//! from none of its eight neighbours is even and costs that one sample. The others are cells: a cell is looked at
//! in its centre too, so that what lies between corners is not missed; depth is bounded; and the threshold is
//! on relative contrast, (max − min) / (max + min + 2·floor) in any channel, the floor a hundredth of the
//! scene's middling luminance, so that neither exposure nor the height of an edge matters.
//!
//! Corners lie on a lattice of 2^depth steps a pixel and are traced once a tile, whichever cells and
//! pixels share them; the centres of the pixels around a tile are traced by it as well. Every value is a
//! function of its lattice point and the pass alone.

use super::Average;
use crate::math::random::{Sequence, Stage};
use crate::math::{Color, DVec2, Place};
use crate::optics::Camera;
use crate::trace::Tile;
use crate::trace::{Sample, Scratch, Tally, Tracer};
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
    let mut lattice = Lattice {
        tracer,
        scratch,
        tally,
        steps: 1 << depth,
        pass,
        threshold: threshold as f32,
        floor: FLOOR * tracer.reference_level,
        radiances: Vec::new(),
        samples: Vec::new(),
        whole: Whole::of(tile),
        finer: HashMap::default(),
    };
    let mut is_probe = super::probes(tracer);
    let uneven = lattice.uneven(tile);
    for ((x, y), stands_out) in tile.pixels().zip(uneven) {
        let probe = is_probe(x, y);
        let mut average = Average::of(super::wants(tracer, probe));
        let size = lattice.steps;
        let mut used = 0;
        if stands_out {
            lattice.cell(x * size, y * size, size, &mut average, &mut used);
        } else {
            used = 1;
            let centre = lattice.centre(x, y);
            lattice.add(centre, 1.0, &mut average);
        }
        if let Some(value) = average.value(used) {
            tile.add_as(probe, x, y, &value);
        }
    }
}

struct Lattice<'a> {
    tracer: &'a Tracer<'a>,
    scratch: &'a mut Scratch,
    tally: &'a mut Tally,
    /// Lattice steps a pixel.
    steps: u32,
    pass: u32,
    threshold: f32,
    floor: f32,
    /// What has been traced; the tables below hold places in it.
    radiances: Vec<Color>,
    /// The whole samples, where more than their radiance is wanted.
    samples: Vec<Sample>,
    whole: Whole,
    finer: HashMap<u64, u32, BuildHasherDefault<Spread>>,
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

    /// The slot of a lattice point that is a multiple of half a pixel.
    fn slot(&mut self, x: u32, y: u32, half: u32) -> Option<&mut u32> {
        if (x | y) & (half - 1) != 0 {
            return None;
        }
        let (column, line) = (x / half + 1 - 2 * self.x, y / half + 1 - 2 * self.y);
        self.places.get_mut(line as usize * self.row as usize + column as usize)
    }
}

impl Lattice<'_> {
    /// The place of the sample in the centre of a pixel.
    fn centre(&mut self, x: u32, y: u32) -> u32 {
        let half = self.steps / 2;
        self.point(x * self.steps + half, y * self.steps + half)
    }

    /// For each pixel of the tile, whether it and the eight around it differ in their centres.
    fn uneven(&mut self, tile: &Tile) -> Vec<bool> {
        let Camera { width, height, .. } = self.tracer.world.camera;
        let around = |at: u32, length: u32, most: u32| at.saturating_sub(1)..=(at + length).min(most - 1);
        let (columns, rows) = (around(tile.x, tile.width, width), around(tile.y, tile.height, height));
        let first = (tile.x - columns.start(), tile.y - rows.start());
        // Of each pixel and its neighbours in the row; then of three rows together.
        let ranges: Vec<Vec<Range>> = rows
            .map(|y| {
                let row: Vec<Range> = columns
                    .clone()
                    .map(|x| {
                        let centre = self.centre(x, y);
                        Range::of(self.radiances[centre as usize])
                    })
                    .collect();
                widened(&row, first.0, tile.width)
            })
            .collect();
        let (floor, threshold) = (self.floor, self.threshold);
        let of = |line: u32, column: usize| {
            let rows = &ranges[near(line + first.1, ranges.len())];
            let all = rows.iter().fold(Range::default(), |all, row| all.with(row[column]));
            all.contrast(floor) > threshold
        };
        (0..tile.height)
            .flat_map(|line| (0..tile.width as usize).map(move |column| (line, column)))
            .map(|(line, column)| of(line, column))
            .collect()
    }

    /// Adds the mean of the cell at (x, y) of `size` lattice steps, weighted by its area. A cell that
    /// is not divided weighs its centre by a half and its corners by an eighth each.
    fn cell(&mut self, x: u32, y: u32, size: u32, average: &mut Average, used: &mut u32) {
        let area = f64::from(size) * f64::from(size);
        let corners =
            [(x, y), (x + size, y), (x, y + size), (x + size, y + size)].map(|(x, y)| self.point(x, y));
        if size == 1 {
            *used += 1;
            return corners.iter().for_each(|&c| self.add(c, area / 4.0, average));
        }
        let half = size / 2;
        let centre = self.point(x + half, y + half);
        if self.differ(&corners, centre) {
            for (dx, dy) in [(0, 0), (half, 0), (0, half), (half, half)] {
                self.cell(x + dx, y + dy, half, average, used);
            }
            return;
        }
        *used += 1;
        self.add(centre, area / 2.0, average);
        corners.iter().for_each(|&c| self.add(c, area / 8.0, average));
    }

    fn differ(&self, corners: &[u32; 4], centre: u32) -> bool {
        let of = |place: u32| Range::of(self.radiances[place as usize]);
        let all = corners.iter().fold(of(centre), |all, &corner| all.with(of(corner)));
        all.contrast(self.floor) > self.threshold
    }

    /// Adds a sample to a mean, unless it was dropped.
    fn add(&mut self, place: u32, weight: f64, average: &mut Average) {
        let radiance = self.radiances[place as usize];
        if !radiance.is_finite() {
            return;
        }
        self.tally.note(|recorder| recorder.weigh(place, weight));
        match self.samples.get(place as usize) {
            Some(sample) => average.add(sample, weight),
            None => average.add_radiance(radiance, weight),
        }
    }

    /// The place of a lattice point's sample, traced when it is first asked for.
    fn point(&mut self, x: u32, y: u32) -> u32 {
        let key = u64::from(y) << 32 | u64::from(x);
        let next = self.radiances.len() as u32;
        if let Some(slot) = self.whole.slot(x, y, self.steps / 2) {
            if *slot != 0 {
                return *slot - 1;
            }
            *slot = next + 1;
        } else {
            match self.finer.entry(key) {
                Entry::Occupied(known) => return *known.get(),
                Entry::Vacant(vacant) => vacant.insert(next),
            };
        }
        let film = DVec2::new(f64::from(x), f64::from(y)) / f64::from(self.steps);
        // Lattice points of different depths are different items.
        let item = key ^ u64::from(self.steps) << 58;
        let sequence = Sequence::new(self.tracer.plan.seed, Stage::Film, item, self.pass);
        let sample = self.tracer.sample(film, sequence, self.scratch, self.tally);
        if !sample.is_finite() {
            // A point on the right or lower border of the image is the last pixel's.
            let Camera { width, height, .. } = self.tracer.world.camera;
            let of = |at: u32, size: u32| (at / self.steps).min(size - 1);
            let place = Place { x: of(x, width), y: of(y, height), pass: self.pass };
            self.tally.health.non_finite(place);
        } else {
            self.tally.health.see(sample.radiance);
        }
        self.radiances.push(if sample.is_finite() { sample.radiance } else { Color::NAN });
        let wants = self.tracer.wants;
        if wants.first_hit || wants.split || wants.photons {
            self.samples.push(*sample);
        }
        next
    }
}

/// Places beside `at` among so many, and itself.
fn near(at: u32, len: usize) -> std::ops::Range<usize> {
    (at as usize).saturating_sub(1)..(at as usize + 2).min(len)
}

/// The ranges of `width` places from `first` on, each together with those beside it.
fn widened(row: &[Range], first: u32, width: u32) -> Vec<Range> {
    let of = |at: u32| row[near(at, row.len())].iter().fold(Range::default(), |all, range| all.with(*range));
    (first..first + width).map(of).collect()
}

/// The least and the greatest of finite radiances, channel by channel.
#[derive(Clone, Copy)]
struct Range {
    lo: Color,
    hi: Color,
}

impl Default for Range {
    fn default() -> Range {
        Range { lo: Color::INFINITY, hi: Color::ZERO }
    }
}

impl Range {
    fn of(radiance: Color) -> Range {
        if radiance.is_finite() {
            Range { lo: radiance, hi: radiance.max(Color::ZERO) }
        } else {
            Range::default()
        }
    }

    fn with(self, other: Range) -> Range {
        Range { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    fn contrast(&self, floor: f32) -> f32 {
        ((self.hi - self.lo) / (self.hi + self.lo + 2.0 * floor)).max_element()
    }
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
