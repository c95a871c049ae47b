//! What a partial image says of itself: enough to go on with it, and to put parts together.

use super::share::{By, Shards};
use super::stop::StopState;
use super::{Aov, Options, RenderError};
use crate::description::Image as Settings;
use crate::film::{Film, Rates, Window};
use crate::math::Health;
use crate::output::partial::{self, PartialError, checksum};
use crate::output::{Image, Provenance, atomic};
use crate::plan::Plan;
use crate::trace::{self, Layers, Parts, Tally};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::path::Path;

/// Of the form of partial images; raised with every change of it.
const FORMAT: u32 = 6;

/// What all parts of one image have in common, beside its provenance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Form {
    pub format: u32,
    pub width: u32,
    pub height: u32,
    pub window: Window,
    pub tile: u32,
    /// The first and the one after the last, of the whole image.
    pub passes: [u32; 2],
    pub aovs: Vec<String>,
    pub of: u32,
    pub by: By,
    /// Whether statistics of the error are kept.
    pub told: bool,
    /// SHA-256 of every asset file, in hexadecimal.
    pub assets: String,
    pub exposure_ev: f64,
    pub png_bits: u8,
    pub rates: Rates,
}

/// What of the image is there.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Part {
    pub form: Form,
    pub shards: Vec<u32>,
    /// The step that tiles are at; after the last pass, if the part is finished.
    pub begin: u32,
    /// Passes that were traced, of this part.
    pub done: u32,
    pub finished: bool,
    pub counts: Counts,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<StopState>,
    pub words: usize,
    pub checksum: u64,
}

/// What a tally leaves in the provenance.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Counts {
    pub health: Health,
    pub cut_paths: u64,
    pub cut_weight: f64,
}

/// A partial image that was read.
pub struct Kept {
    pub provenance: Provenance,
    pub part: Part,
    words: Vec<u32>,
}

impl Form {
    pub(super) fn new(
        plan: &Plan,
        options: &Options,
        size: [u32; 2],
        assets: String,
        shown: (f64, u8),
        rates: Rates,
    ) -> Form {
        let [width, height] = size;
        let (of, by) = match &options.shards {
            Some(shards) => (shards.of, By::of(shards, plan)),
            None => (1, By::Passes),
        };
        Form {
            format: FORMAT,
            width,
            height,
            window: options.crop.unwrap_or(Window::all(width, height)),
            tile: options.tile,
            passes: [plan.first_pass, plan.first_pass + plan.passes],
            aovs: Aov::ALL.iter().filter(|a| options.aovs.contains(a)).map(|a| a.name().to_owned()).collect(),
            of,
            by,
            told: options.tells(plan.passes),
            assets,
            exposure_ev: shown.0,
            png_bits: shown.1,
            rates,
        }
    }

    /// How this differs from another form of the same scene and passes.
    fn other_than(&self, here: &Form) -> Option<String> {
        if self == here {
            return None;
        }
        let window = |Window { x0, y0, x1, y1 }: Window| format!("{x0},{y0},{x1},{y1}");
        let layers = |form: &Form| if form.aovs.is_empty() { "none".to_owned() } else { form.aovs.join(",") };
        let by = |form: &Form| match form.by {
            By::Passes => "passes".to_owned(),
            By::Tiles => "tiles".to_owned(),
        };
        let each = [
            ("the form of the file", self.format.to_string(), here.format.to_string()),
            ("the width", self.width.to_string(), here.width.to_string()),
            ("the height", self.height.to_string(), here.height.to_string()),
            ("the crop", window(self.window), window(here.window)),
            ("the side of a tile", self.tile.to_string(), here.tile.to_string()),
            ("the list of further layers", layers(self), layers(here)),
            ("what is divided", by(self), by(here)),
            ("the PNG's exposure", self.exposure_ev.to_string(), here.exposure_ev.to_string()),
            ("the PNG's bits", self.png_bits.to_string(), here.png_bits.to_string()),
        ];
        let told = each.iter().find(|(_, there, here)| there != here);
        Some(told.map_or("the error is told of one alone".to_owned(), |(what, there, here)| {
            format!("{what} is {there} there and {here} here")
        }))
    }

    /// The layers of the picture.
    pub fn aovs(&self) -> Vec<Aov> {
        self.aovs.iter().filter_map(|name| name.parse().ok()).collect()
    }

    fn layers(&self) -> Layers {
        let options = Options { aovs: self.aovs(), untold: !self.told, ..Options::default() };
        // Whether the error is told has been decided.
        let wants = options.wants(self.width, self.height, u32::MAX);
        let [first, end] = self.passes;
        let one_pass = end - first == 1;
        let divided = self.of > 1 && self.by == By::Passes;
        let parts = if divided { Parts::Of { first, passes: end - first } } else { Parts::Growing };
        Layers { parts, one_pass, ..trace::layers(&wants) }
    }

    /// An empty film of some of the shards.
    pub fn film(&self, shards: &[u32]) -> Film {
        let mut film = Film::of(self.width, self.height, self.window, self.tile, self.layers());
        film.rates = self.rates;
        if self.by == By::Tiles {
            let shards = Shards { numbers: shards.to_vec(), of: self.of };
            film.keep_tiles(|tile| shards.has_tile(tile));
        }
        film
    }

    /// Whether numbers could be those of an image: a file may say anything.
    fn is_sound(&self) -> bool {
        let Window { x0, y0, x1, y1 } = self.window;
        let sides = 1..=Settings::MAX_SIDE;
        self.format == FORMAT
            && sides.contains(&self.width)
            && sides.contains(&self.height)
            && x0 < x1
            && y0 < y1
            && x1 <= self.width
            && y1 <= self.height
            && self.tile > 0
            && self.of > 0
            && self.passes[0] < self.passes[1]
            && self.aovs.len() == self.aovs().len()
    }
}

impl Counts {
    pub(super) fn of(tally: &Tally) -> Counts {
        Counts { health: tally.health.clone(), cut_paths: tally.cut.paths, cut_weight: tally.cut.weight }
    }

    pub(super) fn plus(mut self, other: Counts) -> Counts {
        self.health.add(&other.health);
        Counts {
            health: self.health,
            cut_paths: self.cut_paths + other.cut_paths,
            cut_weight: self.cut_weight + other.cut_weight,
        }
    }
}

/// Writes a partial image, whole or not at all.
pub fn save(
    path: &Path,
    image: &Image,
    provenance: &Provenance,
    part: &Part,
    film: &Film,
) -> Result<(), crate::output::OutputError> {
    let mut file = atomic::Pending::create(path)?;
    write(&mut file, image, provenance, part, film)?;
    Ok(file.commit()?)
}

/// Writes a partial image to any sink.
pub fn write(
    sink: impl std::io::Write + std::io::Seek,
    image: &Image,
    provenance: &Provenance,
    part: &Part,
    film: &Film,
) -> Result<(), crate::output::OutputError> {
    let words = film.to_words();
    let part = Part { words: words.len(), checksum: checksum(&words), ..part.clone() };
    let partial = serde_json::to_value(part).expect("numbers, texts and lists");
    let provenance = Provenance { partial: Some(partial), ..provenance.clone() };
    partial::write(sink, image, &provenance, words)
}

/// Reads a partial image.
pub fn load(path: &Path) -> Result<Kept, PartialError> {
    let (mut provenance, mut words) = partial::read(File::open(path)?)?;
    let part = provenance.partial.take();
    let part = part.ok_or_else(|| PartialError::Other("a whole image: no part of one".to_owned()))?;
    let part: Part = serde_json::from_value(part).map_err(|error| {
        PartialError::Other(format!("a partial image of another version of the program: {error}"))
    })?;
    if !part.form.is_sound() || part.shards.iter().any(|shard| *shard >= part.form.of) {
        return Err(PartialError::Other("a partial image of a form that is not known here".to_owned()));
    }
    if part.words > words.len() {
        return Err(PartialError::Damaged("sums are missing".to_owned()));
    }
    words.truncate(part.words);
    if checksum(&words) != part.checksum {
        return Err(PartialError::Damaged("its sums are not those that were written".to_owned()));
    }
    Ok(Kept { provenance, part, words })
}

impl Kept {
    /// The film as it was.
    pub fn film(&self) -> Result<Film, PartialError> {
        let mut film = self.part.form.film(&self.part.shards);
        film.set_words(&self.words)
            .map_err(|_| PartialError::Damaged("its sums are not those of its pixels".to_owned()))?;
        Ok(film)
    }

    /// Adds its passes to a film of the same form that has others; with which comes first.
    pub fn join(&self, film: &mut Film, earlier: bool) -> Result<(), PartialError> {
        let mismatch = || PartialError::Damaged("its sums are not those of its pixels".to_owned());
        if self.part.form.by == By::Passes {
            return film.join_words(&self.words, earlier).map_err(|_| mismatch());
        }
        // Tiles are one part's or the other's.
        film.join(self.film()?);
        Ok(())
    }

    /// How this differs from what is rendered now, if it does.
    pub(super) fn other_than(&self, provenance: &Provenance, form: &Form, shards: &[u32]) -> Option<String> {
        let told =
            |what: &str, there: &str, here: &str| Some(format!("{what} is {there} there and {here} here"));
        let (there, here) = (&self.provenance, provenance);
        if there.software != here.software {
            return told("the program", &there.software, &here.software);
        }
        if there.scene_hash != here.scene_hash {
            return told("the scene's hash", &there.scene_hash, &here.scene_hash);
        }
        if there.seed != here.seed {
            return told("the seed", &there.seed.to_string(), &here.seed.to_string());
        }
        let (a, b) = (&self.part.form, form);
        if a.assets != b.assets {
            return told("the hash of the meshes and images", &a.assets, &b.assets);
        }
        if a.passes != b.passes {
            let text = |[first, end]: [u32; 2]| format!("{first}..{end}");
            return told("the range of passes", &text(a.passes), &text(b.passes));
        }
        if there.plan != here.plan {
            let overrides = |plan: &str| {
                let line = plan.lines().find_map(|line| line.strip_prefix("overrides: "));
                line.map_or("none".to_owned(), |line| format!("`{line}`"))
            };
            let (a, b) = (overrides(&there.plan), overrides(&here.plan));
            if a == b {
                return Some("other effects are on, or for other reasons".to_owned());
            }
            return Some(format!("effects are overridden in another way: {a} there, {b} here"));
        }
        if a.of != b.of || self.part.shards != shards {
            let text = |list: &[u32], of: u32| format!("{list:?} of {of}");
            return told("the shard", &text(&self.part.shards, a.of), &text(shards, b.of));
        }
        a.other_than(b)
    }
}

impl From<PartialError> for RenderError {
    fn from(error: PartialError) -> Self {
        RenderError::Io(error.to_string())
    }
}
