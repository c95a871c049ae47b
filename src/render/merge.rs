//! Parts of an image, rendered anywhere, put together: the same bits as from one machine.

use super::kept::{self, Counts, Kept};
use super::{By, image};
use crate::film::{Accuracy, Film};
use crate::math::Health;
use crate::output::partial::PartialError;
use crate::output::{Bits, Image, PngSettings, Provenance};
use std::path::{Path, PathBuf};

/// An image that was put together.
pub struct Merged {
    pub image: Image,
    pub provenance: Provenance,
    pub png: PngSettings,
    pub accuracy: Option<Accuracy>,
    /// Of all parts.
    pub health: Health,
    /// Shards that are not there.
    pub missing: Vec<u32>,
    pub of: u32,
    pub passes: u32,
}

/// Why parts can't be put together.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    #[error("can't read {0}: {1}")]
    Unreadable(PathBuf, PartialError),
    #[error("{0}")]
    Invalid(String),
}

/// Puts together the parts in `files`. Shards may be missing only if that is `allowed`; some has to be there.
pub fn merge(files: &[PathBuf], allowed: bool) -> Result<Merged, MergeError> {
    let Some((first, others)) = files.split_first() else {
        return Err(MergeError::Invalid("no part is there".to_owned()));
    };
    let mut whole = Sum::of(first, part(first)?)?;
    let mut next = others.first().map(|file| part(file));
    for (i, file) in others.iter().enumerate() {
        let Some(kept) = next.take() else { break };
        let kept = kept?;
        // The next is read beside it.
        let after = others.get(i + 1);
        let (added, read) = rayon::join(|| whole.add(file, kept), || after.map(|file| part(file)));
        added?;
        next = read;
    }
    whole.finish(allowed)
}

fn part(file: &Path) -> Result<Kept, MergeError> {
    let kept = kept::load(file).map_err(|error| unreadable(file, error))?;
    if !kept.part.finished {
        return Err(MergeError::Invalid(format!(
            "{} is a checkpoint of a part that is not finished: go on with it with --resume",
            file.display()
        )));
    }
    Ok(kept)
}

fn unreadable(file: &Path, error: PartialError) -> MergeError {
    MergeError::Unreadable(file.to_path_buf(), error)
}

/// What has been put together so far.
struct Sum {
    provenance: Provenance,
    part: kept::Part,
    counts: Counts,
    film: Film,
    /// Which file each shard is from.
    from: Vec<(u32, PathBuf)>,
    /// The first file.
    first: PathBuf,
}

impl Sum {
    fn of(file: &Path, kept: Kept) -> Result<Sum, MergeError> {
        let film = kept.film().map_err(|error| unreadable(file, error))?;
        let from = kept.part.shards.iter().map(|shard| (*shard, file.to_path_buf())).collect();
        let counts = kept.part.counts.clone();
        let Kept { provenance, part, .. } = kept;
        Ok(Sum { provenance, part, counts, film, from, first: file.to_path_buf() })
    }

    fn add(&mut self, file: &Path, kept: Kept) -> Result<(), MergeError> {
        // Which shards it is of is all that may differ.
        if let Some(difference) = kept.other_than(&self.provenance, &self.part.form, &kept.part.shards) {
            return Err(MergeError::Invalid(format!(
                "{} is of another render than {}: {difference}",
                file.display(),
                self.first.display()
            )));
        }
        for &shard in &kept.part.shards {
            if let Some((_, other)) = self.from.iter().find(|(known, _)| *known == shard) {
                return Err(MergeError::Invalid(format!(
                    "shard {shard} is there twice: in {} and in {}",
                    other.display(),
                    file.display()
                )));
            }
            self.from.push((shard, file.to_path_buf()));
        }
        self.counts = std::mem::take(&mut self.counts).plus(kept.part.counts.clone());
        // What is kept of the first pass alone comes from the part that has it.
        let earlier = kept.part.shards.first() < self.part.shards.first();
        kept.join(&mut self.film, earlier).map_err(|error| unreadable(file, error))?;
        if earlier {
            self.part = kept.part;
        }
        Ok(())
    }

    fn finish(mut self, allowed: bool) -> Result<Merged, MergeError> {
        let form = &self.part.form;
        let there = |shard: &u32| self.from.iter().any(|(known, _)| known == shard);
        let missing: Vec<u32> = (0..form.of).filter(|shard| !there(shard)).collect();
        if !missing.is_empty() && !allowed {
            return Err(MergeError::Invalid(format!(
                "of {} shards, {} not there; --allow-missing makes the image of those that are there",
                form.of,
                numbered(&missing)
            )));
        }
        let passes = self.film.most_passes();
        let accuracy = if form.by == By::Passes && !missing.is_empty() {
            self.film.accuracy_of_any_passes()
        } else {
            self.film.accuracy()
        };
        image::found(&mut self.provenance, &self.film, passes, &self.counts, accuracy.as_ref());
        if !missing.is_empty() {
            let stats = &mut self.provenance.stats;
            stats.insert("shardsMissing".to_owned(), missing.clone().into());
        }
        let bits = if form.png_bits == 16 { Bits::Sixteen } else { Bits::Eight };
        Ok(Merged {
            image: image::assemble(&self.film, &form.aovs()),
            png: PngSettings { exposure_ev: form.exposure_ev, bits },
            provenance: self.provenance,
            accuracy,
            health: self.counts.health,
            missing,
            of: form.of,
            passes,
        })
    }
}

/// `number 2 is`, `numbers 0-1, 4 are`.
pub fn numbered(numbers: &[u32]) -> String {
    match numbers {
        [one] => format!("number {one} is"),
        many => format!("numbers {} are", list(many)),
    }
}

/// Numbers as ranges: `0-2, 5`.
pub fn list(numbers: &[u32]) -> String {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for &n in numbers {
        match ranges.last_mut().filter(|range| range[1] + 1 == n) {
            Some(range) => range[1] = n,
            None => ranges.push([n, n]),
        }
    }
    let text = |[a, b]: &[u32; 2]| if a == b { a.to_string() } else { format!("{a}-{b}") };
    ranges.iter().map(text).collect::<Vec<_>>().join(", ")
}
