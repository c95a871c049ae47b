//! The film: tiles become the layers of an image.

mod accuracy;
mod brightness;
mod kept;
mod window;

use crate::math::DVec3;
use crate::trace::{LUMINANCE, Layer, Layers, Measured, Probe, Resting, Tile};
pub use accuracy::{Accuracy, Part, Rates};
use brightness::Brightness;
pub use kept::Mismatch;
use rayon::prelude::*;
pub use window::Window;

/// All tiles of an image, or of a part of it.
#[derive(Clone, Debug)]
pub struct Film {
    /// Of the whole image.
    pub width: u32,
    pub height: u32,
    /// The pixels that are there.
    pub window: Window,
    pub tiles: Vec<Tile>,
    /// How photons' noise and bias fall with passes.
    pub rates: Rates,
}

impl Film {
    /// An empty film in square tiles of `tile` pixels, in rows from the top left.
    pub fn new(width: u32, height: u32, tile: u32, layers: Layers) -> Film {
        Film::of(width, height, Window::all(width, height), tile, layers)
    }

    /// The same of a window of the image.
    pub fn of(width: u32, height: u32, window: Window, tile: u32, layers: Layers) -> Film {
        let tile = tile.max(1);
        let Window { x0, y0, x1, y1 } = window;
        let starts = |start: u32, end: u32| (start..end).step_by(tile as usize);
        let corners: Vec<[u32; 2]> =
            starts(y0, y1).flat_map(|y| starts(x0, x1).map(move |x| [x, y])).collect();
        // Memory that is touched for the first time takes the system's time: as much as the sums of a short pass.
        let tiles = corners
            .into_par_iter()
            .map(|[x, y]| Tile::new(x, y, tile.min(x1 - x), tile.min(y1 - y), layers))
            .collect();
        Film { width, height, window, tiles, rates: Rates::default() }
    }

    /// Leaves out the tiles whose number does not fulfil a condition.
    pub fn keep_tiles(&mut self, keep: impl Fn(usize) -> bool) {
        let mut number = 0..;
        self.tiles.retain(|_| number.next().is_some_and(&keep));
    }

    /// The channels of a layer, each row by row from the top of the window, as single-precision numbers.
    pub fn channels(&self, layer: Layer) -> Vec<Vec<f32>> {
        let n = self.window.pixels();
        let count = match layer {
            Layer::Depth | Layer::Object | Layer::Samples | Layer::Edges | Layer::PhotonDensity => 1,
            _ => 3,
        };
        let mut channels = vec![vec![0.0; n]; count];
        let most = match layer {
            Layer::Edges => self.tiles.iter().flat_map(Tile::samples_per_pass).fold(1.0, f64::max),
            _ => 1.0,
        };
        for tile in &self.tiles {
            match layer {
                Layer::Radiance => self.put(tile, &mut channels, |i| tile.mean(i)),
                _ => self.put(tile, &mut channels, |i| tile.value(i, layer, most)),
            }
        }
        channels
    }

    /// Puts the values of a tile's pixels into channels; they are told by the pixel's number in the tile.
    fn put(&self, tile: &Tile, channels: &mut [Vec<f32>], value: impl Fn(usize) -> DVec3) {
        let width = tile.width as usize;
        for (line, y) in (tile.y..tile.y + tile.height).enumerate() {
            let at = self.window.index(tile.x, y);
            for column in 0..width {
                let values = value(line * width + column).to_array();
                channels.iter_mut().zip(values).for_each(|(channel, v)| channel[at + column] = v as f32);
            }
        }
    }

    /// Samples over all pixels and passes.
    pub fn samples(&self) -> u64 {
        self.tiles.iter().map(Tile::samples).sum()
    }

    /// How far it still is from the truth; `None` where that is unknown.
    pub fn accuracy(&self) -> Option<Accuracy> {
        self.measured().next()?;
        Accuracy::of(self.measured(), self.probes(), &self.brightness(), self.rates)
    }

    /// The same where passes in between are missing: what is known of how well distributed they are does not
    /// hold, and they count as independent.
    pub fn accuracy_of_any_passes(&self) -> Option<Accuracy> {
        self.measured().next()?;
        Accuracy::of_independent(self.measured(), self.probes(), &self.brightness(), self.rates)
    }

    /// Passes of the pixels that have the most.
    pub fn most_passes(&self) -> u32 {
        self.tiles.iter().flat_map(Tile::passes).max().unwrap_or(0)
    }

    /// Lets those blocks of pixels rest whose own squared error is at most `enough`.
    pub fn rest(&self, accuracy: &Accuracy, enough: f64, resting: &mut Resting) {
        accuracy::done(self.measured(), self.probes(), &self.brightness(), accuracy.gain, enough, resting);
    }

    fn measured(&self) -> impl Iterator<Item = Measured> {
        self.tiles.iter().flat_map(Tile::measured)
    }

    fn probes(&self) -> impl Iterator<Item = &Probe> {
        self.tiles.iter().flat_map(Tile::probes)
    }

    fn brightness(&self) -> Brightness {
        let mut values = vec![0.0; self.window.pixels()];
        for tile in &self.tiles {
            for (i, (x, y)) in tile.pixels().enumerate() {
                values[self.window.index(x, y)] = tile.mean(i).dot(LUMINANCE) as f32;
            }
        }
        Brightness { window: self.window, values }
    }

    pub fn memory_bytes(&self) -> usize {
        self.tiles.iter().map(Tile::memory_bytes).sum()
    }
}
