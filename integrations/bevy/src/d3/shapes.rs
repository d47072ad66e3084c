//! Colliders that exist in 3D only, and conversions from Bevy's primitives.

use bevy_math::Vec3;
use bevy_math::primitives::{
    Capsule3d, Cone as Cone3d, Cuboid as Cuboid3d, Cylinder as Cylinder3d, InfinitePlane3d,
    Polyline3d, Segment3d, Sphere, Tetrahedron as Tetrahedron3d, Triangle3d,
};
use impinge::dim3::math::{Unit, Vector};
use impinge::dim3::shape::{
    Cone, Cuboid, Cylinder, Ellipsoid, HalfSpace, HeightField, Tetrahedron,
};
use impinge::dim3::transformation::convex_shape;

use super::Collider;
use crate::collider::{point, points};

impl Collider {
    /// Creates a ball around the origin.
    #[must_use]
    pub fn sphere(radius: f32) -> Self {
        Self::ball(radius)
    }

    /// Creates a box centred at the origin, with these full lengths.
    #[must_use]
    pub fn cuboid(x_length: f32, y_length: f32, z_length: f32) -> Self {
        Self::made(Cuboid::try_new(Vector::new(x_length, y_length, z_length) / 2.0))
    }

    /// Creates a cylinder along the y axis, centred at the origin.
    #[must_use]
    pub fn cylinder(radius: f32, height: f32) -> Self {
        Self::made(Cylinder::try_new(height / 2.0, radius))
    }

    /// Creates a cone along the y axis: its apex is `height / 2` above the origin, its base `height
    /// / 2` below.
    #[must_use]
    pub fn cone(radius: f32, height: f32) -> Self {
        Self::made(Cone::try_new(height / 2.0, radius))
    }

    /// Creates an ellipsoid centred at the origin, with these half lengths along the axes.
    #[must_use]
    pub fn ellipsoid(half_axes: Vec3) -> Self {
        Self::made(Ellipsoid::try_new(Vector::new(half_axes.x, half_axes.y, half_axes.z)))
    }

    /// Creates a tetrahedron with these corners.
    #[must_use]
    pub fn tetrahedron(corners: [Vec3; 4]) -> Self {
        Self::made(Tetrahedron::try_new(corners.map(point::<3>)))
    }

    /// Creates the half-space behind a plane through the origin; `normal`, which has length 1, points outwards.
    #[must_use]
    pub fn half_space(normal: Vec3) -> Self {
        let normal = Vector::new(normal.x, normal.y, normal.z);
        Self::made(HalfSpace::try_new(Unit::new_unchecked(normal)))
    }

    /// Creates the convex hull of points; a polygon, a segment or a point, if they span no volume.
    #[must_use]
    pub fn convex_hull(vertices: impl IntoIterator<Item = Vec3>) -> Self {
        Self::from_shape(convex_shape(&points::<3>(vertices)).map_err(Into::into))
    }

    /// Creates a surface over `rows` times `columns` heights, listed row by row, centred at the
    /// origin. The row index grows along z, the column index along x. It is `scale.x` by `scale.z`
    /// wide, with the heights times `scale.y`. It is two-sided.
    #[must_use]
    pub fn heightfield(rows: usize, columns: usize, heights: Vec<f32>, scale: Vec3) -> Self {
        let scale = Vector::new(scale.x, scale.y, scale.z);
        Self::made(HeightField::<f32>::try_new(rows, columns, heights, scale))
    }
}

impl From<Sphere> for Collider {
    fn from(sphere: Sphere) -> Self {
        Self::sphere(sphere.radius)
    }
}

impl From<Cuboid3d> for Collider {
    fn from(cuboid: Cuboid3d) -> Self {
        let size = cuboid.size();
        Self::cuboid(size.x, size.y, size.z)
    }
}

impl From<Cylinder3d> for Collider {
    fn from(cylinder: Cylinder3d) -> Self {
        Self::cylinder(cylinder.radius, 2.0 * cylinder.half_height)
    }
}

impl From<Cone3d> for Collider {
    fn from(cone: Cone3d) -> Self {
        Self::cone(cone.radius, cone.height)
    }
}

impl From<Capsule3d> for Collider {
    fn from(capsule: Capsule3d) -> Self {
        Self::capsule(capsule.radius, 2.0 * capsule.half_length)
    }
}

impl From<InfinitePlane3d> for Collider {
    fn from(plane: InfinitePlane3d) -> Self {
        Self::half_space(*plane.normal)
    }
}

impl From<Segment3d> for Collider {
    fn from(segment: Segment3d) -> Self {
        let [a, b] = segment.vertices;
        Self::segment(a, b)
    }
}

impl From<Triangle3d> for Collider {
    fn from(triangle: Triangle3d) -> Self {
        let [a, b, c] = triangle.vertices;
        Self::triangle(a, b, c)
    }
}

impl From<Tetrahedron3d> for Collider {
    fn from(tetrahedron: Tetrahedron3d) -> Self {
        Self::tetrahedron(tetrahedron.vertices)
    }
}

impl From<Polyline3d> for Collider {
    fn from(polyline: Polyline3d) -> Self {
        Self::polyline(polyline.vertices)
    }
}
