//! Two boxes in space, face to face, edge on face, corner on face or edge across edge, in one go.
//!
//! What the separating axis test found, the general builder would find again through supports and
//! features. Here the face that faces the other box is a rectangle along two axes of its own box, and
//! the most aligned face of the other box, seen along the manifold's normal, a parallelogram above
//! it: the corners of their common area come out of fixed loops. Of a face that leans too far only the
//! edge or the corner counts that comes nearest ([`Shown`]): the same loops pass over the rest. The
//! normal is that of the rectangle, or leans where an edge of each box decides. Names and numbers are
//! those of the general builder, which is the definition of this one, and which takes over wherever
//! this one declines: flat boxes, angular prediction, nearest points off what is shown.

use super::frame::{Candidate, ROUNDING_ERRORS};
use super::overlap::Candidates;
use super::shown::Shown;
use super::{ManifoldRequest, Pair, RawManifold, choose_admitted};
use crate::math::{Point, Pose, Real, Vector, cross2, min};
use crate::query::separation::cuboid_axes::{AxisKind, BoxAxis, Boxes};
use crate::shape::{FeatureId, Kind};

/// Builds the manifold of two boxes; answers whether it did.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (&pair.first, &pair.second) else {
        return false;
    };
    let (half1, half2) = (*cuboid1.half_extents(), *cuboid2.half_extents());
    let boxes = Boxes { half1, half2, pose12: pair.pose12 };
    let axis = boxes.best_axis();
    if axis.gap > request.prediction + N::lit(16.0) * boxes.noise() {
        out.points.clear();
        return true;
    }
    let is_ordinary = axis.gap <= request.prediction && request.sine <= N::ZERO;
    let faces = if is_ordinary { Faces::meeting(&boxes, &axis) } else { None };
    faces.is_some_and(|faces| faces.build(&axis, request, out))
}

/// A face of one box, and the face of the other above it, in the frame of the first of these.
struct Faces<'a, N: Real> {
    boxes: &'a Boxes<N>,
    /// The rectangle belongs to the second box of the pair.
    is_second: bool,
    /// It does, and the normal is not its own.
    is_leaning: bool,
    rectangle: Rectangle<N>,
    above: Parallelogram<N>,
    /// Lengths below this are rounding errors, as for the general builder.
    tolerance: N,
}

/// A face of a box: at `half` on the axis `w`, on the side of `sign`, between `±across`.
struct Rectangle<N: Real> {
    axes: [usize; 3],
    sign: N,
    /// The manifold's normal away from this box, in its frame, by the same axes.
    toward: [N; 3],
    half: N,
    across: [N; 2],
    shown: Shown,
}

/// The face of the other box, seen along the axis of the rectangle.
struct Parallelogram<N: Real> {
    /// Its normal's axis in its own box, and the two axes along its sides.
    axes: [usize; 3],
    /// Its normal is on the positive side.
    is_positive: bool,
    shown: Shown,
    center: Vector<N, 2>,
    /// Half of its sides.
    arms: [Vector<N, 2>; 2],
    /// The height of the centre above the rectangle, and what the arms add to it.
    height: N,
    climbs: [N; 2],
    /// Twice the signed area of the arms' triangle.
    area: N,
    /// For each arm, the distance of the sides at its ends from the centre.
    widths: [N; 2],
}

impl<'a, N: Real> Faces<'a, N> {
    /// The two faces, unless one is too narrow.
    fn meeting(boxes: &'a Boxes<N>, axis: &BoxAxis<N>) -> Option<Self> {
        let (rectangle, is_second) = Rectangle::facing(boxes, axis);
        let (other, pose) = if is_second {
            (boxes.half1, boxes.pose12.inverse())
        } else {
            (boxes.half2, boxes.pose12)
        };
        let size = boxes.half1.norm() + boxes.half2.norm() + boxes.pose12.translation.norm();
        let tolerance = N::lit(ROUNDING_ERRORS) * N::EPSILON * size;
        let above = Parallelogram::facing(&rectangle, &other, &pose);
        let is_wide = min(rectangle.across[0], rectangle.across[1]) > N::lit(4.0) * tolerance
            && min(above.widths[0], above.widths[1]) > N::lit(4.0) * tolerance;
        let is_leaning = is_second && matches!(axis.kind, AxisKind::Edges(..));
        is_wide.then_some(Self { boxes, is_second, is_leaning, rectangle, above, tolerance })
    }

    fn build(
        &self,
        axis: &BoxAxis<N>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 3>,
    ) -> bool {
        let mut candidates = Candidates::new();
        self.corners_above(&mut candidates);
        self.corners_below(&mut candidates);
        self.crossings(&mut candidates);
        let limits = (request.prediction, request.max_points);
        let is_built = choose_admitted(candidates, (axis.gap, self.tolerance), limits, out);
        if is_built {
            out.normal = axis.normal;
        }
        is_built
    }

    /// Corners of the parallelogram above the rectangle; edges that cross have none.
    fn corners_above(&self, out: &mut Candidates<N, 3>) {
        if !self.rectangle.shown.is_whole() {
            return;
        }
        for signs in CORNERS {
            if !self.above.shown.has_corner(signs) {
                continue;
            }
            let (place, height) = self.above.corner(signs);
            if let Some(below) = self.rectangle.locate(&place, self.tolerance) {
                self.push(place, height, [below, self.above.vertex(signs)], out);
            }
        }
    }

    /// Corners of the rectangle below what the parallelogram shows.
    fn corners_below(&self, out: &mut Candidates<N, 3>) {
        if !self.rectangle.shown.is_whole() || self.above.shown.is_corner() {
            return;
        }
        for signs in CORNERS {
            let place = self.rectangle.corner(signs);
            if let Some((above, height)) = self.above.locate(&place, self.tolerance) {
                self.push(place, height, [self.rectangle.vertex(signs), above], out);
            }
        }
    }

    /// Crossings of a side of each.
    fn crossings(&self, out: &mut Candidates<N, 3>) {
        for (arm, sign) in SIDES {
            if !self.above.shown.has_side(arm, sign) {
                continue;
            }
            let (from, low) = self.above.corner(ends(arm, sign, false));
            let (to, high) = self.above.corner(ends(arm, sign, true));
            for (side, far) in SIDES {
                let crossed = self.rectangle.crossed(&from, &to, (side, far), self.tolerance);
                let Some(along) = crossed.filter(|_| self.rectangle.shown.has_side(side, far))
                else {
                    continue;
                };
                let place = from + (to - from) * along;
                let features = [self.rectangle.side(side, far), self.above.side(arm, sign)];
                self.push(place, low + (high - low) * along, features, out);
            }
        }
    }

    /// Adds a place of the common area, once for each pair of names.
    fn push(
        &self,
        flat: Vector<N, 2>,
        height: N,
        [below, above]: [FeatureId; 2],
        out: &mut Candidates<N, 3>,
    ) {
        let features = if self.is_second { [above, below] } else { [below, above] };
        if out.iter().any(|old| old.features == features) {
            return;
        }
        let [u, v, w] = self.rectangle.axes;
        let mut point = Point::<N, 3>::origin();
        (point[u], point[v]) = (flat.x, flat.y);
        // The first box is above where the rectangle is the second's.
        if self.is_leaning {
            let [x, y, z] = self.rectangle.toward;
            let ground = self.rectangle.sign * self.rectangle.half;
            (point[u], point[v]) = (flat.x + x * height, flat.y + y * height);
            point[w] = ground + z * height;
        } else {
            let rise = if self.is_second { height } else { N::ZERO };
            point[w] = self.rectangle.sign * (self.rectangle.half + rise);
        }
        let point1 = if self.is_second { self.boxes.pose12.point(&point) } else { point };
        out.push(Candidate { point1, distance: height, flat, features, kept_id: None });
    }
}

/// The corners of a rectangle: whether each of the two coordinates is positive.
const CORNERS: [[bool; 2]; 4] = [[true, true], [false, true], [false, false], [true, false]];

/// The sides of a rectangle or parallelogram: across which axis, and whether at the positive end.
const SIDES: [(usize, bool); 4] = [(0, true), (0, false), (1, true), (1, false)];

/// The end of the side that lies at `sign` of `arm`: the lower or the upper one.
const fn ends(arm: usize, sign: bool, upper: bool) -> [bool; 2] {
    if arm == 0 { [sign, upper] } else { [upper, sign] }
}

fn signed<N: Real>(value: N, is_positive: bool) -> N {
    if is_positive { value } else { -value }
}

/// The number of the vertex with these positive coordinates.
pub(super) const fn vertex([a, b, c]: [(usize, bool); 3]) -> FeatureId {
    FeatureId::Vertex((a.1 as u32) << a.0 | (b.1 as u32) << b.0 | (c.1 as u32) << c.0)
}

/// The number of the edge along an axis, given the signs of the next axis and the one after.
pub(super) const fn edge(axis: usize, next: bool, after: bool) -> FeatureId {
    const FIRST: [u32; 3] = [0, 4, 8];
    FeatureId::Edge(FIRST[axis] + next as u32 + 2 * after as u32)
}

/// The number of the face on one side of an axis.
pub(super) const fn face(axis: usize, is_positive: bool) -> FeatureId {
    const FIRST: [u32; 3] = [0, 2, 4];
    FeatureId::Face(FIRST[axis] + !is_positive as u32)
}

impl<N: Real> Rectangle<N> {
    /// The face whose normal the axis is; and whether it belongs to the second box. Between edges it is
    /// the most aligned face of the first box or, if that of the second alone does not lean too far, this.
    fn facing(boxes: &Boxes<N>, axis: &BoxAxis<N>) -> (Self, bool) {
        let straight = |w: usize, along: N| {
            Vector::<N, 3>::ith(w, if along < N::ZERO { -N::ONE } else { N::ONE })
        };
        match axis.kind {
            AxisKind::Face1(w) => (Self::new(w, &straight(w, axis.normal[w]), &boxes.half1), false),
            AxisKind::Face2(w) => {
                let along = -axis.normal.dot(&boxes.axis2(w));
                (Self::new(w, &straight(w, along), &boxes.half2), true)
            }
            AxisKind::Edges(..) => {
                let toward2 = -boxes.pose12.inverse_vector(&axis.normal);
                let first = Self::new(axis.normal.iamax(), &axis.normal, &boxes.half1);
                let second = Self::new(toward2.iamax(), &toward2, &boxes.half2);
                let is_second = !first.shown.is_whole() && second.shown.is_whole();
                (if is_second { second } else { first }, is_second)
            }
        }
    }

    /// The face of a box across an axis, where the normal points away from the box.
    fn new(w: usize, toward: &Vector<N, 3>, half: &Vector<N, 3>) -> Self {
        let (u, v) = ((w + 1) % 3, (w + 2) % 3);
        Self {
            axes: [u, v, w],
            sign: if toward[w] < N::ZERO { -N::ONE } else { N::ONE },
            toward: [toward[u], toward[v], toward[w]],
            half: half[w],
            across: [half[u], half[v]],
            shown: Shown::of(w, [toward[u], toward[v]]),
        }
    }

    /// Where a vector that starts on the plane of the rectangle ends, seen along the normal, and how
    /// far along the normal.
    fn seen(&self, vector: &Vector<N, 3>) -> (Vector<N, 2>, N) {
        let ([u, v, w], toward) = (self.axes, &self.toward);
        let height = vector[w] / toward[2];
        let flat =
            Vector::<N, 2>::new(vector[u] - toward[0] * height, vector[v] - toward[1] * height);
        (flat, height)
    }

    fn is_positive(&self) -> bool {
        self.sign > N::ZERO
    }

    fn corner(&self, signs: [bool; 2]) -> Vector<N, 2> {
        Vector::<N, 2>::new(signed(self.across[0], signs[0]), signed(self.across[1], signs[1]))
    }

    fn vertex(&self, signs: [bool; 2]) -> FeatureId {
        let [u, v, w] = self.axes;
        vertex([(u, signs[0]), (v, signs[1]), (w, self.is_positive())])
    }

    /// The side at one end of an axis of the rectangle.
    fn side(&self, axis: usize, is_positive: bool) -> FeatureId {
        let [u, v, _] = self.axes;
        match axis {
            0 => edge(v, self.is_positive(), is_positive),
            _ => edge(u, is_positive, self.is_positive()),
        }
    }

    /// The smallest part that contains a place; `None` outside.
    fn locate(&self, place: &Vector<N, 2>, tolerance: N) -> Option<FeatureId> {
        let inside = [self.across[0] - place.x.abs(), self.across[1] - place.y.abs()];
        if min(inside[0], inside[1]) < -tolerance {
            return None;
        }
        let signs = [place.x > N::ZERO, place.y > N::ZERO];
        Some(match inside.map(|depth| depth <= tolerance) {
            [false, false] => face(self.axes[2], self.is_positive()),
            [true, false] => self.side(0, signs[0]),
            [false, true] => self.side(1, signs[1]),
            [true, true] => self.vertex(signs),
        })
    }

    /// How far along a segment crosses a side of the rectangle, away from the ends of both.
    fn crossed(
        &self,
        from: &Vector<N, 2>,
        to: &Vector<N, 2>,
        (axis, is_positive): (usize, bool),
        tolerance: N,
    ) -> Option<N> {
        let at = signed(self.across[axis], is_positive);
        let (before, after) = (from[axis] - at, to[axis] - at);
        let leaves = before > tolerance && after < -tolerance;
        let enters = before < -tolerance && after > tolerance;
        if !(leaves || enters) {
            return None;
        }
        let along = before / (before - after);
        let other = from[1 - axis] + (to[1 - axis] - from[1 - axis]) * along;
        (other.abs() < self.across[1 - axis] - tolerance).then_some(along)
    }
}

impl<N: Real> Parallelogram<N> {
    /// The face of a box, placed at `pose`, that is most aligned with the normal.
    fn facing(rectangle: &Rectangle<N>, half: &Vector<N, 3>, pose: &Pose<N, 3>) -> Self {
        let [u, v, w] = rectangle.axes;
        let mut toward = Vector::<N, 3>::zeros();
        (toward[u], toward[v], toward[w]) = rectangle.toward.into();
        let facing = -pose.inverse_vector(&toward);
        let m = facing.iamax();
        let (k1, k2) = ((m + 1) % 3, (m + 2) % 3);
        let is_positive = facing[m] > N::ZERO;
        let axis = |axis: usize| pose.rotation.column(axis) * half[axis];
        let mut from_plane = pose.translation + axis(m) * signed(N::ONE, is_positive);
        from_plane[w] -= rectangle.sign * rectangle.half;
        let (center, height) = rectangle.seen(&from_plane);
        let ((arm1, climb1), (arm2, climb2)) =
            (rectangle.seen(&axis(k1)), rectangle.seen(&axis(k2)));
        let area = cross2(&arm1, &arm2);
        Self {
            axes: [m, k1, k2],
            is_positive,
            shown: Shown::of(m, [facing[k1], facing[k2]]),
            center,
            arms: [arm1, arm2],
            height,
            climbs: [climb1, climb2],
            area,
            widths: [area.abs() / arm2.norm(), area.abs() / arm1.norm()],
        }
    }

    /// Where a corner is seen, and its height.
    fn corner(&self, signs: [bool; 2]) -> (Vector<N, 2>, N) {
        let place = self.center
            + self.arms[0] * signed(N::ONE, signs[0])
            + self.arms[1] * signed(N::ONE, signs[1]);
        let height =
            self.height + signed(self.climbs[0], signs[0]) + signed(self.climbs[1], signs[1]);
        (place, height)
    }

    fn vertex(&self, signs: [bool; 2]) -> FeatureId {
        let [m, k1, k2] = self.axes;
        vertex([(m, self.is_positive), (k1, signs[0]), (k2, signs[1])])
    }

    /// The side at one end of an arm.
    fn side(&self, arm: usize, is_positive: bool) -> FeatureId {
        let [_, k1, k2] = self.axes;
        match arm {
            0 => edge(k2, self.is_positive, is_positive),
            _ => edge(k1, is_positive, self.is_positive),
        }
    }

    /// The smallest part seen at a place and its height there; `None` outside what is shown.
    fn locate(&self, place: &Vector<N, 2>, tolerance: N) -> Option<(FeatureId, N)> {
        let arm = place - self.center;
        let along =
            [cross2(&arm, &self.arms[1]) / self.area, cross2(&self.arms[0], &arm) / self.area];
        let inside = [
            (N::ONE - along[0].abs()) * self.widths[0],
            (N::ONE - along[1].abs()) * self.widths[1],
        ];
        if min(inside[0], inside[1]) < -tolerance {
            return None;
        }
        let signs = along.map(|part| part > N::ZERO);
        let at_end = inside.map(|depth| depth <= tolerance);
        if !self.shown.has_place(at_end, signs) {
            return None;
        }
        let id = match at_end {
            [false, false] => face(self.axes[0], self.is_positive),
            [true, false] => self.side(0, signs[0]),
            [false, true] => self.side(1, signs[1]),
            [true, true] => self.vertex(signs),
        };
        Some((id, self.height + along[0] * self.climbs[0] + along[1] * self.climbs[1]))
    }
}
