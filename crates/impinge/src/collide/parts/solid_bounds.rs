//! Lower bounds of how far a convex solid is from boxes and parts of a composite, also where they overlap.
//!
//! Along a unit vector a solid and what it is held against leave a gap, negative where they overlap, and their signed
//! distance is the largest of all gaps. So any direction gives a bound; the normal of the solid where it is nearest to a
//! point of the other gives one that is hardly less than the distance if the other is small.

use super::between::Between;
use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component, unit};
use crate::shape::{Geometry, Kind, Part, SupportMap};
use crate::tables::ByDimension;

/// Bounds are less than gaps by so many rounding units of all lengths; of curved solids the algorithms are content
/// with 2⁻⁴⁰ of these.
const ROUNDING: f64 = 128.0;
const CURVED: f64 = 8.0e-12;

/// A convex solid in the frame of a composite.
pub(crate) struct SolidBounds<'a, N: Real, const D: usize> {
    solid: Kind<'a, N, D>,
    map: &'a dyn SupportMap<N, D>,
    pose: Pose<N, D>,
    center: Point<N, D>,
    /// No coordinate of the solid is larger, but for rounding.
    size: N,
}

impl<'a, N: Space<D>, const D: usize> SolidBounds<'a, N, D> {
    /// Of the first shape (0) or the second (1); `None` of composites and half-spaces.
    pub(crate) fn of(between: &'a Between<'_, N, D>, which: usize) -> Option<Self> {
        let (solid, pose) = between.seen_by_other(which);
        let map = Geometry(solid).as_support_map()?;
        let size = map.reach() + map.rounding() + max_component(&pose.translation);
        Some(Self { solid, map, pose: *pose, center: pose.point(&map.center()), size })
    }

    /// A point well inside of the solid, in the frame of the composite.
    pub(crate) const fn center(&self) -> Point<N, D> {
        self.center
    }

    /// The unit vector along which the solid lies nearest to the middle of a box, and how far it reaches along that, or more.
    pub(crate) fn toward(&self, aabb: &Aabb<N, D>) -> Option<(Vector<N, D>, N)> {
        let outward = self.outward_at(&aabb.center());
        let reach = -self.gap(&outward, N::ZERO, reach_of(aabb));
        (reach < N::INFINITY).then_some((outward, reach))
    }

    /// The signed distance of the solid from anything in the box is not less.
    pub(super) fn of_box(&self, aabb: &Aabb<N, D>) -> N {
        self.toward(aabb).map_or(-N::INFINITY, |(along, reach)| {
            along.dot(&aabb.center().coords) - along.abs().dot(&aabb.half_extents()) - reach
        })
    }

    /// The signed distance of the solid from the part, which lies in the box, is not less.
    pub(crate) fn of_part(&self, part: &Part<'_, N, D>, aabb: &Aabb<N, D>) -> N {
        let geometry = part.solid.geometry();
        let Some(map) = geometry.as_support_map() else { return self.of_box(aabb) };
        let reach = reach_of(aabb);
        let gap = |along: &Vector<N, D>| {
            let against = part.pose.inverse_vector(&-along);
            let lowest = part.pose.point(&map.core_support(&against)).coords;
            self.gap(along, along.dot(&lowest) - map.rounding(), reach)
        };
        let center = part.pose.inverse_point(&self.center);
        let Some(seen) = <N::Algorithms>::seen(geometry.0, &center) else {
            return gap(&self.outward_at(&aabb.center()));
        };
        let across = gap(&-part.pose.vector(&seen.outward));
        max(gap(&self.outward_at(&part.pose.point(&seen.point))), across)
    }

    /// The outward normal where the solid is nearest to a point, or the way from its middle to that.
    fn outward_at(&self, point: &Point<N, D>) -> Vector<N, D> {
        match <N::Algorithms>::seen(self.solid, &self.pose.inverse_point(point)) {
            Some(seen) => self.pose.vector(&seen.outward),
            None => unit(&(point - self.center)).map_or_else(Vector::<N, D>::zeros, |(way, _)| way),
        }
    }

    /// The gap along a vector from the solid to what is above `lowest`, less all that rounding may have added to it;
    /// minus infinity of a vector that is no direction. The other reaches that far from the origin.
    fn gap(&self, along: &Vector<N, D>, lowest: N, reach: N) -> N {
        let highest = self.map.core_support(&self.pose.inverse_vector(along));
        let height = along.dot(&self.pose.point(&highest).coords) + self.map.rounding();
        let size = self.size + reach;
        let bound = lowest - height - gap_slack(size);
        // Lengths that are subnormal numbers are not precise.
        let is_precise = size > N::MIN_POSITIVE / N::EPSILON;
        let is_unit = (along.norm_squared() - N::ONE).abs() < N::lit(64.0) * N::EPSILON;
        if is_precise && is_unit && bound.is_finite_number() { bound } else { -N::INFINITY }
    }
}

/// What rounding, and what algorithms are content with, may add to gaps between solids with coordinates of this size.
pub(super) fn gap_slack<N: Real>(size: N) -> N {
    size * max(N::lit(ROUNDING) * N::EPSILON, N::lit(CURVED))
}

/// The largest coordinate of a bounded box, but for rounding.
fn reach_of<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> N {
    max_component(&(aabb.center().coords.abs() + aabb.half_extents()))
}
