//! Solids that only the tests have; queries know them only by their support points.

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Real, Vector};
use impinge::shape::{Geometry, Shape, SupportMap};

/// The hull of points, inflated by a radius.
#[derive(Debug)]
pub struct RoundHull<N: Real, const D: usize> {
    pub points: Vec<Point<N, D>>,
    pub rounding: N,
}

impl<N: Real, const D: usize> SupportMap<N, D> for RoundHull<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let mut best = self.points[0];
        for point in &self.points {
            if point.coords.dot(direction) > best.coords.dot(direction) {
                best = *point;
            }
        }
        best
    }

    fn rounding(&self) -> N {
        self.rounding
    }

    fn center(&self) -> Point<N, D> {
        impinge::math::centroid(&self.points)
    }
}

impl<N: Real, const D: usize> RoundHull<N, D> {
    /// Returns a box inflated by a radius.
    pub fn cuboid(half_extents: &Vector<N, D>, rounding: N) -> Self {
        let corner = |signs: usize| {
            Point::from(Vector::<N, D>::from_fn(|axis, _| {
                if signs >> axis & 1 == 1 { half_extents[axis] } else { -half_extents[axis] }
            }))
        };
        Self { points: (0..1 << D).map(corner).collect(), rounding }
    }
}

/// The points whose coordinates, divided by the radii, lie in the unit ball.
#[derive(Debug)]
pub struct Ellipsoid<N: Real, const D: usize> {
    pub radii: Vector<N, D>,
}

impl<N: Real, const D: usize> SupportMap<N, D> for Ellipsoid<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let stretched = direction.component_mul(&self.radii);
        let length = stretched.norm();
        let along = if length > N::ZERO { stretched / length } else { stretched };
        Point::from(along.component_mul(&self.radii))
    }
}

/// Returns the box of a support map, from its support points along the axes.
fn box_of<N: Real, const D: usize>(map: &dyn SupportMap<N, D>) -> Aabb<N, D> {
    let (mut mins, mut maxs) = (Point::origin(), Point::origin());
    for axis in 0..D {
        let mut direction = Vector::<N, D>::zeros();
        direction[axis] = N::ONE;
        maxs[axis] = map.support_point(&direction)[axis];
        mins[axis] = map.support_point(&-direction)[axis];
    }
    Aabb::new(mins, maxs)
}

impl<N: Real, const D: usize> Shape<N, D> for RoundHull<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        box_of(self)
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Ellipsoid<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        box_of(self)
    }
}
