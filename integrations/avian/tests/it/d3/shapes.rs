//! Tests of boxes and contacts of each shape.

use avian_impinge::d3::Collider;
use avian3d::prelude::{Rotation, ScalableCollider};
use bevy_math::{Quat, Vec3};

fn rotations() -> [Rotation; 2] {
    [Rotation::default(), Rotation(Quat::from_rotation_y(0.3))]
}

fn all() -> Vec<Collider> {
    let corners =
        (0..8).map(|k| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) - 0.5);
    let corners: Vec<_> = corners.collect();
    let square = vec![[0, 1, 5], [0, 5, 4]];
    let parts = vec![(Vec3::ZERO, Quat::IDENTITY, Collider::sphere(0.5))];
    vec![
        Collider::sphere(0.5),
        Collider::cuboid(1.0, 1.0, 1.0),
        Collider::round_cuboid(0.8, 0.8, 0.8, 0.1),
        Collider::capsule(0.25, 0.5),
        Collider::capsule_endpoints(0.25, Vec3::NEG_Y * 0.25, Vec3::Y * 0.25),
        Collider::cylinder(0.5, 1.0),
        Collider::cone(0.5, 1.0),
        Collider::ellipsoid(Vec3::new(0.4, 0.5, 0.6)),
        Collider::convex_hull(corners.clone()).expect("a cube"),
        Collider::compound(parts),
        Collider::trimesh(corners.clone(), square),
        Collider::segment(Vec3::NEG_Y * 0.5, Vec3::Y * 0.5),
        Collider::triangle(corners[0], corners[1], corners[5]),
        Collider::polyline(corners, Some(vec![[0, 1], [1, 5], [5, 4]])),
        Collider::heightfield(vec![vec![-0.5; 3]; 3], Vec3::ONE),
        Collider::default(),
    ]
}

/// Places each shape over a box that it overlaps by 0.125, far from the global origin. Asserts the
/// depth, the normal and the positions of the points.
#[test]
fn every_shape_meets_a_box() {
    let slab = Collider::cuboid(10.0, 2.0, 10.0);
    for shape in all() {
        assert_eq!(shape.error(), None, "{shape:?}");
        let low = shape.aabb(Vec3::ZERO, Quat::IDENTITY).min.y;
        let positions = [Vec3::new(1e4, 0.0, 0.0), Vec3::new(1e4 + 1.0, 0.875 - low, 0.5)];
        let found = slab.contact_manifolds(&shape, positions, rotations(), 0.0);
        let deepest = found.iter().flat_map(|manifold| &manifold.points).map(|p| p.penetration);
        let deepest = deepest.fold(f32::MIN, f32::max);
        assert!((deepest - 0.125).abs() < 1e-3, "{deepest} of {shape:?}");
        for manifold in &found {
            assert!(manifold.normal.y > 0.999, "from the first to the second: {manifold:?}");
            for point in &manifold.points {
                let apart = point.anchor1 - point.anchor2 - (positions[1] - positions[0]);
                assert!(apart.length() < 1e-5, "one point: {point:?}");
                assert!(
                    (point.anchor1.y - (1.0 - point.penetration / 2.0)).abs() < 1e-4,
                    "halfway"
                );
            }
        }
        let apart = [positions[0], positions[1] + Vec3::Y * 0.2];
        assert!(slab.contact_manifolds(&shape, apart, rotations(), 0.05).is_empty());
        assert!(!slab.contact_manifolds(&shape, apart, rotations(), 0.1).is_empty());
    }
}

#[test]
fn boxes_hold_their_shapes() {
    for shape in all() {
        let at = Vec3::new(3.0, -2.0, 1.0);
        let aabb = shape.aabb(at, Quat::from_rotation_x(0.7));
        assert!(aabb.min.cmple(at + 1.0).all() && aabb.max.cmpge(at - 1.0).all(), "{aabb:?}");
        assert!(aabb.size().max_element() < 2.1, "{aabb:?} of {shape:?}");
    }
    let aabb = Collider::half_space(Vec3::Y).aabb(Vec3::Y, Quat::IDENTITY);
    assert!(aabb.size().is_finite() && aabb.max.y < 1.001 && aabb.max.x > 1e30, "{aabb:?}");
}

/// Asserts that the outer list of heights runs along x: of two lists, the first has the heights at
/// the lower end of the x axis, the second those at the upper end.
#[test]
fn heights_are_given_along_x_first() {
    let field = Collider::heightfield(
        vec![vec![0.0, 0.0, 0.0], vec![1.0, 1.0, 1.0]],
        Vec3::new(2.0, 1.0, 4.0),
    );
    assert_eq!(field.error(), None);
    let ball = Collider::sphere(0.1);
    let touches = |x: f32, y: f32| {
        let positions = [Vec3::ZERO, Vec3::new(x, y, 1.0)];
        !field.contact_manifolds(&ball, positions, rotations(), 0.0).is_empty()
    };
    assert!(touches(0.95, 1.0) && touches(-0.95, 0.0));
    assert!(!touches(0.95, 0.0) && !touches(-0.95, 1.0));
    assert!(Collider::heightfield(vec![vec![0.0; 3], vec![0.0; 2]], Vec3::ONE).error().is_some());
}

/// Asserts that a shape that cannot be scaled exactly becomes a hull, and that a scale of zero is
/// rejected.
#[test]
fn scales() {
    let mut cylinder = Collider::cylinder(0.5, 1.0);
    cylinder.set_scale(Vec3::new(2.0, 1.0, 1.0), 16);
    let aabb = cylinder.aabb(Vec3::ZERO, Quat::IDENTITY);
    assert!((aabb.size() - Vec3::new(2.0, 1.0, 1.0)).length() < 0.02, "{aabb:?}");
    cylinder.set_scale(Vec3::new(0.0, 1.0, 1.0), 16);
    assert_eq!(Collider::scale(&cylinder), Vec3::new(2.0, 1.0, 1.0), "no shape is flat");
    cylinder.set_scale(Vec3::ONE, 16);
    let aabb = cylinder.aabb(Vec3::ZERO, Quat::IDENTITY);
    assert!((aabb.size() - Vec3::ONE).length() < 1e-5, "{aabb:?}");
}
