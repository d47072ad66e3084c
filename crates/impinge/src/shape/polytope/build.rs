//! Construction of polytopes from vertices and faces that are known to be convex.

use smallvec::SmallVec;

use crate::math::{Point, Real, Vector, max, perp, unit};
use crate::shape::polytope::{Twin, count32};
use crate::shape::{Polytope, PolytopeEdge, PolytopeFace};

/// Returns the mean of the points, computed in doubles scaled to about 1, so that the sum cannot
/// overflow.
fn center_of<N: Real, const D: usize>(points: &[Point<N, D>]) -> Point<N, D> {
    let largest = |size, p: &Point<N, D>| p.iter().fold(size, |size, x| max(size, x.abs()));
    let scale = points.iter().fold(N::ZERO, largest).power_of_two_below().as_f64();
    let scaled = |p: &Point<N, D>| p.coords.map(|x| x.as_f64() / scale);
    let sum = points.iter().fold(Vector::<f64, D>::zeros(), |sum, p| sum + scaled(p));
    let count = f64::from(count32(points.len()));
    Point::from((sum / count).map(|x| N::lit(x * scale)))
}

/// Groups values by owner (a stable counting sort). Returns the start index of each of the `count`
/// groups, followed by the end of the last group, and the grouped values.
fn grouped<T: Copy + Default>(
    count: usize,
    owned: impl Iterator<Item = (u32, T)> + Clone,
) -> (Vec<u32>, Vec<T>) {
    // Filling advances the start of an owner to the start of the next owner, so each start is
    // stored one entry later.
    let mut starts = vec![0; count + 2];
    owned.clone().for_each(|(owner, _)| starts[owner as usize + 2] += 1);
    for owner in 0..count {
        starts[owner + 2] += starts[owner + 1];
    }
    let mut values = vec![T::default(); starts[count + 1] as usize];
    for (owner, value) in owned {
        let start = &mut starts[owner as usize + 1];
        values[*start as usize] = value;
        *start += 1;
    }
    starts.pop();
    (starts, values)
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// Returns a polytope with vertices only; the caller adds faces, planes, edges and fans.
    fn from_vertices(vertices: Vec<Point<N, D>>) -> Self {
        Self {
            center: center_of(&vertices),
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
            twin: Twin::default(),
        }
    }

    /// Appends a face with the given loop of vertices; the caller adds the loop's sides.
    fn push_face(&mut self, normal: Vector<N, D>, ring: &[u32]) {
        let heights = ring.iter().map(|&vertex| self.vertices[vertex as usize].coords.dot(&normal));
        let offset = heights.reduce(max).unwrap_or(N::ZERO);
        let (first, len) = (count32(self.loops.len()), count32(ring.len()));
        self.faces.push(PolytopeFace { normal, offset, first, len });
        self.loops.extend_from_slice(ring);
    }
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// Computes for each vertex its fan: the edges (in 2D: the faces) that end at it.
    fn collect_fans(&mut self) {
        let count = if self.edges.is_empty() { self.faces.len() } else { self.edges.len() };
        let sides = (0_u32..).take(count);
        let ends = |side: u32| self.side(side).vertices;
        let ended = sides.clone().flat_map(|side| ends(side).map(|vertex| (vertex, side)));
        let (starts, fans) = grouped(self.vertices.len(), ended);
        let direction = |side: u32| {
            let [a, b] = ends(side).map(|end| self.vertices[end as usize]);
            unit(&(b - a)).map(|(along, _)| along)
        };
        let directions: Vec<_> = sides.map(direction).collect();
        self.fan_directions = fans.iter().map(|&side| directions[side as usize]).collect();
        (self.fan_starts, self.fans) = (starts, fans);
    }
}

impl<N: Real> Polytope<N, 2> {
    /// Returns the polygon with the given corners, at least three, counter-clockwise.
    pub(in crate::shape) fn from_corners(corners: Vec<Point<N, 2>>) -> Self {
        let mut polygon = Self::from_vertices(corners);
        let count = count32(polygon.vertices.len());
        for side in 0..count {
            let next = if side + 1 < count { side + 1 } else { 0 };
            let [a, b] = [side, next].map(|vertex| polygon.vertices[vertex as usize]);
            // Halves each coordinate first: the difference of two large coordinates may overflow.
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
    /// Returns the solid with the given corners and faces; a face has an outward unit normal and a
    /// loop of at least three corners. `None` unless each side of a face occurs reversed in exactly
    /// one other face.
    pub(in crate::shape) fn from_closed_faces(
        corners: Vec<Point<N, 3>>,
        faces: impl Iterator<Item = (Vector<N, 3>, impl AsRef<[u32]>)>,
    ) -> Option<Self> {
        let mut hull = Self::from_vertices(corners);
        faces.for_each(|(normal, ring)| hull.push_face(normal, ring.as_ref()));
        hull.collect_planes();
        hull.connect()?;
        hull.collect_fans();
        Some(hull)
    }

    /// Renumbers and reorients the edges so that edge `i` joins `ends[i]`, in this order.
    ///
    /// `ends` must contain each edge of the solid exactly once.
    pub(in crate::shape) fn name_edges(&mut self, ends: &[[u32; 2]]) {
        let index_of = |edge: &PolytopeEdge| {
            let [a, b] = edge.vertices;
            let found = ends.iter().position(|&ends| ends == [a, b] || ends == [b, a]);
            found.expect("each edge is one of those given")
        };
        let new_indices: Vec<usize> = self.edges.iter().map(index_of).collect();
        for side in &mut self.loop_sides {
            *side = count32(new_indices[*side as usize]);
        }
        let mut edges = self.edges.clone();
        for (edge, &index) in self.edges.iter().zip(&new_indices) {
            let faces = edge.faces;
            let is_reversed = edge.vertices != ends[index];
            let faces = if is_reversed { [faces[1], faces[0]] } else { faces };
            edges[index] = PolytopeEdge { vertices: ends[index], faces };
        }
        self.edges = edges;
        self.collect_fans();
    }

    /// Computes the edges, indexed by their first occurrence in the loops. `None` unless the sides
    /// pair up.
    fn connect(&mut self) -> Option<()> {
        let sides = self.directed_sides();
        let twins = twins(self.vertices.len(), &sides);
        self.edges.reserve(sides.len() / 2);
        self.loop_sides = vec![NONE; sides.len()];
        for (index, side) in sides.iter().enumerate() {
            let twin = twins[index];
            if twin == NONE || twins[twin as usize] as usize != index {
                return None;
            }
            if self.loop_sides[index] == NONE {
                let edge = count32(self.edges.len());
                let faces = [side.face, sides[twin as usize].face];
                self.edges.push(PolytopeEdge { vertices: [side.from, side.to], faces });
                self.loop_sides[index] = edge;
                self.loop_sides[twin as usize] = edge;
            }
        }
        Some(())
    }

    /// Returns for each entry of the loops the directed side to the next vertex.
    fn directed_sides(&self) -> Vec<DirectedSide> {
        let mut sides = Vec::with_capacity(self.loops.len());
        for (face, of) in (0_u32..).zip(&self.faces) {
            let ring = self.face_vertices(of);
            let next = ring[1..].iter().chain(&ring[..1]);
            sides.extend(ring.iter().zip(next).map(|(&from, &to)| DirectedSide { from, to, face }));
        }
        sides
    }
}

/// Marks a side without a twin in the result of [`twins`], and a side that has no edge yet in
/// `loop_sides`.
const NONE: u32 = u32::MAX;

/// A side of a face, in the direction of the face's loop.
struct DirectedSide {
    from: u32,
    to: u32,
    face: u32,
}

/// Returns for each side the index of a side that runs in the opposite direction; [`NONE`] if there
/// is none. If a side occurs twice, at least one of the two occurrences is not the twin of its
/// twin.
///
/// A side looks for its twin among the sides that leave its end, but only if these are no more than
/// the sides that leave its start; otherwise its twin finds it. On a closed surface this takes
/// linear time: Chiba and Nishizeki, "Arboricity and Subgraph Listing Algorithms" (1985).
fn twins(vertices: usize, sides: &[DirectedSide]) -> Vec<u32> {
    let leaving = (0..).zip(sides).map(|(index, side)| (side.from, [side.to, index]));
    let (starts, leaving) = grouped::<[u32; 2]>(vertices, leaving);
    let around =
        |vertex: u32| starts[vertex as usize] as usize..starts[vertex as usize + 1] as usize;
    let mut twins = vec![NONE; sides.len()];
    for (index, side) in (0..).zip(sides) {
        let back = around(side.to);
        if back.len() <= around(side.from).len()
            && let Some(&[_, twin]) = leaving[back].iter().find(|&&[to, _]| to == side.from)
        {
            twins[index as usize] = twin;
            twins[twin as usize] = index;
        }
    }
    twins
}
