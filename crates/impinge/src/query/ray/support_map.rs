//! Ray casts against a convex solid known by support points alone.
//!
//! A returned time is never later than the hit. The number of steps is limited; a search that needs
//! more steps finds no hit.

use super::ball::roots;
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::convex::{Simplicial, separation};
use crate::math::{Pose, Real, Vector, max};
use crate::shape::{Ball, Feature, FeatureId, SupportMap};

/// The maximum number of distance computations. Flat faces take 2 or 3, round faces about 6. For a
/// line that grazes a round face the gap shrinks by a constant factor in each step.
const ROUNDS: usize = 64;

/// Returns the span of time that the line of a ray spends in a solid; see [`RaySolid::span`]. The
/// search starts on a ball around the solid, so the origin of the ray may be at any distance.
pub(super) fn span<N: Simplicial<D>, const D: usize>(
    map: &dyn SupportMap<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let distance = |point: &Vector<N, D>| {
        let pose12 = Pose::from_translation(*point);
        let found = separation(map, &Ball::new(N::ZERO), &pose12, N::INFINITY)?;
        Some((found.distance, found.normal))
    };
    let feature = |_: &Vector<N, D>, normal: &Vector<N, D>| {
        let mut feature = Feature::default();
        map.core_feature(normal, &mut feature);
        feature.id
    };
    let precision = max(N::lit(16.0) * N::EPSILON, N::lit(1.0 / 549_755_813_888.0));
    let radius = map.reach() + map.rounding();
    RaySolid { distance: &distance, feature: &feature, radius, precision }.span(ray)
}

/// Returns the signed distance of a point, and the unit vector out of the solid along which it is
/// measured; `None` if the point is not finite.
pub(super) type DistanceFn<'a, N, const D: usize> =
    &'a dyn Fn(&Vector<N, D>) -> Option<(N, Vector<N, D>)>;

/// A convex solid given by the distances of points in its local frame.
pub(super) struct RaySolid<'a, N: Real, const D: usize> {
    pub(super) distance: DistanceFn<'a, N, D>,
    /// Returns the feature at a point of the surface; the arguments are the point and the normal
    /// there.
    pub(super) feature: &'a dyn Fn(&Vector<N, D>, &Vector<N, D>) -> FeatureId,
    /// The radius of a ball about the local origin that contains the solid.
    pub(super) radius: N,
    /// The accuracy of distances, as a fraction of the radius.
    pub(super) precision: N,
}

impl<N: Real, const D: usize> RaySolid<'_, N, D> {
    /// Returns the span of time that the line of the ray spends in the solid. If the line enters
    /// the solid at time zero or later, the end of the span is not needed, and is infinite. `None`
    /// if the line misses the solid, if it leaves the ball around the solid before time zero, or
    /// if the search for the entry takes more than [`ROUNDS`] steps.
    pub(super) fn span(&self, ray: &Ray<N, D>) -> Option<Span<N, D>> {
        // The radius is enlarged, since it is only accurate up to rounding.
        let around = roots(&ray.origin.coords, &ray.dir, self.radius * N::lit(1.0625))?;
        if around.leave < N::ZERO {
            return None;
        }
        let [first, last] = around.points();
        let duration = around.leave - around.enter;
        let enter = Advance { solid: self, from: first, dir: ray.dir, duration }.first_contact()?;
        let enter = Crossing { t: around.enter + enter.t, ..enter };
        if enter.t >= N::ZERO {
            return Some(Span { enter, leave: Crossing::never(N::INFINITY), thin: false });
        }
        let backward = Advance { solid: self, from: last, dir: -ray.dir, duration };
        let leave = match backward.first_contact() {
            Some(found) => Crossing { t: around.leave - found.t, ..found },
            // The search from the far end found no hit, by rounding or because it took too many
            // steps. The line counts as touching the solid at one point.
            None => enter,
        };
        // A chord of a convex solid stays on the boundary if its middle is there.
        let middle = (enter.t + leave.t) * N::HALF;
        let thin = self.is_on_boundary(&(first + ray.dir * (middle - around.enter)));
        Some(Span { enter, leave, thin })
    }

    /// Returns whether a point of the solid is on its boundary, within the accuracy of distances.
    fn is_on_boundary(&self, point: &Vector<N, D>) -> bool {
        (self.distance)(point).is_some_and(|(distance, _)| distance >= -self.touching())
    }

    /// Returns the largest distance that is treated as touching.
    fn touching(&self) -> N {
        self.precision * self.radius
    }
}

/// A point that moves along a line, starting outside the solid.
struct Advance<'a, N: Real, const D: usize> {
    solid: &'a RaySolid<'a, N, D>,
    from: Vector<N, D>,
    dir: Vector<N, D>,
    /// The time up to which the point moves.
    duration: N,
}

impl<N: Real, const D: usize> Advance<'_, N, D> {
    /// Moves the point to the supporting plane between it and the solid, repeatedly, until the
    /// distance is within the precision. `None` if the point moves away from such a plane, reaches
    /// the end of `duration` first, or needs more than [`ROUNDS`] steps.
    ///
    /// The planes follow G. van den Bergen, "Ray Casting against General Convex Objects with
    /// Application to Continuous Collision Detection" (2004), but are computed anew in each step.
    /// Each plane proves that the solid is not hit before it, so the time never overshoots.
    fn first_contact(&self) -> Option<Crossing<N, D>> {
        let touching = self.solid.touching();
        let mut t = N::ZERO;
        for _ in 0..ROUNDS {
            let (distance, normal) = (self.solid.distance)(&(self.from + self.dir * t))?;
            let approach = -normal.dot(&self.dir);
            if distance <= touching {
                // A last step improves the time unless the plane is nearly parallel to the line.
                let steep = approach > N::lit(0.125);
                let step = if steep { distance / approach } else { N::ZERO };
                return Some(self.crossing(t + step, normal));
            }
            t += distance / approach;
            let is_within = approach > N::ZERO && t <= self.duration;
            if !is_within {
                return None;
            }
        }
        None
    }

    fn crossing(&self, t: N, normal: Vector<N, D>) -> Crossing<N, D> {
        let feature = (self.solid.feature)(&(self.from + self.dir * t), &normal);
        Crossing::new(t, normal, feature)
    }
}
