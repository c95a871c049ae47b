//! Arguments that divide a render, stop it and go on with it.

use super::engine;
use super::exit::{Failure, USAGE};
use super::ranges::numbers;
use clap::Args as ClapArgs;
use std::path::{Path, PathBuf};
use std::time::Duration;
use terrarium::film::Window;
use terrarium::plan::LONGEST;
use terrarium::render::{Checkpoint, Shards};

#[derive(Clone, Debug, ClapArgs)]
pub struct BatchArgs {
    /// Render one part of N, such as `2/8`, numbered from 0: a share of the passes, or of the tiles where there
    /// are fewer passes than parts. `auto` takes the number from the engine that started the program. What is
    /// written is a partial EXR for `terrarium merge`
    #[arg(long, value_name = "I/N", conflicts_with = "shards")]
    pub shard: Option<String>,
    /// Render several parts of those that --of says: `0-3`, `0-3,6`, `0-7:2`
    #[arg(long, value_name = "A-B,…", requires = "of")]
    pub shards: Option<String>,
    /// The number of parts, for --shards and `--shard auto`
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST)))]
    pub of: Option<u32>,
    /// Folder for partial images, named by scene and part
    #[arg(long, value_name = "FOLDER", conflicts_with = "output")]
    pub out_dir: Option<PathBuf>,
    /// Render these pixels alone, `x0,y0,x1,y1` from the top left, the last column and row not included
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = window)]
    pub crop: Option<Window>,
    /// How often to write down what has been traced, beside the first image as `….checkpoint`; `auto`: every 30
    /// seconds, less often where that would take more than 2 % of the time; `off`: never
    #[arg(long, value_name = "TIME", default_value = "auto", value_parser = interval)]
    pub checkpoint: Interval,
    /// Go on from the checkpoint, if there is one
    #[arg(long)]
    pub resume: bool,
}

/// Of checkpoints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interval {
    Never,
    Auto,
    Every(Duration),
}

/// Parts of a render at most.
const MOST: u32 = 1 << 20;

const AUTO: Duration = Duration::from_secs(30);

fn interval(text: &str) -> Result<Interval, String> {
    match text.trim() {
        "off" => Ok(Interval::Never),
        "auto" => Ok(Interval::Auto),
        _ => super::args::seconds(text).map(|s| Interval::Every(Duration::from_secs_f64(s.min(LONGEST)))),
    }
}

fn window(text: &str) -> Result<Window, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Window { x0, y0, x1, y1 }),
        Some([_, _, _, _]) => Err(format!("`{text}` holds no pixel: x0 < x1 and y0 < y1")),
        _ => Err(format!("`{text}` is no rectangle of pixels: x0,y0,x1,y1")),
    }
}

impl BatchArgs {
    /// The parts that are asked for.
    pub fn divided(&self) -> Result<Option<Shards>, Failure> {
        let wrong = |message: String| Failure::new(USAGE, message);
        if let (Some(list), Some(of)) = (&self.shards, self.of) {
            let numbers = parts(list).map_err(|error| wrong(format!("--shards {list}: {error}")))?;
            return Ok(Some(Shards { numbers, of }));
        }
        let Some(shard) = &self.shard else {
            if self.of.is_some() {
                return Err(wrong("--of goes with --shards or with `--shard auto`".to_owned()));
            }
            return Ok(None);
        };
        if shard == "auto" {
            let found = engine::find(self.of, |name| std::env::var(name).ok()).map_err(wrong)?;
            return Ok(Some(Shards { numbers: vec![found.index], of: found.of }));
        }
        let parsed =
            shard.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        match parsed {
            Some((_, of)) if self.of.is_some_and(|n| n != of) => Err(wrong(format!(
                "--shard {shard} is one of {of} parts, and --of says another number: leave it out"
            ))),
            Some((_, of)) if of > MOST => {
                Err(wrong(format!("--shard {shard}: a render has {MOST} parts at most")))
            }
            Some((number, of)) if number < of => Ok(Some(Shards { numbers: vec![number], of })),
            _ => Err(wrong(format!("--shard {shard}: a part is `2/8`, from 0/8 to 7/8, or `auto`"))),
        }
    }

    fn is_divided(&self) -> bool {
        self.shard.is_some() || self.shards.is_some()
    }

    /// The name of a partial image in --out-dir.
    pub fn name(&self, scene: &Path, frame: Option<u32>, shards: &Shards) -> String {
        let stem = scene.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy());
        let stem = if stem == "-" { "scene".into() } else { stem };
        let stem = frame.map_or(stem.to_string(), |frame| format!("{stem}.{frame:04}"));
        let of = shards.of;
        match shards.numbers[..] {
            [number] => format!("{stem}.shard-{number:04}-of-{of:04}.exr"),
            ref numbers => {
                let (first, last) = (numbers.first().unwrap_or(&0), numbers.last().unwrap_or(&0));
                let several = if numbers.len() as u32 == last - first + 1 { "" } else { "-some" };
                format!("{stem}.shards-{first:04}-{last:04}{several}-of-{of:04}.exr")
            }
        }
    }

    /// Checkpoints beside the first image that is a file. `skips`: a part that is there is not rendered again.
    pub fn checkpoints(&self, image: Option<&Path>, skips: bool) -> Result<Option<Checkpoint>, Failure> {
        let (every, sparing) = match self.checkpoint {
            Interval::Never => (None, false),
            Interval::Auto => (Some(AUTO), true),
            Interval::Every(time) => (Some(time), false),
        };
        let (Some(every), Some(image)) = (every, image) else {
            if self.resume {
                return Err(Failure::new(USAGE, "--resume needs checkpoints, and an image that is a file"));
            }
            return Ok(None);
        };
        let mut path = image.as_os_str().to_owned();
        path.push(".checkpoint");
        let part = (self.is_divided() && skips).then(|| image.to_path_buf());
        Ok(Some(Checkpoint { path: path.into(), every, sparing, resume: self.resume, part }))
    }
}

/// Parts, rising; none may be there twice.
fn parts(text: &str) -> Result<Vec<u32>, String> {
    let mut list = numbers(text, 0, MOST as usize)?;
    list.sort_unstable();
    match list.windows(2).find(|two| two[0] == two[1]) {
        Some(two) => Err(format!("{} is there twice", two[0])),
        None => Ok(list),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_in_order_and_there_once() {
        assert_eq!(parts("6,0-2"), Ok(vec![0, 1, 2, 6]));
        assert!(parts("0-3,2").is_err_and(|error| error.contains("2 is there twice")));
    }

    #[test]
    fn crops_hold_a_pixel() {
        assert_eq!(window("1,2,3,4"), Ok(Window { x0: 1, y0: 2, x1: 3, y1: 4 }));
        for wrong in ["", "1,2,3", "3,0,3,4", "0,4,1,4", "-1,0,1,1", "0,0,1,1,1"] {
            assert!(window(wrong).is_err(), "{wrong}");
        }
    }
}
