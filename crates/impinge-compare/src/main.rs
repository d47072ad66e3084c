//! Benchmarks against other libraries: the same scenes and the same queries, alternately in one
//! process on one thread.
//!
//! `impinge-compare SUITE... [--objects N] [--steps N] [--machine NAME]` prints the tables of the
//! named suites, or of all of them for `all`, and writes each to `bench/<machine>/<suite>.csv`.
//! Before it prints a time it compares the results: each row has the number of results that differ
//! from those of impinge. Times are processor times of the thread: median, minimum and the
//! ninetieth percentile.
//!
//! `--only` selects the contenders whose name contains a text, so that one contender can be
//! profiled alone. `--case` selects the cases whose name contains a text, `--from` the cases with
//! at least this number of objects. `--angular` gives the scenes of the suite `world` an angular
//! prediction, in radians. With any of these options the tables are incomplete or have other
//! settings, and are not written.
//!
//! Run it twice, compiled for the default target CPU of Rust and for the CPU of the machine:
//!
//! ```text
//! cargo run --release --features c -- all --machine NAME
//! RUSTFLAGS='-C target-cpu=native' cargo run --release --features c -- all --machine NAME-native
//! ```
//!
//! The feature `c` adds the rivals in C and C++, see [`world`]; `bytes` counts memory, see
//! [`build`]; `parallel` adds the runs on two threads, see [`scale`]. `impinge-compare accuracy
//! [samples]` measures errors instead of times, see [`accuracy`]; `impinge-compare kernels` is for
//! instruction counters, see [`pairs`].

mod accuracy;
mod arguments;
mod batch;
mod broad;
mod build;
mod measure;
mod pairs;
mod queries;
mod scale;
mod stacks;
mod table;
mod world;

use arguments::{Arguments, usage};
use table::Table;

/// The allocator that counts the bytes of the suite `build`.
#[cfg(feature = "bytes")]
#[global_allocator]
static ALLOCATOR: &stats_alloc::StatsAlloc<std::alloc::System> = &stats_alloc::INSTRUMENTED_SYSTEM;

/// The name of a suite, and the function that runs it.
type Suite = (&'static str, fn(&Arguments) -> Vec<Table>);

/// The suites, in the order in which `all` runs them.
const SUITES: &[Suite] = &[
    ("broad", broad::run),
    ("world", world::run),
    ("pairs", pairs::run),
    ("queries", queries::run),
    ("batch", batch::run),
    ("build", build::run),
    ("scale", scale::run),
    ("stacks", stacks::run),
];

fn main() {
    let names = SUITES.iter().map(|suite| suite.0);
    let known: Vec<_> = names.chain(["all", "kernels", "accuracy"]).collect();
    if std::env::args().nth(1).as_deref() == Some("accuracy") {
        let samples = std::env::args().nth(2);
        let samples = samples.map(|word| word.parse().unwrap_or_else(|_| usage(&word, &known)));
        return accuracy::run(samples.unwrap_or(1000));
    }
    let arguments = Arguments::of_command_line(&known);
    if arguments.suites.iter().any(|suite| suite == "kernels") {
        return pairs::count(&arguments);
    }
    for (_, run) in SUITES.iter().filter(|(name, _)| arguments.wants_suite(name)) {
        for table in run(&arguments).into_iter().filter(|_| arguments.is_whole()) {
            match table.write(&arguments.machine) {
                Ok(path) => println!("written to {}", path.display()),
                Err(error) => eprintln!("the table could not be written: {error}"),
            }
        }
    }
}
