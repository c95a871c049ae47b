//! What each effect took, beside what was predicted.

use super::clock::Clock;
use super::photons::{AllPhotons, PassMaps, PhotonStats};
use crate::forecast::{Bill, PhotonSeconds};
use crate::trace::Tally;
use serde::Serialize;

/// Wall seconds of an effect, pilots and photons included.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Priced {
    /// `camera` (to the first surface, with its material), or an effect's key.
    pub effect: &'static str,
    pub seconds: f64,
    pub predicted_seconds: f64,
}

/// Wall seconds of the photons before tracing: pilots, and the first pass's.
pub(super) fn first_photons(first: &PassMaps, clock: &Clock) -> PhotonSeconds {
    let seconds = first.seconds();
    seconds.times((clock.of("pilot") + clock.of("photons")) / seconds.sum().max(f64::MIN_POSITIVE))
}

/// `seconds` of tracing: what the tiles did not take of it was spent on the photons of later passes.
pub(super) fn taken(tally: &Tally, seconds: f64, photons: &AllPhotons, before: PhotonSeconds) -> Bill {
    let later = |photons: &Option<PhotonStats>| {
        let several = photons.as_ref().filter(|photons| photons.maps > 1);
        several.map_or(0.0, |photons| photons.emitted as f64)
    };
    let emitted =
        PhotonSeconds { caustics: later(&photons.photons), indirect: later(&photons.indirect_photons) };
    if emitted.sum() == 0.0 {
        let mut bill = Bill::new(tally.watch.spent(), seconds, PhotonSeconds::default());
        bill.add_photons(before);
        return bill;
    }
    let tiles = (tally.seconds / rayon::current_num_threads() as f64).min(seconds);
    let mut bill = Bill::new(tally.watch.spent(), tiles, emitted.times((seconds - tiles) / emitted.sum()));
    bill.add_photons(before);
    bill
}

/// Row by row, in the order of what was predicted.
pub(super) fn beside(taken: &Bill, predicted: &Bill) -> Vec<Priced> {
    let mut effects: Vec<&'static str> = Vec::new();
    for price in predicted.0.iter().chain(&taken.0) {
        if !effects.contains(&price.effect) {
            effects.push(price.effect);
        }
    }
    let row = |effect| Priced { effect, seconds: taken.of(effect), predicted_seconds: predicted.of(effect) };
    effects.into_iter().map(row).collect()
}
