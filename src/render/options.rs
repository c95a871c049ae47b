//! What a caller asks of a render beyond the scene, and what it may be told.

use super::{Checkpoint, Halt, Planned, Shards};
use crate::build::BuildError;
use crate::film::{Film, Window};
use crate::plan::{Antialiasing, Overrides, Plan, Refused, Request, Until};
use crate::trace::{Probes, Wants};
use std::ops::{ControlFlow, Range};
use std::str::FromStr;
use std::time::Instant;

/// Options of one render. They override what the scene says.
#[derive(Clone, Debug)]
pub struct Options {
    /// Worker threads; without it one a processor. Never changes a pixel.
    pub threads: Option<usize>,
    /// The numbers of the passes, from the first to the one after the last: any part of a render's passes
    /// can be rendered alone.
    pub passes: Option<Range<u32>>,
    pub seed: Option<u64>,
    /// When to stop before the last pass.
    pub until: Until,
    /// When the process began, for a limit on its time; without it, when rendering began.
    pub began: Option<Instant>,
    /// Effects that are left out or added.
    pub overrides: Overrides,
    /// Further layers of the image.
    pub aovs: Vec<Aov>,
    /// Side of a tile in pixels, 1 or more. Never changes a pixel.
    pub tile: u32,
    /// Rare events above their healthy share are an error.
    pub strict: bool,
    /// Keeps no statistics of the error, which then is unknown: to measure what these cost.
    #[doc(hidden)]
    pub untold: bool,
    /// The most bytes that the image may take; without it, what the machine has.
    pub memory: Option<u64>,
    /// The pixels that are rendered; without it, all.
    pub crop: Option<Window>,
    /// The part of the work that is done here; without it, all.
    pub shards: Option<Shards>,
    pub checkpoint: Option<Checkpoint>,
    /// Told from outside to stop: what is there by then becomes the image.
    pub halt: Option<Halt>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            threads: None,
            passes: None,
            seed: None,
            until: Until::default(),
            began: None,
            overrides: Overrides::default(),
            aovs: Vec::new(),
            tile: 32,
            strict: false,
            untold: false,
            memory: None,
            crop: None,
            shards: None,
            checkpoint: None,
            halt: None,
        }
    }
}

/// A further layer of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
    Caustic,
    Indirect,
    Photons,
    PhotonDensity,
    Variance,
    Noise,
    Bias,
    Edges,
}

impl Aov {
    pub const ALL: [Aov; 17] = [
        Aov::Albedo,
        Aov::Normal,
        Aov::Depth,
        Aov::Position,
        Aov::ObjectId,
        Aov::Samples,
        Aov::Direct,
        Aov::Reflection,
        Aov::Refraction,
        Aov::Caustic,
        Aov::Indirect,
        Aov::Photons,
        Aov::PhotonDensity,
        Aov::Variance,
        Aov::Noise,
        Aov::Bias,
        Aov::Edges,
    ];

    /// The name on the command line.
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
            Aov::Caustic => "caustic",
            Aov::Indirect => "indirect",
            Aov::Photons => "photons",
            Aov::PhotonDensity => "photon_density",
            Aov::Variance => "variance",
            Aov::Noise => "noise",
            Aov::Bias => "bias",
            Aov::Edges => "edges",
        }
    }
}

impl FromStr for Aov {
    type Err = String;

    fn from_str(name: &str) -> Result<Aov, String> {
        Aov::ALL.into_iter().find(|aov| aov.name() == name).ok_or_else(|| {
            let nearest =
                Aov::ALL.into_iter().map(Aov::name).min_by_key(|n| strsim::damerau_levenshtein(n, name));
            let names = Aov::ALL.map(Aov::name).join(", ");
            format!(
                "no layer is named `{name}`; did you mean `{}`? All are: {names}",
                nearest.unwrap_or_default()
            )
        })
    }
}

impl Options {
    /// What they ask of the plan.
    pub fn request(&self) -> Request {
        Request {
            passes: self.passes.clone(),
            seed: self.seed,
            until: self.until,
            overrides: self.overrides.clone(),
        }
    }

    /// Whether statistics of the error are kept of so many passes: one tells nothing of it, unless those of other
    /// shards are added to it later.
    pub(super) fn tells(&self, passes: u32) -> bool {
        !self.untold && (passes > 1 || self.shards.is_some())
    }

    /// Of its layers in single precision, up to three channels each, and of a 16-bit PNG before it is compressed.
    pub(super) fn image_bytes_per_pixel(&self) -> u64 {
        4 * 3 * (1 + self.aovs.len() as u64) + 2 * 3
    }

    /// Of an image of this size, and so many passes.
    pub(super) fn wants(&self, width: u32, height: u32, passes: u32) -> Wants {
        let any = |list: &[Aov]| list.iter().any(|aov| self.aovs.contains(aov));
        let part = self.crop.map_or((width, height), |crop| (crop.width(), crop.height()));
        Wants {
            first_hit: any(&[Aov::Albedo, Aov::Normal, Aov::Depth, Aov::Position, Aov::ObjectId]),
            split: any(&[Aov::Direct, Aov::Reflection, Aov::Refraction, Aov::Caustic, Aov::Indirect]),
            variance: any(&[Aov::Variance, Aov::Noise]),
            bias: any(&[Aov::Bias]),
            photons: any(&[Aov::Photons, Aov::PhotonDensity]),
            probes: self.tells(passes).then(|| Probes::of(part.0, part.1)),
            one_pass: passes == 1,
        }
    }

    /// Refuses what this plan cannot give.
    pub(super) fn check(&self, plan: &Plan, width: u32, height: u32) -> Result<(), RenderError> {
        if let Some(crop) = self.crop.filter(|crop| crop.x1 > width || crop.y1 > height || crop.pixels() == 0)
        {
            let Window { x0, y0, x1, y1 } = crop;
            return Err(RenderError::Invalid(format!(
                "--crop {x0},{y0},{x1},{y1} is not within the image of {width} × {height} pixels"
            )));
        }
        let by_passes = [Aov::Variance, Aov::Noise].into_iter().find(|aov| self.aovs.contains(aov));
        if let Some(aov) = by_passes.filter(|_| plan.passes < 2) {
            let name = aov.name();
            return Err(RenderError::Invalid(format!(
                "the {name} of a single pass is unknown: ask for `--passes 2` or more with `--aov {name}`"
            )));
        }
        let adaptive = matches!(plan.antialiasing, Antialiasing::Adaptive { .. });
        if self.aovs.contains(&Aov::Bias) && adaptive {
            return Err(RenderError::Invalid(
                "the `bias` layer is not there with `antialiasing: adaptive()`, whose samples belong to several pixels"
                    .to_owned(),
            ));
        }
        if self.aovs.contains(&Aov::Edges) && !matches!(plan.antialiasing, Antialiasing::Adaptive { .. }) {
            return Err(RenderError::Invalid(
                "the `edges` layer shows where adaptive antialiasing went: it needs `antialiasing: adaptive()`"
                    .to_owned(),
            ));
        }
        if let Some(shards) = &self.shards {
            shards.check(plan)?;
        }
        if self.threads == Some(0) || self.tile == 0 {
            return Err(RenderError::Invalid("threads and tile size must be 1 or more".to_owned()));
        }
        Ok(())
    }
}

/// How a render is followed. Called from many threads.
pub trait Progress: Sync {
    /// A stage of `total` units begins; 0 where nobody knows how many.
    fn start(&self, stage: &str, total: u64, unit: &str);
    /// `done` more units are finished.
    fn advance(&self, done: u64);
    /// `done` units of the stage that has begun were finished by an earlier run.
    fn resume(&self, done: u64) {
        self.advance(done);
    }
    /// The stage is likely to be one of so many units.
    fn expect(&self, _: u64) {}
    /// The stage is over.
    fn finish(&self);
    /// What the render will take is known, and tracing begins.
    fn planned(&self, _: &Planned) {}
    /// The picture's error, as it is and as it should become.
    fn error(&self, _: f64, _: f64) {}
    /// Whether it is looked at after every pass, and not only after several where that is quicker.
    fn looks_on(&self) -> bool {
        false
    }
    /// The picture of so many passes, between two of them; a break ends the render there.
    fn picture(&self, _: &Film, _passes: u32) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// Something worth a line.
    fn note(&self, message: &str);
}

/// Follows nothing.
pub struct Silent;

impl Progress for Silent {
    fn start(&self, _: &str, _: u64, _: &str) {}
    fn advance(&self, _: u64) {}
    fn finish(&self) {}
    fn note(&self, _: &str) {}
}

/// Why nothing was rendered.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    #[error("not supported: {0}")]
    NotSupported(String),
    #[error("{0}")]
    Invalid(String),
    #[error("{0}")]
    Io(String),
    /// A limit on what a render may take.
    #[error("{0}")]
    TooLarge(String),
    #[error("{0}")]
    Failed(String),
    /// Told to stop before anything was traced.
    #[error("stopped before anything was traced")]
    Stopped,
    /// The part that was asked for is there already.
    #[error("there already")]
    Already,
}

impl RenderError {
    /// 1 render failed, 2 scene invalid, 3 input unreadable, 5 a limit refused, 6 stopped.
    pub fn exit_code(&self) -> u8 {
        match self {
            RenderError::Failed(_) => 1,
            RenderError::Already => 0,
            RenderError::NotSupported(_) | RenderError::Invalid(_) => 2,
            RenderError::Io(_) => 3,
            RenderError::TooLarge(_) => 5,
            RenderError::Stopped => 6,
        }
    }
}

impl From<Refused> for RenderError {
    fn from(refused: Refused) -> Self {
        RenderError::Invalid(refused.0)
    }
}

impl From<BuildError> for RenderError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::NotSupported(m) => RenderError::NotSupported(m),
            BuildError::Invalid(m) => RenderError::Invalid(m),
            BuildError::Io(m) => RenderError::Io(m),
        }
    }
}
