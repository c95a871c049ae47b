//! What a study turns: one setting at a time, all others as the scene has them.

use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// A setting that trades time for accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Knob {
    /// How many passes the picture is the mean of.
    Passes,
    /// Photons sent out a pass.
    Photons,
    /// Photons that the first radius holds, or of each classic estimate.
    K,
    /// Kind of antialiasing: none, grid, adaptive, progressive.
    Antialiasing,
    /// Contrast above which adaptive antialiasing divides.
    Threshold,
    /// How often adaptive antialiasing divides at most.
    Depth,
    /// Shadow rays a shading point on a light with an extent.
    ShadowRays,
    /// Facets of a mesh that stands for a sphere.
    Mesh,
}

impl Knob {
    pub const ALL: [Knob; 8] = [
        Knob::Passes,
        Knob::Photons,
        Knob::K,
        Knob::Antialiasing,
        Knob::Threshold,
        Knob::Depth,
        Knob::ShadowRays,
        Knob::Mesh,
    ];

    /// The name on the command line and in files.
    pub fn key(self) -> &'static str {
        match self {
            Knob::Passes => "passes",
            Knob::Photons => "photons",
            Knob::K => "k",
            Knob::Antialiasing => "antialiasing",
            Knob::Threshold => "threshold",
            Knob::Depth => "depth",
            Knob::ShadowRays => "shadow_rays",
            Knob::Mesh => "mesh",
        }
    }

    /// What its number counts.
    pub fn unit(self) -> &'static str {
        match self {
            Knob::Passes => "passes",
            Knob::Photons => "photons",
            Knob::K => "k",
            Knob::Antialiasing => "samples a side",
            Knob::Threshold => "contrast",
            Knob::Depth => "cells a side",
            Knob::ShadowRays => "shadow rays",
            Knob::Mesh => "segments",
        }
    }

    /// What one step of it is called, and the factor of its number that the step is.
    pub fn step(self) -> (&'static str, f64) {
        match self {
            Knob::Passes => ("doubling the passes", 2.0),
            Knob::Photons => ("doubling the photons of a pass", 2.0),
            Knob::K => ("doubling k, the photons of an estimate", 2.0),
            Knob::Antialiasing => ("twice as many samples a side", 2.0),
            Knob::Threshold => ("halving the threshold", 0.5),
            // Numbers of depth are sides of the finest cell: 2^depth.
            Knob::Depth => ("dividing once more", 2.0),
            Knob::ShadowRays => ("doubling the shadow rays", 2.0),
            Knob::Mesh => ("doubling the segments around a sphere", 2.0),
        }
    }
}

impl FromStr for Knob {
    type Err = String;

    fn from_str(name: &str) -> Result<Knob, String> {
        Knob::ALL.into_iter().find(|knob| knob.key() == name.trim()).ok_or_else(|| {
            let keys = Knob::ALL.map(Knob::key);
            let nearest = keys.iter().min_by_key(|key| strsim::damerau_levenshtein(key, name));
            let nearest = nearest.copied().unwrap_or_default();
            format!("no knob is named `{name}`; did you mean `{nearest}`? All are: {}", keys.join(", "))
        })
    }
}
