//! A triangle in the frame of a solid with flat faces: what the separating axis tests of triangles
//! share.
//!
//! Two polyhedra overlap iff no normal of a face and no direction perpendicular to an edge of each
//! parts them, and if they do, the one of these along which they overlap least is the shortest way out
//! (Gottschalk, Lin and Manocha, "`OBBTree`", 1996). Where they are apart, a direction gives the
//! distance if the points that it is the direction of lie across from each other.

use smallvec::SmallVec;

use super::segments::nearest_of_segments;
use crate::convex::Separation;
use crate::math::{Matrix, Point, Pose, Real, Vector, cross, max, max_component, min};
use crate::query::Pair;
use crate::shape::{
    ConvexPolyhedron, Cuboid, FaceRing, Feature, FeatureId, Kind, Polytope, Triangle,
};

/// Thinner than this part of its longest side a triangle counts as a segment, and edges at an angle
/// with a smaller sine as parallel.
pub(super) const THIN: f64 = 16.0;

/// A triangle in the frame of the solid, in units in which neither of the two, nor the way between
/// their origins, is larger than 2.
pub(super) struct Fin<'a, N: Real> {
    triangle: &'a Triangle<N, 3>,
    pose12: &'a Pose<N, 3>,
    pub(super) corners: [Vector<N, 3>; 3],
    scale: N,
    /// 1 / `scale`, exactly.
    pub(super) shrink: N,
}

/// The directions of a [`Fin`].
pub(super) struct Edging<N: Real> {
    /// Unit, from each corner to the next; zero between corners that coincide, and on a triangle
    /// without area on all but the longest, on which they lie.
    pub(super) sides: [Vector<N, 3>; 3],
    /// Unit, on the side that sees the corners counter-clockwise; `None` without area.
    pub(super) front: Option<Vector<N, 3>>,
}

/// What a direction is perpendicular to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AxisKind {
    /// The triangle.
    Triangle,
    /// A face of the solid.
    Face(u32),
    /// An edge of the solid and a side of the triangle.
    Edges(u32, usize),
}

/// A unit direction from the triangle to the solid, and the gap it leaves between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis<N: Real> {
    pub(super) kind: AxisKind,
    pub(super) normal: Vector<N, 3>,
    pub(super) gap: N,
}

/// What the directions say.
pub(super) enum Best<N: Real> {
    /// One leaves a gap that is beyond the limit.
    Beyond,
    /// The one that leaves the largest gap.
    Axis(Axis<N>),
    /// A triangle has no area, or the faces beside an edge are not as they should be.
    Unclear,
}

impl<N: Real> Best<N> {
    /// The separation within a limit, by `fall_back` where the directions do not decide.
    pub(super) fn settled(
        &self,
        fin: &Fin<'_, N>,
        solid: &impl Faces<N>,
        limit: N,
        fall_back: impl FnOnce() -> Option<Separation<N, 3>>,
    ) -> Option<Separation<N, 3>> {
        let found = match self {
            Self::Beyond => return None,
            Self::Axis(axis) => fin.answer(solid, axis),
            Self::Unclear => None,
        };
        match found {
            Some(found) => (found.distance <= limit).then_some(found),
            None => fall_back(),
        }
    }
}

/// What arithmetic on numbers of size 2 cannot resolve.
pub(super) fn noise<N: Real>() -> N {
    N::lit(16.0) * N::EPSILON
}

impl<'a, N: Real> Fin<'a, N> {
    /// The triangle of a pair against a solid no point of which is farther than `reach` from its
    /// origin; `None` where the numbers end.
    #[inline]
    pub(super) fn new(
        triangle: &'a Triangle<N, 3>,
        pose12: &'a Pose<N, 3>,
        reach: N,
    ) -> Option<Self> {
        let (scale, shrink) = Self::units(triangle, pose12, reach)?;
        let [a, b, c] = triangle.corners();
        let place = |corner: &Point<N, 3>| {
            pose12.rotation.tr_mul(&((corner.coords - pose12.translation) * shrink))
        };
        let corners = [place(a), place(b), place(c)];
        Some(Self { triangle, pose12, corners, scale, shrink })
    }

    /// A triangle whose corners are known in the frame of the solid, in its [`Self::units`].
    pub(super) const fn placed(
        triangle: &'a Triangle<N, 3>,
        pose12: &'a Pose<N, 3>,
        corners: [Vector<N, 3>; 3],
        scale: N,
        shrink: N,
    ) -> Self {
        Self { triangle, pose12, corners, scale, shrink }
    }

    /// The length of a unit, and its inverse.
    #[inline]
    pub(super) fn units(
        triangle: &Triangle<N, 3>,
        pose12: &Pose<N, 3>,
        reach: N,
    ) -> Option<(N, N)> {
        let mut size = max(reach, max_component(&pose12.translation));
        for corner in triangle.corners() {
            size = max(size, max_component(&corner.coords));
        }
        let scale = size.power_of_two_below();
        let shrink = N::ONE / scale;
        let is_plain = size > N::ZERO && size.is_finite_number() && shrink.is_finite_number();
        (is_plain && pose12.is_finite()).then_some((scale, shrink))
    }

    /// The directions of the sides and of the front: from the sides as given, which lose nothing to
    /// the way between the origins.
    #[inline]
    pub(super) fn edging(&self) -> Edging<N> {
        Edging::of(self.triangle, self.shrink, &self.pose12.rotation)
    }

    /// The triangle and the solid.
    pub(super) fn pair<'b>(&self, solid: Kind<'b, N, 3>) -> Pair<'b, N, 3>
    where
        'a: 'b,
    {
        Pair { first: Kind::Triangle(self.triangle), second: solid, pose12: *self.pose12 }
    }

    /// Beyond the limit by more than rounding.
    pub(super) fn is_beyond(&self, gap: N, limit: N) -> bool {
        gap * self.scale > limit + N::lit(16.0) * noise::<N>() * self.scale
    }

    /// How low and how high the corners lie along a direction.
    #[inline]
    pub(super) fn range(&self, along: &Vector<N, 3>) -> [N; 2] {
        let [a, b, c] = &self.corners;
        let (a, b, c) = (a.dot(along), b.dot(along), c.dot(along));
        [min(min(a, b), c), max(max(a, b), c)]
    }

    /// The signed distance that an axis says, in the units of the pair.
    pub(super) fn grown(&self, gap: N) -> N {
        gap * self.scale
    }

    /// The answer along an axis, in the frame of the triangle; `None` if the points do not lie across
    /// from each other, so that the axis only gives a bound, or if the face of the solid is none.
    pub(super) fn answer(&self, solid: &impl Faces<N>, axis: &Axis<N>) -> Option<Separation<N, 3>> {
        let [point1, point2] = self.points(solid, axis)?;
        let aside = point2 - point1 - axis.normal * axis.gap;
        // Of solids that overlap the points do lie across from each other, but where other sides or
        // faces are as good but for rounding, they may be the wrong ones.
        let room = if axis.gap > N::ZERO { noise::<N>() } else { N::lit(4.0) * noise::<N>() };
        let is_across = aside.norm() <= room;
        if !is_across {
            return None;
        }
        let placed = |point: Vector<N, 3>| self.pose12.point(&Point::from(point * self.scale));
        let (distance, normal) = (axis.gap * self.scale, self.pose12.vector(&axis.normal));
        let (point1, point2) = (placed(point1), placed(point2));
        Some(Separation { distance, normal, point1, point2 })
    }

    /// The points of the triangle and of the solid where they face each other along an axis.
    fn points(&self, solid: &impl Faces<N>, axis: &Axis<N>) -> Option<[Vector<N, 3>; 2]> {
        let normal = &axis.normal;
        Some(match axis.kind {
            AxisKind::Triangle => {
                let base = self.seen_from(normal);
                let part = self.shrunk(solid.ring_toward(&-normal), |part| {
                    solid.core_feature(&-normal, part);
                });
                let lowest = lowest_over(&part, &base, normal);
                [onto(&lowest, &base, normal), lowest]
            }
            AxisKind::Face(face) => {
                let base = self.shrunk(solid.ring_at(face), |part| {
                    solid.face(FeatureId::Face(face), part);
                });
                let outward = -normal;
                // A flat box has faces without an area.
                if base.len() < 3 {
                    return None;
                }
                let lowest = lowest_over(&self.corners, &base, &outward);
                [lowest, onto(&lowest, &base, &outward)]
            }
            AxisKind::Edges(edge, side) => {
                let ends = solid.edge(FeatureId::Edge(edge)).map(|(_, end)| end * self.shrink);
                let side = [side, (side + 1) % 3].map(|at| Point::from(self.corners[at]));
                let (point1, point2) = nearest_of_segments(&side, &ends);
                [point1.coords, point2.coords]
            }
        })
    }

    /// The corners, counter-clockwise seen from where a vector points.
    fn seen_from(&self, toward: &Vector<N, 3>) -> [Vector<N, 3>; 3] {
        let [a, b, c] = self.corners;
        let is_front = cross(&(b - a), &(c - a)).dot(toward) >= N::ZERO;
        if is_front { [a, b, c] } else { [a, c, b] }
    }

    /// The corners of a face in the units of the pair; of what is no ring by `fill`.
    fn shrunk(
        &self,
        ring: Option<FaceRing<N>>,
        fill: impl FnOnce(&mut Feature<N, 3>),
    ) -> Polygon<N> {
        let mut polygon = Polygon::new();
        if let Some(ring) = ring {
            for at in 0..ring.count {
                polygon.push(ring.corner(at).coords * self.shrink);
            }
            return polygon;
        }
        let mut part = Feature::default();
        fill(&mut part);
        polygon.extend(part.vertices.iter().map(|vertex| vertex.coords * self.shrink));
        polygon
    }
}

impl<N: Real> Edging<N> {
    /// Of a triangle in units and in a frame that its own is turned from.
    #[inline]
    pub(super) fn of(triangle: &Triangle<N, 3>, shrink: N, turn: &Matrix<N, 3>) -> Self {
        let [a, b, c] = triangle.corners();
        let ways = [(b - a) * shrink, (c - b) * shrink, (a - c) * shrink];
        let squared = [ways[0].norm_squared(), ways[1].norm_squared(), ways[2].norm_squared()];
        let front = front_of(&ways, &squared).map(|front| turn.tr_mul(&front));
        let mut sides = ways;
        let longest = longest_of(&squared);
        for (at, (side, squared)) in sides.iter_mut().zip(squared).enumerate() {
            let is_border = front.is_some() || at == longest;
            let has_length = is_border && squared > N::MIN_POSITIVE / N::EPSILON;
            let share = if has_length { N::ONE / squared.sqrt() } else { N::ZERO };
            *side = turn.tr_mul(&(*side * share));
        }
        Self { sides, front }
    }
}

/// A solid whose faces may be given as rings.
pub(super) trait Faces<N: Real>: ConvexPolyhedron<N, 3> {
    /// What the solid shows along a direction, if it is a face with few corners.
    fn ring_toward(&self, direction: &Vector<N, 3>) -> Option<FaceRing<N>>;

    /// A face by its number, if it has an area and few corners.
    fn ring_at(&self, face: u32) -> Option<FaceRing<N>>;
}

impl<N: Real> Faces<N> for Cuboid<N, 3> {
    fn ring_toward(&self, direction: &Vector<N, 3>) -> Option<FaceRing<N>> {
        self.face_ring(direction)
    }

    fn ring_at(&self, face: u32) -> Option<FaceRing<N>> {
        self.face_ring_at(face)
    }
}

impl<N: Real> Faces<N> for Polytope<N, 3> {
    fn ring_toward(&self, direction: &Vector<N, 3>) -> Option<FaceRing<N>> {
        self.face_ring(direction)
    }

    fn ring_at(&self, face: u32) -> Option<FaceRing<N>> {
        self.face_ring_at(face)
    }
}

/// The gap that a direction or its opposite leaves between a triangle and a solid that lie between
/// two heights along it each, and whether the triangle is the upper one.
#[inline]
pub(super) fn parted<N: Real>([low, high]: [N; 2], [bottom, top]: [N; 2]) -> (N, bool) {
    let (above, below) = (low - top, bottom - high);
    if above > below { (above, true) } else { (below, false) }
}

type Polygon<N> = SmallVec<[Vector<N, 3>; 12]>;

/// The unit normal of a triangle given by its sides and their squared lengths: from the two shorter
/// ones, which lose least when multiplied.
fn front_of<N: Real>(ways: &[Vector<N, 3>; 3], squared: &[N; 3]) -> Option<Vector<N, 3>> {
    let longest = longest_of(squared);
    let across = cross(&ways[(longest + 1) % 3], &ways[(longest + 2) % 3]);
    let area = across.norm();
    // Written so that what is no number has no normal, nor what has lost digits by being small.
    let is_wide = area > N::lit(THIN) * N::EPSILON * squared[longest]
        && squared[longest] > N::MIN_POSITIVE.sqrt();
    is_wide.then(|| across / area)
}

/// The index of the greatest of three numbers, the first of equals.
fn longest_of<N: Real>(squared: &[N; 3]) -> usize {
    let longer = |a: usize, b: usize| if squared[b] > squared[a] { b } else { a };
    longer(longer(0, 1), 2)
}

/// The sine below which two edges count as parallel.
pub(super) fn least_sine<N: Real>() -> N {
    N::lit(THIN) * N::EPSILON
}

/// The middle of the lowest points of a polygon over a convex base, which is counter-clockwise seen
/// from where its unit normal points; over nothing, the middle of all the lowest.
fn lowest_over<N: Real>(
    polygon: &[Vector<N, 3>],
    base: &[Vector<N, 3>],
    normal: &Vector<N, 3>,
) -> Vector<N, 3> {
    let height = |point: &Vector<N, 3>| normal.dot(point);
    let level =
        |points: &[Vector<N, 3>]| points.iter().fold(N::INFINITY, |low, p| min(height(p), low));
    let low = level(polygon) + noise::<N>();
    let mut lowest = polygon.iter().filter(|point| height(point) <= low);
    if let (Some(only), None) = (lowest.next(), lowest.next())
        && fences(base, normal).all(|(from, inward)| inward.dot(&(only - from)) >= N::ZERO)
    {
        return *only;
    }
    let mut over = Polygon::from_slice(polygon);
    for (from, inward) in fences(base, normal) {
        over = clipped(&over, &from, &inward);
    }
    let over = if over.is_empty() { polygon } else { &over[..] };
    let low = level(over) + noise::<N>();
    let lowest = over.iter().filter(|point| height(point) <= low);
    let (count, sum) = lowest.fold((N::ZERO, Vector::<N, 3>::zeros()), |(count, sum), point| {
        (count + N::ONE, sum + point)
    });
    if count > N::ZERO { sum / count } else { polygon[0] }
}

/// The sides of a polygon: a point of each, and the direction inwards.
fn fences<'a, N: Real>(
    base: &'a [Vector<N, 3>],
    normal: &'a Vector<N, 3>,
) -> impl Iterator<Item = (Vector<N, 3>, Vector<N, 3>)> + 'a {
    // A segment or a point fences nothing in.
    let count = if base.len() > 2 { base.len() } else { 0 };
    (0..count).map(move |at| {
        let next = if at + 1 < base.len() { at + 1 } else { 0 };
        (base[at], cross(normal, &(base[next] - base[at])))
    })
}

/// The part of a polygon on the inner side of a plane (Sutherland and Hodgman, "Reentrant polygon
/// clipping", 1974).
fn clipped<N: Real>(
    polygon: &[Vector<N, 3>],
    from: &Vector<N, 3>,
    inward: &Vector<N, 3>,
) -> Polygon<N> {
    let inside = |point: &Vector<N, 3>| inward.dot(&(point - from));
    let mut kept = Polygon::new();
    for (at, start) in polygon.iter().enumerate() {
        let end = &polygon[if at + 1 < polygon.len() { at + 1 } else { 0 }];
        let (inside1, inside2) = (inside(start), inside(end));
        if inside1 >= N::ZERO {
            kept.push(*start);
        }
        if (inside1 > N::ZERO && inside2 < N::ZERO) || (inside1 < N::ZERO && inside2 > N::ZERO) {
            kept.push(start + (end - start) * (inside1 / (inside1 - inside2)));
        }
    }
    kept
}

/// The foot of a point on the plane of a convex base, drawn into the base where it lies beside it.
fn onto<N: Real>(
    point: &Vector<N, 3>,
    base: &[Vector<N, 3>],
    normal: &Vector<N, 3>,
) -> Vector<N, 3> {
    let mut foot = point - normal * normal.dot(&(point - base[0]));
    for (from, inward) in fences(base, normal) {
        let beyond = inward.dot(&(foot - from));
        if beyond < N::ZERO {
            foot -= inward * (beyond / inward.norm_squared());
        }
    }
    foot
}
