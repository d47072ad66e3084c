//! Tests which traits the public types implement: plain values, errors, and worlds that are `Send`
//! and `Sync` if their data are. Also compiles programs that depend on the lifetimes of borrows.

use std::fmt::Debug;
use std::hash::Hash;
use std::rc::Rc;

use impinge::dim2::bounding_volume::{Aabb, AabbError};
use impinge::dim2::broad_phase::{BroadPhaseError, DBVTBroadPhase, ProxyHandle};
use impinge::dim2::events::{ContactEvent, ProximityEvent};
use impinge::dim2::math::{Isometry, Real};
use impinge::dim2::na::{Isometry2, Vector2};
use impinge::dim2::query::{
    ClosestPoints, Contact, ContactId, ContactManifold, PointProjection, Proximity, Ray,
    RayIntersection,
};
use impinge::dim2::shape::{Ball, Capsule, Cuboid, FeatureId, Plane, ShapeError, ShapeHandle};
use impinge::dim2::world::{
    CollisionGroups, CollisionObjectHandle, CollisionWorld, GeometricQueryType, GroupError,
    WorldError,
};

fn key<T: Copy + Eq + Hash + Ord + Debug>() {}
fn name<T: Copy + Eq + Hash + Debug>() {}
fn value<T: Copy + PartialEq + Debug>() {}
fn error<T: std::error::Error + Send + Sync + 'static>() {}
fn shared<T: Send + Sync>() {}
fn sent<T: Send>() {}

#[test]
fn plain_values_are_plain() {
    key::<CollisionObjectHandle>();
    key::<ProxyHandle>();
    key::<ContactId>();
    name::<FeatureId>();
    name::<Proximity>();
    name::<ContactEvent>();
    name::<ProximityEvent>();
    value::<CollisionGroups>();
    value::<GeometricQueryType<f32>>();
    value::<Contact<f64>>();
    value::<ClosestPoints<f32>>();
    value::<PointProjection<f64>>();
    value::<Ray<f32>>();
    value::<RayIntersection<f32>>();
    value::<Aabb<f64>>();
    value::<Ball<f32>>();
    value::<Cuboid<f32>>();
    value::<Capsule<f64>>();
    value::<Plane<f64>>();
    error::<WorldError>();
    error::<GroupError>();
    error::<ShapeError>();
    error::<BroadPhaseError>();
    error::<AabbError>();
}

#[test]
fn a_world_is_what_its_data_is() {
    shared::<CollisionWorld<f32, u32>>();
    shared::<impinge::dim3::world::CollisionWorld<f64, String>>();
    shared::<DBVTBroadPhase<f64, Aabb<f64>, String>>();
    sent::<CollisionWorld<f32, std::cell::Cell<u32>>>();
}

/// Returns a world of two balls with the same centre, after its first update.
fn two<N: Real, T: Clone>(data: &T) -> CollisionWorld<N, T> {
    let mut world = CollisionWorld::new(N::lit(0.02));
    let shape = ShapeHandle::new(Ball::new(N::HALF));
    let query = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    for _ in 0..2 {
        let groups = CollisionGroups::new();
        world.add(Isometry::identity(), shape.clone(), groups, query, data.clone());
    }
    world.update();
    world
}

/// Returns the number of contacts, by collecting the manifolds of all pairs in one list.
fn count<N: Real, T>(world: &CollisionWorld<N, T>) -> usize {
    let mut manifolds: Vec<&ContactManifold<N>> = Vec::new();
    for (_, _, algorithm) in world.contact_pairs() {
        algorithm.contacts(&mut manifolds);
    }
    manifolds.iter().map(|manifold| manifold.len()).sum()
}

#[test]
fn data_may_be_anything() {
    let local = String::from("borrowed");
    assert_eq!(count(&two::<f32, _>(&())), 1, "nothing");
    assert_eq!(count(&two::<f64, _>(&Rc::new(std::cell::Cell::new(1)))), 1, "not to be sent");
    assert_eq!(count(&two::<f64, _>(&&local)), 1, "a reference");
    assert_eq!(count(&two::<f32, _>(&|| 3)), 1, "a closure");
}

/// Returns the number of contact points of a tilted box whose lowest corner is below the surface of
/// a half-space. Both objects have the angular prediction `angle`.
fn points_of_a_tilted_box(angle: f64) -> usize {
    let mut world = CollisionWorld::new(0.02);
    let (query, groups) = (GeometricQueryType::Contacts(0.0, angle), CollisionGroups::new());
    let ground = ShapeHandle::new(Plane::new(Vector2::y_axis()));
    let cuboid = ShapeHandle::new(Cuboid::new(Vector2::new(1.0, 1.0)));
    world.add(Isometry2::identity(), ground, groups, query, ());
    world.add(Isometry2::new(Vector2::new(0.0, 1.3), 0.4), cuboid, groups, query, ());
    world.update();
    count(&world)
}

/// Asserts that a larger angular prediction never gives fewer points, even beyond a right angle,
/// where its sine decreases or is negative.
#[test]
fn angular_predictions_beyond_a_right_angle() {
    assert_eq!(points_of_a_tilted_box(0.0), 1, "the lower corner");
    for angle in [0.25, 0.5, 1.0, 1.55, 2.0, 3.0, 50.0, 1e300] {
        assert_eq!(points_of_a_tilted_box(angle), 2, "and the one beside it: {angle}");
    }
}
