//! How far one image is from another.

use super::read::{Channel, FileLayer, Kind, Samples};
use super::relative::relative;
use super::values::values;
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

/// The colours of two images of one size; `None` where the sizes or channels differ. Values that are not
/// finite in one of them make the difference infinite.
pub fn compare(image: &Image, reference: &Image) -> Option<Difference> {
    if (image.width, image.height) != (reference.width, reference.height) {
        return None;
    }
    let colour = |image: &Image| -> Option<FileLayer> {
        let channels = image.layers.first()?.channels.iter();
        let channels = channels
            .map(|(name, values)| Channel { name: name.clone(), samples: Samples::F32(values.clone()) });
        Some(FileLayer { name: String::new(), kind: Kind::Colour, channels: channels.collect() })
    };
    let (image, reference) = (colour(image)?, colour(reference)?);
    let values = values(&image, &reference, image.channels.first()?.samples.len())?;
    let relative = relative(image.colour()?, reference.colour()?);
    let sound = values.non_finite.unmatched == 0;
    Some(Difference {
        relative_rms: if sound { relative.relative_rms } else { f64::INFINITY },
        mean_change: relative.mean_ratio - 1.0,
        same: values.same,
    })
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
