//! Placements of solids as plain numbers, the common input of all contenders.

use impinge_reference::geometry::vector::{add, dot, norm, scale, sub};
use impinge_reference::random::Random;

/// A rigid motion: a rotation, then a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement<const D: usize> {
    pub translation: [f64; D],
    /// The quaternion `[x, y, z, w]`; in 2D a rotation about the third axis.
    pub rotation: [f64; 4],
}

/// The identity rotation.
pub const UNTURNED: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

impl<const D: usize> Placement<D> {
    pub fn new(translation: [f64; D], rotation: [f64; 4]) -> Self {
        Self { translation, rotation }
    }

    /// Returns the cosine and the sine of the angle of a rotation in 2D.
    pub fn complex(&self) -> [f64; 2] {
        let [_, _, z, w] = self.rotation;
        [w * w - z * z, 2.0 * z * w]
    }

    /// Returns the placement after a random translation of a length up to `size` and a random
    /// rotation by an angle up to `size`, in radians.
    pub fn perturbed(&self, random: &mut Random, size: f64) -> Self {
        let step: [f64; D] = random.unit_vector();
        let angle = random.range(-size, size) / 2.0;
        let axis: [f64; 3] = if D == 2 { [0.0, 0.0, 1.0] } else { random.unit_vector() };
        let [x, y, z] = scale(&axis, angle);
        let length = random.range(0.0, size);
        Self {
            translation: add(&self.translation, &scale(&step, length)),
            rotation: unit(product([x, y, z, 1.0], self.rotation)),
        }
    }
}

/// Returns a random rotation: about the third axis in 2D, about any axis in 3D.
pub fn any_rotation<const D: usize>(random: &mut Random) -> [f64; 4] {
    if D == 2 {
        let [z, w] = random.unit_vector();
        return [0.0, 0.0, z, w];
    }
    random.quaternion()
}

/// Returns the shortest rotation that maps the unit vector `from` to `to`. Nearly opposite vectors
/// (within about 0.8 degrees) count as opposite: the result is a half turn about a perpendicular
/// axis.
pub fn turning<const D: usize>(from: &[f64; D], to: &[f64; D]) -> [f64; 4] {
    let (from, to) = (in_space(from), in_space(to));
    let cosine = dot(&from, &to);
    if cosine < -0.9999 {
        let [x, y, z] = normalised(&perpendicular_to(&from));
        return [x, y, z, 0.0];
    }
    let [x, y, z] = cross(&from, &to);
    unit([x, y, z, 1.0 + cosine])
}

/// Returns a vector perpendicular to a unit vector. For a vector in the x-y plane it is the z axis.
fn perpendicular_to(direction: &[f64; 3]) -> [f64; 3] {
    let axis = if direction[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    sub(&axis, &scale(direction, dot(direction, &axis)))
}

fn in_space<const D: usize>(v: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}

fn normalised<const D: usize>(v: &[f64; D]) -> [f64; D] {
    scale(v, 1.0 / norm(v))
}

fn unit(q: [f64; 4]) -> [f64; 4] {
    normalised(&q)
}

fn cross([a, b, c]: &[f64; 3], [x, y, z]: &[f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Composes two rotations: the result rotates by `q` first, then by `p`.
fn product(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    let ([px, py, pz, pw], [qx, qy, qz, qw]) = (p, q);
    let (u, v) = ([px, py, pz], [qx, qy, qz]);
    let [x, y, z] = add(&cross(&u, &v), &add(&scale(&v, pw), &scale(&u, qw)));
    [x, y, z, pw * qw - dot(&u, &v)]
}
