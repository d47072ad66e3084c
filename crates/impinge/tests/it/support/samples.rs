//! The number of samples of random and exhaustive tests, which an environment variable multiplies
//! for all tests.

/// Returns `some` times the value of the environment variable `IMPINGE_SAMPLES`, or `some` if it is
/// not set. The value is 10 in `.ci/run`, and 1000 for a run overnight.
///
/// # Panics
/// If the variable is not a whole number.
pub(crate) fn samples(some: usize) -> usize {
    some * times()
}

/// Returns the stride with which an exhaustive test walks its cases: `most` if `IMPINGE_SAMPLES` is
/// not set, and 1 if it is at least `most`. Choose a prime that does not divide the length of an
/// inner loop, so that each of its cases occurs in a walk with any stride.
///
/// # Panics
/// If the variable is not a whole number.
pub(crate) fn stride(most: usize) -> usize {
    most.div_ceil(times().max(1))
}

fn times() -> usize {
    let times = std::env::var("IMPINGE_SAMPLES").ok();
    times.map_or(1, |times| times.parse().expect("IMPINGE_SAMPLES is a whole number"))
}
