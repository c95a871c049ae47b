//! The film becomes the image that is written, with where it comes from.

use super::{Aov, Options};
use crate::build::World;
use crate::description::Loaded;
use crate::film::{Accuracy, Film};
use crate::math::Rare;
use crate::output::{CameraView, Image, Layer as ImageLayer, Provenance};
use crate::plan::Plan;
use crate::survey::Survey;
use crate::trace::{Layer, Tally};

pub(super) fn assemble(film: &Film, options: &Options) -> Image {
    let mut image = Image::new(film.width as usize, film.height as usize);
    let mut add = |name: &str, names: &[&str], layer: Layer| {
        let channels = names.iter().map(|n| (*n).to_owned()).zip(film.channels(layer)).collect();
        image.layers.push(ImageLayer { name: name.to_owned(), channels });
    };
    const RGB: [&str; 3] = ["R", "G", "B"];
    const XYZ: [&str; 3] = ["X", "Y", "Z"];
    add("", &RGB, Layer::Radiance);
    for aov in Aov::ALL.into_iter().filter(|aov| options.aovs.contains(aov)) {
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

/// All of it follows from the scene, the seed and the program: no times, no machine.
#[expect(clippy::too_many_arguments, reason = "all that an image says of its making")]
pub(super) fn provenance(
    loaded: &Loaded,
    plan: &Plan,
    survey: &Survey,
    world: &World,
    tally: &Tally,
    film: &Film,
    passes: u32,
    accuracy: Option<&Accuracy>,
) -> Provenance {
    let mut provenance = Provenance::new(&loaded.hash, plan.seed, passes);
    provenance.plan = survey.text() + &plan.overridden();
    let camera = &world.camera;
    provenance.camera = Some(CameraView {
        eye: (camera.eye + world.origin).to_array(),
        right: camera.right.to_array(),
        up: camera.up.to_array(),
        forward: camera.forward.to_array(),
        fov_deg: 2.0 * libm::atan(camera.tan_half).to_degrees(),
        aspect: f64::from(camera.width) / f64::from(camera.height),
        aperture_m: 2.0 * camera.lens_radius,
        focus_m: camera.focus,
    });
    // 0 is no object.
    provenance.objects = (1..).zip(world.object_names.iter().cloned()).collect();
    let stats = &mut provenance.stats;
    if let Some(accuracy) = accuracy.and_then(|accuracy| serde_json::to_value(accuracy).ok()) {
        stats.insert("accuracy".to_owned(), accuracy);
    }
    stats.insert("samples".to_owned(), film.samples().into());
    // Whether, not how many: a corner that tiles share is counted in each of them, and the size of
    // tiles must not show in the file.
    stats.insert("pathsCut".to_owned(), (tally.cut.paths > 0).into());
    stats.insert("samplesDropped".to_owned(), (tally.health.of(Rare::NonFiniteSample) > 0).into());
    provenance
}
