//! Memory that goes back to the system when it is of no more use.
//!
//! Passes take turns on threads. What an allocator keeps of one thread's buffers for the next time serves no other
//! thread, and lies in pieces when the next pass has a few photons more: after some passes, the hundred megabytes of
//! one took three hundred. glibc gives each buffer of more than 32 MiB a mapping of its own, whatever else it has
//! learnt to keep (`mallopt(3)`, `M_MMAP_THRESHOLD`). Addresses that are asked for and never written to take no memory.

/// From this many bytes on a buffer is worth a mapping; smaller ones are made faster out of what is kept.
const LARGE: usize = 1 << 20;

/// What is mapped for certain.
const MAPPED: usize = 33 << 20;

/// An empty buffer for `len` elements; of its capacity beyond them nothing is to be used.
pub fn apart<T>(len: usize) -> Vec<T> {
    let large = len.saturating_mul(size_of::<T>()) >= LARGE;
    Vec::with_capacity(if large { len.max(MAPPED / size_of::<T>().max(1)) } else { len })
}
