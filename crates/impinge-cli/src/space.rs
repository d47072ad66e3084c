//! Dispatches from the scalar and dimension of a file, known at run time, to generic code.

use core::fmt;

use impinge::query::{Proximity, Witness, proximity, witness};
use impinge::world::CollisionObject;
use impinge_files::{Dimension, ScalarFile, SceneSpace};
use impinge_record::Scalar;
use impinge_view::{Camera, SvgPicture};
use serde::Serialize;

use crate::error::CliError;

/// A dimension and a scalar, which are fields of most reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Kind {
    pub(crate) dimension: Dimension,
    pub(crate) scalar: ScalarFile,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scalar = match self.scalar {
            ScalarFile::F32 => "f32",
            ScalarFile::F64 => "f64",
        };
        write!(f, "{}D, {scalar}", self.dimension.number())
    }
}

/// A scalar and a dimension in which the command computes.
pub(crate) trait Stage<const D: usize>: SceneSpace<D> {
    /// Returns the camera of a picture: `spatial` in 3D, an orthographic camera in 2D.
    fn camera(spatial: Camera) -> Camera;

    /// Creates a picture of lines. `width` is its width in pixels.
    fn lines(camera: Camera, width: u32) -> SvgPicture;

    /// Returns the proximity of two objects for a margin; see [`proximity`].
    fn proximity<T>(
        object1: &CollisionObject<Self, D, T>,
        object2: &CollisionObject<Self, D, T>,
        margin: Self,
    ) -> Proximity;

    /// Returns the nearest points of two objects; `None` if their distance exceeds `limit` or their
    /// overlap is unbounded. See [`witness`].
    fn witness<T>(
        object1: &CollisionObject<Self, D, T>,
        object2: &CollisionObject<Self, D, T>,
        limit: Self,
    ) -> Option<Witness<Self, D>>;
}

impl<N: Scalar> Stage<2> for N {
    fn camera(_: Camera) -> Camera {
        Camera::plane()
    }

    fn lines(_: Camera, width: u32) -> SvgPicture {
        SvgPicture::plane(width)
    }

    fn proximity<T>(
        object1: &CollisionObject<N, 2, T>,
        object2: &CollisionObject<N, 2, T>,
        margin: N,
    ) -> Proximity {
        let [shape1, shape2] = [object1.shape(), object2.shape()];
        proximity(object1.position(), &**shape1, object2.position(), &**shape2, margin)
    }

    fn witness<T>(
        object1: &CollisionObject<N, 2, T>,
        object2: &CollisionObject<N, 2, T>,
        limit: N,
    ) -> Option<Witness<N, 2>> {
        let [shape1, shape2] = [object1.shape(), object2.shape()];
        witness(object1.position(), &**shape1, object2.position(), &**shape2, limit)
    }
}

impl<N: Scalar> Stage<3> for N {
    fn camera(spatial: Camera) -> Camera {
        spatial
    }

    fn lines(camera: Camera, width: u32) -> SvgPicture {
        SvgPicture::space(camera, width)
    }

    fn proximity<T>(
        object1: &CollisionObject<N, 3, T>,
        object2: &CollisionObject<N, 3, T>,
        margin: N,
    ) -> Proximity {
        let [shape1, shape2] = [object1.shape(), object2.shape()];
        proximity(object1.position(), &**shape1, object2.position(), &**shape2, margin)
    }

    fn witness<T>(
        object1: &CollisionObject<N, 3, T>,
        object2: &CollisionObject<N, 3, T>,
        limit: N,
    ) -> Option<Witness<N, 3>> {
        let [shape1, shape2] = [object1.shape(), object2.shape()];
        witness(object1.position(), &**shape1, object2.position(), &**shape2, limit)
    }
}

/// A computation that is generic over scalar and dimension. Tasks are types, since a closure cannot
/// be generic.
pub(crate) trait Task {
    /// The result of the computation.
    type Answer;

    /// Runs the computation in the scalar `N` and the dimension `D`.
    fn run<N: Stage<D>, const D: usize>(self) -> Result<Self::Answer, CliError>;
}

/// Runs a task in a scalar and a dimension that are known at run time.
pub(crate) fn run_in<T: Task>(kind: Kind, task: T) -> Result<T::Answer, CliError> {
    match (kind.scalar, kind.dimension) {
        (ScalarFile::F32, Dimension::Two) => task.run::<f32, 2>(),
        (ScalarFile::F32, Dimension::Three) => task.run::<f32, 3>(),
        (ScalarFile::F64, Dimension::Two) => task.run::<f64, 2>(),
        (ScalarFile::F64, Dimension::Three) => task.run::<f64, 3>(),
    }
}
