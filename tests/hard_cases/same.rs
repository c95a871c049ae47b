//! The same bits: for any number of threads, any tiles, in parts, and with denormal numbers flushed.

use super::record::{Record, row, sized};
use crate::batch::{ADAPTIVE, CAUSTIC, Lab, merge, resume};
use crate::render::caustics::parts as focused;
use crate::render::determinism::{exr, scene};
use crate::render::meshes::folder;
use crate::render::shot::{Picture, Shot};
use sha2::{Digest, Sha256};
use std::path::Path;
use std::process::Command;
use std::time::Instant;
use terrarium::render::Aov;

const LAYERS: [Aov; 10] = [
    Aov::Albedo,
    Aov::Normal,
    Aov::Depth,
    Aov::Position,
    Aov::ObjectId,
    Aov::Samples,
    Aov::Direct,
    Aov::Reflection,
    Aov::Refraction,
    Aov::Variance,
];

fn hash(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}

/// SHA-256 of all values of all layers.
fn pixels(picture: &Picture) -> [u8; 32] {
    let bytes: Vec<u8> = picture.bits().into_iter().flat_map(u32::to_le_bytes).collect();
    hash(&bytes)
}

#[test]
fn h48_the_same_bits() {
    row("H48", |row| {
        let ways: &[(usize, u32)] = sized(
            &[(1, 32), (2, 7), (8, 64)],
            &[(1, 32), (2, 7), (3, 1), (5, 64), (8, 1000), (64, 16), (64, 5)],
        );
        let dir = folder();
        let shots = [
            scene("progressive").passes(3).aovs(&LAYERS),
            scene("grid(2)").passes(3).aovs(&LAYERS),
            scene("adaptive(threshold: 0.05, depth: 3)").passes(3).aovs(&LAYERS),
            focused::scene("progressive", focused::SMALL).passes(3),
            focused::scene("progressive", focused::BY_PHOTONS).passes(3),
            focused::scene("grid(2)", "classic(count: 20000, k: 50)").passes(3),
            focused::scene("adaptive(threshold: 0.05, depth: 2)", focused::SMALL).passes(3),
        ];
        let (mut same, mut renders) = (0, 0);
        for shot in shots {
            let render = |(threads, tile): (usize, u32)| {
                let mut shot: Shot = shot.clone();
                shot.options.threads = Some(threads);
                shot.options.tile = tile;
                let picture = shot.render();
                (pixels(&picture), hash(&exr(&picture, dir.path())))
            };
            let found: Vec<_> = ways.iter().map(|way| render(*way)).collect();
            same += found.iter().filter(|other| **other == found[0]).count() as u64;
            renders += found.len() as u64;
        }
        let what = format!(
            "renders in {} ways of threads (1 to {}) and tiles with one SHA-256, of pixels and of file",
            ways.len(),
            sized(8, 64)
        );
        row.all(&what, same, renders);
        in_parts(row);
        killed(row);
    });
}

/// Shards of passes and of tiles, each with other threads, merged from the last to the first.
fn in_parts(row: &mut Record) {
    for (what, scene, more) in [
        ("of 14 passes with caustics", CAUSTIC, &["--passes", "14", "--aov", "caustic,variance"][..]),
        ("of tiles, antialiased where there are edges", ADAPTIVE, &["--aov", "edges,depth"]),
    ] {
        let lab = Lab::new(scene);
        lab.render(&[&["-o", "whole.exr"], more].concat());
        let whole = lab.bytes("whole.exr");
        let parts = sized(&[3u32][..], &[1, 2, 3, 4, 5, 6, 7]);
        let same = parts.iter().filter(|n| merge::in_parts(&lab, **n, more) == whole).count();
        let what =
            format!("files merged from up to {} shards {what} with the bytes of one render's", sized(3, 7));
        row.all(&what, same as u64, parts.len() as u64);
    }
}

/// A render that is killed at chance moments and resumed, to its end.
fn killed(row: &mut Record) {
    let lab = Lab::new(CAUSTIC);
    let words = ["render", "scene.ron", "-q", "--passes", "24"];
    let began = Instant::now();
    lab.done(&[&words[..], &["-o", "whole.exr"]].concat());
    let kills = resume::killed(&lab, &words, sized(3, 20), began.elapsed().as_millis() as u64);
    row.at_least("kills of a render that is resumed each time", f64::from(kills), 1.0);
    row.holds(
        "its file has the bytes of a render's that nothing stopped",
        lab.bytes("killed.exr") == lab.bytes("whole.exr"),
    );
}

const SCENE: &str = r#"(
    camera: (eye: (0.0001, 0.0002, 0.0004), target: (0, 0.00003, 0)), image: (width: 48, height: 32), render: (passes: 3), indirect: 2,
    materials: { "floor": (diffuse: 0.6, specular: 0.1, shininess: 900), "glass": (transmission: 1, absorption: 9000), "mirror": (reflection: 0.9) },
    lights: { "lamp": sphere(center: (-0.0001, 0.0004, 0.0001), radius: 0.00003, radiance: 9), "sky": environment(map: gradient(zenith: 1e-12, horizon: 1e-20, nadir: 1e-30)) },
    objects: [(shape: quad(size: (0.0009, 0.0009)), material: "floor"), (shape: sphere(radius: 0.00005, center: (0, 0.00006, 0)), material: "glass"),
              (shape: cone(radius: 0.00004, height: 0.0001), material: "mirror", transform: [translate((0.0001, 0, 0))])],
)"#;

/// Sets flush-to-zero and denormals-are-zero before the program begins, and says at its end whether they are set.
const HOST: &str = r#"
#include <stdio.h>
#include <xmmintrin.h>
__attribute__((constructor)) static void set(void) { _mm_setcsr(_mm_getcsr() | 0x8040); }
__attribute__((destructor)) static void say(void) { fprintf(stderr, "mxcsr %x\n", _mm_getcsr() & 0x8040); }
"#;

#[test]
fn h53_flushed_denormals() {
    row("H53", |row| {
        let dir = folder();
        std::fs::write(dir.path().join("scene.ron"), SCENE).expect("written");
        let plain = render(dir.path(), "plain.exr", None);
        row.holds(
            "a scene of lengths of 1e-5 m, under a sky of 1e-12 to 1e-30 beside a lamp of 9, renders",
            plain.is_some(),
        );
        let Some(host) = host(dir.path()) else {
            row.skip("there is no x86-64 Linux with a C compiler, by which a host sets the mode");
            return;
        };
        let flushed = render(dir.path(), "flushed.exr", Some(&host));
        let said = flushed.as_ref().map_or("", |(_, said)| said);
        row.says("control bits of the program's thread with such a host", said, "mxcsr 8040");
        let [a, b] = [&plain, &flushed].map(|run| run.as_ref().map(|(bytes, _)| hash(bytes)));
        row.holds("the file has the same SHA-256", a.is_some() && a == b);
    });
}

/// The host as a shared library, where it can be built.
fn host(folder: &Path) -> Option<std::path::PathBuf> {
    if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        return None;
    }
    let (source, library) = (folder.join("host.c"), folder.join("host.so"));
    std::fs::write(&source, HOST).expect("written");
    let built = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&library).arg(&source).status();
    built.is_ok_and(|status| status.success()).then_some(library)
}

/// The rendered file, and what was said.
fn render(folder: &Path, name: &str, preload: Option<&Path>) -> Option<(Vec<u8>, String)> {
    let mut program = Command::new(env!("CARGO_BIN_EXE_terrarium"));
    program.current_dir(folder).args(["render", "scene.ron", "--threads", "2", "-q", "-o", name]);
    if let Some(library) = preload {
        program.env("LD_PRELOAD", library);
    }
    let done = program.output().expect("the program runs");
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{said}");
    Some((std::fs::read(folder.join(name)).ok()?, said))
}
