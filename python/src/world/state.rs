//! Worlds as bytes: a recording of the calls that create a world with the same objects.
//!
//! While the recording is made, placeholders occupy the indices without an object; they are removed
//! at the end. So all objects keep their indices, and the world read from the bytes gives the next
//! object the index that the written world would give it. Only an index that the written world has
//! retired, because 2^16 objects had it, is used again, after all free ones. The number of earlier
//! uses of each index is stored beside the bytes, so the handles in Python are new all the same.

use impinge::math::Pose;
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Ball, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld};
use impinge_record::{ReadError, RecordError, Recorder, Registry, Replay};

use super::typed::TypedWorld;
use crate::space::Numeric;

impl<N: Numeric<D>, const D: usize> TypedWorld<N, D> {
    /// Returns the bytes, and for each index the number of objects that had it before the last one.
    pub(super) fn write(&self) -> Result<(Vec<u8>, Vec<u32>), RecordError> {
        let mut recorder = Recorder::<N, D, ()>::new(self.margin, Registry::new())?;
        let mut objects = self.world.collision_objects().peekable();
        let mut handles = Vec::with_capacity(self.slots.len());
        for index in 0..self.slots.len() {
            let object = objects.next_if(|object| object.handle().uid() == index);
            handles.push(match object {
                Some(object) => recorder.add(
                    *object.position(),
                    object.shape().clone(),
                    *object.collision_groups(),
                    object.query_type(),
                    (),
                ),
                None => {
                    let (here, groups) = (N::isometry(&Pose::identity()), CollisionGroups::new());
                    recorder.add(here, placeholder(), groups, contacts(), ())
                }
            }?);
        }
        for index in vacant(&self.world, handles.len()) {
            recorder.remove(&[handles[index]])?;
        }
        let ages = self.slots.iter().map(|slot| slot.0).collect();
        Ok((recorder.finish().bytes, ages))
    }

    /// Fills this new world from the bytes.
    pub(super) fn read(&mut self, bytes: &[u8], ages: &[u32]) -> Result<(), Damage> {
        let mut replay = Replay::open(bytes, &Registry::<N, D, ()>::new())?;
        replay.seek_end()?;
        let old = replay.world();
        let mut objects = old.collision_objects().peekable();
        for (index, &age) in ages.iter().enumerate() {
            let object = objects.next_if(|object| object.handle().uid() == index);
            let handle = self.copy(object)?;
            if handle.uid() != index {
                return Err(Damage::Handles);
            }
            self.slots.push((age, handle));
            if let Some(object) = object {
                self.note_surface(handle, object.shape());
            }
        }
        let is_free_beyond = old.vacant_indices().any(|index| index >= ages.len());
        if objects.next().is_some() || is_free_beyond {
            return Err(Damage::Handles);
        }
        for index in vacant(old, ages.len()) {
            self.world.remove(&[self.slots[index].1])?;
        }
        Ok(())
    }

    /// Adds a copy of an object; `None` adds a placeholder.
    fn copy(
        &mut self,
        object: Option<&CollisionObject<N, D, ()>>,
    ) -> Result<impinge::narrow_phase::CollisionObjectHandle, RecordError> {
        match object {
            Some(object) => {
                let (shape, groups) = (object.shape().clone(), *object.collision_groups());
                self.world.add(*object.position(), shape, groups, object.query_type())
            }
            None => {
                let (here, groups) = (N::isometry(&Pose::identity()), CollisionGroups::new());
                self.world.add(here, placeholder(), groups, contacts())
            }
        }
    }
}

/// Returns the indices without an object, in the order in which their placeholders are removed. The
/// retired indices of the world come first, then its free ones, the next one last. All indices of
/// the world are below `len`.
fn vacant<N: Numeric<D>, const D: usize>(
    world: &CollisionWorld<N, D, ()>,
    len: usize,
) -> Vec<usize> {
    let used = world.collision_objects().map(|object| object.handle().uid());
    let mut is_retired = vec![true; len];
    used.chain(world.vacant_indices()).for_each(|index| is_retired[index] = false);
    (0..len).filter(|index| is_retired[*index]).chain(world.vacant_indices()).collect()
}

/// The reason why bytes cannot be read as a world.
#[derive(Debug)]
pub(super) enum Damage {
    Read(ReadError),
    World(RecordError),
    /// The indices of the objects do not fit the list of uses.
    Handles,
}

impl From<ReadError> for Damage {
    fn from(error: ReadError) -> Self {
        Self::Read(error)
    }
}

impl From<RecordError> for Damage {
    fn from(error: RecordError) -> Self {
        Self::World(error)
    }
}

impl core::fmt::Display for Damage {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Read(error) => error.fmt(f),
            Self::World(error) => error.fmt(f),
            Self::Handles => f.write_str("the objects are not those of the handles"),
        }
    }
}

fn placeholder<N: Numeric<D>, const D: usize>() -> ShapeHandle<N, D> {
    ShapeHandle::new(Ball::new(N::ONE))
}

const fn contacts<N: impinge::math::Real>() -> GeometricQueryType<N> {
    GeometricQueryType::Contacts(N::ZERO, N::ZERO)
}
