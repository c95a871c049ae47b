//! What a material does with light, as far as its description tells: what a texture drives may be anything.

use super::{Dispersion, Ior, Material, NAMED_IOR, Source};

impl Material {
    /// Its index of refraction at the D line.
    pub fn index(&self) -> f64 {
        match &self.ior {
            None => 1.5,
            Some(Ior::Number(n)) => *n,
            Some(Ior::Name(name)) => {
                NAMED_IOR.iter().find(|(known, _)| known == name).map_or(1.5, |&(_, n)| n)
            }
        }
    }

    /// Whether its index depends on the wavelength.
    pub fn disperses(&self) -> bool {
        match self.dispersion {
            None => false,
            Some(Dispersion::Cauchy(b)) => b != 0.0,
            // The spread is that of n − 1.
            Some(Dispersion::Abbe(_)) => self.index() != 1.0,
        }
    }

    /// Whether its index is another than that of the vacuum.
    pub fn bends(&self) -> bool {
        self.index() != 1.0 || self.disperses()
    }

    /// Whether it transmits and is there at all: light passes through some as through the vacuum, and none
    /// through a perfect mirror.
    pub fn is_interface(&self) -> bool {
        !self.transmission.is_zero() && !self.is_nothing() && !self.reflection.is_one()
    }

    /// Whether light passes through it as through the vacuum.
    pub(super) fn is_nothing(&self) -> bool {
        !self.bends()
            && self.transmission.is_one()
            && self.reflection.is_zero()
            && self.specular.is_zero()
            && self.emission.is_zero()
            && self.absorption.is_zero()
    }

    /// Whether it bends or mirrors light.
    pub fn is_specular(&self) -> bool {
        !self.reflection.is_zero() || self.is_interface()
    }

    pub fn emits(&self) -> bool {
        match &self.emission {
            Source::Constant(c) => !c.is_zero(),
            Source::Texture(t) => !t.scale.is_zero(),
        }
    }

    /// Whether light that reaches it is scattered to all sides: (1−km)·(1−kt)·kd is not zero.
    pub fn is_matt(&self) -> bool {
        !self.diffuse.is_zero() && !self.reflection.is_one() && !self.transmission.is_one()
    }

    /// Whether light that reaches it can be seen on it: it is matt, or has a highlight.
    pub fn receives(&self) -> bool {
        self.is_matt() || !self.specular.is_zero()
    }
}
