//! Where in a pixel the samples of a pass lie, and how they make up the pixel's value.

mod adaptive;
mod average;

use super::{Sample, Scratch, Tally, Tracer};
use crate::math::random::{Sequence, Stage};
use crate::math::{DVec2, Place};
use crate::plan::Antialiasing;
use crate::trace::{PixelValue, Tile};
use average::Average;

/// Adds one pass to every pixel of a tile.
pub(super) fn pass(tracer: &Tracer, pass: u32, tile: &mut Tile, scratch: &mut Scratch, tally: &mut Tally) {
    match tracer.plan.antialiasing {
        Antialiasing::None => grid(tracer, 1, pass, tile, scratch, tally),
        Antialiasing::Grid(n) => grid(tracer, n, pass, tile, scratch, tally),
        Antialiasing::Progressive => progressive(tracer, pass, tile, scratch, tally),
        Antialiasing::Adaptive { threshold, depth } => {
            adaptive::pass(tracer, threshold, depth, pass, tile, scratch, tally);
        }
    }
}

fn pixel_number(tracer: &Tracer, x: u32, y: u32) -> u64 {
    u64::from(y) * u64::from(tracer.world.camera.width) + u64::from(x)
}

/// n × n samples at the centres of a regular grid.
fn grid(tracer: &Tracer, n: u32, pass: u32, tile: &mut Tile, scratch: &mut Scratch, tally: &mut Tally) {
    for (x, y) in tile.pixels() {
        let pixel = Sequence::new(tracer.plan.seed, Stage::Film, pixel_number(tracer, x, y), 0);
        let mut average = Average::of(tracer.wants);
        for i in 0..n * n {
            let index = pass.wrapping_mul(n * n).wrapping_add(i);
            let within = DVec2::new(f64::from(i % n) + 0.5, f64::from(i / n) + 0.5) / f64::from(n);
            let film = DVec2::new(f64::from(x), f64::from(y)) + within;
            let sample = tracer.sample(film, pixel.at(index), scratch, tally);
            add_finite(&mut average, sample, Place { x, y, pass }, tally);
        }
        add(tile, x, y, average.value(n * n));
    }
}

/// One sample, well distributed over the pixel's passes.
fn progressive(tracer: &Tracer, pass: u32, tile: &mut Tile, scratch: &mut Scratch, tally: &mut Tally) {
    for (x, y) in tile.pixels() {
        let item = pixel_number(tracer, x, y);
        let sequence = Sequence::new(tracer.plan.seed, Stage::Film, item, pass);
        let [dx, dy] = sequence.pair();
        let film = DVec2::new(f64::from(x) + dx, f64::from(y) + dy);
        let sample = tracer.sample(film, sequence, scratch, tally);
        let mut average = Average::of(tracer.wants);
        add_finite(&mut average, sample, Place { x, y, pass }, tally);
        add(tile, x, y, average.value(1));
    }
}

#[inline]
fn add_finite(average: &mut Average, sample: &Sample, place: Place, tally: &mut Tally) {
    if sample.is_finite() {
        average.add(sample, 1.0);
    } else {
        tally.health.non_finite(place);
    }
}

/// A pixel all of whose samples were dropped has no value in this pass.
fn add(tile: &mut Tile, x: u32, y: u32, value: Option<PixelValue>) {
    if let Some(value) = value {
        tile.add(x, y, &value);
    }
}
