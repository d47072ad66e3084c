//! Clones of a world, which evolve independently of it.

mod objects;
mod rewind;

use core::any::Any;

use crate::bounding_volume::Aabb;
use crate::broad_phase::{BroadPhase, DBVTBroadPhase};
use crate::math::Space;
use crate::narrow_phase::{CollisionObjectHandle, DefaultNarrowPhase};
use crate::world::{CollisionWorld, NarrowPhase, WorldBroadPhase};

pub(super) use objects::{KeptObject, ObjectNote};
pub(super) use rewind::History;
pub use rewind::WorldMark;

/// The broad phase of a new world, as a concrete type.
pub(super) type DefaultBroadPhase<N, const D: usize> =
    DBVTBroadPhase<N, Aabb<N, D>, CollisionObjectHandle>;

/// A broad phase that a world can use: any type that is `Clone`, `Send` and `Sync`. A blanket
/// implementation covers all of these.
///
/// ```
/// use impinge::dim2::broad_phase::DBVTBroadPhase;
/// use impinge::dim2::world::CollisionWorld;
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// world.set_broad_phase(Box::new(DBVTBroadPhase::new(0.1)));
/// world.update();
/// ```
pub trait WorldsBroadPhase<N: Space<D>, const D: usize>:
    BroadPhase<N, Aabb<N, D>, CollisionObjectHandle> + Send + Sync
{
    /// Returns a clone with the same future behaviour.
    fn boxed_clone(&self) -> Box<WorldBroadPhase<N, D>>;

    /// Returns the value itself, for a downcast.
    #[doc(hidden)]
    fn as_any(&self) -> &dyn Any;

    /// Returns the value itself, for a downcast.
    #[doc(hidden)]
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

impl<N: Space<D>, const D: usize, B> WorldsBroadPhase<N, D> for B
where
    B: BroadPhase<N, Aabb<N, D>, CollisionObjectHandle> + Clone + Send + Sync + 'static,
{
    fn boxed_clone(&self) -> Box<WorldBroadPhase<N, D>> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}

/// A narrow phase that a world can use: any type that is `Clone`. A blanket implementation covers
/// all of these.
///
/// ```
/// use impinge::dim2::narrow_phase::DefaultNarrowPhase;
/// use impinge::dim2::world::CollisionWorld;
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// world.set_narrow_phase(Box::new(DefaultNarrowPhase::new()));
/// world.update();
/// ```
pub trait WorldsNarrowPhase<N: Space<D>, const D: usize, T>: NarrowPhase<N, D, T> {
    /// Returns a clone with the same future behaviour.
    fn boxed_clone(&self) -> Box<dyn WorldsNarrowPhase<N, D, T>>;

    /// Returns the value itself, for a downcast.
    #[doc(hidden)]
    fn as_any(&self) -> &dyn Any;

    /// Returns the value itself, for a downcast.
    #[doc(hidden)]
    fn as_any_mut(&mut self) -> &mut dyn Any;
}

impl<N: Space<D>, const D: usize, T, P> WorldsNarrowPhase<N, D, T> for P
where
    P: NarrowPhase<N, D, T> + Clone + 'static,
{
    fn boxed_clone(&self) -> Box<dyn WorldsNarrowPhase<N, D, T>> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}

impl<N: Space<D>, const D: usize> Clone for Box<WorldBroadPhase<N, D>> {
    fn clone(&self) -> Self {
        (**self).boxed_clone()
    }
}

impl<N: Space<D>, const D: usize, T> Clone for Box<dyn WorldsNarrowPhase<N, D, T>> {
    fn clone(&self) -> Self {
        (**self).boxed_clone()
    }
}

/// A clone gives the same bits as the original if the same calls are made: pairs, contacts with
/// their ids, events, and handles of added objects. It may be updated on another thread.
///
/// A handle from before the clone refers to the same object in both worlds. A handle that one of
/// the worlds issues afterwards may refer to another object in the other world, or to none: keep
/// the handles of the two worlds apart. Shapes are shared and never change:
/// [`CollisionWorld::deform`] gives the object of one world a new shape. Pair filters and
/// dispatchers are shared too, including any state to which they refer. Algorithms of single pairs
/// are cloned. Manifolds that [`CollisionWorld::contact_manifolds`] has built are not cloned; the
/// clone builds its own on first access.
///
/// A clone copies the memory of the world: 2.5 MB for 10 000 boxes that touch nothing, 54 MB for a
/// dense pile with 118 000 pairs (3D, `f32`). `clone_from` reuses the memory of the target, and
/// allocates nothing if the target has been as large.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
/// let [_, b] = [0.0, 1.5].map(|x| {
///     world.add(Isometry::translation(x, 0.0), ball.clone(), groups, ContactQuery::default(), ())
/// });
/// world.update();
///
/// // Where would the contact be if `b` were farther away?
/// let mut guess = world.clone();
/// guess.set_position(b, Isometry::translation(9.0, 0.0));
/// guess.update();
/// assert_eq!((guess.contact_events().len(), guess.contact_manifolds().count()), (1, 0));
/// assert_eq!(world.contact_manifolds().count(), 1, "nothing has happened here");
/// ```
impl<N: Space<D>, const D: usize, T: Clone> Clone for CollisionWorld<N, D, T> {
    fn clone(&self) -> Self {
        Self {
            objects: self.objects.clone(),
            broad_phase: self.broad_phase.clone(),
            narrow_phase: self.narrow_phase.clone(),
            next_broad_phase: self.next_broad_phase.clone(),
            next_narrow_phase: self.next_narrow_phase.clone(),
            filters: self.filters.clone(),
            events: self.events.clone(),
            queued: self.queued.clone(),
            keeps_events: self.keeps_events,
            removed: self.removed.clone(),
            algorithms: Vec::new(),
            interactions: Vec::new(),
            recent: self.recent.clone(),
            history: self.history.without_marks(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.objects.clone_from(&source.objects);
        match (self.default_broad_phase(), (*source.broad_phase).as_any().downcast_ref()) {
            (Some(known), Some(other)) => known.clone_from(other),
            _ => self.broad_phase = source.broad_phase.clone(),
        }
        match (self.default_narrow_phase(), (*source.narrow_phase).as_any().downcast_ref()) {
            (Some(known), Some(other)) => known.clone_from(other),
            _ => self.narrow_phase = source.narrow_phase.clone(),
        }
        self.next_broad_phase = source.next_broad_phase.clone();
        self.next_narrow_phase = source.next_narrow_phase.clone();
        self.filters.clone_from(&source.filters);
        self.events.clone_from(&source.events);
        self.queued.clone_from(&source.queued);
        self.keeps_events = source.keeps_events;
        self.removed.clone_from(&source.removed);
        self.recent.clone_from(&source.recent);
        self.history = source.history.without_marks();
    }
}

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the broad phase if it is the library's own; else `None`.
    pub(super) fn default_broad_phase(&mut self) -> Option<&mut DefaultBroadPhase<N, D>> {
        (*self.broad_phase).as_any_mut().downcast_mut()
    }

    /// Returns the narrow phase if it is the library's own; else `None`.
    pub(super) fn default_narrow_phase(&mut self) -> Option<&mut DefaultNarrowPhase<N, D>> {
        (*self.narrow_phase).as_any_mut().downcast_mut()
    }
}
