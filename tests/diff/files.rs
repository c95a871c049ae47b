//! Image files as other programs write them.

use super::{Exr, compared, exr_file};
use exr::prelude::{Blocks, Compression, FlatSamples, Vec2, f16};
use terrarium::measure::Settings;
use terrarium::measure::read::{FileImage, Kind, ReadError, Samples, decode};

fn floats(values: impl IntoIterator<Item = f32>) -> FlatSamples {
    FlatSamples::F32(values.into_iter().collect())
}

/// Multiples of 1/8, which half floats hold exactly.
fn ramp(count: usize, from: usize) -> Vec<f32> {
    (0..count).map(|i| ((i * 37 + from * 11) % 129) as f32 / 8.0).collect()
}

fn rgb(count: usize) -> Vec<(&'static str, FlatSamples)> {
    ["R", "G", "B"].into_iter().enumerate().map(|(c, name)| (name, floats(ramp(count, c)))).collect()
}

fn read(parts: Vec<Exr>) -> FileImage {
    decode(&exr_file(parts)).expect("an EXR file")
}

fn plain() -> FileImage {
    read(vec![Exr::new((70, 40), rgb(2800))])
}

fn values(image: &FileImage, layer: &str, channel: usize) -> Vec<f32> {
    match &image.layer(layer).expect("the layer").channels[channel].samples {
        Samples::F32(values) => values.clone(),
        Samples::U32(values) => values.iter().map(|v| *v as f32).collect(),
    }
}

#[test]
fn colours_are_red_green_blue_whatever_their_order_in_the_file() {
    let image = plain();
    for c in 0..3 {
        assert_eq!(values(&image, "", c), ramp(2800, c));
    }
    assert_eq!((image.width, image.height, image.encoded), (70, 40, false));
    assert!(image.notes.is_empty());
}

#[test]
fn every_compression_half_floats_and_tiles_read_the_same() {
    let reference = plain();
    let all = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
    ];
    for compression in all {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 24))] {
            for half in [false, true] {
                let narrow = |samples: FlatSamples| match samples {
                    FlatSamples::F32(v) if half => {
                        FlatSamples::F16(v.into_iter().map(f16::from_f32).collect())
                    }
                    samples => samples,
                };
                let channels = rgb(2800).into_iter().map(|(name, v)| (name, narrow(v))).collect();
                let image = read(vec![Exr { compression, blocks, ..Exr::new((70, 40), channels) }]);
                let same = compared(&image, &reference, &Settings::default()).same;
                assert!(same, "{compression:?}, {blocks:?}, half: {half}");
            }
        }
    }
}

#[test]
fn alpha_and_depth_beside_the_picture_are_layers_of_data() {
    let mut channels = rgb(2800);
    channels.extend([("A", floats(vec![0.5; 2800])), ("Z", floats(ramp(2800, 7)))]);
    let image = read(vec![Exr::new((70, 40), channels)]);
    let found = compared(&image, &plain(), &Settings { fast: true, ..Settings::default() });
    assert!(found.layers.len() == 1 && found.layers[0].values.same);
    assert!(!found.same, "layers that only one image has are a difference");
    assert_eq!(found.only_in_image, ["A", "Z"]);
    assert_eq!(image.layer("A").map(|layer| layer.kind), Some(Kind::Data));
    let chosen = Settings { layers: vec!["picture".to_owned()], ..Settings::default() };
    assert!(compared(&image, &plain(), &chosen).same);
}

#[test]
fn pixels_outside_the_data_window_are_black_and_those_outside_the_display_window_do_not_count() {
    let crop = |size: (usize, usize), offset: (i32, i32)| {
        read(vec![Exr {
            offset,
            shown: (6, 5),
            ..Exr::new(size, vec![("Y", floats(ramp(size.0 * size.1, 0)))])
        }])
    };
    let smaller = crop((3, 2), (2, 1));
    assert_eq!((smaller.width, smaller.height, smaller.notes.len()), (6, 5, 1));
    let mut expected = vec![0.0; 30];
    for (i, value) in ramp(6, 0).into_iter().enumerate() {
        expected[(1 + i / 3) * 6 + 2 + i % 3] = value;
    }
    assert_eq!(values(&smaller, "", 0), expected);
    let larger = crop((8, 9), (-1, -2));
    let stored = ramp(72, 0);
    let expected: Vec<f32> = (0..30).map(|i| stored[(i / 6 + 2) * 8 + i % 6 + 1]).collect();
    assert_eq!(values(&larger, "", 0), expected);
}

#[test]
fn parts_and_groups_are_layers() {
    let named = |name, channels| Exr { name: Some(name), ..Exr::new((4, 2), channels) };
    let image = read(vec![
        named("rgb", rgb(8)),
        named(
            "glow",
            vec![
                ("glow.R", floats(ramp(8, 1))),
                ("glow.G", floats(ramp(8, 2))),
                ("glow.B", floats(ramp(8, 3))),
            ],
        ),
        named(
            "data",
            vec![("N.X", floats(ramp(8, 4))), ("N.Y", floats(ramp(8, 5))), ("N.Z", floats(ramp(8, 6)))],
        ),
    ]);
    let mut names: Vec<&str> = image.layers.iter().map(|layer| layer.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["data.N", "glow", "rgb"]);
    assert_eq!(values(&image, "glow", 0), ramp(8, 1));
    assert_eq!(values(&image, "data.N", 2), ramp(8, 6));
    // one layer beside one of another name is compared with it
    let lone = read(vec![named("beauty", rgb(8))]);
    let other = read(vec![Exr::new((4, 2), rgb(8))]);
    assert!(compared(&lone, &other, &Settings::default()).same, "the name of a single part says nothing");
}

#[test]
fn numbers_of_objects_are_compared_as_integers() {
    let ids = |last: u32| {
        let values = vec![7, 16_777_216, u32::MAX, last];
        read(vec![Exr::new((2, 2), vec![("id", FlatSamples::U32(values))])])
    };
    let (a, b) = (ids(16_777_217), ids(16_777_216));
    let found = compared(&a, &b, &Settings::default());
    assert!(!found.same, "a single float holds no difference of these");
    assert_eq!((found.layers[0].values.max_error, found.layers[0].values.differing), (1.0, 0.25));
    assert!(found.layers[0].colour.is_none());
}

#[test]
fn grey_beside_a_colour_stands_for_all_its_channels() {
    let grey = read(vec![Exr::new((4, 2), vec![("Y", floats(ramp(8, 0)))])]);
    let colour = ["R", "G", "B"].map(|name| (name, floats(ramp(8, 0))));
    let colour = read(vec![Exr::new((4, 2), colour.into())]);
    for (a, b) in [(&grey, &colour), (&colour, &grey)] {
        let found = compared(a, b, &Settings::default());
        assert!(found.same && found.layers[0].colour.is_some());
    }
}

fn png(data: &[u8], color: image::ExtendedColorType) -> FileImage {
    use image::ImageEncoder;
    let mut file = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut file);
    encoder.write_image(data, 2, 1, color).expect("written to memory");
    decode(&file).expect("a PNG file")
}

#[test]
fn png_is_decoded_to_light() {
    use image::ExtendedColorType as C;
    let colour = png(&[0, 188, 255, 13, 13, 13], C::Rgb8);
    assert!(colour.encoded);
    let linear = |v: f64| terrarium::output::srgb::decode(v) as f32;
    assert_eq!(values(&colour, "", 0), [0.0, linear(13.0 / 255.0)]);
    assert_eq!(values(&colour, "", 1), [linear(188.0 / 255.0), linear(13.0 / 255.0)]);
    assert_eq!(values(&colour, "", 2)[0], 1.0);
    let deep = png(&[0x80, 0x00, 0xff, 0xff, 0, 1, 0, 0, 0, 0, 0, 0].map(|b: u8| b), C::Rgb16);
    assert_eq!(values(&deep, "", 0)[0], linear(f64::from(u16::from_ne_bytes([0x80, 0])) / 65535.0));
    let grey = png(&[13, 51, 188, 255], C::La8);
    assert_eq!(values(&grey, "", 2), [linear(13.0 / 255.0), linear(188.0 / 255.0)]);
    assert_eq!(values(&grey, "A", 0), [0.2, 1.0], "alpha is not encoded");
}

#[test]
fn broken_files_are_refused_wherever_they_break() {
    let whole = exr_file(vec![Exr::new((70, 40), rgb(2800))]);
    for length in [0, 3, 4, 9, 100, 300, whole.len() / 2, whole.len() - 1] {
        assert!(decode(&whole[..length]).is_err(), "cut at {length}");
    }
    assert!(
        matches!(decode(b"P6 2 2 255 "), Err(ReadError::Invalid(reason)) if reason.contains("EXR or PNG"))
    );
    assert!(matches!(decode(b"\x89PNG\r\n\x1a\nrest"), Err(ReadError::Invalid(_))));
    // every byte of the header broken in turn: an error or an image, but nothing worse
    for at in 4..400 {
        let mut bytes = whole.clone();
        bytes[at] ^= 0xff;
        if let Err(error) = decode(&bytes) {
            assert!(!error.to_string().contains("decoder failed"), "byte {at}: {error}");
        }
    }
}
