//! Frames that are there already: an image that says of itself that it is what would be rendered, and is
//! younger than the meshes and images of its scene.

use super::args::RenderArgs;
use super::target::Target;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use terrarium::description::Loaded;
use terrarium::output::{self, Format, Provenance, hex};
use terrarium::plan::Plan;

/// Whether all images of a render are there.
pub fn finished(args: &RenderArgs, targets: &[Target], loaded: &Loaded, plan: &Plan) -> bool {
    // of a part of the passes an image only tells how many they are
    let whole = plan.first_pass == 0;
    let side = args.stats.iter().chain(&args.depfile);
    whole
        && side.into_iter().all(|path| path.exists())
        && targets.iter().all(|target| match target {
            Target::File(path, format) => is_it(path, *format, args, loaded, plan).unwrap_or(false),
            Target::Stdout(_) => false,
        })
}

/// `None` where the file cannot be read as such an image.
fn is_it(path: &Path, format: Format, args: &RenderArgs, loaded: &Loaded, plan: &Plan) -> Option<bool> {
    let written = fs::metadata(path).ok()?.modified().ok()?;
    for asset in &loaded.assets {
        if fs::metadata(asset).ok()?.modified().ok()? > written {
            return Some(false);
        }
    }
    let (text, channels) = match format {
        Format::Exr => of_exr(path)?,
        Format::Png => (of_png(path)?, Vec::new()),
    };
    let said: serde_json::Value = serde_json::from_str(&text).ok()?;
    if said.get("partial").is_some() {
        return Some(false);
    }
    let found: Provenance = serde_json::from_value(said).ok()?;
    let wanted = Provenance::new(&loaded.hash, plan.seed, found.passes);
    let same = found.software == wanted.software
        && found.scene_hash == hex(&loaded.hash)
        && found.seed == plan.seed
        && overrides(&found.plan) == overrides(&plan.overridden());
    Some(same && enough(&found, plan) && layers(args, format, &channels))
}

/// Whether the image has the passes, or the accuracy, that would end its render. A time may have ended
/// it anywhere.
fn enough(found: &Provenance, plan: &Plan) -> bool {
    let error = found.stats.get("accuracy").and_then(|accuracy| accuracy.get("error")?.as_f64());
    let accurate = plan.until.error.is_some_and(|enough| error.is_some_and(|error| error <= enough));
    let timed = plan.until.seconds.is_some() && found.passes > 0;
    found.passes == plan.passes || accurate || timed
}

fn overrides(plan: &str) -> Option<&str> {
    plan.lines().find(|line| line.starts_with("overrides: "))
}

/// A PNG shows the picture alone.
fn layers(args: &RenderArgs, format: Format, channels: &[String]) -> bool {
    let has = |name: &str| {
        let spelt = |channel: &str| channels.iter().any(|c| *c == output::exr::spelling(name, channel));
        ["R", "X", "Y", "Z"].iter().any(|channel| spelt(channel))
    };
    format == Format::Png || args.work.aov.iter().all(|aov| has(aov.name()))
}

/// The provenance in an EXR's header, and the names of its channels.
fn of_exr(path: &Path) -> Option<(String, Vec<String>)> {
    let meta = exr::meta::MetaData::read_from_buffered(BufReader::new(File::open(path).ok()?), false).ok()?;
    let header = meta.headers.first()?;
    let name = exr::prelude::Text::from(output::exr::ATTRIBUTE);
    let [own, shared] = [&header.own_attributes.other, &header.shared_attributes.other];
    let text = own.get(&name).or_else(|| shared.get(&name))?.to_text().ok()?.to_string();
    Some((text, header.channels.list.iter().map(|channel| channel.name.to_string()).collect()))
}

/// The provenance in a PNG's text chunk.
fn of_png(path: &Path) -> Option<String> {
    let reader = png::Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
    let texts = &reader.info().uncompressed_latin1_text;
    texts.iter().find(|chunk| chunk.keyword == output::exr::ATTRIBUTE).map(|chunk| chunk.text.clone())
}
