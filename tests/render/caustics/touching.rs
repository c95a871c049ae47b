//! Glass that touches what is opaque from several sides, shines itself, or is painted and cut by something else.

use super::beneath::block;
use crate::render::meshes::folder;
use crate::render::shot::{Shot, focused as shot};
use std::path::Path;
use terrarium::math::DVec3;

/// Seen from straight above the origin, `eye` metres over it.
fn from_above(folder: &Path, eye: f64, scene: &str) -> Shot {
    shot(format!(
        r#"(camera: (eye: (0, {eye}, 0), target: (0, 0, 0), up: (0, 0, -1), fov_deg: 30), image: (width: 24, height: 12),
        photons: progressive(count: 60000), render: (max_depth: 64),
        textures: {{ "squares": checker(a: 1, b: 0, squares: (4, 4)) }},
        materials: {{
            "white": (diffuse: 1), "black": (diffuse: 0), "mirror": (reflection: 1), "glass": (transmission: 1),
            "water": (transmission: 1, ior: "water"), "painted": (transmission: 0.5, diffuse: 1),
            "glowing": (transmission: 1, emission: 1), "squares": (transmission: texture("squares"), diffuse: 1),
        }},
        {scene})"#
    ))
    .folder(folder)
    .passes(16)
}

fn boxed(min: [f64; 3], max: [f64; 3], material: &str) -> String {
    let [size, center]: [[f64; 3]; 2] =
        [std::array::from_fn(|i| max[i] - min[i]), std::array::from_fn(|i| 0.5 * (min[i] + max[i]))];
    let tuple = |v: [f64; 3]| format!("({}, {}, {})", v[0], v[1], v[2]);
    format!(r#"(shape: box(size: {}, center: {}), material: "{material}")"#, tuple(size), tuple(center))
}

const FLOOR: &str = r#"(shape: quad(size: (1, 1)), material: "white")"#;

/// White paint and white or mirroring things, and clear glass and water around them: none of them absorbs anything, so
/// that in light which is the same from everywhere they look like it. The floor is thin, and lit from below; the
/// squares of paint are as bright at their edges as within, though no photons lie beside them.
#[test]
fn what_absorbs_nothing_is_lost_in_even_light() {
    let dir = folder();
    let pane = boxed([-0.5, 0.0, -0.5], [0.5, 0.1, 0.5], "painted");
    let mut scenes = vec![("painted glass on a sheet".to_owned(), format!("{FLOOR}, {pane}"))];
    scenes.push((
        "glass and paint in squares".to_owned(),
        boxed([-0.5, 0.0, -0.5], [0.5, 0.1, 0.5], "squares"),
    ));
    for stone in ["mirror", "white"] {
        // Its upper face is the water's surface, and the glass's lower face.
        let pool = [
            boxed([-0.5, -0.2, -0.5], [0.5, 0.0, 0.5], "water"),
            boxed([-0.2, -0.15, -0.2], [0.2, 0.0, 0.2], stone),
            boxed([-0.2, 0.0, -0.2], [0.2, 0.1, 0.2], "glass"),
        ];
        scenes.push((format!("glass on {stone} in water"), pool.join(", ")));
    }
    for (name, objects) in scenes {
        for by in ["paths", "photons"] {
            let light = r#"lights: { "sky": environment(map: constant(1)) }, indirect: true"#;
            let scene = format!("{light}, indirect_by: {by}, objects: [{objects}]");
            let mean = from_above(dir.path(), 0.5, &scene).render().mean();
            assert!((mean - 1.0).abs() < 0.02, "{name}, {by}: {mean}");
        }
    }
}

/// Its own light crosses no gap.
#[test]
fn glass_that_shines_lights_what_it_stands_on() {
    let dir = folder();
    let lit = |gap: f64| {
        let glass = boxed([-0.2, gap, -0.2], [0.2, gap + 0.1, 0.2], "glowing");
        from_above(dir.path(), 0.8, &format!("objects: [{FLOOR}, {glass}]")).render().mean()
    };
    let (flush, apart) = (lit(0.0), lit(1e-3));
    assert!((flush / apart - 1.0).abs() < 0.01, "{flush}, and {apart} across a gap");
}

/// Glass that is known badly, as it is far across, and has the lamp within its bounds lets no light past what is right
/// before the lamp.
#[test]
fn what_hides_a_lamp_hides_it_however_near_and_whatever_glass_is_around() {
    let dir = folder();
    let far = DVec3::splat(300.0);
    let mesh = block(far - 1.0, far).with(block(-far, 1.0 - far));
    mesh.write(&dir.path().join("far.obj"));
    let black =
        r#"(shape: quad(size: (0.5, 0.5)), material: "black", transform: [translate((0, 0.298, 0))])"#;
    let scene = format!(
        r#"lights: {{ "lamp": quad(corner: (-0.2, 0.3, -0.2), edge_u: (0.4, 0, 0), edge_v: (0, 0, 0.4), radiance: 1) }},
        objects: [{FLOOR}, {black}, (shape: mesh(path: "far.obj", smooth: false), material: "glass")]"#
    );
    assert_eq!(from_above(dir.path(), 0.25, &scene).passes(2).render().mean(), 0.0);
}

/// Light comes straight down through a pane. To the right something lies in the plane of painted glass, or painted
/// glass comes up through the floor: to the left of it light is even up to the last column of pixels.
#[test]
fn estimates_beside_painted_glass_are_even() {
    let dir = folder();
    let pane = boxed([-2.0, 0.5, -2.0], [2.0, 0.6, 2.0], "glass");
    let mat = |material| {
        format!(
            r#"(shape: quad(size: (0.5, 1)), material: "{material}", transform: [translate((0.25, 0, 0))])"#
        )
    };
    let painted = boxed([-0.5, -0.3, -0.5], [0.5, 0.0, 0.5], "painted");
    let floor = boxed([-0.5, -0.3, -0.5], [0.5, 0.0, 0.5], "white");
    let plate = boxed([0.0, -0.1, -0.5], [0.5, 0.001, 0.5], "painted");
    for (name, objects) in [
        ("white on painted glass", [&painted, &mat("white")]),
        ("black on painted glass", [&painted, &mat("black")]),
        ("painted glass in a floor", [&floor, &plate]),
    ] {
        let scene = format!(
            r#"lights: {{ "sun": directional(direction: (0, -1, 0), irradiance: 1) }}, objects: [{pane}, {}, {}]"#,
            objects[0], objects[1]
        );
        let picture = from_above(dir.path(), 0.4, &scene).passes(32).render();
        let column = |x: usize| {
            let red = picture.channel("", "R");
            (0..12).map(|y| f64::from(red[y * 24 + x])).sum::<f64>() / 12.0
        };
        let within = (4..10).map(column).sum::<f64>() / 6.0;
        let last = column(11) / within;
        assert!((last - 1.0).abs() < 0.04, "{name}: the last column is {last} of those before it");
    }
}
