//! Convex polyhedra, in 3D.

use core::ops::Deref;

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::error::or_panic;
use crate::shape::scale::Scale;
use crate::shape::{Geometry, Kind, Polytope, ScaleError, Shape, ShapeHandle};

/// The convex hull of points that span a volume.
///
/// Vertices are in the order in which the points were given. Faces are polygons, counter-clockwise
/// seen from outside. All methods of [`Polytope`] are available.
///
/// ```
/// use impinge::dim3::math::Point;
/// use impinge::dim3::shape::ConvexHull;
///
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1, 0.1, 0.1]];
/// let hull = ConvexHull::from_points(&points.map(Point::<f32>::from));
/// assert_eq!((hull.vertices().len(), hull.faces().len()), (4, 4), "one point lies inside");
/// ```
#[derive(Clone, PartialEq)]
pub struct ConvexHull<N: Real> {
    polytope: Polytope<N, 3>,
}

impl<N: Real> ConvexHull<N> {
    /// Returns the convex hull of points in any order; see [`Self::try_from_points`].
    ///
    /// # Panics
    /// If [`Self::try_from_points`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn from_points(points: &[Point<N, 3>]) -> Self {
        or_panic(Self::try_from_points(points))
    }

    /// Returns the solid with the given corners and faces; a face has an outward unit normal and a
    /// loop of at least three corners. `None` unless the faces close the surface.
    pub(crate) fn from_closed_faces(
        corners: Vec<Point<N, 3>>,
        faces: impl Iterator<Item = (Vector<N, 3>, impl AsRef<[u32]>)>,
    ) -> Option<Self> {
        Some(Self { polytope: Polytope::<N, 3>::from_closed_faces(corners, faces)? })
    }

    /// Returns the vertices, edges and faces of the solid and their adjacency.
    #[must_use]
    pub const fn polytope(&self) -> &Polytope<N, 3> {
        &self.polytope
    }
}

impl<N: Real> Deref for ConvexHull<N> {
    type Target = Polytope<N, 3>;

    fn deref(&self) -> &Self::Target {
        &self.polytope
    }
}

impl<N: Real> Shape<N, 3> for ConvexHull<N> {
    fn geometry(&self) -> Geometry<'_, N, 3> {
        Geometry(Kind::Polytope(&self.polytope))
    }

    fn local_aabb(&self) -> Aabb<N, 3> {
        self.polytope.aabb_at(&Pose::identity())
    }

    fn aabb(&self, pose: &Pose<N, 3>) -> Aabb<N, 3> {
        self.polytope.aabb_at(pose)
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, 3> {
        self.polytope.bounding_sphere()
    }

    fn scaled(&self, scale: &Vector<N, 3>) -> Result<ShapeHandle<N, 3>, ScaleError> {
        let scale = Scale::try_new(scale)?;
        let corners = scale.corners(self.polytope.vertices())?;
        let faces = self.polytope.faces();
        let mut rings: Vec<_> =
            faces.iter().map(|face| self.polytope.face_vertices(face).to_vec()).collect();
        if scale.is_mirror() {
            rings.iter_mut().for_each(|ring| ring.reverse());
        }
        let normals = faces.iter().map(|face| scale.normal(&face.normal));
        let normals = normals.collect::<Result<Vec<_>, _>>()?;
        let scaled = Self::from_closed_faces(corners, normals.into_iter().zip(&rings));
        Ok(ShapeHandle::new(scaled.expect("its faces are those of a closed solid")))
    }
}
