//! What a render did: a few lines for people, JSON for machines.

use super::progress::{duration, short};
use super::report::Terminal;
use serde::Serialize;
use terrarium::output::Written;
use terrarium::render::Stats;

/// Everything that `--stats` writes.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    pub version: &'static str,
    pub scene: String,
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
        let rays = serde_json::to_value(self.stats.rays).unwrap_or_default();
        let rays: Vec<String> = rays
            .as_object()
            .into_iter()
            .flatten()
            .filter_map(|(kind, count)| Some((kind, count.as_f64().filter(|count| *count > 0.0)?)))
            .map(|(kind, count)| format!("{kind} {}", short(count)))
            .collect();
        if !rays.is_empty() {
            terminal.say(&format!("rays: {}", rays.join(", ")));
        }
        if let Some(bytes) = self.peak_bytes {
            terminal.say(&format!("memory: {:.0} MiB at most", bytes as f64 / f64::from(1 << 20)));
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

/// What the writers of all images had to change: the same values in each of them count once.
pub fn worst(written: &[Written]) -> Written {
    Written {
        non_finite: written.iter().map(|w| w.non_finite).max().unwrap_or(0),
        clamped_pixels: written.iter().map(|w| w.clamped_pixels).max().unwrap_or(0),
    }
}

/// The highest resident memory of this process so far, from Linux's `/proc`.
pub fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}
