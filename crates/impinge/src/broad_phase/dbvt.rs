//! The default broad phase: a [`PairFinder`], with a handle and the user's data for each object.

use crate::math::order::sort_few;
use crate::tables::entries;
use core::fmt::{self, Debug};

use super::error::or_panic;
use super::handle::Handles;
use super::proposal::{Proposal, Proxies};
use super::rewind::ProxyNote;
use super::{BroadPhase, BroadPhaseError, PairFinder, ProxyHandle, VisitProposals};
use crate::bounding_volume::{Aabb, BoundingVolume, Ray};
use crate::bvh::{Bounds, GROUP, Lanes};
use crate::journal::Journal;
use crate::math::{Point, Real, Space, Vector};
use crate::memory::{Recent, clone_fields};
use crate::pairs::unpack;
use crate::partitioning::Sweep;

/// A bounding volume that [`DBVTBroadPhase`] supports. Sealed: only [`Aabb`] implements it.
pub trait TreeVolume<N: Real>: BoundingVolume<N> + sealed::Sealed {
    /// The algorithm that finds the pairs of these volumes.
    type Finder: Debug + Clone;

    /// Creates a finder without objects.
    ///
    /// # Errors
    /// If the margin is negative, infinite or NaN.
    fn try_finder(margin: N) -> Result<Self::Finder, BroadPhaseError>;
}

mod sealed {
    /// Prevents implementations of `TreeVolume` for other volumes.
    #[expect(unnameable_types, reason = "that nobody can name it is its purpose")]
    pub trait Sealed {}
}

impl<N: Real, const D: usize> sealed::Sealed for Aabb<N, D> {}

impl<N: Space<D>, const D: usize> TreeVolume<N> for Aabb<N, D> {
    type Finder = PairFinder<N, D>;

    fn try_finder(margin: N) -> Result<PairFinder<N, D>, BroadPhaseError> {
        PairFinder::try_new(margin)
    }
}

/// The default broad phase: two dynamic trees over bounding volumes loosened by a margin, one of
/// moving and one of still objects.
///
/// An object changes a tree only at its first update, when its exact volume leaves its loosened
/// volume, and when it comes to rest. So objects that move slowly or jitter cost almost nothing.
/// Two objects are a pair if their loosened volumes overlap. The searches `interferences_with_*`,
/// `visit_ray`, `visit_nearest` and `visit_cast` test exact volumes; `visit_*_roughly` test
/// loosened volumes only.
///
/// Loosened volumes are stored as `f32`, rounded outwards, even for `f64`, so no pair is missed. An
/// object is treated as unbounded if a face of its loosened volume is beyond the range of `f32`.
/// Each unbounded object is tested against every object that changes, so there should be few of
/// them.
///
/// An update costs O(k log n) for k changed objects of n, if objects move little between two
/// updates. A still object without pairs takes about 60 bytes in addition to its exact volume, its
/// loosened volume and its data. [`PairFinder`] describes the layout.
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
/// let mut events = Vec::new();
/// broad_phase.update(&mut |_, _| true, &mut |&first, &second, started| events.push((first, second, started)));
/// assert_eq!((broad_phase.num_interferences(), &events[..]), (1, &[("a", "b", true)][..]));
/// # assert!(a < b);
/// ```
pub struct DBVTBroadPhase<N: Real, BV: TreeVolume<N>, T> {
    pub(super) handles: Handles,
    /// Users' data by handle index; `None` for an index without an object.
    pub(super) proxies: Proxies<T>,
    pub(super) finder: BV::Finder,
    recent: Recent,
    pub(super) journal: Journal<ProxyNote<T>>,
}

clone_fields!([N: Real, BV: TreeVolume<N>, T: Clone] DBVTBroadPhase<N, BV, T> {
    handles, proxies, finder, recent, journal,
});

impl<N: Space<D>, const D: usize, T> Debug for DBVTBroadPhase<N, Aabb<N, D>, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DBVTBroadPhase")
            .field("margin", &self.margin())
            .field("num_proxies", &self.proxies.iter().flatten().count())
            .field("num_pairs", &self.num_interferences())
            .finish_non_exhaustive()
    }
}

impl<N: Real, BV: TreeVolume<N>, T> DBVTBroadPhase<N, BV, T> {
    /// Creates an empty broad phase, which loosens volumes by `margin` (zero or more; 0.02 suits
    /// objects of size 1).
    ///
    /// # Panics
    /// If the margin is negative, infinite or NaN; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(margin: N) -> Self {
        or_panic(Self::try_new(margin))
    }

    /// Creates an empty broad phase, which loosens volumes by `margin`.
    ///
    /// # Errors
    /// If the margin is negative, infinite or NaN.
    pub fn try_new(margin: N) -> Result<Self, BroadPhaseError> {
        let finder = BV::try_finder(margin)?;
        let (handles, proxies, recent) = (Handles::new(), Vec::new(), Recent::default());
        Ok(Self { handles, proxies, finder, recent, journal: Journal::default() })
    }
}

/// Returns the data of an object, which must be in the broad phase.
pub(super) fn data_of<T>(proxies: &[Option<T>], id: u32) -> &T {
    let data = proxies[id as usize].as_ref();
    data.expect("the finder knows only objects that are there")
}

/// Returns the id of the object in the finder: the index of its handle.
fn id_of(handle: ProxyHandle) -> u32 {
    u32::try_from(handle.uid()).expect("handles hold an index of 32 bits")
}

impl<N: Space<D>, const D: usize, T> DBVTBroadPhase<N, Aabb<N, D>, T> {
    /// Creates an empty broad phase, which uses SIMD vectors of this width. The width does not
    /// affect results. For tests.
    ///
    /// # Errors
    /// If the margin is negative, infinite or NaN.
    pub fn with_lanes(margin: N, lanes: Lanes) -> Result<Self, BroadPhaseError> {
        let finder = PairFinder::with_lanes(margin, lanes)?;
        Ok(Self { finder, ..Self::try_new(margin)? })
    }

    /// Returns the margin by which volumes are loosened.
    pub fn margin(&self) -> N {
        self.finder.margin()
    }

    /// Returns the loosened volume of an object; `None` for a stale handle, and before the first
    /// update of the object.
    pub fn loosened_volume(&self, handle: ProxyHandle) -> Option<&Bounds<D>> {
        self.check(handle).ok()?;
        self.finder.loosened(id_of(handle))
    }

    /// Iterates over the pairs of the last update, except those removed since. In each pair the
    /// smaller handle comes first; the order of the pairs is unspecified.
    pub fn pairs(&self) -> impl Iterator<Item = (ProxyHandle, ProxyHandle)> + '_ {
        let handle = |id: u32| self.handles.at(id);
        self.finder.pairs().iter().map(move |&(a, b)| (handle(a), handle(b)))
    }

    /// Checks every invariant; for tests.
    ///
    /// # Errors
    /// Returns a sentence that names the violated invariant.
    pub fn validate(&self) -> Result<(), String> {
        self.finder.validate()
    }

    fn check(&self, handle: ProxyHandle) -> Result<(), BroadPhaseError> {
        let is_alive = self.handles.is_alive(handle);
        is_alive.then_some(()).ok_or(BroadPhaseError::StaleHandle(handle))
    }

    /// Returns an error for the first stale handle; if there is none, for the smallest handle that
    /// occurs twice.
    fn check_all(&self, handles: &[ProxyHandle]) -> Result<(), BroadPhaseError> {
        handles.iter().try_for_each(|&handle| self.check(handle))?;
        let mut sorted = handles.to_vec();
        sort_few(&mut sorted, |one, other| one < other);
        let twice = sorted.windows(2).find(|two| two[0] == two[1]);
        twice.map_or(Ok(()), |two| Err(BroadPhaseError::RemovedTwice(two[0])))
    }

    /// Passes a group of found objects to `visit`, and returns the new limit. The group has 1 to
    /// [`GROUP`] objects.
    #[inline]
    fn propose(&self, found: &[(u32, N)], visit: &mut VisitProposals<'_, N, T>) -> N {
        let mut proposals = [Proposal::kept(&self.proxies, found[0].0, found[0].1); GROUP];
        for (proposal, &(id, key)) in proposals.iter_mut().zip(found) {
            *proposal = Proposal::kept(&self.proxies, id, key);
        }
        visit(&proposals[..found.len()])
    }

    fn push_all<'a>(&'a self, ids: &[u32], out: &mut Vec<&'a T>) {
        out.extend(ids.iter().map(|&id| data_of(&self.proxies, id)));
    }
}

/// Returns an error for a NaN or inverted box, which arithmetic on valid boxes can produce.
fn check_volume<N: Real, const D: usize>(
    bv: &Aabb<N, D>,
    handle: Option<ProxyHandle>,
) -> Result<(), BroadPhaseError> {
    let is_usable = (0..D).all(|axis| bv.mins()[axis] <= bv.maxs()[axis]);
    is_usable.then_some(()).ok_or(BroadPhaseError::BadVolume(handle))
}

impl<N: Space<D>, const D: usize, T> BroadPhase<N, Aabb<N, D>, T>
    for DBVTBroadPhase<N, Aabb<N, D>, T>
{
    fn try_create_proxy(
        &mut self,
        bv: Aabb<N, D>,
        data: T,
    ) -> Result<ProxyHandle, BroadPhaseError> {
        check_volume(&bv, None)?;
        let handle = self.handles.create();
        if self.proxies.len() <= handle.uid() {
            self.proxies.resize_with(handle.uid() + 1, || None);
        }
        self.proxies[handle.uid()] = Some(data);
        self.journal.note(ProxyNote::Created(handle));
        self.finder.insert(id_of(handle), bv);
        Ok(handle)
    }

    fn try_remove(
        &mut self,
        handles: &[ProxyHandle],
        callback: &mut dyn FnMut(&T, &T),
    ) -> Result<(), BroadPhaseError> {
        self.check_all(handles)?;
        let ids: Vec<u32> = handles.iter().copied().map(id_of).collect();
        for key in self.finder.pairs_of(&ids) {
            let (a, b) = unpack(key);
            callback(data_of(&self.proxies, a), data_of(&self.proxies, b));
        }
        for (&handle, &id) in handles.iter().zip(&ids) {
            self.finder.remove(id);
            self.handles.remove(handle);
            let data = self.proxies[handle.uid()].take();
            self.journal.note(ProxyNote::Removed(handle, data));
        }
        Ok(())
    }

    fn try_deferred_set_bounding_volume(
        &mut self,
        handle: ProxyHandle,
        bv: Aabb<N, D>,
    ) -> Result<(), BroadPhaseError> {
        self.check(handle)?;
        check_volume(&bv, Some(handle))?;
        self.finder.set(id_of(handle), bv);
        Ok(())
    }

    fn try_deferred_recompute_all_proximities_with(
        &mut self,
        handle: ProxyHandle,
    ) -> Result<(), BroadPhaseError> {
        self.check(handle)?;
        self.finder.refilter(id_of(handle));
        Ok(())
    }

    fn deferred_recompute_all_proximities(&mut self) {
        self.finder.refilter_all();
    }

    fn update(
        &mut self,
        filter: &mut dyn FnMut(&T, &T) -> bool,
        callback: &mut dyn FnMut(&T, &T, bool),
    ) {
        let proxies = &self.proxies;
        entries::find_pairs(
            &mut self.finder,
            &mut |a, b| filter(data_of(proxies, a), data_of(proxies, b)),
            &mut |a, b, started| callback(data_of(proxies, a), data_of(proxies, b), started),
        );
        if let Some(look) = self.recent.end_update(self.proxies.len()) {
            look.fit(&mut self.proxies);
            self.handles.fit(look);
        }
    }

    fn interferences_with_bounding_volume<'a>(&'a self, bv: &Aabb<N, D>, out: &mut Vec<&'a T>) {
        self.push_all(&self.finder.overlapping(bv), out);
    }

    fn interferences_with_ray<'a>(&'a self, ray: &Ray<N, D>, out: &mut Vec<&'a T>) {
        self.push_all(&self.finder.hit_by(ray), out);
    }

    fn interferences_with_point<'a>(&'a self, point: &Point<N, D>, out: &mut Vec<&'a T>) {
        self.push_all(&self.finder.containing(point), out);
    }

    fn num_interferences(&self) -> usize {
        self.finder.pairs().len()
    }

    fn proxy(&self, handle: ProxyHandle) -> Option<(&Aabb<N, D>, &T)> {
        self.check(handle).ok()?;
        let id = id_of(handle);
        Some((self.finder.exact(id), data_of(&self.proxies, id)))
    }

    fn visit_ray(&self, ray: &Ray<N, D>, max_time: N, visit: &mut dyn FnMut(&T) -> N) {
        let mut by_id = |id: u32, _: N| visit(data_of(&self.proxies, id));
        self.finder.visit_ray(ray, max_time, &mut by_id);
    }

    fn visit_ray_roughly(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        visit: &mut VisitProposals<'_, N, T>,
    ) {
        let mut by_ids = |found: &[(u32, N)]| self.propose(found, visit);
        self.finder.visit_ray_roughly(ray, max_time, &mut by_ids);
    }

    fn visit_nearest(&self, bv: &Aabb<N, D>, max_distance: N, visit: &mut dyn FnMut(&T) -> N) {
        let mut by_id = |id: u32, _: N| visit(data_of(&self.proxies, id));
        self.finder.visit_nearest(bv, max_distance, &mut by_id);
    }

    fn visit_nearest_roughly(
        &self,
        bv: &Aabb<N, D>,
        max_distance: N,
        visit: &mut VisitProposals<'_, N, T>,
    ) {
        let mut by_ids = |found: &[(u32, N)]| self.propose(found, visit);
        self.finder.visit_nearest_roughly(bv, max_distance, &mut by_ids);
    }

    fn visit_cast_roughly(
        &self,
        bv: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        max_time: N,
        visit: &mut VisitProposals<'_, N, T>,
    ) {
        let mut by_ids = |found: &[(u32, N)]| self.propose(found, visit);
        let sweep = Sweep { aabb: *bv, velocity: *velocity };
        self.finder.visit_cast_roughly(&sweep, max_time, &mut by_ids);
    }

    #[cfg(feature = "debug_render")]
    fn loosened(&self, handle: ProxyHandle) -> Option<Aabb<N, D>> {
        self.loosened_volume(handle)?.to_aabb()
    }

    #[cfg(feature = "debug_render")]
    fn visit_nodes(&self, visit: &mut dyn FnMut(&Aabb<N, D>)) {
        self.finder.each_node(&mut |bounds| bounds.to_aabb().iter().for_each(&mut *visit));
    }

    fn visit_cast(
        &self,
        bv: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        max_time: N,
        visit: &mut dyn FnMut(&T) -> N,
    ) {
        let mut by_id = |id: u32, _: N| visit(data_of(&self.proxies, id));
        self.finder.visit_cast(&Sweep { aabb: *bv, velocity: *velocity }, max_time, &mut by_id);
    }
}
