//! Compares the library of the working tree with that of an old commit, in the scenes of the suite
//! `world` of `impinge-compare`. Both versions are stepped alternately in one process on one
//! thread, in `f32`.
//!
//! `impinge-compare-old [--case TEXT] [--exact NAME] [--objects N] [--steps N] [--runs N]
//! [--reusing]` prints a line for each scene: the median and the worst step of both versions in
//! microseconds of processor time, and ratios old / new, above 1 where the working tree is faster.
//! A step sets all new positions, updates, and reads every contact point. The first step, in which
//! everything is new, is not timed.
//!
//! `--case` selects the scenes whose name contains a text, `--exact` the scene with that name.
//! `--runs` repeats each scene and keeps the minimum of each step, which removes most of the noise
//! of a busy machine. With `--reusing` the pairs of both versions keep their contacts while they
//! hardly move.
//!
//! `CONTRIBUTING.md` describes where the old commit must be.

mod arguments;
#[path = "../../impinge-compare/src/world/contender.rs"]
mod contender;
#[path = "../../impinge-compare/src/measure.rs"]
#[expect(dead_code, reason = "the other suites use the rest")]
mod measure;
mod new;
mod old;
#[path = "../../impinge-compare/src/world/stages.rs"]
mod stages;
#[path = "../../impinge-compare/src/table.rs"]
#[expect(dead_code, reason = "the other suites use the rest")]
mod table;

use arguments::Arguments;
use contender::{Contender, Entrant, race};
use impinge_scenes::Scene;
use measure::Times;
use stages::{Stage, plane_stages, space_stages, stages};
use table::Row;

/// A function that creates a world with the objects of a scene at step 0.
type Maker<const D: usize> = fn(&Scene<D>) -> Box<dyn Contender<D>>;

/// The constructors of the new version and of the old version.
const PLANE: [Maker<2>; 2] =
    [|scene| Box::new(new::plane(scene)), |scene| Box::new(old::plane(scene))];
const SPACE: [Maker<3>; 2] =
    [|scene| Box::new(new::space(scene)), |scene| Box::new(old::space(scene))];

/// The constructors of both versions with pairs that keep their contacts until they have moved by
/// half of the prediction.
const PLANE_REUSING: [Maker<2>; 2] =
    [|scene| Box::new(new::plane(scene).reusing()), |scene| Box::new(old::plane(scene).reusing())];
const SPACE_REUSING: [Maker<3>; 2] =
    [|scene| Box::new(new::space(scene).reusing()), |scene| Box::new(old::space(scene).reusing())];

fn main() {
    let arguments = Arguments::of_command_line();
    println!(
        "microseconds of processor time; ratios old / new, each the median over pairs of steps"
    );
    println!(
        "{:<36} {:>7} {:>9} {:>6} {:>10} {:>10} {:>10} {:>10} {:>7} {:>7} {:>7}",
        "scene",
        "objects",
        "touching",
        "differ",
        "old",
        "new",
        "worst old",
        "worst new",
        "ratio",
        "update",
        "reading"
    );
    let (plane, space) =
        if arguments.is_reusing { (PLANE_REUSING, SPACE_REUSING) } else { (PLANE, SPACE) };
    run_stages(plane, &stages(), &arguments);
    run_stages(plane, &plane_stages(), &arguments);
    run_stages(space, &stages(), &arguments);
    run_stages(space, &space_stages(), &arguments);
}

fn run_stages<const D: usize>(makers: [Maker<D>; 2], stages: &[Stage<D>], arguments: &Arguments) {
    for stage in stages {
        let name = format!("{} {D}D", stage.name);
        if !arguments.wants(&name) {
            continue;
        }
        let scene = stage.scene(arguments.objects, 0.0);
        let rows = rows(makers, &scene, arguments);
        print(&name, stage.count(arguments.objects), &rows);
    }
}

/// Runs a scene. Returns, for each kind of time, the row of the new version and that of the old
/// one.
fn rows<const D: usize>(
    makers: [Maker<D>; 2],
    scene: &Scene<D>,
    arguments: &Arguments,
) -> Vec<Row> {
    let cases = contender::KINDS.map(str::to_owned);
    let run = || {
        let [new, old] = makers.map(|make| make(scene));
        let entrants =
            vec![Entrant { name: "new", world: new }, Entrant { name: "old", world: old }];
        race(scene, entrants, arguments.steps, &cases)
    };
    let mut rows = run();
    for _ in 1..arguments.runs {
        rows.iter_mut()
            .zip(run())
            .for_each(|(row, again)| keep_minima(&mut row.times, &again.times));
    }
    rows
}

/// Replaces each time by the smaller one of both runs.
fn keep_minima(times: &mut Times, again: &Times) {
    times.0.iter_mut().zip(&again.0).for_each(|(time, again)| *time = time.min(*again));
}

/// Prints a line from the rows of the whole step, of the update and of reading. Each pair of rows
/// begins with the new version.
fn print(name: &str, count: usize, rows: &[Row]) {
    let [median, worst] = [50, 100].map(|percent| {
        [1, 0].map(|n: usize| format!("{:.1}", rows[n].times.quantile(percent) * 1e3))
    });
    let ratios = [0, 2, 4].map(|n| format!("{:.3}", ratio(&rows[n + 1].times, &rows[n].times)));
    println!(
        "{name:<36} {count:>7} {:>9} {:>6} {:>10} {:>10} {:>10} {:>10} {:>7} {:>7} {:>7}",
        rows[0].answers,
        rows[1].differ,
        median[0],
        median[1],
        worst[0],
        worst[1],
        ratios[0],
        ratios[1],
        ratios[2]
    );
}

/// Returns the median over pairs of consecutive steps of the ratio `old / new`; NaN for a single
/// step. The two versions ran within milliseconds of each other, so that a changing load of the
/// machine affects both.
///
/// Two consecutive steps are added, because the version that runs first in a step has colder
/// caches, and the order alternates.
fn ratio(old: &Times, new: &Times) -> f64 {
    let pairs = old.0.chunks_exact(2).zip(new.0.chunks_exact(2));
    let sum = |times: &[f64]| times.iter().sum::<f64>();
    Times(pairs.map(|(old, new)| sum(old) / sum(new)).collect()).median()
}
