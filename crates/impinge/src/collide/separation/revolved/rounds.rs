//! Cylinders and cones against each other.
//!
//! The apex or a rim of one solid is tried against the other: over a rim the distance is a function
//! of one angle, whose minimum Newton's method finds. The remaining case is two sides, whose common
//! normal is where two circles on the sphere of directions intersect. If the solids overlap, two
//! balls around one point, one in each solid, are the proof: their radii add up to the depth.

use super::profile::Profile;
use super::{RevolvedFound, RevolvedPlace, RevolvedResult, noise, seen_from_second, still};
use crate::collide::separation::segments::nearest::nearest_of_segments;
use crate::math::{Mapped, Matrix, Point, Pose, Real, Vector, cross, max, min, unit};

/// Cap on the corners and rims of one solid that are tried.
const TURNS: usize = 3;
/// Cap on the steps of Newton's method; about four are needed.
const STEPS: usize = 12;

/// Returns the result for two solids, the second at a pose whose translation is `shift` in units of
/// the pair.
pub(super) fn resolve<N: Real>(
    [first, second]: [Profile<N>; 2],
    pose12: &Pose<N, 3>,
    shift: Vector<N, 3>,
    beyond: N,
) -> RevolvedResult<N> {
    let rotation = pose12.rotation.transpose();
    let (from_first, from_second) = (shift, -(rotation * shift));
    let views = [
        RoundView::new([second, first], from_second, rotation),
        RoundView::new([first, second], from_first, pose12.rotation),
    ];
    for (view, is_second) in views.iter().zip([true, false]) {
        match view.corners(beyond) {
            RevolvedResult::Undecided => {}
            RevolvedResult::Found(found, _) => return RevolvedResult::Found(found, is_second),
            RevolvedResult::Beyond => return RevolvedResult::Beyond,
        }
    }
    seen_from_second(views[0].sides())
}

/// A solid in the frame of another.
struct RoundView<N: Real> {
    /// The solid at the origin of the frame, about the y axis.
    own: Profile<N>,
    /// The solid whose corners are tried.
    other: Profile<N>,
    /// Middle of the other solid, and its rotation.
    center: Vector<N, 3>,
    rotation: Matrix<N, 3>,
    /// Axis of the other solid, towards its apex or positive end.
    axis: Vector<N, 3>,
}

impl<N: Real> RoundView<N> {
    fn new([own, other]: [Profile<N>; 2], center: Vector<N, 3>, rotation: Matrix<N, 3>) -> Self {
        Self { own, other, center, rotation, axis: rotation.column(1).into_owned() }
    }

    /// Returns the point of the other solid that is lowest along a direction.
    fn lowest(&self, outward: &Vector<N, 3>) -> Vector<N, 3> {
        let toward = -self.rotation.tr_mul(outward);
        self.center + self.rotation * self.other.round.support(&toward)
    }

    /// Tries the apex or a rim of the other solid.
    fn corners(&self, beyond: N) -> RevolvedResult<N> {
        let mut low = self.lowest(&self.own.seen_from(self.center).outward);
        for _ in 0..TURNS {
            let Some(place) = self.at_corner(&low) else { break };
            low = self.lowest(&place.outward);
            if let Some(result) = place.result(&low, beyond) {
                return result;
            }
        }
        RevolvedResult::Undecided
    }

    /// Returns the place of the apex, or the nearest place of the rim, at which `low` lies.
    fn at_corner(&self, low: &Vector<N, 3>) -> Option<RevolvedPlace<N>> {
        let round = &self.other.round;
        let is_up = self.axis.dot(&(low - self.center)) > N::ZERO;
        if is_up && round.is_cone {
            return Some(RevolvedPlace::of(&self.own, &self.own.seen_from(*low)));
        }
        let end = if is_up { round.half } else { -round.half };
        let middle = self.center + self.axis * end;
        let across = self.rotation.column(0).into_owned();
        let out = self.beside(&(low - middle)).unwrap_or(across);
        self.along_rim(&middle, out)
    }

    /// Returns the unit vector of the part of `v` perpendicular to the other axis; `None` if within
    /// noise.
    fn beside(&self, v: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let beside = v - self.axis * self.axis.dot(v);
        unit(&beside).filter(|(_, length)| *length > noise()).map(|(beside, _)| beside)
    }

    /// Returns the nearest place of the rim around `middle`, starting from the direction `out`.
    fn along_rim(&self, middle: &Vector<N, 3>, mut out: Vector<N, 3>) -> Option<RevolvedPlace<N>> {
        let radius = self.other.round.radius;
        for _ in 0..STEPS {
            let seen = self.own.seen_from(middle + out * radius);
            let (around, pull) = (cross(&self.axis, &out), seen.pull());
            let slope = pull.dot(&around);
            let bend = seen.bend(&around) * radius - pull.dot(&out);
            let is_level = slope.abs() <= still() || slope.abs() * radius <= still::<N>() * bend;
            if is_level {
                return RevolvedPlace::across(&self.own, &seen, &around);
            }
            out = if bend > N::ZERO {
                let turn = max(min(-slope / bend, N::HALF), -N::HALF);
                self.beside(&(out + around * turn))?
            } else {
                self.beside(&-seen.outward)?
            };
        }
        None
    }

    /// Tries side against side.
    fn sides(&self) -> Option<RevolvedFound<N>> {
        let (lean, rise1, rise2) = (self.axis.y, self.own.slant.y, self.other.slant.y);
        let squared = self.axis.x * self.axis.x + self.axis.z * self.axis.z;
        if squared <= N::lit(16.0) * N::EPSILON {
            return None;
        }
        // The part in the plane of the axes follows from the angles of the normal with both axes.
        let up = Vector::<N, 3>::y();
        let level = (up * (rise1 + rise2 * lean) - self.axis * (rise2 + rise1 * lean)) / squared;
        let left = N::ONE - level.norm_squared();
        if left <= N::ZERO {
            return None;
        }
        let aside = cross(&up, &self.axis) * (left / squared).sqrt();
        let gap =
            |outward: &Vector<N, 3>| outward.dot(&self.lowest(outward)) - self.own.level(outward);
        let [one, other] = [level + aside, level - aside];
        let (outward, height) = match (gap(&one), gap(&other)) {
            (height, other) if height >= other => (one, height),
            (_, height) => (other, height),
        };
        let found = self.between_sides(outward)?.proved(height)?;
        (height > N::ZERO || self.is_deepest(&found)).then_some(found)
    }

    /// Returns the nearest points of the lines of both sides that face each other along a
    /// direction.
    fn between_sides(&self, outward: Vector<N, 3>) -> Option<RevolvedPlace<N>> {
        let line = |profile: &Profile<N>, along: &Vector<N, 3>| {
            let ends = profile.round.touched(along, core::iter::empty());
            Some([Point::from(*ends.first()?), Point::from(*ends.get(1)?)])
        };
        let own = line(&self.own, &outward)?;
        let other = line(&self.other, &-self.rotation.tr_mul(&outward))?;
        let other = other.mapped(|end| Point::from(self.center + self.rotation * end.coords));
        let (nearest, point) = nearest_of_segments(&own, &other);
        let level = self.own.level(&outward);
        Some(RevolvedPlace { point: point.coords, nearest: nearest.coords, outward, level })
    }

    /// Returns whether balls around the midpoint of both points, one in each solid, add up to the
    /// depth.
    fn is_deepest(&self, found: &RevolvedFound<N>) -> bool {
        let center = found.on_other - found.normal * (found.distance * N::HALF);
        let own = self.own.seen_from(center).distance;
        let other = self.other.seen_from(self.rotation.tr_mul(&(center - self.center))).distance;
        own + other <= found.distance + noise()
    }
}
