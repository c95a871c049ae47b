//! The camera as image files describe it: matrices from the world to the picture.
//!
//! OpenEXR's `worldToCamera` and `worldToNDC` are for row vectors (p' = p · M, translation in the
//! last row) and a left-handed camera space: +x right, +y up, +z forward. Its normalised device
//! coordinates run from (0, 0) in the top left corner to (1, 1) in the bottom right. The scene's
//! camera is right-handed and looks along −z; the change of hand is the sign of the third column.
//! Source: OpenEXR's "Standard Optional Attributes".

use serde::{Deserialize, Serialize};

/// Where the camera stands and what it sees. `right`, `up` and `forward` are orthonormal, with
/// `right = forward × up`; lengths in metres, `fov_deg` the vertical field of view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct CameraView {
    pub eye: [f64; 3],
    pub right: [f64; 3],
    pub up: [f64; 3],
    pub forward: [f64; 3],
    pub fov_deg: f64,
    /// Width over height.
    pub aspect: f64,
    /// Diameter of the lens; 0 is a pinhole.
    pub aperture_m: f64,
    /// Distance of the sharp plane along the view direction.
    pub focus_m: f64,
}

/// Rows of a 4 × 4 matrix for row vectors.
pub type Matrix = [[f64; 4]; 4];

impl CameraView {
    /// World to left-handed camera space.
    pub fn world_to_camera(&self) -> Matrix {
        let columns = [self.right, self.up, self.forward];
        let mut matrix = [[0.0; 4]; 4];
        for (c, axis) in columns.iter().enumerate() {
            for r in 0..3 {
                matrix[r][c] = axis[r];
                matrix[3][c] -= self.eye[r] * axis[r];
            }
        }
        matrix[3][3] = 1.0;
        matrix
    }

    /// World to normalised device coordinates, after division by the fourth component.
    pub fn world_to_ndc(&self) -> Matrix {
        let half_height = self.half_height();
        let camera = self.world_to_camera();
        camera.map(|[x, y, z, w]| {
            // (x / (2 tan(fov/2) · aspect) + z/2,  z/2 − y / (2 tan(fov/2)),  w,  z), over z
            [0.5 * (x / (half_height * self.aspect) + z), 0.5 * (z - y / half_height), w, z]
        })
    }

    /// Horizontal field of view in degrees.
    pub fn horizontal_fov_deg(&self) -> f64 {
        2.0 * libm::atan(self.half_height() * self.aspect).to_degrees()
    }

    /// Half the height of the picture plane at distance 1.
    fn half_height(&self) -> f64 {
        libm::tan(0.5 * self.fov_deg.to_radians())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(p: [f64; 3], m: Matrix) -> [f64; 4] {
        let p = [p[0], p[1], p[2], 1.0];
        std::array::from_fn(|c| (0..4).map(|r| p[r] * m[r][c]).sum())
    }

    /// At (1, 2, 3), looking along −z, 90° high, twice as wide.
    fn view() -> CameraView {
        CameraView {
            eye: [1.0, 2.0, 3.0],
            right: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            forward: [0.0, 0.0, -1.0],
            fov_deg: 90.0,
            aspect: 2.0,
            aperture_m: 0.0,
            focus_m: 5.0,
        }
    }

    #[test]
    fn what_lies_ahead_has_positive_z_and_the_hand_changes() {
        let m = view().world_to_camera();
        assert_eq!(times([1.0, 2.0, -7.0], m), [0.0, 0.0, 10.0, 1.0]);
        assert_eq!(times([4.0, 6.0, 3.0], m), [3.0, 4.0, 0.0, 1.0]);
        let det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
        assert_eq!(det, -1.0);
    }

    #[test]
    fn the_corners_of_the_picture_are_the_corners_of_ndc() {
        let view = view();
        let m = view.world_to_ndc();
        for (point, expected) in [
            ([1.0, 2.0, -7.0], [0.5, 0.5]),
            ([1.0 - 20.0, 2.0 + 10.0, -7.0], [0.0, 0.0]),
            ([1.0 + 20.0, 2.0 - 10.0, -7.0], [1.0, 1.0]),
            ([1.0 + 1.0, 2.0 + 1.0, 1.0], [0.625, 0.25]),
        ] {
            let [x, y, _, w] = times(point, m);
            assert!((x / w - expected[0]).abs() < 1e-12 && (y / w - expected[1]).abs() < 1e-12);
        }
        assert!((view.horizontal_fov_deg() - 126.86989764584402).abs() < 1e-10);
    }
}
