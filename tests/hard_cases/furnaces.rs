//! Energy: even skies in which nothing may show, closed rooms whose light is a geometric series, and what
//! roulette and the depth limit do to both.

use super::proofs::prove;
use super::record::{Record, row, sized};
use crate::render::glass::{AROUND, furnace, unevenness};
use crate::render::materials::plane;
use crate::render::meshes::{cube, folder, icosphere};
use crate::render::shot::{Picture, focused, shot};
use terrarium::math::random::{Counter, Stage};

#[test]
fn s06_layers_gain_nothing() {
    row("S6", |row| {
        let mut random = Counter::new(5, Stage::Test, 0);
        let (mut most, mut least, materials) = (0.0f64, f64::INFINITY, sized(40, 300));
        for _ in 0..materials {
            let [km, kt, kd] = [random.value(), random.value(), random.value()];
            let ks = random.value() * (1.0 - km) * (1.0 - kt) * (1.0 - kd);
            let shininess = libm::pow(10.0, 3.0 * random.value());
            let angle = random.value() * 1.5;
            let material = format!(
                "reflection: {km}, transmission: {kt}, diffuse: {kd}, specular: {ks}, shininess: {shininess}, ior: {}",
                1.0 + random.value()
            );
            let eye = format!("({}, {}, 0)", 3.0 * libm::sin(angle), 3.0 * libm::cos(angle));
            let found = plane(&material, r#""sky": environment(map: constant(1), samples: 16)"#, "", &eye);
            // The diffuse floor of the inside hides the glass below it; all else of the sky comes back.
            let layers = km + (1.0 - km) * (1.0 - kt) * kd;
            (most, least) = (most.max(found), least.min(found / layers));
        }
        row.at_most(
            &format!("{materials} random materials in an even sky of 1: the brightest (2 % noise)"),
            most,
            1.02,
        );
        row.at_least("the least, over what its outer layers alone send back", least, 0.97);
        let mut off = 0.0f64;
        for (km, kd) in [(0.0, 1.0), (0.3, 0.5), (0.5, 0.0), (1.0, 0.7), (0.25, 1.0)] {
            let found = plane(
                &format!("reflection: {km}, diffuse: {kd}"),
                "",
                "ambient: 1, background: 1,",
                "(1, 2, 1)",
            );
            off = off.max((found - (km + (1.0 - km) * kd)).abs());
        }
        row.at_most("km + (1 − km)·kd under ambient light, which has no noise: off by", off, 1e-6);
    });
}

#[test]
fn h37_white_furnace() {
    row("H37", |row| {
        glass(row);
        mirrors(row);
        prove(row, "glass-in-even-sky");
        prove(row, "integrating-sphere-glow");
        prove(row, "integrating-sphere-lamp");
        other_engines(row);
    });
}

fn glass(row: &mut Record) {
    let dir = folder();
    icosphere(2).write(&dir.path().join("ball.obj"));
    cube().scaled(0.6).write(&dir.path().join("cube.obj"));
    let shapes = [
        "sphere()",
        "box()",
        "cone()",
        "cone(top_radius: 0.4)",
        "cylinder(radius: 0.7)",
        "polyhedron(kind: tetrahedron)",
        "polyhedron(kind: cube)",
        "polyhedron(kind: octahedron)",
        "polyhedron(kind: dodecahedron)",
        "polyhedron(kind: icosahedron)",
        r#"mesh(path: "ball.obj", smooth: false)"#,
        r#"mesh(path: "cube.obj", smooth: false)"#,
    ];
    let (mut mean, mut pixel, mut cut) = (0.0f64, 0.0f64, 0.0f64);
    for shape in shapes {
        for (ior, place) in
            [(1.5, "scale(1)"), (2.4, "rotate(axis: (1, 2, 3), deg: 20)"), (0.7, "scale((-1, 0.6, 1))")]
        {
            let materials = format!(r#""glass": (transmission: 1, ior: {ior})"#);
            let object = format!(r#"(shape: {shape}, material: "glass", transform: [{place}])"#);
            let picture = furnace(dir.path(), AROUND, &materials, &object, sized(16, 128));
            let (of_mean, of_each) = unevenness(&picture, 1.0);
            (mean, pixel) = (mean.max(of_mean), pixel.max(of_each));
            // In the tip of a cone light may be reflected a thousand times.
            cut = cut.max(picture.rendered.stats.truncated_weight);
        }
    }
    row.at_most(
        "twelve shapes of smooth glass, three indices, in an even sky of 1: mean off 1",
        mean,
        sized(5e-3, 3e-3),
    );
    row.at_most("the worst pixel off 1", pixel, sized(0.4, 0.1));
    row.at_most("the share of light cut at the depth limit", cut, 1e-4);
}

fn mirrors(row: &mut Record) {
    let mut off = 0.0f64;
    for shape in
        ["sphere()", "box()", "cone()", "cylinder()", "polyhedron(kind: dodecahedron)", "cone(caps: false)"]
    {
        let picture = shot(format!(
            r#"(camera: (eye: (2, 2, 3), target: (0, 0.2, 0)), image: (width: 32, height: 32), background: 1,
            materials: {{ "mirror": (reflection: 1, diffuse: 1) }}, objects: [(shape: {shape}, material: "mirror", transform: [scale((1, 0.7, 1.2))]), (shape: sphere(radius: 0.5), material: "mirror", transform: [translate((1.2, 0, 0))])])"#
        ))
        .passes(4)
        .render();
        off = off.max(unevenness(&picture, 1.0).1);
    }
    row.at_most("six shapes of perfect mirror in it: the worst pixel off 1", off, 1e-6);
}

/// By the engine that the scene's proof does not take.
fn other_engines(row: &mut Record) {
    for (by, wall, lights) in [
        ("photons", ", emission: 0.5", ""),
        ("paths", "", r#""lamp": point(position: (0, 0, 0), intensity: 3.141592653589793)"#),
    ] {
        let picture = focused(format!(
            r#"(camera: (eye: (0.2, 0.1, 0), target: (1, 0.2, 0.3), fov_deg: 70), image: (width: 12, height: 12), indirect: true, indirect_by: {by},
            materials: {{ "wall": (diffuse: 0.5{wall}) }}, lights: {{ {lights} }}, objects: [(shape: sphere(), material: "wall")])"#
        ))
        .passes(sized(64, 512))
        .render();
        let source = if lights.is_empty() { "glow" } else { "lamp" };
        row.is(&format!("the closed sphere with its {source} by {by}"), picture.mean(), 1.0, 5e-3);
    }
}

#[test]
fn h38_roulette_and_depth() {
    row("H38", |row| {
        roulette(row);
        prove(row, "facing-mirrors");
        let fading = facing(0.99, 100);
        let cut = fading.rendered.stats.truncated_weight;
        row.is_close(
            "facing mirrors of 0.99, depth 100: the share that is cut, 0.99^101",
            cut,
            0.99f64.powi(101),
            1e-4,
        );
        row.at_most("what is missing of a sky that is never reached, of 1", cut, 0.99f64.powi(100));
        let told = fading.rendered.warnings.iter().find(|w| w.contains("max_depth")).cloned();
        row.says("what is said of it", &told.unwrap_or_default(), "max_depth");
    });
}

/// Nested glass in an even sky, block by block against 1: roulette decides on every light branch.
fn roulette(row: &mut Record) {
    let seeds = sized(24, 120);
    let blocks = 16;
    let mut sums = vec![[0.0f64; 2]; blocks];
    for seed in 0..seeds {
        let scene = format!(
            r#"(camera: {AROUND}, image: (width: 64, height: 64), render: (max_depth: 1000, seed: {seed}),
            materials: {{ "glass": (transmission: 1, ior: 1.5), "water": (transmission: 1, ior: 1.33) }}, lights: {{ "sky": environment(map: constant(1)) }},
            objects: [(shape: cylinder(radius: 0.8, height: 1), material: "glass"), (shape: sphere(radius: 0.7, center: (0.5, 1, 0)), material: "water")])"#
        );
        let values = shot(scene).passes(2).render().grey();
        for (block, sum) in sums.iter_mut().enumerate() {
            let at = |i: usize| (16 * (block / 4) + i / 16) * 64 + 16 * (block % 4) + i % 16;
            let mean = (0..256).map(|i| values[at(i)]).sum::<f64>() / 256.0;
            *sum = [sum[0] + mean, sum[1] + mean * mean];
        }
    }
    let n = seeds as f64;
    let z = |[sum, squares]: &[f64; 2]| {
        let mean = sum / n;
        let variance = (squares / n - mean * mean).max(0.0) / (n - 1.0);
        if variance > 0.0 { (mean - 1.0).abs() / variance.sqrt() } else { 0.0 }
    };
    let worst = sums.iter().map(z).fold(0.0, f64::max);
    // p = 1e-3 for all sixteen together (Šidák): 6.3e-5 a block, 4.0 σ; with few seeds Student's t.
    row.at_most(
        "glass and water in an even sky of 1, means of 16 blocks by seeds: the worst off 1, in σ",
        worst,
        sized(4.9, 4.1),
    );
}

/// A view between two mirrors that stretch for ever.
fn facing(reflection: f64, depth: u32) -> Picture {
    shot(format!(
        r#"(camera: (eye: (0, 0.3, 0), target: (1, 0.31, 0.02), fov_deg: 10), image: (width: 4, height: 4), antialiasing: none,
        render: (max_depth: {depth}), materials: {{ "mirror": (reflection: {reflection}) }}, background: 1,
        objects: [(shape: quad(size: (9e9, 9e9)), material: "mirror", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((1, 0, 0))]),
                  (shape: quad(size: (9e9, 9e9)), material: "mirror", transform: [rotate(axis: (0, 0, 1), deg: 90), translate((-1, 0, 0))])])"#
    ))
    .render()
}

#[test]
fn h46_endless_reflections() {
    row("H46", |row| {
        let start = std::time::Instant::now();
        let endless = facing(1.0, 10_000);
        row.at_most(
            "seconds for 16 rays between perfect mirrors to a depth of 10,000",
            start.elapsed().as_secs_f64(),
            5.0,
        );
        let stats = &endless.rendered.stats;
        row.is("rays traced", stats.rays.reflection as f64, 16.0 * 10_001.0, 0.0);
        row.all("paths said to be cut", stats.truncated_paths, 16);
        row.is("their weight as a share", stats.truncated_weight, 1.0, 0.0);
        row.is(
            "paths cut where mirrors of 0.9 let roulette end them",
            facing(0.9, 10_000).rendered.stats.truncated_paths as f64,
            0.0,
            0.0,
        );
        let ball = shot(
            r#"(camera: (eye: (0.9, 0.8, 0.7), target: (0, 0, 0)), image: (width: 16, height: 16),
            render: (max_depth: 10000), materials: { "mirror": (reflection: 0.98), "glass": (transmission: 1) },
            lights: { "lamp": sphere(center: (0, 0.9, 0), radius: 0.05, radiance: 10) },
            objects: [(shape: box(size: (2, 2, 2)), material: "mirror"), (shape: sphere(radius: 0.5), material: "glass")])"#,
        )
        .passes(sized(8, 32))
        .render();
        row.holds("a ball of glass in a box of mirrors gives a sound picture", ball.is_sound());
        row.is("of which no path is cut", ball.rendered.stats.truncated_paths as f64, 0.0, 0.0);
    });
}
