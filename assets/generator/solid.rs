//! The regular dodecahedron that the landscape fills: circumradius 1 times a scale, standing on a
//! face (−y), a vertex of that face toward +z.

use glam::DVec3;

/// Distance of the faces from the centre for circumradius 1.
pub const INRADIUS: f64 = 0.794_654_472_291_766_1;
/// The scale of the cavity: the inner side of the glass.
pub const CAVITY: f64 = 0.96;
/// Neighbouring faces' normals have this cosine between them: 1/√5.
const ACROSS: f64 = 0.447_213_595_499_957_9;
/// 2/√5, its sine.
const ALONG: f64 = 0.894_427_190_999_915_9;

/// The outward unit normals: bottom, five lower sides, five upper sides, top.
pub fn normals() -> [DVec3; 12] {
    let mut normals = [DVec3::NEG_Y; 12];
    for k in 0..5 {
        // The lower faces look between the bottom vertices, the upper ones above them.
        let (sin_low, cos_low) = turn(36.0 + 72.0 * k as f64);
        let (sin_high, cos_high) = turn(72.0 * k as f64);
        normals[1 + k] = DVec3::new(ALONG * sin_low, -ACROSS, ALONG * cos_low);
        normals[6 + k] = DVec3::new(ALONG * sin_high, ACROSS, ALONG * cos_high);
    }
    normals[11] = DVec3::Y;
    normals
}

/// Sine and cosine of an angle in degrees, about y from +z toward +x.
pub fn turn(degrees: f64) -> (f64, f64) {
    libm::sincos(degrees.to_radians())
}

/// The solid scaled by `scale`.
pub struct Solid {
    normals: [DVec3; 12],
    distance: f64,
}

impl Solid {
    pub fn new(scale: f64) -> Self {
        Self { normals: normals(), distance: scale * INRADIUS }
    }

    /// The height of its lowest face.
    pub fn floor(&self) -> f64 {
        -self.distance
    }

    /// How far `p` is inside, negative outside: the least distance to a face's plane.
    pub fn depth(&self, p: DVec3) -> f64 {
        self.normals.iter().fold(f64::MAX, |least, n| least.min(self.distance - n.dot(p)))
    }

    /// Distance from the axis to the side at height `y`, in the direction (sin, cos) of `turn`.
    pub fn radius(&self, (sin, cos): (f64, f64), y: f64) -> f64 {
        let reach = |n: &DVec3| {
            let along = n.x * sin + n.z * cos;
            if along > 1e-9 { (self.distance - n.y * y) / along } else { f64::MAX }
        };
        self.normals[1..11].iter().map(reach).fold(f64::MAX, f64::min)
    }

    /// The height at which the side leans neither in nor out in that direction: its widest place.
    pub fn widest(&self, direction: (f64, f64)) -> f64 {
        // The radius is concave in y: golden section would do, halving the slope's sign is exact.
        let (mut low, mut high) = (-self.distance, self.distance);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let step = 1e-7;
            if self.radius(direction, middle + step) > self.radius(direction, middle - step) {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// The normal of the side face that `p` is nearest to.
    pub fn side_normal(&self, p: DVec3) -> usize {
        let gap = |i: usize| self.distance - self.normals[i].dot(p);
        (1..11).min_by(|&a, &b| gap(a).total_cmp(&gap(b))).expect("the solid has ten sides")
    }
}
