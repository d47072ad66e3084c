//! Outlines of the shapes of the plane.

use super::Outline;
use super::circle::{direction, parts_of_turn};
use crate::math::{Point, Real, Vector, perp, unit_or};
use crate::shape::{Ball, Capsule, ConvexPolygon, ConvexPolyhedron, Cuboid, FeatureId, Triangle};

/// A regular polygon of `n = subdivisions` corners inscribed in a disk; the first lies on the x axis.
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

/// The four corners of a rectangle, from the one of greatest x and least y on.
#[must_use]
pub fn cuboid<N: Real>(cuboid: &Cuboid<N, 2>) -> Outline<N> {
    let corner = |index| cuboid.vertex(FeatureId::Vertex(index));
    Outline { points: [1, 3, 2, 0].map(corner).to_vec() }
}

/// Two half circles of `k = ⌈subdivisions / 2⌉` parts each, one around each end: 2 k + 2 corners.
///
/// The first half circle is that around the second end of the segment. The gap is at most
/// `radius · (1 − cos(π / 2k))`.
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

/// The corners of a triangle from `a` on, in the order that is counter-clockwise.
#[must_use]
pub fn triangle<N: Real>(triangle: &Triangle<N, 2>) -> Outline<N> {
    let [a, b, c] = *triangle.corners();
    let [(first, _), _] = triangle.edge(FeatureId::Face(0));
    let is_in_order = first == FeatureId::Vertex(0);
    Outline { points: if is_in_order { vec![a, b, c] } else { vec![a, c, b] } }
}

/// The vertices of a convex polygon.
#[must_use]
pub fn convex_polygon<N: Real>(polygon: &ConvexPolygon<N>) -> Outline<N> {
    Outline { points: polygon.vertices().to_vec() }
}
