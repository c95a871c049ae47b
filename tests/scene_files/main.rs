//! Scene files as a user has them.

mod animation;
mod assets;
mod formats;
mod include;
mod malformed;
mod misspelt;
mod scatter_over;
mod schema;
mod set;
mod snippets;

use std::path::{Path, PathBuf};
use terrarium::description::{Format, Loaded, Report, Scene, load_str};

pub const FULL_RON: &str = include_str!("../description/full.ron");
pub const FULL_TOML: &str = include_str!("../description/full.toml");

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/description")
}

pub fn full(text: &str, format: Format, overrides: &[&str]) -> Result<Loaded, Report> {
    let overrides: Vec<String> = overrides.iter().map(|s| s.to_string()).collect();
    load_str(text, format, &folder(), &overrides)
}

pub fn full_scene(overrides: &[&str]) -> Scene {
    full(FULL_RON, Format::Ron, overrides).unwrap_or_else(|report| panic!("{report}")).scene
}

pub fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("it is in the folder")).expect("a folder can be made");
    std::fs::write(&path, text).expect("a file can be written");
    path
}

pub const CAMERA: &str = "camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1";
