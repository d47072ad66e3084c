//! A cylinder or a cone as a point sees it, and how the distance changes as the point moves.
//!
//! A solid about the y axis is a flat outline in the half-plane of the axis and the point: caps and a side that are
//! lines, a rim and an apex that are corners. The signed distance from it is convex in 3D, inside as well.

use crate::collide::separation::revolved::cylinder_cylinder::radial;
use crate::collide::separation::ridges::Round;
use crate::math::{Real, Vector, cross2, unit};

/// A cylinder or a cone with its apex up, of a size.
#[derive(Clone, Copy)]
pub(super) struct Profile<N: Real> {
    pub(super) round: Round<N>,
    /// The unit normal of the side: away from the axis, and up.
    pub(super) slant: Vector<N, 2>,
    /// From the rim to the apex.
    length: N,
}

/// The part of the outline that a point is nearest to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ProfilePart {
    Cap,
    Side,
    Rim,
    Apex,
}

/// A point, and what it sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfileView<N: Real> {
    pub(super) point: Vector<N, 3>,
    /// Negative inside.
    pub(super) distance: N,
    /// Unit, out of the solid, along which the distance is measured.
    pub(super) outward: Vector<N, 3>,
    pub(super) part: ProfilePart,
    /// How far the point is from the axis, and the unit vector that leads there, as (x, z).
    aside: N,
    away: Vector<N, 2>,
    /// From the corner that is nearest to the point, in the half-plane; of lines their normal.
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

    /// How far the solid reaches along a direction.
    pub(super) fn level(&self, outward: &Vector<N, 3>) -> N {
        outward.dot(&self.round.support(outward))
    }

    /// What a point sees.
    pub(super) fn seen_from(&self, point: Vector<N, 3>) -> ProfileView<N> {
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

    /// A corner of the outline that is nearest to a point this far from it; what is too near to be squared is on
    /// the side.
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
    /// The point of the surface that is nearest.
    pub(super) fn nearest(&self) -> Vector<N, 3> {
        self.point - self.outward * self.distance
    }

    /// The direction of the rim there.
    pub(super) fn around(&self) -> Vector<N, 3> {
        Vector::<N, 3>::new(-self.away.y, N::ZERO, self.away.x)
    }

    /// How fast the distance grows as the point moves.
    pub(super) fn slope(&self, along: &Vector<N, 3>) -> N {
        self.outward.dot(along)
    }

    /// A step towards where the way is nearest to the rim, whatever the point sees: between two lines of the outline
    /// that meet there.
    pub(super) fn way_to_rim(&self, profile: &Profile<N>, along: &Vector<N, 3>) -> Option<N> {
        let Round { half, radius, is_cone } = profile.round;
        let end = if is_cone || self.point.y < N::ZERO { -half } else { half };
        let offset = Vector::<N, 2>::new(self.aside - radius, self.point.y - end);
        let (out, turn) = (self.away.dot(&radial(along)), cross2(&self.away, &radial(along)));
        let bend = out * out + along.y * along.y + turn * turn * (offset.x / self.aside);
        (bend > N::ZERO).then(|| -(offset.x * out + offset.y * along.y) / bend)
    }

    /// How far the point has to move until the slope is zero, if it goes on seeing the same part; nothing of a
    /// line over which the slope does not change. Exact but at a rim, where it is a step of Newton's method
    /// for the squared distance.
    pub(super) fn way_down(&self, along: &Vector<N, 3>) -> Option<N> {
        let (out, turn) = (self.away.dot(&radial(along)), cross2(&self.away, &radial(along)));
        let (across, up) = (out * out + turn * turn, along.y);
        match self.part {
            ProfilePart::Cap => None,
            // The distance from the axis is a hyperbola, whose slope has to be `rise`.
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

    /// What draws the point to the solid: the slope of the distance or, of corners, of half its square, which is
    /// the smoother of the two.
    pub(super) fn pull(&self) -> Vector<N, 3> {
        match self.part {
            ProfilePart::Cap | ProfilePart::Side => self.outward,
            ProfilePart::Rim | ProfilePart::Apex => self.outward * self.distance,
        }
    }

    /// How fast the pull grows along the way as the point moves.
    pub(super) fn bend(&self, along: &Vector<N, 3>) -> N {
        let (out, turn) = (self.away.dot(&radial(along)), cross2(&self.away, &radial(along)));
        let turned = turn * turn;
        match self.part {
            ProfilePart::Cap => N::ZERO,
            ProfilePart::Side => turned * self.offset.x / self.aside,
            ProfilePart::Rim => {
                out * out + along.y * along.y + turned * (self.offset.x / self.aside)
            }
            ProfilePart::Apex => out * out + along.y * along.y + turned,
        }
    }
}
