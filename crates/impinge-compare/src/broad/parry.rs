//! The tree of parry alone, used as in rapier. Leaves are enlarged, the tree is optimized
//! incrementally at each step and refitted, and pairs are listed if one of their boxes left its fat
//! AABB. This contender does not derive which pairs started and stopped.

use super::parry::bounding_volume::Aabb;
use super::parry::math::Vector;
use super::parry::partitioning::{Bvh, BvhBuildStrategy, BvhLeafUpdateStatus, BvhWorkspace};

use super::D;
use crate::broad::contender::{Contender, MARGIN, key};
use crate::broad::swarm::{Cell, Change};

/// A tree of parry.
pub struct Parry {
    tree: Bvh,
    workspace: BvhWorkspace,
    candidates: Vec<(u32, u32)>,
}

impl Parry {
    /// Builds a tree of the boxes.
    pub fn new(cells: &[Cell<D>]) -> Self {
        let leaves: Vec<_> = cells.iter().map(|cell| aabb(cell, MARGIN)).collect();
        Self {
            tree: Bvh::from_leaves(BvhBuildStrategy::default(), &leaves),
            workspace: BvhWorkspace::default(),
            candidates: Vec::new(),
        }
    }
}

fn aabb(cell: &Cell<D>, margin: f32) -> Aabb {
    Aabb::new(
        Vector::from(cell.mins()) - Vector::splat(margin),
        Vector::from(cell.maxs()) + Vector::splat(margin),
    )
}

impl Contender<D> for Parry {
    fn name(&self) -> &'static str {
        "parry (no events)"
    }

    fn step(&mut self, change: &Change<D>) {
        let Self { tree, workspace, candidates } = self;
        candidates.clear();
        for (n, _) in &change.replaced {
            tree.remove(*n);
        }
        let mut updated = 0;
        for (n, cell) in change.replaced.iter().chain(&change.moved) {
            let status = tree.insert_or_update_partially(aabb(cell, 0.0), *n, MARGIN);
            updated += usize::from(status != BvhLeafUpdateStatus::Unchanged);
        }
        // rapier skips the optimization if few boxes leave their fat AABBs; it then has other ways
        // to keep the quality of the tree.
        if updated * 16 >= tree.leaf_count() as usize {
            tree.optimize_incremental(workspace);
        }
        tree.refit(workspace);
        tree.traverse_bvtt_single_tree::<true>(workspace, &mut |a, b| candidates.push((a, b)));
    }

    fn pairs(&mut self) -> Vec<u64> {
        let mut pairs = Vec::new();
        let mut push = |a, b| pairs.push(key(a, b));
        self.tree.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut push);
        pairs
    }
}
