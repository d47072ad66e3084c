//! Searches with boxes, moving boxes, points and rays, as of the last update: among the exact boxes
//! or, in the functions named `*_roughly`, among the loosened boxes.

use super::PairFinder;
use crate::bounding_volume::{Aabb, Ray};
use crate::math::{Point, Real};
use crate::partitioning::{Search, Sweep};

/// Receives a group of objects with their keys, and returns the new limit of the search.
type VisitGroup<'a, N> = dyn FnMut(&[(u32, N)]) -> N + 'a;

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Returns the ids of the objects whose exact box overlaps `aabb`, ascending.
    pub fn overlapping(&self, aabb: &Aabb<N, D>) -> Vec<u32> {
        let mut found = Vec::new();
        self.search().each_overlapping(aabb, |id| found.push(id));
        ascending(found)
    }

    /// Returns the ids of the objects whose exact box contains the point, ascending.
    pub fn containing(&self, point: &Point<N, D>) -> Vec<u32> {
        let mut found = Vec::new();
        self.search().each_containing(point, |id| found.push(id));
        ascending(found)
    }

    /// Returns the ids of the objects whose exact box the ray hits, ascending. A ray with a
    /// coordinate that is not finite hits nothing.
    pub fn hit_by(&self, ray: &Ray<N, D>) -> Vec<u32> {
        let mut found = Vec::new();
        self.search().each_hit(ray, |id| found.push(id));
        ascending(found)
    }

    /// Calls `visit` with the id of each object whose exact box the ray enters at or before
    /// `max_time`, and the time of entry, in ascending order of (time, id). `visit` returns the new
    /// `max_time`, which must not increase.
    pub fn visit_ray(&self, ray: &Ray<N, D>, max_time: N, visit: &mut dyn FnMut(u32, N) -> N) {
        self.search().by_time(&Sweep::along(ray), max_time, visit);
    }

    /// Calls `visit` with groups of objects whose loosened box the ray may enter by `max_time`,
    /// roughly by ascending time; exact boxes are not tested. Keys are lower bounds of the times of
    /// entry. `visit` returns the new `max_time`.
    pub fn visit_ray_roughly(&self, ray: &Ray<N, D>, max_time: N, visit: &mut VisitGroup<'_, N>) {
        self.search().groups_by_time(&Sweep::along(ray), max_time, visit);
    }

    /// Calls `visit` with the id of each object whose exact box is at most `max_distance` from
    /// `aabb`, and the distance, in ascending order of (distance, id). `visit` returns the new
    /// `max_distance`, which must not increase.
    pub fn visit_nearest(
        &self,
        aabb: &Aabb<N, D>,
        max_distance: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        self.search().by_distance(aabb, max_distance, visit);
    }

    /// Calls `visit` with groups of objects whose loosened box may be within `max_distance` of
    /// `aabb`, roughly by ascending distance; exact boxes are not tested. Keys are lower bounds of
    /// the distances. `visit` returns the new `max_distance`.
    pub fn visit_nearest_roughly(
        &self,
        aabb: &Aabb<N, D>,
        max_distance: N,
        visit: &mut VisitGroup<'_, N>,
    ) {
        self.search().groups_by_distance(aabb, max_distance, visit);
    }

    /// Calls `visit` with the id of each object whose exact box the moving box touches at or before
    /// `max_time`, and the first time of contact, in ascending order of (time, id). `visit` returns
    /// the new `max_time`, which must not increase.
    pub(crate) fn visit_cast(
        &self,
        sweep: &Sweep<N, D>,
        max_time: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        self.search().by_time(sweep, max_time, visit);
    }

    /// Calls `visit` with groups of objects whose loosened box the moving box may touch by
    /// `max_time`, roughly by ascending time; exact boxes are not tested. Keys are lower bounds of
    /// the times. `visit` returns the new `max_time`.
    pub(crate) fn visit_cast_roughly(
        &self,
        sweep: &Sweep<N, D>,
        max_time: N,
        visit: &mut VisitGroup<'_, N>,
    ) {
        self.search().groups_by_time(sweep, max_time, visit);
    }

    fn search(&self) -> Search<'_, N, D, 2> {
        Search {
            exact: &self.exact,
            trees: [&self.moving, &self.still],
            unbounded: &self.unbounded,
            lanes: self.lanes,
        }
    }
}

fn ascending(mut ids: Vec<u32>) -> Vec<u32> {
    ids.sort_unstable();
    ids
}
