//! Flat-sided solids, segments, capsules, cylinders and cones against cylinders and cones.
//!
//! The signed distance of a point from a cylinder or a cone is a closed form ([`profile`]), and
//! convex. So the nearest point of the flat solid is searched over the hull of a few of its
//! vertices. The lowest vertex along the direction found is added until none is lower: the
//! simplicial decomposition of B. von Hohenbalken ("Simplicial decomposition in nonlinear
//! programming algorithms", 1977), here over points, chords and triangles.
//!
//! ```text
//!      point *--------* low      low: lowest vertex of the flat solid along `outward`; if it is
//!            |                   not lower than `point`, both solids have a plane there
//!    nearest *  ^ outward        outward: unit, out of the round solid; level: its extent along it
//!        .-------.
//!        | round |               frame: of the round solid, axis y; units of the pair
//! ```
//!
//! An answer is accepted only if its direction is a supporting plane of both solids and its two
//! points lie across from each other along it. If the solids are apart that is all. If a point of
//! the flat solid is inside the round one, the ball around it with its depth as radius is inside
//! too, so no way out is shorter. If a point of the round solid is below a face, the ball around it
//! must be inside the flat one. Cases without such a proof, above all an edge across a rim, go to
//! the arcs of [`ridges`].

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
use super::hulls::{noise, out_of_reach};
use super::ridges::{self, Round};
use super::wrong_kinds;
use crate::collide::Pair;
use crate::convex::{Separation, Units};
use crate::math::{Pose, Real, Vector, cross, unit};
use crate::shape::{Geometry, SupportMap};

/// Cap on the vertices added.
const ROUNDS: usize = 12;

/// Two directions define a common perpendicular if the sine of their angle exceeds this.
const RESOLVED: f64 = 1.0 / 64.0;

/// Returns the tolerance of the search, in units of the pair: moves and differences in height up to
/// this count as none.
fn still<N: Real>() -> N {
    noise::<N>() * N::HALF
}

/// Returns the separation of a flat-sided solid, segment, capsule, cylinder or cone from a cylinder
/// or cone.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let otherwise = || match FlatCore::of(pair.first) {
        Some(_) => ridges::separation(pair, limit),
        None => coaxial::separation(pair, limit),
    };
    attempt(pair, limit).unwrap_or_else(otherwise)
}

/// Returns the distance of [`separation`], or any number that is not positive for overlapping
/// solids.
pub(super) fn distance<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<N> {
    match (attempt(pair, limit), FlatCore::of(pair.first)) {
        (Some(found), _) => found.map(|found| found.distance),
        (None, Some(_)) => ridges::distance(pair, limit),
        (None, None) => general::distance(pair, limit),
    }
}

/// Returns the separation, if the search decides; the inner `None` means beyond `limit`.
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
    let beyond = out_of_reach(&units, limit + map1.rounding());
    let result = match FlatCore::of(pair.first) {
        Some(flat) => {
            RevolvedMeeting { flat, pose12, shift, shrink: units.shrink, profile }.resolve(beyond)
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

/// Wraps an answer in the frame of the second solid.
fn seen_from_second<N: Real>(found: Option<RevolvedFound<N>>) -> RevolvedResult<N> {
    found.map_or(RevolvedResult::Undecided, |found| RevolvedResult::Found(found, true))
}

/// Core of the flat solid and the round one, in the frame of the round one and in units of the
/// pair.
struct RevolvedMeeting<'a, N: Real> {
    flat: FlatCore<'a, N, 3>,
    /// Pose of the round solid in the frame of the flat one.
    pose12: &'a Pose<N, 3>,
    /// Translation of `pose12` in units of the pair.
    shift: Vector<N, 3>,
    /// Factor from lengths of the shapes to units of the pair.
    shrink: N,
    profile: Profile<N>,
}

/// A point of the flat solid with the direction along which it is nearest to the round one.
#[derive(Clone, Copy)]
struct RevolvedPlace<N: Real> {
    /// In the frame of the round solid, in units of the pair.
    point: Vector<N, 3>,
    /// The point of the round solid across from `point`.
    nearest: Vector<N, 3>,
    /// Unit vector out of the round solid; `level` is the extent of the round solid along it.
    outward: Vector<N, 3>,
    level: N,
}

/// The points whose hull contains the nearest point; no more than needed.
#[derive(Clone, Copy)]
enum NearestHull<N: Real> {
    Point(Vector<N, 3>),
    Chord([Vector<N, 3>; 2]),
    Triangle,
}

impl<N: Real> RevolvedMeeting<'_, N> {
    /// Runs the search from the vertex nearest along the first direction; then tries faces and
    /// caps.
    fn resolve(&self, beyond: N) -> RevolvedResult<N> {
        let middle = self.placed(&self.flat.center().coords);
        let first = self.lowest(&self.profile.seen_from(middle).outward);
        let (mut hull, mut place) = self.at_point(first);
        for _ in 0..ROUNDS {
            let low = self.lowest(&place.outward);
            if let Some(result) = place.result(&low, beyond) {
                return result;
            }
            match self.nearer(&hull, &place, low) {
                Some(next) => (hull, place) = next,
                None => break,
            }
        }
        seen_from_second(self.by_face())
    }

    /// Transforms a point of the flat solid from its own frame and units.
    fn placed(&self, point: &Vector<N, 3>) -> Vector<N, 3> {
        self.pose12.rotation.tr_mul(&(point * self.shrink - self.shift))
    }

    /// Returns the vertex of the flat solid that is lowest along a direction.
    fn lowest(&self, outward: &Vector<N, 3>) -> Vector<N, 3> {
        let toward = -(self.pose12.rotation * outward);
        self.placed(&self.flat.core_support(&toward).coords)
    }

    /// Returns the place of a single point.
    fn at_point(&self, point: Vector<N, 3>) -> (NearestHull<N>, RevolvedPlace<N>) {
        (
            NearestHull::Point(point),
            RevolvedPlace::of(&self.profile, &self.profile.seen_from(point)),
        )
    }

    /// Returns the nearest place over a hull and one more vertex, which is lower than all of the
    /// hull.
    fn nearer(
        &self,
        hull: &NearestHull<N>,
        place: &RevolvedPlace<N>,
        low: Vector<N, 3>,
    ) -> Option<(NearestHull<N>, RevolvedPlace<N>)> {
        match hull {
            NearestHull::Point(point) => self.profile.along([*point, low], true),
            NearestHull::Chord([a, b]) => self.over([*a, *b, low], place),
            // Only chords and triangles are searched: the place stands for its triangle.
            NearestHull::Triangle => self.profile.along([place.point, low], true),
        }
    }

    /// Returns the nearest place over the triangle `a b c`, whose corner `c` is lower than `place`,
    /// the nearest place of the side `a b`.
    fn over(
        &self,
        [a, b, c]: [Vector<N, 3>; 3],
        place: &RevolvedPlace<N>,
    ) -> Option<(NearestHull<N>, RevolvedPlace<N>)> {
        let across = cross(&(b - a), &(c - a));
        let (turned, area) = unit(&across).filter(|(_, area)| *area > noise())?;
        let outward = if turned.dot(&place.outward) < N::ZERO { -turned } else { turned };
        let mut nearest = self.profile.round.support(&outward);
        let level = outward.dot(&nearest);
        // On a cap or a line the support point is not unique; take the one known to be near.
        if outward.dot(&place.nearest) >= level - noise() {
            nearest = place.nearest;
        }
        let height = outward.dot(&a) - level;
        let point = nearest + outward * height;
        let room = -noise::<N>() * area;
        let over = |from: &Vector<N, 3>, to: &Vector<N, 3>| {
            cross(&(to - from), &(point - from)).dot(&turned)
        };
        let sides = [over(&b, &c), over(&c, &a), over(&a, &b)];
        if sides.iter().all(|&side| side >= room) {
            let is_proved = height > N::ZERO || self.holds(&nearest, -height);
            return is_proved.then_some((
                NearestHull::Triangle,
                RevolvedPlace { point, nearest, outward, level },
            ));
        }
        let mut best: Option<(NearestHull<N>, RevolvedPlace<N>)> = None;
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

    /// Returns whether the flat solid contains the ball around a point, up to rounding.
    fn holds(&self, center: &Vector<N, 3>, radius: N) -> bool {
        let center = self.pose12.rotation * center + self.shift;
        let room = noise::<N>() - radius;
        match self.flat {
            FlatCore::Cuboid(cuboid) => {
                let half = cuboid.half_extents() * self.shrink;
                (0..3).all(|axis| center[axis].abs() <= half[axis] + room)
            }
            FlatCore::Polytope(hull) => hull
                .faces()
                .iter()
                .all(|face| face.normal.dot(&center) <= face.offset * self.shrink + room),
            _ => false,
        }
    }
}

impl<N: Real> RevolvedPlace<N> {
    /// Takes the direction of a view. At a point on a corner, up to rounding, that direction may
    /// not be one along which the corner is farthest; `level` shows it.
    fn of(profile: &Profile<N>, seen: &ProfileView<N>) -> Self {
        let level = profile.level(&seen.outward);
        Self { point: seen.point, nearest: seen.nearest(), outward: seen.outward, level }
    }

    /// Takes a view at which the distance is stationary along the unit vector `along`, with a
    /// direction perpendicular to `along` to rounding.
    fn across(profile: &Profile<N>, seen: &ProfileView<N>, along: &Vector<N, 3>) -> Option<Self> {
        let by_rim = match seen.part {
            ProfilePart::Rim => unit(&cross(along, &seen.around())),
            _ => None,
        };
        let outward = match by_rim {
            Some((across, sine)) if sine > N::lit(RESOLVED) => {
                if across.dot(&seen.outward) < N::ZERO { -across } else { across }
            }
            _ => unit(&(seen.outward - along * along.dot(&seen.outward)))?.0,
        };
        let level = profile.level(&outward);
        Some(Self { point: seen.point, nearest: seen.nearest(), outward, level })
    }

    fn distance(&self) -> N {
        self.outward.dot(&self.point) - self.level
    }

    /// Returns the result given the lowest vertex along the direction: beyond, or if nothing is
    /// lower than the place, whether it is proved. `None` if a vertex is lower.
    fn result(&self, low: &Vector<N, 3>, beyond: N) -> Option<RevolvedResult<N>> {
        let height = self.outward.dot(low) - self.level;
        if height > beyond {
            return Some(RevolvedResult::Beyond);
        }
        let is_lowest = self.outward.dot(&(self.point - low)) <= still();
        is_lowest.then(|| seen_from_second(self.proved(height)))
    }

    /// Returns the answer, if both points lie across from each other as far apart as supporting
    /// planes.
    fn proved(&self, height: N) -> Option<RevolvedFound<N>> {
        let aside = self.point - self.nearest - self.outward * height;
        let is_across = aside.norm_squared() <= noise::<N>() * noise();
        let found = RevolvedFound { distance: height, normal: self.outward, on_other: self.point };
        is_across.then_some(found)
    }
}
