//! The number of samples of random tests, which an environment variable multiplies for all tests.

/// Returns `some` times the value of the environment variable `IMPINGE_SAMPLES`, or `some` if it is
/// not set. The value is 10 in `.ci/run`, and 1000 for a run overnight.
///
/// # Panics
/// If the variable is not a whole number.
pub(crate) fn samples(some: usize) -> usize {
    let times = std::env::var("IMPINGE_SAMPLES").ok();
    some * times.map_or(1, |times| times.parse().expect("IMPINGE_SAMPLES is a whole number"))
}
