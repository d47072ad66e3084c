//! The face of a triangle against a box or hull, in one go: contacts along the normal of the triangle.
//!
//! Such are most contacts of solids on meshes. The triangle lies in the plane of contact, which the
//! face of the solid is seen on as a convex polygon: the corners of their common area come out of
//! fixed loops. Names, order and distances are those of the general builder, which is the definition of
//! this one, and which takes over wherever this one declines: triangles that are thin or lean, parts of
//! the solid that are no polygons, nearest points off the faces.

use super::frame::rounding;
use super::{Pair, RawManifold, tangents3};
use crate::math::{Point, Real, Vector, cross2, max, min};
use crate::query::RawPoint;
use crate::shape::{ConvexPolyhedron, Feature, FeatureId, Kind, Triangle};

/// So many corners a face may have here.
const MOST: usize = 8;
/// The least ratio of a triangle's height to its longest side.
const LEAST_HEIGHT: f64 = 1.0 / 32.0;

/// What is asked of the two.
pub(crate) struct OnFace<N: Real, const D: usize> {
    /// That of the face, unit, from the triangle to the solid.
    pub(crate) normal: Vector<N, D>,
    /// Points nearer than this by more than rounding are left out.
    pub(crate) least: N,
    /// How near the nearest is, if that is known.
    pub(crate) nearest: Option<N>,
    /// Points farther than this are left out.
    pub(crate) prediction: N,
}

/// In the plane triangles have no faces.
pub(crate) fn on_face2<N: Real>(
    _: &Pair<'_, N, 2>,
    _: &OnFace<N, 2>,
    _: &mut RawManifold<N, 2>,
) -> bool {
    false
}

/// Builds the contacts of a triangle and a box or hull along the triangle's normal, in place of those in
/// `out`; answers whether it did.
pub(crate) fn on_face3<N: Real>(
    pair: &Pair<'_, N, 3>,
    asked: &OnFace<N, 3>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let (first, second) = (pair.first, pair.second);
    let (triangle, solid): (_, &dyn ConvexPolyhedron<N, 3>) = match (first, second) {
        (Kind::Triangle(triangle), Kind::Cuboid(cuboid)) => (triangle, cuboid),
        (Kind::Triangle(triangle), Kind::Polytope(hull)) => (triangle, hull),
        _ => return false,
    };
    let (tolerance, normal) = (rounding(pair), asked.normal);
    let mut base = Outline::blank(tangents3(&normal));
    if !base.fill_with_triangle(triangle, &normal, tolerance) {
        return false;
    }
    let mut part = Feature::default();
    solid.core_feature(&pair.pose12.inverse_vector(&-normal), &mut part);
    for vertex in &mut part.vertices {
        *vertex = pair.pose12.point(vertex);
    }
    let lean = part.normal.map(|own| pair.pose12.vector(&own));
    let Some(lean) = lean else { return false };
    let mut top = Outline::blank(base.tangents);
    if !top.fill_with_part(&part, &base.points[0], tolerance) {
        return false;
    }
    let insides = &[base.insides_of(&top), top.insides_of(&base)];
    let (base, top, lowest) = (&base, &top, N::INFINITY);
    let mut meeting = Meeting { asked, base, top, insides, lean, tolerance, lowest };
    out.points.clear();
    out.normal = normal;
    meeting.corners(out);
    meeting.crossings(out);
    meeting.settle(out)
}

/// How far inside of the sides of one outline the corners of another are.
type Insides<N> = [[N; MOST]; MOST];

/// A convex polygon of the plane of contact.
struct Outline<N: Real> {
    count: usize,
    id: FeatureId,
    points: [Point<N, 3>; MOST],
    flats: [Vector<N, 2>; MOST],
    /// For each side its unit inward normal.
    inward: [Vector<N, 2>; MOST],
    ids: [FeatureId; MOST],
    sides: [FeatureId; MOST],
    tangents: [Vector<N, 3>; 2],
}

impl<N: Real> Outline<N> {
    fn blank(tangents: [Vector<N, 3>; 2]) -> Self {
        let (flats, point) = ([Vector::<N, 2>::zeros(); MOST], Point::<N, 3>::origin());
        let ids = [FeatureId::Face(0); MOST];
        let (id, points, inward, sides) = (ids[0], [point; MOST], flats, ids);
        Self { count: 0, id, points, flats, inward, ids, sides, tangents }
    }

    /// Seen from where the normal points; answers false of one that is thin or not perpendicular to it.
    fn fill_with_triangle(
        &mut self,
        triangle: &Triangle<N, 3>,
        normal: &Vector<N, 3>,
        tolerance: N,
    ) -> bool {
        let corners = triangle.corners();
        let ways = [corners[1] - corners[0], corners[2] - corners[0]];
        let [b, c] = ways.map(|way| self.flat(&way));
        let is_level = ways.iter().all(|way| way.dot(normal).abs() <= tolerance);
        let area = cross2(&b, &c);
        let longest = max(max(b.norm_squared(), c.norm_squared()), (c - b).norm_squared());
        // Written so that what is no number is not level.
        let is_plain = is_level
            && area.abs() > N::lit(LEAST_HEIGHT) * longest
            && longest > N::lit(4096.0) * tolerance * tolerance;
        if !is_plain {
            return false;
        }
        // The names of corners are their places; a side has that of the corner that it leaves.
        let ring: [(usize, u32, u32); 3] = if area > N::ZERO {
            [(0, 0, 0), (1, 1, 1), (2, 2, 2)]
        } else {
            self.id = FeatureId::Face(1);
            [(0, 0, 2), (2, 2, 1), (1, 1, 0)]
        };
        for (corner, id, side) in ring {
            let flat = [Vector::<N, 2>::zeros(), b, c][corner];
            self.push(corners[corner], flat, [FeatureId::Vertex(id), FeatureId::Edge(side)]);
        }
        self.fence(N::ONE);
        true
    }

    /// A face of the solid, seen from a point; answers false of what is no polygon there.
    fn fill_with_part(&mut self, part: &Feature<N, 3>, from: &Point<N, 3>, tolerance: N) -> bool {
        self.id = part.id;
        let count = part.vertices.len();
        if !(3..=MOST).contains(&count) || part.side_ids.len() != count {
            return false;
        }
        for (at, vertex) in part.vertices.iter().enumerate() {
            let flat = self.flat(&(vertex - from));
            self.push(*vertex, flat, [part.vertex_ids[at], part.side_ids[at]]);
        }
        let (mut area, mut shortest, mut longest) = (N::ZERO, N::INFINITY, N::ZERO);
        for at in 0..count {
            let squared = self.side(at).norm_squared();
            (shortest, longest) = (min(shortest, squared), max(longest, squared));
            area += cross2(&(self.flats[at] - self.flats[0]), &self.side(at));
        }
        let room = N::lit(64.0) * tolerance;
        let is_plain = shortest > room * room && area.abs() > room * longest.sqrt();
        self.fence(if area < N::ZERO { -N::ONE } else { N::ONE });
        is_plain
    }

    fn push(&mut self, point: Point<N, 3>, flat: Vector<N, 2>, [id, side]: [FeatureId; 2]) {
        let at = self.count;
        (self.points[at], self.flats[at], self.ids[at], self.sides[at]) = (point, flat, id, side);
        self.count += 1;
    }

    #[inline]
    fn flat(&self, arm: &Vector<N, 3>) -> Vector<N, 2> {
        Vector::<N, 2>::new(self.tangents[0].dot(arm), self.tangents[1].dot(arm))
    }

    #[inline]
    fn next(&self, at: usize) -> usize {
        if at + 1 < self.count { at + 1 } else { 0 }
    }

    #[inline]
    fn side(&self, at: usize) -> Vector<N, 2> {
        self.flats[self.next(at)] - self.flats[at]
    }

    /// Finds the inward normals of an outline that runs counter-clockwise, or with -1 clockwise.
    fn fence(&mut self, turn: N) {
        for at in 0..self.count {
            let side = self.side(at);
            self.inward[at] = Vector::<N, 2>::new(-side.y, side.x) * (turn / side.norm());
        }
    }

    /// How far inside of each side the corners of another outline are: a row for each corner.
    fn insides_of(&self, other: &Self) -> Insides<N> {
        let mut insides = [[N::ZERO; MOST]; MOST];
        for (row, place) in insides.iter_mut().zip(&other.flats[..other.count]) {
            let sides = self.inward.iter().zip(&self.flats).take(self.count);
            for (inside, (inward, flat)) in row.iter_mut().zip(sides) {
                *inside = inward.dot(&(place - flat));
            }
        }
        insides
    }

    /// The smallest part that contains a place; `None` outside.
    fn locate(&self, place: &Vector<N, 2>, insides: &[N; MOST], tolerance: N) -> Option<FeatureId> {
        let insides = &insides[..self.count];
        let least = insides.iter().fold(N::INFINITY, |least, &inside| min(inside, least));
        let is_inside = least >= -tolerance;
        if !is_inside {
            return None;
        }
        if least > tolerance {
            return Some(self.id);
        }
        let sides = insides.iter().enumerate().filter(|(_, inside)| **inside <= tolerance);
        let touched = sides.filter_map(|(side, _)| self.on_side(side, place, tolerance)).last();
        Some(touched.unwrap_or(self.id))
    }

    /// The part of a side that contains a place on its line: one of its corners or itself.
    fn on_side(&self, at: usize, place: &Vector<N, 2>, tolerance: N) -> Option<FeatureId> {
        let next = self.next(at);
        let near = |corner: usize| (self.flats[corner] - place).norm() <= N::TWO * tolerance;
        if near(at) || near(next) {
            return Some(if near(at) { self.ids[at] } else { self.ids[next] });
        }
        let side = self.side(at);
        let along = (place - self.flats[at]).dot(&side);
        (along >= N::ZERO && along <= side.norm_squared()).then_some(self.sides[at])
    }

    /// The point at a share of a side.
    fn along_side(&self, at: usize, share: N) -> Point<N, 3> {
        let (from, to) = (&self.points[at], &self.points[self.next(at)]);
        from + (to - from) * share
    }
}

/// The triangle and the face of the solid over it.
struct Meeting<'a, N: Real> {
    asked: &'a OnFace<N, 3>,
    base: &'a Outline<N>,
    top: &'a Outline<N>,
    /// Of the corners of the top in the base, and of those of the base in the top.
    insides: &'a [Insides<N>; 2],
    /// The outward normal of the solid's face.
    lean: Vector<N, 3>,
    tolerance: N,
    /// The least distance met.
    lowest: N,
}

impl<N: Real> Meeting<'_, N> {
    /// Corners of either outline within the other.
    fn corners(&mut self, out: &mut RawManifold<N, 3>) {
        let (normal, tolerance) = (self.asked.normal, self.tolerance);
        let slope = normal.dot(&self.lean);
        for at in 0..self.base.count {
            let (point, place) = (self.base.points[at], self.base.flats[at]);
            if let Some(on) = self.top.locate(&place, &self.insides[1][at], tolerance) {
                let height = (self.top.points[0] - point).dot(&self.lean) / slope;
                self.push(point, height, [self.base.ids[at], on], out);
            }
        }
        for at in 0..self.top.count {
            let (point, place) = (self.top.points[at], self.top.flats[at]);
            if let Some(on) = self.base.locate(&place, &self.insides[0][at], tolerance) {
                let height = (point - self.base.points[0]).dot(&normal);
                self.push(point - normal * height, height, [on, self.top.ids[at]], out);
            }
        }
    }

    /// Sides that cross well inside both.
    fn crossings(&mut self, out: &mut RawManifold<N, 3>) {
        for side1 in 0..self.base.count {
            let next1 = self.base.next(side1);
            let (from1, to1) = (self.insides[1][side1], self.insides[1][next1]);
            for side2 in 0..self.top.count {
                let ends1 = [from1[side2], to1[side2]];
                let ends2 = [side2, self.top.next(side2)].map(|at| self.insides[0][at][side1]);
                if self.are_apart(ends1) && self.are_apart(ends2) {
                    let share = |[from, to]: [N; 2]| from / (from - to);
                    let core1 = self.base.along_side(side1, share(ends1));
                    let core2 = self.top.along_side(side2, share(ends2));
                    let distance = self.asked.normal.dot(&(core2 - core1));
                    let names = [self.base.sides[side1], self.top.sides[side2]];
                    self.push(core1, distance, names, out);
                }
            }
        }
    }

    /// The ends of a side lie on different hands of a line, and neither on it.
    #[inline]
    fn are_apart(&self, [from, to]: [N; 2]) -> bool {
        let tolerance = self.tolerance;
        from > tolerance && to < -tolerance || from < -tolerance && to > tolerance
    }

    /// Adds a point that is asked for, once for each pair of names.
    fn push(
        &mut self,
        point1: Point<N, 3>,
        distance: N,
        [feature1, feature2]: [FeatureId; 2],
        out: &mut RawManifold<N, 3>,
    ) {
        let distance = self.asked.nearest.map_or(distance, |nearest| max(distance, nearest));
        let is_near = distance <= self.asked.prediction + self.tolerance
            && distance >= self.asked.least - self.tolerance;
        let is_old = |old: &RawPoint<N, 3>| (old.feature1, old.feature2) == (feature1, feature2);
        if !is_near || out.points.iter().any(is_old) {
            return;
        }
        let distance = min(distance, self.asked.prediction);
        self.lowest = min(distance, self.lowest);
        let id = out.ids.next();
        out.points.push(RawPoint { point1, distance, feature1, feature2, id, code: 0 });
    }

    /// The nearest has the distance that is known, if one is; answers false where none is so near.
    fn settle(&self, out: &mut RawManifold<N, 3>) -> bool {
        let Some(nearest) = self.asked.nearest else { return true };
        let is_found = self.lowest <= nearest + self.tolerance;
        if let Some(point) = out.points.iter_mut().find(|point| point.distance == self.lowest) {
            point.distance = nearest;
        }
        if !is_found {
            out.points.clear();
        }
        is_found
    }
}
