//! What lies under glass, flush with its face: light that a matt surface or a mirror sends on crosses that face as
//! light that arrives does, for photons, for eye paths and for shadow rays. Against closed forms, and against the
//! same things a small gap apart.

use crate::render::meshes::{Obj, folder};
use crate::render::shot::{Shot, focused as shot};
use std::path::Path;
use terrarium::math::{DAffine3, DVec3, rotation};

/// A box as a mesh.
pub fn block(min: DVec3, max: DVec3) -> Obj {
    let corner = |i: usize| {
        let pick = |bit: usize, lo: f64, hi: f64| if i & bit == 0 { lo } else { hi };
        DVec3::new(pick(4, min.x, max.x), pick(2, min.y, max.y), pick(1, min.z, max.z))
    };
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        .map(|f| f.to_vec());
    Obj { vertices: (0..8).map(corner).collect(), faces: faces.to_vec(), ..Obj::default() }
}

/// A floor of side 1 whose upper face is at 0, and glass of this height over it, `gap` above.
#[derive(Clone, Copy)]
struct Pane<'a> {
    folder: &'a Path,
    /// Of what shapes the two are made, and of which materials.
    shapes: [&'a str; 2],
    materials: [&'a str; 2],
    height: f64,
    gap: f64,
    /// Whether all of it is larger, and stands askew elsewhere.
    turned: bool,
}

const SHAPES: [[&str; 2]; 3] = [["quad", "box"], ["mesh", "box"], ["box", "mesh"]];

impl Pane<'_> {
    fn transform(&self) -> &'static str {
        if self.turned {
            "scale(1000), rotate(axis: (1, 0.3, 0.2), deg: 25), translate((0, 7.1, 0))"
        } else {
            ""
        }
    }

    fn objects(&self) -> String {
        let Pane { folder, shapes, materials, height, gap, .. } = self;
        let part = |i: usize, lo: f64, hi: f64| {
            let shape = match shapes[i] {
                "quad" => "quad(size: (1, 1))".to_owned(),
                "mesh" => {
                    let file = format!("{lo}-{hi}.obj");
                    block(DVec3::new(-0.5, lo, -0.5), DVec3::new(0.5, hi, 0.5)).write(&folder.join(&file));
                    format!(r#"mesh(path: "{file}", smooth: false)"#)
                }
                _ => format!("box(size: (1, {}, 1), center: (0, {}, 0))", hi - lo, 0.5 * (lo + hi)),
            };
            format!(r#"(shape: {shape}, material: "{}", transform: [{}])"#, materials[i], self.transform())
        };
        format!("{}, {}", part(0, -0.1, 0.0), part(1, *gap, gap + height))
    }

    /// Seen from straight above its middle, `eye` metres over it.
    fn shot(&self, eye: f64, scene: &str) -> Shot {
        let turn = if self.turned { rotation(DVec3::new(1.0, 0.3, 0.2), 25.0) } else { DAffine3::IDENTITY };
        let (scale, target) = if self.turned { (1000.0, DVec3::Y * 7.1) } else { (1.0, DVec3::ZERO) };
        let eye = target + turn.transform_vector3(DVec3::Y * eye * scale);
        let up = turn.transform_vector3(DVec3::NEG_Z);
        shot(format!(
            r#"(camera: (eye: {eye:?}, target: {target:?}, up: {up:?}, fov_deg: 20), image: (width: 12, height: 12),
            photons: progressive(count: 20000), render: (max_depth: 64),
            materials: {{
                "white": (diffuse: 1), "glass": (transmission: 1), "painted": (transmission: 0.5, diffuse: 0.8),
                "mirror": (diffuse: 0, reflection: 0.3), "lamp": (diffuse: 0, emission: 1),
            }},
            {scene})"#
        ).replace("DVec3(", "("))
        .folder(self.folder)
        .passes(8)
    }
}

/// In light that is the same from everywhere, what absorbs nothing looks like that light.
#[test]
fn white_under_glass_is_lost_in_even_light() {
    let dir = folder();
    for by in ["paths", "photons"] {
        for shapes in SHAPES {
            let materials = ["white", "glass"];
            let pane = Pane { folder: dir.path(), shapes, materials, height: 0.1, gap: 0.0, turned: false };
            let scene = format!(
                r#"lights: {{ "sky": environment(map: constant(1)) }}, indirect: true, indirect_by: {by},
                objects: [{}]"#,
                pane.objects()
            );
            let mean = pane.shot(0.5, &scene).render().mean();
            assert!((mean - 1.0).abs() < 0.01, "{shapes:?}, indirect light by {by}: {mean}");
        }
    }
}

/// A pane reflects Rp = 2R/(1+R) of what meets it straight on, R = ((n−1)/(n+1))², and lets Tp = 1−Rp through; with
/// a mirror of r behind it, it reflects Rp + Tp²·r/(1 − r·Rp).
#[test]
fn a_mirror_under_glass_reflects_what_both_faces_let_through() {
    let dir = folder();
    let (r, rp): (f64, f64) = (0.3, 2.0 * 0.04 / 1.04);
    let expected = rp + (1.0 - rp).powi(2) * r / (1.0 - r * rp);
    for shapes in SHAPES {
        for turned in [false, true] {
            let materials = ["mirror", "glass"];
            let pane = Pane { folder: dir.path(), shapes, materials, height: 0.1, gap: 0.0, turned };
            let scene = format!(r#"background: 1, objects: [{}]"#, pane.objects());
            let mean = pane.shot(2.0, &scene).render().mean();
            assert!(
                (mean / expected - 1.0).abs() < 0.005,
                "{shapes:?}, turned {turned}: {mean}, not {expected}"
            );
        }
    }
}

/// Whatever the two are made of and wherever they stand.
#[test]
fn what_is_flush_looks_as_across_a_small_gap() {
    let dir = folder();
    let cases = [
        // What the floor sends on into the glass.
        ("indirect: true, indirect_by: photons, ", "glass", 0.1, 0.2),
        ("indirect: true, indirect_by: paths, ", "glass", 0.1, 0.2),
        // What is half paint keeps photons on both of its sides, next to those of the floor.
        ("indirect: true, indirect_by: photons, ", "painted", 0.1, 0.2),
        ("indirect: true, indirect_by: paths, ", "painted", 0.1, 0.2),
        // A lamp inside of the glass lights the floor through the lower face only.
        ("", "glass", 0.5, 0.25),
    ];
    for (indirect, glass, height, lamp) in cases {
        for shapes in SHAPES {
            for turned in [false, true] {
                let shine = |gap: f64| {
                    let materials = ["white", glass];
                    let pane = Pane { folder: dir.path(), shapes, materials, height, gap, turned };
                    let objects = format!(
                        r#"{}, (shape: box(size: (0.3, 0.02, 0.3), center: (0, {lamp}, 0)), material: "lamp", transform: [{}])"#,
                        pane.objects(),
                        pane.transform()
                    );
                    let eye = if height > lamp { 0.8 } else { 0.18 };
                    pane.shot(eye, &format!("{indirect}objects: [{objects}]")).render().mean()
                };
                let (flush, apart) = (shine(0.0), shine(5e-4));
                assert!(
                    (flush / apart - 1.0).abs() < 0.01,
                    "{indirect}{glass} {shapes:?}, turned {turned}: {flush}, and {apart} across a gap"
                );
            }
        }
    }
}

/// The glass is known to single precision, which has none of these heights; shadow rays go up to the lamp all the same.
#[test]
fn a_lamp_flush_with_the_underside_of_glass_lights_what_is_below() {
    let dir = folder();
    let materials = ["white", "glass"];
    for y in [0.37, 0.61, 0.123] {
        let quad = format!(
            r#"quad(corner: (-0.3, {y}, -0.3), edge_u: (0.6, 0, 0), edge_v: (0, 0, 0.6), radiance: 1)"#
        );
        let placed = format!(
            r#"(shape: quad(size: (0.6, 0.6)), material: "lamp", transform: [rotate(axis: (1, 0, 0), deg: 180), translate((0, {y}, 0))])"#
        );
        for (light, object) in [(format!(r#""lamp": {quad}"#), String::new()), (String::new(), placed)] {
            let lit = |gap: f64| {
                let shapes = ["quad", "mesh"];
                let pane = Pane { folder: dir.path(), shapes, materials, height: 0.1, gap, turned: false };
                let scene = format!("lights: {{ {light} }}, objects: [{}, {object}]", pane.objects());
                pane.shot(0.1, &scene).render().mean()
            };
            let (flush, above) = (lit(y), lit(y + 1e-3));
            assert!(
                (flush / above - 1.0).abs() < 1e-3,
                "{y}: {flush}, and {above} under glass a little higher"
            );
        }
    }
}
