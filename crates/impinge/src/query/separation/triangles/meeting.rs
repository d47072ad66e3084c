//! One solid with flat faces among triangles of a surface: how far they are apart and where they meet, without
//! the points.
//!
//! Of most triangles a surface asks no more than which of its sides or corners is touched, and contacts along
//! its face are made anew. Where a side and an edge cross well inside both, or one corner alone is nearest to
//! a face and over its inside, that is plain, and it is certain that the direction gives the distance.

use super::super::triangle_axes::{Axis, AxisKind, Faces, Fin, noise};
use super::super::triangle_polytope;
use super::{Faceted, Question, at, polytope};
use crate::math::simd::Level;
use crate::math::{Point, Pose, Real, cross, max};
use crate::query::tiles::{GapVisitor, LANES, PartGap, TiledParts, Tiles};
use crate::shape::{Cuboid, FeatureId, Kind, Polytope, Triangle};

/// A side and an edge cross well inside both if they do farther from the ends than this part of their length.
const INSIDE: f64 = 1.0 / 32.0;
/// The least square of the sine of the angle between the two.
const LEAST_SINE: f64 = 1.0 / 64.0;
/// A triangle with less than this ratio of height to longest side is thin.
const TALL: f64 = 1.0 / 32.0;
/// One corner is the nearest where the others are farther by so many times what counts as rounding; and a side
/// that is so many times shorter than another is too short to tell.
const CLEAR: f64 = 64.0;
const LONG: f64 = 8192.0;

/// Calls with what is known of how near each of some triangles and a solid are that are not beyond a limit;
/// the solid lies at `pose12` in the frame of the triangles as seen from their origin. Answers false of solids
/// that are not treated here.
pub(crate) fn gaps3<N: Real>(
    parts: &TiledParts<'_, N, 3>,
    solid: Kind<'_, N, 3>,
    pose12: &Pose<N, 3>,
    limit: N,
    visit: GapVisitor<'_, N, 3>,
) -> bool {
    match solid {
        Kind::Cuboid(cuboid) => Packets { parts, solid: cuboid, pose12, limit }.each(visit),
        Kind::Polytope(hull) if polytope::is_small(hull) => {
            Packets { parts, solid: hull, pose12, limit }.each(visit);
        }
        _ => return false,
    }
    true
}

/// In the plane triangles are filled.
pub(crate) fn gaps2<N: Real>(
    _: &TiledParts<'_, N, 2>,
    _: Kind<'_, N, 2>,
    _: &Pose<N, 2>,
    _: N,
    _: GapVisitor<'_, N, 2>,
) -> bool {
    false
}

/// Triangles against one solid, eight at a time.
struct Packets<'a, N: Real, T> {
    parts: &'a TiledParts<'a, N, 3>,
    solid: &'a T,
    pose12: &'a Pose<N, 3>,
    limit: N,
}

impl<N: Real, T: Meets<N>> Packets<'_, N, T> {
    fn each(&self, visit: GapVisitor<'_, N, 3>) {
        let (mut places, mut first) = (self.parts.places(), 0);
        loop {
            let (mut packet, mut count) = (Tiles::blank(), 0);
            for (tiles, lane) in places.by_ref().take(LANES) {
                packet.copy(count, tiles, lane);
                count += 1;
            }
            if count == 0 {
                return;
            }
            self.each_of_eight(&packet, count, &mut |lane, gap| visit(first + lane, gap));
            first += count;
        }
    }

    fn each_of_eight(&self, packet: &Tiles<N, 3>, count: usize, visit: GapVisitor<'_, N, 3>) {
        let (reach, origin) = (self.solid.reach(), &self.parts.origin);
        let question = Question { pose12: self.pose12, reach, limit: self.limit, origin };
        let axes = at(Level::new(), self.solid, &question, packet);
        for lane in 0..count {
            let (scale, shrink) = (axes.scale[lane], axes.shrink[lane]);
            if !(scale.is_finite_number() && shrink.is_finite_number()) {
                visit(lane, None);
            } else if axes.beyond >> lane & 1 == 0 {
                let corners = packet.corners(lane).map(|corner| corner - origin);
                let triangle = Triangle::of_finite(corners);
                let corners = axes.corners_of(lane);
                let fin = Fin::placed(&triangle, self.pose12, corners, scale, shrink);
                self.one(&fin, axes.axis(lane, self.solid), &mut |gap| visit(lane, Some(gap)));
            }
        }
    }

    /// Calls with what the axis of a triangle says, unless that is beyond the limit.
    fn one(&self, fin: &Fin<'_, N>, axis: Axis<N>, visit: &mut dyn FnMut(&PartGap<'_, N, 3>)) {
        let (solid, limit) = (self.solid, self.limit);
        let exact = || solid.answer(fin, axis, limit);
        let touched = match axis.kind {
            AxisKind::Triangle => Some(None),
            AxisKind::Edges(edge, side) => {
                let is_plain =
                    is_crossing(fin, solid, edge, side, &axis) && solid.is_sound(fin, &axis);
                let side = u32::try_from(side).expect("there are three sides");
                is_plain.then_some(Some(FeatureId::Edge(side)))
            }
            AxisKind::Face(face) => {
                let corner = corner_over(fin, solid, face, &axis);
                corner.map(|corner| Some(FeatureId::Vertex(corner)))
            }
        };
        if let Some(touched) = touched {
            let distance = fin.grown(axis.gap);
            let normal = self.pose12.vector(&axis.normal);
            if distance <= limit {
                visit(&PartGap { distance, normal, touched, exact: &exact });
            }
        } else if let Some(found) = exact() {
            visit(&PartGap::of(&found, &|| Some(found)));
        }
    }
}

/// A solid whose axes are told apart.
trait Meets<N: Real>: Faceted<N> + Faces<N> {
    /// The two edges lie farthest along the axis.
    fn is_sound(&self, fin: &Fin<'_, N>, axis: &Axis<N>) -> bool;
}

impl<N: Real> Meets<N> for Cuboid<N, 3> {
    fn is_sound(&self, _: &Fin<'_, N>, _: &Axis<N>) -> bool {
        true
    }
}

impl<N: Real> Meets<N> for Polytope<N, 3> {
    fn is_sound(&self, fin: &Fin<'_, N>, axis: &Axis<N>) -> bool {
        triangle_polytope::is_sound(fin, self, axis)
    }
}

/// A side of the triangle, which is not thin, and an edge of the solid are as far apart as an axis across both
/// says, and cross well inside of both as seen along it.
#[inline]
fn is_crossing<N: Real>(
    fin: &Fin<'_, N>,
    solid: &impl Faces<N>,
    edge: u32,
    side: usize,
    axis: &Axis<N>,
) -> bool {
    let [from, to] = solid.edge(FeatureId::Edge(edge)).map(|(_, end)| end.coords * fin.shrink);
    let start = &fin.corners[side];
    let way = fin.corners[if side == 2 { 0 } else { side + 1 }] - start;
    let third = fin.corners[if side == 0 { 2 } else { side - 1 }] - start;
    let (along, arm) = (to - from, start - from);
    // Another corner may be farther along the axis than the side: then the gap is not that of the two.
    if (axis.normal.dot(&arm) + axis.gap).abs() > noise() {
        return false;
    }
    // The parameters of the nearest points of two lines, times the determinant.
    let (own, other, both) = (way.norm_squared(), along.norm_squared(), way.dot(&along));
    let (on_way, on_along) = (way.dot(&arm), along.dot(&arm));
    let det = own * other - both * both;
    let (share1, share2) = (both * on_along - on_way * other, own * on_along - both * on_way);
    let room = det * N::lit(INSIDE);
    let is_inside = share1 > room && share1 < det - room && share2 > room && share2 < det - room;
    // Written so that what is no number is not plain.
    is_inside && det > N::lit(LEAST_SINE) * own * other && {
        let longest = max(own, max(third.norm_squared(), (third - way).norm_squared()));
        let tall = N::lit(TALL) * longest;
        let long = N::lit(LONG) * noise::<N>();
        own > long * long && cross(&way, &third).norm_squared() > tall * tall
    }
}

/// The corner of the triangle that alone is nearest to a face of the solid, and over its inside.
#[inline]
fn corner_over<N: Real>(
    fin: &Fin<'_, N>,
    solid: &impl Faces<N>,
    face: u32,
    axis: &Axis<N>,
) -> Option<u32> {
    let outward = -axis.normal;
    let heights = fin.corners.each_ref().map(|corner| outward.dot(corner));
    let lower = |best: usize, next: usize| if heights[next] < heights[best] { next } else { best };
    let lowest = lower(lower(0, 1), 2);
    let clear = heights[lowest] + N::lit(CLEAR) * noise::<N>();
    let is_alone = (0..3).all(|other: usize| other == lowest || heights[other] > clear);
    if !is_alone {
        return None;
    }
    let (ring, at) = (solid.ring_at(face)?, fin.corners[lowest]);
    let corner = |index: usize| -> Point<N, 3> { ring.corner(index) * fin.shrink };
    let is_over = (0..ring.count).all(|index| {
        let from = corner(index);
        let next = corner(if index + 1 < ring.count { index + 1 } else { 0 });
        cross(&outward, &(next - from)).dot(&(at - from.coords)) > N::ZERO
    });
    is_over.then(|| u32::try_from(lowest).expect("there are three corners"))
}
