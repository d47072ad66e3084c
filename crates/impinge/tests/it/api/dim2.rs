//! Programs as users of `impinge::dim2` copy them from the guide: names, signatures, custom
//! algorithms.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use impinge::dim2::bounding_volume::{Aabb, aabb, bounding_sphere};
use impinge::dim2::broad_phase::{BroadPhase, BroadPhasePairFilter, DBVTBroadPhase};
use impinge::dim2::events::{ContactEvent, Events, Proximity};
use impinge::dim2::math::{Isometry, Point, Real, Unit, Vector};
use impinge::dim2::na;
use impinge::dim2::narrow_phase::{
    CollisionObjectHandle, ContactAlgorithm, ContactDispatcher, ContactPair,
    DefaultContactDispatcher, DefaultNarrowPhase, DefaultProximityDispatcher, IdAllocator,
    NarrowPhase, ProximityAlgorithm, ProximityDispatcher, ProximityPair,
};
use impinge::dim2::query::{
    Contact, ContactManifold, PointQuery, Ray, RayCast, TrackedContact, closest_points, contact,
    distance, proximity,
};
use impinge::dim2::shape::{Ball, Cuboid, FeatureId, Plane, Shape, ShapeHandle};
use impinge::dim2::world::{
    CollisionGroups, CollisionObject, CollisionObjects, CollisionWorld, GeometricQueryType,
};
use impinge::world::{ContactPairs, ProximityPairs};

/// A user's function that is generic over the scalar and the data.
fn count_touching<N: Real, T>(world: &CollisionWorld<N, T>) -> usize {
    world.contact_pairs().filter(|(_, _, pair)| pair.num_contacts() > 0).count()
}

/// Fills a world with three balls of equal centres, updates it and casts a ray; generic over scalar
/// and data.
fn fill<N: Real, T: Clone>(data: T) -> CollisionWorld<N, T> {
    let mut world = CollisionWorld::new(N::lit(0.02));
    let shape = ShapeHandle::new(Ball::new(N::HALF));
    let query = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    for _ in 0..3 {
        let groups = CollisionGroups::new();
        world.add(na::one(), shape.clone(), groups, query, data.clone());
    }
    world.update();
    let ray = Ray::new(Point::origin(), Vector::x());
    assert_eq!(world.interferences_with_ray(&ray, &CollisionGroups::new()).count(), 3, "all");
    world
}

#[test]
fn generic_functions_compile() {
    assert_eq!(count_touching(&fill::<f32, _>("data")), 3, "three at one place");
    assert_eq!(count_touching(&fill::<f64, _>(())), 3, "three at one place");
}

#[test]
fn the_broad_phase_of_the_guide() {
    let mut broad_phase = DBVTBroadPhase::new(0.2_f32);
    let ball = Ball::new(0.5);
    let poses = [
        Isometry::translation(0.0, 0.0),
        Isometry::translation(0.0, 0.5),
        Isometry::translation(0.5, 0.0),
        Isometry::translation(0.5, 0.5),
    ];
    let handles = poses.map(|pose| broad_phase.create_proxy(aabb(&ball, &pose), pose));
    broad_phase.update(&mut |_, _| true, &mut |_, _, _| ());
    assert_eq!(broad_phase.num_interferences(), 6, "all with all");
    let mut count = 0;
    broad_phase.remove(&handles[..2], &mut |_, _| count += 1);
    assert_eq!(count, 5, "pairs with a removed one");
    broad_phase.update(&mut |_, _| true, &mut |_, _, _| ());
    assert_eq!(broad_phase.num_interferences(), 1, "the other two");
}

#[test]
fn questions_about_solids() {
    let (ball, cuboid) = (Ball::new(1.0_f64), Cuboid::new(Vector::new(0.5, 0.5)));
    let (here, there) = (Isometry::identity(), Isometry::translation(3.0, 0.0));
    assert_eq!(distance(&here, &ball, &there, &cuboid), 1.5, "along x");
    assert_eq!(proximity(&here, &ball, &there, &cuboid, 2.0), Proximity::WithinMargin, "near");
    let found: Contact<f64> = contact(&here, &ball, &there, &cuboid, 2.0).expect("near");
    assert_eq!((found.depth, found.normal.x), (-1.5, 1.0), "from the first to the second");
    assert_eq!(closest_points(&here, &ball, &there, &cuboid, 1.0), {
        impinge::dim2::query::ClosestPoints::Disjoint
    });
    let ray = Ray::new(Point::origin(), Vector::new(1.0, 0.0));
    let hit = cuboid.toi_and_normal_with_ray(&there, &ray, true).expect("ahead");
    assert_eq!((hit.toi, hit.normal.x), (2.5, -1.0), "its near side");
    assert!(matches!(hit.feature, FeatureId::Face(_)), "a side");
    assert!(cuboid.contains_point(&there, &Point::new(3.0, 0.0)), "its middle");
    let around: Aabb<f64> = aabb(&cuboid, &there);
    assert_eq!(around.mins().x, 2.5, "its box");
    assert!(bounding_sphere(&cuboid, &there).radius() > 0.5, "its sphere");
    let plane = Plane::new(Unit::new_normalize(-Vector::new(1.0, 0.0)));
    assert!(plane.contains_point(&here, &Point::new(3.0, 0.0)), "behind the plane");
}

/// A dispatcher that delegates to the library and counts its calls.
struct Counting(Arc<AtomicUsize>);

impl<N: Real> ContactDispatcher<N, 2> for Counting {
    fn get_contact_algorithm(
        &self,
        a: &dyn Shape<N, 2>,
        b: &dyn Shape<N, 2>,
    ) -> Option<ContactAlgorithm<N>> {
        self.0.fetch_add(1, Ordering::Relaxed);
        DefaultContactDispatcher::new().get_contact_algorithm(a, b)
    }
}

/// A dispatcher that returns no algorithm.
struct Nothing;

impl<N: Real> ProximityDispatcher<N, 2> for Nothing {
    fn get_proximity_algorithm(
        &self,
        _: &dyn Shape<N, 2>,
        _: &dyn Shape<N, 2>,
    ) -> Option<ProximityAlgorithm<N>> {
        None
    }
}

/// Returns a world of three balls with the same centre, one of them a sensor, before its first
/// update.
fn three_balls() -> (CollisionWorld<f32, ()>, [CollisionObjectHandle; 3]) {
    let mut world = CollisionWorld::new(0.02);
    let shape = ShapeHandle::new(Ball::new(0.5));
    let mut add =
        |query| world.add(Isometry::identity(), shape.clone(), CollisionGroups::new(), query, ());
    let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    let handles = [add(contacts), add(contacts), add(GeometricQueryType::Proximity(0.0))];
    (world, handles)
}

#[test]
fn dispatchers_of_ones_own() {
    let (mut world, [first, second, area]) = three_balls();
    let count = Arc::new(AtomicUsize::new(0));
    let contacts = Box::new(Counting(Arc::clone(&count)));
    let narrow_phase = DefaultNarrowPhase::with_dispatchers(contacts, Box::new(Nothing));
    world.set_narrow_phase(Box::new(narrow_phase));
    world.update();
    assert_eq!(count.load(Ordering::Relaxed), 1, "one pair asks for contacts");
    assert_eq!(world.contact_events(), [ContactEvent::Started(first, second)], "by the library");
    assert!(world.proximity_events().is_empty(), "there is no algorithm");

    // The pairs without an algorithm must be removed with the old phases, without events.
    world.set_broad_phase(Box::new(DBVTBroadPhase::new(0.5)));
    world.update();
    assert!(world.contact_events().is_empty() && world.proximity_events().is_empty(), "the same");
    world.remove(&[area]);
    let plain = DefaultNarrowPhase::with_dispatchers(
        Box::new(DefaultContactDispatcher::new()),
        Box::new(DefaultProximityDispatcher::new()),
    );
    world.set_narrow_phase(Box::new(plain));
    world.update();
    assert!(world.contact_events().is_empty() && world.proximity_events().is_empty(), "the same");
    world.validate().expect("the parts agree");
}

/// Asserts that a pair that had no algorithm at a mark has none after a rewind, although it had one
/// in between.
#[test]
fn a_rewind_takes_the_algorithm_of_a_pair() {
    let (mut world, [first, second, area]) = three_balls();
    let contacts = Box::new(DefaultContactDispatcher::new());
    let narrow_phase = DefaultNarrowPhase::with_dispatchers(contacts, Box::new(Nothing));
    world.set_narrow_phase(Box::new(narrow_phase));
    world.update();
    let mark = world.mark();
    world.set_query_type(area, GeometricQueryType::Contacts(0.0, 0.0));
    world.update();
    assert!(world.contact_pair(first, area).is_some(), "it touches");
    world.rewind(mark);
    assert!(world.contact_pair(first, area).is_none(), "as at the mark");
    world.remove(&[first]);
    world.set_query_type(area, GeometricQueryType::Contacts(0.0, 0.0));
    world.update();
    assert!(world.contact_pair(second, area).is_some(), "it touches again");
}

/// Wraps the default narrow phase and passes it only pairs of two contact queries, so that no
/// proximities are reported.
#[derive(Clone, Debug, Default)]
struct ContactsOnly(DefaultNarrowPhase<f32>);

impl<T> NarrowPhase<f32, 2, T> for ContactsOnly {
    fn update(&mut self, objects: &CollisionObjects<f32, T>, events: &mut Events) {
        NarrowPhase::update(&mut self.0, objects, events);
    }

    fn handle_interaction(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<f32, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        started: bool,
    ) {
        assert!(handle1 < handle2, "in order");
        let both = objects.get(handle1).zip(objects.get(handle2)).expect("both live");
        let contacts = |object: &CollisionObject<f32, T>| {
            matches!(object.query_type(), GeometricQueryType::Contacts(..))
        };
        if contacts(both.0) && contacts(both.1) {
            self.0.handle_interaction(events, objects, handle1, handle2, started);
        }
    }

    fn handle_removal(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<f32, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) {
        self.0.handle_removal(events, objects, handle1, handle2);
    }

    fn handle_change(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<f32, T>,
        handle: CollisionObjectHandle,
    ) {
        self.0.handle_change(events, objects, handle);
    }

    fn ids(&mut self) -> Option<&mut IdAllocator> {
        NarrowPhase::<f32, 2, T>::ids(&mut self.0)
    }

    fn contact_pair<'a>(
        &'a self,
        objects: &'a CollisionObjects<f32, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'a, f32>> {
        NarrowPhase::contact_pair(&self.0, objects, handle1, handle2)
    }

    fn proximity_pair(
        &self,
        _: &CollisionObjects<f32, T>,
        _: CollisionObjectHandle,
        _: CollisionObjectHandle,
    ) -> Option<ProximityPair> {
        None
    }

    fn contact_pairs<'a>(
        &'a self,
        objects: &'a CollisionObjects<f32, T>,
    ) -> ContactPairs<'a, f32, 2> {
        NarrowPhase::contact_pairs(&self.0, objects)
    }

    fn proximity_pairs<'a>(&'a self, _: &'a CollisionObjects<f32, T>) -> ProximityPairs<'a> {
        Box::new(std::iter::empty())
    }
}

#[test]
fn a_narrow_phase_of_ones_own() {
    let (mut world, [first, second, area]) = three_balls();
    world.update();
    assert_eq!(world.proximity_events().len(), 2, "both are in the area");
    world.set_narrow_phase(Box::new(ContactsOnly::default()));
    world.update();
    assert!(world.contact_events().is_empty(), "contacts go on");
    assert_eq!(world.proximity_events().len(), 2, "the new one knows of no proximity: they end");
    let ended = world.proximity_events().iter().all(|e| e.new_status == Proximity::Disjoint);
    assert!(ended, "they end");
    let seen = world.contacts_with(second).map(|(other, point)| (other.handle(), point));
    let seen: Vec<_> = seen.collect();
    assert!(!seen.is_empty() && seen.iter().all(|(other, _)| *other == first), "{seen:?}");
    assert_eq!(world.proximities_with(area).count(), 0, "of which it knows nothing");
    world.remove(&[area, first]);
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Stopped(first, second)], "as ever");
}

/// A filter that refuses every pair.
struct Nobody;

impl<N: Real, T> BroadPhasePairFilter<N, T> for Nobody {
    fn is_pair_valid(&self, _: &CollisionObject<N, T>, _: &CollisionObject<N, T>) -> bool {
        false
    }
}

#[test]
fn contacts_as_the_guide_reads_them() {
    let (mut world, [first, second, _]) = three_balls();
    world.update();
    for event in world.contact_events() {
        let ContactEvent::Started(handle1, handle2) = event else { panic!("nothing stops") };
        assert_eq!((*handle1, *handle2), (first, second), "by reference");
    }
    let pair = world.contact_pair(second, first).expect("in either order");
    let mut manifolds: Vec<&ContactManifold<f32>> = Vec::new();
    pair.contacts(&mut manifolds);
    let deepest: &TrackedContact<f32> = manifolds[0].deepest_contact().expect("one");
    assert_eq!(deepest.contact.depth, 1.0, "concentric");
    assert_eq!(manifolds[0].contacts()[manifolds[0].deepest_contact_id()].id, deepest.id, "it");
    world.register_broad_phase_pair_filter("nobody", Nobody);
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Stopped(first, second)], "filtered");
}
