//! Integrals over a body, as sums over its pieces.

use crate::math::{Matrix, Point, Real, Vector, f64_power_of_two_below};
use crate::shape::Moments;

/// The frame in which a shape is integrated: in doubles, about the shape's centre, in units of
/// about its size.
///
/// So the distance from the origin does not affect the accuracy, and no power of a length overflows
/// or underflows. The unit is a power of two: scaling the shape by a power of two scales the result
/// exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalUnits<const D: usize> {
    pub(super) origin: Vector<f64, D>,
    pub(super) scale: f64,
}

impl<const D: usize> LocalUnits<D> {
    /// Returns the units for the set of points within `radius` of the given points.
    pub(super) fn around<'p, N: Real>(
        points: impl IntoIterator<Item = &'p Point<N, D>>,
        radius: N,
    ) -> Self {
        let mut mins = Vector::<f64, D>::repeat(f64::INFINITY);
        let mut maxs = -mins;
        for point in points {
            let position = point.coords.map(N::as_f64);
            mins = mins.zip_map(&position, |a, b| if b < a { b } else { a });
            maxs = maxs.zip_map(&position, |a, b| if b > a { b } else { a });
        }
        let half = maxs * 0.5 - mins * 0.5;
        let size = half.iter().fold(radius.as_f64(), |size, &x| if x > size { x } else { size });
        Self { origin: mins * 0.5 + maxs * 0.5, scale: f64_power_of_two_below(size) }
    }

    /// Returns units about the origin of the shape's frame, for a shape of the given size.
    pub(super) fn about_origin(size: f64) -> Self {
        Self { origin: Vector::<f64, D>::zeros(), scale: f64_power_of_two_below(size) }
    }

    pub(super) fn length<N: Real>(&self, length: N) -> f64 {
        length.as_f64() / self.scale
    }

    pub(super) fn vector<N: Real>(&self, vector: &Vector<N, D>) -> Vector<f64, D> {
        vector.map(|x| x.as_f64() / self.scale)
    }

    pub(super) fn point<N: Real>(&self, point: &Point<N, D>) -> Vector<f64, D> {
        (point.coords.map(N::as_f64) - self.origin) / self.scale
    }

    /// Converts moments from these units to the frame and the units of the shape.
    pub(super) fn grown(&self, moments: &Moments<D>) -> Moments<D> {
        moments.grown(self.scale, &self.origin)
    }
}

/// The integrals of 1, x and x xᵀ over a body, about the origin of the units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Integrals<const D: usize> {
    pub(super) mass: f64,
    pub(super) first: Vector<f64, D>,
    pub(super) second: Matrix<f64, D>,
}

impl<const D: usize> Integrals<D> {
    pub(super) fn none() -> Self {
        let (first, second) = (Vector::<f64, D>::zeros(), Matrix::<f64, D>::zeros());
        Self { mass: 0.0, first, second }
    }

    /// Adds a simplex with the given measure and one corner at the origin; `corners` are its other
    /// corners.
    ///
    /// The matrix of second moments of a simplex in D dimensions, about any point, is `measure /
    /// ((D + 1)(D + 2))` times (the sum over its corners of `c cᵀ`, plus `s sᵀ` for the sum `s` of
    /// its corners).
    pub(super) fn add_cone(&mut self, measure: f64, corners: &[&Vector<f64, D>; D]) {
        let (share, mut sum) = (measure / (D as f64 + 1.0), Vector::<f64, D>::zeros());
        let mut products = Matrix::<f64, D>::zeros();
        for corner in corners {
            sum += *corner;
            products += *corner * corner.transpose();
        }
        self.mass += measure;
        self.first += sum * share;
        self.second += (products + sum * sum.transpose()) * (share / (D as f64 + 2.0));
    }

    /// Adds a piece with a known matrix of second moments about its own centre.
    pub(super) fn add(&mut self, mass: f64, center: &Vector<f64, D>, second: &Matrix<f64, D>) {
        self.mass += mass;
        self.first += center * mass;
        self.second += second + center * center.transpose() * mass;
    }

    /// Adds a piece with known integrals about `point`.
    pub(super) fn add_about(&mut self, point: &Vector<f64, D>, piece: &Self) {
        let moved = point * piece.first.transpose();
        self.mass += piece.mass;
        self.first += piece.first + point * piece.mass;
        self.second +=
            piece.second + moved + moved.transpose() + point * point.transpose() * piece.mass;
    }

    /// Returns the integrals of the body with reversed orientation: all signs change.
    pub(super) fn negated(&self) -> Self {
        Self { mass: -self.mass, first: -self.first, second: -self.second }
    }

    /// Returns the moments of the body, in the units. If the mass is not positive, the result is a
    /// body without mass at the origin.
    pub(super) fn moments(&self) -> Moments<D> {
        let is_body = self.mass > 0.0;
        if !is_body {
            return Moments::massless(Vector::<f64, D>::zeros());
        }
        let center = self.first / self.mass;
        let second = self.second - center * center.transpose() * self.mass;
        Moments::of_seconds(self.mass, center, &second)
    }
}
