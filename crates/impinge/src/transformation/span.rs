//! What points span: numbers checked and scaled, and a first simplex.

use crate::math::{Point, Real, Vector, max};
use crate::shape::ShapeError;

/// Points as doubles between −2 and 2, and what counts as noise among them.
pub(super) struct Scaled<const D: usize> {
    /// The points over a power of two, exactly.
    pub(super) points: Vec<Point<f64, D>>,
    /// One rounding unit of the scalar that the points came in, at the largest coordinate.
    pub(super) unit: f64,
}

impl<const D: usize> Scaled<D> {
    pub(super) fn of<N: Real>(points: &[Point<N, D>], needed: usize) -> Result<Self, ShapeError> {
        if points.len() < needed {
            return Err(ShapeError::TooFewPoints { given: points.len(), needed });
        }
        if let Some(index) = points.iter().position(|p| !p.iter().all(|x| x.is_finite_number())) {
            return Err(ShapeError::PointNotFinite { index });
        }
        let largest = |size, p: &Point<N, D>| p.iter().fold(size, |size, x| max(size, x.abs()));
        let size = points.iter().fold(N::ZERO, largest);
        let (size, scale) = (size.as_f64(), size.power_of_two_below().as_f64());
        let points =
            points.iter().map(|p| Point::from(p.coords.map(|x| x.as_f64() / scale))).collect();
        Ok(Self { points, unit: N::EPSILON.as_f64() * (size / scale) })
    }

    /// Points nearer than this to what the others span count as part of it.
    pub(super) fn flat(&self) -> f64 {
        4.0 * self.unit
    }
}

/// The larger of two numbers; nothing here asks for `f64` to be a scalar of the library.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The unit vector along a vector between scaled points, and its length; `None` if it is zero.
pub(super) fn direction<const D: usize>(v: &Vector<f64, D>) -> Option<(Vector<f64, D>, f64)> {
    let length = v.norm();
    (length > 0.0).then(|| (v / length, length))
}

/// `a` comes before `b` by the first coordinate that differs. Among points equally far along some
/// direction the last one is a corner of the hull, never the middle of an edge or of a face.
pub(super) fn precedes<const D: usize>(a: &Point<f64, D>, b: &Point<f64, D>) -> bool {
    (0..D).find(|&axis| a[axis] != b[axis]).is_some_and(|axis| a[axis] < b[axis])
}

/// The index of the point that a measure finds largest, and the measure; the last in order of
/// coordinates among those within `tie` of it.
pub(super) fn farthest<const D: usize>(
    points: &[Point<f64, D>],
    tie: f64,
    measure: impl Fn(&Point<f64, D>) -> f64,
) -> (usize, f64) {
    let top = points.iter().fold(f64::NEG_INFINITY, |top, p| larger(top, measure(p)));
    let mut best = None;
    for (index, point) in points.iter().enumerate() {
        let is_later = best.is_none_or(|best: usize| precedes(&points[best], point));
        if is_later && measure(point) >= top - tie {
            best = Some(index);
        }
    }
    (best.unwrap_or(0), top)
}

/// The two points that are farthest apart along the axis on which the points spread most.
///
/// # Errors
/// [`ShapeError::Degenerate`] with dimension 0 if the points coincide.
pub(super) fn first_two<const D: usize>(scaled: &Scaled<D>) -> Result<[usize; 2], ShapeError> {
    let points = &scaled.points;
    let spread = |axis: usize| {
        let (high, top) = farthest(points, 0.0, |p| p[axis]);
        let (low, bottom) = farthest(points, 0.0, |p| -p[axis]);
        (low, high, top + bottom)
    };
    let widest = (1..D).fold(spread(0), |best, axis| {
        let candidate = spread(axis);
        if candidate.2 > best.2 { candidate } else { best }
    });
    let (low, high, size) = widest;
    if size > scaled.flat() {
        Ok([low, high])
    } else {
        Err(ShapeError::Degenerate { dimension: 0 })
    }
}

/// The distance of a point from the line through `a` along a unit vector, in any dimension.
pub(super) fn distance_from_line<const D: usize>(
    point: &Point<f64, D>,
    a: &Point<f64, D>,
    along: &Vector<f64, D>,
) -> f64 {
    let offset = point - a;
    (offset - along * along.dot(&offset)).norm()
}

/// The distance of a point from the segment between two others, in any dimension.
pub(super) fn distance_from_segment<const D: usize>(
    point: &Point<f64, D>,
    a: &Point<f64, D>,
    b: &Point<f64, D>,
) -> f64 {
    let Some((along, length)) = direction(&(b - a)) else { return (point - a).norm() };
    let nearest = a + along * along.dot(&(point - a)).clamp(0.0, length);
    (point - nearest).norm()
}

/// Three points that span a triangle as wide as can be found at once.
///
/// # Errors
/// [`ShapeError::Degenerate`] with dimension 0 or 1 if they lie in a point or on a line.
pub(super) fn first_three<const D: usize>(scaled: &Scaled<D>) -> Result<[usize; 3], ShapeError> {
    let [first, second] = first_two(scaled)?;
    let line = ShapeError::Degenerate { dimension: 1 };
    let a = &scaled.points[first];
    let (along, _) = direction(&(scaled.points[second] - a)).ok_or(line)?;
    let measure = |p: &Point<f64, D>| distance_from_line(p, a, &along);
    let (third, height) = farthest(&scaled.points, scaled.unit, measure);
    if height > scaled.flat() { Ok([first, second, third]) } else { Err(line) }
}

/// Four points that span a tetrahedron as large as can be found at once.
///
/// # Errors
/// [`ShapeError::Degenerate`] if they lie in a point, on a line or in a plane.
pub(super) fn first_four(scaled: &Scaled<3>) -> Result<[usize; 4], ShapeError> {
    let [first, second, third] = first_three(scaled)?;
    let plane = ShapeError::Degenerate { dimension: 2 };
    let a = &scaled.points[first];
    let across = (scaled.points[second] - a).cross(&(scaled.points[third] - a));
    let (normal, _) = direction(&across).ok_or(plane)?;
    let (above, top) = farthest(&scaled.points, scaled.unit, |p| normal.dot(&(p - a)));
    let (below, bottom) = farthest(&scaled.points, scaled.unit, |p| -normal.dot(&(p - a)));
    let (fourth, height) = if bottom > top { (below, bottom) } else { (above, top) };
    if height > scaled.flat() { Ok([first, second, third, fourth]) } else { Err(plane) }
}
