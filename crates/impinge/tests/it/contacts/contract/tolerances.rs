//! The tolerances of `guide/guarantees.md`, in units of `EPSILON` times the size of the scene.

use impinge::math::Real;

/// Returns `true` for solids for which the reference has to search for the normal.
pub(crate) fn is_curved(name: &str) -> bool {
    ["cylinder", "cone", "ellipsoid", "tapered"].iter().any(|curved| name.contains(curved))
}

/// Returns `true` for solids of revolution with flat ends.
pub(crate) fn is_of_revolution(name: &str) -> bool {
    name.contains("cylinder") || name.contains("cone")
}

/// Returns the guaranteed bound of the depth error for two kinds, in units.
pub(crate) fn promised<N: Real, const D: usize>(names: [&str; 2]) -> f64 {
    let is_double = N::EPSILON.as_f64() < 1e-10;
    let of_revolution = names.iter().any(|name| is_of_revolution(name));
    match (is_double, of_revolution) {
        (true, true) => 2048.0,
        (true, false) if D == 3 => 128.0,
        _ => 64.0,
    }
}

/// Returns `true` if the depth is guaranteed to be the least. It is not guaranteed if one of the
/// solids is a tapered capsule and the smaller solid lies in the middle of a much larger one.
pub(crate) fn is_promised(names: [&str; 2], is_swallowed: bool) -> bool {
    !(is_swallowed && names.iter().any(|name| name.contains("tapered")))
}

/// Returns the guaranteed bound of the error of points for two kinds, in units. If the separation
/// is nearly the same along a circle of normals, the search ends with an iteration along that
/// circle, accurate to 1e-8 of the scene in `f64`. Cylinders and cones with sizes of zero have a
/// larger error.
pub(crate) fn points_promised<N: Real, const D: usize>(
    names: [&str; 2],
    is_degenerate: bool,
) -> f64 {
    let is_double = N::EPSILON.as_f64() < 1e-10;
    let of_revolution = names.iter().any(|name| is_of_revolution(name));
    let is_round = of_revolution || names.iter().any(|name| name.contains("tapered"));
    match (is_double, is_round) {
        (true, true) if is_degenerate => 5e8,
        (true, true) => 5e7,
        (false, _) if of_revolution && is_degenerate => 2048.0,
        _ => 64.0,
    }
}

/// Laws that some scenes are known to violate, each with the dimension in which they do.
const KNOWN: [(&str, usize); 1] = [
    // The product of four lengths that decides whether axes cross underflows in `f32` at 2⁻²⁰ of
    // the size. A point at an end of an axis then gets the feature of the whole axis.
    ("5 scaled, capsule and capsule", 3),
];

/// Returns `true` if some scenes are known to violate the law in dimension `D`.
pub(crate) fn is_known<const D: usize>(law: &str) -> bool {
    KNOWN.contains(&(law, D))
}
