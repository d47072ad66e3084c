//! The suite of broad phases. Every contender gets the new boxes of moved objects, updates, and
//! lists the changes; this is timed, in milliseconds per step. All contenders with fat AABBs use a
//! margin of 0.05.
//!
//! Results are pairs of overlapping fat AABBs. Their number depends on the rules by which a
//! contender enlarges boxes, so the pairs of two correct contenders may differ. `compare` in
//! `contender.rs` defines which pairs count as wrong. Contenders without events do less work than
//! the others, since they do not report which pairs started and stopped.

mod contender;
mod obvhs_tree;
mod ours;
#[allow(clippy::duplicate_mod, reason = "one source for the crates of both dimensions")]
mod plane;
mod rebuilt;
#[allow(clippy::duplicate_mod, reason = "one source for the crates of both dimensions")]
mod space;
pub mod swarm;

use impinge::math::Space;

use crate::Arguments;
use crate::table::Table;
pub use contender::{Contender, Contenders, MARGIN, key, race};
pub use obvhs_tree::{Obvhs, aabb as obvhs_aabb};
pub use ours::{Impinge, aabb};
use rebuilt::Rebuilt;
pub use rebuilt::leaves;
pub use space::{Ncollide, Parry, Rapier};
use swarm::{Cell, Kind, Plan, Swarm};

/// The default plan: boxes of similar sizes, all of which move fast, with indices in random order.
pub const FAST: Plan =
    Plan { kind: Kind::Alike, count: 0, stride: 1, pace: 0.05, is_sorted: false, replaced: 0 };

/// The largest number of boxes for which the slow rivals run.
const FEW: usize = 10_000;

/// Runs all cases up to the requested number of boxes.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("broad", "ms");
    let fits = |plan: &Plan| arguments.includes(plan.count);
    for (words, plan) in cases_of_space().into_iter().filter(|(_, plan)| fits(plan)) {
        run_case::<3>(&format!("3D {words}"), plan, in_space, arguments, &mut table);
    }
    for (words, plan) in cases_of_plane().into_iter().filter(|(_, plan)| fits(plan)) {
        run_case::<2>(&format!("2D {words}"), plan, in_plane, arguments, &mut table);
    }
    vec![table]
}

fn cases_of_space() -> Vec<(String, Plan)> {
    let slow = Plan { pace: 0.01, ..FAST };
    let named = [
        ("fast", FAST),
        ("slow", slow),
        ("10 % fast", Plan { stride: 10, ..FAST }),
        ("1 % fast", Plan { stride: 100, ..FAST }),
        ("sorted ids", Plan { is_sorted: true, ..FAST }),
        ("mixed sizes", Plan { kind: Kind::Mixed, ..FAST }),
        ("pile", Plan { kind: Kind::Pile, ..FAST }),
    ];
    let usual = [1_000, 10_000, 100_000, 1_000_000];
    let sized = |(words, plan): &(&str, Plan), count| {
        (format!("{words}, {count}"), Plan { count, ..*plan })
    };
    let moving = named[..4].iter().flat_map(|named| usual.map(|count| sized(named, count)));
    let sorted = named[4..5].iter().flat_map(|named| usual[2..].iter().map(|n| sized(named, *n)));
    let other = named[5..].iter().flat_map(|named| usual[1..3].iter().map(|n| sized(named, *n)));
    let born = usual[1..3].iter().map(|&count| {
        (format!("1 % replaced, {count}"), Plan { count, replaced: count / 100, ..FAST })
    });
    moving.chain(sorted).chain(other).chain(born).collect()
}

fn cases_of_plane() -> Vec<(String, Plan)> {
    let strides = [("fast", 1), ("10 % fast", 10), ("1 % fast", 100)];
    let sized = |(words, stride): (&str, usize)| {
        let plan = Plan { stride, ..FAST };
        [10_000, 100_000].map(|count| (format!("{words}, {count}"), Plan { count, ..plan }))
    };
    strides.into_iter().flat_map(sized).collect()
}

fn run_case<const D: usize>(
    case: &str,
    plan: Plan,
    rivals: fn(&[Cell<D>]) -> Contenders<D>,
    arguments: &Arguments,
    table: &mut Table,
) where
    f32: Space<D>,
{
    let mut swarm = Swarm::new(plan);
    let mut contenders: Contenders<D> = vec![Box::new(Impinge::new(&swarm.cells))];
    if !arguments.is_alone() {
        contenders.extend(rivals(&swarm.cells));
    }
    let steps = arguments.steps.min(steps(plan.count, arguments.is_alone()));
    table.add(race(case, &mut swarm, &mut contenders, steps));
}

/// Returns the largest number of timed steps of a case. Large cases run few steps, unless impinge
/// runs alone.
fn steps(count: usize, is_alone: bool) -> u32 {
    match count {
        _ if is_alone => u32::MAX,
        ..20_000 => 100,
        20_000..200_000 => 12,
        _ => 5,
    }
}

fn in_plane(cells: &[Cell<2>]) -> Contenders<2> {
    let mut rivals: Contenders<2> = vec![
        Box::new(plane::Rapier::new(cells, false)),
        Box::new(plane::Rapier::new(cells, true)),
        Box::new(plane::Parry::new(cells)),
        Box::new(Obvhs::new(cells)),
    ];
    if cells.len() <= FEW {
        rivals.extend(rebuilt_ones(cells));
        rivals.push(Box::new(plane::Ncollide::new(cells)));
    }
    rivals
}

fn in_space(cells: &[Cell<3>]) -> Contenders<3> {
    let mut rivals: Contenders<3> = vec![
        Box::new(Rapier::new(cells, false)),
        Box::new(Rapier::new(cells, true)),
        Box::new(Parry::new(cells)),
        Box::new(Obvhs::new(cells)),
    ];
    if cells.len() <= FEW {
        rivals.extend(rebuilt_ones(cells));
        rivals.push(Box::new(Ncollide::new(cells)));
    }
    rivals
}

fn rebuilt_ones<const D: usize>(cells: &[Cell<D>]) -> Contenders<D> {
    vec![Box::new(Rebuilt::rstar(cells)), Box::new(Rebuilt::bvh(cells))]
}
