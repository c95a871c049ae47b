//! How far one image is from another.

use crate::output::Image;

/// The difference of an image from a reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// √ mean((I−R)² / (R² + 0.31·m²)) over pixels and channels, m the reference's mean luminance: the
    /// relative RMS error, relMSE with the usual ε = 0.01 of an image exposed to a mean of 0.18.
    pub relative_rms: f64,
    /// The mean of I over that of R, less 1; 0 where both are black.
    pub mean_change: f64,
    /// Whether all values are the same bits.
    pub same: bool,
}

/// Rec. 709.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// 0.01/0.18².
const FLOOR: f64 = 0.31;

/// The colours of two images of one size; `None` where the sizes or channels differ. Values that are not
/// finite make the difference infinite.
pub fn compare(image: &Image, reference: &Image) -> Option<Difference> {
    let (a, r) = (image.layers.first()?, reference.layers.first()?);
    if (image.width, image.height) != (reference.width, reference.height) {
        return None;
    }
    let pairs: Vec<(&[f32], &[f32])> =
        a.channels.iter().zip(&r.channels).map(|((_, a), (_, r))| (a.as_slice(), r.as_slice())).collect();
    if pairs.len() != a.channels.len() || pairs.len() != r.channels.len() {
        return None;
    }
    let mean =
        |values: &[f32]| values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len().max(1) as f64;
    let luminance = |side: &dyn Fn(&(&[f32], &[f32])) -> f64| -> f64 {
        pairs.iter().zip(LUMINANCE).map(|(pair, weight)| weight * side(pair)).sum()
    };
    let (of_image, m) = (luminance(&|pair| mean(pair.0)), luminance(&|pair| mean(pair.1)));
    let floor = FLOOR * m * m;
    let (mut sum, mut count, mut same) = (0.0, 0usize, true);
    for (a, r) in pairs.iter().flat_map(|(a, r)| a.iter().zip(*r)) {
        same &= a.to_bits() == r.to_bits();
        count += 1;
        let (i, r) = (f64::from(*a), f64::from(*r));
        let square = (i - r) * (i - r);
        if square != 0.0 {
            let relative = square / (r * r + floor);
            sum += if relative.is_nan() { f64::INFINITY } else { relative };
        }
    }
    let mean_change = if of_image == m { 0.0 } else { of_image / m - 1.0 };
    Some(Difference { relative_rms: (sum / count.max(1) as f64).sqrt(), mean_change, same })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Layer;

    fn grey(values: &[f32]) -> Image {
        let mut image = Image::new(values.len(), 1);
        let channels = ["R", "G", "B"].map(|name| (name.to_owned(), values.to_vec()));
        image.layers.push(Layer { name: String::new(), channels: channels.to_vec() });
        image
    }

    /// An even image 10 % too bright has E = 0.1/√1.31, whatever its exposure.
    #[test]
    fn the_error_does_not_depend_on_exposure() {
        for exposure in [1e-3, 1.0, 1e4] {
            let reference = grey(&[exposure; 16]);
            let brighter = grey(&[1.1 * exposure; 16]);
            let found = compare(&brighter, &reference).expect("images of one size");
            assert!((found.relative_rms - 0.1 / 1.31_f64.sqrt()).abs() < 1e-6, "{found:?}");
            assert!((found.mean_change - 0.1).abs() < 1e-6 && !found.same);
        }
        let black = grey(&[0.0; 4]);
        let same = Difference { relative_rms: 0.0, mean_change: 0.0, same: true };
        assert_eq!(compare(&black, &black), Some(same));
        assert_eq!(compare(&black, &grey(&[0.0; 5])), None);
        assert_eq!(compare(&grey(&[f32::NAN]), &grey(&[1.0])).map(|d| d.relative_rms), Some(f64::INFINITY));
    }
}
