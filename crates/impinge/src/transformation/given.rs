//! Convex polyhedra with given faces, which are checked against the hull of their points.

use crate::math::{Point, Real, Vector, max, max_component};
use crate::shape::{ConvexHull, ShapeError};

/// The largest permitted depth of a given face below the surface of the hull, measured at the mean
/// of its corners, in epsilons of the largest coordinate. It allows for flat faces whose corners
/// are rounded.
const SLACK: f64 = 64.0;

impl<N: Real> ConvexHull<N> {
    /// Returns the solid with the given corners and faces; see [`Self::try_new`].
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new<F: AsRef<[u32]>>(points: &[Point<N, 3>], faces: &[F]) -> Self {
        match Self::try_new(points, faces) {
            Ok(hull) => hull,
            Err(error) => panic!("{error}"),
        }
    }

    /// Builds the solid with the given corners and faces. Each face is a polygon, given by the
    /// indices of its corners in order, in either direction.
    ///
    /// The hull is computed from the points, as by [`Self::try_from_points`]: coplanar faces become
    /// one, and points that are not corners are left out, so vertices and faces get new indices.
    /// The given faces are only checked: the mean of the corners of each given face must lie on the
    /// hull, within 64 epsilon of the largest coordinate, and each side must belong to exactly two
    /// faces.
    ///
    /// The cost is the cost of the hull, plus one pass over all faces of the hull for each given
    /// face.
    ///
    /// ```
    /// use impinge::dim3::math::Point;
    /// use impinge::dim3::shape::{ConvexHull, ShapeError};
    ///
    /// let corners: Vec<Point<f32>> =
    ///     (0..8_u8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f32::from).into()).collect();
    /// let mut quads = vec![[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    /// let cube = ConvexHull::new(&corners, &quads);
    /// assert_eq!((cube.vertices().len(), cube.faces().len(), cube.edges().len()), (8, 6, 12));
    ///
    /// quads.pop();
    /// assert!(matches!(ConvexHull::try_new(&corners, &quads), Err(ShapeError::NotClosed { .. })));
    /// ```
    ///
    /// # Errors
    /// If a face has fewer than three corners or refers to a point that does not exist; if a side
    /// does not belong to exactly two faces; if a face is not on the hull, as for solids that are
    /// not convex; and if [`Self::try_from_points`] returns an error.
    pub fn try_new<F: AsRef<[u32]>>(
        points: &[Point<N, 3>],
        faces: &[F],
    ) -> Result<Self, ShapeError> {
        check_corners(points.len(), faces)?;
        check_closed(faces)?;
        let hull = Self::try_from_points(points)?;
        let size = points.iter().map(|point| max_component(&point.coords)).fold(N::ZERO, max);
        let lowest = -N::lit(SLACK) * N::EPSILON * size;
        let is_on_hull = |face: &F| {
            let (_, height) = hull.highest_face(&middle(points, face.as_ref()));
            height >= lowest
        };
        match faces.iter().position(|face| !is_on_hull(face)) {
            // If the mean of some points of a convex set is on the boundary of the set, all of
            // these points are on one supporting plane, and so on the boundary.
            Some(face) => Err(ShapeError::FaceNotOnHull { face }),
            None => Ok(hull),
        }
    }
}

/// Checks that faces have at least three corners, and that all corner indices are valid.
fn check_corners<F: AsRef<[u32]>>(points: usize, faces: &[F]) -> Result<(), ShapeError> {
    for (face, corners) in faces.iter().map(AsRef::as_ref).enumerate() {
        if corners.len() < 3 {
            return Err(ShapeError::TooFewPoints { given: corners.len(), needed: 3 });
        }
        if let Some(&point) = corners.iter().find(|&&point| point as usize >= points) {
            return Err(ShapeError::NoSuchPoint { face, point, points });
        }
    }
    Ok(())
}

/// Checks that each side belongs to exactly two faces.
fn check_closed<F: AsRef<[u32]>>(faces: &[F]) -> Result<(), ShapeError> {
    let mut sides = Vec::new();
    for (face, corners) in faces.iter().map(AsRef::as_ref).enumerate() {
        let next = corners.iter().cycle().skip(1);
        sides.extend(corners.iter().zip(next).map(|(&a, &b)| ([a.min(b), a.max(b)], face)));
    }
    sides.sort_unstable();
    let alone = sides.chunk_by(|a, b| a.0 == b.0).find(|same| same.len() != 2);
    match alone {
        Some(same) => Err(ShapeError::NotClosed { face: same[0].1 }),
        None => Ok(()),
    }
}

/// Returns the mean of the corners of a face, which has at least one. Offsets from the first corner
/// are added, so that a coordinate that all corners have stays exact.
fn middle<N: Real>(points: &[Point<N, 3>], corners: &[u32]) -> Point<N, 3> {
    let count = u32::try_from(corners.len()).map_or(f64::INFINITY, f64::from);
    let (share, first) = (N::ONE / N::lit(count), points[corners[0] as usize]);
    let sum = |sum, &corner: &u32| sum + (points[corner as usize] - first) * share;
    first + corners.iter().fold(Vector::<N, 3>::zeros(), sum)
}
