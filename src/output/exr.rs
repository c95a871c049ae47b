//! OpenEXR: 32-bit float, one part, scan lines, ZIP.
//!
//! Layers are spelt as other programs look for them: `N.X`, `P.X`, `Z`, `direct.R`. Of custom
//! attributes there is one in each of the two maps that the `exr` crate keeps, because a hash
//! map of several would be written in another order on every run: the whole provenance is the
//! JSON text `terrarium`, and `colorInteropID` names the colour space.

use super::parts::{self, Part, Values};
use super::{CameraView, Image, OutputError, Provenance, Written, camera_view::Matrix};
use exr::meta::attribute::{Chromaticities, Matrix4x4};
use exr::prelude::{
    AttributeValue, Compression, ImageAttributes, IntegerBounds, LayerAttributes, Text, Vec2,
};
use std::io::{Seek, Write};

/// The name of the attribute that holds the provenance as JSON.
pub const ATTRIBUTE: &str = "terrarium";

/// Rec. 709 primaries and the D65 white point, CIE 1931 (x, y).
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Writes all layers. Values that are not finite become 0 and are counted.
///
/// The same image and provenance give the same bytes, with any number of threads.
pub fn write(
    sink: impl Write + Seek,
    image: &Image,
    provenance: &Provenance,
) -> Result<Written, OutputError> {
    let (part, written) = picture(image, provenance)?;
    save(sink, image, &[part])?;
    Ok(written)
}

/// Writes the parts of a file that shows an image.
pub(super) fn save<const N: usize>(
    sink: impl Write + Seek,
    image: &Image,
    parts: &[Part; N],
) -> Result<(), OutputError> {
    let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions(shown(image)));
    attributes.chromaticities = Some(REC_709);
    attributes.other.insert(text("colorInteropID"), AttributeValue::Text(text("lin_rec709_scene")));
    Ok(parts::write(sink, &attributes, parts)?)
}

/// The part of the file that shows the picture.
pub(super) fn picture<'a>(
    image: &'a Image,
    provenance: &Provenance,
) -> Result<(Part<'a>, Written), OutputError> {
    picture_with(image, provenance, |_| {})
}

/// The same, with more said of it.
pub(super) fn picture_with<'a>(
    image: &'a Image,
    provenance: &Provenance,
    say: impl FnOnce(&mut LayerAttributes),
) -> Result<(Part<'a>, Written), OutputError> {
    if let Some(defect) = image.defect() {
        return Err(OutputError::Invalid(defect));
    }
    let whole = shown(image);
    if i32::try_from(whole.0.max(whole.1)).is_err() {
        return Err(OutputError::NotSupported("an EXR image wider or higher than 2147483647".to_string()));
    }
    let mut written = Written::default();
    let mut channels = Vec::new();
    for layer in &image.layers {
        for (channel, values) in &layer.channels {
            written.non_finite += values.iter().filter(|value| !value.is_finite()).count() as u64;
            channels.push((text(&spelling(&layer.name, channel)), Values::F32(values)));
        }
    }
    let mut attributes = attributes(&provenance.about(image));
    if let Some(within) = image.within {
        attributes.layer_position = Vec2(within.x as i32, within.y as i32);
    }
    say(&mut attributes);
    let size = Vec2(image.width, image.height);
    // The bytes of a chunk are counted in 31 bits.
    let line = channels.len() as u64 * 4 * image.width as u64;
    let compression = if line * 16 < 1 << 31 { Compression::ZIP16 } else { Compression::ZIP1 };
    Ok((Part::new(size, compression, attributes, channels), written))
}

/// The size of the picture that the image is, or is a part of.
fn shown(image: &Image) -> Vec2<usize> {
    image.within.map_or(Vec2(image.width, image.height), |whole| Vec2(whole.width, whole.height))
}

/// The channel's name in the file.
pub fn spelling(layer: &str, channel: &str) -> String {
    match layer {
        "" | "depth" => channel.to_string(),
        "normal" => format!("N.{channel}"),
        "position" => format!("P.{channel}"),
        _ => format!("{layer}.{channel}"),
    }
}

fn attributes(provenance: &Provenance) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        software_name: Some(text(&provenance.software)),
        owner: provenance.owner.as_deref().map(text),
        comments: provenance.comments.as_deref().map(text),
        ..LayerAttributes::default()
    };
    if let Some(stamp) = &provenance.stamp {
        attributes.capture_date = Some(text(&stamp.date()));
        attributes.utc_offset = Some(0.0);
    }
    if let Some(camera) = &provenance.camera {
        describe(camera, &mut attributes);
    }
    attributes.other.insert(text(ATTRIBUTE), AttributeValue::Text(text(&provenance.to_json())));
    attributes
}

fn describe(camera: &CameraView, attributes: &mut LayerAttributes) {
    attributes.world_to_camera = Some(flat(camera.world_to_camera()));
    attributes.world_to_normalized_device = Some(flat(camera.world_to_ndc()));
    attributes.vertical_field_of_view = Some(camera.fov_deg as f32);
    attributes.horizontal_field_of_view = Some(camera.horizontal_fov_deg() as f32);
    attributes.focus = Some(camera.focus_m as f32);
}

fn flat(matrix: Matrix) -> Matrix4x4 {
    std::array::from_fn(|i| matrix[i / 4][i % 4] as f32)
}

/// A text attribute of UTF-8 bytes.
pub(super) fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

impl From<exr::error::Error> for OutputError {
    fn from(error: exr::error::Error) -> Self {
        match error {
            exr::error::Error::Io(error) => OutputError::Io(error),
            exr::error::Error::NotSupported(message) => OutputError::NotSupported(message.to_string()),
            other => OutputError::Invalid(other.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_spelt_as_other_programs_look_for_them() {
        for (layer, channel, expected) in [
            ("", "R", "R"),
            ("normal", "X", "N.X"),
            ("position", "Z", "P.Z"),
            ("depth", "Z", "Z"),
            ("samples", "Y", "samples.Y"),
            ("object_id", "Y", "object_id.Y"),
        ] {
            assert_eq!(spelling(layer, channel), expected);
        }
    }
}
