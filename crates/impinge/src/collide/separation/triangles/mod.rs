//! Triangles of a surface and one solid, eight at a time: boxes and hulls ([`axes`]), and balls
//! ([`ball`]); and two triangles ([`pair`]).
//!
//! For most triangles a surface needs only the side or corner that is touched; contacts along the
//! face are computed separately. Where a side and an edge cross well inside both, or one corner
//! alone is nearest to a face and over its inside, this feature is certain, and so is the distance
//! along the axis. All other triangles are left to the separation of the pair. So are those whose
//! distance differs from the prediction by rounding error alone: the separation decides whether a
//! pair is within the prediction, for queries and manifolds alike.

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

/// A side and an edge cross well inside if the crossing is farther from the ends than this share of
/// their lengths.
const INSIDE: f64 = 1.0 / 256.0;
/// The least squared sine of the angle between the two.
const MIN_SINE: f64 = 1.0 / 1024.0;
/// A triangle with a smaller ratio of height to longest side may have two sides equally near.
const TALL: f64 = 1.0 / 32.0;
/// A corner is the nearest if the others are farther by this many times [`noise`]; and a side
/// shorter than `LONG` times [`noise`] is undecided.
const CLEAR: f64 = 64.0;
const LONG: f64 = 8192.0;

/// Rounding error of numbers up to 2.
fn noise<N: Real>() -> N {
    N::lit(16.0) * N::EPSILON
}

/// Selected triangles of many packets.
pub(crate) struct TiledTriangles<'a, N: Real> {
    pub(crate) tiles: &'a [PartPacket<N, 3>],
    /// For each packet a bit for each triangle that is selected.
    pub(crate) near: &'a [u8],
    /// The point that corners are taken relative to.
    pub(crate) origin: Vector<N, 3>,
}

/// The separation of a triangle and a solid, in the frame of the triangle.
#[derive(Clone, Copy)]
pub(crate) struct TriangleGap<N: Real> {
    pub(crate) distance: N,
    /// Unit, from the triangle to the solid.
    pub(crate) normal: Vector<N, 3>,
    /// The nearest side or corner of the triangle; `None` if the normal is that of the triangle.
    pub(crate) touched: Option<FeatureId>,
}

/// Receives the index of a triangle among those selected, and its gap if that is certain.
pub(crate) type GapVisitor<'v, N> = &'v mut dyn FnMut(usize, Option<&TriangleGap<N>>);

impl<N: Real> TiledTriangles<'_, N> {
    /// The packet and the lane of each selected triangle.
    fn places(&self) -> impl Iterator<Item = (&PartPacket<N, 3>, usize)> {
        let all = self.tiles.iter().zip(self.near);
        all.flat_map(move |(tiles, near)| {
            Ones::<LANES>((*near).into()).map(move |lane| (tiles, lane))
        })
    }
}

/// Visits the selected triangles that are not beyond `limit`, with their gaps where these are
/// certain. The solid has the pose `pose12` in the frame of the triangles, relative to their
/// origin. Returns false for solids without a kernel here. `limit` is `prediction` plus the margin
/// for rotation.
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

/// Triangles and one solid.
struct TriangleQuery<'a, N: Real> {
    parts: &'a TiledTriangles<'a, N>,
    solid: &'a Polyhedral<'a, N>,
    pose12: &'a Pose<N, 3>,
    prediction: N,
    limit: N,
}

impl<N: Real> TriangleQuery<'_, N> {
    /// Collects the selected triangles in packets of eight and tests these.
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

    /// Returns the gap along the axis of a lane, if the feature and the distance are certain.
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
    /// A vertex of the solid in units of the pair.
    fn vertex(&self, vertex: u32) -> Vector<N, 3> {
        self.solid.vertex(vertex as usize) * self.shrink
    }

    /// Returns the side of the triangle if it crosses an edge of the solid well inside of both,
    /// seen along their common perpendicular. `None` if not, and if the triangle is thin or the
    /// side too short.
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
        // False for NaN.
        let is_plain = is_inside
            && det > N::lit(MIN_SINE) * own * other
            && own > long * long
            && cross(&way, &third).norm_squared() > tall * tall;
        is_plain.then(|| FeatureId::Edge([0, 1, 2][side]))
    }

    /// Returns the corner of the triangle that alone is nearest to a face of the solid, if it is
    /// over the inside of the face.
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
