//! The built world: placed geometry under one tree, and what a ray meets in it.
//!
//! Coordinates are metres from `World::origin`, a point near what the camera looks at, so that a
//! scene far from its origin renders the same. Rays and hits are double precision; trees are
//! traversed in single precision with every rounding bounded.

use super::bvh::{BoxRay, Bvh, TriangleBvh};
use super::contact::Contacts;
use super::media::Medium;
use super::sights::Sights;
use super::vista::Vista;
use crate::math::{Aabb, Color, DVec3, Placement, Ray, round_up};
use crate::optics::{
    Camera, Emitter, Environment, Material, MaterialId, Shape, ShapeHit, Spectrum, Texture, TriangleMesh,
};

/// Everything that rays need.
pub struct World {
    /// Where the renderer's coordinates begin, in the scene's.
    pub origin: DVec3,
    pub camera: Camera,
    pub geometries: Vec<Geometry>,
    pub instances: Vec<Instance>,
    /// Materials by part, for each binding that instances name.
    pub bindings: Vec<Vec<MaterialId>>,
    pub tree: Bvh,
    /// What a pinhole camera may see where, in scenes of few objects.
    pub vista: Option<Vista>,
    /// What lies around lamps and surfaces, in scenes of few objects.
    pub sights: Sights,
    pub materials: Vec<Material>,
    /// By material: its name in the scene, or that of the light with an extent that it was made for.
    pub material_names: Vec<String>,
    pub textures: Vec<Texture>,
    pub emitters: Vec<Emitter>,
    /// By emitter, whether it may lie in glass or touch it.
    pub emitters_in_glass: Vec<bool>,
    pub environment: Option<Environment>,
    /// Whether eye rays that leave the scene see the environment.
    pub environment_visible: bool,
    /// Insides of transmissive instances, by rank: a later one wins where several overlap.
    pub media: Vec<Medium>,
    /// The largest of the errors of their surfaces, metres.
    pub media_error: f64,
    /// Wavelengths, where a medium disperses.
    pub spectrum: Option<Spectrum>,
    /// What is opaque at the media's surfaces, by rank.
    pub contacts: Vec<Contacts>,
    /// Surfaces of transmissive instances that are closer together than this along the normal, in
    /// metres, are one interface; 0 where none overlap.
    pub coincidence: f64,
    pub background: Color,
    pub ambient: Color,
    /// Names for the object-id layer and messages.
    pub object_names: Vec<String>,
}

pub enum Geometry {
    Shape(Shape),
    Mesh(Mesh),
}

pub struct Mesh {
    pub surface: TriangleMesh,
    pub tree: TriangleBvh,
    /// Of the ball around the middle of its bounds that holds all vertices.
    pub radius: f64,
    pub name: String,
}

impl Mesh {
    pub fn new(surface: TriangleMesh, tree: TriangleBvh, name: String) -> Mesh {
        let middle = middle(&tree);
        let squares = surface.positions.iter().map(|p| p.as_dvec3().distance_squared(middle));
        let radius = squares.fold(0.0, f64::max).sqrt();
        Mesh { surface, tree, radius, name }
    }
}

fn middle(tree: &TriangleBvh) -> DVec3 {
    let bounds = tree.bounds();
    0.5 * (bounds.min.as_dvec3() + bounds.max.as_dvec3())
}

/// One placed geometry.
#[derive(Clone, Debug)]
pub struct Instance {
    pub geometry: u32,
    pub binding: u32,
    pub placement: Placement,
    /// Place in [`World::media`] plus one; 0 for what does not transmit.
    pub rank: u32,
    /// Index into [`World::object_names`].
    pub object: u32,
    /// Whether it lets light through and keeps no photons anywhere.
    pub clear: bool,
    /// If it is opaque: the largest of the errors of transmissive instances' faces that may lie in one plane with its
    /// own, metres. 0 where there are none.
    pub flush_error: f64,
    /// The middle one of the extents of its placed bounds, metres.
    pub breadth: f32,
    /// Whether rays can meet it. Hidden lights only send light.
    pub visible: bool,
}

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub t: f64,
    pub instance: u32,
    /// Face of a shape, triangle of a mesh.
    pub primitive: u32,
    /// Barycentric coordinates on a triangle.
    pub b: [f32; 3],
}

impl Geometry {
    pub fn bounds(&self) -> (DVec3, DVec3) {
        match self {
            Geometry::Shape(shape) => shape.bounds(),
            Geometry::Mesh(mesh) => {
                let b = mesh.tree.bounds();
                (b.min.as_dvec3(), b.max.as_dvec3())
            }
        }
    }

    /// The centre and radius of a ball around it in object space, but for rounding.
    pub fn ball(&self) -> (DVec3, f64) {
        match self {
            Geometry::Shape(shape) => shape.ball(),
            Geometry::Mesh(mesh) => (middle(&mesh.tree), mesh.radius),
        }
    }

    /// The nearest hit with 0 < t < t_max of a ray in object space.
    #[inline]
    fn nearest(&self, local: &Ray, t_max: f64) -> Option<(f64, u32, [f32; 3])> {
        match self {
            Geometry::Shape(shape) => shape.nearest(local, 0.0, t_max).map(|h| (h.t, h.face, [0.0; 3])),
            Geometry::Mesh(mesh) => mesh
                .tree
                .nearest(&BoxRay::rounded(local), round_up(t_max))
                .map(|h| (f64::from(h.t), h.triangle, h.b)),
        }
    }

    #[inline]
    fn any(&self, local: &Ray, t_max: f64) -> bool {
        match self {
            Geometry::Shape(shape) => shape.nearest(local, 0.0, t_max).is_some(),
            Geometry::Mesh(mesh) => mesh.tree.any(&BoxRay::rounded(local), t_max as f32),
        }
    }
}

impl World {
    /// The nearest hit with 0 < t < t_max.
    #[inline(never)]
    pub fn nearest(&self, ray: &Ray, t_max: f64) -> Option<Hit> {
        let mut best = Hit { t: t_max, instance: 0, primitive: 0, b: [0.0; 3] };
        let mut met = false;
        self.tree.nearest(
            &BoxRay::rounded(ray),
            round_up(t_max),
            #[inline(always)]
            |instance, _| {
                let nearer = self.nearer(instance, ray, &mut best);
                met |= nearer;
                nearer.then(|| round_up(best.t))
            },
        );
        met.then_some(best)
    }

    /// Puts a hit of one instance at 0 < t < best.t in the place of `best`. Whether there is one.
    #[inline(always)]
    pub(super) fn nearer(&self, instance: u32, ray: &Ray, best: &mut Hit) -> bool {
        let placed = &self.instances[instance as usize];
        let local = placed.placement.local_ray(ray);
        match &self.geometries[placed.geometry as usize] {
            Geometry::Shape(shape) => {
                let Some(ShapeHit { t, face }) = shape.nearest(&local, 0.0, best.t) else { return false };
                *best = Hit { t, instance, primitive: face, b: [0.0; 3] };
            }
            Geometry::Mesh(mesh) => {
                let Some(h) = mesh.tree.nearest(&BoxRay::rounded(&local), round_up(best.t)) else {
                    return false;
                };
                *best = Hit { t: f64::from(h.t), instance, primitive: h.triangle, b: h.b };
            }
        }
        true
    }

    /// The nearest hit of one instance with 0 < t < t_max.
    #[inline]
    pub fn nearest_of(&self, instance: u32, ray: &Ray, t_max: f64) -> Option<Hit> {
        let placed = &self.instances[instance as usize];
        let local = placed.placement.local_ray(ray);
        let (t, primitive, b) = self.geometries[placed.geometry as usize].nearest(&local, t_max)?;
        Some(Hit { t, instance, primitive, b })
    }

    /// Whether anything but `except` lies on the ray at 0 < t < t_max. The direction may be of any length.
    #[inline(never)]
    pub fn occluded(&self, ray: &Ray, t_max: f64, except: Option<u32>) -> bool {
        self.tree.any(&BoxRay::rounded(ray), round_up(t_max), |instance| {
            if except == Some(instance) {
                return false;
            }
            self.hides(instance, ray, t_max)
        })
    }

    /// The share of the way from `ray`'s origin to the point `p` of an instance, at its end, on which what is met may
    /// lie in one plane with that point: a ceiling in which a lamp is set. It is a thousand times what the point is
    /// known to, which covers slopes of 1 : 1000, and 1 where that is more than the way.
    #[inline]
    pub fn flush(&self, ray: &Ray, p: DVec3, instance: u32) -> f64 {
        const GRAZING: f64 = 1e3;
        const ERROR: f64 = 32.0 * f64::EPSILON;
        let placement = &self.instances[instance as usize].placement;
        let own = placement.stretch() * placement.local_point(p).abs().max_element();
        let size = p.abs().max_element() + ray.origin.abs().max_element() + own;
        (GRAZING * ERROR * size / ray.dir.length()).min(1.0)
    }

    /// Whether an instance lies on the ray at 0 < t < t_max.
    #[inline]
    pub(super) fn hides(&self, instance: u32, ray: &Ray, t_max: f64) -> bool {
        let placed = &self.instances[instance as usize];
        let local = placed.placement.local_ray(ray);
        self.geometries[placed.geometry as usize].any(&local, t_max)
    }

    pub fn geometry(&self, instance: u32) -> &Geometry {
        &self.geometries[self.instances[instance as usize].geometry as usize]
    }

    /// World bounds of a placed geometry: of its eight placed corners, rounded outwards.
    pub fn placed_bounds(geometry: &Geometry, placement: &Placement) -> Aabb {
        let (min, max) = geometry.bounds();
        if !min.cmple(max).all() {
            return Aabb::EMPTY;
        }
        let corners = (0..8).map(|i| {
            let pick = |bit: u32, lo: f64, hi: f64| if i & bit == 0 { lo } else { hi };
            placement.point(DVec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z)))
        });
        let (lo, hi) =
            corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
        // Double-precision rounding of the placement itself.
        let pad = (lo.abs().max(hi.abs())) * 1e-14;
        Aabb::from_f64(lo - pad, hi + pad)
    }

    /// The hit of a shape again, for its surface.
    pub(super) fn shape_hit(hit: &Hit) -> ShapeHit {
        ShapeHit { t: hit.t, face: hit.primitive }
    }
}
