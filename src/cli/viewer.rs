//! `--display-server`: the picture in a viewer while it is rendered. What becomes of the viewer is told
//! once and changes nothing.

use super::exit::{Failure, USAGE};
use super::report::Terminal;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use terrarium::film::Film;
use terrarium::output::{Display, Image};
use terrarium::trace::Layer;

/// Between two pictures: what making one takes is little beside.
const SHORTEST: Duration = Duration::from_millis(250);

pub struct Viewer {
    display: Display,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    shown: Option<Instant>,
    complained: bool,
}

impl Viewer {
    /// The viewer at an address; pictures have the scene's name there.
    pub fn new(address: &str, scene: &Path) -> Result<Viewer, Failure> {
        let display = Display::new(address, &scene.display().to_string())
            .map_err(|error| Failure::new(USAGE, format!("--display-server {address}: {error}")))?;
        Ok(Viewer { display, state: Mutex::default() })
    }

    /// Shows the film as it is, if the viewer would see it.
    pub fn show(&self, film: &Film, terminal: &Terminal) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.shown.is_some_and(|shown| shown.elapsed() < SHORTEST) || !self.display.ready() {
            return;
        }
        let channels = film.channels(Layer::Radiance);
        if let [r, g, b] = &channels[..] {
            self.display.show(film.width as usize, film.height as usize, interleaved([r, g, b]));
        }
        state.shown = Some(Instant::now());
        self.complain(&mut state, terminal);
    }

    /// Shows the finished picture, and gives it a moment to arrive.
    pub fn finish(&self, image: &Image, terminal: &Terminal) {
        let Some(picture) = image.beauty() else { return };
        let channels = ["R", "G", "B"].map(|name| picture.channel(name).unwrap_or_default());
        self.display.show(image.width, image.height, interleaved(channels));
        self.display.finish();
        self.complain(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner), terminal);
    }

    fn complain(&self, state: &mut State, terminal: &Terminal) {
        if let Some(trouble) = self.display.trouble()
            && !state.complained
        {
            state.complained = true;
            terminal.warning(&format!("the display server does not show the picture: {trouble}"));
        }
    }
}

fn interleaved([r, g, b]: [&[f32]; 3]) -> Vec<f32> {
    r.iter().zip(g).zip(b).flat_map(|((r, g), b)| [*r, *g, *b]).collect()
}
