//! `convert`: a scene in the other format. What it includes and the paths that it names stay as
//! written; values are typed but not checked, so that a file that is only included converts too.

use super::args::ConvertArgs;
use super::check::{refused, standard_input};
use super::exit::{FAILED, Failure, USAGE};
use super::report::{self, Terminal};
use std::path::Path;
use terrarium::{description, output};

pub fn run(args: &ConvertArgs, terminal: &Terminal) -> Result<(), Failure> {
    let to_stdout = args.output == Path::new("-");
    let format = args
        .to
        .map(description::Format::from)
        .or_else(|| description::Format::from_path(&args.output))
        .ok_or_else(|| {
            let reason = if to_stdout {
                "standard output has no name that ends in .ron or .toml: give --to ron or --to toml"
                    .to_string()
            } else {
                format!("{}: a scene's name ends in .ron or .toml", args.output.display())
            };
            Failure::new(USAGE, reason)
        })?;
    if args.reading.frame.is_some() {
        return Err(Failure::new(USAGE, "a scene is converted with all of its frames: leave out --frame"));
    }
    let set = &args.reading.set;
    let scene = if args.input == Path::new("-") {
        let (text, from) = standard_input(&args.reading)?;
        description::load_str_as_written(&text, from, set)
    } else {
        description::load_as_written(&args.input, set)
    };
    let scene = scene.map_err(|report| refused(&report, terminal))?;
    let text = description::to_string(&scene, format).map_err(|error| {
        Failure::new(FAILED, format!("can't write {} in this format: {error}", args.input.display()))
    })?;
    if to_stdout {
        return report::print(&text);
    }
    let name = args.output.display().to_string();
    output::atomic::write(&args.output, text.as_bytes()).map_err(|error| Failure::writing(&name, error))?;
    let folder = |path: &Path| path.parent().and_then(|folder| std::path::absolute(folder).ok());
    let elsewhere = args.input != Path::new("-") && folder(&args.input) != folder(&args.output);
    if elsewhere && scene.names_files() {
        terminal.warning(&format!(
            "paths in {name} are still relative to the folder of {}",
            args.input.display()
        ));
    }
    Ok(())
}
