//! A line and a triangle in 3D.

use super::segment::{RayNames, span as segment_span};
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Mapped, Point, Real, Vector, cross, cross2, unit, unit_or};
use crate::shape::{FeatureId, Triangle};

/// Through the inside, else along the triangle: there the sides answer, each within rounding.
///
/// The same for both sides of the triangle, and for corners in one line.
pub(super) fn span<N: Real>(triangle: &Triangle<N, 3>, ray: &Ray<N, 3>) -> Option<Span<N, 3>> {
    let sheared = triangle.corners().map(|corner| Sheared::of(&corner, ray));
    match through(&sheared) {
        Through::Hit(t) => {
            let crossing = crossing(triangle, ray, t);
            Some(Span::thin(crossing, crossing))
        }
        Through::Miss => None,
        Through::EdgeOn => (0..3).fold(None, |span, side| {
            let next = (side + 1) % 3;
            let ends = [&triangle.corners()[side as usize], &triangle.corners()[next as usize]];
            let names = RayNames { ends: [side, next], between: FeatureId::Edge(side) };
            Span::union_of(span, segment_span(ends, names, ray))
        }),
    }
}

/// A corner in the frame of the ray: `flat` across it and `t` along it.
struct Sheared<N: Real> {
    flat: Vector<N, 2>,
    t: N,
    /// The magnitude of what `flat` is a difference of: its rounding is in proportion.
    size: N,
}

impl<N: Real> Sheared<N> {
    /// Shears space so that the ray runs along its largest axis (Woop, Benthin and Wald,
    /// "Watertight Ray/Triangle Intersection", 2013).
    ///
    /// The corner alone decides the answer, so that triangles that share it agree on where it is.
    fn of(corner: &Point<N, 3>, ray: &Ray<N, 3>) -> Self {
        let along = ray.dir.iamax();
        let (x, y) = ((along + 1) % 3, (along + 2) % 3);
        let to_corner = corner - ray.origin;
        let t = to_corner[along] / ray.dir[along];
        let (run_x, run_y) = (ray.dir[x] * t, ray.dir[y] * t);
        let flat = Vector::<N, 2>::new(to_corner[x] - run_x, to_corner[y] - run_y);
        let size = to_corner[x].abs() + run_x.abs() + to_corner[y].abs() + run_y.abs();
        Self { flat, t, size }
    }
}

enum Through<N: Real> {
    Hit(N),
    Miss,
    /// The ray is parallel to the triangle within rounding, and not clearly inside.
    EdgeOn,
}

/// The signs of the three areas around the ray decide. Swapping the ends of a side negates its area
/// to the bit, so triangles that share a side leave no gap; an area of zero belongs to both.
fn through<N: Real>(corners: &[Sheared<N>; 3]) -> Through<N> {
    let [a, b, c] = corners;
    let areas = [cross2(&b.flat, &c.flat), cross2(&c.flat, &a.flat), cross2(&a.flat, &b.flat)];
    let total = areas[0] + areas[1] + areas[2];
    let all_left = areas.iter().all(|&area| area >= N::ZERO);
    let all_right = areas.iter().all(|&area| area <= N::ZERO);
    if (all_left || all_right) && total != N::ZERO {
        let [wa, wb, wc] = areas.mapped(|area| area / total);
        return Through::Hit(a.t * wa + b.t * wb + c.t * wc);
    }
    let spread = |p: &Sheared<N>, q: &Sheared<N>| p.size * q.flat.amax() + q.size * p.flat.amax();
    let rounding = N::lit(8.0) * N::EPSILON * (spread(a, b) + spread(b, c) + spread(c, a));
    if total.abs() <= rounding { Through::EdgeOn } else { Through::Miss }
}

/// The normal faces the ray; the face is the one that it comes to.
fn crossing<N: Real>(triangle: &Triangle<N, 3>, ray: &Ray<N, 3>, t: N) -> Crossing<N, 3> {
    let [a, b, c] = triangle.corners();
    let normal = cross(&(b - a), &(c - a));
    let from_front = normal.dot(&ray.dir) <= N::ZERO;
    let facing = if from_front { normal } else { -normal };
    let normal = unit(&facing).map(|(normal, _)| normal);
    let against = || unit_or(&-ray.dir, Vector::<N, 3>::zeros());
    let face = if from_front { 0 } else { 1 };
    Crossing::new(t, normal.unwrap_or_else(against), FeatureId::Face(face))
}
