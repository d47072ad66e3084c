//! Colliders that exist in 2D only, and conversions from Bevy's primitives.

use bevy_math::Vec2;
use bevy_math::primitives::{
    Capsule2d, Circle, ConvexPolygon as ConvexPolygon2d, Ellipse as Ellipse2d, Plane2d, Polyline2d,
    Rectangle, RegularPolygon, Rhombus, Segment2d, Triangle2d,
};
use impinge::dim2::math::{Unit, Vector};
use impinge::dim2::shape::{Cuboid, Ellipse, HalfSpace, HeightField};
use impinge::dim2::transformation::convex_shape;

use super::Collider;
use crate::collider::points;

impl Collider {
    /// Creates a disk around the origin.
    #[must_use]
    pub fn circle(radius: f32) -> Self {
        Self::ball(radius)
    }

    /// Creates a rectangle centred at the origin, with these full lengths.
    #[must_use]
    pub fn rectangle(x_length: f32, y_length: f32) -> Self {
        Self::made(Cuboid::try_new(Vector::new(x_length, y_length) / 2.0))
    }

    /// Creates an ellipse centred at the origin, with these half lengths along the axes, as Bevy's
    /// `Ellipse`.
    #[must_use]
    pub fn ellipse(half_width: f32, half_height: f32) -> Self {
        Self::made(Ellipse::try_new(Vector::new(half_width, half_height)))
    }

    /// Creates the half-plane behind a line through the origin; `normal`, which has length 1, points outwards.
    #[must_use]
    pub fn half_plane(normal: Vec2) -> Self {
        Self::made(HalfSpace::try_new(Unit::new_unchecked(Vector::new(normal.x, normal.y))))
    }

    /// Creates the convex hull of points; a segment or a point, if they span no area.
    #[must_use]
    pub fn convex_hull(vertices: impl IntoIterator<Item = Vec2>) -> Self {
        Self::from_shape(convex_shape(&points::<2>(vertices)).map_err(Into::into))
    }

    /// Creates a polyline over heights at equal distances, centred at the origin: `scale.x` wide, with the heights
    /// times `scale.y`. It is two-sided.
    #[must_use]
    pub fn heightfield(heights: Vec<f32>, scale: Vec2) -> Self {
        Self::made(HeightField::<f32>::try_new(heights, Vector::new(scale.x, scale.y)))
    }
}

impl From<Circle> for Collider {
    fn from(circle: Circle) -> Self {
        Self::circle(circle.radius)
    }
}

impl From<Ellipse2d> for Collider {
    fn from(ellipse: Ellipse2d) -> Self {
        Self::ellipse(ellipse.half_size.x, ellipse.half_size.y)
    }
}

impl From<Rectangle> for Collider {
    fn from(rectangle: Rectangle) -> Self {
        let size = rectangle.size();
        Self::rectangle(size.x, size.y)
    }
}

impl From<Rhombus> for Collider {
    fn from(rhombus: Rhombus) -> Self {
        let Vec2 { x, y } = rhombus.half_diagonals;
        Self::convex_hull([
            Vec2::new(x, 0.0),
            Vec2::new(0.0, y),
            Vec2::new(-x, 0.0),
            Vec2::new(0.0, -y),
        ])
    }
}

impl From<Capsule2d> for Collider {
    fn from(capsule: Capsule2d) -> Self {
        Self::capsule(capsule.radius, 2.0 * capsule.half_length)
    }
}

impl From<Plane2d> for Collider {
    fn from(plane: Plane2d) -> Self {
        Self::half_plane(*plane.normal)
    }
}

impl From<Segment2d> for Collider {
    fn from(segment: Segment2d) -> Self {
        let [a, b] = segment.vertices;
        Self::segment(a, b)
    }
}

impl From<Triangle2d> for Collider {
    fn from(triangle: Triangle2d) -> Self {
        let [a, b, c] = triangle.vertices;
        Self::triangle(a, b, c)
    }
}

impl From<Polyline2d> for Collider {
    fn from(polyline: Polyline2d) -> Self {
        Self::polyline(polyline.vertices)
    }
}

impl From<ConvexPolygon2d> for Collider {
    fn from(polygon: ConvexPolygon2d) -> Self {
        Self::convex_hull(polygon.vertices().iter().copied())
    }
}

impl From<RegularPolygon> for Collider {
    fn from(polygon: RegularPolygon) -> Self {
        Self::convex_hull(polygon.vertices(0.0))
    }
}
