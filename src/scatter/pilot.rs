//! The pilot: a few photons for every cell tell what it sends and how much of that arrives, and from
//! that the share of the photons that each cell gets.
//!
//! The variance of a sum over cells, of which cell c is sampled n_c times, is Σ V_c/n_c and least, for
//! a given number of photons, where n_c goes as √V_c. V_c is taken as the mean square of what arrives,
//! flux²·yield where all photons of a cell weigh the same. Any positive shares give the right mean;
//! every cell therefore keeps a part in proportion to its flux, so that none weighs too much.
//!
//! The same for every pass.

use super::Emission;
use super::path::{Sink, Walk};
use crate::build::World;
use crate::math::random::{Sequence, Stage};
use rayon::prelude::*;

/// Photons of a whole pilot, and the most that one cell gets.
const PHOTONS: usize = 1 << 15;
const MOST: usize = 64;

/// The part of the photons that is shared by flux alone.
const BY_FLUX: f64 = 0.1;

/// Keeps the pilot's random values apart from the passes'.
const PILOT: u64 = 1 << 63;

/// What the pilot has found of one cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// Watts, all channels together.
    pub flux: f64,
    pub arrived: f64,
    /// Mean square of what one photon of weight 1 brings.
    square: f64,
}

/// What each cell sends and yields.
pub(super) fn explore(emission: &Emission, world: &World) -> Vec<Found> {
    let each = (PHOTONS / emission.cells.len().max(1)).clamp(2, MOST) as u32;
    let walk = emission.walk(world);
    let cells: Vec<usize> = (0..emission.cells.len()).collect();
    cells.par_iter().with_min_len(16).map(|&cell| found(emission, &walk, cell, each)).collect()
}

fn found(emission: &Emission, walk: &Walk, cell: usize, each: u32) -> Found {
    let mut sink = Sink::default();
    let mut found = Found::default();
    let sequence = Sequence::new(emission.seed, Stage::Photons, cell as u64 | PILOT, 0);
    let scrambles = super::scrambles(sequence);
    emission.starts(walk.world, cell, &scrambles, 0..each.into(), |i, start| {
        found.flux += start.power.element_sum();
        if emission.may_arrive(start) {
            sink.photons.clear();
            sink.ledger = Default::default();
            walk.follow(start, sequence.at(i as u32), &mut sink);
            let arrived = sink.ledger.arrived.element_sum();
            found.arrived += arrived;
            found.square += arrived * arrived;
        }
    });
    let n = f64::from(each);
    Found { flux: found.flux / n, arrived: found.arrived / n, square: found.square / n }
}

/// Shares of the photons by cell; they sum to 1. `None` if nothing is emitted.
pub(super) fn shares(found: &[Found], each_cell_of: &[u32]) -> Option<Vec<f64>> {
    let flux: f64 = found.iter().map(|f| f.flux).sum();
    if !(flux > 0.0 && flux.is_finite()) {
        return None;
    }
    // A cell of which the pilot saw nothing may be like its light's others.
    let sources = each_cell_of.iter().max().map_or(0, |&s| s as usize + 1);
    let (mut sums, mut counts) = (vec![Found::default(); sources], vec![0.0; sources]);
    for (f, &source) in found.iter().zip(each_cell_of) {
        let sum = &mut sums[source as usize];
        sum.flux += f.flux;
        sum.arrived += f.arrived;
        counts[source as usize] += 1.0;
    }
    let likely = found.iter().zip(each_cell_of).map(|(f, &source)| {
        let sum = sums[source as usize];
        let yielded = if sum.flux > 0.0 { sum.arrived / sum.flux } else { 0.0 };
        let typical = f.flux.max(0.1 * sum.flux / counts[source as usize]);
        (0.9 * f.square + 0.1 * typical * typical * yielded).sqrt()
    });
    let likely: Vec<f64> = likely.collect();
    let sum: f64 = likely.iter().sum();
    let by_flux = |f: &Found, source: u32| {
        // The pilot may have missed what little a cell emits.
        let mean = sums[source as usize].flux / counts[source as usize];
        0.5 * (f.flux + mean) / flux
    };
    let yields = if sum > 0.0 { 1.0 - BY_FLUX } else { 0.0 };
    let share = |((f, &source), l): ((&Found, &u32), &f64)| {
        let likely = if sum > 0.0 { l / sum } else { 0.0 };
        yields * likely + (1.0 - yields) * by_flux(f, source)
    };
    Some(found.iter().zip(each_cell_of).zip(&likely).map(share).collect())
}
