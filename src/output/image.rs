//! The finished image: named layers of 32-bit float channels, in memory.
//!
//! Linear Rec. 709 radiance for colours, metres for positions and depth, counts for samples. No
//! file format is known here; the writers beside this file decide how a layer's name is spelt.

/// A finished image: every channel holds `width · height` values, rows from top to bottom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    pub width: usize,
    pub height: usize,
    /// Where it lies in a larger picture, if it is a part of one.
    pub within: Option<Within>,
    pub layers: Vec<Layer>,
}

/// The place of a part of a picture, in pixels from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Within {
    pub x: usize,
    pub y: usize,
    /// Of the whole picture.
    pub width: usize,
    pub height: usize,
}

/// Channels that belong together. The picture itself has the empty name and the channels R, G, B;
/// others are `albedo` (R, G, B), `normal` (X, Y, Z), `depth` (Z), `samples` (Y) and so on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layer {
    pub name: String,
    pub channels: Vec<(String, Vec<f32>)>,
}

impl Image {
    /// An image without layers.
    pub fn new(width: usize, height: usize) -> Self {
        Image { width, height, within: None, layers: Vec::new() }
    }

    /// Adds a layer from interleaved pixels, one array of `N` values a pixel.
    ///
    /// `channels` names the values in their order. `pixels` holds `width · height` entries.
    pub fn add<const N: usize>(&mut self, name: &str, channels: [&str; N], pixels: &[[f32; N]]) {
        let channels = channels
            .iter()
            .enumerate()
            .map(|(c, channel)| (channel.to_string(), pixels.iter().map(|pixel| pixel[c]).collect()))
            .collect();
        self.layers.push(Layer { name: name.to_string(), channels });
    }

    /// The picture itself: the layer with the empty name.
    pub fn beauty(&self) -> Option<&Layer> {
        self.layer("")
    }

    pub fn layer(&self, name: &str) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.name == name)
    }

    /// What is wrong with the image's form, if anything: a size of zero, no layer, a channel of
    /// another size, or a channel that is there twice.
    pub fn defect(&self) -> Option<String> {
        if self.width == 0 || self.height == 0 {
            return Some(format!("an image of {} × {} pixels", self.width, self.height));
        }
        if let Some(whole) = self.within
            && (whole.x + self.width > whole.width || whole.y + self.height > whole.height)
        {
            return Some(format!("a part that reaches beyond its {} × {} pixels", whole.width, whole.height));
        }
        if self.layers.iter().all(|layer| layer.channels.is_empty()) {
            return Some("an image without channels".to_string());
        }
        let mut seen = Vec::new();
        for layer in &self.layers {
            for (channel, values) in &layer.channels {
                if Some(values.len()) != self.width.checked_mul(self.height) {
                    return Some(format!(
                        "channel {channel} of layer `{}` holds {} values for {} × {} pixels",
                        layer.name,
                        values.len(),
                        self.width,
                        self.height
                    ));
                }
                if seen.contains(&(&layer.name, channel)) {
                    return Some(format!("channel {channel} of layer `{}` is there twice", layer.name));
                }
                seen.push((&layer.name, channel));
            }
        }
        None
    }
}

impl Layer {
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|(n, _)| n == name).map(|(_, values)| values.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interleaved_pixels_are_found_again_by_channel() {
        let mut image = Image::new(2, 1);
        image.add("", ["R", "G", "B"], &[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(image.defect(), None);
        assert_eq!(image.beauty().and_then(|layer| layer.channel("G")), Some([2.0, 5.0].as_slice()));
    }

    #[test]
    fn every_malformed_image_is_named() {
        assert!(Image::new(0, 3).defect().is_some_and(|d| d.contains("0 × 3")));
        assert!(Image::new(1, 1).defect().is_some_and(|d| d.contains("without channels")));
        let mut short = Image::new(2, 2);
        short.add("", ["Y"], &[[1.0]; 3]);
        assert!(short.defect().is_some_and(|d| d.contains("holds 3 values")));
        let mut twice = Image::new(1, 1);
        twice.add("depth", ["Z"], &[[1.0]]);
        twice.add("depth", ["Z"], &[[1.0]]);
        assert!(twice.defect().is_some_and(|d| d.contains("twice")));
    }
}
