//! What a study found, as `study.json` keeps it: enough to go on where it was broken off.

use super::{Change, Knob};
use crate::output::atomic;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;

/// The file in the study's folder.
pub const FILE: &str = "study.json";

/// A study, whole or as far as it has come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// Of the program.
    pub version: String,
    pub scene: String,
    /// What all renders have in common: where any of it differs, nothing is taken over.
    pub subject: Subject,
    pub asked: Asked,
    /// Threads that rendered.
    pub threads: usize,
    pub reference: Reference,
    /// Files that the scene reads, with their SHA-256.
    pub files: Vec<(String, String)>,
    pub rungs: Vec<Rung>,
    /// Knobs that have nothing to change in this scene.
    pub left_out: Vec<LeftOut>,
    /// What was given up for time, in words.
    pub notes: Vec<String>,
    /// What the knobs buy; empty until the study is complete.
    pub lines: Vec<Line>,
    /// Of all runs whose passes show their error (2 or more, progressive), how often the stated interval held
    /// the true error.
    pub honest: Honest,
    pub complete: bool,
}

/// What is studied.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Subject {
    /// Of the program: another one may render other pictures, or need another time.
    pub version: String,
    /// SHA-256 of its file, where the system tells which that is.
    pub program: Option<String>,
    /// That render: with more of them the same takes another time.
    pub threads: usize,
    /// SHA-256 of what the scene says.
    pub scene_hash: String,
    /// Effects left out or added; empty without.
    pub effects: String,
    pub seed: u64,
    pub width: usize,
    pub height: usize,
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    pub knobs: Vec<Knob>,
    /// Renders of each rung, with seeds that follow each other.
    pub seeds: u32,
    /// Rungs of the ladder of passes, 1, 2, 4 …; without it as many as the time allows.
    pub ladder: Option<u32>,
    /// Wall seconds of the whole study.
    pub seconds: f64,
    /// A file whose picture is taken for the truth.
    pub reference: Option<String>,
}

/// What is taken for the truth.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Whether it was given as a file, or else rendered.
    pub given: bool,
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Of a rendered one: its seed, passes, wall seconds, and its own stated error with its interval.
    pub seed: Option<u64>,
    pub passes: Option<u32>,
    pub seconds: Option<f64>,
    pub error: Option<f64>,
    pub interval: Option<[f64; 2]>,
    /// Of a rendered one: the passes after which the error would be four times its own. The ladder ends there:
    /// with less the reference's own error would show (by 3 % of noise that is four times as large).
    pub ladder_passes: Option<f64>,
}

/// One setting, and what its renders were like.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rung {
    /// `passes-8`: also the name of its pictures.
    pub name: String,
    pub knob: Knob,
    /// Rungs of one line are joined in the plot: `grid`, `progressive` or the knob's key.
    pub line: String,
    /// The setting in words: `8`, `grid(3)`.
    pub value: String,
    /// The setting as a number, where twice of it means something.
    pub x: Option<f64>,
    pub passes: u32,
    pub change: Option<Change>,
    /// The same as options of `render`.
    pub set: Vec<String>,
    /// Wall seconds that the plan foretold.
    pub predicted_seconds: f64,
    /// One a seed, in order.
    pub runs: Vec<Run>,
    /// Over the runs; none before the first.
    pub result: Option<Summary>,
}

/// One render.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    pub seed: u64,
    /// Wall seconds: files, building, photons, tracing, and writing the EXR.
    pub seconds: f64,
    /// Against the reference: relative RMS error, 0.01 for 1 %, and relMSE with ε = 0.01.
    pub error: f64,
    pub rel_mse: f64,
    /// What the render itself says of its error, and of what part of it is bias; unknown after one pass.
    pub stated: Option<f64>,
    pub interval: Option<[f64; 2]>,
    pub stated_bias: Option<f64>,
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Highest memory of the process so far into this render, where the system tells it.
    pub peak_bytes: Option<u64>,
}

/// Medians over the runs of a rung, and ranges: `[median, least, most]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    pub seconds: [f64; 3],
    pub error: [f64; 3],
    pub rel_mse: [f64; 3],
    pub stated: Option<[f64; 3]>,
    /// Medians of both ends.
    pub interval: Option<[f64; 2]>,
    pub peak_bytes: Option<u64>,
    pub camera_rays: u64,
    /// Whether no other rung is both as fast and as good.
    pub pareto: bool,
    /// Whether the reference's own error is more than a tenth of this one: the truth is not well enough known.
    pub near_reference: bool,
}

/// What a knob buys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    pub knob: Knob,
    pub line: String,
    /// By least squares on logarithmic axes: of error over seconds, of error and of seconds over the knob's
    /// number.
    pub error_by_seconds: Option<f64>,
    pub error_by_number: Option<f64>,
    pub seconds_by_number: Option<f64>,
    /// The slope of the last of them alone, at most four: what stands beside theory, which is of many.
    pub late_error_by_number: Option<f64>,
    /// Of error over the knob's number, as theory has it: the steepest and the flattest part of this scene's light.
    pub theory: Option<[f64; 2]>,
    pub sentence: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    pub knob: Knob,
    pub reason: String,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Honest {
    pub held: u32,
    pub of: u32,
}

impl Study {
    /// What the folder holds of an earlier study, if it can be read.
    pub fn read(folder: &Path) -> Option<Study> {
        serde_json::from_str(&std::fs::read_to_string(folder.join(FILE)).ok()?).ok()
    }

    pub fn json(&self) -> String {
        let json = serde_json::to_string_pretty(self).expect("numbers, strings and lists of them");
        json + "\n"
    }

    /// Replaces the folder's file as a whole.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        atomic::write(&folder.join(FILE), self.json().as_bytes())
    }

    /// Rungs that were rendered, in order.
    pub fn rendered(&self) -> impl Iterator<Item = (&Rung, &Summary)> {
        self.rungs.iter().filter_map(|rung| Some((rung, rung.result.as_ref()?)))
    }
}

impl Rung {
    pub fn picture(&self) -> String {
        format!("pictures/{}.png", self.name)
    }

    pub fn error_map(&self) -> String {
        format!("errors/{}.png", self.name)
    }

    /// What a reader calls it: `passes 8`, `grid(3)`.
    pub fn title(&self) -> String {
        let own = self.line == self.knob.key();
        if own { format!("{} {}", self.line.replace('_', " "), self.value) } else { self.value.clone() }
    }

    /// Whether it is the same render, whatever its name and price.
    pub fn is_like(&self, other: &Rung) -> bool {
        (self.passes, self.change) == (other.passes, other.change)
    }
}
