//! Searches for volumes, points and rays: the exact boxes as of the last update.

use super::PairFinder;
use crate::bounding_volume::{Aabb, BoundingVolume, Ray};
use crate::bvh::{Bounds, Frontier, Keys};
use crate::math::{Point, Real};

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// The objects whose exact box meets `aabb`, ascending.
    pub fn overlapping(&self, aabb: &Aabb<N, D>) -> Vec<u32> {
        let accept = |id: u32| self.exact[id as usize].intersects(aabb);
        self.accepted_in(&Bounds::enclosing(aabb), accept)
    }

    /// The objects whose exact box holds the point, ascending.
    pub fn containing(&self, point: &Point<N, D>) -> Vec<u32> {
        let accept = |id: u32| self.exact[id as usize].contains_point(point);
        self.accepted_in(&Bounds::enclosing_point(point), accept)
    }

    /// The objects whose exact box the ray meets, ascending.
    pub fn hit_by(&self, ray: &Ray<N, D>) -> Vec<u32> {
        let accept = |id: u32| self.exact[id as usize].intersects_ray(ray);
        let mut found = Vec::new();
        for tree in [&self.moving, &self.still] {
            tree.visit(
                |block| self.lanes.times_of_block(block, ray).0,
                |id| {
                    if accept(id) {
                        found.push(id);
                    }
                },
            );
        }
        self.with_unbounded(found, accept)
    }

    /// Calls `visit` with each object whose exact box the ray enters at or before `max_time` and
    /// the time of entry, in ascending order of (time, id); `visit` returns the new `max_time`.
    pub fn visit_ray(&self, ray: &Ray<N, D>, max_time: N, visit: &mut dyn FnMut(u32, N) -> N) {
        let entry = |id: u32| self.exact[id as usize].ray_interval(ray).map(|(enter, _)| enter);
        let mut frontier = Frontier::new();
        for &id in &self.unbounded {
            if let Some(time) = entry(id) {
                frontier.push_object(time, id);
            }
        }
        let times = |block: &_| self.lanes.times_of_block(block, ray);
        let keys = Keys { block: times, object: entry };
        frontier.search(&[&self.moving, &self.still], max_time, &keys, visit);
    }

    fn accepted_in(&self, query: &Bounds<D>, accept: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut found = Vec::new();
        for tree in [&self.moving, &self.still] {
            tree.visit_overlapping(query, |id| {
                if accept(id) {
                    found.push(id);
                }
            });
        }
        self.with_unbounded(found, accept)
    }

    fn with_unbounded(&self, mut found: Vec<u32>, accept: impl Fn(u32) -> bool) -> Vec<u32> {
        found.extend(self.unbounded.iter().copied().filter(|&id| accept(id)));
        found.sort_unstable();
        found
    }
}
