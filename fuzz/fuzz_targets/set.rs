//! Any bytes to the reader that tests/corpus/read.rs calls `set`.
#![no_main]

#[allow(dead_code)]
#[path = "../../tests/corpus/read.rs"]
mod read;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| read::set(bytes));
