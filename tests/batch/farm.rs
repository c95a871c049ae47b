//! The files for engines say what was asked for, and their own readers take them.

use super::{CAUSTIC, Lab};
use std::fs;
use std::process::Command;

fn written(lab: &Lab, engine: &str, more: &[&str]) -> Vec<(String, String)> {
    let words =
        ["farm", "scene.ron", "--engine", engine, "--shards", "5", "-o", "out.exr", "--folder", "job"];
    lab.done(&[&words[..], more].concat());
    let mut files: Vec<_> = fs::read_dir(lab.path("job"))
        .expect("a folder")
        .map(|entry| {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            (name, fs::read_to_string(path).expect("text"))
        })
        .collect();
    files.sort();
    files
}

#[test]
fn images_that_could_not_be_merged_to_are_refused_before_the_job_is_written() {
    let lab = Lab::new(CAUSTIC);
    for (output, code, reason) in [
        ("a.jpg", 2, "ends in .exr or .png"),
        ("-", 2, "a job's image goes to a file"),
        ("no/folder/a.exr", 4, "can't write"),
    ] {
        let words = ["farm", "scene.ron", "--engine", "slurm", "--shards", "2", "-o", output];
        let said = lab.fails(code, &words);
        assert!(said.contains(reason), "{said}");
        assert_eq!(lab.names(), ["scene.ron"]);
    }
}

/// The engine is played: the variables that it sets, one task after the other, then the merge.
#[test]
fn the_scripts_for_slurm_render_and_merge() {
    let lab = Lab::new(CAUSTIC);
    let program = env!("CARGO_BIN_EXE_terrarium");
    let files = written(&lab, "slurm", &["--passes", "10", "--program", program, "--parts", "some parts"]);
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["terrarium-scene.array.sh", "terrarium-scene.merge.sh", "terrarium-scene.submit.sh"]);
    let array = &files[0].1;
    for line in ["--array=0-4", "--requeue", "--signal=B:USR1@60", "--cpus-per-task=4"] {
        assert!(array.contains(line), "{array}");
    }
    let run = |script: &str, task: &str| {
        let output = Command::new("sh")
            .arg(lab.path("job").join(script))
            .current_dir(lab.folder.path())
            .env("SLURM_ARRAY_TASK_ID", task)
            .env("SLURM_CPUS_PER_TASK", "1")
            .output()
            .expect("a shell");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    ["3", "0", "4", "1", "2"].iter().for_each(|task| run("terrarium-scene.array.sh", task));
    run("terrarium-scene.merge.sh", "0");
    lab.render(&["--passes", "10", "-o", "whole.exr"]);
    assert!(lab.bytes("out.exr") == lab.bytes("whole.exr"));
}

#[test]
fn the_templates_of_other_engines_name_the_parts_and_the_limits() {
    let lab = Lab::new(CAUSTIC);
    let files = written(&lab, "openjd", &["--without", "shadows", "--set", "materials.glass.ior=1.4"]);
    let text = &files[0].1;
    for part in [
        "range: \"0-4\"",
        "\"--shards\", \"{{Task.Param.Shard}}\"",
        "\"--of\", \"5\"",
        "\"--without\", \"shadows\"",
        "\"materials.glass.ior=1.4\"",
        "dependsOn: Render",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let files = written(&lab, "kubernetes", &["--image", "registry.example/terrarium:1"]);
    let render = files.iter().find(|(name, _)| name.contains("render.yaml")).expect("a manifest");
    for part in
        ["completionMode: Indexed", "completions: 5", "\"--shard\", \"auto\"", "registry.example/terrarium:1"]
    {
        assert!(render.1.contains(part), "{part} in {}", render.1);
    }
}
