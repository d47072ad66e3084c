//! Ray casts against a ball. All round parts of solids use the same quadratic equation, which this
//! file solves.

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
    /// The vector from `middle` to the point where the line leaves.
    half_chord: Vector<N, D>,
}

impl<N: Real, const D: usize> Roots<N, D> {
    /// Returns the entry and exit points. They are computed from `middle`, and so are accurate
    /// however far away the line's origin is.
    pub(super) fn points(&self) -> [Vector<N, D>; 2] {
        [self.middle - self.half_chord, self.middle + self.half_chord]
    }

    /// Returns whether the line stays at the constant distance `radius` from the origin.
    pub(super) fn runs_at(&self, radius: N) -> bool {
        self.leave == N::INFINITY && self.middle.norm() == radius
    }
}

/// Returns the times at which `origin + t · dir` is at the distance `radius` from zero; `None` if
/// the line never comes that near. If `dir` is zero, the point `origin` is within that distance
/// always or never.
///
/// The method follows Haines, Günther and Akenine-Möller, "Precision improvements for ray/sphere
/// intersection", 2019: the discriminant is computed from the line's point nearest to the centre,
/// and the roots without cancellation.
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

/// Returns the roots of `squared · t² − 2 · toward · t + product` in ascending order; `root` is the
/// square root of the discriminant.
fn ordered_roots<N: Real>(toward: N, root: N, squared: N, product: N) -> (N, N) {
    let larger = if toward < N::ZERO { toward - root } else { toward + root };
    if larger == N::ZERO {
        return (N::ZERO, N::ZERO);
    }
    let (first, second) = (larger / squared, product / larger);
    (min(first, second), max(first, second))
}

/// Returns the span of the line in the ball of `radius` around the local origin; `None` if the line
/// misses the ball.
pub(super) fn span<N: Real, const D: usize>(radius: N, ray: &Ray<N, D>) -> Option<Span<N, D>> {
    around(&Point::origin(), radius, FeatureId::Face(0), ray)
}

/// Returns the span of the line in a ball around `center`; `None` if the line misses the ball. A
/// ball with an infinite radius contains the whole line.
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
    let [entry, exit] = found.points();
    // A ball of radius zero has no normal of its own: the normal faces the ray.
    let against = unit_or(&-ray.dir, Vector::<N, D>::zeros());
    let enter = Crossing::new(found.enter, unit_or(&entry, against), feature);
    let leave = Crossing::new(found.leave, unit_or(&exit, -against), feature);
    Some(Span { enter, leave, thin: false })
}
