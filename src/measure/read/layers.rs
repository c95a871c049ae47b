//! Which channels of a file belong together, and what they are.
//!
//! `albedo.R` is channel R of layer `albedo`; in files of several parts the part's name comes first. R, G and
//! B make a colour; what stands beside them (A, Z, ids) is a layer of its own, named by the channel. The name
//! tells colours from data that is spelt as if it were one (`variance.R`).

use super::{Channel, FileLayer, Kind, Samples};

/// A part of a file.
pub struct Part {
    /// None where the file has one part only: its name says nothing then.
    pub name: Option<String>,
    /// Full names.
    pub channels: Vec<(String, Samples)>,
}

/// Layers that are no light though their channels are R, G and B.
const DATA: [&str; 20] = [
    "variance",
    "noise",
    "bias",
    "normal",
    "normals",
    "n",
    "ns",
    "ng",
    "position",
    "p",
    "uv",
    "motion",
    "vector",
    "velocity",
    "depth",
    "z",
    "id",
    "object_id",
    "edges",
    "photon_density",
];

/// The layers of all parts, the picture itself first.
pub fn grouped(parts: Vec<Part>) -> Vec<FileLayer> {
    let mut layers: Vec<FileLayer> = Vec::new();
    for part in parts {
        let mut groups: Vec<(String, Vec<Channel>)> = Vec::new();
        for (full, samples) in part.channels {
            let (prefix, name) = full.rsplit_once('.').unwrap_or(("", &full));
            let prefix = within(part.name.as_deref(), prefix);
            let channel = Channel { name: name.to_owned(), samples };
            match groups.iter_mut().find(|(name, _)| *name == prefix) {
                Some((_, channels)) => channels.push(channel),
                None => groups.push((prefix, vec![channel])),
            }
        }
        for (prefix, channels) in groups {
            for mut layer in split(prefix, channels) {
                layer.name = free(&layers, layer.name);
                layers.push(layer);
            }
        }
    }
    layers.sort_by_key(|layer| !layer.name.is_empty());
    layers
}

/// The prefix within a part, whose name many writers repeat in its channels.
fn within(part: Option<&str>, prefix: &str) -> String {
    let part = part.unwrap_or("");
    let repeated = prefix.strip_prefix(part).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    match (part, prefix) {
        ("", prefix) => prefix.to_owned(),
        (part, "") => part.to_owned(),
        (_, prefix) if repeated => prefix.to_owned(),
        (part, prefix) => format!("{part}.{prefix}"),
    }
}

/// `name`, or `name#2` and so on if layers have it.
fn free(layers: &[FileLayer], name: String) -> String {
    let taken = |name: &str| layers.iter().any(|layer| layer.name == name);
    if !taken(&name) {
        return name;
    }
    (2..).map(|n| format!("{name}#{n}")).find(|name| !taken(name)).expect("numbers do not end")
}

/// A group's colour, and the rest of it.
fn split(prefix: String, mut channels: Vec<Channel>) -> Vec<FileLayer> {
    let mut layers = Vec::new();
    let at = |channels: &[Channel], names: [&str; 2]| {
        channels.iter().position(|channel| names.iter().any(|name| channel.name.eq_ignore_ascii_case(name)))
    };
    let places = [["R", "red"], ["G", "green"], ["B", "blue"]].map(|names| at(&channels, names));
    let grey = at(&channels, ["Y", "luminance"]);
    if let [Some(r), Some(g), Some(b)] = places {
        let order = [r, g, b];
        let colour = order.map(|i| channels[i].clone());
        let mut i = 0;
        channels.retain(|_| (!order.contains(&i), i += 1).0);
        let light = colour.iter().all(|c| matches!(c.samples, Samples::F32(_))) && !is_data(&prefix);
        let kind = if light { Kind::Colour } else { Kind::Data };
        layers.push(FileLayer { name: prefix.clone(), kind, channels: colour.to_vec() });
    } else if let (Some(y), "") = (grey, prefix.as_str())
        && matches!(channels[y].samples, Samples::F32(_))
    {
        let channels = vec![channels.remove(y)];
        layers.push(FileLayer { name: String::new(), kind: Kind::Colour, channels });
    } else if !prefix.is_empty() {
        return vec![FileLayer { name: prefix, kind: Kind::Data, channels }];
    }
    for channel in channels {
        let name =
            if prefix.is_empty() { channel.name.clone() } else { format!("{prefix}.{}", channel.name) };
        layers.push(FileLayer { name, kind: Kind::Data, channels: vec![channel] });
    }
    layers
}

fn is_data(name: &str) -> bool {
    let last = name.rsplit('.').next().unwrap_or(name).to_ascii_lowercase();
    DATA.contains(&last.as_str()) || last.starts_with("crypto")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(parts: &[(Option<&str>, &[&str])]) -> Vec<String> {
        let parts = parts.iter().map(|(name, channels)| Part {
            name: name.map(str::to_owned),
            channels: channels.iter().map(|c| (c.to_string(), Samples::F32(vec![0.0]))).collect(),
        });
        let describe = |layer: FileLayer| {
            let channels: Vec<&str> = layer.channels.iter().map(|c| c.name.as_str()).collect();
            format!("{}:{}:{:?}", layer.name, channels.join(""), layer.kind)
        };
        grouped(parts.collect()).into_iter().map(describe).collect()
    }

    #[test]
    fn channels_are_grouped_as_other_programs_spell_them() {
        let one = |channels: &[&str]| names(&[(None, channels)]);
        assert_eq!(one(&["A", "B", "G", "R", "Z"]), [":RGB:Colour", "A:A:Data", "Z:Z:Data"]);
        assert_eq!(one(&["Y"]), [":Y:Colour"]);
        assert_eq!(one(&["b", "g", "r"]), [":rgb:Colour"]);
        assert_eq!(one(&["N.X", "N.Y", "N.Z", "samples.Y"]), ["N:XYZ:Data", "samples:Y:Data"]);
        let view = ["View.Combined.A", "View.Combined.B", "View.Combined.G", "View.Combined.R"];
        assert_eq!(one(&view), ["View.Combined:RGB:Colour", "View.Combined.A:A:Data"]);
        assert_eq!(one(&["variance.B", "variance.G", "variance.R"]), ["variance:RGB:Data"]);
        assert_eq!(one(&["albedo.B", "albedo.G", "albedo.R", "B", "G", "R"])[0], ":RGB:Colour");
    }

    #[test]
    fn the_names_of_parts_come_first_and_only_once() {
        let parts = names(&[
            (Some("rgb"), &["B", "G", "R"]),
            (Some("glow"), &["glow.B", "glow.G", "glow.R"]),
            (Some("data"), &["N.X", "Z"]),
            (Some("data"), &["Z"]),
        ]);
        assert_eq!(
            parts,
            ["rgb:RGB:Colour", "glow:RGB:Colour", "data.N:X:Data", "data:Z:Data", "data#2:Z:Data"]
        );
    }
}
