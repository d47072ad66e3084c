//! Programs of users who start with the prelude. The names exist in both dimensions and for both
//! scalars, and the short names are aliases of the generic types.

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Real, Space, Vector};
use impinge::shape::{
    CompositeShape, FeatureId, Geometry, Part, PartSearch, Polyline, Shape, Surface,
};

/// A polyline wrapped in a custom type that implements only the required methods of a composite
/// shape.
#[derive(Debug)]
struct Ground<N: Space<D>, const D: usize>(Polyline<N, D>);

impl<N: Space<D>, const D: usize> CompositeShape<N, D> for Ground<N, D> {
    fn num_parts(&self) -> u32 {
        self.0.num_parts()
    }

    fn part(&self, part: u32) -> Part<'_, N, D> {
        self.0.part(part)
    }

    fn search(&self) -> &dyn PartSearch<N, D> {
        self.0.search()
    }

    fn surface(&self) -> Option<&dyn Surface<N, D>> {
        Some(self)
    }

    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        self.0.each_corner(part, visit);
    }
}

impl<N: Space<D>, const D: usize> Surface<N, D> for Ground<N, D> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool {
        self.0.admits(part, feature, normal)
    }

    fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>> {
        self.0.snapped(part, normal)
    }

    fn faces(&self, part: u32, center: &Point<N, D>) -> bool {
        self.0.faces(part, center)
    }
}

impl<N: Space<D>, const D: usize> Shape<N, D> for Ground<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.0.local_aabb()
    }
}

/// Defines the programs for one dimension.
macro_rules! programs {
    ($name:ident, $dim:ident, $d:literal) => {
        mod $name {
            use impinge::$dim::prelude::*;

            use super::{Ground, Real};

            fn at<N: Real>(height: f64) -> Isometry<N> {
                Isometry::from_parts((Vector::y() * N::lit(height)).into(), Rotation::identity())
            }

            fn square<N: Real>(size: f64) -> Cuboid<N> {
                Cuboid::new(Vector::repeat(N::lit(size)))
            }

            /// A typical program that needs no import except the prelude.
            fn program<N: Real>() {
                let mut world = CollisionWorld::new(N::lit(0.02));
                let groups = CollisionGroups::new();
                let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
                let floor = ShapeHandle::new(square::<N>(1.0));
                let ball = ShapeHandle::new(Ball::new(N::lit(0.5)));
                let floor = world.add(at(0.0), floor, groups, contacts, "floor");
                let ball = world.add(at(1.25), ball, groups, contacts, "ball");
                world.update();
                assert_eq!(world.contact_events(), [ContactEvent::Started(floor, ball)], "touch");
                let object: &CollisionObject<N, &str> = world.collision_object(ball).expect("it");
                assert_eq!(*object.data(), "ball", "as it was given");
                let down = Ray::new(Point::from(Vector::y() * N::lit(5.0)), -Vector::y());
                let hit = world.first_ray_hit(&down, N::MAX, true, &QueryFilter::new());
                assert_eq!(hit.map(|(object, hit)| (object.handle(), hit.toi)), {
                    Some((ball, N::lit(3.25)))
                });
                // The short name is an alias of the generic type.
                let _: &impinge::world::CollisionWorld<N, $d, &str> = &world;
            }

            fn questions<N: Real>() {
                let (ball, floor) =
                    (Ball::new(N::ONE), HalfSpace::new(Unit::new_unchecked(Vector::y())));
                let _: &Plane<N> = &floor;
                let (here, up) = (at::<N>(0.0), at::<N>(3.0));
                assert_eq!(distance(&here, &floor, &up, &ball), N::TWO, "above the ground");
                assert_eq!(
                    proximity(&here, &floor, &up, &ball, N::ONE),
                    Proximity::Disjoint,
                    "far"
                );
                let found: Contact<N> = contact(&here, &floor, &up, &ball, N::TWO).expect("near");
                assert_eq!(found.depth, -N::TWO, "not yet");
                let nearest = closest_points(&here, &floor, &up, &ball, N::ONE);
                assert_eq!(nearest, ClosestPoints::Disjoint, "farther than asked");
                let (still, fall) = (Vector::zeros(), -Vector::y());
                let toi = time_of_impact(&here, &still, &floor, &up, &fall, &ball);
                assert_eq!(toi, Some(N::TWO), "two below");
                let falls = Moving::new(&up, &fall, &ball);
                let found = impact(&Moving::still(&here, &floor), &falls, &ImpactOptions::new());
                assert_eq!(found.expect("it falls").toi, N::TWO, "the same");
                assert!(ball.contains_point(&up, &Point::from(Vector::y() * N::TWO)), "its foot");
                let down = Ray::new(Point::from(Vector::y() * N::lit(5.0)), fall);
                assert_eq!(ball.toi_with_ray(&up, &down, true), Some(N::ONE), "its top");
                let around: Aabb<N> = Shape::aabb(&ball, &impinge::math::Space::pose(&up));
                assert_eq!(around.maxs().y, N::lit(4.0), "its box");
            }

            /// Asserts that query types made from named fields equal those made by position, and
            /// cause the same events.
            fn query_types<N: Real>() {
                let contacts = ContactQuery::new(N::HALF).with_angular_prediction(N::ONE);
                let by_place = GeometricQueryType::Contacts(N::HALF, N::ONE);
                assert_eq!(GeometricQueryType::from(contacts), by_place, "the same numbers");
                assert_eq!(by_place.as_contacts(), Some(contacts), "and back");
                assert_eq!(by_place.as_proximity(), None, "something else");
                let sensor = ProximityQuery { margin: N::TWO };
                assert_eq!(
                    GeometricQueryType::Proximity(N::TWO).as_proximity(),
                    Some(sensor),
                    "too"
                );
                let none = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
                assert_eq!(none, ContactQuery::default().into(), "no prediction");

                let mut world = CollisionWorld::new(N::lit(0.02));
                let (ball, groups) = (ShapeHandle::new(Ball::new(N::ONE)), CollisionGroups::new());
                let low = world.add(at(0.0), ball.clone(), groups, ContactQuery::default(), ());
                let high = world.add(at(2.5), ball, groups, none, ());
                world.update();
                assert!(world.contact_events().is_empty(), "half a unit apart");
                world.set_query_type(high, ContactQuery::new(N::HALF));
                world.update();
                assert_eq!(world.contact_events(), [ContactEvent::Started(low, high)], "predicted");
                world.set_query_type(low, ProximityQuery { margin: N::HALF });
                world.update();
                let event: &ProximityEvent = &world.proximity_events()[0];
                assert_eq!(event.new_status, Proximity::WithinMargin, "near");
                assert!(
                    world.try_set_query_type(low, ProximityQuery::new(-N::ONE)).is_err(),
                    "bad"
                );
            }

            /// Asserts that each alias of a query gives the same result as the method that it is an
            /// alias for.
            fn aliases<N: Real>() {
                let mut world = CollisionWorld::new(N::lit(0.02));
                let ball = ShapeHandle::new(Ball::new(N::ONE));
                for height in [4.0, 0.0, 2.0, 9.0] {
                    let query = ContactQuery::default();
                    world.add(at(height), ball.clone(), CollisionGroups::new(), query, ());
                }
                let (groups, all) = (CollisionGroups::new(), QueryFilter::new());
                let ray = Ray::new(Point::from(Vector::y() * N::lit(-3.0)), Vector::y());
                let first = world.first_ray_hit(&ray, N::MAX, true, &all);
                let other = world.first_interference_with_ray(&ray, &groups);
                let hit = |(object, hit): (&CollisionObject<N, ()>, _)| (object.handle(), hit);
                assert_eq!(first.map(hit), other.map(hit), "the first hit");
                let mut hits: Vec<_> =
                    world.ray_hits(&ray, N::MAX, true, &all).into_iter().map(hit).collect();
                hits.sort_by_key(|(handle, _)| *handle);
                let others: Vec<_> = world.interferences_with_ray(&ray, &groups).map(hit).collect();
                assert_eq!((hits.len(), hits), (4, others), "all hits");
                let between = Point::from(Vector::y());
                let holding = world.objects_containing(&between, &all).map(CollisionObject::handle);
                let others = world.interferences_with_point(&between, &groups);
                assert!(holding.eq(others.map(CollisionObject::handle)), "around a point");
                let volume = Aabb::new(Point::from(-Vector::repeat(N::ONE)), between);
                let within = world.objects_in_aabb(&volume, &all).map(CollisionObject::handle);
                let others = world.interferences_with_aabb(&volume, &groups);
                assert!(within.eq(others.map(CollisionObject::handle)), "in a box");
                let probe = Ball::new(N::HALF);
                let nearest = world.nearest_objects(&at(6.0), &probe, 1, N::MAX, &all);
                let closest = world.closest_object(&at(6.0), &probe, N::MAX, &all).expect("one");
                assert_eq!(nearest[0].object.handle(), closest.object.handle(), "the nearest");
                let (ball, here) = (Ball::new(N::ONE), at::<N>(0.0));
                let found = ball.first_hit_with_ray(&here, &ray, N::MAX, true);
                assert_eq!(found, ball.toi_and_normal_with_ray(&here, &ray, true), "one shape");
                assert_eq!(found.map(|hit| hit.toi), ball.toi_with_ray(&here, &ray, true), "time");
            }

            /// Returns a polyline along the first axis, from -3 to 3.
            fn line<N: Real>() -> Polyline<N> {
                let at = |x: i32| Point::from(Vector::x() * N::lit(f64::from(x)));
                Polyline::open((-3..4).map(at).collect())
            }

            fn surfaces<N: Real>() {
                let grounds = [ShapeHandle::new(line()), ShapeHandle::new(Ground(line()))];
                let probes: [ShapeHandle<N>; 3] = [
                    ShapeHandle::new(Ball::new(N::ONE)),
                    ShapeHandle::new(square(1.0)),
                    ShapeHandle::new(Capsule::new(N::HALF, N::HALF)),
                ];
                for probe in probes {
                    let found = grounds.each_ref().map(|ground| {
                        let mut world = CollisionWorld::new(N::lit(0.02));
                        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
                        world.add(at(0.0), ground.clone(), groups, query, ());
                        world.add(at(0.875), probe.clone(), groups, query, ());
                        world.update();
                        let views = world.contact_views();
                        let points = views.flat_map(|(_, _, view)| view.contacts());
                        points.map(|p| (p.contact, p.feature1, p.part1)).collect::<Vec<_>>()
                    });
                    assert!(!found[0].is_empty(), "they touch");
                    assert_eq!(found[0], found[1], "a user's line is touched as the library's is");
                }
            }

            /// Returns a world with pairs of every representation of contacts, in both orders.
            fn crowd<N: Real>() -> CollisionWorld<N, ()> {
                let mut world = CollisionWorld::new(N::lit(0.02));
                let query = ContactQuery::new(N::lit(0.125)).with_angular_prediction(N::lit(0.09));
                let shapes: [ShapeHandle<N>; 6] = [
                    ShapeHandle::new(square(1.0)),
                    ShapeHandle::new(Ball::new(N::ONE)),
                    ShapeHandle::new(line()),
                    ShapeHandle::new(Capsule::new(N::ONE, N::HALF)),
                    ShapeHandle::new(HalfSpace::new(Vector::y_axis())),
                    ShapeHandle::new(square(0.75)),
                ];
                for (index, shape) in (0..).zip(shapes.iter().cycle()).take(18) {
                    let place = Vector::x() * N::lit(0.75 * f64::from(index % 5))
                        + Vector::y() * N::lit(0.8 * f64::from(index % 3));
                    let turned = if index % 2 == 0 { at::<N>(0.0) } else { tilted() };
                    let pose = Isometry::from_parts(place.into(), turned.rotation);
                    world.add(pose, shape.clone(), CollisionGroups::new(), query, ());
                }
                world.update();
                world
            }

            /// Returns a rotation by about a tenth of a radian, from the first axis towards the
            /// second.
            fn tilted<N: Real>() -> Isometry<N> {
                let (from, to) = (Vector::x(), Vector::x() + Vector::y() * N::lit(0.1));
                let turn = Rotation::rotation_between(&from, &to);
                Isometry::from_parts(
                    Vector::zeros().into(),
                    Option::from(turn).expect("no half turn"),
                )
            }

            fn views<N: Real>() {
                let world = crowd::<N>();
                let name = |one: &CollisionObject<N, ()>, two: &CollisionObject<N, ()>| {
                    (one.handle(), two.handle())
                };
                let views = world.contact_views();
                let mut read: Vec<_> =
                    views.map(|(one, two, view)| (name(one, two), view.to_manifold())).collect();
                read.sort_by_key(|(name, _)| *name);
                let manifolds = world.contact_manifolds();
                let made: Vec<_> =
                    manifolds.map(|(one, two, m)| (name(one, two), m.clone())).collect();
                assert!(made.len() > 30, "most of them touch: {}", made.len());
                assert_eq!(read, made, "to the bit");
                for (one, two, pair) in world.contact_pairs() {
                    let mut expected = Vec::new();
                    pair.contacts(&mut expected);
                    assert_eq!(pair.views().count(), expected.len(), "as many of a pair");
                    for (view, manifold) in pair.views().zip(expected) {
                        assert_eq!(&view.to_manifold(), manifold, "those of a pair");
                        for (index, tracked) in manifold.contacts().iter().enumerate() {
                            assert_eq!(&view.tracked_contact(index), tracked, "each by itself");
                            let kinematic = view.kinematic(index);
                            let now = kinematic.contact(one.position(), two.position());
                            let error = (now.depth - tracked.contact.depth).abs();
                            assert!(error <= N::EPSILON * N::lit(256.0), "where it is: {error}");
                        }
                    }
                }
            }

            #[test]
            fn surfaces_of_ones_own() {
                surfaces::<f32>();
                surfaces::<f64>();
            }

            #[test]
            fn a_view_has_all_that_a_manifold_has() {
                views::<f32>();
                views::<f64>();
            }

            #[test]
            fn query_types_by_name() {
                query_types::<f32>();
                query_types::<f64>();
            }

            #[test]
            fn names_of_one_question_agree() {
                aliases::<f32>();
                aliases::<f64>();
            }

            #[test]
            fn a_program_with_the_prelude() {
                program::<f32>();
                program::<f64>();
            }

            #[test]
            fn questions_with_the_prelude() {
                questions::<f32>();
                questions::<f64>();
            }
        }
    };
}

programs!(plane, dim2, 2);
programs!(space, dim3, 3);

/// Tests the conversions between types of glam and of the library.
#[cfg(feature = "glam")]
mod glam_conversions {
    use glam::{DQuat, DVec3, Mat4, Quat, Vec2, Vec3};

    /// Places a ball on a box in 3D with vectors and rotations of glam. Asserts that the contact
    /// and the pose come back as the same glam values.
    #[test]
    fn in_space() {
        use impinge::dim3::prelude::*;

        let mut world = CollisionWorld::<f32, ()>::new(0.02);
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        let floor = ShapeHandle::new(Cuboid::new(Vec3::new(4.0, 1.0, 4.0).into()));
        world.add(Isometry::identity(), floor, groups, query, ());
        let (place, turn) = (Vec3::new(0.5, 1.75, -0.25), Quat::from_rotation_y(0.5));
        let ball =
            world.add((place, turn).into(), ShapeHandle::new(Ball::new(1.0)), groups, query, ());
        world.update();
        let (_, _, view) = world.contact_views().next().expect("it touches");
        let contact = view.deepest_contact().contact;
        assert_eq!(Vec3::from(contact.world1), Vec3::new(0.5, 1.0, -0.25), "under the ball");
        assert_eq!(Vec3::from(*contact.normal), Vec3::Y, "up");

        let object = world.collision_object(ball).expect("it is there");
        let (back, turned): (Vec3, Quat) = (*object.position()).into();
        assert_eq!((back, turned), (place, turn), "as it was given");
        let matrix = Mat4::from(*object.position());
        assert_eq!(matrix.transform_point3(Vec3::ZERO), place, "and as a matrix");
        let exact = Isometry::<f64>::from((DVec3::X, DQuat::IDENTITY));
        assert_eq!(exact.translation.x, 1.0, "of f64 too");
    }

    /// Converts points and poses in 2D.
    #[test]
    fn in_the_plane() {
        use impinge::dim2::prelude::*;

        let pose = Isometry::<f32>::from((Vec2::new(2.0, 0.0), 0.25));
        let (place, angle): (Vec2, f32) = pose.into();
        assert_eq!(place, Vec2::new(2.0, 0.0), "where it is");
        assert!((angle - 0.25).abs() < 1e-6, "how it is turned");
        let ball = Ball::new(1.0_f32);
        assert!(ball.contains_point(&pose, &Point::from(Vec2::new(2.5, 0.5))), "in the ball");
    }
}
