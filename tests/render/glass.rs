//! Glass: Fresnel's and Snell's laws in pictures, furnaces, nested and touching dielectrics.
//!
//! Directions are read off a ruler: a wall that emits red in proportion to its local x and green to
//! its local z, so that a pixel says where its ray has ended. `max_depth` keeps the one path that is meant.

use super::meshes::{Obj, folder, write_exr};
use super::shot::{Picture, assert_close, shot};
use std::path::Path;
use terrarium::math::DVec3;

fn write_ruler(folder: &Path) {
    write_exr(&folder.join("ruler.exr"), 2, 2, |x, y| [x as f32, y as f32, 1.0]);
}

/// The ruler's texture and material: between the four texel centres it is linear. (u, v) from 0.25 to
/// 0.75 are the whole quad.
const RULER: &str = r#"textures: { "ruler": image(path: "ruler.exr", wrap: clamp, uv: (scale: (0.5, 0.5), offset: (0.25, 0.25))) }"#;

/// Local (x, z) from −1/2 to 1/2 of the ruler quad's size, and the weight of the path (blue).
fn read(picture: &Picture) -> (f64, f64, f64) {
    let [r, g, b] = picture.rgb()[0].map(f64::from);
    (r / b, g / b, b)
}

/// A single ray from `eye` towards `target`.
pub(crate) fn ray(eye: DVec3, target: DVec3, max_depth: u32, rest: &str) -> String {
    format!(
        "(camera: (eye: ({:?}, {:?}, {:?}), target: ({:?}, {:?}, {:?}), up: (0.1, 0.2, 1), fov_deg: 1e-7), \
          image: (width: 1, height: 1), antialiasing: none, render: (max_depth: {max_depth}), {rest})",
        eye.x, eye.y, eye.z, target.x, target.y, target.z
    )
}

/// Where on a ruler of size 2 × 2 in the plane x = `wall` (facing −x) the ray ends: its y.
pub(crate) struct Ruler {
    pub(crate) folder: tempfile::TempDir,
    wall: f64,
}

impl Ruler {
    pub(crate) fn new(wall: f64) -> Ruler {
        let folder = folder();
        write_ruler(folder.path());
        Ruler { folder, wall }
    }

    /// (y on the wall, weight). The quad's own x is turned to y: rotation by 90° about z.
    pub(crate) fn measure(
        &self,
        eye: DVec3,
        dir: DVec3,
        max_depth: u32,
        materials: &str,
        objects: &str,
    ) -> (f64, f64) {
        let wall = format!(
            r#"(shape: quad(size: (4, 4)), material: "wall", transform: [rotate(axis: (0, 0, 1), deg: 90), translate(({:?}, 0, 0))])"#,
            self.wall
        );
        let rest = format!(
            r#"{RULER}, materials: {{ "wall": (emission: texture("ruler")), {materials} }}, objects: [{wall}, {objects}]"#
        );
        let picture = shot(ray(eye, eye + dir, max_depth, &rest)).folder(self.folder.path()).render();
        let (u, _, weight) = read(&picture);
        ((u - 0.5) * 4.0, weight)
    }
}

pub(crate) const GLASS: &str =
    r#""glass": (transmission: 1, ior: 1.5), "water": (transmission: 1, ior: 1.33)"#;

pub(crate) fn fresnel(cos_i: f64, eta: f64) -> f64 {
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let rs = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let rp = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    (rs * rs + rp * rp) / 2.0
}

#[test]
fn the_ruler_reads_where_a_free_ray_ends() {
    let ruler = Ruler::new(3.0);
    for slope in [-0.3, -0.1, 0.0, 0.05, 0.2] {
        let (y, weight) = ruler.measure(DVec3::new(-2.0, 0.1, 0.0), DVec3::new(1.0, slope, 0.0), 1, "", "");
        assert!((y - (0.1 + 5.0 * slope)).abs() < 2e-6, "{y} at slope {slope}");
        assert_eq!(weight, 1.0);
    }
}

/// A right-angled prism mirrors without loss but for its faces.
#[test]
fn total_internal_reflection_loses_nothing() {
    let ruler = Ruler::new(3.0);
    // Travels along +y, is turned to +x by the face x + y = 0 of glass at x + y < 0 … (normal (1, 1)).
    // Corners: right angle at (1, −1) would be outside; use the right angle at (−1, −1) mirrored: the long
    // face faces (−1, 1), glass below it.
    let outline = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)];
    let vertices = [-1.0, 1.0].iter().flat_map(|&z| outline.map(|p| p + DVec3::Z * z)).collect();
    let faces = vec![vec![0, 2, 1], vec![3, 4, 5], vec![0, 1, 4, 3], vec![1, 2, 5, 4], vec![2, 0, 3, 5]];
    Obj { vertices, normals: Vec::new(), faces }.write(&ruler.folder.path().join("prism.obj"));
    let prism = r#"(shape: mesh(path: "prism.obj", smooth: false), material: "glass")"#;
    let (y, weight) = ruler.measure(DVec3::new(0.25, -2.0, 0.0), DVec3::Y, 3, GLASS, prism);
    assert!((y - 0.25).abs() < 2e-6, "{y}");
    assert_close(weight, 0.96f64.powi(2), 1e-6);
}

/// Both reflections lost and returned: T = (1−R)/(1+R), R′ = 2R/(1+R).
#[test]
fn a_slab_between_two_glowing_walls_transmits_and_reflects_all() {
    for (deg, f) in [(0.0, 0.04), (60.0, 0.089_186_7), (85.0, fresnel(85f64.to_radians().cos(), 1.5))] {
        let angle = f64::to_radians(deg);
        let eye = DVec3::new(-angle.cos(), -angle.sin(), 0.0) * 2.0;
        let walls = |behind: f64, before: f64| {
            let rest = format!(
                r#"materials: {{ "behind": (emission: {behind}), "before": (emission: {before}), {GLASS} }},
                objects: [(shape: box(size: (0.01, 900, 900)), material: "glass"),
                (shape: quad(size: (900, 900)), material: "behind", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((5, 0, 0))]),
                (shape: quad(size: (900, 900)), material: "before", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((-5, 0, 0))])]"#
            );
            shot(ray(eye, DVec3::ZERO, 32, &rest)).passes(256).render().mean()
        };
        assert_close(walls(1.0, 0.0), (1.0 - f) / (1.0 + f), 2e-3);
        assert_close(walls(0.0, 1.0), 2.0 * f / (1.0 + f), 2e-2);
        assert_close(walls(1.0, 1.0), 1.0, 1e-3);
    }
}

/// Every pixel of an even glow of radiance 1, seen with `objects` in it.
pub(crate) fn furnace(folder: &Path, camera: &str, materials: &str, objects: &str, passes: u32) -> Picture {
    let scene = format!(
        r#"(camera: {camera}, image: (width: 24, height: 24), render: (max_depth: 1000),
        materials: {{ {materials} }}, lights: {{ "sky": environment(map: constant(1)) }}, objects: [{objects}])"#
    );
    shot(scene).folder(folder).passes(passes).render()
}

pub(crate) const AROUND: &str = "(eye: (2, 1.5, 3), target: (0, 0, 0), fov_deg: 45)";

/// How far the mean and the worst pixel are off what all should be, as shares of it.
pub(crate) fn unevenness(picture: &Picture, expected: f64) -> (f64, f64) {
    assert!(picture.is_sound());
    let off = |value: f64| (value / expected - 1.0).abs();
    (off(picture.mean()), picture.grey().into_iter().map(off).fold(0.0, f64::max))
}

/// Glass that stands on a table: however the two coincident faces round, the table is seen through both
/// faces of it, with all the reflections between them, (1 − F)/(1 + F), without a speckle.
#[test]
fn a_table_is_seen_through_glass_that_stands_on_it() {
    for (s, deg) in [(1.0, 0.0), (1.0, 20.0), (1e4, 20.0), (0.37, 33.0)] {
        let picture = shot(format!(
            r#"(camera: (eye: (0, {}, {}), target: (0, 0, 0), fov_deg: 5), image: (width: 24, height: 24), antialiasing: none,
            materials: {{ "table": (emission: 1), {GLASS} }},
            objects: [(shape: quad(size: (90, 90)), material: "table", transform: [rotate(axis: (0, 1, 0), deg: {deg}), scale({s})]),
                      (shape: box(), material: "glass", transform: [translate((0, 0.5, 0)), rotate(axis: (0, 1, 0), deg: {deg}), scale({s})])])"#,
            6.0 * s, 1.0 * s
        ))
        .passes(32)
        .render();
        // Light branches live on by chance: 32 passes leave 0.001 of that.
        let expected = 0.923_077;
        for value in picture.grey() {
            assert!(
                (value - expected).abs() < 0.003,
                "{value} through the glass at scale {s}, turned by {deg}°"
            );
        }
    }
}

/// Glass that stands exactly on a luminous table sends light through both of its faces, as glass that
/// is lifted does: (1 − F)² without inner reflections, at any scale and height. Oblique light obeys Snell
/// twice and ends where a lifted pane would send it.
#[test]
fn glass_in_contact_with_something_opaque_still_has_its_lower_face() {
    for scale in [1e-4, 1.0, 1e4] {
        for height in [0.0, 0.37, -123.456] {
            let y = height * scale;
            let eye = DVec3::new(0.1 * scale, y + 3.0 * scale, 0.05 * scale);
            let target = DVec3::new(0.1 * scale, y, 0.05 * scale);
            let rest = format!(
                r#"materials: {{ "table": (emission: 1), "glass": (transmission: 1, ior: 1.5) }}, objects: [
                    (shape: quad(size: ({q}, {q})), material: "table", transform: [translate((0, {y}, 0))]),
                    (shape: box(size: ({scale}, {scale}, {scale}), center: (0, {c}, 0)), material: "glass")]"#,
                q = 10.0 * scale,
                c = y + 0.5 * scale,
            );
            let weight = read(&shot(ray(eye, target, 2, &rest)).render()).2;
            assert_close(weight, 0.96 * 0.96, 1e-6);
        }
    }
}
