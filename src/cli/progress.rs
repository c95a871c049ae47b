//! Progress: a bar on a terminal, plain lines elsewhere, or lines for programs.
//!
//! A stage never shows more than 99 %; the whole is done, and says so, when the images have their
//! names. Off a terminal nothing is drawn over.

use super::args::ProgressChoice;
use super::breakage::Breakage;
use super::frames::Place;
use super::machine::{self, DONE, State};
use super::plan;
use super::report::{self, Terminal};
use super::signals;
use super::summary::significant;
use super::viewer::Viewer;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use terrarium::film::Film;
use terrarium::output::Image;
use terrarium::render::{Planned, Progress};

/// Plain lines come after this time at the latest.
const LONGEST_SILENCE: Duration = Duration::from_secs(30);
/// The bar is drawn, and JSON lines come, no more often than this.
const SHORTEST_SILENCE: Duration = Duration::from_millis(100);

/// The progress of one render.
pub struct Reporter {
    form: Form,
    terminal: Terminal,
    /// Whether the plan is told once it is known.
    tells_plan: bool,
    place: Place,
    stage: Mutex<Option<Stage>>,
    /// The picture's error, as it was told last.
    err: Mutex<Option<f64>>,
    viewer: Option<Viewer>,
    breakage: Breakage,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Bar,
    Plain,
    Json,
    OpenJd,
    None,
}

struct Stage {
    name: String,
    unit: String,
    done: u64,
    /// Of `done`, by an earlier run.
    earlier: u64,
    total: u64,
    began: Instant,
    /// When a line was printed last, and how much of the stage it told.
    told: (Instant, f64),
    bar: Option<ProgressBar>,
}

impl Reporter {
    pub fn new(choice: ProgressChoice, quiet: bool, terminal: &Terminal) -> Self {
        let form = match choice {
            ProgressChoice::None => Form::None,
            ProgressChoice::Json => Form::Json,
            ProgressChoice::Openjd => Form::OpenJd,
            _ if quiet => Form::None,
            ProgressChoice::Bar => Form::Bar,
            ProgressChoice::Auto if terminal.redraws => Form::Bar,
            ProgressChoice::Auto | ProgressChoice::Plain => Form::Plain,
        };
        Reporter {
            form,
            terminal: terminal.clone(),
            tells_plan: false,
            breakage: Breakage::asked_for(),
            place: Place { of: 1, ..Place::default() },
            stage: Mutex::new(None),
            err: Mutex::new(None),
            viewer: None,
        }
    }

    /// The same, of one frame among others.
    pub fn of_frame(self, place: Place) -> Self {
        Reporter { place, ..self }
    }

    /// The same, telling the plan once it is known unless that is not wanted.
    pub fn telling_plan(self, wanted: bool) -> Self {
        Reporter { tells_plan: wanted, ..self }
    }

    /// The same, with the picture in a viewer.
    pub fn shown_by(self, viewer: Option<Viewer>) -> Self {
        Reporter { viewer, ..self }
    }

    /// Shows the finished picture, where it is shown.
    pub fn show(&self, image: &Image) {
        if let Some(viewer) = &self.viewer {
            viewer.finish(image, &self.terminal);
        }
    }

    /// The images have their names: the whole is done.
    pub fn complete(&self) {
        self.finish();
        let state = State { place: self.place, stage: DONE, done: 1.0, eta_s: Some(0.0), err: self.err() };
        self.tell_machine(&state);
    }

    fn err(&self) -> Option<f64> {
        *self.err.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// `, error 2.1 %` while an image is traced; nothing where it is not known.
    fn told_error(&self) -> String {
        self.err().map_or(String::new(), |error| format!(", error {} %", significant(100.0 * error)))
    }

    fn tell_machine(&self, state: &State) {
        match self.form {
            Form::Json => self.terminal.say(&state.json()),
            // who reads progress may have gone: no reason to stop
            Form::OpenJd => drop(report::print(&state.openjd_progress())),
            _ => {}
        }
    }

    fn stage(&self) -> MutexGuard<'_, Option<Stage>> {
        // a panic elsewhere leaves the counts usable
        self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tell(&self, stage: &Stage) {
        match self.form {
            Form::Plain => {
                let left = stage.seconds_left().map_or(String::new(), |s| format!(", {} left", duration(s)));
                let (percent, rate, error) = (stage.percent(), stage.rate(), self.told_error());
                self.terminal.say(&format!("{}: {percent}, {rate}{left}{error}", stage.name));
            }
            Form::Json | Form::OpenJd => self.tell_machine(&State {
                place: self.place,
                stage: &stage.name,
                done: stage.share(),
                eta_s: stage.seconds_left(),
                err: self.err(),
            }),
            Form::Bar | Form::None => {}
        }
    }
}

impl Progress for Reporter {
    fn start(&self, stage: &str, total: u64, unit: &str) {
        self.finish();
        match stage {
            "build" => signals::tracing(false),
            "trace" => signals::tracing(true),
            _ => {}
        }
        let bar = (self.form == Form::Bar).then(|| {
            let bar =
                ProgressBar::with_draw_target(Some(total.max(1)), ProgressDrawTarget::stderr_with_hz(10));
            let style = ProgressStyle::with_template("{prefix:10} {bar:30} {msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_prefix(stage.to_string());
            bar.tick();
            bar
        });
        let now = Instant::now();
        let stage = Stage {
            name: stage.to_string(),
            unit: unit.to_string(),
            done: 0,
            earlier: 0,
            total,
            began: now,
            told: (now, 0.0),
            bar,
        };
        if matches!(self.form, Form::Json | Form::OpenJd) {
            self.tell(&stage);
        }
        if self.form == Form::OpenJd {
            let state =
                State { place: self.place, stage: &stage.name, done: 0.0, eta_s: None, err: self.err() };
            drop(report::print(&state.openjd_status()));
        }
        *self.stage() = Some(stage);
    }

    fn advance(&self, done: u64) {
        self.breakage.step();
        let mut guard = self.stage();
        let Some(stage) = guard.as_mut() else { return };
        stage.done = stage.done.saturating_add(done);
        let silence = stage.told.0.elapsed();
        if let Some(bar) = &stage.bar {
            if silence >= SHORTEST_SILENCE {
                let left = stage.seconds_left().map_or(String::new(), |s| format!(", {} left", duration(s)));
                let error = self.told_error();
                bar.set_message(format!("{}, {}{left}{error}", stage.percent(), stage.rate()));
                bar.set_position(stage.done.min(stage.total.saturating_sub(1)));
                stage.told.0 = Instant::now();
            }
            return;
        }
        let news = stage.share() - stage.told.1;
        // short stages pass without a line
        let due = match self.form {
            Form::Json => silence >= SHORTEST_SILENCE,
            Form::OpenJd => silence >= Duration::from_secs(1),
            _ => silence >= LONGEST_SILENCE || (news >= 0.1 && stage.began.elapsed().as_secs() >= 1),
        };
        if due {
            self.tell(stage);
            stage.told = (Instant::now(), stage.share());
        }
    }

    fn resume(&self, done: u64) {
        if let Some(stage) = self.stage().as_mut() {
            stage.done = stage.done.saturating_add(done);
            stage.earlier = stage.earlier.saturating_add(done);
        }
    }

    fn expect(&self, total: u64) {
        if let Some(stage) = self.stage().as_mut().filter(|stage| stage.total != total) {
            stage.total = total;
            stage.told.1 = stage.told.1.min(stage.share());
            if let Some(bar) = &stage.bar {
                bar.set_length(total.max(1));
            }
        }
    }

    fn finish(&self) {
        if let Some(stage) = self.stage().take() {
            if let Some(bar) = &stage.bar {
                bar.finish_and_clear();
            }
            if matches!(self.form, Form::Json | Form::OpenJd) {
                self.tell(&stage);
            }
        }
    }

    fn planned(&self, planned: &Planned) {
        if self.form == Form::Json {
            let (seconds, bytes) = (planned.seconds, planned.peak_bytes);
            let fields =
                serde_json::json!({ "note": "planned", "predicted_s": seconds, "predicted_bytes": bytes });
            self.terminal.say(&machine::note(self.place, fields));
            planned.survey.notes.iter().for_each(|note| self.note(note));
        } else if self.tells_plan {
            self.terminal.say(&plan::summary(planned));
            planned.survey.notes.iter().for_each(|note| self.terminal.say(note));
        }
    }

    fn error(&self, error: f64, target: f64) {
        let percent = |share: f64| (1e4 * share).round() / 100.0;
        *self.err.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        if self.form == Form::Json {
            let fields = serde_json::json!({ "note": "error", "error": error, "target": target });
            self.terminal.say(&machine::note(self.place, fields));
        } else {
            self.note(&format!("error: {} %, to be {} %", percent(error), percent(target)));
        }
    }

    fn looks_on(&self) -> bool {
        self.viewer.is_some()
    }

    fn picture(&self, film: &Film, passes: u32) -> ControlFlow<()> {
        if let Some(viewer) = &self.viewer {
            viewer.show(film, &self.terminal);
        }
        // what it takes to know is little beside as many passes again
        if self.form != Form::None && passes >= 4 && passes.is_power_of_two() {
            let error = film.accuracy().map(|accuracy| accuracy.error);
            *self.err.lock().unwrap_or_else(PoisonError::into_inner) = error;
        }
        ControlFlow::Continue(())
    }

    fn note(&self, message: &str) {
        match (self.form, self.stage().as_ref().and_then(|stage| stage.bar.clone())) {
            (Form::None | Form::OpenJd, _) => {}
            (Form::Json, _) => {
                self.terminal.say(&machine::note(self.place, serde_json::json!({ "note": message })));
            }
            (_, Some(bar)) => bar.suspend(|| self.terminal.say(message)),
            (_, None) => self.terminal.say(message),
        }
    }
}

impl Stage {
    /// How much of the stage is done, at most 0.99; 0 where nobody knows.
    fn share(&self) -> f64 {
        if self.total == 0 {
            return 0.0;
        }
        (self.done as f64 / self.total as f64).min(0.99)
    }

    fn percent(&self) -> String {
        if self.total == 0 { "begun".to_owned() } else { format!("{:2} %", (100.0 * self.share()) as u32) }
    }

    fn rate(&self) -> String {
        let per_second = self.done_here() as f64 / self.began.elapsed().as_secs_f64().max(1e-3);
        format!("{} {}/s", short(per_second), self.unit)
    }

    /// At the rate so far; unknown before anything is done, and where the total is.
    fn seconds_left(&self) -> Option<f64> {
        if self.total == 0 {
            return None;
        }
        let left = self.total.saturating_sub(self.done) as f64;
        let done = self.done_here();
        (done > 0).then(|| (self.began.elapsed().as_secs_f64() * left / done as f64 * 10.0).round() / 10.0)
    }

    fn done_here(&self) -> u64 {
        self.done - self.earlier
    }
}

/// A count with a prefix of the SI: `12.3 M`.
pub fn short(value: f64) -> String {
    match value {
        v if v >= 1e9 => format!("{:.1} G", v / 1e9),
        v if v >= 1e6 => format!("{:.1} M", v / 1e6),
        v if v >= 1e4 => format!("{:.1} k", v / 1e3),
        v if v >= 100.0 || v.fract() == 0.0 => format!("{v:.0}"),
        v => format!("{v:.1}"),
    }
}

/// `4.2 s`, `3 min 20 s`, `2 h 5 min`.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        0..60 if seconds < 9.95 => format!("{seconds:.1} s"),
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_stage_shows_more_than_99_percent() {
        let now = Instant::now();
        let (name, unit) = ("trace".to_string(), "tiles".to_string());
        let mut stage =
            Stage { name, unit, done: 0, earlier: 0, total: 8, began: now, told: (now, 0.0), bar: None };
        assert_eq!((stage.share(), stage.seconds_left()), (0.0, None));
        stage.done = 4;
        assert_eq!(stage.share(), 0.5);
        stage.done = 8;
        assert_eq!((stage.share(), stage.seconds_left()), (0.99, Some(0.0)));
        // Nobody knows how much there is.
        stage.total = 0;
        assert_eq!((stage.share(), stage.seconds_left()), (0.0, None));
    }

    /// 300 of 600 were there, 3 more took 10 s: 990 s for the others.
    #[test]
    fn what_an_earlier_run_did_is_not_of_this_ones_rate() {
        let now = Instant::now();
        let began = now - Duration::from_secs(10);
        let (name, unit) = ("trace".to_string(), "tiles".to_string());
        let mut stage =
            Stage { name, unit, done: 300, earlier: 300, total: 600, began, told: (now, 0.0), bar: None };
        assert_eq!(stage.seconds_left(), None);
        stage.done = 303;
        let left = stage.seconds_left().expect("something is done");
        assert!((990.0..1000.0).contains(&left), "{left}");
    }

    #[test]
    fn durations_and_counts_read_well() {
        assert_eq!(
            [0.04, 9.94, 59.0, 200.0, 7500.0].map(duration).join(" · "),
            "0.0 s · 9.9 s · 59 s · 3 min 20 s · 2 h 5 min"
        );
        assert_eq!(
            [3.0, 4.25, 123.4, 45_600.0, 12_340_000.0].map(short).join(" · "),
            "3 · 4.2 · 123 · 45.6 k · 12.3 M"
        );
    }
}
