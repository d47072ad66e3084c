//! Polygons in 2D, and the sets of points within a radius of them.

use super::integrals::{Integrals, LocalUnits};
use crate::math::{Matrix, Point, Real, Vector};
use crate::shape::{Moments, Polytope};

type V2 = Vector<f64, 2>;

/// The integrals over a sector of a disk: its area, its first moment along the bisector about its
/// corner, and its second moments along and across the bisector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wedge {
    pub(super) area: f64,
    pub(super) first: f64,
    pub(super) along: f64,
    pub(super) across: f64,
}

impl Wedge {
    pub(super) fn new(radius: f64, angle: f64) -> Self {
        let (sine, half) = (libm::sin(angle), libm::sin(angle * 0.5));
        let (squared, eighth) = (radius * radius, radius * radius * radius * radius * 0.125);
        Self {
            area: squared * angle * 0.5,
            first: squared * radius * half * (2.0 / 3.0),
            along: eighth * (angle + sine),
            across: eighth * (angle - sine),
        }
    }
}

/// Returns the moments of the set of points within `radius` of a convex polygon.
pub(super) fn round_polygon<N: Real>(polygon: &Polytope<N, 2>, radius: N) -> Moments<2> {
    round_points(polygon.vertices(), radius)
}

/// Returns the moments of the set of points within `radius` of a triangle, which may be clockwise
/// or have no area.
pub(super) fn round_triangle<N: Real>(corners: &[Point<N, 2>; 3], radius: N) -> Moments<2> {
    round_points(corners, radius)
}

/// Returns the moments of the set of points within `radius` of a polygon with convex corners in
/// either order.
fn round_points<N: Real>(corners: &[Point<N, 2>], radius: N) -> Moments<2> {
    let units = LocalUnits::around(corners, radius);
    let ring: Vec<V2> = corners.iter().map(|corner| units.point(corner)).collect();
    units.grown(&round_ring(ring, units.length(radius)).moments())
}

/// Returns the integrals over the set of points within `radius` of the polygon with the corners
/// `ring`. The pieces of the set are the polygon, a rectangle along each side, and at each corner a
/// sector with the angle by which the outline turns there.
fn round_ring(mut ring: Vec<V2>, radius: f64) -> Integrals<2> {
    let mut sum = Integrals::none();
    for (a, b) in sides(&ring) {
        sum.add_cone(crossed(&a, &b) * 0.5, &[&a, &b]);
    }
    if sum.mass < 0.0 {
        ring.reverse();
        sum = sum.negated();
    }
    ring.dedup();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    if radius > 0.0 {
        add_border(&ring, radius, &mut sum);
    }
    sum
}

/// Returns the sides of a closed ring of points, each as two points.
pub(super) fn sides<P: Copy>(ring: &[P]) -> impl Iterator<Item = (P, P)> {
    ring.iter().copied().zip(ring.iter().copied().cycle().skip(1))
}

/// Adds the border of width `radius` outside a counter-clockwise outline of distinct points.
fn add_border(ring: &[V2], radius: f64, sum: &mut Integrals<2>) {
    if let [point] = ring {
        let area = core::f64::consts::PI * radius * radius;
        let second = Matrix::<f64, 2>::from_diagonal_element(area * radius * radius * 0.25);
        return sum.add(area, point, &second);
    }
    let last = ring.len() - 1;
    let mut before = outward(&ring[last], &ring[0]);
    for (a, b) in sides(ring) {
        let normal = outward(&a, &b);
        add_corner(&a, [&before, &normal], radius, sum);
        let (along, center) = (b - a, (a + b + normal * radius) * 0.5);
        let area = along.norm() * radius;
        let across = normal * normal.transpose() * (radius * radius);
        sum.add(area, &center, &((along * along.transpose() + across) * (area / 12.0)));
        before = normal;
    }
}

/// Adds the sector at a corner where the outward normal rotates counter-clockwise from `from` to
/// `to`.
fn add_corner(corner: &V2, [from, to]: [&V2; 2], radius: f64, sum: &mut Integrals<2>) {
    // The angle is at most 180°; for exactly 180°, rounding must not decide its direction.
    let angle = libm::atan2(crossed(from, to), from.dot(to)).abs();
    let (sine, cosine) = libm::sincos(angle * 0.5);
    let along = from * cosine + quarter_turn(from) * sine;
    let (wedge, across) = (Wedge::new(radius, angle), quarter_turn(&along));
    let second =
        along * along.transpose() * wedge.along + across * across.transpose() * wedge.across;
    let piece = Integrals { mass: wedge.area, first: along * wedge.first, second };
    sum.add_about(corner, &piece);
}

/// Returns the outward unit normal of a side, which must have a length.
fn outward(a: &V2, b: &V2) -> V2 {
    let side = b - a;
    V2::new(side.y, -side.x) / side.norm()
}

/// Returns the signed area of the parallelogram of `a` and `b`, positive if `b` is
/// counter-clockwise of `a`. `math::cross2` needs a [`Real`], which `f64` is only with the feature
/// `f64`.
pub(super) fn crossed(a: &V2, b: &V2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns the vector rotated by 90° counter-clockwise.
fn quarter_turn(v: &V2) -> V2 {
    V2::new(-v.y, v.x)
}
