//! The plugin: the resource, the systems, and their order.

use core::fmt;
use core::marker::PhantomData;

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::prelude::{Entity, IntoScheduleConfigs, Resource, SystemSet};
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_ecs::system::{SystemParam, SystemParamItem};
use bevy_transform::systems::{
    StaticTransformOptimizations, mark_dirty_trees, propagate_parent_transforms,
    sync_simple_transforms,
};
use impinge::world::CollisionWorld;

use crate::follow::{follow, forget_disabled, notice_orphan, notice_removal};
use crate::glam::Glam;
use crate::report::{fill_colliding, report, step, trigger};
use crate::{
    ColliderFailed, CollisionEnded, CollisionLayers, CollisionStarted, Collisions, DefaultWorld,
    FixedCollider, Sensor, WorldKey,
};

/// The stages of the plugin in its schedule, in this order, for all worlds.
///
/// Move entities before [`Follow`](Self::Follow), read messages and contacts after [`Report`](Self::Report).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ImpingeSystems {
    /// Computes global transforms of hierarchies, as Bevy does at the end of a frame.
    Propagate,
    /// Copies changes of entities to the world.
    Follow,
    /// Updates the world.
    Step,
    /// Writes messages, runs observers, updates [`CollidingEntities`](crate::CollidingEntities).
    Report,
}

/// A filter of pairs that uses system parameters; see [`ImpingePlugin::with_filter`].
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_ecs::system::{SystemParam, SystemParamItem};
/// use bevy_impinge::d2::prelude::*;
///
/// #[derive(Component, PartialEq)]
/// struct Team(u8);
///
/// #[derive(SystemParam)]
/// struct Teams<'w, 's>(Query<'w, 's, &'static Team>);
///
/// impl PairFilter for Teams<'_, '_> {
///     fn allows(teams: &mut SystemParamItem<'_, '_, Self>, a: Entity, b: Entity) -> bool {
///         teams.0.get(a).ok() != teams.0.get(b).ok()
///     }
/// }
///
/// let mut app = App::new();
/// app.add_plugins(ImpingePlugin::default().in_schedule(Update).with_filter::<Teams>());
/// for team in [1, 1, 2] {
///     app.world_mut().spawn((Collider::circle(1.0), Team(team)));
/// }
/// app.update();
/// assert_eq!(app.world().resource::<Collisions>().contact_pairs().count(), 2);
/// ```
pub trait PairFilter: SystemParam {
    /// Whether the two entities may have a pair. Called for pairs that the layers allow, once when
    /// the boxes of the colliders begin to overlap, and again after [`Collisions::refilter`]. `one`
    /// is the entity whose collider was added first.
    fn allows(param: &mut SystemParamItem<'_, '_, Self>, one: Entity, other: Entity) -> bool;
}

/// Accepts all pairs.
impl PairFilter for () {
    fn allows(_: &mut SystemParamItem<'_, '_, Self>, _: Entity, _: Entity) -> bool {
        true
    }
}

/// The plugin for one collision world.
///
/// By default it runs in `FixedPostUpdate`, which needs Bevy's `TimePlugin`. Add one for each world:
/// `ImpingePlugin::default().in_world::<Ghosts>()`.
pub struct ImpingePlugin<const D: usize, W = DefaultWorld, F = ()> {
    schedule: InternedScheduleLabel,
    margin: f32,
    prediction: f32,
    types: PhantomData<fn() -> (W, F)>,
}

impl<const D: usize> Default for ImpingePlugin<D> {
    fn default() -> Self {
        Self {
            schedule: FixedPostUpdate.intern(),
            margin: 0.02,
            prediction: 0.0,
            types: PhantomData,
        }
    }
}

impl<const D: usize, W, F> ImpingePlugin<D, W, F> {
    /// Runs in another schedule, for instance in `PostUpdate`, once per frame.
    #[must_use]
    pub fn in_schedule(self, schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern(), ..self }
    }

    /// Sets the margin by which boxes of the broad phase are larger than their colliders: 0.02 by
    /// default. About a fiftieth of the size of a typical collider is suitable, so 1 or 2 if the
    /// unit is a pixel. The margin changes speed, never results.
    #[must_use]
    pub fn with_margin(self, margin: f32) -> Self {
        Self { margin, ..self }
    }

    /// Sets the prediction: contacts exist while colliders are at most twice this length apart, and
    /// [`CollisionStarted`] is then sent at that distance. With 0, the default, contacts exist
    /// while colliders touch or overlap.
    #[must_use]
    pub fn with_prediction(self, prediction: f32) -> Self {
        Self { prediction, ..self }
    }

    /// Returns the plugin for the world of another key.
    #[must_use]
    pub fn in_world<V: WorldKey>(self) -> ImpingePlugin<D, V, F> {
        self.typed()
    }

    /// Returns the plugin with a filter of pairs.
    #[must_use]
    pub fn with_filter<G: PairFilter + 'static>(self) -> ImpingePlugin<D, W, G> {
        self.typed()
    }

    fn typed<V, G>(self) -> ImpingePlugin<D, V, G> {
        let Self { schedule, margin, prediction, .. } = self;
        ImpingePlugin { schedule, margin, prediction, types: PhantomData }
    }
}

impl<const D: usize, W: WorldKey, F: PairFilter + 'static> Plugin for ImpingePlugin<D, W, F>
where
    f32: Glam<D>,
{
    /// # Panics
    /// If the margin or the prediction is negative, NaN or infinite.
    fn build(&self, app: &mut App) {
        assert!(
            self.prediction >= 0.0 && self.prediction.is_finite(),
            "the prediction is {}: it must be finite and not negative",
            self.prediction
        );
        let world = CollisionWorld::new(self.margin);
        app.insert_resource(Collisions::<D, W>::new(world, self.prediction))
            .add_message::<CollisionStarted<D, W>>()
            .add_message::<CollisionEnded<D, W>>()
            .add_message::<ColliderFailed<D, W>>()
            .add_observer(forget_disabled::<D, W>)
            .add_observer(notice_orphan::<D, W>)
            .add_observer(notice_removal::<Disabled, D, W>)
            .add_observer(notice_removal::<Sensor, D, W>)
            .add_observer(notice_removal::<FixedCollider, D, W>)
            .add_observer(notice_removal::<CollisionLayers, D, W>);
        order(app, self.schedule);
        let reports = (report::<D, W>, fill_colliding::<D, W>, trigger::<D, W>).chain();
        app.add_systems(self.schedule, follow::<D, W>.in_set(ImpingeSystems::Follow))
            .add_systems(self.schedule, step::<D, W, F>.in_set(ImpingeSystems::Step))
            .add_systems(self.schedule, reports.in_set(ImpingeSystems::Report));
    }
}

/// The schedules in which worlds run.
#[derive(Resource, Default)]
struct Schedules(Vec<InternedScheduleLabel>);

/// Orders the sets of a schedule and adds the computation of global transforms, once for all worlds in it.
fn order(app: &mut App, schedule: InternedScheduleLabel) {
    use ImpingeSystems::{Follow, Propagate, Report, Step};

    let mut schedules = app.world_mut().get_resource_or_init::<Schedules>();
    if schedules.0.contains(&schedule) {
        return;
    }
    schedules.0.push(schedule);
    let propagate = (mark_dirty_trees, propagate_parent_transforms, sync_simple_transforms).chain();
    app.init_resource::<StaticTransformOptimizations>()
        .configure_sets(schedule, (Propagate, Follow, Step, Report).chain())
        .add_systems(schedule, propagate.in_set(Propagate));
}

impl<const D: usize, W, F> fmt::Debug for ImpingePlugin<D, W, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ImpingePlugin")
            .field("schedule", &self.schedule)
            .field("margin", &self.margin)
            .field("prediction", &self.prediction)
            .finish()
    }
}
