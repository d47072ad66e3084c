//! Tests of entities that are added, changed and removed.

use bevy_app::{App, Update};
use bevy_ecs::entity_disabling::Disabled;
use bevy_impinge::{
    Collider, CollisionLayers, Collisions, FixedCollider, Glam, ImpingePlugin, Sensor,
};

use crate::support::{app, at, ball, collisions, impinge_ball, place, spawn, told};

fn despawned_in_the_frame_of_a_hit<const D: usize>()
where
    f32: Glam<D>,
{
    let mut app = app::<D>();
    let (a, b) = (spawn::<D>(&mut app, 0.0), spawn::<D>(&mut app, 1.0));
    app.update();
    assert_eq!(told::<D>(&mut app), [(true, a, b)]);
    app.world_mut().despawn(b);
    assert_eq!(collisions::<D>(&app).len(), 1, "queries no longer see it");
    app.update();
    assert_eq!(told::<D>(&mut app), [(false, a, b)], "each start has its end");
    app.update();
    assert_eq!(told::<D>(&mut app), [], "once");
}

#[test]
fn an_entity_despawned_in_the_frame_of_a_hit_ends_it() {
    despawned_in_the_frame_of_a_hit::<2>();
    despawned_in_the_frame_of_a_hit::<3>();
}

#[test]
fn what_is_added_and_removed_in_one_frame_leaves_nothing() {
    let mut app = app::<3>();
    let a = spawn::<3>(&mut app, 0.0);
    let b = spawn::<3>(&mut app, 1.0);
    app.world_mut().despawn(b);
    let c = spawn::<3>(&mut app, 1.0);
    app.world_mut().entity_mut(c).remove::<Collider<3>>();
    app.update();
    assert_eq!((collisions::<3>(&app).len(), told::<3>(&mut app)), (1, vec![]));

    app.world_mut().entity_mut(c).insert(ball::<3>());
    app.update();
    assert_eq!(told::<3>(&mut app), [(true, a, c)]);
    app.world_mut().entity_mut(c).remove::<Collider<3>>().insert(ball::<3>());
    app.update();
    assert_eq!(told::<3>(&mut app), [(false, a, c), (true, a, c)], "removed and back");
    assert!(collisions::<3>(&app).are_touching(a, c));
}

#[test]
fn disabled_entities_are_not_in_the_world() {
    let mut app = app::<2>();
    let (a, b) = (spawn::<2>(&mut app, 0.0), spawn::<2>(&mut app, 1.0));
    app.update();
    told::<2>(&mut app);
    app.world_mut().entity_mut(b).insert(Disabled);
    app.update();
    assert_eq!(told::<2>(&mut app), [(false, a, b)]);
    place(&mut app, b, at(-1.0));
    app.update();
    assert!(!collisions::<2>(&app).contains(b));
    app.world_mut().entity_mut(b).remove::<Disabled>();
    app.update();
    assert_eq!(told::<2>(&mut app), [(true, a, b)]);
    assert_eq!(collisions::<2>(&app).pose(b).map(|pose| pose.translation.x), Some(-1.0));

    let born = app.world_mut().spawn((ball::<2>(), Disabled)).id();
    app.update();
    assert!(!collisions::<2>(&app).contains(born), "disabled from the start");
}

#[test]
fn colliders_are_replaced_and_assigned() {
    let mut app = app::<3>();
    let (a, b) = (spawn::<3>(&mut app, 0.0), spawn::<3>(&mut app, 5.0));
    app.update();
    assert_eq!(told::<3>(&mut app), []);
    app.world_mut().entity_mut(a).insert(Collider::<3>::sphere(4.0));
    app.update();
    assert_eq!(told::<3>(&mut app), [(true, a, b)]);
    *app.world_mut().get_mut::<Collider<3>>(a).expect("it has one") =
        Collider::<3>::new(impinge_ball(0.5));
    app.update();
    assert_eq!(told::<3>(&mut app), [(false, a, b)]);
}

#[test]
fn layers_change_at_run_time() {
    let mut app = app::<3>();
    let (a, b) = (spawn::<3>(&mut app, 0.0), spawn::<3>(&mut app, 1.0));
    app.update();
    assert_eq!(told::<3>(&mut app), [(true, a, b)]);
    app.world_mut().entity_mut(a).insert(CollisionLayers::new(1, 1));
    app.world_mut().entity_mut(b).insert(CollisionLayers::new(2, 2));
    app.update();
    assert_eq!(told::<3>(&mut app), [(false, a, b)]);
    *app.world_mut().get_mut::<CollisionLayers>(b).expect("it has") = CollisionLayers::new(3, 3);
    app.update();
    assert_eq!(told::<3>(&mut app), [(true, a, b)], "assigned");
    app.world_mut().entity_mut(b).insert(CollisionLayers::NONE);
    app.update();
    assert_eq!(told::<3>(&mut app), [(false, a, b)]);
    // Four frames without a step. Bevy drops its record of the removed component before the next
    // step.
    app.world_mut().entity_mut(b).remove::<CollisionLayers>();
    for _ in 0..4 {
        app.world_mut().clear_trackers();
    }
    app.update();
    assert_eq!(told::<3>(&mut app), [(true, a, b)], "without the component it meets all");
}

#[test]
fn sensors_and_fixed_colliders_change_at_run_time() {
    let mut app = app::<2>();
    let (a, b) = (spawn::<2>(&mut app, 0.0), spawn::<2>(&mut app, 1.0));
    app.update();
    assert_eq!(collisions::<2>(&app).contact_pairs().count(), 1);
    told::<2>(&mut app);
    app.world_mut().entity_mut(a).insert(Sensor);
    app.update();
    assert_eq!(told::<2>(&mut app), [(false, a, b), (true, a, b)], "of another kind");
    assert_eq!(collisions::<2>(&app).contact_pairs().count(), 0, "sensors have no contacts");
    assert!(collisions::<2>(&app).are_touching(a, b));
    app.world_mut().entity_mut(a).remove::<Sensor>();
    app.update();
    assert_eq!(told::<2>(&mut app), [(false, a, b), (true, a, b)]);
    assert_eq!(collisions::<2>(&app).contact_pairs().count(), 1);

    app.world_mut().entity_mut(a).insert(FixedCollider);
    app.update();
    assert_eq!(told::<2>(&mut app), [], "one may be fixed");
    app.world_mut().entity_mut(b).insert(FixedCollider);
    app.update();
    assert_eq!(told::<2>(&mut app), [(false, a, b)], "not both");
    app.world_mut().entity_mut(a).remove::<FixedCollider>();
    app.update();
    assert_eq!(told::<2>(&mut app), [(true, a, b)]);
}

#[test]
fn despawning_a_tree_takes_all_of_it() {
    let mut app = app::<3>();
    let parent =
        app.world_mut().spawn((ball::<3>(), at(0.0))).with_child((ball::<3>(), at(1.0))).id();
    app.update();
    assert_eq!((collisions::<3>(&app).len(), told::<3>(&mut app).len()), (2, 1));
    app.world_mut().despawn(parent);
    app.update();
    assert_eq!((collisions::<3>(&app).len(), told::<3>(&mut app).len()), (0, 1));
    assert_eq!(collisions::<3>(&app).world().validate(), Ok(()));
}

/// The key that selects a second collision world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ghosts;

#[test]
fn worlds_do_not_see_each_other() {
    let mut app = app::<3>();
    let ghosts = ImpingePlugin::<3>::default().in_schedule(Update).in_world::<Ghosts>();
    app.add_plugins(ghosts);
    let living = spawn::<3>(&mut app, 0.0);
    let both = (ball::<3>(), ball::<3>().in_world::<Ghosts>(), at(1.0));
    let both = app.world_mut().spawn(both).id();
    let ghost = app.world_mut().spawn((ball::<3>().in_world::<Ghosts>(), at(0.5))).id();
    app.update();
    assert_eq!(told::<3>(&mut app), [(true, living, both)]);
    let of_ghosts = |app: &App| app.world().resource::<Collisions<3, Ghosts>>().touching(both);
    assert_eq!(of_ghosts(&app), [ghost]);
    app.world_mut().entity_mut(both).remove::<Collider<3>>();
    app.update();
    assert_eq!(told::<3>(&mut app), [(false, living, both)]);
    assert_eq!(of_ghosts(&app), [ghost], "still a ghost");
}
