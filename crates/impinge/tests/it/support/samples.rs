//! How much a test by samples tries: decided here for all of them.

/// `some` samples, or as many times that as the variable `IMPINGE_SAMPLES` says: 10 in `.ci/run`, 1000 for a night.
///
/// # Panics
/// If the variable is not a whole number.
pub(crate) fn samples(some: usize) -> usize {
    let times = std::env::var("IMPINGE_SAMPLES").ok();
    some * times.map_or(1, |times| times.parse().expect("IMPINGE_SAMPLES is a whole number"))
}
