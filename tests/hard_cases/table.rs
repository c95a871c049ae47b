//! `docs/hard-cases.md`: the page that is made of measured rows, and the tests that keep it whole.

use super::record::{self, Outcome};
use super::rows::{self, Row, SECTIONS};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/hard-cases.md")
}

/// All sources of the hard cases, as text.
pub fn sources() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hard_cases");
    let mut text = String::new();
    for entry in std::fs::read_dir(folder).expect("the hard cases lie there") {
        text += &std::fs::read_to_string(entry.expect("an entry").path()).expect("a source");
    }
    text
}

#[test]
fn every_row_has_its_test_or_a_reason_why_not() {
    let expected = (1..=10).map(|i| format!("S{i}")).chain((1..=54).map(|i| format!("H{i}")));
    let found: Vec<&str> = rows::all().map(|row| row.id).collect();
    for id in expected {
        assert_eq!(found.iter().filter(|row| **row == id).count(), 1, "{id}");
    }
    let sources = sources();
    for row in rows::all() {
        if row.test.is_empty() {
            assert!(!row.excluded.is_empty(), "{} has no test and no reason", row.id);
            continue;
        }
        let (kind, number) = row.id.split_at(1);
        let prefix = format!("{}{:0>2}_", kind.to_lowercase(), number);
        assert!(row.test.starts_with(&prefix), "{} is tested by {}", row.id, row.test);
        let test = format!("#[test]\nfn {}() {{\n    row(\"{}\", ", row.test, row.id);
        assert_eq!(sources.matches(&test).count(), 1, "{}: {test}", row.id);
    }
}

#[test]
fn the_page_has_a_line_for_every_row() {
    let page = std::fs::read_to_string(page()).expect("`make hard` writes it");
    for row in rows::all() {
        let line = format!("\n| {} | {} |", row.id, what(row));
        assert_eq!(page.matches(&line).count(), 1, "docs/hard-cases.md: {}: run `make hard`", row.id);
        let excluded = format!("\n- {}: {}\n", row.id, row.excluded);
        assert!(row.excluded.is_empty() || page.contains(&excluded), "docs/hard-cases.md: {}", row.id);
    }
}

fn read(folder: &Path) -> BTreeMap<String, Outcome> {
    let outcome = |row: &Row| {
        let text = std::fs::read_to_string(folder.join(format!("{}.json", row.id))).ok()?;
        Some((row.id.to_owned(), serde_json::from_str(&text).expect("a row as it was written")))
    };
    rows::all().filter_map(outcome).collect()
}

/// Writes the page from the rows in `HARD_CASES_OUT`, and fails if one of them does not hold.
#[test]
#[ignore = "`make hard` runs it, after all rows"]
fn write_the_page() {
    let folder = record::folder().expect("HARD_CASES_OUT names the folder of the measured rows");
    let outcomes = read(&folder);
    std::fs::write(page(), text(&outcomes)).expect("docs/ is writable");
    let tested = rows::all().filter(|row| !row.test.is_empty());
    let failing: Vec<&str> =
        tested.filter(|row| !outcomes.get(row.id).is_some_and(Outcome::passes)).map(|row| row.id).collect();
    assert!(failing.is_empty(), "rows that do not hold: {failing:?}");
}

fn text(outcomes: &BTreeMap<String, Outcome>) -> String {
    let tested = rows::all().filter(|row| !row.test.is_empty()).count();
    let passing = outcomes.values().filter(|outcome| outcome.passes()).count();
    let seconds: f64 = outcomes.values().map(|outcome| outcome.seconds).sum();
    let size = if outcomes.values().all(|outcome| outcome.full) { "in full" } else { "in the small size" };
    let mut page = format!(
        "# Hard cases\n\n\
         What breaks renderers, and what this one shows in each case: {tested} rows, of which {passing} hold.\n\n\
         Each row is a test by the name of its row (`s07_…`, `h05_…`, in `tests/hard_cases/`) that measures \
         and asserts what stands here. H1 to H54 number cases that are known to break renderers, from the \
         literature and from the lists of faults of other programs; S1 to S10 are formulas of the course \
         project that this program follows ([the report, and what is done here instead](the-report.md)), \
         which are wrong, singular or biased. σ is the standard error of the mean; chances have fixed seeds.\n\n\
         `make hard` made this page, measured {size} (rows together took {seconds:.0} s, several at a time); \
         `make test` runs the same tests with fewer rays. Where a row can be a scene, the scene is in \
         `scenes/proofs/`, with its answer and where that comes from.\n"
    );
    for (section, rows) in SECTIONS {
        write!(
            page,
            "\n## {section}\n\n| row | what breaks, and the remedy | what is asserted | measured | bound | s | |\n\
             |---|---|---|---|---|---|---|\n"
        )
        .expect("memory");
        for row in rows {
            page += &line(row, outcomes.get(row.id));
        }
    }
    page += "\n## What is not in the table, and why\n\n";
    for row in rows::all().filter(|row| !row.excluded.is_empty()) {
        writeln!(page, "- {}: {}", row.id, row.excluded).expect("memory");
    }
    for outcome in outcomes.values() {
        for skipped in &outcome.skipped {
            writeln!(page, "- {}, on the machine that made this page: {skipped}", outcome.row)
                .expect("memory");
        }
    }
    page
}

/// What breaks, and the remedy.
fn what(row: &Row) -> String {
    let both = format!("{} → {}", row.case, row.remedy);
    cell(if row.remedy.is_empty() { row.case } else { &both })
}

fn line(row: &Row, outcome: Option<&Outcome>) -> String {
    let what = what(row);
    if row.test.is_empty() {
        return format!("| {} | {what} | | | | | excluded |\n", row.id);
    }
    let Some(outcome) = outcome else {
        return format!("| {} | {what} | | | | | **not run** |\n", row.id);
    };
    let column = |of: fn(&record::Figure) -> &str| -> String {
        outcome.figures.iter().map(|figure| cell(of(figure))).collect::<Vec<_>>().join("<br>")
    };
    let mut asserted = column(|figure| &figure.asserted);
    if let Some(panic) = &outcome.panic {
        write!(asserted, "<br>ended by: {}", cell(panic)).expect("memory");
    }
    let verdict = if outcome.passes() { "holds" } else { "**fails**" };
    format!(
        "| {} | {what} | {asserted} | {} | {} | {:.1} | {verdict} |\n",
        row.id,
        column(|figure| &figure.measured),
        column(|figure| &figure.bound),
        outcome.seconds,
    )
}

/// Text within a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
