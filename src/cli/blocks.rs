//! A picture in the terminal: a character cell is two pixels, `▀` in the colour of the upper one on the
//! ground of the lower, in 24-bit colour.

use std::fmt::Write;
use terrarium::output::srgb;

/// Linear red, green and blue, channel by channel, rows from the top.
#[derive(Clone, Copy)]
pub struct Linear<'a> {
    pub width: usize,
    pub height: usize,
    pub channels: [&'a [f32]; 3],
    /// What radiance is multiplied by.
    pub gain: f64,
}

/// The size of the picture that fits into so many columns and rows of characters, pixels.
pub fn fitting(width: usize, height: usize, columns: usize, rows: usize) -> (usize, usize) {
    let (width, height) = (width.max(1) as f64, height.max(1) as f64);
    let scale = (columns as f64 / width).min(2.0 * rows as f64 / height).min(1.0);
    let side = |length: f64| ((length * scale) as usize).max(1);
    (side(width), side(height))
}

/// The picture in at most so many columns and rows, each line ended.
pub fn draw(picture: Linear, columns: usize, rows: usize) -> String {
    let (width, height) = fitting(picture.width, picture.height, columns, rows);
    let mut text = String::new();
    for y in (0..height).step_by(2) {
        for x in 0..width {
            let [r, g, b] = picture.cell(x, y, width, height);
            let _ = write!(text, "\x1b[38;2;{r};{g};{b}m");
            if y + 1 < height {
                let [r, g, b] = picture.cell(x, y + 1, width, height);
                let _ = write!(text, "\x1b[48;2;{r};{g};{b}m");
            }
            text.push('▀');
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

impl Linear<'_> {
    /// The mean of the pixels that one of `width` × `height` stands for, for the screen.
    fn cell(&self, x: usize, y: usize, width: usize, height: usize) -> [u8; 3] {
        let range = |at: usize, count: usize, all: usize| {
            let first = at * all / count;
            first..((at + 1) * all / count).max(first + 1).min(all)
        };
        let (columns, rows) = (range(x, width, self.width), range(y, height, self.height));
        let count = (columns.len() * rows.len()).max(1) as f64;
        self.channels.map(|channel| {
            let row = |y: usize| channel.get(y * self.width + columns.start..y * self.width + columns.end);
            let sum: f64 = rows.clone().filter_map(row).flatten().map(|x| f64::from(*x)).sum();
            let mean = self.gain * sum / count;
            srgb::quantise(srgb::encode(if mean.is_finite() { mean.clamp(0.0, 1.0) } else { 0.0 }), 255) as u8
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pixels_share_a_cell_and_larger_pictures_are_averaged() {
        let (white, black) = ([1.0f32; 4], [0.0f32; 4]);
        let mixed = [1.0, 1.0, 0.0, 0.0];
        let picture = |red| Linear { width: 2, height: 2, channels: [red, &black, &white], gain: 1.0 };
        let text = draw(picture(&mixed), 80, 24);
        let cell = "\x1b[38;2;255;0;255m\x1b[48;2;0;0;255m▀";
        assert_eq!(text, format!("{cell}{cell}\x1b[0m\n"));
        // half of the light is 188 on the screen
        assert_eq!(draw(picture(&mixed), 1, 1), "\x1b[38;2;188;0;255m▀\x1b[0m\n");
        assert!(draw(Linear { gain: 0.5, ..picture(&white) }, 1, 1).contains("38;2;188;0;188"));
        assert!(draw(picture(&[f32::NAN; 4]), 1, 1).contains("38;2;0;0;255"));
    }

    #[test]
    fn pictures_fit_and_keep_their_shape() {
        assert_eq!(fitting(1280, 720, 80, 24), (80, 45));
        assert_eq!(fitting(720, 1280, 80, 24), (27, 48));
        assert_eq!(fitting(16, 16, 80, 24), (16, 16));
        assert_eq!(fitting(65536, 1, 80, 24), (80, 1));
    }
}
