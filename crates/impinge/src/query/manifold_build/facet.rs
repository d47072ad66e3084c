//! One solid's share of a contact: the part of its core that faces the other, seen along the normal.

use smallvec::SmallVec;

use super::frame::Frame;
use crate::math::{Point, Pose, Real, Vector, cross2, max, max_component, min};
use crate::shape::{Feature, FeatureId, SupportMap};

/// Parts that lean more than 60° out of the plane of contact count as their nearest point.
pub(super) const LEAST_COSINE: f64 = 0.5;

/// How many sides are looked at side by side.
pub(super) const LANES: usize = 8;

/// The lines of up to eight sides: a corner on each, and its inward normal.
pub(super) struct Lines<N: Real> {
    pub(super) from: [[N; LANES]; 2],
    pub(super) inward: [[N; LANES]; 2],
}

/// Which of the two solids of a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Which {
    First,
    Second,
}

impl Which {
    /// How far a point is below the supporting plane of the whole solid, seen from the other one.
    #[inline]
    pub(super) fn below_witness<N: Real, const D: usize>(
        self,
        point: &Point<N, D>,
        frame: &Frame<N, D>,
    ) -> N {
        let height = frame.height(point);
        match self {
            Self::First => -height,
            Self::Second => height - frame.witness.distance,
        }
    }
}

/// How far the surface of a core that is swollen by a radius, and whose flat part has a cosine to the
/// normal, is above a point of the core: `room` below the supporting plane, with the core's end nearest
/// to the other solid, `top` below it, `away` from there to the point across the normal.
#[inline]
pub(super) fn lifted<N: Real>(
    (radius, cosine): (N, N),
    (room, top): (N, N),
    away: &Vector<N, 2>,
) -> N {
    lifted_by((radius, cosine), (room, top), away.norm_squared())
}

/// [`lifted`], where the square of the way across the normal is known.
#[inline]
pub(super) fn lifted_by<N: Real>(
    (radius, cosine): (N, N),
    (room, top): (N, N),
    away_squared: N,
) -> N {
    let turns_squared = radius * radius * (N::ONE - cosine * cosine);
    let lift = if away_squared < turns_squared {
        room - top + (radius * radius - away_squared).sqrt()
    } else {
        radius / cosine
    };
    max(min(lift, room), N::ZERO)
}

/// A corner and the side that leads from it to the next.
#[derive(Clone, Copy)]
pub(super) struct Corner<N: Real, const D: usize> {
    pub(super) point: Point<N, D>,
    pub(super) flat: Vector<N, 2>,
    pub(super) id: FeatureId,
    pub(super) side: FeatureId,
}

/// A point, a segment or a convex polygon, in the frame of the first solid.
///
/// Corners that coincide when seen along the normal are merged, polygons without width are segments.
pub(super) struct Facet<N: Real, const D: usize> {
    which: Which,
    pub(super) id: FeatureId,
    pub(super) corners: SmallVec<[Corner<N, D>; 8]>,
    /// For each side its unit inward normal, seen along the manifold's normal.
    inward: SmallVec<[Vector<N, 2>; 8]>,
    /// The outward normal of a polygon in space.
    normal: Option<Vector<N, D>>,
    rounding: N,
    /// Between the manifold's normal and the facet's own.
    cosine: N,
    /// Of a rounded solid the corner nearest to the other: how far it is below the supporting plane
    /// and where it is seen.
    top: (N, Vector<N, 2>),
}

impl<N: Real, const D: usize> Facet<N, D> {
    /// The facet of a half-space, which has no corners.
    #[inline]
    pub(super) fn boundary(which: Which) -> Self {
        Self {
            which,
            id: FeatureId::Face(0),
            corners: SmallVec::new(),
            inward: SmallVec::new(),
            normal: None,
            rounding: N::ZERO,
            cosine: N::ONE,
            top: (N::ZERO, Vector::<N, 2>::zeros()),
        }
    }

    /// Makes it the facet of a solid that is placed at `pose` in the frame of the first; `None` for
    /// the first itself.
    pub(super) fn face(
        &mut self,
        map: &dyn SupportMap<N, D>,
        pose: Option<&Pose<N, D>>,
        frame: &Frame<N, D>,
    ) {
        let outward = self.which.outward(frame);
        let mut feature = Feature::default();
        match pose {
            None => map.core_feature(&outward, &mut feature),
            Some(pose) => map.core_feature(&pose.inverse_vector(&outward), &mut feature),
        }
        self.rounding = map.rounding();
        self.take(&feature, pose, frame);
        if self.rounding > N::ZERO {
            self.find_top(frame);
        }
    }

    fn take(&mut self, feature: &Feature<N, D>, pose: Option<&Pose<N, D>>, frame: &Frame<N, D>) {
        self.id = feature.id;
        self.normal = feature.normal.map(|normal| pose.map_or(normal, |pose| pose.vector(&normal)));
        self.take_corners(feature, pose, frame);
        self.settle(&self.which.outward(frame), frame.tolerance);
    }

    /// Takes the corners of a feature to the frame of the first solid. Where a feature names fewer
    /// sides than it has corners, as segments do, the rest bear its own name.
    fn take_corners(
        &mut self,
        feature: &Feature<N, D>,
        pose: Option<&Pose<N, D>>,
        frame: &Frame<N, D>,
    ) {
        let (vertices, ids) = (feature.vertices.as_slice(), feature.vertex_ids.as_slice());
        let sides = feature.side_ids.as_slice();
        for (index, (vertex, &id)) in vertices.iter().zip(ids).enumerate() {
            let point = pose.map_or(*vertex, |pose| pose.point(vertex));
            let side = sides.get(index).copied().unwrap_or(feature.id);
            self.corners.push(Corner { point, flat: frame.flat(&point), id, side });
        }
    }

    /// Finds the corner that is nearest to the other solid, the first of equals.
    fn find_top(&mut self, frame: &Frame<N, D>) {
        let placed =
            |corner: &Corner<N, D>| (self.which.below_witness(&corner.point, frame), corner.flat);
        let nearer = |top: (N, _), corner: (N, _)| if corner.0 < top.0 { corner } else { top };
        self.top = self.corners.iter().map(placed).reduce(nearer).unwrap_or(self.top);
    }

    /// Simplifies what has no extent when seen along the normal, and prepares the sides.
    fn settle(&mut self, outward: &Vector<N, D>, tolerance: N) {
        merge_coincident(&mut self.corners, tolerance);
        if self.corners.len() > 2 {
            self.settle_polygon(outward, tolerance);
        }
        if self.corners.len() == 2 {
            self.settle_segment(outward);
        }
        if self.corners.len() == 1 {
            self.cosine = N::ONE;
        }
    }

    /// A polygon of no area is a segment, one that leans too much its nearest corner. Else its sides
    /// get inward normals, by the sign of the area: the outline of the second solid runs clockwise
    /// when seen along the normal.
    fn settle_polygon(&mut self, outward: &Vector<N, D>, tolerance: N) {
        let (area, longest) = self.area_and_longest_side();
        let length = self.side(longest).norm();
        if area.abs() <= N::TWO * tolerance * length {
            return self.flatten(longest);
        }
        self.cosine = self.normal.map_or(N::ZERO, |normal| normal.dot(outward));
        if self.cosine < N::lit(LEAST_COSINE) {
            return self.keep_farthest(outward);
        }
        let turn = if area < N::ZERO { -N::ONE } else { N::ONE };
        let inward = &mut self.inward;
        each_side(&self.corners, |_, from, to| {
            let side = to.flat - from.flat;
            inward.push(Vector::<N, 2>::new(-side.y, side.x) * (turn / side.norm()));
        });
    }

    /// A segment that leans too much is its nearest end. The cosine is that of the angle between the
    /// segment and the plane of contact. In the plane this is every side of a polygon: it has an
    /// outward normal of its own, but its two ends say as much.
    fn settle_segment(&mut self, outward: &Vector<N, D>) {
        self.normal = None;
        let flat = self.side(0);
        let length = (self.corners[1].point - self.corners[0].point).norm();
        self.cosine = flat.norm() / length;
        if self.cosine < N::lit(LEAST_COSINE) {
            return self.keep_farthest(outward);
        }
        let inward = Vector::<N, 2>::new(-flat.y, flat.x) / flat.norm();
        self.inward.clear();
        self.inward.push(inward);
    }

    /// Leaves the two ends of a polygon without width, named as its longest side.
    fn flatten(&mut self, longest: usize) {
        let (along, from) = (self.side(longest), self.corners[longest].flat);
        let at = |corner: &Corner<N, D>| (corner.flat - from).dot(&along);
        let (mut low, mut high) = (self.corners[0], self.corners[0]);
        for corner in &self.corners[1..] {
            low = if at(corner) < at(&low) { *corner } else { low };
            high = if at(corner) > at(&high) { *corner } else { high };
        }
        self.id = self.corners[longest].side;
        self.corners = SmallVec::from_slice(&[low, high]);
    }

    /// Leaves the corner nearest to the other solid.
    fn keep_farthest(&mut self, outward: &Vector<N, D>) {
        let at = |corner: &Corner<N, D>| corner.point.coords.dot(outward);
        let first = self.corners[0];
        let farthest =
            self.corners.iter().fold(first, |best, c| if at(c) > at(&best) { *c } else { best });
        self.id = farthest.id;
        self.corners = SmallVec::from_slice(&[farthest]);
        self.inward.clear();
        self.normal = None;
    }

    /// Twice the signed area seen along the normal, and the index of the longest side.
    fn area_and_longest_side(&self) -> (N, usize) {
        let (mut area, mut longest, mut most) = (N::ZERO, 0, N::ZERO);
        let origin = self.corners[0].flat;
        each_side(&self.corners, |index, from, to| {
            let (arm, side) = (from.flat - origin, to.flat - from.flat);
            area += cross2(&arm, &side);
            let squared = side.norm_squared();
            if squared > most {
                (longest, most) = (index, squared);
            }
        });
        (area, longest)
    }

    /// A point without any extent across the normal.
    #[inline]
    pub(super) fn is_point(&self) -> bool {
        self.corners.len() < 2
    }

    /// Two corners: one side, which is looked at from both hands.
    #[inline]
    pub(super) fn is_segment(&self) -> bool {
        self.corners.len() == 2
    }

    /// None for a point, one for a segment, else one for each corner.
    #[inline]
    pub(super) fn side_count(&self) -> usize {
        self.inward.len()
    }

    /// The index of the corner after a corner.
    #[inline]
    pub(super) fn next(&self, index: usize) -> usize {
        if index + 1 < self.corners.len() { index + 1 } else { 0 }
    }

    /// From a corner to the next, seen along the normal.
    #[inline]
    pub(super) fn side(&self, index: usize) -> Vector<N, 2> {
        self.corners[self.next(index)].flat - self.corners[index].flat
    }

    /// How far inside the line of each side a place is; negative outside.
    #[inline]
    pub(super) fn measure_inside(&self, flat: &Vector<N, 2>, insides: &mut [N]) {
        for ((inside, inward), from) in insides.iter_mut().zip(&self.inward).zip(&self.corners) {
            *inside = inward.dot(&(flat - from.flat));
        }
    }

    /// The smallest part of the facet that contains a place: a corner, a side, the whole.
    ///
    /// `None` if the place is outside by more than the tolerance.
    pub(super) fn locate(&self, flat: &Vector<N, 2>, tolerance: N) -> Option<FeatureId> {
        let mut insides: SmallVec<[N; 8]> = SmallVec::from_elem(N::ZERO, self.side_count());
        self.measure_inside(flat, &mut insides);
        self.locate_inside(&insides, flat, tolerance)
    }

    /// [`Self::locate`] where it is known how far inside of each side the place is.
    #[inline]
    pub(super) fn locate_inside(
        &self,
        insides: &[N],
        flat: &Vector<N, 2>,
        tolerance: N,
    ) -> Option<FeatureId> {
        let highest = if self.is_segment() { tolerance } else { N::INFINITY };
        if insides.iter().any(|&inside| inside < -tolerance || inside > highest) {
            return None;
        }
        let mut touched = None;
        for (side, &inside) in insides.iter().enumerate() {
            // Of two touched sides either will do: where they meet, both answer with the corner.
            if inside <= tolerance {
                touched = self.on_side(side, flat, tolerance).or(touched);
            }
        }
        if self.is_segment() { touched } else { Some(touched.unwrap_or(self.id)) }
    }

    /// [`Self::locate`] of a place inside, but for the tolerance, that is on the lines of some sides,
    /// given as bits.
    #[inline]
    pub(super) fn locate_on_sides(
        &self,
        mut on_lines: u8,
        flat: &Vector<N, 2>,
        tolerance: N,
    ) -> Option<FeatureId> {
        let mut touched = None;
        while on_lines != 0 {
            let side = on_lines.trailing_zeros() as usize;
            touched = self.on_side(side, flat, tolerance).or(touched);
            on_lines &= on_lines - 1;
        }
        if self.is_segment() { touched } else { Some(touched.unwrap_or(self.id)) }
    }

    /// The sides, one after the other in lanes; the last one fills the rest.
    #[inline]
    pub(super) fn lines(&self) -> Lines<N> {
        let zero = [N::ZERO; LANES];
        let mut lines = Lines { from: [zero; 2], inward: [zero; 2] };
        let (inward, corners) = (self.inward.as_slice(), self.corners.as_slice());
        let last = inward.len() - 1;
        for lane in 0..LANES {
            let side = if lane < last { lane } else { last };
            let (from, inward) = (&corners[side].flat, &inward[side]);
            (lines.from[0][lane], lines.from[1][lane]) = (from.x, from.y);
            (lines.inward[0][lane], lines.inward[1][lane]) = (inward.x, inward.y);
        }
        lines
    }

    /// The part of a side that contains a place on its line: one of its corners or itself.
    fn on_side(&self, side: usize, flat: &Vector<N, 2>, tolerance: N) -> Option<FeatureId> {
        let (from, to) = (&self.corners[side], &self.corners[self.next(side)]);
        let near = |corner: &Corner<N, D>| (corner.flat - flat).norm() <= N::TWO * tolerance;
        if near(from) || near(to) {
            return Some(if near(from) { from.id } else { to.id });
        }
        let (along, length) = ((flat - from.flat).dot(&self.side(side)), self.side(side).norm());
        let within = along >= N::ZERO && along <= length * length;
        within.then_some(if self.is_segment() { self.id } else { from.side })
    }

    /// The point of the core that is seen at the same place as `point`.
    #[inline]
    pub(super) fn under(&self, point: &Point<N, D>, frame: &Frame<N, D>) -> Point<N, D> {
        let Some(normal) = self.normal else {
            return self.along_side(0, self.parameter(&frame.flat(point)));
        };
        let along = (self.corners[0].point - point).dot(&normal) / frame.normal().dot(&normal);
        point + frame.normal() * along
    }

    /// Where on the first side a place is: 0 at its start, 1 at its end, never beyond.
    fn parameter(&self, flat: &Vector<N, 2>) -> N {
        let side = self.side(0);
        let along = (flat - self.corners[0].flat).dot(&side) / side.norm_squared();
        min(max(along, N::ZERO), N::ONE)
    }

    /// The point of a side at a parameter between 0 and 1.
    #[inline]
    pub(super) fn along_side(&self, side: usize, parameter: N) -> Point<N, D> {
        let (from, to) = (&self.corners[side].point, &self.corners[self.next(side)].point);
        from + (to - from) * parameter
    }

    /// How far the rounded surface is above a point of the core, along the manifold's normal.
    ///
    /// Above the flat part that is `rounding / cosine`; above the end nearest to the other solid the
    /// ball around that end. Nothing rises above the witness. Exact for capsules, and wherever the
    /// surface is parallel to the facet; between the two a rounded polygon may lie a little lower.
    #[inline]
    pub(super) fn lift(&self, core: &Point<N, D>, frame: &Frame<N, D>) -> N {
        if self.rounding <= N::ZERO {
            return N::ZERO;
        }
        let room = self.which.below_witness(core, frame);
        let (radius, away) = (self.rounding, frame.flat(core) - self.top.1);
        lifted((radius, self.cosine), (room, self.top.0), &away)
    }
}

impl Which {
    /// The direction in which this solid faces the other.
    #[inline(always)]
    pub(super) fn outward<N: Real, const D: usize>(self, frame: &Frame<N, D>) -> Vector<N, D> {
        match self {
            Self::First => frame.normal(),
            Self::Second => -frame.normal(),
        }
    }
}

/// Visits each corner, by its number, and the one after it.
#[inline(always)]
fn each_side<N: Real, const D: usize>(
    corners: &[Corner<N, D>],
    mut visit: impl FnMut(usize, &Corner<N, D>, &Corner<N, D>),
) {
    let (Some(last), Some(first)) = (corners.last(), corners.first()) else { return };
    for (index, pair) in corners.windows(2).enumerate() {
        visit(index, &pair[0], &pair[1]);
    }
    visit(corners.len() - 1, last, first);
}

/// Merges each corner with those that follow it at the same place; the last one's side leads on.
fn merge_coincident<N: Real, const D: usize>(
    corners: &mut SmallVec<[Corner<N, D>; 8]>,
    tolerance: N,
) {
    let apart = |a: &Corner<N, D>, b: &Corner<N, D>| max_component(&(a.flat - b.flat)) > tolerance;
    let mut are_apart = true;
    each_side(corners, |_, a, b| are_apart &= apart(a, b));
    if are_apart {
        return;
    }
    let mut kept = 0;
    for index in 1..corners.len() {
        if apart(&corners[kept], &corners[index]) {
            kept += 1;
            corners[kept] = corners[index];
        } else {
            corners[kept].side = corners[index].side;
        }
    }
    while kept > 0 && !apart(&corners[0], &corners[kept]) {
        kept -= 1;
    }
    corners.truncate(kept + 1);
}
