//! How bright the picture is around a pixel: to tell rare bright paths from bright things.

use super::Window;

/// Mean luminance by pixel.
#[derive(Clone, Debug)]
pub(super) struct Brightness {
    pub window: Window,
    pub values: Vec<f32>,
}

/// How many times brighter one pass may make a pixel than all the others do.
const FAR: f64 = 2.0;

/// Passes of which one alone meets what covers a small part of a pixel. Of fewer it may cover half.
const MANY: u32 = 16;

/// Of n passes one has met what covers a part c of a pixel with the probability n·c·(1 − c)^(n−1), so that much smaller
/// parts than 1/n are as likely as that, where 1/R² is larger: found by trial, glints of the sun in glass.
const COVERED: f64 = 0.7;

impl Brightness {
    /// The mean over all pixels.
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|v| f64::from(*v)).sum::<f64>() / (self.values.len() as f64).max(1.0)
    }

    /// Whether a single pass has made more than half of a pixel; `others`: the mean without that pass.
    pub fn single(&self, x: u32, y: u32, others: f64) -> bool {
        f64::from(self.at(x, y)) > FAR * others
    }

    /// What a pixel's mean is to be multiplied by to be nearer to the truth. Where a single pass has made more than
    /// half of it and none of its neighbours is as bright, that pass has found a rare bright path, and the brightest
    /// neighbour is nearer. Where one is, and of many passes one alone has met what is bright there, it covers less
    /// of the pixel than the one pass in all on average.
    pub fn trusted(&self, x: u32, y: u32, others: f64, passes: u32) -> f64 {
        if !self.single(x, y, others) {
            return 1.0;
        }
        let own = f64::from(self.at(x, y));
        let most = if passes < MANY { 1.0 } else { COVERED };
        let Window { x0, y0, x1, y1 } = self.window;
        let near =
            |centre: u32, start: u32, end: u32| centre.saturating_sub(1).max(start)..(centre + 2).min(end);
        let brightest = near(y, y0, y1)
            .flat_map(|v| near(x, x0, x1).map(move |u| (u, v)))
            .filter(|place| *place != (x, y))
            .map(|(u, v)| f64::from(self.at(u, v)))
            .fold(0.0, f64::max);
        most.min(brightest / own)
    }

    fn at(&self, x: u32, y: u32) -> f32 {
        self.values[self.window.index(x, y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lone_pixels_that_a_single_pass_has_made_are_not_trusted() {
        let mut values = vec![1.0; 25];
        values[12] = 50.0;
        let picture = Brightness { window: Window::all(5, 5), values: values.clone() };
        assert_eq!(picture.trusted(2, 2, 1.0, 4), 0.02);
        assert_eq!(picture.trusted(2, 2, 48.0, 4), 1.0);
        assert_eq!(picture.trusted(0, 0, 0.0, 4), 1.0);
        assert_eq!(picture.trusted(0, 0, 0.0, 16), COVERED);
        // At the edge of a lamp.
        values[13] = 60.0;
        assert_eq!(Brightness { values, ..picture }.trusted(2, 2, 1.0, 4), 1.0);
    }
}
