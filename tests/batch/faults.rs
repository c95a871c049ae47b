//! What may go wrong around a render: a message, the right code, and nothing half-written.

use super::{CAUSTIC, Lab};
use std::fs;

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_told_before_the_first_ray() {
    let lab = Lab::new(CAUSTIC);
    for words in
        [&["-o", "missing/out.exr"][..], &["-o", "/proc/out.exr"], &["--shard", "0/2", "-o", "missing/a.exr"]]
    {
        let words = [&["render", "scene.ron", "--passes", "1000000"], words].concat();
        let began = std::time::Instant::now();
        let said = lab.fails(4, &words);
        assert!(said.contains("can't write") && began.elapsed().as_secs() < 5, "{said}");
    }
    assert_eq!(lab.names(), ["scene.ron"]);
}

/// Needs a file system of its own, so the right to mount one.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_keeps_the_old_file() {
    let lab = Lab::new(CAUSTIC);
    let disk = lab.path("disk");
    fs::create_dir(&disk).expect("created");
    let mount = |words: &[&str]| {
        std::process::Command::new(words[0]).args(&words[1..]).output().is_ok_and(|o| o.status.success())
    };
    let place = disk.display().to_string();
    if !mount(&["mount", "-t", "tmpfs", "-o", "size=24k", "tmpfs", &place]) {
        eprintln!("not tried: no right to mount a small disk");
        return;
    }
    fs::write(disk.join("out.exr"), "old").expect("written");
    let output = lab.run(&["render", "scene.ron", "--passes", "2", "-q", "-o", "disk/out.exr"]);
    let (old, left) = (fs::read(disk.join("out.exr")), fs::read_dir(&disk).map(Iterator::count));
    assert!(mount(&["umount", &place]));
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(said.contains("can't write disk/out.exr") && said.contains("space"), "{said}");
    assert_eq!((old.ok(), left.ok()), (Some(b"old".to_vec()), Some(1)));
}

#[test]
fn a_texture_that_vanishes_between_check_and_render_is_told() {
    let lab = Lab::new(
        r#"(
        camera: (eye: (0, 0, 4), target: (0, 0, 0)),
        image: (width: 8, height: 8),
        textures: { "t": image(path: "t.png") },
        materials: { "m": (diffuse: texture("t")) },
        lights: { "l": point(position: (0, 4, 3), intensity: (20, 20, 20)) },
        objects: [(shape: sphere(radius: 1), material: "m")],
    )"#,
    );
    image::RgbImage::from_pixel(4, 4, image::Rgb([200, 100, 50])).save(lab.path("t.png")).expect("written");
    lab.done(&["check", "scene.ron"]);
    fs::remove_file(lab.path("t.png")).expect("removed");
    assert!(lab.fails(3, &["render", "scene.ron", "-o", "out.exr"]).contains("t.png"));
    assert_eq!(lab.names(), ["scene.ron"]);
}

#[test]
fn a_thread_that_breaks_off_leaves_the_old_file_and_no_other() {
    let lab = Lab::new(CAUSTIC);
    fs::write(lab.path("out.exr"), "the old file").expect("written");
    for (step, threads) in [("1", "1"), ("2", "2"), ("5", "2")] {
        let words = ["render", "scene.ron", "-o", "out.exr", "--tile", "16", "--threads", threads];
        let output = lab.command(&words).env("TERRARIUM_BREAK", step).output().expect("the program runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("the program broke off, which is a defect of its own"), "{said}");
        assert!(!said.contains("panicked"), "{said}");
        assert_eq!(lab.bytes("out.exr"), b"the old file");
        assert_eq!(lab.names(), ["out.exr", "scene.ron"]);
    }
}

#[test]
fn a_render_that_is_foretold_to_take_more_than_the_limit_is_refused_with_what_it_takes() {
    let lab = Lab::new(&CAUSTIC.replace("count: 20000", "count: 3000000"));
    let said = lab.fails(5, &["render", "scene.ron", "-o", "out.exr", "--memory", "200MiB"]);
    assert!(said.contains("of the next pass's photons") && said.contains("the limit is 209715200"), "{said}");
    assert_eq!(lab.names(), ["scene.ron"]);
    lab.fails(5, &["plan", "scene.ron", "--memory", "24MiB"]);
    let lab = Lab::new(CAUSTIC);
    lab.render(&["-o", "out.exr", "--passes", "2", "--memory", "256MiB"]);
}
