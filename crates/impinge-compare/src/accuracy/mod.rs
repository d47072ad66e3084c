//! The accuracy of results: `impinge-compare accuracy [samples]`.
//!
//! For every pair of kinds, scalar and regime, `samples` random samples are drawn. The distance,
//! depth and normal of each contender are compared with the reference of
//! `impinge_reference::precise`, which has about 25 digits.
//!
//! All numbers of a sample are representable in the scalar, and its rotations have unit length to
//! within a hundredth of the rounding error. So the input has no errors of its own: all errors are
//! those of the contenders, including their conversion of rotations to matrices. Samples for which
//! the reference cannot prove its result accurately enough are counted and omitted.

mod form;
mod judge;
mod ours;
mod parry;
mod sample;
mod table;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use impinge_reference::random::Random;

use form::{Ask, Kind, Scalar};
use judge::Errors;
use sample::{Dimension, Known, PLANE, Regime, SPACE, draw};

/// The contenders, in the order of the tables.
pub const CONTENDERS: [&str; 2] = ["impinge", "parry"];

/// The errors of both contenders for one pair of kinds, scalar and regime.
pub struct Row {
    dimension: usize,
    scalar: Scalar,
    kinds: [Kind; 2],
    regime: Regime,
    /// The number of samples for which the reference could not prove its result.
    dropped: usize,
    errors: [Errors; 2],
}

/// Draws the samples, prints a line for each row, and writes the tables.
pub fn run(samples: usize) {
    // A panic of a contender is counted as an error; its message is suppressed.
    std::panic::set_hook(Box::new(|_| {}));
    let mut rows = Vec::new();
    let plane32: [Ask<2>; 2] = [ours::plane::<f32>, parry::plane32::ask];
    let plane64: [Ask<2>; 2] = [ours::plane::<f64>, parry::plane64::ask];
    let space32: [Ask<3>; 2] = [ours::space::<f32>, parry::space32::ask];
    let space64: [Ask<3>; 2] = [ours::space::<f64>, parry::space64::ask];
    rows.extend(rows_of(PLANE, Kind::PLANE, [plane32, plane64], samples));
    rows.extend(rows_of(SPACE, Kind::SPACE, [space32, space64], samples));
    drop(std::panic::take_hook());
    match table::write(&rows, samples) {
        Ok(folder) => println!("\nwritten to {}", folder.display()),
        Err(error) => eprintln!("the tables could not be written: {error}"),
    }
}

/// A unit of work of a thread: all regimes of two kinds with one scalar.
struct Task {
    scalar: Scalar,
    kinds: [Kind; 2],
}

/// Computes the rows of all pairs of the given kinds on several threads. The number of threads has
/// no influence on the rows.
fn rows_of<const D: usize>(
    dimension: Dimension<D>,
    kinds: &[Kind],
    asks: [[Ask<D>; 2]; 2],
    samples: usize,
) -> Vec<Row> {
    let tasks = tasks(kinds);
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(task) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
            let asks = asks[usize::from(task.scalar == Scalar::F64)];
            for regime in Regime::ALL {
                let row = row(dimension, task, regime, asks, samples);
                table::print(&row);
                done.lock().expect("no thread panics").push(row);
            }
        }
    };
    thread::scope(|scope| {
        let count = thread::available_parallelism().map_or(1, usize::from);
        (0..count).for_each(|_| drop(scope.spawn(work)));
    });
    let mut rows = done.into_inner().expect("no thread panics");
    let place = |row: &Row| {
        let task = tasks.iter().position(|t| t.scalar == row.scalar && t.kinds == row.kinds);
        (task, row.regime as usize)
    };
    rows.sort_by_key(place);
    rows
}

fn tasks(kinds: &[Kind]) -> Vec<Task> {
    let mut tasks = Vec::new();
    for scalar in Scalar::ALL {
        for (index, &kind1) in kinds.iter().enumerate() {
            for &kind2 in &kinds[index..] {
                // A pair of half-spaces is omitted: it has no distance.
                if kind1 != Kind::HalfSpace {
                    tasks.push(Task { scalar, kinds: [kind1, kind2] });
                }
            }
        }
    }
    tasks
}

/// Draws and runs the samples of one row. The random numbers depend only on the row, not on the
/// order of the rows.
fn row<const D: usize>(
    dimension: Dimension<D>,
    task: &Task,
    regime: Regime,
    asks: [Ask<D>; 2],
    samples: usize,
) -> Row {
    let Task { scalar, kinds } = *task;
    let numbers = [D, scalar as usize, kinds[0] as usize, kinds[1] as usize, regime as usize];
    let seed = numbers.iter().fold(1, |seed, &number| seed * 31 + number as u64);
    let mut random = Random::new(seed);
    let mut row =
        Row { dimension: D, scalar, kinds, regime, dropped: 0, errors: Default::default() };
    let mut failures = 0;
    while row.errors[0].asked + row.dropped < samples && failures < 3 {
        let Some(mut known) = draw(dimension, kinds, regime, scalar, &mut random) else {
            failures += 1;
            continue;
        };
        if !known.truth.is_settled(scalar.epsilon() / 4.0) {
            row.dropped += 1;
            continue;
        }
        if random.chance(0.5) {
            known = known.swapped();
        }
        for (errors, ask) in row.errors.iter_mut().zip(asks) {
            errors.ask(ask, &known, scalar.epsilon());
        }
    }
    row
}

impl<const D: usize> Known<D> {
    /// Returns the sample with its solids swapped.
    fn swapped(mut self) -> Self {
        self.sample.forms.swap(0, 1);
        self.sample.placements.swap(0, 1);
        self.solids.swap(0, 1);
        self.poses.swap(0, 1);
        self.truth.normal = self.truth.normal.map(|x| -x);
        self
    }

    /// Returns `true` if a half-space is involved, so that only one normal is correct.
    fn is_of_half_space(&self) -> bool {
        self.sample.forms.iter().any(|form| matches!(form, form::Form::HalfSpace { .. }))
    }
}
