//! Surfaces of polyhedra inflated by a radius: offset faces, cylinder patches around edges, and
//! sphere patches around corners.
//!
//! Every vertex is a corner plus the radius times a unit vector between the normals of the faces at
//! that corner (the Gauss map of the polyhedron), so it lies on the surface up to rounding.
//! Neighbouring patches compute a common vertex from equal numbers, so its bits are equal in both
//! patches.

use std::collections::BTreeMap;

use super::sketch::Sketch;
use crate::math::{Point, Real, Vector, cross, unit, unit_or};
use crate::shape::Feature;

/// The flat faces of a solid, their adjacency, and the radius.
struct Inflation<'a, N: Real> {
    faces: &'a [Feature<N, 3>],
    /// For each directed side, from its first point to its second, the index of the face that has
    /// it. Points are identified by their bits.
    face_of_side: BTreeMap<[[u64; 3]; 2], usize>,
    radius: N,
    /// The cosine of the greatest allowed angle between neighbouring directions of an arc.
    cosine: N,
}

/// Adds the surface of a polyhedron inflated by a radius, with the outlines of its faces and the
/// arcs at the ends of its edges. Returns `false` and adds nothing if there is no face, if a side
/// has the length zero or does not belong to exactly two faces, or if a corner is too sharp (see
/// [`middle_of`]).
pub(super) fn inflated<N: Real>(
    sketch: &mut Sketch<N, 3>,
    faces: &[Feature<N, 3>],
    radius: N,
) -> bool {
    let step = core::f64::consts::TAU / f64::from(sketch.parts_of_turn());
    let (_, cosine) = N::lit(step).sine_cosine();
    let keyed = faces
        .iter()
        .enumerate()
        .flat_map(|(index, face)| sides(face).map(move |[a, b]| ([a, b].map(bits), index)));
    let count = faces.iter().map(|face| face.vertices.len()).sum::<usize>();
    let solid = Inflation { faces, face_of_side: keyed.collect(), radius, cosine };
    if count == 0 || solid.face_of_side.len() < count || !solid.is_closed() {
        return false;
    }
    let Some(corners) = solid.corners() else { return false };
    // All checks have passed, so the sketch may be changed.
    for (index, face) in faces.iter().enumerate() {
        let moved: Vec<_> = face.vertices.iter().map(|v| solid.moved(v, &normal(face))).collect();
        sketch.ring(&moved);
        sketch.fan(&moved);
        for side in sides(face) {
            solid.around_edge(sketch, index, side);
        }
    }
    corners.iter().for_each(|corner| solid.patch(sketch, corner));
    true
}

/// A corner of the polyhedron, and the directions that bound its sphere patch.
struct RoundedCorner<N: Real> {
    point: Point<N, 3>,
    /// The directions on the border of the patch, clockwise seen from outside.
    around: Vec<Vector<N, 3>>,
    /// A direction inside the patch.
    middle: Vector<N, 3>,
}

/// Returns the central direction of the directions around a corner. `None` if they form nearly a
/// full circle, as at the tip of a needle: their sum is then mostly rounding error.
fn middle_of<N: Real>(around: &[Vector<N, 3>]) -> Option<Vector<N, 3>> {
    let sum = around.iter().fold(Vector::<N, 3>::zeros(), |sum, direction| sum + direction);
    let (direction, length) = unit(&sum)?;
    (length > N::lit(around.len() as f64 / 64.0)).then_some(direction)
}

/// Returns the sides of a face, counter-clockwise.
fn sides<N: Real>(face: &Feature<N, 3>) -> impl Iterator<Item = [Point<N, 3>; 2]> + '_ {
    let next = face.vertices.iter().cycle().skip(1);
    face.vertices.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// Returns the bits of a corner's coordinates as a key. All faces of a solid have bitwise equal
/// coordinates of a common corner.
fn bits<N: Real>(point: Point<N, 3>) -> [u64; 3] {
    // Adding zero makes zeros positive.
    [0, 1, 2].map(|axis| (point[axis] + N::ZERO).bits())
}

/// Returns the outward unit normal of a face.
fn normal<N: Real>(face: &Feature<N, 3>) -> Vector<N, 3> {
    face.normal.unwrap_or_else(Vector::<N, 3>::zeros)
}

impl<N: Real> Inflation<'_, N> {
    /// Returns whether the reverse of each side is also a side, and no side has the length zero.
    fn is_closed(&self) -> bool {
        self.face_of_side.keys().all(|[a, b]| a != b && self.face_of_side.contains_key(&[*b, *a]))
    }

    /// Returns the point of the inflated surface that lies in a unit direction from a corner.
    fn moved(&self, corner: &Point<N, 3>, direction: &Vector<N, 3>) -> Point<N, 3> {
        corner + direction * self.radius
    }

    /// Returns the index of the face beyond a side of a face: the face that has the reverse of the
    /// side. `None` if no face has it.
    fn beyond(&self, [a, b]: [Point<N, 3>; 2]) -> Option<usize> {
        self.face_of_side.get(&[bits(b), bits(a)]).copied()
    }

    /// Returns unit directions from the normal of a face to the normal of the face beyond a side,
    /// both included. Exchanging the two faces may change the bits of the directions; see
    /// [`Self::ordered_arc`].
    fn arc(&self, face: usize, side: [Point<N, 3>; 2]) -> Vec<Vector<N, 3>> {
        let Some(other) = self.beyond(side) else { return Vec::new() };
        let [first, last] = [face, other].map(|index| normal(&self.faces[index]));
        // The two faces of a flat solid have opposite normals. The direction midway between them is
        // then perpendicular to the side, away from the solid.
        let along = side[1] - side[0];
        let outward = unit_or(&cross(&along, &first), first);
        let middle =
            if first.dot(&last) < -N::HALF { outward } else { unit_or(&(first + last), outward) };
        let mut arc = vec![first];
        self.bisect(first, middle, &mut arc);
        self.bisect(middle, last, &mut arc);
        arc
    }

    /// Appends the directions after `first` up to `last`, each midway between its neighbours.
    fn bisect(&self, first: Vector<N, 3>, last: Vector<N, 3>, arc: &mut Vec<Vector<N, 3>>) {
        let middle = unit_or(&(first + last), last);
        // A right angle takes at most six bisections at the finest resolution. Equal directions are
        // not bisected, nor are opposite directions, which have no middle.
        let apart = first.dot(&last);
        let is_between = middle.dot(&first) > apart && middle.dot(&last) > apart;
        if apart < self.cosine && is_between {
            self.bisect(first, middle, arc);
            self.bisect(middle, last, arc);
        } else {
            arc.push(last);
        }
    }

    /// Adds the cylinder patch around a side, once for both faces.
    fn around_edge(&self, sketch: &mut Sketch<N, 3>, face: usize, [a, b]: [Point<N, 3>; 2]) {
        if self.beyond([a, b]).is_none_or(|other| other <= face) {
            return;
        }
        for pair in self.arc(face, [a, b]).windows(2) {
            let [a1, a2] = [0, 1].map(|index| self.moved(&a, &pair[index]));
            let [b1, b2] = [0, 1].map(|index| self.moved(&b, &pair[index]));
            // The face is on the left of the side from `a` to `b`, the patch on its right.
            sketch.triangle([&b1, &a1, &a2]);
            sketch.triangle([&b1, &a2, &b2]);
            sketch.line([&a1, &a2]);
            sketch.line([&b1, &b2]);
        }
    }

    /// Returns all corners; `None` if a corner is too sharp (see [`middle_of`]).
    fn corners(&self) -> Option<Vec<RoundedCorner<N>>> {
        let mut begun = BTreeMap::new();
        for (index, face) in self.faces.iter().enumerate() {
            for side in sides(face) {
                begun.entry(bits(side[0])).or_insert((index, side));
            }
        }
        let corner = |(face, side): (usize, [Point<N, 3>; 2])| {
            let around = self.directions_around(face, side);
            middle_of(&around).map(|middle| RoundedCorner { point: side[0], around, middle })
        };
        begun.into_values().map(corner).collect()
    }

    /// Returns the directions around the start point of a side of the face `start`, clockwise seen
    /// from outside. Each step moves to the face beyond the side that leaves the corner.
    fn directions_around(&self, start: usize, side: [Point<N, 3>; 2]) -> Vec<Vector<N, 3>> {
        let (mut face, mut side, mut around) = (start, side, Vec::new());
        for _ in 0..self.face_of_side.len() {
            // The last direction of each arc is the first of the next arc.
            let mut arc = self.ordered_arc(face, side);
            arc.pop();
            around.extend(arc);
            let Some(other) = self.beyond(side) else { break };
            let leaving = sides(&self.faces[other]).find(|[from, _]| bits(*from) == bits(side[0]));
            let Some(next) = leaving else { break };
            (face, side) = (other, next);
            if face == start {
                break;
            }
        }
        around
    }

    /// Returns [`Self::arc`], computed from the face with the lower index. So the directions are
    /// bitwise equal to the directions of the cylinder patch.
    fn ordered_arc(&self, face: usize, [a, b]: [Point<N, 3>; 2]) -> Vec<Vector<N, 3>> {
        match self.beyond([a, b]) {
            Some(other) if other < face => self.arc(other, [b, a]).into_iter().rev().collect(),
            _ => self.arc(face, [a, b]),
        }
    }

    /// Adds the sphere patch around a corner, as rings around its central direction up to its
    /// border.
    fn patch(&self, sketch: &mut Sketch<N, 3>, corner: &RoundedCorner<N>) {
        let RoundedCorner { point, around, middle } = corner;
        let steps = |direction: &Vector<N, 3>| {
            let mut arc = Vec::new();
            self.bisect(*middle, *direction, &mut arc);
            arc.len()
        };
        let rings = around.iter().map(steps).max().unwrap_or(1);
        let on_ring = |direction: &Vector<N, 3>, ring: usize| {
            let part = N::lit(ring as f64 / rings as f64);
            let between = middle * (N::ONE - part) + direction * part;
            let direction = if ring == rings { *direction } else { unit_or(&between, *middle) };
            self.moved(point, &direction)
        };
        let next = around.iter().cycle().skip(1);
        for (p, q) in around.iter().zip(next) {
            for ring in 0..rings {
                let [p1, p2] = [ring, ring + 1].map(|ring| on_ring(p, ring));
                let [q1, q2] = [ring, ring + 1].map(|ring| on_ring(q, ring));
                // The border is clockwise. Next to the centre the second triangle has two equal
                // corners and is left out.
                sketch.triangle([&p1, &q2, &p2]);
                sketch.triangle([&p1, &q1, &q2]);
            }
        }
    }
}
