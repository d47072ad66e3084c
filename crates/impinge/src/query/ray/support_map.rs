//! A line and a convex solid known by its support points only.
//!
//! The steps have a cap; a time is never later than the hit.

use super::ball::roots;
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::convex::{Simplicial, separation};
use crate::math::{Pose, Real, Vector, max};
use crate::shape::{Ball, Feature, FeatureId, SupportMap};

/// Cap on the number of distances asked for. Flat faces take two or three, round ones about six;
/// a line that grazes a round one comes closer by a constant factor each time.
const ROUNDS: usize = 64;

/// The line inside the solid, searched within a ball around it: so the origin of the ray may be
/// anywhere.
///
/// Where the ray hits from outside, the end of the span is left open: nobody asks for it.
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

/// Tells the signed distance of a place and the unit vector out of the solid along which it is
/// measured; `None` if the place is not finite.
pub(super) type See<'a, N, const D: usize> = &'a dyn Fn(&Vector<N, D>) -> Option<(N, Vector<N, D>)>;

/// A convex solid as seen from places in its local frame.
pub(super) struct RaySolid<'a, N: Real, const D: usize> {
    pub(super) see: See<'a, N, D>,
    /// The name of a place on the surface, given with the normal there.
    pub(super) name: &'a dyn Fn(&Vector<N, D>, &Vector<N, D>) -> FeatureId,
    /// The solid lies within this distance of the local origin.
    pub(super) radius: N,
    /// How accurate distances are, in parts of the radius.
    pub(super) precision: N,
}

impl<N: Real, const D: usize> RaySolid<'_, N, D> {
    /// When the line is inside; `None` if never, or if that is over at time zero.
    pub(super) fn span(&self, ray: &Ray<N, D>) -> Option<Span<N, D>> {
        // Somewhat larger than the radius, which is only right up to rounding.
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
            // Rounding has let the line pass: it only touches.
            None => enter,
        };
        Some(Span { enter, leave, thin: false })
    }
}

/// A point that moves from outside the solid along a line.
struct Advance<'a, N: Real, const D: usize> {
    seen: &'a RaySolid<'a, N, D>,
    from: Vector<N, D>,
    dir: Vector<N, D>,
    /// How long it may move.
    room: N,
}

impl<N: Real, const D: usize> Advance<'_, N, D> {
    /// Moves the point to the supporting plane between it and the solid, again and again, until it
    /// is as near as distances can be distinguished; `None` once it moves away from such a plane.
    ///
    /// The planes are those of the idea of G. van den Bergen, "Ray Casting against General Convex
    /// Objects with Application to Continuous Collision Detection" (2004), found afresh each time:
    /// every one proves that the solid is not hit before it, so the time never overshoots.
    fn first_contact(&self) -> Option<Crossing<N, D>> {
        let touching = self.seen.precision * self.seen.radius;
        let mut t = N::ZERO;
        for _ in 0..ROUNDS {
            let (distance, normal) = (self.seen.see)(&(self.from + self.dir * t))?;
            let approach = -normal.dot(&self.dir);
            if distance <= touching {
                // The last step is worth it unless the plane is all but parallel to the line.
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
