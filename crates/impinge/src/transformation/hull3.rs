//! Convex hulls in 3D.

use super::hull_faces::{FaceRings, faces, redundant};
use super::quickhull::{Facet, HullSurface, at, index_of};
use super::span::{Scaled, first_four};
use crate::math::{Mapped, Point, Real, Vector};
use crate::shape::{ConvexHull, ShapeError};

/// A convex hull as indices of the points it was computed from.
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
    /// The polygons: for each the indices of its vertices, counter-clockwise seen from outside.
    /// Each side of one is, reversed, a side of exactly one other.
    pub faces: Vec<Vec<usize>>,
    /// The outward unit normal of each face.
    pub normals: Vec<Vector<N, 3>>,
}

/// The maximum number of times that redundant vertices are removed. No two neighbours are removed
/// at once; vertices left after the last round have flat angles, not wrong ones.
const ROUNDS: usize = 8;

/// Returns the convex hull of some points.
///
/// Let `u = N::EPSILON · max |coordinate|`, one rounding unit of the points. Points that are
/// outside by less than 2 u are left out, triangles within 4 u of a plane are merged into one
/// polygon, vertices within 4 u of the segment between two neighbors or of the plane of all their
/// neighbors are removed. A face has the normal of its largest triangle. So every given point is in
/// front of no face, measured from its highest vertex, by more than 8 u, and usually by no more
/// than 4 u. Where two faces meet at an angle that is itself pure rounding, as at the rim of a dish
/// some 100 u deep, the bound is 32 u. No vertex of a face lies lower than the highest by more than
/// 8 u; every vertex is one of the points, bit by bit; of coinciding points one is used. The faces
/// visible from a point are decided exactly, so no input breaks the algorithm.
///
/// Expected time is O(n log n), with a quickhull. The result depends on the points and their order
/// only, and scaling them by a power of two changes nothing.
///
/// # Errors
/// For fewer than four points, a coordinate that is not finite, or points that span no volume: all
/// within 4 u of a point, line or plane ([`ShapeError::Degenerate`] with dimension 0, 1 or 2).
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
    let HullFaces { named, faces } = hull_of(points)?;
    let ring = |ring: &[u32]| ring.iter().map(|&vertex| named[vertex as usize]).collect();
    let normals = faces.normals.iter().map(|normal| normal.map(N::lit)).collect();
    Ok(IndexedHull { faces: faces.rings().map(ring).collect(), normals, vertices: named })
}

/// A hull in terms of its own vertices.
struct HullFaces {
    /// The index of the point of each vertex, ascending.
    named: Vec<usize>,
    faces: FaceRings,
}

/// Removes redundant vertices until there are none, or too few would be left.
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
    let (used, places) = numbered(grown.named.len(), faces.corners.iter().copied());
    faces.corners.iter_mut().for_each(|corner| *corner = places[at(*corner)]);
    let named = used.into_iter().map(|vertex| grown.named[vertex]).collect();
    Ok(HullFaces { named, faces })
}

/// The hull of some points, as triangles.
struct Grown {
    /// The index of the point of each vertex, ascending.
    named: Vec<usize>,
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
        let (named, places) = numbered(scaled.points.len(), corners);
        for facet in &mut facets {
            facet.corners = facet.corners.mapped(|corner| places[at(corner)]);
        }
        let points = named.iter().map(|&index| scaled.points[index]).collect();
        Ok(Self { named, vertices: Scaled { points, unit: scaled.unit }, facets })
    }

    /// The hull without some vertices.
    fn without(&self, redundant: &[u32]) -> Result<Self, ShapeError> {
        let is_kept = |&vertex: &usize| redundant.binary_search(&index_of(vertex)).is_err();
        let kept: Vec<usize> = (0..self.named.len()).filter(is_kept).collect();
        let points = kept.iter().map(|&vertex| self.vertices.points[vertex]).collect();
        let mut next = Self::of(&Scaled { points, unit: self.vertices.unit })?;
        next.named.iter_mut().for_each(|name| *name = self.named[kept[*name]]);
        Ok(next)
    }
}

/// Returns the used vertices, ascending, and the index of each among them.
fn numbered(count: usize, corners: impl Iterator<Item = u32>) -> (Vec<usize>, Vec<u32>) {
    let (mut places, mut used) = (vec![0; count], Vec::with_capacity(count));
    corners.for_each(|corner| places[at(corner)] = 1);
    for (vertex, place) in places.iter_mut().enumerate().filter(|(_, place)| **place == 1) {
        *place = index_of(used.len());
        used.push(vertex);
    }
    (used, places)
}

impl<N: Real> ConvexHull<N> {
    /// The convex hull of points in any order; see [`convex_hull3`].
    ///
    /// # Errors
    /// For fewer than four points, a coordinate that is not finite, and points that span no volume.
    pub fn try_from_points(points: &[Point<N, 3>]) -> Result<Self, ShapeError> {
        let HullFaces { named, faces } = hull_of(points)?;
        let corners = named.iter().map(|&index| points[index]).collect();
        let normals = faces.normals.iter().map(|normal| normal.map(N::lit));
        let solid = Self::from_closed_faces(corners, normals.zip(faces.rings()));
        solid.ok_or(ShapeError::Degenerate { dimension: 2 })
    }
}
