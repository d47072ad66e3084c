//! Rotation and translation of a solid.

use super::vector::{add, axis, dot, norm, sub};

/// The position and rotation of a solid: `world = rotation * local + translation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<const D: usize> {
    /// The rows of the rotation matrix. The matrix must be orthogonal with determinant +1, which is
    /// not checked.
    pub rotation: [[f64; D]; D],
    /// The world position of the local origin.
    pub translation: [f64; D],
}

impl<const D: usize> Pose<D> {
    /// Returns the pose whose local frame is the world frame.
    #[must_use]
    pub fn identity() -> Self {
        Self::at([0.0; D])
    }

    /// Returns a pose without rotation.
    #[must_use]
    pub fn at(translation: [f64; D]) -> Self {
        Self { rotation: std::array::from_fn(axis), translation }
    }

    /// Rotates the vector `v` from the local to the world frame.
    #[must_use]
    pub fn rotate(&self, v: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|row| dot(&self.rotation[row], v))
    }

    /// Rotates the vector `v` from the world to the local frame.
    #[must_use]
    pub fn inverse_rotate(&self, v: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|column| (0..D).map(|row| self.rotation[row][column] * v[row]).sum())
    }

    /// Transforms the point `p` from the local to the world frame.
    #[must_use]
    pub fn apply(&self, p: &[f64; D]) -> [f64; D] {
        add(&self.rotate(p), &self.translation)
    }

    /// Transforms the point `p` from the world to the local frame.
    #[must_use]
    pub fn inverse_apply(&self, p: &[f64; D]) -> [f64; D] {
        self.inverse_rotate(&sub(p, &self.translation))
    }

    /// Returns the world pose of an object whose pose in the frame of `self` is `local`.
    #[must_use]
    pub fn compose(&self, local: &Self) -> Self {
        let columns: [[f64; D]; D] =
            std::array::from_fn(|j| self.rotate(&std::array::from_fn(|i| local.rotation[i][j])));
        Self {
            rotation: std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])),
            translation: self.apply(&local.translation),
        }
    }

    /// Returns the pose translated by the world vector `by`.
    #[must_use]
    pub fn moved(&self, by: &[f64; D]) -> Self {
        Self { rotation: self.rotation, translation: add(&self.translation, by) }
    }
}

impl Pose<2> {
    /// Returns the pose with a counter-clockwise rotation by `angle` radians.
    #[must_use]
    pub fn from_angle(translation: [f64; 2], angle: f64) -> Self {
        Self::from_complex(translation, [angle.cos(), angle.sin()])
    }

    /// Returns the pose with the rotation of the complex number `[cosine, sine]`, which is
    /// normalized first.
    #[must_use]
    pub fn from_complex(translation: [f64; 2], complex: [f64; 2]) -> Self {
        let length = norm(&complex);
        let [c, s] = complex.map(|x| x / length);
        Self { rotation: [[c, -s], [s, c]], translation }
    }
}

impl Pose<3> {
    /// Returns the pose with the rotation of the quaternion `[x, y, z, w]`, which is normalized
    /// first.
    #[must_use]
    pub fn from_quaternion(translation: [f64; 3], quaternion: [f64; 4]) -> Self {
        let length = norm(&quaternion);
        let [x, y, z, w] = quaternion.map(|q| q / length);
        let rotation = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Self { rotation, translation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns() {
        let plane = Pose::from_complex([1.0, 2.0], [0.0, 5.0]);
        assert_eq!(plane.apply(&[1.0, 0.0]), [1.0, 3.0]);
        assert_eq!(plane.inverse_apply(&[1.0, 3.0]), [1.0, 0.0]);
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let space = Pose::from_quaternion([0.0; 3], [0.0, 0.0, half, half]);
        let turned = space.rotate(&[1.0, 0.0, 0.0]);
        assert!(norm(&sub(&turned, &[0.0, 1.0, 0.0])) < 1e-15, "x turns to y about z: {turned:?}");
    }

    #[test]
    fn composition_is_application_twice() {
        let outer = Pose::from_angle([1.0, -2.0], 0.3);
        let inner = Pose::from_angle([0.5, 4.0], -1.1);
        let p = [0.7, 0.2];
        let difference = sub(&outer.compose(&inner).apply(&p), &outer.apply(&inner.apply(&p)));
        assert!(norm(&difference) < 1e-15, "difference {difference:?}");
    }
}
