//! The outline of a tetrahedron without volume: a polygon, a segment or a point.

use crate::math::{Mapped, Point, Real, Vector, unit};
use crate::shape::solids::tetrahedron::{EDGES, scaled};
use crate::shape::tilt::Tilt;
use crate::shape::{Feature, FeatureId};

/// The corners are treated as collinear if twice the area of their largest triangle is at most
/// `STRAIGHT` epsilon times the squared size.
const STRAIGHT: f64 = 4096.0;

/// The corners of the outline, counter-clockwise seen from the side to which `normal` points; two
/// corners for a segment, one for a point.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::shape) struct FlatOutline<N: Real> {
    ring: Vec<u32>,
    points: Vec<Point<N, 3>>,
    /// The unit normal of the plane; meaningless for a segment or a point.
    normal: Vector<N, 3>,
}

impl<N: Real> FlatOutline<N> {
    pub(in crate::shape) fn of(corners: &[Point<N, 3>; 4]) -> Self {
        let positions = scaled(corners);
        let tolerance = STRAIGHT * N::EPSILON.as_f64();
        let normal = widest_normal(&positions).filter(|&(_, area)| area > tolerance);
        let ring = match normal {
            Some((normal, _)) => ring(&positions, &normal, tolerance),
            None => ends(&positions),
        };
        let points = ring.iter().map(|&corner| corners[corner as usize]).collect();
        let normal = normal.map_or_else(Vector::<N, 3>::y, |(normal, _)| normal.map(N::lit));
        Self { ring, points, normal }
    }

    /// Applies the rule of [`crate::shape::SupportMap::core_feature`] to the flat polygon.
    pub(in crate::shape) fn fill_toward(&self, direction: &Vector<N, 3>, out: &mut Feature<N, 3>) {
        if self.ring.len() < 3 {
            return self.fill_side(0, out);
        }
        let back = -self.normal;
        for normal in [self.normal, back] {
            if Tilt::default_limit().admits_face(&normal, direction) {
                return self.fill_face(normal, normal == back, out);
            }
        }
        let (mut best, mut height) = (0, -N::INFINITY);
        for (index, point) in self.points.iter().enumerate() {
            let found = point.coords.dot(direction);
            (best, height) = if found > height { (index, found) } else { (best, height) };
        }
        let before = if best == 0 { self.ring.len() - 1 } else { best - 1 };
        let flatter =
            if self.slope(before, direction) < self.slope(best, direction) { before } else { best };
        let slope = self.slope(flatter, direction);
        if Tilt::default_limit().admits(slope * slope) {
            self.fill_side(flatter, out);
        } else {
            out.set_point(FeatureId::Vertex(self.ring[best]), self.points[best]);
        }
    }

    fn next(&self, index: usize) -> usize {
        if index + 1 < self.ring.len() { index + 1 } else { 0 }
    }

    /// Returns the sine of the slope of a side along a direction; 1 for a side without length.
    fn slope(&self, side: usize, direction: &Vector<N, 3>) -> N {
        let along = unit(&(self.points[self.next(side)] - self.points[side]));
        along.map_or(N::ONE, |(along, _)| along.dot(direction).abs())
    }

    fn edge_id(&self, side: usize) -> FeatureId {
        let [a, b] = [self.ring[side], self.ring[self.next(side)]];
        let ends = if a < b { [a, b] } else { [b, a] };
        let found = (0_u32..).zip(EDGES).find(|&(_, edge)| edge == ends);
        FeatureId::Edge(found.map_or(0, |(index, _)| index))
    }

    /// Writes a side, or the vertex if the outline is a point.
    fn fill_side(&self, side: usize, out: &mut Feature<N, 3>) {
        let with_id = |at: usize| (FeatureId::Vertex(self.ring[at]), self.points[at]);
        if self.ring.len() == 1 {
            return out.set_point(with_id(0).0, with_id(0).1);
        }
        out.set_segment(self.edge_id(side), [with_id(side), with_id(self.next(side))]);
    }

    /// Writes the whole outline with the id of a face: the face opposite to the last corner that is
    /// not in the outline, or opposite to corner 3 if all corners are in the outline.
    fn fill_face(&self, normal: Vector<N, 3>, is_back: bool, out: &mut Feature<N, 3>) {
        let left_out = (0..4).rev().find(|corner| !self.ring.contains(corner)).unwrap_or(3);
        out.clear();
        out.id = FeatureId::Face(left_out);
        let count = self.ring.len();
        for step in 0..count {
            let at = if is_back { count - 1 - step } else { step };
            out.push(FeatureId::Vertex(self.ring[at]), self.points[at]);
            let side = if is_back { if at == 0 { count - 1 } else { at - 1 } } else { at };
            out.side_ids.push(self.edge_id(side));
        }
        out.normal = Some(normal);
    }
}

/// Returns the unit normal of the largest triangle, and twice its area; `None` if no triangle has
/// an area.
fn widest_normal(positions: &[Vector<f64, 3>; 4]) -> Option<(Vector<f64, 3>, f64)> {
    let [a, b, c, d] = positions;
    let triangles = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
    let across = triangles.mapped(|[a, b, c]| (b - a).cross(&(c - a)));
    let widest = across.into_iter().fold(Vector::<f64, 3>::zeros(), |most, area| {
        if area.norm() > most.norm() { area } else { most }
    });
    widest.try_normalize(0.0).map(|normal| (normal, widest.norm()))
}

/// Returns the corners of the outline, counter-clockwise around the normal. No corner lies outside
/// a side of the outline by more than `tolerance`.
fn ring(positions: &[Vector<f64, 3>; 4], normal: &Vector<f64, 3>, tolerance: f64) -> Vec<u32> {
    let is_left = |a: usize, b: usize, c: usize| {
        let side = positions[b] - positions[a];
        side.cross(&(positions[c] - positions[a])).dot(normal) >= -tolerance * side.norm()
    };
    let side_from = |a: usize, taken: &[u32]| {
        let leads = |b: &usize| {
            let others = (0..4).filter(|c| *c != a && c != b);
            *b != a && others.into_iter().all(|c| is_left(a, *b, c))
        };
        let far = |b: &usize| (positions[*b] - positions[a]).norm();
        let open = (0..4).filter(leads).filter(|b| *b == start_of(taken) || !has(taken, *b));
        open.reduce(|best, b| if far(&b) > far(&best) { b } else { best })
    };
    let far = |corner: usize| {
        (positions[corner] - (positions[0] + positions[1] + positions[2] + positions[3]) * 0.25)
            .norm()
    };
    let start = (1..4).fold(0, |best, corner| if far(corner) > far(best) { corner } else { best });
    let mut ring = vec![index32(start)];
    let mut at = start;
    for _ in 0..4 {
        match side_from(at, &ring) {
            Some(next) if next != start => {
                ring.push(index32(next));
                at = next;
            }
            _ => break,
        }
    }
    ring
}

fn start_of(taken: &[u32]) -> usize {
    taken[0] as usize
}

fn has(taken: &[u32], corner: usize) -> bool {
    taken.contains(&index32(corner))
}

fn index32(corner: usize) -> u32 {
    u32::try_from(corner).expect("one of four")
}

/// Returns the two corners that are farthest apart; only the first corner if all corners coincide.
fn ends(positions: &[Vector<f64, 3>; 4]) -> Vec<u32> {
    let apart = |[a, b]: [u32; 2]| (positions[a as usize] - positions[b as usize]).norm();
    let [a, b] = EDGES
        .into_iter()
        .fold([0, 1], |best, ends| if apart(ends) > apart(best) { ends } else { best });
    if apart([a, b]) > 0.0 { vec![a, b] } else { vec![0] }
}
