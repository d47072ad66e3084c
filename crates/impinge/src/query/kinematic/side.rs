//! One solid's part in the kinematics of a manifold.

use super::NeighborhoodGeometry;
use crate::math::{Point, Real, Vector, unit};
use crate::shape::{Cylinder, FacingPart, Feature, FeatureId, Geometry, Kind, SupportMap};

/// A cylinder whose axis has at most this sine with the contact plane touches along its side: its
/// axis is the core.
const LYING_SINE: f64 = 0.05;

/// One solid's part in all contacts of a manifold, in its local frame.
pub(super) struct KinematicSide<N: Real, const D: usize> {
    pub(super) rounding: N,
    /// The manifold's normal away from the solid.
    outward: Vector<N, D>,
    facing: SideFacing<N, D>,
}

/// The supporting feature of a solid towards the other one.
enum SideFacing<N: Real, const D: usize> {
    /// A half-space, with its outward normal.
    Boundary(Vector<N, D>),
    /// A ball.
    Center,
    /// A cylinder that lies on its side.
    Axis,
    /// A part of a box.
    Part(FacingPart<N, D>),
    /// The generic case: the supporting feature, in which the feature of a contact is looked up by
    /// its id. A curved face is represented by its tangent plane.
    Feature(Feature<N, D>),
}

impl<N: Real, const D: usize> KinematicSide<N, D> {
    /// The side of a solid; `outward` is the manifold's normal away from it.
    pub(super) fn new(kind: Kind<'_, N, D>, outward: Vector<N, D>) -> Self {
        let (facing, rounding) = match kind {
            Kind::Plane(plane) => (SideFacing::Boundary(plane.normal().into_inner()), N::ZERO),
            Kind::Ball(ball) => (SideFacing::Center, ball.radius()),
            Kind::Cylinder(cylinder, _) if is_lying(cylinder, &outward) => {
                (SideFacing::Axis, cylinder.radius())
            }
            Kind::Rounded(solid) => {
                let inner = Self::new(solid.inner().0, outward);
                return Self { rounding: inner.rounding + solid.radius(), ..inner };
            }
            Kind::Cuboid(cuboid) => match cuboid.facing_part(&outward) {
                Some(part) => (SideFacing::Part(part), N::ZERO),
                None => return Self::of_core(kind, outward),
            },
            other => return Self::of_core(other, outward),
        };
        Self { rounding, outward, facing }
    }

    fn of_core(kind: Kind<'_, N, D>, outward: Vector<N, D>) -> Self {
        let map: &dyn SupportMap<N, D> =
            Geometry(kind).as_support_map().expect("neither a half-space nor a composite");
        let mut feature = Feature::default();
        map.core_feature(&outward, &mut feature);
        Self { rounding: map.rounding(), outward, facing: SideFacing::Feature(feature) }
    }

    /// The point of the core below a point of the surface.
    pub(super) fn core(&self, surface: &Point<N, D>) -> Point<N, D> {
        surface - self.outward * self.rounding
    }

    /// The local geometry of the core at the feature `id`.
    pub(super) fn geometry(&self, id: FeatureId) -> NeighborhoodGeometry<N, D> {
        match (&self.facing, id) {
            (SideFacing::Boundary(normal), _) => NeighborhoodGeometry::Plane(*normal),
            (SideFacing::Axis, FeatureId::Face(_)) => NeighborhoodGeometry::Line(upward()),
            (SideFacing::Part(_), FeatureId::Edge(index)) => {
                NeighborhoodGeometry::Line(FacingPart::edge_direction(index))
            }
            (SideFacing::Part(part), FeatureId::Face(_)) => {
                NeighborhoodGeometry::Plane(part.normal.unwrap_or(self.outward))
            }
            (SideFacing::Feature(feature), FeatureId::Edge(_)) => line(feature, id),
            (SideFacing::Feature(feature), FeatureId::Face(_)) => {
                NeighborhoodGeometry::Plane(feature.normal.unwrap_or(self.outward))
            }
            // The ends of a lying cylinder are on the rims.
            (
                SideFacing::Center
                | SideFacing::Axis
                | SideFacing::Part(_)
                | SideFacing::Feature(_),
                _,
            ) => NeighborhoodGeometry::Point,
        }
    }

    /// The tilt of the supporting face: the length of the difference of its normal and the
    /// contact's; 2, the maximum, without such a face.
    pub(super) fn lean(&self) -> N {
        let normal = match &self.facing {
            SideFacing::Boundary(normal) => Some(*normal),
            SideFacing::Part(part) => part.normal,
            SideFacing::Feature(feature) => feature.normal,
            SideFacing::Center | SideFacing::Axis => None,
        };
        normal.map_or(N::TWO, |normal| (normal - self.outward).norm())
    }

    /// An edge of the supporting feature that is perpendicular to the contact's normal.
    pub(super) fn level_edge(&self) -> Option<Vector<N, D>> {
        match &self.facing {
            SideFacing::Part(part) => {
                part.most_level_side(&self.outward).filter(|side| is_level(side, &self.outward))
            }
            SideFacing::Feature(feature) => level_edge(feature, &self.outward),
            _ => None,
        }
    }
}

/// The side of a feature that is most nearly perpendicular to a direction; `None` if it is not so
/// up to rounding.
fn level_edge<N: Real, const D: usize>(
    feature: &Feature<N, D>,
    outward: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let sides = (0..feature.side_ids.len()).filter_map(|index| along(feature, index));
    let lean = |side: &Vector<N, D>| side.dot(outward).abs();
    let level = sides.reduce(|best, side| if lean(&side) < lean(&best) { side } else { best });
    level.filter(|side| is_level(side, outward))
}

/// Whether two unit vectors are perpendicular up to rounding.
fn is_level<N: Real, const D: usize>(side: &Vector<N, D>, outward: &Vector<N, D>) -> bool {
    side.dot(outward).abs() <= super::least_angle()
}

/// The direction of a side of a feature, along its outline; `None` for a side of no length.
fn along<N: Real, const D: usize>(feature: &Feature<N, D>, index: usize) -> Option<Vector<N, D>> {
    let next = if index + 1 < feature.vertices.len() { index + 1 } else { 0 };
    unit(&(feature.vertices[next] - feature.vertices[index])).map(|(along, _)| along)
}

/// Whether a cylinder with a radius is touched from the side.
fn is_lying<N: Real, const D: usize>(cylinder: &Cylinder<N>, outward: &Vector<N, D>) -> bool {
    outward[1].abs() <= N::lit(LYING_SINE) && cylinder.radius() > N::ZERO
}

/// The axis of a cylinder.
fn upward<N: Real, const D: usize>() -> Vector<N, D> {
    let mut axis = Vector::<N, D>::zeros();
    axis[1] = N::ONE;
    axis
}

/// The line of a side of a feature; a point for a rim, which is no straight edge.
fn line<N: Real, const D: usize>(
    feature: &Feature<N, D>,
    id: FeatureId,
) -> NeighborhoodGeometry<N, D> {
    let mut named = feature.side_ids.iter().enumerate().filter(|&(_, &side)| side == id);
    // A round cap is represented by a polygon whose sides all have the id of the rim.
    let (Some((index, _)), None) = (named.next(), named.next()) else {
        return NeighborhoodGeometry::Point;
    };
    along(feature, index).map_or(NeighborhoodGeometry::Point, NeighborhoodGeometry::Line)
}
