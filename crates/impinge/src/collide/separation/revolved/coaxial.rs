//! Depth of two solids of revolution about nearly the same axis, from their outlines.
//!
//! The Minkowski difference of two solids about one axis is a solid about that axis. Its outline in
//! a half-plane of the axis is the difference of two polygons. So the least depth is along the
//! normal of a side of one of them. This depth is equal all around the axis, so a search over
//! directions has no gradient. If the axes differ slightly, the best direction is near the ring of
//! such a normal.
//!
//! ```text
//!       axis |____ corners[0] (x, y)       x: distance from the axis, y: along it
//!            |    \                        normals: caps (0, 1) and (0, -1), and the side's
//!            |     \  side normal ->       a normal with x > 0 stands for a ring of directions
//!            |______\ corners[1]
//! ```

use smallvec::SmallVec;

use crate::collide::Pair;
use crate::collide::separation::flat_core::FlatCore;
use crate::collide::separation::general;
use crate::collide::separation::hulls::rounding_error;
use crate::collide::separation::ridges::Round;
use crate::collide::separation::wrong_kinds;
use crate::convex::{self, Peak, Peaks, Separation};
use crate::math::{Mapped, Pose, Real, Vector, cross, max, perpendicular_to, unit};
use crate::shape::{Geometry, Kind};

/// Two solids, in units of the pair, count as coaxial if their distance from a common axis is at
/// most this: 2⁻¹².
const NEAR: f64 = 1.0 / 4096.0;
/// Largest length of the difference of two normals in the half-plane at which they count as normals
/// of one ring.
const SAME_RING: f64 = 1.0 / 16.0;

/// Returns the separation of two cylinders or cones by the general algorithm; `None` above `limit`.
/// If the solids overlap and are coaxial, the algorithm takes the normal from [`CoaxialPeaks`].
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let (first, second) = (Geometry(pair.first), Geometry(pair.second));
    let (Some(map1), Some(map2)) = (first.as_support_map(), second.as_support_map()) else {
        wrong_kinds(pair)
    };
    let loosened = general::loosened(map1, map2, &pair.pose12, limit);
    let peaks = CoaxialPeaks { pair };
    let found = convex::separation_by(map1, map2, &pair.pose12, loosened, &peaks);
    found.filter(|found| found.distance <= limit)
}

/// Gives the general algorithm the normal of an overlap, by [`peak`], if the solids are coaxial.
struct CoaxialPeaks<'a, 'b, N: Real> {
    pair: &'b Pair<'a, N, 3>,
}

impl<N: Real> Peaks<N, 3> for CoaxialPeaks<'_, '_, N> {
    fn best(&self, shrink: N, _: N) -> Option<Peak<N, 3>> {
        peak(self.pair, shrink)
    }
}

/// Returns the normal of least depth for the overlapping cores of two coaxial solids, each a
/// segment, capsule, cylinder or cone. `None` for other kinds, if the axes do not nearly coincide,
/// or if another ring of normals may have less depth. `shrink` is the factor from lengths of the
/// shapes to units of the pair.
pub(in crate::collide::separation) fn peak<N: Real>(
    pair: &Pair<'_, N, 3>,
    shrink: N,
) -> Option<Peak<N, 3>> {
    let own_frame = Pose::identity();
    let first = AxialOutline::of(pair.first, &own_frame, shrink)?;
    let second = AxialOutline::of(pair.second, &pair.pose12, shrink)?;
    Coaxial::new(first, second)?.peak()
}

/// A solid about an axis, in the frame of the first solid and in units of the pair: in a plane
/// through the axis, it is the hull of both corners and their mirror images.
struct AxialOutline<N: Real> {
    /// Centre of the solid, in the frame of the first.
    middle: Vector<N, 3>,
    /// Unit vector along the axis.
    axis: Vector<N, 3>,
    /// Distance from the axis and coordinate along it, for the upper and the lower corner.
    corners: [Vector<N, 2>; 2],
}

impl<N: Real> AxialOutline<N> {
    /// Returns the outline of a cylinder, cone, segment or capsule, without a capsule's radius.
    /// `None` for other kinds, and for cylinders, cones and segments whose half height, radius or
    /// half length is within rounding error.
    fn of(kind: Kind<'_, N, 3>, pose: &Pose<N, 3>, shrink: N) -> Option<Self> {
        let position = pose.translation * shrink;
        if let Some(round) = Round::new(&kind, shrink) {
            let top = if round.is_cone { N::ZERO } else { round.radius };
            return Some(Self {
                middle: position,
                axis: pose.rotation.column(1).into_owned(),
                corners: [
                    Vector::<N, 2>::new(top, round.half),
                    Vector::<N, 2>::new(round.radius, -round.half),
                ],
            });
        }
        let segment = match FlatCore::of(kind)? {
            FlatCore::Segment(segment) => segment,
            FlatCore::Capsule(capsule) => capsule.segment(),
            _ => return None,
        };
        let [a, b] = [segment.a(), segment.b()].mapped(|end| end.coords * (shrink * N::HALF));
        let (along, half) = unit(&(b - a)).filter(|(_, half)| *half > rounding_error())?;
        let corners = [half, -half].mapped(|at| Vector::<N, 2>::new(N::ZERO, at));
        let middle = pose.rotation * (a + b) + position;
        Some(Self { middle, axis: pose.rotation * along, corners })
    }

    fn reach(&self) -> N {
        max(self.corners[0].norm(), self.corners[1].norm())
    }

    fn extent_in_half_plane(&self, normal: &Vector<N, 2>) -> N {
        max(normal.dot(&self.corners[0]), normal.dot(&self.corners[1]))
    }

    /// Returns the extent of the solid along a unit vector.
    fn extent(&self, along: &Vector<N, 3>) -> N {
        let up = along.dot(&self.axis);
        let aside = (along - self.axis * up).norm();
        along.dot(&self.middle) + self.extent_in_half_plane(&Vector::<N, 2>::new(aside, up))
    }

    /// Returns the normals of the caps, then of the side, in the half-plane.
    fn normals(&self) -> impl Iterator<Item = Vector<N, 2>> {
        let [top, bottom] = &self.corners;
        let up = Vector::<N, 2>::y();
        let caps = [(top, up), (bottom, -up)].mapped(|(end, cap)| (end.x > N::ZERO).then_some(cap));
        let side = unit(&Vector::<N, 2>::new(top.y - bottom.y, bottom.x - top.x));
        caps.into_iter().chain([side.map(|(side, _)| side)]).flatten()
    }

    /// Maps a direction of the half-plane through the unit vector `aside` to 3D.
    fn lifted(&self, v: &Vector<N, 2>, aside: &Vector<N, 3>) -> Vector<N, 3> {
        aside * v.x + self.axis * v.y
    }

    /// Returns the corners farthest along a normal; for caps also their mirror images.
    fn touched(&self, normal: &Vector<N, 2>, aside: &Vector<N, 3>) -> SmallVec<[Vector<N, 3>; 8]> {
        let low = self.extent_in_half_plane(normal) - N::EPSILON.sqrt();
        let sides: &[N] = if normal.x > N::ZERO { &[N::ONE] } else { &[N::ONE, -N::ONE] };
        let far = self.corners.iter().filter(|corner| normal.dot(corner) >= low);
        far.flat_map(|corner| {
            sides.iter().map(|&s| self.middle + self.lifted(corner, &(aside * s)))
        })
        .collect()
    }
}

/// Two nearly coaxial solids.
struct Coaxial<N: Real> {
    first: AxialOutline<N>,
    /// Second solid; its axis has the direction of the first solid's axis.
    second: AxialOutline<N>,
    /// Offset of the second centre from the first, perpendicular to the axis.
    offset: Vector<N, 3>,
    /// Upper bound of the distance of the solids from a common axis.
    apart: N,
}

impl<N: Real> Coaxial<N> {
    /// Flips the second axis into the direction of the first; `None` unless the solids are nearly
    /// coaxial.
    fn new(first: AxialOutline<N>, mut second: AxialOutline<N>) -> Option<Self> {
        if first.axis.dot(&second.axis) < N::ZERO {
            let [top, bottom] = second.corners;
            second.axis = -second.axis;
            second.corners =
                [bottom, top].mapped(|corner| Vector::<N, 2>::new(corner.x, -corner.y));
        }
        let between = second.middle - first.middle;
        let shift = first.axis.dot(&between);
        let offset = between - first.axis * shift;
        let sine = cross(&first.axis, &second.axis).norm();
        let apart = offset.norm() + sine * (second.reach() + shift.abs());
        (apart <= N::lit(NEAR)).then_some(Self { first, second, offset, apart })
    }

    /// Returns the unit vector from the first axis towards the second centre; any perpendicular if
    /// the centre is on the axis.
    fn aside(&self) -> Vector<N, 3> {
        let beside = unit(&self.offset).filter(|(_, offset)| *offset > rounding_error());
        beside.map_or_else(|| perpendicular_to(&self.first.axis), |(aside, _)| aside)
    }

    /// Returns the exit (a direction and the depth along it) along the normal of a cap or side;
    /// `normal` is in the half-plane of the solid `whose`.
    fn direction(
        &self,
        normal: Vector<N, 2>,
        whose: &AxialOutline<N>,
        aside: &Vector<N, 3>,
    ) -> AxialExit<N> {
        let lifted = whose.lifted(&normal, aside);
        let along = unit(&lifted).map_or(*aside, |(along, _)| along);
        let depth = self.first.extent(&along) + self.second.extent(&-along);
        AxialExit { normal, along, depth }
    }

    /// Returns the exit of least depth; `None` if the ring of another normal may contain a better
    /// one.
    fn peak(&self) -> Option<Peak<N, 3>> {
        let aside = self.aside();
        let own = self.first.normals().map(|n| self.direction(n, &self.first, &aside));
        let across = |n: Vector<N, 2>| Vector::<N, 2>::new(n.x, -n.y);
        let others = self.second.normals();
        let others = others.map(|n| self.direction(across(n), &self.second, &aside));
        let exits: SmallVec<[AxialExit<N>; 6]> = own.chain(others).collect();
        let shorter = |a: AxialExit<N>, b: AxialExit<N>| if b.depth < a.depth { b } else { a };
        let best = exits.iter().copied().reduce(shorter)?;
        let is_exact = self.apart <= rounding_error();
        let slack = self.apart * N::lit(4.0);
        let is_rival = |other: &AxialExit<N>| {
            let is_other_ring = (other.normal - best.normal).norm() > N::lit(SAME_RING);
            other.normal.x > N::ZERO && is_other_ring && other.depth < best.depth + slack
        };
        if !is_exact && exits.iter().any(is_rival) {
            return None;
        }
        let is_ring = best.normal.x > N::ZERO && !is_exact;
        Some(Peak {
            normal: best.along,
            is_exact: !is_ring,
            is_ring,
            on1: self.first.touched(&best.normal, &aside),
            on2: self.second.touched(&across(best.normal), &-aside),
        })
    }
}

/// A unit vector along which the solids can be separated, with the depth along it.
#[derive(Clone, Copy)]
struct AxialExit<N: Real> {
    /// The normal in the half-plane of the axis.
    normal: Vector<N, 2>,
    /// Unit vector in the frame of the first solid.
    along: Vector<N, 3>,
    /// Depth of the overlap along the direction.
    depth: N,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::separation::hulls::tests::{Random, error};
    use crate::collide::separation::{general, separation as of_table};
    use crate::math::Point;
    use crate::math::na::UnitQuaternion;
    use crate::shape::{Cone, Cylinder, Segment, Shape};

    fn solid<N: Real>(random: &mut Random) -> Box<dyn Shape<N, 3>> {
        let sizes = random.vector::<N>().abs().add_scalar(N::lit(0.125));
        match random.pick(3) {
            0 => Box::new(Cylinder::new(sizes.x, sizes.y)),
            1 => Box::new(Cone::new(sizes.x, sizes.y)),
            _ => {
                let end = Point::<N, 3>::new(N::ZERO, sizes.x, N::ZERO);
                Box::new(Segment::new(-end, end))
            }
        }
    }

    /// Asserts that the separation agrees with the general algorithm within `accuracy`, for solids
    /// that are coaxial up to an offset and a tilt of size `slight`. The second solid is upright or
    /// upside down.
    fn compare<N: Real>(seed: u64, slight: f64, accuracy: f64) {
        let random = &mut Random(seed);
        for round in 0..200 {
            let [one, other] = [(); 2].map(|()| solid::<N>(random));
            if one.geometry().kind() > other.geometry().kind() {
                continue;
            }
            let [about, tilt, offset] = [(); 3].mapped(|()| random.vector::<N>());
            let up = if round % 2 == 0 { N::ZERO } else { N::lit(core::f64::consts::PI) };
            let turns =
                [tilt * N::lit(slight), Vector::<N, 3>::x() * up, Vector::<N, 3>::y() * about.y];
            let turn = turns.mapped(UnitQuaternion::from_scaled_axis);
            let rotation = (turn[0] * turn[1] * turn[2]).to_rotation_matrix().into_inner();
            let at = Vector::<N, 3>::y() * (about.x * N::HALF) + offset * N::lit(slight);
            let pose12 = Pose { rotation, translation: at };
            let pair = Pair { first: one.geometry().0, second: other.geometry().0, pose12 };
            let found = of_table(&pair, N::INFINITY).expect("no limit");
            let truth = general::separation(&pair, N::INFINITY).expect("no limit");
            let error = error(&pair, &found, &truth);
            assert!(
                error <= accuracy,
                "round {round}: off by {error}: {one:?} {other:?} {pose12:?}: {found:?}, not {truth:?}"
            );
        }
    }

    #[test]
    fn answers_about_one_axis_are_those_of_the_search() {
        compare::<f64>(1, 0.0, 1e-11);
        compare::<f32>(2, 0.0, 1e-5);
    }

    #[test]
    fn answers_near_one_axis_are_those_of_the_search() {
        compare::<f64>(3, 1e-9, 1e-11);
        compare::<f64>(4, 1e-5, 1e-11);
        compare::<f32>(5, 1e-5, 1e-5);
    }
}
