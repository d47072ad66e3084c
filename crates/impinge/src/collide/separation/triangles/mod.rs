//! Tests 8 triangles of a surface at a time against one solid, which is a box or hull ([`axes`]) or
//! a ball ([`ball`]). [`pair`] tests two triangles.
//!
//! For most triangles a surface needs only the touched side or corner; contacts along a face are
//! computed later. A case is plain if a side of the triangle and an edge of the solid cross well
//! inside both, or if a single corner of the triangle is nearest to a face of the solid and
//! projects into the inside of this face. Then the gap is certainly the distance. If the best
//! direction is the triangle's own normal, the case is plain, too, but without a feature, and the
//! gap is only a lower bound. All other triangles are passed to the separation of the pair. So are
//! triangles whose gap differs only by rounding from the prediction, the largest distance of
//! contacts: there the separation decides, for queries and manifolds alike.
//!
//! ```text
//!   tiles   [. x . x x . . .] [x . . x . . . .] ...    `masks`: bits of the selected ones
//!              |   | |         |     |
//!   packet  [0 1 2 3 4 ...]                            up to 8 of them, packed without gaps;
//!                                                      the visitor counts on over all packets
//! ```
//!
//! Tiles and packets are [`PartPacket`]s of `collide/packet.rs`. Callers: `collide/mesh/faces.rs`,
//! and `collide/mesh/ball.rs` for balls.

mod axes;
mod ball;
pub(super) mod pair;

use self::axes::{AxisFeature, TriangleAxes};
pub(crate) use self::ball::{BallQuestion, CandidateTriangles, candidate_triangles};
use super::hulls::{LocalFeatures, Polyhedral};
use crate::collide::packet::{LANES, PartPacket};
use crate::math::ones::Ones;
use crate::math::simd::Level;
use crate::math::{Mapped, Pose, Real, Vector, cross, max};
use crate::shape::{FeatureId, Kind};

/// Smallest distance of a crossing from all ends, relative to the lengths, at which a side and an
/// edge cross well inside both.
const INSIDE: f64 = 1.0 / 256.0;
/// Smallest squared sine of the angle between side and edge of a plain case.
const MIN_SINE: f64 = 1.0 / 1024.0;
/// Smallest ratio of height to longest side of a plain case; in a thinner triangle another side may
/// be as near.
const TALL: f64 = 1.0 / 32.0;
/// One corner is nearest if the other two are farther by more than this many times
/// [`rounding_error`].
const CLEAR: f64 = 64.0;
/// The side of a plain case is longer than this many times [`rounding_error`].
const LONG: f64 = 8192.0;

/// Returns the number that counts as rounding error in arithmetic on numbers up to 2.
fn rounding_error<N: Real>() -> N {
    N::lit(16.0) * N::EPSILON
}

/// A selection of the triangles of many packets.
pub(crate) struct TiledTriangles<'a, N: Real> {
    pub(crate) tiles: &'a [PartPacket<N, 3>],
    /// For each packet the bits of the selected triangles.
    pub(crate) masks: &'a [u8],
    /// Point that is subtracted from all corners; the triangles' frame has its origin there.
    pub(crate) origin: Vector<N, 3>,
}

/// Gap between a triangle and a solid along a direction, in the frame of the triangles.
#[derive(Clone, Copy)]
pub(crate) struct TriangleGap<N: Real> {
    /// Signed gap along `normal`: the distance if `touched` is `Some`, else a lower bound of it.
    pub(crate) distance: N,
    /// Unit vector from the triangle to the solid.
    pub(crate) normal: Vector<N, 3>,
    /// Nearest side or corner of the triangle; `None` if `normal` is the normal of the triangle.
    pub(crate) touched: Option<FeatureId>,
}

/// Callback: receives the index of a triangle among the selected ones, and its gap, or `None` if
/// the case is not plain.
pub(crate) type GapVisitor<'v, N> = &'v mut dyn FnMut(usize, Option<&TriangleGap<N>>);

impl<N: Real> TiledTriangles<'_, N> {
    /// Returns packet and lane of each selected triangle, in order.
    fn slots(&self) -> impl Iterator<Item = (&PartPacket<N, 3>, usize)> {
        let all = self.tiles.iter().zip(self.masks);
        all.flat_map(move |(tiles, mask)| {
            Ones::<LANES>((*mask).into()).map(move |lane| (tiles, lane))
        })
    }
}

/// Visits the triangles that are not certainly farther than `limit` from a solid, with the gap if
/// the case is plain. `pose12` is the pose of the solid in the frame of the triangles, relative to
/// their origin. Returns `false`, without a visit, for solids of which [`Polyhedral::of`] returns
/// `None`, and for hulls of fewer than 4 faces. `limit` is `prediction` plus the distance that
/// rotations may add.
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

/// A query of triangles near one solid.
struct TriangleQuery<'a, N: Real> {
    parts: &'a TiledTriangles<'a, N>,
    solid: &'a Polyhedral<'a, N>,
    pose12: &'a Pose<N, 3>,
    /// Largest distance of contacts. A gap that differs from it only by rounding is not a plain
    /// case.
    prediction: N,
    /// Triangles farther than this are skipped.
    limit: N,
}

impl<N: Real> TriangleQuery<'_, N> {
    /// Packs the selected triangles, 8 at a time, and visits the triangles that are not certainly
    /// farther than the limit.
    fn each(&self, visit: GapVisitor<'_, N>) {
        let (mut slots, mut first) = (self.parts.slots(), 0);
        loop {
            let (mut packet, mut count) = (PartPacket::blank(), 0);
            for (tiles, lane) in slots.by_ref().take(LANES) {
                packet.copy(count, tiles, lane);
                count += 1;
            }
            if count == 0 {
                return;
            }
            for run in Level::new().runs(count) {
                let axes = self.axes(run, &packet);
                for lane in run.lanes().filter(|lane| axes.beyond >> lane & 1 == 0) {
                    visit(first + lane, self.certain_gap(&axes, lane).as_ref());
                }
            }
            first += count;
        }
    }

    /// Returns the gap along the axis of a triangle; `None` if the case is not plain.
    fn certain_gap(&self, axes: &TriangleAxes<N>, lane: usize) -> Option<TriangleGap<N>> {
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
    /// Unit vector from the triangle to the solid.
    normal: Vector<N, 3>,
    shrink: N,
    solid: &'a Polyhedral<'a, N>,
}

impl<N: Real> PlacedTriangle<'_, N> {
    fn vertex(&self, vertex: u32) -> Vector<N, 3> {
        self.solid.vertex(vertex as usize) * self.shrink
    }

    /// Returns the side of the triangle with index `side`, if it crosses the edge of the solid well
    /// inside both; the two are separated along their common perpendicular. `None` otherwise, and
    /// for thin triangles and short sides.
    fn crossing(&self, edge: usize, side: usize) -> Option<FeatureId> {
        let [from, to] = self.solid.edges[edge].vertices.mapped(|end| self.vertex(end));
        let start = &self.corners[side];
        let edge = self.corners[(side + 1) % 3] - start;
        let third = self.corners[(side + 2) % 3] - start;
        let (along, arm) = (to - from, start - from);
        // Parameters of the nearest points of the two lines, multiplied by the determinant.
        let (own, other, both) = (edge.norm_squared(), along.norm_squared(), edge.dot(&along));
        let (on_edge, on_along) = (edge.dot(&arm), along.dot(&arm));
        let det = own * other - both * both;
        let (share1, share2) = (both * on_along - on_edge * other, own * on_along - both * on_edge);
        let margin = det * N::lit(INSIDE);
        let is_inside =
            share1 > margin && share1 < det - margin && share2 > margin && share2 < det - margin;
        let longest = max(own, max(third.norm_squared(), (third - edge).norm_squared()));
        let (tall, long) = (N::lit(TALL) * longest, N::lit(LONG) * rounding_error::<N>());
        // False for NaN, which is not a plain case.
        let is_certain = is_inside
            && det > N::lit(MIN_SINE) * own * other
            && own > long * long
            && cross(&edge, &third).norm_squared() > tall * tall;
        is_certain.then(|| FeatureId::Edge([0, 1, 2][side]))
    }

    /// Returns the corner of the triangle nearest to a face of the solid, if no other corner is
    /// about as near, and the nearest corner projects into the inside of the face; else `None`.
    fn corner_over(&self, face: usize) -> Option<FeatureId> {
        let outward = -self.normal;
        let heights = self.corners.each_ref().mapped(|corner| outward.dot(corner));
        let lower =
            |best: usize, next: usize| if heights[next] < heights[best] { next } else { best };
        let lowest = lower(lower(0, 1), 2);
        let clear = heights[lowest] + N::lit(CLEAR) * rounding_error::<N>();
        let is_alone = (0..3).all(|other: usize| other == lowest || heights[other] > clear);
        let (ring, at) = (self.solid.ring(face), self.corners[lowest]);
        let is_over = |(from, to): (&u32, &u32)| {
            let from = self.vertex(*from);
            cross(&outward, &(self.vertex(*to) - from)).dot(&(at - from)) > N::ZERO
        };
        let is_certain = is_alone && ring.iter().zip(ring.iter().cycle().skip(1)).all(is_over);
        is_certain.then(|| FeatureId::Vertex([0, 1, 2][lowest]))
    }
}
