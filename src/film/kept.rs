//! The film's sums as words, to be kept in a file and to go on from.

use super::Film;
use crate::trace::{Reader, Tile, Words};

/// Words that are not those of a film of this form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mismatch;

impl Film {
    /// All sums: tile after tile its next pass, its pixels, its probes.
    pub fn to_words(&self) -> Vec<u32> {
        let mut words = Words::default();
        words.0.reserve_exact(self.memory_bytes() / size_of::<u32>());
        for tile in &self.tiles {
            words.0.push(tile.next);
            tile.put_pixels(&mut words);
            tile.put_probes(&mut words);
        }
        words.0
    }

    /// Sets all sums to those of [`Film::to_words`] of a film of the same form.
    pub fn set_words(&mut self, words: &[u32]) -> Result<(), Mismatch> {
        let mut reader = Reader(words);
        for tile in &mut self.tiles {
            let Some((next, rest)) = reader.0.split_first() else { return Err(Mismatch) };
            (tile.next, reader.0) = (*next, rest);
            if !(tile.take_pixels(&mut reader) && tile.take_probes(&mut reader)) {
                return Err(Mismatch);
            }
        }
        if reader.0.is_empty() { Ok(()) } else { Err(Mismatch) }
    }

    /// Adds the passes of a film of the same image. Tiles that are not here yet are taken over; where both have
    /// one, it has the same place, size and layers.
    pub fn join(&mut self, other: Film) {
        let place = |tile: &Tile| (tile.y, tile.x);
        self.tiles.sort_by_key(place);
        let known = self.tiles.len();
        for tile in other.tiles {
            match self.tiles[..known].binary_search_by_key(&place(&tile), place) {
                Ok(i) => self.tiles[i].join(&tile),
                Err(_) => self.tiles.push(tile),
            }
        }
        self.tiles.sort_by_key(place);
    }
}
