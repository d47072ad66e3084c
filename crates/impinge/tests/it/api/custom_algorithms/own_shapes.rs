//! Tests that custom shapes work in every query: an ellipsoid that has only support points, and a
//! wrapper that delegates to a box.

use super::dim::bounding_volume::Aabb;
use super::dim::math::{DIM, Isometry, Point, Pose, Real, Unit, Vector};
use super::dim::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, IdAllocator,
    PairManifoldGenerator,
};
use super::dim::query::{
    ClosestPoints, PointQuery, Proximity, Ray, RayCast, closest_points, contact, distance,
    proximity, time_of_impact,
};
use super::dim::shape::{
    Ball, Capsule, Cuboid, Geometry, Plane, Segment, Shape, ShapeHandle, ShapeKind, SupportMap,
    Triangle,
};
use super::dim::world::{CollisionGroups, CollisionObject, CollisionWorld, GeometricQueryType};
use super::standalone::{at, cube, vector};

/// An ellipsoid: the points `x` with `Σ (x_i / radii_i)² <= 1`.
#[derive(Clone, Debug)]
struct Ellipsoid<N: Real> {
    radii: Vector<N>,
}

impl<N: Real> SupportMap<N, DIM> for Ellipsoid<N> {
    fn core_support(&self, direction: &Vector<N>) -> Point<N> {
        let stretched = self.radii.component_mul(direction);
        let length = stretched.norm();
        if length > N::ZERO {
            Point::from(self.radii.component_mul(&stretched) / length)
        } else {
            Point::origin()
        }
    }
}

impl<N: Real> Shape<N, DIM> for Ellipsoid<N> {
    fn geometry(&self) -> Geometry<'_, N> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<N> {
        Aabb::new(Point::from(-self.radii), Point::from(self.radii))
    }
}

/// A box wrapped in a custom type.
#[derive(Clone, Debug)]
struct Crate<N: Real> {
    walls: Cuboid<N>,
    #[expect(dead_code, reason = "what the user's own type is for")]
    content: &'static str,
}

impl<N: Real> Shape<N, DIM> for Crate<N> {
    fn geometry(&self) -> Geometry<'_, N> {
        self.walls.geometry()
    }

    fn local_aabb(&self) -> Aabb<N> {
        Shape::local_aabb(&self.walls)
    }
}

/// Returns six solids of size about 1 and a half-space, as partners of the tested shapes.
fn others<N: Real>() -> Vec<Box<dyn Shape<N, DIM>>> {
    let point = |x: f64, y: f64| Point::from(vector::<N>(x, y));
    vec![
        Box::new(Ball::new(N::ONE)),
        Box::new(cube::<N>(1.0)),
        Box::new(Capsule::<N>::new(N::HALF, N::HALF)),
        Box::new(Segment::<N>::new(point(-0.5, -1.0), point(0.25, 1.0))),
        Box::new(Triangle::<N>::new(point(-1.0, -1.0), point(1.0, -0.5), point(0.0, 1.0))),
        Box::new(Plane::<N>::new(Unit::new_normalize(vector(-1.0, 0.25)))),
        Box::new(Ellipsoid { radii: vector::<N>(0.5, 0.75) + Vector::repeat(N::HALF) }),
    ]
}

/// Returns the largest error allowed for results of iterations over support points: 1e-7 in `f64`,
/// 2e-3 in `f32`.
fn tolerance<N: Real>() -> f64 {
    if N::EPSILON.as_f64() < 1e-10 { 1e-7 } else { 2e-3 }
}

#[track_caller]
fn check_near<N: Real>(a: N, b: N, what: &str) {
    assert!((a - b).abs().as_f64() <= tolerance::<N>(), "{what}: {a} and {b}");
}

#[track_caller]
fn check_close<N: Real>(a: &Vector<N>, b: &Vector<N>, what: &str) {
    // Near its minimum the distance changes with the square of the offset. So points and directions
    // are known only to the square root of the tolerance.
    assert!((a - b).norm().as_f64() <= tolerance::<N>().sqrt(), "{what}: {a} and {b}");
}

/// Asserts for two shapes that are the same set of points, against each of [`others`]: distance,
/// contact and time of impact agree up to [`tolerance`], and proximities are equal in both orders.
fn check_twins<N: Real>(own: &dyn Shape<N, DIM>, known: &dyn Shape<N, DIM>) {
    for (index, other) in others::<N>().iter().enumerate() {
        let other = &**other;
        for x in [-0.25, 1.5, 2.5, 4.0] {
            let (here, there) = (at::<N>(0.125, -0.25), at::<N>(x, 0.5));
            let what = format!("the {index}-th at {x}");
            let both = |f: &dyn Fn(&dyn Shape<N, DIM>) -> N| (f(own), f(known));
            let (a, b) = both(&|shape| distance(&here, shape, &there, other));
            check_near(a, b, &format!("distance to {what}"));
            check_contact(own, known, (&here, &there), other, &what);
            let margin = N::lit(0.375);
            let near = |shape| proximity(&here, shape, &there, other, margin);
            assert_eq!(near(own), near(known), "proximity of {what}");
            assert_eq!(
                proximity(&there, other, &here, own, margin),
                near(own),
                "in the other order: {what}"
            );
            let (still, toward) = (Vector::<N>::zeros(), vector::<N>(-1.0, 0.0));
            let toi = |shape| time_of_impact(&here, &still, shape, &there, &toward, other);
            match (toi(own), toi(known)) {
                (Some(a), Some(b)) => check_near(a, b, &format!("time of impact of {what}")),
                (a, b) => assert_eq!(a, b, "time of impact of {what}"),
            }
        }
    }
}

fn check_contact<N: Real>(
    own: &dyn Shape<N, DIM>,
    known: &dyn Shape<N, DIM>,
    (here, there): (&Isometry<N>, &Isometry<N>),
    other: &dyn Shape<N, DIM>,
    what: &str,
) {
    let prediction = N::ONE;
    let both = [own, known].map(|shape| contact(here, shape, there, other, prediction));
    if let [Some(a), Some(b)] = &both {
        check_near(a.depth, b.depth, &format!("depth of {what}"));
        // A deep overlap may have several shortest ways out, so normals are compared only for
        // shallow ones.
        if a.depth < N::lit(0.25) {
            check_close(&a.normal, &b.normal, &format!("normal of {what}"));
        }
    }
    assert_eq!(both[0].is_some(), both[1].is_some(), "contact of {what}");
    let points = [own, known].map(|shape| closest_points(here, shape, there, other, prediction));
    match points {
        [ClosestPoints::WithinMargin(a, _), ClosestPoints::WithinMargin(b, _)] => {
            check_close(&a.coords, &b.coords, &format!("closest point to {what}"));
        }
        [a, b] => assert_eq!(a, b, "closest points of {what}"),
    }
}

fn check_points_and_rays<N: Real>(own: &dyn Shape<N, DIM>, known: &dyn Shape<N, DIM>) {
    let here = at::<N>(0.5, -0.25);
    let (mut hits, mut insides) = (0, 0);
    for n in 0..60 {
        let angle = 0.37 * f64::from(n);
        let reach = 0.2 + 0.04 * f64::from(n);
        let point = Point::from(vector::<N>(0.5 + reach * angle.cos(), reach * angle.sin()));
        let distances = |solid| {
            let of = |shape: &dyn Shape<N, DIM>| shape.distance_to_point(&here, &point, solid);
            (of(own), of(known))
        };
        for solid in [true, false] {
            let (a, b) = distances(solid);
            check_near(a, b, &format!("distance to the {n}-th point"));
        }
        let inside = own.contains_point(&here, &point);
        assert_eq!(inside, known.contains_point(&here, &point), "the {n}-th point");
        insides += usize::from(inside);
        let direction = vector::<N>(0.5 - angle.cos() * reach + 0.4, -angle.sin() * reach);
        for solid in [true, false] {
            let ray = Ray::new(point, direction);
            let cast =
                |shape: &dyn Shape<N, DIM>| shape.toi_and_normal_with_ray(&here, &ray, solid);
            match (cast(own), cast(known)) {
                (Some(a), Some(b)) => {
                    check_near(a.toi, b.toi, &format!("the {n}-th ray"));
                    check_close(&a.normal, &b.normal, &format!("the {n}-th ray"));
                    hits += 1;
                }
                (a, b) => assert_eq!(a, b, "the {n}-th ray"),
            }
        }
    }
    assert!((15..45).contains(&insides) && hits > 40, "{insides} inside, {hits} hits");
}

/// Compares an ellipsoid of equal radii with a ball, and queries of a long ellipsoid with values
/// computed by hand.
fn ellipsoids<N: Real>() {
    let round = Ellipsoid { radii: Vector::repeat(N::ONE) };
    let ball = Ball::new(N::ONE);
    assert_eq!(round.geometry().kind(), ShapeKind::SupportMap, "by support points");
    check_twins::<N>(&round, &ball);
    check_points_and_rays::<N>(&round, &ball);

    // An ellipsoid with the radii 2 and 0.5 along the first two axes.
    let long = Ellipsoid { radii: vector::<N>(1.0, -0.5) + Vector::repeat(N::ONE) };
    let (here, there) = (at::<N>(0.0, 0.0), at::<N>(4.0, 0.0));
    check_near(distance(&here, &long, &there, &ball), N::ONE, "2 + 1 + 1 = 4");
    check_near(distance(&here, &long, &at(0.0, 4.0), &ball), N::lit(2.5), "0.5 + 2.5 + 1 = 4");
    let stands = Plane::<N>::new(Unit::new_normalize(vector(0.0, 1.0)));
    let found = contact(&here, &stands, &at(0.0, 0.25), &long, N::ZERO).expect("sunk in");
    check_near(found.depth, N::lit(0.25), "half of the half");
    let hit = long.toi_and_normal_with_ray(
        &here,
        &Ray::new(Point::from(vector::<N>(-5.0, 0.0)), vector(2.0, 0.0)),
        true,
    );
    check_near(hit.expect("hits").toi, N::lit(1.5), "3 at speed 2");
}

/// Asserts that a custom round shape that moves along a floor has a manifold of one point at every
/// step, with the same contact id.
fn manifolds<N: Real>() {
    let (round, floor) = (Ellipsoid { radii: Vector::repeat(N::ONE) }, cube::<N>(3.0));
    let (mut generator, mut ids) = (PairManifoldGenerator::<N>::default(), IdAllocator::new());
    let prediction = ContactPrediction::new(N::lit(0.125), N::ZERO, N::ZERO);
    let mut names = Vec::new();
    for step in 0..20 {
        let (here, there) = (at::<N>(0.0, 0.0), at::<N>(0.05 * f64::from(step), 3.9375));
        let dispatcher = DefaultContactDispatcher::new();
        let generator: &mut dyn ContactManifoldGenerator<N, DIM> = &mut generator;
        generator.update(&dispatcher, &here, &floor, &there, &round, &prediction, &mut ids);
        let mut manifolds = Vec::new();
        generator.contacts(&mut manifolds);
        let [manifold] = manifolds[..] else { panic!("one manifold at step {step}") };
        assert_eq!(manifold.len(), 1, "curved: one point");
        let tracked = manifold.deepest_contact().expect("the one");
        check_near(tracked.contact.depth, N::lit(0.0625), "one sixteenth");
        check_close(&tracked.contact.normal, &vector(0.0, 1.0), "up");
        names.push(tracked.id);
    }
    names.dedup();
    assert_eq!(names.len(), 1, "it keeps its name");
}

fn in_worlds<N: Real>() {
    let round = ShapeHandle::new(Ellipsoid { radii: Vector::repeat(N::ONE) });
    let mut world = CollisionWorld::<N, ()>::new(N::lit(0.02));
    let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    let near = GeometricQueryType::Proximity(N::lit(0.25));
    let all = CollisionGroups::new();
    let first = world.add(at(0.0, 0.0), round.clone(), all, contacts, ());
    let shape = ShapeHandle::new(cube::<N>(1.0));
    let second = world.add(at(1.75, 0.0), shape, all, contacts, ());
    let area = world.add(at(0.0, 2.125), round, all, near, ());
    world.update();
    let pair = world.contact_pair(first, second).expect("boxes meet");
    assert_eq!(pair.num_contacts(), 1, "curved: one point");
    let status = world.proximity_pair(first, area).expect("boxes meet").proximity();
    assert_eq!(status, Proximity::WithinMargin, "an eighth apart");
    let ray = Ray::new(Point::from(vector::<N>(-5.0, 0.0)), vector(1.0, 0.0));
    let hits: Vec<_> = world.interferences_with_ray(&ray, &all).collect();
    assert_eq!(hits.len(), 2, "the first and the box");
    check_near(hits[0].1.toi, N::lit(4.0), "its left end");
    let inside = Point::from(vector::<N>(0.0, 2.0));
    let found = world.interferences_with_point(&inside, &all).map(CollisionObject::handle);
    assert_eq!(found.collect::<Vec<_>>(), [area], "the area only");
    let shape = world.collision_object(first).expect("alive").shape();
    assert!(shape.as_ref().as_shape::<Ellipsoid<N>>().is_some(), "what it was made as");
    assert!(shape.as_ref().as_shape::<Ball<N>>().is_none(), "and nothing else");
}

/// Asserts that a wrapper that delegates to a box gives the results of the box, bit for bit.
fn crates<N: Real>() {
    let walls = Cuboid::new(vector::<N>(1.0, 0.5) + Vector::repeat(N::lit(0.25)));
    let own = Crate { walls, content: "apples" };
    check_twins::<N>(&own, &walls);
    check_points_and_rays::<N>(&own, &walls);
    let pose = Pose::from_isometry(&at::<N>(0.5, 3.0));
    assert_eq!(Shape::aabb(&own, &pose), Shape::aabb(&walls, &pose), "the same box");
    for other in others::<N>() {
        let (here, there) = (at::<N>(0.0, 0.0), at::<N>(1.5, 0.75));
        let bits = |shape: &dyn Shape<N, DIM>| {
            let found = contact(&here, shape, &there, &*other, N::lit(4.0));
            let apart = distance(&here, shape, &there, &*other);
            let points = closest_points(&here, shape, &there, &*other, N::lit(4.0));
            (found, apart, points)
        };
        assert_eq!(bits(&own), bits(&walls), "{other:?}");
    }
}

#[test]
fn own_shapes_join_every_query() {
    ellipsoids::<f32>();
    ellipsoids::<f64>();
    manifolds::<f32>();
    manifolds::<f64>();
    in_worlds::<f32>();
    in_worlds::<f64>();
}

#[test]
fn own_shapes_stand_for_others() {
    crates::<f32>();
    crates::<f64>();
}
