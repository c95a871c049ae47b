//! The plan of terrain and water: a disc of triangles of even size, in five sectors of 72°, with k
//! edges a sector on ring k, from the axis to a rim that depends on the direction. Its rays at
//! multiples of 36° from +z run through the dodecahedron's upright edges, which stay sharp.

use super::solid::{Solid, turn};

/// A disc of `rings` rings.
pub struct Disc {
    pub rings: usize,
}

impl Disc {
    pub fn columns(&self) -> usize {
        5 * self.rings
    }

    /// The direction of rim column `j`.
    pub fn direction(&self, j: usize) -> (f64, f64) {
        turn(360.0 * j as f64 / self.columns() as f64)
    }

    /// Index of vertex `j` (wrapping) of `ring`; the centre is ring 0.
    pub fn index(&self, ring: usize, j: usize) -> usize {
        if ring == 0 { 0 } else { 1 + 5 * ring * (ring - 1) / 2 + j % (5 * ring) }
    }

    /// The plan (x, z) of each vertex, in the order of `index`; `rim` gives the last ring's radius.
    pub fn plan(&self, rim: impl Fn((f64, f64)) -> f64) -> Vec<[f64; 2]> {
        let mut plan = vec![[0.0; 2]];
        for ring in 1..=self.rings {
            for j in 0..5 * ring {
                let direction = turn(360.0 * j as f64 / (5 * ring) as f64);
                let r = rim(direction) * ring as f64 / self.rings as f64;
                plan.push([r * direction.0, r * direction.1]);
            }
        }
        plan
    }

    /// The triangles, counter-clockwise as seen from above (+y).
    pub fn faces(&self) -> Vec<[usize; 3]> {
        let mut faces = Vec::with_capacity(5 * self.rings * self.rings);
        for ring in 1..=self.rings {
            for sector in 0..5 {
                for j in 0..ring {
                    let outer = sector * ring + j;
                    let inner = sector * (ring - 1) + j;
                    let (a, b) = (self.index(ring, outer), self.index(ring, outer + 1));
                    let c = self.index(ring - 1, inner);
                    faces.push([a, b, c]);
                    if j + 1 < ring {
                        faces.push([c, b, self.index(ring - 1, inner + 1)]);
                    }
                }
            }
        }
        faces
    }
}

/// Where a surface of height `height(x, z)` meets the side of `solid` in a direction.
pub fn rim(solid: &Solid, direction: (f64, f64), height: impl Fn(f64, f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.45, 1.0);
    for _ in 0..26 {
        let r = 0.5 * (low + high);
        let y = height(r * direction.0, r * direction.1);
        if solid.radius(direction, y) > r {
            low = r;
        } else {
            high = r;
        }
    }
    0.5 * (low + high)
}
