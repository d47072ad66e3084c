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
    /// How much the flat face that faces the other solid leans: the length of the difference of its
    /// normal and the contact's. `None` without such a face.
    pub(super) lean: Option<N>,
    /// An edge of what faces the other solid that is perpendicular to the contact's normal.
    pub(super) level_edge: Option<Vector<N, D>>,
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
        let (geometry, rounding) = match kind {
            Kind::Plane(plane) => {
                let normal = plane.normal().into_inner();
                let lean = Some((normal - outward).norm());
                let geometry = NeighborhoodGeometry::Plane(normal);
                return Self {
                    core: *surface,
                    geometry,
                    rounding: N::ZERO,
                    lean,
                    level_edge: None,
                };
            }
            Kind::Ball(ball) => (NeighborhoodGeometry::Point, ball.radius()),
            Kind::Cylinder(cylinder, _) if is_lying(cylinder, outward) => {
                (on_axis(id), cylinder.radius())
            }
            other => return Self::of_core(other, id, outward, surface),
        };
        let core = surface - outward * rounding;
        Self { core, geometry, rounding, lean: None, level_edge: None }
    }

    /// The general case: the feature that faces the other solid is asked for once more and the named
    /// part is looked up in it. A curved face counts as its tangent plane.
    fn of_core(
        kind: Kind<'_, N, D>,
        id: FeatureId,
        outward: &Vector<N, D>,
        surface: &Point<N, D>,
    ) -> Self {
        let map: &dyn SupportMap<N, D> =
            Geometry(kind).as_support_map().expect("only half-spaces are no support maps");
        let mut feature = Feature::default();
        map.core_feature(outward, &mut feature);
        let geometry = match id {
            FeatureId::Vertex(_) => NeighborhoodGeometry::Point,
            FeatureId::Edge(_) => line(&feature, id),
            FeatureId::Face(_) => NeighborhoodGeometry::Plane(feature.normal.unwrap_or(*outward)),
        };
        let rounding = map.rounding();
        Self {
            core: surface - outward * rounding,
            geometry,
            rounding,
            lean: feature.normal.map(|normal| (normal - outward).norm()),
            level_edge: level_edge(&feature, outward),
        }
    }
}

/// The side of a feature that is most nearly perpendicular to a direction, if it is up to rounding.
fn level_edge<N: Real, const D: usize>(
    feature: &Feature<N, D>,
    outward: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let sides = (0..feature.side_ids.len()).filter_map(|index| along(feature, index));
    let lean = |side: &Vector<N, D>| side.dot(outward).abs();
    let level = sides.reduce(|best, side| if lean(&side) < lean(&best) { side } else { best });
    level.filter(|side| lean(side) <= super::least_angle())
}

/// The direction of a side of a feature, along its outline; `None` for a side of no length.
fn along<N: Real, const D: usize>(feature: &Feature<N, D>, index: usize) -> Option<Vector<N, D>> {
    let next = if index + 1 < feature.vertices.len() { index + 1 } else { 0 };
    unit(&(feature.vertices[next] - feature.vertices[index])).map(|(along, _)| along)
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

/// The line of a side of a feature; a point for a rim, which is no straight edge.
fn line<N: Real, const D: usize>(
    feature: &Feature<N, D>,
    id: FeatureId,
) -> NeighborhoodGeometry<N, D> {
    let mut named = feature.side_ids.iter().enumerate().filter(|&(_, &side)| side == id);
    // A cap that is round is given as a polygon all of whose sides bear the name of the rim.
    let (Some((index, _)), None) = (named.next(), named.next()) else {
        return NeighborhoodGeometry::Point;
    };
    along(feature, index).map_or(NeighborhoodGeometry::Point, NeighborhoodGeometry::Line)
}
