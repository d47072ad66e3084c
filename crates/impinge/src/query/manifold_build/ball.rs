//! The one point of a ball and another solid: the nearest pair of points, without any face built.

use super::facet::{Facet, Which};
use super::frame::{Candidate, Frame, rounding};
use super::{Pair, RawManifold, at_witness, face, names, witness};
use crate::convex::Separation;
use crate::math::{Point, Real, Space};
use crate::shape::{FeatureId, Kind, Segment};

/// The only part of a ball, an ellipsoid or a half-space.
const WHOLE: FeatureId = FeatureId::Face(0);

/// Builds the manifold of a ball, the first solid, from its separation; `None` is one beyond the
/// prediction.
pub(super) fn build<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    found: Option<Separation<N, D>>,
    out: &mut RawManifold<N, D>,
) {
    match found.filter(|found| found.distance.is_finite_number()) {
        Some(found) => {
            let touched = known_part(pair, &found).unwrap_or_else(|| {
                let frame = witness::frame(pair, &found, (N::tables().tangents)(&found.normal));
                shown_at_witness(pair, &frame)
            });
            out.normal = found.normal;
            names::settle_alone(&Candidate::alone(&found, [WHOLE, touched]), out);
        }
        None => out.points.clear(),
    }
}

/// The part of the second solid that a ball, the first, touches, where its kind says so at once: as
/// [`shown_at_witness`] finds it, but for what is within rounding of another part.
#[inline]
pub(super) fn known_part<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    found: &Separation<N, D>,
) -> Option<FeatureId> {
    let point = || pair.pose12.inverse_point(&found.point2);
    let outward = || -pair.pose12.inverse_vector(&found.normal);
    match pair.second {
        Kind::Ball(_) | Kind::Ellipsoid(_) | Kind::Plane(_) => Some(WHOLE),
        Kind::Segment(segment) => Some(part_of_segment(pair, segment)),
        Kind::Capsule(capsule) => Some(part_of_segment(pair, capsule.segment())),
        Kind::Cuboid(cuboid) => cuboid.part_at(&point(), rounding(pair)),
        Kind::Triangle(triangle) => triangle.part_at(&point(), &outward(), rounding(pair)),
        Kind::Polytope(solid) => Some(solid.part_at(&point(), &outward(), rounding(pair))),
        Kind::Cylinder(cylinder, _) => cylinder.part_at(&point(), rounding(pair)),
        Kind::Cone(cone, _) => cone.part_at(&point(), rounding(pair)),
        _ => None,
    }
}

/// The part of the second solid that the witness lies on, of those that it shows along the normal.
pub(super) fn shown_at_witness<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    frame: &Frame<N, D>,
) -> FeatureId {
    let mut second = Facet::boundary(Which::Second);
    face(&mut second, pair.second, Some(&pair.pose12), frame);
    at_witness(&second, frame)
}

/// The end of a segment that is nearest to the centre of the ball, or the segment itself where the
/// nearest point is neither; one without length has no ends.
fn part_of_segment<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    segment: &Segment<N, D>,
) -> FeatureId {
    let center = pair.pose12.inverse_point(&Point::origin());
    let along = segment.b() - segment.a();
    let (length, noise) = (along.norm(), N::TWO * rounding(pair));
    let is_near = |reach: N| reach <= noise * length;
    if length <= noise {
        FeatureId::Edge(0)
    } else if is_near((center - segment.a()).dot(&along)) {
        FeatureId::Vertex(0)
    } else if is_near((segment.b() - center).dot(&along)) {
        FeatureId::Vertex(1)
    } else {
        FeatureId::Edge(0)
    }
}
