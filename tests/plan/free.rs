//! What is off is free: its stages do not run, its files are not read, its memory is not held.

use super::lab::{BALL, LAMP, decision, own_plan, render, scene, shot, without};
use crate::render::shot::Picture;
use terrarium::plan::{Effect, Overrides};

/// A folder with one small image.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let image = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([100 + 10 * x as u8, 120, 200 + y as u8]));
    image.save(folder.path().join("a.png")).expect("an image");
    folder
}

/// `material` on a box, with textures of an image that is there and of one that is not.
fn mapped(material: &str, of_box: &str) -> String {
    let materials = format!(r#""mapped": ({material}), "elsewhere": (diffuse: texture("missing"))"#);
    let object = format!(r#"(shape: box(), material: "{of_box}")"#);
    scene("", &materials, LAMP, &object).replace(
        "textures: {",
        r#"textures: { "there": image(path: "a.png"), "missing": image(path: "none.png"),"#,
    )
}

fn render_in(folder: &std::path::Path, text: &str, overrides: &Overrides) -> Picture {
    shot(text, overrides).folder(folder).render()
}

#[test]
fn maps_that_are_left_out_or_unreachable_are_not_read() {
    let folder = folder();
    let (whole, none) = (Overrides::default(), 0);
    let relief = [
        (Effect::NormalMaps, r#"diffuse: 0.5, normal_map: (texture: "there")"#),
        (Effect::BumpMaps, r#"diffuse: 0.5, bump_map: (texture: "there", height_m: 0.1)"#),
    ];
    for (effect, material) in relief {
        let text = mapped(material, "mapped");
        let (on, off) =
            (render_in(folder.path(), &text, &whole), render_in(folder.path(), &text, &without(&[effect])));
        assert_eq!((on.rendered.files.len(), off.rendered.files.len()), (1, none), "{effect}");
        assert!(on.rendered.stats.memory.textures_bytes > 0);
        assert_eq!(off.rendered.stats.memory.textures_bytes, 0);
    }
    let text = mapped(r#"diffuse: texture("there")"#, "mapped");
    assert_eq!(render_in(folder.path(), &text, &whole).rendered.files.len(), 1);
    // The mean of an image is found by reading it, and is all that is kept.
    let mean = render_in(folder.path(), &text, &without(&[Effect::Textures]));
    assert_eq!((mean.rendered.files.len(), mean.rendered.stats.memory.textures_bytes), (1, 0));
    let unreachable = render_in(folder.path(), &mapped(r#"diffuse: texture("there")"#, "matt"), &whole);
    assert!(unreachable.rendered.files.is_empty());
}

/// Settings that change nothing load and call for nothing, and the image is that of the scene without them.
#[test]
fn what_changes_nothing_is_not_read_and_calls_for_nothing() {
    let folder = folder();
    let whole = Overrides::default();
    for (idle, plain) in [
        (r#"diffuse: 0.5, normal_map: (texture: "there", strength: 0)"#, "diffuse: 0.5"),
        (r#"diffuse: 0.5, bump_map: (texture: "there", height_m: 0)"#, "diffuse: 0.5"),
        (r#"diffuse: texture(name: "there", scale: 0), reflection: 0.5"#, "reflection: 0.5"),
        (r#"diffuse: 0.5, reflection: texture(name: "there", scale: 0)"#, "diffuse: 0.5"),
        (r#"diffuse: 0.5, transmission: texture(name: "there", scale: 0), absorption: 2"#, "diffuse: 0.5"),
    ] {
        let (idle, plain) = (mapped(idle, "mapped"), mapped(plain, "mapped"));
        let (a, b) = (render_in(folder.path(), &idle, &whole), render_in(folder.path(), &plain, &whole));
        assert!(a.rendered.files.is_empty(), "{idle}");
        assert_eq!(a.rendered.image, b.rendered.image, "{idle}");
        let on = |text: &str| own_plan(text).decisions.iter().map(|d| d.on).collect::<Vec<_>>();
        assert_eq!(on(&idle), on(&plain), "{idle}");
        assert_eq!(a.rendered.stats.rays, b.rendered.stats.rays, "{idle}");
    }
    // nor is the image of a sky that is black
    let sky = r#""sky": environment(map: image(path: "none.exr"), scale: 0)"#;
    let night = mapped("diffuse: 0.5", "mapped").replace("lights: {", &format!("lights: {{ {sky},"));
    assert!(render_in(folder.path(), &night, &whole).rendered.files.is_empty());
    // and a file that is not there is no mistake
    let missing = mapped(r#"diffuse: 0.5, normal_map: (texture: "missing", strength: 0)"#, "mapped");
    assert!(render_in(folder.path(), &missing, &whole).rendered.files.is_empty());
}

/// The wall of a bubble refracts, whatever the index within: what it is around tells only where it is placed.
#[test]
fn a_bubble_in_glass_keeps_its_map() {
    let bubble = |ior: f64, map: &str| {
        let air = format!(r#""air": (transmission: 1, ior: {ior}, priority: 1 {map})"#);
        let objects =
            format!(r#"{BALL}, (shape: sphere(radius: 0.3, center: (0, 0.6, 0)), material: "air")"#);
        render(&scene("", &air, LAMP, &objects), &Overrides::default()).grey()
    };
    let map = r#", bump_map: (texture: "waves", height_m: 0.05)"#;
    let (plain, bumpy, near) = (bubble(1.0, ""), bubble(1.0, map), bubble(1.0 + 1e-9, map));
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(
        off(&bumpy, &near) < 1e-4 && off(&bumpy, &plain) > 1e-2,
        "{} {}",
        off(&bumpy, &near),
        off(&bumpy, &plain)
    );
}

/// Nothing is sent through a perfect mirror, and its plan says so.
#[test]
fn a_perfect_mirror_hides_the_glass_below() {
    let text = mapped("reflection: 1, transmission: 0.5, dispersion: abbe(30)", "mapped");
    let picture = render(&text, &Overrides::default());
    assert_eq!(picture.rendered.stats.rays.refraction, 0);
    let plan = own_plan(&text);
    let off = [Effect::Refraction, Effect::NestedMedia].map(|effect| decision(&plan, effect).on);
    assert_eq!(off, [false; 2]);
}

#[test]
fn without_mirrors_and_glass_there_are_no_specular_rays_and_no_photon_stages() {
    let picture = render(&scene("", "", LAMP, ""), &Overrides::default());
    let stats = &picture.rendered.stats;
    assert_eq!(
        (stats.rays.reflection, stats.rays.refraction, stats.rays.diffuse, stats.rays.probe),
        (0, 0, 0, 0)
    );
    assert!(stats.photons.photons.is_none() && stats.photons.indirect_photons.is_none());
    assert_eq!(stats.memory.photons_bytes, 0);
    let dark = render(&scene("", "", "", ""), &Overrides::default());
    assert_eq!(dark.rendered.stats.rays.shadow, 0);
}

#[test]
fn caustics_that_are_left_out_send_no_photons() {
    let text = scene("indirect: true, indirect_by: photons,", "", LAMP, BALL);
    let stats = render(&text, &without(&[Effect::Caustics])).rendered.stats;
    assert!(stats.photons.photons.is_none());
    // Indirect light is not touched by it.
    let whole = render(&text, &Overrides::default()).rendered.stats;
    let stored = |stats: &terrarium::render::Stats| stats.photons.indirect_photons.as_ref().map(|p| p.stored);
    assert!(stored(&stats).is_some_and(|n| n > 0) && stored(&stats) == stored(&whole));
}
