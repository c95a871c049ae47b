//! Where in a pixel the samples of a pass lie, and how they make up the pixel's value.

mod adaptive;
mod average;

use super::{Probes, Sample, Scratch, Tally, Tracer, Wants};
use crate::math::random::{Sequence, Stage};
use crate::math::{DVec2, DVec3, Place};
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

/// The values of a second sample at one place.
const ANOTHER: u64 = 0x5ec0_0d5a;

fn pixel_number(tracer: &Tracer, x: u32, y: u32) -> u64 {
    u64::from(y) * u64::from(tracer.world.camera.width) + u64::from(x)
}

/// n × n samples at the centres of a regular grid.
fn grid(tracer: &Tracer, n: u32, pass: u32, tile: &mut Tile, scratch: &mut Scratch, tally: &mut Tally) {
    let mut is_probe = probes(tracer);
    let centre = |i: u32| (f64::from(i) + 0.5) / f64::from(n);
    let within: Vec<DVec2> = (0..n * n).map(|i| DVec2::new(centre(i % n), centre(i / n))).collect();
    let mut value = PixelValue::default();
    for (x, y) in tile.pixels() {
        let pixel = Sequence::new(tracer.plan.seed, Stage::Film, pixel_number(tracer, x, y), 0);
        let probe = is_probe(x, y);
        let wants = wants(tracer, probe);
        look(tally, probe, tracer.wants.bias, pass);
        let corner = DVec2::new(f64::from(x), f64::from(y));
        let candidates = tracer.world.before_eye(corner);
        let samples = (0u32..).zip(&within).map(|(i, within)| {
            let index = pass.wrapping_mul(n * n).wrapping_add(i);
            (corner + within, pixel.at(index))
        });
        let place = Place { x, y, pass };
        if wants.radiance_alone() {
            let (mut sum, mut count) = (DVec3::ZERO, 0);
            for (film, sequence) in samples {
                let sample = tracer.sample_among(candidates, film, sequence, scratch, tally);
                if checked(sample, place, tally) {
                    sum += sample.radiance.as_dvec3();
                    count += 1;
                }
            }
            if count == 0 {
                continue;
            }
            value.of_radiance(sum * (1.0 / f64::from(count)), n * n);
        } else {
            let mut average = Average::of(wants);
            for (film, sequence) in samples {
                let sample = tracer.sample_among(candidates, film, sequence, scratch, tally);
                if checked(sample, place, tally) {
                    average.add(sample, 1.0);
                }
            }
            let Some(mean) = average.value(n * n) else { continue };
            value = mean;
        }
        look_up(&mut value, tally, n * n);
        tile.add_as(probe, x, y, &value);
    }
}

/// Tells which pixels of a tile are probes.
fn probes(tracer: &Tracer) -> impl FnMut(u32, u32) -> bool {
    let mut scan = tracer.wants.probes.map(Probes::scan);
    move |x, y| scan.as_mut().is_some_and(|scan| scan.is_probe(x, y))
}

/// Of a probe's light, the parts are kept.
fn wants(tracer: &Tracer, probe: bool) -> Wants {
    Wants { split: tracer.wants.split || probe, ..tracer.wants }
}

/// One pass in so many looks at the photons' bias, and takes two samples at one place: both of them cost time.
const LOOK: u32 = 2;
const PAIR: u32 = 4;

/// Begins to look at the bias, if that is due.
fn look(tally: &mut Tally, probe: bool, bias: bool, pass: u32) {
    tally.probing = (probe || bias) && pass.is_multiple_of(LOOK);
    tally.bias = Default::default();
}

/// Ends to look, with what was found in so many samples.
fn look_up(value: &mut PixelValue, tally: &Tally, samples: u32) {
    if tally.probing {
        let bias = tally.bias.map(|look| look.map(|sum| sum.as_dvec3() / f64::from(samples)));
        value.bias = bias.iter().flatten().all(|b| b.is_finite()).then_some(bias);
    }
}

/// One sample, well distributed over the pixel's passes.
fn progressive(tracer: &Tracer, pass: u32, tile: &mut Tile, scratch: &mut Scratch, tally: &mut Tally) {
    let rests = |x: u32, y: u32| tracer.resting.is_some_and(|resting| resting.has(x, y));
    let (mut is_probe, mut value) = (probes(tracer), PixelValue::default());
    for (x, y) in tile.pixels().filter(|&(x, y)| !rests(x, y)) {
        let item = pixel_number(tracer, x, y);
        let sequence = Sequence::new(tracer.plan.seed, Stage::Film, item, pass);
        let [dx, dy] = sequence.pair();
        let film = DVec2::new(f64::from(x) + dx, f64::from(y) + dy);
        let probe = is_probe(x, y);
        look(tally, probe, tracer.wants.bias, pass);
        let sample = tracer.sample(film, sequence, scratch, tally);
        if !checked(sample, Place { x, y, pass }, tally) {
            continue;
        }
        value.set(sample, wants(tracer, probe));
        look_up(&mut value, tally, 1);
        if probe && pass.is_multiple_of(PAIR) {
            let rest = sample.rest();
            let mut aside = Tally::default();
            let other = tracer.sample(film, sequence.dimension(ANOTHER), scratch, &mut aside);
            value.pair = Some((rest - other.rest()).as_dvec3()).filter(|pair| pair.is_finite());
        }
        tile.add_as(probe, x, y, &value);
    }
}

/// Whether a sample can be added up; takes note of it either way.
#[inline]
fn checked(sample: &Sample, place: Place, tally: &mut Tally) -> bool {
    let finite = sample.is_finite();
    if finite {
        tally.health.see(sample.radiance);
        tally.note(|recorder| recorder.weigh_last(1.0));
    } else {
        tally.health.non_finite(place);
    }
    finite
}
