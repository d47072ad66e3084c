//! Contact reuse, an option: a pair keeps its contacts while it hardly moves.
//!
//! In a scene that comes to rest, most pairs move by a thousandth of their size in a step, and a
//! new query would find the old points, moved along with the solids. So the relative pose of a pair
//! at its last query is kept, as its *reference*. While no point of the smaller solid has moved
//! farther than a tolerance since then, relative to the other solid, the points stay fixed to both
//! solids, and their distances are measured again along the normal. This is the contact recycling
//! of Box2D and Box3D (E. Catto), but with the motion measured from the last query instead of from
//! the last step, so that errors do not accumulate.
//!
//! A signed distance changes by no more than the motion of its solids. So a reused distance differs
//! from the distance that a new query would find by at most twice the tolerance, and may exceed the
//! prediction by as much. Contacts are not reused if all of them are beyond the prediction and
//! farther apart than at the last query.

use core::fmt;

use smallvec::SmallVec;

use super::ObjectTable;
use super::entry::{ContactEntry, ContactView};
use super::group::{PairKey, Rows};
use super::state::{KeptContacts, KeptPoints};
use crate::math::{Mapped, Pose, Real, Space, max, min};

/// The tolerance of contact reuse is negative, infinite or NaN.
///
/// ```
/// use impinge::dim3::narrow_phase::{DefaultNarrowPhase, ReuseError};
///
/// let refused = DefaultNarrowPhase::<f32>::new().try_reusing(-1.0).err();
/// assert_eq!(refused, Some(ReuseError { value: -1.0 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReuseError {
    /// The refused tolerance, converted to `f64`.
    pub value: f64,
}

impl fmt::Display for ReuseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the tolerance is {}: it must be finite and not negative", self.value)
    }
}

impl std::error::Error for ReuseError {}

/// Returns the tolerance if it is finite and not negative, else an error.
pub(super) fn usable_tolerance<N: Real>(tolerance: N) -> Result<N, ReuseError> {
    if tolerance < N::ZERO || !tolerance.is_finite_number() {
        return Err(ReuseError { value: tolerance.as_f64() });
    }
    Ok(tolerance)
}

/// The relative pose and the contact distances of a pair at the last computation of its contacts.
#[derive(Clone, Debug)]
pub(crate) struct Reference<N: Real, const D: usize> {
    /// Pose of the solid in whose frame contacts are stored, relative to the other solid.
    pub(super) pose21: Pose<N, D>,
    /// Bounding radius, about the origin of the frame in which contacts are stored, of the points
    /// whose motion matters. Infinite if the contacts cannot be reused.
    pub(super) reach: N,
    /// Number of further updates in which the reference is neither compared nor set, because the
    /// pair is fast.
    pub(super) pause: u8,
    /// Signed distance of each contact at the last query, in the order of the contacts.
    pub(super) distances: SmallVec<[N; 4]>,
}

/// A pair is fast if it has moved by more than `FAST` times the limit of reuse (see
/// [`Reference::keeps`]).
const FAST: f64 = 4.0;
/// Number of updates that a fast pair skips before its reference is set again. This bounds the cost
/// of reuse in scenes where all objects move fast.
const PAUSE: u8 = 6;

impl<N: Real, const D: usize> Default for Reference<N, D> {
    fn default() -> Self {
        let (pose21, distances) = (Pose::identity(), SmallVec::new());
        Self { pose21, reach: N::INFINITY, pause: 0, distances }
    }
}

impl<N: Space<D>, const D: usize> Reference<N, D> {
    /// Measures the distances of the contacts again if the pair has moved by less than the limit
    /// since the last query. Returns `true` if it did, and a contact is within the prediction or
    /// within its old distance, or there are no contacts. Returns `false` during a pause. `pose21`
    /// returns the present relative pose.
    ///
    /// The limit is the smaller of `tolerance` and `prediction`, so that no contact of overlapping
    /// solids is missed.
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

    /// Stores the relative pose and the distances of the contacts, which were just computed, as the
    /// reference; does nothing during a pause. `reaches` returns the bounding radii of the solids,
    /// first of the solid in whose frame contacts are stored.
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
        // Contacts lie on both solids: if the first solid is unbounded or larger, only its part
        // near the other solid matters.
        let [own, others] = reaches();
        self.reach = min(own, self.pose21.translation.norm() + others);
        self.distances.clear();
        state.each_point(|_, distance, _| self.distances.push(*distance));
    }

    /// Returns an upper bound of the motion, since the last query and relative to the other solid,
    /// of a point within `reach` of the origin; NaN or infinite if there is no bound.
    fn motion(&self, pose21: &Pose<N, D>) -> N {
        // The Frobenius norm of a difference of rotations bounds its spectral norm.
        let rotation_change = (pose21.rotation - self.pose21.rotation).norm();
        (pose21.translation - self.pose21.translation).norm() + rotation_change * self.reach
    }

    /// Measures the distance of each contact along its normal, which is fixed to the first solid;
    /// both points are fixed to their solids. Returns `true` if a contact is within `limit` or
    /// within its old distance, or if there is no contact. A single contact that leaves the
    /// prediction does not end the reuse, because in a pair with many contacts this happens at most
    /// steps.
    ///
    /// `pose21` maps x to R x + t, and the reference maps x to R' x + t'. A point p of the first
    /// solid and its opposite point, at distance d along n, were at R' p + t' and R' (p + d n) +
    /// t'. The new distance is the component along R n of the vector from the present position of
    /// the first point to the opposite point: (R' − R) p + (t' − t) + d R' n. Only small
    /// differences occur, so little precision is lost far from the origin.
    fn measure<S: KeptPoints<N, D>>(&self, pose21: &Pose<N, D>, state: &mut S, limit: N) -> bool {
        let rotation_change = self.pose21.rotation - pose21.rotation;
        let translation_change = self.pose21.translation - pose21.translation;
        let (mut index, mut is_near) = (0, false);
        state.each_point(|normal, distance, point| {
            let outer = pose21.rotation * normal;
            let (slope, shift) = (rotation_change.tr_mul(&outer), outer.dot(&translation_change));
            let scale = outer.dot(&(self.pose21.rotation * normal));
            let before = self.distances[index];
            *distance = slope.dot(&point.coords) + shift + scale * before;
            is_near |= *distance <= max(limit, before);
            index += 1;
        });
        is_near || index == 0
    }
}

/// The object table and the tolerance of contact reuse in an update.
#[derive(Clone, Copy)]
pub(super) struct Reuse<'t, N: Space<D>, const D: usize> {
    pub(super) table: &'t ObjectTable<N, D>,
    pub(super) tolerance: N,
}

/// The rows of some pairs of one group with built-in contacts, with all of their columns.
type KeptRows<'a, N, S, V, const D: usize> =
    Rows<'a, ContactEntry<N, S>, ContactView<V>, Reference<N, D>>;

impl<N: Space<D>, const D: usize> Reuse<'_, N, D> {
    /// Returns `true` if the group has references and [`Reference::keeps`] returns `true`; the
    /// contacts then have their new distances. The number of contacts does not change, so there are
    /// no events.
    #[inline]
    pub(super) fn keeps<S: KeptContacts<N, D>>(
        &self,
        rows: &mut KeptRows<'_, N, S, S::Manifolds, D>,
        row: usize,
    ) -> bool {
        !rows.references.is_empty() && self.moves_along(rows, row)
    }

    /// Implements [`Self::keeps`] for groups that have references.
    fn moves_along<S: KeptContacts<N, D>>(
        &self,
        rows: &mut KeptRows<'_, N, S, S::Manifolds, D>,
        row: usize,
    ) -> bool {
        let (key, entry) = (rows.keys[row], &mut rows.states[row]);
        let (is_swapped, limits) =
            (entry.state.is_swapped(), [self.tolerance, entry.request.prediction]);
        let pose21 = || self.pose21(key, is_swapped);
        let is_kept = rows.references[row].keeps(&mut entry.state, pose21, limits);
        if is_kept {
            ContactView::expire_any(rows.views.get_mut(row));
        }
        is_kept
    }

    /// Stores the present poses and contacts of a pair, which were just computed, as its reference.
    #[inline]
    pub(super) fn note<S: KeptContacts<N, D>>(
        &self,
        rows: &mut KeptRows<'_, N, S, S::Manifolds, D>,
        row: usize,
    ) {
        let (key, state) = (rows.keys[row], &mut rows.states[row].state);
        let Some(reference) = rows.references.get_mut(row) else { return };
        let is_swapped = state.is_swapped();
        let reaches =
            || kept_order(key, is_swapped).mapped(|object| self.table.bounds(object).reach());
        reference.note(state, || self.pose21(key, is_swapped), reaches);
    }

    /// Returns the pose of the solid in whose frame contacts are stored, relative to the other
    /// solid.
    fn pose21(&self, key: PairKey, is_swapped: bool) -> Pose<N, D> {
        let [first, other] = kept_order(key, is_swapped);
        Pose::relative(self.table.pose(other), self.table.pose(first))
    }
}

/// Returns both objects of a pair, first the object in whose frame contacts are stored.
const fn kept_order([first, second]: PairKey, is_swapped: bool) -> [u32; 2] {
    if is_swapped { [second, first] } else { [first, second] }
}
