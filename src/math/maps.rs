//! Affine maps by what they do.

use super::{DAffine3, DMat3, DVec3};

/// A turn by `deg` degrees about an axis through the origin, of any length but 0; exact for multiples of 90°.
pub fn rotation(axis: DVec3, deg: f64) -> DAffine3 {
    let (sin, cos) = match deg.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => libm::sincos(other.to_radians()),
    };
    let a = axis.normalize();
    // Rodrigues' formula, column by column.
    let column = |e: DVec3| e * cos + a.cross(e) * sin + a * (a.dot(e) * (1.0 - cos));
    DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z)))
}

/// Takes the unit square across +y to the parallelogram of two edges, its own normal to `edge_u × edge_v`, as long as
/// the root of the area.
pub fn parallelogram(edge_u: DVec3, edge_v: DVec3) -> DMat3 {
    let normal = edge_u.cross(edge_v);
    // z × x = +y
    DMat3::from_cols(edge_v, normal.normalize_or_zero() * normal.length().sqrt(), edge_u)
}
