//! Ray casts against a convex solid given by support points alone.
//!
//! The number of steps is capped; a time is never later than the hit.

use super::ball::roots;
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::convex::{Simplicial, separation};
use crate::math::{Pose, Real, Vector, max};
use crate::shape::{Ball, Feature, FeatureId, SupportMap};

/// The maximum number of distance computations. Flat faces take two or three, round ones about six;
/// for a line that grazes a round one the gap shrinks by a constant factor each time.
const ROUNDS: usize = 64;

/// The span of the line in the solid, searched within a ball around it: so the origin of the ray
/// may be at any distance.
///
/// If the ray hits from outside, the end of the span is left infinite: it is not used.
pub(super) fn span<N: Simplicial<D>, const D: usize>(
    map: &dyn SupportMap<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let see = |place: &Vector<N, D>| {
        let pose12 = Pose::from_translation(*place);
        let found = separation(map, &Ball::new(N::ZERO), &pose12, N::INFINITY)?;
        Some((found.distance, found.normal))
    };
    let name = |_: &Vector<N, D>, normal: &Vector<N, D>| {
        let mut feature = Feature::default();
        map.core_feature(normal, &mut feature);
        feature.id
    };
    let precision = max(N::lit(16.0) * N::EPSILON, N::lit(1.0 / 549_755_813_888.0));
    let radius = map.reach() + map.rounding();
    RaySolid { see: &see, name: &name, radius, precision }.span(ray)
}

/// Returns the signed distance of a point and the unit vector out of the solid along which it is
/// measured; `None` if the point is not finite.
pub(super) type See<'a, N, const D: usize> = &'a dyn Fn(&Vector<N, D>) -> Option<(N, Vector<N, D>)>;

/// A convex solid given by the distances of points in its local frame.
pub(super) struct RaySolid<'a, N: Real, const D: usize> {
    pub(super) see: See<'a, N, D>,
    /// Returns the feature at a point of the surface, given with the normal there.
    pub(super) name: &'a dyn Fn(&Vector<N, D>, &Vector<N, D>) -> FeatureId,
    /// The solid lies within this distance of the local origin.
    pub(super) radius: N,
    /// The accuracy of distances, as a fraction of the radius.
    pub(super) precision: N,
}

impl<N: Real, const D: usize> RaySolid<'_, N, D> {
    /// The span of the line; `None` if it misses, or leaves before time zero.
    pub(super) fn span(&self, ray: &Ray<N, D>) -> Option<Span<N, D>> {
        // A larger radius, since the radius itself is only right up to rounding.
        let around = roots(&ray.origin.coords, &ray.dir, self.radius * N::lit(1.0625))?;
        if around.leave < N::ZERO {
            return None;
        }
        let [first, last] = around.places();
        let room = around.leave - around.enter;
        let enter = Advance { seen: self, from: first, dir: ray.dir, room }.first_contact()?;
        let enter = Crossing { t: around.enter + enter.t, ..enter };
        if enter.t >= N::ZERO {
            return Some(Span { enter, leave: Crossing::never(N::INFINITY), thin: false });
        }
        let backward = Advance { seen: self, from: last, dir: -ray.dir, room };
        let leave = match backward.first_contact() {
            Some(found) => Crossing { t: around.leave - found.t, ..found },
            // By rounding the backward search missed: the line only touches.
            None => enter,
        };
        Some(Span { enter, leave, thin: false })
    }
}

/// A point that moves along a line from outside the solid.
struct Advance<'a, N: Real, const D: usize> {
    seen: &'a RaySolid<'a, N, D>,
    from: Vector<N, D>,
    dir: Vector<N, D>,
    /// The time for which it may move.
    room: N,
}

impl<N: Real, const D: usize> Advance<'_, N, D> {
    /// Moves the point to the supporting plane between it and the solid, repeatedly, until the
    /// distance is within the precision; `None` once it moves away from such a plane.
    ///
    /// The planes follow G. van den Bergen, "Ray Casting against General Convex Objects with
    /// Application to Continuous Collision Detection" (2004), but are computed anew each time: each
    /// one proves that the solid is not hit before it, so the time never overshoots.
    fn first_contact(&self) -> Option<Crossing<N, D>> {
        let touching = self.seen.precision * self.seen.radius;
        let mut t = N::ZERO;
        for _ in 0..ROUNDS {
            let (distance, normal) = (self.seen.see)(&(self.from + self.dir * t))?;
            let approach = -normal.dot(&self.dir);
            if distance <= touching {
                // A last step improves the time unless the plane is nearly parallel to the line.
                let steep = approach > N::lit(0.125);
                let step = if steep { distance / approach } else { N::ZERO };
                return Some(self.crossing(t + step, normal));
            }
            t += distance / approach;
            let on_the_way = approach > N::ZERO && t <= self.room;
            if !on_the_way {
                return None;
            }
        }
        None
    }

    fn crossing(&self, t: N, normal: Vector<N, D>) -> Crossing<N, D> {
        let feature = (self.seen.name)(&(self.from + self.dir * t), &normal);
        Crossing::new(t, normal, feature)
    }
}
