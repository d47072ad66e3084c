//! Colliders that exist in 3D only, with the arguments of Avian's constructors.

use avian3d::prelude::{Position, Rotation};
use bevy_impinge::ColliderError;
use bevy_math::Vec3;
use impinge::dim3::math::{Isometry, Point, Vector};
use impinge::dim3::query::{ContactPrediction, ManifoldView, each_contact_manifold};
use impinge::dim3::shape::{HeightField, Shape, ShapeHandle};
use impinge::dim3::transformation::convex_shape;

use super::Collider;
use super::backend::isometry;
use crate::collider::points;
use crate::scaling::Dimension;

impl Dimension<3> for f32 {
    fn each_manifold(
        [pose1, pose2]: &[Isometry<Self>; 2],
        [shape1, shape2]: [&dyn Shape<Self, 3>; 2],
        prediction: &ContactPrediction<Self>,
        each: impl FnMut(ManifoldView<'_, Self>),
    ) {
        each_contact_manifold(pose1, shape1, pose2, shape2, prediction, None, each);
    }

    fn hull(points: &[Point<Self>]) -> Result<ShapeHandle<Self>, ColliderError> {
        Ok(convex_shape(points)?)
    }
}

impl Collider {
    /// Creates a ball around the origin.
    #[must_use]
    pub fn sphere(radius: f32) -> Self {
        Self::new(bevy_impinge::d3::Collider::sphere(radius))
    }

    /// Creates an ellipsoid centred at the origin, with these half lengths along the axes.
    #[must_use]
    pub fn ellipsoid(half_axes: Vec3) -> Self {
        Self::new(bevy_impinge::d3::Collider::ellipsoid(half_axes))
    }

    /// Creates a box centred at the origin, with these full lengths.
    #[must_use]
    pub fn cuboid(x_length: f32, y_length: f32, z_length: f32) -> Self {
        Self::new(bevy_impinge::d3::Collider::cuboid(x_length, y_length, z_length))
    }

    /// Creates a rounded box: all points within `border_radius` of a box with these full lengths.
    #[must_use]
    pub fn round_cuboid(x_length: f32, y_length: f32, z_length: f32, border_radius: f32) -> Self {
        Self::cuboid(x_length, y_length, z_length).rounded(border_radius)
    }

    /// Creates a cylinder along the y axis, centred at the origin.
    #[must_use]
    pub fn cylinder(radius: f32, height: f32) -> Self {
        Self::new(bevy_impinge::d3::Collider::cylinder(radius, height))
    }

    /// Creates a cone along the y axis: its apex is `height / 2` above the origin, its base `height
    /// / 2` below.
    #[must_use]
    pub fn cone(radius: f32, height: f32) -> Self {
        Self::new(bevy_impinge::d3::Collider::cone(radius, height))
    }

    /// Creates the half-space behind a plane through the origin. The normal points outwards and may
    /// have any length but 0.
    #[must_use]
    pub fn half_space(outward_normal: Vec3) -> Self {
        Self::new(bevy_impinge::d3::Collider::half_space(outward_normal.normalize_or_zero()))
    }

    /// Creates the convex hull of points; `None` if there are none, or if one is not finite. For
    /// points in a plane the result is a flat polygon.
    #[must_use]
    pub fn convex_hull(vertices: Vec<Vec3>) -> Option<Self> {
        convex_shape(&points::<3>(vertices)).ok().map(Self::from_handle)
    }

    /// Creates a surface over a grid of heights, centred at the origin: `heights[i][j]` is at `i`
    /// steps along x and `j` along z. It is `scale.x` by `scale.z` wide, with the heights times
    /// `scale.y`. Rows of different lengths give a collider with an error.
    #[must_use]
    pub fn heightfield(heights: Vec<Vec<f32>>, scale: Vec3) -> Self {
        let (columns, rows) = (heights.len(), heights.first().map_or(0, Vec::len));
        // The rows of the library's height fields are along z.
        let height = |row: usize, column: usize| heights[column].get(row).copied();
        let all = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let is_grid = heights.iter().all(|line| line.len() == rows);
        let found: Vec<f32> = all.filter_map(|(row, column)| height(row, column)).collect();
        let found = if is_grid { found } else { Vec::new() };
        let scale = Vector::new(scale.x, scale.y, scale.z);
        Self::of(HeightField::<f32>::try_new(rows, columns, found, scale))
    }

    /// Creates a compound of colliders, each at its position and rotation in the frame of the
    /// compound.
    #[must_use]
    pub fn compound(
        shapes: Vec<(impl Into<Position>, impl Into<Rotation>, impl Into<Self>)>,
    ) -> Self {
        Self::side_by_side(shapes.into_iter().map(|(position, rotation, shape)| {
            (isometry(position.into().0, rotation.into()), shape.into())
        }))
    }
}

/// A box with sides of 0.5, as in Avian.
impl Default for Collider {
    fn default() -> Self {
        Self::cuboid(0.5, 0.5, 0.5)
    }
}
