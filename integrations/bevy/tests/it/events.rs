//! Tests of messages, observers and lists of touching entities.

use bevy_ecs::prelude::*;
use bevy_impinge::{CollidingEntities, CollisionEnded, CollisionStarted, Glam, Sensor};

use crate::support::{app, at, ball, collisions, place, spawn, told};

#[derive(Resource, Default)]
struct Seen(Vec<(&'static str, Entity, Entity, bool)>);

#[test]
fn observers_see_their_own_side() {
    let mut app = app::<3>();
    app.init_resource::<Seen>();
    let (a, b) = (spawn::<3>(&mut app, 0.0), spawn::<3>(&mut app, 1.0));
    app.add_observer(|event: On<CollisionStarted<3>>, mut seen: ResMut<Seen>| {
        seen.0.push(("started", event.entity, event.other, event.is_sensor));
    });
    let note = |event: On<CollisionEnded<3>>, mut seen: ResMut<Seen>| {
        seen.0.push(("b ended", event.entity, event.other, event.is_sensor));
    };
    app.world_mut().entity_mut(b).observe(note);
    app.update();
    let seen = std::mem::take(&mut app.world_mut().resource_mut::<Seen>().0);
    assert_eq!(seen, [("started", a, b, false), ("started", b, a, false)]);
    place(&mut app, a, at(-9.0));
    app.update();
    assert_eq!(app.world().resource::<Seen>().0, [("b ended", b, a, false)]);
}

#[test]
fn observers_may_despawn_what_they_see() {
    let mut app = app::<2>();
    let balls = [0.0, 1.0, 1.5].map(|x| spawn::<2>(&mut app, x));
    app.add_observer(|event: On<CollisionStarted<2>>, mut commands: Commands| {
        commands.entity(event.other).try_despawn();
    });
    app.update();
    assert_eq!(told::<2>(&mut app).len(), 3, "all three pairs began");
    app.update();
    assert_eq!(told::<2>(&mut app).len(), 3, "and ended");
    assert!(balls.iter().all(|&ball| app.world().get_entity(ball).is_err()));
    assert!(collisions::<2>(&app).is_empty());
}

fn lists_are_complete<const D: usize>()
where
    f32: Glam<D>,
{
    let mut app = app::<D>();
    let (a, b) = (spawn::<D>(&mut app, 0.0), spawn::<D>(&mut app, 1.0));
    let sensor = app.world_mut().spawn((ball::<D>(), Sensor, at(0.5))).id();
    app.world_mut().entity_mut(a).insert(CollidingEntities::<D>::default());
    app.update();
    let list = |app: &bevy_app::App, entity| {
        app.world().get::<CollidingEntities<D>>(entity).map(|list| list.to_vec())
    };
    assert_eq!(list(&app, a), Some(vec![b, sensor]), "contacts and sensors");
    app.world_mut().entity_mut(sensor).insert(CollidingEntities::<D>::default());
    app.update();
    assert_eq!(list(&app, sensor), Some(vec![a, b]), "inserted while they touch");
    place(&mut app, b, at(9.0));
    app.update();
    assert_eq!(list(&app, a), Some(vec![sensor]));
    app.world_mut().despawn(a);
    app.update();
    assert_eq!(list(&app, sensor), Some(vec![]));
    app.world_mut().entity_mut(sensor).remove::<Sensor>();
    place(&mut app, b, at(1.0));
    app.update();
    assert_eq!(list(&app, sensor), Some(vec![b]));
    app.world_mut().entity_mut(b).insert(Sensor);
    app.update();
    assert_eq!(list(&app, sensor), Some(vec![b]), "the pair ends and begins as another kind");
}

#[test]
fn lists_of_colliding_entities_are_complete() {
    lists_are_complete::<2>();
    lists_are_complete::<3>();
}

fn a_list_that_is_replaced_is_filled_again<const D: usize>()
where
    f32: Glam<D>,
{
    let mut app = app::<D>();
    let [a, b, c] = [0.0, 1.0, 9.0].map(|x| spawn::<D>(&mut app, x));
    app.world_mut().entity_mut(a).insert(CollidingEntities::<D>::default());
    app.world_mut().entity_mut(c).insert(CollidingEntities::<D>::default());
    app.update();
    let list = |app: &bevy_app::App, entity| {
        app.world().get::<CollidingEntities<D>>(entity).map(|list| list.to_vec())
    };
    app.world_mut().entity_mut(a).insert(CollidingEntities::<D>::default());
    app.update();
    assert_eq!(list(&app, a), Some(vec![b]), "another list in its place");
    *app.world_mut().get_mut::<CollidingEntities<D>>(a).expect("it has one") = Default::default();
    app.update();
    assert_eq!(list(&app, a), Some(vec![b]), "a list assigned");
    let full = app.world().get::<CollidingEntities<D>>(a).expect("it has one").clone();
    app.world_mut().entity_mut(c).insert(full.clone());
    app.update();
    assert_eq!(list(&app, c), Some(vec![]), "the list of another entity");
    place(&mut app, b, at(5.0));
    app.update();
    let mut other = app.world_mut().spawn(full);
    let other = other.insert((ball::<D>(), at(5.5))).id();
    app.update();
    assert_eq!((list(&app, a), list(&app, other)), (Some(vec![]), Some(vec![b])));
    let empty = CollidingEntities::<D>::default();
    assert_eq!(app.world().get::<CollidingEntities<D>>(a), Some(&empty), "filled or not");
}

#[test]
fn lists_of_colliding_entities_are_filled_again() {
    a_list_that_is_replaced_is_filled_again::<2>();
    a_list_that_is_replaced_is_filled_again::<3>();
}

#[test]
fn an_entity_with_two_children_of_its_own_gets_one_event_for_each_pair() {
    let mut app = app::<3>();
    let sensor = app.world_mut().spawn((ball::<3>(), Sensor, at(0.0))).id();
    let others = [0.5, -0.5, 0.25].map(|x| spawn::<3>(&mut app, x));
    app.update();
    let with_sensor: Vec<_> =
        told::<3>(&mut app).into_iter().filter(|&(_, a, b)| a == sensor || b == sensor).collect();
    let expected = others.map(|other| (true, sensor, other));
    assert_eq!(with_sensor, expected, "in the order of insertion");
}
