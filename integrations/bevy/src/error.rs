//! Errors of colliders and transforms.

use core::fmt;
use core::marker::PhantomData;

use bevy_ecs::prelude::{Component, Entity, Message};
use impinge::shape::{MeshError, ScaleError, ShapeError};
use impinge::world::WorldError;

use crate::{DefaultWorld, WorldKey};

/// The reason why the collider of an entity is not in the world, or is there with outdated
/// components.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ColliderError {
    /// A size or point of the shape is invalid.
    Shape(ShapeError),
    /// Vertices or indices of a mesh or polyline are invalid.
    Mesh(MeshError),
    /// The library cannot represent the shape with the scale of the transform: for instance the ends of a capsule would
    /// be elliptic. Change the scale, or use a shape that supports every scale, such as a convex hull or a triangle
    /// mesh.
    Scale(ScaleError),
    /// A component of the transform is NaN or infinite, or its quaternion is not a rotation.
    Pose(WorldError),
    /// A scaled parent is rotated relative to its child. The transform is then a shear in the
    /// child's frame.
    Sheared,
    /// In 2D: the transform rotates the entity out of the x-y plane.
    OutOfPlane,
    /// A `Mesh` without readable triangles, and the reason.
    NoTriangles(&'static str),
}

impl fmt::Display for ColliderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape(error) => write!(f, "the shape: {error}"),
            Self::Mesh(error) => write!(f, "the mesh: {error}"),
            Self::Scale(error) => write!(f, "the scale of the transform: {error}"),
            Self::Pose(error) => write!(f, "the transform: {error}"),
            Self::Sheared => write!(f, "the transform shears: a scaled parent, a rotated child"),
            Self::OutOfPlane => write!(f, "the transform turns the entity out of the x-y plane"),
            Self::NoTriangles(why) => write!(f, "the mesh has no triangles to read: {why}"),
        }
    }
}

impl std::error::Error for ColliderError {}

impl From<ShapeError> for ColliderError {
    fn from(error: ShapeError) -> Self {
        Self::Shape(error)
    }
}

impl From<MeshError> for ColliderError {
    fn from(error: MeshError) -> Self {
        Self::Mesh(error)
    }
}

impl From<ScaleError> for ColliderError {
    fn from(error: ScaleError) -> Self {
        Self::Scale(error)
    }
}

impl From<WorldError> for ColliderError {
    fn from(error: WorldError) -> Self {
        Self::Pose(error)
    }
}

/// The reason why the collider of an entity is not in the world, or is there with outdated
/// components. The plugin inserts and removes this component.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct ColliderProblem<const D: usize, W: WorldKey = DefaultWorld> {
    /// The reason.
    pub error: ColliderError,
    pub(crate) world: PhantomData<W>,
}

/// A message: the collider of an entity is not in the world, or is there with outdated components.
/// Written once when a problem begins or changes.
#[derive(Message, Clone, Copy, Debug, PartialEq)]
pub struct ColliderFailed<const D: usize, W: WorldKey = DefaultWorld> {
    /// The entity.
    pub entity: Entity,
    /// The reason.
    pub error: ColliderError,
    pub(crate) world: PhantomData<W>,
}
