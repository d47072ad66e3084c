//! Tests of events, sensors, removal, scale and queries.

use avian_impinge::d2;
use avian2d::prelude::*;
use bevy_app::{App, Last};
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir2, Vec2, Vec3};
use bevy_transform::prelude::*;

use crate::scenes2::{Backend, Impinge, app, dynamic, floor, place, steps};

#[derive(Resource, Default)]
struct Count {
    started: usize,
    ended: usize,
}

fn read(
    mut started: MessageReader<'_, '_, CollisionStart>,
    mut ended: MessageReader<'_, '_, CollisionEnd>,
    mut count: ResMut<'_, Count>,
) {
    count.started += started.read().count();
    count.ended += ended.read().count();
}

/// Lets a ball fall through a sensor onto the floor, then removes the floor. Returns the numbers of
/// start and end messages after the sensor, after the landing, and after the removal.
fn told<B: Backend>() -> [[usize; 2]; 3] {
    let mut app = app::<B>();
    app.init_resource::<Count>().add_systems(Last, read);
    let at = Transform::from_xyz(0.0, 2.0, 0.0);
    let sensor = (RigidBody::Static, B::rectangle(3.0, 0.5), at, Sensor);
    app.world_mut().spawn((sensor, CollisionEventsEnabled));
    let ball = (RigidBody::Dynamic, B::circle(0.5), Transform::from_xyz(0.0, 4.0, 0.0));
    let ball = app.world_mut().spawn((ball, SleepingDisabled, CollisionEventsEnabled)).id();
    let floor = floor::<B>(&mut app);
    let counts = |app: &App| {
        let count = app.world().resource::<Count>();
        [count.started, count.ended]
    };
    steps(&mut app, 52);
    let passed = counts(&app);
    steps(&mut app, 100);
    assert!((place(&app, ball).y - 0.5).abs() < 0.02);
    let landed = counts(&app);
    app.world_mut().despawn(floor);
    steps(&mut app, 60);
    assert!(place(&app, ball).y < 0.0, "nothing carries it");
    [passed, landed, counts(&app)]
}

#[test]
fn starts_and_ends_are_told() {
    let [passed, landed, last] = told::<Impinge>();
    println!("{passed:?} {landed:?} {last:?}");
    assert_eq!(passed, [1, 1], "the sensor");
    assert_eq!(landed[0], landed[1] + 1, "it lies there");
    assert_eq!(last, [landed[0]; 2]);
}

#[cfg(feature = "parry")]
#[test]
fn beside_parry() {
    println!("parry: {:?}", told::<crate::scenes2::Parry>());
}

#[test]
fn layers_part_what_does_not_meet() {
    let mut app = app::<Impinge>();
    floor::<Impinge>(&mut app);
    let [ghost, ball] =
        [0.0, 3.0].map(|x| dynamic::<Impinge>(&mut app, Impinge::circle(0.5), Vec2::new(x, 1.0)));
    app.world_mut().entity_mut(ghost).insert(CollisionLayers::new(0b10, 0b10));
    steps(&mut app, 120);
    assert!(place(&app, ghost).y < -4.0);
    assert!((place(&app, ball).y - 0.5).abs() < 0.02);
}

#[test]
fn a_scaled_body_stands_on_its_scaled_side() {
    let mut app = app::<Impinge>();
    floor::<Impinge>(&mut app);
    let at = Transform::from_xyz(0.0, 1.5, 0.0).with_scale(Vec3::new(3.0, 2.0, 1.0));
    let body = (RigidBody::Dynamic, d2::Collider::rectangle(1.0, 1.0), at);
    let body = app.world_mut().spawn(body).id();
    steps(&mut app, 120);
    assert!((place(&app, body) - Vec2::Y).length() < 0.02);
    let mass = app.world().get::<ComputedMass>(body).expect("a body").value();
    assert!((mass - 6.0).abs() < 1e-4, "{mass}");
}

#[test]
fn queries() {
    let mut app = app::<Impinge>();
    let floor = floor::<Impinge>(&mut app);
    let ball = dynamic::<Impinge>(&mut app, Impinge::circle(0.5), Vec2::Y * 0.5);
    steps(&mut app, 10);
    let ask = move |spatial: d2::SpatialQuery<'_, '_>| {
        let all = SpatialQueryFilter::default();
        let ray = spatial.cast_ray(Vec2::new(-3.0, 0.5), Dir2::X, 9.0, true, &all);
        let ray = ray.expect("the ball");
        assert!(ray.entity == ball && (ray.distance - 2.5).abs() < 0.01, "{ray:?}");
        let hits = spatial.ray_hits(Vec2::Y * 3.0, Dir2::NEG_Y, 9.0, 9, true, &all);
        assert_eq!(hits.iter().map(|hit| hit.entity).collect::<Vec<_>>(), [ball, floor]);
        let (config, from) = (d2::ShapeCastConfig::default(), Vec2::new(0.2, 4.0));
        let shape = d2::Collider::rectangle(1.0, 1.0);
        let hit = spatial.cast_shape(&shape, from, 0.0, Dir2::NEG_Y, &config, &all);
        let hit = hit.expect("the ball");
        assert!(hit.entity == ball && (hit.distance - 2.5).abs() < 0.02, "{hit:?}");
        let near = spatial.project_point(Vec2::new(0.0, 3.0), true, &all).expect("the ball");
        assert!(near.entity == ball && (near.point.y - 1.0).abs() < 0.01, "{near:?}");
        assert_eq!(spatial.point_intersections(Vec2::new(5.0, -0.5), &all), [floor]);
        let mut both = [floor, ball];
        both.sort();
        assert_eq!(spatial.shape_intersections(&shape, Vec2::Y * 0.4, 0.3, &all), both);
    };
    app.world_mut().run_system_once(ask).expect("it has what it reads");
}
