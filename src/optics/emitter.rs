//! What sends light: the lights of a scene, and its emitting objects.

use crate::math::{Color, DVec3};

/// A source of light. Every kind says how many shadow rays a shading point spends on it.
#[derive(Clone, Debug)]
pub struct Emitter {
    pub kind: EmitterKind,
    /// Shadow rays a shading point.
    pub samples: u32,
    /// The name in the scene, or the emitting object's.
    pub name: String,
}

#[derive(Clone, Debug)]
pub enum EmitterKind {
    /// W/sr, with the classic attenuation 1/(c0 + c1·d + c2·d²) where one is given.
    Point {
        position: DVec3,
        intensity: Color,
        falloff: Option<[f64; 3]>,
    },
    Spot {
        position: DVec3,
        axis: DVec3,
        cos_inner: f64,
        cos_outer: f64,
        intensity: Color,
    },
    /// `to_light` is the unit direction against which the light travels; W·m⁻².
    Directional {
        to_light: DVec3,
        irradiance: Color,
    },
    /// A placed analytic shape whose material emits.
    Shape {
        instance: u32,
    },
    /// The emitting triangles of a placed mesh; `choose` draws one by area.
    Mesh {
        instance: u32,
        triangles: Vec<u32>,
        cumulative: Vec<f64>,
    },
    Environment,
}

impl EmitterKind {
    /// Whether its light comes to a point from more directions than one.
    #[inline]
    pub fn extended(&self) -> bool {
        use EmitterKind::{Directional, Point, Spot};
        !matches!(self, Point { .. } | Spot { .. } | Directional { .. })
    }
}

/// The spot light's smooth edge: 1 inside the inner cone, 0 outside the outer one, a cubic between.
pub fn spot_falloff(cos: f64, cos_inner: f64, cos_outer: f64) -> f64 {
    if cos >= cos_inner {
        return 1.0;
    }
    if cos <= cos_outer {
        return 0.0;
    }
    let x = (cos - cos_outer) / (cos_inner - cos_outer);
    x * x * (3.0 - 2.0 * x)
}
