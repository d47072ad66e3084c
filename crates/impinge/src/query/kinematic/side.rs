//! The data of one solid in the kinematics of a manifold.

use super::NeighborhoodGeometry;
use crate::math::{Point, Real, Vector, unit};
use crate::shape::{Cylinder, Feature, FeatureId, Geometry, Kind, SupportMap, SupportPart};

/// The largest sine of the angle between a cylinder's axis and the contact plane at which the
/// cylinder touches along its round side; the axis then represents the core.
const LYING_SINE: f64 = 0.05;

/// The data of one solid for all contacts of a manifold, in the solid's local frame.
pub(super) struct KinematicSide<N: Real, const D: usize> {
    pub(super) rounding: N,
    /// The manifold's normal, pointing away from the solid.
    outward: Vector<N, D>,
    support: SideSupport<N, D>,
}

/// The supporting feature of a solid towards the other solid of the pair.
enum SideSupport<N: Real, const D: usize> {
    /// The plane of a half-space, by its outward normal.
    Boundary(Vector<N, D>),
    /// The centre of a ball.
    Center,
    /// The axis of a cylinder that lies on its side.
    Axis,
    /// A feature of a box.
    Part(SupportPart<N, D>),
    /// The supporting feature of any other solid, in which the feature of a contact is looked up by
    /// its id. A curved face is represented by its tangent plane.
    Feature(Feature<N, D>),
}

impl<N: Real, const D: usize> KinematicSide<N, D> {
    /// Returns the data of a solid; `outward` is the manifold's normal away from the solid.
    pub(super) fn new(kind: Kind<'_, N, D>, outward: Vector<N, D>) -> Self {
        let (support, rounding) = match kind {
            Kind::Plane(plane) => (SideSupport::Boundary(plane.normal().into_inner()), N::ZERO),
            Kind::Ball(ball) => (SideSupport::Center, ball.radius()),
            Kind::Cylinder(cylinder, _) if is_lying(cylinder, &outward) => {
                (SideSupport::Axis, cylinder.radius())
            }
            Kind::Rounded(solid) => {
                let inner = Self::new(solid.inner().0, outward);
                return Self { rounding: inner.rounding + solid.radius(), ..inner };
            }
            Kind::Cuboid(cuboid) => match cuboid.part_toward(&outward) {
                Some(part) => (SideSupport::Part(part), N::ZERO),
                None => return Self::of_core(kind, outward),
            },
            other => return Self::of_core(other, outward),
        };
        Self { rounding, outward, support }
    }

    fn of_core(kind: Kind<'_, N, D>, outward: Vector<N, D>) -> Self {
        let map: &dyn SupportMap<N, D> =
            Geometry(kind).as_support_map().expect("neither a half-space nor a composite");
        let mut feature = Feature::default();
        map.core_feature(&outward, &mut feature);
        Self { rounding: map.rounding(), outward, support: SideSupport::Feature(feature) }
    }

    /// Returns the core point below a point of the surface.
    pub(super) fn core(&self, surface: &Point<N, D>) -> Point<N, D> {
        surface - self.outward * self.rounding
    }

    /// Returns the local geometry of the core at the feature `id`. A face without a normal of its
    /// own has the manifold's normal.
    pub(super) fn geometry(&self, id: FeatureId) -> NeighborhoodGeometry<N, D> {
        match (&self.support, id) {
            (SideSupport::Boundary(normal), _) => NeighborhoodGeometry::Plane(*normal),
            (SideSupport::Axis, FeatureId::Face(_)) => NeighborhoodGeometry::Line(upward()),
            (SideSupport::Part(_), FeatureId::Edge(index)) => {
                NeighborhoodGeometry::Line(SupportPart::edge_direction(index))
            }
            (SideSupport::Part(part), FeatureId::Face(_)) => {
                NeighborhoodGeometry::Plane(part.normal.unwrap_or(self.outward))
            }
            (SideSupport::Feature(feature), FeatureId::Edge(_)) => line(feature, id),
            (SideSupport::Feature(feature), FeatureId::Face(_)) => {
                NeighborhoodGeometry::Plane(feature.normal.unwrap_or(self.outward))
            }
            // The contact points at the ends of a lying cylinder are on the rims.
            (
                SideSupport::Center
                | SideSupport::Axis
                | SideSupport::Part(_)
                | SideSupport::Feature(_),
                _,
            ) => NeighborhoodGeometry::Point,
        }
    }

    /// Returns the tilt of the supporting face: the length of the difference of its normal and the
    /// contact's normal. Without such a face returns 2, the maximum.
    pub(super) fn tilt(&self) -> N {
        let normal = match &self.support {
            SideSupport::Boundary(normal) => Some(*normal),
            SideSupport::Part(part) => part.normal,
            SideSupport::Feature(feature) => feature.normal,
            SideSupport::Center | SideSupport::Axis => None,
        };
        normal.map_or(N::TWO, |normal| (normal - self.outward).norm())
    }

    /// Returns the direction of an edge of the supporting feature that is perpendicular to the
    /// contact's normal; `None` if there is none.
    pub(super) fn perpendicular_edge(&self) -> Option<Vector<N, D>> {
        match &self.support {
            SideSupport::Part(part) => part
                .flattest_side(&self.outward)
                .filter(|side| is_perpendicular(side, &self.outward)),
            SideSupport::Feature(feature) => perpendicular_edge(feature, &self.outward),
            _ => None,
        }
    }
}

/// Returns the side of a feature that is most nearly perpendicular to `outward`; `None` if even
/// this side is not perpendicular up to rounding.
fn perpendicular_edge<N: Real, const D: usize>(
    feature: &Feature<N, D>,
    outward: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let sides = (0..feature.side_ids.len()).filter_map(|index| along(feature, index));
    let component = |side: &Vector<N, D>| side.dot(outward).abs();
    let flattest =
        sides.reduce(|best, side| if component(&side) < component(&best) { side } else { best });
    flattest.filter(|side| is_perpendicular(side, outward))
}

/// Returns whether two unit vectors are perpendicular up to rounding.
fn is_perpendicular<N: Real, const D: usize>(side: &Vector<N, D>, outward: &Vector<N, D>) -> bool {
    side.dot(outward).abs() <= super::least_angle()
}

/// Returns the unit direction of a side of a feature, along its outline; `None` for a side without
/// length.
fn along<N: Real, const D: usize>(feature: &Feature<N, D>, index: usize) -> Option<Vector<N, D>> {
    let next = if index + 1 < feature.vertices.len() { index + 1 } else { 0 };
    unit(&(feature.vertices[next] - feature.vertices[index])).map(|(along, _)| along)
}

/// Returns whether the contact is on the round side of the cylinder and the radius is positive.
fn is_lying<N: Real, const D: usize>(cylinder: &Cylinder<N>, outward: &Vector<N, D>) -> bool {
    outward[1].abs() <= N::lit(LYING_SINE) && cylinder.radius() > N::ZERO
}

/// Returns the axis of a cylinder.
fn upward<N: Real, const D: usize>() -> Vector<N, D> {
    let mut axis = Vector::<N, D>::zeros();
    axis[1] = N::ONE;
    axis
}

/// Returns the line along the side with the id `id` of a feature. Returns a point for a rim, which
/// is not a straight edge, for an unknown id, and for a side without length.
fn line<N: Real, const D: usize>(
    feature: &Feature<N, D>,
    id: FeatureId,
) -> NeighborhoodGeometry<N, D> {
    let mut matching = feature.side_ids.iter().enumerate().filter(|&(_, &side)| side == id);
    // A round cap is represented by a polygon whose sides all have the id of the rim, so the id is
    // not unique.
    let (Some((index, _)), None) = (matching.next(), matching.next()) else {
        return NeighborhoodGeometry::Point;
    };
    along(feature, index).map_or(NeighborhoodGeometry::Point, NeighborhoodGeometry::Line)
}
