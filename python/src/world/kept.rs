//! The world of the library behind a Python world: plain, or inside a recorder.

use core::ops::Deref;

use impinge::math::Space;
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::shape::ShapeHandle;
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_record::{RecordError, Recorder, Registry};

use crate::space::Numeric;

/// A world that is read through [`Deref`] and changed by methods only, so that a recorder receives
/// every change.
pub(crate) enum KeptWorld<N: Numeric<D>, const D: usize> {
    Plain(Box<CollisionWorld<N, D, ()>>),
    Recorded(Box<Recorder<N, D, ()>>),
}

impl<N: Numeric<D>, const D: usize> Deref for KeptWorld<N, D> {
    type Target = CollisionWorld<N, D, ()>;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Plain(world) => world,
            Self::Recorded(recorder) => recorder,
        }
    }
}

/// The isometry type of a scalar and dimension.
type Isometry<N, const D: usize> = <N as Space<D>>::Isometry;

/// The query type of an object.
type Query<N> = GeometricQueryType<N>;

impl<N: Numeric<D>, const D: usize> KeptWorld<N, D> {
    pub(crate) fn add(
        &mut self,
        position: Isometry<N, D>,
        shape: ShapeHandle<N, D>,
        groups: CollisionGroups,
        query: Query<N>,
    ) -> Result<CollisionObjectHandle, RecordError> {
        match self {
            Self::Plain(world) => Ok(world.try_add(position, shape, groups, query, ())?),
            Self::Recorded(recorder) => recorder.add(position, shape, groups, query, ()),
        }
    }

    pub(crate) fn remove(&mut self, handles: &[CollisionObjectHandle]) -> Result<(), RecordError> {
        match self {
            Self::Plain(world) => Ok(world.try_remove(handles)?),
            Self::Recorded(recorder) => recorder.remove(handles),
        }
    }

    pub(crate) fn set_positions(
        &mut self,
        positions: &[(CollisionObjectHandle, Isometry<N, D>)],
    ) -> Result<(), RecordError> {
        match self {
            Self::Plain(world) => Ok(world.try_set_positions(positions)?),
            Self::Recorded(recorder) => recorder.set_positions(positions),
        }
    }

    pub(crate) fn set_shape(
        &mut self,
        handle: CollisionObjectHandle,
        shape: ShapeHandle<N, D>,
    ) -> Result<(), RecordError> {
        match self {
            Self::Plain(world) => Ok(world.try_set_shape(handle, shape)?),
            Self::Recorded(recorder) => recorder.set_shape(handle, shape),
        }
    }

    pub(crate) fn set_groups(
        &mut self,
        handle: CollisionObjectHandle,
        groups: CollisionGroups,
    ) -> Result<(), RecordError> {
        match self {
            Self::Plain(world) => Ok(world.try_set_collision_groups(handle, groups)?),
            Self::Recorded(recorder) => recorder.set_collision_groups(handle, groups),
        }
    }

    pub(crate) fn set_query(
        &mut self,
        handle: CollisionObjectHandle,
        query: Query<N>,
    ) -> Result<(), RecordError> {
        match self {
            Self::Plain(world) => Ok(world.try_set_query_type(handle, query)?),
            Self::Recorded(recorder) => recorder.set_query_type(handle, query),
        }
    }

    pub(crate) fn update(&mut self) {
        match self {
            Self::Plain(world) => world.update(),
            Self::Recorded(recorder) => recorder.update(),
        }
    }

    /// Starts a recording of all changes from now on. A world that is already recorded is
    /// unchanged. On an error the world is unchanged, too.
    pub(crate) fn record(&mut self, margin: N) -> Result<(), RecordError> {
        let Self::Plain(world) = self else { return Ok(()) };
        let world = *std::mem::replace(world, Box::new(CollisionWorld::new(N::ZERO)));
        match Recorder::of_world(world, margin, Registry::new()) {
            Ok(recorder) => *self = Self::Recorded(Box::new(recorder)),
            Err(refused) => {
                *self = Self::Plain(refused.world);
                return Err(refused.error);
            }
        }
        Ok(())
    }

    /// Ends the recording and returns its bytes; `None` if the world is not recorded.
    pub(crate) fn stop(&mut self) -> Option<Vec<u8>> {
        let none = Self::Plain(Box::new(CollisionWorld::new(N::ZERO)));
        match std::mem::replace(self, none) {
            Self::Plain(world) => {
                *self = Self::Plain(world);
                None
            }
            Self::Recorded(recorder) => {
                let recording = recorder.finish();
                *self = Self::Plain(Box::new(recording.world));
                Some(recording.bytes)
            }
        }
    }

    pub(crate) const fn is_recorded(&self) -> bool {
        matches!(self, Self::Recorded(_))
    }
}
