//! Arguments of what puts parts of renders together, and has engines render them, as typed.

use super::args::{ImageFormat, Reading, Work};
use clap::{Args as ClapArgs, ValueEnum};
use std::path::PathBuf;

pub const FARM_EXAMPLES: &str = "\
Examples:
  terrarium farm scene.ron --engine slurm --shards 32 -o image.exr --folder job && sh job/terrarium-scene.submit.sh
  terrarium farm scene.ron --engine openjd --shards 8 -o image.exr --parts parts";

pub const MERGE_EXAMPLES: &str = "\
Examples:
  terrarium render scene.ron --shard 0/2 -o a.exr
  terrarium render scene.ron --shard 1/2 -o b.exr
  terrarium merge a.exr b.exr -o image.exr -o image.png
  terrarium merge parts/ -o image.exr --allow-missing";

#[derive(Debug, ClapArgs)]
pub struct MergeArgs {
    /// Partial images, or folders of them (files named *.shard*.exr)
    #[arg(required = true, value_name = "PART")]
    pub parts: Vec<PathBuf>,
    /// The image to write, .exr or .png; `-` is standard output; may be given several times
    #[arg(short, long, value_name = "FILE", required = true)]
    pub output: Vec<PathBuf>,
    /// Format of the image that goes to standard output
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t)]
    pub format: ImageFormat,
    /// Make the image of the parts that are there, and restate its error
    #[arg(long)]
    pub allow_missing: bool,
    /// Fail if rare events were too frequent in the parts together
    #[arg(long)]
    pub strict: bool,
    /// Print only warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub struct FarmArgs {
    /// The scene, .ron or .toml, at the same place on every machine
    pub scene: PathBuf,
    /// The engine that will render
    #[arg(long, value_enum, value_name = "ENGINE")]
    pub engine: Engine,
    /// Parts that the render is divided into
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub shards: u32,
    /// The image that the parts are merged to, .exr or .png; may be given several times
    #[arg(short, long, value_name = "FILE", required = true)]
    pub output: Vec<PathBuf>,
    /// Folder for the partial images, which all machines see
    #[arg(long, value_name = "FOLDER", default_value = "parts")]
    pub parts: PathBuf,
    /// Folder for the job files; the working directory if not given
    #[arg(long, value_name = "FOLDER")]
    pub folder: Option<PathBuf>,
    /// Processors of a part; 4 if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub cpus: Option<u32>,
    /// The program on the machines that render
    #[arg(long, value_name = "PROGRAM", default_value = "terrarium")]
    pub program: String,
    /// The container image, for Kubernetes
    #[arg(long, value_name = "IMAGE", default_value = "terrarium:latest")]
    pub image: String,
    #[command(flatten)]
    pub reading: Reading,
    #[command(flatten)]
    pub work: Work,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    Slurm,
    /// Open Job Description, of AWS Deadline Cloud
    Openjd,
    Kubernetes,
}
