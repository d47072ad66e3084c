//! Batches of rays.

use core::ops::{ControlFlow, Range};

use super::RayIntersection;
use crate::bounding_volume::Ray;
use crate::chunks::each_chunk;
use crate::math::Real;

/// Rays that are cast together, with their common options.
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
    /// Hits after this time do not count; in units of the direction of each ray.
    pub max_time: N,
    /// A ray that starts inside hits at time zero; see [`RayCast`](super::RayCast).
    pub solid: bool,
}

impl<'a, N: Real, const D: usize> RayBatch<'a, N, D> {
    /// Rays of unlimited length, against solids.
    #[must_use]
    pub const fn new(rays: &'a [Ray<N, D>]) -> Self {
        Self { rays, max_time: N::INFINITY, solid: true }
    }

    /// Returns the rays with another [`Self::max_time`].
    #[must_use]
    pub const fn until(self, max_time: N) -> Self {
        Self { max_time, ..self }
    }

    /// Returns the rays against boundaries: those that start inside a shape hit where they leave
    /// it.
    #[must_use]
    pub const fn hollow(self) -> Self {
        Self { solid: false, ..self }
    }

    /// Writes the answer of each ray to the entry with its index.
    #[track_caller]
    pub(crate) fn each<A>(&self, answers: &mut [A], mut answer: impl FnMut(&Ray<N, D>) -> A) {
        self.check(answers.len());
        for (ray, place) in self.rays.iter().zip(answers) {
            *place = answer(ray);
        }
    }

    /// Computes the answers chunk by chunk; with the feature `parallel` on several threads.
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
    fn check(&self, places: usize) {
        assert_eq!(places, self.rays.len(), "a batch of rays needs a place for each answer");
    }
}
