//! Image files, whole and broken: what is read, what is refused, and that nothing panics.

use super::*;
use crate::math::random::{Counter, Stage};
use exr::prelude::WritableImage;
use image::{ExtendedColorType, ImageEncoder};
use std::io::Cursor;
use std::time::Instant;

const SMALL: Limits = Limits { max_bytes: 16 << 20, max_side: 65536 };

fn read(bytes: &[u8]) -> Result<LoadedImage, ImageError> {
    decode(Path::new("folder/file"), bytes, &Limits::default())
}

fn png(data: &[u8], width: u32, height: u32, color: ExtendedColorType) -> Vec<u8> {
    let mut file = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut file);
    encoder.write_image(data, width, height, color).expect("it is written to memory");
    file
}

fn jpeg(width: u32, height: u32) -> Vec<u8> {
    let data: Vec<u8> = (0..width * height * 3).map(|i| (i * 7 % 251) as u8).collect();
    let mut file = Vec::new();
    image::codecs::jpeg::JpegEncoder::new(&mut file)
        .write_image(&data, width, height, ExtendedColorType::Rgb8)
        .expect("it is written to memory");
    file
}

/// (R, G, B) by texel, compressed as told.
fn exr_file(
    width: usize,
    height: usize,
    compression: exr::prelude::Compression,
    f: impl Fn(usize) -> [f32; 3] + Sync,
) -> Vec<u8> {
    use exr::prelude as e;
    let channels = e::SpecificChannels::rgb(|at: e::Vec2<usize>| {
        let [r, g, b] = f(at.1 * width + at.0);
        (r, g, b)
    });
    let encoding = e::Encoding { compression, ..e::Encoding::SMALL_LOSSLESS };
    let layer = e::Layer::new((width, height), e::LayerAttributes::named("main"), encoding, channels);
    let mut file = Cursor::new(Vec::new());
    e::Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut file)
        .expect("it is written to memory");
    file.into_inner()
}

fn samples() -> Vec<(&'static str, Vec<u8>)> {
    use exr::prelude::Compression as C;
    let bytes: Vec<u8> = (0..13 * 11 * 6).map(|i| (i * 37 % 256) as u8).collect();
    let texel = |i: usize| [i as f32, 0.5 * i as f32, 1.0 / (1.0 + i as f32)];
    vec![
        ("png8", png(&bytes[..13 * 11 * 3], 13, 11, ExtendedColorType::Rgb8)),
        ("png16", png(&bytes, 13, 11, ExtendedColorType::Rgb16)),
        ("jpeg", jpeg(13, 11)),
        ("exr raw", exr_file(7, 5, C::Uncompressed, texel)),
        ("exr zip", exr_file(7, 5, C::ZIP16, texel)),
        ("exr piz", exr_file(7, 5, C::PIZ, texel)),
        ("exr rle", exr_file(7, 5, C::RLE, texel)),
        ("exr b44", exr_file(7, 5, C::B44, texel)),
        ("exr pxr24", exr_file(7, 5, C::PXR24, texel)),
    ]
}

/// A decoder that panics would be contained, but is to be known.
fn assert_contained(name: &str, result: &Result<LoadedImage, ImageError>) {
    if let Err(e) = result {
        assert!(!e.to_string().contains("decoder failed"), "{name}: a decoder panicked");
        assert!(e.to_string().starts_with("folder/file: "), "{e}");
    }
}

#[test]
fn texels_are_read_as_written() {
    let data: Vec<u8> = (0..2 * 3 * 3).map(|i| i * 14).collect();
    let image = read(&png(&data, 2, 3, ExtendedColorType::Rgb8)).expect("it is a PNG");
    assert_eq!((image.width, image.height, image.format), (2, 3, Format::Png));
    assert_eq!(image.pixels, Texels::U8(triples(&data)));

    let image = read(&png(&[7, 200], 2, 1, ExtendedColorType::L8)).expect("it is a PNG");
    assert_eq!(image.pixels, Texels::U8(vec![[7; 3], [200; 3]]));
    let image = read(&png(&[9, 8, 7, 0], 1, 1, ExtendedColorType::Rgba8)).expect("it is a PNG");
    assert_eq!(image.pixels, Texels::U8(vec![[9, 8, 7]]), "alpha is ignored");

    let wide: Vec<u16> = vec![0, 65535, 300, 1, 2, 60000];
    let bytes: Vec<u8> = wide.iter().flat_map(|v| v.to_ne_bytes()).collect();
    let image = read(&png(&bytes, 2, 1, ExtendedColorType::Rgb16)).expect("it is a PNG");
    assert_eq!(image.pixels, Texels::U16(vec![[0, 65535, 300], [1, 2, 60000]]));

    let texel = |i: usize| [i as f32, 1e-5, 70000.0];
    let image = read(&exr_file(3, 2, exr::prelude::Compression::ZIP1, texel)).expect("it is an EXR");
    assert_eq!((image.width, image.height), (3, 2));
    assert_eq!(image.pixels, Texels::F32((0..6).map(texel).collect()));

    let image = read(&jpeg(13, 11)).expect("it is a JPEG");
    assert_eq!((image.width, image.height, image.format), (13, 11, Format::Jpeg));
}

/// Chunks of a PNG file by hand; the checksum is CRC-32.
fn chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut crc = !0u32;
    for byte in name.iter().chain(data) {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    let length = (data.len() as u32).to_be_bytes();
    [&length[..], name, data, &(!crc).to_be_bytes()].concat()
}

fn png_of(chunks: &[Vec<u8>]) -> Vec<u8> {
    [b"\x89PNG\r\n\x1a\n".to_vec(), chunks.concat()].concat()
}

fn header(width: u32, height: u32, depth: u8, kind: u8) -> Vec<u8> {
    let sides = [width.to_be_bytes(), height.to_be_bytes()].concat();
    chunk(b"IHDR", &[&sides[..], &[depth, kind, 0, 0, 0]].concat())
}

/// A zlib stream of one stored block.
fn stored(data: &[u8]) -> Vec<u8> {
    let (mut a, mut b) = (1u32, 0u32);
    for byte in data {
        a = (a + u32::from(*byte)) % 65521;
        b = (b + a) % 65521;
    }
    let length = data.len() as u16;
    let adler = ((b << 16) | a).to_be_bytes();
    [&[0x78, 1, 1][..], &length.to_le_bytes(), &(!length).to_le_bytes(), data, &adler].concat()
}

#[test]
fn palettes_and_single_bits_are_expanded_and_text_is_skipped() {
    let palette = chunk(b"PLTE", &[10, 20, 30, 40, 50, 60]);
    // Four texels of one bit: 0, 1, 1, 0, behind the row's filter byte.
    let data = chunk(b"IDAT", &stored(&[0, 0b0110_0000]));
    let end = chunk(b"IEND", &[]);
    let text = chunk(b"zTXt", &[b"bomb\0\0".to_vec(), vec![0xff; 1000]].concat());
    let image = read(&png_of(&[header(4, 1, 1, 3), text, palette, data.clone(), end.clone()]));
    let (dark, light) = ([10, 20, 30], [40, 50, 60]);
    assert_eq!(image.expect("it is a PNG").pixels, Texels::U8(vec![dark, light, light, dark]));
    let image = read(&png_of(&[header(4, 1, 1, 0), data, end]));
    assert_eq!(image.expect("it is a PNG").pixels, Texels::U8(vec![[0; 3], [255; 3], [255; 3], [0; 3]]));
}

#[test]
fn sizes_are_refused_before_anything_is_allocated() {
    let tail = [chunk(b"IDAT", &stored(&[0; 40])), chunk(b"IEND", &[])].concat();
    let file = |w, h| png_of(&[header(w, h, 8, 2), tail.clone()]);
    let start = Instant::now();
    for (w, h) in [(100_000, 100_000), (1 << 31, 1), (65_536, 65_536), (u32::MAX, u32::MAX), (70_000, 1)] {
        assert!(matches!(read(&file(w, h)), Err(ImageError::TooLarge { .. })), "{w} × {h}");
    }
    for (w, h) in [(0, 5), (5, 0), (8_000, 8_000)] {
        assert!(matches!(read(&file(w, h)), Err(ImageError::Invalid { .. })), "{w} × {h}");
    }
    let message = read(&file(20_000, 20_000)).expect_err("it is too large").to_string();
    assert_eq!(
        message,
        "folder/file: too large: 20000 × 20000 texels × 11 bytes = 4400000000 bytes; the limit is 1073741824"
    );

    // A JPEG of a few hundred bytes that says it is 65500 × 65500, or 8000 × 8000.
    let plain = jpeg(13, 11);
    let frame = plain.windows(2).position(|w| w == [0xff, 0xc0]).expect("it has a frame") + 5;
    for (side, large) in [(65_500u16, true), (7_000, false)] {
        let mut file = plain.clone();
        file[frame..frame + 4].copy_from_slice(&[side.to_be_bytes(), side.to_be_bytes()].concat());
        let result = read(&file);
        assert!(matches!(result, Err(ImageError::TooLarge { .. })) == large, "{result:?}");
        assert!(matches!(result, Err(ImageError::Invalid { .. })) != large, "{result:?}");
    }
    assert!(start.elapsed().as_secs_f64() < 1.0);
}

#[test]
fn nonsense_data_windows_are_errors() {
    let plain = exr_file(7, 5, exr::prelude::Compression::ZIP16, |_| [1.0; 3]);
    let name = b"dataWindow\0box2i\0\x10\0\0\0";
    let at = plain.windows(name.len()).position(|w| w == name).expect("it has one") + name.len();
    for window in [
        [5, 5, 0, 0],
        [0, 0, i32::MAX, i32::MAX],
        [i32::MIN, i32::MIN, i32::MAX, i32::MAX],
        [0, 0, -1, -1],
        [0, 0, 69_999, 4],
        [0, 0, 30_000, 30_000],
        [i32::MAX, i32::MAX, i32::MIN, i32::MIN],
        [i32::MAX - 3, 0, i32::MAX, 4],
    ] {
        let mut file = plain.clone();
        for (i, v) in window.iter().enumerate() {
            file[at + 4 * i..at + 4 * i + 4].copy_from_slice(&v.to_le_bytes());
        }
        let result = read(&file);
        assert!(result.is_err(), "{window:?}");
        assert_contained("exr", &result);
    }
}

#[test]
fn numbers_that_are_no_radiance_are_mended_and_counted() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 2.5, 0.25];
    let file = exr_file(6, 1, exr::prelude::Compression::Uncompressed, |i| [bad[i], 1.0, 7.5]);
    let image = read(&file).expect("it is an EXR");
    let red = [0.0, 7.5, 0.0, 0.0, 2.5, 0.25];
    assert_eq!(image.pixels, Texels::F32(red.iter().map(|&r| [r, 1.0, 7.5]).collect()));
    assert_eq!(
        image.warnings,
        [
            "folder/file: 1 values that are not numbers and 2 negative ones were replaced by 0, 1 infinite ones by 7.5"
        ]
    );
}

#[test]
fn files_that_are_no_images_are_errors() {
    for bytes in [
        &b""[..],
        b"hello",
        b"GIF89a............",
        b"\x89PNG\r\n\x1a\n",
        &[0xff, 0xd8, 0xff],
        b"\x76\x2f\x31\x01",
    ] {
        let result = read(bytes);
        assert!(result.is_err(), "{bytes:?}");
        assert_contained("stub", &result);
    }
    let missing = load(Path::new("no/such/file.png"), &Limits::default());
    assert!(matches!(missing, Err(ImageError::Io { .. })));
}

#[test]
fn every_truncation_is_an_error() {
    let mut files = 0;
    for (name, bytes) in samples() {
        assert!(read(&bytes).is_ok(), "{name}: {:?}", read(&bytes));
        for length in 0..bytes.len() {
            let result = decode(Path::new("folder/file"), &bytes[..length], &SMALL);
            assert!(result.is_err(), "{name} of {} cut to {length}", bytes.len());
            assert_contained(name, &result);
            files += 1;
        }
    }
    println!("{files} truncated files");
}

#[test]
fn mutated_files_neither_panic_nor_take_long() {
    let (mut slowest, mut errors, mut files) = (0.0f64, 0, 0);
    for (k, (name, bytes)) in samples().into_iter().enumerate() {
        let mut values = Counter::new(5, Stage::Test, k as u64);
        for _ in 0..2500 {
            let mut file = bytes.clone();
            for _ in 0..=(values.value() * 4.0) as usize {
                let at = (values.value() * file.len() as f64) as usize;
                file[at] = match (values.value() * 4.0) as u32 {
                    0 => 0xff,
                    1 => 0,
                    2 => file[at] ^ (1 << (values.bits() % 8)),
                    _ => values.bits() as u8,
                };
            }
            let start = Instant::now();
            let result = decode(Path::new("folder/file"), &file, &SMALL);
            slowest = slowest.max(start.elapsed().as_secs_f64());
            assert_contained(name, &result);
            errors += u32::from(result.is_err());
            files += 1;
        }
    }
    println!("{files} mutated files, {errors} errors, slowest {slowest:.3} s");
    assert!(slowest < 1.0);
}
