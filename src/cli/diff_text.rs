//! What `diff` tells people.

use std::fmt::Write;
use terrarium::measure::{Colour, Comparison, LayerDifference, Verdict};

/// The whole comparison, some lines a layer.
pub fn text(heading: &str, found: &Comparison) -> String {
    let mut text = format!("{heading}: {} × {} pixels\n", found.width, found.height);
    for note in &found.notes {
        line(&mut text, "note", note);
    }
    for (side, only) in [("image", &found.only_in_image), ("reference", &found.only_in_reference)] {
        if !only.is_empty() {
            line(&mut text, "note", &format!("only in the {side}: {}", only.join(", ")));
        }
    }
    for layer in &found.layers {
        let _ = writeln!(text, "{} ({})", title(&layer.name), layer.channels.join(", "));
        describe(&mut text, layer);
    }
    text
}

/// The layer's name as messages show it.
pub fn title(name: &str) -> &str {
    if name.is_empty() { "picture" } else { name }
}

/// What a limit that is exceeded says.
pub fn exceeded(verdict: &Verdict) -> String {
    let Verdict { limit, layer, value, allowed, .. } = verdict;
    if value.is_nan() {
        return format!("--{limit}: there is no such figure of what was compared");
    }
    let layer = title(layer);
    match *limit {
        "fail" | "warn" => {
            format!("--{limit}: {value:.4} % of the pixels of {layer} are over, {allowed} % may be")
        }
        _ => format!("--{limit}: {} of {layer} is over {allowed}", number(*value)),
    }
}

fn describe(text: &mut String, layer: &LayerDifference) {
    let values = &layer.values;
    if values.non_finite.image + values.non_finite.reference > 0 {
        let found = &values.non_finite;
        let counts = format!("{} values, {} of the reference", found.image, found.reference);
        let unmatched = format!("{counts}; {} in one image only; left out of all means", found.unmatched);
        line(text, "not finite", &unmatched);
    }
    if values.same {
        line(text, "same", "bit for bit");
        return;
    }
    if let Some(colour) = &layer.colour {
        colours(text, colour);
    }
    line(text, "RMSE", &format!("{}, MSE {}", number(values.rmse), number(values.mse)));
    if let Some(worst) = &values.worst {
        let list = |values: &[f64]| values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(" ");
        let both = format!("{} against {}", list(&worst.image), list(&worst.reference));
        line(text, "worst", &format!("{} at ({}, {}): {both}", number(values.max_error), worst.x, worst.y));
    }
    line(text, "differing", &format!("{} of the pixels", percent(values.differing)));
}

fn colours(text: &mut String, colour: &Colour) {
    let relative = &colour.relative;
    let trimmed = number(relative.rel_mse_trimmed);
    let both = format!("{} (ε = 0.01), {trimmed} without the worst 0.1 %", number(relative.rel_mse));
    line(text, "relMSE", &both);
    line(text, "E", &format!("{} (relative RMS error, of any exposure)", percent(relative.relative_rms)));
    line(text, "MAPE", &percent(relative.mape));
    line(text, "mean", &format!("{:.6} of the reference's", relative.mean_ratio));
    let ssim = colour.ssim.map_or(String::new(), |ssim| format!(", SSIM {ssim:.6}"));
    let exposure = format!("at {:+.3} EV", colour.exposure_ev);
    line(text, "PSNR", &format!("{:.3} dB{ssim}, {exposure}", colour.psnr_db));
    let quartiles = |q: [f64; 3]| format!("weighted quartiles {:.4}, {:.4}, {:.4}", q[0], q[1], q[2]);
    if let Some(flip) = &colour.flip {
        line(text, "FLIP", &format!("{:.6}, {}, {exposure}", flip.mean, quartiles(flip.weighted_quartiles)));
    }
    if let Some(flip) = &colour.flip_hdr {
        let range = &flip.exposures;
        let range = format!("{} from {:+.3} to {:+.3} EV", range.count, range.start_ev, range.stop_ev);
        let quartiles = quartiles(flip.pooled.weighted_quartiles);
        line(text, "HDR-FLIP", &format!("{:.6}, {quartiles}, {range}", flip.pooled.mean));
    }
}

fn line(text: &mut String, name: &str, what: &str) {
    let _ = writeln!(text, "  {name:<10} {what}");
}

/// Four significant digits.
fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e4).contains(&size) {
        let digits = if size >= 1.0 || size == 0.0 { 3 } else { 5 };
        format!("{value:.digits$}")
    } else {
        format!("{value:.3e}")
    }
}

fn percent(share: f64) -> String {
    format!("{} %", number(100.0 * share))
}
