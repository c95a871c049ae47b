//! Any bytes to the reader that tests/corpus/read.rs calls `open_exr`.
#![no_main]

#[allow(dead_code)]
#[path = "../../tests/corpus/read.rs"]
mod read;

libfuzzer_sys::fuzz_target!(
    // A panic of a decoder that its reader catches is an error like others; one that comes out is a finding.
    init: std::panic::set_hook(Box::new(|panic| eprintln!("{panic}"))),
    |bytes: &[u8]| read::open_exr(bytes)
);
