//! Colliders that exist in 2D only, with the arguments of Avian's constructors.

use avian2d::prelude::{Position, Rotation};
use bevy_impinge::ColliderError;
use bevy_math::Vec2;
use bevy_math::primitives::RegularPolygon;
use impinge::dim2::math::{Isometry, Point};
use impinge::dim2::query::{ContactPrediction, ManifoldView, each_contact_manifold};
use impinge::dim2::shape::{Shape, ShapeHandle};
use impinge::dim2::transformation::convex_shape;

use super::Collider;
use super::backend::isometry;
use crate::collider::points;
use crate::scaling::Dimension;

impl Dimension<2> for f32 {
    fn each_manifold(
        [pose1, pose2]: &[Isometry<Self>; 2],
        [shape1, shape2]: [&dyn Shape<Self, 2>; 2],
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
    /// Creates a disk around the origin.
    #[must_use]
    pub fn circle(radius: f32) -> Self {
        Self::new(bevy_impinge::d2::Collider::circle(radius))
    }

    /// Creates an ellipse centred at the origin, with these half lengths along the axes.
    #[must_use]
    pub fn ellipse(half_width: f32, half_height: f32) -> Self {
        Self::new(bevy_impinge::d2::Collider::ellipse(half_width, half_height))
    }

    /// Creates a rectangle centred at the origin, with these full lengths.
    #[must_use]
    pub fn rectangle(x_length: f32, y_length: f32) -> Self {
        Self::new(bevy_impinge::d2::Collider::rectangle(x_length, y_length))
    }

    /// Creates a rounded rectangle: all points within `border_radius` of a rectangle with these
    /// full lengths.
    #[must_use]
    pub fn round_rectangle(x_length: f32, y_length: f32, border_radius: f32) -> Self {
        Self::rectangle(x_length, y_length).rounded(border_radius)
    }

    /// Creates a regular polygon whose corners lie on a circle of radius `circumradius`, one of
    /// them at the top. Fewer than 3 sides, and a radius that is negative or not finite, give a
    /// collider with an error.
    #[must_use]
    pub fn regular_polygon(circumradius: f32, sides: u32) -> Self {
        let is_one = sides >= 3 && circumradius >= 0.0 && circumradius.is_finite();
        // Without corners, the constructor of the hull returns the error.
        let corners = is_one.then(|| RegularPolygon::new(circumradius, sides).vertices(0.0));
        Self::new(bevy_impinge::d2::Collider::convex_hull(corners.into_iter().flatten()))
    }

    /// Creates the half-plane behind a line through the origin. The normal points outwards and may
    /// have any length but 0.
    #[must_use]
    pub fn half_space(outward_normal: Vec2) -> Self {
        Self::new(bevy_impinge::d2::Collider::half_plane(outward_normal.normalize_or_zero()))
    }

    /// Creates the convex hull of points; `None` if there are none, or if one is not finite. For
    /// points on a line the result is a segment.
    #[must_use]
    pub fn convex_hull(vertices: Vec<Vec2>) -> Option<Self> {
        convex_shape(&points::<2>(vertices)).ok().map(Self::from_handle)
    }

    /// Creates the convex hull of the corners of a polygon; `None` if there are no corners, or if
    /// one is not finite.
    #[must_use]
    pub fn convex_polyline(vertices: Vec<Vec2>) -> Option<Self> {
        Self::convex_hull(vertices)
    }

    /// Creates a polyline over evenly spaced heights, centred at the origin: `scale.x` wide, with
    /// the heights times `scale.y`.
    #[must_use]
    pub fn heightfield(heights: Vec<f32>, scale: Vec2) -> Self {
        Self::new(bevy_impinge::d2::Collider::heightfield(heights, scale))
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

/// A square with sides of 0.5, as in Avian.
impl Default for Collider {
    fn default() -> Self {
        Self::rectangle(0.5, 0.5)
    }
}
