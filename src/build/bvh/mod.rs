//! Bounding volume hierarchies with eight boxes a node, and their watertight traversal.
//!
//! [`Bvh`] is over boxes, for the instances and single shapes of a scene; [`TriangleBvh`] is over
//! the triangles of a mesh. Building: binned surface area heuristic (`binned`), then collapsed to
//! eight children a node (`collapse`). Traversal: `traverse`, with the slab test of `ray` and the
//! triangle test of `packet`; large trees lie on huge pages (`store`). Sources stand in those files. All of it gives the same bits on any
//! machine and for any number of threads.

mod binned;
mod collapse;
mod few;
mod mesh;
mod node;
mod overlap;
mod packet;
mod ray;
mod store;
#[cfg(test)]
mod tests;
mod traverse;
mod tree;

pub use mesh::TriangleBvh;
pub use packet::TriangleHit;
pub use ray::BoxRay;
pub use tree::Bvh;
