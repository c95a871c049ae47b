//! Which parts of a picture are accurate enough.

use super::independent::relative;
use super::{FLOOR, weight};
use crate::film::brightness::Brightness;
use crate::math::DVec3;
use crate::trace::{Look, Measured, Probe, Resting};

/// Sums over a block's pixels and probes.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    pixels: f64,
    noise: f64,
    probes: f64,
    bias: f64,
}

/// Lets the blocks rest whose own squared error is at most `enough`, and that of all eight around them: what
/// begins in a block may just not have been seen in the next.
///
/// `gain`: squared noise over that of independent passes. The bias of a block is that of the 25 around it, as
/// one probe lies in four.
pub(in crate::film) fn done<'a>(
    pixels: impl Iterator<Item = Measured>,
    probes: impl Iterator<Item = &'a Probe>,
    picture: &Brightness,
    gain: f64,
    enough: f64,
    resting: &mut Resting,
) {
    let floor = FLOOR * picture.mean() * picture.mean();
    let [across, down] = resting.size();
    let mut blocks = vec![Block::default(); resting.blocks().len()];
    for pixel in pixels {
        let block = &mut blocks[resting.block(pixel.x, pixel.y)];
        block.pixels += 1.0;
        block.noise += gain * relative(&pixel, picture, floor);
    }
    for probe in probes {
        let Some([[caustic, indirect], [caustic_later, indirect_later]]) = probe.biases(Look::Wide) else {
            continue;
        };
        let squared: DVec3 = (caustic + indirect) * (caustic_later + indirect_later);
        let block = &mut blocks[resting.block(probe.x, probe.y)];
        block.probes += 1.0;
        block.bias += (squared * weight(probe.mean_of_all(), floor)).element_sum() / 3.0;
    }
    // Where no probe is near, as at the edge of a crop.
    let (probes, bias) = blocks.iter().fold((0.0, 0.0), |(n, sum), b| (n + b.probes, sum + b.bias));
    let everywhere = bias / f64::max(probes, 1.0);
    let around = |i: usize, far: u32| {
        let (x, y) = (i as u32 % across, i as u32 / across);
        let near = move |c: u32, end: u32| c.saturating_sub(far)..(c + far + 1).min(end);
        near(y, down).flat_map(move |v| near(x, across).map(move |u| (v * across + u) as usize))
    };
    let accurate: Vec<bool> = (0..blocks.len())
        .map(|i| {
            let (probes, bias) =
                around(i, 2).fold((0.0, 0.0), |(n, sum), k| (n + blocks[k].probes, sum + blocks[k].bias));
            let bias = if probes > 0.0 { bias / probes } else { everywhere }.max(0.0);
            blocks[i].noise / blocks[i].pixels.max(1.0) + bias <= enough
        })
        .collect();
    let settled: Vec<usize> =
        (0..blocks.len()).filter(|&i| around(i, 1).all(|k| accurate[k] || resting.blocks()[k])).collect();
    settled.into_iter().for_each(|i| resting.rest(i));
}
