//! What a render did: a few lines for people, JSON for machines.

use super::progress::{duration, short};
use super::report::Terminal;
use serde::Serialize;
use terrarium::measure::Expected;
use terrarium::output::Written;
use terrarium::render::{Next, PhotonStats, Priced, Stats};
use terrarium::trace::Rays;

/// Everything that `--stats` writes.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    /// Whether it is of a part, whose error only the whole tells.
    #[serde(skip)]
    pub part: bool,
    /// Of this format.
    pub v: u32,
    pub version: &'static str,
    pub scene: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<u32>,
    pub scene_hash: &'a str,
    pub seed: u64,
    pub width: usize,
    pub height: usize,
    pub outputs: Vec<String>,
    pub threads: usize,
    /// From the program's start to the last image's name.
    pub seconds: f64,
    /// The highest memory use of the process, where the system tells it.
    pub peak_bytes: Option<u64>,
    pub non_finite_values: u64,
    pub clamped_pixels: u64,
    pub warnings: &'a [String],
    #[serde(flatten)]
    pub stats: &'a Stats,
}

impl Summary<'_> {
    pub fn json(&self) -> String {
        let json = serde_json::to_string_pretty(self).expect("numbers, strings and maps with string keys");
        json + "\n"
    }

    /// A few lines: where the images are, time, rays, memory, and whatever should be rare.
    pub fn say(&self, terminal: &Terminal) {
        let stages: Vec<String> =
            self.stats.stages.iter().map(|stage| format!("{} {:.2}", stage.name, stage.seconds)).collect();
        terminal.say(&format!("wrote {}", self.outputs.join(", ")));
        terminal.say(&format!("time: {} ({} s)", duration(self.seconds), stages.join(", ")));
        let prices: Vec<String> = self.stats.prices.iter().map(price).collect();
        if !prices.is_empty() {
            let predicted = duration(self.stats.predicted_seconds);
            terminal.say(&format!("of which: {} (predicted: {predicted} in all)", prices.join(", ")));
        }
        accuracy(self.stats, self.part).iter().for_each(|line| terminal.say(line));
        let rays = rays(&self.stats.rays);
        if !rays.is_empty() {
            terminal.say(&format!("rays: {rays}"));
        }
        let photons = &self.stats.photons;
        for (what, photons) in
            [("photons", &photons.photons), ("indirect photons", &photons.indirect_photons)]
        {
            if let Some(photons) = photons {
                terminal.say(&format!("{what}: {}", of_photons(photons)));
            }
        }
        if let Some(bytes) = self.peak_bytes {
            let predicted = self
                .stats
                .predicted_peak_bytes
                .map_or(String::new(), |bytes| format!(" ({} predicted)", mebibytes(bytes)));
            terminal.say(&format!("memory: {} at most{predicted}", mebibytes(bytes)));
        }
        for event in self.stats.rare_events.iter().filter(|event| event.count > 0) {
            terminal.say(&format!(
                "rare: {} {} of {} times ({} allowed)",
                event.name, event.count, event.of, event.allowed
            ));
        }
        if self.non_finite_values > 0 {
            terminal.warning(&format!(
                "{} values were not finite and are 0 in the image",
                self.non_finite_values
            ));
        }
        if self.clamped_pixels > 0 {
            let share = 100.0 * self.clamped_pixels as f64 / (self.width * self.height).max(1) as f64;
            terminal.say(&format!("PNG: {} pixels ({share:.1} %) are out of range", self.clamped_pixels));
        }
    }
}

/// How far the picture is from the truth, where that comes from, and what less of it would cost.
fn accuracy(stats: &Stats, part: bool) -> Vec<String> {
    let percent = |share: f64| format!("{} %", significant(100.0 * share));
    let Some(a) = &stats.accuracy else {
        let why = if part {
            "of a part: `terrarium merge` tells that of the image"
        } else if stats.passes < 2 {
            "as one pass tells nothing of it (--passes 2 or more)"
        } else {
            "as the picture is black"
        };
        return vec![format!("accuracy: unknown, {why}")];
    };
    let [low, high] = a.interval;
    // Some pixels may have come to rest.
    let fewer = a.mean_passes < 0.99 * f64::from(a.passes);
    let mean = if fewer { format!(" (a pixel has {:.0} on average)", a.mean_passes) } else { String::new() };
    let least = if stats.not_seen.is_empty() { "" } else { "at least " };
    let mut lines = vec![format!(
        "accuracy: error {least}{} (95 %: {} to {}) after {} passes{mean}; noise {}, bias {}",
        percent(a.error),
        significant(100.0 * low),
        percent(high),
        a.passes,
        percent(a.noise),
        percent(a.bias)
    )];
    let parts: Vec<String> =
        a.by_effect.iter().map(|part| format!("{} {:.0} %", part.effect, 100.0 * part.share)).collect();
    if !parts.is_empty() {
        lines.push(format!("  where: {} of the squared error", parts.join(", ")));
    }
    lines.extend(stats.next.iter().map(price_of_half));
    if !stats.not_seen.is_empty() {
        lines.push(format!("  not in it: {}", stats.not_seen.join("; ")));
    }
    lines
}

/// `  next: 0.97 % for about 4 min 10 s more (caustics ×7.9)`.
fn price_of_half(next: &Next) -> String {
    let factors: Vec<String> =
        next.by_effect.iter().map(|f| format!("{} ×{}", f.effect, significant(f.passes))).collect();
    let (more, error) = (duration(next.seconds), significant(100.0 * next.error));
    format!("  next: {error} % for about {more} more ({})", factors.join(", "))
}

/// The same of a render that is planned.
pub fn expected(expected: &Expected) -> Vec<String> {
    let mut lines = vec![match expected.error {
        None => "accuracy: one pass, or a black picture, tells nothing of it".to_owned(),
        Some(error) => format!(
            "accuracy: error about {} % after {:.0} passes, {} of tracing (told from the first {})",
            significant(100.0 * error),
            expected.passes,
            duration(expected.seconds),
            expected.from_passes
        ),
    }];
    lines.extend(expected.next.iter().map(price_of_half));
    if !expected.not_seen.is_empty() {
        lines.push(format!("  not in it: {}", expected.not_seen.join("; ")));
    }
    lines
}

/// Two digits that count.
pub fn significant(x: f64) -> String {
    let decimals = if x >= 9.95 || x <= 0.0 { 0.0 } else { 1.0 - x.log10().floor() };
    format!("{x:.*}", decimals.clamp(0.0, 6.0) as usize)
}

/// What an effect took, and should have.
fn price(price: &Priced) -> String {
    let Priced { effect, seconds, predicted_seconds } = price;
    format!("{effect} {seconds:.2} s ({predicted_seconds:.2} predicted)")
}

/// Rays by kind; empty where there are none.
pub fn rays(rays: &Rays) -> String {
    let rays = serde_json::to_value(rays).unwrap_or_default();
    let kinds: Vec<String> = rays
        .as_object()
        .into_iter()
        .flatten()
        .filter_map(|(kind, count)| Some((kind, count.as_f64().filter(|count| *count > 0.0)?)))
        .map(|(kind, count)| format!("{kind} {}", short(count)))
        .collect();
    kinds.join(", ")
}

/// Emitted, stored, by which lights, and how far around each point they were gathered.
fn of_photons(photons: &PhotonStats) -> String {
    let lights: Vec<String> = photons
        .lights
        .iter()
        .filter(|light| light.share > 0.0)
        .map(|light| {
            format!(
                "`{}` {:.0} % of them, yield {:.1} %",
                light.name,
                100.0 * light.share,
                100.0 * light.yields
            )
        })
        .take(LIGHTS)
        .collect();
    let more = photons.lights.iter().filter(|light| light.share > 0.0).count().saturating_sub(LIGHTS);
    let more = if more > 0 { format!("; {more} lights more") } else { String::new() };
    let maps = if photons.maps == 1 { "1 map".to_owned() } else { format!("{} maps", photons.maps) };
    let refused = match photons.refused {
        0 => String::new(),
        n => format!("; {n} were not finite and are left out"),
    };
    format!(
        "{} sent out, {} stored in {maps} of at most {:.1} MiB ({}{more}); radius up to {:.3} m, ×{:.2} in the last{refused}",
        short(photons.emitted as f64),
        short(photons.stored as f64),
        photons.map_bytes as f64 / f64::from(1 << 20),
        lights.join("; "),
        photons.max_radius,
        photons.radius_factor,
    )
}

/// Lights that are named one by one.
const LIGHTS: usize = 4;

/// What the writers of all images had to change: the same values in each of them count once.
pub fn worst(written: &[Written]) -> Written {
    Written {
        non_finite: written.iter().map(|w| w.non_finite).max().unwrap_or(0),
        clamped_pixels: written.iter().map(|w| w.clamped_pixels).max().unwrap_or(0),
    }
}

/// `123 MiB`.
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.0} MiB", bytes as f64 / f64::from(1 << 20))
}
