//! A few blocks of pixels, traced as the render will trace them.

use crate::math::random::{Sequence, Stage, mix};
use crate::plan::Antialiasing;
use crate::trace::{self, Rays, Spent, Tally, Tile, Tracer};
use rayon::prelude::*;
use std::time::Instant;

/// What one pixel takes in one pass, on average.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// Of one thread.
    pub seconds: f64,
    pub spent: Spent,
    pub samples: f64,
    pub rays: RaysByPixel,
}

/// Rays by kind, as [`Rays`] has them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RaysByPixel([f64; 6]);

impl RaysByPixel {
    fn of(rays: &Rays, pixels: f64) -> RaysByPixel {
        let Rays { camera, shadow, reflection, refraction, diffuse, probe } = *rays;
        RaysByPixel([camera, shadow, reflection, refraction, diffuse, probe].map(|n| n as f64 / pixels))
    }

    pub(super) fn map(&self, count: impl Fn(f64) -> u64) -> Rays {
        let [camera, shadow, reflection, refraction, diffuse, probe] = self.0.map(count);
        Rays { camera, shadow, reflection, refraction, diffuse, probe }
    }
}

/// The side of a block in samples, and in pixels where adaptive antialiasing shares cells within it.
const SIDE: u32 = 8;

/// The pilot's wall time: a share of what it foretells, seconds at the least and at the most.
const SHARE: f64 = 0.01;
const SECONDS: (f64, f64) = (0.001, 0.02);

/// Rounds of two blocks a thread, at least: the first, of one a thread, is to warm up.
const ROUNDS: u32 = 4;

/// One sample in so many is timed by its parts.
const TIMED: u32 = 7;

impl Pace {
    /// Of a tracer that has its photons, in pass number `pass`, for a render of about `passes` passes.
    pub fn measure(tracer: &Tracer, pass: u32, passes: u32) -> Pace {
        let began = Instant::now();
        let camera = &tracer.world.camera;
        let all = f64::from(camera.width) * f64::from(camera.height);
        let threads = rayon::current_num_threads() as u32;
        let (mut round, mut next) = (0, 0);
        let mut sum = Sum::default();
        loop {
            let count = if round == 0 { threads } else { 2 * threads };
            let blocks: Vec<u32> = (next..next + count).collect();
            next += count;
            let traced: Vec<Sum> = blocks.par_iter().map(|&i| block(tracer, pass, i)).collect();
            // Caches and branch predictors are cold in the first.
            if round == 1 {
                sum = Sum::default();
            }
            traced.iter().for_each(|one| sum.add(one));
            round += 1;
            let predicted = sum.tally.seconds / sum.pixels * all * f64::from(passes);
            let enough = (SHARE * predicted / f64::from(threads)).clamp(SECONDS.0, SECONDS.1);
            if began.elapsed().as_secs_f64() >= enough && round >= ROUNDS || sum.pixels >= all {
                break;
            }
        }
        Pace {
            seconds: sum.tally.seconds / sum.pixels,
            spent: *sum.tally.watch.spent(),
            samples: sum.tally.rays.camera as f64 / sum.pixels,
            rays: RaysByPixel::of(&sum.tally.rays, sum.pixels),
        }
    }
}

#[derive(Default)]
struct Sum {
    tally: Tally,
    pixels: f64,
}

impl Sum {
    fn add(&mut self, other: &Sum) {
        self.tally.add(&other.tally);
        self.pixels += other.pixels;
    }
}

/// Block number `i` of a well-distributed sequence of those that the image is divided into: every pixel is as
/// likely as any other.
fn block(tracer: &Tracer, pass: u32, i: u32) -> Sum {
    let side = match tracer.plan.antialiasing {
        Antialiasing::Grid(n) => (2 * SIDE / n).clamp(1, SIDE),
        Antialiasing::Adaptive { .. } | Antialiasing::None | Antialiasing::Progressive => SIDE,
    };
    let camera = &tracer.world.camera;
    let [u, v] = Sequence::new(tracer.plan.seed, Stage::Film, mix(u64::MAX - 1), i).pair();
    let part = |u: f64, size: u32| {
        let start = (u * f64::from(size.div_ceil(side))) as u32 * side;
        (start, side.min(size - start))
    };
    let ((x, width), (y, height)) = (part(u, camera.width), part(v, camera.height));
    let mut tile = Tile::new(x, y, width, height, trace::layers(&tracer.wants));
    let tally = trace::passes(tracer, pass..pass + 1, &mut tile, TIMED);
    Sum { tally, pixels: f64::from(width) * f64::from(height) }
}
