//! Lamps and opaque things in one plane with the face of a glass: across a gap of no width, for photons and for
//! shadow rays as for the eye, whichever of the two faces rounding puts first.

use crate::render::meshes::{Obj, folder};
use crate::render::shot::{Shot, focused as shot};
use std::path::Path;
use terrarium::math::DVec3;

/// A horizontal unit square at this height, faces down.
fn sheet(y: f64) -> Obj {
    let vertices = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| DVec3::new(x, y, z));
    Obj { vertices: vertices.to_vec(), faces: vec![vec![0, 1, 2, 3]], ..Obj::default() }
}

fn quad(y: f64, material: &str) -> String {
    format!(
        r#"(shape: quad(size: (1, 1)), material: "{material}", transform: [rotate(axis: (1, 0, 0), deg: 180), translate((0, {y}, 0))])"#
    )
}

fn mesh(folder: &Path, y: f64, material: &str) -> String {
    let file = format!("sheet{y}.obj");
    sheet(y).write(&folder.join(&file));
    format!(r#"(shape: mesh(path: "{file}", smooth: false), material: "{material}")"#)
}

/// A white floor of side 1 at y = 0, seen from close above.
fn floor(folder: &Path, lights: &str, objects: &[String]) -> Shot {
    shot(format!(
        r#"(camera: (eye: (0, 0.3, 0), target: (0, 0, 0), up: (0, 0, -1), fov_deg: 60), image: (width: 16, height: 16),
        photons: progressive(count: 60000), render: (max_depth: 64),
        materials: {{
            "white": (diffuse: 1), "glass": (transmission: 1), "black": (diffuse: 0), "lamp": (diffuse: 0, emission: 1),
            "water 1": (transmission: 1, ior: "water", priority: 1), "water -1": (transmission: 1, ior: "water", priority: -1),
        }},
        lights: {{ {lights} }},
        objects: [(shape: quad(size: (1, 1)), material: "white"), {}])"#,
        objects.join(", ")
    ))
    .folder(folder)
    .passes(12)
}

const GLASS: &str = r#"(shape: box(size: (1, 0.1, 1), center: (0, 0.45, 0)), material: "glass")"#;

#[test]
fn a_lamp_flush_with_glass_shines_through_its_face_as_one_just_above_it() {
    let dir = folder();
    let lit = |name: &str, y: f64| {
        let (mut lights, mut objects) = (String::new(), vec![GLASS.to_owned()]);
        match name {
            "quad" => objects.push(quad(y, "lamp")),
            "mesh" => objects.push(mesh(dir.path(), y, "lamp")),
            "box" => objects.push(format!(
                r#"(shape: box(size: (1, 0.1, 1), center: (0, {}, 0)), material: "lamp")"#,
                y + 0.05
            )),
            _ => {
                lights = format!(
                    r#""l": quad(corner: (-0.5, {y}, -0.5), edge_u: (1, 0, 0), edge_v: (0, 0, 1), radiance: 1)"#
                );
            }
        }
        floor(dir.path(), &lights, &objects).render().mean()
    };
    let above = lit("quad", 0.501);
    for name in ["quad", "mesh", "box", "light"] {
        let flush = lit(name, 0.5);
        assert!((flush / above - 1.0).abs() < 0.03, "{name}: {flush}, and {above} from above");
    }
    // What is immersed sends only the part of its light out that meets the faces within the critical angle.
    let immersed = lit("quad", 0.499);
    assert!(immersed < 0.55 * above, "{immersed}, and {above} from above");
}

/// On a face that looks up, down or to the side, of a box and of a mesh, on an edge, and where glass and water touch.
#[test]
fn a_lamp_without_extent_on_a_face_of_glass_is_outside() {
    let dir = folder();
    let low = r#"(shape: box(size: (0.8, 0.2, 0.8), center: (0, 0.1, 0)), material: "glass")"#;
    let water = r#"(shape: box(size: (1, 0.25, 1), center: (0, 0.325, 0)), material: "water -1")"#;
    let bar = r#"(shape: box(size: (0.2, 0.1, 1), center: (0, 0.45, 0)), material: "glass")"#;
    let corners = [(-0.4, 0.2), (0.4, 0.2), (0.4, 0.0), (-0.4, 0.0)];
    let vertices = [0.4, -0.4].into_iter().flat_map(|z| corners.map(|(x, y)| DVec3::new(x, y, z)));
    let faces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [1, 2, 6, 5], [3, 0, 4, 7]];
    let block = Obj { vertices: vertices.collect(), faces: faces.map(Vec::from).to_vec(), ..Obj::default() };
    block.write(&dir.path().join("block.obj"));
    let block = r#"(shape: mesh(path: "block.obj", smooth: false), material: "glass")"#;
    let lit = |lamp: &str, [x, y, z]: [f64; 3], objects: &[&str]| {
        let lights = match lamp {
            "point" => format!(r#""l": point(position: ({x}, {y}, {z}), intensity: 1)"#),
            _ => format!(
                r#""l": spot(position: ({x}, {y}, {z}), target: (0, 0, 0), intensity: 1, outer_deg: 60)"#
            ),
        };
        let objects: Vec<String> = objects.iter().map(|&object| object.to_owned()).collect();
        floor(dir.path(), &lights, &objects).passes(24).render().mean()
    };
    let cases: [(&[&str], [f64; 3], [f64; 3]); 7] = [
        (&[low], [0.05, 0.2, 0.02], [0.0, 1.0, 0.0]),
        (&[block], [0.05, 0.2, 0.02], [0.0, 1.0, 0.0]),
        (&[GLASS], [0.05, 0.5, 0.02], [0.0, 1.0, 0.0]),
        (&[GLASS], [0.05, 0.4, 0.02], [0.0, -1.0, 0.0]),
        (&[bar], [0.1, 0.45, 0.02], [1.0, 0.0, 0.0]),
        (&[bar], [0.1, 0.5, 0.02], [1.0, 1.0, 0.0]),
        (&[low, water], [0.05, 0.2, 0.02], [0.0, 1.0, 0.0]),
    ];
    for (objects, at, outwards) in cases {
        for lamp in ["point", "spot"] {
            let beside = std::array::from_fn(|axis| at[axis] + 5e-4 * outwards[axis]);
            let (flush, beside) = (lit(lamp, at, objects), lit(lamp, beside, objects));
            assert!(
                (flush / beside - 1.0).abs() < 0.03,
                "{lamp} {at:?} {objects:?}: {flush}, beside it {beside}"
            );
        }
    }
}

/// Water in glass, both flush with the lamp: the light crosses the face of what counts more.
#[test]
fn a_lamp_flush_with_two_media_shines_through_the_upper_one() {
    let dir = folder();
    for priority in [1, -1] {
        let lit = |y: f64| {
            let text = format!(
                r#"(shape: box(size: (0.8, 0.08, 0.8), center: (0, 0.46, 0)), material: "water {priority}")"#
            );
            floor(dir.path(), "", &[GLASS.to_owned(), text, quad(y, "lamp")]).render().mean()
        };
        let (flush, above) = (lit(0.5), lit(0.501));
        assert!((flush / above - 1.0).abs() < 0.03, "priority {priority}: {flush}, and {above} from above");
    }
}

/// A white plate in the middle of glass on which a lamp lies: light reaches it through the face of the glass only.
#[test]
fn what_lies_in_glass_sees_a_lamp_that_is_flush_with_it_by_refraction_only() {
    let dir = folder();
    let plate = |lamp: String| {
        let glass = r#"(shape: box(size: (2, 1, 2), center: (0, 0, 0)), material: "glass")"#;
        floor(dir.path(), "", &[glass.to_owned(), lamp]).render().mean()
    };
    let above = plate(quad(0.501, "lamp"));
    for lamp in [quad(0.5, "lamp"), mesh(dir.path(), 0.5, "lamp")] {
        let flush = plate(lamp);
        assert!((flush / above - 1.0).abs() < 0.03, "{flush}, and {above} from above");
    }
}

/// No ray slips between a black sheet and glass that it lies on, at heights that single precision has and has not.
#[test]
fn a_black_sheet_on_glass_lets_no_light_through() {
    let dir = folder();
    for y in [0.5, 0.37, 0.6] {
        let glass =
            format!(r#"(shape: box(size: (1, 0.1, 1), center: (0, {}, 0)), material: "glass")"#, y - 0.05);
        for sheet in [quad(y, "black"), mesh(dir.path(), y, "black")] {
            let mean = floor(dir.path(), "", &[glass.clone(), sheet, quad(y + 0.1, "lamp")]).render().mean();
            assert_eq!(mean, 0.0, "at {y}");
        }
    }
}
