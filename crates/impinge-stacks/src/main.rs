//! Prints two tables that measure how well impinge's contacts support stacks.
//!
//! ```text
//! cargo run --release -p impinge-stacks --no-default-features -- [WORD...] [OPTION...]
//!
//!   WORD          run only scenes and pairs whose name contains WORD; "table1", "table2": a table
//!   --points N    keep at most N points per manifold instead of the default
//!   --reuse X     reuse contacts of pairs within the tolerance X
//!   --by-place    find old impulses by the nearest old point, not by contact id
//!   --one-way     take contacts in the same order in all iterations
//!   --steps N     simulate N steps per scene instead of 600
//!   --f64         compute in f64 (not with --no-default-features)
//! ```

#![forbid(unsafe_code)]
#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge_stacks::{
    Choices, Counts, Impinge, Kind, Memory, Outcome, Solver, Stack, Stage, pairs2, pairs3, play,
    shake, stacks2, stacks3,
};

/// The options of the command line.
#[derive(Default)]
struct Arguments {
    words: Vec<String>,
    choices: Choices,
    is_by_place: bool,
    is_one_way: bool,
    is_double: bool,
    steps: Option<usize>,
}

fn main() {
    let Some(arguments) = read() else {
        println!("[WORD...] [--points N] [--reuse X] [--by-place] [--one-way] [--steps N] [--f64]");
        println!("words choose scenes by name; table1 and table2 choose a table");
        return;
    };
    #[cfg(feature = "f64")]
    if arguments.is_double {
        return tables::<f64>(&arguments);
    }
    tables::<f32>(&arguments);
}

/// Parses the words of the command line; `None` if a word is unknown.
fn read() -> Option<Arguments> {
    let mut arguments = Arguments::default();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--points" => arguments.choices.max_points = Some(words.next()?.parse().ok()?),
            "--reuse" => arguments.choices.reuse = Some(words.next()?.parse().ok()?),
            "--steps" => arguments.steps = Some(words.next()?.parse().ok()?),
            "--one-way" => arguments.is_one_way = true,
            "--by-place" => arguments.is_by_place = true,
            "--f64" if cfg!(feature = "f64") => arguments.is_double = true,
            option if option.starts_with("--") => return None,
            _ => arguments.words.push(word),
        }
    }
    Some(arguments)
}

impl Arguments {
    fn wants(&self, table: &str, name: &str) -> bool {
        let (tables, words): (Vec<_>, Vec<_>) =
            self.words.iter().partition(|word| word.starts_with("table"));
        (tables.is_empty() || tables.iter().any(|wanted| *wanted == table))
            && (words.is_empty() || words.iter().any(|word| name.contains(word.as_str())))
    }
}

fn tables<N: Stage<2> + Stage<3>>(arguments: &Arguments) {
    let head = Outcome::default().columns().map(|(name, _)| format!("{name:>9}"));
    println!("{:<32}{}", "scene", head.join(""));
    for stack in stacks3().iter().filter(|stack| arguments.wants("table1", stack.name)) {
        rest::<N, 3>(stack, arguments);
    }
    for stack in stacks2().iter().filter(|stack| arguments.wants("table1", stack.name)) {
        rest::<N, 2>(stack, arguments);
    }
    let head = Counts::default().columns().map(|(name, _)| format!("{name:>9}"));
    println!("\n{:<32}{} | by 1e-4 | by 1e-3", "pair, shaken by 1e-5", head.join(""));
    for pair in pairs3().iter().filter(|pair| arguments.wants("table2", pair.name)) {
        shaken::<N, 3>(pair, arguments);
    }
    for pair in pairs2().iter().filter(|pair| arguments.wants("table2", pair.name)) {
        shaken::<N, 2>(pair, arguments);
    }
}

fn rest<N: Stage<D>, const D: usize>(stack: &Stack<D>, arguments: &Arguments) {
    let mut source = Impinge::<N, D>::new(stack, arguments.choices);
    let memory = if arguments.is_by_place { Memory::by_place() } else { Memory::by_ids() };
    let solver = Solver { alternates: !arguments.is_one_way, ..Solver::new(memory) };
    let outcome = play(stack, &mut source, solver, arguments.steps.unwrap_or(600));
    let cells = outcome.columns().map(|(_, number)| format!("{number:>9}"));
    let has_fallen = stack.kind == Kind::Rest && (outcome.sunk > 0.4 || outcome.drift > 0.4);
    println!("{:<32}{}{}", stack.name, cells.join(""), if has_fallen { "  fell" } else { "" });
}

fn shaken<N: Stage<D>, const D: usize>(pair: &Stack<D>, arguments: &Arguments) {
    let cells = [1e-5, 1e-4, 1e-3].map(|way| {
        let mut source = Impinge::<N, D>::new(pair, arguments.choices);
        let counts = shake(pair, &mut source, way, 1000);
        counts.columns().map(|(_, number)| format!("{number:>9}")).join("")
    });
    println!("{:<32}{}", pair.name, cells.join(" |"));
}
