//! Ray casts against a cylinder: the span of time during which the ray's line is inside.

use super::ball::roots;
use super::clip::{HalfSpace, clipped};
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Mapped, Real, Vector, unit_or};
use crate::shape::{Cylinder, FeatureId};

/// Returns the span in the infinite cylinder, clipped at the planes of the two caps; `None` if the
/// line misses the cylinder.
pub(super) fn span<N: Real>(cylinder: &Cylinder<N>, ray: &Ray<N, 3>) -> Option<Span<N, 3>> {
    let side = round_side(cylinder.radius(), ray)?;
    let half_height = cylinder.half_height();
    let caps = [(N::ONE, FeatureId::Face(0)), (-N::ONE, FeatureId::Face(1))];
    clipped(side, caps.mapped(|(sign, feature)| cap(half_height, sign, feature, ray)))
}

/// Returns the span of the line in the infinite cylinder around the y axis; `None` if the line
/// misses it.
fn round_side<N: Real>(radius: N, ray: &Ray<N, 3>) -> Option<Span<N, 3>> {
    let flat = |v: &Vector<N, 3>| Vector::<N, 2>::new(v.x, v.z);
    let (origin, dir) = (flat(&ray.origin.coords), flat(&ray.dir));
    let found = roots(&origin, &dir, radius)?;
    let [entry, exit] = found.points();
    // For a radius of zero the normal faces the line.
    let against = unit_or(&-dir, Vector::<N, 2>::zeros());
    let [enter, leave] = [(found.enter, entry, against), (found.leave, exit, -against)].mapped(
        |(t, point, fallback)| {
            let normal = unit_or(&point, fallback);
            let normal = Vector::<N, 3>::new(normal.x, N::ZERO, normal.y);
            Crossing::new(t, normal, FeatureId::Face(2))
        },
    );
    Some(Span { enter, leave, thin: found.runs_at(radius) })
}

/// Returns the half-space under a flat cap: `sign · y ≤ half_height`.
pub(super) fn cap<N: Real>(
    half_height: N,
    sign: N,
    feature: FeatureId,
    ray: &Ray<N, 3>,
) -> HalfSpace<N, 3> {
    HalfSpace {
        normal: Vector::<N, 3>::new(N::ZERO, sign, N::ZERO),
        below: half_height - sign * ray.origin.y,
        rise: sign * ray.dir.y,
        feature,
    }
}
