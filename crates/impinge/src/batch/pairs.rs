//! Pairs of placed shapes, element by element.

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

/// Two sides whose elements with one index are a pair.
///
/// One side may have a single element, which then stands against each of the other. The methods write the answer
/// about pair `i` into slot `i`, with the bits of the single call.
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
    /// The pairs of two sides with as many elements, or of one with a single element and another.
    ///
    /// # Errors
    /// [`BatchError::Length`] if neither has one element and they do not have as many.
    pub fn try_new(side1: Side<'a, N, D>, side2: Side<'a, N, D>) -> Result<Self, BatchError> {
        let len = common_length(side1.len(), ("side2", side2.len()))?;
        Ok(Self { sides: [side1, side2], len })
    }

    /// How many pairs there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// There is no pair.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// How far apart the solids of each pair are, zero if they touch or overlap: see [`distance`](crate::query::distance()).
    /// Infinite without an answer.
    ///
    /// Cost: that of the single calls, less what all elements of a side have in common. Where a limit will do,
    /// [`Self::closest_points`] and [`Self::proximities`] reject distant pairs by their bounding balls.
    ///
    /// # Errors
    /// [`BatchError::Length`] if `out` is not as long as the batch, [`BatchError::Cancelled`].
    pub fn distances(&self, control: &Control<'_>, out: &mut [N]) -> Result<(), BatchError> {
        entries::distances(self, control, out)
    }

    /// The nearest points of each pair that is at most `max_distance` apart: see
    /// [`closest_points`](crate::query::closest_points()).
    ///
    /// The distance is zero and the points are NaN where the solids touch or overlap; [`Self::witnesses`] has points
    /// there. A negative or NaN `max_distance` counts as zero.
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch, [`BatchError::Cancelled`].
    pub fn closest_points(
        &self,
        max_distance: N,
        control: &Control<'_>,
        out: ClosestColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::closest_points(self, max_distance, control, out)
    }

    /// The nearest or deepest points of each pair that is at most `max_distance` apart, with the parts and features
    /// that they lie on: see [`witness`](crate::query::witness()), also for negative limits.
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch, [`BatchError::Cancelled`].
    pub fn witnesses(
        &self,
        max_distance: N,
        control: &Control<'_>,
        out: WitnessColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::witnesses(self, max_distance, control, out)
    }

    /// Whether the solids of each pair touch or overlap, are at most `margin` apart, or neither: see
    /// [`proximity`](crate::query::proximity()). Disjoint without an answer.
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

    /// The deepest contact of each pair that overlaps, touches, or is at most `prediction` apart: see
    /// [`contact`](crate::query::contact()).
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch, [`BatchError::Cancelled`].
    pub fn contacts(
        &self,
        prediction: N,
        control: &Control<'_>,
        out: ContactColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::contacts(self, prediction, control, out)
    }

    /// When the solids of each pair first touch if they move with constant velocities and do not turn: see
    /// [`impact`](crate::query::impact()).
    ///
    /// `velocities` are those of the first and of the second side in the world frame, in units of length per unit of
    /// time: one for each pair, one for all, or none for solids at rest.
    ///
    /// # Errors
    /// [`BatchError::Length`] if there is another number of velocities, or a column is neither empty nor as long as
    /// the batch; [`BatchError::Cancelled`].
    pub fn impacts(
        &self,
        velocities: [&[[N; D]]; 2],
        options: &ImpactOptions<N>,
        control: &Control<'_>,
        out: ImpactColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::impacts(self, velocities, options, control, out)
    }

    /// The contact points of each pair, row by row: those that a new
    /// [`PairManifoldGenerator`](crate::narrow_phase::PairManifoldGenerator) finds, to the bit.
    ///
    /// `prediction` is how far apart, and after which turns, points count; manifolds have at most `max_points` points,
    /// at least one, and without it two in 2D and four in 3D. What `out` held is replaced; its memory is
    /// used again. Boxes, balls, segments and capsules are computed eight pairs at a time.
    ///
    /// # Errors
    /// [`BatchError::Cancelled`]; then `out` holds the rows of the first pairs, and how many these are is
    /// [`ManifoldRows::num_pairs`].
    pub fn manifolds(
        &self,
        prediction: &ContactPrediction<N>,
        max_points: Option<usize>,
        control: &Control<'_>,
        out: &mut ManifoldRows<N, D>,
    ) -> Result<(), BatchError> {
        entries::manifolds(self, (prediction, max_points), control, out)
    }

    /// The pair whose solids are nearest to each other, and their distance; of several the one of least index, and
    /// `None` if none are at most `max_distance` apart. A negative or NaN `max_distance` counts as zero.
    ///
    /// The limit shrinks to the least distance so far, so that most pairs are rejected by their bounding balls:
    /// cheaper than all [`Self::distances`]. The answer does not depend on the threads.
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

    /// Both sides, ready to be asked. Each is made where it stays: `map` over both copies them several times.
    #[inline]
    pub(super) fn prepared(&self) -> [PreparedSide<'a, N, D>; 2] {
        [PreparedSide::new(&self.sides[0]), PreparedSide::new(&self.sides[1])]
    }

    /// Calls with the elements of each pair and the slot of the answer in the columns of a chunk.
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

    /// Fills the slots with what follows from the distances of pairs that are at most a limit apart, and those of
    /// others with what stands for none.
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

    /// Calls with the slot of each pair and nothing, then with that of each that may be at most a limit apart and
    /// what is known of it.
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

    /// Calls with the pair of a batch of one, if it may be at most a limit apart: it takes less time than lists.
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

/// See [`PairBatch::distances`].
pub(super) fn distances<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    control: &Control<'_>,
    out: &mut [N],
) -> Result<(), BatchError> {
    batch.each_distance(N::INFINITY, control, out, N::INFINITY, |distance| max(distance, N::ZERO))
}

/// See [`PairBatch::closest_points`].
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

/// See [`PairBatch::witnesses`].
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

/// See [`PairBatch::proximities`].
pub(super) fn proximities<N: Space<D>, const D: usize>(
    batch: &PairBatch<'_, N, D>,
    margin: N,
    control: &Control<'_>,
    out: &mut [Proximity],
) -> Result<(), BatchError> {
    let margin = max(margin, N::ZERO);
    batch.each_distance(margin, control, out, Proximity::Disjoint, Proximity::within)
}

/// See [`PairBatch::contacts`].
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

/// See [`PairBatch::impacts`].
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

/// The velocity of an element: its own, that of all, or none.
#[inline]
fn velocity_at<N: Real, const D: usize>(column: &[[N; D]], index: usize) -> Vector<N, D> {
    match column.get(index_in(column.len(), index)) {
        Some(velocity) => Vector::<N, D>::from(*velocity),
        None => Vector::<N, D>::zeros(),
    }
}

/// See [`PairBatch::nearest`].
///
/// Each chunk begins with the nearest pair that any chunk has found by then. What it rejects for that is farther, or as
/// far and later by its index: so the least of all, by distance and then by index, does not depend on which
/// chunks came first.
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

/// The nearest of a range of pairs and one that is known.
fn nearest_of<N: Space<D>, const D: usize>(
    sides: &[PreparedSide<'_, N, D>; 2],
    range: Range<usize>,
    limit: N,
    known: Option<(usize, N)>,
) -> Option<(usize, N)> {
    let mut best = known;
    for index in range {
        // Nothing is nearer than what touches.
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

/// The nearer of two pairs, of two at one distance the one of lower index.
fn nearer<N: Real>(one: Option<(usize, N)>, other: Option<(usize, N)>) -> Option<(usize, N)> {
    let (Some((index1, distance1)), Some((index2, distance2))) = (one, other) else {
        return one.or(other);
    };
    let is_first = distance1 < distance2 || (distance1 == distance2 && index1 <= index2);
    if is_first { one } else { other }
}
