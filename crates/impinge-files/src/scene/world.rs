//! The recorded world of a scene. Its objects have names, and move by the motions of the scene.

use core::num::NonZeroU64;
use core::ops::Deref;
use std::collections::BTreeMap;

use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;
use impinge_record::{RecordError, Recorder, Recording, Registry};

use super::placed::PlacedObject;
use super::pose::Motion;
use super::{Placement, Scene, SceneSpace};
use crate::error::Within;
use crate::{FileError, Problem};

/// The world of a scene, with a recorder, and with the motions of its objects. It dereferences to
/// the [`CollisionWorld`], for reading only ([`Deref`]).
///
/// ```
/// use impinge_files::Scene;
/// use impinge_record::{Registry, validate};
///
/// let text = r#"{"dimension": 2, "objects": [
///     {"name": "wall", "shape": {"cuboid": {"half_extents": [1, 1]}}},
///     {"name": "ball", "shape": {"ball": {"radius": 1}}, "position": {"translation": [5, 0]},
///      "motion": {"velocity": [-2, 0]}}
/// ]}"#;
/// let scene = Scene::from_json("hit.json", text)?;
/// let mut world = scene.world::<f64, 2>()?;
/// let ball = world.handle("ball").expect("an object");
/// for _ in 0..4 {
///     world.step(0.5)?;
/// }
/// assert_eq!(world.collision_object(ball).expect("it lives").position().translation.x, 1.0);
/// assert_eq!(world.contact_events().len(), 0, "they touch since the step before");
/// let recording = world.finish();
/// assert_eq!(validate(&recording.bytes, &Registry::<f64, 2, String>::new()), Ok(None));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SceneWorld<N: SceneSpace<D>, const D: usize> {
    recorder: Recorder<N, D, String>,
    handles: BTreeMap<String, CollisionObjectHandle>,
    movers: Vec<Mover>,
    seconds: f64,
}

/// The handle, start and motion of an object that moves.
#[derive(Debug)]
struct Mover {
    handle: CollisionObjectHandle,
    start: Placement,
    motion: Motion,
}

impl Scene {
    /// Creates a recorded world with the objects in their order. The world is not updated yet. The
    /// data of an object is its name.
    ///
    /// The recorder stores every shape; [`Self::collision_world`] creates a world without this
    /// cost. The recording needs no registered shapes or filters.
    ///
    /// # Errors
    /// If [`Self::collision_world`] would return an error, or a shape has more parts than
    /// recordings allow.
    pub fn world<N: SceneSpace<D>, const D: usize>(&self) -> Result<SceneWorld<N, D>, FileError> {
        let recorder = Recorder::new(N::lit(self.file.margin), Registry::new());
        let recorder = recorder.map_err(Problem::recorded).within("margin");
        let mut recorder = recorder.map_err(|fault| self.source.error(fault))?;
        let (mut handles, mut movers) = (BTreeMap::new(), Vec::new());
        for placed in self.placed::<N, D>()? {
            let PlacedObject { object, position, shape, query } = placed;
            let added = recorder.add(position, shape, object.groups, query, object.name.clone());
            let handle = added.map_err(|error| self.refused(object, Problem::recorded(error)))?;
            handles.insert(object.name.clone(), handle);
            let start = object.start;
            movers.extend(object.motion.map(|motion| Mover { handle, start, motion }));
        }
        Ok(SceneWorld { recorder, handles, movers, seconds: 0.0 })
    }
}

impl<N: SceneSpace<D>, const D: usize> SceneWorld<N, D> {
    /// Writes a key frame before every update whose index is a positive multiple of `updates`; see
    /// [`Recorder::with_key_frames`].
    #[must_use]
    pub fn with_key_frames(self, updates: NonZeroU64) -> Self {
        Self { recorder: self.recorder.with_key_frames(updates), ..self }
    }

    /// Moves the objects by their motions over `seconds`, and updates the world. A step of 0
    /// seconds only updates; callers usually begin with such a step. Positions are computed from
    /// the start and the elapsed time.
    ///
    /// # Errors
    /// If a position leaves the range of numbers. The world is then unchanged, but
    /// [`Self::seconds()`] includes the step.
    pub fn step(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.move_objects(seconds)?;
        self.recorder.update();
        Ok(())
    }

    /// Moves the objects like [`Self::step`], without updating the world. Positions can then be
    /// read before the update.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn move_objects(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.seconds += seconds;
        let living = self.movers.iter().filter(|mover| self.recorder.contains(mover.handle));
        let moved = living.filter_map(|mover| {
            let at = mover.start.after(&mover.motion, self.seconds).isometry::<N, D>();
            at.ok().map(|at| (mover.handle, at))
        });
        let moved: Vec<_> = moved.collect();
        if !moved.is_empty() && seconds != 0.0 {
            self.recorder.set_positions(&moved)?;
        }
        Ok(())
    }

    /// Returns the elapsed time in seconds, which is the sum over all steps.
    #[must_use]
    pub const fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Returns the handle of the object with this name; `None` if the scene has no such object. The
    /// handle may be stale.
    #[must_use]
    pub fn handle(&self, name: &str) -> Option<CollisionObjectHandle> {
        self.handles.get(name).copied()
    }

    /// Returns the name of an object; `None` for a stale handle.
    #[must_use]
    pub fn name(&self, handle: CollisionObjectHandle) -> Option<&str> {
        self.recorder.collision_object(handle).map(|object| object.data().as_str())
    }

    /// Returns the recorder, for changes that no motion describes and for recorded queries.
    pub const fn recorder_mut(&mut self) -> &mut Recorder<N, D, String> {
        &mut self.recorder
    }

    /// Ends the recording and returns it.
    #[must_use]
    pub fn finish(self) -> Recording<N, D, String> {
        self.recorder.finish()
    }
}

impl<N: SceneSpace<D>, const D: usize> Deref for SceneWorld<N, D> {
    type Target = CollisionWorld<N, D, String>;

    fn deref(&self) -> &Self::Target {
        &self.recorder
    }
}

impl<N: SceneSpace<D>, const D: usize> core::fmt::Debug for SceneWorld<N, D> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let mut debug = f.debug_struct("SceneWorld");
        debug.field("objects", &self.handles.len()).field("movers", &self.movers.len());
        debug.field("seconds", &self.seconds).finish()
    }
}
