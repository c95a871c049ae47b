//! `render --pixel`: what the camera paths of one pixel in one pass met, for people and as JSON.

use super::args::RenderArgs;
use super::check::{load_and_report, set_threads};
use super::exit::{FAILED, Failure};
use super::render::unbuildable;
use super::report::{self, Terminal, printable};
use std::fmt::Write;
use terrarium::math::Place;
use terrarium::render::{self, Replay};
use terrarium::trace::{Event, Fate, SampleRecord, Sent, Vertex};

pub fn run(args: &RenderArgs, [x, y]: [u32; 2], terminal: &Terminal) -> Result<(), Failure> {
    set_threads(args.work.threads)?;
    let options = args.work.options();
    let loaded = load_and_report(&args.scene, &args.reading, options.overrides.unread(), terminal)?;
    let place = Place { x, y, pass: args.replay.pass };
    let found =
        render::replay(&loaded, &options, place).map_err(|error| unbuildable(error, &loaded, terminal))?;
    if args.replay.json {
        let json = serde_json::to_string_pretty(&found).expect("numbers, strings and lists");
        report::print(&(json + "\n"))?;
    } else {
        report::print(&printable(&text(&found)))?;
    }
    let dropped = found.samples.iter().filter(|sample| sample.dropped).count();
    if args.strict && dropped > 0 {
        return Err(Failure::new(FAILED, format!("unhealthy: {dropped} samples were dropped (--strict)")));
    }
    Ok(())
}

/// All of it, sample by sample.
fn text(found: &Replay) -> String {
    let (used, seen): (Vec<_>, Vec<_>) = found.samples.iter().partition(|s| s.weight > 0.0 || s.dropped);
    let plural = if used.len() == 1 { "" } else { "s" };
    let mut text = format!(
        "pixel ({}, {}), pass {}: {} of {} sample{plural}\n",
        found.x,
        found.y,
        found.pass,
        colour(found.value),
        used.len()
    );
    for sample in used {
        describe(&mut text, sample);
    }
    if !seen.is_empty() {
        let _ = writeln!(
            text,
            "{} more were only compared, to see where the pixel had to be divided",
            seen.len()
        );
    }
    text
}

// Writing to a string cannot fail.
fn describe(text: &mut String, sample: &SampleRecord) {
    let [x, y] = sample.film;
    let sum = colour(sample.radiance);
    let finite = sample.radiance.iter().all(|c| c.is_finite());
    let fate = match (sample.dropped, finite) {
        (false, _) => format!("weight {:.4}", sample.weight),
        (true, true) => "beyond 3.5e13: dropped".to_owned(),
        (true, false) => "not finite: dropped".to_owned(),
    };
    let _ = writeln!(text, "sample at ({x:.4}, {y:.4}): {sum}, {fate}");
    for (i, vertex) in sample.vertices.iter().enumerate() {
        let by = came(vertex.by);
        let from = vertex.from.map_or("the eye".to_owned(), |from| (from + 1).to_string());
        match &vertex.met {
            None => {
                let _ = writeln!(text, "  {}. {by} from {from}: leaves the scene", i + 1);
            }
            Some(met) => {
                let [x, y, z] = met.position;
                let _ = writeln!(
                    text,
                    "  {}. {by} from {from}: `{}` of `{}` at ({x:.6}, {y:.6}, {z:.6}), {:.6} m on",
                    i + 1,
                    met.object,
                    met.material,
                    met.distance
                );
            }
        }
        details(text, vertex);
    }
}

fn details(text: &mut String, vertex: &Vertex) {
    let _ = writeln!(text, "       throughput {}, adds {}", colour(vertex.throughput), colour(vertex.adds));
    for (what, radiance) in [("emits", vertex.emitted), ("ambient light", vertex.ambient)] {
        if radiance != [0.0; 3] {
            let _ = writeln!(text, "       {what}: {}", colour(radiance));
        }
    }
    for light in &vertex.lights {
        let _ = writeln!(text, "       light `{}`: {}", light.light, colour(light.radiance));
    }
    for (what, photons) in [("caustic", &vertex.caustic), ("indirect", &vertex.indirect)] {
        if let Some(found) = photons {
            let _ = writeln!(
                text,
                "       {what}: {} of {} photons within {:.3e} m",
                colour(found.radiance),
                found.photons,
                found.radius
            );
        }
    }
    if let Some(interface) = &vertex.interface {
        let colour = interface.wavelength_um.map_or(String::new(), |um| format!(" at {um:.4} µm"));
        let (near, far) = (interface.near_ior, interface.far_ior);
        let share = 100.0 * interface.reflectance;
        let _ = writeln!(text, "       interface {near:.5} → {far:.5}{colour}: {share:.3} % reflected");
    }
    for sent in &vertex.sends {
        let _ = writeln!(text, "       {}: {}", goes(sent.event), fate(sent));
    }
}

fn came(by: Event) -> &'static str {
    match by {
        Event::Camera => "seen",
        Event::Mirrored => "mirrored",
        Event::Reflected => "reflected",
        Event::Refracted => "refracted",
        Event::Diffuse => "scattered",
        Event::Unnoticed => "straight on",
    }
}

fn goes(event: Event) -> &'static str {
    match event {
        Event::Camera => "from the eye",
        Event::Mirrored => "mirrored",
        Event::Reflected => "reflected at the interface",
        Event::Refracted => "refracted through it",
        Event::Diffuse => "scattered on, for indirect light",
        Event::Unnoticed => "within an object of higher priority, this surface is none",
    }
}

fn fate(sent: &Sent) -> String {
    let carries = colour(sent.throughput);
    match (sent.fate, sent.to) {
        (Fate::Followed, Some(to)) => format!("{carries}, to {}", to + 1),
        (Fate::Followed, None) => carries,
        (Fate::Roulette, _) => format!("{carries}, ended by chance"),
        (Fate::DepthLimit, _) => format!("{carries}, cut off by render.max_depth"),
        (Fate::Weightless, _) => "nothing".to_owned(),
    }
}

/// Six digits that count.
fn colour(rgb: [f32; 3]) -> String {
    let [r, g, b] = rgb.map(|c| match c.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e4).contains(&size) => {
            let digits = (5.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
            format!("{c:.digits$}")
        }
        _ => format!("{c:.5e}"),
    });
    format!("({r}, {g}, {b})")
}
