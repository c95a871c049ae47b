//! Makes the project's assets from fixed seeds: meshes, textures and a sky.
//!
//! `cargo run --release --example assets -- [--out assets] [--check]`
//!
//! **The glass that the landscape is made for.** A regular dodecahedron of circumradius 1 about
//! the origin, standing on a face whose outward normal is −y (inradius 0.794654, so the table is
//! at y = −0.794654), turned about y so that one vertex of the bottom face points toward +z. The
//! cavity is the same solid scaled by 0.96. Everything of the landscape is in that space; a scene
//! scales glass and landscape together.
//!
//! Every value comes from integer hashes (`random.rs`), IEEE-exact arithmetic and `libm`, so that
//! the files have the same bytes on every machine; `tests/assets.rs` holds the program to that.
#![forbid(unsafe_code)]

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

#[path = "generator.rs"]
mod generator;

/// Make the assets, or check that the committed ones are what this program makes.
#[derive(Parser)]
struct Arguments {
    /// The folder to write to, or to check.
    #[arg(long, default_value = "assets")]
    out: PathBuf,
    /// Write nothing; fail when a file is missing or differs.
    #[arg(long)]
    check: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let assets = generator::assets();
    if arguments.check {
        let differences = generator::differences(&assets, &arguments.out);
        for difference in &differences {
            eprintln!("{difference}");
        }
        return if differences.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    for asset in &assets {
        println!("{:>9}  {}", asset.bytes.len(), asset.path);
    }
    match generator::write(&assets, &arguments.out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("cannot write to {}: {error}", arguments.out.display());
            ExitCode::FAILURE
        }
    }
}
