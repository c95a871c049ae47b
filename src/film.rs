//! The film: tiles become the layers of an image.

mod accuracy;
mod brightness;

use crate::trace::{LUMINANCE, Layer, Layers, Measured, Probe, Resting, Tile};
pub use accuracy::{Accuracy, BIAS_RATE, Part};
use brightness::Brightness;

/// All tiles of an image.
#[derive(Clone, Debug)]
pub struct Film {
    pub width: u32,
    pub height: u32,
    pub tiles: Vec<Tile>,
}

impl Film {
    /// An empty film in square tiles of `tile` pixels, in rows from the top left.
    pub fn new(width: u32, height: u32, tile: u32, layers: Layers) -> Film {
        let tile = tile.max(1);
        let starts = |end: u32| (0..end).step_by(tile as usize);
        let tiles = starts(height)
            .flat_map(|y| starts(width).map(move |x| (x, y)))
            .map(|(x, y)| Tile::new(x, y, tile.min(width - x), tile.min(height - y), layers))
            .collect();
        Film { width, height, tiles }
    }

    /// The channels of a layer, each row by row from the top, as single-precision numbers.
    pub fn channels(&self, layer: Layer) -> Vec<Vec<f32>> {
        let n = self.width as usize * self.height as usize;
        let count = match layer {
            Layer::Depth | Layer::Object | Layer::Samples | Layer::Edges | Layer::PhotonDensity => 1,
            _ => 3,
        };
        let mut channels = vec![vec![0.0; n]; count];
        let most = self.tiles.iter().flat_map(Tile::samples_per_pass).fold(1.0, f64::max);
        for tile in &self.tiles {
            for (x, y) in tile.pixels() {
                let at = y as usize * self.width as usize + x as usize;
                let value = tile.value(x, y, layer, most);
                for (channel, v) in channels.iter_mut().zip(value.to_array()) {
                    channel[at] = v as f32;
                }
            }
        }
        channels
    }

    /// Samples over all pixels and passes.
    pub fn samples(&self) -> u64 {
        self.tiles.iter().map(Tile::samples).sum()
    }

    /// How far it still is from the truth; `None` where that is unknown.
    pub fn accuracy(&self) -> Option<Accuracy> {
        Accuracy::of(self.measured(), self.probes(), &self.brightness())
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
        let mut values = vec![0.0; self.width as usize * self.height as usize];
        for tile in &self.tiles {
            for (x, y) in tile.pixels() {
                let value = tile.value(x, y, Layer::Radiance, 1.0).dot(LUMINANCE);
                values[y as usize * self.width as usize + x as usize] = value as f32;
            }
        }
        Brightness { width: self.width, height: self.height, values }
    }

    pub fn memory_bytes(&self) -> usize {
        self.tiles.iter().map(Tile::memory_bytes).sum()
    }
}
