//! The stages called in order: a checked description in, an image out.
//!
//! Stand-in: the picture is a gradient until the stages are there.

use crate::{description, output};
use serde::Serialize;
use std::path::PathBuf;
use std::str::FromStr;

/// What the command line decides about a render.
#[derive(Clone, Debug)]
pub struct Options {
    /// Worker threads; all that the machine has if `None`.
    pub threads: Option<usize>,
    /// Passes; the scene's if `None`.
    pub passes: Option<u32>,
    /// Seed; the scene's if `None`.
    pub seed: Option<u64>,
    pub aovs: Vec<Aov>,
    /// Edge of a tile in pixels.
    pub tile: u32,
    /// Whether more rare events than are allowed fail the render.
    pub strict: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options { threads: None, passes: None, seed: None, aovs: Vec::new(), tile: 32, strict: false }
    }
}

/// A further layer of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    Albedo,
    Normal,
    Depth,
    Position,
    ObjectId,
    Samples,
    Direct,
    Reflection,
    Refraction,
    Variance,
    Edges,
}

impl Aov {
    pub const ALL: [Aov; 11] = [
        Aov::Albedo,
        Aov::Normal,
        Aov::Depth,
        Aov::Position,
        Aov::ObjectId,
        Aov::Samples,
        Aov::Direct,
        Aov::Reflection,
        Aov::Refraction,
        Aov::Variance,
        Aov::Edges,
    ];

    /// The layer's name.
    pub fn name(self) -> &'static str {
        match self {
            Aov::Albedo => "albedo",
            Aov::Normal => "normal",
            Aov::Depth => "depth",
            Aov::Position => "position",
            Aov::ObjectId => "object_id",
            Aov::Samples => "samples",
            Aov::Direct => "direct",
            Aov::Reflection => "reflection",
            Aov::Refraction => "refraction",
            Aov::Variance => "variance",
            Aov::Edges => "edges",
        }
    }
}

impl FromStr for Aov {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        if let Some(aov) = Aov::ALL.into_iter().find(|aov| aov.name() == name) {
            return Ok(aov);
        }
        let likeness = |aov: &Aov| strsim::jaro_winkler(aov.name(), name);
        let nearest = Aov::ALL
            .into_iter()
            .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
            .filter(|aov| likeness(aov) > 0.7);
        let names: Vec<&str> = Aov::ALL.iter().map(|aov| aov.name()).collect();
        Err(match nearest {
            Some(aov) => format!("there is no layer of this name; did you mean `{}`?", aov.name()),
            None => format!("there is no layer of this name; there are {}", names.join(", ")),
        })
    }
}

/// Told of the progress of a render, from any thread.
pub trait Progress: Sync {
    /// A stage of `total` units begins.
    fn start(&self, stage: &str, total: u64, unit: &str);
    /// `done` more units of the stage are done.
    fn advance(&self, done: u64);
    /// The stage is over.
    fn finish(&self);
    /// Something worth reading, in one line.
    fn note(&self, message: &str);
}

/// A finished render.
#[derive(Debug)]
pub struct Rendered {
    pub image: output::Image,
    pub provenance: output::Provenance,
    pub stats: Stats,
    pub warnings: Vec<String>,
    /// Every file read besides the scene's own.
    pub files: Vec<PathBuf>,
}

/// What a render did and what it cost.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Stats {
    pub stages: Vec<Stage>,
    pub rays: Rays,
    pub memory: Memory,
    pub rare_events: Vec<RareEvent>,
    pub passes: u32,
    pub samples: u64,
    pub truncated_paths: u64,
}

#[derive(Clone, Debug, Serialize)]
pub struct Stage {
    pub name: String,
    pub seconds: f64,
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Rays {
    pub camera: u64,
    pub shadow: u64,
    pub reflection: u64,
    pub refraction: u64,
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Memory {
    pub geometry_bytes: u64,
    pub texture_bytes: u64,
    pub film_bytes: u64,
}

/// `count` of `of` events were rare ones; up to the share `allowed` is expected.
#[derive(Clone, Debug, Serialize)]
pub struct RareEvent {
    pub name: String,
    pub count: u64,
    pub of: u64,
    pub allowed: f64,
}

/// Why a render failed.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    #[error("not supported: {0}")]
    NotSupported(String),
    #[error("{0}")]
    Invalid(String),
    #[error("{0}")]
    Io(String),
    #[error("{0}")]
    Failed(String),
}

/// Renders the scene.
pub fn render(
    loaded: &description::Loaded,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Rendered, RenderError> {
    let scene = &loaded.scene;
    let (width, height) = (scene.image.width as usize, scene.image.height as usize);
    match scene.render.seed {
        666 => panic!("a planted panic"),
        667 => return Err(RenderError::Failed("a planted failure".to_string())),
        668 => std::thread::sleep(std::time::Duration::from_secs(20)),
        _ => {}
    }
    progress.start("trace", height as u64, "rows");
    let mut pixels = Vec::with_capacity(width * height);
    for y in 0..height {
        pixels.extend((0..width).map(|x| [x as f32 / width as f32, y as f32 / height as f32, 0.2]));
        progress.advance(1);
    }
    progress.finish();
    let mut image = output::Image::new(width, height);
    image.add("", ["R", "G", "B"], &pixels);
    for aov in &options.aovs {
        image.add(aov.name(), ["Y"], &vec![[0.5]; width * height]);
    }
    let passes = options.passes.or(scene.render.passes).unwrap_or(1);
    let seed = options.seed.unwrap_or(scene.render.seed);
    Ok(Rendered {
        image,
        provenance: output::Provenance::new(&loaded.hash, seed, passes),
        stats: Stats {
            stages: vec![Stage { name: "trace".to_string(), seconds: 0.01 }],
            passes,
            samples: (width * height) as u64,
            ..Stats::default()
        },
        warnings: Vec::new(),
        files: Vec::new(),
    })
}
