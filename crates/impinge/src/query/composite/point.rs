//! The nearest point of a composite: the nearest point of its nearest part.

use crate::collide::parts::between::recentred;
use crate::collide::parts::bounds::{around_point, loosened};
use crate::math::{Mapped, Point, Real, Space, Vector, max, min};
use crate::query::point::{SurfacePoint, length};
use crate::shape::{CompositeShape, FeatureId, Geometry, Part, PartSolid};
use crate::tables::ByDimension;

/// The result of a point query on the nearest part of a composite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartPoint<N: Real, const D: usize> {
    /// The signed distance of the query point: zero or negative inside and on the boundary. It is
    /// more accurate than the distance computed from the two points, whose coordinates may be
    /// large.
    pub(crate) distance: N,
    /// The nearest point of the part's boundary, in the frame of the composite.
    pub(crate) point: Point<N, D>,
    pub(crate) feature: FeatureId,
    pub(crate) part: u32,
    /// The nearest point in the frame of [`PartQuery::query`]. For a triangle or segment the origin
    /// of that frame is the query point.
    pub(crate) local: Point<N, D>,
}

/// A part in a frame near the query point. A triangle or segment is translated so that the query
/// point is the origin, unless a coordinate overflows.
pub(crate) struct PartQuery<'a, N: Real, const D: usize> {
    part: Part<'a, N, D>,
    moved: Vector<N, D>,
    /// The query point in the frame of the moved part.
    pub(crate) query: Point<N, D>,
}

impl<'a, N: Real, const D: usize> PartQuery<'a, N, D> {
    pub(crate) fn new(part: Part<'a, N, D>, point: &Point<N, D>) -> Self {
        let query = part.pose.inverse_point(point);
        match recentred(&part.solid, &query.coords) {
            Some(solid) => {
                let part = Part { solid, ..part };
                Self { part, moved: query.coords, query: Point::origin() }
            }
            None => Self { part, moved: Vector::<N, D>::zeros(), query },
        }
    }

    pub(crate) fn solid(&self) -> &PartSolid<'a, N, D> {
        &self.part.solid
    }

    /// Converts a point from the frame of the moved part to the composite's frame.
    fn outer(&self, local: &Point<N, D>) -> Point<N, D> {
        self.part.pose.point(&(local + self.moved))
    }
}

impl<N: Real, const D: usize> PartQuery<'_, N, D> {
    /// Returns whether a plane proves that a triangle or segment is farther than `distance` from
    /// the query point; false for other parts, and for a part that was not translated. Let `m` be
    /// the sum of the corners `c` relative to the query point, where the second end of a segment
    /// counts twice. All corners lie beyond the plane perpendicular to `m` at the distance `min(m ·
    /// c) / |m|`.
    fn is_beyond(&self, distance: N) -> bool {
        let corners: [Vector<N, D>; 3] = match self.solid() {
            _ if self.query != Point::origin() => return false,
            PartSolid::Triangle(triangle) => triangle.corners().mapped(|corner| corner.coords),
            PartSolid::Segment(segment) => {
                let (a, b) = (segment.a().coords, segment.b().coords);
                [a, b, b]
            }
            PartSolid::Shape(_) => return false,
        };
        let [a, b, c] = &corners;
        let sum = a + b + c;
        let (heights, squares) =
            (corners.mapped(|corner| sum.dot(&corner)), corners.mapped(|v| v.norm_squared()));
        let square = sum.norm_squared();
        // The margins are the rounding error of the products, 16 epsilon times the sum of all
        // squares, and a thousandth of the distance. Parts that are equally near up to rounding are
        // thus still tested.
        let rounding_error =
            N::lit(16.0) * N::EPSILON * (square + squares[0] + squares[1] + squares[2]);
        let lowest = min(min(heights[0], heights[1]), heights[2]) - rounding_error;
        let limit = distance * distance * square * N::lit(1.0 + 1.0 / 512.0);
        lowest > N::ZERO && lowest * lowest > limit && limit > N::MIN_POSITIVE
    }
}

impl<N: Space<D>, const D: usize> PartQuery<'_, N, D> {
    /// Returns the nearest point of the part with the index `number`; `None` if its distance is
    /// NaN, as after an overflow.
    fn nearest(&self, number: u32, point: &Point<N, D>) -> Option<PartPoint<N, D>> {
        let Geometry(kind) = self.part.solid.geometry();
        let found = <N::Algorithms>::surface_point(kind, &self.query);
        let (projected, feature) = found.projection(&self.query);
        let local = projected.point;
        let apart = length(&(self.query - local));
        let distance = if projected.is_inside { N::ZERO - apart } else { apart };
        let is_at_query = apart == N::ZERO;
        let outer = if is_at_query { *point } else { self.outer(&local) };
        let is_number = distance <= N::INFINITY;
        is_number.then_some(PartPoint { distance, point: outer, feature, part: number, local })
    }
}

/// Returns the nearest boundary point on the nearest part, or on the part in which `point` is
/// deepest; of several such parts, on the part with the lowest index. If `touching` is true, only
/// parts that contain the point are considered, and any of these may be returned.
///
/// Returns `None` if there are no parts to consider, or if the point is not finite.
pub(crate) fn nearest_part<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    point: &Point<N, D>,
    touching: bool,
) -> Option<PartPoint<N, D>> {
    let search = parts.search();
    let start = around_point(point, &search.bounds())?;
    let mut best: Option<PartPoint<N, D>> = None;
    let limit = if touching { N::ZERO } else { N::INFINITY };
    search.nearest(&start, limit, &mut |index, _| {
        let part_query = PartQuery::new(parts.part(index), point);
        let is_beyond = best.is_some_and(|best| part_query.is_beyond(best.distance));
        if !is_beyond
            && let Some(found) = part_query.nearest(index, point)
            && best.is_none_or(|best| found.is_before(&best))
        {
            best = Some(found);
        }
        let bound = best.map_or(limit, |best| best.distance);
        let is_decided = touching && bound <= N::ZERO && best.is_some();
        if is_decided { -N::ONE } else { loosened(max(bound, N::ZERO)) }
    });
    let best = best.filter(|best| !touching || best.distance <= N::ZERO);
    if parts.has_bodies() { deepest_within(parts, point, best) } else { best }
}

/// Returns the result for a composite with bodies: the deepest among `best` and the nearest
/// boundary part of each body that contains the point. Returns `best` if no body contains the
/// point.
fn deepest_within<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    point: &Point<N, D>,
    best: Option<PartPoint<N, D>>,
) -> Option<PartPoint<N, D>> {
    let mut best = best;
    parts.each_body(&mut |body| {
        if !body.holds(point) {
            return;
        }
        let (search, range) = (parts.search(), body.parts());
        let Some(start) = around_point(point, &search.bounds()) else { return };
        let mut nearest: Option<PartPoint<N, D>> = None;
        search.nearest(&start, N::INFINITY, &mut |index, _| {
            if range.contains(&index)
                && let Some(found) = PartQuery::new(parts.part(index), point).nearest(index, point)
                && nearest.is_none_or(|nearest| found.is_before(&nearest))
            {
                nearest = Some(found);
            }
            loosened(max(nearest.map_or(N::INFINITY, |nearest| nearest.distance), N::ZERO))
        });
        let inside = nearest.map(|found| PartPoint { distance: -found.distance.abs(), ..found });
        let is_deeper = |found: &PartPoint<N, D>| best.is_none_or(|best| found.is_before(&best));
        best = inside.filter(is_deeper).or(best);
    });
    best
}

impl<N: Real, const D: usize> PartPoint<N, D> {
    /// Returns whether this point is nearer or deeper than `other`, or equal with a lower part
    /// index.
    fn is_before(&self, other: &Self) -> bool {
        self.distance < other.distance
            || (self.distance == other.distance && self.part < other.part)
    }
}

/// Implements the point query of composites in the dispatch table of shapes.
pub(crate) fn surface_point<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let nowhere = SurfacePoint { point: *point, feature: FeatureId::Face(0), is_inside: false };
    nearest_part(parts, point, false).map_or(nowhere, |found| SurfacePoint {
        point: found.point,
        feature: found.feature,
        is_inside: found.distance <= N::ZERO,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Pose;
    use crate::math::xorshift::Xorshift;
    use crate::shape::{Segment, Triangle};

    /// Checks, for random triangles and segments of three sizes, that no part is reported as beyond
    /// its distance or a larger one, and that at least a third of the parts are reported as beyond
    /// a quarter or three quarters of their distance.
    fn parts_beyond<N: Space<3>>() {
        let random = &mut Xorshift(7);
        let (mut beyond, mut decided) = (0, 0);
        for round in 0..3000 {
            let scale = [1.0, 1e-12, 1e9][round % 3];
            let aside = random.vector::<f64>(3.0);
            let mut corner = || {
                let at = random.vector::<f64>([1.0, 0.1, 4.0][round / 3 % 3]) + aside;
                Point::from(at.map(|x| N::lit(x * scale)))
            };
            let corners = [corner(), corner(), corner()];
            let point = corner();
            let solid = if round % 4 == 0 {
                PartSolid::Segment(Segment::new(corners[0], corners[1]))
            } else {
                PartSolid::Triangle(Triangle::new(corners[0], corners[1], corners[2]))
            };
            let part_query = PartQuery::new(Part { pose: Pose::identity(), solid }, &point);
            let found = part_query.nearest(0, &point).expect("finite").distance;
            assert!(!part_query.is_beyond(found), "{round}: it is as near as it is");
            let share = N::lit(0.25 + 0.5 * f64::from(u32::try_from(round % 2).expect("small")));
            for limit in [found * share, found * N::lit(1.5)] {
                assert!(
                    !part_query.is_beyond(limit) || limit < found,
                    "{round}: {found} and {limit}"
                );
            }
            beyond += 1;
            decided += usize::from(part_query.is_beyond(found * share));
        }
        assert!(decided * 3 > beyond, "{decided} of {beyond}");
    }

    #[test]
    fn what_is_beyond_a_distance_is_farther() {
        parts_beyond::<f32>();
        parts_beyond::<f64>();
    }
}
