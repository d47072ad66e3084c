//! A line and a ball: the quadratic that the round parts of all solids share.

use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Point, Real, Vector, max, min, unit_or};
use crate::shape::FeatureId;

/// The two times at which a line is at a given distance from the origin, and the points there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots<N: Real, const D: usize> {
    pub(super) enter: N,
    pub(super) leave: N,
    /// The point of the line that is nearest to the origin.
    middle: Vector<N, D>,
    /// From the middle to the point of leaving.
    half_chord: Vector<N, D>,
}

impl<N: Real, const D: usize> Roots<N, D> {
    /// The points of entering and leaving, computed from the middle: accurate however far the
    /// line's origin is.
    pub(super) fn places(&self) -> [Vector<N, D>; 2] {
        [self.middle - self.half_chord, self.middle + self.half_chord]
    }

    /// Whether the line stays at one distance, which is `radius`.
    pub(super) fn runs_at(&self, radius: N) -> bool {
        self.leave == N::INFINITY && self.middle.norm() == radius
    }
}

/// The times at which `origin + t · dir` is at the distance `radius` from zero; `None` if it never
/// comes within. If `dir` is zero, it is within always or never.
///
/// After Haines, Günther and Akenine-Möller, "Precision improvements for ray/sphere intersection",
/// 2019: the discriminant from the point of the line nearest to the centre, the roots without
/// cancellation.
pub(super) fn roots<N: Real, const D: usize>(
    origin: &Vector<N, D>,
    dir: &Vector<N, D>,
    radius: N,
) -> Option<Roots<N, D>> {
    let squared = dir.norm_squared();
    let distance = origin.norm();
    let is_inside = distance <= radius;
    if squared == N::ZERO {
        let (middle, half_chord) = (*origin, Vector::<N, D>::zeros());
        let always = Roots { enter: -N::INFINITY, leave: N::INFINITY, middle, half_chord };
        return is_inside.then_some(always);
    }
    let toward = -origin.dot(dir);
    let middle = origin + dir * (toward / squared);
    let across = middle.norm();
    let discriminant = (radius - across) * (radius + across);
    if discriminant < N::ZERO && !is_inside {
        return None;
    }
    let half = (max(discriminant, N::ZERO) / squared).sqrt();
    let product = (distance - radius) * (distance + radius);
    let (enter, leave) = ordered_roots(toward, half * squared, squared, product);
    Some(Roots { enter, leave, middle, half_chord: dir * half })
}

/// The roots of `squared · t² − 2 · toward · t + product`, given the root of the discriminant.
fn ordered_roots<N: Real>(toward: N, root: N, squared: N, product: N) -> (N, N) {
    let larger = if toward < N::ZERO { toward - root } else { toward + root };
    if larger == N::ZERO {
        return (N::ZERO, N::ZERO);
    }
    let (first, second) = (larger / squared, product / larger);
    (min(first, second), max(first, second))
}

/// The span of the line in the ball of `radius` around the local origin.
pub(super) fn span<N: Real, const D: usize>(radius: N, ray: &Ray<N, D>) -> Option<Span<N, D>> {
    around(&Point::origin(), radius, FeatureId::Face(0), ray)
}

/// The span of the line in a ball around any center. An infinite ball contains all of it.
pub(super) fn around<N: Real, const D: usize>(
    center: &Point<N, D>,
    radius: N,
    feature: FeatureId,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    if radius == N::INFINITY {
        return Some(Span::everything());
    }
    let found = roots(&(ray.origin - center), &ray.dir, radius)?;
    let [entry, exit] = found.places();
    // A ball of radius zero has no normal of its own: it faces the ray.
    let against = unit_or(&-ray.dir, Vector::<N, D>::zeros());
    let enter = Crossing::new(found.enter, unit_or(&entry, against), feature);
    let leave = Crossing::new(found.leave, unit_or(&exit, -against), feature);
    Some(Span { enter, leave, thin: false })
}
