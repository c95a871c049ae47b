//! Buffers that photons have been in, kept for those of the next pass.
//!
//! Passes take turns on threads, and what one thread's allocator holds free is not another's to use: made anew for
//! every pass, the buffers would in the end be held once by each.

use super::photon::Photon;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

#[derive(Clone, Debug, Default)]
pub(super) struct Shelf(Arc<Mutex<Vec<Vec<Photon>>>>);

impl Shelf {
    /// An empty buffer, one that was put back if there is any.
    pub fn take(&self) -> Vec<Photon> {
        self.buffers().pop().unwrap_or_default()
    }

    pub fn put(&self, used: Vec<Vec<Photon>>) {
        let emptied = used.into_iter().map(|mut buffer| {
            buffer.clear();
            buffer
        });
        self.buffers().extend(emptied);
    }

    pub fn clear(&self) {
        *self.buffers() = Vec::new();
    }

    fn buffers(&self) -> MutexGuard<'_, Vec<Vec<Photon>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
