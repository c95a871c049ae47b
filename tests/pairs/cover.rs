//! A covering array of strength two, greedily: rows of levels such that any two factors meet in all of their
//! combinations.

use std::collections::BTreeSet;
use terrarium::math::random::{Counter, Stage};

/// Two factors with a level each: (factor, level, factor, level).
pub type Pair = (usize, usize, usize, usize);

pub fn pairs_of<const N: usize>(row: [usize; N]) -> impl Iterator<Item = Pair> {
    (0..N).flat_map(move |i| (0..i).map(move |j| (j, row[j], i, row[i])))
}

/// Rows that cover every pair: each begins with a pair that is not covered yet, and of a few random ways to
/// fill in the rest the one that covers most is taken.
pub fn rows<const N: usize>(sizes: [usize; N]) -> Vec<[usize; N]> {
    const TRIES: usize = 60;
    let mut open = BTreeSet::new();
    for i in 0..N {
        for j in 0..i {
            open.extend((0..sizes[i] * sizes[j]).map(|n| (j, n % sizes[j], i, n / sizes[j])));
        }
    }
    let mut counter = Counter::new(3, Stage::Test, 0);
    let mut rows = Vec::new();
    while let Some(&(j, b, i, a)) = open.first() {
        let mut candidate = || {
            let mut row: [usize; N] = std::array::from_fn(|k| (counter.value() * sizes[k] as f64) as usize);
            (row[j], row[i]) = (b, a);
            row
        };
        let tries: Vec<[usize; N]> = (0..TRIES).map(|_| candidate()).collect();
        let gain = |row: &[usize; N]| pairs_of(*row).filter(|pair| open.contains(pair)).count();
        let best = tries.into_iter().max_by_key(gain).expect("some were tried");
        pairs_of(best).for_each(|pair| {
            open.remove(&pair);
        });
        rows.push(best);
    }
    rows
}
