//! On which face light arrives.

/// The kind of a surface, on one side of it. Photons of one kind count for each other, and for no other: surfaces of
/// several kinds may lie in one plane, or one close above another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Face {
    /// Of what does not transmit.
    #[default]
    Opaque,
    /// Of what transmits, from outside of it.
    Outer,
    /// The same from within.
    Inner,
}
