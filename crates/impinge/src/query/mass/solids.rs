//! Mass and moments in closed form for boxes, balls, ellipsoids and simplices; each formula covers
//! 2D and 3D.

use super::integrals::LocalUnits;
use crate::math::{Matrix, Point, Real, Vector, max, max_component};
use crate::shape::Moments;

const PI: f64 = core::f64::consts::PI;

/// The measure of the unit ball in 0, 1, 2 and 3 dimensions.
pub(super) const UNIT_BALL: [f64; 4] = [1.0, 2.0, PI, 4.0 / 3.0 * PI];

/// The mean of |x| over the unit ball in 0, 1, 2 and 3 dimensions.
const MEAN_ASIDE: [f64; 4] = [0.0, 0.5, 4.0 / 3.0 / PI, 0.375];

/// Returns the measure of a ball in `dimensions` dimensions.
fn ball_measure(dimensions: usize, radius: f64) -> f64 {
    (0..dimensions).fold(UNIT_BALL[dimensions], |measure, _| measure * radius)
}

/// Returns the moments of the set of points within `radius` of a box about the origin; a ball if
/// the box has no extent.
///
/// The set is decomposed into products: the box along some axes, and along the other axes the parts
/// of a ball of that dimension, moved to the corners of the box.
pub(super) fn round_box<N: Real, const D: usize>(
    half_extents: &Vector<N, D>,
    radius: N,
) -> Moments<D> {
    let size = max(max_component(half_extents), radius).as_f64();
    let units = LocalUnits::about_origin(size);
    let (half, radius) = (units.vector(half_extents), units.length(radius));
    let (mut mass, mut seconds) = (0.0, Vector::<f64, D>::zeros());
    for choice in 0..1_usize << D {
        let is_round = |axis: usize| choice >> axis & 1 == 1;
        let dimensions = (0..D).filter(|&axis| is_round(axis)).count();
        let straight = (0..D).filter(|&axis| !is_round(axis));
        let ball = ball_measure(dimensions, radius);
        let measure = straight.fold(ball, |measure, axis| measure * (2.0 * half[axis]));
        mass += measure;
        for axis in 0..D {
            let squared = half[axis] * half[axis];
            let mean = if is_round(axis) {
                let aside = 2.0 * half[axis] * radius * MEAN_ASIDE[dimensions];
                squared + aside + radius * radius / (dimensions as f64 + 2.0)
            } else {
                squared / 3.0
            };
            seconds[axis] += measure * mean;
        }
    }
    let (center, axes) = (Vector::<f64, D>::zeros(), Matrix::<f64, D>::identity());
    units.grown(&Moments::along_axes(mass, center, axes, &seconds))
}

/// Returns the moments of an ellipsoid (in 2D an ellipse) about the origin.
pub(super) fn ellipsoid<N: Real, const D: usize>(half_axes: &Vector<N, D>) -> Moments<D> {
    let units = LocalUnits::about_origin(max_component(half_axes).as_f64());
    let half = units.vector(half_axes);
    let mass = half.iter().fold(UNIT_BALL[D], |measure, axis| measure * axis);
    let seconds = half.map(|axis| mass * axis * axis / (D as f64 + 2.0));
    let (center, axes) = (Vector::<f64, D>::zeros(), Matrix::<f64, D>::identity());
    units.grown(&Moments::along_axes(mass, center, axes, &seconds))
}

/// Returns the moments of a segment or a triangle with density 1 per unit of length or area.
pub(super) fn simplex<N: Real, const D: usize, const CORNERS: usize>(
    corners: &[Point<N, D>; CORNERS],
) -> Moments<D> {
    let units = LocalUnits::around(corners, N::ZERO);
    let corners = corners.each_ref().map(|corner| units.point(corner));
    let count = CORNERS as f64;
    let center = corners.iter().sum::<Vector<f64, D>>() / count;
    let measure = measure_of(&corners);
    // False for a point, which has no scale, and for NaN: the body then has no mass.
    let has_measure = measure > 0.0;
    if !has_measure {
        return units.grown(&Moments::massless(Vector::<f64, D>::zeros()));
    }
    let products = corners.map(|corner| (corner - center) * (corner - center).transpose());
    let second = products.iter().sum::<Matrix<f64, D>>() * (measure / (count * (count + 1.0)));
    let body = Moments::of_seconds(measure, center, &second);
    // The measure scales with the dimension of the simplex, not of the space around it.
    let spare = (CORNERS..=D).fold(1.0, |spare, _| spare / units.scale);
    units.grown(&body).of_density(spare)
}

/// Returns the length of a segment or the area of a triangle, given its 2 or 3 corners.
pub(super) fn measure_of<const D: usize>(corners: &[Vector<f64, D>]) -> f64 {
    let side = corners[1] - corners[0];
    let Some(third) = corners.get(2) else { return side.norm() };
    let (other, mut squared) = (third - corners[0], 0.0);
    for (row, column) in (0..D).flat_map(|column| (0..column).map(move |row| (row, column))) {
        let minor = side[row] * other[column] - side[column] * other[row];
        squared += minor * minor;
    }
    squared.sqrt() * 0.5
}
