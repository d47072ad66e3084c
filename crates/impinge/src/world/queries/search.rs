//! The way all ranked queries go: box by box, near ones first, as long as a box may hold an answer.

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

/// What the boxes are asked; the key of a box is a time or a distance.
#[derive(Clone, Copy, Debug)]
pub(super) enum WorldProbe<N: Real, const D: usize> {
    /// When they are entered.
    Ray(Ray<N, D>),
    /// How far they are.
    Near(Aabb<N, D>),
    /// When they are touched.
    Cast(Aabb<N, D>, Vector<N, D>),
}

impl<N: Space<D>, const D: usize> WorldProbe<N, D> {
    /// The boxes of dirty objects, those of least keys about first.
    fn visit_dirty(&self, tree: &DirtyTree<D>, limit: N, visit: &mut DirtyVisitor<'_, N>) {
        let along = |sweep, visit| entries::dirty_by_time(tree, &sweep, limit, visit);
        match self {
            Self::Ray(ray) => along(Sweep::along(ray), visit),
            Self::Near(own) => entries::dirty_by_distance(tree, own, limit, visit),
            Self::Cast(own, velocity) => along(Sweep { aabb: *own, velocity: *velocity }, visit),
        }
    }

    /// The boxes of the broad phase, those of least keys about first.
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

/// Gets some objects that the broad phase proposes, and returns the largest key that still counts.
type ProposalVisitor<'a, N> = dyn FnMut(&[Proposal<'_, N, CollisionObjectHandle>]) -> N + 'a;

/// A few objects, and bounds below their keys.
type ProposedGroup<'a, N, const D: usize, T> = [Option<(&'a CollisionObject<N, D, T>, N)>; GROUP];

/// An object and what was found about it.
type FoundObject<'a, N, const D: usize, T, A> = (&'a CollisionObject<N, D, T>, A);

/// An object and what was found about it, with the key that it was ranked by.
pub(super) type QueryAnswer<'a, N, const D: usize, T, A> = (&'a CollisionObject<N, D, T>, N, A);

/// Gets an object and the largest key that still counts, and returns the key of the object and the
/// answer; `None` if the object has no key or a larger one.
pub(super) type Measure<'a, N, const D: usize, A> =
    dyn Fn(&WorldBody<N, D>, N) -> Option<(N, A)> + 'a;

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// The best answers, in order, that `measure` gives about objects that the filter allows.
    pub(super) fn rank<A>(
        &self,
        probe: &WorldProbe<N, D>,
        room: RankRange<N>,
        filter: &QueryFilter<'_, N, D, T>,
        measure: &Measure<'_, N, D, A>,
    ) -> Vec<QueryAnswer<'_, N, D, T, A>> {
        let Some(mut ranking) = Ranking::new(room.count, room.limit) else { return Vec::new() };
        self.rank_into(&mut ranking, probe, filter, measure);
        ranking.into_sorted().into_iter().map(answer).collect()
    }

    /// The best of the answers with keys up to `limit`.
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

    /// Calls `visit` with each object whose box may have a key of at most `limit`, and with some others, near ones
    /// about first, each once. `visit` gets and returns the largest key that still counts; a negative one ends the
    /// search.
    ///
    /// Dirty objects are proposed by a tree of their own, whatever the broad phase proposes.
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
            let of_dirty = |&(id, key): &(u32, N)| Some((self.objects.of_dirty(tree, id)?, key));
            probe.visit_dirty(tree, limit.get(), &mut |found| visit_all(gathered(found, of_dirty)));
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

    /// The object of a proposal of the broad phase, if it lives and is not dirty.
    ///
    /// As a rule the number of its proxy tells where it is, which saves the way through the broad phase's
    /// record. A proxy with the number of that of a living object is that object's.
    #[inline]
    fn clean_proposal(
        &self,
        proposal: &Proposal<'_, N, CollisionObjectHandle>,
    ) -> Option<&CollisionObject<N, D, T>> {
        let expected = proposal.uid().and_then(|uid| self.objects.of_proxy(uid));
        let object = expected.or_else(|| self.objects.get(*proposal.data()))?;
        (!self.objects.changes.is_dirty(&object.body)).then_some(object)
    }

    /// The filter allows a living object.
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

/// The objects of a few proposals, before any is looked at: they lie apart from each other, and memory is slow one by
/// one.
#[inline]
fn gathered<P, A: Copy>(group: &[P], find: impl Fn(&P) -> Option<A>) -> [Option<A>; GROUP] {
    let mut found = [None; GROUP];
    for (found, one) in found.iter_mut().zip(group) {
        *found = find(one);
    }
    found
}
