//! Convex hulls in space.

use super::hull_faces::{faces, redundant};
use super::quickhull::Surface;
use super::span::{Scaled, first_four};
use crate::math::{Point, Real};
use crate::shape::{ConvexHull, ShapeError};

/// A convex hull, in terms of the points it was made of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IndexedHull {
    /// The indices of the points that are vertices, ascending.
    pub vertices: Vec<usize>,
    /// The polygons: for each the indices of its vertices, counter-clockwise seen from outside. Each
    /// side of one is, backwards, a side of exactly one other.
    pub faces: Vec<Vec<usize>>,
}

/// How often vertices that add nothing are taken out. Each time no two neighbors go, so this is
/// enough for a row of 2⁸ points on an edge; what is left then are flat angles, not wrong ones.
const ROUNDS: usize = 8;

/// The convex hull of some points.
///
/// Let `u = N::EPSILON · max |coordinate|`, one rounding unit of the points. Points that stick out of
/// all faces by less than 2 u are left out, triangles within 4 u of a plane are merged into one
/// polygon, vertices within 4 u of the segment between two neighbors or of the plane of all their
/// neighbors are taken out. So every point given is in front of no face by more than 32 u, and
/// usually by no more than 4 u; every vertex is one of the points, bit by bit; of points that
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
pub fn convex_hull3<N: Real>(points: &[Point<N, 3>]) -> Result<IndexedHull, ShapeError> {
    let scaled = Scaled::of(points, 4)?;
    let all: Vec<usize> = (0..points.len()).collect();
    let mut step = Step::of(&scaled, all)?;
    for _ in 0..ROUNDS {
        let Some(Ok(next)) = step.without_redundant(&scaled) else { break };
        step = next;
    }
    Ok(step.indexed())
}

/// A hull of some of the points, once it is found.
struct Step {
    /// The points that it was made of.
    named: Vec<usize>,
    faces: Vec<Vec<u32>>,
    /// Which of them are vertices and not redundant.
    needed: Vec<usize>,
    has_redundant: bool,
}

impl Step {
    fn of(scaled: &Scaled<3>, named: Vec<usize>) -> Result<Self, ShapeError> {
        let points = named.iter().map(|&index| scaled.points[index]).collect();
        let sub = Scaled { points, unit: scaled.unit };
        let index_of = |index: usize| u32::try_from(index).expect("a hull of at most 2³² points");
        let first = first_four(&sub)?.map(index_of);
        let numbers: Vec<u32> = (0..named.len()).map(index_of).collect();
        let surface = Surface::grown(&sub.points, &numbers, first, 2.0 * sub.unit);
        let surface = surface.ok_or(ShapeError::Degenerate { dimension: 2 })?;
        let redundant = redundant(&surface, &sub.points, sub.flat());
        let faces = faces(&surface, &sub.points, sub.flat());
        let mut needed: Vec<u32> = surface.facets.iter().flat_map(|facet| facet.corners).collect();
        needed.sort_unstable();
        needed.dedup();
        needed.retain(|vertex| redundant.binary_search(vertex).is_err());
        let needed = needed.into_iter().map(|vertex| named[vertex as usize]).collect();
        Ok(Self { named, faces, needed, has_redundant: !redundant.is_empty() })
    }

    /// The hull of the needed vertices alone, unless that is this one.
    fn without_redundant(&self, scaled: &Scaled<3>) -> Option<Result<Self, ShapeError>> {
        let is_worthwhile = self.has_redundant && self.needed.len() >= 4;
        is_worthwhile.then(|| Self::of(scaled, self.needed.clone()))
    }

    fn indexed(self) -> IndexedHull {
        let name =
            |face: &Vec<u32>| face.iter().map(|&vertex| self.named[vertex as usize]).collect();
        let faces: Vec<Vec<usize>> = self.faces.iter().map(name).collect();
        let mut vertices = faces.concat();
        vertices.sort_unstable();
        vertices.dedup();
        IndexedHull { vertices, faces }
    }
}

impl<N: Real> ConvexHull<N> {
    /// The convex hull of points in any order; see [`convex_hull3`].
    ///
    /// # Errors
    /// For fewer than four points, a coordinate that is not finite, and points that span no volume.
    pub fn try_from_points(points: &[Point<N, 3>]) -> Result<Self, ShapeError> {
        let IndexedHull { vertices, faces } = convex_hull3(points)?;
        let renamed =
            |index: usize| vertices.binary_search(&index).expect("a face has vertices only");
        let faces: Vec<Vec<usize>> =
            faces.into_iter().map(|face| face.into_iter().map(renamed).collect()).collect();
        let corners = vertices.iter().map(|&index| points[index]).collect();
        Self::from_closed_faces(corners, &faces).ok_or(ShapeError::Degenerate { dimension: 2 })
    }
}
