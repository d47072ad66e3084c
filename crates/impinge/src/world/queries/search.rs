//! The way all ranked queries go: box by box, near ones first, as long as a box may hold an answer.

use super::QueryFilter;
use super::ranking::{BestOne, Rank, RankRange, Ranked, Ranking};
use crate::bounding_volume::{Aabb, Ray};
use crate::broad_phase::Proposal;
use crate::bvh::GROUP;
use crate::math::{Real, Space, Vector};
use crate::narrow_phase::CollisionObjectHandle;
use crate::world::bodies::WorldBody;
use crate::world::{CollisionObject, CollisionWorld, WorldBroadPhase};

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
    /// The key of one box, which is never above that of a solid in it; `None` if the solid has none.
    fn key(&self, aabb: &Aabb<N, D>) -> Option<N> {
        match self {
            Self::Ray(ray) => aabb.ray_interval(ray).map(|(enter, _)| enter),
            Self::Near(own) => Some(aabb.distance_to_aabb(own)),
            Self::Cast(own, velocity) => aabb.sweep_interval(own, velocity).map(|(enter, _)| enter),
        }
    }

    /// A solid in the box may have a key.
    pub(super) fn meets(&self, aabb: &Aabb<N, D>) -> bool {
        self.key(aabb).is_some()
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
        let mut limit = ranking.limit_of_boxes();
        let mut consider = |object: &'a CollisionObject<N, D, T>, key: N, limit: N| {
            if key <= limit
                && self.allows(object, filter)
                && let Some((key, answer)) = measure(&object.body, ranking.limit())
            {
                let handle = object.body.handle;
                ranking.offer(Ranked { key, handle, answer: (object, answer) });
                return ranking.limit_of_boxes();
            }
            limit
        };
        for (object, volume) in self.astray() {
            if let Some(key) = probe.key(&volume) {
                limit = consider(object, key, limit);
            }
        }
        probe.visit(&*self.broad_phase, limit, &mut |proposals| {
            for group in proposals.chunks(GROUP) {
                let objects = self.gathered(group);
                for (object, one) in objects.into_iter().zip(group) {
                    limit = object.map_or(limit, |object| consider(object, one.key(), limit));
                }
            }
            limit
        });
    }

    /// The objects of a few proposals: they lie apart from each other, and memory is slow one by one.
    #[inline]
    fn gathered(
        &self,
        group: &[Proposal<'_, N, CollisionObjectHandle>],
    ) -> [Option<&CollisionObject<N, D, T>>; GROUP] {
        let mut objects = [None; GROUP];
        for (object, one) in objects.iter_mut().zip(group) {
            *object = self.settled_proposal(one);
        }
        objects
    }

    /// The object of a proposal, if it is where it was at the last update.
    ///
    /// As a rule the number of its proxy tells where it is, which saves the way through the broad phase's
    /// record. A proxy with the number of that of a living object is that object's.
    #[inline]
    pub(super) fn settled_proposal(
        &self,
        proposal: &Proposal<'_, N, CollisionObjectHandle>,
    ) -> Option<&CollisionObject<N, D, T>> {
        let expected = proposal.uid().and_then(|uid| self.objects.of_proxy(uid));
        let Some(object) = expected else { return self.settled(*proposal.data()) };
        (!self.objects.changes.is_astray(&object.body)).then_some(object)
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
