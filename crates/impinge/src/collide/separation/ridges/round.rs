//! Support points, touched points and side normals of cylinders and cones about the y axis.

use smallvec::SmallVec;

use crate::collide::separation::hulls::rounding_error;
use crate::collide::separation::revolved::cylinder_cylinder::radial;
use crate::math::{Real, Vector, unit};
use crate::shape::Kind;

/// The unit normals of a round side: their components away from the axis and along it, and the
/// extent of the solid along each of them.
pub(super) struct Slope<N> {
    /// Component of the unit normals away from the axis.
    pub(super) aside: N,
    /// Component along the axis.
    pub(super) along: N,
    /// Extent of the solid along the normals.
    pub(super) extent: N,
}

/// A cylinder, or a cone with its apex up, in units of the pair.
#[derive(Clone, Copy)]
pub(in super::super) struct Round<N: Real> {
    /// Half the height.
    pub(in super::super) half: N,
    /// Radius of the cylinder, or of the base of the cone.
    pub(in super::super) radius: N,
    pub(in super::super) is_cone: bool,
}

impl<N: Real> Round<N> {
    /// Scales a cylinder or cone; `None` for other kinds, and if half height or radius is within
    /// rounding error.
    pub(in super::super) fn new(kind: &Kind<'_, N, 3>, shrink: N) -> Option<Self> {
        let (half, radius, is_cone) = match kind {
            Kind::Cylinder(cylinder, _) => (cylinder.half_height(), cylinder.radius(), false),
            Kind::Cone(cone, _) => (cone.half_height(), cone.radius(), true),
            _ => return None,
        };
        let round = Self { half: half * shrink, radius: radius * shrink, is_cone };
        (round.half > rounding_error() && round.radius > rounding_error()).then_some(round)
    }

    /// Returns the sides of the caps: 1 for a cap at the upper end of the axis, -1 for a cap at the
    /// lower end. A cone has only the lower cap.
    pub(in super::super) fn caps(&self) -> &'static [f64] {
        if self.is_cone { &[-1.0] } else { &[1.0, -1.0] }
    }

    /// Returns the point farthest along a direction; one of several if it is not unique.
    pub(in super::super) fn support(&self, direction: &Vector<N, 3>) -> Vector<N, 3> {
        let aside = radial(direction);
        let squared = aside.norm_squared();
        let is_aside = squared > N::EPSILON * N::EPSILON;
        let scale = if is_aside { self.radius / squared.sqrt() } else { N::ZERO };
        let (x, z) = (aside.x * scale, aside.y * scale);
        if !self.is_cone {
            let y = if direction.y < N::ZERO { -self.half } else { self.half };
            return Vector::<N, 3>::new(x, y, z);
        }
        let rim = Vector::<N, 3>::new(x, -self.half, z);
        let apex = self.apex();
        if apex.dot(direction) > rim.dot(direction) { apex } else { rim }
    }

    fn apex(&self) -> Vector<N, 3> {
        Vector::<N, 3>::new(N::ZERO, self.half, N::ZERO)
    }

    /// Returns the unit normals of the side.
    pub(super) fn slope(&self) -> Slope<N> {
        if !self.is_cone {
            return Slope { aside: N::ONE, along: N::ZERO, extent: self.radius };
        }
        let normal = unit(&Vector::<N, 2>::new(N::TWO * self.half, self.radius));
        let (aside, along) = normal.map_or((N::ONE, N::ZERO), |(normal, _)| (normal.x, normal.y));
        Slope { aside, along, extent: along * self.half }
    }

    /// Returns up to 8 points of this solid, at least one of which touches the supporting plane
    /// with the normal `direction`; the point of a separation is computed from them. For the normal
    /// of a cap they are the ends of its diameters through the first four of the points `below`
    /// (none if there are no such points). For other directions they are both ends of the line
    /// along the side in that direction: two points of the rims or, of a cone, a point of the rim
    /// and the apex.
    pub(in super::super) fn touched<'a>(
        &self,
        direction: &Vector<N, 3>,
        below: impl Iterator<Item = &'a Vector<N, 3>>,
    ) -> SmallVec<[Vector<N, 3>; 8]> {
        let is_below = direction.y < N::ZERO;
        let has_cap = is_below || !self.is_cone;
        let is_cap = has_cap && radial(direction).norm_squared() <= N::EPSILON;
        let end = if is_below { -self.half } else { self.half };
        let at = |aside: Vector<N, 2>, y: N| {
            Vector::<N, 3>::new(aside.x * self.radius, y, aside.y * self.radius)
        };
        if is_cap {
            // For each point below, the ends of the cap's diameter through it.
            let across = |point| unit(&radial(point)).map_or(Vector::<N, 2>::x(), |found| found.0);
            let rims = below.take(4).map(across);
            return rims.flat_map(|aside| [at(aside, end), at(-aside, end)]).collect();
        }
        let aside = unit(&radial(direction)).map_or(Vector::<N, 2>::x(), |found| found.0);
        let top = if self.is_cone { self.apex() } else { at(aside, self.half) };
        SmallVec::from_slice(&[at(aside, -self.half), top])
    }
}
