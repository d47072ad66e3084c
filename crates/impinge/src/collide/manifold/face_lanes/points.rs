//! Computes the contact points of one triangle from the measured distances.

use super::ClipRequest;
use super::measure::FaceClip;
use crate::collide::{RawPoint, RawPoints};
use crate::math::{Point, Real, Vector, max, min};
use crate::shape::FeatureId;

impl<N: Real> FaceClip<N> {
    /// Appends the points of one triangle; returns their smallest distance, infinite without
    /// points. `None`, with nothing appended, if the lane is undecided.
    pub(super) fn points_of(
        &self,
        lane: usize,
        request: &ClipRequest<N>,
        prediction: N,
        points: &mut RawPoints<N, 3>,
    ) -> Option<N> {
        let has_extent = self.with_extent >> lane & 1 == 1;
        // If neither outline has an area, edges may be parallel and corners may coincide.
        let has_area = self.ring.count > 2 || self.supporting.face >> lane & 1 == 1;
        if !(has_extent && has_area) {
            return None;
        }
        let (tolerance, first) = (self.tolerance[lane], points.len());
        let mut found = FoundPoints { request, prediction, tolerance, points, first };
        let one = LaneClip { clip: self, lane, normal: &request.normal };
        let is_clear = one.corners(&mut found).and_then(|()| one.vertices(&mut found)).is_some();
        if is_clear {
            one.crossings(&mut found);
        }
        let lowest = found.lowest().filter(|_| is_clear);
        if lowest.is_none() {
            points.truncate(first);
        }
        lowest
    }
}

/// Points of one triangle found so far.
struct FoundPoints<'a, N: Real> {
    request: &'a ClipRequest<N>,
    /// Largest distance of a contact point; points that are farther by more than the tolerance are
    /// dropped.
    prediction: N,
    tolerance: N,
    points: &'a mut RawPoints<N, 3>,
    /// Index of the triangle's first point in `points`.
    first: usize,
}

impl<N: Real> FoundPoints<'_, N> {
    /// Returns the smallest distance; infinite without points. If the request has a distance
    /// `nearest`, the deepest point gets that distance, and the result is `None` if there is no
    /// point or if none is that near, up to the tolerance.
    fn lowest(&mut self) -> Option<N> {
        let new = &mut self.points[self.first..];
        let lowest = new.iter().fold(N::INFINITY, |lowest, point| min(point.distance, lowest));
        let Some(nearest) = self.request.nearest else { return Some(lowest) };
        // The comparison is false for NaN.
        let is_reached = lowest <= nearest + self.tolerance;
        let deepest = new.iter_mut().find(|point| point.distance == lowest)?;
        deepest.distance = nearest;
        is_reached.then_some(nearest)
    }

    /// Adds the point `point` of the triangle, at the signed `distance` from the solid's feature
    /// along the normal, unless it is beyond the prediction or below `least` by more than the
    /// tolerance, or already added. Clamps the stored distance to these bounds and to `nearest`, if
    /// known.
    fn push(&mut self, point: &Vector<N, 3>, distance: N, [feature1, feature2]: [FeatureId; 2]) {
        let ClipRequest { normal, nearest, least, .. } = self.request;
        let mut distance = max(distance, nearest.unwrap_or(distance));
        // The comparison is false for NaN.
        let is_near = distance <= self.prediction + self.tolerance;
        if !is_near || distance < *least - self.tolerance {
            return;
        }
        distance = max(min(distance, self.prediction), *least);
        let point1 = Point::from(point + normal * distance);
        // Corners that coincide are found from both outlines.
        let near = N::lit(4.0) * self.tolerance;
        let is_same = |old: &RawPoint<N, 3>| {
            let moved = old.point1 - point1;
            [old.feature1, old.feature2] == [feature1, feature2]
                && (moved - normal * normal.dot(&moved)).norm() <= near
        };
        if self.points[self.first..].iter().any(is_same) {
            return;
        }
        self.points.push(RawPoint { point1, distance, feature1, feature2, id: 0, code: 0 });
    }
}

/// The triangle in one lane of a clip.
struct LaneClip<'a, N: Real> {
    clip: &'a FaceClip<N>,
    lane: usize,
    normal: &'a Vector<N, 3>,
}

impl<N: Real> LaneClip<'_, N> {
    /// Returns whether a mask has the bit of this lane.
    fn has(&self, bits: u8) -> bool {
        bits >> self.lane & 1 == 1
    }

    /// Returns a corner of the triangle, in the frame of the solid.
    fn corner(&self, corner: usize) -> Vector<N, 3> {
        let [x, y, z] = &self.clip.corners[corner];
        Vector::<N, 3>::new(x[self.lane], y[self.lane], z[self.lane])
    }

    /// If the solid's supporting feature is a face, adds the corners of the triangle's supporting
    /// feature that lie within it. `None` if the solid's feature is an edge and a corner of the
    /// triangle is on the edge's line.
    fn corners(&self, found: &mut FoundPoints<'_, N>) -> Option<()> {
        let FaceClip { ring, in_face, supporting, depths, .. } = self.clip;
        if ring.count < 3 {
            let is_on = (0..3).any(|corner| self.has(in_face.is_on[corner]));
            return (ring.count < 2 || !is_on).then_some(());
        }
        for corner in 0..3 {
            if !self.has(supporting.corners[corner] & !in_face.is_beyond[corner]) {
                continue;
            }
            let (at, id) = (self.corner(corner), FeatureId::Vertex([0, 1, 2][corner]));
            let features = [self.part_of_face(corner, &at).unwrap_or(ring.id), id];
            found.push(&at, depths[corner][self.lane], features);
        }
        Some(())
    }

    /// If the triangle's supporting feature is its face, adds the corners of the ring that lie
    /// within the triangle. Otherwise adds none, and returns `None` if a corner of the ring is on
    /// the line of a supporting side.
    fn vertices(&self, found: &mut FoundPoints<'_, N>) -> Option<()> {
        let FaceClip { ring, in_triangle, supporting, vertex_depths, .. } = self.clip;
        let face = FeatureId::Face(u32::from(self.has(supporting.back)));
        for (vertex, depths) in vertex_depths.iter().enumerate().take(ring.count) {
            if !self.has(supporting.face) {
                let is_on = |side| self.has(in_triangle.on(vertex, side) & supporting.sides[side]);
                if (0..3).any(is_on) {
                    return None;
                }
            } else if !self.has(in_triangle.is_beyond[vertex]) {
                let (at, distance) = (self.clip.vertex(vertex), depths[self.lane]);
                let part = self.part_of_triangle(vertex, &at).unwrap_or(face);
                found.push(&(at - self.normal * distance), distance, [ring.ids[vertex], part]);
            }
        }
        Some(())
    }

    /// Returns the side or corner of the triangle that a corner of the ring projects to; `None` if
    /// it projects to the inside.
    fn part_of_triangle(&self, vertex: usize, at: &Vector<N, 3>) -> Option<FeatureId> {
        let in_triangle = &self.clip.in_triangle;
        if !self.has(in_triangle.is_on[vertex]) {
            return None;
        }
        let with_ids = |corner: usize| {
            let number = [0, 1, 2][corner];
            (self.corner(corner), FeatureId::Vertex(number), FeatureId::Edge(number))
        };
        let sides = (0..3).filter(|side| self.has(in_triangle.on(vertex, *side)));
        self.part_with(at, sides, |side| [with_ids(side), with_ids((side + 1) % 3)])
    }

    /// Returns the side or corner of the solid's face that a corner of the triangle projects to;
    /// `None` if it projects to the inside.
    fn part_of_face(&self, corner: usize, at: &Vector<N, 3>) -> Option<FeatureId> {
        let FaceClip { ring, in_face, .. } = self.clip;
        if !self.has(in_face.is_on[corner]) {
            return None;
        }
        let with_ids = |side: usize| (self.clip.vertex(side), ring.ids[side], ring.sides[side]);
        let sides = (0..ring.count).filter(|side| self.has(in_face.on(corner, *side)));
        self.part_with(at, sides, |side| [with_ids(side), with_ids((side + 1) % ring.count)])
    }

    /// Adds the crossings of sides of the triangle and sides of the ring. Two sides cross only if
    /// the ends of each are farther than the tolerance from the line of the other, on different
    /// sides of that line.
    fn crossings(&self, found: &mut FoundPoints<'_, N>) {
        let FaceClip { ring, in_face, in_triangle, crossed, .. } = self.clip;
        for side in 0..3 {
            let ends = [side, (side + 1) % 3];
            for other in (0..self.clip.sides()).filter(|other| self.has(crossed[side][*other])) {
                let others = [other, (other + 1) % ring.count];
                let (share, start) = (in_face.share(ends, other, self.lane), self.corner(side));
                let point = start + (self.corner(ends[1]) - start) * share;
                let (share, start) =
                    (in_triangle.share(others, side, self.lane), self.clip.vertex(other));
                let facing = start + (self.clip.vertex(others[1]) - start) * share;
                let distance = self.normal.dot(&(facing - point));
                let id = FeatureId::Edge([0, 1, 2][side]);
                found.push(&point, distance, [ring.sides[other], id]);
            }
        }
    }

    /// Returns the side or corner of an outline that the point `at`, on the lines of `sides`,
    /// projects to. If several of `sides` contain the projected point, the last one decides; `None`
    /// if none does. `ends` returns the two corners of a side, each with its id and the id of the
    /// side that begins there.
    fn part_with(
        &self,
        at: &Vector<N, 3>,
        sides: impl Iterator<Item = usize>,
        ends: impl Fn(usize) -> [(Vector<N, 3>, FeatureId, FeatureId); 2],
    ) -> Option<FeatureId> {
        let tolerance = N::TWO * self.clip.tolerance[self.lane];
        // Projects along the normal.
        let flat = |v: Vector<N, 3>| v - self.normal * self.normal.dot(&v);
        let mut part = None;
        for side in sides {
            let [(from, from_id, side_id), (to, to_id, _)] = ends(side);
            let (edge, arm) = (flat(to - from), flat(at - from));
            let share = arm.dot(&edge);
            if arm.norm() <= tolerance {
                part = Some(from_id);
            } else if flat(at - to).norm() <= tolerance {
                part = Some(to_id);
            } else if share >= N::ZERO && share <= edge.norm_squared() {
                part = Some(side_id);
            }
        }
        part
    }
}
