//! Rivals side by side: the same scenes, the same questions, stepped alternately in one process on
//! one thread.
//!
//! `impinge-compare [objects [steps [machine]]]` prints a table and writes it to
//! `bench/<machine>/compare.csv`. Per step, each contender is told the new poses of what moved,
//! updates, and reads every contact point; only this is timed, by the processor time of the thread.
//! Looking up the poses and converting them is not. On every tenth step the touching pairs of both
//! are compared, and the table says by how many they differ: a time for another answer is no time.
//!
//! `impinge-compare accuracy [samples]` measures errors instead of times: see [`accuracy`].
//!
//! Both sides use `f32`, the same prediction and as good as the same loosening of boxes.

mod accuracy;
mod contender;
mod ours;
mod rapier2;
mod rapier3;
mod report;

use contender::{Contender, race};
use impinge_scenes::{Scene, SceneQuery, few_moving, mixed_shapes, pile, sparse_drift};
use report::{Row, print_header, print_rows, write_csv};

/// Two objects whose distance is at most this have contact points: the sum of what the objects of
/// the scenes ask for.
const PREDICTION: f32 = 0.002;

/// What the command line asks for.
struct Arguments {
    objects: usize,
    steps: u32,
    machine: String,
}

fn main() {
    if std::env::args().nth(1).as_deref() == Some("accuracy") {
        let samples = std::env::args().nth(2);
        let samples = samples.map(|word| word.parse().unwrap_or_else(|_| usage(&word)));
        accuracy::run(samples.unwrap_or(1000));
        return;
    }
    let arguments = arguments();
    print_header(&arguments);
    let n = arguments.objects;
    let mut rows = Vec::new();
    for scene in scenes::<2>(n) {
        let rival = rapier2::Rapier::new(&scene);
        run(&scene, &mut ours::plane(&scene), rival, &arguments, &mut rows);
    }
    for scene in scenes::<3>(n) {
        let rival = rapier3::Rapier::new(&scene);
        run(&scene, &mut ours::space(&scene), rival, &arguments, &mut rows);
    }
    match write_csv(&arguments.machine, &rows) {
        Ok(path) => println!("\nwritten to {}", path.display()),
        Err(error) => eprintln!("the table could not be written: {error}"),
    }
}

/// The scenes, all of which ask for contacts with the same prediction: rapier has one for all.
fn scenes<const D: usize>(n: usize) -> [Scene<D>; 4] {
    let linear = f64::from(PREDICTION) / 2.0;
    let mut scenes = [pile(n), sparse_drift(n), few_moving(n), mixed_shapes(n)];
    for object in scenes.iter_mut().flat_map(|scene| &mut scene.objects) {
        object.query = SceneQuery::Contacts { linear, angular: 0.0 };
    }
    scenes
}

/// Runs one scene, prints its part of the table and keeps it.
fn run<const D: usize>(
    scene: &Scene<D>,
    ours: &mut dyn Contender<D>,
    mut rival: impl Contender<D>,
    arguments: &Arguments,
    rows: &mut Vec<Row>,
) {
    let result = race(scene, [ours, &mut rival], arguments.steps);
    let found = Row::of(scene, &result);
    print_rows(&found);
    rows.extend(found);
}

fn arguments() -> Arguments {
    let mut words = std::env::args().skip(1);
    let mut number = |default: u32| match words.next() {
        Some(word) => word.parse().unwrap_or_else(|_| usage(&word)),
        None => default,
    };
    let (objects, steps) = (number(10_000), number(100));
    let machine = words.next().unwrap_or_else(|| "local".to_owned());
    Arguments { objects: objects as usize, steps, machine }
}

fn usage(word: &str) -> ! {
    eprintln!("{word} is not a number\nusage: impinge-compare [objects [steps [machine]]]\n       impinge-compare accuracy [samples]");
    std::process::exit(2)
}
