//! The film's sums as words, to be kept in a file and to go on from.

use super::Film;
use crate::trace::{Reader, Tile, Words};
use rayon::prelude::*;

/// Words that are not those of a film of this form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mismatch;

impl Film {
    /// All sums: tile after tile its next pass, its pixels, its probes.
    pub fn to_words(&self) -> Vec<u32> {
        let mut all = vec![0; self.tiles.iter().map(Tile::words).sum()];
        self.tiles.par_iter().zip(slices(&self.tiles, &mut all)).for_each(|(tile, slice)| {
            let mut words = Words::default();
            words.0.reserve_exact(slice.len());
            tile.put(&mut words);
            slice.copy_from_slice(&words.0);
        });
        all
    }

    /// Sets all sums to those of [`Film::to_words`] of a film of the same form.
    pub fn set_words(&mut self, words: &[u32]) -> Result<(), Mismatch> {
        self.with_words(words, |tile, words| tile.take(words))
    }

    /// Adds the passes of [`Film::to_words`] of a film of the same form; if they are `earlier`, what is kept of
    /// the first pass alone is theirs.
    pub fn join_words(&mut self, words: &[u32], earlier: bool) -> Result<(), Mismatch> {
        self.with_words(words, |tile, words| {
            let mut other = tile.clone();
            if !other.take(words) {
                return false;
            }
            if earlier {
                std::mem::swap(tile, &mut other);
            }
            tile.join(&other);
            true
        })
    }

    /// Has every tile look at its words. After a mismatch, sums are of no use.
    fn with_words(
        &mut self,
        words: &[u32],
        look: impl Fn(&mut Tile, &mut Reader) -> bool + Sync,
    ) -> Result<(), Mismatch> {
        let ends: Vec<usize> = self
            .tiles
            .iter()
            .scan(0, |end, tile| {
                *end += tile.words();
                Some(*end)
            })
            .collect();
        if ends.last().copied().unwrap_or(0) != words.len() {
            return Err(Mismatch);
        }
        let all = self.tiles.par_iter_mut().enumerate().all(|(i, tile)| {
            let start = if i == 0 { 0 } else { ends[i - 1] };
            let mut reader = Reader(&words[start..ends[i]]);
            look(tile, &mut reader) && reader.0.is_empty()
        });
        if all { Ok(()) } else { Err(Mismatch) }
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

/// Each tile's part of all words.
fn slices<'a>(tiles: &[Tile], mut all: &'a mut [u32]) -> Vec<&'a mut [u32]> {
    let next = |tile: &Tile| all.split_off_mut(..tile.words()).expect("the sum of the tiles' words");
    tiles.iter().map(next).collect()
}
