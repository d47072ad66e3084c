//! Programs as a user writes them who begins with the prelude: the names that there are, in both dimensions and for
//! both scalars, and that short names are the generic types.

use impinge::math::Real;

/// The programs of one dimension; they are the same source for both.
macro_rules! programs {
    ($name:ident, $dim:ident, $d:literal) => {
        mod $name {
            use impinge::$dim::prelude::*;

            use super::Real;

            fn at<N: Real>(height: f64) -> Isometry<N> {
                Isometry::from_parts((Vector::y() * N::lit(height)).into(), Rotation::identity())
            }

            fn square<N: Real>(size: f64) -> Cuboid<N> {
                Cuboid::new(Vector::repeat(N::lit(size)))
            }

            /// All of a usual program, with no other import.
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
                // The generic type is the same type.
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

            /// The numbers of a query type by their names, and the same events whichever way they are given.
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

            /// Each name of a question answers as the one that it is the same as.
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
