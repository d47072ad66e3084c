//! How near the parts of a surface are to a convex solid: bounds that cost little.
//!
//! Most parts whose boxes are near are not near themselves. A plane between the solid and a part says
//! so for the price of a few products: the one across the shortest way from the part to the solid's
//! middle. Any plane gives a lower bound of the distance, so no case needs care but for rounding.

use super::super::between::Between;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component, min};
use crate::query::Pair;
use crate::shape::{CompositeShape, Geometry, Kind, Part, PartSolid, SupportMap};

/// Bounds are loosened by so many rounding units of all lengths, or by what is left where the search
/// for the distance of curved solids stops, whichever is more.
const ROUNDING: f64 = 128.0;
const CURVED: f64 = 1.0e-10;

/// A convex first shape, as the second sees it.
pub(super) struct Probe<'a, N: Real, const D: usize> {
    map: &'a dyn SupportMap<N, D>,
    /// Its core is the middle alone.
    is_ball: bool,
    pose21: &'a Pose<N, D>,
    center: Point<N, D>,
    /// Parts beyond this are of no interest.
    reach: N,
    /// The size of the solid, its place and the reach.
    size: N,
}

/// What a probe finds of a part.
pub(super) struct Bound<N> {
    /// The part is at least so far from the middle of the solid; zero if that is not known.
    pub(super) from_middle: N,
    /// The part is out of reach.
    pub(super) is_beyond: bool,
}

impl<'a, N: Space<D>, const D: usize> Probe<'a, N, D> {
    /// `None` of two composites and of half-spaces.
    pub(super) fn new(between: &'a Between<'a, N, D>, reach: N) -> Option<Self> {
        let Pair { first, .. } = between.pair;
        let map = Geometry(first).as_support_map()?;
        let (is_ball, pose21) = (matches!(first, Kind::Ball(_)), &between.pose21);
        let center = pose21.point(&map.center());
        let own = if is_ball { map.rounding() } else { map.reach() + map.rounding() };
        let size = own + reach + max_component(&pose21.translation);
        Some(Self { map, is_ball, pose21, center, reach, size })
    }

    /// The middle of the solid.
    pub(super) const fn center(&self) -> &Point<N, D> {
        &self.center
    }

    /// What is known of a part of a composite; nothing of one that is not given by its corners.
    pub(super) fn bound(&self, parts: &dyn CompositeShape<N, D>, part: u32) -> Bound<N> {
        let Part { pose, solid } = parts.part(part);
        let placed = |corner: &Point<N, D>| pose.point(corner);
        match solid {
            PartSolid::Triangle(triangle) => {
                let corners = triangle.corners().each_ref().map(placed);
                self.of_corners(&corners, &to_triangle(&corners, &self.center))
            }
            PartSolid::Segment(segment) => {
                let corners = [placed(segment.a()), placed(segment.b())];
                self.of_corners(&corners, &to_segment(&corners, &self.center))
            }
            PartSolid::Shape(_) => Bound { from_middle: N::ZERO, is_beyond: false },
        }
    }

    /// What the planes across a direction from the part to the middle say.
    fn of_corners<const K: usize>(
        &self,
        corners: &[Point<N, D>; K],
        toward: &Vector<N, D>,
    ) -> Bound<N> {
        let (mut least, mut farthest) = (N::INFINITY, self.size);
        for corner in corners {
            let arm = self.center - corner;
            least = min(least, toward.dot(&arm));
            farthest = max(farthest, max_component(&corner.coords));
        }
        let length = toward.norm();
        let slack = max(N::lit(ROUNDING) * N::EPSILON, N::lit(CURVED)) * (farthest + self.size);
        // Written so that what is no number bounds nothing.
        let is_bound = length > slack && least > N::ZERO;
        if !is_bound {
            return Bound { from_middle: N::ZERO, is_beyond: false };
        }
        let from_middle = least / length - slack;
        let own = if self.is_ball { self.map.rounding() } else { self.extent(toward, length) };
        Bound { from_middle, is_beyond: from_middle - own - slack > self.reach }
    }

    /// How far the solid reaches from its middle against a direction of a given length.
    fn extent(&self, toward: &Vector<N, D>, length: N) -> N {
        let local = -self.pose21.inverse_vector(toward);
        let farthest = self.map.core_support(&local) - self.map.center();
        local.dot(&farthest) / length + self.map.rounding()
    }
}

/// From the point of a segment nearest to a point, to that.
fn to_segment<N: Real, const D: usize>(ends: &[Point<N, D>; 2], p: &Point<N, D>) -> Vector<N, D> {
    let (along, arm) = (ends[1] - ends[0], p - ends[0]);
    let share = along.dot(&arm) / along.norm_squared();
    let share = if share > N::ZERO { min(share, N::ONE) } else { N::ZERO };
    arm - along * share
}

/// From the point of a triangle nearest to a point, to that: in the middle by its shares of the
/// corners, else the nearest of the sides. In any dimension.
fn to_triangle<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
    p: &Point<N, D>,
) -> Vector<N, D> {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    let (bb, bc, cc) = (ab.norm_squared(), ab.dot(&ac), ac.norm_squared());
    // The shares of two corners, times four squared areas.
    let (at_b, at_c) = (d1 * cc - d2 * bc, d2 * bb - d1 * bc);
    let area = bb * cc - bc * bc;
    if at_b >= N::ZERO && at_c >= N::ZERO && at_b + at_c <= area && area > N::ZERO {
        return ap - ab * (at_b / area) - ac * (at_c / area);
    }
    let sides = [[*a, *b], [*b, *c], [*c, *a]].map(|side| to_segment(&side, p));
    let nearer = |x: Vector<N, D>, y: Vector<N, D>| {
        if y.norm_squared() < x.norm_squared() { y } else { x }
    };
    sides.into_iter().reduce(nearer).unwrap_or(ap)
}
