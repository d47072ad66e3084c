//! The nearest point of a boundary, and the rules by which a query point is treated as inside.

use super::PointProjection;
use crate::math::{Point, Real, Vector, max, max_component, unit};
use crate::shape::FeatureId;

/// The point of a solid's boundary that is nearest to a query point, in the local frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfacePoint<N: Real, const D: usize> {
    pub(crate) point: Point<N, D>,
    pub(crate) feature: FeatureId,
    /// Whether the query point lies in the solid or on its boundary.
    pub(crate) is_inside: bool,
}

impl<N: Real, const D: usize> SurfacePoint<N, D> {
    /// Returns the nearest point for a query point outside, or on a set without interior.
    pub(super) const fn on(point: Point<N, D>, feature: FeatureId) -> Self {
        Self { point, feature, is_inside: false }
    }

    /// Returns the nearer of two points to `query`; `self` if they are equally near.
    pub(super) fn nearer(self, other: Self, query: &Point<N, D>) -> Self {
        if self.is_beaten_by(&other, query) { other } else { self }
    }

    /// Returns whether `other` is nearer to `query` than `self`.
    pub(super) fn is_beaten_by(&self, other: &Self, query: &Point<N, D>) -> bool {
        let (first, second) = (query - self.point, query - other.point);
        let (square1, square2) = (first.norm_squared(), second.norm_squared());
        // The squares of very large and very small lengths overflow and underflow.
        let usable = |square: N| square > N::MIN_POSITIVE && square < N::INFINITY;
        match usable(square1) && usable(square2) {
            true => square2 < square1,
            false => length(&second) < length(&first),
        }
    }

    /// Replaces the nearest point by `query` if the two are equal within rounding: a query point
    /// within rounding of a set without thickness is treated as lying on it.
    ///
    /// `reach` is the largest distance of the set from the local origin. The rounding error of
    /// coordinates is proportional to it and to the coordinates of the query point.
    pub(super) fn snapped(self, query: &Point<N, D>, reach: N) -> Self {
        let scale = max(max_component(&query.coords), reach);
        let near = length(&(query - self.point)) <= N::lit(8.0) * N::EPSILON * scale;
        if near { Self { point: *query, ..self } } else { self }
    }

    /// Converts to the public form. A point that is its own projection is inside, even if
    /// `self.is_inside` is false. So a point outside has a positive distance.
    pub(crate) fn projection(self, query: &Point<N, D>) -> (PointProjection<N, D>, FeatureId) {
        let finite = query.iter().all(|x| x.is_finite_number());
        let touches = self.is_inside || length(&(query - self.point)) == N::ZERO;
        let is_inside = finite && touches;
        (PointProjection { is_inside, point: self.point }, self.feature)
    }
}

/// Returns the length of a vector, correct also if its square overflows or underflows; NaN for NaN.
pub(crate) fn length<N: Real, const D: usize>(v: &Vector<N, D>) -> N {
    unit(v).map_or_else(|| v.norm(), |(_, length)| length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiny_lengths_are_not_zero() {
        let tiny = Vector::<f32, 2>::new(3e-30, 4e-30);
        assert!((length(&tiny) / 5e-30 - 1.0).abs() < 1e-6, "{}", length(&tiny));
        assert_eq!(length(&Vector::<f32, 3>::zeros()), 0.0, "zero stays");
        assert!(length(&Vector::<f32, 3>::new(f32::NAN, 0.0, 0.0)).is_nan(), "NaN stays");
    }
}
