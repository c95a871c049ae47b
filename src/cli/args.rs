//! The arguments, as typed.

use super::batch_args::BatchArgs;
use super::diff_args::{DIFF_EXAMPLES, DiffArgs};
use super::farm_args::{FARM_EXAMPLES, FarmArgs, MERGE_EXAMPLES, MergeArgs};
use super::frame_args::FrameArgs;
use super::replay_args::ReplayArgs;
use super::study_args::{STUDY_EXAMPLES, StudyArgs};
use super::watch_args::{WATCH_EXAMPLES, WatchArgs};
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use terrarium::plan::{Effect, Overrides, Until};
use terrarium::render::{Aov, Options};

const EXAMPLES: &str = "\
Examples:
  terrarium render scene.ron -o image.exr -o image.png
  terrarium render scene.toml -o - --set materials.glass.ior=1.33 | viewer -
  terrarium plan scene.ron
  terrarium study scene.ron -o study
  terrarium check scenes/*.ron
  terrarium convert scene.ron scene.toml
  terrarium diff image.exr reference.exr --max-e 1%

Exit codes: 0 done; 1 the render failed, or diff found a difference; 2 the scene is invalid or the call is wrong;
3 a file can't be read; 4 an output can't be written (tested before the first ray); 5 more memory than allowed;
6 stopped early (SIGINT, SIGTERM) with what was there written; 130, 143 stopped at once by a second signal.";

const RENDER_EXAMPLES: &str = "\
Examples:
  terrarium render scene.ron -o image.exr
  terrarium render scene.ron -o image.exr -o image.png --passes 256 --aov normal,depth,albedo
  terrarium render scene.ron -o image.exr --depfile image.d --stats image.json
  terrarium render scene.ron -o frames/####.png --frames 1-48
  terrarium render scene.ron --pixel 120,45 --pass 3
  generate | terrarium render - --scene-format toml -o - --format png > image.png";

const PLAN_EXAMPLES: &str = "\
Examples:
  terrarium plan scene.ron
  terrarium plan scene.ron --json | jq .seconds
  terrarium plan scene.ron --without caustics,normal_maps --passes 16
  terrarium plan scene.ron --measure --passes 4";

/// Renders light that passes through glass and water, from declarative scene files.
#[derive(Debug, Parser)]
#[command(name = "terrarium", version, long_version = LONG_VERSION, after_help = EXAMPLES, max_term_width = 100)]
#[command(arg_required_else_help = true)]
pub struct Args {
    /// When to colour messages; NO_COLOR and CLICOLOR_FORCE are kept by `auto`
    #[arg(
        long,
        global = true,
        value_enum,
        value_name = "WHEN",
        default_value_t,
        hide_possible_values = false
    )]
    pub color: ColorChoice,
    #[command(subcommand)]
    pub command: Command,
}

const LONG_VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    "\nscenes: RON, TOML; images: EXR (32-bit float), PNG (8, 16 bits)\nlicence: ",
    env!("CARGO_PKG_LICENSE"),
);

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to one or several images
    #[command(after_help = RENDER_EXAMPLES)]
    Render(Box<RenderArgs>),
    /// Render a scene pass by pass, and anew whenever it or a file that it uses changes
    #[command(after_help = WATCH_EXAMPLES)]
    Watch(Box<WatchArgs>),
    /// Tell what a render would do, why, and what time and memory it would take
    #[command(after_help = PLAN_EXAMPLES)]
    Plan(Box<PlanArgs>),
    /// Find out what accuracy costs in time: a ladder of renders, plots, and a page to look at
    #[command(after_help = STUDY_EXAMPLES)]
    Study(Box<StudyArgs>),
    /// Report every mistake in scene files, without rendering
    Check(CheckArgs),
    /// Compare an image with a reference: metrics, limits, heat maps
    #[command(after_help = DIFF_EXAMPLES)]
    Diff(Box<DiffArgs>),
    /// Put the partial images of a divided render together: the same bits as from one machine
    #[command(after_help = MERGE_EXAMPLES)]
    Merge(MergeArgs),
    /// Write the files with which Slurm, Open Job Description or Kubernetes renders a scene in parts
    #[command(after_help = FARM_EXAMPLES)]
    Farm(Box<FarmArgs>),
    /// Rewrite a scene in the other format, RON or TOML
    Convert(ConvertArgs),
    /// Print the JSON Schema of scenes, for completion in editors
    #[command(after_help = "Save it beside the scenes and begin a TOML scene with\n  \
                            #:schema ./terrarium.schema.json")]
    Schema,
    /// Print the completion script of a shell
    #[command(after_help = "Example:\n  terrarium completions bash > \
                            ~/.local/share/bash-completion/completions/terrarium")]
    Completions { shell: clap_complete::Shell },
}

#[derive(Clone, Debug, ClapArgs)]
pub struct RenderArgs {
    /// The scene, .ron or .toml; `-` reads it from standard input
    pub scene: PathBuf,
    /// The image to write, .exr or .png; `-` is standard output; may be given several times
    #[arg(short, long, value_name = "FILE", required_unless_present_any = ["out_dir", "pixel"])]
    pub output: Vec<PathBuf>,
    #[command(flatten)]
    pub replay: ReplayArgs,
    /// Format of the image that goes to standard output
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t)]
    pub format: ImageFormat,
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub work: Work,
    #[command(flatten)]
    pub batch: BatchArgs,
    #[command(flatten)]
    pub several: FrameArgs,
    /// Edge of a tile in pixels. The image does not depend on it
    #[arg(long, value_name = "PIXELS", default_value_t = 32,
          value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub tile: u32,
    /// Fail when more rare events happen than are allowed
    #[arg(long)]
    pub strict: bool,
    /// Write the time and the machine's name into the image. SOURCE_DATE_EPOCH replaces the time
    /// and leaves out the name
    #[arg(long)]
    pub stamp: bool,
    /// Write statistics as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Show the picture while it is rendered, in a viewer that speaks tev's protocol
    #[arg(long, value_name = "HOST:PORT")]
    pub display_server: Option<String>,
    /// Write a rule for make: which files the images depend on
    #[arg(long, value_name = "FILE")]
    pub depfile: Option<PathBuf>,
    /// How to show progress; `auto` is a bar on a terminal and plain lines elsewhere
    #[arg(long, value_enum, value_name = "HOW", default_value_t)]
    pub progress: ProgressChoice,
    /// Print only warnings and errors
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print the plan and the files that were read
    #[arg(short, long)]
    pub verbose: bool,
}

/// What is rendered of a scene: the same for a plan as for the render.
#[derive(Clone, Debug, ClapArgs)]
pub struct Work {
    /// Independent passes whose mean is the image, or a range of them such as `8..16` (8 to 15), to be
    /// averaged with the others later; the scene's if not given
    #[arg(long, value_name = "N or A..B", value_parser = passes)]
    pub passes: Option<std::ops::Range<u32>>,
    /// End after this wall time of the whole process: `90`, `60s`, `5min`, `1h`; the scene's if not given
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub time: Option<f64>,
    /// End when the relative RMS error of the picture is this or less, `2%`, `0.02`, by a quarter of the way to
    /// the upper end of its interval; the scene's if not given. Whichever of passes, time and error comes first ends the render
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub error: Option<f64>,
    /// Seed of every random value; the scene's if not given
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    #[command(flatten)]
    pub effects: Effects,
    /// Threads; as many as the machine runs at once if not given. The image does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Further layers of the EXR: albedo, normal, depth, position, object_id, samples, direct,
    /// reflection, refraction, caustic, indirect, photons, photon_density, variance, noise, bias, edges
    #[arg(long, value_name = "LAYER,…", value_delimiter = ',')]
    pub aov: Vec<Aov>,
    /// The most memory that the render may take, such as 512MiB or 4GiB; what the machine has if not given
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    pub memory: Option<u64>,
}

impl Work {
    /// As the library takes them; tiles and strictness are the render's own.
    pub fn options(&self) -> Options {
        let mut aovs = Vec::new();
        for aov in &self.aov {
            if !aovs.contains(aov) {
                aovs.push(*aov);
            }
        }
        Options {
            threads: self.threads.map(usize::from),
            passes: self.passes.clone(),
            seed: self.seed,
            until: Until { seconds: self.time, error: self.error },
            overrides: self.effects.overrides(),
            aovs,
            memory: self.memory,
            ..Options::default()
        }
    }
}

#[derive(Debug, ClapArgs)]
pub struct PlanArgs {
    /// Scenes, .ron or .toml; `-` reads one from standard input
    #[arg(required = true)]
    pub scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub work: Work,
    /// Print one JSON document instead of text: an object, or an array of them for several scenes
    #[arg(long)]
    pub json: bool,
    /// Render the scene as it is and with each effect left out in turn: what each costs, and what it
    /// changes in the image
    #[arg(long)]
    pub measure: bool,
    /// Trace the first 8 passes, and say how accurate the planned picture will be and what half of that
    /// error would cost
    #[arg(long)]
    pub accuracy: bool,
    /// How to show progress; `auto` is a bar on a terminal and plain lines elsewhere
    #[arg(long, value_enum, value_name = "HOW", default_value_t)]
    pub progress: ProgressChoice,
    /// Print only the plan, warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Passes: how many, or from the first to the one after the last.
fn passes(text: &str) -> Result<std::ops::Range<u32>, String> {
    let number = |part: &str| part.trim().parse::<u32>().map_err(|e| format!("`{part}`: {e}"));
    let range = match text.split_once("..") {
        Some((first, end)) => number(first)?..number(end)?,
        None => 0..number(text)?,
    };
    if range.end == u32::MAX {
        return Err(format!("{} passes at most", u32::MAX - 1));
    }
    if range.is_empty() {
        return Err("at least one pass is needed".to_owned());
    }
    Ok(range)
}

/// Seconds from a number with a unit.
pub fn seconds(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let units = [("ms", 1e-3), ("min", 60.0), ("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let found = units.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, *factor)));
    let (number, factor) = found.unwrap_or((text, 1.0));
    let value =
        number.trim().parse::<f64>().map_err(|_| format!("`{text}` is no time: 90, 60s, 5min, 1h"))?;
    positive(value * factor)
}

/// A number of bytes with its unit.
fn bytes(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let units = [("KiB", 1u64 << 10), ("MiB", 1 << 20), ("GiB", 1 << 30), ("TiB", 1 << 40), ("B", 1)];
    let found = units.iter().find_map(|(unit, size)| Some((text.strip_suffix(unit)?, *size)));
    let (number, size) = found.unwrap_or((text, 1));
    let number = number.trim().parse::<u64>().ok().filter(|n| *n > 0);
    let bytes = number.and_then(|n| n.checked_mul(size));
    bytes.ok_or_else(|| format!("`{text}` is no size: 512MiB, 4GiB, 1000000"))
}

/// A share, or so many per cent.
fn share(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (number, factor) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let value = number.trim().parse::<f64>().map_err(|_| format!("`{text}` is no share: 2%, 0.02"))?;
    positive(value * factor)
}

fn positive(value: f64) -> Result<f64, String> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(format!("{value} is not above 0")) }
}

/// Overrides of the effects that the scene calls for.
#[derive(Clone, Debug, ClapArgs)]
pub struct Effects {
    /// Leave out effects: direct, shadows, soft_shadows, reflection, refraction, absorption, dispersion,
    /// highlights, textures, normal_maps, bump_maps, caustics, indirect, depth_of_field, environment,
    /// antialiasing
    #[arg(long, value_name = "EFFECT,…", value_delimiter = ',')]
    pub without: Vec<Effect>,
    /// Render the light of these effects alone: direct, reflection, refraction, highlights, caustics,
    /// indirect, environment
    #[arg(long, value_name = "EFFECT,…", value_delimiter = ',')]
    pub only: Vec<Effect>,
    /// Add effects that the scene turns off: indirect, caustics
    #[arg(long, value_name = "EFFECT,…", value_delimiter = ',')]
    pub with: Vec<Effect>,
}

impl Effects {
    pub fn overrides(&self) -> Overrides {
        let once = |list: &[Effect]| {
            let mut effects = Vec::new();
            list.iter().for_each(|effect| {
                if !effects.contains(effect) {
                    effects.push(*effect)
                }
            });
            effects
        };
        let only = (!self.only.is_empty()).then(|| once(&self.only));
        Overrides { without: once(&self.without), only, with: once(&self.with), ..Overrides::default() }
    }
}

/// How a scene is read.
#[derive(Clone, Debug, ClapArgs)]
pub struct Reading {
    /// Replace a value of the scene, such as `materials.glass.ior=1.33`; may be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// The frame of an animated scene, from 1; the first if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub frame: Option<u32>,
    /// Let the scene read the files of this folder too, beside those of its own folder or project; may be
    /// given several times
    #[arg(long, value_name = "FOLDER")]
    pub allow: Vec<PathBuf>,
    /// Format of a scene that comes from standard input
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub scene_format: Option<SceneFormat>,
}

#[derive(Debug, ClapArgs)]
pub struct CheckArgs {
    /// Scenes, .ron or .toml; `-` reads one from standard input
    #[arg(required = true)]
    pub scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: Reading,
    /// `text` goes to standard error, `json` to standard output
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t)]
    pub format: CheckFormat,
}

#[derive(Debug, ClapArgs)]
pub struct ConvertArgs {
    /// The scene to read; `-` is standard input
    pub input: PathBuf,
    /// The file to write, .ron or .toml; `-` is standard output
    pub output: PathBuf,
    #[command(flatten)]
    pub reading: Reading,
    /// Format to write; needed for standard output, else it follows from the file's name
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub to: Option<SceneFormat>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ColorChoice {
    #[default]
    Auto,
    Always,
    Never,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ImageFormat {
    #[default]
    Exr,
    Png,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SceneFormat {
    Ron,
    Toml,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum CheckFormat {
    #[default]
    Text,
    Json,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ProgressChoice {
    #[default]
    Auto,
    /// One line that is drawn over
    Bar,
    /// A line every 10 % or 30 seconds
    Plain,
    None,
    /// One JSON object a line
    Json,
    /// On standard output, for Open Job Description
    Openjd,
}

impl From<SceneFormat> for terrarium::description::Format {
    fn from(format: SceneFormat) -> Self {
        match format {
            SceneFormat::Ron => terrarium::description::Format::Ron,
            SceneFormat::Toml => terrarium::description::Format::Toml,
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_arguments_are_well_formed() {
        use clap::CommandFactory;
        super::Args::command().debug_assert();
    }
}
