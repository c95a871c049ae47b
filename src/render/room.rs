//! Whether a render has room in memory: the image's sums and layers, known before anything is built, and all of
//! it, foretold once the scene is.

use super::{Options, Planned, RenderError};
use crate::build::Instance;
use crate::description::{Instances, Scene};
use crate::forecast::memory;
use crate::trace::{self, Tile};

/// The side of the tile whose memory is measured.
const SIDE: u32 = 64;

/// Bytes a pixel of sums, and of the finished image.
fn bytes_per_pixel(options: &Options, passes: u32, width: u32, height: u32) -> [u64; 2] {
    let layers = trace::layers(&options.wants(width, height, passes));
    let tile = Tile::new(0, 0, SIDE, SIDE, layers).memory_bytes() as u64;
    [tile.div_ceil(u64::from(SIDE * SIDE)), options.image_bytes_per_pixel()]
}

/// Refuses a scene whose instances alone take more than `options.memory`, or than the machine has.
pub(super) fn check_scene(options: &Options, scene: &Scene) -> Result<(), RenderError> {
    let Some(limit) = options.memory.or_else(memory::machine) else { return Ok(()) };
    let (count, each) = (Instances::of(scene).all(), size_of::<Instance>());
    let bytes = count * each as f64;
    if bytes <= limit as f64 {
        return Ok(());
    }
    Err(RenderError::TooLarge(format!(
        "the scene takes {count} instances × {each} bytes = {bytes} bytes, before any tree of them; {} {limit}",
        whose(options)
    )))
}

/// Refuses passes whose photons alone, `stored` of them at so many bytes `each` at the least while they are put
/// into their map, take more than `options.memory`, or than the machine has.
pub(super) fn check_photons(options: &Options, stored: f64, each: f64) -> Result<(), RenderError> {
    let Some(limit) = options.memory.or_else(memory::machine) else { return Ok(()) };
    let bytes = stored * each;
    if bytes <= limit as f64 {
        return Ok(());
    }
    Err(RenderError::TooLarge(format!(
        "a pass stores about {stored:.0} photons × {each:.0} bytes = {bytes:.0} bytes at the least; {} {limit}; the scene's `photons` \
         say how many are sent out",
        whose(options)
    )))
}

fn whose(options: &Options) -> &'static str {
    if options.memory.is_some() { "the limit is" } else { "this machine has" }
}

/// Refuses an image that takes more than `options.memory`, or than the machine has.
pub(super) fn check(options: &Options, passes: u32, width: u32, height: u32) -> Result<(), RenderError> {
    let Some(limit) = options.memory.or_else(memory::machine) else { return Ok(()) };
    let [sums, layers] = bytes_per_pixel(options, passes, width, height);
    // At most 2^16 a side, checked with the scene: no product overflows.
    let (width, height) = options.crop.map_or((width, height), |crop| (crop.width(), crop.height()));
    let bytes = u64::from(width) * u64::from(height) * (sums + layers);
    if bytes <= limit {
        return Ok(());
    }
    let whose = whose(options);
    Err(RenderError::TooLarge(format!(
        "the image takes {width} × {height} pixels × ({sums} bytes of sums + {layers} of layers) = {bytes} bytes; \
         {whose} {limit}"
    )))
}

/// The share of a forecast that is left for its error: what is foretold is at most a sixth too low in the
/// repository's scenes, so that a render keeps its limit within a tenth.
const SPARE: u64 = 10;

/// Refuses a render that is foretold to take more than `options.memory`.
pub(super) fn foreseen(options: &Options, planned: &Planned) -> Result<(), RenderError> {
    let (Some(limit), Some(held), Some(peak)) = (options.memory, planned.held, planned.peak_bytes) else {
        return Ok(());
    };
    let spared = peak + peak / SPARE;
    if spared <= limit {
        return Ok(());
    }
    let later = &planned.later;
    Err(RenderError::TooLarge(format!(
        "the render takes about {} bytes that are held now, with the scene + {} of sums + {} of the next pass's \
         photons + {} of samples in tiles + {} of layers, {peak} at its highest, and a tenth to spare: {spared} bytes; the limit is \
         {limit}",
        held.now, later.film, later.photons, later.tiles, later.image
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Aov;

    #[test]
    fn images_are_refused_from_one_byte_above_the_limit() {
        for aovs in [vec![], vec![Aov::Variance, Aov::Normal]] {
            let of = |memory| Options { aovs: aovs.clone(), memory, ..Options::default() };
            let bytes = 640 * 480 * bytes_per_pixel(&of(None), 2, 640, 480).iter().sum::<u64>();
            assert!(check(&of(Some(bytes)), 2, 640, 480).is_ok());
            let refused = check(&of(Some(bytes - 1)), 2, 640, 480);
            assert!(matches!(refused, Err(RenderError::TooLarge(message)) if message.contains("640 × 480")));
        }
    }
}
