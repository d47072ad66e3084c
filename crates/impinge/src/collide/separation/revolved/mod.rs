//! Flat-sided solids, segments, capsules, cylinders and cones against cylinders and cones. In these
//! files, "flat solid" means a flat-sided solid, segment or capsule, and "round solid" a cylinder
//! or cone.
//!
//! The signed distance of a point from a cylinder or a cone has a closed form ([`profile`]), and it
//! is convex. So the nearest point of the flat solid is searched over the hull of a few of its
//! vertices. The lowest vertex along the direction found is added until none is lower: the
//! simplicial decomposition of B. von Hohenbalken ("Simplicial decomposition in nonlinear
//! programming algorithms", 1977), here over points, chords and triangles.
//!
//! ```text
//!      point *--------* low      low: lowest vertex of the flat solid along `outward`; if it is
//!            |                   not lower than `point`, both solids have a supporting plane there
//!    nearest *  ^ outward        outward: unit, out of the round solid; extent: the round solid's
//!        .-------.               along `outward`
//!        | round |               frame: of the round solid, axis y; units of the pair
//! ```
//!
//! A result is accepted only if its direction is the normal of a supporting plane of both solids
//! and its two points face each other along it. If the solids are apart, this suffices. If a point
//! of the flat solid is inside the round one, the ball around it with its depth as radius is inside
//! too, so no separating translation is shorter. If a point of the round solid is below a face, the
//! ball around it with its depth as radius must be inside the flat solid. Cases without such a
//! proof, mostly an edge across a rim, fall back to the arcs of [`ridges`].

mod chord;
pub(super) mod coaxial;
pub(super) mod cylinder_cylinder;
mod faces;
mod profile;
mod rounds;
#[cfg(test)]
mod tests;

use self::cylinder_cylinder::{RevolvedFound, RevolvedResult};
use self::profile::{Profile, ProfilePart, ProfileView};
use super::flat_core::FlatCore;
use super::general;
use super::hulls::{beyond_limit, rounding_error};
use super::ridges::{self, Round};
use super::wrong_kinds;
use crate::collide::Pair;
use crate::convex::{Separation, Units};
use crate::math::{Pose, Real, Vector, cross, unit};
use crate::shape::{Geometry, SupportMap};

/// Largest number of vertices added in one search.
const ROUNDS: usize = 12;

/// Smallest sine of the angle between a chord and the rim's tangent at which their common
/// perpendicular is used as the direction of the nearest points.
const RESOLVED: f64 = 1.0 / 64.0;

/// Returns the tolerance of the search, in units of the pair: moves and differences of heights up
/// to this count as zero.
fn still<N: Real>() -> N {
    rounding_error::<N>() * N::HALF
}

/// Returns the separation of a flat-sided solid, segment, capsule, cylinder or cone from a cylinder
/// or cone; `None` above `limit`, and if the pose is not finite.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let otherwise = || match FlatCore::of(pair.first) {
        Some(_) => ridges::separation(pair, limit),
        None => coaxial::separation(pair, limit),
    };
    attempt(pair, limit).unwrap_or_else(otherwise)
}

/// Returns the distance of [`separation`]; for overlapping solids it may be any number that is not
/// positive. `None` above `limit`.
pub(super) fn distance<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<N> {
    match (attempt(pair, limit), FlatCore::of(pair.first)) {
        (Some(found), _) => found.map(|found| found.distance),
        (None, Some(_)) => ridges::distance(pair, limit),
        (None, None) => general::distance(pair, limit),
    }
}

/// Returns the separation if the search decides. An inner `None` is a pair beyond `limit`, or with
/// a pose that is not finite; an outer `None` is an undecided pair, or one for which [`Round::new`]
/// returns `None`.
fn attempt<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Option<Separation<N, 3>>> {
    let (first, second) = (Geometry(pair.first), Geometry(pair.second));
    let (Some(map1), Some(map2)) = (first.as_support_map(), second.as_support_map()) else {
        wrong_kinds(pair)
    };
    let pose12 = &pair.pose12;
    if !pose12.is_finite() {
        return Some(None);
    }
    let units = Units::of(map1.reach(), map2.reach(), &pose12.translation);
    let profile = Profile::new(Round::new(&pair.second, units.shrink)?);
    let shift = pose12.translation * units.shrink;
    let beyond = beyond_limit(&units, limit + map1.rounding());
    let result = match FlatCore::of(pair.first) {
        Some(flat) => {
            RevolvedPair { flat, pose12, shift, shrink: units.shrink, profile }.resolve(beyond)
        }
        None => {
            let first = Profile::new(Round::new(&pair.first, units.shrink)?);
            rounds::resolve([first, profile], pose12, shift, beyond)
        }
    };
    let found = result.answer(&units, pose12)?;
    let rounded = found.map(|found| found.rounded(map1.rounding(), N::ZERO));
    Some(rounded.filter(|found| found.distance <= limit))
}

/// Converts a separation in the frame of the second solid to a result; `None` gives `Undecided`.
fn in_second_frame<N: Real>(found: Option<RevolvedFound<N>>) -> RevolvedResult<N> {
    found.map_or(RevolvedResult::Undecided, |found| RevolvedResult::Found(found, true))
}

/// The core of the flat solid, and the round solid, in the frame of the round solid and in units of
/// the pair.
struct RevolvedPair<'a, N: Real> {
    flat: FlatCore<'a, N, 3>,
    /// Pose of the round solid in the frame of the flat one.
    pose12: &'a Pose<N, 3>,
    /// Translation of `pose12` in units of the pair.
    shift: Vector<N, 3>,
    /// Factor from lengths of the shapes to units of the pair.
    shrink: N,
    profile: Profile<N>,
}

/// A point of the other solid (flat or round), and the direction of its distance from the round
/// solid in whose frame the search runs.
#[derive(Clone, Copy)]
struct DirectedPoint<N: Real> {
    /// Point of the other solid, in the frame of the round solid and in units of the pair.
    point: Vector<N, 3>,
    /// Point of the round solid that faces `point`.
    nearest: Vector<N, 3>,
    /// Unit vector out of the round solid.
    outward: Vector<N, 3>,
    /// Extent of the round solid along `outward`.
    extent: N,
}

/// The smallest hull of points of the flat solid that contains the nearest point.
#[derive(Clone, Copy)]
enum NearestHull<N: Real> {
    Point(Vector<N, 3>),
    Chord([Vector<N, 3>; 2]),
    Triangle,
}

impl<N: Real> RevolvedPair<'_, N> {
    /// Runs the search from the vertex that is lowest along the direction from the round solid to
    /// the centre of the flat one. If no nearer point is found, or after [`ROUNDS`] steps, tries
    /// faces and caps.
    fn resolve(&self, beyond: N) -> RevolvedResult<N> {
        let middle = self.placed(&self.flat.center().coords);
        let first = self.lowest(&self.profile.project(middle).outward);
        let (mut hull, mut directed) = self.at_point(first);
        for _ in 0..ROUNDS {
            let low = self.lowest(&directed.outward);
            if let Some(result) = directed.result(&low, beyond) {
                return result;
            }
            match self.nearer(&hull, &directed, low) {
                Some(next) => (hull, directed) = next,
                None => break,
            }
        }
        in_second_frame(self.by_face())
    }

    /// Transforms a point of the flat solid to the frame of the round solid and to units of the
    /// pair.
    fn placed(&self, point: &Vector<N, 3>) -> Vector<N, 3> {
        self.pose12.rotation.tr_mul(&(point * self.shrink - self.shift))
    }

    /// Returns the vertex of the flat solid that is lowest along a direction.
    fn lowest(&self, outward: &Vector<N, 3>) -> Vector<N, 3> {
        let toward = -(self.pose12.rotation * outward);
        self.placed(&self.flat.core_support(&toward).coords)
    }

    /// Returns the hull of a single point, and that point with its direction.
    fn at_point(&self, point: Vector<N, 3>) -> (NearestHull<N>, DirectedPoint<N>) {
        (NearestHull::Point(point), DirectedPoint::of(&self.profile, &self.profile.project(point)))
    }

    /// Returns the point nearest to the round solid in the hull of `hull` and the vertex `low` (for
    /// a triangle, in the chord from `directed` to `low`), and the smallest hull that contains it.
    /// `low` must be lower than all of `hull`. `None` if the search fails.
    fn nearer(
        &self,
        hull: &NearestHull<N>,
        directed: &DirectedPoint<N>,
        low: Vector<N, 3>,
    ) -> Option<(NearestHull<N>, DirectedPoint<N>)> {
        match hull {
            NearestHull::Point(point) => self.profile.along([*point, low], true),
            NearestHull::Chord([a, b]) => self.over([*a, *b, low], directed),
            // No tetrahedron is searched: the triangle is reduced to its nearest point, and the
            // chord from that point to `low` is searched.
            NearestHull::Triangle => self.profile.along([directed.point, low], true),
        }
    }

    /// Returns the point of the triangle `a b c` nearest to the round solid; `None` if it is not
    /// found or not proved. The corner `c` is lower than `directed`, the nearest point of the side
    /// `a b`.
    fn over(
        &self,
        [a, b, c]: [Vector<N, 3>; 3],
        directed: &DirectedPoint<N>,
    ) -> Option<(NearestHull<N>, DirectedPoint<N>)> {
        let across = cross(&(b - a), &(c - a));
        let (unit_across, area) = unit(&across).filter(|(_, area)| *area > rounding_error())?;
        let outward =
            if unit_across.dot(&directed.outward) < N::ZERO { -unit_across } else { unit_across };
        let mut nearest = self.profile.round.support(&outward);
        let extent = outward.dot(&nearest);
        // On a cap or a line the support point is not unique; use the point known to be near.
        if outward.dot(&directed.nearest) >= extent - rounding_error() {
            nearest = directed.nearest;
        }
        let height = outward.dot(&a) - extent;
        let point = nearest + outward * height;
        let slack = -rounding_error::<N>() * area;
        let over = |from: &Vector<N, 3>, to: &Vector<N, 3>| {
            cross(&(to - from), &(point - from)).dot(&unit_across)
        };
        let sides = [over(&b, &c), over(&c, &a), over(&a, &b)];
        if sides.iter().all(|&side| side >= slack) {
            let is_proved = height > N::ZERO || self.holds(&nearest, -height);
            return is_proved.then_some((
                NearestHull::Triangle,
                DirectedPoint { point, nearest, outward, extent },
            ));
        }
        let mut best: Option<(NearestHull<N>, DirectedPoint<N>)> = None;
        for (chord, other) in [([b, c], a), ([a, c], b)] {
            let Some((hull, found)) = self.profile.along(chord, false) else { continue };
            let is_least = found.outward.dot(&(found.point - other)) <= still();
            if is_least {
                return Some((hull, found));
            }
            if best.as_ref().is_none_or(|(_, best)| found.distance() < best.distance()) {
                best = Some((hull, found));
            }
        }
        best
    }

    /// Returns whether the flat solid contains the ball around `center`, up to rounding; always
    /// `false` for segments, capsules and triangles.
    fn holds(&self, center: &Vector<N, 3>, radius: N) -> bool {
        let center = self.pose12.rotation * center + self.shift;
        let slack = rounding_error::<N>() - radius;
        match self.flat {
            FlatCore::Cuboid(cuboid) => {
                let half = cuboid.half_extents() * self.shrink;
                (0..3).all(|axis| center[axis].abs() <= half[axis] + slack)
            }
            FlatCore::Polytope(hull) => hull
                .faces()
                .iter()
                .all(|face| face.normal.dot(&center) <= face.offset * self.shrink + slack),
            _ => false,
        }
    }
}

impl<N: Real> DirectedPoint<N> {
    /// Creates the point with the direction of a [`ProfileView`]. If the nearest point is a corner,
    /// the corner may not be the farthest point along this direction, because of rounding; then
    /// `extent` exceeds the corner's height.
    fn of(profile: &Profile<N>, projected: &ProfileView<N>) -> Self {
        let extent = profile.extent(&projected.outward);
        Self {
            point: projected.point,
            nearest: projected.nearest(),
            outward: projected.outward,
            extent,
        }
    }

    /// Creates the point of a view at which the distance is stationary along the unit vector
    /// `along`, with a direction that is perpendicular to `along` up to rounding. `None` if the
    /// direction of the view is parallel to `along`.
    fn across(
        profile: &Profile<N>,
        projected: &ProfileView<N>,
        along: &Vector<N, 3>,
    ) -> Option<Self> {
        let by_rim = match projected.part {
            ProfilePart::Rim => unit(&cross(along, &projected.around())),
            _ => None,
        };
        let outward = match by_rim {
            Some((across, sine)) if sine > N::lit(RESOLVED) => {
                if across.dot(&projected.outward) < N::ZERO { -across } else { across }
            }
            _ => unit(&(projected.outward - along * along.dot(&projected.outward)))?.0,
        };
        let extent = profile.extent(&outward);
        Some(Self { point: projected.point, nearest: projected.nearest(), outward, extent })
    }

    fn distance(&self) -> N {
        self.outward.dot(&self.point) - self.extent
    }

    /// Returns the result for `low`, the lowest vertex along the direction: `Beyond`, or, if no
    /// vertex is lower than the point, the separation or `Undecided`. `None` if a vertex is lower.
    fn result(&self, low: &Vector<N, 3>, beyond: N) -> Option<RevolvedResult<N>> {
        let height = self.outward.dot(low) - self.extent;
        if height > beyond {
            return Some(RevolvedResult::Beyond);
        }
        let is_lowest = self.outward.dot(&(self.point - low)) <= still();
        is_lowest.then(|| in_second_frame(self.proved(height)))
    }

    /// Returns the separation; `None` unless the vector between both points is `outward` times
    /// `height`, up to rounding.
    fn proved(&self, height: N) -> Option<RevolvedFound<N>> {
        let aside = self.point - self.nearest - self.outward * height;
        let is_across = aside.norm_squared() <= rounding_error::<N>() * rounding_error();
        let found = RevolvedFound { distance: height, normal: self.outward, on_other: self.point };
        is_across.then_some(found)
    }
}
