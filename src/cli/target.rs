//! Where the images go: named files, each once, and standard output.

use super::args::{ImageFormat, ProgressChoice, RenderArgs};
use super::exit::{Failure, USAGE};
use std::io::{self, Cursor, IsTerminal, Write};
use std::path::{Path, PathBuf};
use terrarium::output::{self, Format, Image, PngSettings, Provenance, Written, atomic};

/// One image to write.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    File(PathBuf, Format),
    Stdout(Format),
}

/// An image that is written but does not have its name yet.
pub enum Staged {
    File(atomic::Pending, PathBuf),
    Stdout(Vec<u8>),
}

/// The outputs that were asked for; refuses formats unknown, paths given twice, and a terminal.
pub fn targets(args: &RenderArgs) -> Result<Vec<Target>, Failure> {
    let targets = targets_of(&args.output, args.format)?;
    let shown = targets.iter().any(|target| matches!(target, Target::Stdout(_)));
    let stats = args.stats.as_deref() == Some(Path::new("-"));
    if shown && stats {
        return Err(Failure::new(USAGE, "the image and the statistics can't both go to standard output"));
    }
    if (shown || stats) && args.progress == ProgressChoice::Openjd {
        return Err(Failure::new(USAGE, "OpenJD's progress goes to standard output, and nothing else can"));
    }
    let holds_layers =
        |target: &Target| matches!(target, Target::File(_, Format::Exr) | Target::Stdout(Format::Exr));
    if !args.work.aov.is_empty() && !targets.iter().any(holds_layers) {
        return Err(Failure::new(
            USAGE,
            "--aov asks for layers, and only EXR files have any: add `-o <name>.exr`",
        ));
    }
    Ok(targets)
}

/// The same of any command.
pub fn targets_of(outputs: &[PathBuf], format: ImageFormat) -> Result<Vec<Target>, Failure> {
    let mut targets: Vec<Target> = Vec::new();
    for path in outputs {
        let target = if path == Path::new("-") {
            Target::Stdout(match format {
                ImageFormat::Exr => Format::Exr,
                ImageFormat::Png => Format::Png,
            })
        } else {
            let format = Format::from_path(path).ok_or_else(|| {
                let name = path.display();
                Failure::new(USAGE, format!("{name}: an image's name ends in .exr or .png"))
            })?;
            Target::File(path.clone(), format)
        };
        let same = |other: &Target| match (other, &target) {
            (Target::File(a, _), Target::File(b, _)) => same_file(a, b),
            (a, b) => matches!((a, b), (Target::Stdout(_), Target::Stdout(_))),
        };
        if targets.iter().any(same) {
            return Err(Failure::new(USAGE, format!("{} is given as an output twice", path.display())));
        }
        targets.push(target);
    }
    let shown = targets.iter().any(|target| matches!(target, Target::Stdout(_)));
    if shown && io::stdout().is_terminal() {
        return Err(Failure::new(USAGE, "standard output is a terminal, which can't show an image file"));
    }
    Ok(targets)
}

/// Whether both paths name the same place, as far as can be told.
pub fn same_file(a: &Path, b: &Path) -> bool {
    place(a) == place(b)
}

/// The path with its folder's links resolved.
fn place(path: &Path) -> PathBuf {
    if let Ok(place) = path.canonicalize() {
        return place;
    }
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    match (path.parent().and_then(|folder| folder.canonicalize().ok()), path.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => path,
    }
}

impl Target {
    /// As it was typed.
    pub fn name(&self) -> String {
        match self {
            Target::File(path, _) => path.display().to_string(),
            Target::Stdout(_) => "-".to_owned(),
        }
    }

    pub fn path(&self) -> Option<&Path> {
        match self {
            Target::File(path, _) => Some(path),
            Target::Stdout(_) => None,
        }
    }

    /// Writes the image, without giving it its name.
    pub fn stage(
        &self,
        image: &Image,
        provenance: &Provenance,
        settings: PngSettings,
    ) -> Result<(Staged, Written), Failure> {
        match self {
            Target::File(path, format) => {
                let name = path.display().to_string();
                let mut file =
                    atomic::Pending::create(path).map_err(|error| Failure::writing(&name, error))?;
                let written = format
                    .write(&mut file, image, provenance, settings)
                    .map_err(|error| Failure::image(&name, error))?;
                Ok((Staged::File(file, path.clone()), written))
            }
            Target::Stdout(format) => {
                let mut bytes = Cursor::new(Vec::new());
                let written = format
                    .write(&mut bytes, image, provenance, settings)
                    .map_err(|error| Failure::image("to standard output", error))?;
                Ok((Staged::Stdout(bytes.into_inner()), written))
            }
        }
    }
}

impl Staged {
    /// Gives the file its name, or sends the bytes.
    pub fn commit(self) -> Result<(), Failure> {
        match self {
            Staged::File(file, path) => {
                file.commit().map_err(|error| Failure::writing(&path.display().to_string(), error))
            }
            Staged::Stdout(bytes) => {
                let mut stdout = io::stdout().lock();
                stdout
                    .write_all(&bytes)
                    .and_then(|()| stdout.flush())
                    .map_err(|error| Failure::writing("to standard output", error))
            }
        }
    }
}

/// The image settings of a scene for PNG.
pub fn png_settings(image: &terrarium::description::Image) -> PngSettings {
    PngSettings {
        exposure_ev: image.exposure_ev,
        bits: if image.png_bits == 16 { output::Bits::Sixteen } else { output::Bits::Eight },
    }
}
