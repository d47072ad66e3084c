//! Tests the ids of contacts where two edges cross.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use impinge::math::Point;
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Capsule, ConvexHull, Cylinder, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_scenes::Placement;

use super::contact_ids::{ACROSS, World, contacts_of, cuboid};
use crate::support::scene_stage::Play;

/// Asserts that a crossing of two edges ends when its normal turns by more than 45°, though the
/// features stay the same, and outlasts a turn of 40°.
fn crossings_end_with_their_normal<N: Play<3>>() {
    let capsule = ShapeHandle::new(Capsule::new(N::ONE, N::lit(0.5)));
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|index: u32| {
        let sign = |axis: usize| if index >> axis & 1 == 1 { N::ONE } else { -N::ONE };
        Point::<N, 3>::new(sign(0), sign(1), sign(2))
    });
    let hull = ShapeHandle::new(ConvexHull::from_points(&corners));
    // An edge of the first solid lies on the x axis; seen from there, the second solid lies in the
    // direction (0, cos, sin) of an angle, and rotates with the angle about the x axis. A capsule,
    // long in y, rotates by a quarter turn more; a cube stands on an edge.
    let (corner, diagonal) = ([0.0, -1.0, -1.0], 2.0_f64.sqrt());
    for (shape, origin, reach, [lying, roll, pitch]) in [
        (capsule, [0.0; 3], 1.0, [FRAC_PI_2, 0.0, FRAC_PI_2]),
        (cuboid::<N, 3>([1.0; 3]), corner, diagonal, [0.0, FRAC_PI_4, 0.0]),
        (hull, corner, diagonal, [0.0, FRAC_PI_4, 0.0]),
    ] {
        let place = |degrees: f64| {
            let angle = degrees.to_radians();
            let [x, z] = [angle + pitch, roll].map(|angle| (angle / 2.0).tan());
            let axis = [x, -x * z, z];
            let tangent = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            let translation = [0.0, angle.cos(), angle.sin()].map(|x| x * (reach - 0.01));
            let axis = axis.map(|x| x / tangent);
            N::pose_of(&Placement { translation, axis, tangent }, 1.0)
        };
        let tangent = (lying / 2.0).tan();
        let first_place = Placement { translation: origin, axis: ACROSS, tangent };
        for (turn, outlasts) in [(40.0, true), (70.0, false)] {
            let mut world = World::<N, 3>::new(N::lit(0.02));
            let query = GeometricQueryType::Contacts(N::lit(0.05), N::ZERO);
            let mut add = |at, shape: &ShapeHandle<N, 3>| {
                world.add(at, shape.clone(), CollisionGroups::new(), query, ())
            };
            let first = add(N::pose_of(&first_place, 1.0), &shape);
            let second = add(place(45.0 - turn / 2.0), &shape);
            world.update();
            let before = contacts_of(&world, first, second);
            assert_eq!(before.len(), 1, "edges that cross");
            world.set_position(second, place(45.0 + turn / 2.0));
            world.update();
            let after = contacts_of(&world, first, second);
            assert_eq!(after.len(), 1, "edges that cross");
            assert_eq!(before[0].id == after[0].id, outlasts, "turned by {turn}");
        }
    }
}

/// Asserts that a contact of two capsules that slide along each other keeps its id, also where
/// their canonical order changes, after one of them was a cylinder.
fn crossings_outlast_a_former_shape<N: Play<3>>() {
    let capsule = ShapeHandle::new(Capsule::new(N::ONE, N::lit(0.25)));
    let cylinder = ShapeHandle::new(Cylinder::new(N::ONE, N::lit(0.25)));
    let place =
        |translation, axis, tangent| N::pose_of(&Placement { translation, axis, tangent }, 1.0);
    // The first lies along x, the second along z, beside it in y.
    let slide = |x: f64| place([x, -0.45, 0.0], [1.0, 0.0, 0.0], 1.0);
    let mut world = World::<N, 3>::new(N::lit(0.02));
    let query = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    let mut add = |at, shape| world.add(at, shape, CollisionGroups::new(), query, ());
    let first = add(place([0.0; 3], [0.0, 0.0, -1.0], 1.0), cylinder);
    let second = add(slide(-0.8), capsule.clone());
    world.update();
    world.set_shape(first, capsule);
    world.update();
    let ids = |world: &World<N, 3>| -> Vec<_> {
        contacts_of(world, first, second).iter().map(|tracked| tracked.id).collect()
    };
    let before = ids(&world);
    assert_eq!(before.len(), 1, "a crossing");
    for step in -15..=16 {
        world.set_position(second, slide(0.05 * f64::from(step)));
        world.update();
        assert_eq!(ids(&world), before, "step {step}");
    }
}

#[test]
fn crossings_end_when_they_turn() {
    crossings_end_with_their_normal::<f32>();
    crossings_end_with_their_normal::<f64>();
    crossings_outlast_a_former_shape::<f32>();
    crossings_outlast_a_former_shape::<f64>();
}
