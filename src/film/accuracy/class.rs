//! Pixels by how many passes they have: those that came to rest have fewer.

use super::independent::{Independent, relative};
use super::jackknife::jackknife;
use super::sums::{Row, Sums};
use super::{Accuracy, Part, Rates};
use crate::film::brightness::Brightness;
use crate::math::random::{combine, mix};
use crate::trace::{Look, Measured, Probe};
use std::collections::BTreeMap;

/// Groups of probes, to see how much an estimate hangs on some of them.
const GROUPS: u64 = 16;

/// Probes that tell by themselves how the noise of a class falls.
const ENOUGH: f64 = 64.0;

/// Pixels and probes with one number of passes.
#[derive(Default)]
struct Class {
    part: u32,
    independent: Independent,
    groups: Vec<Sums>,
}

/// All of them, by their passes.
pub(super) struct Classes {
    classes: BTreeMap<u32, Class>,
    pixels: f64,
    /// The class with the most probes.
    main: u32,
    /// How the bias is told, of caustic, indirect and both.
    looks: [Look; 3],
    /// Whether noise is that of independent passes, whatever the probes tell.
    pub independent: bool,
    pub rates: Rates,
}

impl Classes {
    /// `None` where no pixel or no probe has two passes.
    pub fn of<'a>(
        pixels: impl Iterator<Item = Measured>,
        probes: impl Iterator<Item = &'a Probe>,
        picture: &Brightness,
        floor: f64,
    ) -> Option<Classes> {
        let mut classes: BTreeMap<u32, Class> = BTreeMap::new();
        for pixel in pixels {
            let class = classes.entry(pixel.passes).or_default();
            let single = picture.single(pixel.x, pixel.y, pixel.others);
            class.independent.add(relative(&pixel, picture, floor), single);
        }
        let mut probes: Vec<&Probe> = probes.filter(|probe| probe.passes() > 1).collect();
        // A fixed order, whatever the tiles, so that sums have the same bits.
        probes.sort_by_key(|probe| (probe.y, probe.x));
        for probe in &probes {
            let class = classes.entry(probe.passes()).or_default();
            class.part = probe.first_half();
            class.groups.resize(GROUPS as usize, Sums::default());
            let group = combine(mix(u64::from(probe.x)), u64::from(probe.y)) % GROUPS;
            class.groups[group as usize].add(probe, picture, floor);
        }
        let main = classes.iter().max_by(|a, b| a.1.probes().total_cmp(&b.1.probes())).map(|(n, _)| *n)?;
        let pixels = classes.values().map(|class| class.independent.count).sum::<u64>() as f64;
        if probes.is_empty() || pixels <= 0.0 {
            return None;
        }
        let (looks, rates) = ([Look::Wide; 3], Rates::default());
        let mut classes = Classes { classes, pixels, main, looks, independent: false, rates };
        classes.looks = std::array::from_fn(|which| classes.look(which));
        Some(classes)
    }

    /// The squared error, as it is without one of the groups of probes.
    pub fn squared(&self, without: Option<usize>) -> f64 {
        let noise: f64 = self.classes.iter().map(|(n, class)| self.noise(*n, class, without)).sum();
        noise + self.bias(2, without)
    }

    /// The squared bias: 0 caustic, 1 indirect, 2 both.
    fn bias(&self, which: usize, without: Option<usize>) -> f64 {
        self.probed(without).bias(self.looks[which], which).max(0.0)
    }

    /// The look that tells most of a bias: the narrow one where it sees more than the wide one by twice what
    /// chance may do to the difference, told by the jackknife over groups of probes; else the one with less noise.
    fn look(&self, which: usize) -> Look {
        let more = |without: Option<usize>| {
            let probed = self.probed(without);
            probed.bias(Look::Narrow, which) - probed.bias(Look::Wide, which)
        };
        let each: Vec<f64> = self.groups().map(|group| more(Some(group))).collect();
        if more(None) > 2.0 * jackknife(&each) { Look::Narrow } else { Look::Wide }
    }

    /// What a class adds to the squared noise of the picture.
    fn noise(&self, passes: u32, class: &Class, without: Option<usize>) -> f64 {
        class.independent.sum() / self.pixels * self.gain(passes, class, without)
    }

    fn gain(&self, passes: u32, class: &Class, without: Option<usize>) -> f64 {
        if self.independent || (passes != self.main && class.probes() < ENOUGH) {
            return 1.0;
        }
        class.sums(without).gain(class.part, passes)
    }

    /// Of the class with the most probes.
    pub fn doubt(&self) -> f64 {
        let class = &self.classes[&self.main];
        if self.independent { 0.0 } else { class.sums(None).doubt(class.part, self.main) }
    }

    /// All probes.
    fn probed(&self, without: Option<usize>) -> Sums {
        self.classes.values().fold(Sums::default(), |sum, class| sum.with(&class.sums(without), 1.0))
    }

    /// Groups that have probes.
    pub fn groups(&self) -> impl Iterator<Item = usize> {
        let has = |group: &usize| {
            self.classes.values().any(|c| c.groups.get(*group).is_some_and(|g| g.count > 0.0))
        };
        (0..GROUPS as usize).filter(has)
    }

    /// The share of the pixels' parts that single passes have made.
    pub fn single(&self) -> f64 {
        let sum = |of: fn(&Independent) -> f64| -> f64 {
            self.classes.iter().map(|(n, class)| self.gain(*n, class, None) * of(&class.independent)).sum()
        };
        let all = sum(Independent::sum);
        if all > 0.0 { sum(Independent::single) / all } else { 0.0 }
    }

    /// √Σt²/Σt of the pixels' parts t: how much their sum hangs on few of them.
    pub fn scatter(&self) -> f64 {
        let (mut sum, mut squares) = (0.0, 0.0);
        for (passes, class) in &self.classes {
            let gain = self.gain(*passes, class, None);
            sum += gain * class.independent.sum();
            squares += gain * gain * class.independent.squares();
        }
        if sum > 0.0 { squares.sqrt() / sum } else { 0.0 }
    }

    pub fn accuracy(&self) -> Accuracy {
        let mut rows: Vec<Row> = Vec::new();
        let mut mean_passes = 0.0;
        for (&passes, class) in &self.classes {
            mean_passes += class.independent.count as f64 / self.pixels * f64::from(passes);
            // Probes tell how it is shared, all pixels how much it is.
            let told = if class.probes() > 0.0 { passes } else { self.main };
            let class_told = &self.classes[&told];
            let shares = class_told.sums(None).rows(class_told.part, told, self.rates, self.independent);
            let probed: f64 = shares.iter().map(|row| row.noise).sum();
            let scale = if probed > 0.0 { self.noise(passes, class, None) / probed } else { 0.0 };
            for share in shares {
                let noise = scale * share.noise;
                match rows.iter_mut().find(|row| row.effect == share.effect) {
                    Some(row) => {
                        let all = row.noise + noise;
                        if all > 0.0 {
                            row.rate = (row.rate * row.noise + share.rate * noise) / all;
                        }
                        row.noise = all;
                    }
                    None => rows.push(Row { noise, ..share }),
                }
            }
        }
        let noise: f64 = rows.iter().map(|row| row.noise).sum();
        let biases = rows.iter().map(|row| match row.effect {
            "caustics" => self.bias(0, None),
            "indirect" => self.bias(1, None),
            _ => 0.0,
        });
        let all: Vec<(&Row, f64)> =
            rows.iter().zip(biases).filter(|(row, bias)| row.noise + bias > 0.0).collect();
        let sum: f64 = all.iter().map(|(row, bias)| row.noise + bias).sum();
        let part = |(row, bias): &(&Row, f64)| Part {
            effect: row.effect,
            share: (row.noise + bias) / sum,
            rate: row.rate,
            noise: row.noise.sqrt(),
            bias: bias.sqrt(),
        };
        let error = (noise + self.bias(2, None)).sqrt();
        Accuracy {
            passes: self.classes.keys().copied().max().unwrap_or(0),
            mean_passes,
            error,
            interval: [error; 2],
            noise: noise.sqrt(),
            bias: self.bias(2, None).sqrt(),
            by_effect: all.iter().map(part).collect(),
            gain: self.classes.iter().next_back().map_or(1.0, |(n, class)| self.gain(*n, class, None)),
            bias_rate: self.rates.bias,
        }
    }
}

impl Class {
    fn probes(&self) -> f64 {
        self.groups.iter().map(|group| group.count).sum()
    }

    fn sums(&self, without: Option<usize>) -> Sums {
        let kept = self.groups.iter().enumerate().filter(|(i, _)| Some(*i) != without);
        kept.fold(Sums::default(), |sum, (_, group)| sum.with(group, 1.0))
    }
}
