//! Convex outlines in the plane: what segments, triangles, boxes and polygons have in common.

use core::array::from_fn;

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
    /// bisector.
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

    /// Visits the directions that may be the best to part the outline from another: for each vertex the
    /// outward normal of the side that starts there and, where the angle is sharper than a right
    /// angle, the outward bisector.
    ///
    /// Sides alone would not try the latter: it keeps the directions tried less than a right angle
    /// apart, so that flat outlines (segments, slivers) that point at each other are told apart.
    /// Beside a side of no length there is none.
    #[inline]
    pub(super) fn visit_axes(&self, visit: &mut impl FnMut(Vector<N, 2>)) {
        let Some(mut before) = self.normals.last().copied() else { return };
        for &after in &self.normals {
            after.into_iter().for_each(&mut *visit);
            if let (Some(before), Some(after)) = (before, after)
                && before.dot(&after) < N::ZERO
            {
                // The normals turned back by a quarter are the directions of the sides.
                let tip = unit(&(left_of(&before) - left_of(&after)));
                tip.into_iter().for_each(|(tip, _)| visit(tip));
            }
            before = after;
        }
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

/// How many vertices [`Reach`] measures side by side.
const LANES: usize = 8;

/// How far an outline reaches along many directions: as [`Outline::height`], with the vertices side by
/// side where there are few.
pub(super) struct Reach<'a, N: Real> {
    outline: &'a Outline<N>,
    /// The coordinates, the last vertex again and again in the rest.
    lanes: Option<([N; LANES], [N; LANES])>,
}

impl<'a, N: Real> Reach<'a, N> {
    pub(super) fn of(outline: &'a Outline<N>) -> Self {
        let vertices = outline.vertices.as_slice();
        let last = vertices.len() - 1;
        let at = |lane: usize| vertices[if lane < last { lane } else { last }];
        let lanes = || (from_fn(|lane| at(lane).x), from_fn(|lane| at(lane).y));
        Self { outline, lanes: (last < LANES).then(lanes) }
    }

    #[inline]
    pub(super) fn along(&self, direction: &Vector<N, 2>) -> N {
        let Some((xs, ys)) = &self.lanes else { return self.outline.height(direction) };
        let heights: [N; LANES] = from_fn(|lane| direction.x * xs[lane] + direction.y * ys[lane]);
        let halves: [N; LANES / 2] = from_fn(|lane| max(heights[lane + 4], heights[lane]));
        max(max(halves[2], halves[0]), max(halves[3], halves[1]))
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
