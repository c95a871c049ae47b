//! Image files as other programs read them: written by the library, read back by other readers.

use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use std::io::Cursor;
use std::path::Path;
use terrarium::output::{self, CameraView, Format, Image, PngSettings, Provenance, Stamp};

/// 67 × 35 pixels (no multiple of a block) with a smooth picture, normals and depth.
fn image() -> Image {
    let (width, height) = (67, 35);
    let mut image = Image::new(width, height);
    let at = |i: usize| ((i % width) as f32 / width as f32, (i / width) as f32 / height as f32);
    let pixels = |f: &dyn Fn(f32, f32) -> [f32; 3]| -> Vec<[f32; 3]> {
        (0..width * height).map(|i| f(at(i).0, at(i).1)).collect()
    };
    image.add("", ["R", "G", "B"], &pixels(&|x, y| [x, y, x * y]));
    image.add("normal", ["X", "Y", "Z"], &pixels(&|x, y| [x, -y, 1.0]));
    image.add("depth", ["Z"], &(0..width * height).map(|i| [1.0 + i as f32]).collect::<Vec<_>>());
    image
}

fn provenance() -> Provenance {
    let mut provenance = Provenance::new(&[0x5a; 32], 11, 64);
    provenance.plan = "caustics: on – `glass` refracts".to_string();
    provenance.camera = Some(CameraView {
        eye: [0.0, 1.0, 4.0],
        right: [1.0, 0.0, 0.0],
        up: [0.0, 1.0, 0.0],
        forward: [0.0, 0.0, -1.0],
        fov_deg: 40.0,
        aspect: 67.0 / 35.0,
        aperture_m: 0.0,
        focus_m: 4.0,
    });
    for name in ["rays", "passes", "cut", "samples", "photons"] {
        provenance.stats.insert(name.to_string(), name.len().into());
    }
    provenance
}

fn bytes(format: Format, image: &Image, settings: PngSettings) -> Vec<u8> {
    let mut sink = Cursor::new(Vec::new());
    format.write(&mut sink, image, &provenance(), settings).expect("a sound image is written");
    sink.into_inner()
}

#[test]
fn exr_gives_back_every_float_and_the_provenance() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("image.exr");
    let image = image();
    std::fs::write(&path, bytes(Format::Exr, &image, PngSettings::default())).expect("written");
    let file = read_first_flat_layer_from_file(&path).expect("an EXR");
    let names: Vec<String> =
        file.layer_data.channel_data.list.iter().map(|channel| channel.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "N.X", "N.Y", "N.Z", "R", "Z"], "alphabetical, as the format demands");
    for (name, layer, channel) in [("B", "", "B"), ("N.Y", "normal", "Y"), ("Z", "depth", "Z")] {
        let read = file.layer_data.channel_data.list.iter().find(|c| c.name.eq(name)).expect("the channel");
        let FlatSamples::F32(read) = &read.sample_data else { panic!("{name} is not f32") };
        assert_eq!(Some(read.as_slice()), image.layer(layer).and_then(|l| l.channel(channel)));
    }
    let attributes = &file.layer_data.attributes;
    let json = attributes.other.get(&exr::prelude::Text::from(output::exr::ATTRIBUTE)).expect("ours");
    let json = json.to_text().expect("a text").to_string();
    assert_eq!(serde_json::from_str::<Provenance>(&json).ok(), Some(provenance()));
    assert!(attributes.software_name.as_ref().is_some_and(|name| name.to_string().starts_with("terrarium ")));
    let to_camera = attributes.world_to_camera.expect("a matrix");
    assert_eq!((to_camera[10], to_camera[13], to_camera[14]), (-1.0, -1.0, 4.0));
    assert!(file.attributes.chromaticities.is_some_and(|c| c.white.0 == 0.3127));
    assert!(attributes.capture_date.is_none());
}

#[test]
fn the_same_image_is_the_same_file() {
    for format in [Format::Exr, Format::Png] {
        let first = bytes(format, &image(), PngSettings::default());
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            for _ in 0..5 {
                let again = pool.install(|| bytes(format, &image(), PngSettings::default()));
                assert!(again == first, "{format:?} differs with {threads} threads");
            }
        }
    }
}

#[test]
fn png_says_that_it_is_srgb_and_where_it_comes_from() {
    let file = bytes(Format::Png, &image(), PngSettings::default());
    let reader = png::Decoder::new(Cursor::new(&file)).read_info().expect("a PNG");
    let info = reader.info();
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
    let at = file.windows(4).position(|w| w == b"gAMA").expect("the chunk for older readers");
    assert_eq!(file[at + 4..at + 8], 45_455u32.to_be_bytes());
    let texts = &info.uncompressed_latin1_text;
    let json = texts.iter().find(|text| text.keyword == "terrarium").expect("the provenance");
    assert_eq!(serde_json::from_str::<Provenance>(&json.text).ok(), Some(provenance()));
}

#[test]
fn a_stamp_is_written_only_on_request() {
    let mut stamped = provenance();
    stamped.stamp = Some(Stamp { unix_time: 1_700_000_000, host: None });
    let mut sink = Cursor::new(Vec::new());
    output::exr::write(&mut sink, &image(), &stamped).expect("written");
    let stamped = sink.into_inner();
    let contains = |file: &[u8], text: &str| file.windows(text.len()).any(|w| w == text.as_bytes());
    assert!(contains(&stamped, "2023:11:14 22:13:20"));
    assert!(!contains(&bytes(Format::Exr, &image(), PngSettings::default()), "capDate"));
}

#[test]
fn malformed_images_are_refused_by_both_writers() {
    let mut short = Image::new(2, 2);
    short.add("", ["R", "G", "B"], &[[0.0; 3]; 3]);
    let mut blind = Image::new(1, 1);
    blind.add("depth", ["Z"], &[[1.0]]);
    assert!(output::exr::write(Cursor::new(Vec::new()), &short, &provenance()).is_err());
    for image in [&short, &blind, &Image::new(0, 5)] {
        assert!(output::png::write(Vec::new(), image, &provenance(), PngSettings::default()).is_err());
    }
}

/// The reference implementation's reader, where Python has it.
#[test]
fn openexr_itself_reads_the_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("image.exr");
    std::fs::write(&path, bytes(Format::Exr, &image(), PngSettings::default())).expect("written");
    let script = "
import sys
try:
    import OpenEXR
except ImportError:
    sys.exit(77)
with OpenEXR.File(sys.argv[1], separate_channels=True) as file:
    header, channels = file.header(), file.channels()
    assert 'sceneHash' in header['terrarium'], header
    assert header['worldToCamera'] is not None and header['chromaticities'] is not None
    assert channels['Z'].pixels[0][1] == 2.0 and channels['N.Z'].pixels[34][66] == 1.0
    assert sorted(channels) == ['B', 'G', 'N.X', 'N.Y', 'N.Z', 'R', 'Z'], channels
";
    let Ok(run) = std::process::Command::new("python3").args(["-c", script]).arg(Path::new(&path)).output()
    else {
        eprintln!("skipped: no python3");
        return;
    };
    match run.status.code() {
        Some(77) => eprintln!("skipped: python3 has no OpenEXR module (pip install openexr)"),
        code => assert_eq!(code, Some(0), "{}", String::from_utf8_lossy(&run.stderr)),
    }
}
