//! A thread that breaks off in the middle of a render, on request: what surrounds a defect can be tried only so.

use std::sync::atomic::{AtomicI64, Ordering};

/// Counts steps down to the one that breaks off.
pub struct Breakage(Option<AtomicI64>);

impl Breakage {
    /// As `TERRARIUM_BREAK` says: the number of the step, from 1. Anything else is never.
    pub fn asked_for() -> Breakage {
        let asked = std::env::var("TERRARIUM_BREAK").ok().and_then(|text| text.parse().ok());
        Breakage(asked.map(AtomicI64::new))
    }

    /// # Panics
    ///
    /// At the step that was asked for.
    pub fn step(&self) {
        if let Some(left) = &self.0 {
            assert!(left.fetch_sub(1, Ordering::Relaxed) != 1, "TERRARIUM_BREAK asked for it");
        }
    }
}
