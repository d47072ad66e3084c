//! Ray casts against placed shapes.

use super::columns::AnswerColumns;
use super::control::Progress;
use super::entries;
use super::side::{PreparedSide, common_length, index_in};
use super::{BatchError, Control, HitColumns, Side};
use crate::bounding_volume::Ray;
use crate::math::{Point, Real, Space, Vector};
use crate::query::{RayBatch, RayIntersection, cast_at, cast_many_on};

/// A batch of rays in the world frame, as arrays of origins and directions: ray `i` is paired with
/// element `i` of a side. A single ray is paired with all elements, and a single element with all
/// rays.
///
/// The results have the bits of
/// [`RayCast::first_hit_with_ray`](crate::query::RayCast::first_hit_with_ray). Each ray is cast
/// against its own element only; to find the first hit among many shapes, use a world or a
/// [`Compound`](crate::shape::Compound).
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control, HitColumns, OnePose, RayColumns, Shapes, Side};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, place) = (Ball::new(1.0_f64), OnePose(Isometry::translation(5.0, 0.0)));
/// let side = Side::try_new(Shapes::One(&ball), &place)?;
/// let origins = [[0.0, 0.0], [0.0, 3.0], [5.0, 0.0]];
/// let rays = RayColumns::try_new(side, &origins, &[[2.0, 0.0]])?.until(10.0);
///
/// let (mut time, mut normal) = ([0.0; 3], [[0.0; 2]; 3]);
/// rays.cast(&Control::new(), HitColumns { time: &mut time, normal: &mut normal, ..Default::default() })?;
/// assert_eq!(time, [2.0, f64::INFINITY, 0.0], "the last starts inside");
/// assert_eq!(normal[0], [-1.0, 0.0]);
/// # Ok::<(), BatchError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RayColumns<'a, N: Real, const D: usize> {
    side: Side<'a, N, D>,
    origins: &'a [[N; D]],
    directions: &'a [[N; D]],
    max_time: N,
    solid: bool,
    len: usize,
}

impl<'a, N: Space<D>, const D: usize> RayColumns<'a, N, D> {
    /// Pairs each ray with the placed shape of the same index. A single ray is paired with all
    /// shapes, and a single shape with all rays; a single origin or direction is used for all rays.
    /// The rays have no maximum time. Time `t` is at the point `origin + t * direction`.
    ///
    /// # Errors
    /// [`BatchError::Length`] if two of the lengths differ and neither is 1.
    pub fn try_new(
        side: Side<'a, N, D>,
        origins: &'a [[N; D]],
        directions: &'a [[N; D]],
    ) -> Result<Self, BatchError> {
        let len = common_length(side.len(), ("origins", origins.len()))?;
        let len = common_length(len, ("directions", directions.len()))?;
        Ok(Self { side, origins, directions, max_time: N::INFINITY, solid: true, len })
    }

    /// Returns the rays with maximum time `max_time`; nothing is hit if it is negative or NaN.
    #[must_use]
    pub const fn until(self, max_time: N) -> Self {
        Self { max_time, ..self }
    }

    /// Returns the rays for hollow shapes: a ray that starts inside a shape hits the boundary where
    /// it leaves the shape.
    #[must_use]
    pub const fn hollow(self) -> Self {
        Self { solid: false, ..self }
    }

    /// Returns the number of rays.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Returns `true` if there is no ray.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Computes the first hit of each ray.
    ///
    /// # Errors
    /// [`BatchError::Length`] if a column is neither empty nor as long as the batch,
    /// [`BatchError::Cancelled`].
    pub fn cast(&self, control: &Control<'_>, out: HitColumns<'_, N, D>) -> Result<(), BatchError> {
        entries::cast(self, control, out)
    }

    #[inline]
    fn ray(&self, index: usize) -> Ray<N, D> {
        let origin = self.origins[index_in(self.origins.len(), index)];
        let direction = self.directions[index_in(self.directions.len(), index)];
        Ray::new(Point::from(origin), Vector::<N, D>::from(direction))
    }
}

/// Implements [`RayColumns::cast`].
pub(super) fn cast<N: Space<D>, const D: usize>(
    rays: &RayColumns<'_, N, D>,
    control: &Control<'_>,
    out: HitColumns<'_, N, D>,
) -> Result<(), BatchError> {
    out.check(rays.len)?;
    let side = PreparedSide::new(&rays.side);
    let alone = side.alone();
    Progress::new(control).run(rays.len, out, |range, mut out| {
        if let Some((shape, pose)) = alone {
            let local: Vec<_> =
                range.map(|index| rays.ray(index).inverse_transformed_by(&pose)).collect();
            let batch = RayBatch { rays: &local, max_time: rays.max_time, solid: rays.solid };
            return cast_many_on(shape, &batch, &mut |slot, hit| {
                let rotated = |hit: RayIntersection<N, D>| RayIntersection {
                    normal: pose.vector(&hit.normal),
                    ..hit
                };
                out.put(slot, hit.map(rotated).as_ref());
            });
        }
        for (slot, index) in range.enumerate() {
            let (shape, pose, ray) = (side.shape(index), side.pose(index), rays.ray(index));
            let hit = cast_at(shape, &pose, &ray, rays.max_time, rays.solid);
            out.put(slot, hit.as_ref());
        }
    })
}
