//! Photon index: photons → a map that can be asked for those near a point, the second stage of every pass.

use crate::scatter::Photon;

/// Photons, ready to be gathered.
#[derive(Clone, Debug, Default)]
pub struct PhotonMap {
    photons: Vec<Photon>,
}

impl PhotonMap {
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    pub fn is_empty(&self) -> bool {
        self.photons.is_empty()
    }
}

/// The map of a pass's photons; none where none were scattered.
pub fn map(photons: Option<Vec<Photon>>) -> Option<PhotonMap> {
    photons.map(|photons| PhotonMap { photons })
}
