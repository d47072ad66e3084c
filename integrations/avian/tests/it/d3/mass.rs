//! Compares mass properties with closed forms.

use core::f32::consts::PI;

use avian_impinge::d3::Collider;
use avian3d::prelude::{ComputeMassProperties3d, ScalableCollider};
use bevy_math::{Quat, Vec3};

/// Checks the mass properties of a collider at density 2. `moments` are the principal moments of
/// inertia divided by the mass.
fn weighs(collider: &Collider, volume: f32, center: Vec3, moments: Vec3) {
    let found = collider.mass_properties(2.0);
    let near = |a: f32, b: f32| (a - b).abs() <= 1e-5 * b.abs().max(1.0);
    assert!(near(found.mass, 2.0 * volume), "{} for {}", found.mass, 2.0 * volume);
    assert!(near(collider.mass(2.0), 2.0 * volume));
    assert!((found.center_of_mass - center).length() < 1e-5, "{}", found.center_of_mass);
    let wanted = moments * 2.0 * volume;
    let inertia = found.principal_angular_inertia;
    for axis in 0..3 {
        assert!(near(inertia[axis], wanted[axis]), "{inertia} for {wanted}");
        assert!(near(collider.unit_principal_angular_inertia()[axis], moments[axis]));
    }
}

#[test]
fn solids_weigh_what_they_should() {
    weighs(&Collider::sphere(2.0), 4.0 / 3.0 * PI * 8.0, Vec3::ZERO, Vec3::splat(1.6));
    let box_moments = Vec3::new(4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0) / 12.0;
    weighs(&Collider::cuboid(1.0, 2.0, 3.0), 6.0, Vec3::ZERO, box_moments);
    let (r, h) = (0.5_f32, 3.0_f32);
    let across = (3.0 * r * r + h * h) / 12.0;
    let moments = Vec3::new(across, r * r / 2.0, across);
    weighs(&Collider::cylinder(r, h), PI * r * r * h, Vec3::ZERO, moments);
    let across = 0.15 * r * r + 0.0375 * h * h;
    let moments = Vec3::new(across, 0.3 * r * r, across);
    weighs(&Collider::cone(r, h), PI * r * r * h / 3.0, Vec3::NEG_Y * (h / 4.0), moments);
    let (side, ball) = (PI * r * r * h, 4.0 / 3.0 * PI * r * r * r);
    let along = side * r * r / 2.0 + ball * 0.4 * r * r;
    let across =
        side * (h * h / 12.0 + r * r / 4.0) + ball * (0.4 * r * r + h * h / 4.0 + 0.375 * h * r);
    let moments = Vec3::new(across, along, across) / (side + ball);
    weighs(&Collider::capsule(r, h), side + ball, Vec3::ZERO, moments);
}

#[test]
fn closed_meshes_and_compounds_weigh_what_they_enclose() {
    let corners = (0..8).map(|k| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32));
    let corners: Vec<_> = corners.map(|corner| corner * Vec3::new(1.0, 2.0, 3.0)).collect();
    let squares =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = squares.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let moments = Vec3::new(4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0) / 12.0;
    let center = Vec3::new(0.5, 1.0, 1.5);
    weighs(&Collider::trimesh(corners.clone(), triangles), 6.0, center, moments);
    weighs(&Collider::convex_hull(corners).expect("a box"), 6.0, center, moments);
    let half = Collider::cuboid(1.0, 2.0, 1.5);
    let parts = vec![
        (Vec3::Z * 0.75, Quat::IDENTITY, half.clone()),
        (Vec3::NEG_Z * 0.75, Quat::IDENTITY, half),
    ];
    weighs(&Collider::compound(parts), 6.0, Vec3::ZERO, moments);
}

#[test]
fn what_encloses_nothing_has_no_mass() {
    let open = Collider::trimesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]);
    for shape in [open, Collider::half_space(Vec3::Y), Collider::sphere(f32::NAN)] {
        assert_eq!((shape.mass(1.0), shape.principal_angular_inertia(1.0)), (0.0, Vec3::ZERO));
        assert_eq!(shape.mass_properties(1.0).mass, 0.0);
    }
}

/// Asserts that the mass properties of a collider include its scale.
#[test]
fn scaled_shapes_weigh_as_such() {
    let mut ball = Collider::sphere(1.0);
    ball.set_scale(Vec3::new(1.0, 2.0, 3.0), 10);
    let moments = Vec3::new(4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0) / 5.0;
    weighs(&ball, 8.0 * PI, Vec3::ZERO, moments);
    // The hull lies inside the elliptic capsule.
    let mut capsule = Collider::capsule(1.0, 2.0);
    capsule.set_scale(Vec3::new(2.0, 1.0, 1.0), 20);
    let whole = 2.0 * (PI * 2.0 + 4.0 / 3.0 * PI);
    let found = capsule.mass(1.0);
    assert!(found < whole && found > 0.96 * whole, "{found} of {whole}");
    assert_eq!(Collider::scale(&capsule), Vec3::new(2.0, 1.0, 1.0));
}
