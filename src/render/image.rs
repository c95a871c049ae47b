//! The film becomes the image that is written, with where it comes from.

use super::Aov;
use super::kept::Counts;
use crate::build::World;
use crate::description::Loaded;
use crate::film::{Accuracy, Film, Window};
use crate::math::{Exact, Rare};
use crate::output::{CameraView, Image, Layer as ImageLayer, Provenance, Within};
use crate::plan::Plan;
use crate::survey::Survey;
use crate::trace::Layer;
use serde_json::Value;

pub(super) fn assemble(film: &Film, aovs: &[Aov]) -> Image {
    let window = film.window;
    let mut image = Image::new(window.width() as usize, window.height() as usize);
    if window != Window::all(film.width, film.height) {
        let [x, y] = [window.x0, window.y0].map(|v| v as usize);
        image.within = Some(Within { x, y, width: film.width as usize, height: film.height as usize });
    }
    let mut add = |name: &str, names: &[&str], layer: Layer| {
        let channels = names.iter().map(|n| (*n).to_owned()).zip(film.channels(layer)).collect();
        image.layers.push(ImageLayer { name: name.to_owned(), channels });
    };
    const RGB: [&str; 3] = ["R", "G", "B"];
    const XYZ: [&str; 3] = ["X", "Y", "Z"];
    add("", &RGB, Layer::Radiance);
    for aov in Aov::ALL.into_iter().filter(|aov| aovs.contains(aov)) {
        let (channels, layer): (&[&str], Layer) = match aov {
            Aov::Albedo => (&RGB, Layer::Albedo),
            Aov::Normal => (&XYZ, Layer::Normal),
            Aov::Depth => (&["Z"], Layer::Depth),
            Aov::Position => (&XYZ, Layer::Position),
            Aov::ObjectId => (&["Y"], Layer::Object),
            Aov::Samples => (&["Y"], Layer::Samples),
            Aov::Direct => (&RGB, Layer::Direct),
            Aov::Reflection => (&RGB, Layer::Reflection),
            Aov::Refraction => (&RGB, Layer::Refraction),
            Aov::Caustic => (&RGB, Layer::Caustic),
            Aov::Indirect => (&RGB, Layer::Indirect),
            Aov::Photons => (&RGB, Layer::Photons),
            Aov::PhotonDensity => (&["Y"], Layer::PhotonDensity),
            Aov::Variance => (&RGB, Layer::Variance),
            Aov::Noise => (&RGB, Layer::Noise),
            Aov::Bias => (&RGB, Layer::Bias),
            Aov::Edges => (&["Y"], Layer::Edges),
        };
        add(aov.name(), channels, layer);
    }
    image
}

/// A warning of each layer with values that sums cannot hold.
pub(super) fn beyond(image: &Image) -> Vec<String> {
    let limit = Exact::LIMIT as f32;
    let cut = |values: &[f32]| values.iter().filter(|v| v.abs() >= limit).count();
    let told = |layer: &ImageLayer| {
        let most = layer.channels.iter().map(|(_, values)| cut(values)).max().unwrap_or(0);
        (most > 0).then(|| format!("the layer `{}` is cut to {limit:.1e} at {most} pixels", layer.name))
    };
    image.layers.iter().filter_map(told).collect()
}

/// All of it follows from the scene, the seed and the program: no times, no machine.
pub(super) fn provenance(loaded: &Loaded, plan: &Plan, survey: &Survey, world: &World) -> Provenance {
    let mut provenance = Provenance::new(&loaded.hash, plan.seed, plan.passes);
    provenance.plan = survey.text() + &plan.overridden();
    let camera = &world.camera;
    provenance.camera = Some(CameraView {
        eye: (camera.eye + world.origin).to_array(),
        right: camera.right.to_array(),
        up: camera.up.to_array(),
        forward: camera.forward.to_array(),
        fov_deg: 2.0 * libm::atan(0.5 * f64::from(camera.height) * camera.pixel).to_degrees(),
        aspect: f64::from(camera.width) / f64::from(camera.height),
        aperture_m: 2.0 * camera.lens_radius,
        focus_m: camera.focus,
    });
    // 0 is no object.
    provenance.objects = (1..).zip(world.object_names.iter().cloned()).collect();
    provenance
}

/// What was found, added to where it comes from.
pub(super) fn found(
    provenance: &mut Provenance,
    film: &Film,
    passes: u32,
    counts: &Counts,
    accuracy: Option<&Accuracy>,
) {
    provenance.passes = passes;
    let stats = &mut provenance.stats;
    if let Some(mut accuracy) = accuracy.and_then(|accuracy| serde_json::to_value(accuracy).ok()) {
        shorten(&mut accuracy);
        stats.insert("accuracy".to_owned(), accuracy);
    }
    stats.insert("samples".to_owned(), film.samples().into());
    // Whether, not how many: a corner that tiles share is counted in each of them, and the size of
    // tiles must not show in the file.
    stats.insert("pathsCut".to_owned(), (counts.cut_paths > 0).into());
    stats.insert("samplesDropped".to_owned(), (counts.health.of(Rare::NonFiniteSample) > 0).into());
}

/// Leaves five digits of every number: more are not known of an error, and the last ones depend on where
/// passes were summed up.
fn shorten(value: &mut Value) {
    match value {
        Value::Number(number) => {
            if let Some(x) = number.as_f64().filter(|x| x.fract() != 0.0) {
                let short = format!("{x:.4e}").parse::<f64>().unwrap_or(x);
                *value = short.into();
            }
        }
        Value::Array(list) => list.iter_mut().for_each(shorten),
        Value::Object(map) => map.values_mut().for_each(shorten),
        _ => {}
    }
}
