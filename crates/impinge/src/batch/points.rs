//! Queries of points against placed shapes.

use super::columns::AnswerColumns;
use super::control::Progress;
use super::entries;
use super::side::{PreparedSide, common_length, index_in};
use super::{BatchError, Control, ProjectionColumns, Side};
use crate::math::{Point, Pose, Real, Space};
use crate::query::{PointQuery, located_at};
use crate::shape::Shape;

/// A batch of points in the world frame: point `i` is paired with element `i` of a side. A single
/// point is paired with all elements, and a single element with all points.
///
/// The results have the bits of [`PointQuery`], which also defines the inside of composites and of
/// shapes without thickness.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control, OnePose, PointBatch, ProjectionColumns, Shapes, Side};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, place) = (Ball::new(2.0_f64), OnePose(Isometry::translation(10.0, 0.0)));
/// let side = Side::try_new(Shapes::One(&ball), &place)?;
/// let points = [[10.0, 5.0], [11.0, 0.0], [0.0, 0.0]];
/// let batch = PointBatch::try_new(side, &points)?;
///
/// let mut distance = [0.0; 3];
/// batch.signed_distances(&Control::new(), &mut distance)?;
/// assert_eq!(distance, [3.0, -1.0, 8.0]);
///
/// let mut point = [[0.0; 2]; 3];
/// let wanted = ProjectionColumns { point: &mut point, ..Default::default() };
/// batch.project(false, &Control::new(), wanted)?;
/// assert_eq!(point, [[10.0, 2.0], [12.0, 0.0], [8.0, 0.0]]);
/// # Ok::<(), BatchError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PointBatch<'a, N: Real, const D: usize> {
    side: Side<'a, N, D>,
    points: &'a [[N; D]],
    len: usize,
}

impl<'a, N: Space<D>, const D: usize> PointBatch<'a, N, D> {
    /// Pairs each point with the placed shape of the same index. A single point is paired with all
    /// shapes, and a single shape with all points.
    ///
    /// # Errors
    /// [`BatchError::Length`] if the lengths differ and neither is one.
    pub fn try_new(side: Side<'a, N, D>, points: &'a [[N; D]]) -> Result<Self, BatchError> {
        let len = common_length(side.len(), ("points", points.len()))?;
        Ok(Self { side, points, len })
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

    /// Projects each point onto its shape, or onto the boundary of its shape if `solid` is `false`.
    /// See [`PointQuery::project_point_with_location`].
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch,
    /// [`BatchError::Cancelled`].
    pub fn project(
        &self,
        solid: bool,
        control: &Control<'_>,
        out: ProjectionColumns<'_, N, D>,
    ) -> Result<(), BatchError> {
        entries::project(self, solid, control, out)
    }

    /// Computes the distance of each point from the boundary of its shape, negative inside;
    /// infinite without a result. See [`PointQuery::distance_to_point`].
    ///
    /// # Errors
    /// [`BatchError::Length`] if `out` is not as long as the batch, [`BatchError::Cancelled`].
    pub fn signed_distances(&self, control: &Control<'_>, out: &mut [N]) -> Result<(), BatchError> {
        entries::signed_distances(self, control, out)
    }

    /// Computes whether each point lies in its shape or on the boundary; `false` without a result.
    /// See [`PointQuery::contains_point`].
    ///
    /// # Errors
    /// [`BatchError::Length`] if `out` is not as long as the batch, [`BatchError::Cancelled`].
    pub fn contains(&self, control: &Control<'_>, out: &mut [bool]) -> Result<(), BatchError> {
        entries::contains(self, control, out)
    }

    /// Calls `answer` for each pair with its point and shape, the columns of the pair's chunk, and
    /// the index of the pair's slot in these columns. `answer` receives `None` instead of the point
    /// and shape if the point or the pose is not finite.
    fn each<C: AnswerColumns>(
        &self,
        control: &Control<'_>,
        out: C,
        answer: impl Fn(Option<PointQuestion<'a, N, D>>, &mut C, usize) + Sync,
    ) -> Result<(), BatchError> {
        out.check(self.len)?;
        let side = PreparedSide::new(&self.side);
        Progress::new(control).run(self.len, out, |range, mut columns| {
            for (slot, index) in range.enumerate() {
                let point = Point::from(self.points[index_in(self.points.len(), index)]);
                let question =
                    PointQuestion { shape: side.shape(index), pose: side.pose(index), point };
                answer(question.if_finite(), &mut columns, slot);
            }
        })
    }
}

/// One element of a [`PointBatch`]: a point in the world frame and a placed shape.
struct PointQuestion<'a, N: Real, const D: usize> {
    shape: &'a dyn Shape<N, D>,
    pose: Pose<N, D>,
    point: Point<N, D>,
}

impl<N: Real, const D: usize> PointQuestion<'_, N, D> {
    fn if_finite(self) -> Option<Self> {
        let is_finite = self.pose.is_finite() && self.point.iter().all(|x| x.is_finite_number());
        is_finite.then_some(self)
    }

    /// Returns the point in the local frame of the shape.
    fn local(&self) -> Point<N, D> {
        self.pose.inverse_point(&self.point)
    }
}

/// Implements [`PointBatch::project`].
pub(super) fn project<N: Space<D>, const D: usize>(
    batch: &PointBatch<'_, N, D>,
    solid: bool,
    control: &Control<'_>,
    out: ProjectionColumns<'_, N, D>,
) -> Result<(), BatchError> {
    batch.each(control, out, |question, out, slot| {
        let found = question.map(|q| located_at(q.shape, &q.pose, &q.point, solid));
        out.put(slot, found.as_ref());
    })
}

/// Implements [`PointBatch::signed_distances`].
pub(super) fn signed_distances<N: Space<D>, const D: usize>(
    batch: &PointBatch<'_, N, D>,
    control: &Control<'_>,
    out: &mut [N],
) -> Result<(), BatchError> {
    batch.each(control, out, |question, out, slot| {
        let distance = question.map(|q| q.shape.signed_distance_to_local_point(&q.local()));
        out[slot] = distance.unwrap_or(N::INFINITY);
    })
}

/// Implements [`PointBatch::contains`].
pub(super) fn contains<N: Space<D>, const D: usize>(
    batch: &PointBatch<'_, N, D>,
    control: &Control<'_>,
    out: &mut [bool],
) -> Result<(), BatchError> {
    batch.each(control, out, |question, out, slot| {
        out[slot] = question.is_some_and(|q| q.shape.contains_local_point(&q.local()));
    })
}
