//! The search that all ranked queries share. It visits objects roughly in ascending order of the
//! keys of their boxes, and ends when no box can have a better result.

use crate::world::entries;
use core::cell::Cell;

use super::QueryFilter;
use super::ranking::{BestOne, Rank, RankRange, Ranked, Ranking};
use crate::bounding_volume::{Aabb, Ray};
use crate::broad_phase::Proposal;
use crate::bvh::GROUP;
use crate::math::{Real, Space, Vector};
use crate::narrow_phase::CollisionObjectHandle;
use crate::partitioning::Sweep;
use crate::world::bodies::WorldBody;
use crate::world::{CollisionObject, CollisionWorld, DirtyTree, DirtyVisitor, WorldBroadPhase};

/// The ray, box or moving box with which a query searches. It defines the key of an object's box: a
/// time or a distance.
#[derive(Clone, Copy, Debug)]
pub(super) enum WorldProbe<N: Real, const D: usize> {
    /// The key is the time at which the ray enters the box.
    Ray(Ray<N, D>),
    /// The key is the distance between this box and the box of the object.
    Near(Aabb<N, D>),
    /// The key is the time at which this moving box first touches the box of the object. The second
    /// field is its velocity.
    Cast(Aabb<N, D>, Vector<N, D>),
}

impl<N: Space<D>, const D: usize> WorldProbe<N, D> {
    /// Visits the boxes of dirty objects, roughly in ascending order of their keys.
    fn visit_dirty(&self, tree: &DirtyTree<D>, limit: N, visit: &mut DirtyVisitor<'_, N>) {
        let along = |sweep, visit| entries::dirty_by_time(tree, &sweep, limit, visit);
        match self {
            Self::Ray(ray) => along(Sweep::along(ray), visit),
            Self::Near(own) => entries::dirty_by_distance(tree, own, limit, visit),
            Self::Cast(own, velocity) => along(Sweep { aabb: *own, velocity: *velocity }, visit),
        }
    }

    /// Visits the boxes of the broad phase, roughly in ascending order of their keys.
    fn visit(
        &self,
        broad_phase: &WorldBroadPhase<N, D>,
        limit: N,
        visit: &mut ProposalVisitor<'_, N>,
    ) {
        match self {
            Self::Ray(ray) => broad_phase.visit_ray_roughly(ray, limit, visit),
            Self::Near(own) => broad_phase.visit_nearest_roughly(own, limit, visit),
            Self::Cast(own, velocity) => {
                broad_phase.visit_cast_roughly(own, velocity, limit, visit);
            }
        }
    }
}

/// Receives a group of objects that the broad phase proposes, and returns the new limit of keys.
type ProposalVisitor<'a, N> = dyn FnMut(&[Proposal<'_, N, CollisionObjectHandle>]) -> N + 'a;

/// A group of objects with lower bounds of their keys; unused entries are `None`.
type ProposedGroup<'a, N, const D: usize, T> = [Option<(&'a CollisionObject<N, D, T>, N)>; GROUP];

/// An object and its result.
type FoundObject<'a, N, const D: usize, T, A> = (&'a CollisionObject<N, D, T>, A);

/// An object, its key and its result.
pub(super) type QueryAnswer<'a, N, const D: usize, T, A> = (&'a CollisionObject<N, D, T>, N, A);

/// Receives an object and the present limit of keys. Returns the object's key and result, or `None`
/// if it has no key or its key exceeds the limit.
pub(super) type Measure<'a, N, const D: usize, A> =
    dyn Fn(&WorldBody<N, D>, N) -> Option<(N, A)> + 'a;

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the best results of `measure` among the objects that the filter allows, by ascending
    /// key, then handle.
    pub(super) fn rank<A>(
        &self,
        probe: &WorldProbe<N, D>,
        range: RankRange<N>,
        filter: &QueryFilter<'_, N, D, T>,
        measure: &Measure<'_, N, D, A>,
    ) -> Vec<QueryAnswer<'_, N, D, T, A>> {
        let Some(mut ranking) = Ranking::new(range.count, range.limit) else { return Vec::new() };
        self.rank_into(&mut ranking, probe, filter, measure);
        ranking.into_sorted().into_iter().map(answer).collect()
    }

    /// Returns the best result of `measure` with a key of at most `limit`; `None` if there is none.
    pub(super) fn best<A>(
        &self,
        probe: &WorldProbe<N, D>,
        limit: N,
        filter: &QueryFilter<'_, N, D, T>,
        measure: &Measure<'_, N, D, A>,
    ) -> Option<QueryAnswer<'_, N, D, T, A>> {
        let mut best = BestOne::new(limit)?;
        self.rank_into(&mut best, probe, filter, measure);
        best.found().map(answer)
    }

    fn rank_into<'a, A>(
        &'a self,
        ranking: &mut impl Rank<N, FoundObject<'a, N, D, T, A>>,
        probe: &WorldProbe<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
        measure: &Measure<'_, N, D, A>,
    ) {
        self.propose(probe, ranking.limit_of_boxes(), |object, limit| {
            if self.allows(object, filter)
                && let Some((key, answer)) = measure(&object.body, ranking.limit())
            {
                let handle = object.body.handle;
                ranking.offer(Ranked { key, handle, answer: (object, answer) });
                return ranking.limit_of_boxes();
            }
            limit
        });
    }

    /// Calls `visit` with each object whose box may have a key of at most `limit`, and possibly
    /// with a few objects with a larger key. Visits each object once, roughly in ascending order of
    /// keys. `visit` receives the present limit of keys and returns the new one; a negative limit
    /// ends the search.
    ///
    /// Dirty objects come from the tree of dirty objects; proposals of the broad phase for them are
    /// dropped.
    pub(super) fn propose<'a>(
        &'a self,
        probe: &WorldProbe<N, D>,
        limit: N,
        mut visit: impl FnMut(&'a CollisionObject<N, D, T>, N) -> N,
    ) {
        let limit = Cell::new(limit);
        let mut visit_all = |group: ProposedGroup<'a, N, D, T>| {
            for (object, key) in group.into_iter().flatten() {
                if key <= limit.get() {
                    limit.set(visit(object, limit.get()));
                }
            }
            limit.get()
        };
        if let Some(tree) = self.objects.dirty_tree(&*self.broad_phase) {
            let dirty_object =
                |&(id, key): &(u32, N)| Some((self.objects.dirty_object(tree, id)?, key));
            probe.visit_dirty(tree, limit.get(), &mut |found| {
                visit_all(gathered(found, dirty_object))
            });
            if tree.has_all() {
                return;
            }
        }
        let of_clean = |one: &Proposal<'_, N, _>| Some((self.clean_proposal(one)?, one.key()));
        probe.visit(&*self.broad_phase, limit.get(), &mut |proposals| {
            let groups = proposals.chunks(GROUP);
            groups.fold(limit.get(), |_, group| visit_all(gathered(group, of_clean)))
        });
    }

    /// Returns the object of a proposal of the broad phase; `None` if the object does not exist or
    /// is dirty.
    ///
    /// Usually the object is found by the uid of the proxy, without loading the proxy's data: no
    /// two present objects have proxies with the same uid.
    #[inline]
    fn clean_proposal(
        &self,
        proposal: &Proposal<'_, N, CollisionObjectHandle>,
    ) -> Option<&CollisionObject<N, D, T>> {
        let expected = proposal.uid().and_then(|uid| self.objects.object_of_proxy(uid));
        let object = expected.or_else(|| self.objects.get(*proposal.data()))?;
        (!self.objects.changes.is_dirty(&object.body)).then_some(object)
    }

    /// Returns `true` if the filter allows an object.
    #[inline]
    pub(super) fn allows(
        &self,
        object: &CollisionObject<N, D, T>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> bool {
        filter.admits(object.body.handle, &object.body.groups) && filter.accepts(object)
    }
}

fn answer<'a, N: Space<D>, const D: usize, T, A>(
    ranked: Ranked<N, FoundObject<'a, N, D, T, A>>,
) -> QueryAnswer<'a, N, D, T, A> {
    let (object, answer) = ranked.answer;
    (object, ranked.key, answer)
}

/// Finds the objects of a group of proposals before any of them is tested. The objects are
/// scattered in memory, and the cache misses of independent loads overlap.
#[inline]
fn gathered<P, A: Copy>(group: &[P], find: impl Fn(&P) -> Option<A>) -> [Option<A>; GROUP] {
    let mut found = [None; GROUP];
    for (found, one) in found.iter_mut().zip(group) {
        *found = find(one);
    }
    found
}
