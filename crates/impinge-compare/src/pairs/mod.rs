//! The suite of pairs: two solids at a time, in all ways to be near, asked everything that there is to
//! ask. `f32`, one thread; times are nanoseconds per pair.
//!
//! Cases are each two of [`form::plane`] and of [`form::space`] in each [`regime::Regime`], 256
//! random placements of them. They are found with impinge: the second solid is moved along a direction
//! until the distance is that of the regime. Regimes that a pair cannot be in are left out, such as a
//! segment deep in another. Of two grounds the second is a patch of it, about 1 across.
//!
//! What a time covers:
//!
//! | question | impinge | parry | ncollide |
//! |---|---|---|---|
//! | distance | `distance` | `distance` | `distance` |
//! | contact | `contact` within 0.1 | `contact` | `contact` |
//! | proximity | `proximity` within 0 | `intersection_test` | `proximity` within 0 |
//! | time of impact | `impact` within 10 | `cast_shapes` | `time_of_impact` |
//! | manifold | `PairManifoldGenerator` | `contact_manifolds` | a generator of `DefaultContactDispatcher` |
//!
//! With the feature `coal` Coal runs in space as well, in `f64`: `ComputeDistance` for distances,
//! `ComputeCollision` with a security margin for contacts and proximity, `ComputeContactPatch` after it
//! for manifolds, all pairs in one call from C++. Warm searches begin with the last direction. It has no
//! time of impact, and throws for triangles.
//!
//! Left out: FCL, whose wheel can be asked for one pair at a time from Python alone, at a microsecond for
//! each call, and from whose library Coal came.
//!
//! Single calls are given both placements, in the world; parry's manifold is given the second one in
//! the frame of the first, and making it is part of the time. "impinge" is that call; its manifold is
//! kept as it is found, and made in the world's frame, with all that belongs to a contact, when it is read, which no
//! time covers. "impinge world" is the batch: a world
//! of all 256 pairs, far from one another, is told the placements of the second solids and updated, and
//! the time is a 256th of that. It includes the broad phase, whose boxes are so loose that
//! all pairs stay pairs in all regimes; it does not include reading the manifolds, which are as the
//! narrow phase keeps them until they are read. "impinge narrow phase" is the part of the same updates that
//! the narrow phase takes. "impinge reusing" is a world in which pairs keep their contacts while they have
//! moved by less than a twentieth of the prediction (warm solids alone are asked), as parry's do within
//! a degree and a thousandth; "impinge alone reusing" is a `PairManifoldGenerator` that does so; all else computes
//! everything anew.
//!
//! Manifolds are *cold* if nothing that was kept is of use: alone, each call begins with a new generator
//! (or an empty list of manifolds); in a world, all second solids jump between two sets of placements
//! that have nothing to do with each other. *Warm* solids move by a thousandth and turn by as many
//! radians at most between calls; *undisturbed* ones are told the same placement again.
//!
//! Answers are compared before a time is printed: distances, signed distances of contacts (in manifolds
//! of the deepest one), times of impact, each within 0.002, and whether solids touch unless they just
//! do. Rows are left out where a contender has no algorithm for a pair, or takes milliseconds for each; whoever
//! answers otherwise for more than half of the pairs is in the table, but no rival. Where there is a
//! target its row says what it is on this machine, which is compared by what the manifold of two balls
//! takes parry. In the end come the cases where impinge takes more than half of the time of its best rival.
//!
//! `kernels` runs so many rounds (`--steps`) of one contender (`--only`, its whole name) in the cases
//! selected, for instruction counters and profilers. Instructions per call are those collected divided
//! by the calls that it prints (see `bench/callgrind.md`):
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

/// Races all cases.
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

/// Runs, for an instruction counter, what is selected.
pub fn count(arguments: &Arguments) {
    each(&arguments.case, &mut |case, question, _, contenders| {
        let rounds = arguments.steps as usize;
        kernels::count(case, question, &arguments.only, contenders, rounds);
    });
}

/// What is done with each case of a question.
type Visit<'a> = &'a mut dyn FnMut(&str, Question, Regime, &mut Vec<Box<dyn Contender>>);

/// All cases whose name contains the text.
fn each(text: &str, visit: Visit<'_>) {
    each_of(&form::plane(), text, contest_in_plane, visit);
    each_of(&form::space(), text, contest_in_space, visit);
}

/// What it takes to hold a contest between two solids.
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

/// The placements of a case; says so if there are none.
fn poses<const D: usize>(pair: &Pair<D>, regime: Regime, judge: Judge<'_, D>) -> Option<Poses<D>> {
    let poses = regime::poses(pair, regime, judge);
    if poses.is_none() {
        println!("{} cannot be {}", pair.name, regime.name());
    }
    poses
}

/// How much slower this machine is than that of the targets.
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
