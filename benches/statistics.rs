//! What keeping the statistics of the error costs: renders with and without them, in turns.
//!
//! The image is the same. One pixel in 256 is looked at closely, of images smaller than half a megapixel more. Seconds of tracing and of the photons beside it, the best of each, on one thread.
//! `cargo bench --bench statistics`

use std::path::Path;
use terrarium::description::load;
use terrarium::render::{Options, Silent, render};

const SCENES: [&str; 5] = [
    "scenes/yardstick/caustic-sphere.ron",
    "scenes/yardstick/cornell-glass.ron",
    "scenes/gallery/reflection.ron",
    "scenes/gallery/still_life.toml",
    "scenes/terrarium.ron",
];
const TURNS: u32 = 4;
const PASSES: u32 = 4;

fn main() {
    println!("{:38}{:>12}{:>12}{:>10}", "", "with", "without", "cost");
    for scene in SCENES {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(scene);
        let smaller = ["image.width=640".to_owned(), "image.height=400".to_owned()];
        let loaded = load(&path, &smaller).expect("the repository's scenes are valid");
        let mut best = [f64::INFINITY; 2];
        for turn in 0..2 * TURNS {
            // First the one, then the other.
            let untold = (turn / 2 + turn) % 2 == 1;
            let options = Options { passes: Some(0..PASSES), threads: Some(1), untold, ..Options::default() };
            let stats = render(&loaded, &options, &Silent).expect("the scene can be rendered").stats;
            let traced = stats.stages.iter().filter(|stage| stage.name == "trace").map(|stage| stage.seconds);
            let seconds = &mut best[usize::from(untold)];
            *seconds = seconds.min(traced.sum());
        }
        let [with, without] = best;
        println!("{scene:38}{with:10.3} s{without:10.3} s{:9.1} %", 100.0 * (with / without - 1.0));
    }
}
