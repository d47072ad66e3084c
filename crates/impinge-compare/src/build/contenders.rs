//! Contenders that build trees of boxes, broad phases and worlds.

use bvh::aabb::Aabb as BvhAabb;
use bvh::bvh::Bvh;
use impinge::math::na::Point;
use impinge::partitioning::BoxTree;
use impinge_reference::random::Random;
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2;
use parry3d::partitioning::{Bvh as ParryBvh, BvhBuildStrategy};
use rstar::{AABB, RTree};

use super::measure::{Answer, Maker};
use super::world::{self, World, certainly_touching};
use crate::broad::swarm::{Cell, Change};
use crate::broad::{Contender, Impinge, Ncollide, Rapier, aabb, leaves, obvhs_aabb};

/// The number of box queries by which trees are compared.
const QUESTIONS: usize = 1000;

/// Returns the query boxes: boxes of the tree drawn at random, with half extents enlarged by half.
pub fn questions(cells: &[Cell<3>]) -> Vec<Cell<3>> {
    let mut random = Random::new(9);
    let any = (0..QUESTIONS).map(|_| cells[random.below(cells.len())]);
    any.map(|cell| Cell { half: cell.half.map(|x| x * 1.5), ..cell }).collect()
}

/// Returns a function that runs all box queries with the candidates of `propose`. Trees may return
/// candidates that do not overlap the query box; the function removes them.
pub fn ask<'a>(
    cells: &'a [Cell<3>],
    mut propose: impl FnMut(&Cell<3>, &mut Vec<u32>) + 'a,
) -> Answer<'a> {
    Box::new(move || {
        let mut answers = Vec::new();
        for (n, question) in (0_u64..).zip(questions(cells)) {
            let mut proposed = Vec::new();
            propose(&question, &mut proposed);
            proposed.retain(|other| cells[*other as usize].gap(&question) <= 0.0);
            answers.extend(proposed.into_iter().map(|other| n << 32 | u64::from(other)));
        }
        answers
    })
}

/// Converts a box to an AABB of parry.
pub fn parry_aabb(cell: &Cell<3>) -> parry3d::bounding_volume::Aabb {
    parry3d::bounding_volume::Aabb::new(cell.mins().into(), cell.maxs().into())
}

/// Returns the contenders that build trees of boxes. Variants of one library are sorted from the
/// fastest build to the best tree. With more than 200,000 boxes `bvh` and `rstar` are omitted.
pub fn boxes(cells: &[Cell<3>]) -> Vec<Maker<'_>> {
    let mut makers = vec![
        Maker::new("impinge BoxTree", || ours(cells)),
        Maker::new("parry binned", || parry(cells, BvhBuildStrategy::Binned)),
        Maker::new("parry ploc", || parry(cells, BvhBuildStrategy::Ploc)),
        Maker::new("obvhs fastest", || obvhs(cells, BvhBuildParams::fastest_build())),
        Maker::new("obvhs fast", || obvhs(cells, BvhBuildParams::fast_build())),
        Maker::new("obvhs medium", || obvhs(cells, BvhBuildParams::medium_build())),
        Maker::new("bvh", || by_bvh(cells)),
        Maker::new("rstar", || rstar(cells)),
    ];
    makers.truncate(if cells.len() > 200_000 { 6 } else { 8 });
    makers
}

fn ours(cells: &[Cell<3>]) -> Answer<'_> {
    let boxes: Vec<_> = cells.iter().map(aabb).collect();
    let tree = BoxTree::<f32, 3>::from_boxes(&boxes);
    drop(boxes);
    ask(cells, move |question, found| {
        found.extend(tree.overlapping(&aabb(question)).into_iter().map(|n| n as u32));
    })
}

fn parry(cells: &[Cell<3>], strategy: BvhBuildStrategy) -> Answer<'_> {
    let leaves = cells.iter().map(parry_aabb).enumerate();
    let tree = ParryBvh::from_iter(strategy, leaves);
    ask(cells, move |question, found| found.extend(tree.intersect_aabb(&parry_aabb(question))))
}

fn obvhs(cells: &[Cell<3>], params: BvhBuildParams) -> Answer<'_> {
    let boxes: Vec<_> = cells.iter().map(|cell| obvhs_aabb(cell, 0.0)).collect();
    let tree = build_bvh2(&boxes, params, &mut std::time::Duration::default());
    drop(boxes);
    ask(cells, move |question, found| {
        tree.aabb_traverse(obvhs_aabb(question, 0.0), |tree, node| {
            let node = &tree.nodes[node as usize];
            let leaves = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            found.extend(&tree.primitive_indices[leaves]);
            true
        });
    })
}

fn by_bvh(cells: &[Cell<3>]) -> Answer<'_> {
    let mut leaves = leaves(cells);
    let tree = Bvh::build(&mut leaves);
    ask(cells, move |question, found| {
        let query =
            BvhAabb::with_bounds(Point::from(question.mins()), Point::from(question.maxs()));
        found.extend(tree.traverse_iterator(&query, &leaves).map(|leaf| leaf.number()));
    })
}

fn rstar(cells: &[Cell<3>]) -> Answer<'_> {
    let tree = RTree::bulk_load(leaves(cells));
    ask(cells, move |question, found| {
        let envelope = AABB::from_corners(question.mins(), question.maxs());
        let met = tree.locate_in_envelope_intersecting(envelope);
        found.extend(met.map(|leaf| leaf.number()));
    })
}

/// Returns the contenders that build broad phases and find all pairs. With more than 200,000 boxes
/// `ncollide` is omitted.
pub fn phases(cells: &[Cell<3>]) -> Vec<Maker<'_>> {
    let mut makers = vec![
        Maker::new("impinge", || phase(cells, Impinge::new(cells))),
        Maker::new("rapier", || phase(cells, Rapier::new(cells, false))),
        Maker::new("rapier set_aabb", || phase(cells, Rapier::new(cells, true))),
        Maker::new("ncollide", || phase(cells, Ncollide::new(cells))),
    ];
    makers.truncate(if cells.len() > 200_000 { 3 } else { 4 });
    makers
}

/// Runs the first step of a broad phase; the results are its overlapping pairs.
fn phase<'a>(cells: &'a [Cell<3>], mut phase: impl Contender<3> + 'a) -> Answer<'a> {
    phase.step(&Change::default());
    Box::new(move || {
        phase.settle(&Change::default());
        let mut pairs = phase.pairs();
        let cell = |n: u64| &cells[n as usize];
        pairs.retain(|key| cell(key >> 32).gap(cell(key & 0xffff_ffff)) <= 0.0);
        pairs
    })
}

/// Returns the contenders that build worlds and compute all contacts. With more than 200,000 boxes
/// `ncollide` is omitted.
pub fn worlds(cells: &[Cell<3>]) -> Vec<Maker<'_>> {
    let mut makers = vec![
        Maker::new("impinge", || filled(cells, world::Ours::new())),
        Maker::new("rapier", || filled(cells, world::Rapier::new())),
        Maker::new("ncollide", || filled(cells, world::Ncollide::new())),
    ];
    makers.truncate(if cells.len() > 200_000 { 2 } else { 3 });
    makers
}

fn filled<'a>(cells: &'a [Cell<3>], mut world: impl World + 'a) -> Answer<'a> {
    for cell in cells {
        world.add(cell);
    }
    world.step(&[]);
    Box::new(move || certainly_touching(&world, cells))
}
