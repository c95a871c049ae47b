//! `--set` changes any value of a scene, and is checked like the file.

use super::{FULL_RON, FULL_TOML, folder, full, full_scene};
use terrarium::description::Format;

fn refused(overrides: &[&str]) -> Vec<String> {
    let report = full(FULL_RON, Format::Ron, overrides).expect_err("the override is wrong");
    report.diagnostics.iter().map(|d| d.headline()).collect()
}

#[test]
fn set_reaches_every_kind_of_place() {
    let scene = full_scene(&[
        "materials.glass.ior=1.33",
        "image.width=64",
        "objects.0.material=glass",
        "objects.gem.material=water",
        "lights.ball.sphere.radius=0.2",
        "lights.ball.samples=9",
        "antialiasing=grid(2)",
        "render.passes=3",
        "camera.eye=(1, 2, 3)",
        "camera.target.1=0.25",
        "objects.gem.transform.2.scale=0.75",
        "textures.photo.path=./wood.png",
        "materials.water.diffuse=texture(\"squares\")",
        "materials.lamp.shininess=20",
        "textures.photo.wrap=clamp",
    ]);
    let plain = full_scene(&[]);
    let mut expected = full_scene(&[]);
    use terrarium::description::*;
    expected.image.width = 64;
    expected.antialiasing = Antialiasing::Grid(2);
    expected.render.passes = Some(3);
    expected
        .camera
        .as_mut()
        .map(|c| (c.eye, c.target[1]) = ([1.0, 2.0, 3.0], 0.25))
        .expect("it has a camera");
    expected.objects[0].material = Some("glass".into());
    expected.objects[2].material = Some("water".into());
    expected.objects[2].transform[2] = Transform::Scale(Scale::Uniform(0.75));
    for (name, material) in expected.materials.iter_mut() {
        match name {
            "glass" => material.ior = Some(Ior::Number(1.33)),
            "lamp" => material.shininess = Some(20.0),
            "water" => {
                material.diffuse =
                    Source::Texture(TextureRef { name: "squares".into(), scale: Rgb::grey(1.0) })
            }
            _ => {}
        }
    }
    for (name, light) in expected.lights.iter_mut() {
        if let ("ball", Light::Sphere { radius, samples, .. }) = (name, light) {
            (*radius, *samples) = (0.2, Some(9));
        }
    }
    for (name, texture) in expected.textures.iter_mut() {
        if let ("photo", Texture::Image { path, wrap, .. }) = (name, texture) {
            *path = folder().join("./wood.png").display().to_string();
            *wrap = Wrap::Clamp;
        }
    }
    assert_eq!(scene, expected);
    assert_ne!(scene, plain);
    let toml = full(FULL_TOML, Format::Toml, &["lights.ball.radius=0.2", "objects.gem.kind=cube"]);
    let headlines: Vec<String> =
        toml.err().map(|r| r.diagnostics.iter().map(|d| d.headline()).collect()).unwrap_or_default();
    assert_eq!(
        headlines,
        ["--set objects.gem.kind=cube:13: error: objects.2: there is no field `kind` here"]
    );
    let shorthand = full(FULL_TOML, Format::Toml, &["lights.ball.radius=0.2", "objects.gem.shape.kind=cube"]);
    let direct = full(
        FULL_RON,
        Format::Ron,
        &["lights.ball.sphere.radius=0.2", "objects.2.shape.polyhedron.kind=cube"],
    );
    assert_eq!(shorthand.ok().map(|l| l.hash), direct.ok().map(|l| l.hash));
}

#[test]
fn wrong_overrides_are_reported_in_the_argument() {
    let cases = [
        (
            "materials.glas.ior=1.33",
            "--set materials.glas.ior=1.33:11: error: no material `glas`; did you mean `glass`?",
        ),
        (
            "materials.glass.iro=1.33",
            "--set materials.glass.iro=1.33:17: error: materials.glass: there is no field `iro` here; did you mean `ior`?",
        ),
        (
            "image.width=wide",
            "--set image.width=wide:13: error: image.width: expected a whole number from 0 to 4294967295, found `wide`",
        ),
        ("image.width=0", "--set image.width=0:13: error: image.width: 0 is outside [1, 1048576]"),
        (
            "objects.gme.material=glass",
            "--set objects.gme.material=glass:9: error: no entry is named `gme`; did you mean `gem`? (known: `floor`, `pillar`, `gem`, `tree`, `two`, `meadow`, `glow`, `cube`)",
        ),
        (
            "objects.99.material=glass",
            "--set objects.99.material=glass:9: error: there is no entry 99, the list has 8",
        ),
        (
            "objects.0.material=glas",
            "--set objects.0.material=glas:20: error: objects.0.material: no material `glas`; did you mean `glass`?",
        ),
        (
            "antialiasing=gird(2)",
            "--set antialiasing=gird(2):14: error: antialiasing: there is no `gird` here; did you mean `grid`?",
        ),
        (
            "antialiasing=grid(0)",
            "--set antialiasing=grid(0):19: error: antialiasing.grid: 0 is outside [1, 64]",
        ),
        ("image.width", "--set image.width:1: error: expected path.to.key=value"),
        ("image..width=1", "--set image..width=1:7: error: a name is missing in the path"),
        ("camera.eye=(1,2", "--set camera.eye=(1,2:12: error: camera.eye: expected 3 values, found `(1,2`"),
        (
            "camera.fov_deg=1e999",
            "--set camera.fov_deg=1e999:16: error: camera.fov_deg: a finite number is expected, this is infinite or beyond 1.8e308",
        ),
    ];
    for (argument, expected) in cases {
        assert_eq!(refused(&[argument]), [expected]);
    }
}
