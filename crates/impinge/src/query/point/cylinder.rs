//! The nearest point of the surface of a cylinder, computed in the half-plane through the y axis
//! and the query point.

use super::SurfacePoint;
use crate::math::{Point, Real, Vector, max, min, unit};
use crate::shape::{Cylinder, FeatureId};

/// A 3D point as its distance from the y axis, its height, and the direction away from the axis
/// (the x axis for a point on the y axis). It reduces queries of solids of revolution to 2D.
pub(super) struct Meridian<N: Real> {
    pub(super) flat: Point<N, 2>,
    away: Vector<N, 2>,
}

impl<N: Real> Meridian<N> {
    pub(super) fn of(point: &Point<N, 3>) -> Self {
        let radial = Vector::<N, 2>::new(point.x, point.z);
        let (away, distance) =
            unit(&radial).unwrap_or((Vector::<N, 2>::new(N::ONE, N::ZERO), N::ZERO));
        Self { flat: Point::<N, 2>::new(distance, point.y), away }
    }

    /// Converts a point of the half-plane to 3D.
    pub(super) fn lift(&self, flat: &Point<N, 2>) -> Point<N, 3> {
        Point::<N, 3>::new(self.away.x * flat.x, flat.y, self.away.y * flat.x)
    }
}

pub(super) fn surface_point<N: Real>(
    cylinder: &Cylinder<N>,
    point: &Point<N, 3>,
) -> SurfacePoint<N, 3> {
    let (radius, half_height) = (cylinder.radius(), cylinder.half_height());
    let meridian = Meridian::of(point);
    let (away, y) = (meridian.flat.x, meridian.flat.y);
    let cap = if y < N::ZERO { 1 } else { 0 };
    let cap_y = if y < N::ZERO { -half_height } else { half_height };
    let (beyond_side, beyond_cap) = (away > radius, y.abs() > half_height);
    let is_inside = !beyond_side && !beyond_cap;
    if is_inside {
        // The caps have the lower indices and win a tie.
        let on_side = radius - away < half_height - y.abs();
        let (feature, x, y) = if on_side { (2, radius, y) } else { (cap, away, cap_y) };
        let nearest = meridian.lift(&Point::<N, 2>::new(x, y));
        return SurfacePoint { point: nearest, feature: FeatureId::Face(feature), is_inside };
    }
    let nearest = Point::<N, 2>::new(min(away, radius), max(min(y, half_height), -half_height));
    let feature = match (beyond_side, beyond_cap) {
        (true, true) => FeatureId::Edge(cap),
        (true, false) => FeatureId::Face(2),
        _ => FeatureId::Face(cap),
    };
    SurfacePoint::on(meridian.lift(&nearest), feature)
}
