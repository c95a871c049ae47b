//! Scenes as text to worlds, and photons to numbers.

use std::path::Path;
use terrarium::build::{World, build};
use terrarium::description::{Format, load_str};
use terrarium::math::{DVec3, Vec3};
use terrarium::plan::{Plan, Request};
use terrarium::scatter::{Aim, Emission, Photon, Photons, Scattered, Store};

pub struct Lab {
    pub world: World,
    pub plan: Plan,
}

/// The world of `materials`, `lights` and `objects`, each the inside of its list in RON.
pub fn lab(materials: &str, lights: &str, objects: &str) -> Lab {
    lab_in(Path::new(""), "", materials, lights, objects)
}

/// The same with files of a folder, and `more` fields of the scene, each with its comma.
pub fn lab_in(folder: &Path, more: &str, materials: &str, lights: &str, objects: &str) -> Lab {
    let text = format!(
        r#"(
    camera: (eye: (0, 3, 9), target: (0, 0, 0), fov_deg: 40),
    image: (width: 2, height: 2),
    {more}
    materials: {{ "white": (diffuse: 1), "glass": (transmission: 1, ior: 1.5), "mirror": (reflection: 1), {materials} }},
    lights: {{ {lights} }},
    objects: [{objects}],
)"#
    );
    let loaded =
        load_str(&text, Format::Ron, folder, &[]).unwrap_or_else(|report| panic!("{report:?}\n{text}"));
    let plan =
        Plan::new(&loaded.scene, &Request { seed: Some(7), ..Request::default() }).expect("no overrides");
    let world = build(&loaded.scene, &plan).unwrap_or_else(|error| panic!("{error}\n{text}")).world;
    Lab { world, plan }
}

impl Lab {
    pub fn emission(&self, store: Store, aim: Aim) -> Option<Emission> {
        Emission::of(&self.world, &self.plan, store, aim)
    }

    /// Passes of caustic photons.
    pub fn caustics(&self, passes: u32, count: u64) -> Vec<Scattered> {
        self.passes(Store::Caustics, Aim::Casters, passes, count)
    }

    pub fn passes(&self, store: Store, aim: Aim, passes: u32, count: u64) -> Vec<Scattered> {
        let emission = self.emission(store, aim).expect("something to emit");
        (0..passes).map(|pass| emission.scatter(&self.world, pass, count)).collect()
    }

    /// The photon's place in the scene's coordinates.
    pub fn place(&self, photon: &Photon) -> DVec3 {
        photon.position.as_dvec3() + self.world.origin
    }
}

/// Mean over passes and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub error: f64,
}

pub fn estimate(values: impl IntoIterator<Item = f64>) -> Estimate {
    let values: Vec<f64> = values.into_iter().collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Estimate { mean, error: (variance / n).sqrt() }
}

/// Power of the photons that `keep` keeps, in the red channel, pass by pass.
pub fn power(passes: &[Scattered], keep: impl Fn(&Photon) -> bool) -> Estimate {
    let sum =
        |photons: &Photons| photons.iter().filter(|p| keep(p)).map(|p| f64::from(p.power.x)).sum::<f64>();
    estimate(passes.iter().map(|pass| sum(&pass.photons)))
}

/// Whether a photon lies on the floor y = 0, within `half` of (x, z) in both directions, from above.
pub fn on_patch(lab: &Lab, photon: &Photon, [x, z]: [f64; 2], half: f64) -> bool {
    let p = lab.place(photon);
    photon.normal == Vec3::Y && p.y.abs() < 1e-4 && (p.x - x).abs() < half && (p.z - z).abs() < half
}
