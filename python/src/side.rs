//! One side of a batch in Python: shapes and poses.

use impinge::batch::{BatchError, PoseSource, Side};
use impinge::math::Pose;
use impinge::shape::{ShapeHandle, ShapeKind};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::poses::{Poses, Source};
use crate::shapes::ShapesArgument;
use crate::solid;
use crate::space::{Kind, Numeric};

/// The arguments of a side, and their names in Python.
#[derive(Clone, Copy)]
pub(crate) struct SideArgument<'a, 'py> {
    pub(crate) shapes: &'a Bound<'py, PyAny>,
    pub(crate) poses: &'a Bound<'py, PyAny>,
    pub(crate) names: &'static [&'static str; 2],
}

impl<'a, 'py> SideArgument<'a, 'py> {
    /// Reads shapes and poses, which must have this scalar and dimension.
    pub(crate) fn read<N: Numeric<D>, const D: usize>(
        &self,
        kind: Kind,
    ) -> PyResult<GivenSide<'a, 'py, N, D>> {
        let [shapes, poses] = self.names;
        Ok(GivenSide {
            shapes: ShapesArgument::of(self.shapes, shapes, kind)?,
            poses: Poses::of(self.poses, poses)?,
            names: self.names,
        })
    }
}

/// Shapes and poses that are kept alive while a batch reads them.
pub(crate) struct GivenSide<'a, 'py, N: Numeric<D>, const D: usize> {
    shapes: ShapesArgument<'a, 'py, N, D>,
    poses: Poses<'py, N, D>,
    names: &'static [&'static str; 2],
}

impl<N: Numeric<D>, const D: usize> GivenSide<'_, '_, N, D> {
    /// Whether there is one shape at one pose. The result is then not an array, unless another
    /// argument has many elements.
    pub(crate) fn is_lone(&self) -> bool {
        self.shapes.lone().is_some() && self.poses.is_lone()
    }

    /// Whether there is one shape that is not a composite, at one pose. A query about it takes
    /// about a microsecond.
    pub(crate) fn is_quick(&self) -> bool {
        let shape = self.shapes.lone().map(|shape| shape.geometry().kind());
        shape.is_some_and(|kind| kind != ShapeKind::Composite) && self.poses.is_lone()
    }

    /// Returns the shape of an element.
    pub(crate) fn shape(&self, element: usize) -> &ShapeHandle<N, D> {
        self.shapes.at(element)
    }

    /// Returns `true` if any shape of the side is a surface or a polyline, or a compound with one.
    ///
    /// # Errors
    /// Unless `surface` is `true`, `ValueError` for a surface that is not closed. It names the row
    /// if the argument is a sequence of shapes.
    pub(crate) fn has_surface(&self, surface: bool) -> PyResult<bool> {
        let [name, _] = self.names;
        let mut has_surface = false;
        for (row, shape) in self.shapes.distinct().iter().enumerate() {
            let Some(standing) = solid::standing(shape) else { continue };
            has_surface = true;
            if !surface && self.shapes.lone().is_some() {
                solid::refuse_open(Some(standing), name)?;
            } else if !surface {
                solid::refuse_open(Some(standing), &format!("{name}[{row}]"))?;
            }
        }
        Ok(has_surface)
    }

    /// Returns the shapes and poses of all elements; a single element if the side has one shape and
    /// one pose.
    pub(crate) fn placed(&self) -> PyResult<Vec<(&ShapeHandle<N, D>, Pose<N, D>)>> {
        let poses = self.poses()?;
        let len = self.side(&*poses)?.len();
        let pose = |element| poses.pose(if poses.len() == 1 { 0 } else { element });
        Ok((0..len).map(|element| (self.shape(element), pose(element))).collect())
    }

    /// Returns the poses in the form of the library.
    pub(crate) fn poses(&self) -> PyResult<Source<'_, N, D>> {
        self.poses.source()
    }

    /// Returns the side in the form of the library.
    pub(crate) fn side<'a>(&'a self, poses: &'a dyn PoseSource<N, D>) -> PyResult<Side<'a, N, D>> {
        let [_, name] = self.names;
        Side::try_new(self.shapes.shapes()?, poses).map_err(|error| match error {
            BatchError::Length { given, needed, .. } => {
                error::of_batch(&BatchError::Length { argument: name, given, needed }, name)
            }
            other => error::of_batch(&other, name),
        })
    }

    /// Returns the shape and the position of each element; a single shape or pose is repeated.
    pub(crate) fn elements(&self) -> PyResult<Elements<'_, N, D>> {
        let poses = self.poses()?;
        let len = self.side(&*poses)?.len();
        let pose = |element| poses.pose(if poses.len() == 1 { 0 } else { element });
        Ok(Elements {
            shapes: (0..len).map(|element| self.shape(element)).collect(),
            positions: (0..len).map(|element| N::isometry(&pose(element))).collect(),
        })
    }
}

/// The elements of a side, which other threads can read.
pub(crate) struct Elements<'a, N: Numeric<D>, const D: usize> {
    pub(crate) shapes: Vec<&'a ShapeHandle<N, D>>,
    pub(crate) positions: Vec<N::Isometry>,
}

/// Returns the common number of elements of arguments; an argument with a single element fits any
/// number. `ValueError` names an argument of another length.
pub(crate) fn common(lengths: &[(&str, usize)]) -> PyResult<usize> {
    let len = lengths.iter().map(|(_, len)| *len).find(|len| *len != 1).unwrap_or(1);
    match lengths.iter().find(|(_, given)| *given != 1 && *given != len) {
        None => Ok(len),
        Some((name, given)) => Err(PyValueError::new_err(format!(
            "{name} has {given} elements where {len} are needed"
        ))),
    }
}
