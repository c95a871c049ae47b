//! Arguments of a replay, as typed.

use clap::Args as ClapArgs;

/// One pixel of one pass instead of an image.
#[derive(Clone, Debug, ClapArgs)]
pub struct ReplayArgs {
    /// Instead of rendering, trace one pixel of one pass again and print all that its paths met. The pixel is
    /// counted from 0, from the top left
    #[arg(long, value_name = "X,Y", value_parser = pixel,
          conflicts_with_all = ["output", "stats", "depfile", "stamp", "passes"])]
    pub pixel: Option<[u32; 2]>,
    /// The pass that --pixel is of
    #[arg(long, value_name = "N", default_value_t, requires = "pixel", conflicts_with = "output")]
    pub pass: u32,
    /// Print what --pixel finds as JSON
    #[arg(long, requires = "pixel", conflicts_with = "output")]
    pub json: bool,
}

/// A column and a row.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let number = |part: &str| part.trim().parse::<u32>().ok();
    let found = text.split_once(',').and_then(|(x, y)| Some([number(x)?, number(y)?]));
    found.ok_or_else(|| format!("`{text}` is no pixel: 120,45"))
}
