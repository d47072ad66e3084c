//! One solid with flat faces among triangles of a surface: how far they are apart and where they meet, without
//! the points.
//!
//! Of most triangles a surface asks no more than which of its sides or corners is touched, and contacts along
//! its face are made anew. Where a side and an edge cross well inside both, or one corner alone is nearest to
//! a face and over its inside, that is plain, and it is certain that the direction gives the distance.

use super::super::triangle_axes::{Axis, AxisKind, Faces, Fin, noise};
use super::super::triangle_polytope;
use super::{Axes, Faceted, Question, at, polytope};
use crate::convex::Separation;
use crate::math::simd::Level;
use crate::math::{Point, Pose, Real, Vector, cross, max};
use crate::query::tiles::{LANES, Tiles};
use crate::shape::{Cuboid, FeatureId, Kind, Polytope, SupportMap, Triangle};

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

/// A box or hull among triangles.
pub(crate) struct FlatQuestion<'a, N: Real> {
    pub(crate) solid: Flat<'a, N>,
    /// Its pose in the frame of the triangles as seen from their origin.
    pub(crate) pose12: Pose<N, 3>,
    pub(crate) limit: N,
    /// Where the triangles are seen from.
    pub(crate) origin: Vector<N, 3>,
}

/// A solid with flat faces.
#[derive(Clone, Copy)]
pub(crate) enum Flat<'a, N: Real> {
    Cuboid(&'a Cuboid<N, 3>),
    Polytope(&'a Polytope<N, 3>),
}

/// How a triangle and a solid meet.
pub(crate) struct Told<N: Real> {
    pub(crate) distance: N,
    /// From the triangle to the solid, in the frame of the triangle.
    pub(crate) normal: Vector<N, 3>,
    pub(crate) touched: Touched<N>,
}

/// What of the triangle is touched.
pub(crate) enum Touched<N: Real> {
    /// The normal is that of the triangle; where the points lie is not known, nor that they lie across from
    /// each other.
    Face,
    /// A side or corner, plainly.
    Seam(FeatureId),
    /// What is not plain: the separation.
    Unclear(Separation<N, 3>),
}

/// The axes of eight triangles and what they are asked of.
pub(crate) struct PacketAxes<'q, 'a, N: Real> {
    question: &'q FlatQuestion<'a, N>,
    axes: Axes<N>,
}

impl<'a, N: Real> Flat<'a, N> {
    /// `None` of what is not treated here.
    pub(crate) fn new(solid: Kind<'a, N, 3>) -> Option<Self> {
        match solid {
            Kind::Cuboid(cuboid) => Some(Self::Cuboid(cuboid)),
            Kind::Polytope(hull) if polytope::is_small(hull) => Some(Self::Polytope(hull)),
            _ => None,
        }
    }

    /// The same.
    pub(crate) const fn kind(&self) -> Kind<'a, N, 3> {
        match self {
            Self::Cuboid(cuboid) => Kind::Cuboid(cuboid),
            Self::Polytope(hull) => Kind::Polytope(hull),
        }
    }

    /// No point of the solid is farther from its origin.
    pub(crate) fn reach(&self) -> N {
        match self {
            Self::Cuboid(cuboid) => cuboid.reach(),
            Self::Polytope(hull) => hull.reach(),
        }
    }
}

impl<'a, N: Real> FlatQuestion<'a, N> {
    /// The axes of eight triangles.
    pub(crate) fn eight<'q>(&'q self, tiles: &Tiles<N, 3>) -> PacketAxes<'q, 'a, N> {
        let reach = self.solid.reach();
        let Self { pose12, limit, origin, .. } = self;
        let question = Question { pose12, reach, limit: *limit, origin };
        let axes = match self.solid {
            Flat::Cuboid(cuboid) => at(Level::new(), cuboid, &question, tiles),
            Flat::Polytope(hull) => at(Level::new(), hull, &question, tiles),
        };
        PacketAxes { question: self, axes }
    }
}

impl<N: Real> PacketAxes<'_, '_, N> {
    /// The triangle is certainly beyond the limit.
    pub(crate) const fn is_beyond(&self, lane: usize) -> bool {
        self.axes.beyond >> lane & 1 == 1
    }

    /// The numbers of all triangles have an end.
    pub(crate) fn is_sound(&self) -> bool {
        let Axes { scale, shrink, .. } = &self.axes;
        (0..LANES).all(|lane| scale[lane].is_finite_number() && shrink[lane].is_finite_number())
    }

    /// How one of the triangles, seen from the origin, and the solid meet; `None` beyond the limit.
    pub(crate) fn told(
        &self,
        lane: usize,
        triangle: &Triangle<N, 3>,
        tolerance: N,
    ) -> Option<Told<N>> {
        match self.question.solid {
            Flat::Cuboid(cuboid) => self.told_of(cuboid, lane, triangle, tolerance),
            Flat::Polytope(hull) => self.told_of(hull, lane, triangle, tolerance),
        }
    }

    /// The separation of one of the triangles.
    pub(crate) fn separation(
        &self,
        lane: usize,
        triangle: &Triangle<N, 3>,
    ) -> Option<Separation<N, 3>> {
        match self.question.solid {
            Flat::Cuboid(cuboid) => self.separation_of(cuboid, lane, triangle),
            Flat::Polytope(hull) => self.separation_of(hull, lane, triangle),
        }
    }

    fn fin<'t>(&'t self, lane: usize, triangle: &'t Triangle<N, 3>) -> Fin<'t, N> {
        let corners = self.axes.corners_of(lane);
        let (scale, shrink) = (self.axes.scale[lane], self.axes.shrink[lane]);
        Fin::placed(triangle, &self.question.pose12, corners, scale, shrink)
    }

    fn separation_of(
        &self,
        solid: &impl Faceted<N>,
        lane: usize,
        triangle: &Triangle<N, 3>,
    ) -> Option<Separation<N, 3>> {
        let axis = self.axes.axis(lane, solid);
        solid.answer(&self.fin(lane, triangle), axis, self.question.limit)
    }

    fn told_of<T: Meets<N>>(
        &self,
        solid: &T,
        lane: usize,
        triangle: &Triangle<N, 3>,
        tolerance: N,
    ) -> Option<Told<N>> {
        let (axis, fin) = (self.axes.axis(lane, solid), self.fin(lane, triangle));
        let touched = match axis.kind {
            AxisKind::Triangle => Some(Touched::Face),
            AxisKind::Edges(edge, side) => {
                let is_plain = is_crossing(&fin, solid, edge, side, &axis, tolerance)
                    && solid.is_sound(&fin, &axis);
                let side = u32::try_from(side).expect("there are three sides");
                is_plain.then_some(Touched::Seam(FeatureId::Edge(side)))
            }
            AxisKind::Face(face) => {
                let corner = corner_over(&fin, solid, face, &axis);
                corner.map(|corner| Touched::Seam(FeatureId::Vertex(corner)))
            }
        };
        if let Some(touched) = touched {
            let distance = fin.grown(axis.gap);
            let normal = self.question.pose12.vector(&axis.normal);
            return (distance <= self.question.limit).then_some(Told { distance, normal, touched });
        }
        let found = solid.answer(&fin, axis, self.question.limit)?;
        let Separation { distance, normal, .. } = found;
        Some(Told { distance, normal, touched: Touched::Unclear(found) })
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
    tolerance: N,
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
        let long = N::lit(LONG) * tolerance * fin.shrink;
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
