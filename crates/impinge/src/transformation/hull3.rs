//! Convex hulls in 3D.

use super::hull_faces::{FaceRings, faces, redundant};
use super::quickhull::{Facet, HullSurface, at, index_of};
use super::span::{Scaled, first_four};
use crate::math::{Mapped, Point, Real, Vector};
use crate::shape::{ConvexHull, ShapeError};

/// A convex hull as indices of the points from which it was computed.
///
/// ```
/// use impinge::dim3::math::Point;
/// use impinge::dim3::transformation::convex_hull;
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.2, 0.2]];
/// let hull = convex_hull(&corners.map(Point::<f32>::from)).expect("they span a solid");
/// assert_eq!((hull.vertices, hull.faces.len()), (vec![0, 1, 2, 3], 4));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct IndexedHull<N: Real> {
    /// The indices of the points that are vertices, ascending.
    pub vertices: Vec<usize>,
    /// For each face, the indices of its vertices, counter-clockwise seen from outside. Each side
    /// of a face occurs, reversed, in exactly one other face.
    pub faces: Vec<Vec<usize>>,
    /// The outward unit normal of each face.
    pub normals: Vec<Vector<N, 3>>,
}

/// The maximum number of rounds in which redundant vertices are removed; a round never removes two
/// adjacent vertices. Redundant vertices that remain after the last round do no harm: the surface
/// is almost flat there.
const ROUNDS: usize = 8;

/// Returns the convex hull of some points.
///
/// Let `u = N::EPSILON · max |coordinate|`, one rounding unit of the points. Points outside the
/// hull by less than 2 u are left out. Triangles within 4 u of a plane are merged into one polygon.
/// Vertices within 4 u of the segment between two neighbors, or of the plane of all their
/// neighbors, are removed. A face has the normal of its largest triangle. So no given point is in
/// front of a face, measured from the face's highest vertex, by more than 8 u, and usually not by
/// more than 4 u. Where two faces meet at an angle that is itself rounding error, as at the rim of
/// a dish about 100 u deep, the bound is 32 u. Along the normal of a face, its vertices differ in
/// height by at most 8 u. Every vertex is bitwise equal to one of the points; of coinciding points
/// one is used. The faces visible from a point are decided exactly, so no input breaks the
/// algorithm.
///
/// The algorithm is quickhull, with an expected time of O(n log n). The result depends only on the
/// points and their order, and scaling them by a power of two changes no index.
///
/// # Errors
/// If there are fewer than four points, a coordinate is not finite, or the points span no volume:
/// all within 4 u of a point, line or plane ([`ShapeError::Degenerate`] with the dimension 0, 1 or
/// 2).
///
/// ```
/// use impinge::math::Point;
/// use impinge::transformation::convex_hull3;
///
/// let cube: Vec<_> = (0..8_u8)
///     .map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f32::from))
///     .map(Point::<f32, 3>::from)
///     .collect();
/// assert_eq!(convex_hull3(&cube).map(|hull| hull.faces.len()), Ok(6));
/// ```
pub fn convex_hull3<N: Real>(points: &[Point<N, 3>]) -> Result<IndexedHull<N>, ShapeError> {
    let HullFaces { point_indices, faces } = hull_of(points)?;
    let ring = |ring: &[u32]| ring.iter().map(|&vertex| point_indices[vertex as usize]).collect();
    let normals = faces.normals.iter().map(|normal| normal.map(N::lit)).collect();
    Ok(IndexedHull { faces: faces.rings().map(ring).collect(), normals, vertices: point_indices })
}

/// A hull whose faces contain indices into its own list of vertices.
struct HullFaces {
    /// For each vertex, the index of its point, in ascending order.
    point_indices: Vec<usize>,
    faces: FaceRings,
}

/// Computes the hull, and removes redundant vertices in rounds. Ends when there are none, when the
/// remaining vertices would span no volume, or after [`ROUNDS`] rounds.
///
/// # Errors
/// If the points span no volume.
fn hull_of<N: Real>(points: &[Point<N, 3>]) -> Result<HullFaces, ShapeError> {
    let mut grown = Grown::of(&Scaled::of(points, 4)?)?;
    for _ in 0..ROUNDS {
        let redundant = redundant(&grown.facets, &grown.vertices);
        if redundant.is_empty() {
            break;
        }
        let Ok(next) = grown.without(&redundant) else { break };
        grown = next;
    }
    let mut faces = faces(&grown.facets, &grown.vertices);
    let (used, new_indices) = numbered(grown.point_indices.len(), faces.corners.iter().copied());
    faces.corners.iter_mut().for_each(|corner| *corner = new_indices[at(*corner)]);
    let point_indices = used.into_iter().map(|vertex| grown.point_indices[vertex]).collect();
    Ok(HullFaces { point_indices, faces })
}

/// The hull of some points as a closed surface of triangles, before triangles are merged into
/// faces.
struct Grown {
    /// For each vertex, the index of its point, in ascending order.
    point_indices: Vec<usize>,
    /// The positions of the vertices.
    vertices: Scaled<3>,
    facets: Vec<Facet>,
}

impl Grown {
    fn of(scaled: &Scaled<3>) -> Result<Self, ShapeError> {
        let first = first_four(scaled)?.mapped(index_of);
        let facets = HullSurface::grown(&scaled.points, first, 2.0 * scaled.unit);
        let mut facets = facets.ok_or(ShapeError::Degenerate { dimension: 2 })?;
        let corners = facets.iter().flat_map(|facet| facet.corners);
        let (point_indices, new_indices) = numbered(scaled.points.len(), corners);
        for facet in &mut facets {
            facet.corners = facet.corners.mapped(|corner| new_indices[at(corner)]);
        }
        let points = point_indices.iter().map(|&index| scaled.points[index]).collect();
        Ok(Self { point_indices, vertices: Scaled { points, unit: scaled.unit }, facets })
    }

    /// Returns the hull without the vertices in `redundant`.
    ///
    /// # Errors
    /// If too few points are left to span a volume.
    fn without(&self, redundant: &[u32]) -> Result<Self, ShapeError> {
        let is_kept = |&vertex: &usize| redundant.binary_search(&index_of(vertex)).is_err();
        let kept: Vec<usize> = (0..self.point_indices.len()).filter(is_kept).collect();
        let points = kept.iter().map(|&vertex| self.vertices.points[vertex]).collect();
        let mut next = Self::of(&Scaled { points, unit: self.vertices.unit })?;
        next.point_indices.iter_mut().for_each(|index| *index = self.point_indices[kept[*index]]);
        Ok(next)
    }
}

/// Returns the used vertices in ascending order, and for each old vertex its index among the used
/// vertices; 0 if it is unused.
fn numbered(count: usize, corners: impl Iterator<Item = u32>) -> (Vec<usize>, Vec<u32>) {
    let (mut new_indices, mut used) = (vec![0; count], Vec::with_capacity(count));
    corners.for_each(|corner| new_indices[at(corner)] = 1);
    for (vertex, index) in new_indices.iter_mut().enumerate().filter(|(_, index)| **index == 1) {
        *index = index_of(used.len());
        used.push(vertex);
    }
    (used, new_indices)
}

impl<N: Real> ConvexHull<N> {
    /// Returns the convex hull of points in any order; see [`convex_hull3`].
    ///
    /// # Errors
    /// If there are fewer than four points, a coordinate is not finite, or the points span no
    /// volume.
    pub fn try_from_points(points: &[Point<N, 3>]) -> Result<Self, ShapeError> {
        let HullFaces { point_indices, faces } = hull_of(points)?;
        let corners = point_indices.iter().map(|&index| points[index]).collect();
        let normals = faces.normals.iter().map(|normal| normal.map(N::lit));
        let solid = Self::from_closed_faces(corners, normals.zip(faces.rings()));
        solid.ok_or(ShapeError::Degenerate { dimension: 2 })
    }
}
