//! Where the emitted power went: an account that balances.
//!
//! At a surface of reflection km and transmission kt the share km + (1−km)·kt of what arrives goes on;
//! the rest ends there, and counts as stored where a photon was stored and as absorbed elsewhere. Of
//! the ways to go on one is followed by chance, with its power divided by its probability: what that
//! takes away or adds is `roulette`, 0 in the mean. So, in every channel and for every pass,
//!
//! emitted + bent = stored + absorbed + escaped + cut + roulette.

use crate::math::DVec3;

/// Watts a channel, and counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    pub emitted: DVec3,
    /// Ended at surfaces where a photon was stored.
    pub stored: DVec3,
    /// Ended at other surfaces, in media, and in the lamp that sent it.
    pub absorbed: DVec3,
    /// Left the scene.
    pub escaped: DVec3,
    /// Carried by paths that were cut at the depth limit.
    pub cut: DVec3,
    /// Lost (> 0) or gained (< 0) by Russian roulette: 0 in the mean.
    pub roulette: DVec3,
    /// Gained where interpolated or mapped normals bend light off surfaces that are tilted otherwise.
    pub bent: DVec3,
    /// The power of all stored photons. A path may store several, so that this may exceed `emitted`.
    pub arrived: DVec3,
    /// Paths that left an emitter.
    pub paths: u64,
    /// Rays that those paths consist of.
    pub rays: u64,
    pub photons: u64,
    pub cut_paths: u64,
}

impl Ledger {
    pub fn add(&mut self, other: &Ledger) {
        self.emitted += other.emitted;
        self.stored += other.stored;
        self.absorbed += other.absorbed;
        self.escaped += other.escaped;
        self.cut += other.cut;
        self.roulette += other.roulette;
        self.bent += other.bent;
        self.arrived += other.arrived;
        self.paths += other.paths;
        self.rays += other.rays;
        self.photons += other.photons;
        self.cut_paths += other.cut_paths;
    }

    /// The largest imbalance of a channel as a share of all that was emitted and bent.
    pub fn imbalance(&self) -> f64 {
        let out = self.stored + self.absorbed + self.escaped + self.cut + self.roulette;
        let off = (self.emitted + self.bent - out).abs().max_element();
        let scale = (self.emitted + self.bent.abs()).max_element();
        if scale > 0.0 { off / scale } else { off }
    }

    /// The share of emitted paths' power that arrived as photons.
    pub fn efficiency(&self) -> f64 {
        let emitted = self.emitted.element_sum();
        if emitted > 0.0 { self.arrived.element_sum() / emitted } else { 0.0 }
    }
}
