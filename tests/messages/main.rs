//! Wrong scenes and what is said about each, word for word: place, path, message.

mod lights;
mod materials;
mod objects;
mod settings;
mod syntax;

use std::path::Path;
use terrarium::description::{Format, Report, load, load_str};

/// A line of a scene, and the headlines of what is said about it.
type Case = (&'static str, &'static [&'static str]);

/// A scene of one line, its second; what a scene needs besides follows.
fn scene(line: &str) -> String {
    let rest = [
        ("camera", "camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n"),
        ("ambient", "ambient: 1,\n"),
        ("materials", "materials: { \"m\": (diffuse: 0.5) },\n"),
    ];
    let rest: String = rest.iter().filter(|(key, _)| !line.contains(key)).map(|(_, text)| *text).collect();
    format!("(\n{line},\n{rest})")
}

fn headlines(report: &Report) -> Vec<String> {
    report.diagnostics.iter().map(|d| d.headline()).collect()
}

#[test]
fn each_mistake_is_named_with_its_place() {
    let topics = [settings::CASES, materials::CASES, lights::CASES, objects::CASES, syntax::CASES];
    for (line, expected) in topics.into_iter().flatten() {
        let found = match load_str(&scene(line), Format::Ron, Path::new("tests/description"), &[]) {
            Ok(loaded) => loaded.warnings.iter().map(|d| d.headline()).collect(),
            Err(report) => headlines(&report),
        };
        let found: Vec<&str> = found.iter().map(|line| line.trim_start_matches("<input>:")).collect();
        // that the line has a material too many or nothing to see is not its point
        let doubts =
            |line: &&str| !(line.ends_with("is not used") || line.ends_with("the scene has no objects"));
        assert_eq!(found.into_iter().filter(doubts).collect::<Vec<_>>(), *expected, "{line}");
    }
}

#[test]
fn whole_scenes_full_of_mistakes_are_reported_in_one_run() {
    for name in ["many.ron", "many.toml", "syntax.ron", "syntax.toml", "unclosed.ron"] {
        let path = Path::new("tests/bad_scenes").join(name);
        let report = load(&path, &[]).err().unwrap_or_else(|| panic!("{name} was read"));
        assert_eq!(report.exit_code(), 2);
        let expected = std::fs::read_to_string(format!("tests/bad_scenes/{name}.txt"))
            .expect("it lies beside the scene");
        let found: Vec<String> = headlines(&report)
            .iter()
            .map(|line| line.trim_start_matches("tests/bad_scenes/").to_owned())
            .collect();
        assert_eq!(found.join("\n"), expected.trim_end(), "{name}");
    }
}

#[test]
fn a_diagnostic_shows_the_line_the_place_and_what_helps() {
    let report = load_str(
        &scene("materials: { \"m\": (diffuse: 0.8, specular: 0.3) }"),
        Format::Ron,
        Path::new(""),
        &[],
    );
    let expected = "<input>:2:19: error: materials.m: gives back 1.1 of the light it gets: 0.8 by its layers and 0.3 by its highlight
 2 | materials: { \"m\": (diffuse: 0.8, specular: 0.3) },
   |                   ^
  help: lower `specular` to 0.2, or the layers (reflection, transmission, diffuse)";
    assert_eq!(report.err().map(|report| report.to_string()).as_deref(), Some(expected));
}
