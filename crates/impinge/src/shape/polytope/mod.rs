//! The common core of convex polygons and convex hulls: vertices, faces, edges and who meets whom.

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
/// In 2D the faces are the sides: face `i` leads from vertex `i` to vertex `i + 1`,
/// counter-clockwise, and there are no edges. In 3D the faces are polygons, counter-clockwise
/// seen from outside, and each edge lies between two faces.
///
/// Features are named by their place in [`Self::vertices`], [`Self::edges`] and [`Self::faces`].
/// Finding a support point takes time in proportion to the number of vertices.
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
// What questions about small solids read lies in front and in one piece: among thousands of solids each further
// place is a wait for memory.
#[derive(Clone, PartialEq)]
#[repr(C)]
pub struct Polytope<N: Real, const D: usize> {
    pub(in crate::shape) center: Point<N, D>,
    pub(in crate::shape) reach: N,
    /// That of a ball about the middle which no face cuts.
    pub(in crate::shape) inner_radius: N,
    pub(in crate::shape) vertices: Vec<Point<N, D>>,
    /// The vertices again, eight at a time, coordinate by coordinate; the last one fills the rest.
    pub(in crate::shape) blocks: Blocks<N, D>,
    /// The planes of the faces again, as the vertices in `blocks`.
    pub(in crate::shape) planes: SmallVec<[Planes<N, D>; 1]>,
    /// The vertices by four, for code without vectors.
    pub(in crate::shape) quartets: Quartets<N, D>,
    pub(in crate::shape) faces: Vec<PolytopeFace<N, D>>,
    /// The vertices of all faces, one loop after the other.
    pub(in crate::shape) loops: Vec<u32>,
    /// For each entry of `loops`, the edge (in 2D: the face) that leads to the next vertex.
    pub(in crate::shape) loop_sides: Vec<u32>,
    /// Empty in 2D.
    pub(in crate::shape) edges: Vec<PolytopeEdge>,
    /// The edges (in 2D: the faces) at all vertices, one vertex after the other.
    pub(in crate::shape) fans: Vec<u32>,
    /// Where the fan of each vertex starts, and at last where the last one ends.
    pub(in crate::shape) fan_starts: Vec<u32>,
    /// For each entry of `fans` the unit vector along it, either way; `None` for one of no length.
    pub(in crate::shape) fan_directions: Vec<Option<Vector<N, D>>>,
    pub(in crate::shape) twin: Twin<N, D>,
}

/// A copy of a polytope that pairs share, which know the polytope again by it: made when the first of them asks.
#[derive(Clone, Default)]
pub(in crate::shape) struct Twin<N: Real, const D: usize>(OnceLock<Arc<Polytope<N, D>>>);

/// Whether a copy was asked for is no property of the solid.
impl<N: Real, const D: usize> PartialEq for Twin<N, D> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// How many vertices or faces are looked at side by side.
pub(in crate::shape) const LANES: usize = 8;
/// How many vertices code without vectors looks at: they fit in one register everywhere.
pub(in crate::shape) const QUARTET: usize = 4;

/// Vertices in packets of eight; those of a small solid within it.
type Blocks<N, const D: usize> = SmallVec<[[[N; LANES]; D]; 1]>;
/// Vertices by fours, likewise.
type Quartets<N, const D: usize> = SmallVec<[[[N; QUARTET]; D]; 2]>;

/// The planes of some faces side by side, coordinate by coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Planes<N: Real, const D: usize> {
    pub(crate) normals: [[N; LANES]; D],
    pub(crate) offsets: [N; LANES],
}

/// A flat face.
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
    /// The unit vector out of the solid.
    pub normal: Vector<N, D>,
    /// Every point of the solid has `normal · x ≤ offset`, up to rounding.
    pub offset: N,
    pub(in crate::shape) first: u32,
    pub(in crate::shape) len: u32,
}

impl<N: Real, const D: usize> PolytopeFace<N, D> {
    /// How far a point lies above the face's plane.
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
    /// Its ends: the loop of the first face runs from the first to the second.
    pub vertices: [u32; 2],
    /// The faces on its two sides.
    pub faces: [u32; 2],
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// A copy of the solid that its clones share.
    pub(crate) fn twin(&self) -> &Arc<Self> {
        self.twin.0.get_or_init(|| Arc::new(self.clone()))
    }

    /// The vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Point<N, D>] {
        &self.vertices
    }

    /// The faces.
    #[must_use]
    pub fn faces(&self) -> &[PolytopeFace<N, D>] {
        &self.faces
    }

    /// The edges; none in 2D.
    #[must_use]
    pub fn edges(&self) -> &[PolytopeEdge] {
        &self.edges
    }

    /// The vertices around a face of this solid.
    #[must_use]
    pub fn face_vertices(&self, face: &PolytopeFace<N, D>) -> &[u32] {
        let first = face.first as usize;
        &self.loops[first..first + face.len as usize]
    }

    /// The sides around a face: edges, in 2D the face itself.
    pub(in crate::shape) fn face_sides(&self, face: &PolytopeFace<N, D>) -> &[u32] {
        let first = face.first as usize;
        &self.loop_sides[first..first + face.len as usize]
    }

    /// The vertices, eight at a time, coordinate by coordinate; the last one fills the rest.
    pub(crate) fn blocks(&self) -> &[[[N; LANES]; D]] {
        &self.blocks
    }

    /// The planes of the faces, eight at a time; the last one fills the rest.
    pub(crate) fn planes(&self) -> &[Planes<N, D>] {
        &self.planes
    }

    /// The edges (in 2D: the faces) that end at a vertex.
    pub(in crate::shape) fn fan(&self, vertex: usize) -> &[u32] {
        &self.fans[self.fan_range(vertex)]
    }

    /// The edges (in 2D: the faces) that end at a vertex, and their directions.
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

    /// An edge (in 2D: a face) with its ends and what lies beside it; a side of the plane lies
    /// beside itself.
    pub(in crate::shape) fn side(&self, index: u32) -> PolytopeEdge {
        match self.edges.get(index as usize) {
            Some(edge) => *edge,
            None => {
                let ends = self.face_vertices(&self.faces[index as usize]);
                PolytopeEdge { vertices: [ends[0], ends[1]], faces: [index; 2] }
            }
        }
    }

    /// The name of an edge (in 2D: of a face).
    pub(in crate::shape) fn side_id(index: u32) -> FeatureId {
        FeatureId::flat::<D>(1, index)
    }

    /// The index of the face that a point lies highest above, the first of equals, and how high: positive
    /// exactly if the point is outside.
    pub(crate) fn highest_face(&self, point: &Point<N, D>) -> (u32, N) {
        let highest = polytope_support::plane(Level::new(), &self.planes, point);
        (count32(highest), self.faces[highest].height_of(point))
    }

    /// The index of a vertex farthest along a direction: the first of equals.
    pub(in crate::shape) fn support_vertex(&self, direction: &Vector<N, D>) -> usize {
        if self.blocks.len() > 1 {
            polytope_support::vertex(Level::new(), &self.blocks, direction)
        } else {
            self.support_vertex_of_few(direction)
        }
    }

    /// The same without vectors, which is as fast for few vertices.
    ///
    /// Written for the compiler to keep each array in one register.
    fn support_vertex_of_few(&self, direction: &Vector<N, D>) -> usize {
        let (mut heights, mut places) = (heights(&self.quartets[0], direction), [0_u32; QUARTET]);
        for (place, quartet) in (1_u32..).zip(&self.quartets[1..]) {
            let candidates = self::heights(quartet, direction);
            for lane in 0..QUARTET {
                let is_higher = candidates[lane] > heights[lane];
                heights[lane] = if is_higher { candidates[lane] } else { heights[lane] };
                places[lane] = if is_higher { place } else { places[lane] };
            }
        }
        let index = |lane: usize| places[lane] as usize * QUARTET + lane;
        (1..QUARTET)
            .fold((heights[0], index(0)), |best, lane| {
                let is_tie = heights[lane] == best.0 && index(lane) < best.1;
                if heights[lane] > best.0 || is_tie { (heights[lane], index(lane)) } else { best }
            })
            .1
    }

    /// What [`Self::blocks`] and `quartets` hold.
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

    /// The radius of a ball about the middle that is inside, up to rounding; zero where there is none.
    #[inline]
    pub(crate) fn inner_radius(&self) -> N {
        self.inner_radius
    }

    /// Keeps what follows from the faces once all are known.
    pub(in crate::shape) fn collect_planes(&mut self) {
        self.planes = Self::planes_of(&self.faces);
        let depths = self.faces.iter().map(|face| -face.height_of(&self.center));
        self.inner_radius = max(depths.fold(N::MAX, min), N::ZERO);
    }

    /// What [`Self::planes`] holds.
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

    /// The largest distance of a vertex from the origin.
    pub(in crate::shape) fn reach_of(vertices: &[Point<N, D>]) -> N {
        vertices.iter().fold(N::ZERO, |reach, vertex| max(reach, length_of(&vertex.coords)))
    }
}

/// How far four vertices reach along a direction. (`map` of the standard library keeps the four in one register here.)
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

/// A count of vertices, edges or faces as it is stored.
#[inline]
pub(in crate::shape) fn count32(count: usize) -> u32 {
    u32::try_from(count).expect("a solid has fewer than 2³² parts")
}
