//! Ray casts against a triangle in 3D: the span of time during which the ray's line is on the
//! triangle.

use super::segment::{RayFeatures, span as segment_span};
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{
    Mapped, Point, Real, Vector, cross, cross2, filled, max_component, unit, unit_or,
};
use crate::shape::{FeatureId, Triangle};

/// Returns the span of the line: the hit in the interior, or, if the line is parallel to the
/// triangle, the hits on the sides, each within rounding. `None` if the line misses the triangle.
///
/// The method is valid for both sides of the triangle, and for collinear corners.
pub(super) fn span<N: Real>(triangle: &Triangle<N, 3>, ray: &Ray<N, 3>) -> Option<Span<N, 3>> {
    let corners = triangle.corners();
    match through(&Shear::along(ray).of(corners)) {
        Through::Hit(t) => {
            let crossing = crossing(corners, &ray.dir, t);
            Some(Span::thin(crossing, crossing))
        }
        Through::Miss => None,
        Through::EdgeOn => (0..3).fold(None, |span, side| {
            let next = (side + 1) % 3;
            let ends = [&corners[side as usize], &corners[next as usize]];
            let features = RayFeatures { ends: [side, next], between: FeatureId::Edge(side) };
            Span::union_of(span, segment_span(ends, features, ray))
        }),
    }
}

/// A ray for casts against many triangles, one at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleRay<N: Real> {
    shear: Shear<N>,
    /// The power of two by which the ray's direction is divided before a span is computed.
    unit: N,
}

/// A hit in the interior of a triangle. `t` is the time in units of the direction divided by
/// [`TriangleRay::unit`], `toi` the time in units of the ray's direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct InnerHit<N: Real> {
    t: N,
    pub(super) toi: N,
}

impl<N: Real> TriangleRay<N> {
    /// Returns the data of a finite ray; `None` if its direction is zero.
    #[inline(always)]
    pub(super) fn new(ray: &Ray<N, 3>) -> Option<Self> {
        let speed = max_component(&ray.dir);
        if speed == N::ZERO {
            return None;
        }
        let unit = speed.power_of_two_below();
        Some(Self { shear: Shear::along(&Ray::new(ray.origin, ray.dir / unit)), unit })
    }

    /// Returns the result of [`span`] for most triangles that are hit; `None` if the full test has
    /// to decide.
    #[inline(always)]
    pub(super) fn inner_hit(&self, corners: &[Point<N, 3>; 3]) -> Option<InnerHit<N>> {
        match through(&self.shear.of(corners)) {
            Through::Hit(t) if t >= N::ZERO => {
                let toi = (N::ZERO + t) / self.unit;
                toi.is_finite_number().then_some(InnerHit { t, toi })
            }
            _ => None,
        }
    }

    /// Returns the crossing at an inner hit, with its normal and face.
    pub(super) fn surface(&self, corners: &[Point<N, 3>; 3], hit: &InnerHit<N>) -> Crossing<N, 3> {
        crossing(corners, &self.shear.dir, hit.t)
    }
}

/// A shear of space in which a ray runs along the axis of its largest component (Woop, Benthin and
/// Wald, "Watertight Ray/Triangle Intersection", 2013).
#[derive(Clone, Copy, Debug)]
struct Shear<N: Real> {
    origin: Point<N, 3>,
    dir: Vector<N, 3>,
    /// The two axes across the ray, then the axis of its largest component.
    axes: [usize; 3],
}

/// A corner in the frame of the ray: `flat` across the ray and `t` along it.
#[derive(Clone, Copy)]
struct Sheared<N: Real> {
    flat: Vector<N, 2>,
    t: N,
    /// The magnitude of the terms of `flat`, to which its rounding error is proportional.
    size: N,
}

impl<N: Real> Shear<N> {
    #[inline]
    fn along(ray: &Ray<N, 3>) -> Self {
        let along = ray.dir.iamax();
        Self { origin: ray.origin, dir: ray.dir, axes: [(along + 1) % 3, (along + 2) % 3, along] }
    }

    /// Transforms each corner independently, so that triangles that share a corner get bitwise
    /// equal values.
    #[inline(always)]
    fn of(&self, corners: &[Point<N, 3>; 3]) -> [Sheared<N>; 3] {
        let [x, y, along] = self.axes;
        corners.mapped(
            #[inline(always)]
            |corner| {
                let to_corner = corner - self.origin;
                let t = to_corner[along] / self.dir[along];
                let (run_x, run_y) = (self.dir[x] * t, self.dir[y] * t);
                let flat = Vector::<N, 2>::new(to_corner[x] - run_x, to_corner[y] - run_y);
                let size = to_corner[x].abs() + run_x.abs() + to_corner[y].abs() + run_y.abs();
                Sheared { flat, t, size }
            },
        )
    }
}

enum Through<N: Real> {
    Hit(N),
    Miss,
    /// The ray is parallel to the triangle within rounding, and not clearly inside its outline.
    EdgeOn,
}

/// Classifies the ray by the signs of the three areas around it. Swapping the ends of a side
/// negates its area exactly, so triangles that share a side leave no gap; an area of zero belongs
/// to both triangles. A ray outside by no more than rounding hits, too.
#[inline(always)]
fn through<N: Real>(corners: &[Sheared<N>; 3]) -> Through<N> {
    let [a, b, c] = corners;
    let areas = [cross2(&b.flat, &c.flat), cross2(&c.flat, &a.flat), cross2(&a.flat, &b.flat)];
    let total = areas[0] + areas[1] + areas[2];
    // Written without branches, because the deciding sign is unpredictable.
    let all = |is: [bool; 3]| is[0] & is[1] & is[2];
    let all_left = all(filled(|side| areas[side] >= N::ZERO));
    let all_right = all(filled(|side| areas[side] <= N::ZERO));
    let hit = || {
        let [wa, wb, wc] = areas.mapped(|area| area / total);
        Through::Hit(a.t * wa + b.t * wb + c.t * wc)
    };
    if (all_left | all_right) & (total != N::ZERO) {
        return hit();
    }
    let spread = |p: &Sheared<N>, q: &Sheared<N>| p.size * q.flat.amax() + q.size * p.flat.amax();
    let rounding = N::lit(8.0) * N::EPSILON * (spread(a, b) + spread(b, c) + spread(c, a));
    if total.abs() <= rounding {
        return Through::EdgeOn;
    }
    let side = if total > N::ZERO { N::ONE } else { -N::ONE };
    if all(filled(|index| areas[index] * side >= -rounding)) { hit() } else { Through::Miss }
}

/// Returns the crossing at `t`. Its normal points against the ray, and its face is the face on that
/// side of the triangle. For a triangle without area, the normal is opposite to the ray.
fn crossing<N: Real>(corners: &[Point<N, 3>; 3], dir: &Vector<N, 3>, t: N) -> Crossing<N, 3> {
    let [a, b, c] = corners;
    let normal = cross(&(b - a), &(c - a));
    let from_front = normal.dot(dir) <= N::ZERO;
    let facing = if from_front { normal } else { -normal };
    let normal = unit(&facing).map(|(normal, _)| normal);
    let against = || unit_or(&-dir, Vector::<N, 3>::zeros());
    let face = if from_front { 0 } else { 1 };
    Crossing::new(t, normal.unwrap_or_else(against), FeatureId::Face(face))
}
