//! The suite of stacks: the stability of one solver with the contacts of impinge and of parry, and
//! the persistence of these contacts.
//!
//! The scenes, the solver and the measurements are those of `impinge-stacks`: 600 steps of 1/60 s,
//! 10 iterations (more in scenes of tall stacks), warm starts. Contacts of impinge are matched by
//! their ids. parry transfers the data of a point to the next manifold itself, by the pairs of
//! features or by position, as it does for rapier; here the data is the id. The broad phase of this
//! contender compares all pairs of boxes, which is fast for so few solids.
//!
//! The second table shakes the upper of two solids a thousand times. Both tables are also written
//! to `bench/<machine>/stacks.csv` and `stacks-shaken.csv`. `--case` selects scenes by name,
//! `--only` a contender.

mod parry;

use std::fs;
use std::path::Path;

use impinge_stacks::{
    Choices, ContactSource, Counts, Impinge, Memory, Outcome, Solver, Stack, Stage, pairs2, pairs3,
    play, shake, stacks2, stacks3,
};

use crate::Arguments;
use crate::table::Table;

/// The number of steps of a scene.
const STEPS: usize = 600;
/// The number of shakes of the upper of two solids. [`WAYS`] lists the amplitudes of the shakes.
const SHAKES: usize = 1000;
const WAYS: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// Prints and writes both tables. Returns no table, since the numbers are not times.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut rest = Lines::new("scene", &Outcome::default().columns());
    for stack in stacks3().iter().filter(|stack| arguments.wants_case(stack.name)) {
        played(stack, arguments, parry::space::Parry::new, &mut rest);
    }
    for stack in stacks2().iter().filter(|stack| arguments.wants_case(stack.name)) {
        played(stack, arguments, parry::plane::Parry::new, &mut rest);
    }
    rest.write(arguments, "stacks");
    let mut shaken = Lines::new("pair, way", &Counts::default().columns());
    for pair in pairs3().iter().filter(|pair| arguments.wants_case(pair.name)) {
        shaken_by(pair, arguments, parry::space::Parry::new, &mut shaken);
    }
    for pair in pairs2().iter().filter(|pair| arguments.wants_case(pair.name)) {
        shaken_by(pair, arguments, parry::plane::Parry::new, &mut shaken);
    }
    shaken.write(arguments, "stacks-shaken");
    Vec::new()
}

fn played<const D: usize, P: ContactSource<f32, D>>(
    stack: &Stack<D>,
    arguments: &Arguments,
    parry: fn(&Stack<D>) -> P,
    lines: &mut Lines,
) where
    f32: Stage<D>,
{
    if arguments.wants_contender("impinge") {
        let mut ours = Impinge::<f32, D>::new(stack, Choices::default());
        let outcome = play(stack, &mut ours, Solver::new(Memory::by_ids()), STEPS);
        lines.add(stack.name, "impinge", &outcome.columns());
    }
    if arguments.wants_contender("parry") {
        let outcome = play(stack, &mut parry(stack), Solver::new(Memory::by_ids()), STEPS);
        lines.add(stack.name, "parry", &outcome.columns());
    }
}

fn shaken_by<const D: usize, P: ContactSource<f32, D>>(
    pair: &Stack<D>,
    arguments: &Arguments,
    parry: fn(&Stack<D>) -> P,
    lines: &mut Lines,
) where
    f32: Stage<D>,
{
    for way in WAYS {
        let case = format!("{}, {way:.0e}", pair.name);
        if arguments.wants_contender("impinge") {
            let mut ours = Impinge::<f32, D>::new(pair, Choices::default());
            lines.add(&case, "impinge", &shake(pair, &mut ours, way, SHAKES).columns());
        }
        if arguments.wants_contender("parry") {
            lines.add(&case, "parry", &shake(pair, &mut parry(pair), way, SHAKES).columns());
        }
    }
}

/// The name of a column, and its value in a row.
type Column = (&'static str, String);

/// The lines of a table, collected for the CSV file.
struct Lines(Vec<String>);

impl Lines {
    /// Creates a table and prints its head.
    fn new(case: &str, columns: &[Column]) -> Self {
        let names = columns.iter().map(|(name, _)| format!("{name:>9}"));
        println!("\n{case:<40} {:<10}{}", "contender", names.collect::<String>());
        let names = columns.iter().map(|(name, _)| format!(",{name}"));
        Self(vec![format!("case,contender{}", names.collect::<String>())])
    }

    fn add(&mut self, case: &str, contender: &str, columns: &[Column]) {
        let numbers = columns.iter().map(|(_, number)| format!("{number:>9}"));
        println!("{case:<40} {contender:<10}{}", numbers.collect::<String>());
        let numbers = columns.iter().map(|(_, number)| format!(",{number}"));
        self.0.push(format!("\"{case}\",{contender}{}", numbers.collect::<String>()));
    }

    /// Writes `bench/<machine>/<name>.csv`, if the table is complete.
    fn write(&self, arguments: &Arguments, name: &str) {
        if !arguments.is_whole() {
            return;
        }
        let bench = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bench");
        let folder = bench.join(&arguments.machine);
        let path = folder.join(format!("{name}.csv"));
        let text = self.0.join("\n") + "\n";
        match fs::create_dir_all(folder).and_then(|()| fs::write(&path, text)) {
            Ok(()) => println!("written to {}", path.display()),
            Err(error) => eprintln!("the table could not be written: {error}"),
        }
    }
}
