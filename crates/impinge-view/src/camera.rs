//! The camera of a picture.

use impinge::dim3::math::{Point, Real, Vector};
use impinge::math::unit;

/// A direction of view and a projection. The position of the camera follows from the framed
/// content.
///
/// All vectors are in the world frame. A 2D scene has `z = 0`; [`Camera::plane`] shows it with x to
/// the right and y upwards.
///
/// ```
/// use impinge::dim3::math::{Point, Vector};
/// use impinge_view::Camera;
///
/// let camera = Camera::look_along(&-Vector::z(), &Vector::y());
/// assert_eq!(camera, Camera::plane());
/// assert_eq!(camera.right(), Vector::x());
/// let near = camera.perspective(0.6).fit([Point::origin(), Point::new(1.0, 1.0, 1.0)]);
/// assert_eq!(near.up(), Vector::y());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The unit vectors right, up and back: orthonormal, with `back = right x up`.
    axes: [Vector<f64>; 3],
    /// The tangent of half the angle of view; zero for an orthographic camera.
    tangent: f64,
    framed: Option<[Point<f64>; 2]>,
}

/// The minimum and the maximum of the angle of view, in radians.
const ANGLES: [f64; 2] = [0.01, 2.5];

impl Camera {
    /// Returns a camera for 2D scenes: x to the right, y upwards, orthographic.
    #[must_use]
    pub fn plane() -> Self {
        Self::look_along(&-Vector::z(), &Vector::y())
    }

    /// Returns an orthographic camera that looks along `direction`; `up` points to the upper side
    /// of the picture.
    ///
    /// The vectors need not be unit vectors, nor perpendicular to each other. A direction that is
    /// zero or not finite becomes `-z`. An `up` that is zero, not finite, or parallel to the
    /// direction is replaced by a vector derived from the axis that is the most perpendicular to
    /// the direction.
    #[must_use]
    pub fn look_along(direction: &Vector<f64>, up: &Vector<f64>) -> Self {
        let back = -unit_of(direction).unwrap_or_else(|| -Vector::z());
        let right = unit_of(up).and_then(|up| unit_of_sine(&up.cross(&back)));
        let right = right.unwrap_or_else(|| {
            let side = least_axis(&back).cross(&back);
            side / side.norm()
        });
        Self { axes: [right, back.cross(&right), back], tangent: 0.0, framed: None }
    }

    /// Returns a perspective camera with the same direction. `view_angle` is the angle, in radians,
    /// under which the framed content appears. It is clamped to the range from 0.01 to 2.5; NaN
    /// counts as 0.01.
    #[must_use]
    pub fn perspective(self, view_angle: f64) -> Self {
        let [least, largest] = ANGLES;
        let angle = if view_angle > least { view_angle } else { least };
        let angle = if angle < largest { angle } else { largest };
        let (sine, cosine) = (angle * 0.5).sine_cosine();
        Self { tangent: sine / cosine, ..self }
    }

    /// Frames a box, given by two opposite corners, instead of all drawn content.
    ///
    /// Content outside the box is clipped by the sides of the picture. If a corner is not finite,
    /// the picture frames all content.
    #[must_use]
    pub fn fit(self, bounds: [Point<f64>; 2]) -> Self {
        let is_finite = bounds.iter().all(|corner| corner.iter().all(|x| x.is_finite()));
        Self { framed: is_finite.then_some(bounds), ..self }
    }

    /// Returns the unit vector that points to the right in the picture.
    #[must_use]
    pub fn right(&self) -> Vector<f64> {
        self.axes[0]
    }

    /// Returns the unit vector that points upwards in the picture.
    #[must_use]
    pub fn up(&self) -> Vector<f64> {
        self.axes[1]
    }

    /// Returns the unit vector from the scene to the viewer.
    #[must_use]
    pub fn back(&self) -> Vector<f64> {
        self.axes[2]
    }

    /// Returns the tangent of half the angle of view; zero for an orthographic camera.
    pub(crate) fn tangent(&self) -> f64 {
        self.tangent
    }

    /// Returns the corners of the framed box; `None` if all content is framed.
    pub(crate) fn framed(&self) -> Option<Vec<Point<f64>>> {
        let ends = self.framed?;
        let corner = |index: usize| {
            Point::new(ends[index & 1].x, ends[index >> 1 & 1].y, ends[index >> 2].z)
        };
        Some((0..8).map(corner).collect())
    }
}

/// Normalizes a vector; `None` if it is zero, infinite or NaN. Lengths whose squares overflow or
/// underflow are allowed.
fn unit_of(v: &Vector<f64>) -> Option<Vector<f64>> {
    unit(v).map(|(direction, _)| direction)
}

/// Normalizes `v`, the cross product of two unit vectors; `None` if these are parallel up to
/// rounding.
fn unit_of_sine(v: &Vector<f64>) -> Option<Vector<f64>> {
    (v.norm_squared() > 1e-20).then(|| v / v.norm())
}

/// Returns the unit vector along the axis on which `v` has the component of least magnitude.
fn least_axis(v: &Vector<f64>) -> Vector<f64> {
    let (x, y, z) = (v.x.abs(), v.y.abs(), v.z.abs());
    if y <= x && y <= z {
        Vector::y()
    } else if z <= x {
        Vector::z()
    } else {
        Vector::x()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_orthonormal_whatever_is_asked() {
        let numbers = [0.0, 1.0, -2.0, 1e-200, 1e200, f64::NAN, f64::INFINITY];
        for index in 0..numbers.len().pow(3) {
            let digit = |place| numbers[index / numbers.len().pow(place) % numbers.len()];
            let v = Vector::new(digit(0), digit(1), digit(2));
            for camera in [Camera::look_along(&v, &Vector::y()), Camera::look_along(&v, &v)] {
                let [right, up, back] = camera.axes;
                assert!((right.cross(&up) - back).norm() < 1e-14, "{v}: {camera:?}");
                assert!((right.norm() - 1.0).abs() < 1e-14, "{v}: {camera:?}");
            }
        }
    }

    #[test]
    fn angles_are_clamped() {
        let wide = Camera::plane().perspective(1e9).tangent();
        assert!((wide - 3.0).abs() < 0.01, "the tangent of 1.25 is about 3, not {wide}");
        let none = Camera::plane().perspective(f64::NAN).tangent();
        assert!((none - 0.005).abs() < 1e-6, "NaN is the smallest: {none}");
    }
}
