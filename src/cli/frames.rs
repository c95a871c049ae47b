//! Several frames of an animation: into files of which names, and what is said when some of them fail.

use super::args::{Reading, RenderArgs};
use super::check::load;
use super::exit::{Failure, STOPPED, USAGE};
use super::frame_args::Frames;
use super::machine;
use super::report::Terminal;
use std::path::{Path, PathBuf};
use terrarium::description::Unread;

/// The frames to be rendered; none stands for a scene without its frame named.
///
/// # Errors
/// Several frames would be one file; a frame that the scene's animation does not have.
pub fn asked(args: &RenderArgs) -> Result<Vec<Option<u32>>, Failure> {
    let Some(Frames(frames)) = &args.several.frames else { return Ok(vec![args.reading.frame]) };
    let step = args.several.frame_step.unwrap_or(1) as usize;
    let frames: Vec<Option<u32>> = frames.iter().copied().step_by(step).map(Some).collect();
    if frames.len() > 1 {
        let side = args.stats.iter().chain(&args.depfile);
        for path in args.output.iter().chain(side) {
            if named(path, 1) == *path {
                let (name, hint) = (path.display(), hint(path));
                let message = format!("{name}: several frames need a number in the name, such as {hint}");
                return Err(Failure::new(USAGE, message));
            }
        }
        if args.scene == Path::new("-") {
            return Err(Failure::new(USAGE, "several frames need a scene that can be read several times"));
        }
        refuse_missing(args, frames.iter().flatten().copied().max().unwrap_or(1))?;
    }
    Ok(frames)
}

/// A frame that is not there is no reason to render those before it.
fn refuse_missing(args: &RenderArgs, last: u32) -> Result<(), Failure> {
    let reading = Reading { frame: None, ..args.reading.clone() };
    let Ok(loaded) = load(&args.scene, &reading, Unread::default())? else { return Ok(()) };
    match loaded.animation {
        Some(animation) if last > animation.frames => Err(Failure::new(
            USAGE,
            format!("there is no frame {last}: the scene's are numbered from 1 to {}", animation.frames),
        )),
        _ => Ok(()),
    }
}

/// The call that renders one frame.
fn one(args: &RenderArgs, frame: Option<u32>) -> RenderArgs {
    let mut args = args.clone();
    args.several.frames = None;
    args.reading.frame = frame;
    if let Some(frame) = frame {
        for path in args.output.iter_mut().chain(&mut args.stats).chain(&mut args.depfile) {
            *path = named(path, frame);
        }
    }
    args
}

/// A file's name with the frame in the place of `####` or `%04d`, whichever comes first.
pub fn named(path: &Path, frame: u32) -> PathBuf {
    let Some(name) = path.file_name().and_then(|name| name.to_str()) else { return path.to_owned() };
    let Some((before, width, after)) = place(name) else { return path.to_owned() };
    path.with_file_name(format!("{before}{frame:0width$}{after}"))
}

/// What stands before the number, how many digits it has at least, and what stands behind it.
fn place(name: &str) -> Option<(&str, usize, &str)> {
    let digits = |(at, _): (usize, &str)| {
        let rest = &name[at + 1..];
        let end = rest.find(|c: char| !c.is_ascii_digit())?;
        let width = if end == 0 { 1 } else { rest[..end].parse::<usize>().ok()?.clamp(1, 9) };
        Some((at, width, rest[end..].strip_prefix('d')?))
    };
    let percent = name.match_indices('%').find_map(digits);
    let hash = name.find('#').map(|at| {
        let after = name[at..].trim_start_matches('#');
        (at, (name.len() - at - after.len()).min(9), after)
    });
    let (at, width, after) = [percent, hash].into_iter().flatten().min_by_key(|(at, ..)| *at)?;
    Some((&name[..at], width, after))
}

/// The name as it could be.
fn hint(path: &Path) -> String {
    let (stem, ending) = (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let name = match path {
        path if path == Path::new("-") => "frame_####.exr".to_owned(),
        _ => format!("{}_####.{}", stem.to_string_lossy(), ending.to_string_lossy()),
    };
    path.with_file_name(name).display().to_string()
}

/// Renders every frame, whatever becomes of the others, and tells in the end which failed.
pub fn each(
    args: &RenderArgs,
    frames: &[Option<u32>],
    terminal: &Terminal,
    mut render: impl FnMut(&RenderArgs, Place) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let of = frames.len();
    let mut failed: Vec<(u32, u8)> = Vec::new();
    let mut first = String::new();
    for (index, &frame) in frames.iter().enumerate() {
        let outcome = render(&one(args, frame), Place { frame, index, of });
        let Err(failure) = outcome else { continue };
        if of == 1 || failure.code == STOPPED {
            return Err(failure);
        }
        let frame = frame.unwrap_or_default();
        machine::failed(args.progress, &failure, Place { frame: Some(frame), ..Place::default() }, terminal);
        if failed.is_empty() {
            first = failure.reason();
        }
        if !failure.message.is_empty() {
            terminal.error(&format!("frame {frame}: {}", failure.message));
        }
        failed.push((frame, failure.code));
    }
    // the gravest: what is wrong with a scene before what is wrong with a file
    let Some(code) = failed.iter().map(|(_, code)| *code).min() else { return Ok(()) };
    let list: Vec<String> = failed.iter().map(|(frame, _)| frame.to_string()).collect();
    let message = format!("{} of {of} frames failed: {}", list.len(), list.join(", "));
    Err(Failure {
        said: Some(format!("{message}; the first of them: {first}")),
        ..Failure::new(code, message)
    })
}

/// Where a frame stands among those that were asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Its number; none where no frame was asked for.
    pub frame: Option<u32>,
    /// How many were before it.
    pub index: usize,
    /// How many there are.
    pub of: usize,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_their_places_in_names() {
        for (name, expected) in [
            ("out/####.exr", "out/0007.exr"),
            ("out/a_%04d.png", "out/a_0007.png"),
            ("%d.png", "7.png"),
            ("a#.png", "a7.png"),
            ("%%04d.png", "%0007.png"),
            ("100%_#.png", "100%_7.png"),
            ("##_%04d.png", "07_%04d.png"),
            ("plain.png", "plain.png"),
            ("##/plain.png", "##/plain.png"),
        ] {
            assert_eq!(named(Path::new(name), 7), Path::new(expected), "{name}");
        }
        assert_eq!(named(Path::new("##.exr"), 12345), Path::new("12345.exr"));
    }
}
