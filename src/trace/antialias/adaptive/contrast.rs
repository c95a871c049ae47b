//! How much radiances differ, and which pixels stand out from those around them.

use crate::math::Color;

/// When a cell counts as uneven: by (max − min) / (max + min + 2·floor) in any channel, times the cell's share of
/// a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    pub threshold: f32,
    pub floor: f32,
}

impl Limit {
    pub fn exceeded(&self, range: Range, share: f32) -> bool {
        let most = self.threshold * (range.hi + range.lo + 2.0 * self.floor);
        (share * (range.hi - range.lo)).cmpgt(most).any()
    }
}

/// The least and the greatest of finite radiances, channel by channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    lo: Color,
    hi: Color,
}

impl Default for Range {
    fn default() -> Range {
        Range { lo: Color::INFINITY, hi: Color::ZERO }
    }
}

impl Range {
    /// Of one radiance; none where it is not finite.
    pub fn of(radiance: Color) -> Range {
        if radiance.is_finite() {
            Range { lo: radiance, hi: radiance.max(Color::ZERO) }
        } else {
            Range::default()
        }
    }

    pub fn with(self, other: Range) -> Range {
        Range { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }
}

/// Of the pixels of a rectangle, row by row, whether each and the eight around it differ in their centres.
pub(super) fn uneven(centres: &[Color], width: usize, limit: Limit) -> Vec<bool> {
    let mut rows = Vec::with_capacity(centres.len());
    for row in centres.chunks_exact(width) {
        let of = |column: usize| row.get(column).map_or(Range::default(), |&centre| Range::of(centre));
        let (mut before, mut here) = (Range::default(), of(0));
        for column in 1..=width {
            let after = of(column);
            rows.push(here.with(before).with(after));
            (before, here) = (here, after);
        }
    }
    let none = vec![Range::default(); width];
    let row = |line: usize| rows.get(line * width..(line + 1) * width).unwrap_or(&none);
    let mut uneven = Vec::with_capacity(centres.len());
    for line in 0..centres.len() / width {
        let three = row(line.wrapping_sub(1)).iter().zip(row(line)).zip(row(line + 1));
        uneven
            .extend(three.map(|((above, here), below)| limit.exceeded(here.with(*above).with(*below), 1.0)));
    }
    uneven
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: Limit = Limit { threshold: 0.25, floor: 0.01 };

    #[test]
    fn contrast_is_relative_and_weighs_by_its_share() {
        let range = |a: f32, b: f32| Range::of(Color::splat(a)).with(Range::of(Color::new(a, b, a)));
        // (max − min) / (max + min + 0.02): 0.2462 and 0.2523.
        for (scale, brighter, over) in
            [(1.0, 1.66, false), (1.0, 1.69, true), (1e4, 1.66, false), (1e4, 1.69, true)]
        {
            assert_eq!(LIMIT.exceeded(range(scale, brighter * scale), 1.0), over, "{scale} × {brighter}");
        }
        // What lies below the floor does not show.
        assert!(!LIMIT.exceeded(range(0.0, 0.006), 1.0) && LIMIT.exceeded(range(0.0, 0.02), 1.0));
        // A quarter of a pixel asks for four times as much.
        assert!(!LIMIT.exceeded(range(1.0, 1e6), 0.25) && LIMIT.exceeded(range(1.0, 3.4), 0.5));
    }

    #[test]
    fn a_pixel_stands_out_from_any_of_eight_and_not_from_what_is_no_number() {
        let (width, height) = (7, 5);
        let mut centres = vec![Color::ONE; width * height];
        centres[2 * width + 3] = Color::splat(9.0);
        // Beside the picture's end nothing is missed, nor does a row go on in the next.
        centres[4 * width] = Color::splat(9.0);
        centres[width - 1] = Color::NAN;
        for (i, stands_out) in uneven(&centres, width, LIMIT).into_iter().enumerate() {
            let (x, y) = (i % width, i / width);
            let near = |u: usize, v: usize| x.abs_diff(u) <= 1 && y.abs_diff(v) <= 1;
            assert_eq!(stands_out, near(3, 2) || near(0, 4), "pixel {x}, {y}");
        }
    }
}
