//! Every snippet in the documentation of the scene's types is a scene.

use std::path::Path;
use terrarium::description::{Format, json_schema, load_str_as_written};

/// The `ron` blocks of a source text's documentation.
fn snippets(source: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut inside = false;
    for line in source.lines().map(str::trim) {
        match line.strip_prefix("///").map(str::trim) {
            Some("```ron") => {
                inside = true;
                found.push(String::new());
            }
            Some("```") => inside = false,
            Some(text) if inside => found.last_mut().expect("a block is open").extend([text, "\n"]),
            _ => {}
        }
    }
    found
}

#[test]
fn every_snippet_of_the_documentation_is_a_scene_and_every_variant_has_one() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/description");
    let mut all = String::new();
    for entry in std::fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("the sources are there").path();
        if path.is_file() {
            let source = std::fs::read_to_string(&path).expect("a source can be read");
            for snippet in snippets(&source) {
                let scene = load_str_as_written(&format!("({snippet})"), Format::Ron, &[]);
                scene.unwrap_or_else(|report| panic!("{}:\n{report}", path.display()));
                all += &snippet;
            }
        }
    }
    let schema = json_schema();
    let mut tags = Vec::new();
    variants(&schema, &mut tags);
    assert!(tags.len() > 35, "{tags:?}");
    let values = ["auto", "linear", "repeat", "mirror"];
    for tag in tags.iter().filter(|tag| !values.contains(&tag.as_str())) {
        let shown = [format!("{tag}("), format!(": {tag}")].iter().any(|form| all.contains(form));
        assert!(shown, "no snippet shows `{tag}`");
    }
}

/// The names of all variants in a schema.
fn variants(schema: &serde_json::Value, tags: &mut Vec<String>) {
    use serde_json::Value;
    if let Some(Value::Array(options)) = schema.get("oneOf") {
        for option in options {
            let required = option.get("required").and_then(Value::as_array).and_then(|r| r.first());
            let listed = option.get("enum").and_then(Value::as_array).into_iter().flatten();
            let names = required.into_iter().chain(option.get("const")).chain(listed);
            tags.extend(names.filter_map(Value::as_str).map(str::to_owned));
        }
    }
    match schema {
        Value::Object(map) => map.values().for_each(|inner| variants(inner, tags)),
        Value::Array(items) => items.iter().for_each(|inner| variants(inner, tags)),
        _ => {}
    }
}
