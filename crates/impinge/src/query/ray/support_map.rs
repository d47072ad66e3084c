//! A line and a convex solid known by its support points only.

use super::ball::roots;
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::convex::{Simplicial, separation};
use crate::math::{Pose, Real, Vector, max};
use crate::shape::{Ball, Feature, SupportMap};

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
    // Somewhat larger than the reach, which is only right up to rounding.
    let radius = (map.reach() + map.rounding()) * N::lit(1.0625);
    let around = roots(&ray.origin.coords, &ray.dir, radius)?;
    if around.leave < N::ZERO {
        return None;
    }
    let [first, last] = around.places();
    let forward =
        Advance { map, from: first, dir: ray.dir, room: around.leave - around.enter, radius };
    let enter = forward.first_contact()?;
    let enter = Crossing { t: around.enter + enter.t, ..enter };
    if enter.t >= N::ZERO {
        return Some(Span { enter, leave: Crossing::never(N::INFINITY), thin: false });
    }
    let backward = Advance { from: last, dir: -ray.dir, ..forward };
    let leave = match backward.first_contact() {
        Some(found) => Crossing { t: around.leave - found.t, ..found },
        // Rounding has let the line pass: it only touches.
        None => enter,
    };
    Some(Span { enter, leave, thin: false })
}

/// A point that moves from outside the solid along a line.
struct Advance<'a, N: Real, const D: usize> {
    map: &'a dyn SupportMap<N, D>,
    from: Vector<N, D>,
    dir: Vector<N, D>,
    /// How long it may move.
    room: N,
    /// The solid lies within this distance of the local origin.
    radius: N,
}

impl<N: Simplicial<D>, const D: usize> Advance<'_, N, D> {
    /// Moves the point to the supporting plane between it and the solid, again and again, until it
    /// is as near as distances can be told apart; `None` once it moves away from such a plane.
    ///
    /// The planes are those of the idea of G. van den Bergen, "Ray Casting against General Convex
    /// Objects with Application to Continuous Collision Detection" (2004), found afresh each time:
    /// every one proves that the solid is not hit before it, so the time never overshoots.
    fn first_contact(&self) -> Option<Crossing<N, D>> {
        let touching =
            max(N::lit(16.0) * N::EPSILON, N::lit(1.0 / 549_755_813_888.0)) * self.radius;
        let mut t = N::ZERO;
        for _ in 0..ROUNDS {
            let place = Pose::from_translation(self.from + self.dir * t);
            let found = separation(self.map, &Ball::new(N::ZERO), &place, N::INFINITY)?;
            let approach = -found.normal.dot(&self.dir);
            if found.distance <= touching {
                // The last step is worth it unless the plane is all but parallel to the line.
                let steep = approach > N::lit(0.125);
                let step = if steep { found.distance / approach } else { N::ZERO };
                return Some(self.crossing(t + step, found.normal));
            }
            t += found.distance / approach;
            let on_the_way = approach > N::ZERO && t <= self.room;
            if !on_the_way {
                return None;
            }
        }
        None
    }

    fn crossing(&self, t: N, normal: Vector<N, D>) -> Crossing<N, D> {
        let mut feature = Feature::default();
        self.map.core_feature(&normal, &mut feature);
        Crossing::new(t, normal, feature.id)
    }
}
