//! No surface may give back more light than it gets.

use super::Checker;
use crate::description::tree::{Path, number};
use crate::description::{Material, Rgb, Source};

/// km + (1−km)·(kt + (1−kt)·kd) + ks ≤ 1 a channel. What a texture drives counts as 0 here, so that
/// only certain gains are refused.
pub(super) fn check(c: &mut Checker, path: &Path, material: &Material) {
    let constant = |source: &Source| match source {
        Source::Constant(rgb) => rgb.0,
        Source::Texture(_) => Rgb::default().0,
    };
    let [kd, ks, km, kt] =
        [&material.diffuse, &material.specular, &material.reflection, &material.transmission].map(constant);
    let in_range = [kd, ks, km, kt].iter().flatten().all(|k| (0.0..=1.0).contains(k));
    if !in_range {
        return;
    }
    let layered = |i: usize| km[i] + (1.0 - km[i]) * (kt[i] + (1.0 - kt[i]) * kd[i]);
    let total = |i: usize| layered(i) + ks[i];
    let worst = (0..3).max_by(|a, b| total(*a).total_cmp(&total(*b))).unwrap_or(0);
    // sums such as 0.9 + 0.1 may round above 1
    if total(worst) <= 1.0 + 1e-9 {
        return;
    }
    let channel =
        if total(0) == total(1) && total(1) == total(2) { "" } else { ["red: ", "green: ", "blue: "][worst] };
    let rounded = |x: f64| number((x * 1000.0).round() / 1000.0);
    let room = rounded((((1.0 - layered(worst)) * 1000.0 + 1e-6).floor() / 1000.0).max(0.0));
    let message = format!(
        "{channel}gives back {} of the light it gets: {} by its layers and {} by its highlight",
        rounded(total(worst)),
        rounded(layered(worst)),
        rounded(ks[worst]),
    );
    let help = format!("lower `specular` to {room}, or the layers (reflection, transmission, diffuse)");
    c.report(super::Severity::Error, super::Kind::Invalid, &[path], message, Some(help));
}
