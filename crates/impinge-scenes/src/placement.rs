//! Placements: positions and rotations of objects.

use crate::rounded;

/// A rigid placement: a rotation about the local origin, then a translation.
///
/// The rotation is given by Cayley's rational parametrisation: a unit vector along the axis, and
/// the tangent of half the angle. This form needs no trigonometry, and each program that runs a
/// scene computes a rotation that is accurate to its own scalar: [`Placement::<2>::complex`],
/// [`Placement::<3>::quaternion`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement<const D: usize> {
    /// The world position of the local origin.
    pub translation: [f64; D],
    /// The unit vector along the axis of the rotation; (0, 0, 1) in 2D.
    pub axis: [f64; 3],
    /// The tangent of half the angle of the rotation, counter-clockwise about the axis.
    pub tangent: f64,
}

impl<const D: usize> Placement<D> {
    /// Creates a placement without a rotation.
    #[must_use]
    pub fn at(translation: [f64; D]) -> Self {
        Self { translation: translation.map(rounded), axis: [0.0, 0.0, 1.0], tangent: 0.0 }
    }

    /// Rotates a vector from the local to the world frame.
    #[must_use]
    pub fn turned(&self, local: &[f64; D]) -> [f64; D] {
        let v: [f64; 3] = std::array::from_fn(|i| if i < D { local[i] } else { 0.0 });
        // Rodrigues' formula for the vector part t·axis of a quaternion whose scalar part is 1.
        let t = self.axis.map(|x| x * self.tangent);
        let squared = 1.0 + t.iter().map(|x| x * x).sum::<f64>();
        let inner = cross(&t, &v);
        let outer = cross(&t, &inner);
        std::array::from_fn(|i| v[i] + 2.0 * (inner[i] + outer[i]) / squared)
    }

    /// Transforms a point from the local to the world frame.
    #[must_use]
    pub fn point(&self, local: &[f64; D]) -> [f64; D] {
        let turned = self.turned(local);
        std::array::from_fn(|i| turned[i] + self.translation[i])
    }
}

impl Placement<2> {
    /// Returns the rotation as a unit complex number: cosine and sine.
    #[must_use]
    pub fn complex(&self) -> [f64; 2] {
        let squared = self.tangent * self.tangent;
        [(1.0 - squared) / (1.0 + squared), 2.0 * self.tangent / (1.0 + squared)]
    }
}

impl Placement<3> {
    /// Returns the rotation as a unit quaternion `(i, j, k, w)`.
    #[must_use]
    pub fn quaternion(&self) -> [f64; 4] {
        let w = 1.0 / (1.0 + self.tangent * self.tangent).sqrt();
        let [x, y, z] = self.axis.map(|x| x * self.tangent * w);
        [x, y, z, w]
    }
}

/// Returns the cross product.
pub(crate) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_by_hand() {
        // The tangent 1 belongs to half of a right angle.
        let turn =
            |axis: [f64; 3]| Placement::<3> { axis, tangent: 1.0, ..Placement::at([0.0; 3]) };
        let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-15);
        assert!(close(turn([0.0, 0.0, 1.0]).turned(&[1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]), "x to y");
        assert!(close(turn([1.0, 0.0, 0.0]).turned(&[0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]), "y to z");
        let half = 0.5_f64.sqrt();
        let q = turn([0.0, 1.0, 0.0]).quaternion();
        assert!((q[1] - half).abs() < 1e-15 && (q[3] - half).abs() < 1e-15, "{q:?}");
        let plane = Placement::<2> { tangent: 1.0, ..Placement::at([3.0, 4.0]) };
        assert_eq!(plane.complex(), [0.0, 1.0], "a quarter");
        assert_eq!(plane.point(&[1.0, 0.0]), [3.0, 5.0], "turned, then moved");
    }

    #[test]
    fn turns_keep_lengths() {
        let axis = [0.6, 0.0, 0.8];
        for tangent in [-3.0, -0.1, 0.5, 100.0] {
            let placement = Placement::<3> { axis, tangent, ..Placement::at([0.0; 3]) };
            let v = placement.turned(&[1.0, 2.0, -2.0]);
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((length - 3.0).abs() < 1e-14, "tangent {tangent}: {length}");
        }
    }
}
