//! Rivals side by side: the same scenes, the same questions, alternately in one process on one
//! thread.
//!
//! `impinge-compare SUITE... [--from N] [--objects N] [--steps N] [--machine NAME] [--alone]` prints the tables of the
//! suites named, or of all of them for `all`, and writes each to `bench/<machine>/<suite>.csv`.
//! Before it prints a time it compares the answers: each row says by how many they differ from ours.
//! Times are those of the thread's processor, median, minimum and the ninetieth percentile.
//!
//! `impinge-compare accuracy [samples]` measures errors instead of times: see [`accuracy`].

mod accuracy;
mod broad;
mod build;
mod measure;
mod scale;
mod table;
mod world;

use table::Table;

/// Counts the bytes of the suite `build`.
#[cfg(feature = "bytes")]
#[global_allocator]
static ALLOCATOR: &stats_alloc::StatsAlloc<std::alloc::System> = &stats_alloc::INSTRUMENTED_SYSTEM;

/// A suite, by name.
type Suite = (&'static str, fn(&Arguments) -> Vec<Table>);

/// The suites, in the order in which `all` runs them.
const SUITES: &[Suite] =
    &[("world", world::run), ("broad", broad::run), ("build", build::run), ("scale", scale::run)];

/// What the command line asks for.
#[derive(Clone, Debug)]
pub struct Arguments {
    /// How many objects there are in scenes whose size is not part of the case, and at most where it is.
    objects: usize,
    /// Cases of fewer objects are left out, where the size is part of the case.
    least: usize,
    /// How many steps or rounds make a run.
    steps: u32,
    /// The folder below `bench/`.
    machine: String,
    /// Whether impinge runs alone, for profilers; only `broad` and `scale` know how to.
    is_alone: bool,
    /// The suites asked for.
    suites: Vec<String>,
}

impl Arguments {
    /// Whether a case of so many objects is among those asked for.
    fn includes(&self, objects: usize) -> bool {
        (self.least..=self.objects).contains(&objects)
    }
}

fn main() {
    if std::env::args().nth(1).as_deref() == Some("accuracy") {
        let samples = std::env::args().nth(2);
        let samples = samples.map(|word| word.parse().unwrap_or_else(|_| usage(&word)));
        accuracy::run(samples.unwrap_or(1000));
        return;
    }
    let arguments = arguments();
    let is_wanted =
        |name: &str| arguments.suites.iter().any(|wanted| wanted == "all" || wanted == name);
    for (_, run) in SUITES.iter().filter(|(name, _)| is_wanted(name)) {
        for table in run(&arguments) {
            match table.write(&arguments.machine) {
                Ok(path) => println!("written to {}", path.display()),
                Err(error) => eprintln!("the table could not be written: {error}"),
            }
        }
    }
}

fn arguments() -> Arguments {
    let mut arguments = Arguments {
        objects: 10_000,
        least: 0,
        steps: 100,
        machine: "local".to_owned(),
        is_alone: false,
        suites: Vec::new(),
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| usage(&word));
        let number = |text: String| text.parse().unwrap_or_else(|_| usage(&text));
        match word.as_str() {
            "--objects" => arguments.objects = number(value()) as usize,
            "--from" => arguments.least = number(value()) as usize,
            "--steps" => arguments.steps = number(value()),
            "--alone" => arguments.is_alone = true,
            "--machine" => arguments.machine = value(),
            name if name == "all" || SUITES.iter().any(|suite| suite.0 == name) => {
                arguments.suites.push(word);
            }
            other => usage(other),
        }
    }
    if arguments.suites.is_empty() {
        usage("nothing");
    }
    arguments
}

fn usage(word: &str) -> ! {
    let suites: Vec<_> = SUITES.iter().map(|suite| suite.0).collect();
    eprintln!("{word} is not understood");
    eprintln!(
        "usage: impinge-compare SUITE... [--objects N] [--steps N] [--machine NAME] [--alone]"
    );
    eprintln!("       impinge-compare accuracy [samples]");
    eprintln!("suites: all {}", suites.join(" "));
    std::process::exit(2)
}
