//! What GUIDE.md and README.md say holds: every scene and fragment in them is read by the program,
//! RON and TOML beside each other say the same, and nothing that can be written is left out.
//!
//! Fences: `ron scene`, `toml scene` are whole scenes; `ron fields`, `toml fields` are some of a
//! scene's fields, to which a camera and the materials `white` and `stone` are added.

use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use terrarium::description::{Format, NAMED_IOR, json_schema, load_str};

const PAGES: [&str; 2] = ["GUIDE.md", "README.md"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).expect("the page is in the repository")
}

/// A fenced block that is a scene or part of one.
struct Fence {
    /// `GUIDE.md:12`.
    place: String,
    format: Format,
    whole: bool,
    text: String,
    /// Number of lines between the end of the block before and this one.
    gap: usize,
}

fn fences(name: &str) -> Vec<Fence> {
    let page = page(name);
    let mut found = Vec::new();
    let mut last_end = 0;
    let mut lines = page.lines().enumerate();
    while let Some((at, line)) = lines.next() {
        let Some(info) = line.trim_start().strip_prefix("```") else { continue };
        let mut text = String::new();
        let mut end = at;
        for (i, line) in lines.by_ref() {
            end = i;
            if line.trim_start().starts_with("```") {
                break;
            }
            text.push_str(line);
            text.push('\n');
        }
        let (format, kind) = match info.split_once(' ') {
            Some(("ron", kind)) => (Format::Ron, kind),
            Some(("toml", kind)) => (Format::Toml, kind),
            _ => {
                assert!(!matches!(info, "ron" | "toml"), "{name}:{}: a fence that no test reads", at + 1);
                last_end = end;
                continue;
            }
        };
        assert!(matches!(kind, "scene" | "fields"), "{name}:{}: `{kind}` is not known", at + 1);
        let place = format!("{name}:{}", at + 1);
        found.push(Fence { place, format, whole: kind == "scene", text, gap: at - last_end });
        last_end = end;
    }
    found
}

/// The scene of a fence, as JSON, so that the order of names does not matter.
fn scene(fence: &Fence, library: &Path) -> Value {
    let library = library.to_str().expect("a temporary folder has a plain name");
    let camera = fence.text.contains("camera");
    let text = match (fence.whole, fence.format) {
        (true, _) => fence.text.clone(),
        (false, Format::Ron) => {
            let camera = if camera { "" } else { "camera: (eye: (0, 1, 5), target: (0, 0, 0))," };
            format!("(include: [{library:?}], {camera}\n{})", fence.text)
        }
        (false, Format::Toml) => {
            let camera = if camera { "" } else { "[camera]\neye = [0, 1, 5]\ntarget = [0, 0, 0]\n" };
            format!("include = [{library:?}]\n{}\n{camera}", fence.text)
        }
    };
    match load_str(&text, fence.format, &root().join("scenes"), &[]) {
        Ok(loaded) => serde_json::to_value(loaded.scene).expect("a scene is plain data"),
        Err(report) => panic!("{}: {report}", fence.place),
    }
}

/// A file with the materials that fragments name.
fn library() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("library.ron");
    let materials = r#"(materials: { "white": (diffuse: 0.8), "stone": (diffuse: (0.4, 0.38, 0.35)) })"#;
    std::fs::write(&path, materials).expect("it can be written");
    (folder, path)
}

#[test]
fn every_example_is_a_scene() {
    let (_folder, library) = library();
    let mut count = 0;
    for name in PAGES {
        for fence in fences(name) {
            scene(&fence, &library);
            count += 1;
        }
    }
    assert!(count >= 20, "only {count} examples were found");
}

#[test]
fn toml_beside_ron_says_the_same() {
    let (_folder, library) = library();
    let mut pairs = 0;
    for name in PAGES {
        for pair in fences(name).windows(2) {
            if pair[1].gap == 2 && (pair[0].format, pair[1].format) == (Format::Ron, Format::Toml) {
                assert_eq!(scene(&pair[0], &library), scene(&pair[1], &library), "{}", pair[1].place);
                pairs += 1;
            }
        }
    }
    assert!(pairs >= 10, "only {pairs} pairs were found");
}

/// Whether a page has `word` in code, by itself.
fn mentions(page: &str, word: &str) -> bool {
    let name = |c: char| c.is_alphanumeric() || c == '_';
    page.match_indices(word).any(|(at, _)| {
        let before = page[..at].chars().next_back();
        let after = page[at + word.len()..].chars().next();
        matches!(before, Some('`' | '(' | '.' | '{' | ' ')) && !after.is_some_and(name) && in_code(page, at)
    })
}

/// Whether a place is between two backticks of its line.
fn in_code(page: &str, at: usize) -> bool {
    let line = page[..at].rfind('\n').map_or(0, |end| end + 1);
    page[line..at].matches('`').count() % 2 == 1
}

/// Names of fields and choices of a JSON Schema.
fn words(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(object) => {
            if let Some(Value::Object(properties)) = object.get("properties") {
                found.extend(properties.keys().cloned());
            }
            if let Some(Value::String(choice)) = object.get("const") {
                found.insert(choice.clone());
            }
            if let Some(Value::Array(choices)) = object.get("enum") {
                found.extend(choices.iter().filter_map(Value::as_str).map(str::to_owned));
            }
            object.values().for_each(|value| words(value, found));
        }
        Value::Array(items) => items.iter().for_each(|value| words(value, found)),
        _ => {}
    }
}

#[test]
fn every_field_and_choice_is_described() {
    let guide = page("GUIDE.md");
    let mut found = BTreeSet::new();
    words(&json_schema(), &mut found);
    assert!(found.contains("max_slope_deg") && found.contains("dodecahedron") && found.contains("clamp"));
    let missing: Vec<&String> = found.iter().filter(|word| !mentions(&guide, word)).collect();
    assert!(missing.is_empty(), "GUIDE.md does not mention {missing:?}");
}

#[test]
fn the_named_indices_of_refraction_are_the_programs() {
    let guide = page("GUIDE.md");
    let cells: Vec<&str> = guide.split('|').map(str::trim).collect();
    let listed = |name: &str, ior: f64| {
        cells.windows(2).any(|pair| pair[0] == format!("`{name}`") && pair[1].parse() == Ok(ior))
    };
    for (name, ior) in NAMED_IOR {
        assert!(listed(name, *ior), "GUIDE.md does not list {name}, {ior}");
    }
}

/// What the program prints with these arguments.
fn output(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_terrarium")).args(arguments).output();
    String::from_utf8(output.expect("the program starts").stdout).expect("it prints UTF-8")
}

#[test]
fn every_option_of_every_command_is_described() {
    let guide = page("GUIDE.md");
    let help = output(&["--help"]);
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .map_while(|line| line.split_whitespace().next())
        .filter(|command| *command != "help")
        .collect();
    assert!(commands.contains(&"render") && commands.contains(&"check"), "{commands:?}");
    for command in commands {
        assert!(guide.contains(command), "GUIDE.md does not mention `{command}`");
        for word in output(&[command, "--help"]).split_whitespace() {
            let option = word.trim_end_matches([',', '.', ';', ']', ')', '`']);
            if option.starts_with("--") && option.len() > 2 && option != "--help" {
                assert!(guide.contains(option), "GUIDE.md does not mention `{command} {option}`");
            }
        }
    }
}

#[test]
fn every_target_of_make_is_described() {
    let guide = page("GUIDE.md");
    let makefile = page("Makefile");
    let targets = makefile.lines().filter_map(|line| line.strip_prefix("## ")?.split_once(':'));
    for (target, _) in targets {
        let shown = if target == "all" { "`make`".to_owned() } else { format!("`make {target}`") };
        assert!(guide.contains(&shown), "GUIDE.md does not mention {shown}");
    }
}

#[test]
fn every_key_of_the_statistics_is_described_and_there_once() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let scene = folder.path().join("scene.ron");
    std::fs::write(&scene, "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), image: (width: 2, height: 2))")
        .expect("it can be written");
    let [scene, image] = [scene, folder.path().join("a.exr")].map(|path| path.display().to_string());
    let json = output(&["render", &scene, "-o", &image, "--stats", "-", "--passes", "1", "--quiet"]);
    let stats: Value = serde_json::from_str(&json).expect("the statistics are JSON");
    let guide = page("GUIDE.md");
    for key in stats.as_object().expect("an object").keys() {
        assert!(mentions(&guide, key), "GUIDE.md does not mention `{key}`");
        assert_eq!(json.matches(&format!("\n  \"{key}\":")).count(), 1, "`{key}` is there twice");
    }
}

/// Pages that people read; pictures are made by rendering and are not looked for.
#[test]
fn links_lead_to_files() {
    for page_name in [
        "README.md",
        "GUIDE.md",
        "CHANGELOG.md",
        "docs/the-report.md",
        "docs/accuracy.md",
        "docs/adr/README.md",
    ] {
        let folder = root().join(page_name).parent().expect("a file is in a folder").to_owned();
        let page = page(page_name);
        for (at, _) in page.match_indices("](").filter(|(at, _)| !in_code(&page, *at)) {
            let target = page[at + 2..].split(')').next().unwrap_or_default();
            let file = target.split('#').next().unwrap_or_default();
            if !target.contains("://") && !file.is_empty() && !file.ends_with(".png") {
                assert!(folder.join(file).exists(), "{page_name} links to {target}, which is not there");
            }
            let anchor = target.strip_prefix('#').unwrap_or_default();
            assert!(
                anchor.is_empty() || anchors(&page).contains(anchor),
                "{page_name}: no heading for #{anchor}"
            );
        }
    }
}

/// The anchors that Markdown viewers give a page's headings.
fn anchors(page: &str) -> BTreeSet<String> {
    page.lines()
        .filter(|line| line.starts_with('#'))
        .map(|line| {
            let heading = line.trim_start_matches('#').trim().to_lowercase();
            heading
                .chars()
                .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
                .collect::<String>()
                .replace(' ', "-")
        })
        .collect()
}
