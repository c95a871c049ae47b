//! `watch`: a scene is rendered pass by pass, and anew whenever it or a file that it uses changes; its
//! mistakes are told, and the next change is waited for.
//!
//! Files are asked for their times and lengths a few times a second, which works on every file system
//! and for files that editors replace.

use super::blocks::{self, Linear};
use super::check::{load, set_threads};
use super::exit::{Failure, USAGE};
use super::render::until;
use super::report::{self, Terminal};
use super::target::png_settings;
use super::viewer::Viewer;
use super::watch_args::WatchArgs;
use std::collections::BTreeMap;
use std::io::{self, IsTerminal};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};
use terrarium::description::{Kind, Loaded};
use terrarium::film::Film;
use terrarium::output::Image;
use terrarium::plan::Plan;
use terrarium::render::{self, Progress, RenderError};
use terrarium::trace::Layer;

/// Between two looks at the files.
const LOOK: Duration = Duration::from_millis(100);
/// A scene that lacks a file is read again after this time.
const MISSING: Duration = Duration::from_secs(1);
/// Between two pictures in the terminal.
const DRAW: Duration = Duration::from_millis(250);

/// Watches until it is ended from outside, or until `--renders` renders were finished.
pub fn run(args: &WatchArgs, terminal: &Terminal) -> Result<(), Failure> {
    if args.scene == Path::new("-") {
        return Err(Failure::new(USAGE, "a scene from standard input does not change: give a file"));
    }
    set_threads(args.work.threads)?;
    let viewer =
        args.display_server.as_deref().map(|address| Viewer::new(address, &args.scene)).transpose()?;
    let screen = io::stdout().is_terminal().then(screen).flatten();
    let (mut files, mut finished, mut told) = (vec![args.scene.clone()], 0, None);
    loop {
        let before = Snapshot::of(&files);
        let (since, patience) =
            match load(&args.scene, &args.reading, args.work.options().overrides.unread())? {
                Ok(loaded) => {
                    told = None;
                    files = used(&loaded);
                    let since = before.and(&files);
                    let drawn = Mutex::default();
                    let view = View {
                        args,
                        terminal,
                        loaded: &loaded,
                        viewer: viewer.as_ref(),
                        screen,
                        since,
                        drawn,
                    };
                    match view.render() {
                        Ok(true) => finished += 1,
                        Ok(false) => {}
                        Err(error) => tell(&loaded, error, terminal),
                    }
                    (view.since, None)
                }
                Err(report) => {
                    if told.as_ref() != Some(&report) {
                        report.diagnostics.iter().for_each(|diagnostic| terminal.diagnostic(diagnostic));
                    }
                    let named = report.diagnostics.iter().filter_map(|found| found.file.clone());
                    files.extend(named.filter(|file| !files.contains(file)).collect::<Vec<_>>());
                    // a file that is missing may come
                    let missing = report.errors().any(|error| error.kind == Kind::Io);
                    told = Some(report);
                    (before.and(&files), missing.then_some(MISSING))
                }
            };
        if args.renders.is_some_and(|renders| finished >= renders) {
            return Ok(());
        }
        if let Some(changed) = since.wait(patience) {
            terminal.say(&format!("changed: {}", changed.display()));
        }
    }
}

fn tell(loaded: &Loaded, error: RenderError, terminal: &Terminal) {
    let failure = super::render::unbuildable(error, loaded, terminal);
    if !failure.message.is_empty() {
        terminal.error(&failure.message);
    }
}

/// The files whose changes change the picture.
fn used(loaded: &Loaded) -> Vec<PathBuf> {
    let mut files = loaded.files.clone();
    files.extend(loaded.assets.iter().cloned());
    files.sort();
    files.dedup();
    files
}

/// Times and lengths of files; of a file that is not there, none.
#[derive(Debug, Default)]
struct Snapshot {
    known: BTreeMap<PathBuf, Option<(SystemTime, u64)>>,
}

impl Snapshot {
    fn of(files: &[PathBuf]) -> Snapshot {
        Snapshot { known: files.iter().map(|file| (file.clone(), state(file))).collect() }
    }

    /// The first file that is not as it was.
    fn changed(&self) -> Option<PathBuf> {
        self.known.iter().find(|(file, known)| state(file) != **known).map(|(file, _)| file.clone())
    }

    /// The same with further files; of one that is known already, as it was then.
    fn and(self, files: &[PathBuf]) -> Snapshot {
        Snapshot { known: Snapshot::of(files).known.into_iter().chain(self.known).collect() }
    }

    /// Waits for a change, or for so long.
    fn wait(&self, patience: Option<Duration>) -> Option<PathBuf> {
        let began = Instant::now();
        loop {
            if let Some(file) = self.changed() {
                // an editor may be writing still
                std::thread::sleep(LOOK / 2);
                return Some(file);
            }
            if patience.is_some_and(|patience| began.elapsed() >= patience) {
                return None;
            }
            std::thread::sleep(LOOK);
        }
    }
}

fn state(file: &Path) -> Option<(SystemTime, u64)> {
    let about = std::fs::metadata(file).ok()?;
    Some((about.modified().ok()?, about.len()))
}

/// Columns and rows for a picture on the terminal, with a line left for words.
fn screen() -> Option<(usize, usize)> {
    let (width, height) = terminal_size::terminal_size()?;
    Some((usize::from(width.0).max(2), usize::from(height.0).saturating_sub(2).max(1)))
}

/// One render that is looked at.
struct View<'a> {
    args: &'a WatchArgs,
    terminal: &'a Terminal,
    loaded: &'a Loaded,
    viewer: Option<&'a Viewer>,
    screen: Option<(usize, usize)>,
    /// The files as they were when the scene was read.
    since: Snapshot,
    drawn: Mutex<Drawn>,
}

#[derive(Default)]
struct Drawn {
    at: Option<Instant>,
    /// Lines of the picture that stands on the terminal.
    lines: usize,
    passes: u32,
}

impl View<'_> {
    /// Whether it came to its end before something changed.
    fn render(&self) -> Result<bool, RenderError> {
        let options = self.args.work.options();
        let plan = Plan::new(&self.loaded.scene, &options.request())?;
        let image = &self.loaded.scene.image;
        let (scene, until) = (self.args.scene.display(), until(&plan));
        self.terminal.say(&format!("{scene}: {} × {} pixels, {until}", image.width, image.height));
        self.loaded.warnings.iter().for_each(|warning| self.terminal.diagnostic(warning));
        let done = render::render(self.loaded, &options, self)?;
        if self.since.changed().is_some() {
            return Ok(false);
        }
        self.draw_image(&done.image);
        if let Some(viewer) = self.viewer {
            viewer.finish(&done.image, self.terminal);
        }
        let error =
            done.stats.accuracy.map_or(String::new(), |a| format!(", error {:.2} %", 100.0 * a.error));
        let files = self.since.known.len();
        self.terminal
            .say(&format!("{} passes{error}; waiting for changes of {files} files", done.stats.passes));
        Ok(true)
    }

    /// Draws the finished picture.
    fn draw_image(&self, image: &Image) {
        let Some(picture) = image.beauty() else { return };
        let channels = ["R", "G", "B"].map(|name| picture.channel(name).unwrap_or_default());
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        self.draw(image.width, image.height, channels, &mut drawn);
    }

    /// Draws over the picture before, where there is a terminal.
    fn draw(&self, width: usize, height: usize, channels: [&[f32]; 3], drawn: &mut Drawn) {
        let Some((columns, rows)) = self.screen else { return };
        let gain = libm::exp2(png_settings(&self.loaded.scene.image).exposure_ev);
        let text = blocks::draw(Linear { width, height, channels, gain }, columns, rows);
        let up = if drawn.lines > 0 { format!("\x1b[{}A", drawn.lines) } else { String::new() };
        drawn.lines = text.lines().count() + 1;
        // a terminal that has gone away ends the program soon enough
        drop(report::print(&format!("{up}{text}\x1b[2Kpass {}\n", drawn.passes)));
    }
}

impl Progress for View<'_> {
    fn start(&self, _: &str, _: u64, _: &str) {}
    fn advance(&self, _: u64) {}
    fn finish(&self) {}
    fn note(&self, message: &str) {
        self.terminal.say(message);
    }

    fn looks_on(&self) -> bool {
        true
    }

    fn picture(&self, film: &Film, passes: u32) -> ControlFlow<()> {
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        drawn.passes = passes;
        if self.screen.is_some() && drawn.at.is_none_or(|at| at.elapsed() >= DRAW) {
            let channels = film.channels(Layer::Radiance);
            if let [r, g, b] = &channels[..] {
                self.draw(film.width as usize, film.height as usize, [r, g, b], &mut drawn);
            }
            drawn.at = Some(Instant::now());
        }
        if let Some(viewer) = self.viewer {
            viewer.show(film, self.terminal);
        }
        match self.since.changed() {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        }
    }
}
