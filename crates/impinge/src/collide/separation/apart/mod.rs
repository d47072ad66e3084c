//! Nearest points of triangles, boxes and hulls in 3D that are well apart, for one pair or for 8
//! pairs at a time. One pair and 8 pairs run the same code, so the results are bit-identical.
//!
//! The search follows E. Gilbert, D. Johnson and S. Keerthi ("A Fast Procedure for Computing the
//! Distance Between Complex Objects in Three-Dimensional Space", 1988), without branches: each step
//! computes the nearest points of all features that meet in the newest corner of the simplex, and
//! selects the nearest of them ([`simplex`]). A result is returned only with a proof: up to
//! rounding, the distance of its points equals the distance between two parallel planes that
//! separate the cores. Without a proof the pair falls back to the algorithm of its kinds. This
//! happens if the cores overlap or are nearer than 2⁻⁶ of the pair's size (`MIN_GAP`), if there are
//! several pairs of nearest points, for hulls of more than [`MAX_VERTICES`] vertices, and if the
//! bounds do not agree.
//!
//! ```text
//!        core 1             core 2        normal = nearest / |nearest|
//!      +--------+          /\             lower bound: min normal · b − max normal · a
//!      |        a*-------b*  \            upper bound: |b* − a*|
//!      +--------+          \__\           without agreement up to rounding there is no result
//! ```
//!
//! `packet` lays out [`LANES`] pairs in rows, `core` computes support points, and `search` has the
//! loop. `collide/batch/convex.rs` cuts the packets from runs of pairs of equal kinds.

mod core;
mod packet;
mod search;
mod simplex;
#[cfg(test)]
mod tests;

use self::core::{CorePoints, LaneCore};
#[cfg(test)]
use self::search::MIN_GAP;
use self::search::{LaneCores, LaneGap};
use super::boxes::cuboid_cuboid;
use super::flat_core::FlatCore;
use super::{Algorithm, hulls, triangles};
use crate::collide::Pair;
use crate::convex::{Separation, Units, safe_reach};
use crate::math::lanes::{LanePose, minus};
use crate::math::lone::{Lone, LoneMask, OneLane};
use crate::math::simd::Level;
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::{Kind, SupportMap};

/// Number of pairs in one packet.
const LANES: usize = 8;

/// Largest number of vertices of a hull in the search, which visits every vertex in each step.
/// Larger hulls are passed to [`hulls`].
const MAX_VERTICES: usize = 128;

/// Returns the separation of two triangles, boxes or hulls: by the search if they are well apart,
/// else by the algorithm of their kinds. `None` if they are farther apart than `limit`.
///
/// For two boxes and a finite `limit`, the separating axis test runs first. Most such pairs touch,
/// and the test proves this in less time than the search needs to give up. For hulls the test takes
/// longer than the search.
#[inline]
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    if limit < N::INFINITY
        && let (Kind::Cuboid(_), Kind::Cuboid(_)) = (pair.first, pair.second)
        && let Some(found) = cuboid_cuboid::decided_by_axes(pair, limit)
    {
        return found;
    }
    // The search proves only distances above zero, which are all beyond this limit.
    if limit <= N::ZERO
        && let (Kind::Triangle(_), Kind::Triangle(_)) = (pair.first, pair.second)
    {
        return nearer(pair)(pair, limit);
    }
    result(pair, limit, false).separation(pair, limit)
}

/// Returns the distance of [`separation`], but zero if `limit` is zero or more and the cores
/// certainly overlap. `None` if the distance exceeds `limit`.
pub(super) fn distance<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<N> {
    result(pair, limit, limit >= N::ZERO).distance(pair, limit)
}

/// Computes [`separation`] for up to [`LANES`] pairs of the same kinds, with identical bits. An
/// outer `None` is a pair that has to be computed alone; an inner `None` is a pair beyond `limit`.
pub(crate) fn separations<'p, 'a: 'p, N: Real>(
    pairs: impl Iterator<Item = &'p Pair<'a, N, 3>> + Clone,
    limit: N,
) -> [Option<Option<Separation<N, 3>>>; LANES] {
    each(pairs, limit, false, |result, pair| result.separation(pair, limit))
}

/// Computes [`distance`] for up to [`LANES`] pairs of the same kinds; `limit` is zero or more. An
/// outer `None` is a pair that has to be computed alone; an inner `None` is a pair beyond `limit`.
pub(crate) fn distances<'p, 'a: 'p, N: Real>(
    pairs: impl Iterator<Item = &'p Pair<'a, N, 3>> + Clone,
    limit: N,
) -> [Option<Option<N>>; LANES] {
    each(pairs, limit, true, |result, pair| result.distance(pair, limit))
}

/// Searches up to [`LANES`] pairs and applies `convert` to the result of each. Returns `None` for
/// all pairs if [`Level::vectors`] returns `None`, if a hull or triangle is not the same object in
/// all pairs, or if the search supports none of the pairs.
#[inline]
fn each<'p, 'a: 'p, N: Real, T: Copy>(
    pairs: impl Iterator<Item = &'p Pair<'a, N, 3>> + Clone,
    limit: N,
    with_overlap: bool,
    convert: impl Fn(&GapResult<N>, &Pair<'a, N, 3>) -> Option<T>,
) -> [Option<Option<T>>; LANES] {
    let mut converted = [None; LANES];
    let Some(vectors) = Level::new().vectors() else { return converted };
    if let Some(results) = packet::results(vectors, pairs.clone(), limit, with_overlap) {
        for ((converted, result), pair) in converted.iter_mut().zip(&results).zip(pairs) {
            *converted = Some(convert(result, pair));
        }
    }
    converted
}

/// Returns whether a solid is a triangle, a box or a hull.
pub(crate) const fn is_faceted<N: Real>(kind: &Kind<'_, N, 3>) -> bool {
    matches!(kind, Kind::Triangle(_) | Kind::Cuboid(_) | Kind::Polytope(_))
}

/// Returns the algorithm for the kinds of a pair. Unlike the search, it also handles contact and
/// overlap.
fn nearer<N: Real>(pair: &Pair<'_, N, 3>) -> Algorithm<N, 3> {
    match (pair.first, pair.second) {
        (Kind::Cuboid(_), Kind::Cuboid(_)) => cuboid_cuboid::separation,
        (Kind::Triangle(_), Kind::Triangle(_)) => triangles::pair::separation,
        _ => hulls::separation,
    }
}

/// Result of the search for one pair.
#[derive(Clone, Copy, Debug, PartialEq)]
enum GapResult<N: Real> {
    /// The solids are farther apart than the limit.
    Beyond,
    /// Separation of the solids, with a proof.
    Apart(Separation<N, 3>),
    /// The cores certainly overlap.
    Overlap,
    /// The search found no proof, or [`FlatPair::of`] rejects the pair.
    Unproved,
}

impl<N: Real> GapResult<N> {
    /// Returns the separation, `None` beyond `limit`; computes overlapping and unproved pairs by
    /// the algorithm of their kinds.
    #[inline]
    fn separation(&self, pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
        match self {
            Self::Beyond => None,
            Self::Apart(found) => Some(*found).filter(|found| found.distance <= limit),
            Self::Overlap | Self::Unproved => nearer(pair)(pair, limit),
        }
    }

    /// Returns the distance, `None` beyond `limit`, or zero if the cores certainly overlap;
    /// computes unproved pairs by the algorithm of their kinds.
    #[inline]
    fn distance(&self, pair: &Pair<'_, N, 3>, limit: N) -> Option<N> {
        let distance = match self {
            Self::Beyond => None,
            Self::Apart(found) => Some(found.distance),
            Self::Overlap => Some(N::ZERO),
            Self::Unproved => match (pair.first, pair.second) {
                (Kind::Cuboid(_), Kind::Cuboid(_)) => cuboid_cuboid::distance(pair, limit),
                _ => nearer(pair)(pair, limit).map(|found| found.distance),
            },
        };
        distance.filter(|distance| *distance <= limit)
    }
}

/// Runs the search for one pair, in one lane.
#[inline(never)]
fn result<N: Real>(pair: &Pair<'_, N, 3>, limit: N, with_overlap: bool) -> GapResult<N> {
    let Some(solids) = FlatPair::of(pair) else { return GapResult::Unproved };
    let cores = [solids.lone_core(0), solids.lone_core(1)];
    let translation = pair.pose12.translation * solids.units.shrink;
    let lane = OneLane(0);
    let pose12 = LanePose::of(lane, &Pose { rotation: pair.pose12.rotation, translation });
    let [middle1, middle2] = [Lone::each(&solids.middles[0]), Lone::each(&solids.middles[1])];
    let between = minus(&pose12.point(&middle2), &middle1);
    let limit = Lone(solids.limit_of_cores(limit));
    let found = LaneCores { cores, pose12, between, limit }.gap(lane, with_overlap);
    solids.lone_result(&found)
}

/// Two triangles, boxes or hulls, and the unit of length of the search.
struct FlatPair<'a, N: Real> {
    solids: [FlatCore<'a, N, 3>; 2],
    /// Radii of both solids; zero for triangles, boxes and hulls.
    radii: [N; 2],
    /// Unit of length: the sum of both bounding radii and the distance of the origins is 1 to 2
    /// units.
    units: Units<N>,
    /// Centres of the cores in their own frames, in units of the pair.
    middles: [Vector<N, 3>; 2],
}

impl<'a, N: Real> FlatPair<'a, N> {
    /// Makes the pair; `None` for other kinds, for hulls of more than [`MAX_VERTICES`] vertices,
    /// and if the unit of the pair or its reciprocal is not finite.
    #[inline]
    fn of(pair: &Pair<'a, N, 3>) -> Option<Self> {
        if !(is_faceted(&pair.first) && is_faceted(&pair.second)) {
            return None;
        }
        let solids = [FlatCore::of(pair.first)?, FlatCore::of(pair.second)?];
        let [reach1, reach2] = [safe_reach(&solids[0]), safe_reach(&solids[1])];
        let units = Units::of(reach1, reach2, &pair.pose12.translation);
        let is_small = solids.iter().all(|solid| {
            vertices(solid).is_none_or(|points| points.vertices.len() <= MAX_VERTICES)
        });
        let is_scalable = units.scale.is_finite_number() && units.shrink.is_finite_number();
        (is_small && is_scalable).then(|| Self {
            middles: [
                solids[0].center().coords * units.shrink,
                solids[1].center().coords * units.shrink,
            ],
            radii: [solids[0].rounding(), solids[1].rounding()],
            solids,
            units,
        })
    }

    /// Returns the limit for the distance of the cores, in units of the pair, raised so that
    /// rounding rejects no pair within `limit`.
    #[inline]
    fn limit_of_cores(&self, limit: N) -> N {
        let limit = (limit + self.radii[0] + self.radii[1]) * self.units.shrink;
        limit + N::lit(64.0) * N::EPSILON * (N::ONE + limit.abs())
    }

    #[inline]
    fn lone_core(&self, which: usize) -> LaneCore<'a, N, Lone<N>> {
        let shrink = self.units.shrink;
        match (self.solids[which], vertices(&self.solids[which])) {
            (FlatCore::Cuboid(cuboid), _) => {
                LaneCore::Cuboid(Lone::each(&(cuboid.half_extents() * shrink)))
            }
            (_, found) => {
                let points = found.expect("the others have vertices");
                LaneCore::Points { points, shrink: Lone(shrink) }
            }
        }
    }

    /// Converts the outcome of the search into the result for the solids. The first flag that is
    /// `true` decides; without one the pair is unproved. `core` computes the separation of the
    /// cores in units of the pair; it is called only for a pair that is apart.
    #[inline]
    fn result(
        &self,
        [is_beyond, is_overlap, is_apart]: [bool; 3],
        core: impl FnOnce() -> Separation<N, 3>,
    ) -> GapResult<N> {
        if is_beyond {
            GapResult::Beyond
        } else if is_overlap {
            GapResult::Overlap
        } else if is_apart {
            let core = core().scaled(self.units.scale);
            GapResult::Apart(core.rounded(self.radii[0], self.radii[1]))
        } else {
            GapResult::Unproved
        }
    }

    #[inline]
    fn lone_result(&self, found: &LaneGap<Lone<N>, LoneMask>) -> GapResult<N> {
        let known = [found.is_beyond.0, found.is_overlap.0, found.is_apart.0];
        let [point1, point2] = &found.points;
        self.result(known, || Separation {
            distance: found.distance.0,
            normal: Lone::vector(&found.normal),
            point1: Point::from(Lone::vector(point1)),
            point2: Point::from(Lone::vector(point2)),
        })
    }
}

/// Returns the vertices of a triangle or hull; `None` for other kinds.
#[inline]
fn vertices<'a, N: Real>(solid: &FlatCore<'a, N, 3>) -> Option<CorePoints<'a, N>> {
    match *solid {
        FlatCore::Triangle(triangle) => {
            Some(CorePoints { vertices: triangle.corners().as_slice(), hull: None })
        }
        FlatCore::Polytope(hull) => {
            Some(CorePoints { vertices: hull.vertices(), hull: Some(hull) })
        }
        _ => None,
    }
}
