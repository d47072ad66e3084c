//! What panics say: the handle or the value at fault, in the words of the error of the `try_` twin.

use std::panic::{AssertUnwindSafe, catch_unwind};

use impinge::dim2::bounding_volume::Aabb;
use impinge::dim2::broad_phase::{BroadPhase, DBVTBroadPhase};
use impinge::dim2::na::{Isometry2, Point2, Vector2};
use impinge::dim2::shape::{
    Ball, Capsule, ConvexPolygon, ConvexPolyhedron, Cuboid, FeatureId, Segment, ShapeHandle,
};
use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};

/// What a call panics with.
fn message<R>(call: impl FnOnce() -> R) -> String {
    let Err(panic) = catch_unwind(AssertUnwindSafe(call)) else { panic!("no panic") };
    *panic.downcast::<String>().expect("a formatted message")
}

/// The call panics with a message that holds all of `parts`.
#[track_caller]
fn names<R>(parts: &[&str], call: impl FnOnce() -> R) {
    let message = message(call);
    for part in parts {
        assert!(message.contains(part), "{part} is not in {message:?}");
    }
}

fn at(x: f64, y: f64) -> Isometry2<f64> {
    Isometry2::translation(x, y)
}

#[test]
fn a_world_names_handles_and_values() {
    let mut world = CollisionWorld::new(0.02);
    let (ball, groups) = (ShapeHandle::new(Ball::new(0.5)), CollisionGroups::new());
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    let bad = GeometricQueryType::Proximity(-2.5);
    let kept = world.add(at(0.0, 0.0), ball.clone(), groups, query, ());
    let gone = world.add(at(0.0, 0.0), ball.clone(), groups, query, ());
    world.remove(&[gone]);
    let (kept_name, gone_name) = (format!("{kept:?}"), format!("{gone:?}"));
    names(&[&gone_name], || world.remove(&[kept, gone]));
    names(&[&kept_name, "twice"], || world.remove(&[kept, kept]));
    names(&[&gone_name], || world.set_position(gone, at(0.0, 0.0)));
    names(&[&kept_name, "NaN"], || world.set_position(kept, at(f64::NAN, 0.0)));
    names(&["inf"], || world.add(at(0.0, f64::INFINITY), ball.clone(), groups, query, ()));
    names(&["-2.5"], || world.add(at(0.0, 0.0), ball.clone(), groups, bad, ()));
    names(&[&gone_name], || world.set_shape(gone, ball.clone()));
    names(&[&gone_name], || world.set_collision_groups(gone, groups));
    names(&[&gone_name], || world.set_query_type(gone, query));
    names(&["-2.5"], || world.set_query_type(kept, bad));
    names(&["-1"], || CollisionWorld::<f64, ()>::new(-1.0));
    let object = world.collision_object(kept).expect("nothing was removed");
    assert_eq!(*object.position(), at(0.0, 0.0), "nor moved");
    assert_eq!((world.len(), object.query_type()), (1, query), "nor changed, nor added to");
}

#[test]
fn groups_name_the_group() {
    let mut groups = CollisionGroups::new();
    for group in [30, 31, 32, 64, usize::MAX] {
        let name = group.to_string();
        names(&[&name], || groups.set_membership(&[1, group]));
        names(&[&name], || groups.set_whitelist(&[1, group]));
        names(&[&name], || groups.set_blacklist(&[1, group]));
        names(&[&name], || groups.modify_membership(group, false));
        names(&[&name], || groups.modify_whitelist(group, true));
        names(&[&name], || groups.modify_blacklist(group, true));
    }
    assert_eq!(groups, CollisionGroups::new(), "unchanged");
}

#[test]
fn a_broad_phase_names_handles_and_margins() {
    let volume = Aabb::new(Point2::new(0.0_f64, 0.0), Point2::new(1.0, 1.0));
    let mut broad_phase = DBVTBroadPhase::new(0.1);
    let gone = broad_phase.create_proxy(volume, ());
    broad_phase.remove(&[gone], &mut |(), ()| ());
    let name = format!("{gone:?}");
    names(&[&name], || broad_phase.remove(&[gone], &mut |(), ()| ()));
    names(&[&name], || broad_phase.deferred_set_bounding_volume(gone, volume));
    names(&[&name], || broad_phase.deferred_recompute_all_proximities_with(gone));
    names(&["-1"], || DBVTBroadPhase::<f64, Aabb<f64>, ()>::new(-1.0));
}

#[test]
fn sizes_are_named() {
    names(&["radius", "-1.5"], || Ball::new(-1.5_f32));
    names(&["half extent", "-2.5"], || Cuboid::new(Vector2::new(1.0, -2.5_f32)));
    names(&["radius", "NaN"], || Capsule::<f32>::new(1.0, f32::NAN));
    names(&["first end", "inf"], || {
        Segment::new(Point2::new(0.0, f32::INFINITY), Point2::origin())
    });
    names(&["axis 1", "3", "-2"], || Aabb::new(Point2::new(0.0_f32, 3.0), Point2::new(0.0, -2.0)));
}

#[test]
fn points_that_span_nothing_are_described() {
    let line = [[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]].map(Point2::<f64>::from);
    names(&["lie on one line"], || ConvexPolygon::from_points(&line));
    names(&["coincide"], || ConvexPolygon::from_points(&[Point2::<f64>::origin(); 5]));
    names(&["2 points", "3"], || ConvexPolygon::from_points(&line[..2]));
}

#[test]
fn features_that_are_not_there_are_named() {
    let cuboid = Cuboid::new(Vector2::new(1.0_f64, 1.0));
    names(&["no vertex", "Vertex(4)"], || cuboid.vertex(FeatureId::Vertex(4)));
    names(&["no face", "Edge(0)"], || cuboid.edge(FeatureId::Edge(0)));
    names(&["Face(4)"], || cuboid.feature_normal(FeatureId::Face(4)));
}
