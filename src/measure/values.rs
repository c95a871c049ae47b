//! Differences of plain numbers: what is the same, the largest difference, the mean square, and what is not
//! finite.
//!
//! A pixel is *finite* if all of its values are, in both images; means run over finite pixels, and the others
//! are counted. Sums are taken over rows of fixed length and then in order, so that they are the same for any
//! number of threads.

use super::read::{Channel, FileLayer};
use rayon::prelude::*;
use serde::Serialize;

/// Pixels that one partial sum runs over.
pub(super) const CHUNK: usize = 1 << 14;

/// How the numbers of one layer differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Values {
    /// Whether all values are the same, bit for bit; any NaN is the same as any other.
    pub same: bool,
    /// Share of pixels with a value that is not the same, 0 to 1.
    pub differing: f64,
    /// mean((I−R)²) over pixels and channels, of values that are finite in both.
    pub mse: f64,
    /// √ mse.
    pub rmse: f64,
    /// The largest |I−R|.
    pub max_error: f64,
    /// Where that is; none where no finite values differ.
    pub worst: Option<Place>,
    pub non_finite: NonFinite,
    /// Means by channel, of values that are finite in both.
    pub mean_image: Vec<f64>,
    pub mean_reference: Vec<f64>,
}

/// A pixel and what both images have there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Column, from 0 at the left.
    pub x: usize,
    /// Row, from 0 at the top.
    pub y: usize,
    pub image: Vec<f64>,
    pub reference: Vec<f64>,
}

/// Values that are NaN or infinite.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NonFinite {
    pub image: usize,
    pub reference: usize,
    /// Values that are not finite in one image, and in the other finite or of another kind.
    pub unmatched: usize,
    /// Column and row of the first unmatched one.
    pub first: Option<[usize; 2]>,
}

/// A chunk's share of the sums.
#[derive(Clone, Debug, Default)]
struct Part {
    differing: usize,
    square: f64,
    worst: Option<(f64, usize)>,
    image: usize,
    reference: usize,
    unmatched: usize,
    first: Option<usize>,
    /// By channel.
    sums: Vec<Sums>,
}

/// Of a channel's values that are finite in both images.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    finite: usize,
    image: f64,
    reference: f64,
}

/// Compares two layers of one size and number of channels; none where they have not.
pub fn values(image: &FileLayer, reference: &FileLayer, width: usize) -> Option<Values> {
    let pairs = paired(image, reference)?;
    let pixels = pairs.first()?.0.samples.len();
    if width == 0 || pairs.iter().any(|(a, b)| a.samples.len() != pixels || b.samples.len() != pixels) {
        return None;
    }
    let parts: Vec<Part> = (0..pixels.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| part(&pairs, chunk * CHUNK..((chunk + 1) * CHUNK).min(pixels)))
        .collect();
    let whole = parts.into_iter().reduce(Part::plus)?;
    let mse = whole.square / whole.sums.iter().map(|sums| sums.finite).sum::<usize>() as f64;
    let place = |(_, at): (f64, usize)| Place {
        x: at % width,
        y: at / width,
        image: pairs.iter().map(|(a, _)| a.samples.get(at)).collect(),
        reference: pairs.iter().map(|(_, r)| r.samples.get(at)).collect(),
    };
    let mean = |of: fn(&Sums) -> f64| whole.sums.iter().map(|sums| of(sums) / sums.finite as f64).collect();
    Some(Values {
        same: whole.differing == 0,
        differing: whole.differing as f64 / pixels as f64,
        mse,
        rmse: mse.sqrt(),
        max_error: whole.worst.map_or(0.0, |(error, _)| error),
        worst: whole.worst.map(place),
        non_finite: NonFinite {
            image: whole.image,
            reference: whole.reference,
            unmatched: whole.unmatched,
            first: whole.first.map(|at| [at % width, at / width]),
        },
        mean_image: mean(|sums| sums.image),
        mean_reference: mean(|sums| sums.reference),
    })
}

/// Pixels of which any channel differs by more than `limit`, or is not finite in one image only.
pub fn pixels_over(image: &FileLayer, reference: &FileLayer, limit: f64) -> usize {
    let Some(pairs) = paired(image, reference) else { return 0 };
    let pixels = pairs.first().map_or(0, |(a, _)| a.samples.len());
    let over = |(a, r): &(&Channel, &Channel), at: usize| {
        let (i, r) = (a.samples.get(at), r.samples.get(at));
        let error = (i - r).abs();
        !same(i, r) && (error.is_nan() || error > limit)
    };
    (0..pixels).into_par_iter().filter(|at| pairs.iter().any(|pair| over(pair, *at))).count()
}

/// Channels of the same name; grey beside a colour stands for each of its channels.
fn paired<'a>(image: &'a FileLayer, reference: &'a FileLayer) -> Option<Vec<(&'a Channel, &'a Channel)>> {
    let (a, r) = (&image.channels, &reference.channels);
    let colours = image.colour().is_some() && reference.colour().is_some();
    match (a.as_slice(), r.as_slice()) {
        ([y], _) if colours => Some(r.iter().map(|r| (y, r)).collect()),
        (_, [y]) if colours => Some(a.iter().map(|a| (a, y)).collect()),
        _ if a.len() != r.len() => None,
        _ => a
            .iter()
            .map(|a| r.iter().find(|r| r.name.eq_ignore_ascii_case(&a.name)).map(|r| (a, r)))
            .collect(),
    }
}

fn same(i: f64, r: f64) -> bool {
    i.to_bits() == r.to_bits() || (i.is_nan() && r.is_nan())
}

fn part(pairs: &[(&Channel, &Channel)], range: std::ops::Range<usize>) -> Part {
    let mut part = Part { sums: vec![Sums::default(); pairs.len()], ..Part::default() };
    for at in range {
        let mut all_same = true;
        for ((a, r), sums) in pairs.iter().zip(&mut part.sums) {
            let (i, r) = (a.samples.get(at), r.samples.get(at));
            let same = same(i, r);
            all_same &= same;
            if !i.is_finite() || !r.is_finite() {
                // The pixel's other channels count all the same.
                part.image += usize::from(!i.is_finite());
                part.reference += usize::from(!r.is_finite());
                part.unmatched += usize::from(!same);
                part.first = part.first.or((!same).then_some(at));
                continue;
            }
            sums.image += i;
            sums.reference += r;
            sums.finite += 1;
            let error = (i - r).abs();
            part.square += error * error;
            if error > part.worst.map_or(0.0, |(worst, _)| worst) {
                part.worst = Some((error, at));
            }
        }
        part.differing += usize::from(!all_same);
    }
    part
}

impl Part {
    fn plus(mut self, other: Part) -> Part {
        let worse = other.worst.is_some_and(|(error, _)| error > self.worst.map_or(0.0, |(worst, _)| worst));
        for (sums, more) in self.sums.iter_mut().zip(&other.sums) {
            sums.finite += more.finite;
            sums.image += more.image;
            sums.reference += more.reference;
        }
        Part {
            differing: self.differing + other.differing,
            square: self.square + other.square,
            worst: if worse { other.worst } else { self.worst },
            image: self.image + other.image,
            reference: self.reference + other.reference,
            unmatched: self.unmatched + other.unmatched,
            first: self.first.or(other.first),
            sums: self.sums,
        }
    }
}
