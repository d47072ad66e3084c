//! Convex outlines in the plane: what segments, triangles, boxes and polygons have in common.

use smallvec::{SmallVec, smallvec};

use super::wrong_kinds;
use crate::math::{Point, Pose, Real, Vector, cross2, max, unit};
use crate::query::Pair;
use crate::shape::{Kind, Polytope};

/// A convex polygon, swollen by a rounding radius.
///
/// Counter-clockwise; a point, a segment (there and back again) and a flat triangle are outlines.
pub(super) struct Outline<N: Real> {
    pub(super) vertices: SmallVec<[Point<N, 2>; 8]>,
    /// The unit outward normal of the side from each vertex to the next; `None` for a side of no
    /// length.
    pub(super) normals: SmallVec<[Option<Vector<N, 2>>; 8]>,
    pub(super) rounding: N,
}

impl<N: Real> Outline<N> {
    /// The outline of a solid of the plane in its own frame.
    pub(super) fn of(pair: &Pair<'_, N, 2>, kind: &Kind<'_, N, 2>) -> Self {
        match kind {
            Kind::Ball(ball) => Self::new(smallvec![Point::origin()], ball.radius()),
            Kind::Segment(segment) => Self::new(smallvec![*segment.a(), *segment.b()], N::ZERO),
            Kind::Capsule(capsule) => {
                let segment = capsule.segment();
                Self::new(smallvec![*segment.a(), *segment.b()], capsule.radius())
            }
            Kind::Triangle(triangle) => Self::of_triangle(triangle.corners()),
            Kind::Cuboid(cuboid) => Self::of_box(cuboid.half_extents()),
            Kind::Polytope(polygon) => Self::of_polygon(polygon),
            _ => wrong_kinds(pair),
        }
    }

    /// Vertices that repeat the one before count once: beside a side of no length there would be no
    /// [`Self::tip`].
    fn new(mut vertices: SmallVec<[Point<N, 2>; 8]>, rounding: N) -> Self {
        vertices.dedup();
        if vertices.len() > 1 && vertices.first() == vertices.last() {
            vertices.pop();
        }
        let mut outline = Self { vertices, normals: SmallVec::new(), rounding };
        for at in 0..outline.vertices.len() {
            let [from, to] = outline.side(at);
            outline.normals.push(unit(&(to - from)).map(|(along, _)| right_of(&along)));
        }
        outline
    }

    /// The corners may be given in either order.
    fn of_triangle(&[a, b, c]: &[Point<N, 2>; 3]) -> Self {
        let clockwise = cross2(&(b - a), &(c - a)) < N::ZERO;
        Self::new(if clockwise { smallvec![a, c, b] } else { smallvec![a, b, c] }, N::ZERO)
    }

    fn of_box(half: &Vector<N, 2>) -> Self {
        let corner = |x: N, y: N| Point::<N, 2>::new(x * half.x, y * half.y);
        let (low, high) = (-N::ONE, N::ONE);
        let vertices =
            smallvec![corner(low, low), corner(high, low), corner(high, high), corner(low, high)];
        let (x, y) = (Vector::<N, 2>::x(), Vector::<N, 2>::y());
        let normals = smallvec![Some(-y), Some(x), Some(y), Some(-x)];
        Self { vertices, normals, rounding: N::ZERO }
    }

    fn of_polygon(polygon: &Polytope<N, 2>) -> Self {
        let mut normals = SmallVec::new();
        for face in polygon.faces() {
            normals.push(Some(face.normal));
        }
        Self { vertices: SmallVec::from_slice(polygon.vertices()), normals, rounding: N::ZERO }
    }

    /// The same outline seen from the frame in which its own has the given pose.
    pub(super) fn placed(mut self, pose: &Pose<N, 2>) -> Self {
        for vertex in &mut self.vertices {
            *vertex = pose.point(vertex);
        }
        for normal in self.normals.iter_mut().flatten() {
            *normal = pose.vector(normal);
        }
        self
    }

    /// The index of the vertex farthest along `direction`, the first of equals.
    #[inline]
    pub(super) fn support(&self, direction: &Vector<N, 2>) -> usize {
        let (mut best, mut height) = (0, direction.dot(&self.vertices[0].coords));
        for (at, vertex) in self.vertices.iter().enumerate().skip(1) {
            let candidate = direction.dot(&vertex.coords);
            if candidate > height {
                (best, height) = (at, candidate);
            }
        }
        best
    }

    /// How far the outline reaches along `direction`, from the origin.
    #[inline]
    pub(super) fn height(&self, direction: &Vector<N, 2>) -> N {
        let first = direction.dot(&self.vertices[0].coords);
        self.vertices[1..]
            .iter()
            .fold(first, |high, vertex| max(direction.dot(&vertex.coords), high))
    }

    /// The two ends of the side that starts at a vertex.
    #[inline]
    pub(super) fn side(&self, at: usize) -> [Point<N, 2>; 2] {
        [self.vertices[at], self.vertices[self.next(at)]]
    }

    /// The number of the vertex after a vertex.
    fn next(&self, at: usize) -> usize {
        if at + 1 < self.vertices.len() { at + 1 } else { 0 }
    }

    /// The number of the vertex before a vertex.
    pub(super) fn previous(&self, at: usize) -> usize {
        if at > 0 { at - 1 } else { self.vertices.len() - 1 }
    }

    /// The outward bisector at a vertex whose angle is sharper than a right angle; `None` at a
    /// blunter one, and beside a side of no length.
    ///
    /// An axis that sides alone would not try: it keeps the directions tried less than a right angle
    /// apart, so that flat outlines (segments, slivers) that point at each other are told apart.
    pub(super) fn tip(&self, at: usize) -> Option<Vector<N, 2>> {
        let (before, after) = (self.normals[self.previous(at)]?, self.normals[at]?);
        if before.dot(&after) >= N::ZERO {
            return None;
        }
        // The normals turned back by a quarter are the directions of the sides.
        unit(&(left_of(&before) - left_of(&after))).map(|(tip, _)| tip)
    }

    /// A length that no vertex exceeds in distance from the origin, within a factor of 2.
    pub(super) fn reach(&self) -> N {
        self.vertices.iter().fold(N::ZERO, |most, p| max(p.x.abs() + p.y.abs(), most))
    }

    /// The lowest and highest of the vertices that reach within `noise` of the farthest along
    /// `normal`, as measured along `tangent`.
    pub(super) fn feature(
        &self,
        normal: &Vector<N, 2>,
        tangent: &Vector<N, 2>,
        noise: N,
    ) -> [(N, Point<N, 2>); 2] {
        let farthest = self.vertices[self.support(normal)];
        let mut ends = [(tangent.dot(&farthest.coords), farthest); 2];
        for vertex in &self.vertices {
            let along = tangent.dot(&vertex.coords);
            if normal.dot(&(farthest - vertex)) <= noise {
                if along < ends[0].0 {
                    ends[0] = (along, *vertex);
                }
                if along > ends[1].0 {
                    ends[1] = (along, *vertex);
                }
            }
        }
        ends
    }
}

/// `v` turned by a quarter clockwise: from the direction of a side to its outward normal.
fn right_of<N: Real>(v: &Vector<N, 2>) -> Vector<N, 2> {
    Vector::<N, 2>::new(v.y, -v.x)
}

/// `v` turned by a quarter counter-clockwise: from a normal to the direction of the side.
fn left_of<N: Real>(v: &Vector<N, 2>) -> Vector<N, 2> {
    crate::math::perp(v)
}
