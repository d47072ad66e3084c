//! Tests of events, sensors, layers, hooks, removal and hierarchies.

use avian_impinge::d3;
use avian3d::prelude::*;
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

use crate::scenes3::{Backend, Impinge, app, dynamic, fixed, floor, place, sheet, steps};

#[derive(Resource, Default)]
struct Log {
    started: Vec<[Entity; 2]>,
    ended: Vec<[Entity; 2]>,
}

fn read(
    mut started: MessageReader<'_, '_, CollisionStart>,
    mut ended: MessageReader<'_, '_, CollisionEnd>,
    mut log: ResMut<'_, Log>,
) {
    log.started.extend(started.read().map(|event| sorted(event.collider1, event.collider2)));
    log.ended.extend(ended.read().map(|event| sorted(event.collider1, event.collider2)));
}

fn sorted(one: Entity, other: Entity) -> [Entity; 2] {
    [one.min(other), one.max(other)]
}

fn logged() -> App {
    let mut app = app::<Impinge>();
    app.init_resource::<Log>().add_systems(Last, read);
    app
}

fn counts(app: &App) -> [usize; 2] {
    let log = app.world().resource::<Log>();
    [log.started.len(), log.ended.len()]
}

#[test]
fn a_landing_is_told_and_a_removal_ends_it() {
    let mut app = logged();
    let floor = floor::<Impinge>(&mut app);
    let told = (CollisionEventsEnabled, CollidingEntities::default());
    let ball = (RigidBody::Dynamic, Impinge::sphere(0.5), Transform::from_xyz(0.0, 2.0, 0.0));
    let ball = app.world_mut().spawn((ball, told, SleepingDisabled)).id();
    steps(&mut app, 5);
    assert_eq!(counts(&app), [0, 0], "it falls");
    steps(&mut app, 120);
    assert_eq!(app.world().resource::<Log>().started, [sorted(floor, ball)]);
    assert!(app.world().get::<CollidingEntities>(ball).is_some_and(|all| all.contains(&floor)));

    app.world_mut().entity_mut(floor).remove::<d3::Collider>();
    steps(&mut app, 2);
    assert_eq!(app.world().resource::<Log>().ended, [sorted(floor, ball)]);
    steps(&mut app, 60);
    assert!(place(&app, ball).y < 0.0, "nothing carries it");
    app.world_mut().despawn(ball);
    steps(&mut app, 2);
    assert_eq!(counts(&app), [1, 1]);
}

#[test]
fn a_sensor_is_passed_and_tells() {
    let mut app = logged();
    let sensor = (RigidBody::Static, Impinge::cuboid(4.0, 1.0, 4.0), Transform::default());
    let sensor = app.world_mut().spawn((sensor, Sensor, CollisionEventsEnabled)).id();
    let ball = dynamic::<Impinge>(&mut app, Impinge::sphere(0.25), Vec3::Y * 2.0);
    steps(&mut app, 120);
    assert!(place(&app, ball).y < -4.0, "it fell through");
    let log = app.world().resource::<Log>();
    assert_eq!((&log.started[..], &log.ended[..]), (&[sorted(sensor, ball)][..], &log.started[..]));
}

#[test]
fn layers_part_what_does_not_meet() {
    let mut app = app::<Impinge>();
    let floor = floor::<Impinge>(&mut app);
    app.world_mut().entity_mut(floor).insert(CollisionLayers::new(0b10, 0b10));
    let [ghost, ball] = [0.0, 3.0]
        .map(|x| dynamic::<Impinge>(&mut app, Impinge::sphere(0.5), Vec3::new(x, 1.0, 0.0)));
    app.world_mut().entity_mut(ghost).insert(CollisionLayers::new(0b01, 0b01));
    app.world_mut().entity_mut(ball).insert(CollisionLayers::new(0b10, 0b11));
    steps(&mut app, 120);
    assert!(place(&app, ghost).y < -4.0);
    assert!((place(&app, ball).y - 0.5).abs() < 0.02);
}

#[derive(Component)]
struct OneWay;

#[derive(SystemParam)]
struct Gate<'w, 's> {
    one_way: Query<'w, 's, &'static OneWay>,
}

impl CollisionHooks for Gate<'_, '_> {
    fn filter_pairs(&self, one: Entity, other: Entity, _: &mut Commands<'_, '_>) -> bool {
        !self.one_way.contains(one) && !self.one_way.contains(other)
    }

    fn modify_contacts(&self, contacts: &mut ContactPair, _: &mut Commands<'_, '_>) -> bool {
        for manifold in &mut contacts.manifolds {
            manifold.tangent_velocity = Vec3::new(2.0, 0.0, 0.0) * manifold.normal.y.signum();
        }
        true
    }
}

#[test]
fn hooks_filter_and_modify() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, TimePlugin));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    let avian = PhysicsPlugins::default().with_collision_hooks::<Gate<'_, '_>>();
    #[cfg(feature = "parry")]
    let avian = avian
        .build()
        .disable::<ColliderBackendPlugin<Collider>>()
        .disable::<ColliderTreePlugin<Collider>>()
        .disable::<NarrowPhasePlugin<Collider, Gate<'_, '_>>>();
    let ours = d3::ImpingeColliderPlugin::default().with_collision_hooks::<Gate<'_, '_>>();
    app.add_plugins((avian, ours));
    app.finish();
    app.cleanup();
    let [below, cube] = [Impinge::cuboid(100.0, 2.0, 100.0), Impinge::cuboid(1.0, 1.0, 1.0)];
    let at = Transform::from_xyz(0.0, -1.0, 0.0);
    app.world_mut().spawn((RigidBody::Static, below, at, ActiveCollisionHooks::all()));
    let [ghost, carried] =
        [0.0, 3.0].map(|z| dynamic::<Impinge>(&mut app, cube.clone(), Vec3::new(0.0, 0.5, z)));
    app.world_mut().entity_mut(ghost).insert(OneWay);
    steps(&mut app, 120);
    assert!(place(&app, ghost).y < -4.0, "no pair");
    let carried = place(&app, carried);
    assert!(carried.x.abs() > 1.0 && (carried.y - 0.5).abs() < 0.02, "a conveyor: {carried}");
}

/// Tests a body with two scaled boxes as children, one on either side: asserts its height at rest
/// and its mass.
#[test]
fn colliders_of_children_carry_their_body() {
    let mut app = app::<Impinge>();
    floor::<Impinge>(&mut app);
    let at = Transform::from_xyz(0.0, 1.5, 0.0);
    let body = app.world_mut().spawn((RigidBody::Dynamic, at)).id();
    for x in [-1.0, 1.0] {
        let at = Transform::from_xyz(x, 0.0, 0.0).with_scale(Vec3::new(1.0, 2.0, 1.0));
        app.world_mut().spawn((d3::Collider::cuboid(0.5, 0.5, 0.5), at, ChildOf(body)));
    }
    steps(&mut app, 120);
    let at = place(&app, body);
    assert!((at - Vec3::Y * 0.5).length() < 0.02, "{at}");
    let mass = app.world().get::<ComputedMass>(body).expect("a body").value();
    assert!((mass - 0.5).abs() < 1e-5, "{mass}");
}

#[test]
fn a_shape_may_be_replaced() {
    let mut app = app::<Impinge>();
    floor::<Impinge>(&mut app);
    let body = dynamic::<Impinge>(&mut app, Impinge::sphere(0.5), Vec3::Y * 0.5);
    steps(&mut app, 20);
    let mut collider = app.world_mut().get_mut::<d3::Collider>(body).expect("it has one");
    *collider = d3::Collider::sphere(1.0);
    steps(&mut app, 200);
    let at = place(&app, body);
    assert!((at.y - 1.0).abs() < 0.02, "{at}");
    let mass = app.world().get::<ComputedMass>(body).expect("a body").value();
    assert!((mass - 4.0 / 3.0 * core::f32::consts::PI).abs() < 1e-4, "{mass}");
}

/// Asserts that ended pairs are removed: after 400 bodies, ten at a time, fewer than 100 pairs are
/// stored.
#[test]
fn pairs_are_forgotten() {
    let mut app = app::<Impinge>();
    fixed::<Impinge>(&mut app, sheet::<Impinge>(40, 1.0, |_, _| 0.0), Vec3::ZERO);
    for _ in 0..40 {
        let at = |x: usize| Vec3::new(1.5 * x as f32, 0.5, 0.0);
        let body = |x| dynamic::<Impinge>(&mut app, Impinge::sphere(0.5), at(x));
        let bodies: Vec<_> = (0..10).map(body).collect();
        steps(&mut app, 3);
        bodies.into_iter().for_each(|body| assert!(app.world_mut().despawn(body)));
    }
    let kept = app.world().resource::<d3::PairContacts>();
    assert!((10..100).contains(&kept.len()), "{kept:?} of 400");
}

/// Asserts that the states of despawned bodies are dropped even if new bodies have their indices:
/// Bevy gives freed indices away again, many of them before the next step.
#[test]
fn pairs_of_former_indices_are_forgotten() {
    let mut app = app::<Impinge>();
    fixed::<Impinge>(&mut app, sheet::<Impinge>(40, 1.0, |_, _| 0.0), Vec3::ZERO);
    for _ in 0..12 {
        let at = |i: usize| 1.25 * Vec3::new((i % 16) as f32 - 7.5, 0.4, (i / 16) as f32 - 7.5);
        let body = |i| dynamic::<Impinge>(&mut app, Impinge::sphere(0.5), at(i));
        let bodies: Vec<_> = (0..256).map(body).collect();
        steps(&mut app, 1);
        bodies.into_iter().for_each(|body| assert!(app.world_mut().despawn(body)));
    }
    let kept = app.world().resource::<d3::PairContacts>();
    assert!((256..=2 * 256 + 64).contains(&kept.len()), "{kept:?} of 3072");
}

/// Asserts that a clone of the resource has its pairs, and that bodies stay at rest if the resource
/// is cleared or replaced.
#[test]
fn pairs_may_be_cleared() {
    let mut app = app::<Impinge>();
    fixed::<Impinge>(&mut app, sheet::<Impinge>(40, 1.0, |_, _| 0.0), Vec3::ZERO);
    let body = dynamic::<Impinge>(&mut app, Impinge::cuboid(1.0, 1.0, 1.0), Vec3::Y * 0.5);
    steps(&mut app, 60);
    let kept = app.world().resource::<d3::PairContacts>().clone();
    assert_eq!(kept.len(), 1);
    app.world_mut().resource_mut::<d3::PairContacts>().clear();
    assert!(app.world().resource::<d3::PairContacts>().is_empty());
    steps(&mut app, 60);
    assert!((place(&app, body) - Vec3::Y * 0.5).length() < 0.02);
    // With an invalid tolerance contacts are recomputed in each step.
    app.insert_resource(d3::PairContacts::reusing(f32::NAN));
    steps(&mut app, 60);
    assert!((place(&app, body) - Vec3::Y * 0.5).length() < 0.02);
}

/// Asserts that colliders with invalid sizes or indices have an error, cause no panic, and do not
/// stop the app.
#[test]
fn nothing_panics() {
    let mut app = app::<Impinge>();
    floor::<Impinge>(&mut app);
    let shapes = [
        d3::Collider::sphere(f32::NAN),
        d3::Collider::cuboid(-1.0, 1.0, f32::INFINITY),
        d3::Collider::trimesh(vec![Vec3::ZERO], vec![[0, 1, 2]]),
        d3::Collider::heightfield(vec![], Vec3::ONE),
        d3::Collider::half_space(Vec3::ZERO),
    ];
    for shape in &shapes {
        assert!(shape.error().is_some(), "{shape:?}");
        let at = Transform::from_xyz(0.0, 0.2, 0.0);
        app.world_mut().spawn((RigidBody::Kinematic, shape.clone(), at));
    }
    let body = dynamic::<Impinge>(&mut app, Impinge::sphere(0.5), Vec3::Y * 0.6);
    steps(&mut app, 60);
    assert!((place(&app, body).y - 0.5).abs() < 0.02, "on the floor");
}

/// Avian's schedule does not allow two back ends, as the README says. If this no longer panics,
/// change the README.
#[cfg(feature = "parry")]
#[test]
#[should_panic(expected = "indeterminate execution order")]
fn two_back_ends_are_no_schedule() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, TimePlugin));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.add_plugins((PhysicsPlugins::default(), d3::ImpingeColliderPlugin::default()));
    app.finish();
    app.cleanup();
    steps(&mut app, 2);
}
