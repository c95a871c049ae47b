//! What a user hands in: texels that are no numbers, coordinates beyond the image, cameras that look nowhere.

use super::record::{row, sized};
use crate::render::meshes::{folder, write_exr};
use crate::render::shot::shot;
use std::path::Path;
use terrarium::build::images::{Images, Limits, TextureUse};
use terrarium::description::{ColorSpace, Format, Texture, UvMapping, Wrap, load_str};
use terrarium::math::random::{Counter, Stage};
use terrarium::math::{Color, DVec2, DVec3};
use terrarium::optics::TexturePoint;

#[test]
fn h42_bad_texels() {
    row("H42", |row| {
        let dir = folder();
        let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 7.5, 0.25, 0.5, 1.0];
        write_exr(&dir.path().join("bad.exr"), 8, 4, |x, y| if y == 0 { [bad[x]; 3] } else { [0.5; 3] });
        let scene = |diffuse: &str, sky: &str| {
            shot(format!(
                r#"(camera: (eye: (0, 2, 4), target: (0, 0, 0)), image: (width: 32, height: 24),
                textures: {{ "t": image(path: "bad.exr") }}, materials: {{ "m": ({diffuse}) }}, lights: {{ "sky": environment(map: {sky}) }},
                objects: [(shape: quad(size: (4, 4)), material: "m"), (shape: sphere(radius: 0.5), material: "m")])"#
            ))
            .folder(dir.path())
            .passes(4)
            .render()
        };
        for (what, picture) in [
            ("a texture", scene(r#"emission: texture("t")"#, "constant(1)")),
            ("a sky", scene("diffuse: 0.5", r#"image(path: "bad.exr")"#)),
        ] {
            let dropped = picture.rendered.stats.rare_events[0].count;
            row.holds(
                &format!("{what} with NaN, infinite and negative texels gives a sound picture"),
                picture.is_sound(),
            );
            row.is("samples dropped in it", dropped as f64, 0.0, 0.0);
            let warnings = &picture.rendered.warnings;
            let said = warnings.iter().find(|w| w.contains("bad.exr")).cloned().unwrap_or_default();
            let said = said.replace(&format!("{}/", dir.path().display()), "");
            // Three channels each: one NaN and −∞ … −1 are below 0, one is infinite.
            row.says("what is said of the file", &said, "infinite ones by 7.5");
        }
    });
}

fn image(path: &str, wrap: Wrap) -> Texture {
    Texture::Image { path: path.into(), color_space: ColorSpace::Linear, wrap, uv: UvMapping::default() }
}

#[test]
fn h52_texture_coordinates() {
    row("H52", |row| {
        let dir = folder();
        write_exr(&dir.path().join("one.exr"), 1, 1, |_, _| [0.25, 0.5, 1.0]);
        write_exr(&dir.path().join("many.exr"), 7, 5, |x, y| [x as f32, y as f32, 1.0]);
        let mut images = Images::new(dir.path(), Limits::default());
        let at = |u: f64, v: f64| TexturePoint::at(DVec2::new(u, v), DVec3::ZERO);
        let wild = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            1e9,
            -1e9,
            1e300,
            f64::MAX,
            f64::MIN_POSITIVE,
            -5e-324,
            f64::EPSILON,
            1.0 - f64::EPSILON,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ];
        let (mut bad, mut apart, mut lookups) = (0, 0.0f64, 0);
        let mut random = Counter::new(52, Stage::Test, 0);
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for name in ["one.exr", "many.exr"] {
                let texture = images.texture(&image(name, wrap), TextureUse::Color).expect("an image");
                let most = texture.max();
                let mut look = |u: f64, v: f64| {
                    let c = texture.color(&at(u, v));
                    let within =
                        c.is_finite() && c.cmpge(Color::ZERO).all() && c.cmple(most * 1.000_001).all();
                    bad += u64::from(!within || (name == "one.exr" && c != Color::new(0.25, 0.5, 1.0)));
                    lookups += 1;
                };
                for (u, v) in wild.iter().flat_map(|&u| wild.map(|v| (u, v))) {
                    look(u, v);
                }
                for _ in 0..sized(10_000, 1_000_000) {
                    let [u, v] = random.pair().map(|u| (u - 0.5) * 1e9);
                    look(u, v);
                }
                if wrap == Wrap::Repeat {
                    for v in [0.0, 0.3, 0.99] {
                        apart = apart.max(f64::from(
                            (texture.color(&at(1.0, v)) - texture.color(&at(0.0, v))).length(),
                        ));
                    }
                }
            }
        }
        row.none("lookups at 0, ±1, ±1e9, ±∞, NaN … that leave the image's range, of 1 × 1 and 7 × 5 texels, three wraps", bad, lookups);
        row.is("u = 1 less u = 0 where the image repeats", apart, 0.0, 0.0);
    });
}

#[test]
fn h47_degenerate_cameras() {
    row("H47", |row| {
        let up = shot(
            r#"(camera: (eye: (0, 5, 0), target: (0, 0, 0)), image: (width: 8, height: 8),
            materials: { "m": (emission: 1) }, objects: [(shape: sphere(), material: "m")])"#,
        );
        let warning = up.load().warnings.iter().map(|d| d.headline()).find(|w| w.contains("camera"));
        row.says(
            "what is said of an up along the view",
            &warning.unwrap_or_default(),
            "another one is chosen",
        );
        let picture = up.passes(4).render();
        row.holds("its picture is sound and shows what is there", picture.is_sound() && picture.mean() > 0.0);
        for (what, camera, image, place) in [
            ("an eye that is the target", "eye: (0, 0, 0), target: (0, 0, 0)", "", "camera.target"),
            ("an angle of 0°", "eye: (0, 0, 5), target: (0, 0, 0), fov_deg: 0", "", "camera.fov_deg"),
            ("an angle of 180°", "eye: (0, 0, 5), target: (0, 0, 0), fov_deg: 180", "", "camera.fov_deg"),
            (
                "an angle that is no number",
                "eye: (0, 0, 5), target: (0, 0, 0), fov_deg: NaN",
                "",
                "camera.fov_deg",
            ),
            ("an up of no length", "eye: (0, 0, 5), target: (0, 0, 0), up: (0, 0, 0)", "", "camera.up"),
            ("an eye at infinity", "eye: (inf, 0, 5), target: (0, 0, 0)", "", "camera.eye"),
            ("no pixels", "eye: (0, 0, 5), target: (0, 0, 0)", "image: (width: 0),", "image.width"),
        ] {
            let scene = format!("({image}\ncamera: ({camera}))");
            let report = load_str(&scene, Format::Ron, Path::new(""), &[]).err();
            let said = report
                .and_then(|r| Some(format!("code {}, {}", r.exit_code(), r.errors().next()?.headline())));
            let said = said.unwrap_or_default();
            let holds = said.starts_with("code 2, <input>:") && said.contains(place);
            row.says(&format!("what is said of {what}"), if holds { &said } else { "" }, place);
        }
    });
}
