//! Images compared: metrics against closed forms and independent programs, files of other programs, and
//! `terrarium diff` as its caller sees it.

mod closed_forms;
mod files;
mod independent;
mod program;

use exr::prelude as e;
use terrarium::measure::read::{Channel, FileImage, FileLayer, Kind, Samples};
use terrarium::measure::{Comparison, LayerDifference, Settings, compare_files};

/// A picture of interleaved colours.
pub fn picture(width: usize, pixels: &[[f32; 3]]) -> FileImage {
    let channels = ["R", "G", "B"].into_iter().enumerate().map(|(c, name)| Channel {
        name: name.to_owned(),
        samples: Samples::F32(pixels.iter().map(|pixel| pixel[c]).collect()),
    });
    let layer = FileLayer { name: String::new(), kind: Kind::Colour, channels: channels.collect() };
    FileImage { width, height: pixels.len() / width, layers: vec![layer], ..FileImage::default() }
}

pub fn compared(image: &FileImage, reference: &FileImage, settings: &Settings) -> Comparison {
    compare_files(image, reference, settings).expect("images of one size with layers in common")
}

/// The first layer of two pictures, with all metrics, not exposed.
pub fn first(width: usize, image: &[[f32; 3]], reference: &[[f32; 3]]) -> LayerDifference {
    let settings = Settings { exposure_ev: Some(0.0), ..Settings::default() };
    compared(&picture(width, image), &picture(width, reference), &settings).layers.remove(0)
}

#[track_caller]
pub fn near(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} instead of {expected}");
}

/// How an EXR file is written.
pub struct Exr {
    pub size: (usize, usize),
    /// Of the data window's corner from the display window's.
    pub offset: (i32, i32),
    pub shown: (usize, usize),
    pub compression: e::Compression,
    pub blocks: e::Blocks,
    pub name: Option<&'static str>,
    pub channels: Vec<(&'static str, e::FlatSamples)>,
}

impl Exr {
    pub fn new(size: (usize, usize), channels: Vec<(&'static str, e::FlatSamples)>) -> Self {
        let compression = e::Compression::ZIP16;
        let blocks = e::Blocks::ScanLines;
        Exr { size, offset: (0, 0), shown: size, compression, blocks, name: None, channels }
    }

    fn layer(self) -> e::Layer<e::AnyChannels<e::FlatSamples>> {
        let mut attributes =
            e::LayerAttributes { layer_name: self.name.map(e::Text::from), ..Default::default() };
        // a display window that does not begin at 0, as crops have it
        attributes.layer_position = e::Vec2(self.offset.0 + 5, self.offset.1 - 3);
        let encoding = e::Encoding {
            compression: self.compression,
            blocks: self.blocks,
            line_order: e::LineOrder::Increasing,
        };
        let channels = self.channels.into_iter().map(|(name, samples)| e::AnyChannel::new(name, samples));
        e::Layer::new(self.size, attributes, encoding, e::AnyChannels::sort(channels.collect()))
    }
}

/// The bytes of an EXR file with these parts.
pub fn exr_file(parts: Vec<Exr>) -> Vec<u8> {
    use e::WritableImage;
    let shown = parts[0].shown;
    let window = e::IntegerBounds::new((5, -3), shown);
    let layers: e::Layers<e::AnyChannels<e::FlatSamples>> = parts.into_iter().map(Exr::layer).collect();
    let image = e::Image::from_layers(e::ImageAttributes::new(window), layers);
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).expect("written to memory");
    bytes.into_inner()
}
