//! Searches with exact boxes: trees of `f32` boxes propose candidates, tests of the exact boxes
//! decide.

use crate::bounding_volume::{Aabb, BoundingVolume, Ray};
use crate::bvh::{Block, Bounds, Frontier, GROUP, Gaps, Keys, LANES, Lanes, Slabs, Tree};
use crate::math::{Point, Real, Vector, min};

/// Exact boxes by id, and the trees over them. Each id in use is either in one of the trees, with a
/// box that encloses its exact box, or in the list of unbounded boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search<'a, N: Real, const D: usize, const TREES: usize> {
    pub(crate) exact: &'a [Aabb<N, D>],
    pub(crate) trees: [&'a Tree<D>; TREES],
    pub(crate) unbounded: &'a [u32],
    pub(crate) lanes: Lanes,
}

/// A box that moves with constant velocity, without rotating, from time zero on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sweep<N: Real, const D: usize> {
    /// The box at time zero.
    pub(crate) aabb: Aabb<N, D>,
    pub(crate) velocity: Vector<N, D>,
}

impl<N: Real, const D: usize> Sweep<N, D> {
    /// Returns the sweep of a point along the ray.
    pub(crate) fn along(ray: &Ray<N, D>) -> Self {
        Self { aabb: Aabb::at(ray.origin), velocity: ray.dir }
    }
}

impl<N: Real, const D: usize, const TREES: usize> Search<'_, N, D, TREES> {
    /// Calls `found` with each object whose box overlaps `aabb`, in unspecified order.
    pub(crate) fn each_overlapping(&self, aabb: &Aabb<N, D>, found: impl FnMut(u32)) {
        self.each_within(&Bounds::enclosing(aabb), |own| own.intersects(aabb), found);
    }

    /// Calls `found` with each object whose box contains the point, in unspecified order.
    pub(crate) fn each_containing(&self, point: &Point<N, D>, found: impl FnMut(u32)) {
        let query = Bounds::enclosing_point(point);
        self.each_within(&query, |own| own.contains_point(point), found);
    }

    fn each_within(
        &self,
        query: &Bounds<D>,
        accept: impl Fn(&Aabb<N, D>) -> bool,
        found: impl FnMut(u32),
    ) {
        let mut propose = self.accepted(accept, found);
        for tree in self.trees {
            tree.visit_overlapping(query, &mut propose);
        }
        self.unbounded.iter().copied().for_each(propose);
    }

    /// Calls `found` with each object whose box the ray meets, in unspecified order. A ray that is
    /// not finite meets nothing.
    pub(crate) fn each_hit(&self, ray: &Ray<N, D>, found: impl FnMut(u32)) {
        let Sweep { aabb, velocity } = Sweep::along(ray);
        if !is_finite(ray) {
            return;
        }
        let mut propose = self.accepted(|own| own.intersects_ray(ray), found);
        for tree in self.trees {
            let test = |block: &Block<D>| self.lanes.times_of_block(block, &aabb, &velocity).0;
            tree.visit(test, &mut propose);
        }
        self.unbounded.iter().copied().for_each(propose);
    }

    /// Returns a function that calls `found` only for ids whose exact box passes `accept`.
    fn accepted(
        &self,
        accept: impl Fn(&Aabb<N, D>) -> bool,
        mut found: impl FnMut(u32),
    ) -> impl FnMut(u32) {
        move |id| {
            if accept(&self.exact[id as usize]) {
                found(id);
            }
        }
    }

    /// Calls `found` with the id of each object whose box the moving box touches at or before
    /// `limit`, and the first time of contact, in ascending order of (time, id). `found` returns
    /// the new limit, which must not increase. Finds nothing if the velocity is not finite or the
    /// moving box has no finite point, such as the box of a ray with an infinite origin.
    pub(crate) fn by_time(&self, sweep: &Sweep<N, D>, limit: N, found: impl FnMut(u32, N) -> N) {
        let Sweep { aabb, velocity } = sweep;
        if !aabb.holds_finite_point() || !velocity.iter().all(|x| x.is_finite_number()) {
            return;
        }
        let enter = |own: &Aabb<N, D>| own.sweep_interval(aabb, velocity).map(|(enter, _)| enter);
        let keys = Keys {
            block: |block: &Block<D>| self.lanes.times_of_block(block, aabb, velocity),
            object: |id: u32| enter(&self.exact[id as usize]),
        };
        self.best_first(limit, &keys, found);
    }

    /// Calls `found` with the id of each object whose box is at most `limit` from `aabb`, and its
    /// distance, in ascending order of (distance, id). `found` returns the new limit, which must
    /// not increase. A box without a finite point is near nothing.
    pub(crate) fn by_distance(&self, aabb: &Aabb<N, D>, limit: N, found: impl FnMut(u32, N) -> N) {
        if !aabb.holds_finite_point() {
            return;
        }
        let keys = Keys {
            block: |block: &Block<D>| self.lanes.distance_of_block(block, aabb),
            object: |id: u32| Some(self.exact[id as usize].distance_to_aabb(aabb)),
        };
        self.best_first(limit, &keys, found);
    }

    /// Calls `found` with the objects and times that [`Self::by_time`] finds, but only roughly by
    /// ascending time. `found` returns the new limit, which must not increase.
    pub(crate) fn near_first(&self, sweep: &Sweep<N, D>, limit: N, found: impl FnMut(u32, N) -> N) {
        let Some(slabs) = self.slabs(sweep) else { return };
        let Sweep { aabb, velocity } = sweep;
        let enter = |own: &Aabb<N, D>| own.sweep_interval(aabb, velocity).map(|(enter, _)| enter);
        let mut within = self.within(limit, enter, found);
        let first = self.unbounded.iter().fold(limit, |_, &id| within(id));
        self.lanes.visit_along(&self.trees, &slabs, slabs.limit(first), |near| {
            slabs.limit(near.iter().fold(limit, |_, &(id, _)| within(id)))
        });
    }

    /// Calls `found` with the objects and distances that [`Self::by_distance`] finds, but only
    /// roughly by ascending distance. `found` returns the new limit, which must not increase.
    pub(crate) fn nearest_first(
        &self,
        aabb: &Aabb<N, D>,
        limit: N,
        found: impl FnMut(u32, N) -> N,
    ) {
        if !aabb.holds_finite_point() {
            return;
        }
        let distance = |own: &Aabb<N, D>| Some(own.distance_to_aabb(aabb));
        let mut within = self.within(limit, distance, found);
        let gaps = Gaps::new(aabb, self.size());
        let first = self.unbounded.iter().fold(limit, |_, &id| within(id));
        self.lanes.visit_around(&self.trees, &gaps, gaps.limit(first), |near| {
            gaps.limit(near.iter().fold(limit, |_, &(id, _)| within(id)))
        });
    }

    /// Calls `found` with groups of the objects that the moving box may touch by `limit`, roughly
    /// by ascending time. Each object comes with a lower bound of its time. `found` returns the new
    /// limit; a limit above the previous one has no effect. The exact boxes are not tested, since
    /// the callers test the objects themselves.
    pub(crate) fn groups_by_time(
        &self,
        sweep: &Sweep<N, D>,
        limit: N,
        mut found: impl FnMut(&[(u32, N)]) -> N,
    ) {
        let Some(slabs) = self.slabs(sweep) else { return };
        let mut lowest = self.first_unbounded(limit, &mut found);
        let first = slabs.limit(lowest);
        self.lanes.visit_along(&self.trees, &slabs, first, |proposed| {
            let (group, count) = converted(proposed, |key| slabs.time(key));
            lowest = min(lowest, found(&group[..count]));
            slabs.limit(lowest)
        });
    }

    /// Calls `found` with groups of the objects that may be at most `limit` from `aabb`, roughly by
    /// ascending distance. Each object comes with a lower bound of its distance. `found` returns
    /// the new limit; a limit above the previous one has no effect. The exact boxes are not tested.
    pub(crate) fn groups_by_distance(
        &self,
        aabb: &Aabb<N, D>,
        limit: N,
        mut found: impl FnMut(&[(u32, N)]) -> N,
    ) {
        if !aabb.holds_finite_point() {
            return;
        }
        let mut lowest = self.first_unbounded(limit, &mut found);
        let gaps = Gaps::new(aabb, self.size());
        let first = gaps.limit(lowest);
        self.lanes.visit_around(&self.trees, &gaps, first, |proposed| {
            let (group, count) = converted(proposed, |key| gaps.distance(key));
            lowest = min(lowest, found(&group[..count]));
            gaps.limit(lowest)
        });
    }

    /// Calls `found` with groups of the unbounded objects, with zero as the lower bound of each
    /// object. Returns the new limit.
    fn first_unbounded(&self, limit: N, found: &mut impl FnMut(&[(u32, N)]) -> N) -> N {
        self.unbounded.chunks(GROUP).fold(limit, |limit, ids| {
            let mut group = [(0, N::ZERO); GROUP];
            for (one, &id) in group.iter_mut().zip(ids) {
                one.0 = id;
            }
            min(limit, found(&group[..ids.len()]))
        })
    }

    /// Prepares the moving box for slab tests; `None` if its velocity is not finite or the box has
    /// no finite point.
    fn slabs(&self, sweep: &Sweep<N, D>) -> Option<Slabs<D>> {
        let Sweep { aabb, velocity } = sweep;
        let is_path = velocity.iter().all(|x| x.is_finite_number());
        let moves = is_path && aabb.holds_finite_point();
        moves.then(|| Slabs::new(aabb, velocity, self.size()))
    }

    /// Returns a function that calls `found` with an id only if the key of the id's exact box is at
    /// most the current limit. The function returns the new limit.
    fn within(
        &self,
        limit: N,
        key: impl Fn(&Aabb<N, D>) -> Option<N>,
        mut found: impl FnMut(u32, N) -> N,
    ) -> impl FnMut(u32) -> N {
        let mut lowest = limit;
        move |id| {
            if let Some(key) = key(&self.exact[id as usize]).filter(|key| *key <= lowest) {
                lowest = min(lowest, found(id, key));
            }
            lowest
        }
    }

    /// Returns the largest magnitude of a coordinate in the trees; rounding errors are proportional
    /// to it.
    fn size(&self) -> f32 {
        self.trees.iter().map(|tree| tree.size()).fold(0.0, f32::max)
    }

    fn best_first(
        &self,
        limit: N,
        keys: &Keys<impl Fn(&Block<D>) -> (u32, [N; LANES]), impl Fn(u32) -> Option<N>>,
        mut found: impl FnMut(u32, N) -> N,
    ) {
        let mut frontier = Frontier::new();
        for &id in self.unbounded {
            if let Some(key) = (keys.object)(id) {
                frontier.push_object(key, id);
            }
        }
        // The frontier drops objects beyond an earlier limit, so the limit must not grow. A NaN
        // limit passes through `min`, and ends the search.
        let mut lowest = limit;
        let lowered = |id: u32, key: N| {
            lowest = min(lowest, found(id, key));
            lowest
        };
        frontier.search(&self.trees, limit, keys, lowered);
    }
}

/// The box with the least key (a time or a distance) so far, and its key; at equal keys the box
/// with the lowest index.
pub(super) struct Best<N: Real> {
    pub(super) of: Option<(usize, N)>,
    limit: N,
}

impl<N: Real> Best<N> {
    pub(super) const fn none(limit: N) -> Self {
        Self { of: None, limit }
    }

    /// Considers a box within the limit. Returns the new limit: the least key so far.
    pub(super) fn offer(&mut self, id: u32, key: N) -> N {
        let index = id as usize;
        if self.of.is_none_or(|(best, least)| key < least || (key == least && index < best)) {
            (self.of, self.limit) = (Some((index, key)), key);
        }
        self.limit
    }
}

/// Converts the keys of a group of at most [`GROUP`] objects; returns the group and its length.
#[inline(always)]
fn converted<N: Real>(
    proposed: &[(u32, f32)],
    key: impl Fn(f32) -> N,
) -> ([(u32, N); GROUP], usize) {
    let mut group = [(0, N::ZERO); GROUP];
    for (one, &(id, bound)) in group.iter_mut().zip(proposed) {
        *one = (id, key(bound));
    }
    (group, proposed.len())
}

fn is_finite<N: Real, const D: usize>(ray: &Ray<N, D>) -> bool {
    ray.origin.iter().chain(ray.dir.iter()).all(|x| x.is_finite_number())
}
