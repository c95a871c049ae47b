//! Light from infinitely far all around, and directions sampled by how bright it is.
//!
//! Up is +y. The centre column of an equirectangular image looks along −z and its columns grow to the
//! right as seen from inside, from −z toward +x; row 0 is the zenith. `turn_deg` turns the surroundings
//! about +y, right-handed.

mod map;

use crate::math::Color;
use glam::{DVec3, Vec3};
use map::Map;
use std::f64::consts::PI;

/// Radiance by direction, W·m⁻²·sr⁻¹.
#[derive(Clone, Debug)]
pub struct Environment {
    kind: Kind,
    scale: f64,
    /// Sine and cosine of the turn.
    turn: (f64, f64),
}

#[derive(Clone, Debug)]
enum Kind {
    Constant(Color),
    Gradient { zenith: Color, horizon: Color, nadir: Color },
    Image(Map),
}

/// A direction toward the environment, with density `pdf` per steradian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentSample {
    pub dir: DVec3,
    pub radiance: Color,
    pub pdf: f64,
}

impl Environment {
    /// The same radiance from everywhere. Here and below, channels that are negative or NaN are 0.
    pub fn constant(radiance: Color) -> Environment {
        Environment::new(Kind::Constant(clean(radiance)))
    }

    /// Linear in the sine of the elevation: nadir (−1), horizon (0), zenith (1).
    pub fn gradient(zenith: Color, horizon: Color, nadir: Color) -> Environment {
        let [zenith, horizon, nadir] = [zenith, horizon, nadir].map(clean);
        Environment::new(Kind::Gradient { zenith, horizon, nadir })
    }

    /// An equirectangular image, by rows from the zenith, interpolated bilinearly. Missing texels are
    /// black and surplus ones are ignored; a side of 0 counts as 1.
    pub fn image(width: usize, height: usize, texels: Vec<Vec3>) -> Environment {
        let texels = texels.into_iter().map(|c| clean(c.into()).into()).collect();
        Environment::new(Kind::Image(Map::new(width.max(1), height.max(1), texels)))
    }

    fn new(kind: Kind) -> Environment {
        Environment { kind, scale: 1.0, turn: (0.0, 1.0) }
    }

    /// Multiplies all radiance; negative or NaN is 0.
    pub fn with_scale(self, scale: f64) -> Environment {
        Environment { scale: scale.max(0.0), ..self }
    }

    /// Turned about +y by so many degrees.
    pub fn with_turn_deg(self, deg: f64) -> Environment {
        let angle = (if deg.is_finite() { deg % 360.0 } else { 0.0 }).to_radians();
        Environment { turn: (libm::sin(angle), libm::cos(angle)), ..self }
    }

    /// Radiance that arrives from the unit direction `dir`; finite.
    pub fn radiance(&self, dir: DVec3) -> Color {
        let raw = match &self.kind {
            Kind::Constant(radiance) => *radiance,
            Kind::Gradient { zenith, horizon, nadir } => {
                let y = dir.y.clamp(-1.0, 1.0) as f32;
                let end = if y > 0.0 { *zenith } else { *nadir };
                *horizon * (1.0 - y.abs()) + end * y.abs()
            }
            Kind::Image(map) => map.radiance(self.to_map(dir)),
        };
        self.scaled(raw)
    }

    /// A direction of density proportional to the radiance's luminance (for images: to its mean over
    /// the cell between four texel centres). `u` in [0, 1)². None where all is black. Every
    /// direction from which light comes has a density above 0.
    pub fn sample(&self, u: [f64; 2]) -> Option<EnvironmentSample> {
        if self.scaled(Color::ONE) == Color::ZERO {
            return None;
        }
        let (dir, pdf) = match &self.kind {
            Kind::Constant(radiance) => {
                let dir = direction(2.0 * u[1] - 1.0, 2.0 * PI * u[0]);
                if *radiance == Color::ZERO {
                    return None;
                }
                (dir, 0.25 / PI)
            }
            Kind::Gradient { zenith, horizon, nadir } => {
                let slope = Elevation::new(*zenith, *horizon, *nadir)?;
                let y = slope.sample(u[1]);
                (direction(y, 2.0 * PI * u[0]), slope.density(y) / (2.0 * PI))
            }
            Kind::Image(map) => {
                let (dir, pdf) = map.sample(u)?;
                (self.from_map(dir), pdf)
            }
        };
        Some(EnvironmentSample { dir, radiance: self.radiance(dir), pdf })
    }

    /// Density, per steradian, with which [`Environment::sample`] gives the unit direction `dir`; 0 where
    /// all is black.
    pub fn pdf(&self, dir: DVec3) -> f64 {
        if self.scaled(Color::ONE) == Color::ZERO {
            return 0.0;
        }
        match &self.kind {
            Kind::Constant(radiance) if *radiance == Color::ZERO => 0.0,
            Kind::Constant(_) => 0.25 / PI,
            Kind::Gradient { zenith, horizon, nadir } => Elevation::new(*zenith, *horizon, *nadir)
                .map_or(0.0, |slope| slope.density(dir.y.clamp(-1.0, 1.0)) / (2.0 * PI)),
            Kind::Image(map) => map.pdf(self.to_map(dir)),
        }
    }

    /// Mean over the sphere.
    pub fn mean_radiance(&self) -> Color {
        self.scaled(match &self.kind {
            Kind::Constant(radiance) => *radiance,
            Kind::Gradient { zenith, horizon, nadir } => *zenith * 0.25 + *horizon * 0.5 + *nadir * 0.25,
            Kind::Image(map) => map.mean(),
        })
    }

    pub fn memory_bytes(&self) -> usize {
        let heap = if let Kind::Image(map) = &self.kind { map.memory_bytes() } else { 0 };
        size_of::<Environment>() + heap
    }

    fn scaled(&self, radiance: Color) -> Color {
        (radiance.as_dvec3() * self.scale).as_vec3a().min(Color::MAX)
    }

    /// Turning the surroundings one way is looking them up the other way.
    fn to_map(&self, d: DVec3) -> DVec3 {
        let (sin, cos) = self.turn;
        DVec3::new(cos * d.x - sin * d.z, d.y, sin * d.x + cos * d.z)
    }

    #[expect(clippy::wrong_self_convention, reason = "the inverse of to_map")]
    fn from_map(&self, d: DVec3) -> DVec3 {
        let (sin, cos) = self.turn;
        DVec3::new(cos * d.x + sin * d.z, d.y, cos * d.z - sin * d.x)
    }
}

fn clean(c: Color) -> Color {
    Color::from(c.to_array().map(|x| if x > 0.0 { x.min(f32::MAX) } else { 0.0 }))
}

/// Luminance, which is 0 for black only.
fn luminance(c: Color) -> f64 {
    crate::optics::texture::LUMINANCE.dot(c.as_dvec3())
}

/// The unit direction of height `y` and angle `phi` from −z toward +x.
fn direction(y: f64, phi: f64) -> DVec3 {
    let y = y.clamp(-1.0, 1.0);
    let r = (1.0 - y * y).max(0.0).sqrt();
    DVec3::new(r * libm::sin(phi), y, -r * libm::cos(phi))
}

/// The density of the direction's height y in [−1, 1] under a gradient, piecewise linear like the
/// luminance itself, since equal slices of height are equal solid angles (Archimedes).
struct Elevation {
    nadir: f64,
    horizon: f64,
    zenith: f64,
}

impl Elevation {
    /// Normalised. None if all is black.
    fn new(zenith: Color, horizon: Color, nadir: Color) -> Option<Elevation> {
        let [zenith, horizon, nadir] = [zenith, horizon, nadir].map(luminance);
        let total = 0.5 * (zenith + nadir) + horizon;
        (total > 0.0).then(|| Elevation {
            nadir: nadir / total,
            horizon: horizon / total,
            zenith: zenith / total,
        })
    }

    fn density(&self, y: f64) -> f64 {
        let end = if y > 0.0 { self.zenith } else { self.nadir };
        self.horizon + (end - self.horizon) * y.abs()
    }

    fn sample(&self, u: f64) -> f64 {
        let below = 0.5 * (self.nadir + self.horizon);
        if u < below {
            return -linear(self.horizon, self.nadir, 1.0 - u / below);
        }
        linear(self.horizon, self.zenith, (u - below) / (1.0 - below))
    }
}

/// t in [0, 1] of density proportional to a + (b − a)·t; a, b ≥ 0, not both 0.
fn linear(a: f64, b: f64, u: f64) -> f64 {
    let root = (a * a * (1.0 - u) + b * b * u).max(0.0).sqrt();
    // a = 0 at u = 0: the numerator is 0 too.
    if a + root > 0.0 { (u * (a + b) / (a + root)).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests;
