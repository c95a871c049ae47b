//! One pixel of one pass again, with all that its camera paths met.
//!
//! The pixel goes through the same code as in a render, so that its value is that of `--passes n..n+1`,
//! bit for bit.

use super::clock::Clock;
use super::prepare::Prepared;
use super::{Options, RenderError, Silent, on_threads};
use crate::description::Loaded;
use crate::math::Place;
use crate::plan::Until;
use crate::trace::{self, SampleRecord, Tracer, Wants};
use serde::Serialize;

/// What a pixel of a pass is made of.
#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    pub x: u32,
    pub y: u32,
    pub pass: u32,
    /// As the image of this pass alone has it.
    pub value: [f32; 3],
    /// Whether every sample is finite and can be added up. One that is not was dropped.
    pub finite: bool,
    pub samples: Vec<SampleRecord>,
}

/// Traces one pixel of one pass of a checked scene again. Which passes the options name, and when they would
/// have a render end, does not matter.
pub fn replay(loaded: &Loaded, options: &Options, place: Place) -> Result<Replay, RenderError> {
    let Place { x, y, pass } = place;
    let image = &loaded.scene.image;
    if x >= image.width || y >= image.height {
        return Err(RenderError::Invalid(format!(
            "there is no pixel ({x}, {y}) in an image of {} × {}: they are counted from 0, from the top left",
            image.width, image.height
        )));
    }
    let last = pass.checked_add(1).filter(|last| *last < u32::MAX);
    let last = last.ok_or_else(|| RenderError::Invalid(format!("there is no pass {pass}")))?;
    let options = Options {
        passes: Some(pass..last),
        until: Until::default(),
        aovs: Vec::new(),
        untold: true,
        ..options.clone()
    };
    on_threads(&options, || {
        let (ready, maps) = Prepared::new(loaded, &options, &Silent, &mut Clock::start())?;
        let tracer = Tracer { wants: Wants::default(), ..ready.tracer(&maps) };
        let (value, samples) = trace::replay(&tracer, place);
        let finite = !samples.iter().any(|sample| sample.dropped);
        Ok(Replay { x, y, pass, value: value.as_vec3().to_array(), finite, samples })
    })
}
