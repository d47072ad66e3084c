//! Signed distance of a point from a cylinder or a cone, and its derivatives as the point moves.
//!
//! In the half-plane of the axis and the point, a solid about the y axis is a flat outline: caps
//! and a side that are lines, a rim and an apex that are corners. The signed distance is a convex
//! function in 3D, also inside.
//!
//! ```text
//!    cylinder  y|  Cap   : Rim         cone  y| Apex .       nearest part, by region;
//!               |________:......              |\  .          x: distance from the axis, `aside`
//!               |        |                    | \   Side
//!               |        | Side               |__\ .         inside: the nearer line
//!               +--------+----> x             |Cap: Rim
//! ```

use crate::collide::separation::revolved::cylinder_cylinder::radial;
use crate::collide::separation::ridges::Round;
use crate::math::{Real, Vector, cross2, unit};

/// A cylinder, or a cone with its apex up.
#[derive(Clone, Copy)]
pub(super) struct Profile<N: Real> {
    pub(super) round: Round<N>,
    /// Unit normal of the side in the half-plane: components away from the axis, and along it.
    pub(super) slant: Vector<N, 2>,
    /// Length of the side of a cone from the rim to the apex; unused for a cylinder.
    length: N,
}

/// Part of the outline nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ProfilePart {
    Cap,
    Side,
    Rim,
    Apex,
}

/// A point with its signed distance, and the part nearest to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfileView<N: Real> {
    pub(super) point: Vector<N, 3>,
    /// Signed distance of `point` from the surface, negative inside.
    pub(super) distance: N,
    /// Unit vector out of the solid, along which the distance is measured.
    pub(super) outward: Vector<N, 3>,
    pub(super) part: ProfilePart,
    /// Distance of the point from the axis.
    aside: N,
    /// Unit vector from the axis to the point, as (x, z); the x axis for a point on the axis.
    away: Vector<N, 2>,
    /// For the rim and the apex, the vector from there to the point, in the half-plane; for a cap
    /// or side, its unit normal.
    offset: Vector<N, 2>,
}

impl<N: Real> Profile<N> {
    pub(super) fn new(round: Round<N>) -> Self {
        let Round { half, radius, is_cone } = round;
        let side =
            if is_cone { Vector::<N, 2>::new(N::TWO * half, radius) } else { Vector::<N, 2>::x() };
        let (slant, length) = unit(&side).unwrap_or((Vector::<N, 2>::x(), N::ZERO));
        Self { round, slant, length }
    }

    /// Returns the extent of the solid along a direction.
    pub(super) fn extent(&self, outward: &Vector<N, 3>) -> N {
        outward.dot(&self.round.support(outward))
    }

    /// Returns the view of a point: its signed distance and the nearest part.
    pub(super) fn project(&self, point: Vector<N, 3>) -> ProfileView<N> {
        let fallback = (Vector::<N, 2>::x(), N::ZERO);
        let (away, aside) = unit(&radial(&point)).unwrap_or(fallback);
        let (part, distance, offset) = if self.round.is_cone {
            self.of_cone(aside, point.y)
        } else {
            self.of_cylinder(aside, point.y)
        };
        let normal = match part {
            ProfilePart::Cap | ProfilePart::Side => offset,
            ProfilePart::Rim | ProfilePart::Apex => offset / distance,
        };
        let outward = Vector::<N, 3>::new(away.x * normal.x, normal.y, away.y * normal.x);
        ProfileView { point, distance, outward, part, aside, away, offset }
    }

    /// Returns the nearest part of a cylinder, the distance, and the `offset` of the view.
    fn of_cylinder(&self, x: N, y: N) -> (ProfilePart, N, Vector<N, 2>) {
        let up = if y < N::ZERO { -N::ONE } else { N::ONE };
        let (beside, above) = (x - self.round.radius, y.abs() - self.round.half);
        if beside > N::ZERO && above > N::ZERO {
            return self.corner(ProfilePart::Rim, Vector::<N, 2>::new(beside, above * up));
        }
        if beside > above {
            (ProfilePart::Side, beside, Vector::<N, 2>::x())
        } else {
            (ProfilePart::Cap, above, Vector::<N, 2>::y() * up)
        }
    }

    /// Returns the nearest part of a cone, the distance, and the `offset` of the view.
    fn of_cone(&self, x: N, y: N) -> (ProfilePart, N, Vector<N, 2>) {
        let from_rim = Vector::<N, 2>::new(x - self.round.radius, y + self.round.half);
        let (below, above) = (-from_rim.y, self.slant.dot(&from_rim));
        let along = cross2(&self.slant, &from_rim);
        let is_beside = along >= N::ZERO && along <= self.length;
        if above > N::ZERO && along > self.length {
            return self.corner(ProfilePart::Apex, Vector::<N, 2>::new(x, y - self.round.half));
        }
        if above > N::ZERO && is_beside || above > below && below <= N::ZERO && above <= N::ZERO {
            return (ProfilePart::Side, above, self.slant);
        }
        if from_rim.x <= N::ZERO {
            return (ProfilePart::Cap, below, -Vector::<N, 2>::y());
        }
        self.corner(ProfilePart::Rim, from_rim)
    }

    /// Returns the nearest part, the distance and the `offset` of the view for a point at `offset`
    /// from a corner of the outline. If the squared length underflows, the point counts as on the
    /// side.
    fn corner(&self, part: ProfilePart, offset: Vector<N, 2>) -> (ProfilePart, N, Vector<N, 2>) {
        let length = offset.norm();
        if length > N::ZERO {
            (part, length, offset)
        } else {
            (ProfilePart::Side, N::ZERO, self.slant)
        }
    }
}

impl<N: Real> ProfileView<N> {
    /// Returns the nearest point of the surface.
    pub(super) fn nearest(&self) -> Vector<N, 3> {
        self.point - self.outward * self.distance
    }

    /// Returns the unit tangent of the rim at the angle of the point about the axis.
    pub(super) fn around(&self) -> Vector<N, 3> {
        Vector::<N, 3>::new(-self.away.y, N::ZERO, self.away.x)
    }

    /// Returns the derivative of the distance as the point moves along `along`.
    pub(super) fn slope(&self, along: &Vector<N, 3>) -> N {
        self.outward.dot(along)
    }

    /// Returns the multiple of `along` that is one step of Newton's method for the smallest squared
    /// distance to the rim, even if another part is nearest to the point. For a cylinder, the rim
    /// on the point's side of the plane y = 0 is used. `None` if the second derivative of the
    /// squared distance is not positive.
    pub(super) fn step_to_rim(&self, profile: &Profile<N>, along: &Vector<N, 3>) -> Option<N> {
        let Round { half, radius, is_cone } = profile.round;
        let end = if is_cone || self.point.y < N::ZERO { -half } else { half };
        let offset = Vector::<N, 2>::new(self.aside - radius, self.point.y - end);
        let (out, turn) = (self.away.dot(&radial(along)), cross2(&self.away, &radial(along)));
        let bend = out * out + along.y * along.y + turn * turn * (offset.x / self.aside);
        (bend > N::ZERO).then(|| -(offset.x * out + offset.y * along.y) / bend)
    }

    /// Returns the multiple of `along` by which the point has to move until the slope is zero, if
    /// its nearest part does not change. `None` if no such multiple exists: at a cap the slope is
    /// constant, at a side it may have no zero. Exact except at a rim, where it is a step of
    /// Newton's method for the squared distance.
    pub(super) fn descent(&self, along: &Vector<N, 3>) -> Option<N> {
        let (out, turn) = (self.away.dot(&radial(along)), cross2(&self.away, &radial(along)));
        let (across, up) = (out * out + turn * turn, along.y);
        match self.part {
            ProfilePart::Cap => None,
            // As a function of the multiple of `along`, the distance from the axis is a hyperbola.
            // The multiple sought is the one at which the hyperbola has the slope `rise`.
            ProfilePart::Side => {
                let rise = -up * self.offset.y / self.offset.x;
                let left = across - rise * rise;
                (left > N::ZERO)
                    .then(|| (rise * turn.abs() / left.sqrt() - out) * self.aside / across)
            }
            ProfilePart::Rim | ProfilePart::Apex => {
                Some(-self.pull().dot(along) / self.bend(along))
            }
        }
    }

    /// Returns the gradient of the distance or, at corners, of half its square, which is smoother.
    pub(super) fn pull(&self) -> Vector<N, 3> {
        match self.part {
            ProfilePart::Cap | ProfilePart::Side => self.outward,
            ProfilePart::Rim | ProfilePart::Apex => self.outward * self.distance,
        }
    }

    /// Returns the derivative of the component of [`pull`](Self::pull) along `along` as the point
    /// moves along `along`.
    pub(super) fn bend(&self, along: &Vector<N, 3>) -> N {
        let (out, turn) = (self.away.dot(&radial(along)), cross2(&self.away, &radial(along)));
        let turn_squared = turn * turn;
        match self.part {
            ProfilePart::Cap => N::ZERO,
            ProfilePart::Side => turn_squared * self.offset.x / self.aside,
            ProfilePart::Rim => {
                out * out + along.y * along.y + turn_squared * (self.offset.x / self.aside)
            }
            ProfilePart::Apex => out * out + along.y * along.y + turn_squared,
        }
    }
}
