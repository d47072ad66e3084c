//! Lower bounds of the signed distance from a convex solid to boxes and parts of a composite.
//!
//! Along any unit vector, two convex sets have a gap, which is negative if their projections
//! overlap. The largest of these gaps is the signed distance of the sets, so every direction gives
//! a lower bound. The solid's normal at its nearest point to some point of the other set gives a
//! bound close to the distance if the other set is small.
//!
//! ```text
//!     solid                       box or part
//!    ╭─────╮                      ┌───┐
//!    │  ·  │───> along            │   │
//!    ╰─────╯                      └───┘
//!          ├──────── gap ─────────┤        gap <= distance
//! ```

use super::between::Between;
use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component, unit};
use crate::shape::{Geometry, Kind, Part, SupportMap};
use crate::tables::ByDimension;

/// Rounding error of bounds, in units of epsilon times the coordinates.
const ROUNDING: f64 = 128.0;
/// Smallest error of bounds, relative to the coordinates. The algorithms for curved solids stop at
/// a relative tolerance of 2⁻⁴⁰.
const CURVED: f64 = 8.0e-12;

/// A convex solid in the frame of a composite, prepared for lower bounds of its distance from boxes
/// and parts.
pub(crate) struct SolidBounds<'a, N: Real, const D: usize> {
    solid: Kind<'a, N, D>,
    map: &'a dyn SupportMap<N, D>,
    pose: Pose<N, D>,
    center: Point<N, D>,
    /// Upper bound of the absolute coordinates of the solid, up to rounding.
    size: N,
}

impl<'a, N: Space<D>, const D: usize> SolidBounds<'a, N, D> {
    /// Creates the bounds of the first shape (0) or the second (1), in the frame of the other
    /// shape; `None` for composites and half-spaces.
    pub(crate) fn of(between: &'a Between<'_, N, D>, which: usize) -> Option<Self> {
        let (solid, pose) = between.in_frame_of_other(which);
        let map = Geometry(solid).as_support_map()?;
        let size = map.reach() + map.rounding() + max_component(&pose.translation);
        Some(Self { solid, map, pose: *pose, center: pose.point(&map.center()), size })
    }

    /// Returns the centre of the solid, in the frame of the composite.
    pub(crate) const fn center(&self) -> Point<N, D> {
        self.center
    }

    /// Returns a direction from the solid toward the centre of a box, computed by
    /// [`Self::outward_at`]. Also returns an upper bound of the largest coordinate of the solid
    /// along this direction, in the frame of the composite. `None` if the direction is not a unit
    /// vector or the bound is not finite.
    pub(crate) fn toward(&self, aabb: &Aabb<N, D>) -> Option<(Vector<N, D>, N)> {
        let outward = self.outward_at(&aabb.center());
        let extent = -self.gap(&outward, N::ZERO, largest_coordinate(aabb));
        (extent < N::INFINITY).then_some((outward, extent))
    }

    /// Returns a lower bound of the signed distance from the solid to everything in the box; minus
    /// infinity if [`Self::toward`] returns `None`.
    pub(super) fn of_box(&self, aabb: &Aabb<N, D>) -> N {
        self.toward(aabb).map_or(-N::INFINITY, |(along, extent)| {
            along.dot(&aabb.center().coords) - along.abs().dot(&aabb.half_extents()) - extent
        })
    }

    /// Returns a lower bound of the signed distance from the solid to a part that lies in the box.
    pub(crate) fn of_part(&self, part: &Part<'_, N, D>, aabb: &Aabb<N, D>) -> N {
        let geometry = part.solid.geometry();
        let Some(map) = geometry.as_support_map() else { return self.of_box(aabb) };
        let largest = largest_coordinate(aabb);
        let gap = |along: &Vector<N, D>| {
            let against = part.pose.inverse_vector(&-along);
            let lowest = part.pose.point(&map.core_support(&against)).coords;
            self.gap(along, along.dot(&lowest) - map.rounding(), largest)
        };
        let center = part.pose.inverse_point(&self.center);
        let Some(projected) = <N::Algorithms>::project_on_solid(geometry.0, &center) else {
            return gap(&self.outward_at(&aabb.center()));
        };
        let across = gap(&-part.pose.vector(&projected.outward));
        max(gap(&self.outward_at(&part.pose.point(&projected.point))), across)
    }

    /// Returns the outward unit normal at the solid's nearest point to `point`. For solids without
    /// a closed form, returns the direction from the centre to `point` instead, or zero if the two
    /// coincide.
    fn outward_at(&self, point: &Point<N, D>) -> Vector<N, D> {
        match <N::Algorithms>::project_on_solid(self.solid, &self.pose.inverse_point(point)) {
            Some(projected) => self.pose.vector(&projected.outward),
            None => unit(&(point - self.center))
                .map_or_else(Vector::<N, D>::zeros, |(direction, _)| direction),
        }
    }

    /// Returns the gap along a unit vector from the solid to points whose coordinate along it is at
    /// least `lowest`, minus the rounding error. Minus infinity if `along` is not a unit vector.
    /// `largest` is an upper bound of the absolute coordinates of these points.
    fn gap(&self, along: &Vector<N, D>, lowest: N, largest: N) -> N {
        let highest = self.map.core_support(&self.pose.inverse_vector(along));
        let height = along.dot(&self.pose.point(&highest).coords) + self.map.rounding();
        let size = self.size + largest;
        let bound = lowest - height - gap_slack(size);
        // Subnormal lengths have a large relative rounding error.
        let is_precise = size > N::MIN_POSITIVE / N::EPSILON;
        let is_unit = (along.norm_squared() - N::ONE).abs() < N::lit(64.0) * N::EPSILON;
        if is_precise && is_unit && bound.is_finite_number() { bound } else { -N::INFINITY }
    }
}

/// Returns a bound of the error of gaps between solids with coordinates up to `size`: rounding
/// error, or the tolerance of the searches of curved solids if that is larger.
pub(super) fn gap_slack<N: Real>(size: N) -> N {
    size * max(N::lit(ROUNDING) * N::EPSILON, N::lit(CURVED))
}

/// Returns the largest absolute coordinate of a bounded box, up to rounding.
fn largest_coordinate<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> N {
    max_component(&(aabb.center().coords.abs() + aabb.half_extents()))
}
