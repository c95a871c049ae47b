//! Objects: a shape, its material and its place.

use super::{NameMap, Transform, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A shape of some material, placed by a list of transforms.
///
/// ```ron
/// objects: [(name: "ball", shape: sphere(), material: "glass", transform: [translate((0, 1, 0))])]
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// For messages, `--set`, `scatter` and the object-id layer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    pub shape: Shape,
    /// A name of `materials`. Objects within a group that have none take the group's; a mesh needs none
    /// whose `parts` name all of its parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transform: Vec<Transform>,
}

/// Shapes. Solids of revolution stand on the plane y = 0 with +y for their axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A sphere around `center`.
    ///
    /// ```ron
    /// objects: [(shape: sphere(radius: 0.5, center: (0, 1, 0)), material: "glass")]
    /// ```
    Sphere {
        #[serde(default = "one")]
        radius: f64,
        #[serde(default)]
        center: Vector,
    },
    /// A box of edge lengths `size` around `center`.
    ///
    /// ```ron
    /// objects: [(shape: box(size: (1, 2, 1)), material: "glass")]
    /// ```
    Box {
        #[serde(default = "ones")]
        size: Vector,
        #[serde(default)]
        center: Vector,
    },
    /// From `radius` at y = 0 to `top_radius` at y = `height`; 0 is a point.
    ///
    /// ```ron
    /// objects: [(shape: cone(radius: 1, height: 2, top_radius: 0.5, caps: false), material: "glass")]
    /// ```
    Cone {
        #[serde(default = "one")]
        radius: f64,
        #[serde(default = "one")]
        height: f64,
        #[serde(default)]
        top_radius: f64,
        #[serde(default = "yes")]
        caps: bool,
    },
    /// A cylinder of `radius` from y = 0 to y = `height`.
    ///
    /// ```ron
    /// objects: [(shape: cylinder(radius: 0.2, height: 2), material: "glass")]
    /// ```
    Cylinder {
        #[serde(default = "one")]
        radius: f64,
        #[serde(default = "one")]
        height: f64,
        #[serde(default = "yes")]
        caps: bool,
    },
    /// In the plane y = 0 around the origin, normal +y. `inner_radius` makes a ring.
    ///
    /// ```ron
    /// objects: [(shape: disk(radius: 1, inner_radius: 0.5), material: "glass")]
    /// ```
    Disk {
        #[serde(default = "one")]
        radius: f64,
        #[serde(default)]
        inner_radius: f64,
    },
    /// A rectangle of `size` (x, z) in the plane y = 0 around the origin, normal +y.
    ///
    /// ```ron
    /// objects: [(shape: quad(size: (4, 3)), material: "table")]
    /// ```
    Quad {
        #[serde(default = "one_by_one")]
        size: [f64; 2],
    },
    /// A regular solid with its corners at `radius` from the origin, standing on a face (the normal of
    /// that face is −y).
    ///
    /// ```ron
    /// objects: [(shape: polyhedron(kind: dodecahedron, radius: 0.8), material: "glass")]
    /// ```
    Polyhedron {
        kind: Polyhedron,
        #[serde(default = "one")]
        radius: f64,
    },
    /// A Wavefront OBJ file; the path is relative to the scene file.
    ///
    /// ```ron
    /// objects: [(shape: mesh(path: "tree.obj", smooth: false, parts: { "leaves": "leaf" }), material: "bark")]
    /// ```
    Mesh {
        path: String,
        #[serde(default)]
        smooth: Smooth,
        /// Materials by the file's own group, object or `usemtl` names; the rest takes the object's material.
        #[serde(default, skip_serializing_if = "NameMap::is_empty")]
        parts: NameMap<String>,
    },
    /// Objects that are placed together.
    ///
    /// ```ron
    /// objects: [(shape: group(objects: [(shape: sphere()), (shape: box())]), material: "glass")]
    /// ```
    Group {
        objects: Vec<Object>,
    },
    /// A copy of an entry of `definitions`. Meshes are stored once however often they appear.
    ///
    /// ```ron
    /// definitions: { "tree": (shape: mesh(path: "tree.obj"), material: "bark") },
    /// objects: [(shape: instance(of: "tree"), transform: [scale(2)])]
    /// ```
    Instance {
        of: String,
    },
    Scatter(Box<Scatter>),
}

/// Copies of an object strewn over a surface, uniformly by area, from a seed.
///
/// ```ron
/// objects: [(shape: scatter(of: ["blade"], over: "lawn", count: 5000, scale: (0.8, 1.2), max_slope_deg: 40, align: 0.5))]
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scatter {
    /// Entries of `definitions` to choose from with equal chance.
    pub of: Vec<String>,
    /// The surface: the name of a placed object (in a group too), where it stands; or an entry of
    /// `definitions`, in this object's own coordinates (it carries, and is not seen itself).
    pub over: String,
    /// Copies, 1 to 10 million. Places that `max_slope_deg` rules out are drawn again.
    pub count: u32,
    #[serde(default)]
    pub seed: u64,
    /// Smallest and largest factor of size.
    #[serde(default = "unit_range")]
    pub scale: [f64; 2],
    /// Smallest and largest turn about the copy's own +y, degrees.
    #[serde(default = "full_turn")]
    pub turn_deg: [f64; 2],
    /// Steepest ground that still carries a copy: angle between its normal and +y, degrees.
    #[serde(default = "any_slope")]
    pub max_slope_deg: f64,
    /// 0 keeps copies upright (+y), 1 stands them on the surface's normal.
    #[serde(default)]
    pub align: f64,
    /// How deep a copy is sunk into the ground, metres before its scale.
    #[serde(default)]
    pub sink_m: f64,
}

/// ```ron
/// objects: [
///     (shape: polyhedron(kind: tetrahedron), material: "glass"),
///     (shape: polyhedron(kind: cube), material: "glass"),
///     (shape: polyhedron(kind: octahedron), material: "glass"),
///     (shape: polyhedron(kind: icosahedron), material: "glass"),
/// ]
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Polyhedron {
    Tetrahedron,
    Cube,
    Octahedron,
    Dodecahedron,
    Icosahedron,
}

/// Shading normals of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(from = "bool", into = "bool")]
pub enum Smooth {
    /// The file's normals, or angle-weighted averages where it has none.
    #[default]
    Interpolated,
    /// The triangles' own.
    Flat,
}

impl From<bool> for Smooth {
    fn from(smooth: bool) -> Self {
        if smooth { Smooth::Interpolated } else { Smooth::Flat }
    }
}

impl From<Smooth> for bool {
    fn from(smooth: Smooth) -> Self {
        smooth == Smooth::Interpolated
    }
}

fn one() -> f64 {
    1.0
}

fn ones() -> Vector {
    [1.0; 3]
}

fn one_by_one() -> [f64; 2] {
    [1.0; 2]
}

fn yes() -> bool {
    true
}

fn unit_range() -> [f64; 2] {
    [1.0, 1.0]
}

fn full_turn() -> [f64; 2] {
    [0.0, 360.0]
}

fn any_slope() -> f64 {
    90.0
}
