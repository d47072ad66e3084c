//! Errors of a world.

use core::fmt;

use super::WorldMark;
use crate::math::{Pose, Real, Space, is_unit};
use crate::narrow_phase::{CollisionObjectHandle, GeometricQueryType};

/// The reason why a world refused an operation; the world is then unchanged. Each `value` is the
/// rejected number, converted to `f64` exactly.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType, WorldError};
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// let handle = world.add(Isometry::identity(), ball, CollisionGroups::new(), query, ());
/// world.remove(&[handle]);
/// let refused = world.try_set_position(handle, Isometry::identity());
/// assert_eq!(refused, Err(WorldError::StaleHandle(handle)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WorldError {
    /// The handle is stale or unknown: its object was removed, or belongs to another world.
    StaleHandle(CollisionObjectHandle),
    /// The handle occurs twice in a list of objects to remove.
    RepeatedHandle(CollisionObjectHandle),
    /// A number of a position is NaN or infinite.
    Position {
        /// The object to be moved; `None` for an object to be added.
        handle: Option<CollisionObjectHandle>,
        /// The rejected value.
        value: f64,
    },
    /// The rotation of a position, a complex number or quaternion, is not of unit length: its
    /// length differs from 1 by more than 0.8 %.
    Rotation {
        /// The object to be moved; `None` for an object to be added.
        handle: Option<CollisionObjectHandle>,
        /// The length of the rotation's complex number or quaternion.
        length: f64,
    },
    /// A number of a query type is negative, NaN or infinite.
    QueryType {
        /// The rejected value.
        value: f64,
    },
    /// The skin of an object is negative, NaN or infinite.
    Skin {
        /// The object.
        handle: CollisionObjectHandle,
        /// The rejected value.
        value: f64,
    },
    /// The margin of a world is negative, NaN or infinite.
    Margin {
        /// The rejected value.
        value: f64,
    },
    /// The shape of the object is not of the type that the caller of `deform` expects.
    ShapeType(CollisionObjectHandle),
    /// The mark has ended, or belongs to another world.
    MarkGone(WorldMark),
    /// The number of objects has reached the maximum.
    Full,
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StaleHandle(handle) => {
                write!(f, "{handle:?} is stale, or a handle of another world")
            }
            Self::RepeatedHandle(handle) => write!(f, "{handle:?} is to be removed twice"),
            Self::Position { handle: Some(handle), value } => {
                write!(f, "a number of the position for {handle:?} is {value}")
            }
            Self::Position { handle: None, value } => {
                write!(f, "a number of the position of a new object is {value}")
            }
            Self::Rotation { handle: Some(handle), length } => {
                write!(
                    f,
                    "the rotation of the position for {handle:?} has the length {length}, not 1"
                )
            }
            Self::Rotation { handle: None, length } => {
                write!(
                    f,
                    "the rotation of the position of a new object has the length {length}, not 1"
                )
            }
            Self::QueryType { value } => {
                write!(
                    f,
                    "a number of the query type is {value}: it must be finite and not negative"
                )
            }
            Self::Skin { handle, value } => {
                write!(f, "the skin for {handle:?} is {value}: it must be finite and not negative")
            }
            Self::Margin { value } => {
                write!(f, "the margin is {value}: it must be finite and not negative")
            }
            Self::ShapeType(handle) => {
                write!(f, "the shape of {handle:?} is not of the type to be deformed")
            }
            Self::MarkGone(_) => write!(f, "the mark has ended, or belongs to another world"),
            Self::Full => write!(f, "the world holds as many objects as it can name"),
        }
    }
}

impl std::error::Error for WorldError {}

/// Returns the pose of an isometry; an error if a number is not finite or the rotation is not of
/// unit length.
#[inline]
pub(super) fn usable_pose<N: Space<D>, const D: usize>(
    isometry: &N::Isometry,
    handle: Option<CollisionObjectHandle>,
) -> Result<Pose<N, D>, WorldError> {
    let (pose, squared) = (N::pose(isometry), N::squared_length_of_rotation(isometry));
    if !pose.is_finite() {
        return Err(bad_position(&pose, handle));
    }
    if !is_unit(squared) {
        return Err(bad_rotation(squared, handle));
    }
    Ok(pose)
}

#[cold]
fn bad_rotation<N: Real>(squared: N, handle: Option<CollisionObjectHandle>) -> WorldError {
    WorldError::Rotation { handle, length: squared.as_f64().sqrt() }
}

#[cold]
fn bad_position<N: Real, const D: usize>(
    pose: &Pose<N, D>,
    handle: Option<CollisionObjectHandle>,
) -> WorldError {
    let mut numbers = pose.translation.iter().chain(pose.rotation.iter());
    let value = numbers.find(|x| !x.is_finite_number()).map_or(f64::NAN, |value| value.as_f64());
    WorldError::Position { handle, value }
}

/// Returns the query type; an error if a number is negative or not finite.
pub(super) fn usable_query<N: Real>(
    query: GeometricQueryType<N>,
) -> Result<GeometricQueryType<N>, WorldError> {
    match query.bad_number() {
        Some(value) => Err(WorldError::QueryType { value: value.as_f64() }),
        None => Ok(query),
    }
}

/// Returns the value, or panics with the text of the error. Used by the panicking variants of
/// methods.
#[track_caller]
pub(super) fn or_panic<S>(result: Result<S, WorldError>) -> S {
    match result {
        Ok(value) => value,
        Err(error) => panic!("{error}"),
    }
}
