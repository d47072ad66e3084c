//! The interface that all broad phases implement.

use super::error::or_panic;
use super::{BroadPhaseError, Proposal, ProxyHandle};
use crate::bounding_volume::BoundingVolume;
use crate::math::{Real, max};

/// Receives a group of proposals, and returns the new limit of the search; see
/// [`BroadPhase::visit_ray_roughly`].
pub type VisitProposals<'a, N, T> = dyn FnMut(&[Proposal<'_, N, T>]) -> N + 'a;

/// Finds and keeps the pairs of objects whose bounding volumes overlap.
///
/// `T` is the user's data of an object, to which callbacks get references. The trait is
/// dyn-compatible.
///
/// # Semantics
/// * **Deferred**: `deferred_*` calls and [`Self::create_proxy`] take effect at the next
///   [`Self::update`]. Removal is immediate.
/// * **Complete**: after an update, every two objects whose volumes overlap are a pair, unless the
///   filter refused them. Objects whose exact volumes do not overlap may be a pair too.
/// * **Incremental**: an unchanged pair is not reported again. Each pair that started stops at most
///   once before it starts again: in an update or in a removal.
/// * **The filter must not change over time**: it is called once, when the volumes of a pair begin
///   to overlap. If it changes, call [`Self::deferred_recompute_all_proximities`].
/// * **Canonical order**: the data of the object with the smaller [`ProxyHandle::uid`] come first.
///   Pairs come in ascending order of their two uids, whether they start or stop.
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
    /// If the volume is inverted or contains NaN.
    fn try_create_proxy(&mut self, bv: BV, data: T) -> Result<ProxyHandle, BroadPhaseError>;

    /// Removes several objects; see [`Self::remove`].
    ///
    /// # Errors
    /// If a handle is stale or occurs twice. Then nothing is removed.
    fn try_remove(
        &mut self,
        handles: &[ProxyHandle],
        callback: &mut dyn FnMut(&T, &T),
    ) -> Result<(), BroadPhaseError>;

    /// Replaces the volume of an object at the next update; see
    /// [`Self::deferred_set_bounding_volume`].
    ///
    /// # Errors
    /// If the handle is stale, or the volume is inverted or contains NaN.
    fn try_deferred_set_bounding_volume(
        &mut self,
        handle: ProxyHandle,
        bv: BV,
    ) -> Result<(), BroadPhaseError>;

    /// Makes the next update filter the pairs of one object again; see
    /// [`Self::deferred_recompute_all_proximities_with`].
    ///
    /// # Errors
    /// If the handle is stale.
    fn try_deferred_recompute_all_proximities_with(
        &mut self,
        handle: ProxyHandle,
    ) -> Result<(), BroadPhaseError>;

    /// Makes the next update filter every pair of overlapping volumes again, once. Pairs that the
    /// filter now refuses stop, and pairs that it now allows start.
    fn deferred_recompute_all_proximities(&mut self);

    /// Applies all deferred changes and reports the pairs that started and stopped.
    ///
    /// `filter` returns `true` if a pair whose volumes begin to overlap is allowed. Then `callback`
    /// runs once for each pair that started (`true`) or stopped (`false`). All calls of `filter`
    /// come before those of `callback`; if `filter` panics, the next update calls it again.
    fn update(
        &mut self,
        filter: &mut dyn FnMut(&T, &T) -> bool,
        callback: &mut dyn FnMut(&T, &T, bool),
    );

    /// Appends the data of each object whose exact volume, as of the last update, overlaps `bv`, by
    /// ascending uid.
    fn interferences_with_bounding_volume<'a>(&'a self, bv: &BV, out: &mut Vec<&'a T>);

    /// Appends the data of each object whose exact volume, as of the last update, is hit by the
    /// ray, by ascending uid.
    fn interferences_with_ray<'a>(&'a self, ray: &BV::Ray, out: &mut Vec<&'a T>);

    /// Appends the data of each object whose exact volume, as of the last update, contains the
    /// point, by ascending uid.
    fn interferences_with_point<'a>(&'a self, point: &BV::Point, out: &mut Vec<&'a T>);

    /// Returns the number of pairs of the last update, except those removed since.
    fn num_interferences(&self) -> usize;

    /// Returns the exact volume of an object as of its last update, and its data; `None` for a
    /// stale handle. Before the first update of the object, this is its volume at creation.
    fn proxy(&self, handle: ProxyHandle) -> Option<(&BV, &T)>;

    /// Adds an object. It has pairs from the next update on.
    ///
    /// # Panics
    /// If the volume is inverted or contains NaN.
    #[track_caller]
    fn create_proxy(&mut self, bv: BV, data: T) -> ProxyHandle {
        or_panic(self.try_create_proxy(bv, data))
    }

    /// Removes several objects at once.
    ///
    /// Before the removal, `callback` runs on each pair of the last update that contains at least
    /// one of the objects. It runs once even if both objects are removed; the pairs come in
    /// canonical order.
    ///
    /// # Panics
    /// If a handle is stale or occurs twice. Then nothing is removed.
    #[track_caller]
    fn remove(&mut self, handles: &[ProxyHandle], callback: &mut dyn FnMut(&T, &T)) {
        or_panic(self.try_remove(handles, callback));
    }

    /// Replaces the volume of an object at the next update; of several calls, only the last has an
    /// effect.
    ///
    /// # Panics
    /// If the handle is stale, or the volume is inverted or contains NaN.
    #[track_caller]
    fn deferred_set_bounding_volume(&mut self, handle: ProxyHandle, bv: BV) {
        or_panic(self.try_deferred_set_bounding_volume(handle, bv));
    }

    /// Makes the next update filter again all pairs of this object with objects whose volumes
    /// overlap its volume. Pairs that the filter now refuses stop, and pairs that it now allows
    /// start. A pair that remains is not reported again.
    ///
    /// # Panics
    /// If the handle is stale.
    #[track_caller]
    fn deferred_recompute_all_proximities_with(&mut self, handle: ProxyHandle) {
        or_panic(self.try_deferred_recompute_all_proximities_with(handle));
    }

    /// Calls `visit` for the objects whose exact volumes, as of the last update, the ray hits at or
    /// before `max_time`, by ascending time of entry, then uid. `visit` returns the new `max_time`,
    /// which must not increase; a negative value stops the search.
    ///
    /// The default does not compute times of entry: it visits all hits by ascending uid until
    /// `visit` returns a negative time. Ordered implementations override it.
    fn visit_ray(&self, ray: &BV::Ray, max_time: N, visit: &mut dyn FnMut(&T) -> N) {
        let mut hits = Vec::new();
        self.interferences_with_ray(ray, &mut hits);
        visit_all(&hits, max_time, visit);
    }

    /// Calls `visit` with groups of objects that the ray may hit, in unspecified order, for callers
    /// that test the objects themselves and sort the results. Near objects should come first. The
    /// ray may narrowly miss some of the volumes. `visit` returns the new `max_time`. The default
    /// calls [`Self::visit_ray`], and proposes one object at a time with key zero.
    ///
    /// A broad phase that wraps another broad phase and issues its own handles must create its
    /// proposals by [`Proposal::of`]. The proposals of the wrapped broad phase would have the uids
    /// of that broad phase.
    fn visit_ray_roughly(&self, ray: &BV::Ray, max_time: N, visit: &mut VisitProposals<'_, N, T>) {
        self.visit_ray(ray, max_time, &mut |data| visit(&[Proposal::of(data, N::ZERO)]));
    }

    /// Calls `visit` for the objects whose exact volumes, as of the last update, are at most
    /// `max_distance` from `bv`, by ascending distance, then uid. `visit` returns the new
    /// `max_distance`, which must not increase; a negative value stops the search.
    ///
    /// The default does not compute distances: it visits the objects that overlap `bv` loosened by
    /// `max_distance`, by ascending uid, until `visit` returns a negative distance. Ordered
    /// implementations override it.
    fn visit_nearest(&self, bv: &BV, max_distance: N, visit: &mut dyn FnMut(&T) -> N) {
        let (distance, mut near) = (max(max_distance, N::ZERO), Vec::new());
        self.interferences_with_bounding_volume(&bv.loosened(distance), &mut near);
        visit_all(&near, max_distance, visit);
    }

    /// Calls `visit` for the objects whose exact volumes, as of the last update, are touched by
    /// `bv` at or before `max_time` while it moves with `velocity` (finite), by ascending time,
    /// then uid. `visit` returns the new `max_time`, which must not increase; a negative value
    /// stops the search.
    ///
    /// The default does not compute times: it visits the objects that overlap the volume swept
    /// until `max_time`, by ascending uid, until `visit` returns a negative time. Ordered
    /// implementations override it.
    fn visit_cast(
        &self,
        bv: &BV,
        velocity: &BV::Vector,
        max_time: N,
        visit: &mut dyn FnMut(&T) -> N,
    ) {
        let (end, mut overlapping) = (max(max_time, N::ZERO), Vec::new());
        self.interferences_with_bounding_volume(&bv.swept(velocity, end), &mut overlapping);
        visit_all(&overlapping, max_time, visit);
    }

    /// Returns the loosened volume of an object, for drawing. `None` for a stale handle, and before
    /// the first update of the object. The default always returns `None`.
    #[cfg(feature = "debug_render")]
    fn loosened(&self, handle: ProxyHandle) -> Option<BV> {
        let _ = handle;
        None
    }

    /// Calls `visit` with the volume of each inner node, as of the last update, in a deterministic
    /// order; for drawing. The default does nothing.
    #[cfg(feature = "debug_render")]
    fn visit_nodes(&self, visit: &mut dyn FnMut(&BV)) {
        let _ = visit;
    }

    /// Calls `visit` with groups of objects that may be at most `max_distance` from `bv`, in
    /// unspecified order; [`Self::visit_ray_roughly`] describes the groups. The default calls
    /// [`Self::visit_nearest`].
    fn visit_nearest_roughly(
        &self,
        bv: &BV,
        max_distance: N,
        visit: &mut VisitProposals<'_, N, T>,
    ) {
        self.visit_nearest(bv, max_distance, &mut |data| visit(&[Proposal::of(data, N::ZERO)]));
    }

    /// Calls `visit` with groups of objects that the moving volume may touch by `max_time`, in
    /// unspecified order; [`Self::visit_ray_roughly`] describes the groups. The default calls
    /// [`Self::visit_cast`].
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

/// Visits the objects in order, as long as the limit is zero or more: first `limit`, then the
/// result of `visit`. A negative or NaN limit ends the visit.
fn visit_all<N: Real, T>(found: &[&T], mut limit: N, visit: &mut dyn FnMut(&T) -> N) {
    for data in found {
        let goes_on = limit >= N::ZERO;
        if !goes_on {
            return;
        }
        limit = visit(data);
    }
}
