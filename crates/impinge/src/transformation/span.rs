//! Checks and scales the coordinates of points, and finds a first simplex of the hull.

use super::lattice::rounded;
use crate::math::{Point, Real, Vector, max};
use crate::shape::ShapeError;

/// Points as doubles between −2 and 2, with the rounding unit of their coordinates.
pub(super) struct Scaled<const D: usize> {
    /// The points divided by a power of two, which is exact, and rounded to multiples of 2⁻⁶⁰, with
    /// an error of at most 1/512 of `unit`.
    pub(super) points: Vec<Point<f64, D>>,
    /// The rounding unit of the original scalar at the largest coordinate: epsilon times its
    /// magnitude.
    pub(super) unit: f64,
}

impl<const D: usize> Scaled<D> {
    pub(super) fn of<N: Real>(points: &[Point<N, D>], needed: usize) -> Result<Self, ShapeError> {
        if points.len() < needed {
            return Err(ShapeError::TooFewPoints { given: points.len(), needed });
        }
        let is_finite = |p: &Point<N, D>| p.iter().fold(true, |is, x| is & x.is_finite_number());
        if !points.iter().fold(true, |are, p| are & is_finite(p)) {
            let index = points.iter().position(|p| !is_finite(p)).unwrap_or(0);
            return Err(ShapeError::PointNotFinite { index });
        }
        let largest = |size, p: &Point<N, D>| p.iter().fold(size, |size, x| max(size, x.abs()));
        let size = points.iter().fold(N::ZERO, largest);
        // The inverse of a power of two is representable, so the product is exact too.
        let scale = 1.0 / size.power_of_two_below().as_f64();
        let scaled = |p: &Point<N, D>| Point::from(p.coords.map(|x| rounded(x.as_f64() * scale)));
        let unit = N::EPSILON.as_f64() * (size.as_f64() * scale);
        Ok(Self { points: points.iter().map(scaled).collect(), unit })
    }

    /// Returns the tolerance: a point closer than this to the span of other points is treated as
    /// part of that span.
    pub(super) fn flat(&self) -> f64 {
        4.0 * self.unit
    }
}

/// Returns the larger of two numbers. `math::max` needs a scalar of the library, and `f64` is one
/// only with the feature `f64`.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Returns the unit vector along a vector between scaled points, and the length of the vector;
/// `None` for a zero vector.
pub(super) fn direction<const D: usize>(v: &Vector<f64, D>) -> Option<(Vector<f64, D>, f64)> {
    let length = v.norm();
    (length > 0.0).then(|| (v / length, length))
}

/// Returns whether `a` comes before `b` by the first coordinate that differs. Among the points that
/// are farthest in some direction, the last in this order is a corner of the hull, never in the
/// interior of an edge or a face.
pub(super) fn precedes<const D: usize>(a: &Point<f64, D>, b: &Point<f64, D>) -> bool {
    (0..D).find(|&axis| a[axis] != b[axis]).is_some_and(|axis| a[axis] < b[axis])
}

/// Returns the index of the last point, in order of coordinates, whose measure is at least `tied`;
/// 0 if there is none.
fn last<const D: usize>(points: &[Point<f64, D>], measures: &[f64], tied: f64) -> usize {
    let mut last = None;
    for (index, &measure) in measures.iter().enumerate() {
        let is_later = |last: usize| precedes(&points[last], &points[index]);
        if measure >= tied && last.is_none_or(is_later) {
            last = Some(index);
        }
    }
    last.unwrap_or(0)
}

/// Returns the two points that are farthest apart along the axis of the largest spread; of several
/// points at one end, the last in order of coordinates.
///
/// # Errors
/// [`ShapeError::Degenerate`] with dimension 0 if the points coincide within [`Scaled::flat`].
pub(super) fn first_two<const D: usize>(scaled: &Scaled<D>) -> Result<[usize; 2], ShapeError> {
    let points = &scaled.points;
    let mut ends = [[0; 2]; D];
    let [mut lows, mut highs] = [points[0]; 2];
    for (index, p) in points.iter().enumerate().skip(1) {
        for axis in 0..D {
            let is_later = |end: usize| precedes(&points[end], p);
            if p[axis] <= lows[axis] && (p[axis] < lows[axis] || is_later(ends[axis][0])) {
                (lows[axis], ends[axis][0]) = (p[axis], index);
            }
            if p[axis] >= highs[axis] && (p[axis] > highs[axis] || is_later(ends[axis][1])) {
                (highs[axis], ends[axis][1]) = (p[axis], index);
            }
        }
    }
    let spread = |axis: usize| highs[axis] - lows[axis];
    let widest = (1..D).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best });
    if spread(widest) > scaled.flat() {
        Ok(ends[widest])
    } else {
        Err(ShapeError::Degenerate { dimension: 0 })
    }
}

/// Returns the distance of a point from the segment between `a` and `b`, in any dimension.
pub(super) fn distance_from_segment<const D: usize>(
    point: &Point<f64, D>,
    a: &Point<f64, D>,
    b: &Point<f64, D>,
) -> f64 {
    let Some((along, length)) = direction(&(b - a)) else { return (point - a).norm() };
    let nearest = a + along * along.dot(&(point - a)).clamp(0.0, length);
    (point - nearest).norm()
}

/// Returns the points of [`first_two`] and the point farthest from the line through them. Of points
/// within one rounding unit of the largest distance, the last in order of coordinates is taken.
///
/// # Errors
/// [`ShapeError::Degenerate`] with the dimension 0 or 1 if the points coincide or lie on a line,
/// within [`Scaled::flat`].
pub(super) fn first_three<const D: usize>(scaled: &Scaled<D>) -> Result<[usize; 3], ShapeError> {
    let [first, second] = first_two(scaled)?;
    let line = ShapeError::Degenerate { dimension: 1 };
    let a = &scaled.points[first];
    let (along, _) = direction(&(scaled.points[second] - a)).ok_or(line)?;
    let squared_distance = |p: &Point<f64, D>| {
        let offset = p - a;
        (offset - along * along.dot(&offset)).norm_squared()
    };
    let squares: Vec<f64> = scaled.points.iter().map(squared_distance).collect();
    let top = squares.iter().copied().fold(0.0, larger);
    if top <= scaled.flat() * scaled.flat() {
        return Err(line);
    }
    let tied = top.sqrt() - scaled.unit;
    // Rounding may raise the square of `tied` above the largest square.
    let tied = -larger(-tied * tied, -top);
    Ok([first, second, last(&scaled.points, &squares, tied)])
}

/// Returns the points of [`first_three`] and the point farthest from their plane. Of the points on
/// the side of the farthest point and within one rounding unit of the largest distance, the last in
/// order of coordinates is taken.
///
/// # Errors
/// [`ShapeError::Degenerate`] if the points coincide or lie on a line or in a plane, within
/// [`Scaled::flat`].
pub(super) fn first_four(scaled: &Scaled<3>) -> Result<[usize; 4], ShapeError> {
    let [first, second, third] = first_three(scaled)?;
    let plane = ShapeError::Degenerate { dimension: 2 };
    let a = &scaled.points[first];
    let across = (scaled.points[second] - a).cross(&(scaled.points[third] - a));
    let (normal, _) = direction(&across).ok_or(plane)?;
    let mut heights: Vec<f64> = scaled.points.iter().map(|p| normal.dot(&(p - a))).collect();
    let top = heights.iter().copied().fold(0.0, larger);
    let depth = heights.iter().map(|height| -height).fold(0.0, larger);
    if larger(top, depth) <= scaled.flat() {
        return Err(plane);
    }
    if depth > top {
        heights.iter_mut().for_each(|height| *height = -*height);
    }
    let tied = larger(top, depth) - scaled.unit;
    Ok([first, second, third, last(&scaled.points, &heights, tied)])
}
