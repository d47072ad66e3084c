//! Number of samples of a test, decided here for all tests.

/// `some` samples, times the value of the variable `IMPINGE_SAMPLES`: 10 in `.ci/run`, 1000 for a
/// run overnight.
///
/// # Panics
/// If the variable is not a whole number.
pub(crate) fn samples(some: usize) -> usize {
    let times = std::env::var("IMPINGE_SAMPLES").ok();
    some * times.map_or(1, |times| times.parse().expect("IMPINGE_SAMPLES is a whole number"))
}
