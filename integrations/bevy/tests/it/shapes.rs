//! Tests of collider constructors and of conversions from Bevy's primitives. They compare the
//! extents of bounding boxes, and the error types of invalid arguments.

use bevy_impinge::{ColliderError, d2, d3};
use bevy_math::primitives::*;
use bevy_math::{Isometry2d, Isometry3d, Vec2, Vec3};

fn size2(collider: impl Into<d2::Collider>) -> Vec2 {
    let collider = collider.into();
    let half = collider.shape().expect("a good shape").local_aabb().half_extents();
    Vec2::new(half.x, half.y) * 2.0
}

fn size3(collider: impl Into<d3::Collider>) -> Vec3 {
    let collider = collider.into();
    let half = collider.shape().expect("a good shape").local_aabb().half_extents();
    Vec3::new(half.x, half.y, half.z) * 2.0
}

#[test]
fn primitives_of_2d_have_their_sizes() {
    assert_eq!(size2(Circle::new(2.0)), Vec2::new(4.0, 4.0));
    assert_eq!(size2(Rectangle::new(3.0, 5.0)), Vec2::new(3.0, 5.0));
    assert_eq!(size2(Ellipse::new(1.0, 2.0)), Vec2::new(2.0, 4.0));
    assert_eq!(size2(Capsule2d::new(0.5, 2.0)), Vec2::new(1.0, 3.0));
    assert_eq!(size2(Rhombus::new(4.0, 2.0)), Vec2::new(4.0, 2.0));
    assert_eq!(size2(Segment2d::new(Vec2::ZERO, Vec2::new(3.0, 1.0))), Vec2::new(3.0, 1.0));
    assert_eq!(size2(Triangle2d::new(Vec2::ZERO, Vec2::X, Vec2::Y * 2.0)), Vec2::new(1.0, 2.0));
    assert_eq!(size2(Polyline2d::new([Vec2::ZERO, Vec2::X, Vec2::ONE])), Vec2::ONE);
    let square = size2(RegularPolygon::new(2.0, 4));
    assert!((square - Vec2::splat(4.0)).length() < 1e-5, "{square}");
    assert_eq!(d2::Collider::from(Plane2d::default()).error(), None);
}

#[test]
fn primitives_of_3d_have_their_sizes() {
    assert_eq!(size3(Sphere::new(2.0)), Vec3::splat(4.0));
    assert_eq!(size3(Cuboid::new(1.0, 2.0, 3.0)), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(size3(Cylinder::new(1.0, 3.0)), Vec3::new(2.0, 3.0, 2.0));
    assert_eq!(size3(Capsule3d::new(1.0, 3.0)), Vec3::new(2.0, 5.0, 2.0));
    assert_eq!(size3(Cone { radius: 1.0, height: 3.0 }), Vec3::new(2.0, 3.0, 2.0));
    assert_eq!(size3(Segment3d::new(Vec3::ZERO, Vec3::ONE)), Vec3::ONE);
    assert_eq!(size3(Triangle3d::new(Vec3::ZERO, Vec3::X, Vec3::Y)), Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(size3(Tetrahedron::new(Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z)), Vec3::ONE);
    assert_eq!(size3(Polyline3d::new([Vec3::ZERO, Vec3::ONE, Vec3::X])), Vec3::ONE);
    assert_eq!(d3::Collider::from(InfinitePlane3d::default()).error(), None);
}

#[test]
fn other_shapes_have_their_sizes() {
    let hull = d3::Collider::convex_hull([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::splat(0.1)]);
    assert_eq!(size3(hull), Vec3::ONE);
    let field = d3::Collider::heightfield(
        2,
        3,
        vec![0.0, 1.0, 0.0, 0.0, 2.0, 0.0],
        Vec3::new(8.0, 2.0, 4.0),
    );
    assert_eq!(size3(field), Vec3::new(8.0, 4.0, 4.0));
    assert_eq!(
        size2(d2::Collider::heightfield(vec![0.0, 1.0, 0.0], Vec2::new(8.0, 2.0))),
        Vec2::new(8.0, 2.0)
    );
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    assert_eq!(size3(d3::Collider::trimesh(corners, vec![[0, 1, 2], [0, 1, 3]])), Vec3::ONE);
    let parts = [-1.0, 1.0].map(|x| (Isometry3d::from_xyz(x, 0.0, 0.0), d3::Collider::sphere(1.0)));
    assert_eq!(size3(d3::Collider::compound(parts)), Vec3::new(4.0, 2.0, 2.0));
    let parts = [(Isometry2d::from_xy(0.0, 1.0), d2::Collider::circle(1.0))];
    assert_eq!(size2(d2::Collider::compound(parts)), Vec2::splat(2.0));
    assert_eq!(size3(d3::Collider::cuboid(1.0, 1.0, 1.0).rounded(0.5)), Vec3::splat(2.0));
    assert_eq!(size3(d3::Collider::tapered_capsule(1.0, 0.5, 2.0)), Vec3::new(2.0, 3.5, 2.0));
    assert_eq!(size3(d3::Collider::ellipsoid(Vec3::new(1.0, 2.0, 3.0))), Vec3::new(2.0, 4.0, 6.0));
    let tube = d3::Collider::capsule_between(Vec3::ZERO, Vec3::X * 2.0, 0.5);
    assert_eq!(size3(tube), Vec3::new(3.0, 1.0, 1.0));
    let ring = [Vec2::ZERO, Vec2::X, Vec2::Y];
    assert_eq!(size2(d2::Collider::closed_polyline(ring)), Vec2::ONE);
    assert_eq!(size2(d2::Collider::convex_hull(ring)), Vec2::ONE);
    let tall = d3::Collider::cone(1.0, 4.0);
    let aabb = *tall.shape().expect("good").local_aabb().maxs();
    assert_eq!(aabb.y, 2.0);
}

#[test]
fn bad_shapes_have_errors() {
    let nan = f32::NAN;
    let is_shape = |error: Option<ColliderError>| matches!(error, Some(ColliderError::Shape(_)));
    let is_mesh = |error: Option<ColliderError>| matches!(error, Some(ColliderError::Mesh(_)));
    for bad in [-1.0, nan, f32::INFINITY] {
        assert!(is_shape(d3::Collider::sphere(bad).error()), "{bad}");
        assert!(is_shape(d3::Collider::cuboid(1.0, bad, 1.0).error()), "{bad}");
        assert!(is_shape(d2::Collider::rectangle(1.0, bad).error()), "{bad}");
        assert!(is_shape(d2::Collider::capsule(bad, 1.0).error()), "{bad}");
        assert!(is_shape(d3::Collider::sphere(1.0).rounded(bad).error()), "{bad}");
    }
    assert!(is_shape(d3::Collider::half_space(Vec3::ZERO).error()));
    assert!(is_shape(d3::Collider::convex_hull([]).error()));
    assert!(is_shape(d2::Collider::convex_hull([Vec2::NAN]).error()));
    assert!(is_shape(d3::Collider::heightfield(2, 2, vec![0.0], Vec3::ONE).error()));
    assert!(is_mesh(d3::Collider::trimesh([Vec3::ZERO], vec![[0, 1, 2]]).error()));
    assert!(is_mesh(d2::Collider::polyline([Vec2::ZERO]).error()));
    let child = (Isometry3d::IDENTITY, d3::Collider::sphere(nan));
    assert!(is_shape(d3::Collider::compound([child]).error()), "that of the child");
    let none: [(Isometry3d, d3::Collider); 0] = [];
    assert!(is_shape(d3::Collider::compound(none).error()));
}
