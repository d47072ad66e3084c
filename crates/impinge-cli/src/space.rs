//! From the scalar and dimension that a file names to types: the one place where they are chosen.

use core::fmt;

use impinge::query::{Witness, witness};
use impinge::world::CollisionObject;
use impinge_files::{Dimension, SceneSpace};
use impinge_record::Scalar;
use impinge_view::{Camera, SvgPicture};
use serde::Serialize;

use crate::args::ScalarName;
use crate::error::CliError;

/// A scalar and a dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    pub(crate) scalar: ScalarName,
    pub(crate) dimension: Dimension,
}

/// A scalar and a dimension in which the command works.
pub(crate) trait Stage<const D: usize>: SceneSpace<D> {
    /// What the user may ask for of the camera, or the one that this dimension has anyway.
    fn camera(spatial: Camera) -> Camera;

    /// A picture of lines of this width in pixels.
    fn lines(camera: Camera, width: u32) -> SvgPicture;

    /// The nearest points of two objects that are at most `limit` apart; see [`witness`].
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

    fn witness<T>(
        object1: &CollisionObject<N, 3, T>,
        object2: &CollisionObject<N, 3, T>,
        limit: N,
    ) -> Option<Witness<N, 3>> {
        let [shape1, shape2] = [object1.shape(), object2.shape()];
        witness(object1.position(), &**shape1, object2.position(), &**shape2, limit)
    }
}

/// What is done in a scalar and a dimension that are known when the program runs.
pub(crate) trait Task {
    /// What comes of it.
    type Answer;

    /// Does it.
    fn run<N: Stage<D>, const D: usize>(self) -> Result<Self::Answer, CliError>;
}

/// Does a task in a scalar and a dimension.
pub(crate) fn run_in<T: Task>(kind: Kind, task: T) -> Result<T::Answer, CliError> {
    match (kind.scalar, kind.dimension) {
        (ScalarName::F32, Dimension::Two) => task.run::<f32, 2>(),
        (ScalarName::F32, Dimension::Three) => task.run::<f32, 3>(),
        (ScalarName::F64, Dimension::Two) => task.run::<f64, 2>(),
        (ScalarName::F64, Dimension::Three) => task.run::<f64, 3>(),
    }
}

/// The fields of every report that say what it was computed in.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct KindFields {
    pub(crate) dimension: usize,
    pub(crate) scalar: &'static str,
}

impl Kind {
    /// As fields of a report.
    pub(crate) const fn fields(self) -> KindFields {
        let scalar = match self.scalar {
            ScalarName::F32 => "f32",
            ScalarName::F64 => "f64",
        };
        KindFields { dimension: self.dimension.number(), scalar }
    }
}

impl fmt::Display for KindFields {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}D, {}", self.dimension, self.scalar)
    }
}
