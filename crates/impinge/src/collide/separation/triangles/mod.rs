//! Triangles of a surface against one solid, eight at a time: boxes and hulls ([`axes`]), and balls ([`ball`]);
//! and two triangles ([`pair`]).
//!
//! Of most triangles a surface asks no more than which of its sides or corners is touched, and contacts along
//! its face are made anew. Where a side and an edge cross well inside both, or one corner alone is nearest to
//! a face and over its inside, that is plain, and it is certain that the direction gives the distance. All other
//! triangles are left to the separation of the pair, and so are those whose distance differs from the prediction by
//! rounding alone: the separation decides whether a pair is within it, for queries and manifolds alike.

mod axes;
mod ball;
pub(super) mod pair;

use self::axes::{AxisFeature, TriangleAxes};
pub(crate) use self::ball::{BallQuestion, NearTriangles, near_triangles};
use super::hulls::{LocalFeatures, Polyhedral};
use crate::collide::packet::{LANES, PartPacket};
use crate::math::ones::Ones;
use crate::math::simd::Level;
use crate::math::{Mapped, Pose, Real, Vector, cross, max};
use crate::shape::{FeatureId, Kind};

/// A side and an edge cross well inside both if they do farther from the ends than this part of their length.
const INSIDE: f64 = 1.0 / 256.0;
/// The least square of the sine of the angle between the two.
const MIN_SINE: f64 = 1.0 / 1024.0;
/// A triangle with less than this ratio of height to longest side may have its other sides as near.
const TALL: f64 = 1.0 / 32.0;
/// One corner is the nearest where the others are farther by so many times what counts as rounding; and a side
/// that is so many times shorter than another is too short to tell.
const CLEAR: f64 = 64.0;
const LONG: f64 = 8192.0;

/// What arithmetic on numbers of size 2 cannot resolve.
fn noise<N: Real>() -> N {
    N::lit(16.0) * N::EPSILON
}

/// Some of the triangles of many tiles.
pub(crate) struct TiledTriangles<'a, N: Real> {
    pub(crate) tiles: &'a [PartPacket<N, 3>],
    /// For each of the tiles a bit for each triangle that is meant.
    pub(crate) near: &'a [u8],
    /// Where the triangles are to be seen from.
    pub(crate) origin: Vector<N, 3>,
}

/// How far a triangle and a solid are apart, in the frame of the triangle.
#[derive(Clone, Copy)]
pub(crate) struct TriangleGap<N: Real> {
    pub(crate) distance: N,
    /// Unit, from the triangle to the solid.
    pub(crate) normal: Vector<N, 3>,
    /// The side or corner of the triangle that is nearest; `None` where the normal is that of the triangle.
    pub(crate) touched: Option<FeatureId>,
}

/// Is called with the number of a triangle, counted among those that are meant, and what is plain of it.
pub(crate) type GapVisitor<'v, N> = &'v mut dyn FnMut(usize, Option<&TriangleGap<N>>);

impl<N: Real> TiledTriangles<'_, N> {
    /// The tile and the lane of each triangle that is meant.
    fn places(&self) -> impl Iterator<Item = (&PartPacket<N, 3>, usize)> {
        let all = self.tiles.iter().zip(self.near);
        all.flat_map(move |(tiles, near)| {
            Ones::<LANES>((*near).into()).map(move |lane| (tiles, lane))
        })
    }
}

/// Calls with what is plain of how near each of some triangles and a solid are that are not beyond a limit;
/// the solid lies at `pose12` in the frame of the triangles as seen from their origin. Answers false of solids
/// that have no kernel here. The limit is the `prediction` and what turning adds to it.
pub(crate) fn gaps3<N: Real>(
    parts: &TiledTriangles<'_, N>,
    solid: Kind<'_, N, 3>,
    pose12: &Pose<N, 3>,
    prediction: N,
    limit: N,
    visit: GapVisitor<'_, N>,
) -> bool {
    let features = LocalFeatures::of(solid);
    let solid = Polyhedral::of(solid, features.as_ref()).filter(|solid| solid.faces() > 3);
    let Some(solid) = &solid else { return false };
    TriangleQuery { parts, solid, pose12, prediction, limit }.each(visit);
    true
}

/// Triangles against one solid.
struct TriangleQuery<'a, N: Real> {
    parts: &'a TiledTriangles<'a, N>,
    solid: &'a Polyhedral<'a, N>,
    pose12: &'a Pose<N, 3>,
    prediction: N,
    limit: N,
}

impl<N: Real> TriangleQuery<'_, N> {
    fn each(&self, visit: GapVisitor<'_, N>) {
        let (mut places, mut first) = (self.parts.places(), 0);
        loop {
            let (mut packet, mut count) = (PartPacket::blank(), 0);
            for (tiles, lane) in places.by_ref().take(LANES) {
                packet.copy(count, tiles, lane);
                count += 1;
            }
            if count == 0 {
                return;
            }
            for run in Level::new().runs(count) {
                let axes = self.axes(run, &packet);
                for lane in run.lanes().filter(|lane| axes.beyond >> lane & 1 == 0) {
                    visit(first + lane, self.plain(&axes, lane).as_ref());
                }
            }
            first += count;
        }
    }

    /// What the axis of a triangle says, if that is plain.
    fn plain(&self, axes: &TriangleAxes<N>, lane: usize) -> Option<TriangleGap<N>> {
        let triangle = PlacedTriangle {
            corners: axes.corners.each_ref().mapped(|corner| of_lane(corner, lane)),
            normal: of_lane(&axes.normals, lane),
            shrink: axes.shrink[lane],
            solid: self.solid,
        };
        let (gap, scale) = (axes.gaps[lane], axes.scale[lane]);
        let is_clear = (gap * scale - self.prediction).abs() > axes::slack(scale);
        if axes.known >> lane & 1 == 0 || !is_clear {
            return None;
        }
        let touched = match AxisFeature::of(axes.features[lane]) {
            AxisFeature::Triangle => None,
            AxisFeature::Face(face) => Some(triangle.corner_over(face)?),
            AxisFeature::Edges(edge, side) => Some(triangle.crossing(edge, side)?),
        };
        let normal = self.pose12.vector(&triangle.normal);
        Some(TriangleGap { distance: gap * scale, normal, touched })
    }
}

fn of_lane<N: Real>(rows: &[[N; LANES]; 3], lane: usize) -> Vector<N, 3> {
    Vector::<N, 3>::new(rows[0][lane], rows[1][lane], rows[2][lane])
}

/// A triangle in the frame of a solid, in units of the pair.
struct PlacedTriangle<'a, N: Real> {
    corners: [Vector<N, 3>; 3],
    /// Unit, from the triangle to the solid.
    normal: Vector<N, 3>,
    shrink: N,
    solid: &'a Polyhedral<'a, N>,
}

impl<N: Real> PlacedTriangle<'_, N> {
    fn vertex(&self, vertex: u32) -> Vector<N, 3> {
        self.solid.vertex(vertex as usize) * self.shrink
    }

    /// A side of the triangle, which is not thin, if it and an edge of the solid, along whose common
    /// perpendicular the two are parted, cross well inside of both.
    fn crossing(&self, edge: usize, side: usize) -> Option<FeatureId> {
        let [from, to] = self.solid.edges[edge].vertices.mapped(|end| self.vertex(end));
        let start = &self.corners[side];
        let way = self.corners[(side + 1) % 3] - start;
        let third = self.corners[(side + 2) % 3] - start;
        let (along, arm) = (to - from, start - from);
        // The parameters of the nearest points of two lines, times the determinant.
        let (own, other, both) = (way.norm_squared(), along.norm_squared(), way.dot(&along));
        let (on_way, on_along) = (way.dot(&arm), along.dot(&arm));
        let det = own * other - both * both;
        let (share1, share2) = (both * on_along - on_way * other, own * on_along - both * on_way);
        let room = det * N::lit(INSIDE);
        let is_inside =
            share1 > room && share1 < det - room && share2 > room && share2 < det - room;
        let longest = max(own, max(third.norm_squared(), (third - way).norm_squared()));
        let (tall, long) = (N::lit(TALL) * longest, N::lit(LONG) * noise::<N>());
        // Written so that NaN is not plain.
        let is_plain = is_inside
            && det > N::lit(MIN_SINE) * own * other
            && own > long * long
            && cross(&way, &third).norm_squared() > tall * tall;
        is_plain.then(|| FeatureId::Edge([0, 1, 2][side]))
    }

    /// The corner of the triangle that alone is nearest to a face of the solid, and over its inside.
    fn corner_over(&self, face: usize) -> Option<FeatureId> {
        let outward = -self.normal;
        let heights = self.corners.each_ref().mapped(|corner| outward.dot(corner));
        let lower =
            |best: usize, next: usize| if heights[next] < heights[best] { next } else { best };
        let lowest = lower(lower(0, 1), 2);
        let clear = heights[lowest] + N::lit(CLEAR) * noise::<N>();
        let is_alone = (0..3).all(|other: usize| other == lowest || heights[other] > clear);
        let (ring, at) = (self.solid.ring(face), self.corners[lowest]);
        let is_over = |(from, to): (&u32, &u32)| {
            let from = self.vertex(*from);
            cross(&outward, &(self.vertex(*to) - from)).dot(&(at - from)) > N::ZERO
        };
        let is_plain = is_alone && ring.iter().zip(ring.iter().cycle().skip(1)).all(is_over);
        is_plain.then(|| FeatureId::Vertex([0, 1, 2][lowest]))
    }
}
