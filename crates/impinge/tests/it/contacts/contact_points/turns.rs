//! Random rotations of solids: by quarter turns, by small angles from these, and arbitrary ones.

use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{Real, Vector};
use impinge_reference::random::Random;

/// The rotations of one dimension.
pub(crate) struct Turns<R> {
    /// A random rotation that maps axes to axes.
    pub(crate) straight: fn(&mut Random) -> R,
    /// A rotation by the given angle, in radians, about a random axis perpendicular to the y axis.
    /// In 2D the sign of the angle is random.
    pub(crate) tilt: fn(f64, &mut Random) -> R,
    pub(crate) any: fn(&mut Random) -> R,
}

/// Returns the generators of rotations in 2D. `CLEAN` sets tiny components to zero; see
/// [`component`].
pub(crate) fn turns2<N: Real, const CLEAN: bool>() -> Turns<UnitComplex<N>> {
    Turns {
        straight: |random| {
            turned2::<N, CLEAN>([0.0, 0.5, 1.0, 1.5][random.below(4)] * core::f64::consts::PI)
        },
        tilt: |angle, random| turned2::<N, CLEAN>(*random.pick(&[angle, -angle])),
        any: |random| turned2::<N, CLEAN>(random.range(-3.0, 3.0)),
    }
}

/// Returns the generators of rotations in 3D. `CLEAN` sets tiny components to zero; see
/// [`component`].
pub(crate) fn turns3<N: Real, const CLEAN: bool>() -> Turns<UnitQuaternion<N>> {
    Turns {
        straight: |random| {
            let axis = random.below(3);
            let sign = *random.pick(&[0.0, 0.5, 1.0, -0.5]);
            turned3::<N, CLEAN>(Vector::<f64, 3>::ith(axis, sign * core::f64::consts::PI))
        },
        tilt: |angle, random| {
            let [x, y] = random.unit_vector::<2>();
            turned3::<N, CLEAN>(Vector::<f64, 3>::new(x, 0.0, y) * angle)
        },
        any: |random| turned3::<N, CLEAN>(Vector::<f64, 3>::from(random.vector::<3>(3.0))),
    }
}

fn turned2<N: Real, const CLEAN: bool>(angle: f64) -> UnitComplex<N> {
    let [cos, sin] = [angle.cos(), angle.sin()].map(component::<N, CLEAN>);
    UnitComplex::from_cos_sin_unchecked(cos, sin)
}

pub(crate) fn turned3<N: Real, const CLEAN: bool>(by: Vector<f64, 3>) -> UnitQuaternion<N> {
    let turn = UnitQuaternion::from_scaled_axis(by);
    UnitQuaternion::new_normalize(turn.into_inner().coords.map(component::<N, CLEAN>).into())
}

/// Converts a component of a rotation to `N`. `CLEAN` replaces magnitudes below `EPSILON / 64` by
/// zero.
fn component<N: Real, const CLEAN: bool>(x: f64) -> N {
    if CLEAN && x.abs() < N::EPSILON.as_f64() / 64.0 { N::ZERO } else { N::lit(x) }
}
