//! The pipeline is the folder tree: a module names only modules above it.
//!
//! Reads `src/` and compares every `crate::…` and `super::…` path with the table. Tests inside the
//! modules are held to it as well.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Each module with those that it may name, in the order of the pipeline.
const TABLE: [(&str, &[&str]); 15] = [
    ("math", &[]),
    ("optics", &["math"]),
    ("description", &["math"]),
    ("plan", &["math", "description"]),
    ("build", &["math", "optics", "description", "plan"]),
    ("scatter", &["math", "optics", "plan", "build"]),
    ("survey", &["math", "optics", "plan", "build", "scatter"]),
    ("index", &["math", "optics", "plan", "scatter"]),
    ("trace", &["math", "optics", "plan", "build", "index"]),
    ("film", &["math", "trace"]),
    ("output", &["math", "plan", "film"]),
    ("forecast", &["math", "plan", "trace"]),
    (
        "render",
        &[
            "math",
            "optics",
            "description",
            "plan",
            "build",
            "scatter",
            "survey",
            "index",
            "trace",
            "film",
            "output",
            "forecast",
        ],
    ),
    ("measure", &["math", "description", "plan", "film", "output", "forecast", "render"]),
    // part of the program, not of the library: it sees the library from outside
    ("cli", &[]),
];

const LONGEST_FILE: usize = 450;

fn sources() -> Vec<(PathBuf, String)> {
    fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of the sources") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                walk(&path, files);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    walk(&root, &mut files);
    files.sort();
    let read = |file: PathBuf| {
        let text = fs::read_to_string(&file).expect("a source");
        (file.strip_prefix(&root).expect("a file of src").to_path_buf(), text)
    };
    files.into_iter().map(read).collect()
}

/// The file's modules below the crate: `build/bvh.rs` is `build`, `bvh`; `build/mod.rs` is `build`.
fn modules(file: &Path) -> Vec<String> {
    let mut parts: Vec<String> =
        file.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|part| part == "mod" || part == "lib" || part == "main") {
        parts.pop();
    }
    parts
}

/// The text without comments; strings stay, since code seldom quotes paths of modules.
fn code(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or(""));
    lines.collect::<Vec<_>>().join("\n")
}

/// The first names of a path's rest: `a::b` gives a; `{a, b::{c, d}, e}` gives a, b, e.
fn first_names(rest: &str) -> Vec<String> {
    let word = |text: &str| -> String {
        let text = text.trim_start();
        text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let Some(group) = rest.trim_start().strip_prefix('{') else {
        return vec![word(rest)];
    };
    let (mut names, mut depth, mut item) = (Vec::new(), 0, String::new());
    for character in group.chars() {
        match character {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                names.push(word(&item));
                item.clear();
                continue;
            }
            _ => {}
        }
        item.push(character);
    }
    names.push(word(&item));
    names.retain(|name| !name.is_empty());
    names
}

/// Modules at the top of the crate that a file names.
fn named(file: &Path, text: &str) -> BTreeSet<String> {
    let code = code(text);
    let depth = modules(file).len();
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        // not `$crate::` or `other_crate::`
        let before = code[..at].chars().next_back();
        if before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != '$') {
            names.extend(first_names(&code[at + "crate::".len()..]));
        }
    }
    let tests = code.find("mod tests").unwrap_or(code.len());
    let mut at = 0;
    while let Some(found) = code[at..].find("super::") {
        let start = at + found;
        let mut rest = &code[start..];
        let mut levels = 0;
        while let Some(further) = rest.strip_prefix("super::") {
            rest = further;
            levels += 1;
        }
        at = code.len() - rest.len();
        // a module of tests lies one level deeper
        if levels == depth + usize::from(start > tests) {
            names.extend(first_names(rest));
        }
    }
    names
}

/// What a file names against the table.
fn violations(file: &Path, text: &str) -> Vec<String> {
    let modules = modules(file);
    let Some(module) = modules.first() else { return Vec::new() };
    let Some((_, allowed)) = TABLE.iter().find(|(name, _)| name == module) else {
        return vec![format!("{}: module `{module}` is not in the table", file.display())];
    };
    let known = |name: &str| TABLE.iter().any(|(other, _)| *other == name);
    named(file, text)
        .into_iter()
        .filter(|name| known(name) && name != module && !allowed.contains(&name.as_str()))
        .map(|name| format!("{}: `{module}` names `{name}`", file.display()))
        .collect()
}

#[test]
fn every_module_names_only_modules_above_it() {
    let found: Vec<String> = sources().iter().flat_map(|(file, text)| violations(file, text)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn the_check_finds_planted_violations() {
    for (file, text) in [
        ("math/ray.rs", "use crate::optics::Surface;"),
        ("optics/bsdf.rs", "use crate::{math::Vec3, description::{Material, Rgb}};"),
        ("description/light.rs", "fn f() { let x = crate::build::World::new(); }"),
        ("film.rs", "use super::output::Image;"),
        ("trace/path.rs", "use super::super::render;"),
        ("trace/mod.rs", "#[cfg(test)]\nmod tests {\n    use super::super::film::Film;\n}"),
        ("extra/mod.rs", ""),
        ("output/exr.rs", "use crate::{\n    film, plan,\n    description,\n};"),
    ] {
        assert_eq!(violations(Path::new(file), text).len(), 1, "{file}: {text}");
    }
    for (file, text) in [
        ("trace/path.rs", "use super::film; // a part of trace itself\nuse crate::{math, plan};"),
        ("math/ray.rs", "//! Unlike crate::optics, this knows no surface."),
        ("math/ray.rs", "mod tests { use super::*; use super::super::frame; }"),
        ("lib.rs", "pub mod math;"),
    ] {
        assert_eq!(violations(Path::new(file), text), Vec::<String>::new(), "{file}");
    }
}

#[test]
fn the_table_itself_points_upwards_only() {
    for (at, (module, allowed)) in TABLE.iter().enumerate() {
        for name in *allowed {
            assert!(TABLE[..at].iter().any(|(above, _)| above == name), "{module} names {name}");
        }
    }
    let optics = TABLE.iter().find(|(name, _)| *name == "optics");
    assert!(optics.is_some_and(|(_, allowed)| !allowed.contains(&"description")));
}

#[test]
fn every_file_is_short_and_opens_with_what_it_is() {
    for (file, text) in sources() {
        let lines = text.lines().count();
        assert!(lines <= LONGEST_FILE, "{}: {lines} lines", file.display());
        assert!(text.starts_with("//! "), "{} does not open with a module comment", file.display());
    }
}

#[test]
fn the_sources_are_free_of_unsafe_code() {
    for root in ["lib.rs", "main.rs"] {
        let (_, text) =
            sources().into_iter().find(|(file, _)| file == Path::new(root)).expect("the crate's root");
        assert!(text.contains("#![forbid(unsafe_code)]"), "{root}");
    }
}
