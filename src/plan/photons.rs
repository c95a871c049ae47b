//! The budget of photons.

pub use crate::description::Kernel;
use crate::description::{Photons, Scene};

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

/// Bounds on the photons of a pass where the scene does not say.
const COUNT: (u64, u64) = (50_000, 400_000);

/// `None` where the scene turns photons off.
pub(super) fn budget(scene: &Scene) -> Option<PhotonBudget> {
    match scene.photons {
        Photons::Off => None,
        Photons::Progressive { count, k, alpha, kernel, max_radius_m } => {
            let pixels = u64::from(scene.image.width) * u64::from(scene.image.height);
            let count = count.unwrap_or(pixels.clamp(COUNT.0, COUNT.1) as u32);
            let engine = PhotonEngine::Progressive { alpha, k };
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
        let pixels = u64::from(scene.image.width) * u64::from(scene.image.height);
        PhotonBudget {
            count: pixels.clamp(COUNT.0, COUNT.1) as u32,
            engine: PhotonEngine::Progressive { alpha: Photons::ALPHA, k: INDIRECT_K },
            kernel: Kernel::default(),
            max_radius: None,
        }
    })
}

/// Indirect light is smooth: it can be blurred more than a caustic.
const INDIRECT_K: u32 = 60;
