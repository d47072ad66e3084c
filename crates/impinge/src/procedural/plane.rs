//! Outlines of 2D shapes.

use super::Outline;
use super::circle::{direction, parts_of_turn};
use crate::math::{Point, Real, Vector, perp, unit_or};
use crate::shape::{
    Ball, Capsule, ConvexPolygon, ConvexPolyhedron, Cuboid, Ellipsoid, FeatureId, TaperedCapsule,
    Triangle,
};

/// Returns a regular polygon of `n = subdivisions` corners inscribed in a disk; the first corner
/// lies on the x axis.
///
/// The gap is at most `radius · (1 − cos(π / n))`.
///
/// ```
/// use impinge::procedural::plane::ball;
/// use impinge::shape::Ball;
///
/// let square = ball(&Ball::new(2.0_f32), 4).points;
/// assert_eq!(square.len(), 4);
/// assert_eq!((square[1].x, square[1].y), (0.0, 2.0));
/// ```
#[must_use]
pub fn ball<N: Real>(ball: &Ball<N>, subdivisions: u32) -> Outline<N> {
    let count = parts_of_turn(subdivisions);
    let corner = |index| Point::from(direction::<N>(index, count) * ball.radius());
    Outline { points: (0..count).map(corner).collect() }
}

/// Returns a polygon of `n = subdivisions` corners inscribed in an ellipse: the polygon of [`ball`]
/// for radius 1, scaled by the half axes.
///
/// The gap is at most `(1 − cos(π / n))` times the longer half axis.
#[must_use]
pub fn ellipse<N: Real>(ellipse: &Ellipsoid<N, 2>, subdivisions: u32) -> Outline<N> {
    let count = parts_of_turn(subdivisions);
    let corner =
        |index| Point::from(direction::<N>(index, count).component_mul(ellipse.half_axes()));
    Outline { points: (0..count).map(corner).collect() }
}

/// Returns the four corners of a rectangle, starting at the greatest x and the least y.
#[must_use]
pub fn cuboid<N: Real>(cuboid: &Cuboid<N, 2>) -> Outline<N> {
    let corner = |index| cuboid.vertex(FeatureId::Vertex(index));
    Outline { points: [1, 3, 2, 0].map(corner).to_vec() }
}

/// Returns two half circles of `k = ⌈subdivisions / 2⌉` parts each, one around each end: 2 k + 2
/// corners.
///
/// The half circle around the second end of the segment comes first. The gap is at most `radius ·
/// (1 − cos(π / 2k))`.
#[must_use]
pub fn capsule<N: Real>(capsule: &Capsule<N, 2>, subdivisions: u32) -> Outline<N> {
    let half_turn = parts_of_turn(subdivisions).div_ceil(2);
    let (a, b) = (capsule.segment().a(), capsule.segment().b());
    let along = unit_or(&(b - a), Vector::<N, 2>::new(N::ZERO, N::ONE));
    let right = -perp(&along);
    let corner = |end: &Point<N, 2>, index: u32| {
        let toward = direction::<N>(index, 2 * half_turn);
        end + (right * toward.x + along * toward.y) * capsule.radius()
    };
    let around_b = (0..=half_turn).map(|index| corner(b, index));
    let around_a = (half_turn..=2 * half_turn).map(|index| corner(a, index));
    Outline { points: around_b.chain(around_a).collect() }
}

/// Returns a polygon inscribed in the outline: an arc around each end, joined by the two straight
/// sides.
///
/// The `n = subdivisions` directions are evenly spaced, starting on the right of the segment. Each
/// direction gives at most one corner, where it is the normal of an arc; with the four ends of the
/// sides there are at most `n + 4` corners. The gap is at most `(1 − cos(π / n))` times the larger
/// radius. If one ball contains the other, the outline is the polygon of `n` corners of the larger
/// ball.
#[must_use]
pub fn tapered_capsule<N: Real>(capsule: &TaperedCapsule<N, 2>, subdivisions: u32) -> Outline<N> {
    let count = parts_of_turn(subdivisions);
    let corner =
        |end: usize, toward: Vector<N, 2>| capsule.end(end) + toward * capsule.radii()[end];
    let Some(taper) = capsule.taper() else {
        let around = |index| corner(capsule.larger_end(), direction::<N>(index, count));
        return Outline { points: (0..count).map(around).collect() };
    };
    let right = -perp(&taper.along);
    let placed = |v: Vector<N, 2>| right * v.x + taper.along * v.y;
    let facing = |end: usize, range: core::ops::Range<u32>| {
        let all = range.map(move |index| direction::<N>(index, count));
        let is_on = move |v: &Vector<N, 2>| (v.y > taper.sine) == (end == 1) && v.y != taper.sine;
        all.filter(is_on).map(move |v| corner(end, placed(v))).collect::<Vec<_>>()
    };
    let [right_side, left_side] =
        [taper.cosine, -taper.cosine].map(|away| placed(Vector::<N, 2>::new(away, taper.sine)));
    // The arc of an end may pass from the last direction to direction 0, so it is collected from
    // two ranges. Index `lowest` is the first direction past straight backwards: no arc around the
    // second end starts earlier. Index `highest` is the first direction not before straight
    // forwards: no arc around the first end starts earlier.
    let (highest, lowest) = (count.div_ceil(4), 3 * count / 4 + 1);
    let mut points = vec![corner(1, right_side)];
    points.extend(facing(1, lowest..count));
    points.extend(facing(1, 0..lowest));
    points.extend([corner(1, left_side), corner(0, left_side)]);
    points.extend(facing(0, highest..count));
    points.extend(facing(0, 0..highest));
    points.push(corner(0, right_side));
    Outline { points }
}

/// Returns the corners of a triangle, starting at `a`, counter-clockwise.
#[must_use]
pub fn triangle<N: Real>(triangle: &Triangle<N, 2>) -> Outline<N> {
    let [a, b, c] = *triangle.corners();
    let [(first, _), _] = triangle.edge(FeatureId::Face(0));
    let is_in_order = first == FeatureId::Vertex(0);
    Outline { points: if is_in_order { vec![a, b, c] } else { vec![a, c, b] } }
}

/// Returns the vertices of a convex polygon.
#[must_use]
pub fn convex_polygon<N: Real>(polygon: &ConvexPolygon<N>) -> Outline<N> {
    Outline { points: polygon.vertices().to_vec() }
}
