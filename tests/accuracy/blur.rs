//! What the density estimate's blur adds, where that is known in closed form.

use super::super::render::shot::focused;
use terrarium::render::Aov;

/// The radius of the estimate, and the height of the lamp's mirror image, m.
const RADIUS: f64 = 0.4;
const HEIGHT: f64 = 1.1;

/// A lamp of 1 W/sr below a mirror lights the floor a second time, from its mirror image; the eye sees 10 cm of
/// floor right below them.
fn floor(photons: u32, side: u32) -> String {
    format!(
        r#"(
    camera: (eye: (0, 0.4, 0), target: (0, 0, 0), up: (0, 0, 1), fov_deg: 14),
    image: (width: {side}, height: {side}),
    photons: progressive(count: {photons}, k: 10000, alpha: 0.999, max_radius_m: {RADIUS}),
    materials: {{ "white": (diffuse: 0.8), "mirror": (reflection: 1) }},
    lights: {{ "lamp": point(position: (0, 0.5, 0), intensity: 1) }},
    objects: [
        (shape: quad(size: (4, 4)), material: "white"),
        (shape: quad(size: (6, 6)), material: "mirror", transform: [translate((0, 0.8, 0))]),
    ],
)"#
    )
}

/// Irradiance below the mirror image, averaged over the kernel 2/(πr²)·(1 − (d/r)²).
fn blurred(radius: f64) -> f64 {
    const STEPS: u32 = 10_000;
    let at = |i: u32| {
        let d = radius * (f64::from(i) + 0.5) / f64::from(STEPS);
        let irradiance = HEIGHT / (HEIGHT * HEIGHT + d * d).powf(1.5);
        let kernel = 2.0 / (std::f64::consts::PI * radius * radius) * (1.0 - (d / radius).powi(2));
        irradiance * kernel * std::f64::consts::TAU * d * radius / f64::from(STEPS)
    };
    (0..STEPS).map(at).sum()
}

/// By 6.4 % of the light here: the layer `bias` is the difference of estimates at √2·r and r, and that is nearly what
/// the one at r is off the truth by. The bias that is stated for the picture is that of its light.
#[test]
fn the_bias_of_smooth_light_is_told() {
    let picture = focused(floor(20_000, 16)).passes(64).aovs(&[Aov::Bias, Aov::Caustic]).render();
    let mean = |layer: &str| {
        let values = picture.channel(layer, "G");
        values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64
    };
    let scale = 0.8 / std::f64::consts::PI;
    let truth = scale / (HEIGHT * HEIGHT);
    let (at_r, wider) = (scale * blurred(RADIUS), scale * blurred(RADIUS * std::f64::consts::SQRT_2));
    assert!((mean("caustic") / at_r - 1.0).abs() < 0.01, "{} for {at_r}", mean("caustic"));
    assert!((mean("bias") / (wider - at_r) - 1.0).abs() < 0.1, "{} for {}", mean("bias"), wider - at_r);
    assert!((mean("bias") / (at_r - truth) - 1.0).abs() < 0.2, "{} for {}", mean("bias"), at_r - truth);
    let direct = scale / 0.25;
    let all = direct + at_r;
    let stated = picture.rendered.stats.accuracy.as_ref().expect("many passes").bias;
    let expected = (truth - at_r) / (all * 1.31_f64.sqrt());
    assert!((stated / expected - 1.0).abs() < 0.25, "{stated} for {expected}");
}

/// With less than one photon within the radius the layer is the same in the mean, to 3σ: what is just beyond the
/// radius counts where nothing is within, too (else three times as much is told).
#[test]
fn the_bias_of_sparse_photons_is_told() {
    let picture = focused(floor(6, 4)).passes(20_000).aovs(&[Aov::Bias]).render();
    let photons = picture.rendered.stats.photons.photons.as_ref().expect("a mirror and a lamp");
    assert!(photons.stored < 6 * 20_000);
    let values = picture.channel("bias", "G");
    let found = values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64;
    let scale = 0.8 / std::f64::consts::PI;
    let expected = scale * (blurred(RADIUS * std::f64::consts::SQRT_2) - blurred(RADIUS));
    // About 0.4 photons in the disc: σ of an estimate is 1.8 of it, of the difference 0.7 of that, over the 10,000
    // passes that look.
    let sigma = 0.7 * 1.8 * scale * blurred(RADIUS) / f64::sqrt(10_000.0);
    assert!((found - expected).abs() < 3.0 * sigma, "{found} for {expected} ± {sigma}");
}
