//! The plugin for `avian2d`.

use core::fmt;
use core::marker::PhantomData;

use avian2d::prelude::{
    ColliderBackendPlugin, ColliderTreePlugin, CollisionHooks, ContactGraph, NarrowPhasePlugin,
    NarrowPhaseSystems, PhysicsLengthUnit, PhysicsSchedule,
};
use bevy_app::prelude::*;
use bevy_ecs::intern::Interned;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_ecs::system::SystemParamItem;

use super::{Collider, PairContacts};

/// Registers [`Collider`] with Avian's plugins. Add it after Avian's `PhysicsPlugins`.
///
/// `H` are the hooks for pairs and contacts that Avian's narrow phase calls for these colliders.
/// The broad phase gets them from `PhysicsPlugins::default().with_collision_hooks::<H>()`.
pub struct ImpingeColliderPlugin<H = ()> {
    schedule: Interned<dyn ScheduleLabel>,
    hooks: PhantomData<H>,
}

impl ImpingeColliderPlugin {
    /// Creates the plugin for `PhysicsPlugins::new(schedule)`. The default is `FixedPostUpdate`, as
    /// in Avian.
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern(), hooks: PhantomData }
    }
}

impl<H> ImpingeColliderPlugin<H> {
    /// Returns the plugin with the hooks `G`.
    #[must_use]
    pub fn with_collision_hooks<G: CollisionHooks + 'static>(self) -> ImpingeColliderPlugin<G>
    where
        for<'w, 's> SystemParamItem<'w, 's, G>: CollisionHooks,
    {
        ImpingeColliderPlugin { schedule: self.schedule, hooks: PhantomData }
    }
}

impl Default for ImpingeColliderPlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl<H> fmt::Debug for ImpingeColliderPlugin<H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ImpingeColliderPlugin").field("schedule", &self.schedule).finish()
    }
}

impl<H: CollisionHooks + 'static> Plugin for ImpingeColliderPlugin<H>
where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    fn build(&self, app: &mut App) {
        let unit = app.world().get_resource::<PhysicsLengthUnit>().map_or(1.0, |unit| unit.0);
        if !app.world().contains_resource::<PairContacts>() {
            app.insert_resource(PairContacts::reusing(unit * PairContacts::TOLERANCE));
        }
        app.add_plugins((
            ColliderBackendPlugin::<Collider>::new(self.schedule),
            ColliderTreePlugin::<Collider>::default(),
            NarrowPhasePlugin::<Collider, H>::default(),
        ));
        app.add_systems(PhysicsSchedule, sweep.in_set(NarrowPhaseSystems::Last));
    }
}

fn sweep(mut pairs: ResMut<PairContacts>, graph: Res<ContactGraph>) {
    let count = graph.active_pairs().len() + graph.sleeping_pairs().len();
    // The keys of Avian's pairs are indices without generations, so a pair of a despawned entity
    // seems to live on if a new entity has its index.
    let lives = |entity| graph.entity_to_node(entity).is_some();
    pairs
        .bypass_change_detection()
        .sweep(count, |(one, other)| lives(one) && lives(other) && graph.contains(one, other));
}
