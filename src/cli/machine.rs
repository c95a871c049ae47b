//! Progress for programs: one JSON object a line on standard error, or the lines that Open Job
//! Description takes from standard output.
//!
//! Both are versioned: `v` of JSON goes up when a key changes its meaning or goes; new keys may come.
//! OpenJD's lines are those of its specification (How Jobs Are Run: stdout messages).

use super::args::ProgressChoice;
use super::exit::Failure;
use super::frames::Place;
use super::report::{self, Terminal};
use serde_json::{Map, Value, json};

/// The version of the JSON lines, and of the statistics.
pub const VERSION: u32 = 1;

/// How far a stage of a frame is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<'a> {
    pub place: Place,
    pub stage: &'a str,
    /// Share of the stage, at most 1.
    pub done: f64,
    /// Seconds left of the stage.
    pub eta_s: Option<f64>,
    /// Relative RMS error of the picture so far.
    pub err: Option<f64>,
}

impl State<'_> {
    pub fn json(&self) -> String {
        let State { place, stage, done, eta_s, err } = self;
        let mut line = Map::new();
        line.insert("v".to_owned(), VERSION.into());
        if let Some(frame) = place.frame {
            line.insert("frame".to_owned(), frame.into());
        }
        line.insert("stage".to_owned(), (*stage).into());
        line.insert("done".to_owned(), json!(done));
        line.insert("eta_s".to_owned(), json!(eta_s));
        line.insert("err".to_owned(), json!(err));
        Value::Object(line).to_string()
    }

    /// Per cent of all frames. A stage's share of its frame is what it takes in most renders: nearly all
    /// is tracing.
    pub fn percent(&self) -> f64 {
        let (from, to) = match self.stage {
            "build" => (0.0, 0.01),
            "trace" => (0.01, 0.98),
            "write" => (0.98, 0.99),
            DONE => (1.0, 1.0),
            _ => (0.01, 0.01),
        };
        let frame = from + (to - from) * self.done;
        let all = 100.0 * (self.place.index as f64 + frame) / self.place.of.max(1) as f64;
        // one digit, rounded down: not whole before it is
        (10.0 * all + 1e-9).floor() / 10.0
    }

    pub fn openjd_progress(&self) -> String {
        format!("openjd_progress: {:.1}\n", self.percent())
    }

    pub fn openjd_status(&self) -> String {
        let frame = self.place.frame.map_or(String::new(), |frame| format!("frame {frame}: "));
        let error = self.err.map_or(String::new(), |err| format!(", error {:.2} %", 100.0 * err));
        format!("openjd_status: {frame}{}{error}\n", self.stage)
    }
}

/// The stage after the images have their names.
pub const DONE: &str = "done";

/// A line that is not a stage's.
pub fn note(place: Place, mut fields: Value) -> String {
    if let Some(object) = fields.as_object_mut() {
        object.insert("v".to_owned(), VERSION.into());
        if let Some(frame) = place.frame {
            object.insert("frame".to_owned(), frame.into());
        }
    }
    fields.to_string()
}

/// Tells a program why a render failed, or a frame of it.
pub fn failed(progress: ProgressChoice, failure: &Failure, place: Place, terminal: &Terminal) {
    match progress {
        // who reads them may have gone; the exit code stays
        ProgressChoice::Openjd if place.frame.is_none() => {
            drop(report::print(&openjd_fail(&failure.reason())));
        }
        ProgressChoice::Json => {
            let fields = json!({"note": "failed", "code": failure.code, "reason": failure.reason()});
            terminal.say(&note(place, fields));
        }
        _ => {}
    }
}

/// Why a task failed, on one line.
fn openjd_fail(reason: &str) -> String {
    format!("openjd_fail: {reason}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(index: usize, of: usize, stage: &str, done: f64) -> State<'_> {
        State { place: Place { frame: Some(3), index, of }, stage, done, eta_s: Some(31.0), err: Some(0.021) }
    }

    #[test]
    fn a_json_line_has_the_documented_keys() {
        let line: Value = serde_json::from_str(&state(0, 1, "trace", 0.42).json()).expect("JSON");
        let expected =
            json!({ "v": 1, "frame": 3, "stage": "trace", "done": 0.42, "eta_s": 31.0, "err": 0.021 });
        assert_eq!(line, expected);
        let plain = State { place: Place::default(), ..state(0, 1, "trace", 0.42) };
        assert!(!plain.json().contains("frame"));
        assert_eq!(note(Place::default(), json!({ "note": "x" })), r#"{"note":"x","v":1}"#);
    }

    #[test]
    fn percents_rise_with_the_work_and_are_100_at_the_very_end_only() {
        let mut last = 0.0;
        for index in 0..3 {
            for stage in ["build", "trace", "write"] {
                for done in [0.0, 0.3, 0.99, 1.0] {
                    let percent = state(index, 3, stage, done).percent();
                    assert!((last..100.0).contains(&percent), "{index} {stage} {done}: {percent}");
                    last = percent;
                }
            }
            last = state(index, 3, DONE, 1.0).percent();
            assert_eq!(last == 100.0, index == 2);
        }
        assert_eq!(state(2, 3, DONE, 1.0).openjd_progress(), "openjd_progress: 100.0\n");
        assert_eq!(
            state(0, 3, "trace", 0.5).openjd_status(),
            "openjd_status: frame 3: trace, error 2.10 %\n"
        );
        assert_eq!(openjd_fail("a b"), "openjd_fail: a b\n");
    }
}
