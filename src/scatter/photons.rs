//! The photons of one pass, in the pieces in which threads have scattered them: put together, they would be held twice.

use super::photon::Photon;
use super::shelf::Shelf;
use rayon::prelude::*;

/// Photons in a fixed order.
#[derive(Clone, Debug, Default)]
pub struct Photons {
    chunks: Vec<Vec<Photon>>,
    /// The number of each chunk's first photon, and at the end that of all.
    starts: Vec<u32>,
    /// The chunk of every [`STEP`]th photon.
    guide: Vec<u32>,
    /// Where the chunks go when they are of no more use.
    shelf: Option<Shelf>,
}

/// Photons between two entries of the guide: fewer than most chunks have.
const STEP: usize = 256;

impl Photons {
    /// One after the other; fewer than 2³² in all. The buffers that they are in go back onto the `shelf`.
    pub(super) fn of_chunks(chunks: Vec<Vec<Photon>>, shelf: Option<Shelf>) -> Photons {
        let (mut starts, mut all) = (Vec::with_capacity(chunks.len() + 1), 0);
        let mut guide = Vec::new();
        for (number, chunk) in (0u32..).zip(&chunks) {
            starts.push(all as u32);
            all += chunk.len();
            guide.resize(all.div_ceil(STEP), number);
        }
        starts.push(u32::try_from(all).expect("photons are fewer than 2^32"));
        Photons { chunks, starts, guide, shelf }
    }

    pub fn len(&self) -> usize {
        self.starts.last().map_or(0, |&all| all as usize)
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number `i`, below [`Photons::len`].
    #[inline]
    pub fn at(&self, i: usize) -> &Photon {
        let mut chunk = self.guide[i / STEP] as usize;
        while self.starts[chunk + 1] as usize <= i {
            chunk += 1;
        }
        &self.chunks[chunk][i - self.starts[chunk] as usize]
    }

    pub fn iter(&self) -> impl Iterator<Item = &Photon> {
        self.chunks.iter().flatten()
    }

    /// The same without those that are not `sound`.
    pub fn only(mut self, sound: impl Fn(&Photon) -> bool + Sync) -> Photons {
        self.chunks.par_iter_mut().for_each(|chunk| chunk.retain(&sound));
        Photons::of_chunks(std::mem::take(&mut self.chunks), self.shelf.take())
    }

    /// What `of` makes of each, in order, in place of what is in `into`.
    pub fn map_into<T: Clone + Default + Send>(&self, into: &mut Vec<T>, of: impl Fn(&Photon) -> T + Sync) {
        into.clear();
        into.resize(self.len(), T::default());
        let mut rest = &mut into[..];
        let places = self.chunks.iter().map(|chunk| rest.split_off_mut(..chunk.len()).unwrap_or_default());
        let work: Vec<_> = self.chunks.iter().zip(places).collect();
        work.into_par_iter().with_min_len(16).for_each(|(chunk, places)| {
            places.iter_mut().zip(chunk).for_each(|(place, photon)| *place = of(photon))
        });
    }
}

impl From<Vec<Photon>> for Photons {
    fn from(photons: Vec<Photon>) -> Photons {
        Photons::of_chunks(vec![photons], None)
    }
}

impl Drop for Photons {
    fn drop(&mut self) {
        if let Some(shelf) = &self.shelf {
            shelf.put(std::mem::take(&mut self.chunks));
        }
    }
}

impl PartialEq for Photons {
    fn eq(&self, other: &Photons) -> bool {
        self.iter().eq(other.iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::optics::Face;

    fn photon(number: usize) -> Photon {
        let power = Vec3::splat(number as f32);
        Photon { position: Vec3::ZERO, wi: Vec3::Y, normal: Vec3::Y, power, face: Face::Opaque }
    }

    #[test]
    fn photons_keep_their_numbers_whatever_the_chunks() {
        for sizes in [&[][..], &[0, 0], &[1], &[5000], &[1, 700, 0, 3, 255, 256, 257, 1, 1, 0, 2000, 0]] {
            let mut number = 0;
            let chunk = |n: &usize| {
                number += n;
                (number - n..number).map(photon).collect()
            };
            let photons = Photons::of_chunks(sizes.iter().map(chunk).collect(), None);
            assert_eq!((photons.len(), photons.iter().count()), (number, number));
            for (i, one) in photons.iter().enumerate() {
                assert_eq!((one, photons.at(i)), (&photon(i), &photon(i)));
            }
            let mut numbers = Vec::new();
            photons.map_into(&mut numbers, |p| p.power.x as usize);
            assert!(numbers.into_iter().eq(0..number));
            let odd = photons.only(|p| p.power.x as usize % 2 == 1);
            assert_eq!(odd.len(), number / 2);
            (0..odd.len()).for_each(|i| assert_eq!(odd.at(i), &photon(2 * i + 1)));
        }
    }
}
