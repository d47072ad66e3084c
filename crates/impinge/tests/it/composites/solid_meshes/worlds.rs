//! Tests that worlds, batches and checkers treat the inside of a solid mesh as part of the solid.

use super::{P3, V3, at, ball, cuboid, skin, solid};

use impinge::batch::{Control, OnePose, PairBatch, PointBatch, Shapes, Side};
use impinge::checker::{Body, Checker, Frame, FrameTree, Joint, Obstacle};
use impinge::dim2;
use impinge::math::{Isometry2, Isometry3, Point, Pose, Vector};
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactEvent, GeometricQueryType, ProximityEvent,
};
use impinge::query::{Proximity, Ray, distance, proximity};
use impinge::shape::{Ball, Cuboid, Polyline, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};

type World = CollisionWorld<f64, 3, ()>;

fn contacts() -> GeometricQueryType<f64> {
    GeometricQueryType::Contacts(0.01, 0.0)
}

/// Returns a world with a solid mesh at the origin and a small ball at `place`, and both handles.
fn stage(
    body: TriMesh<f64, 3>,
    query: GeometricQueryType<f64>,
    place: Isometry3<f64>,
) -> (World, [CollisionObjectHandle; 2]) {
    let mut world = World::new(0.02);
    let groups = CollisionGroups::new();
    let body = world.add(at([0.0; 3]), ShapeHandle::new(body), groups, query, ());
    let small = world.add(place, ShapeHandle::new(Ball::new(0.25)), groups, query, ());
    (world, [body, small])
}

#[test]
fn a_ball_inside_has_its_event_and_is_pushed_out() {
    let body = solid(cuboid::<f64>([4.0; 3], [0.0; 3]));
    let (mut world, [body, small]) = stage(body, contacts(), at([1.0, 2.0, 0.5]));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Started(body, small)]);
    let mut depths = Vec::new();
    let mut place = V3::new(1.0, 2.0, 0.5);
    for _ in 0..100 {
        world.validate().expect("sound");
        let Some((_, _, manifold)) = world.contact_manifolds().next() else { break };
        assert_eq!(world.contact_manifolds().count(), 1, "one way out");
        let found = manifold.deepest_contact().expect("not empty").contact;
        if found.depth <= 0.0 {
            break;
        }
        assert_eq!(found.normal.into_inner(), V3::y());
        depths.push(found.depth);
        place += found.normal.into_inner() * found.depth.min(0.125);
        world.set_position(small, at([place.x, place.y, place.z]));
        world.update();
    }
    assert_eq!(depths.first(), Some(&2.25), "as deep as it lies below the top");
    let steps = depths.windows(2).map(|pair| pair[0] - pair[1]);
    assert!(
        steps.into_iter().all(|step| (step - 0.125).abs() < 1e-12),
        "no jump at the wall: {depths:?}"
    );
    assert!((place.y - 4.25).abs() < 1e-12, "{place}");
    world.set_position(small, at([0.0, 9.0, 0.0]));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Stopped(body, small)]);
    world.set_position(small, at([0.0; 3]));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Started(body, small)], "it was put there");
    world.remove(&[small]);
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Stopped(body, small)]);
}

#[test]
fn proximities_and_queries() {
    let body = solid(cuboid::<f64>([4.0; 3], [0.0; 3]));
    let query = GeometricQueryType::Proximity(0.5);
    let (mut world, [body, small]) = stage(body, query, at([9.0, 0.0, 0.0]));
    world.update();
    assert!(world.proximity_events().is_empty());
    world.set_position(small, at([1.0, 0.0, 0.0]));
    world.update();
    let event = world.proximity_events().to_vec();
    assert!(
        matches!(event[..], [ProximityEvent { new_status: Proximity::Intersecting, .. }]),
        "{event:?}"
    );
    let all = CollisionGroups::new();
    let inside = P3::new(-2.0, 1.0, 0.0);
    let held: Vec<_> = world
        .interferences_with_point(&inside, &all)
        .map(impinge::dim3::world::CollisionObject::handle)
        .collect();
    assert_eq!(held, [body], "the point is inside");
    let ray = Ray::new(inside, V3::z());
    let hits: Vec<_> = world
        .interferences_with_ray(&ray, &all)
        .map(|(object, hit)| (object.handle(), hit.toi))
        .collect();
    assert_eq!(hits, [(body, 0.0)]);
    let everything = (&all).into();
    let probe = Cuboid::new(V3::repeat(0.125));
    assert!(world.overlaps_any(&at([-3.0, 0.0, 0.0]), &probe, &everything));
    assert!(!world.overlaps_any(&at([-5.0, 0.0, 0.0]), &probe, &everything));
}

#[test]
fn a_body_that_is_deformed_or_replaced() {
    let room = skin(cuboid::<f64>([4.0; 3], [0.0; 3]));
    let (mut world, [body, small]) = stage(room.clone(), contacts(), at([0.0; 3]));
    world.update();
    assert!(world.contact_events().is_empty(), "a room");
    world.set_shape(body, ShapeHandle::new(room.clone().solid()));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Started(body, small)]);
    let moved: Vec<_> = room.vertices().iter().map(|v| v + V3::new(20.0, 0.0, 0.0)).collect();
    world.deform(body, |mesh: &mut TriMesh<f64, 3>| mesh.set_vertices(&moved));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Stopped(body, small)]);
    world.deform(body, |mesh: &mut TriMesh<f64, 3>| mesh.set_vertices(room.vertices()));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Started(body, small)]);
}

#[test]
fn the_plane_as_well() {
    type Plane = CollisionWorld<f64, 2, ()>;
    let corners = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]].map(Point::from);
    let mut world = Plane::new(0.02);
    let (groups, query) = (CollisionGroups::new(), contacts());
    let body = ShapeHandle::new(Polyline::closed(corners.to_vec()).solid());
    let body = world.add(Isometry2::identity(), body, groups, query, ());
    let small = ShapeHandle::new(dim2::shape::Cuboid::new(Vector::<f64, 2>::new(0.5, 0.5)));
    let small = world.add(Isometry2::translation(4.0, 5.0), small, groups, query, ());
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Started(body, small)]);
    let mut height = 5.0;
    for _ in 0..50 {
        let Some((_, _, manifold)) = world.contact_manifolds().next() else { break };
        let found = manifold.deepest_contact().expect("not empty").contact;
        if found.depth <= 0.0 {
            break;
        }
        assert_eq!((manifold.len(), found.normal.y), (2, 1.0), "a face at {height}");
        assert!((found.depth - (8.5 - height)).abs() < 1e-12);
        height += found.depth.min(0.25);
        world.set_position(small, Isometry2::translation(4.0, height));
        world.update();
    }
    assert_eq!(height, 8.5);
}

#[test]
fn batches_say_the_same() {
    let (body, small) = (solid(ball::<f64>(2.0, 12)), Ball::new(0.25));
    let place = |at: usize| V3::new(0.25 * f64::from(u32::try_from(at).expect("few")), 0.1, 0.0);
    let poses: Vec<_> = (0..16).map(|at| Pose::from_translation(place(at))).collect();
    let here = OnePose(Pose::<f64, 3>::identity());
    let one = Side::try_new(Shapes::One(&body), &here).expect("one");
    let many = Side::try_new(Shapes::One(&small), &poses).expect("many");
    let (pairs, control) =
        (PairBatch::try_new(one, many).expect("one against many"), Control::default());
    let (mut found, mut near) = ([0.0; 16], [Proximity::Disjoint; 16]);
    pairs.distances(&control, &mut found).expect("not cancelled");
    pairs.proximities(0.5, &control, &mut near).expect("not cancelled");
    for (at, (found, near)) in found.into_iter().zip(near).enumerate() {
        let [x, y, z] = place(at).into();
        let (here, there) = (Isometry3::identity(), Isometry3::translation(x, y, z));
        assert_eq!(found, distance(&here, &body, &there, &small), "{at}");
        assert_eq!(near, proximity(&here, &body, &there, &small, 0.5), "{at}");
    }
    assert!(found.iter().filter(|&&distance| distance == 0.0).count() >= 9, "{found:?}");
    let points = PointBatch::try_new(one, &[[0.0, 0.5, 0.0], [5.0, 0.0, 0.0]]).expect("two points");
    let mut held = [false; 2];
    points.contains(&control, &mut held).expect("not cancelled");
    assert_eq!(held, [true, false]);
}

#[test]
fn robots_are_not_free_inside() {
    let joint = Joint::prismatic(V3::x_axis(), 0);
    let frames = [Frame { parent: None, origin: Pose::identity(), joint }];
    let tree = FrameTree::try_new(&frames, 1).expect("one joint");
    let shape = ShapeHandle::new(Ball::new(0.25));
    let bodies = vec![Body { frame: 0, shape, pose: Pose::identity() }];
    let mut checker = Checker::try_new(tree, bodies, &[]).expect("one body");
    for (is_solid, inside) in [(false, true), (true, false)] {
        let room = skin(cuboid::<f64>([4.0; 3], [0.0; 3]));
        let room = ShapeHandle::new(if is_solid { room.solid() } else { room });
        let obstacle = Obstacle { shape: room, pose: Pose::identity() };
        checker.try_set_obstacles(vec![obstacle], &[]).expect("one obstacle");
        let mut free = [true; 3];
        checker.are_free(&[0.0, 4.0, 9.0], 0.0, &Control::new(), &mut free).expect("three");
        assert_eq!(free, [inside, false, true]);
    }
}
