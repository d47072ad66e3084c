//! Ellipsoids as smaller solids with a radius around them.
//!
//! If a ball can roll inside a convex solid and touch every point of its surface, the solid
//! consists of the points within the ball's radius of a smaller convex solid (W. Blaschke, "Kreis
//! und Kugel", 1916). So an ellipsoid is a core with a radius, like a capsule. As long as the cores
//! of two solids do not overlap, the depth of the solids follows from the distance of the cores,
//! which a convex search finds.

use crate::math::{Matrix, Point, Real, Vector, max_component, min};
use crate::shape::{CurvedSupport, Ellipsoid, Geometry, Kind, SupportMap};

/// Radius by which an ellipsoid is eroded, as a share of the largest possible radius. It is below 1
/// so that the core of a sphere is not a point.
const SHARE: f64 = 15.0 / 16.0;

/// A solid as a core with a radius: the points within `radius` of the eroded solid. Support points
/// may only be requested along unit vectors, because they move inwards by `radius` times the
/// direction.
#[derive(Clone, Copy)]
pub(super) struct Eroded<'a, N: Real, const D: usize> {
    solid: &'a dyn SupportMap<N, D>,
    /// Erosion radius; zero for all kinds but ellipsoids.
    radius: N,
}

impl<'a, N: Real, const D: usize> Eroded<'a, N, D> {
    /// Makes the eroded form of a solid; `None` for half-spaces and composites.
    pub(super) fn of(kind: Kind<'a, N, D>) -> Option<Self> {
        let radius = if let Kind::Ellipsoid(ellipsoid) = kind {
            least_curvature_radius(ellipsoid) * N::lit(SHARE)
        } else {
            N::ZERO
        };
        Some(Self { solid: Geometry(kind).as_support_map()?, radius })
    }
}

/// Returns the radius of the largest ball that can roll inside an ellipsoid: the smallest radius of
/// curvature, `shortest² / longest`, at the ends of the longest axis.
fn least_curvature_radius<N: Real, const D: usize>(ellipsoid: &Ellipsoid<N, D>) -> N {
    let half_axes = ellipsoid.half_axes();
    let longest = max_component(half_axes);
    let shortest = half_axes.iter().fold(longest, |least, &half_axis| min(half_axis, least));
    if longest > N::ZERO { shortest * (shortest / longest) } else { N::ZERO }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Eroded<'_, N, D> {
    #[inline]
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        self.solid.core_support(direction) - direction * self.radius
    }

    fn rounding(&self) -> N {
        self.solid.rounding() + self.radius
    }

    fn curved_support(
        &self,
        point: &Point<N, D>,
        direction: &Vector<N, D>,
    ) -> Option<CurvedSupport<N, D>> {
        let off = direction * self.radius;
        let found = self.solid.curved_support(&(point + off), direction)?;
        let bend = Matrix::<N, D>::from_fn(|i, j| {
            let across = if i == j { N::ONE } else { N::ZERO } - direction[i] * direction[j];
            found.bend[(i, j)] - across * self.radius
        });
        Some(CurvedSupport { point: found.point - off, bend })
    }

    fn round_face(&self, direction: &Vector<N, D>) -> Option<Vector<N, D>> {
        self.solid.round_face(direction)
    }

    fn round_side(&self) -> Option<(Vector<N, D>, N)> {
        self.solid.round_side()
    }

    fn center(&self) -> Point<N, D> {
        self.solid.center()
    }

    fn reach(&self) -> N {
        self.solid.reach() - self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::Pair;
    use crate::collide::separation::general;
    use crate::collide::separation::hulls::tests::{Random, error};
    use crate::convex;
    use crate::shape::{Cone, Cuboid, Cylinder, Shape};

    /// Asserts that [`general::separation`], which erodes ellipsoids, and [`convex::separation`] of
    /// the unchanged solids agree within `accuracy`.
    fn compare<N: Real>(seed: u64, accuracy: f64) {
        let random = &mut Random(seed);
        for round in 0..600 {
            let sizes = [(); 2].map(|()| random.vector::<N>().abs().add_scalar(N::lit(0.125)));
            let first: Box<dyn Shape<N, 3>> = match round % 4 {
                0 => Box::new(Cuboid::new(sizes[0])),
                1 => Box::new(Cylinder::new(sizes[0].x, sizes[0].y)),
                2 => Box::new(Cone::new(sizes[0].x, sizes[0].y)),
                _ => Box::new(Ellipsoid::new(sizes[0])),
            };
            let second = Ellipsoid::new(sizes[1]);
            let mut pose12 = random.turn();
            pose12.translation = random.vector::<N>() * N::lit([2.0, 1.0, 0.25][round % 3]);
            let pair = Pair { first: first.geometry().0, second: second.geometry().0, pose12 };
            let found = general::separation(&pair, N::INFINITY).expect("no limit");
            let solid = Geometry(pair.first).as_support_map().expect("a convex solid");
            let truth = convex::separation(solid, &second, &pose12, N::INFINITY).expect("no limit");
            let error = error(&pair, &found, &truth);
            assert!(
                error <= accuracy,
                "round {round}: off by {error}: {first:?} {second:?} {pose12:?}: {found:?}, not {truth:?}"
            );
        }
    }

    #[test]
    fn what_is_taken_off_is_put_back() {
        compare::<f64>(1, 1e-11);
        compare::<f32>(2, 1e-5);
    }
}
