//! Rays a second of photon tracing on one thread, beside plain nearest-hit queries in the same world.
//!
//! The plain queries are of the photons' own rays, in their order. A photon's ray costs such a query and what
//! happens at its end: the surface, Snell and Fresnel, the draw, the ledger, and for the first ray the
//! emission. The third rate is that of camera paths through the same glass, which have the same to do at the
//! end of each ray, and shade besides: shadow rays are counted as rays. All take turns, block by block, and
//! the best time of each counts.
//! `cargo bench --bench photons [-- gallery/pool.ron ...]`

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;
use terrarium::build::build;
use terrarium::description::{Loaded, load};
use terrarium::plan::{Effect, Overrides, Plan, Request};
use terrarium::render::{Options, Silent, render};
use terrarium::scatter::Emission;

/// Of the folder `scenes`, where the command line names no others.
const SCENES: [&str; 3] = ["yardstick/caustic-sphere.ron", "yardstick/cornell-glass.ron", "terrarium.ron"];
const PHOTONS: u64 = 200_000;
const TURNS: u32 = 8;

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    println!(
        "{:34}{:>14}{:>16}{:>8}{:>16}{:>8}{:>12}",
        "", "photons", "plain rays", "ratio", "camera paths", "ratio", "rays/photon"
    );
    let named: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).collect();
    let scenes = if named.is_empty() { SCENES.map(str::to_owned).to_vec() } else { named };
    for scene in &scenes {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
        let smaller = ["image.width=256".to_owned(), "image.height=256".to_owned()];
        let loaded = load(&path, &smaller).expect("the yardstick's scenes are valid");
        let scene_text = &loaded.scene;
        let plan = Plan::new(scene_text, &Request::default()).expect("nothing is overridden");
        let world = build(scene_text, &plan).expect("the yardstick's scenes can be built").world;
        let emission = Emission::new(&world, &plan).expect("light reaches the glass");
        let rays = emission.rays(&world, TURNS, PHOTONS);
        let (mut scattering, mut plain, mut counted, mut emitted) = (f64::INFINITY, f64::INFINITY, 0, 0);
        let mut camera = f64::INFINITY;
        for pass in 0..TURNS {
            pool.install(|| {
                let start = Instant::now();
                let scattered = black_box(emission.scatter(&world, pass, PHOTONS));
                scattering = scattering.min(start.elapsed().as_secs_f64() / scattered.ledger.rays as f64);
                (counted, emitted) = (scattered.ledger.rays, scattered.emitted);
                let start = Instant::now();
                let hits = rays.iter().filter(|ray| world.nearest(ray, f64::INFINITY).is_some()).count();
                plain = plain.min(start.elapsed().as_secs_f64() / rays.len() as f64);
                black_box(hits);
            });
            camera = camera.min(camera_path(&loaded));
        }
        println!(
            "{scene:34}{:9.2} M/s {:10.2} M/s {:7.2} {:10.2} M/s {:7.2} {:11.2}",
            1e-6 / scattering,
            1e-6 / plain,
            plain / scattering,
            1e-6 / camera,
            camera / scattering,
            counted as f64 / emitted as f64
        );
    }
}

/// Seconds a ray of camera paths, without photons, on one thread.
fn camera_path(loaded: &Loaded) -> f64 {
    let overrides = Overrides { without: vec![Effect::Caustics, Effect::Indirect], ..Overrides::default() };
    let options = Options { passes: Some(0..2), threads: Some(1), overrides, ..Options::default() };
    let stats = render(loaded, &options, &Silent).expect("the yardstick's scenes can be rendered").stats;
    let traced = stats.stages.iter().find(|stage| stage.name == "trace").expect("a stage of every render");
    traced.seconds / stats.rays.total() as f64
}
