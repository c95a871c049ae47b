//! Normals from maps: tangent-space normal maps, and heights.
//!
//! Blinn, Simulation of Wrinkled Surfaces, SIGGRAPH 1978. A flat map leaves the normal as it is, to the
//! last bit, everywhere, also where the surface's coordinates are singular.

use crate::math::Color;
use crate::math::Frame;
use glam::{DVec2, DVec3};

/// The normal that a tangent-space map gives: `rgb` in [0, 1], red along ∂p/∂u, green along ∂p/∂v,
/// blue along the normal; `strength` scales the tilt. `ns` of unit length; so is the result, in
/// the hemisphere of `ns`. Where ∂p/∂u is singular the tangent follows from ∂p/∂v, and where that is
/// too, it is any.
///
/// Zero tilt is ½ in a float image but 128/255 in bytes, so everything from ½ to 128/255 is zero: above
/// it the value rises to 1 at 1 (in bytes (v − 128)/127), below it falls to −1 at 0.
pub fn perturbed_normal_from_map(rgb: Color, strength: f64, ns: DVec3, dpdu: DVec3, dpdv: DVec3) -> DVec3 {
    let tilt = DVec2::new(signed(rgb.x), signed(rgb.y)) * strength;
    if tilt == DVec2::ZERO || !tilt.is_finite() {
        return ns;
    }
    // A normal at or below the horizon is drawn by mistake; it is kept just above.
    let up = signed(rgb.z).max(1.0 / 127.0);
    let (s, t) = tangents(ns, dpdu, dpdv);
    (s * tilt.x + t * tilt.y + ns * up).try_normalize().unwrap_or(ns)
}

/// [0, 1] to [−1, 1] with both kinds of zero. NaN is 0.
fn signed(v: f32) -> f64 {
    const BYTE_ZERO: f32 = 128.0 / 255.0;
    let x = f64::from(v);
    let zero = f64::from(BYTE_ZERO);
    if v > BYTE_ZERO {
        ((x - zero) / (1.0 - zero)).min(1.0)
    } else if v < 0.5 {
        (2.0 * x - 1.0).max(-1.0)
    } else {
        0.0
    }
}

/// Unit tangents orthogonal to `ns` and to each other, along ∂p/∂u and toward ∂p/∂v.
fn tangents(ns: DVec3, dpdu: DVec3, dpdv: DVec3) -> (DVec3, DVec3) {
    if usable(ns, dpdu) {
        let frame = Frame::with_tangent(ns, dpdu);
        let t = if frame.t.dot(dpdv) < 0.0 { -frame.t } else { frame.t };
        return (frame.s, t);
    }
    let frame = Frame::with_tangent(ns, dpdv);
    if usable(ns, dpdv) { (-frame.t, frame.s) } else { (frame.s, frame.t) }
}

/// Whether a tangent keeps a direction once its share along the normal is taken away.
fn usable(ns: DVec3, tangent: DVec3) -> bool {
    let rest = tangent - ns * ns.dot(tangent);
    rest.is_finite() && rest.length_squared() > 1e-16 * tangent.length_squared()
}

/// The normal of the surface raised by a height h along `ns`: `slope` is (∂h/∂u, ∂h/∂v), in the unit of
/// the derivatives. n' ∝ n·|∂p/∂u × ∂p/∂v| ± (∂h/∂u · n × ∂p/∂v − ∂h/∂v · n × ∂p/∂u), with − where
/// (∂p/∂u, ∂p/∂v, `ng`) is left-handed. Unit, in the hemisphere of `ns`; `ns` itself for slope
/// zero and where the derivatives are singular.
pub fn bumped_normal(slope: DVec2, ns: DVec3, ng: DVec3, dpdu: DVec3, dpdv: DVec3) -> DVec3 {
    let cross = dpdu.cross(dpdv);
    let area = cross.length();
    if slope == DVec2::ZERO || !slope.is_finite() || area <= 1e-8 * dpdu.length() * dpdv.length() {
        return ns;
    }
    let side = if cross.dot(ng) < 0.0 { -1.0 } else { 1.0 };
    let tilt = ns.cross(dpdv) * slope.x - ns.cross(dpdu) * slope.y;
    (ns + tilt * (side / area)).try_normalize().unwrap_or(ns)
}
