//! `--frames`: which frames of an animation are rendered, into files of which names, and what is said
//! when some of them fail.

use super::args::{Reading, RenderArgs};
use super::check::load;
use super::exit::{Failure, USAGE};
use super::report::Terminal;
use std::path::{Path, PathBuf};
use terrarium::description::Unread;

/// Frames in the order in which they were asked for, each once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames(Vec<u32>);

/// More are not asked for at once.
const MOST: usize = 1_000_000;

impl std::str::FromStr for Frames {
    type Err = String;

    /// `7`, `1-48`, `1-48:2`, and several of these with commas between.
    fn from_str(text: &str) -> Result<Frames, String> {
        let mut frames = Vec::new();
        for part in text.split(',') {
            let number = |text: &str| {
                let found = text.trim().parse::<u32>().ok().filter(|n| *n >= 1);
                found.ok_or_else(|| format!("`{part}` is neither a frame (7) nor frames (1-48, 1-48:2)"))
            };
            let (range, step) = match part.split_once(':') {
                Some((range, step)) => (range, number(step)?),
                None => (part, 1),
            };
            let (first, last) = match range.split_once('-') {
                Some((first, last)) => (number(first)?, number(last)?),
                None => (number(range)?, number(range)?),
            };
            if first > last {
                return Err(format!("`{part}`: the first frame is behind the last"));
            }
            if frames.len() + ((last - first) / step) as usize >= MOST {
                return Err(format!("more than {MOST} frames"));
            }
            frames.extend((first..=last).step_by(step as usize));
        }
        let mut seen = std::collections::HashSet::new();
        frames.retain(|frame| seen.insert(*frame));
        Ok(Frames(frames))
    }
}

/// The calls that render one frame each.
///
/// # Errors
/// Several frames would be one file; a frame that the scene's animation does not have.
pub fn split(args: &RenderArgs) -> Result<Vec<RenderArgs>, Failure> {
    let frames = match (&args.frames, args.reading.frame) {
        (Some(Frames(frames)), _) => {
            let step = args.frame_step.unwrap_or(1) as usize;
            frames.iter().copied().step_by(step).collect()
        }
        (None, Some(frame)) => vec![frame],
        (None, None) => return Ok(vec![args.clone()]),
    };
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
        refuse_missing(args, frames.iter().copied().max().unwrap_or(1))?;
    }
    Ok(frames.into_iter().map(|frame| one(args, frame)).collect())
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

fn one(args: &RenderArgs, frame: u32) -> RenderArgs {
    let mut args = args.clone();
    args.frames = None;
    args.reading.frame = Some(frame);
    for path in args.output.iter_mut().chain(&mut args.stats).chain(&mut args.depfile) {
        *path = named(path, frame);
    }
    args
}

/// A file's name with the frame in the place of `####` or `%04d`, whichever comes first.
fn named(path: &Path, frame: u32) -> PathBuf {
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
    calls: &[RenderArgs],
    terminal: &Terminal,
    mut render: impl FnMut(&RenderArgs, Place) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let of = calls.len();
    let mut failed: Vec<(u32, u8)> = Vec::new();
    for (index, call) in calls.iter().enumerate() {
        let frame = call.reading.frame;
        let outcome = render(call, Place { frame, index, of });
        let Err(failure) = outcome else { continue };
        if of == 1 || failure.code == STOPPED {
            return Err(failure);
        }
        let frame = frame.unwrap_or_default();
        if !failure.message.is_empty() {
            terminal.error(&format!("frame {frame}: {}", failure.message));
        }
        failed.push((frame, failure.code));
    }
    // the gravest: what is wrong with a scene before what is wrong with a file
    let Some(code) = failed.iter().map(|(_, code)| *code).min() else { return Ok(()) };
    let list: Vec<String> = failed.iter().map(|(frame, _)| frame.to_string()).collect();
    let message = format!("{} of {of} frames failed: {}", list.len(), list.join(", "));
    Err(Failure::new(code, message))
}

/// The exit code of a render that was told to stop: there is no next frame then.
const STOPPED: u8 = 6;

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
    fn frames_are_read_as_render_farms_write_them() {
        let frames = |text: &str| text.parse::<Frames>().map(|Frames(frames)| frames).ok();
        assert_eq!(frames("7"), Some(vec![7]));
        assert_eq!(frames("0-0"), None);
        assert_eq!(frames("1-5"), Some(vec![1, 2, 3, 4, 5]));
        assert_eq!(frames("1-6:2"), Some(vec![1, 3, 5]));
        assert_eq!(frames("1-3,5, 7-20:6,2"), Some(vec![1, 2, 3, 5, 7, 13, 19]));
        for wrong in ["", "a", "3-1", "1-", "1-4:0", "-3", "1,,2", "1-4000000000", "1.5"] {
            assert_eq!(frames(wrong), None, "{wrong}");
        }
    }

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
