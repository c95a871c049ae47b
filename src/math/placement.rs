//! Affine placements of objects in the world, in double precision, with their inverses.

use super::Ray;
use glam::{DAffine3, DMat3, DVec3};

/// Where an object stands: the map from its own space to the world's and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    pub world_from_object: DAffine3,
    pub object_from_world: DAffine3,
    /// sign(det)·cofactors: takes outward normals to outward normals, mirrored placements included.
    normal_matrix: DMat3,
    /// The factor of volume, with its sign (negative for mirrored placements).
    det: f64,
    /// Mean factor of length: ∛|det|.
    scale: f64,
    /// Largest factor of length: a bound (Frobenius norm) on ‖M‖.
    stretch: f64,
    /// Smallest factor of length: a bound, the inverse of the inverse's Frobenius norm.
    least_stretch: f64,
    /// Whether the map moves without turning or scaling, as most do.
    translation_only: bool,
}

/// The most by which a map may stretch one direction beyond another. Rays in an object's own space have the
/// inverse's factors, of which rounding leaves nothing at 2^53 ≈ 1e16.
pub const MAX_SQUEEZE: f64 = 1e13;

/// Whether a map squeezes space more than [`MAX_SQUEEZE`] times as much one way as another, or has no inverse at
/// all: ‖M‖·‖M⁻¹‖ in Frobenius norms, computed on M over its largest factor so that no scale overflows.
pub fn flattens(matrix: &DMat3) -> bool {
    let largest = matrix.to_cols_array().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return true;
    }
    let m = *matrix * (1.0 / largest);
    let frobenius = |m: &DMat3| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
    // ‖M⁻¹‖ is that of the cofactors over the determinant.
    m.determinant().abs() * MAX_SQUEEZE <= frobenius(&m) * frobenius(&cofactors(&m))
}

fn cofactors(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}

impl Placement {
    pub const IDENTITY: Placement = Placement {
        world_from_object: DAffine3::IDENTITY,
        object_from_world: DAffine3::IDENTITY,
        normal_matrix: DMat3::IDENTITY,
        det: 1.0,
        scale: 1.0,
        stretch: 1.0,
        least_stretch: 1.0,
        translation_only: true,
    };

    /// `None` for a map that [`flattens`], or whose volume leaves the normal numbers.
    pub fn new(world_from_object: DAffine3) -> Option<Placement> {
        let m = world_from_object.matrix3;
        let det = m.determinant();
        let norm = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length()).length();
        if !world_from_object.is_finite() || !det.is_normal() || flattens(&m) {
            return None;
        }
        let inverse = world_from_object.inverse();
        let back = inverse.matrix3;
        let back_norm = DVec3::new(back.x_axis.length(), back.y_axis.length(), back.z_axis.length()).length();
        Some(Placement {
            world_from_object,
            object_from_world: inverse,
            normal_matrix: cofactors(&m) * det.signum(),
            det,
            scale: libm::cbrt(det.abs()),
            stretch: if m == DMat3::IDENTITY { 1.0 } else { norm },
            least_stretch: if turns_only(m) { 1.0 - 1e-9 } else { 1.0 / back_norm },
            translation_only: m == DMat3::IDENTITY,
        })
    }

    #[inline]
    pub fn point(&self, p: DVec3) -> DVec3 {
        if self.translation_only {
            return p + self.world_from_object.translation;
        }
        self.world_from_object.transform_point3(p)
    }

    #[inline]
    pub fn vector(&self, v: DVec3) -> DVec3 {
        if self.translation_only { v } else { self.world_from_object.transform_vector3(v) }
    }

    /// The unit world normal for a unit normal in object space.
    #[inline]
    pub fn unit_normal(&self, n: DVec3) -> DVec3 {
        if self.translation_only { n } else { self.normal(n) }
    }

    /// The unit world normal for an object-space normal of any length but zero.
    pub fn normal(&self, n: DVec3) -> DVec3 {
        (self.normal_matrix * n).normalize()
    }

    #[inline]
    pub fn local_point(&self, p: DVec3) -> DVec3 {
        if self.translation_only {
            return p + self.object_from_world.translation;
        }
        self.object_from_world.transform_point3(p)
    }

    #[inline]
    pub fn local_vector(&self, v: DVec3) -> DVec3 {
        if self.translation_only { v } else { self.object_from_world.transform_vector3(v) }
    }

    /// The ray in object space. Its direction is not normalised, so that t is the world's.
    #[inline]
    pub fn local_ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.local_point(ray.origin), dir: self.local_vector(ray.dir) }
    }

    pub fn mirrored(&self) -> bool {
        self.det < 0.0
    }

    pub fn det(&self) -> f64 {
        self.det
    }

    /// By how much the map stretches area across the object's unit normal `n`: |det M|·‖M⁻ᵀn‖.
    pub fn area_factor(&self, n: DVec3) -> f64 {
        self.det.abs() * (self.object_from_world.matrix3.transpose() * n).length()
    }

    /// The factor by which a length grows on the way to the world, over all directions.
    #[inline]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A lower bound on the factor by which any length grows on the way to the world.
    pub fn least_stretch(&self) -> f64 {
        self.least_stretch
    }

    /// An upper bound on the factor by which a length grows on the way to the world.
    #[inline]
    pub fn stretch(&self) -> f64 {
        self.stretch
    }
}

/// Whether a map keeps lengths, to rounding.
fn turns_only(m: DMat3) -> bool {
    (m.transpose() * m - DMat3::IDENTITY).to_cols_array().iter().all(|e| e.abs() < 1e-12)
}
