//! What counts as middling luminance in a scene: the floor of relative contrast rests on it, so that
//! exposure and the strength of the lamps do not matter to adaptive antialiasing.

use super::{Scratch, Tally, Tracer};
use crate::math::random::{Sequence, Stage, mix};
use crate::math::{Color, DVec2};

/// Samples at most, spread evenly over the image.
const SAMPLES: u32 = 1024;

/// Rec. 709 luminance.
pub fn luminance(c: Color) -> f32 {
    c.dot(Color::new(0.2126, 0.7152, 0.0722))
}

/// The median luminance of what is not black; 1 where all is.
pub fn reference_level(tracer: &Tracer) -> f32 {
    let mut scratch = Scratch::new(tracer);
    let mut tally = Tally::default();
    let camera = &tracer.world.camera;
    let mut levels: Vec<f32> = (0..SAMPLES)
        .map(|i| {
            let sequence = Sequence::new(tracer.plan.seed, Stage::Film, mix(u64::MAX), i);
            let [x, y] = sequence.pair();
            let film = DVec2::new(x * f64::from(camera.width), y * f64::from(camera.height));
            luminance(tracer.sample(film, sequence, &mut scratch, &mut tally).radiance)
        })
        .filter(|l| l.is_finite() && *l > 0.0)
        .collect();
    levels.sort_by(f32::total_cmp);
    levels.get(levels.len() / 2).copied().unwrap_or(1.0)
}
