//! How a hard case is told: what is asserted, the figure that was measured, its bound, and the time.
//!
//! A test states its row, measures, and fails at its end if a figure is out of its bound. Where the
//! environment variable `HARD_CASES_OUT` names a folder, the row is written there as one line of JSON.
//! `HARD_CASES=full` takes the numbers of rays, samples and files that the catalogue asks for; without it
//! they are small enough for every day.

use serde::{Deserialize, Serialize};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// One figure with its bound.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Figure {
    pub asserted: String,
    pub measured: String,
    pub bound: String,
    pub holds: bool,
}

/// A row as it is written.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Outcome {
    pub row: String,
    pub full: bool,
    pub seconds: f64,
    pub figures: Vec<Figure>,
    /// What a test says that could not come to its end.
    pub panic: Option<String>,
    /// What was not looked at on this machine.
    pub skipped: Vec<String>,
}

impl Outcome {
    pub fn passes(&self) -> bool {
        self.panic.is_none() && self.figures.iter().all(|figure| figure.holds)
    }
}

/// A row in the making.
#[derive(Default)]
pub struct Record {
    figures: Vec<Figure>,
    skipped: Vec<String>,
}

/// Whether the catalogue's own numbers are asked for.
pub fn full() -> bool {
    std::env::var("HARD_CASES").is_ok_and(|size| size == "full")
}

/// The small size or the full one.
pub fn sized<T>(small: T, of_catalogue: T) -> T {
    if full() { of_catalogue } else { small }
}

/// The folder in which rows are written, if they are to be.
pub fn folder() -> Option<PathBuf> {
    std::env::var_os("HARD_CASES_OUT").map(PathBuf::from)
}

/// Measures a row, writes it where rows are asked for, and fails if it does not hold.
#[track_caller]
pub fn row(id: &str, measure: impl FnOnce(&mut Record)) {
    let start = Instant::now();
    let mut record = Record::default();
    let end = catch_unwind(AssertUnwindSafe(|| measure(&mut record)));
    let outcome = Outcome {
        row: id.to_owned(),
        full: full(),
        seconds: start.elapsed().as_secs_f64(),
        figures: record.figures,
        panic: end.as_ref().err().map(|cause| words_of(cause.as_ref())),
        skipped: record.skipped,
    };
    if let Some(folder) = folder() {
        write(&folder, &outcome);
    }
    for Figure { asserted, measured, bound, holds } in &outcome.figures {
        println!("{id}: {asserted}: {measured} ({bound}){}", if *holds { "" } else { " FAILS" });
    }
    if let Err(cause) = end {
        resume_unwind(cause);
    }
    assert!(!outcome.figures.is_empty(), "{id} measures nothing");
    let failing: Vec<&Figure> = outcome.figures.iter().filter(|figure| !figure.holds).collect();
    assert!(failing.is_empty(), "{id}: {failing:#?}");
}

fn write(folder: &Path, outcome: &Outcome) {
    std::fs::create_dir_all(folder).expect("the folder of rows can be made");
    let line = serde_json::to_string(outcome).expect("a row is JSON") + "\n";
    std::fs::write(folder.join(format!("{}.json", outcome.row)), line).expect("the folder is writable");
}

fn words_of(cause: &(dyn std::any::Any + Send)) -> String {
    let text = cause.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| cause.downcast_ref::<&str>().copied()).unwrap_or("a panic without words");
    text.lines().next().unwrap_or_default().to_owned()
}

impl Record {
    fn add(&mut self, asserted: &str, measured: String, bound: String, holds: bool) {
        self.figures.push(Figure { asserted: asserted.to_owned(), measured, bound, holds });
    }

    /// |found − expected| ≤ within.
    pub fn is(&mut self, asserted: &str, found: f64, expected: f64, within: f64) {
        let bound = format!("{} ± {}", near(expected, expected, within), figure(within));
        self.add(asserted, near(found, expected, within), bound, (found - expected).abs() <= within);
    }

    /// |found − expected| ≤ share·|expected|.
    pub fn is_close(&mut self, asserted: &str, found: f64, expected: f64, share: f64) {
        let within = share * expected.abs();
        let bound = format!("{} ± {} %", near(expected, expected, within), figure(100.0 * share));
        self.add(asserted, near(found, expected, within), bound, (found - expected).abs() <= within);
    }

    pub fn at_most(&mut self, asserted: &str, found: f64, bound: f64) {
        self.add(asserted, figure(found), format!("≤ {}", figure(bound)), found <= bound);
    }

    pub fn at_least(&mut self, asserted: &str, found: f64, bound: f64) {
        self.add(asserted, figure(found), format!("≥ {}", figure(bound)), found >= bound);
    }

    /// That it never happened among so many trials.
    pub fn none(&mut self, asserted: &str, count: u64, of: u64) {
        let measured = format!("{} of {}", grouped(count), grouped(of));
        self.add(asserted, measured, "0".to_owned(), count == 0 && of > 0);
    }

    /// That it happened in all of so many trials.
    pub fn all(&mut self, asserted: &str, count: u64, of: u64) {
        let measured = format!("{} of {}", grouped(count), grouped(of));
        self.add(asserted, measured, "all".to_owned(), count == of && of > 0);
    }

    /// A share of trials that is no less than this one.
    pub fn share(&mut self, asserted: &str, count: u64, of: u64, least: f64) {
        let measured = format!("{} of {}", grouped(count), grouped(of));
        let holds = of > 0 && count as f64 >= least * of as f64;
        self.add(asserted, measured, format!("≥ {} %", figure(100.0 * least)), holds);
    }

    pub fn holds(&mut self, asserted: &str, yes: bool) {
        self.add(asserted, if yes { "yes" } else { "no" }.to_owned(), "yes".to_owned(), yes);
    }

    /// Words that were found, which must hold others.
    pub fn says(&mut self, asserted: &str, found: &str, expected: &str) {
        let measured = format!("“{}”", found.trim().lines().next().unwrap_or_default());
        self.add(asserted, measured, format!("“{expected}”"), found.contains(expected));
    }

    /// What this machine cannot show.
    pub fn skip(&mut self, what: &str) {
        self.skipped.push(what.to_owned());
    }
}

/// A figure with the digits that its bound makes worth reading.
fn near(found: f64, expected: f64, within: f64) -> String {
    let digits = (expected.abs().max(f64::MIN_POSITIVE) / within.max(f64::MIN_POSITIVE)).log10();
    if (1.0..14.0).contains(&digits) && (1e-3..1e6).contains(&expected.abs()) {
        let decimals = (1.0 - within.log10()).floor();
        format!("{found:.*}", decimals.clamp(0.0, 15.0) as usize)
    } else {
        figure(found)
    }
}

/// Up to six digits; powers of ten for the very small and the very large.
pub fn figure(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    if x.fract() == 0.0 && x.abs() < 1e15 {
        let whole = grouped(x.abs() as u64);
        return if x < 0.0 { format!("−{whole}") } else { whole };
    }
    let size = x.abs().log10().floor() as i32;
    if (-4..6).contains(&size) {
        let text = format!("{x:.*}", (5 - size).clamp(0, 9) as usize);
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        return text.replace('-', "−");
    }
    format!("{x:.2e}").replace('-', "−")
}

/// 1234567 as 1,234,567.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[test]
fn figures_are_written_as_people_read_them() {
    let cases = [0.0, 1.0, -3.0, 1e7, 0.75, 0.923_077, 1.5e-9, 41.810_314_9, 2.5e20, 1e-4];
    let written =
        ["0", "1", "−3", "10,000,000", "0.75", "0.923077", "1.50e−9", "41.8103", "2.50e20", "0.0001"];
    assert_eq!(cases.map(figure), written);
}

#[test]
fn a_row_that_does_not_hold_fails_and_says_so() {
    let run =
        |measure: fn(&mut Record)| catch_unwind(|| row("T0", measure)).map_err(|e| words_of(e.as_ref()));
    assert!(run(|r| r.at_most("a", 1.0, 1.0)).is_ok());
    for bad in [
        (|r: &mut Record| r.at_most("a", 1.1, 1.0)) as fn(&mut Record),
        |r| r.at_most("a", f64::NAN, 1.0),
        |r| r.is("a", f64::NAN, 1.0, 1.0),
        |r| r.none("a", 0, 0),
        |r| r.none("a", 1, 9),
        |r| r.all("a", 8, 9),
        |r| r.share("a", 8, 9, 0.9),
        |r| r.holds("a", false),
        |r| r.says("a", "b", "c"),
        |_| {},
        |_| panic!("no end"),
    ] {
        assert!(run(bad).is_err());
    }
}
