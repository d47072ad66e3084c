//! The implementation of [`PartSearch`] for the box tree.

use crate::bounding_volume::Aabb;
use crate::math::{Space, Vector};
use crate::partitioning::entries;
use crate::partitioning::{BoxTree, Sweep};
use crate::shape::PartSearch;

impl<N: Space<D>, const D: usize> PartSearch<N, D> for BoxTree<N, D> {
    fn bounds(&self) -> Aabb<N, D> {
        Self::bounds(self).copied().unwrap_or_else(Aabb::unbounded)
    }

    fn as_tree(&self) -> Option<&Self> {
        Some(self)
    }

    fn overlapping(&self, aabb: &Aabb<N, D>, visit: &mut dyn FnMut(u32)) {
        self.visit_overlapping(aabb, |index| visit(number(index)));
    }

    fn nearest(&self, aabb: &Aabb<N, D>, limit: N, visit: &mut dyn FnMut(u32, N) -> N) {
        entries::nearest_first(self, aabb, limit, visit);
    }

    fn cast(
        &self,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        let sweep = Sweep { aabb: *aabb, velocity: *velocity };
        entries::near_first(self, &sweep, limit, visit);
    }
}

/// Converts a box index to 32 bits; a tree has fewer than 2³² boxes.
fn number(index: usize) -> u32 {
    u32::try_from(index).expect("a tree has fewer than 2^32 boxes")
}
