//! Rivals side by side: the same scenes, the same questions, alternately in one process on one
//! thread.
//!
//! `impinge-compare SUITE... [--objects N] [--steps N] [--machine NAME]` prints the tables of the
//! suites named, or of all of them for `all`, and writes each to `bench/<machine>/<suite>.csv`;
//! `--case TEXT` and `--only TEXT` leave out cases and contenders whose names do not contain a text.
//! Before it prints a time it compares the answers: each row says by how many they differ from ours.
//! Times are those of the thread's processor, median, minimum and the ninetieth percentile.
//!
//! `impinge-compare accuracy [samples]` measures errors instead of times: see [`accuracy`].
//! `impinge-compare kernels` is for instruction counters: see [`pairs`].

mod accuracy;
mod measure;
mod pairs;
mod table;
mod world;

use table::Table;

/// A suite, by name.
type Suite = (&'static str, fn(&Arguments) -> Vec<Table>);

/// The suites, in the order in which `all` runs them.
const SUITES: &[Suite] = &[("world", world::run), ("pairs", pairs::run)];

/// What the command line asks for.
#[derive(Clone, Debug)]
pub struct Arguments {
    /// How many objects there are in scenes whose size is not part of the case.
    objects: usize,
    /// How many steps or rounds make a run.
    steps: u32,
    /// The folder below `bench/`.
    machine: String,
    /// Only the cases whose name contains this.
    case: String,
    /// Only the contenders whose name contains this.
    only: String,
    /// The suites asked for.
    suites: Vec<String>,
}

fn main() {
    if std::env::args().nth(1).as_deref() == Some("accuracy") {
        let samples = std::env::args().nth(2);
        let samples = samples.map(|word| word.parse().unwrap_or_else(|_| usage(&word)));
        accuracy::run(samples.unwrap_or(1000));
        return;
    }
    let arguments = arguments();
    if arguments.suites.iter().any(|suite| suite == "kernels") {
        pairs::count(&arguments);
        return;
    }
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
        steps: 100,
        machine: "local".to_owned(),
        case: String::new(),
        only: String::new(),
        suites: Vec::new(),
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| usage(&word));
        let number = |text: String| text.parse().unwrap_or_else(|_| usage(&text));
        match word.as_str() {
            "--objects" => arguments.objects = number(value()) as usize,
            "--steps" => arguments.steps = number(value()),
            "--machine" => arguments.machine = value(),
            "--case" => arguments.case = value(),
            "--only" => arguments.only = value(),
            "kernels" => arguments.suites.push(word),
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
    eprintln!("usage: impinge-compare SUITE... [--objects N] [--steps N] [--machine NAME]");
    eprintln!("           [--case TEXT] [--only TEXT]");
    eprintln!("       impinge-compare kernels --case TEXT --only CONTENDER");
    eprintln!("       impinge-compare accuracy [samples]");
    eprintln!("suites: all {}", suites.join(" "));
    std::process::exit(2)
}
