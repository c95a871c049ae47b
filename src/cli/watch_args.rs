//! The arguments of `watch`, as typed.

use super::args::{Reading, Work};
use clap::Args as ClapArgs;
use std::path::PathBuf;

pub const WATCH_EXAMPLES: &str = "\
Examples:
  terrarium watch scene.ron --set image.width=320 --set image.height=180
  terrarium watch scene.ron --display-server localhost:14158

The picture is drawn in the terminal, where standard output is one that shows 24-bit colour.";

#[derive(Debug, ClapArgs)]
pub struct WatchArgs {
    /// The scene, .ron or .toml
    pub scene: PathBuf,
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub work: Work,
    /// Show the picture in a viewer that speaks tev's protocol too
    #[arg(long, value_name = "HOST:PORT")]
    pub display_server: Option<String>,
    /// End after so many finished renders
    #[arg(long, value_name = "N")]
    pub renders: Option<u32>,
}
