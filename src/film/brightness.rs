//! How bright the picture is around a pixel: to tell rare bright paths from bright things.

/// Mean luminance by pixel.
#[derive(Clone, Debug)]
pub(super) struct Brightness {
    pub width: u32,
    pub height: u32,
    pub values: Vec<f32>,
}

/// Halves of the passes that are this far apart do not show the same thing.
const FAR: f64 = 2.0;

impl Brightness {
    /// The mean over all pixels.
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|v| f64::from(*v)).sum::<f64>() / (self.values.len() as f64).max(1.0)
    }

    /// What a pixel's mean is to be multiplied by to be nearer to the truth. Where one half of its passes is
    /// much brighter than the other and none of its neighbours is as bright as their mean, a rare bright path is
    /// in it, and the brightest neighbour is.
    pub fn trusted(&self, x: u32, y: u32, halves: [f64; 2]) -> f64 {
        let [a, b] = halves;
        if a.max(b) <= FAR * a.min(b) {
            return 1.0;
        }
        let own = f64::from(self.at(x, y));
        let near = |centre: u32, end: u32| centre.saturating_sub(1)..(centre + 2).min(end);
        let brightest = near(y, self.height)
            .flat_map(|v| near(x, self.width).map(move |u| (u, v)))
            .filter(|place| *place != (x, y))
            .map(|(u, v)| f64::from(self.at(u, v)))
            .fold(0.0, f64::max);
        if own > brightest { brightest / own } else { 1.0 }
    }

    fn at(&self, x: u32, y: u32) -> f32 {
        self.values[y as usize * self.width as usize + x as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lone_pixels_that_half_of_the_passes_deny_are_not_trusted() {
        let mut values = vec![1.0; 25];
        values[12] = 50.0;
        let picture = Brightness { width: 5, height: 5, values: values.clone() };
        assert_eq!(picture.trusted(2, 2, [99.0, 1.0]), 0.02);
        assert_eq!(picture.trusted(2, 2, [52.0, 48.0]), 1.0);
        assert_eq!(picture.trusted(0, 0, [2.0, 0.0]), 1.0);
        // At the edge of a lamp.
        values[13] = 60.0;
        assert_eq!(Brightness { values, ..picture }.trusted(2, 2, [99.0, 1.0]), 1.0);
    }
}
