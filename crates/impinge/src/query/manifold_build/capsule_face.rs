//! The face of a triangle against a capsule or segment, in one go: contacts along the normal of the triangle.
//!
//! The core is a segment over the plane of the triangle: of its ends those over the triangle count, and the
//! places where it leaves the triangle. Names, order and distances are those of the general builder, which is
//! the definition of this one, and which takes over wherever this one declines: triangles that are thin or
//! lean, and ends and corners that lie, but for rounding, on a side or on the core.

use super::facet::{LEAST_COSINE, lifted};
use super::triangle_face::{Ground, Kept, OnFace};
use super::{Pair, RawManifold};
use crate::math::{Point, Real, Vector};
use crate::shape::{FeatureId, Kind, Triangle};

/// Builds the contacts of a capsule or segment and a triangle along the triangle's normal, in place of those
/// in `out`; answers whether it did.
pub(super) fn on_triangle<N: Real>(
    pair: &Pair<'_, N, 3>,
    asked: &OnFace<N, 3>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let Kind::Triangle(triangle) = pair.second else { return false };
    let (segment, radius) = match pair.first {
        Kind::Capsule(capsule) => (capsule.segment(), capsule.radius()),
        Kind::Segment(segment) => (segment, N::ZERO),
        _ => return false,
    };
    let placed = triangle.corners().map(|corner| pair.pose12.point(&corner));
    let (placed, up) = (Triangle::of_finite(placed), -asked.normal);
    let ground = Ground::new(&placed, &pair.pose12, (up, asked.tolerance));
    let Some(ground) = &ground else { return false };
    let Some(core) = Core::new([*segment.a(), *segment.b()], radius, (ground, &up)) else {
        return false;
    };
    let Some(beside) = core.beside(ground, N::TWO * asked.tolerance) else { return false };
    let mut kept = Kept::new(asked);
    out.points.clear();
    out.normal = asked.normal;
    core.points(ground, &beside, |place, names| {
        let (point, distance) = core.lifted(&place, asked);
        kept.push(point, distance, names, out);
    });
    kept.settle(out)
}

/// The core of the solid as the triangle sees it.
struct Core<N: Real> {
    ends: [Point<N, 3>; 2],
    flats: [Vector<N, 2>; 2],
    /// How high the ends are over the triangle; the lower of the two, the first of equals.
    heights: [N; 2],
    low: usize,
    radius: N,
    /// Seen from above, and its length so; in proportion to the length.
    along: Vector<N, 2>,
    length: N,
    cosine: N,
}

/// How far the ends are inside of the three sides, and the corners to the left of the core.
struct Beside<N> {
    ends: [[N; 3]; 2],
    corners: [N; 3],
}

/// A point of the core by the share of the way from its first end to its second.
struct Place<N: Real> {
    core: Point<N, 3>,
    flat: Vector<N, 2>,
    height: N,
}

impl<N: Real> Core<N> {
    /// `None` of one that is seen as a point.
    fn new(
        ends: [Point<N, 3>; 2],
        radius: N,
        (ground, up): (&Ground<'_, N>, &Vector<N, 3>),
    ) -> Option<Self> {
        let (tangents, origin) = (&ground.base.tangents, &ground.base.origin);
        let flat = |end: &Point<N, 3>| {
            let arm = end - origin;
            Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm))
        };
        let flats = [flat(&ends[0]), flat(&ends[1])];
        let heights = [up.dot(&(ends[0] - origin)), up.dot(&(ends[1] - origin))];
        let low = usize::from(heights[1] < heights[0]);
        let along = flats[1] - flats[0];
        let length = along.norm();
        // Written so that what is no number is a point.
        let is_long = length > N::lit(8.0) * ground.base.tolerance;
        let cosine = length / (ends[1] - ends[0]).norm();
        is_long.then_some(Self { ends, flats, heights, low, radius, along, length, cosine })
    }

    /// One that leans too much counts as its lower end.
    fn is_steep(&self) -> bool {
        self.cosine < N::lit(LEAST_COSINE)
    }

    /// `None` where an end or a corner lies on a line, but for rounding.
    fn beside(&self, ground: &Ground<'_, N>, room: N) -> Option<Beside<N>> {
        let (inward, corners) = (&ground.base.inward, &ground.base.flats);
        let left = Vector::<N, 2>::new(-self.along.y, self.along.x) / self.length;
        let mut beside = Beside { ends: [[N::ZERO; 3]; 2], corners: [N::ZERO; 3] };
        let mut is_plain = true;
        for side in 0..3 {
            for end in 0..2 {
                let inside = inward[side].dot(&(self.flats[end] - corners[side]));
                is_plain &= inside.abs() > room;
                beside.ends[end][side] = inside;
            }
            beside.corners[side] = left.dot(&(corners[side] - self.flats[0]));
            is_plain &= beside.corners[side].abs() > room;
        }
        is_plain.then_some(beside)
    }

    /// Visits the places of the core that are over the triangle and delimit what is, with the names of the
    /// parts of both that are there.
    fn points(
        &self,
        ground: &Ground<'_, N>,
        beside: &Beside<N>,
        mut visit: impl FnMut(Place<N>, [FeatureId; 2]),
    ) {
        for (end, name) in [FeatureId::Vertex(0), FeatureId::Vertex(1)].into_iter().enumerate() {
            let is_over = beside.ends[end].iter().all(|&inside| inside > N::ZERO);
            if is_over && (end == self.low || !self.is_steep()) {
                let (core, flat, height) = (self.ends[end], self.flats[end], self.heights[end]);
                visit(Place { core, flat, height }, [name, ground.id]);
            }
        }
        if self.is_steep() {
            return;
        }
        for side in 0..3 {
            let [from, to] = [beside.ends[0][side], beside.ends[1][side]];
            let corners = [beside.corners[side], beside.corners[(side + 1) % 3]];
            let is_left = corners.map(|corner| corner > N::ZERO);
            if (from > N::ZERO) != (to > N::ZERO) && is_left[0] != is_left[1] {
                let share = from / (from - to);
                let core = self.ends[0] + (self.ends[1] - self.ends[0]) * share;
                let flat = self.flats[0] + self.along * share;
                let height = self.heights[0] + (self.heights[1] - self.heights[0]) * share;
                visit(Place { core, flat, height }, [FeatureId::Edge(0), ground.sides[side]]);
            }
        }
    }

    /// The point of the solid's surface below a place of its core, and how high it is.
    fn lifted(&self, place: &Place<N>, asked: &OnFace<N, 3>) -> (Point<N, 3>, N) {
        if self.radius <= N::ZERO {
            return (place.core, place.height);
        }
        let cosine = if self.is_steep() { N::ONE } else { self.cosine };
        let room = self.radius + (place.height - self.heights[self.low]);
        let away = place.flat - self.flats[self.low];
        let lift = lifted((self.radius, cosine), (room, self.radius), &away);
        (place.core + asked.normal * lift, place.height - lift)
    }
}
