//! Dispatches from the scalar and dimension of a file to types: the only place of this choice.

use core::fmt;

use impinge::query::{Proximity, Witness, proximity, witness};
use impinge::world::CollisionObject;
use impinge_files::{Dimension, ScalarFile, SceneSpace};
use impinge_record::Scalar;
use impinge_view::{Camera, SvgPicture};
use serde::Serialize;

use crate::error::CliError;

/// A dimension and a scalar: fields of nearly every report.
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

/// A scalar and a dimension in which the command works.
pub(crate) trait Stage<const D: usize>: SceneSpace<D> {
    /// Returns the camera of a picture: in 3D the given one, in 2D an orthographic one.
    fn camera(spatial: Camera) -> Camera;

    /// Creates a picture of lines of this width in pixels.
    fn lines(camera: Camera, width: u32) -> SvgPicture;

    /// Whether two objects touch, or are at most a margin apart; see [`proximity`].
    fn proximity<T>(
        object1: &CollisionObject<Self, D, T>,
        object2: &CollisionObject<Self, D, T>,
        margin: Self,
    ) -> Proximity;

    /// Returns the nearest points of two objects whose distance is at most `limit`; see [`witness`].
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

/// A computation that is generic over scalar and dimension, which are known at run time. It is a type, because a
/// closure cannot be generic.
pub(crate) trait Task {
    /// Its result.
    type Answer;

    /// Runs the computation.
    fn run<N: Stage<D>, const D: usize>(self) -> Result<Self::Answer, CliError>;
}

/// Runs a task in a scalar and a dimension.
pub(crate) fn run_in<T: Task>(kind: Kind, task: T) -> Result<T::Answer, CliError> {
    match (kind.scalar, kind.dimension) {
        (ScalarFile::F32, Dimension::Two) => task.run::<f32, 2>(),
        (ScalarFile::F32, Dimension::Three) => task.run::<f32, 3>(),
        (ScalarFile::F64, Dimension::Two) => task.run::<f64, 2>(),
        (ScalarFile::F64, Dimension::Three) => task.run::<f64, 3>(),
    }
}
