//! How polytopes are put together from what is already known to be convex.

use smallvec::SmallVec;

use crate::math::{Point, Real, Vector, max, perp, unit};
use crate::shape::polytope::count32;
use crate::shape::{Polytope, PolytopeEdge, PolytopeFace};

/// Points as doubles near 1, in which products neither overflow nor vanish, and the power of two
/// that takes them back.
struct ScaledPoints<const D: usize> {
    points: Vec<Point<f64, D>>,
    scale: f64,
}

impl<const D: usize> ScaledPoints<D> {
    fn of<N: Real>(points: &[Point<N, D>]) -> Self {
        let largest = |size, p: &Point<N, D>| p.iter().fold(size, |size, x| max(size, x.abs()));
        let scale = points.iter().fold(N::ZERO, largest).power_of_two_below().as_f64();
        let points = points.iter().map(|p| Point::from(p.coords.map(|x| x.as_f64() / scale)));
        Self { points: points.collect(), scale }
    }

    /// The mean of the points.
    fn center<N: Real>(&self) -> Point<N, D> {
        let sum = self.points.iter().fold(Vector::<f64, D>::zeros(), |sum, p| sum + p.coords);
        let count = f64::from(count32(self.points.len()));
        Point::from((sum / count).map(|x| N::lit(x * self.scale)))
    }
}

impl<N: Real, const D: usize> Polytope<N, D> {
    fn from_vertices(vertices: Vec<Point<N, D>>, center: Point<N, D>) -> Self {
        Self {
            reach: Self::reach_of(&vertices),
            inner_radius: N::ZERO,
            blocks: Self::blocks_of(&vertices),
            quartets: Self::blocks_of(&vertices),
            vertices,
            faces: Vec::new(),
            planes: SmallVec::new(),
            loops: Vec::new(),
            loop_sides: Vec::new(),
            edges: Vec::new(),
            fans: Vec::new(),
            fan_starts: Vec::new(),
            fan_directions: Vec::new(),
            center,
        }
    }

    /// Adds a face with the given loop; its sides follow later.
    fn push_face(&mut self, normal: Vector<N, D>, ring: &[u32]) {
        let heights = ring.iter().map(|&vertex| self.vertices[vertex as usize].coords.dot(&normal));
        let offset = heights.reduce(max).unwrap_or(N::ZERO);
        let (first, len) = (count32(self.loops.len()), count32(ring.len()));
        self.faces.push(PolytopeFace { normal, offset, first, len });
        self.loops.extend_from_slice(ring);
    }
}

impl<N: Real> Polytope<N, 2> {
    /// The polygon with these corners, which are counter-clockwise and three at least.
    pub(in crate::shape) fn from_corners(corners: Vec<Point<N, 2>>) -> Self {
        let center = ScaledPoints::of(&corners).center();
        let mut polygon = Self::from_vertices(corners, center);
        let count = count32(polygon.vertices.len());
        for side in 0..count {
            let next = if side + 1 < count { side + 1 } else { 0 };
            let [a, b] = [side, next].map(|vertex| polygon.vertices[vertex as usize]);
            // Half of each coordinate: the difference of two large ones may overflow.
            let along = b.coords * N::HALF - a.coords * N::HALF;
            let along = unit(&along).map_or_else(Vector::<N, 2>::x, |(along, _)| along);
            polygon.push_face(-perp(&along), &[side, next]);
            polygon.loop_sides.extend([side, side]);
        }
        polygon.collect_planes();
        polygon.collect_fans();
        polygon
    }
}

impl<N: Real> Polytope<N, 3> {
    /// The solid with these corners and faces, given by outward unit normals and loops of three
    /// corners at least; `None` unless each side of a face is, backwards, a side of one other.
    pub(in crate::shape) fn from_closed_faces(
        corners: Vec<Point<N, 3>>,
        normals: &[Vector<N, 3>],
        faces: &[Vec<usize>],
    ) -> Option<Self> {
        let center = ScaledPoints::of(&corners).center();
        let mut hull = Self::from_vertices(corners, center);
        for (normal, face) in normals.iter().zip(faces) {
            let ring: Vec<u32> = face.iter().map(|&vertex| count32(vertex)).collect();
            hull.push_face(*normal, &ring);
        }
        hull.collect_planes();
        hull.connect()?;
        hull.collect_fans();
        Some(hull)
    }

    /// Numbers the edges anew, and turns them round, so that edge `i` joins the given ends.
    ///
    /// There are as many as there are edges, and each is one of them.
    pub(in crate::shape) fn name_edges(&mut self, ends: &[[u32; 2]]) {
        let place = |edge: &PolytopeEdge| {
            let [a, b] = edge.vertices;
            let found = ends.iter().position(|&ends| ends == [a, b] || ends == [b, a]);
            found.expect("each edge is one of those given")
        };
        let places: Vec<usize> = self.edges.iter().map(place).collect();
        for side in &mut self.loop_sides {
            *side = count32(places[*side as usize]);
        }
        let mut edges = self.edges.clone();
        for (edge, &place) in self.edges.iter().zip(&places) {
            let faces = edge.faces;
            let is_turned = edge.vertices != ends[place];
            let faces = if is_turned { [faces[1], faces[0]] } else { faces };
            edges[place] = PolytopeEdge { vertices: ends[place], faces };
        }
        self.edges = edges;
        self.collect_fans();
    }

    /// Finds the edges: numbered by the place in the loops where they are seen first.
    fn connect(&mut self) -> Option<()> {
        let sides = self.directed_sides();
        self.loop_sides = vec![0; sides.len()];
        let mut sorted: Vec<u32> = (0_u32..).take(sides.len()).collect();
        sorted.sort_unstable_by_key(|&place| sides[place as usize].0);
        for (place, &(ends, face)) in (0_u32..).zip(&sides) {
            let back = [ends[1], ends[0]];
            let twins = sorted.partition_point(|&other| sides[other as usize].0 < back);
            let twin =
                sorted.get(twins).copied().filter(|&other| sides[other as usize].0 == back)?;
            let next = sorted.get(twins + 1).map(|&other| sides[other as usize].0);
            if next == Some(back) {
                return None;
            }
            if place < twin {
                let edge = count32(self.edges.len());
                let faces = [face, sides[twin as usize].1];
                self.edges.push(PolytopeEdge { vertices: ends, faces });
                self.loop_sides[place as usize] = edge;
                self.loop_sides[twin as usize] = edge;
            }
        }
        Some(())
    }

    /// For each entry of the loops: the ends of the side to the next vertex, and the face.
    fn directed_sides(&self) -> Vec<([u32; 2], u32)> {
        let mut sides = Vec::with_capacity(self.loops.len());
        for (index, face) in (0_u32..).zip(&self.faces) {
            let ring = self.face_vertices(face);
            for (at, &from) in ring.iter().enumerate() {
                sides.push(([from, ring[(at + 1) % ring.len()]], index));
            }
        }
        sides
    }
}
