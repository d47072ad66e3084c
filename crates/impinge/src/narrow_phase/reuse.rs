//! Contacts kept while a pair hardly moves: an approximation that users may ask for.
//!
//! To most pairs of a scene that comes to rest a step brings a thousandth of a size, and what a fresh query
//! would find is what was found before, moved along. So the pose of a pair at its last query is kept (its
//! *reference*), and while no point of the smaller solid has moved farther from there than a tolerance,
//! beside the other, the points stay: each where it was on both solids, with its distance measured anew
//! along the normal. This is the contact recycling of Box2D and Box3D (E. Catto), with motion measured
//! from the last query rather than from step to step, so that what is kept cannot drift.
//!
//! Signed distances change by no more than their solids move. Those that are handed on are therefore at
//! most twice the tolerance off those of a query, and as far beyond the prediction; the nearest is within it.

use core::fmt;

use smallvec::SmallVec;

use super::ObjectTable;
use super::entry::{ContactEntry, ContactView};
use super::group::{PairKey, Rows};
use super::state::{KeptContacts, KeptPoints};
use crate::math::{Mapped, Pose, Real, Space, max, min};

/// A tolerance of motion is negative, infinite or NaN.
///
/// ```
/// use impinge::dim3::narrow_phase::{DefaultNarrowPhase, ReuseError};
///
/// let refused = DefaultNarrowPhase::<f32>::new().try_reusing(-1.0).err();
/// assert_eq!(refused, Some(ReuseError { value: -1.0 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReuseError {
    /// The number, exactly.
    pub value: f64,
}

impl fmt::Display for ReuseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the tolerance is {}: it must be finite and not negative", self.value)
    }
}

impl std::error::Error for ReuseError {}

/// The tolerance, if it is finite and not negative.
pub(super) fn usable_tolerance<N: Real>(tolerance: N) -> Result<N, ReuseError> {
    if tolerance < N::ZERO || !tolerance.is_finite_number() {
        return Err(ReuseError { value: tolerance.as_f64() });
    }
    Ok(tolerance)
}

/// A pair as it was when its contacts were computed.
#[derive(Clone, Debug)]
pub(crate) struct Reference<N: Real, const D: usize> {
    /// The pose of the solid in whose frame contacts are kept in that of the other.
    pose21: Pose<N, D>,
    /// How far the points that matter are from the origin of that solid at most; infinite if nothing can be
    /// kept.
    reach: N,
    /// For so many updates nothing is held against this, nor noted: the pair is fast.
    pause: u8,
    /// Of the contacts, in their order.
    distances: SmallVec<[N; 4]>,
}

/// A pair that has moved by so many times what may be kept is fast.
const FAST: f64 = 4.0;
/// So many updates of a fast pair are not noted before one is, for the next to be held against: where
/// everything moves fast, that is what keeping contacts costs.
const PAUSE: u8 = 6;

impl<N: Real, const D: usize> Default for Reference<N, D> {
    fn default() -> Self {
        let (pose21, distances) = (Pose::identity(), SmallVec::new());
        Self { pose21, reach: N::INFINITY, pause: 0, distances }
    }
}

impl<N: Space<D>, const D: usize> Reference<N, D> {
    /// Moves the contacts of a pair along, if it has moved so little that this will do; `pose21` is how its solids lie
    /// now.
    ///
    /// Nobody may miss a contact of solids that overlap: where less than the tolerance is predicted, no
    /// motion beyond that counts as little.
    #[inline]
    pub(super) fn keeps<S: KeptPoints<N, D>>(
        &mut self,
        state: &mut S,
        pose21: impl FnOnce() -> Pose<N, D>,
        [tolerance, prediction]: [N; 2],
    ) -> bool {
        if self.pause > 0 {
            self.pause -= 1;
            return false;
        }
        if !self.reach.is_finite_number() {
            return false;
        }
        let pose21 = pose21();
        let (motion, limit) = (self.motion(&pose21), min(tolerance, prediction));
        if motion > limit * N::lit(FAST) {
            self.pause = PAUSE;
        }
        motion < limit && self.measure(&pose21, state, prediction)
    }

    /// Holds the contacts, which were computed just now, and how the solids lie; `reaches` are those of the solids, the
    /// one in whose frame contacts are kept first.
    #[inline]
    pub(super) fn note<S: KeptPoints<N, D>>(
        &mut self,
        state: &mut S,
        pose21: impl FnOnce() -> Pose<N, D>,
        reaches: impl FnOnce() -> [N; 2],
    ) {
        if self.pause > 0 {
            return;
        }
        self.pose21 = pose21();
        // Solids meet where both of them are: of one without end, or larger, only what is near the other
        // counts.
        let [own, others] = reaches();
        self.reach = min(own, self.pose21.translation.norm() + others);
        self.distances.clear();
        state.each_point(|_, distance, _| self.distances.push(*distance));
    }

    /// How far a point of the first solid has come from where it was, beside the second, at most; no
    /// number or infinite if that is not known.
    fn motion(&self, pose21: &Pose<N, D>) -> N {
        // The Frobenius norm of a difference of rotations is no less than its greatest stretch.
        let turn = (pose21.rotation - self.pose21.rotation).norm();
        (pose21.translation - self.pose21.translation).norm() + turn * self.reach
    }

    /// Measures the distance of each contact, whose points are fixed to the solids, along its normal in
    /// the first of them. Answers whether one is within `limit`, or there is none: of many contacts one or the
    /// other leaves the prediction at every step, which ends nothing.
    ///
    /// With x ↦ R x + t for `pose21` and R' and t' for that of the reference, a point p of the first solid
    /// and the one opposite, by d n, were at R' p + t' and R' (p + d n) + t'. Of the second one's way to the
    /// first as it is now, (R' − R) p + (t' − t) + d R' n, the part along R n is the distance: only
    /// differences that are small, so that little is lost far away from the origin.
    fn measure<S: KeptPoints<N, D>>(&self, pose21: &Pose<N, D>, state: &mut S, limit: N) -> bool {
        let turned = self.pose21.rotation - pose21.rotation;
        let moved = self.pose21.translation - pose21.translation;
        let (mut index, mut is_near) = (0, false);
        state.each_point(|normal, distance, point| {
            let outer = pose21.rotation * normal;
            let (slope, shift) = (turned.tr_mul(&outer), outer.dot(&moved));
            let scale = outer.dot(&(self.pose21.rotation * normal));
            let before = self.distances[index];
            *distance = slope.dot(&point.coords) + shift + scale * before;
            is_near |= *distance <= max(limit, before);
            index += 1;
        });
        is_near || index == 0
    }
}

/// What it takes to keep contacts: where objects are, and how far they may have moved.
#[derive(Clone, Copy)]
pub(super) struct Reuse<'t, N: Space<D>, const D: usize> {
    pub(super) table: &'t ObjectTable<N, D>,
    pub(super) tolerance: N,
}

/// The rows of pairs that the library computes contacts for.
type KeptRows<'a, N, S, V, const D: usize> =
    Rows<'a, ContactEntry<N, S>, ContactView<V>, Reference<N, D>>;

impl<N: Space<D>, const D: usize> Reuse<'_, N, D> {
    /// Moves the contacts of a pair along, if it has moved so little that this will do. Nothing is said
    /// about it in events: there are as many contacts as before.
    #[inline]
    pub(super) fn keeps<S: KeptContacts<N, D>>(
        &self,
        rows: &mut KeptRows<'_, N, S, S::Manifolds, D>,
        place: usize,
    ) -> bool {
        !rows.references.is_empty() && self.moves_along(rows, place)
    }

    /// [`Self::keeps`] of pairs that have references.
    fn moves_along<S: KeptContacts<N, D>>(
        &self,
        rows: &mut KeptRows<'_, N, S, S::Manifolds, D>,
        place: usize,
    ) -> bool {
        let (key, entry) = (rows.keys[place], &mut rows.states[place]);
        let (is_swapped, limits) =
            (entry.state.is_swapped(), [self.tolerance, entry.request.prediction]);
        let pose21 = || self.pose21(key, is_swapped);
        let is_kept = rows.references[place].keeps(&mut entry.state, pose21, limits);
        if is_kept {
            ContactView::expire_any(rows.views.get_mut(place));
        }
        is_kept
    }

    /// Makes the poses and contacts of a pair, which were computed just now, its reference.
    #[inline]
    pub(super) fn note<S: KeptContacts<N, D>>(
        &self,
        rows: &mut KeptRows<'_, N, S, S::Manifolds, D>,
        place: usize,
    ) {
        let (key, state) = (rows.keys[place], &mut rows.states[place].state);
        let Some(reference) = rows.references.get_mut(place) else { return };
        let is_swapped = state.is_swapped();
        let reaches =
            || home_first(key, is_swapped).mapped(|object| self.table.bounds(object).reach());
        reference.note(state, || self.pose21(key, is_swapped), reaches);
    }

    /// The pose of the solid in whose frame contacts are kept in that of the other.
    fn pose21(&self, key: PairKey, is_swapped: bool) -> Pose<N, D> {
        let [home, other] = home_first(key, is_swapped);
        Pose::relative(self.table.pose(other), self.table.pose(home))
    }
}

/// The object in whose frame contacts are kept, then the other.
const fn home_first([first, second]: PairKey, is_swapped: bool) -> [u32; 2] {
    if is_swapped { [second, first] } else { [first, second] }
}
