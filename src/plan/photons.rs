//! The budget of photons.

pub use crate::description::Kernel;
use crate::description::{Antialiasing, Photons, Scene};

/// How caustics are estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonBudget {
    /// Photons sent out a map.
    pub count: u32,
    pub engine: PhotonEngine,
    pub kernel: Kernel,
    /// The largest gather radius, metres; without it the size of what focuses light decides.
    pub max_radius: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PhotonEngine {
    /// A map a pass, with a radius that shrinks: α of Knaus & Zwicker 2011, and the photons that the first
    /// radius holds.
    Progressive { alpha: f64, k: u32 },
    /// One map for all passes, and the k nearest.
    Classic { k: u32 },
}

/// Bounds on the photons of a pass where the scene does not say, and what the first radius holds of them.
const COUNT: (u64, u64) = (50_000, 400_000);
const FIRST_K: u32 = 30;

/// One pass has to do where samples lie in a fixed pattern: more photons, and more of them in each estimate.
/// How many passes are rendered does not matter, so that any of them can be rendered alone.
const SINGLE_PASS: (u32, u32) = (4, 100);

fn single_pass(scene: &Scene) -> bool {
    scene.antialiasing != Antialiasing::Progressive
}

fn chosen_count(scene: &Scene) -> u32 {
    let pixels = u64::from(scene.image.width) * u64::from(scene.image.height);
    pixels.clamp(COUNT.0, COUNT.1) as u32 * if single_pass(scene) { SINGLE_PASS.0 } else { 1 }
}

fn chosen_k(scene: &Scene, of_many_passes: u32) -> u32 {
    if single_pass(scene) { SINGLE_PASS.1 } else { of_many_passes }
}

/// `None` where the scene turns photons off.
pub(super) fn budget(scene: &Scene) -> Option<PhotonBudget> {
    match scene.photons {
        Photons::Off => None,
        Photons::Progressive { count, k, alpha, kernel, max_radius_m } => {
            let engine = PhotonEngine::Progressive { alpha, k: k.unwrap_or(chosen_k(scene, FIRST_K)) };
            let count = count.unwrap_or(chosen_count(scene));
            Some(PhotonBudget { count, engine, kernel, max_radius: max_radius_m })
        }
        Photons::Classic { count, k, kernel, max_radius_m } => {
            let engine = PhotonEngine::Classic { k };
            Some(PhotonBudget { count, engine, kernel, max_radius: max_radius_m })
        }
    }
}

/// The same for indirect light, which is spread over the whole scene.
pub(super) fn indirect(scene: &Scene) -> PhotonBudget {
    let asked = budget(scene).filter(|_| !scene.photons.is_default());
    asked.unwrap_or_else(|| {
        let k = chosen_k(scene, INDIRECT_K);
        PhotonBudget {
            count: chosen_count(scene),
            engine: PhotonEngine::Progressive { alpha: Photons::ALPHA, k },
            kernel: Kernel::default(),
            max_radius: None,
        }
    })
}

/// Indirect light is smooth: it can be blurred more than a caustic.
const INDIRECT_K: u32 = 60;
