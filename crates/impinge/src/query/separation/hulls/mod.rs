//! Convex hulls and boxes in space, of so few parts that all of them can be looked at.
//!
//! No iteration, and nothing that depends on where a search begins: the answer is that of named
//! features. The separating axis test asks every face of both solids, eight at a time, how far the other
//! solid lies above it ([`cloud`]). The highest face is the answer where the solids face each other
//! there ([`face`]). If not, edges decide ([`edges`]), and only those whose vertices lie within reach
//! of the face: where the solids overlap, pairs of edges that are a face of their Minkowski difference
//! (the Gauss map test of D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013);
//! where they are apart, the nearest points of edges. What is not proved in the end, by points that
//! lie as far apart as a pair of supporting planes, is left to the general algorithm.

mod cloud;
mod edges;
mod face;
mod solid;
#[cfg(test)]
pub(in crate::query) mod tests;

use fearless_simd::{Level, Simd};

use self::cloud::{Cloud, Place};
use self::face::{Meeting, Side};
use self::solid::{BoxParts, Flat};
use super::{general, wrong_kinds};
use crate::convex::{Separation, Units};
use crate::math::lanes::with_lanes;
use crate::math::{Point, Pose, Real, Vector, Wide};
use crate::query::Pair;
use crate::shape::{Cuboid, Kind, SupportMap};

/// How many vertices, faces or edges are treated at once.
const LANES: usize = 8;
/// Room for 32 vertices, and for the 60 faces that as many vertices may have.
const BLOCKS: usize = 4;
const PLANE_BLOCKS: usize = 8;

/// The separation of a convex hull or a box from a convex hull.
///
/// Equal faces: those of the first solid come before those of the second, in their order, and all
/// before edges. Cost: the product of the numbers of vertices and faces, by eights; larger hulls
/// are left to the general algorithm.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let Kind::Polytope(second) = pair.second else { wrong_kinds(pair) };
    let found = match (pair.first, Flat::of_polytope(second)) {
        (_, None) => Verdict::Undecided,
        (Kind::Polytope(first), Some(second)) => Flat::of_polytope(first)
            .map_or(Verdict::Undecided, |first| between(&first, &second, &pair.pose12, limit)),
        (Kind::Cuboid(first), Some(second)) if has_volume(first, second.reach) => {
            between(&BoxParts::new(first).flat(), &second, &pair.pose12, limit)
        }
        (Kind::Cuboid(_), _) => Verdict::Undecided,
        _ => wrong_kinds(pair),
    };
    match found {
        Verdict::Beyond => None,
        Verdict::Found(found) => Some(found).filter(|found| found.distance <= limit),
        Verdict::Undecided => general::of_flat_cores(pair, limit),
    }
}

/// Whether no side of a box is as short as noise beside a solid of this reach: faces without width have
/// sides without direction.
fn has_volume<N: Real>(cuboid: &Cuboid<N, 3>, reach: N) -> bool {
    let least = noise::<N>() * (cuboid.reach() + reach);
    cuboid.half_extents().iter().all(|&half| half > least)
}

/// How the test ended.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict<N: Real> {
    /// The solids are farther apart than the limit.
    Beyond,
    Found(Separation<N, 3>),
    Undecided,
}

/// What arithmetic cannot resolve, in units of the pair.
pub(super) fn noise<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// What a lower bound has to exceed to be out of reach, in units of the pair: a limit of the caller's, and
/// rounding.
pub(super) fn out_of_reach<N: Real>(units: &Units<N>, limit: N) -> N {
    let limit = limit * units.shrink;
    limit + N::lit(16.0) * noise::<N>() * (N::ONE + limit.abs())
}

fn between<N: Real>(
    first: &Flat<'_, N>,
    second: &Flat<'_, N>,
    pose12: &Pose<N, 3>,
    limit: N,
) -> Verdict<N> {
    if !pose12.is_finite() {
        return Verdict::Beyond;
    }
    at(Level::new(), [first, second], pose12, limit)
}

/// [`between`] with the vectors of an instruction set; the answers do not depend on it.
fn at<N: Real>(
    level: Level,
    solids: [&Flat<'_, N>; 2],
    pose12: &Pose<N, 3>,
    limit: N,
) -> Verdict<N> {
    with_lanes!(level, simd => search::<_, N, N::Lanes<_>>(simd, solids, pose12, limit), else Verdict::Undecided)
}

#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [first, second]: [&Flat<'_, N>; 2],
    pose12: &Pose<N, 3>,
    limit: N,
) -> Verdict<N> {
    let units = Units::of(first.reach, second.reach, &pose12.translation);
    let shrink = units.shrink;
    let beyond = out_of_reach(&units, limit);
    let in_first = Place { rotation: pose12.rotation, translation: pose12.translation * shrink };
    let own2 = Cloud::own::<S, V>(simd, (second.blocks, second.vertices), shrink);
    let cloud2 = own2.placed::<S, V>(simd, &in_first);
    let (face1, height1) = cloud2.farthest_plane::<S, V>(simd, first.planes, shrink);
    if height1 > beyond {
        return Verdict::Beyond;
    }
    let in_second = in_first.inverse();
    let own1 = Cloud::own::<S, V>(simd, (first.blocks, first.vertices), shrink);
    let cloud1 = own1.placed::<S, V>(simd, &in_second);
    let (face2, height2) = cloud1.farthest_plane::<S, V>(simd, second.planes, shrink);
    if height2 > beyond {
        return Verdict::Beyond;
    }
    // Seen from the solid whose face it is: the other one is placed in its frame.
    let is_second = height2 > height1 + noise();
    let (solids, clouds, place, face) = if is_second {
        ([second, first], [&own2, &cloud1], in_second, face2)
    } else {
        ([first, second], [&own1, &cloud2], in_first, face1)
    };
    let normal = solids[0].normal(face);
    let [own, other] = [
        Side::new::<S, V>(simd, solids[0], clouds[0], &-normal),
        Side::new::<S, V>(simd, solids[1], clouds[1], &normal),
    ];
    let meeting = Meeting { own, other, place, face, normal, shrink };
    match meeting.resolve::<S, V>(simd) {
        Some(found) if is_second => {
            Verdict::Found(in_first_frame(&found.restored(units.scale), pose12))
        }
        Some(found) => Verdict::Found(found.restored(units.scale)),
        None => Verdict::Undecided,
    }
}

/// An answer in the frame of the solid that owns the face, from it to the other.
#[derive(Clone, Copy)]
struct Found<N: Real> {
    distance: N,
    normal: Vector<N, 3>,
    on_own: Vector<N, 3>,
    on_other: Vector<N, 3>,
}

impl<N: Real> Found<N> {
    /// In the caller's units.
    fn restored(&self, scale: N) -> Separation<N, 3> {
        Separation {
            distance: self.distance * scale,
            normal: self.normal,
            point1: Point::from(self.on_own * scale),
            point2: Point::from(self.on_other * scale),
        }
    }
}

/// An answer found in the frame of the second solid, in that of the first, at which it lies at
/// `pose12`.
pub(super) fn in_first_frame<N: Real>(
    found: &Separation<N, 3>,
    pose12: &Pose<N, 3>,
) -> Separation<N, 3> {
    Separation {
        distance: found.distance,
        normal: -pose12.vector(&found.normal),
        point1: pose12.point(&found.point2),
        point2: pose12.point(&found.point1),
    }
}
