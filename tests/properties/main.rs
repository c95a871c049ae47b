//! Properties of whatever proptest thinks of: shapes, places, materials, rays, at scales from 1e-6 to 1e6.
//!
//! Cases are drawn from a fixed seed; `PROPTEST_CASES=10000` draws more of them. A failure prints the
//! smallest case that it was shrunk to.

mod describe;
mod intersection;
mod light;
mod optics;
mod photons;

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestRunner};

/// Holds a property against `cases` values of a strategy, or as many as the environment says.
fn hold<S: Strategy>(cases: u32, values: S, property: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    let said = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok());
    let config = Config {
        cases: said.unwrap_or(cases),
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..Config::default()
    };
    if let Err(failure) = TestRunner::new(config).run(&values, property) {
        panic!("{failure}");
    }
}
