//! A tile's sums to words and back, and the sums of two tiles together.

use super::{Brightest, FirstHitSums, PhotonSums, SplitSums, Tile};
use crate::math::DVec3;
use crate::trace::Probe;
use crate::trace::words::{Reader, Record, Words, record};

record!(FirstHitSums, albedo, normal, position, depth, object);
record!(SplitSums, direct, reflection, refraction, caustic, indirect);
record!(PhotonSums, dots, density);

impl Record for Brightest {
    fn put(&self, words: &mut Words) {
        u32::from(self.0).put(words);
    }

    fn take(words: &mut Reader) -> Option<Brightest> {
        u16::try_from(u32::take(words)?).ok().map(Brightest)
    }
}

impl FirstHitSums {
    fn join(&mut self, other: &FirstHitSums) {
        self.albedo.join(&other.albedo);
        self.normal.join(&other.normal);
        self.position.join(&other.position);
        self.depth.join(&other.depth);
    }
}

impl SplitSums {
    fn join(&mut self, other: &SplitSums) {
        self.direct.join(&other.direct);
        self.reflection.join(&other.reflection);
        self.refraction.join(&other.refraction);
        self.caustic.join(&other.caustic);
        self.indirect.join(&other.indirect);
    }
}

impl Tile {
    /// Appends the sums of a pixel, given by its number in the tile.
    fn put_pixel(&self, i: usize, words: &mut Words) {
        fn put<T: Record>(list: &[T], i: usize, words: &mut Words) {
            if let Some(record) = list.get(i) {
                record.put(words);
            }
        }
        put(&self.passes, i, words);
        put(&self.samples, i, words);
        self.radiance.exact(i).put(words);
        put(&self.spread, i, words);
        put(&self.brightest, i, words);
        put(&self.split, i, words);
        put(&self.first, i, words);
        put(&self.squares, i, words);
        put(&self.photons, i, words);
        put(&self.bias, i, words);
    }

    /// Sets a pixel's sums to those of words. `false` where words are missing.
    fn take_pixel(&mut self, i: usize, words: &mut Reader) -> bool {
        fn take<T: Record>(list: &mut [T], i: usize, words: &mut Reader) -> bool {
            let Some(slot) = list.get_mut(i) else { return true };
            T::take(words).map(|record| *slot = record).is_some()
        }
        take(&mut self.passes, i, words)
            && take(&mut self.samples, i, words)
            && take(self.radiance.sums(), i, words)
            && take(&mut self.spread, i, words)
            && take(&mut self.brightest, i, words)
            && take(&mut self.split, i, words)
            && take(&mut self.first, i, words)
            && take(&mut self.squares, i, words)
            && take(&mut self.photons, i, words)
            && take(&mut self.bias, i, words)
    }

    /// How many words [`Tile::put`] appends.
    pub fn words(&self) -> usize {
        let (mut pixel, mut probe) = (Words::default(), Words::default());
        if self.radiance.len() > 0 {
            self.put_pixel(0, &mut pixel);
        }
        if let Some(first) = self.probes.first() {
            first.put(&mut probe);
        }
        1 + self.radiance.len() * pixel.0.len() + self.probes.len() * probe.0.len()
    }

    /// Appends the number of the next pass, the sums of all pixels, row by row, and the probes.
    pub fn put(&self, words: &mut Words) {
        self.next.put(words);
        (0..self.radiance.len()).for_each(|i| self.put_pixel(i, words));
        self.probes.iter().for_each(|probe| probe.put(words));
    }

    /// Sets all of it to what [`Tile::put`] has appended of a tile of the same size and layers. `false` where
    /// words are missing.
    pub fn take(&mut self, words: &mut Reader) -> bool {
        u32::take(words).map(|next| self.next = next).is_some()
            && (0..self.radiance.len()).all(|i| self.take_pixel(i, words))
            && self.probes.iter_mut().all(|slot| Probe::take(words).map(|probe| *slot = probe).is_some())
    }

    /// Adds the passes of a tile of the same place and layers. What is kept of the first pass alone stays this
    /// tile's, unless a pixel of it has no pass.
    pub fn join(&mut self, other: &Tile) {
        self.next = self.next.max(other.next);
        for i in 0..self.radiance.len() {
            let (mine, theirs) = (f64::from(self.passes[i]), f64::from(other.passes[i]));
            if theirs == 0.0 {
                continue;
            }
            // Chan, Golub & LeVeque 1979, eq. 2.1.
            let off = if mine == 0.0 {
                DVec3::ZERO
            } else {
                other.radiance.sum(i) / theirs - self.radiance.sum(i) / mine
            };
            let between = off * off * (mine * theirs / (mine + theirs));
            if let (Some(squares), Some(more)) = (self.squares.get_mut(i), other.squares.get(i)) {
                *squares += *more + between;
            }
            if let (Some(spread), Some(more)) = (self.spread.get_mut(i), other.spread.get(i)) {
                *spread += *more + between.as_vec3();
            }
            if let (Some(brightest), Some(more)) = (self.brightest.get_mut(i), other.brightest.get(i)) {
                *brightest = (*brightest).max(*more);
            }
            if let (Some(photons), Some(more)) = (self.photons.get_mut(i), other.photons.get(i)) {
                photons.density.join(&more.density);
                if mine == 0.0 {
                    photons.dots = more.dots;
                }
            }
            if let (Some(first), Some(more)) = (self.first.get_mut(i), other.first.get(i)) {
                first.join(more);
                if mine == 0.0 {
                    first.object = more.object;
                }
            }
            if let (Some(split), Some(more)) = (self.split.get_mut(i), other.split.get(i)) {
                split.join(more);
            }
            if let (Some(bias), Some(more)) = (self.bias.get_mut(i), other.bias.get(i)) {
                bias.0.join(&more.0);
                bias.1 += more.1;
            }
            self.radiance.sums()[i].join(&other.radiance.exact(i));
            self.passes[i] += other.passes[i];
            self.samples[i] = self.samples[i].saturating_add(other.samples[i]);
        }
        self.probes.iter_mut().zip(&other.probes).for_each(|(probe, more)| probe.join(more));
    }
}
