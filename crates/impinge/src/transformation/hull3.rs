//! Convex hulls in 3D.

use super::hull_faces::{HullFace, faces, redundant};
use super::quickhull::{Facet, HullSurface};
use super::span::{Scaled, first_four};
use crate::math::{Point, Real, Vector};
use crate::shape::{ConvexHull, ShapeError};

/// A convex hull, in terms of the points it was made of.
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
    /// The polygons: for each the indices of its vertices, counter-clockwise seen from outside. Each
    /// side of one is, backwards, a side of exactly one other.
    pub faces: Vec<Vec<usize>>,
    /// The outward unit normal of each face.
    pub normals: Vec<Vector<N, 3>>,
}

/// How often vertices that add nothing are taken out. Each time no two neighbors go; what is left
/// after the last are flat angles, not wrong ones.
const ROUNDS: usize = 8;

/// The convex hull of some points.
///
/// Let `u = N::EPSILON · max |coordinate|`, one rounding unit of the points. Points that are
/// outside by less than 2 u are left out, triangles within 4 u of a plane are merged into one
/// polygon, vertices within 4 u of the segment between two neighbors or of the plane of all their
/// neighbors are taken out. A face has the normal of the largest triangle in it. So every point given is in
/// front of no face, taken at its highest vertex, by more than 8 u, and usually by no more than 4 u;
/// where two faces meet at an angle that is itself all rounding, as at the rim of a dish some 100 u
/// deep, by up to 32 u;
/// no vertex of a face lies lower than the highest by more than 8 u; every vertex is one of the points, bit by bit; of points that
/// coincide one is named. Which faces a point sees is decided exactly, so no input leads astray.
///
/// Expected time is O(n log n), with a quickhull. The answer depends on the points and their order
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
    hull_of(&Scaled::of(points, 4)?)
}

/// Takes redundant vertices out until there are none or nothing would be left.
fn hull_of<N: Real>(scaled: &Scaled<3>) -> Result<IndexedHull<N>, ShapeError> {
    let mut grown = Grown::of(scaled, (0..scaled.points.len()).collect())?;
    for _ in 0..ROUNDS {
        let redundant = redundant(&grown.facets, &grown.points);
        if redundant.is_empty() {
            break;
        }
        let Ok(next) = Grown::of(scaled, grown.without(&redundant)) else { break };
        grown = next;
    }
    Ok(grown.indexed())
}

/// The hull of some of the points, as triangles.
struct Grown {
    /// The points that it was made of, by their indices.
    named: Vec<usize>,
    /// Their positions.
    points: Scaled<3>,
    facets: Vec<Facet>,
}

impl Grown {
    fn of(scaled: &Scaled<3>, named: Vec<usize>) -> Result<Self, ShapeError> {
        let points = named.iter().map(|&index| scaled.points[index]).collect();
        let points = Scaled { points, unit: scaled.unit };
        let index_of = |index: usize| u32::try_from(index).expect("a hull of at most 2³² points");
        let first = first_four(&points)?.map(index_of);
        let facets = HullSurface::grown(&points.points, first, 2.0 * scaled.unit);
        let facets = facets.ok_or(ShapeError::Degenerate { dimension: 2 })?;
        Ok(Self { named, points, facets })
    }

    /// The other vertices.
    fn without(&self, redundant: &[u32]) -> Vec<usize> {
        let mut needed: Vec<u32> = self.facets.iter().flat_map(|facet| facet.corners).collect();
        needed.sort_unstable();
        needed.dedup();
        needed.retain(|vertex| redundant.binary_search(vertex).is_err());
        needed.into_iter().map(|vertex| self.named[vertex as usize]).collect()
    }

    fn indexed<N: Real>(&self) -> IndexedHull<N> {
        let name = |vertex: &u32| self.named[*vertex as usize];
        let (mut loops, mut normals) = (Vec::<Vec<usize>>::new(), Vec::new());
        for HullFace { normal, ring } in faces(&self.facets, &self.points) {
            loops.push(ring.iter().map(name).collect());
            normals.push(normal.map(N::lit));
        }
        let mut vertices = loops.concat();
        vertices.sort_unstable();
        vertices.dedup();
        IndexedHull { vertices, faces: loops, normals }
    }
}

impl<N: Real> ConvexHull<N> {
    /// The convex hull of points in any order; see [`convex_hull3`].
    ///
    /// # Errors
    /// For fewer than four points, a coordinate that is not finite, and points that span no volume.
    pub fn try_from_points(points: &[Point<N, 3>]) -> Result<Self, ShapeError> {
        let IndexedHull { vertices, faces, normals } = convex_hull3(points)?;
        let place = |index: &usize| vertices.binary_search(index).ok();
        let rings: Option<Vec<Vec<usize>>> =
            faces.iter().map(|face| face.iter().map(place).collect()).collect();
        let corners = vertices.iter().map(|&index| points[index]).collect();
        let solid = rings.and_then(|rings| Self::from_closed_faces(corners, &normals, &rings));
        solid.ok_or(ShapeError::Degenerate { dimension: 2 })
    }
}
