//! Where an image comes from: enough to make it again, written into every file.
//!
//! By default only what the scene, the seed and the program decide, so that the same render is
//! the same file, byte for byte. The time and the machine are added on request (`Stamp`).

use super::{CameraView, Image};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The colour space of every colour channel, by OpenImageIO's name.
pub const COLOR_SPACE: &str = "lin_rec709";

/// The layer that holds numbers of objects.
const OBJECT_LAYER: &str = "object_id";

/// What is known of an image's making.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Provenance {
    /// Program and version.
    pub software: String,
    /// SHA-256 of the scene, in lower-case hexadecimal.
    pub scene_hash: String,
    pub seed: u64,
    /// Passes whose mean the image is.
    pub passes: u32,
    /// Which effects ran, and why.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub plan: String,
    pub color_space: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraView>,
    /// Counts that are the same on every run: no times, no memory.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub stats: Map<String, Value>,
    /// What the numbers of the `object_id` layer stand for.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub objects: BTreeMap<u32, String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub owner: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub comments: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stamp: Option<Stamp>,
    /// Of an image that is not whole: what of it is there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partial: Option<Value>,
}

/// When and where: what differs from run to run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Stamp {
    /// Seconds since 1970-01-01 00:00:00 UTC.
    pub unix_time: u64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub host: Option<String>,
}

impl Provenance {
    /// A provenance without plan, camera, counts or stamp.
    pub fn new(scene_hash: &[u8; 32], seed: u64, passes: u32) -> Self {
        Provenance {
            software: concat!("terrarium ", env!("CARGO_PKG_VERSION")).to_string(),
            scene_hash: hex(scene_hash),
            seed,
            passes,
            plan: String::new(),
            color_space: COLOR_SPACE.to_string(),
            camera: None,
            stats: Map::new(),
            objects: BTreeMap::new(),
            owner: None,
            comments: None,
            stamp: None,
            partial: None,
        }
    }

    /// Without what `image` gives no reason to say: the names of objects that no layer numbers.
    pub(super) fn about(&self, image: &Image) -> Cow<'_, Provenance> {
        let numbered = image.layers.iter().any(|layer| layer.name == OBJECT_LAYER);
        if numbered || self.objects.is_empty() {
            return Cow::Borrowed(self);
        }
        Cow::Owned(Provenance { objects: BTreeMap::new(), ..self.clone() })
    }

    /// JSON in ASCII: characters beyond it are escaped, because not every reader of image
    /// attributes takes them for UTF-8.
    pub fn to_json(&self) -> String {
        let json = serde_json::to_string(self).expect("strings, numbers and maps with string keys");
        let mut ascii = String::with_capacity(json.len());
        for character in json.chars() {
            if character.is_ascii() {
                ascii.push(character);
            } else {
                for unit in character.encode_utf16(&mut [0; 2]) {
                    ascii.push_str(&format!("\\u{unit:04x}"));
                }
            }
        }
        ascii
    }
}

impl Stamp {
    /// The time in UTC as OpenEXR's `capDate` writes it: `YYYY:MM:DD hh:mm:ss`.
    pub fn date(&self) -> String {
        let (days, second) = (self.unix_time / 86_400, self.unix_time % 86_400);
        let (year, month, day) = civil_date(days);
        let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
        format!("{year:04}:{month:02}:{day:02} {hour:02}:{minute:02}:{second:02}")
    }
}

/// Year, month and day of the Gregorian calendar, `days` after 1970-01-01.
///
/// Counted in years that begin in March, so that the leap day comes last.
fn civil_date(days: u64) -> (u64, u64, u64) {
    const ERA: u64 = 146_097; // days in 400 years
    let days = days + 719_468; // since 0000-03-01
    let (era, of_era) = (days / ERA, days % ERA);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    (era * 400 + year_of_era + u64::from(month <= 2), month, day)
}

/// A hash as text.
pub fn hex(hash: &[u8; 32]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Layer;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (unix_time, date) in [
            (0, "1970:01:01 00:00:00"),
            (951_782_399, "2000:02:28 23:59:59"),
            (951_782_400, "2000:02:29 00:00:00"),
            (951_868_800, "2000:03:01 00:00:00"),
            (1_700_000_000, "2023:11:14 22:13:20"),
            (4_107_542_400, "2100:03:01 00:00:00"),
        ] {
            assert_eq!(Stamp { unix_time, host: None }.date(), date);
        }
    }

    #[test]
    fn json_is_ascii_and_reads_back_the_same() {
        let mut provenance = Provenance::new(&[0xab; 32], 7, 64);
        provenance.plan = "caustics: off – no glass \u{1f333}".to_string();
        provenance.stats.insert("cutPaths".to_string(), 3.into());
        let json = provenance.to_json();
        assert!(json.is_ascii() && json.contains(&"ab".repeat(32)));
        assert_eq!(serde_json::from_str::<Provenance>(&json).ok(), Some(provenance));
    }

    #[test]
    fn objects_are_named_where_a_layer_numbers_them() {
        let mut provenance = Provenance::new(&[0; 32], 0, 1);
        provenance.objects = [(1, "floor".to_string()), (12, "tree".to_string())].into();
        let mut image = Image::new(1, 1);
        assert!(!provenance.about(&image).to_json().contains("floor"));
        image.layers.push(Layer { name: OBJECT_LAYER.to_string(), channels: Vec::new() });
        let json = provenance.about(&image).to_json();
        assert!(json.contains(r#""objects":{"1":"floor","12":"tree"}"#), "{json}");
        assert_eq!(serde_json::from_str::<Provenance>(&json).ok(), Some(provenance));
    }

    #[test]
    fn without_a_stamp_nothing_tells_the_time_or_the_machine() {
        let json = Provenance::new(&[0; 32], 0, 1).to_json();
        assert!(!json.contains("stamp") && !json.contains("host") && !json.contains("unixTime"));
    }
}
