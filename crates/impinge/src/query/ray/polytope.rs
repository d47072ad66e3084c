//! Ray casts against a convex polygon or hull: the span of time during which the ray's line is
//! inside.

use super::clip::{HalfSpace, clipped};
use super::span::Span;
use crate::bounding_volume::Ray;
use crate::math::{Real, Vector, max, max_component};
use crate::shape::{FeatureId, Polytope, PolytopeFace, SupportMap};

/// Returns the span of the line, clipped by the planes of all faces; `None` if nothing is left.
pub(super) fn span<N: Real, const D: usize>(
    solid: &Polytope<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let scale = max(solid.reach(), max_component(&ray.origin.coords));
    let faces = (0_u32..).zip(solid.faces());
    clipped(Span::everything(), faces.map(|(number, face)| below(face, number, ray, scale)))
}

/// Returns a face as a half-space.
///
/// A line that is parallel to a face within rounding is treated as parallel, and as inside if it
/// also is within rounding of the face's plane. Otherwise the time would be the quotient of two
/// rounding errors. `scale` is the largest length that enters the height.
fn below<N: Real, const D: usize>(
    face: &PolytopeFace<N, D>,
    number: u32,
    ray: &Ray<N, D>,
    scale: N,
) -> HalfSpace<N, D> {
    let (below, rise) =
        (face.offset - face.normal.dot(&ray.origin.coords), face.normal.dot(&ray.dir));
    let feature = FeatureId::Face(number);
    let rounding = N::lit(4.0) * N::EPSILON;
    let parallel = rise.abs() <= rounding * max_component(&ray.dir);
    if !parallel {
        return HalfSpace { normal: face.normal, below, rise, feature };
    }
    let grazing = below.abs() <= rounding * scale;
    let below = if grazing { N::ZERO } else { below };
    HalfSpace { normal: Vector::<N, D>::zeros(), below, rise: N::ZERO, feature }
}
