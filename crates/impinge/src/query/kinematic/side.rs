//! One solid's share of a contact's kinematic.

use super::NeighborhoodGeometry;
use crate::math::{Point, Real, Vector, unit};
use crate::shape::{Cylinder, Feature, FeatureId, Geometry, Kind, SupportMap};

/// A cylinder that leans by no more than this sine touches along its side: its axis is the core.
const LYING_SINE: f64 = 0.05;

/// The core near a contact, in the local frame.
pub(super) struct Side<N: Real, const D: usize> {
    pub(super) core: Point<N, D>,
    pub(super) geometry: NeighborhoodGeometry<N, D>,
    pub(super) rounding: N,
    /// The cosine between the contact's normal and that of the flat face that faces the other solid:
    /// the solid with the larger one defines the normal. Zero for curved faces, −1 for none.
    pub(super) alignment: N,
}

impl<N: Real, const D: usize> Side<N, D> {
    /// The side of a solid whose surface is touched at `surface`, on the feature `id`; `outward` is
    /// the contact's normal away from the solid.
    pub(super) fn new(
        kind: Kind<'_, N, D>,
        id: FeatureId,
        outward: &Vector<N, D>,
        surface: &Point<N, D>,
    ) -> Self {
        let (geometry, rounding, alignment) = match kind {
            Kind::Plane(plane) => {
                let normal = plane.normal().into_inner();
                (NeighborhoodGeometry::Plane(normal), N::ZERO, normal.dot(outward))
            }
            Kind::Ball(ball) => (NeighborhoodGeometry::Point, ball.radius(), -N::ONE),
            Kind::Cylinder(cylinder, _) if is_lying(cylinder, outward) => {
                (on_axis(id), cylinder.radius(), -N::ONE)
            }
            other => of_core(other, id, outward),
        };
        Self { core: surface - outward * rounding, geometry, rounding, alignment }
    }
}

/// A cylinder of some radius, touched from the side.
fn is_lying<N: Real, const D: usize>(cylinder: &Cylinder<N>, outward: &Vector<N, D>) -> bool {
    outward[1].abs() <= N::lit(LYING_SINE) && cylinder.radius() > N::ZERO
}

/// The side of a cylinder is a line, its ends on the rims are points.
fn on_axis<N: Real, const D: usize>(id: FeatureId) -> NeighborhoodGeometry<N, D> {
    let mut axis = Vector::<N, D>::zeros();
    axis[1] = N::ONE;
    match id {
        FeatureId::Face(_) => NeighborhoodGeometry::Line(axis),
        _ => NeighborhoodGeometry::Point,
    }
}

/// Geometry, rounding and alignment of a named part of a core.
fn of_core<N: Real, const D: usize>(
    kind: Kind<'_, N, D>,
    id: FeatureId,
    outward: &Vector<N, D>,
) -> (NeighborhoodGeometry<N, D>, N, N) {
    let map: &dyn SupportMap<N, D> =
        Geometry(kind).as_support_map().expect("only half-spaces are no support maps");
    let mut feature = Feature::default();
    map.core_feature(outward, &mut feature);
    let geometry = match id {
        FeatureId::Vertex(_) => NeighborhoodGeometry::Point,
        FeatureId::Edge(_) => line(&feature, id),
        FeatureId::Face(_) => NeighborhoodGeometry::Plane(feature.normal.unwrap_or(*outward)),
    };
    let is_curved = matches!(id, FeatureId::Face(_)) && feature.normal.is_none();
    let none = if is_curved { N::ZERO } else { -N::ONE };
    let alignment = feature.normal.map_or(none, |normal| normal.dot(outward));
    (geometry, map.rounding(), alignment)
}

/// The line of a side of a feature; a point for a rim, which is no straight edge.
fn line<N: Real, const D: usize>(
    feature: &Feature<N, D>,
    id: FeatureId,
) -> NeighborhoodGeometry<N, D> {
    let mut named = feature.side_ids.iter().enumerate().filter(|&(_, &side)| side == id);
    let (Some((index, _)), None) = (named.next(), named.next()) else {
        return NeighborhoodGeometry::Point;
    };
    let next = if index + 1 < feature.vertices.len() { index + 1 } else { 0 };
    let side = feature.vertices[next] - feature.vertices[index];
    unit(&side).map_or(NeighborhoodGeometry::Point, |(along, _)| NeighborhoodGeometry::Line(along))
}
