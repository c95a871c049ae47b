//! What is written: values that are no numbers, the sRGB curve, sizes at their limits.

use super::record::{Record, row, sized};
use crate::render::meshes::folder;
use crate::render::shot::shot;
use exr::prelude::read_all_flat_layers_from_file;
use std::io::Cursor;
use std::process::Command;
use terrarium::description::{Format, load_str};
use terrarium::output::{self, Bits, Image, PngSettings, Provenance, srgb};

fn provenance() -> Provenance {
    Provenance::new(&[0x5a; 32], 11, 64)
}

fn picture(pixels: &[[f32; 3]]) -> Image {
    let mut image = Image::new(pixels.len(), 1);
    image.add("", ["R", "G", "B"], pixels);
    image
}

#[test]
fn h39_no_overflow_in_the_file() {
    row("H39", |row| {
        let dir = folder();
        let path = dir.path().join("bright.exr");
        let bright =
            [[f32::NAN, 1.0, 2.0], [0.5, f32::INFINITY, -f32::INFINITY], [1e6, 65_520.0, 3e38], [0.1; 3]];
        let mut sink = Cursor::new(Vec::new());
        let written = output::exr::write(&mut sink, &picture(&bright), &provenance()).expect("it is written");
        row.is("values that the writer says it has replaced by 0", written.non_finite as f64, 3.0, 0.0);
        std::fs::write(&path, sink.into_inner()).expect("the folder is writable");
        let file = read_all_flat_layers_from_file(&path).expect("an EXR");
        let values: Vec<f32> =
            file.layer_data[0].channel_data.list.iter().flat_map(|c| c.sample_data.values_as_f32()).collect();
        let bad = values.iter().filter(|value| !value.is_finite()).count() as u64;
        row.none("values in the file that are NaN or infinite, by the crate `exr`", bad, values.len() as u64);
        row.all(
            "radiances of 1e6, 65,520 and 3e38 that are in the file to the bit",
            [1e6, 65_520.0, 3e38].iter().filter(|v| values.contains(v)).count() as u64,
            3,
        );
        second_reader(row, &path);
    });
}

/// The reference implementation's reader, where Python has it.
fn second_reader(row: &mut Record, path: &std::path::Path) {
    let script = "
import sys
try:
    import OpenEXR, numpy
except ImportError:
    sys.exit(77)
with OpenEXR.File(sys.argv[1], separate_channels=True) as file:
    print(sum(int((~numpy.isfinite(c.pixels)).sum()) for c in file.channels().values()))
";
    let run = Command::new("python3").args(["-c", script]).arg(path).output();
    match run {
        Ok(run) if run.status.success() => {
            let bad = String::from_utf8_lossy(&run.stdout).trim().parse().unwrap_or(f64::NAN);
            row.is("the same by OpenEXR's own reader", bad, 0.0, 0.0);
        }
        Ok(run) if run.status.code() != Some(77) => {
            let said = String::from_utf8_lossy(&run.stderr).lines().last().unwrap_or_default().to_owned();
            row.holds(&format!("OpenEXR's own reader takes the file ({said})"), false);
        }
        _ => row.skip("OpenEXR's own reader (Python's module OpenEXR) is not installed"),
    }
}

fn decoded(png: &[u8]) -> (png::BitDepth, Vec<u8>) {
    let mut reader = png::Decoder::new(Cursor::new(png)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    (info.bit_depth, pixels)
}

fn png_of(pixels: &[[f32; 3]], settings: PngSettings) -> (Vec<u8>, u64) {
    let mut file = Vec::new();
    let written =
        output::png::write(&mut file, &picture(pixels), &provenance(), settings).expect("it is written");
    (file, written.clamped_pixels)
}

#[test]
fn h54_png_curve() {
    row("H54", |row| {
        let ramp: Vec<[f32; 3]> = (0..256).map(|i| [srgb::decode(f64::from(i) / 255.0) as f32; 3]).collect();
        let (_, pixels) = decoded(&png_of(&ramp, PngSettings::default()).0);
        let wrong = (0..256usize).filter(|&i| pixels[3 * i..3 * i + 3] != [i as u8; 3]).count() as u64;
        row.none(
            "of 256 levels by the curve's inverse, those that are another level in the file",
            wrong,
            256,
        );
        let settings = PngSettings { exposure_ev: 0.0, bits: Bits::Sixteen };
        let (depth, pixels) = decoded(&png_of(&ramp, settings).0);
        assert_eq!(depth, png::BitDepth::Sixteen);
        // 65535 / 255 = 257; the picture is f32, whose error is below one 16-bit step
        let off = |i: usize| {
            let value = u16::from_be_bytes([pixels[6 * i], pixels[6 * i + 1]]);
            (i32::from(value) - 257 * i as i32).abs()
        };
        row.at_most("in 16 bits, levels of 65,535 off", f64::from((0..256).map(off).max().unwrap_or(0)), 1.0);
        // IEC 61966-2-1: 12.92·x up to 0.0031308, then 1.055·x^(1/2.4) − 0.055.
        for (x, expected) in
            [(0.001, 0.01292), (0.18, 0.461_356_129_500_442), (0.5, 0.735_356_983_052_449_7), (1.0, 1.0)]
        {
            row.is(&format!("the curve at {x}"), srgb::encode(x), expected, 1e-14);
        }
        let halves = [0.5, 1.5, 2.5, 3.5].map(|v| srgb::quantise(v / 4.0, 4));
        row.holds("halves between levels go to the even one", halves == [0, 2, 2, 4]);
        let settings = PngSettings { exposure_ev: 1.0, bits: Bits::Eight };
        let (_, clamped) = png_of(&[[0.25; 3], [0.5; 3], [0.6, 0.1, 0.1], [-0.1, 0.0, 0.0]], settings);
        row.is("pixels out of range after an exposure of one stop, as counted", clamped as f64, 2.0, 0.0);
    });
}

fn sky(width: u64, height: u64, antialiasing: &str) -> String {
    format!(
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)),\nimage: (width: {width}, height: {height}), antialiasing: {antialiasing}, background: 0.25)"
    )
}

#[test]
fn h44_extreme_image_sizes() {
    row("H44", |row| {
        let (mut wrong, mut pixels) = (0, 0);
        let long = sized(500, 100_000);
        for (width, height) in [(1, 1), (1, long), (long, 1)] {
            for antialiasing in ["progressive", "grid(3)", "adaptive()", "none"] {
                let values = shot(sky(width, height, antialiasing)).passes(2).render().grey();
                wrong += values.iter().filter(|x| **x != 0.25).count() as u64;
                pixels += width * height;
            }
        }
        row.none(&format!("wrong pixels of images of 1 × 1, 1 × {long} and {long} × 1"), wrong, pixels);
        for (width, height) in [(0, 5), (5, 0), (1, 1_048_577), (1 << 32, 1 << 32)] {
            let report = load_str(&sky(width, height, "none"), Format::Ron, "".as_ref(), &[]).err();
            let said = report
                .and_then(|r| Some(format!("code {}, {}", r.exit_code(), r.errors().next()?.headline())));
            row.says(
                &format!("what is said of {width} × {height}"),
                &said.unwrap_or_default(),
                "code 2, <input>:2:",
            );
        }
        let dir = folder();
        std::fs::write(dir.path().join("scene.ron"), sky(100_000, 100_000, "none")).expect("written");
        let start = std::time::Instant::now();
        let done = Command::new(env!("CARGO_BIN_EXE_terrarium"))
            .current_dir(dir.path())
            .args(["render", "scene.ron", "-q", "-o", "a.exr", "--memory", "1GiB"])
            .output()
            .expect("the program runs");
        let said = String::from_utf8_lossy(&done.stderr);
        let said = said.lines().find(|line| line.contains("100000 × 100000")).unwrap_or_default();
        let found = format!("code {}, {said}", done.status.code().unwrap_or(-1));
        row.says("what is said of 100000 × 100000 with --memory 1GiB", &found, "100000 × 100000 pixels × ");
        row.is("exit code", f64::from(done.status.code().unwrap_or(-1)), 5.0, 0.0);
        row.at_most("seconds until then", start.elapsed().as_secs_f64(), 1.0);
    });
}
