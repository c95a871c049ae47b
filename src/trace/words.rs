//! Sums as 32-bit words, to be kept in files: numbers bit for bit.

use crate::math::{DVec3, Exact, Vec3};

/// Words that are written one after the other.
#[derive(Debug, Default)]
pub struct Words(pub Vec<u32>);

/// Words that are read again in the same order.
#[derive(Debug)]
pub struct Reader<'a>(pub &'a [u32]);

/// What can be written as words: floating-point numbers bit for bit.
pub(super) trait Record: Sized {
    fn put(&self, words: &mut Words);
    /// `None` where words are missing.
    fn take(words: &mut Reader) -> Option<Self>;
}

impl Reader<'_> {
    fn next(&mut self) -> Option<u32> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }
}

impl Record for u32 {
    fn put(&self, words: &mut Words) {
        words.0.push(*self);
    }

    fn take(words: &mut Reader) -> Option<u32> {
        words.next()
    }
}

impl Record for f32 {
    fn put(&self, words: &mut Words) {
        self.to_bits().put(words);
    }

    fn take(words: &mut Reader) -> Option<f32> {
        u32::take(words).map(f32::from_bits)
    }
}

impl Record for DVec3 {
    fn put(&self, words: &mut Words) {
        for value in self.to_array() {
            let bits = value.to_bits();
            words.0.extend([bits as u32, (bits >> 32) as u32]);
        }
    }

    fn take(words: &mut Reader) -> Option<DVec3> {
        let mut one = || Some(f64::from_bits(u64::from(words.next()?) | u64::from(words.next()?) << 32));
        Some(DVec3::new(one()?, one()?, one()?))
    }
}

impl Record for Vec3 {
    fn put(&self, words: &mut Words) {
        self.to_array().iter().for_each(|value| value.put(words));
    }

    fn take(words: &mut Reader) -> Option<Vec3> {
        Some(Vec3::new(f32::take(words)?, f32::take(words)?, f32::take(words)?))
    }
}

impl Record for Exact {
    fn put(&self, words: &mut Words) {
        words.0.extend(self.to_words());
    }

    fn take(words: &mut Reader) -> Option<Exact> {
        let (sum, rest) = words.0.split_first_chunk()?;
        words.0 = rest;
        Some(Exact::from_words(*sum))
    }
}

impl<T: Record + Copy + Default, const N: usize> Record for [T; N] {
    fn put(&self, words: &mut Words) {
        self.iter().for_each(|value| value.put(words));
    }

    fn take(words: &mut Reader) -> Option<[T; N]> {
        let mut list = [T::default(); N];
        for value in &mut list {
            *value = T::take(words)?;
        }
        Some(list)
    }
}

impl Record for (Exact, u32) {
    fn put(&self, words: &mut Words) {
        self.0.put(words);
        self.1.put(words);
    }

    fn take(words: &mut Reader) -> Option<(Exact, u32)> {
        Some((Exact::take(words)?, u32::take(words)?))
    }
}

/// Records of named fields, in their order.
macro_rules! record {
    ($type:ty, $($field:ident),+) => {
        impl $crate::trace::words::Record for $type {
            fn put(&self, words: &mut $crate::trace::words::Words) {
                $($crate::trace::words::Record::put(&self.$field, words);)+
            }

            fn take(words: &mut $crate::trace::words::Reader) -> Option<Self> {
                Some(Self { $($field: $crate::trace::words::Record::take(words)?),+ })
            }
        }
    };
}
pub(super) use record;
