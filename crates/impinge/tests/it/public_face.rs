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
