//! Materials as the renderer sees them: every name resolved, every default filled in.

use super::{Cauchy, Texture, TexturePoint};
use crate::math::Color;

/// An index into the world's materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// An index into the world's textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// A colour or weight: constant, or a texture times a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weight {
    Constant(Color),
    Texture(TextureId, Color),
}

impl Weight {
    pub const ZERO: Weight = Weight::Constant(Color::ZERO);

    pub fn is_zero(&self) -> bool {
        matches!(self, Weight::Constant(c) if *c == Color::ZERO)
    }

    #[inline]
    pub fn at(&self, textures: &[Texture], point: &TexturePoint) -> Color {
        match *self {
            Weight::Constant(value) => value,
            Weight::Texture(id, factor) => textures[id.0 as usize].color(point) * factor,
        }
    }

    /// All of it but the texture.
    #[inline]
    pub fn factor(&self) -> Color {
        match *self {
            Weight::Constant(value) | Weight::Texture(_, value) => value,
        }
    }

    /// Whether evaluating it needs surface coordinates.
    pub fn textured(&self) -> bool {
        matches!(self, Weight::Texture(..))
    }

    /// An upper bound, channel by channel.
    pub fn bound(&self, textures: &[Texture]) -> Color {
        match *self {
            Weight::Constant(value) => value,
            Weight::Texture(id, factor) => textures[id.0 as usize].max() * factor,
        }
    }
}

/// How a material bends the shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    NormalMap {
        texture: TextureId,
        strength: f64,
    },
    /// Height of white above black, metres.
    BumpMap {
        texture: TextureId,
        height: f64,
    },
}

/// The layers of a surface, from the outside in.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub diffuse: Weight,
    pub specular: Weight,
    pub shininess: f64,
    /// km.
    pub reflection: Weight,
    /// kt.
    pub transmission: Weight,
    pub ior: Cauchy,
    /// 1/m.
    pub absorption: Color,
    pub priority: i32,
    /// W·m⁻²·sr⁻¹.
    pub emission: Weight,
    /// Whether the side away from the geometric normal emits too.
    pub emits_back: bool,
    pub relief: Vec<Relief>,
    /// Whether any part of it needs surface coordinates.
    pub textured: bool,
    /// Whether photons may be stored on some of a surface and not on the rest of it.
    pub patchy: bool,
}

impl Material {
    /// What [`Material::patchy`] is, by its textures: some of it may be all mirror or all glass.
    pub fn is_patchy(&self, textures: &[Texture]) -> bool {
        let [km, kt] = [&self.reflection, &self.transmission];
        let most = km.bound(textures).max(kt.bound(textures)).min_element();
        self.keeps_photons() && self.specular.is_zero() && (km.textured() || kt.textured()) && most >= 1.0
    }

    pub fn transmits(&self) -> bool {
        !self.transmission.is_zero()
    }

    /// Whether light may go on from it without being scattered.
    pub fn specular_somewhere(&self) -> bool {
        self.transmits() || !self.reflection.is_zero()
    }

    /// Whether it sends on light of a lamp or of photons, as far as that is known without its textures.
    pub fn shades(&self) -> bool {
        !(self.diffuse.is_zero() && self.specular.is_zero())
    }

    /// Whether photons may be stored on some of it: it shades, and is neither all mirror nor all glass.
    pub fn keeps_photons(&self) -> bool {
        let all = |weight: &Weight| *weight == Weight::Constant(Color::ONE);
        let covered = all(&self.reflection) || all(&self.transmission);
        self.shades() && !(covered && self.specular.is_zero())
    }

    pub fn emits(&self) -> bool {
        !self.emission.is_zero()
    }

    pub fn absorbs(&self) -> bool {
        self.absorption != Color::ZERO
    }
}
