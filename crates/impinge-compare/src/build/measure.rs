//! Measures the time to build structures, or the bytes that they keep allocated, and compares their
//! results.

use crate::measure::Times;
#[cfg(not(feature = "bytes"))]
use crate::measure::timed;
use crate::table::Row;

/// Runs queries on a built structure and returns the results, each encoded as a number.
pub type Answer<'a> = Box<dyn FnMut() -> Vec<u64> + 'a>;

/// A contender: its name, and its constructor.
pub struct Maker<'a> {
    /// The name in the table.
    pub name: &'static str,
    /// Builds the structure; this call is measured.
    pub make: Box<dyn Fn() -> Answer<'a> + 'a>,
}

impl<'a> Maker<'a> {
    /// Creates a contender.
    pub fn new(name: &'static str, make: impl Fn() -> Answer<'a> + 'a) -> Self {
        Self { name, make: Box::new(make) }
    }
}

/// The unit of the measured times.
#[cfg(not(feature = "bytes"))]
pub const UNIT: &str = "ms";
/// The unit of the counted memory.
#[cfg(feature = "bytes")]
pub const UNIT: &str = "bytes_per_object";

#[cfg(not(feature = "bytes"))]
fn measured<R>(_count: usize, work: impl FnOnce() -> R) -> (f64, R) {
    let (time, result) = timed(work);
    (time * 1e-6, result)
}

#[cfg(feature = "bytes")]
fn measured<R>(count: usize, work: impl FnOnce() -> R) -> (f64, R) {
    let region = stats_alloc::Region::new(crate::ALLOCATOR);
    let result = work();
    let change = region.change();
    let bytes = change.bytes_allocated as f64 - change.bytes_deallocated as f64;
    (bytes / count as f64, result)
}

/// Runs the constructors in turn for several rounds. In the first round the results of each
/// contender are compared with those of the first one: results that only one of the two has count
/// as different.
pub fn measure(case: &str, count: usize, makers: &[Maker<'_>]) -> Vec<Row> {
    let rounds = match count {
        _ if UNIT != "ms" => 1,
        ..50_000 => 15,
        50_000..300_000 => 7,
        _ => 3,
    };
    let mut rows: Vec<Row> = makers.iter().map(|maker| row(case, maker)).collect();
    let mut first: Vec<u64> = Vec::new();
    for round in 0..rounds {
        // In round 0, in which results are compared, the order begins with the first contender.
        for n in (0..makers.len()).map(|n| (n + round) % makers.len()) {
            let (value, mut answer) = measured(count, || (makers[n].make)());
            rows[n].times.push(value);
            if round == 0 {
                let answers = sorted(answer());
                if n == 0 {
                    first.clone_from(&answers);
                }
                rows[n].answers = answers.len();
                rows[n].differ = missing(&first, &answers) + missing(&answers, &first);
            }
        }
    }
    rows
}

fn row(case: &str, maker: &Maker<'_>) -> Row {
    let (case, contender) = (case.to_owned(), maker.name.to_owned());
    Row { case, contender, answers: 0, differ: 0, times: Times::default() }
}

fn sorted(mut answers: Vec<u64>) -> Vec<u64> {
    answers.sort_unstable();
    answers
}

/// Returns the number of elements of `of` that are not in `from`.
fn missing(from: &[u64], of: &[u64]) -> usize {
    of.iter().filter(|answer| from.binary_search(answer).is_err()).count()
}
