//! The features of triangles, in any dimension: the supporting feature for a direction, and the
//! order of its vertices.

use crate::math::{Matrix, Point, Real, Vector, cross, max, max_component, unit, unit_or};
use crate::shape::solids::segment::length_of;
use crate::shape::tilt::{FACING_SINE_SQUARED, Tilt};
use crate::shape::{
    ConvexPolyhedron, FaceRing, Feature, FeatureId, SideOrVertex, SupportMap, Triangle,
};

/// The plane (in 2D: the whole space) that a triangle spans.
struct TriangleSpan<N: Real, const D: usize> {
    /// The index of the longest side.
    longest: usize,
    /// The unit vector along the longest side, from its first vertex to its second.
    along: Vector<N, D>,
    /// The unit vector in the plane from the longest side to the opposite corner; `None` if the
    /// corners lie on a line.
    rise: Option<Vector<N, D>>,
}

impl<N: Real, const D: usize> TriangleSpan<N, D> {
    /// Returns the span of three corners; `None` if they coincide.
    fn of(corners: &[Point<N, D>; 3]) -> Option<Self> {
        let side = |i: usize| corners[(i + 1) % 3] - corners[i];
        let longer = |best: usize, i: usize| {
            if length_of(&side(i)) > length_of(&side(best)) { i } else { best }
        };
        let longest = longer(longer(0, 1), 2);
        let (along, length) = unit(&side(longest))?;
        let to_opposite = corners[(longest + 2) % 3] - corners[longest];
        // Up to this height, the difference of coordinates may be rounding error alone.
        let tolerance = N::lit(16.0) * N::EPSILON * length;
        let rise = unit(&without(&to_opposite, &along));
        let rise = rise.filter(|&(_, height)| height > tolerance);
        // A second projection makes the vector perpendicular up to rounding, even for a nearly flat
        // triangle.
        let rise = rise.map(|(rise, _)| unit_or(&without(&rise, &along), rise));
        Some(Self { longest, along, rise })
    }

    /// Returns the squared length of the component of the unit vector `direction` in the plane: the
    /// squared sine of its angle to the normal. `None` if the corners lie on a line.
    fn squared_sine(&self, direction: &Vector<N, D>) -> Option<N> {
        let (along, rise) = (self.along.dot(direction), self.rise?.dot(direction));
        Some(along * along + rise * rise)
    }

    /// Returns the unit normal of the plane on the side to which `direction` points. `None` if
    /// `direction` lies in the plane, or the corners lie on a line.
    fn normal_toward(&self, direction: &Vector<N, D>) -> Option<Vector<N, D>> {
        let rise = self.rise?;
        let rest = |v: &Vector<N, D>| without(&without(v, &self.along), &rise);
        let (normal, _) = unit(&rest(direction))?;
        Some(unit_or(&rest(&normal), normal))
    }
}

/// Returns the component of a vector perpendicular to the unit vector `along`.
fn without<N: Real, const D: usize>(v: &Vector<N, D>, along: &Vector<N, D>) -> Vector<N, D> {
    v - along * along.dot(v)
}

/// Returns whether the determinant of `D` columns is negative, by Gaussian elimination with row
/// exchanges.
fn is_left_handed<N: Real, const D: usize>(mut columns: Matrix<N, D>) -> bool {
    let mut is_negative = false;
    for at in 0..D {
        let pivot = (at..D).fold(at, |best, row| {
            if columns[(row, at)].abs() > columns[(best, at)].abs() { row } else { best }
        });
        if columns[(pivot, at)] == N::ZERO {
            return false;
        }
        columns.swap_rows(at, pivot);
        is_negative ^= (pivot != at) ^ (columns[(at, at)] < N::ZERO);
        for row in at + 1..D {
            let factor = columns[(row, at)] / columns[(at, at)];
            for column in at..D {
                let above = columns[(at, column)];
                columns[(row, column)] -= factor * above;
            }
        }
    }
    is_negative
}

impl<N: Real, const D: usize> Triangle<N, D> {
    /// Returns the corner indices in counter-clockwise order, in 3D seen from the side to which
    /// `direction` points.
    fn ring(&self, direction: &Vector<N, D>) -> [usize; 3] {
        let [a, b, c] = self.corners();
        let mut columns = Matrix::<N, D>::zeros();
        for (column, vector) in [b - a, c - a, *direction].iter().enumerate().take(D) {
            columns.set_column(column, vector);
        }
        if is_left_handed(columns) { [0, 2, 1] } else { [0, 1, 2] }
    }

    fn point(&self, index: usize) -> (FeatureId, Point<N, D>) {
        (vertex_id(index), self.corners()[index])
    }

    /// Writes the supporting feature for the unit vector `direction` with the limit `tilt`.
    pub(in crate::shape) fn fill_toward(
        &self,
        direction: &Vector<N, D>,
        tilt: Tilt<N>,
        out: &mut Feature<N, D>,
    ) {
        let Some(span) = TriangleSpan::of(self.corners()) else {
            return out.set_point(vertex_id(0), self.corners()[0]);
        };
        if span.squared_sine(direction).is_some_and(|sine_squared| tilt.admits(sine_squared)) {
            return self.fill_polygon(&span, direction, out);
        }
        let (side, slope) = self.flattest_side(&span, direction);
        if tilt.admits(slope * slope) {
            self.fill_side(side, direction, out);
        } else {
            let (id, point) = self.point(self.support_corner(direction));
            out.set_point(id, point);
        }
    }

    /// Returns the id of the corner, side or face on which a surface point lies, up to `tolerance`.
    /// In 3D the face is on the side to which the unit vector `direction` points. `None` for a
    /// point near several sides but no corner, as on a thin triangle, and in 2D for a point inside.
    pub(crate) fn part_at(
        &self,
        point: &Point<N, D>,
        direction: &Vector<N, D>,
        tolerance: N,
    ) -> Option<FeatureId> {
        let corners = self.corners();
        let to = |index: usize| point - corners[index];
        if let Some(corner) =
            (0..3).find(|&at| to(at).norm_squared() <= N::lit(4.0) * tolerance * tolerance)
        {
            return Some(vertex_id(corner));
        }
        let is_on = |&side: &usize| {
            let (along, arm) = (corners[(side + 1) % 3] - corners[side], to(side));
            let aside = arm - along * (along.dot(&arm) / along.norm_squared());
            aside.norm_squared() <= tolerance * tolerance
        };
        let mut touched = (0..3).filter(is_on);
        match (touched.next(), touched.next()) {
            (Some(side), None) => Some(side_id::<D>(side)),
            (None, _) => {
                let index = u32::from(self.ring(direction)[1] == 2);
                // In 2D the interior is not a feature.
                Some(FeatureId::flat::<D>(2, index)).filter(|id| matches!(id, FeatureId::Face(_)))
            }
            _ => None,
        }
    }

    fn support_corner(&self, direction: &Vector<N, D>) -> usize {
        let support = self.core_support(direction);
        (0..3).find(|&index| self.corners()[index] == support).unwrap_or(0)
    }

    /// Returns the side at the support vertex with the smallest slope, and the sine of that slope.
    /// If the corners lie on a line, only the longest side is considered.
    fn flattest_side(&self, span: &TriangleSpan<N, D>, direction: &Vector<N, D>) -> (usize, N) {
        if span.rise.is_none() {
            return (span.longest, span.along.dot(direction).abs());
        }
        let support = self.support_corner(direction);
        let slope = |side: usize| {
            let along =
                unit_or(&(self.corners()[(side + 1) % 3] - self.corners()[side]), span.along);
            (side, along.dot(direction).abs())
        };
        let (out, back) = (slope(support), slope((support + 2) % 3));
        if back.1 < out.1 { back } else { out }
    }

    /// Writes the face on the side of `direction`. Called in 3D only.
    fn fill_polygon(
        &self,
        span: &TriangleSpan<N, D>,
        direction: &Vector<N, D>,
        out: &mut Feature<N, D>,
    ) {
        out.clear();
        let ring = self.ring(direction);
        out.id = FeatureId::Face(u32::from(ring[1] == 2));
        for at in 0..3 {
            let (id, point) = self.point(ring[at]);
            out.push(id, point);
            out.side_ids.push(side_id::<D>(side_between(ring[at], ring[(at + 1) % 3])));
        }
        out.normal = span.normal_toward(direction);
    }

    /// Writes side `side`; in 2D, where it is a face, with its normal.
    fn fill_side(&self, side: usize, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        out.set_segment(side_id::<D>(side), self.side_ends(side, direction));
        let normal = self.side_normal(side).filter(|normal| normal.dot(direction) > N::ZERO);
        let normal = normal.or_else(|| {
            let (along, _) = unit(&(out.vertices[1] - out.vertices[0]))?;
            unit(&without(direction, &along)).map(|(normal, _)| normal)
        });
        out.normal = normal.filter(|_| matches!(out.id, FeatureId::Face(_)));
    }

    /// Returns the unit vector in the triangle's plane that points out of a side; `None` if the
    /// corners lie on a line.
    fn side_normal(&self, side: usize) -> Option<Vector<N, D>> {
        TriangleSpan::of(self.corners())?.rise?;
        let corners = self.corners();
        let (along, _) = unit(&(corners[(side + 1) % 3] - corners[side]))?;
        let (normal, _) = unit(&without(&(corners[side] - corners[(side + 2) % 3]), &along))?;
        Some(unit_or(&without(&normal, &along), normal))
    }

    /// Returns the normal of a vertex or a side. If the corners lie on a line, the normal of a
    /// vertex is the direction from the centre to the vertex, and the normal of a side is an
    /// arbitrary perpendicular of the line.
    fn thin_normal(&self, id: FeatureId) -> Vector<N, D> {
        let outward = |index: usize| unit(&(self.corners()[index] - self.center()));
        let normal = match id {
            FeatureId::Vertex(index) => {
                let index = index as usize;
                let (out, back) = (self.side_normal(index), self.side_normal((index + 2) % 3));
                let sum = out.zip(back).and_then(|(out, back)| unit(&(out + back)));
                sum.or_else(|| outward(index)).map(|(normal, _)| normal)
            }
            FeatureId::Edge(side) | FeatureId::Face(side) => {
                let along = TriangleSpan::of(self.corners()).map(|span| span.along);
                self.side_normal(side as usize)
                    .or_else(|| along.map(|along| any_perpendicular(&along)))
            }
        };
        normal.unwrap_or_else(|| axis(0))
    }

    /// Returns the ends of a side in the order of [`Self::ring`].
    fn side_ends(&self, side: usize, direction: &Vector<N, D>) -> [(FeatureId, Point<N, D>); 2] {
        let ring = self.ring(direction);
        let ends = if ring[1] == 1 { [side, (side + 1) % 3] } else { [(side + 1) % 3, side] };
        ends.map(|index| self.point(index))
    }

    #[track_caller]
    fn index(id: FeatureId, dimension: usize) -> usize {
        let (FeatureId::Vertex(index) | FeatureId::Edge(index) | FeatureId::Face(index)) = id;
        let fits = index < 3 && id == FeatureId::flat::<D>(dimension, index);
        assert!(fits, "a triangle has no {} named {id:?}", FeatureId::word::<D>(dimension));
        index as usize
    }

    fn ends(&self, id: FeatureId) -> [(FeatureId, Point<N, D>); 2] {
        self.side_ends(Self::index(id, 1), &Vector::<N, D>::zeros())
    }
}

impl<N: Real> Triangle<N, 2> {
    /// Implements [`SideOrVertex::of`] for triangles; `None` if the corners coincide.
    pub(in crate::shape) fn supporting(&self, direction: &Vector<N, 2>) -> Option<SideOrVertex<N>> {
        let span = TriangleSpan::of(self.corners())?;
        let (side, slope) = self.flattest_side(&span, direction);
        if Tilt::default_limit().admits(slope * slope) {
            let ends = self.side_ends(side, direction);
            return Some(SideOrVertex::side(side_id::<2>(side), ends));
        }
        let (id, point) = self.point(self.support_corner(direction));
        Some(SideOrVertex::vertex(id, point))
    }
}

fn axis<N: Real, const D: usize>(index: usize) -> Vector<N, D> {
    let mut axis = Vector::<N, D>::zeros();
    axis[index] = N::ONE;
    axis
}

/// Returns a unit vector perpendicular to the unit vector `along`: the projection of the axis along
/// which `along` has its smallest component.
fn any_perpendicular<N: Real, const D: usize>(along: &Vector<N, D>) -> Vector<N, D> {
    let weakest =
        (1..D).fold(0, |best, at| if along[at].abs() < along[best].abs() { at } else { best });
    unit_or(&without(&axis(weakest), along), axis(weakest))
}

/// Returns the id of a corner, 0 to 2.
fn vertex_id(index: usize) -> FeatureId {
    FeatureId::Vertex(u32::try_from(index).expect("there are three corners"))
}

fn side_id<const D: usize>(index: usize) -> FeatureId {
    FeatureId::flat::<D>(1, u32::try_from(index).expect("there are three sides"))
}

/// Returns the index of the side between the corners `from` and `to`, which must differ.
fn side_between(from: usize, to: usize) -> usize {
    if (from + 1) % 3 == to { from } else { to }
}

/// A triangle is thin if four times its squared area is at most this fraction of the fourth power
/// of its longest side.
pub(crate) const THIN_SQUARED: f64 = 1.0 / 1024.0;
/// A quantity is clearly larger than another if the excess is more than this fraction of the larger
/// one; otherwise rounding may decide.
pub(crate) const CLEAR: f64 = 1.0 / 1024.0;

impl<N: Real> Triangle<N, 3> {
    /// Returns the id of the feature that [`SupportMap::core_feature`] writes for a unit vector,
    /// computed without square roots. `None` for thin triangles, and if the decision is within the
    /// margin [`CLEAR`].
    pub(crate) fn supporting_part(&self, direction: &Vector<N, 3>) -> Option<FeatureId> {
        let [a, b, c] = self.corners();
        let sides = [b - a, c - b, a - c];
        let size = max(max_component(&sides[0]), max_component(&sides[1]));
        // The sides are scaled so that fourth powers neither overflow nor underflow.
        let scaled_sides = sides.map(|side| side / size.power_of_two_below());
        let squared = [
            scaled_sides[0].norm_squared(),
            scaled_sides[1].norm_squared(),
            scaled_sides[2].norm_squared(),
        ];
        let longest = max(max(squared[0], squared[1]), squared[2]);
        let across = cross(&scaled_sides[0], &scaled_sides[1]);
        let (area, rise) = (across.norm_squared(), across.dot(direction));
        // A NaN area fails the comparison, so the triangle is treated as thin.
        let is_wide = area > N::lit(THIN_SQUARED) * longest * longest;
        if !is_wide {
            return None;
        }
        let limit = N::lit(FACING_SINE_SQUARED);
        let is_less = |small: N, large: N| small < large * (N::ONE - N::lit(CLEAR));
        let upright = (N::ONE - limit) * area;
        if is_less(upright, rise * rise) {
            return Some(FeatureId::Face(u32::from(rise < N::ZERO)));
        }
        if !is_less(rise * rise, upright) {
            return None;
        }
        let climbs = scaled_sides.map(|side| side.dot(direction));
        // The highest corner along the direction, from the components of the sides.
        let heights = [N::ZERO, climbs[0], climbs[0] + climbs[1]];
        let higher = |best: usize, at: usize| if heights[at] > heights[best] { at } else { best };
        let top = higher(higher(0, 1), 2);
        let slope = |side: usize| climbs[side] * climbs[side] / squared[side];
        let (out, back) = (slope(top), slope((top + 2) % 3));
        let (side, least, other) =
            if back < out { ((top + 2) % 3, back, out) } else { (top, out, back) };
        if is_less(limit, least) {
            return Some(vertex_id(top));
        }
        let is_side = is_less(least, limit) && is_less(least, other);
        is_side.then(|| side_id::<3>(side))
    }

    /// Fills a blank ring with the face on the side of a direction. The triangle must not be thin.
    pub(crate) fn fill_ring(&self, direction: &Vector<N, 3>, face: &mut FaceRing<N>) {
        let [a, b, c] = self.corners();
        let edges = [b - a, c - a];
        // The edges are scaled so that products neither overflow nor underflow.
        let size = max(max_component(&edges[0]), max_component(&edges[1])).power_of_two_below();
        let across = cross(&(edges[0] / size), &(edges[1] / size));
        let is_below = across.dot(direction) < N::ZERO;
        let normal = unit_or(&across, *direction);
        face.normal = if is_below { -normal } else { normal };
        face.id = FeatureId::Face(u32::from(is_below));
        let ring = if is_below { [0, 2, 1] } else { [0, 1, 2] };
        for at in 0..3 {
            let (id, point) = self.point(ring[at]);
            face.push(&point, [id, side_id::<3>(side_between(ring[at], ring[(at + 1) % 3]))]);
        }
    }
}

impl<N: Real> ConvexPolyhedron<N, 2> for Triangle<N, 2> {
    fn vertex(&self, id: FeatureId) -> Point<N, 2> {
        self.corners()[Self::index(id, 0)]
    }

    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, 2>); 2] {
        self.ends(id)
    }

    fn face(&self, id: FeatureId, out: &mut Feature<N, 2>) {
        let normal = self
            .feature_normal(FeatureId::Face(u32::try_from(Self::index(id, 1)).expect("below 3")));
        self.fill_side(Self::index(id, 1), &normal, out);
    }

    fn feature_normal(&self, id: FeatureId) -> Vector<N, 2> {
        Self::index(id, usize::from(!matches!(id, FeatureId::Vertex(_))));
        self.thin_normal(id)
    }

    fn support_face_toward(&self, direction: &Vector<N, 2>, out: &mut Feature<N, 2>) {
        let Some(span) = TriangleSpan::of(self.corners()) else {
            return out.set_point(vertex_id(0), self.corners()[0]);
        };
        let (side, _) = self.flattest_side(&span, direction);
        self.fill_side(side, direction, out);
    }

    fn support_feature_toward(&self, direction: &Vector<N, 2>, angle: N, out: &mut Feature<N, 2>) {
        self.fill_toward(direction, Tilt::of_angle(angle), out);
    }

    fn support_feature_id_toward(&self, direction: &Vector<N, 2>) -> FeatureId {
        let mut feature = Feature::default();
        self.fill_toward(direction, Tilt::least(), &mut feature);
        feature.id
    }
}

impl<N: Real> ConvexPolyhedron<N, 3> for Triangle<N, 3> {
    fn vertex(&self, id: FeatureId) -> Point<N, 3> {
        self.corners()[Self::index(id, 0)]
    }

    fn edge(&self, id: FeatureId) -> [(FeatureId, Point<N, 3>); 2] {
        self.ends(id)
    }

    fn face(&self, id: FeatureId, out: &mut Feature<N, 3>) {
        let normal = self.feature_normal(FeatureId::Face(u32::from(is_second_face(id))));
        self.support_face_toward(&normal, out);
    }

    fn feature_normal(&self, id: FeatureId) -> Vector<N, 3> {
        if !matches!(id, FeatureId::Face(_)) {
            Self::index(id, usize::from(matches!(id, FeatureId::Edge(_))));
            return self.thin_normal(id);
        }
        let is_second = is_second_face(id);
        let span = TriangleSpan::of(self.corners());
        let along = span.as_ref().map_or_else(|| axis(0), |span| span.along);
        let rise = span.and_then(|span| span.rise).unwrap_or_else(|| any_perpendicular(&along));
        let across = cross(&along, &rise);
        if is_second { -across } else { across }
    }

    fn support_face_toward(&self, direction: &Vector<N, 3>, out: &mut Feature<N, 3>) {
        match TriangleSpan::of(self.corners()) {
            None => out.set_point(vertex_id(0), self.corners()[0]),
            Some(span) if span.rise.is_none() => self.fill_side(span.longest, direction, out),
            Some(span) => self.fill_polygon(&span, direction, out),
        }
    }

    fn support_feature_toward(&self, direction: &Vector<N, 3>, angle: N, out: &mut Feature<N, 3>) {
        self.fill_toward(direction, Tilt::of_angle(angle), out);
    }

    fn support_feature_id_toward(&self, direction: &Vector<N, 3>) -> FeatureId {
        let mut feature = Feature::default();
        self.fill_toward(direction, Tilt::least(), &mut feature);
        feature.id
    }
}

/// Returns whether `id` is `Face(1)`.
#[track_caller]
fn is_second_face(id: FeatureId) -> bool {
    assert!(matches!(id, FeatureId::Face(0 | 1)), "a triangle has no face named {id:?}");
    id == FeatureId::Face(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::xorshift::Xorshift;

    #[test]
    fn the_supporting_part_is_known_at_every_scale() {
        let (mut random, mut known) = (Xorshift(3), 0);
        for _ in 0..2000 {
            let corners = [(); 3].map(|()| Point::from(random.vector::<f32>(1.0)));
            let direction = random.vector::<f32>(1.0).normalize();
            let supporting = |scale: f32| {
                let [a, b, c] = corners.map(|corner| corner * scale);
                Triangle::new(a, b, c).supporting_part(&direction)
            };
            let part = supporting(1.0);
            assert_eq!([supporting(2.0_f32.powi(-60)), supporting(2.0_f32.powi(60))], [part; 2]);
            known += usize::from(part.is_some());
        }
        assert!(known > 1500, "{known} are decided");
        assert_eq!(
            Triangle::new(Point::origin(), Point::origin(), Point::<f32, 3>::origin())
                .supporting_part(&Vector::<f32, 3>::y()),
            None,
            "it has no area"
        );
    }
}
