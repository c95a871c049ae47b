//! Paths that leave something opaque with which glass is flush: they cross its face first (see
//! [`crate::build::Departure`]).

use super::Tracer;
use super::branch::Branch;
use crate::build::{Beside, Entry, Start, Surface};
use std::num::NonZeroU32;

/// Branches that are still to be followed, the last one first, and what some of them cross where they start.
#[derive(Default)]
pub(super) struct Todo {
    branches: Vec<Branch>,
    entries: Vec<Entry>,
}

impl Todo {
    pub fn clear(&mut self) {
        self.branches.clear();
        self.entries.clear();
    }

    #[inline(always)]
    pub fn push(&mut self, branch: &Branch) {
        self.branches.push(*branch);
    }

    #[inline]
    pub fn len(&self) -> usize {
        self.branches.len()
    }

    /// Puts the last one in the place of `branch`, which spares a copy. Whether there is one.
    #[inline(always)]
    pub fn pop(&mut self, branch: &mut Branch) -> bool {
        let Some(last) = self.branches.last() else { return false };
        *branch = *last;
        self.branches.truncate(self.branches.len() - 1);
        true
    }

    /// What the branch crosses first, instead of what its ray meets.
    #[inline]
    pub fn entry(&self, branch: &Branch) -> Option<&Entry> {
        self.entries.get(branch.entry?.get() as usize - 1)
    }
}

impl Tracer<'_> {
    /// Turns a branch that goes on from this surface to the way that it takes if glass is flush with it.
    #[inline]
    pub(super) fn depart(&self, branch: &mut Branch, surface: &Surface, todo: &mut Todo) {
        if self.world.instances[surface.instance as usize].flush_error > 0.0 {
            self.depart_beside(branch, surface, &mut todo.entries);
        }
    }

    /// The same with the last branch of the list, which the surface has scattered.
    #[inline]
    pub(super) fn depart_scattered(&self, surface: &Surface, beside: &Beside, todo: &mut Todo) {
        let Some(branch) = todo.branches.last_mut() else { return };
        if let Beside::Before(_) = beside {
            // Back to what is opaque there.
            let dir = branch.ray.dir;
            (branch.start, branch.ray) = self.going_on(surface, surface.p_error, dir, true);
        } else if self.world.instances[surface.instance as usize].flush_error > 0.0 {
            self.depart_beside(branch, surface, &mut todo.entries);
        }
    }

    #[inline(never)]
    fn depart_beside(&self, branch: &mut Branch, surface: &Surface, entries: &mut Vec<Entry>) {
        if let Some(departure) = self.world.onward(surface, branch.ray.dir, &branch.media) {
            branch.start = Start { outside: false, ..branch.start };
            (branch.ray, branch.media) = (departure.ray, departure.media);
            branch.entry = departure.entry.and_then(|entry| {
                entries.push(*entry);
                NonZeroU32::new(entries.len() as u32)
            });
        }
    }
}
