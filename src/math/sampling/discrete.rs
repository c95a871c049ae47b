//! Choice among finitely many entries in proportion to their weights: by bisection of the cumulative
//! sums, which keeps the order of well-distributed values, or in constant time by Walker's alias
//! method (Vose, A Linear Algorithm for Generating Random Numbers with a Given Distribution, 1991).
//!
//! Negative and non-finite weights count as zero; an entry of weight zero is never chosen.

/// One entry, chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    pub index: usize,
    /// The probability of this entry.
    pub pmf: f64,
    /// A fresh value of [0, 1), made of what the choice has left of the one it was given.
    pub u: f64,
}

/// Cumulative sums of weights, with bisection.
#[derive(Clone, Debug, PartialEq)]
pub struct Cdf {
    /// Ends with 1; entry i is chosen between element i−1 (or 0) and element i.
    cumulative: Vec<f64>,
}

impl Cdf {
    /// `None` if no weight is positive.
    pub fn new(weights: &[f64]) -> Option<Cdf> {
        let scale = usable_scale(weights)?;
        let mut sum = 0.0;
        let mut cumulative: Vec<f64> = weights
            .iter()
            .map(|&w| {
                sum += usable(w) * scale;
                sum
            })
            .collect();
        cumulative.iter_mut().for_each(|c| *c /= sum);
        Some(Cdf { cumulative })
    }

    /// `u` in [0, 1).
    pub fn choose(&self, u: f64) -> Choice {
        let u = u.clamp(0.0, 1.0f64.next_down());
        // The first element above u has an element ≤ u before it, hence a positive weight.
        let index = self.cumulative.partition_point(|&c| c <= u);
        let pmf = self.pmf(index);
        let before = self.cumulative[index] - pmf;
        Choice { index, pmf, u: fraction((u - before) / pmf) }
    }

    /// The probability with which [`Cdf::choose`] gives `index`; 0 beyond the end.
    pub fn pmf(&self, index: usize) -> f64 {
        let before = if index == 0 { 0.0 } else { self.cumulative.get(index - 1).copied().unwrap_or(1.0) };
        self.cumulative.get(index).copied().unwrap_or(1.0) - before
    }

    pub fn len(&self) -> usize {
        self.cumulative.len()
    }

    pub fn is_empty(&self) -> bool {
        self.cumulative.is_empty()
    }
}

/// Choice in constant time, for many entries.
#[derive(Clone, Debug, PartialEq)]
pub struct AliasTable {
    pub(super) columns: Vec<Column>,
}

/// 1/n of the probability, shared by its own entry (up to `own`) and another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) own: f64,
    pub(super) alias: u32,
    pmf: f64,
}

impl AliasTable {
    /// `None` if no weight is positive, or for more than 2³² entries.
    pub fn new(weights: &[f64]) -> Option<AliasTable> {
        let scale = usable_scale(weights)?;
        u32::try_from(weights.len()).ok()?;
        let sum: f64 = weights.iter().map(|&w| usable(w) * scale).sum();
        let n = weights.len() as f64;
        let mut columns: Vec<Column> = weights
            .iter()
            .enumerate()
            .map(|(i, &w)| Column { own: 0.0, alias: i as u32, pmf: usable(w) * scale / sum })
            .collect();
        let mut share: Vec<f64> = columns.iter().map(|c| c.pmf * n).collect();
        let (mut poor, mut rich): (Vec<usize>, Vec<usize>) = (0..share.len()).partition(|&i| share[i] < 1.0);
        while let (Some(&giver), Some(taker)) = (rich.last(), poor.pop()) {
            columns[taker].own = share[taker];
            columns[taker].alias = giver as u32;
            share[giver] -= 1.0 - share[taker];
            if share[giver] < 1.0 {
                rich.pop();
                poor.push(giver);
            }
        }
        // What is left has a share of 1 up to rounding; an entry of weight 0 has found its giver,
        // unless rounding has used all of them up, so that it takes the largest.
        let largest = (0..columns.len()).max_by(|&a, &b| columns[a].pmf.total_cmp(&columns[b].pmf))?;
        for i in poor.into_iter().chain(rich) {
            let positive = columns[i].pmf > 0.0;
            columns[i].own = if positive { 1.0 } else { 0.0 };
            columns[i].alias = if positive { i } else { largest } as u32;
        }
        Some(AliasTable { columns })
    }

    /// `u` in [0, 1).
    pub fn choose(&self, u: f64) -> Choice {
        let scaled = u * self.columns.len() as f64;
        let i = (scaled as usize).min(self.columns.len() - 1);
        let column = self.columns[i];
        let rest = fraction(scaled - i as f64);
        if rest < column.own {
            return Choice { index: i, pmf: column.pmf, u: fraction(rest / column.own) };
        }
        let index = column.alias as usize;
        Choice { index, pmf: self.columns[index].pmf, u: fraction((rest - column.own) / (1.0 - column.own)) }
    }

    /// The probability of `index`; 0 beyond the end.
    pub fn pmf(&self, index: usize) -> f64 {
        self.columns.get(index).map_or(0.0, |c| c.pmf)
    }
}

/// One of a few entries, without a table. `None` if no weight is positive.
pub fn pick(weights: &[f64], u: f64) -> Option<Choice> {
    let scale = usable_scale(weights)?;
    let total: f64 = weights.iter().map(|&w| usable(w) * scale).sum();
    let mut rest = u * total;
    let mut chosen = None;
    for (index, &w) in weights.iter().enumerate() {
        let w = usable(w) * scale;
        if w > 0.0 {
            chosen = Some(Choice { index, pmf: w / total, u: fraction(rest / w) });
            if rest < w {
                break;
            }
            rest -= w;
        }
    }
    chosen
}

fn usable(w: f64) -> f64 {
    if w > 0.0 && w.is_finite() { w } else { 0.0 }
}

/// The power of two that brings the largest weight near 1, so that no sum overflows or vanishes.
fn usable_scale(weights: &[f64]) -> Option<f64> {
    let largest = weights.iter().fold(0.0f64, |m, &w| m.max(usable(w)));
    (largest > 0.0).then(|| libm::ldexp(1.0, -libm::ilogb(largest).clamp(-1000, 1000)))
}

fn fraction(u: f64) -> f64 {
    u.clamp(0.0, 1.0f64.next_down())
}
