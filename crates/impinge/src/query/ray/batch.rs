//! Batches of rays that are cast against one shape.

use core::ops::{ControlFlow, Range};

use super::RayIntersection;
use crate::bounding_volume::Ray;
use crate::chunks::each_chunk;
use crate::math::Real;

/// Rays that are cast together, with the options that they share.
///
/// See [`RayCast::cast_local_rays`](super::RayCast::cast_local_rays).
///
/// ```
/// use impinge::dim2::math::{Isometry, Point, Vector};
/// use impinge::dim2::query::{Ray, RayBatch, RayCast};
/// use impinge::dim2::shape::Ball;
///
/// let rays = [0.0, 0.5, 5.0].map(|y| Ray::new(Point::new(-4.0_f64, y), Vector::x()));
/// let mut hits = [None; 3];
/// Ball::new(1.0).cast_rays(&Isometry::identity(), &RayBatch::new(&rays).until(10.0), &mut hits);
/// assert_eq!(hits.map(|hit| hit.is_some()), [true, true, false]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RayBatch<'a, N: Real, const D: usize> {
    /// The rays.
    pub rays: &'a [Ray<N, D>],
    /// The latest time of a hit, inclusive, in units of the direction of each ray.
    pub max_time: N,
    /// Whether a ray that starts inside hits at time zero; see [`RayCast`](super::RayCast).
    pub solid: bool,
}

impl<'a, N: Real, const D: usize> RayBatch<'a, N, D> {
    /// Returns a batch of rays of unlimited length, against solids.
    #[must_use]
    pub const fn new(rays: &'a [Ray<N, D>]) -> Self {
        Self { rays, max_time: N::INFINITY, solid: true }
    }

    /// Returns the batch with [`Self::max_time`] replaced.
    #[must_use]
    pub const fn until(self, max_time: N) -> Self {
        Self { max_time, ..self }
    }

    /// Returns the batch with [`Self::solid`] set to false: rays that start inside a shape hit
    /// where they leave it.
    #[must_use]
    pub const fn hollow(self) -> Self {
        Self { solid: false, ..self }
    }

    /// Writes the result of each ray to the entry with the ray's index.
    ///
    /// # Panics
    /// If `answers` does not have as many entries as there are rays.
    #[track_caller]
    pub(crate) fn each<A>(&self, answers: &mut [A], mut answer: impl FnMut(&Ray<N, D>) -> A) {
        self.check(answers.len());
        for (ray, slot) in self.rays.iter().zip(answers) {
            *slot = answer(ray);
        }
    }

    /// Computes the results chunk by chunk; with the feature `parallel` on several threads.
    #[track_caller]
    pub(super) fn each_chunk(
        &self,
        hits: &mut [Option<RayIntersection<N, D>>],
        answer: impl Fn(&Self, &mut [Option<RayIntersection<N, D>>]) + Sync,
    ) {
        self.check(hits.len());
        let work = |range: Range<usize>, hits: &mut [_]| {
            answer(&Self { rays: &self.rays[range], ..*self }, hits);
            ControlFlow::Continue(())
        };
        _ = each_chunk(0..self.rays.len(), hits, &work);
    }

    #[track_caller]
    fn check(&self, slots: usize) {
        assert_eq!(slots, self.rays.len(), "a batch of rays needs a place for each answer");
    }
}
