//! The frames that are asked for, as typed.

use super::ranges::numbers;
use clap::Args as ClapArgs;

/// Which frames are rendered.
#[derive(Clone, Debug, ClapArgs)]
pub struct FrameArgs {
    /// Frames of an animated scene: `1-48`, `1-48:2` (every second), `1-3,7`. Each is a file of its own,
    /// with the number in the place of `####` or `%04d` in its name; those that are there are left
    #[arg(long, value_name = "FRAMES", conflicts_with = "frame")]
    pub frames: Option<Frames>,
    /// Only every so many of these frames, beginning with the first
    #[arg(long, value_name = "N", requires = "frames", value_parser = clap::value_parser!(u32).range(1..))]
    pub frame_step: Option<u32>,
    /// Render frames that are there already too
    #[arg(long)]
    pub again: bool,
}

/// Frames in the order in which they were asked for, each once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames(pub Vec<u32>);

/// More are not asked for at once.
const MOST: usize = 1_000_000;

impl std::str::FromStr for Frames {
    type Err = String;

    /// `7`, `1-48`, `1-48:2`, and several of these with commas between.
    fn from_str(text: &str) -> Result<Frames, String> {
        let mut frames = numbers(text, 1, MOST)?;
        let mut seen = std::collections::HashSet::new();
        frames.retain(|frame| seen.insert(*frame));
        Ok(Frames(frames))
    }
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
}
