//! Textures and environments from descriptions and files.

use image::{ExtendedColorType, ImageEncoder};
use std::path::Path;
use terrarium::build::images::{ImageError, Images, Limits, TextureUse};
use terrarium::description::{ColorSpace, EnvironmentMap, Rgb, Texture, UvMapping, Wrap};
use terrarium::math::{Color, DVec2, DVec3};
use terrarium::optics::TexturePoint;

/// A PNG of the given grey codes in one row.
fn write_png(path: &Path, codes: &[u8]) {
    let mut file = Vec::new();
    image::codecs::png::PngEncoder::new(&mut file)
        .write_image(codes, codes.len() as u32, 1, ExtendedColorType::L8)
        .expect("it is written to memory");
    std::fs::write(path, file).expect("the folder is writable");
}

fn image(path: &str, color_space: ColorSpace, uv: UvMapping) -> Texture {
    Texture::Image { path: path.into(), color_space, wrap: Wrap::Repeat, uv }
}

fn at(u: f64) -> TexturePoint {
    TexturePoint::at(DVec2::new(u, 0.5), DVec3::ZERO)
}

#[test]
fn colours_are_srgb_and_data_is_linear_unless_stated() {
    let folder = tempfile::tempdir().expect("there is a temporary folder");
    // The name says nothing about the format.
    write_png(&folder.path().join("grey.txt"), &[188, 188]);
    let mut images = Images::new(folder.path(), Limits::default());
    let mut value = |space, usage| {
        let texture =
            images.texture(&image("grey.txt", space, UvMapping::default()), usage).expect("it is there");
        texture.color(&at(0.3)).x
    };
    let (srgb, linear) = (0.502_886_5, 188.0 / 255.0);
    for (space, usage, expected) in [
        (ColorSpace::Auto, TextureUse::Color, srgb),
        (ColorSpace::Auto, TextureUse::Data, linear),
        (ColorSpace::Srgb, TextureUse::Data, srgb),
        (ColorSpace::Linear, TextureUse::Color, linear),
    ] {
        assert!(
            (value(space, usage) - expected).abs() < 1e-6,
            "{space:?} {usage:?}: {}",
            value(space, usage)
        );
    }
    assert_eq!(images.files().len(), 1, "one file, read in two ways");
    // Two images of 2 × 1 bytes and one level of floats above each.
    assert_eq!(images.memory_bytes(), 2 * (6 + 12));
}

#[test]
fn images_are_scaled_and_moved() {
    let folder = tempfile::tempdir().expect("there is a temporary folder");
    write_png(&folder.path().join("ramp.png"), &[0, 51, 102, 153]);
    let mut images = Images::new(folder.path(), Limits::default());
    let uv = UvMapping { scale: [2.0, 1.0], offset: [0.25, 0.0] };
    let texture =
        images.texture(&image("ramp.png", ColorSpace::Linear, uv), TextureUse::Color).expect("it is there");
    // 2·u + ¼: u = 1/16 is the centre of the second texel, and half a unit later again.
    assert!((texture.color(&at(0.0625)).x - 0.2).abs() < 1e-6);
    assert!((texture.color(&at(0.5625)).x - 0.2).abs() < 1e-6);
}

#[test]
fn missing_files_are_named() {
    let mut images = Images::new(Path::new("/nowhere"), Limits::default());
    let result =
        images.texture(&image("wood.png", ColorSpace::Auto, UvMapping::default()), TextureUse::Color);
    match result {
        Err(e @ ImageError::Io { .. }) => assert!(e.to_string().starts_with("/nowhere/wood.png: "), "{e}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn environments_follow_their_description() {
    let folder = tempfile::tempdir().expect("there is a temporary folder");
    write_png(&folder.path().join("sky.png"), &[255]);
    let mut images = Images::new(folder.path(), Limits::default());
    let map = EnvironmentMap::Image { path: "sky.png".into(), color_space: ColorSpace::Auto };
    let sky = images.environment(&map, 3.0, 45.0).expect("it is there");
    assert_eq!(sky.radiance(DVec3::Y), Color::splat(3.0));
    let map = EnvironmentMap::Gradient {
        zenith: Rgb([0.0, 0.0, 1.0]),
        horizon: Rgb::grey(1.0),
        nadir: Rgb::grey(0.0),
    };
    let sky = images.environment(&map, 1.0, 0.0).expect("it needs no file");
    assert_eq!(sky.radiance(DVec3::Y), Color::Z);
    assert_eq!(sky.radiance(DVec3::X), Color::ONE);
    assert!((sky.radiance(DVec3::new(0.8, -0.6, 0.0)) - Color::splat(0.4)).length() < 1e-6);
}
