//! The face of a triangle against a box or hull, in one go: contacts along the normal of the triangle.
//!
//! Such are most contacts of solids on meshes. The triangle lies in the plane of contact, which the
//! face of the solid is seen on as a convex polygon: the corners of their common area come out of
//! fixed loops, and how far inside of all sides all corners are is
//! found side by side ([`fences`](super::fences)). Names, order and distances are those of the general builder, which is the definition of
//! this one, and which takes over wherever this one declines: triangles that are thin or lean, parts of
//! the solid that are no polygons, nearest points off the faces.

use super::capsule_face;
use super::fences::{Base, Fences};
use super::{Pair, RawManifold, tangents3};
use crate::math::{Point, Pose, Real, Vector, cross2, max, min};
use crate::query::RawPoint;
use crate::shape::{Cuboid, FaceRing, FeatureId, Kind, Triangle};

/// The least ratio of a triangle's height to its longest side.
const LEAST_HEIGHT: f64 = 1.0 / 32.0;

/// What is asked of the two.
pub(crate) struct OnFace<N: Real, const D: usize> {
    /// That of the face, unit, from the triangle to the solid.
    pub(crate) normal: Vector<N, D>,
    /// Points nearer than this by more than rounding are left out, others are as near as this.
    pub(crate) least: N,
    /// How near the nearest is, if that is known.
    pub(crate) nearest: Option<N>,
    /// Points farther than this are left out.
    pub(crate) prediction: N,
    /// Lengths below this are rounding errors of the pair.
    pub(crate) tolerance: N,
}

/// In the plane triangles have no faces.
pub(crate) fn on_face2<N: Real>(
    _: &Pair<'_, N, 2>,
    _: &OnFace<N, 2>,
    _: &mut RawManifold<N, 2>,
) -> bool {
    false
}

/// Builds the contacts of a triangle and a box, a hull, a capsule or a segment along the triangle's normal, in
/// place of those in `out`; answers whether it did.
pub(crate) fn on_face3<N: Real>(
    pair: &Pair<'_, N, 3>,
    asked: &OnFace<N, 3>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let Pair { first, second, pose12: pose } = pair;
    let (Kind::Triangle(triangle), Kind::Cuboid(_) | Kind::Polytope(_)) = (first, second) else {
        return capsule_face::on_triangle(pair, asked, out);
    };
    let normal = asked.normal;
    let Some(ground) = Ground::new(triangle, pose, (normal, asked.tolerance)) else { return false };
    let Some(face) = &shown(second, &pose.inverse_vector(&-normal)) else { return false };
    let Some(fences) = &Fences::new(&ground.base, face) else { return false };
    let lean = pose.vector(&face.normal);
    let all = u8::MAX >> (FaceRing::<N>::MOST - face.count);
    let (top, tolerance) = (Top { face, fences, all }, asked.tolerance);
    let kept = Kept::new(asked);
    let mut meeting = Meeting { asked, ground: &ground, top, lean, tolerance, kept };
    out.points.clear();
    out.normal = normal;
    meeting.corners(out);
    meeting.crossings(out);
    meeting.kept.settle(out)
}

/// The face of few corners that a box or hull shows to a direction.
fn shown<N: Real>(solid: &Kind<'_, N, 3>, toward: &Vector<N, 3>) -> Option<FaceRing<N>> {
    match solid {
        Kind::Cuboid(cuboid) => cuboid.face_ring_at(Cuboid::facing_face(toward)?),
        Kind::Polytope(hull) => hull.face_ring_at(hull.facing_face(toward)?),
        _ => None,
    }
}

/// A triangle in the plane of contact, counter-clockwise as seen from where the normal points.
pub(super) struct Ground<'a, N: Real> {
    pub(super) id: FeatureId,
    points: [Point<N, 3>; 3],
    ids: [FeatureId; 3],
    pub(super) sides: [FeatureId; 3],
    pub(super) base: Base<'a, N>,
}

impl<'a, N: Real> Ground<'a, N> {
    /// `None` of one that is thin or not perpendicular to the normal.
    #[inline]
    pub(super) fn new(
        triangle: &Triangle<N, 3>,
        pose: &'a Pose<N, 3>,
        (normal, tolerance): (Vector<N, 3>, N),
    ) -> Option<Self> {
        let [a, b, c] = triangle.corners();
        let ways = [b - a, c - a];
        let is_level = ways.iter().all(|way| way.dot(&normal).abs() <= tolerance);
        if !is_level {
            return None;
        }
        let tangents = tangents3(&normal);
        let flat =
            |way: &Vector<N, 3>| Vector::<N, 2>::new(tangents[0].dot(way), tangents[1].dot(way));
        let (zero, to_b, to_c) = (Vector::<N, 2>::zeros(), flat(&ways[0]), flat(&ways[1]));
        let area = cross2(&to_b, &to_c);
        let squared = max(to_b.norm_squared(), to_c.norm_squared());
        let longest = max(squared, (to_c - to_b).norm_squared());
        // Written so that what is no number is not plain.
        let is_plain = area.abs() > N::lit(LEAST_HEIGHT) * longest
            && longest > N::lit(4096.0) * tolerance * tolerance;
        if !is_plain {
            return None;
        }
        let base = |flats: [Vector<N, 2>; 3]| Base {
            flats,
            inward: [
                inward(&(flats[1] - flats[0])),
                inward(&(flats[2] - flats[1])),
                inward(&(flats[0] - flats[2])),
            ],
            origin: *a,
            tangents,
            pose,
            tolerance,
        };
        // The names of corners are their places; a side has that of the corner that it leaves.
        use FeatureId::{Edge, Face, Vertex};
        Some(if area > N::ZERO {
            Self {
                id: Face(0),
                points: [*a, *b, *c],
                ids: [Vertex(0), Vertex(1), Vertex(2)],
                sides: [Edge(0), Edge(1), Edge(2)],
                base: base([zero, to_b, to_c]),
            }
        } else {
            Self {
                id: Face(1),
                points: [*a, *c, *b],
                ids: [Vertex(0), Vertex(2), Vertex(1)],
                sides: [Edge(2), Edge(1), Edge(0)],
                base: base([zero, to_c, to_b]),
            }
        })
    }
}

/// Unit, to the left of a side.
#[inline]
fn inward<N: Real>(side: &Vector<N, 2>) -> Vector<N, 2> {
    Vector::<N, 2>::new(-side.y, side.x) * (N::ONE / side.norm())
}

/// The face of the solid over the triangle.
#[derive(Clone, Copy)]
struct Top<'a, N: Real> {
    face: &'a FaceRing<N>,
    fences: &'a Fences<N>,
    /// A bit for each corner or side.
    all: u8,
}

impl<N: Real> Top<'_, N> {
    fn point(&self, at: usize) -> Point<N, 3> {
        let [x, y, z] = &self.fences.points;
        Point::<N, 3>::new(x[at], y[at], z[at])
    }

    fn flat(&self, at: usize) -> Vector<N, 2> {
        let [x, y] = &self.fences.flats;
        Vector::<N, 2>::new(x[at], y[at])
    }

    fn next(&self, at: usize) -> usize {
        if at + 1 < self.face.count { at + 1 } else { 0 }
    }

    /// The same for the next of each corner.
    const fn of_next(&self, bits: u8) -> u8 {
        (bits & self.all) >> 1 | (bits & 1) << (self.face.count - 1)
    }
}

/// The part of a side that contains a place on its line: one of its corners or itself.
fn on_side<N: Real>(
    ends: [Vector<N, 2>; 2],
    [from, to, side]: [FeatureId; 3],
    place: &Vector<N, 2>,
    tolerance: N,
) -> Option<FeatureId> {
    let near = |end: &Vector<N, 2>| (end - place).norm() <= N::TWO * tolerance;
    if near(&ends[0]) {
        return Some(from);
    }
    if near(&ends[1]) {
        return Some(to);
    }
    let along = ends[1] - ends[0];
    let share = (place - ends[0]).dot(&along);
    (share >= N::ZERO && share <= along.norm_squared()).then_some(side)
}

/// The triangle and the face of the solid over it.
struct Meeting<'a, N: Real> {
    asked: &'a OnFace<N, 3>,
    ground: &'a Ground<'a, N>,
    top: Top<'a, N>,
    /// The outward normal of the solid's face.
    lean: Vector<N, 3>,
    tolerance: N,
    kept: Kept<'a, N>,
}

/// The points that are asked for.
pub(super) struct Kept<'a, N: Real> {
    asked: &'a OnFace<N, 3>,
    /// The least distance met.
    lowest: N,
}

impl<N: Real> Meeting<'_, N> {
    /// Corners of either outline within the other.
    fn corners(&mut self, out: &mut RawManifold<N, 3>) {
        let (ground, top, normal) = (self.ground, self.top, self.asked.normal);
        let slope = normal.dot(&self.lean);
        for (at, signs) in top.fences.top_signs.iter().enumerate() {
            if signs.outside & top.all != 0 {
                continue;
            }
            let touched = !signs.inside & top.all;
            let on = if touched == 0 { top.face.id } else { self.on_top(at, touched) };
            let point = ground.points[at];
            let height = (top.point(0) - point).dot(&self.lean) / slope;
            self.kept.push(point, height, [ground.ids[at], on], out);
        }
        let [first, second, third] = &top.fences.base_signs;
        let outside = first.outside | second.outside | third.outside;
        let inside = first.inside & second.inside & third.inside;
        let mut within = !outside & top.all;
        while within != 0 {
            let at = within.trailing_zeros() as usize;
            within &= within - 1;
            let on = if inside >> at & 1 == 1 { ground.id } else { self.on_ground(at) };
            let point = top.point(at);
            let height = (point - ground.points[0]).dot(&normal);
            self.kept.push(point - normal * height, height, [on, top.face.ids[at]], out);
        }
    }

    /// The smallest part of the solid's face that has a corner of the triangle, close to some sides.
    fn on_top(&self, corner: usize, touched: u8) -> FeatureId {
        let (top, place, mut found) = (&self.top, &self.ground.base.flats[corner], None);
        for at in (0..top.face.count).filter(|at| touched >> at & 1 == 1) {
            let next = top.next(at);
            let names = [top.face.ids[at], top.face.ids[next], top.face.sides[at]];
            let on = on_side([top.flat(at), top.flat(next)], names, place, self.tolerance);
            found = on.or(found);
        }
        found.unwrap_or(top.face.id)
    }

    /// The smallest part of the triangle that has a corner of the solid's face, close to a side.
    fn on_ground(&self, corner: usize) -> FeatureId {
        let (ground, place, mut found) = (self.ground, self.top.flat(corner), None);
        let signs = &self.top.fences.base_signs;
        for at in (0..3).filter(|&at: &usize| signs[at].inside >> corner & 1 == 0) {
            let next = (at + 1) % 3;
            let names = [ground.ids[at], ground.ids[next], ground.sides[at]];
            let ends = [ground.base.flats[at], ground.base.flats[next]];
            found = on_side(ends, names, &place, self.tolerance).or(found);
        }
        found.unwrap_or(ground.id)
    }

    /// Sides that cross well inside both.
    fn crossings(&mut self, out: &mut RawManifold<N, 3>) {
        let (ground, top, fences) = (self.ground, self.top, self.top.fences);
        for side1 in 0..3 {
            let next1 = (side1 + 1) % 3;
            let [from, to] = [side1, next1].map(|at: usize| fences.top_signs[at]);
            let parted = from.inside & to.outside | from.outside & to.inside;
            let own = fences.base_signs[side1];
            let crossed =
                own.inside & top.of_next(own.outside) | own.outside & top.of_next(own.inside);
            let mut both = parted & crossed & top.all;
            while both != 0 {
                let side2 = both.trailing_zeros() as usize;
                both &= both - 1;
                let ends2 = [side2, top.next(side2)];
                let insides2 = ends2.map(|at| fences.of_base[side1][at]);
                let insides1 = [side1, next1].map(|at: usize| fences.of_top[at][side2]);
                let ends1 = [ground.points[side1], ground.points[next1]];
                let core1 = along_side(&ends1, insides1);
                let core2 = along_side(&ends2.map(|at| top.point(at)), insides2);
                let distance = self.asked.normal.dot(&(core2 - core1));
                self.kept.push(core1, distance, [ground.sides[side1], top.face.sides[side2]], out);
            }
        }
    }
}

impl<'a, N: Real> Kept<'a, N> {
    /// None yet.
    pub(super) fn new(asked: &'a OnFace<N, 3>) -> Self {
        Self { asked, lowest: N::INFINITY }
    }

    /// Adds a point that is asked for, once for each pair of names.
    pub(super) fn push(
        &mut self,
        point1: Point<N, 3>,
        distance: N,
        [feature1, feature2]: [FeatureId; 2],
        out: &mut RawManifold<N, 3>,
    ) {
        let distance = self.asked.nearest.map_or(distance, |nearest| max(distance, nearest));
        let is_near = distance <= self.asked.prediction + self.asked.tolerance
            && distance >= self.asked.least - self.asked.tolerance;
        let is_old = |old: &RawPoint<N, 3>| (old.feature1, old.feature2) == (feature1, feature2);
        if !is_near || out.points.iter().any(is_old) {
            return;
        }
        let distance = min(max(distance, self.asked.least), self.asked.prediction);
        self.lowest = min(distance, self.lowest);
        let id = out.ids.next();
        out.points.push(RawPoint { point1, distance, feature1, feature2, id, code: 0 });
    }

    /// The nearest has the distance that is known, if one is; answers false where none is so near.
    pub(super) fn settle(&self, out: &mut RawManifold<N, 3>) -> bool {
        let Some(nearest) = self.asked.nearest else { return true };
        let is_found = self.lowest <= nearest + self.asked.tolerance;
        if let Some(point) = out.points.iter_mut().find(|point| point.distance == self.lowest) {
            point.distance = nearest;
        }
        if !is_found {
            out.points.clear();
        }
        is_found
    }
}

/// The point of a side that lies on a line, given how far inside of that its ends are.
#[inline]
pub(super) fn along_side<N: Real>(ends: &[Point<N, 3>; 2], [from, to]: [N; 2]) -> Point<N, 3> {
    ends[0] + (ends[1] - ends[0]) * (from / (from - to))
}
