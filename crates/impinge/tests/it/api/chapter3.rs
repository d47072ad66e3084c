//! The programs of the guide's pipeline chapter in 3D: the two phases on their own, groups, filters
//! and queries of two solids.

use impinge::dim3::bounding_volume::{self, Aabb};
use impinge::dim3::broad_phase::{BroadPhase, DBVTBroadPhase};
use impinge::dim3::na::{self, Isometry3, Point3, Vector3};
use impinge::dim3::narrow_phase::{
    ContactAlgorithm, ContactDispatcher, DefaultContactDispatcher, DefaultProximityDispatcher,
    IdAllocator, ProximityAlgorithm, ProximityDispatcher,
};
use impinge::dim3::query::{
    ClosestPoints, Contact, ContactManifold, ContactPrediction, PointQuery, Proximity, Ray,
    RayCast, closest_points, contact, distance, proximity, time_of_impact,
};
use impinge::dim3::shape::{Ball, Cuboid, Plane, Shape, ShapeHandle};
use impinge::dim3::world::{
    BroadPhasePairFilter, CollisionGroups, CollisionObject, CollisionWorld, GeometricQueryType,
};

#[test]
fn four_balls() {
    let poss = [
        Isometry3::new(Vector3::new(0.0, 0.0, 0.0), na::zero()),
        Isometry3::new(Vector3::new(0.0, 0.5, 0.0), na::zero()),
        Isometry3::new(Vector3::new(0.5, 0.0, 0.0), na::zero()),
        Isometry3::new(Vector3::new(0.5, 0.5, 0.0), na::zero()),
    ];
    let ball = Ball::new(0.5);
    let mut bf = DBVTBroadPhase::new(0.2f32);
    let proxy1 = bf.create_proxy(bounding_volume::aabb(&ball, &poss[0]), 0);
    let proxy2 = bf.create_proxy(bounding_volume::aabb(&ball, &poss[1]), 1);
    let _ = bf.create_proxy(bounding_volume::aabb(&ball, &poss[2]), 2);
    let _ = bf.create_proxy(bounding_volume::aabb(&ball, &poss[3]), 3);
    bf.update(&mut |a, b| *a != *b, &mut |_, _, _| {});
    assert_eq!(bf.num_interferences(), 6, "all with all");
    let mut called = 0;
    bf.remove(&[proxy1, proxy2], &mut |_, _| called += 1);
    assert_eq!(called, 5, "all but one involve a removed ball");
    bf.update(&mut |a, b| *a != *b, &mut |_, _, _| {});
    assert_eq!(bf.num_interferences(), 1, "the other two");
}

#[test]
fn three_groups() {
    let mut group_a = CollisionGroups::new();
    let mut group_b = CollisionGroups::new();
    let mut group_c = CollisionGroups::new();
    group_a.set_membership(&[1, 3, 6]);
    group_a.set_whitelist(&[6, 7]);
    group_a.set_blacklist(&[1]);
    group_b.set_membership(&[1, 3, 7]);
    group_b.set_whitelist(&[3, 7]);
    group_c.set_membership(&[6, 9]);
    group_c.set_whitelist(&[3, 7]);
    assert!(!group_a.can_interact_with_groups(&group_b), "b is in group 1, which a blacklists");
    assert!(!group_b.can_interact_with_groups(&group_c), "c is in no group that b whitelists");
    assert!(group_a.can_interact_with_groups(&group_c), "c is in 6, a is in 3");
}

struct IdParityFilter;

impl BroadPhasePairFilter<f32, ()> for IdParityFilter {
    fn is_pair_valid(&self, b1: &CollisionObject<f32, ()>, b2: &CollisionObject<f32, ()>) -> bool {
        b1.handle().uid() % 2 == b2.handle().uid() % 2
    }
}

#[test]
fn a_filter_by_parity() {
    let mut world = CollisionWorld::new(0.02);
    let shape = ShapeHandle::new(Ball::new(0.5));
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    for _ in 0..4 {
        world.add(na::one(), shape.clone(), CollisionGroups::new(), query, ());
    }
    world.register_broad_phase_pair_filter("Id parity filter", IdParityFilter);
    world.update();
    assert_eq!(world.contact_events().len(), 2, "0 with 2 and 1 with 3");
    world.unregister_broad_phase_pair_filter("Id parity filter");
    world.update();
    assert_eq!(world.contact_events().len(), 4, "the other four");
}

#[test]
fn a_proximity_detector_alone() {
    let dispatcher = DefaultProximityDispatcher::new();
    let (ball, cuboid) = (Ball::new(0.5f32), Cuboid::new(Vector3::new(1.0, 1.0, 1.0)));
    let (ma, mb) = (Isometry3::identity(), Isometry3::new(Vector3::new(2.0, 0.0, 0.0), na::zero()));
    let mut detector: ProximityAlgorithm<f32> =
        dispatcher.get_proximity_algorithm(&ball, &cuboid).unwrap();
    detector.update(&dispatcher, &ma, &ball, &mb, &cuboid, 0.5);
    assert_eq!(detector.proximity(), Proximity::WithinMargin, "exactly at the margin");
    detector.update(&dispatcher, &ma, &ball, &mb, &cuboid, 0.25);
    assert_eq!(detector.proximity(), Proximity::Disjoint, "beyond it");
    detector.update(&dispatcher, &ma, &ball, &ma, &cuboid, 0.25);
    assert_eq!(detector.proximity(), Proximity::Intersecting, "one in the other");
}

#[test]
fn a_manifold_generator_alone() {
    let dispatcher = DefaultContactDispatcher::new();
    let (plane, cuboid) =
        (Plane::new(Vector3::y_axis()), Cuboid::new(Vector3::new(1.0f64, 1.0, 1.0)));
    let (ma, mb) =
        (Isometry3::identity(), Isometry3::new(Vector3::new(2.0, 0.75, 0.0), na::zero()));
    let mut generator: ContactAlgorithm<f64> =
        dispatcher.get_contact_algorithm(&plane, &cuboid).unwrap();
    let (prediction, mut ids) = (ContactPrediction::new(0.0, 0.0, 0.0), IdAllocator::new());
    generator.update(&dispatcher, &ma, &plane, &mb, &cuboid, &prediction, &mut ids);
    assert_eq!(generator.num_contacts(), 4, "the corners of the lower face");
    let mut collector: Vec<&ContactManifold<f64>> = Vec::new();
    generator.contacts(&mut collector);
    assert_eq!((collector.len(), collector[0].len()), (1, 4), "one manifold");
    let deepest = collector[0].deepest_contact().unwrap();
    assert_eq!((deepest.contact.depth, deepest.contact.normal), (0.25, Vector3::y_axis()), "up");
}

#[test]
fn questions_about_two_solids() {
    let (ball, cuboid) = (Ball::new(0.5f32), Cuboid::new(Vector3::new(1.0, 1.0, 1.0)));
    let (ma, mb) = (Isometry3::identity(), Isometry3::new(Vector3::new(2.0, 0.0, 0.0), na::zero()));
    assert_eq!(distance(&ma, &ball, &mb, &cuboid), 0.5, "along x");
    let nearest =
        ClosestPoints::WithinMargin(Point3::new(0.5, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0));
    assert_eq!(closest_points(&ma, &ball, &mb, &cuboid, 0.5), nearest, "at the limit");
    let found: Contact<f32> = contact(&ma, &ball, &mb, &cuboid, 0.5).unwrap();
    assert_eq!((found.depth, found.normal), (-0.5, Vector3::x_axis()), "apart");
    assert_eq!(proximity(&ma, &ball, &mb, &cuboid, 0.25), Proximity::Disjoint, "beyond");
    let time = time_of_impact(&ma, &Vector3::x(), &ball, &mb, &na::zero(), &cuboid);
    assert_eq!(time, Some(0.5), "at unit speed");
}

#[test]
fn questions_about_one_solid() {
    let (ball, m) = (Ball::new(0.5f32), Isometry3::identity());
    let ray = Ray::new(Point3::new(-2.0, 0.0, 0.0), Vector3::x());
    assert_eq!(ball.toi_with_ray(&m, &ray, true), Some(1.5), "its near side");
    assert_eq!(
        ball.project_point(&m, &Point3::new(2.0, 0.0, 0.0), true).point.x,
        0.5,
        "its far side"
    );
    let around = bounding_volume::aabb(&ball, &m);
    assert_eq!(
        around,
        Aabb::new(Point3::new(-0.5, -0.5, -0.5), Point3::new(0.5, 0.5, 0.5)),
        "its box"
    );
    assert_eq!(bounding_volume::bounding_sphere(&ball, &m).radius(), 0.5, "its sphere");
}

#[test]
fn shapes_tell_their_type() {
    let handle: ShapeHandle<f32> = ShapeHandle::new(Ball::new(1.0));
    let shape: &dyn Shape<f32, 3> = &*handle;
    assert_eq!(shape.as_shape::<Ball<f32>>().map(Ball::radius), Some(1.0), "a ball");
    assert!(!shape.is_shape::<Cuboid<f32>>(), "no box");
    assert!(handle.is_same(&handle.clone()), "shared");
}
