//! Closed surfaces and lines as what they bound, in questions about points.
//!
//! The library sees a mesh that was not made solid as a surface, in which no point lies, and answers beside that what a
//! closed one encloses (`TriMesh::signed_distance`). Here a closed mesh in 3D and a closed line in 2D are solids. Other meshes,
//! lines and height fields are *open*: they bound nothing, and a question about what is inside needs the word of the caller
//! (`surface=True`) that they are surfaces. A compound is the union of its children.

use impinge::math::{Point, Pose, Real, Space};
use impinge::query::PointQuery;
use impinge::shape::{Compound, HeightField, Polyline, ShapeHandle, ShapeKind, TriMesh};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::space::Numeric;

/// A scalar and a dimension in which surfaces may bound something.
pub(crate) trait Bounding<const D: usize>: Space<D> {
    /// The signed distance of a point of its frame from a mesh or line, negative in what it bounds; `None` if the shape
    /// bounds nothing, and of solids.
    fn signed_distance(shape: &ShapeHandle<Self, D>, point: &Point<Self, D>) -> Option<Self>;

    /// Whether a point of its frame lies in what a mesh or line bounds, or on it; `None` as above.
    fn encloses(shape: &ShapeHandle<Self, D>, point: &Point<Self, D>) -> Option<bool>;

    /// What the shape is if it is a surface or a line.
    fn standing(shape: &ShapeHandle<Self, D>) -> Option<Standing>;
}

/// What a shape with a surface but no inside of its own is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standing {
    /// It bounds a solid.
    Closed,
    /// It bounds nothing; with the name of its kind.
    Open(&'static str),
}

impl<N: Real> Bounding<2> for N {
    fn signed_distance(shape: &ShapeHandle<N, 2>, point: &Point<N, 2>) -> Option<N> {
        shape.as_shape::<Polyline<N, 2>>()?.signed_distance(point)
    }

    fn encloses(shape: &ShapeHandle<N, 2>, point: &Point<N, 2>) -> Option<bool> {
        shape.as_shape::<Polyline<N, 2>>()?.encloses(point)
    }

    /// The triangles of meshes are filled in 2D.
    fn standing(shape: &ShapeHandle<N, 2>) -> Option<Standing> {
        if let Some(line) = shape.as_shape::<Polyline<N, 2>>() {
            let is_closed = line.is_outline();
            return Some(if is_closed { Standing::Closed } else { Standing::Open("Polyline") });
        }
        shape.as_shape::<HeightField<N, 2>>().map(|_| Standing::Open("HeightField"))
    }
}

impl<N: Real> Bounding<3> for N {
    fn signed_distance(shape: &ShapeHandle<N, 3>, point: &Point<N, 3>) -> Option<N> {
        shape.as_shape::<TriMesh<N, 3>>()?.signed_distance(point)
    }

    fn encloses(shape: &ShapeHandle<N, 3>, point: &Point<N, 3>) -> Option<bool> {
        shape.as_shape::<TriMesh<N, 3>>()?.encloses(point)
    }

    fn standing(shape: &ShapeHandle<N, 3>) -> Option<Standing> {
        if let Some(mesh) = shape.as_shape::<TriMesh<N, 3>>() {
            let is_closed = mesh.is_volume();
            return Some(if is_closed { Standing::Closed } else { Standing::Open("TriMesh") });
        }
        // A line bounds nothing in space.
        if shape.as_shape::<Polyline<N, 3>>().is_some() {
            return Some(Standing::Open("Polyline"));
        }
        shape.as_shape::<HeightField<N, 3>>().map(|_| Standing::Open("HeightField"))
    }
}

/// What the shape is: of a compound open if a child is, else closed if one is; `None` of solids.
pub(crate) fn standing<N: Numeric<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
) -> Option<Standing> {
    if shape.geometry().kind() != ShapeKind::Composite {
        return None;
    }
    if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
        let all = compound.children().iter().filter_map(|(_, child)| standing(child));
        return all.reduce(|one, other| if one == Standing::Closed { other } else { one });
    }
    N::standing(shape)
}

/// Refuses an open surface.
///
/// # Errors
/// `ValueError`, with what names the shape.
pub(crate) fn refuse_open(standing: Option<Standing>, name: &str) -> PyResult<()> {
    let Some(Standing::Open(kind)) = standing else { return Ok(()) };
    Err(PyValueError::new_err(format!(
        "{name} has a {kind} that is not closed: it has no inside, and is asked as a surface by surface=True"
    )))
}

/// Whether a point of the outer frame lies in the placed shape, or on its boundary.
pub(crate) fn contains<N: Numeric<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    pose: &Pose<N, D>,
    point: &Point<N, D>,
) -> bool {
    let local = pose.inverse_point(point);
    if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
        let mut children = compound.children().iter();
        return children.any(|(at, child)| contains(child, &N::pose(at), &local));
    }
    N::encloses(shape, &local).unwrap_or_else(|| shape.contains_local_point(&local))
}

/// How far a point of the outer frame is from the placed shape, negative inside; of a compound the least of its children.
pub(crate) fn signed_distance<N: Numeric<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    pose: &Pose<N, D>,
    point: &Point<N, D>,
) -> N {
    let local = pose.inverse_point(point);
    if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
        let distances = compound.children().iter();
        let distances = distances.map(|(at, child)| signed_distance(child, &N::pose(at), &local));
        return distances.fold(N::INFINITY, |one, other| if other < one { other } else { one });
    }
    let of_bounded = N::signed_distance(shape, &local);
    of_bounded.unwrap_or_else(|| shape.signed_distance_to_local_point(&local))
}
