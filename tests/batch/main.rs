//! Renders in parts and with interruptions: the same bits as in one go.

mod crop;
mod farm;
mod faults;
mod limits;
pub(crate) mod merge;
pub(crate) mod resume;

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// Caustics of a glass ball on a matt floor, a lamp with an extent.
pub(crate) const CAUSTIC: &str = r#"(
    camera: (eye: (0, 1.6, 4), target: (0, 0.5, 0), fov_deg: 40),
    image: (width: 60, height: 44),
    photons: progressive(count: 20000),
    materials: { "glass": (transmission: 1, ior: 1.5), "floor": (diffuse: (0.7, 0.6, 0.5)) },
    lights: { "lamp": sphere(center: (1, 3, 0.5), radius: 0.3, radiance: (60, 55, 50)) },
    objects: [
        (shape: sphere(radius: 0.6), material: "glass", transform: [translate((0, 0.8, 0))]),
        (shape: box(), material: "floor", transform: [scale((12, 0.2, 12)), translate((0, -0.1, 0))]),
    ],
)"#;

/// Edges that adaptive antialiasing divides, in one pass.
pub(crate) const ADAPTIVE: &str = r#"(
    camera: (eye: (0, 1.6, 4), target: (0, 0.5, 0), fov_deg: 40),
    image: (width: 90, height: 70),
    antialiasing: adaptive(depth: 3),
    render: (passes: 1),
    materials: { "white": (diffuse: (0.8, 0.7, 0.6), reflection: 0.3) },
    lights: { "lamp": point(position: (1, 4, 3), intensity: (40, 40, 40)) },
    objects: [
        (shape: cone(), material: "white", transform: [translate((-0.8, 0, 0))]),
        (shape: box(), material: "white", transform: [rotate(axis: (0, 1, 0), deg: 30), translate((0.9, 0.5, 0))]),
        (shape: box(), material: "white", transform: [scale((12, 0.2, 12)), translate((0, -0.1, 0))]),
    ],
)"#;

pub(crate) struct Lab {
    folder: TempDir,
}

impl Lab {
    pub(crate) fn new(scene: &str) -> Lab {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("scene.ron"), scene).expect("written");
        Lab { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_terrarium"));
        command.current_dir(self.folder.path()).args(words).stdin(Stdio::null());
        for name in ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "SOURCE_DATE_EPOCH", "NO_COLOR"] {
            command.env_remove(name);
        }
        command
    }

    fn run(&self, words: &[&str]) -> Output {
        self.command(words).output().expect("the program runs")
    }

    /// Runs the program, which has to end well.
    pub(crate) fn done(&self, words: &[&str]) -> String {
        let output = self.run(words);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words:?}: {said}");
        said
    }

    /// Runs the program, which has to end with a code, and says what it printed.
    fn fails(&self, code: i32, words: &[&str]) -> String {
        let output = self.run(words);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{words:?}: {said}");
        said
    }

    pub(crate) fn render(&self, more: &[&str]) -> String {
        self.done(&[&["render", "scene.ron", "--progress", "none"], more].concat())
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder");
        let mut names: Vec<String> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}
