//! Tests that panic messages name the handle or value at fault, with the text of the error of the
//! matching `try_` method.

use std::panic::{AssertUnwindSafe, catch_unwind};

use impinge::dim2::bounding_volume::Aabb;
use impinge::dim2::broad_phase::{BroadPhase, DBVTBroadPhase};
use impinge::dim2::na::{Isometry2, Point2, Vector2};
use impinge::dim2::narrow_phase::DefaultNarrowPhase;
use impinge::dim2::query::ConstantVelocities;
use impinge::dim2::shape::{
    Ball, Capsule, Compound, ConvexPolygon, ConvexPolyhedron, Cuboid, FeatureId, HeightField,
    Polyline, Segment, ShapeHandle, TriMesh,
};
use impinge::dim2::world::{CollisionGroups, CollisionObject, CollisionWorld, GeometricQueryType};

/// Returns the message with which `call` panics.
fn message<R>(call: impl FnOnce() -> R) -> String {
    let Err(panic) = catch_unwind(AssertUnwindSafe(call)) else { panic!("no panic") };
    *panic.downcast::<String>().expect("a formatted message")
}

/// Asserts that `call` panics with a message that contains all of `parts`.
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

/// Names of private fields and parts, which debug output must not contain, because users do not
/// know them.
const INSIDES: [&str; 22] = [
    "state",
    "blocks",
    "quartets",
    "fans",
    "tree",
    "lanes",
    "pyramid",
    "marks",
    "topology",
    "bends",
    "joints",
    "identity",
    "raw",
    "placement",
    "slots",
    "records",
    "finder",
    "table",
    "entries",
    "rule",
    "2147483647",
    "4294967295",
];

/// Asserts that the debug output of a value contains all of `parts` and none of [`INSIDES`].
#[track_caller]
fn prints(value: &dyn std::fmt::Debug, parts: &[&str]) {
    let text = format!("{value:?}");
    for part in parts {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    for inside in INSIDES {
        assert!(!text.contains(inside), "{inside} is in {text}");
    }
    assert!(text.len() < 2000, "{} characters: {text}", text.len());
}

#[test]
fn worlds_print_what_users_know() {
    let mut world = CollisionWorld::new(0.02_f64);
    let (ball, groups) = (ShapeHandle::new(Ball::new(0.5)), CollisionGroups::new());
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    prints(&world, &["num_objects: 0", "pending: []"]);
    let [a, b] = [0.0, 0.5].map(|x| world.add(at(x, 0.0), ball.clone(), groups, query, "name"));
    prints(&world, &["num_objects: 2", "num_pairs: 0", "changed objects: 2"]);
    world.update();
    prints(&world, &["num_pairs: 1", "pending: []"]);
    prints(
        world.collision_object(a).expect("there"),
        &["Ball { radius: 0.5 }", "query_type", "\"name\""],
    );
    prints(&world.contact_pair(a, b), &["num_contacts: 1"]);
    for (_, _, view) in world.contact_views() {
        prints(&view, &["depth: 0.5"]);
    }
    for (_, _, manifold) in world.contact_manifolds() {
        prints(manifold, &["depth: 0.5", "local1"]);
    }
    world.set_position(a, at(0.0, 0.0));
    prints(&world, &["pending: []"]);
    world.set_position(a, at(0.1, 0.0));
    world.unregister_broad_phase_pair_filter("none");
    prints(&world, &["changed objects: 1\"]"]);
    world.remove(&[a]);
    type Object = CollisionObject<f64, &'static str>;
    world.register_broad_phase_pair_filter("all", |_: &Object, _: &Object| true);
    world.set_broad_phase(Box::new(DBVTBroadPhase::new(0.1)));
    world.set_narrow_phase(Box::new(DefaultNarrowPhase::new()));
    let pending = ["queued events: 1", "other filters", "broad phase", "narrow phase"];
    prints(&world, &pending);
    assert!(!format!("{world:?}").contains("changed objects"), "it is gone");
    world.update();
    prints(&world, &["num_objects: 1", "filters: [\"all\"]", "pending: []"]);
    prints(&DefaultNarrowPhase::<f64>::new(), &["pairs: 0"]);
    let mut broad_phase = DBVTBroadPhase::<f64, Aabb<f64>, ()>::new(0.1);
    broad_phase.create_proxy(Aabb::new(Point2::origin(), Point2::origin()), ());
    prints(&broad_phase, &["num_proxies: 1", "num_pairs: 0", "margin: 0.1"]);
}

#[test]
fn shapes_print_what_they_were_made_of() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::<f64>::from);
    let ball = ShapeHandle::new(Ball::new(0.5));
    prints(&ball, &["radius: 0.5"]);
    prints(&Compound::new(vec![(at(1.0, 2.0), ball)]), &["children", "radius: 0.5"]);
    prints(&ConvexPolygon::new(&square), &["ConvexPolygon", "[1.0, 1.0]"]);
    prints(
        &Polyline::<f64>::open(square.to_vec()).one_sided(),
        &["num_segments: 3", "is_one_sided: true"],
    );
    let mesh = TriMesh::new(square.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    prints(&mesh, &["num_vertices: 4", "num_triangles: 2"]);
    prints(mesh.tree(), &["BoxTree"]);
    let field = HeightField::<f64>::new(vec![0.0; 100_000], Vector2::new(1.0, 1.0));
    prints(&field, &["num_heights: 100000", "is_one_sided: false"]);
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let corners = corners.map(impinge::dim3::math::Point::<f32>::from);
    let hull = impinge::dim3::shape::ConvexHull::from_points(&corners);
    prints(&hull, &["ConvexHull", "faces", "[0.0, 0.0, 1.0]"]);
    prints(hull.polytope(), &["Polytope", "faces"]);
    prints(&impinge::dim3::shape::Tetrahedron::new(corners), &["corners"]);
    let turning = ConstantVelocities::<f64>::new(at(1.0, 0.0), Vector2::x(), 0.5);
    prints(&turning, &["linear", "turn: 0.5"]);
}

#[test]
fn what_is_too_little_is_said_in_the_words_of_the_shape() {
    names(&["line", "two", "1 is given"], || Polyline::<f64>::open(vec![Point2::origin()]));
    names(&["line", "two", "0 is given"], || Polyline::<f64>::closed(Vec::new()));
    names(&["no part", "polyline a segment"], || Polyline::<f64>::new(vec![], vec![]));
    names(&["no part", "mesh needs a triangle"], || TriMesh::<f64>::new(vec![], vec![]));
    names(&["height field", "2", "1 is given"], || {
        HeightField::<f64>::new(vec![0.0], Vector2::new(1.0, 1.0))
    });
    names(&["compound", "child"], || Compound::<f64>::new(Vec::new()));
    names(&["part 0", "vertex 7", "1 vertices"], || {
        Polyline::<f64>::new(vec![Point2::origin()], vec![[0, 7]])
    });
}
