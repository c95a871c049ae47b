//! Every pair of features once: light kinds, materials, shapes, antialiasing, effects, photon engines. Tiny
//! scenes, held against what must be so whatever the scene is.

mod cover;
mod scene;

use crate::render::shot::{Picture, Shot, focused};
use cover::{pairs_of, rows};
use scene::{FACTORS, text};
use std::path::Path;
use terrarium::description::{Format, load_str, load_str_as_written, to_string};
use terrarium::plan::Overrides;
use terrarium::render::{Options, Silent, render};

/// A scene for every row of the covering array.
fn scenes() -> Vec<([usize; 6], String)> {
    let sizes = FACTORS.map(|(_, levels)| levels);
    rows(sizes).into_iter().map(|row| (row, text(row))).collect()
}

fn name(row: [usize; 6]) -> String {
    let parts = FACTORS.iter().zip(row).map(|((factor, _), level)| format!("{factor} {level}"));
    parts.collect::<Vec<_>>().join(", ")
}

fn shoot(text: &str, folder: &Path) -> Shot {
    focused(text).folder(folder).passes(2)
}

/// All pairs, in not many more rows than the two largest factors need.
#[test]
fn the_array_covers_every_pair() {
    let sizes = FACTORS.map(|(_, levels)| levels);
    let rows = rows(sizes);
    let mut covered: Vec<_> = rows.iter().flat_map(|row| pairs_of(*row)).collect();
    covered.sort_unstable();
    covered.dedup();
    let all: usize = (0..6).flat_map(|i| (0..i).map(move |j| sizes[i] * sizes[j])).sum();
    assert_eq!(covered.len(), all);
    let mut largest = sizes;
    largest.sort_unstable();
    let least = largest[5] * largest[4];
    assert!(rows.len() < least * 3 / 2, "{} rows, {least} at least", rows.len());
}

/// By how much the means of such scenes may differ, as a share. Of the 54 the most that was found is 0.041.
const NOISE: f64 = 0.06;

/// Finite, not negative, healthy, and no brighter than what shines; the same bits on one thread and on two, in
/// tiles of any size, to the bit; and with everything that could run forced to, to the bit where no photons are sent.
#[test]
fn every_pair_is_sound_and_the_same_however_it_is_computed() {
    let folder = scene::folder();
    for (row, text) in scenes() {
        let shot = shoot(&text, folder.path());
        let with = |options: Options| {
            let mut shot = shot.clone();
            shot.options = options;
            shot.render()
        };
        let base = shot.options.clone();
        let picture = with(Options { threads: Some(1), ..base.clone() });
        let what = name(row);
        assert!(picture.is_sound(), "{what}: {text}");
        let rare = &picture.rendered.stats.rare_events;
        let unhealthy = rare.iter().find(|e| e.count as f64 > e.allowed * e.of as f64);
        assert!(unhealthy.is_none(), "{what}: {unhealthy:?}: {text}");
        let (mean, most) = (picture.mean(), scene::bound(row));
        assert!(mean > 0.0 && mean <= most, "{what}: {mean}, {most} at most: {text}");
        let again = with(Options { threads: Some(2), tile: 5, ..base.clone() });
        assert!(picture.bits() == again.bits(), "{what}: threads and tiles change the picture: {text}");
        let overrides = Overrides { forced: true, ..Overrides::default() };
        let forced = with(Options { overrides, ..base });
        // Glass that light does not notice is glass when forced, and has shadows and caustics.
        let photons = &picture.rendered.stats.photons;
        let focused = photons.photons.is_some() || photons.indirect_photons.is_some();
        if scene::is_unnoticed(row) && !scene::has_photons(row) {
            // As glass it has a shadow, and the scene asks for nothing that brings its light.
        } else if focused || scene::is_unnoticed(row) {
            // Photons are sent elsewhere: the same to the noise of two passes of a thousand.
            let off = (forced.mean() / mean - 1.0).abs();
            assert!(off <= NOISE, "{what}: what the plan left out is {off} of the picture: {text}");
        } else {
            let same = picture.bits() == forced.bits();
            assert!(same, "{what}: what the plan left out changes the picture: {text}");
        }
    }
}

/// One scene in so many is rendered in both languages: that their content is the same is told without.
const RENDERED: usize = 5;

/// The same scene in the other language, and back, is the same scene and the same picture.
#[test]
fn every_pair_is_the_same_in_both_languages() {
    let folder = scene::folder();
    for (i, (row, text)) in scenes().into_iter().enumerate() {
        let what = name(row);
        let shot = shoot(&text, folder.path());
        let ron = shot.load();
        let written = load_str_as_written(&text, Format::Ron, &[]).unwrap_or_else(|r| panic!("{what}: {r}"));
        let toml = to_string(&written, Format::Toml).unwrap_or_else(|e| panic!("{what}: {e}"));
        let other = load_str(&toml, Format::Toml, folder.path(), &[])
            .unwrap_or_else(|report| panic!("{what}: {report}\n{toml}"));
        assert_eq!(ron.hash, other.hash, "{what}: {text}\n{toml}");
        let written = load_str_as_written(&toml, Format::Toml, &[]).unwrap_or_else(|r| panic!("{what}: {r}"));
        let back = to_string(&written, Format::Ron).unwrap_or_else(|e| panic!("{what}: {e}"));
        let back = load_str(&back, Format::Ron, folder.path(), &[])
            .unwrap_or_else(|report| panic!("{what}: {report}\n{back}"));
        assert_eq!(ron.hash, back.hash, "{what}");
        if i % RENDERED != 0 {
            continue;
        }
        let one = Options { passes: Some(0..1), ..shot.options.clone() };
        let [a, b] = [&ron, &other].map(|loaded| Picture {
            rendered: render(loaded, &one, &Silent).unwrap_or_else(|e| panic!("{what}: {e}")),
        });
        assert!(a.bits() == b.bits(), "{what}: {text}\n{toml}");
    }
}
