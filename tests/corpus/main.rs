//! Bytes for every reader: seeds to fuzz from, and what fuzzing has found, each file named for its defect.

mod read;

use std::path::Path;
use std::time::{Duration, Instant};

fn files(reader: &str) -> Vec<std::path::PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(reader);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files
}

/// No file makes its reader panic or takes it long.
#[test]
fn every_reader_stands_its_corpus() {
    for (name, reader) in read::READERS {
        let files = files(name);
        assert!(files.len() >= 3, "{name} has few seeds");
        for file in files {
            let bytes = std::fs::read(&file).expect("a file of the corpus");
            let began = Instant::now();
            reader(&bytes);
            let took = began.elapsed();
            assert!(took < Duration::from_secs(2), "{} takes {took:?}", file.display());
        }
    }
}

/// And none of what is cut off or changed in a byte or a few, as fuzzing would; more of it with
/// `CORPUS_MUTATIONS`.
#[test]
fn every_reader_stands_what_is_near_its_corpus() {
    use terrarium::math::random::{Counter, Stage};
    let said = std::env::var("CORPUS_MUTATIONS").ok().and_then(|n| n.parse().ok());
    let mutations: u64 = said.unwrap_or(40);
    for (item, (name, reader)) in (0..).zip(read::READERS) {
        let files: Vec<Vec<u8>> =
            files(name).iter().map(|file| std::fs::read(file).expect("a file of the corpus")).collect();
        let mut counter = Counter::new(9, Stage::Test, item);
        let mut below = |n: usize| ((counter.value() * n as f64) as usize).min(n.saturating_sub(1));
        for n in 0..mutations * files.len() as u64 {
            let mut bytes = files[n as usize % files.len()].clone();
            for _ in 0..=below(4) {
                mutate(&mut bytes, &files, &mut below);
            }
            let shown = bytes.clone();
            let outcome = std::panic::catch_unwind(|| reader(&bytes));
            if outcome.is_err() {
                let kept = std::env::temp_dir().join(format!("corpus-{name}-{n}"));
                std::fs::write(&kept, shown).expect("written");
                panic!("{name}: {} makes it panic", kept.display());
            }
        }
    }
}

/// A byte changed, removed, doubled or inserted, a stretch copied from elsewhere, or the end cut off.
fn mutate(bytes: &mut Vec<u8>, others: &[Vec<u8>], below: &mut impl FnMut(usize) -> usize) {
    const TELLING: &[u8] = b"\0\x01\x7f\x80\xff\n\"'()[]{},.:=-+/\\#eE0189 \t";
    let at = below(bytes.len());
    match (below(7), bytes.is_empty()) {
        (0, false) => bytes[at] ^= 1 << below(8),
        (1, false) => bytes[at] = TELLING[below(TELLING.len())],
        (2, false) => {
            bytes.remove(at);
        }
        (3, false) => bytes.truncate(at),
        (4, false) => {
            let (start, end) = (at, (at + 1 + below(24)).min(bytes.len()));
            let stretch = bytes[start..end].to_vec();
            bytes.splice(at..at, stretch);
        }
        (5, _) => {
            let other = &others[below(others.len())];
            let start = below(other.len());
            let end = (start + 1 + below(40)).min(other.len());
            bytes.splice(at..at, other[start..end].iter().copied());
        }
        _ => bytes.insert(at, TELLING[below(TELLING.len())]),
    }
}
