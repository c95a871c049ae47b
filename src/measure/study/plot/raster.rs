//! A drawing as pixels: strokes with smooth edges, texts in the stroke font.

use super::font::{CAPITAL, strokes};
use super::marks::{Anchor, Colour, Drawing, Mark};
use crate::measure::heat::ScreenPicture;

/// Pixels a point.
const SCALE: f64 = 2.0;

/// Height of a capital over the size of a font, and the width of its strokes over that height.
const CAPITAL_OF_SIZE: f64 = 0.7;
const STROKE: f64 = 0.13;

/// Lengths of dashes and gaps, points.
const DASHES: [f64; 2] = [6.0, 5.0];

/// The drawing at two pixels a point.
pub fn raster(drawing: &Drawing) -> ScreenPicture {
    let side = |points: f64| (SCALE * points).ceil() as usize;
    let (width, height) = (side(drawing.width), side(drawing.height));
    let mut canvas = Canvas { width, height, pixels: vec![[255.0; 3]; width * height] };
    drawing.marks.iter().for_each(|mark| canvas.mark(mark));
    let byte = |value: f32| value.round().clamp(0.0, 255.0) as u8;
    ScreenPicture { width, pixels: canvas.pixels.iter().map(|pixel| pixel.map(byte)).collect() }
}

struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

impl Canvas {
    fn mark(&mut self, mark: &Mark) {
        match mark {
            Mark::Line { points, colour, width, dashed } => {
                let pieces = if *dashed { dashes(points) } else { vec![points.clone()] };
                self.strokes(&pieces, *width, *colour);
            }
            Mark::Dot { at, radius, colour, filled, .. } => self.dot(*at, *radius, *colour, *filled),
            Mark::Text { at, size, anchor, colour, upright, text } => {
                let unit = CAPITAL_OF_SIZE * size / CAPITAL;
                let (letters, long) = strokes(text);
                let start = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => 0.5 * long,
                    Anchor::End => long,
                };
                let place = |[x, y]: [f64; 2]| {
                    let (along, up) = (unit * (x - start), unit * y);
                    if *upright { [at[0] - up, at[1] - along] } else { [at[0] + along, at[1] - up] }
                };
                let letters: Vec<Vec<[f64; 2]>> =
                    letters.into_iter().map(|stroke| stroke.into_iter().map(place).collect()).collect();
                self.strokes(&letters, STROKE * CAPITAL_OF_SIZE * size, *colour);
            }
        }
    }

    /// Polylines with round ends, as one shape.
    fn strokes(&mut self, lines: &[Vec<[f64; 2]>], width: f64, colour: Colour) {
        let half = 0.5 * SCALE * width;
        for line in lines {
            let line: Vec<[f64; 2]> = line.iter().map(|p| p.map(|v| SCALE * v)).collect();
            for pair in line.windows(2) {
                let [a, b] = [pair[0], pair[1]];
                self.cover([a, b], half + 1.0, colour, |p| half + 0.5 - distance(p, a, b));
            }
        }
    }

    fn dot(&mut self, at: [f64; 2], radius: f64, colour: Colour, filled: bool) {
        let (at, radius) = (at.map(|v| SCALE * v), SCALE * radius);
        let line = 0.75 * SCALE;
        self.cover([at, at], radius + line + 1.0, colour, |p| {
            let d = distance(p, at, at);
            if filled { radius + line + 0.5 - d } else { line + 0.5 - (d - radius).abs() }
        });
    }

    /// Blends the colour into the pixels around a segment, by how much of each is covered.
    fn cover(&mut self, ends: [[f64; 2]; 2], margin: f64, colour: Colour, share: impl Fn([f64; 2]) -> f64) {
        let range = |axis: usize, most: usize| {
            let low = (ends[0][axis].min(ends[1][axis]) - margin).floor().max(0.0) as usize;
            let high = (ends[0][axis].max(ends[1][axis]) + margin).ceil().max(0.0) as usize;
            low.min(most)..high.min(most)
        };
        for y in range(1, self.height) {
            for x in range(0, self.width) {
                let alpha = share([x as f64 + 0.5, y as f64 + 0.5]).clamp(0.0, 1.0) as f32;
                let pixel = &mut self.pixels[y * self.width + x];
                for (value, ink) in pixel.iter_mut().zip(colour) {
                    *value += alpha * (f32::from(ink) - *value);
                }
            }
        }
    }
}

/// From a point to a segment.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (ab, ap) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = ab[0] * ab[0] + ab[1] * ab[1];
    let t = if square > 0.0 { ((ap[0] * ab[0] + ap[1] * ab[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    let [x, y] = [ap[0] - t * ab[0], ap[1] - t * ab[1]];
    (x * x + y * y).sqrt()
}

/// A polyline cut into dashes.
fn dashes(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let (mut pieces, mut drawn, mut left) = (Vec::new(), true, DASHES[0]);
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let long = distance(a, b, b);
        let mut at = 0.0;
        while at < long {
            let step = left.min(long - at);
            let place = |s: f64| [0, 1].map(|i| a[i] + (b[i] - a[i]) * s / long);
            if drawn {
                pieces.push(vec![place(at), place(at + step)]);
            }
            at += step;
            left -= step;
            if left <= 0.0 {
                drawn = !drawn;
                left = DASHES[usize::from(!drawn)];
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_covers_its_own_area() {
        let mut drawing = Drawing::new(40.0, 20.0);
        drawing.line(vec![[10.0, 10.0], [30.0, 10.0]], [0, 0, 0], 4.0);
        let picture = raster(&drawing);
        let ink: f64 = picture.pixels.iter().map(|p| 1.0 - f64::from(p[0]) / 255.0).sum();
        // length times width, and two half discs
        let expected = SCALE * SCALE * (20.0 * 4.0 + std::f64::consts::PI * 4.0);
        assert!((ink / expected - 1.0).abs() < 0.02, "{ink} instead of {expected}");
        assert_eq!(picture.pixels[20 * picture.width + 40], [0; 3]);
    }

    #[test]
    fn dashes_alternate_with_gaps() {
        let pieces = dashes(&[[0.0, 0.0], [20.0, 0.0]]);
        assert_eq!(pieces, [[[0.0, 0.0], [6.0, 0.0]], [[11.0, 0.0], [17.0, 0.0]]]);
    }

    #[test]
    fn texts_begin_and_end_where_they_are_anchored() {
        for (anchor, from, to) in [(Anchor::Start, 50, 80), (Anchor::End, 20, 50), (Anchor::Middle, 35, 65)] {
            let mut drawing = Drawing::new(100.0, 20.0);
            drawing.text([50.0, 15.0], 10.0, anchor, [0, 0, 0], "Wide");
            let picture = raster(&drawing);
            let dark = picture.pixels.iter().enumerate().filter(|(_, p)| p[0] < 128);
            let columns: Vec<usize> = dark.map(|(i, _)| i % picture.width / 2).collect();
            let (first, last) = (columns.iter().min(), columns.iter().max());
            assert!(
                first.is_some_and(|c| *c + 2 >= from) && last.is_some_and(|c| *c <= to),
                "{first:?} {last:?}"
            );
        }
    }
}
