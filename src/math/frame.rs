//! Orthonormal frames around a direction.
//!
//! Duff, Burgess, Christensen, Hery, Kensler, Liani, Villemin: Building an Orthonormal Basis,
//! Revisited, JCGT 6(1), 2017.

use glam::DVec3;

/// A right-handed orthonormal basis (s, t, n).
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub s: DVec3,
    pub t: DVec3,
    pub n: DVec3,
}

impl Frame {
    /// Any frame whose third axis is the unit vector `n`. Continuous but for n.z changing sign.
    pub fn around(n: DVec3) -> Frame {
        let sign = 1.0_f64.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Frame {
            s: DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: DVec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// The frame whose third axis is `n` and whose first axis is `tangent` without its share along
    /// `n`; any frame around `n` where the tangent has no usable rest.
    pub fn with_tangent(n: DVec3, tangent: DVec3) -> Frame {
        let rest = tangent - n * n.dot(tangent);
        // Below this share the direction of the rest is mostly rounding noise.
        let usable = rest.length_squared() > 1e-16 * tangent.length_squared();
        match rest.try_normalize() {
            Some(s) if usable => Frame { s, t: n.cross(s), n },
            _ => Frame::around(n),
        }
    }

    pub fn to_world(&self, v: DVec3) -> DVec3 {
        self.s * v.x + self.t * v.y + self.n * v.z
    }

    pub fn to_local(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.s.dot(v), self.t.dot(v), self.n.dot(v))
    }
}
