//! `include` takes in other files; what cannot be read is named.

use super::{CAMERA, folder, write};
use std::path::Path;
use terrarium::description::{Format, Object, Shape, load, load_str};

#[test]
fn include_takes_in_both_formats_with_paths_of_their_own_folder() {
    let temp = tempfile::tempdir().expect("a folder can be made");
    let main = write(
        temp.path(),
        "main.ron",
        &format!(
            "({CAMERA}, include: [\"lib/a.toml\", \"lib/b.ron\"], materials: {{ \"m\": (diffuse: 0.5) }}, objects: [(name: \"first\", shape: sphere(), material: \"glass\")])"
        ),
    );
    write(
        temp.path(),
        "lib/a.toml",
        "include = [\"deep/c.ron\"]\n[materials.glass]\ntransmission = 1\n[[objects]]\nmaterial = \"m\"\nshape.mesh = { path = \"t.obj\" }\n",
    );
    write(
        temp.path(),
        "lib/b.ron",
        "(include: [\"deep/c.ron\"], lights: { \"l\": point(position: (0, 1, 0), intensity: 1) })",
    );
    write(temp.path(), "lib/deep/c.ron", "(definitions: { \"d\": (shape: mesh(path: \"../t.obj\")) })");
    write(temp.path(), "lib/t.obj", "v 0 0 0\n");
    let loaded = load(&main, &["objects.0.name=main".into()]).unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(loaded.files.len(), 4);
    assert!(loaded.scene.include.is_empty());
    assert_eq!(loaded.scene.objects[0].name.as_deref(), Some("main"));
    let path = |object: &Object| match &object.shape {
        Shape::Mesh { path, .. } => path.clone(),
        _ => String::new(),
    };
    for object in [&loaded.scene.objects[1], loaded.scene.definitions.get("d").expect("it is included")] {
        assert!(Path::new(&path(object)).is_file(), "{}", path(object));
    }
    let elsewhere = tempfile::tempdir().expect("a folder can be made");
    let copy = elsewhere.path().join("moved");
    std::fs::rename(temp.path(), &copy).expect("a folder can be moved");
    let moved =
        load(&copy.join("main.ron"), &["objects.0.name=main".into()]).unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(moved.hash, loaded.hash);
    std::fs::rename(&copy, temp.path()).expect("a folder can be moved");
}

#[test]
fn wrong_includes_are_reported_where_they_are() {
    let temp = tempfile::tempdir().expect("a folder can be made");
    let at = |name: &str| temp.path().join(name).display().to_string();
    let main = write(
        temp.path(),
        "main.ron",
        &format!(
            "({CAMERA},\n include: [\"a.ron\", \"none.ron\", \"x.txt\", \"bad.ron\"],\n materials: {{ \"m\": (diffuse: 2) }})"
        ),
    );
    write(
        temp.path(),
        "a.ron",
        "(image: (width: 3), include: [\"b.toml\"], material: {},\n materials: { \"m\": (), \"n\": (specular: -1) })",
    );
    write(temp.path(), "b.toml", "include = [\"a.ron\", \"main.ron\"]\nmaterials = 3\n");
    write(temp.path(), "bad.ron", "(materials: {");
    let report = load(&main, &[]).expect_err("nearly everything is wrong");
    assert_eq!(report.exit_code(), 2);
    let found: Vec<String> = report.diagnostics.iter().map(|d| d.headline()).collect();
    let (m, a, b) = (at("main.ron"), at("a.ron"), at("b.toml"));
    let expected = [
        format!("{m}:2:21: error: `{}` cannot be read: there is no such file", at("none.ron")),
        format!("{m}:2:33: error: `x.txt` does not end in .ron or .toml"),
        format!("{m}:3:30: error: materials.m.diffuse: 2 is outside [0, 1]"),
        format!("{a}:1:2: error: `image` belongs to the main file, an included file cannot set it"),
        format!("{a}:1:42: error: there is no field `material` here; did you mean `materials`?"),
        format!("{a}:2:15: error: materials: `m` is given twice; the first is at {m}:3:15"),
        format!("{a}:2:40: error: materials.n.specular: -1 is outside [0, 1]"),
        format!("{b}:1:12: error: files include each other: {a} → {b} → {a}"),
        format!("{b}:1:21: error: files include each other: {m} → {a} → {b} → {m}"),
        format!("{b}:2:13: error: expected a map from names to entries, found `3`"),
        format!("{}:1:14: error: a name in quotes is expected", at("bad.ron")),
    ];
    assert_eq!(found, expected, "\n{report}");
}

#[test]
fn files_that_cannot_be_read_are_io_errors() {
    let missing = load(Path::new("no/such/scene.ron"), &[]).expect_err("there is no such file");
    assert_eq!(missing.exit_code(), 3);
    let temp = tempfile::tempdir().expect("a folder can be made");
    let latin = temp.path().join("latin.toml");
    std::fs::write(&latin, b"# one\n# caf\xe9\n").expect("a file can be written");
    let report = load(&latin, &[]).expect_err("it is not UTF-8");
    assert_eq!(report.exit_code(), 2);
    assert_eq!(
        report.diagnostics[0].headline(),
        format!("{}:2:6: error: byte 11 is not valid UTF-8", latin.display())
    );
    let lost = format!(
        "({CAMERA}, objects: [(shape: mesh(path: \"tre.obj\"), material: \"m\")], materials: {{ \"m\": () }})"
    );
    let report = load_str(&lost, Format::Ron, &folder(), &[]).expect_err("the mesh is missing");
    assert_eq!(report.exit_code(), 3);
    let message = format!(
        "`{}` cannot be read: there is no such file; did you mean `tree.obj`?",
        folder().join("tre.obj").display()
    );
    assert_eq!(report.diagnostics[0].message, message);
    let json = serde_json::to_value(&report.diagnostics[0]).expect("diagnostics have a JSON form");
    assert_eq!(json["kind"], "io");
    assert_eq!(json["path"], "objects.0.shape.mesh.path");
}
