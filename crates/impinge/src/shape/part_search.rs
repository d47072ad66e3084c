//! The tree over boxes as the search of a composite.

use super::PartSearch;
use crate::bounding_volume::{Aabb, Ray};
use crate::math::{Space, Vector, max, min};
use crate::partitioning::BoxTree;

impl<N: Space<D>, const D: usize> PartSearch<N, D> for BoxTree<N, D> {
    fn bounds(&self) -> Aabb<N, D> {
        BoxTree::bounds(self).copied().unwrap_or_else(Aabb::unbounded)
    }

    fn overlapping(&self, aabb: &Aabb<N, D>, visit: &mut dyn FnMut(u32)) {
        self.visit_overlapping(aabb, |index| visit(number(index)));
    }

    fn nearest(&self, aabb: &Aabb<N, D>, limit: N, visit: &mut dyn FnMut(u32, N) -> N) {
        let mut lowest = limit;
        for (index, own) in self.boxes().iter().enumerate() {
            let mut squared = N::ZERO;
            for axis in 0..D {
                let below = max(own.mins()[axis] - aabb.maxs()[axis], N::ZERO);
                let above = max(aabb.mins()[axis] - own.maxs()[axis], N::ZERO);
                squared += (below + above) * (below + above);
            }
            if squared.sqrt() <= lowest {
                lowest = min(lowest, visit(number(index), squared.sqrt()));
            }
        }
    }

    fn cast(
        &self,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        let mut lowest = limit;
        let (half, ray) = (aabb.half_extents(), Ray::new(aabb.center(), *velocity));
        for (index, own) in self.boxes().iter().enumerate() {
            let grown = Aabb::new(own.mins() - half, own.maxs() + half);
            if let Some((enter, _)) = grown.ray_interval(&ray).filter(|(enter, _)| *enter <= lowest)
            {
                lowest = min(lowest, visit(number(index), enter));
            }
        }
    }
}

/// A tree numbers its boxes with 32 bits.
fn number(index: usize) -> u32 {
    u32::try_from(index).expect("a tree has fewer than 2^32 boxes")
}
