//! The suite of pairs: two solids at a time, at several distances, with all queries. The scalar is
//! `f32`, on one thread; times are nanoseconds per pair.
//!
//! A case is a pair of solids of [`form::plane`] or of [`form::space`] in a [`regime::Regime`],
//! with 256 random placements. The placements are found with impinge: the second solid is moved
//! along a direction until the distance is that of the regime. Impossible cases are omitted, such
//! as a segment deep inside another. If both solids are terrains, the second one is a patch about 1
//! across.
//!
//! The calls that a time covers:
//!
//! | question | impinge | parry | ncollide |
//! |---|---|---|---|
//! | distance | `distance` | `distance` | `distance` |
//! | contact | `contact` within 0.1 | `contact` | `contact` |
//! | proximity | `proximity` within 0 | `intersection_test` | `proximity` within 0 |
//! | time of impact | `impact` within 10 | `cast_shapes` | `time_of_impact` |
//! | manifold | `PairManifoldGenerator` | `contact_manifolds` | a generator of `DefaultContactDispatcher` |
//!
//! With the feature `coal` Coal runs in 3D as well, in `f64`: `ComputeDistance` for distances,
//! `ComputeCollision` with a security margin for contacts and proximity, `ComputeContactPatch`
//! after it for manifolds. All pairs are computed in one call from C++. Warm searches begin with
//! the last direction. Coal has no time of impact, and throws for triangles.
//!
//! FCL, the library from which Coal was forked, is omitted: its wheel computes one pair at a time
//! from Python, at a microsecond for each call.
//!
//! Single calls get both placements in the world frame. parry's manifold function gets the pose of
//! solid 2 in the frame of solid 1; computing this pose is part of its time. The contenders of
//! impinge are:
//!
//! - "impinge" makes single calls. Its manifold is stored in its internal form. Reading it, which
//!   builds all data of a contact in the world frame, is not timed.
//! - "impinge world" is a world that contains all 256 pairs, far from each other. It gets the
//!   placements of the second solids and is updated; the time is that of the update divided by 256.
//!   This time includes the broad phase, whose boxes are so large that all pairs stay pairs in all
//!   regimes. It does not include reading the manifolds.
//! - "impinge narrow phase" is the share of the narrow phase in these updates.
//! - "impinge reusing" is a world in which a pair keeps its contacts until it has moved by a
//!   twentieth of the prediction (warm solids only). parry does this too, up to a rotation of a
//!   degree and a translation of 0.001.
//! - "impinge alone reusing" is a `PairManifoldGenerator` with the same tolerance. All other
//!   contenders of impinge recompute everything.
//!
//! Manifolds are *cold* if no stored state is useful: single calls begin with a new generator (or
//! an empty list of manifolds); in a world, all second solids jump between two unrelated sets of
//! placements. *Warm* solids translate by at most 0.001 and rotate by at most 0.001 radians between
//! calls. *Undisturbed* solids keep their placements.
//!
//! Results are compared before a time is printed: distances, signed distances of contacts (for
//! manifolds the least one) and times of impact must agree within 0.002; whether solids overlap
//! must agree, except in the regime in which they just touch. The row of a contender is omitted if
//! it has no algorithm for a pair, or takes milliseconds for each pair. A contender whose results
//! differ for more than half of the pairs is in the table, but is no rival. If a case has a target,
//! its row has the target time scaled to this machine by the time of parry's manifold of two balls.
//! The cases in which impinge takes more than half of the time of its best rival are listed at the
//! end.
//!
//! `kernels` runs `--steps` rounds of one contender (`--only`, its whole name) in the selected
//! cases, for instruction counters and profilers. Instructions per call are those collected divided
//! by the printed number of calls (see `bench/callgrind.md`):
//!
//! ```text
//! valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='*kernels*counted*' target/release/impinge-compare kernels --steps 8 --case '3D cuboid, cuboid, stacked: manifold warm' --only 'impinge world'
//! ```

mod clocked;
#[cfg(feature = "coal")]
mod coal;
mod form;
mod kernels;
mod ncollide;
mod ours;
mod parry;
mod placement;
mod question;
mod race;
mod regime;
mod target;

use impinge::math::na::{UnitComplex, UnitQuaternion};

use form::Solid;
use question::{Contender, Question};
use race::race;
use regime::{Judge, Pair, Poses, Regime};
use target::{Verdicts, machine_scale, target};

use crate::Arguments;
use crate::table::{Row, Table};

/// Runs all selected cases and prints the comparison with the rivals.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("pairs", "ns");
    let mut verdicts = Verdicts::default();
    let rounds = arguments.steps as usize;
    std::panic::set_hook(Box::new(|_| {}));
    let scale = scale_of_this_machine();
    each(&arguments.case, &mut |case, question, regime, contenders| {
        contenders.retain(|one| one.name().contains(&arguments.only));
        let mut rows = race(case, question, regime, contenders, rounds);
        rows.extend(target(case, question, scale));
        verdicts.add(question, &rows);
        table.add(rows);
    });
    drop(std::panic::take_hook());
    verdicts.print();
    vec![table]
}

/// Runs the selected cases for an instruction counter.
pub fn count(arguments: &Arguments) {
    each(&arguments.case, &mut |case, question, _, contenders| {
        let rounds = arguments.steps as usize;
        kernels::count(case, question, &arguments.only, contenders, rounds);
    });
}

/// A callback for each case and question, with the contenders.
type Visit<'a> = &'a mut dyn FnMut(&str, Question, Regime, &mut Vec<Box<dyn Contender>>);

/// Calls `visit` for all cases whose name contains `text`.
fn each(text: &str, visit: Visit<'_>) {
    each_of(&form::plane(), text, contest_in_plane, visit);
    each_of(&form::space(), text, contest_in_space, visit);
}

/// Creates the contenders for a pair in a regime; `None` if the regime is impossible.
type Contest<const D: usize> = fn(&Pair<D>, Regime) -> Option<Vec<Box<dyn Contender>>>;

fn each_of<const D: usize>(solids: &[Solid<D>], text: &str, contest: Contest<D>, visit: Visit<'_>) {
    for pair in regime::pairs(solids) {
        for regime in Regime::ALL {
            let case = |question: Question| {
                format!("{}, {}: {}", pair.name, regime.name(), question.name())
            };
            let mut asked = Question::ALL.to_vec();
            asked.retain(|question| case(*question).contains(text));
            if asked.is_empty() {
                continue;
            }
            let Some(mut contenders) = contest(&pair, regime) else { continue };
            for question in asked {
                visit(&case(question), question, regime, &mut contenders);
            }
        }
    }
}

fn contest_in_plane(pair: &Pair<2>, regime: Regime) -> Option<Vec<Box<dyn Contender>>> {
    type Turn = UnitComplex<f32>;
    let poses = poses(pair, regime, &ours::judge::<Turn, 2>(pair))?;
    let mut contenders: Vec<Box<dyn Contender>> = vec![
        Box::new(ours::Alone::<Turn, 2>::new(pair, &poses)),
        Box::new(ours::Alone::<Turn, 2>::reusing(pair, &poses)),
        Box::new(ours::World::<Turn, 2>::new(pair, &poses)),
        Box::new(ours::World::<Turn, 2>::reusing(pair, &poses)),
    ];
    contenders.extend(boxed(parry::plane::Parry::new(pair, &poses)));
    contenders.extend(boxed(ncollide::plane::Ncollide::new(pair, &poses)));
    Some(contenders)
}

fn contest_in_space(pair: &Pair<3>, regime: Regime) -> Option<Vec<Box<dyn Contender>>> {
    type Turn = UnitQuaternion<f32>;
    let poses = poses(pair, regime, &ours::judge::<Turn, 3>(pair))?;
    let mut contenders: Vec<Box<dyn Contender>> = vec![
        Box::new(ours::Alone::<Turn, 3>::new(pair, &poses)),
        Box::new(ours::Alone::<Turn, 3>::reusing(pair, &poses)),
        Box::new(ours::World::<Turn, 3>::new(pair, &poses)),
        Box::new(ours::World::<Turn, 3>::reusing(pair, &poses)),
    ];
    contenders.extend(boxed(parry::space::Parry::new(pair, &poses)));
    contenders.extend(boxed(ncollide::space::Ncollide::new(pair, &poses)));
    #[cfg(feature = "coal")]
    contenders.extend(boxed(coal::Coal::new(pair, &poses)));
    Some(contenders)
}

fn boxed<C: Contender + 'static>(contender: Option<C>) -> Option<Box<dyn Contender>> {
    contender.map(|contender| Box::new(contender) as Box<dyn Contender>)
}

/// Returns the placements of a case. Prints a message and returns `None` if the regime is
/// impossible.
fn poses<const D: usize>(pair: &Pair<D>, regime: Regime, judge: Judge<'_, D>) -> Option<Poses<D>> {
    let poses = regime::poses(pair, regime, judge);
    if poses.is_none() {
        println!("{} cannot be {}", pair.name, regime.name());
    }
    poses
}

/// Returns the time of parry's manifold of two balls on this machine, divided by its time on the
/// machine on which the targets were set; NaN if parry has no row.
fn scale_of_this_machine() -> f64 {
    const ROUNDS: usize = 100;
    let mut scale = f64::NAN;
    each("3D ball, ball, shallow: manifold warm", &mut |case, question, regime, contenders| {
        let rows = race(case, question, regime, contenders, ROUNDS);
        let parry = rows.iter().find(|row: &&Row| row.contender == "parry");
        scale = parry.map_or(f64::NAN, |row| machine_scale(row.times.median()));
    });
    println!("this machine takes {scale:.2} of the time of that of the targets");
    scale
}
