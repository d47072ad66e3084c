//! Tests of boxes, contacts and masses of each shape.

use core::f32::consts::PI;

use avian_impinge::d2::Collider;
use avian2d::prelude::{ComputeMassProperties2d, Rotation, ScalableCollider};
use bevy_math::Vec2;

fn all() -> Vec<Collider> {
    let square = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(Vec2::from).to_vec();
    let [a, b, c, _] = square[..] else { unreachable!("it has four corners") };
    let parts = vec![(Vec2::ZERO, Rotation::default(), Collider::circle(0.5))];
    vec![
        Collider::circle(0.5),
        Collider::rectangle(1.0, 1.0),
        Collider::round_rectangle(0.8, 0.8, 0.1),
        Collider::ellipse(0.6, 0.5),
        Collider::capsule(0.25, 0.5),
        Collider::capsule_endpoints(0.25, Vec2::NEG_Y * 0.25, Vec2::Y * 0.25),
        Collider::regular_polygon(0.5, 6),
        Collider::convex_hull(square.clone()).expect("a square"),
        Collider::convex_polyline(square.clone()).expect("a square"),
        Collider::compound(parts),
        Collider::trimesh(square.clone(), vec![[0, 1, 2], [0, 2, 3]]),
        Collider::segment(Vec2::NEG_Y * 0.5, Vec2::Y * 0.5),
        Collider::triangle(a, b, c),
        Collider::triangle(a, c, b),
        Collider::polyline(square, None),
        Collider::heightfield(vec![-0.5; 4], Vec2::ONE),
        Collider::default(),
    ]
}

#[test]
fn every_shape_meets_a_box() {
    let slab = Collider::rectangle(10.0, 2.0);
    for shape in all() {
        assert_eq!(shape.error(), None, "{shape:?}");
        let rotations = [Rotation::default(); 2];
        let low = shape.aabb(Vec2::ZERO, 0.0).min.y;
        let positions = [Vec2::new(1e4, 0.0), Vec2::new(1e4 + 1.0, 0.875 - low)];
        let found = slab.contact_manifolds(&shape, positions, rotations, 0.0);
        let deepest = found.iter().flat_map(|manifold| &manifold.points).map(|p| p.penetration);
        let deepest = deepest.fold(f32::MIN, f32::max);
        assert!((deepest - 0.125).abs() < 1e-3, "{deepest} of {shape:?}");
        assert!(found.iter().all(|manifold| manifold.normal.y > 0.999), "{found:?}");
        let apart = [positions[0], positions[1] + Vec2::Y * 0.2];
        assert!(slab.contact_manifolds(&shape, apart, rotations, 0.05).is_empty());
        assert!(!slab.contact_manifolds(&shape, apart, rotations, 0.1).is_empty());
    }
}

#[test]
fn solids_weigh_what_they_should() {
    let weighs = |shape: &Collider, area: f32, moment: f32| {
        let found = shape.mass_properties(2.0);
        assert!((found.mass - 2.0 * area).abs() < 1e-5, "{} for {}", found.mass, 2.0 * area);
        let wanted = 2.0 * area * moment;
        assert!((found.angular_inertia - wanted).abs() < 1e-5, "{found:?} for {wanted}");
        assert!((shape.unit_angular_inertia() - moment).abs() < 1e-5);
        assert!(found.center_of_mass.length() < 1e-5);
    };
    weighs(&Collider::circle(0.5), PI / 4.0, 0.125);
    weighs(&Collider::rectangle(1.0, 2.0), 2.0, 5.0 / 12.0);
    weighs(&Collider::ellipse(1.0, 2.0), 2.0 * PI, 5.0 / 4.0);
    let side = (PI / 6.0).sin() * 2.0;
    let (apothem, area) = ((PI / 6.0).cos(), 1.5 * 3.0_f32.sqrt());
    weighs(
        &Collider::regular_polygon(1.0, 6),
        area,
        (3.0 * apothem * apothem + side * side / 4.0) / 6.0,
    );
    let mut tall = Collider::rectangle(1.0, 1.0);
    tall.set_scale(Vec2::new(1.0, 2.0), 10);
    weighs(&tall, 2.0, 5.0 / 12.0);
}

/// Asserts that a capsule whose scale would make its ends elliptic becomes a hull, with an area
/// slightly below the area of the exact shape, and that shapes without an extent have an error.
#[test]
fn what_has_no_exact_scale_is_approximated() {
    let mut capsule = Collider::capsule(0.5, 1.0);
    capsule.set_scale(Vec2::new(2.0, 1.0), 20);
    let whole = 2.0 * (1.0 + PI / 4.0);
    let found = capsule.mass(1.0);
    assert!(found < whole && found > 0.99 * whole, "{found} of {whole}");
    for sides in [0, 2] {
        assert!(Collider::regular_polygon(1.0, sides).error().is_some());
    }
    assert!(Collider::regular_polygon(f32::NAN, 5).error().is_some());
    assert!(Collider::half_space(Vec2::ZERO).error().is_some());
}
