//! Any bytes to the reader that tests/corpus/read.rs calls `scene_toml`.
#![no_main]

#[allow(dead_code)]
#[path = "../../tests/corpus/read.rs"]
mod read;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| read::scene_toml(bytes));
