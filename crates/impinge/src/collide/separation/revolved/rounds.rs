//! Cylinders and cones against cones.
//!
//! The apex or a rim of one solid is tried against the other. Over a rim the distance is a function
//! of one angle, whose minimum Newton's method finds. The remaining case is side against side; the
//! common normals of two sides are the intersections of two circles on the sphere of directions. If
//! two sides overlap, the proof is two balls around one point, one in each solid, whose radii add
//! up to the depth.

use super::profile::Profile;
use super::{DirectedPoint, RevolvedFound, RevolvedResult, in_second_frame, rounding_error, still};
use crate::collide::separation::segments::nearest::nearest_of_segments;
use crate::math::{Mapped, Matrix, Point, Pose, Real, Vector, cross, max, min, unit};

/// Largest number of times that an apex or a rim of one solid is tried.
const TURNS: usize = 3;
/// Largest number of steps of Newton's method; about four are needed.
const STEPS: usize = 12;

/// Searches for the separation of two round solids. A gap larger than `beyond` gives `Beyond`.
/// `shift` is the translation of the second solid's pose, in units of the pair.
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
    in_second_frame(views[0].sides())
}

/// Two round solids in the frame of one of them.
struct RoundView<N: Real> {
    /// The solid at the origin of the frame, about the y axis.
    own: Profile<N>,
    /// The solid whose corners are tried.
    other: Profile<N>,
    /// Centre of the other solid.
    center: Vector<N, 3>,
    /// Rotation of the other solid.
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

    /// Tries the apex and the rims of the other solid against this one.
    fn corners(&self, beyond: N) -> RevolvedResult<N> {
        let mut low = self.lowest(&self.own.project(self.center).outward);
        for _ in 0..TURNS {
            let Some(directed) = self.at_corner(&low) else { break };
            low = self.lowest(&directed.outward);
            if let Some(result) = directed.result(&low, beyond) {
                return result;
            }
        }
        RevolvedResult::Undecided
    }

    /// Returns the apex of the other solid if `low` is the apex, else the point nearest to this
    /// solid on the rim through `low`; `None` if the search does not converge.
    fn at_corner(&self, low: &Vector<N, 3>) -> Option<DirectedPoint<N>> {
        let round = &self.other.round;
        let is_up = self.axis.dot(&(low - self.center)) > N::ZERO;
        if is_up && round.is_cone {
            return Some(DirectedPoint::of(&self.own, &self.own.project(*low)));
        }
        let end = if is_up { round.half } else { -round.half };
        let middle = self.center + self.axis * end;
        let across = self.rotation.column(0).into_owned();
        let out = self.beside(&(low - middle)).unwrap_or(across);
        self.along_rim(&middle, out)
    }

    /// Returns the unit vector along the part of `v` perpendicular to the axis of the other solid;
    /// `None` if that part is within rounding error.
    fn beside(&self, v: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let beside = v - self.axis * self.axis.dot(v);
        unit(&beside).filter(|(_, length)| *length > rounding_error()).map(|(beside, _)| beside)
    }

    /// Returns the point of the rim around `middle` nearest to this solid, searched from the
    /// direction `out`; `None` if the search does not converge.
    fn along_rim(&self, middle: &Vector<N, 3>, mut out: Vector<N, 3>) -> Option<DirectedPoint<N>> {
        let radius = self.other.round.radius;
        for _ in 0..STEPS {
            let projected = self.own.project(middle + out * radius);
            let (around, pull) = (cross(&self.axis, &out), projected.pull());
            let slope = pull.dot(&around);
            let bend = projected.bend(&around) * radius - pull.dot(&out);
            let is_flat = slope.abs() <= still() || slope.abs() * radius <= still::<N>() * bend;
            if is_flat {
                return DirectedPoint::across(&self.own, &projected, &around);
            }
            out = if bend > N::ZERO {
                let turn = max(min(-slope / bend, N::HALF), -N::HALF);
                self.beside(&(out + around * turn))?
            } else {
                self.beside(&-projected.outward)?
            };
        }
        None
    }

    /// Tries side against side; `None` unless supporting planes or balls prove the result.
    fn sides(&self) -> Option<RevolvedFound<N>> {
        let (cosine, rise1, rise2) = (self.axis.y, self.own.slant.y, self.other.slant.y);
        let squared = self.axis.x * self.axis.x + self.axis.z * self.axis.z;
        if squared <= N::lit(16.0) * N::EPSILON {
            return None;
        }
        // The normal's component in the plane of both axes follows from the angles between the
        // normal and each axis.
        let up = Vector::<N, 3>::y();
        let in_plane =
            (up * (rise1 + rise2 * cosine) - self.axis * (rise2 + rise1 * cosine)) / squared;
        let left = N::ONE - in_plane.norm_squared();
        if left <= N::ZERO {
            return None;
        }
        let aside = cross(&up, &self.axis) * (left / squared).sqrt();
        let gap =
            |outward: &Vector<N, 3>| outward.dot(&self.lowest(outward)) - self.own.extent(outward);
        let [one, other] = [in_plane + aside, in_plane - aside];
        let (outward, height) = match (gap(&one), gap(&other)) {
            (height, other) if height >= other => (one, height),
            (_, height) => (other, height),
        };
        let found = self.between_sides(outward)?.proved(height)?;
        (height > N::ZERO || self.is_deepest(&found)).then_some(found)
    }

    /// Returns the nearest points of the lines in which both sides touch supporting planes with the
    /// normal `outward`. `None` if a cap touches instead.
    fn between_sides(&self, outward: Vector<N, 3>) -> Option<DirectedPoint<N>> {
        let line = |profile: &Profile<N>, along: &Vector<N, 3>| {
            let ends = profile.round.touched(along, core::iter::empty());
            Some([Point::from(*ends.first()?), Point::from(*ends.get(1)?)])
        };
        let own = line(&self.own, &outward)?;
        let other = line(&self.other, &-self.rotation.tr_mul(&outward))?;
        let other = other.mapped(|end| Point::from(self.center + self.rotation * end.coords));
        let (nearest, point) = nearest_of_segments(&own, &other);
        let extent = self.own.extent(&outward);
        Some(DirectedPoint { point: point.coords, nearest: nearest.coords, outward, extent })
    }

    /// Returns whether two balls around the midpoint of the two points of `found`, one in each
    /// solid, have radii that add up to the depth.
    fn is_deepest(&self, found: &RevolvedFound<N>) -> bool {
        let center = found.on_other - found.normal * (found.distance * N::HALF);
        let own = self.own.project(center).distance;
        let other = self.other.project(self.rotation.tr_mul(&(center - self.center))).distance;
        own + other <= found.distance + rounding_error()
    }
}
