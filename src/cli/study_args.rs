//! The arguments of `study`, as typed.

use super::args::{Effects, ProgressChoice, Reading, seconds};
use clap::Args as ClapArgs;
use std::path::PathBuf;
use terrarium::measure::study::{Asked, Knob};
use terrarium::render::Options;

pub const STUDY_EXAMPLES: &str = "\
Examples:
  terrarium study scene.ron -o study
  terrarium study scene.ron -o study --knobs passes,photons --time 30min --seeds 5
  terrarium study scene.ron -o study --reference truth.exr
  terrarium study scene.ron -o study --set image.width=320 --set image.height=180

The same call again goes on where a study was broken off. Open study/index.html in a browser.

Exit codes: 0 done; 1 a render failed; 2 the scene is invalid or the call is wrong; 3 a file
can't be read; 4 the folder can't be written.";

#[derive(Debug, ClapArgs)]
pub struct StudyArgs {
    /// The scene, .ron or .toml; `-` reads it from standard input
    pub scene: PathBuf,
    /// The folder to write; it is made where there is none
    #[arg(short, long, value_name = "FOLDER")]
    pub output: PathBuf,
    /// An EXR file that is taken for the truth; rendered first if not given, by half of the time
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,
    /// Renders of each setting, with different seeds
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=100))]
    pub seeds: u32,
    /// What to turn: passes, photons, k, antialiasing, threshold, depth, shadow_rays, mesh; all if not given
    #[arg(long, value_name = "KNOB,…", value_delimiter = ',')]
    pub knobs: Vec<Knob>,
    /// Rungs of the ladder of passes: 1, 2, 4 …; as many as the time allows if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=20))]
    pub ladder: Option<u32>,
    /// Wall time of the whole study, about: `90`, `60s`, `5min`, `1h`
    #[arg(long, value_name = "TIME", value_parser = seconds, default_value = "10min")]
    pub time: f64,
    /// Seed of the first render of each setting; the scene's if not given
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub effects: Effects,
    /// Threads; as many as the machine runs at once if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print the study as JSON to standard output
    #[arg(long)]
    pub json: bool,
    /// How to show progress; `auto` is a bar on a terminal and plain lines elsewhere
    #[arg(long, value_enum, value_name = "HOW", default_value_t)]
    pub progress: ProgressChoice,
    /// Print only warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl StudyArgs {
    pub fn asked(&self) -> Asked {
        let mut knobs = if self.knobs.is_empty() { Knob::ALL.to_vec() } else { self.knobs.clone() };
        knobs.sort_unstable();
        knobs.dedup();
        Asked {
            knobs,
            seeds: self.seeds,
            ladder: self.ladder,
            seconds: self.time,
            reference: self.reference.as_ref().map(|path| path.display().to_string()),
        }
    }

    pub fn options(&self) -> Options {
        Options { seed: self.seed, overrides: self.effects.overrides(), ..Options::default() }
    }
}
