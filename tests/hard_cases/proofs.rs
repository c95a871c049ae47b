//! Scenes with their answer inside: `scenes/proofs/*.ron` begin with what they show, where the answer comes from,
//! and the answer, which is held against the mean of the rendered picture's red channel.

use super::record::{Record, sized};
use crate::render::shot::focused;
use std::path::{Path, PathBuf};

/// What a proof says of itself.
struct Claim {
    row: String,
    what: String,
    mean: f64,
    within: f64,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/proofs")
}

/// `// Proof for ROW: WHAT` and `// Answer: mean M ± W`.
fn claim(text: &str) -> Option<Claim> {
    let comment = |head: &str| text.lines().find_map(|line| line.strip_prefix(head));
    let (row, what) = comment("// Proof for ")?.split_once(": ")?;
    let (mean, within) = comment("// Answer: mean ")?.split_once(" ± ")?;
    Some(Claim {
        row: row.to_owned(),
        what: what.to_owned(),
        mean: mean.trim().parse().ok()?,
        within: within.trim().parse().ok()?,
    })
}

/// Renders a proof (in full: with sixteen times the passes) and records its answer.
pub fn prove(row: &mut Record, name: &str) {
    let path = folder().join(format!("{name}.ron"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let Claim { what, mean, within, .. } = claim(&text).unwrap_or_else(|| panic!("{name} states no answer"));
    let shot = focused(text).folder(&folder());
    let passes = shot.load().scene.render.passes.unwrap_or(1);
    let found = shot.passes(sized(passes, 16 * passes)).render();
    assert!(found.is_sound(), "{name}");
    row.is(&format!("{what} (`scenes/proofs/{name}.ron`)"), found.mean(), mean, within);
}

#[test]
fn every_proof_is_evaluated_by_its_row() {
    let sources = super::table::sources();
    let mut proofs = 0;
    for entry in std::fs::read_dir(folder()).expect("the proofs lie there") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("a scene");
        let claim = claim(&text).unwrap_or_else(|| panic!("{name} states no row and answer"));
        let call = format!("prove(row, \"{name}\")");
        assert_eq!(sources.matches(&call).count(), 1, "{name}: {call}");
        let row = format!("    row(\"{}\", ", claim.row);
        assert!(sources.contains(&row), "{name} is of {}", claim.row);
        proofs += 1;
    }
    assert!(proofs >= 10, "{proofs} proofs");
}
