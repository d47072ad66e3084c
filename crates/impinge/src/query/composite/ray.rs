//! Intersections of a ray with a composite: the intersections with its parts.
//!
//! A ray does not slip between two parts that share corners. The triangle algorithms decide by
//! signs that are exact except for zero, and a zero belongs to both sides (see `triangle3`). The
//! search uses a box around the ray's origin that contains the rounding errors of times and boxes.

use super::point::nearest_part;
use crate::bounding_volume::Ray;
use crate::collide::parts::bounds::{around_point, loosened};
use crate::math::{Real, Space, max};
use crate::query::ray::at_start;
use crate::query::{RayCast, RayIntersection};
use crate::shape::CompositeShape;

/// A ray query in the frame of the composite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayQuestion<N: Real, const D: usize> {
    pub(crate) ray: Ray<N, D>,
    /// The latest time of a hit, inclusive.
    pub(crate) max_time: N,
    pub(crate) solid: bool,
}

/// Calls `visit` with the first hit on each part that is hit up to `max_time`. `visit` returns the
/// new limit of time; a limit later than the current limit has no effect, and a negative limit ends
/// the search. The order of the hits is unspecified.
pub(crate) fn each_hit<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    question: &RayQuestion<N, D>,
    visit: &mut dyn FnMut(RayIntersection<N, D>) -> N,
) {
    let RayQuestion { ray, max_time, solid } = question;
    let mut latest = *max_time;
    let Some(start) = around_point(&ray.origin, &parts.search().bounds()) else { return };
    // The comparison is false for NaN, so a NaN limit finds nothing.
    let is_valid = latest >= N::ZERO && ray.dir.iter().all(|x| x.is_finite_number());
    if !is_valid {
        return;
    }
    let held = if *solid && parts.has_bodies() { start_inside(parts, ray) } else { None };
    if let Some(hit) = held {
        let next = visit(hit);
        latest = if next < latest { next } else { latest };
        if latest < N::ZERO {
            return;
        }
    }
    parts.parts_along(ray, &start, loosened(latest), &mut |index, part| {
        if held.is_some_and(|held| held.part == index) {
            return if latest < N::ZERO { latest } else { loosened(latest) };
        }
        let local = ray.inverse_transformed_by(&part.pose);
        let hit = part.solid.as_shape().cast_local_ray(&local, *solid);
        if let Some(hit) = hit.filter(|hit| hit.toi <= latest) {
            let normal = part.pose.vector(&hit.normal);
            let next = visit(RayIntersection { normal, part: index, ..hit });
            latest = if next < latest { next } else { latest };
        }
        if latest < N::ZERO { latest } else { loosened(max(latest, N::ZERO)) }
    });
}

/// Returns the hit of a ray that starts in a body: at time zero, on the nearest part of the
/// boundary. `None` if the ray does not start in a body.
fn start_inside<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    ray: &Ray<N, D>,
) -> Option<RayIntersection<N, D>> {
    let mut is_held = false;
    parts.each_body(&mut |body| is_held |= body.holds(&ray.origin));
    let nearest = nearest_part(parts, &ray.origin, false).filter(|_| is_held)?;
    Some(RayIntersection { part: nearest.part, ..at_start(nearest.feature) })
}

/// Returns whether a ray hits a composite up to a time.
pub(crate) fn is_crossed<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    ray: &Ray<N, D>,
    max_time: N,
) -> bool {
    let mut is_hit = false;
    each_hit(parts, &RayQuestion { ray: *ray, max_time, solid: false }, &mut |_| {
        is_hit = true;
        -N::ONE
    });
    is_hit
}
