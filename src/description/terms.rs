//! On which terms a scene is read: what its reader decides, and the scene cannot.

use super::Reach;

/// What of a scene a caller will leave out, so that files which nothing else names may be missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unread {
    pub normal_maps: bool,
    pub bump_maps: bool,
    pub environment: bool,
    pub highlights: bool,
}

/// The terms of one reading.
#[derive(Clone, Debug, Default)]
pub struct Terms {
    pub unread: Unread,
    /// The files that the scene may read.
    pub reach: Reach,
    /// The frame of its animation, from 1; without it, the first.
    pub frame: Option<u32>,
}
