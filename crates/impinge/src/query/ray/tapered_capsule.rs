//! Ray casts against a tapered capsule, in any dimension: the span of time during which the ray's
//! line is inside.

use super::ball::around;
use super::clip::in_order;
use super::cone::ConeTimes;
use super::segment::{RayFeatures, span as segment_span};
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Mapped, Real, Vector, max, min, unit_or};
use crate::shape::{FeatureId, Taper, TaperedCapsule};

/// Returns the span of the union of the two balls and the frustum between the circles in which it
/// touches them; `None` if the line misses the solid. If both radii are zero, the shape is a
/// segment.
pub(super) fn span<N: Real, const D: usize>(
    capsule: &TaperedCapsule<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    if capsule.radii() == [N::ZERO; 2] {
        let segment = capsule.segment();
        return segment_span([segment.a(), segment.b()], RayFeatures::SEGMENT, ray);
    }
    let ball = |end: usize, index| {
        around(capsule.end(end), capsule.radii()[end], FeatureId::Vertex(index), ray)
    };
    let Some(taper) = capsule.taper() else {
        return if capsule.larger_end() == 0 { ball(0, 0) } else { ball(1, 1) };
    };
    let side = TaperedSide::new(capsule, &taper, ray).span();
    Span::union_of(side, Span::union_of(ball(0, 0), ball(1, 1)))
}

/// The frustum between the two circles of contact, and a line.
///
/// A point at the height `y` over the first end and the distance `x` from the axis is inside where
/// `cosine · x ≤ radius1 − sine · y`; the right-hand side is positive between the circles.
struct TaperedSide<'a, N: Real, const D: usize> {
    taper: &'a Taper<N, D>,
    /// The heights of the two circles over the first end.
    heights: [N; 2],
    /// The time at which the line is nearest to the middle of the capsule. The other quantities are
    /// relative to the line's point at this time, so they are accurate even if the origin of the
    /// ray is far away.
    start: N,
    against: Vector<N, D>,
    /// The components, across and along the axis, of the line's point at `start`.
    flat: Vector<N, D>,
    height: N,
    /// The components of the direction across and along the axis.
    flat_dir: Vector<N, D>,
    climb: N,
    /// The value of `radius1 − sine · y` at the line's point at `start`, and its rate of change.
    surface_radius: N,
    widening: N,
}

impl<'a, N: Real, const D: usize> TaperedSide<'a, N, D> {
    fn new(capsule: &TaperedCapsule<N, D>, taper: &'a Taper<N, D>, ray: &Ray<N, D>) -> Self {
        let [radius1, radius2] = capsule.radii();
        let to_middle = capsule.segment().a() + taper.along * (taper.length * N::HALF) - ray.origin;
        let start = to_middle.dot(&ray.dir) / ray.dir.norm_squared();
        let offset = ray.origin + ray.dir * start - capsule.segment().a();
        let (height, climb) = (offset.dot(&taper.along), ray.dir.dot(&taper.along));
        Self {
            taper,
            heights: [radius1 * taper.sine, taper.length + radius2 * taper.sine],
            start,
            against: unit_or(&-ray.dir, Vector::<N, D>::zeros()),
            flat: offset - taper.along * height,
            height,
            flat_dir: ray.dir - taper.along * climb,
            climb,
            surface_radius: radius1 - taper.sine * height,
            widening: -taper.sine * climb,
        }
    }

    /// Returns the span of the line in the frustum; `None` if the line misses the frustum.
    fn span(&self) -> Option<Span<N, D>> {
        let (low, high) = self.between_circles()?;
        let times = self.in_cone()?;
        let (enter, leave) = times.in_nappe(self.widening)?;
        let (enter, leave) = (max(enter, low), min(leave, high));
        let [enter, leave] =
            [(enter, self.against), (leave, -self.against)].mapped(|(t, fallback)| {
                let away = unit_or(&(self.flat + self.flat_dir * t), fallback);
                let normal = away * self.taper.cosine + self.taper.along * self.taper.sine;
                Crossing::new(self.start + t, unit_or(&normal, fallback), FeatureId::Edge(0))
            });
        let span = Span { enter, leave, thin: times.runs_along_side() };
        in_order(&span).then_some(span)
    }

    /// Returns the interval, relative to `start`, in which the line is between the planes of the
    /// circles; `None` if the line is parallel to these planes and not between them.
    fn between_circles(&self) -> Option<(N, N)> {
        let [low, high] = self.heights.mapped(|height| height - self.height);
        if self.climb == N::ZERO {
            let is_between = low <= N::ZERO && high >= N::ZERO;
            return is_between.then_some((-N::INFINITY, N::INFINITY));
        }
        let (first, second) = (low / self.climb, high / self.climb);
        Some((min(first, second), max(first, second)))
    }

    /// Returns the times, relative to `start`, at which the line is in the double cone; `None` if
    /// it misses the cone. The nappe of the frustum is the one where `radius1 − sine · y` is
    /// positive.
    ///
    /// The coefficients are differences of squares that are not expanded.
    fn in_cone(&self) -> Option<ConeTimes<N>> {
        let cosine = self.taper.cosine;
        let form = |a: N, b: N| (cosine * a - b) * (cosine * a + b);
        let quadratic = form(self.flat_dir.norm(), self.widening.abs());
        let constant = form(self.flat.norm(), self.surface_radius.abs());
        let along = self.flat.dot(&self.flat_dir);
        let linear = cosine * cosine * along - self.surface_radius * self.widening;
        let moment = (self.flat_dir * self.surface_radius - self.flat * self.widening).norm();
        let discriminant = (moment - cosine * self.twist()) * (moment + cosine * self.twist());
        if discriminant < N::ZERO && quadratic > N::ZERO && constant > N::ZERO {
            return None;
        }
        let root = cosine * max(discriminant, N::ZERO).sqrt();
        Some(ConeTimes { quadratic, linear, constant, root })
    }

    /// Returns the area of the parallelogram of the line's point and its direction, both across the
    /// axis.
    fn twist(&self) -> N {
        let speed = self.flat_dir.norm();
        let along = unit_or(&self.flat_dir, Vector::<N, D>::zeros());
        (self.flat - along * along.dot(&self.flat)).norm() * speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;

    type P = Point<f64, 3>;
    type V = Vector<f64, 3>;

    #[test]
    fn across_the_side_and_along_the_axis() {
        // The side rises by 3 on 4; at the height y over the small end its radius is (1 + 0.6 y) /
        // 0.8.
        let club = TaperedCapsule::try_from_ends(P::origin(), P::new(0.0, 5.0, 0.0), [1.0, 4.0])
            .expect("finite");
        let across = Ray::new(P::new(-10.0, 1.0, 0.0), V::x());
        let found = span(&club, &across).expect("through the side");
        assert!((found.enter.t - 8.0).abs() < 1e-14 && (found.leave.t - 12.0).abs() < 1e-14);
        assert_eq!(found.enter.feature, FeatureId::Edge(0), "the side");
        assert!((found.enter.normal - V::new(-0.8, -0.6, 0.0)).norm() < 1e-15, "{found:?}");
        let along = span(&club, &Ray::new(P::new(0.0, -10.0, 0.0), V::y())).expect("the axis");
        assert_eq!((along.enter.t, along.leave.t), (9.0, 19.0), "from end to end");
        assert_eq!(along.leave.feature, FeatureId::Vertex(1), "the large ball");
        assert_eq!(span(&club, &Ray::new(P::new(-10.0, 0.0, 1.5), V::x())), None, "beside it");
    }
}
