//! Described textures and environments made into the renderer's, each file read once.

use super::{Format, ImageError, Limits, LoadedImage, load_within};
use crate::description::{self, ColorSpace, EnvironmentMap, Reach, Rgb, UvMapping, Wrap};
use crate::math::Color;
use crate::optics::Environment;
use crate::optics::texture::{
    Brick, Checker, Checker3d, Colors, Encoding, ImagePlacement, ImageTexture, ImageWrap, Marble, Noise,
    Pyramid, Texels, Texture, Wood, srgb_to_linear, srgb8_to_linear,
};
use glam::{DVec2, Vec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a texture's numbers are used for, which decides what an image without a stated colour space is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureUse {
    /// Colours: PNG and JPEG are sRGB.
    Color,
    /// Normals and heights only: everything is linear.
    Data,
}

/// The images of a scene. Paths are relative to the scene's folder.
#[derive(Debug)]
pub struct Images {
    folder: PathBuf,
    reach: Reach,
    limits: Limits,
    loaded: HashMap<(PathBuf, Encoding), Arc<Pyramid>>,
    formats: HashMap<PathBuf, Format>,
    files: Vec<PathBuf>,
    warnings: Vec<String>,
}

impl Images {
    pub fn new(folder: &Path, limits: Limits) -> Images {
        Images {
            folder: folder.to_owned(),
            reach: Reach::default(),
            limits,
            loaded: HashMap::new(),
            formats: HashMap::new(),
            files: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The same, of files within reach only.
    pub fn within(self, reach: &Reach) -> Images {
        Images { reach: reach.clone(), ..self }
    }

    /// The files that were read, in the order in which they were first asked for.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// What had to be mended in them.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Bytes of all images that are held, each counted once.
    pub fn memory_bytes(&self) -> usize {
        self.loaded.values().map(|p| p.memory_bytes()).sum()
    }

    /// The texture that a checked description means.
    ///
    /// # Errors
    /// As [`load`], for images.
    pub fn texture(
        &mut self,
        description: &description::Texture,
        usage: TextureUse,
    ) -> Result<Texture, ImageError> {
        use description::Texture as D;
        Ok(match description {
            D::Image { path, color_space, wrap, uv } => {
                let pyramid = self.pyramid(path, *color_space, usage)?;
                Texture::Image(ImageTexture::new(pyramid, placement(*wrap, uv)))
            }
            D::Checker { a, b, squares } => {
                Texture::Checker(Checker::new(colors(a, b), DVec2::from_array(*squares)))
            }
            D::Checker3d { a, b, size_m } => Texture::Checker3d(Checker3d::new(colors(a, b), *size_m)),
            D::Noise { a, b, size_m, octaves } => Texture::Noise(Noise::new(colors(a, b), *size_m, *octaves)),
            D::Marble { a, b, size_m, octaves } => {
                Texture::Marble(Marble::new(colors(a, b), *size_m, *octaves))
            }
            D::Wood { a, b, ring_m } => Texture::Wood(Wood::new(colors(a, b), *ring_m)),
            D::Brick { a, b, bricks, mortar } => {
                Texture::Brick(Brick::new(colors(a, b), DVec2::from_array(*bricks), *mortar))
            }
        })
    }

    /// The environment that a checked description means.
    ///
    /// # Errors
    /// As [`load`], for images.
    pub fn environment(
        &mut self,
        map: &EnvironmentMap,
        scale: f64,
        turn_deg: f64,
    ) -> Result<Environment, ImageError> {
        let environment = match map {
            EnvironmentMap::Constant(radiance) => Environment::constant(color(radiance)),
            EnvironmentMap::Gradient { zenith, horizon, nadir } => {
                Environment::gradient(color(zenith), color(horizon), color(nadir))
            }
            EnvironmentMap::Image { path, color_space } => {
                let image = self.read(path)?;
                let encoding = encoding(*color_space, image.format, TextureUse::Color);
                Environment::image(image.width, image.height, linear(image.pixels, encoding))
            }
        };
        Ok(environment.with_scale(scale).with_turn_deg(turn_deg))
    }

    fn pyramid(
        &mut self,
        path: &str,
        space: ColorSpace,
        usage: TextureUse,
    ) -> Result<Arc<Pyramid>, ImageError> {
        let full = self.folder.join(path);
        // Only a file that was read before is known by its format, and only it can be held already.
        if let Some(&format) = self.formats.get(&full)
            && let Some(pyramid) = self.loaded.get(&(full.clone(), encoding(space, format, usage)))
        {
            return Ok(Arc::clone(pyramid));
        }
        let image = self.read(path)?;
        let encoding = encoding(space, image.format, usage);
        let pyramid = Arc::new(Pyramid::new(image.width, image.height, image.pixels, encoding));
        self.loaded.insert((full, encoding), Arc::clone(&pyramid));
        Ok(pyramid)
    }

    fn read(&mut self, path: &str) -> Result<LoadedImage, ImageError> {
        let full = self.folder.join(path);
        let mut image = load_within(&self.reach, &full, &self.limits)?;
        if self.formats.insert(full.clone(), image.format).is_none() {
            self.files.push(full);
            self.warnings.append(&mut image.warnings);
        }
        Ok(image)
    }
}

fn encoding(space: ColorSpace, format: Format, usage: TextureUse) -> Encoding {
    match (space, format, usage) {
        (ColorSpace::Srgb, ..) => Encoding::Srgb,
        (ColorSpace::Linear, ..) => Encoding::Linear,
        (ColorSpace::Auto, Format::Exr, _) | (ColorSpace::Auto, _, TextureUse::Data) => Encoding::Linear,
        (ColorSpace::Auto, Format::Png | Format::Jpeg, TextureUse::Color) => Encoding::Srgb,
    }
}

fn placement(wrap: Wrap, uv: &UvMapping) -> ImagePlacement {
    ImagePlacement {
        wrap: match wrap {
            Wrap::Repeat => ImageWrap::Repeat,
            Wrap::Clamp => ImageWrap::Clamp,
            Wrap::Mirror => ImageWrap::Mirror,
        },
        scale: DVec2::from_array(uv.scale),
        offset: DVec2::from_array(uv.offset),
    }
}

fn linear(texels: Texels, encoding: Encoding) -> Vec<Vec3> {
    let curve = |v: f64| (if encoding == Encoding::Srgb { srgb_to_linear(v) } else { v }) as f32;
    match texels {
        Texels::U8(t) if encoding == Encoding::Srgb => {
            let table = srgb8_to_linear();
            t.into_iter().map(|c| Vec3::from(c.map(|v| table[usize::from(v)]))).collect()
        }
        Texels::U8(t) => t.into_iter().map(|c| Vec3::from(c.map(|v| curve(f64::from(v) / 255.0)))).collect(),
        Texels::U16(t) => {
            t.into_iter().map(|c| Vec3::from(c.map(|v| curve(f64::from(v) / 65535.0)))).collect()
        }
        Texels::F32(t) => t.into_iter().map(|c| Vec3::from(c.map(|v| curve(f64::from(v))))).collect(),
    }
}

fn colors(a: &Rgb, b: &Rgb) -> Colors {
    Colors::new(color(a), color(b))
}

fn color(c: &Rgb) -> Color {
    Color::from(c.0.map(|v| v as f32))
}
