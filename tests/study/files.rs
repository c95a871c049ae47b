//! What a study writes, and what that says.

use super::{MATT, folder, json, rungs, study, terrarium};
use serde_json::Value;
use std::fs;
use std::path::Path;
use terrarium::measure::read;
use terrarium::measure::study::COLUMNS;

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join("out").join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn everything_is_written_and_can_be_read() {
    let folder = folder(MATT);
    let outcome = study(folder.path(), &["--knobs", "passes,antialiasing,shadow_rays,mesh,photons,depth"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = json(folder.path());
    assert_eq!(found["complete"], true, "{}", outcome.stderr);
    let all = found["rungs"].as_array().expect("a list");

    // Every rung has its row, its picture and its map.
    let csv = text(folder.path(), "study.csv");
    assert_eq!(csv.lines().next(), Some(COLUMNS.join(",").as_str()));
    assert_eq!(csv.lines().count(), all.len() + 1);
    for rung in all {
        let name = rung["name"].as_str().expect("a name");
        assert!(csv.lines().any(|line| line.starts_with(&format!("{name},"))), "{name}");
        for file in ["pictures", "errors"].map(|place| folder.path().join(format!("out/{place}/{name}.png")))
        {
            let picture = read::load(&file).expect("a picture");
            assert_eq!((picture.width, picture.height), (32, 24), "{name}");
        }
        assert_eq!(rung["runs"].as_array().map(Vec::len), Some(2), "{name}");
    }
    let names: Vec<&Value> = all.iter().map(|rung| &rung["name"]).collect();
    assert!(names.iter().all(|name| names.iter().filter(|other| other == &name).count() == 1), "{names:?}");

    // Knobs that change nothing are left out for a reason in the scene's terms.
    let left_out = found["left_out"].to_string();
    assert!(left_out.contains("no photons are sent: caustics: off"), "{left_out}");
    assert!(left_out.contains("the scene's antialiasing is `progressive`, not `adaptive`"), "{left_out}");

    let plot = text(folder.path(), "plot.svg");
    assert!(plot.starts_with("<svg") && plot.trim_end().ends_with("</svg>"));
    assert_eq!(plot.matches("<circle").count(), all.len());
    assert!(plot.contains("Pareto front") && plot.contains("theory: −0.75 to −0.50"), "{plot}");
    let drawn = read::load(&folder.path().join("out/plot.png")).expect("a picture");
    assert!(drawn.width > 1000 && drawn.height > 500);

    // The page holds all it shows.
    let page = text(folder.path(), "index.html");
    for outside in ["http:", "https:", "src=\"", "href=", "url(", "import", "{{"] {
        assert!(!page.contains(outside), "the page has `{outside}`");
    }
    assert_eq!(page.matches("data:image/png;base64,").count(), 2 * all.len() + 1);
    for line in found["lines"].as_array().expect("a list") {
        assert!(line["sentence"].as_str().is_some_and(|s| s.contains("error") && s.ends_with('.')), "{line}");
    }
}

#[test]
fn errors_fall_with_passes_and_the_reference_is_better_than_all() {
    let folder = folder(MATT);
    let outcome = study(folder.path(), &["--knobs", "passes", "--json"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = json(folder.path());
    assert_eq!(found, serde_json::from_str::<Value>(&outcome.stdout).expect("JSON"));
    let passes = rungs(&found, "passes");
    let errors: Vec<f64> =
        passes.iter().map(|rung| rung["result"]["error"][0].as_f64().expect("a number")).collect();
    assert!(errors.len() == 3 && errors[0] > errors[1] && errors[1] > errors[2], "{errors:?}");
    // The first render tells nothing of its error, the others do.
    assert!(passes[0]["result"]["stated"].is_null() && passes[2]["result"]["stated"][0].as_f64() > Some(0.0));
    let reference = found["reference"]["error"].as_f64().expect("rendered");
    assert!(reference < 0.2 * errors[2], "{reference} and {errors:?}");
    assert!(outcome.stderr.contains("reference: rendered by this program"), "{}", outcome.stderr);
    // Noise of samples that are spread well falls at least as fast as that of independent ones.
    let slope = found["lines"][0]["error_by_number"].as_f64().expect("a slope");
    assert!((-1.2..-0.35).contains(&slope), "{slope}");
    assert_eq!(found["lines"][0]["theory"], serde_json::json!([-0.75, -0.5]));
}

/// The options of a rung's row make its picture, to the last bit.
#[test]
fn rungs_are_rendered_again_by_their_options() {
    let folder = folder(MATT);
    let outcome = study(folder.path(), &["--knobs", "antialiasing,shadow_rays", "--seeds", "1"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = json(folder.path());
    for name in ["antialiasing-grid-3", "antialiasing-adaptive-0.1-2", "shadow_rays-4"] {
        let rung = found["rungs"].as_array().expect("a list").iter().find(|rung| rung["name"] == name);
        let rung = rung.unwrap_or_else(|| panic!("no {name} in {found:#}"));
        let passes = rung["passes"].to_string();
        let mut arguments =
            vec!["render", "scene.ron", "-o", "again.exr", "--seed", "0", "--passes", &passes];
        for set in rung["set"].as_array().expect("a list") {
            arguments.extend(["--set", set.as_str().expect("text")]);
        }
        let again = terrarium(folder.path(), &arguments);
        assert_eq!(again.code, Some(0), "{}", again.stderr);
        let diff = terrarium(
            folder.path(),
            &["diff", "again.exr", "out/reference.exr", "--fast", "--json", "--max-e", "9"],
        );
        let diff: Value = serde_json::from_str(&diff.stdout).expect("JSON");
        assert_eq!(diff["layers"][0]["colour"]["relative_rms"], rung["runs"][0]["error"], "{name}");
    }
}

#[test]
fn photons_and_k_are_knobs_where_photons_run() {
    let glass = MATT
        .replace("\"red\": (diffuse: (0.7, 0.1, 0.1))", "\"red\": (transmission: 1, ior: 1.5)")
        .replace("materials:", "photons: progressive(count: 1600, k: 12), materials:");
    let folder = folder(&glass);
    let rendered = terrarium(
        folder.path(),
        &["render", "scene.ron", "-o", "truth.exr", "--passes", "40", "--seed", "9"],
    );
    assert_eq!(rendered.code, Some(0), "{}", rendered.stderr);
    let knobs = ["--knobs", "passes,photons,k", "--seeds", "1", "--reference", "truth.exr"];
    let outcome = study(folder.path(), &knobs);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = json(folder.path());
    let values = |knob: &str| -> Vec<String> {
        rungs(&found, knob).iter().map(|rung| rung["value"].as_str().expect("text").to_owned()).collect()
    };
    assert_eq!(values("photons"), ["100", "400", "1600", "6400"]);
    assert_eq!(values("k"), ["3", "6", "12", "24", "48"]);
    assert_eq!(found["lines"][0]["theory"], serde_json::json!([-0.75, -1.0 / 3.0]));
}
