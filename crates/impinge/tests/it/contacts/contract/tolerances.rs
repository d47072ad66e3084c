//! The numbers of `guide/guarantees.md`, in rounding errors of the scene.

use impinge::math::Real;

/// Solids of which the reference searches the normal.
pub(crate) fn is_curved(name: &str) -> bool {
    ["cylinder", "cone", "ellipsoid", "tapered"].iter().any(|curved| name.contains(curved))
}

/// Solids with flat round faces.
pub(crate) fn is_of_revolution(name: &str) -> bool {
    name.contains("cylinder") || name.contains("cone")
}

/// How many units the depth of two kinds may be off.
pub(crate) fn promised<N: Real, const D: usize>(names: [&str; 2]) -> f64 {
    let is_double = N::EPSILON.as_f64() < 1e-10;
    let of_revolution = names.iter().any(|name| is_of_revolution(name));
    match (is_double, of_revolution) {
        (true, true) => 2048.0,
        (true, false) if D == 3 => 128.0,
        _ => 64.0,
    }
}

/// Not promised is the least depth of what is much smaller than a ball of a tapered capsule, about its middle.
pub(crate) fn is_promised(names: [&str; 2], is_swallowed: bool) -> bool {
    !(is_swallowed && names.iter().any(|name| name.contains("tapered")))
}

/// How many units the points of two kinds may be off. Where a ring of normals is about as good, an iteration
/// along it ends the work, in `f64` at 1e-8 of the scene; with sizes of zero in cylinders and cones at more.
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

/// Laws that do not hold of all scenes, each of a dimension.
const KNOWN: [(&str, usize); 1] = [
    // The product of four lengths that tells whether axes cross underflows in `f32` at a millionth of the size:
    // a point at an end of an axis is named after the axis.
    ("5 scaled, capsule and capsule", 3),
];

/// The law is known not to hold.
pub(crate) fn is_known<const D: usize>(law: &str) -> bool {
    KNOWN.contains(&(law, D))
}
