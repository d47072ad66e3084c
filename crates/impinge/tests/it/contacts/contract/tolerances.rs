//! The tolerances of `guide/guarantees.md`, in rounding errors of the size of the scene.

use impinge::math::Real;

/// Returns `true` for solids for which the reference has to search for the normal.
pub(crate) fn is_curved(name: &str) -> bool {
    ["cylinder", "cone", "ellipsoid", "tapered"].iter().any(|curved| name.contains(curved))
}

/// Returns `true` for solids of revolution with flat ends.
pub(crate) fn is_of_revolution(name: &str) -> bool {
    name.contains("cylinder") || name.contains("cone")
}

/// Returns the greatest error of the depth of two kinds, in units.
pub(crate) fn promised<N: Real, const D: usize>(names: [&str; 2]) -> f64 {
    let is_double = N::EPSILON.as_f64() < 1e-10;
    let of_revolution = names.iter().any(|name| is_of_revolution(name));
    match (is_double, of_revolution) {
        (true, true) => 2048.0,
        (true, false) if D == 3 => 128.0,
        _ => 64.0,
    }
}

/// Returns `true` if the least depth is guaranteed. It is not for a solid much smaller than a ball
/// of a tapered capsule, inside the middle of that ball.
pub(crate) fn is_promised(names: [&str; 2], is_swallowed: bool) -> bool {
    !(is_swallowed && names.iter().any(|name| name.contains("tapered")))
}

/// Greatest error of the points of two kinds, in units. Where all normals of a ring are nearly equally good, the search
/// ends with an iteration along the ring, in `f64` at 1e-8 of the scene; cylinders and cones with sizes of zero have a
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

/// Laws that some scenes are known to violate, each with the dimension.
const KNOWN: [(&str, usize); 1] = [
    // The product of four lengths that decides whether axes cross underflows in `f32` at 2⁻²⁰ of the size, so a point
    // at an end of an axis has the feature of the axis.
    ("5 scaled, capsule and capsule", 3),
];

/// Returns `true` if the law is known to be violated.
pub(crate) fn is_known<const D: usize>(law: &str) -> bool {
    KNOWN.contains(&(law, D))
}
