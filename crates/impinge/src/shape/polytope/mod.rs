//! The common core of convex polygons and convex hulls: vertices, faces, edges and their adjacency.
//!
//! ```text
//! faces[f]       normal, offset, first, len
//! loops          | v0 v2 v1 | v1 v2 v5 v4 | …      `len` vertices around a face, from `first`
//! loop_sides     | e0 e1 e2 | e1 e3 e4 e5 | …      side (edge; in 2D face) from each to the next
//! fan_starts[v]  | 0 | 3 | …                       one entry per vertex, then the end
//! fans           | e0 e2 e6 | e2 e1 e5 | …         sides that end at each vertex
//!
//! blocks[b][axis][lane]    coordinate `axis` of vertex 8 b + lane; the last vertex fills the rest
//! ```

pub(crate) mod build;
pub(crate) mod check;
pub(crate) mod convex_hull;
pub(crate) mod convex_polygon;
pub(crate) mod feature;
pub(crate) mod support;

use core::ops::Range;
use std::sync::{Arc, OnceLock};

use smallvec::SmallVec;

use crate::math::simd::Level;
use crate::math::{Point, Real, Vector, filled, max, min};
use crate::shape::FeatureId;
use crate::shape::polytope::support as polytope_support;
use crate::shape::solids::segment::length_of;

/// A convex solid with flat faces, in any dimension.
///
/// In 2D the faces are the sides: face `i` leads from vertex `i` to the next, counter-clockwise,
/// and there are no edges. In 3D the faces are polygons, counter-clockwise seen from outside, and
/// each edge lies between two faces.
///
/// The id of a feature has its index in [`Self::vertices`], [`Self::edges`] or [`Self::faces`].
/// Finding a support point takes linear time in the number of vertices.
///
/// ```
/// use impinge::dim3::math::Point;
/// use impinge::dim3::shape::ConvexHull;
///
/// let cube: Vec<Point<f32>> =
///     (0..8_u8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f32::from).into()).collect();
/// let hull = ConvexHull::<f32>::from_points(&cube);
/// let top = hull.faces().iter().find(|face| face.normal.y > 0.5).expect("a cube has one");
/// let corners = hull.face_vertices(top);
/// assert!(corners.iter().all(|&corner| hull.vertices()[corner as usize].y == 1.0));
/// ```
// The fields that queries of small solids read come first and are stored inline: among thousands of
// solids each allocation is another cache miss.
#[derive(Clone, PartialEq)]
#[repr(C)]
pub struct Polytope<N: Real, const D: usize> {
    pub(in crate::shape) center: Point<N, D>,
    pub(in crate::shape) reach: N,
    /// The radius of the largest ball about `center` inside all face planes; zero if there is none.
    pub(in crate::shape) inner_radius: N,
    pub(in crate::shape) vertices: Vec<Point<N, D>>,
    /// The vertices in packets of 8, one row per axis; the last vertex pads the last packet.
    pub(in crate::shape) blocks: Blocks<N, D>,
    /// The planes of the faces in packets of 8; the last face pads the last packet.
    pub(in crate::shape) planes: SmallVec<[Planes<N, D>; 1]>,
    /// The vertices in packets of 4, for code without SIMD.
    pub(in crate::shape) quartets: Quartets<N, D>,
    pub(in crate::shape) faces: Vec<PolytopeFace<N, D>>,
    /// The vertex indices around each face, one loop after the other.
    pub(in crate::shape) loops: Vec<u32>,
    /// For each entry of `loops`, the edge (in 2D: the face) that leads to the next vertex.
    pub(in crate::shape) loop_sides: Vec<u32>,
    /// The edges of the solid; empty in 2D.
    pub(in crate::shape) edges: Vec<PolytopeEdge>,
    /// The edges (in 2D: the faces) that end at each vertex, one vertex after the other.
    pub(in crate::shape) fans: Vec<u32>,
    /// For each vertex, the index in `fans` where its fan starts; the last entry is the length of
    /// `fans`.
    pub(in crate::shape) fan_starts: Vec<u32>,
    /// For each entry of `fans`, the unit vector along that side, in either direction; `None` if
    /// the side has no length.
    pub(in crate::shape) fan_directions: Vec<Option<Vector<N, D>>>,
    pub(in crate::shape) twin: Twin<N, D>,
}

/// A copy of the polytope for the caches of pairs, made on first use. Later clones of the polytope
/// share the copy, so that a pair recognizes the polytope by the pointer.
#[derive(Clone, Default)]
pub(in crate::shape) struct Twin<N: Real, const D: usize>(OnceLock<Arc<Polytope<N, D>>>);

/// Always equal: the copy is a cache, not a property of the solid.
impl<N: Real, const D: usize> PartialEq for Twin<N, D> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The number of vertices or faces in a packet.
pub(in crate::shape) const LANES: usize = 8;
/// The number of vertices in a packet for code without SIMD; each row fits one register on every
/// target.
pub(in crate::shape) const QUARTET: usize = 4;

/// Vertices in packets of 8, one row per axis; a single packet is stored inline, more on the heap.
type Blocks<N, const D: usize> = SmallVec<[[[N; LANES]; D]; 1]>;
/// Vertices in packets of 4, one row per axis; up to two packets are stored inline, more on the
/// heap.
type Quartets<N, const D: usize> = SmallVec<[[[N; QUARTET]; D]; 2]>;

/// The planes of 8 faces, one row of normals per axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Planes<N: Real, const D: usize> {
    pub(crate) normals: [[N; LANES]; D],
    pub(crate) offsets: [N; LANES],
}

/// A flat face of a polytope.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::ConvexPolygon;
///
/// let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point::<f64>::from);
/// let square = ConvexPolygon::new(&corners);
/// let right = &square.faces()[1];
/// assert_eq!((right.normal.x, right.offset), (1.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolytopeFace<N: Real, const D: usize> {
    /// The outward unit normal.
    pub normal: Vector<N, D>,
    /// Every point of the solid has `normal · x ≤ offset`, up to rounding.
    pub offset: N,
    pub(in crate::shape) first: u32,
    pub(in crate::shape) len: u32,
}

impl<N: Real, const D: usize> PolytopeFace<N, D> {
    /// Returns the signed distance of a point from the face's plane, positive outside.
    pub(crate) fn height_of(&self, point: &Point<N, D>) -> N {
        self.normal.dot(&point.coords) - self.offset
    }
}

/// An edge between two faces, in 3D.
///
/// ```
/// use impinge::dim3::math::Point;
/// use impinge::dim3::shape::ConvexHull;
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let hull = ConvexHull::from_points(&corners.map(Point::<f32>::from));
/// assert_eq!(hull.edges().len(), 6);
/// assert!(hull.edges().iter().all(|edge| edge.faces[0] != edge.faces[1]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PolytopeEdge {
    /// The vertices at its ends: the loop of `faces[0]` traverses the edge from the first to the
    /// second.
    pub vertices: [u32; 2],
    /// The two faces that meet at the edge.
    pub faces: [u32; 2],
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// Returns a copy of the solid. The copy is made on first use, and clones made later share it.
    pub(crate) fn twin(&self) -> &Arc<Self> {
        self.twin.0.get_or_init(|| Arc::new(self.clone()))
    }

    /// Returns the vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Point<N, D>] {
        &self.vertices
    }

    /// Returns the faces.
    #[must_use]
    pub fn faces(&self) -> &[PolytopeFace<N, D>] {
        &self.faces
    }

    /// Returns the edges; none in 2D.
    #[must_use]
    pub fn edges(&self) -> &[PolytopeEdge] {
        &self.edges
    }

    /// Returns the vertex indices around a face, which must belong to this solid.
    #[must_use]
    pub fn face_vertices(&self, face: &PolytopeFace<N, D>) -> &[u32] {
        let first = face.first as usize;
        &self.loops[first..first + face.len as usize]
    }

    /// Returns the sides around a face: edges, or in 2D the face itself, once for each of its two
    /// vertices.
    pub(in crate::shape) fn face_sides(&self, face: &PolytopeFace<N, D>) -> &[u32] {
        let first = face.first as usize;
        &self.loop_sides[first..first + face.len as usize]
    }

    /// Returns the vertices in packets of 8, one row per axis; the last vertex pads the last
    /// packet.
    pub(crate) fn blocks(&self) -> &[[[N; LANES]; D]] {
        &self.blocks
    }

    /// Returns the planes of the faces in packets of 8; the last face pads the last packet.
    pub(crate) fn planes(&self) -> &[Planes<N, D>] {
        &self.planes
    }

    /// Returns the edges (in 2D: the faces) that end at a vertex.
    pub(in crate::shape) fn fan(&self, vertex: usize) -> &[u32] {
        &self.fans[self.fan_range(vertex)]
    }

    /// Returns the edges (in 2D: the faces) that end at a vertex, and their directions.
    pub(in crate::shape) fn fan_along(
        &self,
        vertex: usize,
    ) -> impl Iterator<Item = (u32, &Option<Vector<N, D>>)> {
        let range = self.fan_range(vertex);
        self.fans[range.clone()].iter().copied().zip(&self.fan_directions[range])
    }

    fn fan_range(&self, vertex: usize) -> Range<usize> {
        self.fan_starts[vertex] as usize..self.fan_starts[vertex + 1] as usize
    }

    /// Returns an edge with its ends and its two faces. In 2D returns a face as an edge; both
    /// entries of `faces` are then the face itself.
    pub(in crate::shape) fn side(&self, index: u32) -> PolytopeEdge {
        match self.edges.get(index as usize) {
            Some(edge) => *edge,
            None => {
                let ends = self.face_vertices(&self.faces[index as usize]);
                PolytopeEdge { vertices: [ends[0], ends[1]], faces: [index; 2] }
            }
        }
    }

    /// Returns the id of an edge (in 2D: of a face).
    pub(in crate::shape) fn side_id(index: u32) -> FeatureId {
        FeatureId::flat::<D>(1, index)
    }

    /// Returns the index of the face over which `point` has the greatest signed height, the first
    /// if there are several, and that height. The height is positive if and only if the point is
    /// outside, up to rounding.
    pub(crate) fn highest_face(&self, point: &Point<N, D>) -> (u32, N) {
        let highest = polytope_support::plane(Level::new(), &self.planes, point);
        (count32(highest), self.faces[highest].height_of(point))
    }

    /// Returns the index of a vertex farthest along a direction, the first if there are several.
    pub(in crate::shape) fn support_vertex(&self, direction: &Vector<N, D>) -> usize {
        if self.blocks.len() > 1 {
            polytope_support::vertex(Level::new(), &self.blocks, direction)
        } else {
            self.support_vertex_of_few(direction)
        }
    }

    /// Implements [`Self::support_vertex`] without SIMD, which is as fast for few vertices.
    ///
    /// The loop is written so that the compiler keeps each array in one register.
    fn support_vertex_of_few(&self, direction: &Vector<N, D>) -> usize {
        let (mut heights, mut best_quartets) =
            (heights(&self.quartets[0], direction), [0_u32; QUARTET]);
        for (quartet_index, quartet) in (1_u32..).zip(&self.quartets[1..]) {
            let candidates = self::heights(quartet, direction);
            for lane in 0..QUARTET {
                let is_higher = candidates[lane] > heights[lane];
                heights[lane] = if is_higher { candidates[lane] } else { heights[lane] };
                best_quartets[lane] = if is_higher { quartet_index } else { best_quartets[lane] };
            }
        }
        let index = |lane: usize| best_quartets[lane] as usize * QUARTET + lane;
        (1..QUARTET)
            .fold((heights[0], index(0)), |best, lane| {
                let is_tie = heights[lane] == best.0 && index(lane) < best.1;
                if heights[lane] > best.0 || is_tie { (heights[lane], index(lane)) } else { best }
            })
            .1
    }

    /// Packs vertices in the layout of [`Self::blocks`] (`COUNT` is 8) or of `quartets` (4).
    pub(in crate::shape) fn blocks_of<Blocks, const COUNT: usize>(
        vertices: &[Point<N, D>],
    ) -> Blocks
    where
        Blocks: FromIterator<[[N; COUNT]; D]>,
    {
        let block = |some: &[Point<N, D>]| {
            let last = some.len() - 1;
            filled(|axis| filled(|lane| some[if lane < last { lane } else { last }][axis]))
        };
        vertices.chunks(COUNT).map(block).collect()
    }

    /// Returns the radius of a ball about the centre that lies inside the solid, up to rounding;
    /// zero if there is none.
    #[inline]
    pub(crate) fn inner_radius(&self) -> N {
        self.inner_radius
    }

    /// Computes `planes` and `inner_radius` from the finished faces.
    pub(in crate::shape) fn collect_planes(&mut self) {
        self.planes = Self::planes_of(&self.faces);
        let depths = self.faces.iter().map(|face| -face.height_of(&self.center));
        self.inner_radius = max(depths.fold(N::MAX, min), N::ZERO);
    }

    /// Packs planes in the layout of [`Self::planes`].
    pub(in crate::shape) fn planes_of(faces: &[PolytopeFace<N, D>]) -> SmallVec<[Planes<N, D>; 1]> {
        let block = |some: &[PolytopeFace<N, D>]| {
            let last = some.len() - 1;
            let at = |lane: usize| &some[if lane < last { lane } else { last }];
            Planes {
                normals: filled(|axis| filled(|lane| at(lane).normal[axis])),
                offsets: filled(|lane| at(lane).offset),
            }
        };
        faces.chunks(LANES).map(block).collect()
    }

    /// Returns the largest distance of a vertex from the origin.
    pub(in crate::shape) fn reach_of(vertices: &[Point<N, D>]) -> N {
        vertices.iter().fold(N::ZERO, |reach, vertex| max(reach, length_of(&vertex.coords)))
    }
}

/// Returns the heights of 4 vertices along a direction. (`map` of the standard library keeps the 4
/// numbers in one register here.)
#[inline]
fn heights<N: Real, const D: usize>(
    quartet: &[[N; QUARTET]; D],
    direction: &Vector<N, D>,
) -> [N; QUARTET] {
    let mut sums = quartet[0].map(|x| x * direction[0]);
    for (axis, coordinates) in quartet.iter().enumerate().skip(1) {
        for (sum, coordinate) in sums.iter_mut().zip(coordinates) {
            *sum += *coordinate * direction[axis];
        }
    }
    sums
}

/// Converts a count or an index of vertices, edges or faces to its stored type.
#[inline]
pub(in crate::shape) fn count32(count: usize) -> u32 {
    u32::try_from(count).expect("a solid has fewer than 2³² parts")
}
