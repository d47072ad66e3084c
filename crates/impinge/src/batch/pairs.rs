//! Queries of pairs of placed shapes, one result for each pair.

use super::entries;
use crate::collide::mesh::contact_in_world;
use crate::collide::separation::{distance_in_world, touching_in_world};
use crate::query::witness_in_world;
use core::ops::Range;
use std::sync::{Mutex, PoisonError};

use super::columns::{AnswerColumns, as_long_as};
use super::control::Progress;
use super::placed::{PairAnswer, PlacedPairs};
use super::side::{Element, PreparedSide, common_length, index_in, pair_at};
use super::{
    BatchError, ClosestColumns, ContactColumns, Control, ImpactColumns, ManifoldRows, Side,
    WitnessColumns,
};
use crate::chunks::Cut;
use crate::collide::{Placed, Placing};
use crate::math::{Real, Space, Vector, max};
use crate::narrow_phase::ContactPrediction;
use crate::query::{
    Contact, ImpactOptions, Moving, Proximity, Witness, distance_within, impact_of_pair,
    witness_between,
};

/// A batch of pairs: element `i` of one side is paired with element `i` of the other side.
///
/// A side of a single element is paired with every element of the other side. The methods write the
/// result of pair `i` to slot `i`, with the bits of the single call.
///
/// ```
/// use impinge::dim2::batch::{BatchError, ClosestColumns, Control, OnePose, PairBatch, Shapes, Side};
/// use impinge::dim2::math::{Isometry, Pose, Vector};
/// use impinge::dim2::shape::{Ball, Cuboid};
///
/// let (floor, ball) = (Cuboid::new(Vector::new(10.0_f64, 1.0)), Ball::new(0.5));
/// let (here, places) = (OnePose(Pose::identity()), [1.0, 2.0, 4.0].map(|y| Isometry::translation(0.0, y)));
/// let floors = Side::try_new(Shapes::One(&floor), &here)?;
/// let batch = PairBatch::try_new(floors, Side::try_new(Shapes::One(&ball), &places)?)?;
///
/// let mut distance = [0.0; 3];
/// batch.distances(&Control::new(), &mut distance)?;
/// assert_eq!(distance, [0.0, 0.5, 2.5]);
///
/// let mut point2 = [[0.0; 2]; 3];
/// let wanted = ClosestColumns { point2: &mut point2, ..Default::default() };
/// batch.closest_points(f64::INFINITY, &Control::new(), wanted)?;
/// assert_eq!(point2[2], [0.0, 3.5], "the foot of the last ball");
/// assert_eq!(batch.nearest(1.0, &Control::new())?, Some((0, 0.0)));
/// # Ok::<(), BatchError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PairBatch<'a, N: Real, const D: usize> {
    sides: [Side<'a, N, D>; 2],
    len: usize,
}

impl<'a, N: Space<D>, const D: usize> PairBatch<'a, N, D> {
    /// Pairs two sides of equal length, or a single element with each element of the other side.
    ///
    /// # Errors
    /// [`BatchError::Length`] if the lengths differ and neither is one.
    pub fn try_new(side1: Side<'a, N, D>, side2: Side<'a, N, D>) -> Result<Self, BatchError> {
        let len = common_length(side1.len(), ("side2", side2.len()))?;
        Ok(Self { sides: [side1, side2], len })
    }

    /// Returns the number of pairs.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Returns `true` if there is no pair.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Computes the distance of each pair: zero if the solids touch or overlap, infinite if the
    /// pair has no result. See [`distance`](crate::query::distance()).
    ///
    /// The cost is the sum of the single calls, except that data shared by all elements of a side
    /// is computed once. If a maximum distance suffices, [`Self::closest_points`] and
    /// [`Self::proximities`] reject distant pairs by their bounding balls.
    ///
    /// # Errors
    /// [`BatchError::Length`] if `out` is not as long as the batch, [`BatchError::Cancelled`].
    pub fn distances(&self, control: &Control<'_>, out: &mut [N]) -> Result<(), BatchError> {
        entries::distances(self, control, out)
    }

    /// Computes the nearest points of each pair that is at most `max_distance` apart: see
    /// [`closest_points`](crate::query::closest_points()).
    ///
    /// Where the solids touch or overlap, the distance is zero and the points are NaN;
    /// [`Self::witnesses`] computes points there too. A negative or NaN `max_distance` means zero.
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch,
    /// [`BatchError::Cancelled`].
    pub fn closest_points(
        &self,
        max_distance: N,
        control: &Control<'_>,
        out: ClosestColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::closest_points(self, max_distance, control, out)
    }

    /// Computes the nearest or deepest points of each pair that is at most `max_distance` apart,
    /// with the parts and features on which they lie. `max_distance` may be negative: see
    /// [`witness`](crate::query::witness()).
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch,
    /// [`BatchError::Cancelled`].
    pub fn witnesses(
        &self,
        max_distance: N,
        control: &Control<'_>,
        out: WitnessColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::witnesses(self, max_distance, control, out)
    }

    /// Computes whether the solids of each pair touch or overlap, are at most `margin` apart, or
    /// are farther apart: see [`proximity`](crate::query::proximity()). A negative or NaN `margin`
    /// means zero. A pair without a result is `Disjoint`.
    ///
    /// # Errors
    /// [`BatchError::Length`] if `out` is not as long as the batch, [`BatchError::Cancelled`].
    pub fn proximities(
        &self,
        margin: N,
        control: &Control<'_>,
        out: &mut [Proximity],
    ) -> Result<(), BatchError> {
        entries::proximities(self, margin, control, out)
    }

    /// Computes the deepest contact of each pair that overlaps, touches, or is at most `prediction`
    /// apart: see [`contact`](crate::query::contact()).
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch,
    /// [`BatchError::Cancelled`].
    pub fn contacts(
        &self,
        prediction: N,
        control: &Control<'_>,
        out: ContactColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::contacts(self, prediction, control, out)
    }

    /// Computes the time at which the solids of each pair first touch, or reach the target distance
    /// of `options`, if they move with constant velocities and do not rotate: see
    /// [`impact`](crate::query::impact()).
    ///
    /// `velocities` has a list for each side, in the world frame and in units of length per unit of
    /// time. A list has one velocity for each pair, or a single velocity for all pairs, or is empty
    /// for solids at rest.
    ///
    /// # Errors
    /// [`BatchError::Length`] if the length of a list of velocities is neither 0, 1 nor the number
    /// of pairs, or a column is neither empty nor as long as the batch; [`BatchError::Cancelled`].
    pub fn impacts(
        &self,
        velocities: [&[[N; D]]; 2],
        options: &ImpactOptions<N>,
        control: &Control<'_>,
        out: ImpactColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::impacts(self, velocities, options, control, out)
    }

    /// Computes the contact points of each pair as rows, with the bits of a new
    /// [`PairManifoldGenerator`](crate::narrow_phase::PairManifoldGenerator).
    ///
    /// `prediction` limits distances and rotations as in the generator. Manifolds have at most
    /// `max_points` points (0 means 1); by default (`None`) two in 2D and four in 3D. The content
    /// of `out` is replaced and its memory reused. Boxes, balls, segments and capsules are computed
    /// 8 pairs at a time.
    ///
    /// # Errors
    /// [`BatchError::Cancelled`]; then `out` holds the rows of the first
    /// [`ManifoldRows::num_pairs`] pairs.
    pub fn manifolds(
        &self,
        prediction: &ContactPrediction<N>,
        max_points: Option<usize>,
        control: &Control<'_>,
        out: &mut ManifoldRows<N, D>,
    ) -> Result<(), BatchError> {
        entries::manifolds(self, (prediction, max_points), control, out)
    }

    /// Returns the index and distance of the nearest pair; at equal distances the lowest index.
    /// `None` if no pair is at most `max_distance` apart. A negative or NaN `max_distance` means
    /// zero.
    ///
    /// The limit shrinks to the least distance found so far. So most pairs are usually rejected by
    /// their bounding balls, and the call is cheaper than [`Self::distances`]. The result does not
    /// depend on the number of threads.
    ///
    /// # Errors
    /// [`BatchError::Cancelled`].
    pub fn nearest(
        &self,
        max_distance: N,
        control: &Control<'_>,
    ) -> Result<Option<(usize, N)>, BatchError> {
        entries::nearest(self, max_distance, control)
    }

    /// Prepares both sides. Written without `map`, which would copy the sides several times.
    #[inline]
    pub(super) fn prepared(&self) -> [PreparedSide<'a, N, D>; 2] {
        [PreparedSide::new(&self.sides[0]), PreparedSide::new(&self.sides[1])]
    }

    /// Calls `answer` for each pair with both elements, the columns of the pair's chunk, and the
    /// index of the pair's slot in these columns.
    fn each<C: AnswerColumns>(
        &self,
        control: &Control<'_>,
        out: C,
        answer: impl Fn([Element<'_, 'a, N, D>; 2], &mut C, usize) + Sync,
    ) -> Result<(), BatchError> {
        out.check(self.len)?;
        self.each_chunk(control, out, |sides, range, columns| {
            for (slot, index) in range.enumerate() {
                answer(pair_at(sides, index), columns, slot);
            }
        })
    }

    /// Writes `answer(distance)` to the slot of each pair that is at most `limit` apart, and `none`
    /// to every other slot.
    fn each_distance<T: Copy + Send + Sync>(
        &self,
        limit: N,
        control: &Control<'_>,
        out: &mut [T],
        none: T,
        answer: impl Fn(N) -> T + Sync,
    ) -> Result<(), BatchError> {
        out.check(self.len)?;
        if self.len == 1 {
            out.fill(none);
            return self.alone(limit, control, out, |placed1, placed2, out| {
                let found = distance_in_world(placed1, placed2, limit);
                out[0] = found.map_or(none, &answer);
            });
        }
        self.each_chunk(control, out, |sides, range, out| {
            out.fill(none);
            let pairs = PlacedPairs::new(sides, range, limit);
            pairs.distances(|slot, distance| out[slot] = answer(distance));
        })
    }

    /// First calls `answer` with `None` for the slot of each pair. Then calls it with a
    /// [`PairAnswer`] for each pair that may be at most `limit` apart.
    fn each_separation<C: AnswerColumns>(
        &self,
        limit: N,
        control: &Control<'_>,
        mut out: C,
        answer: impl Fn(&mut C, usize, Option<PairAnswer<'_, 'a, N, D>>) + Sync,
    ) -> Result<(), BatchError> {
        out.check(self.len)?;
        if self.len == 1 {
            answer(&mut out, 0, None);
            return self.alone(limit, control, out, |placed1, placed2, out| {
                answer(out, 0, Some(PairAnswer::Alone([placed1, placed2])));
            });
        }
        self.each_chunk(control, out, |sides, range, columns| {
            (0..range.len()).for_each(|slot| answer(columns, slot, None));
            let pairs = PlacedPairs::new(sides, range, limit);
            pairs.separations(|slot, found| answer(columns, slot, Some(found)));
        })
    }

    /// In a batch of one pair, calls `answer` with the placed shapes if they may be at most `limit`
    /// apart. Builds no lists.
    fn alone<C: Cut>(
        &self,
        limit: N,
        control: &Control<'_>,
        out: C,
        answer: impl Fn(&Placed<'a, N, D>, &Placed<'a, N, D>, &mut C) + Sync,
    ) -> Result<(), BatchError> {
        let [side1, side2] = &self.sides;
        Progress::new(control).run(1, out, |_, mut out| {
            if let Some([placed1, placed2]) = Placed::within(&side1.alone(), &side2.alone(), limit)
            {
                answer(&placed1, &placed2, &mut out);
            }
        })
    }

    fn each_chunk<C: Cut>(
        &self,
        control: &Control<'_>,
        out: C,
        work: impl Fn(&[PreparedSide<'a, N, D>; 2], Range<usize>, &mut C) + Sync,
    ) -> Result<(), BatchError> {
        let sides = self.prepared();
        Progress::new(control)
            .run(self.len, out, |range, mut columns| work(&sides, range, &mut columns))
    }
}

/// Implements [`PairBatch::distances`].
pub(super) fn distances<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    control: &Control<'_>,
    out: &mut [N],
) -> Result<(), BatchError> {
    batch.each_distance(N::INFINITY, control, out, N::INFINITY, |distance| max(distance, N::ZERO))
}

/// Implements [`PairBatch::closest_points`].
pub(super) fn closest_points<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    max_distance: N,
    control: &Control<'_>,
    out: ClosestColumns<'_, N, D>,
) -> Result<(), BatchError> {
    let limit = max(max_distance, N::ZERO);
    batch.each_separation(limit, control, out, |out, slot, found| match found {
        None => out.put(slot, None),
        Some(PairAnswer::Convex(found)) => out.put(slot, Some(found)),
        Some(PairAnswer::Alone([one, other])) => {
            out.put(slot, touching_in_world(one, other, limit).as_ref());
        }
    })
}

/// Implements [`PairBatch::witnesses`].
pub(super) fn witnesses<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    limit: N,
    control: &Control<'_>,
    out: WitnessColumns<'_, N, D>,
) -> Result<(), BatchError> {
    if !(out.feature1.is_empty() && out.feature2.is_empty()) {
        return batch.each(control, out, |[one, other], out, slot| {
            out.put(slot, witness_between(&one, &other, limit, true).as_ref());
        });
    }
    batch.each_separation(limit, control, out, |out, slot, found| match found {
        None => out.put(slot, None),
        Some(PairAnswer::Convex(found)) => out.put(slot, Witness::of_separation(found).as_ref()),
        Some(PairAnswer::Alone([one, other])) => {
            out.put(slot, witness_in_world(one, other, limit, false).as_ref());
        }
    })
}

/// Implements [`PairBatch::proximities`].
pub(super) fn proximities<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    margin: N,
    control: &Control<'_>,
    out: &mut [Proximity],
) -> Result<(), BatchError> {
    let margin = max(margin, N::ZERO);
    batch.each_distance(margin, control, out, Proximity::Disjoint, Proximity::within)
}

/// Implements [`PairBatch::contacts`].
pub(super) fn contacts<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    prediction: N,
    control: &Control<'_>,
    out: ContactColumns<'_, N, D>,
) -> Result<(), BatchError> {
    batch.each_separation(prediction, control, out, |out, slot, found| match found {
        None => out.put(slot, None),
        Some(PairAnswer::Convex(found)) => out.put(slot, Contact::of_separation(found).as_ref()),
        Some(PairAnswer::Alone([one, other])) => {
            let found = contact_in_world(one, other, prediction);
            let contact = found.as_ref().and_then(Contact::of_separation);
            out.put(slot, contact.as_ref());
        }
    })
}

/// Implements [`PairBatch::impacts`].
pub(super) fn impacts<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    velocities: [&[[N; D]]; 2],
    options: &ImpactOptions<N>,
    control: &Control<'_>,
    out: ImpactColumns<'_, N, D>,
) -> Result<(), BatchError> {
    out.check(batch.len)?;
    for (argument, column) in ["velocities1", "velocities2"].into_iter().zip(velocities) {
        if column.len() > 1 {
            as_long_as(batch.len, argument, column)?;
        }
    }
    batch.each_chunk(control, out, |sides, range, out| {
        for (slot, index) in range.enumerate() {
            let [one, other] = pair_at(sides, index);
            let one = Moving { placed: one.placed(), velocity: velocity_at(velocities[0], index) };
            let velocity = velocity_at(velocities[1], index);
            let other = Moving { placed: other.placed(), velocity };
            out.put(slot, impact_of_pair(&one, &other, options).as_ref());
        }
    })
}

/// Returns the velocity of element `index`: the common velocity if `column` has length 1, zero if
/// it is empty, else the velocity at this index.
#[inline]
fn velocity_at<N: Real, const D: usize>(column: &[[N; D]], index: usize) -> Vector<N, D> {
    match column.get(index_in(column.len(), index)) {
        Some(velocity) => Vector::<N, D>::from(*velocity),
        None => Vector::<N, D>::zeros(),
    }
}

/// Implements [`PairBatch::nearest`].
///
/// Each chunk starts with the nearest pair that any chunk has found so far. It rejects only pairs
/// that are farther away, or equally far with a larger index. So the minimum by (distance, index)
/// does not depend on the order of the chunks.
pub(super) fn nearest<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    max_distance: N,
    control: &Control<'_>,
) -> Result<Option<(usize, N)>, BatchError> {
    let limit = max(max_distance, N::ZERO);
    let best = Mutex::new(None);
    batch.each_chunk(control, (), |sides, range, &mut ()| {
        let known = *best.lock().unwrap_or_else(PoisonError::into_inner);
        let found = nearest_of(sides, range, limit, known);
        let mut best = best.lock().unwrap_or_else(PoisonError::into_inner);
        *best = nearer(*best, found);
    })?;
    Ok(best.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Returns the nearest pair among `known` and the pairs in `range`; `None` if `known` is `None` and
/// no pair in `range` is within `limit`.
fn nearest_of<N: Space<D>, const D: usize>(
    sides: &[PreparedSide<'_, N, D>; 2],
    range: Range<usize>,
    limit: N,
    known: Option<(usize, N)>,
) -> Option<(usize, N)> {
    let mut best = known;
    for index in range {
        // A pair that touches is the nearest one, and all pairs that follow have larger indices.
        if best.is_some_and(|(first, distance)| distance <= N::ZERO && first < index) {
            break;
        }
        let limit = best.map_or(limit, |(_, distance)| distance);
        let [one, other] = pair_at(sides, index);
        let found = distance_within(&one, &other, limit).map(|distance| (index, distance));
        best = nearer(best, found);
    }
    best
}

/// Returns the nearer of two pairs, at equal distances the pair with the lower index; `None` if
/// both are `None`.
fn nearer<N: Real>(one: Option<(usize, N)>, other: Option<(usize, N)>) -> Option<(usize, N)> {
    let (Some((index1, distance1)), Some((index2, distance2))) = (one, other) else {
        return one.or(other);
    };
    let is_first = distance1 < distance2 || (distance1 == distance2 && index1 <= index2);
    if is_first { one } else { other }
}
