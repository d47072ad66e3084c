//! The interface of all broad phases.

use super::error::or_panic;
use super::{BroadPhaseError, Proposal, ProxyHandle};
use crate::bounding_volume::BoundingVolume;
use crate::math::{Real, max};

/// Receives several proposals at once and returns the new limit of a search; see
/// [`BroadPhase::visit_ray_roughly`].
pub type VisitProposals<'a, N, T> = dyn FnMut(&[Proposal<'_, N, T>]) -> N + 'a;

/// Finds and keeps the pairs of objects whose bounding volumes overlap.
///
/// `T` is the user's data of an object; callbacks get references to it. Object-safe.
///
/// # Semantics
/// * **Deferred**: `deferred_*` calls and [`Self::create_proxy`] have no effect before the next
///   [`Self::update`]. Removal is immediate.
/// * **Complete**: after an update, every two objects whose volumes overlap are a pair, unless the
///   filter refused them. Pairs that do not overlap exactly may be reported too.
/// * **Incremental**: an unchanged pair is not reported again. Each pair that started stops once:
///   in an update or in a removal.
/// * **The filter is constant in time**: it is called once, when the volumes of a pair begin to
///   overlap. When it changes, [`Self::deferred_recompute_all_proximities`] must be called.
/// * **Canonical order**: the data of the object with the smaller [`ProxyHandle::uid`] come first,
///   and pairs come in ascending order of both uids, started and stopped ones mixed.
///
/// ```
/// use impinge::dim2::bounding_volume::Aabb;
/// use impinge::dim2::broad_phase::{BroadPhase, DBVTBroadPhase};
/// use impinge::dim2::math::{Point, Vector};
///
/// let mut broad_phase = DBVTBroadPhase::new(0.1_f32);
/// let [a, b] = ["a", "b"].map(|name| {
///     broad_phase.create_proxy(Aabb::from_half_extents(Point::origin(), Vector::repeat(1.0)), name)
/// });
///
/// broad_phase.update(&mut |_, _| true, &mut |_, _, _| ());
/// let away = Aabb::from_half_extents(Point::new(9.0, 0.0), Vector::repeat(1.0));
/// broad_phase.deferred_set_bounding_volume(b, away);
/// assert_eq!(broad_phase.num_interferences(), 1, "not before the next update");
/// let mut found = Vec::new();
/// broad_phase.update(&mut |_, _| true, &mut |_, _, _| ());
/// broad_phase.interferences_with_point(&Point::origin(), &mut found);
/// assert_eq!((broad_phase.num_interferences(), found), (0, vec![&"a"]));
/// # assert!(a < b);
/// ```
pub trait BroadPhase<N: Real, BV: BoundingVolume<N>, T> {
    /// Adds an object; see [`Self::create_proxy`].
    ///
    /// # Errors
    /// If the volume is inverted or NaN.
    fn try_create_proxy(&mut self, bv: BV, data: T) -> Result<ProxyHandle, BroadPhaseError>;

    /// Removes a set of objects; see [`Self::remove`].
    ///
    /// # Errors
    /// If a handle is stale or occurs twice. Nothing is removed then.
    fn try_remove(
        &mut self,
        handles: &[ProxyHandle],
        callback: &mut dyn FnMut(&T, &T),
    ) -> Result<(), BroadPhaseError>;

    /// Replaces the volume at the next update; see [`Self::deferred_set_bounding_volume`].
    ///
    /// # Errors
    /// If the handle is stale, or the volume inverted or NaN.
    fn try_deferred_set_bounding_volume(
        &mut self,
        handle: ProxyHandle,
        bv: BV,
    ) -> Result<(), BroadPhaseError>;

    /// Filters the pairs of one object again at the next update; see
    /// [`Self::deferred_recompute_all_proximities_with`].
    ///
    /// # Errors
    /// If the handle is stale.
    fn try_deferred_recompute_all_proximities_with(
        &mut self,
        handle: ProxyHandle,
    ) -> Result<(), BroadPhaseError>;

    /// Filters every pair of overlapping volumes again at the next update: pairs that the filter
    /// now refuses stop, pairs that it now allows start. The request holds for that update only.
    fn deferred_recompute_all_proximities(&mut self);

    /// Applies all deferred changes and reports the pairs that started and stopped.
    ///
    /// `filter` returns whether a pair whose volumes begin to overlap is allowed. `callback` then
    /// runs once for each pair that started (`true`) or stopped (`false`). The filter runs before
    /// anything is reported; if it panics, the next update calls it again.
    fn update(
        &mut self,
        filter: &mut dyn FnMut(&T, &T) -> bool,
        callback: &mut dyn FnMut(&T, &T, bool),
    );

    /// Appends the data of each object whose exact volume, as of the last update, overlaps `bv`, by
    /// ascending uid.
    fn interferences_with_bounding_volume<'a>(&'a self, bv: &BV, out: &mut Vec<&'a T>);

    /// Appends the data of each object whose exact volume, as of the last update, the ray meets, by
    /// ascending uid.
    fn interferences_with_ray<'a>(&'a self, ray: &BV::Ray, out: &mut Vec<&'a T>);

    /// Appends the data of each object whose exact volume, as of the last update, contains the
    /// point, by ascending uid.
    fn interferences_with_point<'a>(&'a self, point: &BV::Point, out: &mut Vec<&'a T>);

    /// Returns the number of pairs as of the last update without those removed since.
    fn num_interferences(&self) -> usize;

    /// Returns the exact volume, as of the last update, and the data of an object; `None` for a
    /// stale handle. Before the first update of the object, the volume that it was created with.
    fn proxy(&self, handle: ProxyHandle) -> Option<(&BV, &T)>;

    /// Adds an object, which has pairs from the next update on.
    ///
    /// # Panics
    /// If the volume is inverted or NaN.
    #[track_caller]
    fn create_proxy(&mut self, bv: BV, data: T) -> ProxyHandle {
        or_panic(self.try_create_proxy(bv, data))
    }

    /// Removes a set of objects at once.
    ///
    /// `callback` runs before the removal on each pair, as of the last update, that involves one of
    /// the objects: exactly once even if both are removed, in canonical order.
    ///
    /// # Panics
    /// If a handle is stale or occurs twice. Nothing is removed then.
    #[track_caller]
    fn remove(&mut self, handles: &[ProxyHandle], callback: &mut dyn FnMut(&T, &T)) {
        or_panic(self.try_remove(handles, callback));
    }

    /// Replaces the volume of an object at the next update; the last of several calls counts.
    ///
    /// # Panics
    /// If the handle is stale, or the volume inverted or NaN.
    #[track_caller]
    fn deferred_set_bounding_volume(&mut self, handle: ProxyHandle, bv: BV) {
        or_panic(self.try_deferred_set_bounding_volume(handle, bv));
    }

    /// Filters the pairs of this object with all that overlap it again at the next update: pairs
    /// that the filter now refuses stop, pairs that it now allows start. A pair that stands is not
    /// reported again.
    ///
    /// # Panics
    /// If the handle is stale.
    #[track_caller]
    fn deferred_recompute_all_proximities_with(&mut self, handle: ProxyHandle) {
        or_panic(self.try_deferred_recompute_all_proximities_with(handle));
    }

    /// Calls `visit` for the objects whose exact volumes, as of the last update, the ray meets at
    /// or before `max_time`, in order of entry, ties by uid. `visit` returns the new `max_time`, by
    /// which a search for the nearest hit ends early; a negative one ends it at once.
    ///
    /// The default does not compute times of entry: it visits all hits by uid until a negative time
    /// is returned. Ordered implementations override it.
    fn visit_ray(&self, ray: &BV::Ray, max_time: N, visit: &mut dyn FnMut(&T) -> N) {
        let mut hits = Vec::new();
        self.interferences_with_ray(ray, &mut hits);
        visit_all(&hits, max_time, visit);
    }

    /// As [`Self::visit_ray`], but in unspecified order and several objects at a time, for callers
    /// that sort the results and test the objects themselves. Near objects should come first, and
    /// objects whose volumes the ray narrowly misses may be among them. The default calls
    /// [`Self::visit_ray`], one object at a time, with the key zero.
    ///
    /// A broad phase that wraps another and gives handles of its own must create proposals by
    /// [`Proposal::of`]: those of the wrapped one refer to its handles.
    fn visit_ray_roughly(&self, ray: &BV::Ray, max_time: N, visit: &mut VisitProposals<'_, N, T>) {
        self.visit_ray(ray, max_time, &mut |data| visit(&[Proposal::of(data, N::ZERO)]));
    }

    /// Calls `visit` for the objects whose exact volumes, as of the last update, are at most
    /// `max_distance` from `bv`, the nearest first, ties by uid. `visit` returns the new
    /// `max_distance`; a negative one ends the search at once.
    ///
    /// The default does not compute distances: it visits the objects that overlap `bv` loosened by
    /// `max_distance`, by uid, until a negative distance is returned. Ordered implementations
    /// override it.
    fn visit_nearest(&self, bv: &BV, max_distance: N, visit: &mut dyn FnMut(&T) -> N) {
        let (reach, mut near) = (max(max_distance, N::ZERO), Vec::new());
        self.interferences_with_bounding_volume(&bv.loosened(reach), &mut near);
        visit_all(&near, max_distance, visit);
    }

    /// Calls `visit` for the objects whose exact volumes, as of the last update, `bv` touches at or
    /// before `max_time` while it moves with `velocity` (finite), in order of that time, ties by
    /// uid. `visit` returns the new `max_time`; a negative one ends the search at once.
    ///
    /// The default does not compute times: it visits the objects that overlap the volume swept
    /// until `max_time`, by uid, until a negative time is returned. Ordered implementations
    /// override it.
    fn visit_cast(
        &self,
        bv: &BV,
        velocity: &BV::Vector,
        max_time: N,
        visit: &mut dyn FnMut(&T) -> N,
    ) {
        let (end, mut met) = (max(max_time, N::ZERO), Vec::new());
        self.interferences_with_bounding_volume(&bv.swept(velocity, end), &mut met);
        visit_all(&met, max_time, visit);
    }

    /// Returns the loosened volume of an object, for drawing. `None`, the default, if the broad
    /// phase has none, for a stale handle, and before the first update of the object.
    #[cfg(feature = "debug_render")]
    fn loosened(&self, handle: ProxyHandle) -> Option<BV> {
        let _ = handle;
        None
    }

    /// Calls `visit` with the volume of each inner node, as of the last update, in an order that
    /// does not change; for drawing. The default has no nodes.
    #[cfg(feature = "debug_render")]
    fn visit_nodes(&self, visit: &mut dyn FnMut(&BV)) {
        let _ = visit;
    }

    /// As [`Self::visit_nearest`], in groups and roughly in order; see [`Self::visit_ray_roughly`].
    fn visit_nearest_roughly(
        &self,
        bv: &BV,
        max_distance: N,
        visit: &mut VisitProposals<'_, N, T>,
    ) {
        self.visit_nearest(bv, max_distance, &mut |data| visit(&[Proposal::of(data, N::ZERO)]));
    }

    /// As [`Self::visit_cast`], in groups and roughly in order; see [`Self::visit_ray_roughly`].
    fn visit_cast_roughly(
        &self,
        bv: &BV,
        velocity: &BV::Vector,
        max_time: N,
        visit: &mut VisitProposals<'_, N, T>,
    ) {
        self.visit_cast(bv, velocity, max_time, &mut |data| visit(&[Proposal::of(data, N::ZERO)]));
    }
}

/// Visits all objects until the limit is negative or NaN.
fn visit_all<N: Real, T>(found: &[&T], mut limit: N, visit: &mut dyn FnMut(&T) -> N) {
    for data in found {
        let goes_on = limit >= N::ZERO;
        if !goes_on {
            return;
        }
        limit = visit(data);
    }
}
