//! Random scenes: whatever a scene says, the picture is finite, not negative, and gains no energy.

use super::meshes::{folder, icosphere};
use super::shot::shot;
use terrarium::math::random::{Counter, Stage};

struct Random(Counter);

impl Random {
    fn value(&mut self) -> f64 {
        self.0.value()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.value()
    }

    fn pick<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[((self.value() * of.len() as f64) as usize).min(of.len() - 1)]
    }

    fn vector(&mut self, reach: f64) -> String {
        let mut x = || self.between(-reach, reach);
        format!("({:e}, {:e}, {:e})", x(), x(), x())
    }

    fn shape(&mut self) -> String {
        let [a, b, c] = [0; 3].map(|_| self.between(0.05, 1.5));
        match (self.value() * 9.0) as u32 {
            0 => format!("sphere(radius: {a})"),
            1 => format!("box(size: ({a}, {b}, {c}))"),
            2 => format!(
                "cone(radius: {a}, height: {b}, top_radius: {}, caps: {})",
                self.pick(&["0", "0.3"]),
                self.pick(&["true", "false"])
            ),
            3 => format!("cylinder(radius: {a}, height: {b}, caps: {})", self.pick(&["true", "false"])),
            4 => format!("disk(radius: {a}, inner_radius: {})", a * self.value()),
            5 => format!("quad(size: ({a}, {b}))"),
            6 => {
                let kind = self.pick(&["tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron"]);
                format!("polyhedron(kind: {kind}, radius: {a})")
            }
            _ => format!(r#"mesh(path: "ball.obj", smooth: {})"#, self.pick(&["true", "false"])),
        }
    }

    fn material(&mut self) -> String {
        let [km, kt, kd] = [0; 3].map(|_| if self.value() < 0.4 { 0.0 } else { self.value() });
        let ks = 0.9 * self.value() * (1.0 - km) * (1.0 - kt) * (1.0 - kd);
        let (ior, priority) = (self.between(0.5, 2.5), (self.value() * 3.0) as i32);
        let absorption = if kt > 0.0 && self.value() < 0.3 { self.between(0.0, 5.0) } else { 0.0 };
        let relief = self.pick(&[
            "",
            "",
            "",
            r#", normal_map: (texture: "t", strength: 2)"#,
            r#", bump_map: (texture: "n", height_m: 0.2)"#,
        ]);
        format!(
            "reflection: {km}, transmission: {kt}, diffuse: {kd}, specular: {ks}, shininess: {}, ior: {ior}, priority: {priority}, absorption: {absorption}{relief}",
            self.between(1.0, 500.0)
        )
    }

    /// Sizes from `1/spread` to `spread`, mostly moderate; squashed and mirrored.
    fn transform(&mut self, spread: f64, unit: f64) -> String {
        let mut factor = || {
            let e = self.between(-1.0, 1.0);
            let sign = if self.value() < 0.3 { -1.0 } else { 1.0 };
            sign * libm::pow(spread, e * e * e) * unit
        };
        let scale = format!("({:e}, {:e}, {:e})", factor(), factor(), factor());
        format!(
            "scale({scale}), rotate(axis: (1, {}, {}), deg: {}), translate({})",
            self.value(),
            self.value(),
            self.between(0.0, 360.0),
            self.vector(2.0 * unit)
        )
    }

    fn scene(&mut self, lights: &str, spread: f64, unit: f64) -> String {
        let n = 2 + (self.value() * 5.0) as u32;
        let materials: String = (0..n).map(|i| format!(r#""m{i}": ({}), "#, self.material())).collect();
        let objects: String = (0..n)
            .map(|i| {
                let (shape, place) = (self.shape(), self.transform(spread, unit));
                format!(r#"(shape: {shape}, material: "m{i}", transform: [{place}]), "#)
            })
            .collect();
        let aa = self.pick(&["progressive", "progressive", "adaptive()", "none"]);
        format!(
            r#"(camera: (eye: {}, target: {}, aperture_m: {:e}), image: (width: 8, height: 6), antialiasing: {aa}, render: (max_depth: 60),
            textures: {{ "t": noise(a: 0, b: 1, size_m: 0.1), "n": noise(a: 0, b: 1, size_m: 0.3) }},
            materials: {{ {materials} }}, {lights}, objects: [{objects}])"#,
            self.vector(4.0 * unit),
            self.vector(unit),
            0.01 * unit * self.pick(&["0", "1"]).parse::<f64>().expect("a number"),
        )
    }
}

/// Finite, ≥ 0 and within n² of the glow, at moderate and at extreme proportions and units.
#[test]
fn random_scenes_in_an_even_glow_are_sound_and_gain_nothing() {
    let dir = folder();
    icosphere(1).write(&dir.path().join("ball.obj"));
    let mut random = Random(Counter::new(11, Stage::Test, 1));
    let lights = r#"lights: { "sky": environment(map: constant(1), samples: 4) }"#;
    let (mut worst, mut dropped) = (0.0, 0);
    for i in 0..140 {
        let spread = [2.0, 100.0, 1e6][i % 3];
        let unit = [1.0, 1e-6, 1e6, 1e-3][i % 4];
        let scene = random.scene(lights, spread, unit);
        let picture = shot(scene.clone()).folder(dir.path()).passes(4).render();
        assert!(picture.is_sound(), "scene {i}: {scene}");
        dropped += picture.rendered.stats.rare_events[0].count;
        assert_eq!(dropped, 0, "scene {i} has non-finite samples: {scene}");
        // An eye within a medium sees n² at most; noise on top of it.
        let mean = picture.mean();
        worst = f64::max(worst, mean);
        assert!(mean <= 2.5 * 2.5 * 1.2, "scene {i}: mean {mean}: {scene}");
    }
    println!("highest mean {worst}");
}

/// Lamps of every kind, emitting objects too, within the same wild scenes.
#[test]
fn random_scenes_under_every_light_are_sound() {
    let dir = folder();
    icosphere(1).write(&dir.path().join("ball.obj"));
    let mut random = Random(Counter::new(12, Stage::Test, 2));
    for i in 0..45 {
        let unit = [1.0, 1e-6, 1e6][i % 3];
        let mut at = || random.vector(4.0 * unit);
        let lights = format!(
            r#"background: 0.1, ambient: 0.05, lights: {{
            "a": point(position: {}, intensity: {i0:e}), "b": spot(position: {}, target: {}, intensity: {i0:e}),
            "c": sphere(center: {}, radius: {r:e}, radiance: 2), "d": disk(center: {}, normal: (1, 2, 0.5), radius: {r:e}, radiance: 3, two_sided: true),
            "e": quad(corner: {}, edge_u: ({r:e}, 0, 0), edge_v: (0, {r:e}, {r:e}), radiance: 1), "f": directional(direction: (1, -2, 1), irradiance: 1),
            "g": environment(map: gradient(zenith: 1, horizon: 0.5, nadir: 0)) }}"#,
            at(),
            at(),
            at(),
            at(),
            at(),
            at(),
            i0 = unit * unit,
            r = 0.5 * unit,
        );
        let scene =
            random.scene(&lights, [2.0, 1e3][i % 2], unit).replace(r#""m0": ("#, r#""m0": (emission: 3, "#);
        let picture = shot(scene.clone()).folder(dir.path()).passes(2).render();
        assert!(picture.is_sound(), "scene {i}: {scene}");
        assert_eq!(picture.rendered.stats.rare_events[0].count, 0, "scene {i}: {scene}");
    }
}

/// An ordinary scene is healthy in the strict sense.
#[test]
fn an_ordinary_scene_is_healthy() {
    let mut shot = shot(
        r#"(camera: (eye: (1, 2, 4), target: (0, 0.3, 0)), image: (width: 32, height: 24), render: (max_depth: 1000),
        textures: { "n": noise(a: 0, b: 1, size_m: 0.2) },
        materials: { "floor": (diffuse: 0.6, bump_map: (texture: "n", height_m: 0.02)), "glass": (transmission: 1), "water": (transmission: 1, ior: "water", absorption: 0.2) },
        lights: { "lamp": sphere(center: (-1, 4, 1), radius: 0.5, radiance: 9) },
        objects: [(shape: quad(size: (9, 9)), material: "floor"), (shape: cylinder(radius: 0.5), material: "glass"), (shape: cylinder(radius: 0.4, height: 0.9), material: "water", transform: [translate((0, 0.1, 0))])])"#,
    )
    .passes(8);
    shot.options.strict = true;
    let picture = shot.render();
    assert_eq!(picture.rendered.warnings, Vec::<String>::new());
}
