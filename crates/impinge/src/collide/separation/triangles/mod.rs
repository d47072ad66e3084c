//! Triangles of a surface against one solid, eight at a time: boxes and hulls ([`axes`]), and balls
//! ([`ball`]). And two triangles ([`pair`]).
//!
//! For most triangles a surface needs only the touched side or corner; contacts along a face are
//! computed again. A case is plain if a side and an edge cross well inside both, or if a single
//! corner is nearest to a face and over its inside. Then the direction certainly gives the
//! distance. All other triangles go to the separation of the pair. So do those whose distance
//! differs from the prediction by rounding alone: for queries and manifolds alike, the separation
//! decides whether a pair is within.
//!
//! ```text
//!   tiles   [. x . x x . . .] [x . . x . . . .] ...    `near`: bits of the selected ones
//!              |   | |         |     |
//!   packet  [0 1 2 3 4 ...]                            up to eight of them, packed without gaps;
//!                                                      the visitor counts on over all packets
//! ```
//!
//! Layout of both: [`PartPacket`] of `collide/packet.rs`. Caller: `collide/mesh/faces.rs`; balls
//! `collide/mesh/ball.rs`.

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

/// A side and an edge cross well inside both if the crossing is farther than this share from all
/// ends.
const INSIDE: f64 = 1.0 / 256.0;
/// Least squared sine of the angle between the two.
const MIN_SINE: f64 = 1.0 / 1024.0;
/// Least ratio of height to longest side: in a thinner triangle another side may be as near.
const TALL: f64 = 1.0 / 32.0;
/// `CLEAR`: one corner is nearest if the others are farther by this many times rounding. `LONG`: a
/// side below this many times rounding in length is too short to decide.
const CLEAR: f64 = 64.0;
const LONG: f64 = 8192.0;

/// Returns the rounding error of arithmetic on numbers of size 2.
fn noise<N: Real>() -> N {
    N::lit(16.0) * N::EPSILON
}

/// A subset of the triangles of many tiles.
pub(crate) struct TiledTriangles<'a, N: Real> {
    pub(crate) tiles: &'a [PartPacket<N, 3>],
    /// For each tile the bits of the selected triangles.
    pub(crate) near: &'a [u8],
    /// Origin that the triangles are taken relative to.
    pub(crate) origin: Vector<N, 3>,
}

/// Distance of a triangle and a solid, in the frame of the triangle.
#[derive(Clone, Copy)]
pub(crate) struct TriangleGap<N: Real> {
    /// Signed distance along the normal.
    pub(crate) distance: N,
    /// Unit, from the triangle to the solid.
    pub(crate) normal: Vector<N, 3>,
    /// The nearest side or corner of the triangle; `None` if the normal is that of the triangle.
    pub(crate) touched: Option<FeatureId>,
}

/// Receives the index of a triangle among the selected ones, and its gap if the case is plain.
pub(crate) type GapVisitor<'v, N> = &'v mut dyn FnMut(usize, Option<&TriangleGap<N>>);

impl<N: Real> TiledTriangles<'_, N> {
    /// Tile and lane of each selected triangle.
    fn places(&self) -> impl Iterator<Item = (&PartPacket<N, 3>, usize)> {
        let all = self.tiles.iter().zip(self.near);
        all.flat_map(move |(tiles, near)| {
            Ones::<LANES>((*near).into()).map(move |lane| (tiles, lane))
        })
    }
}

/// Visits the triangles that are not certainly farther than `limit` from a solid, with the gap
/// where the case is plain. The solid lies at `pose12` in the frame of the triangles, relative to
/// their origin. Returns `false` for solids without a kernel here. `limit` is `prediction` plus
/// what turning adds to it.
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
    /// Distance up to which contacts are asked for; close to it a case is not plain.
    prediction: N,
    /// Triangles farther than this are skipped.
    limit: N,
}

impl<N: Real> TriangleQuery<'_, N> {
    /// Packs the selected triangles, eight at a time, and visits those within the limit.
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

    /// Returns the gap along the axis of a triangle, if the case is plain.
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

    /// Returns a side of the triangle if it crosses an edge of the solid well inside both. The two
    /// are separated along their common perpendicular. `None` also for thin triangles and short
    /// sides.
    fn crossing(&self, edge: usize, side: usize) -> Option<FeatureId> {
        let [from, to] = self.solid.edges[edge].vertices.mapped(|end| self.vertex(end));
        let start = &self.corners[side];
        let way = self.corners[(side + 1) % 3] - start;
        let third = self.corners[(side + 2) % 3] - start;
        let (along, arm) = (to - from, start - from);
        // Parameters of the nearest points of two lines, times the determinant.
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

    /// Returns the corner of the triangle that alone is nearest to a face of the solid and over its
    /// inside.
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
