//! Algorithms on convex sets that are given by their support points. They depend on no kind of
//! shape, know nothing of composites, and keep no state between calls.
//!
//! ```text
//!         core 1                core 2             difference: all b - a
//!        .-----.    normal n   .-----.             h(n) = min n · b - max n · a: the certificate
//!        |    a|-------------->|b    |             signed distance = max h(n) over unit n
//!        '-----'               '-----'
//!    found by     apart: `gjk`          overlapping: `epa2`, `epa3`, or a known `peak`
//!    improved by  `refine`  `climb`  `newton`  `polish`  `side`        points: `witness`
//! ```
//!
//! [`separation`] returns the signed distance of two convex solids with radii. It works on their
//! cores: the difference of the cores (all `b − a`) is searched for its point nearest to the origin
//! ([`gjk`]) or, if it contains the origin, for its nearest supporting plane (`epa2`, `epa3`). A
//! normal `n` is never trusted for how it was found, only for its height `h(n) = min n·b − max
//! n·a`, called its *certificate*: two support points prove that `n` separates the cores by that
//! much. The signed distance is the largest height over all unit vectors. For curved cores that
//! provide their curvature, Newton's method computes the last digits (`polish`).
//!
//! All computations use units in which the size of the pair is about 1 (`difference`). The unit is
//! a power of two. So the conversion is exact, every tolerance is a plain multiple of the machine
//! epsilon, and scaling both solids by a power of two scales the result exactly.
//!
//! [`gjk`], `epa2` and `epa3` find a normal without a good guess. `refine` (support points),
//! `climb` (proximal points), `newton` and `polish` (curvature) and `side` (the ring of normals of
//! a round side) improve a good normal; `witness` finds the points of both cores that belong to the
//! normal. Every loop has a cap, and the result at the cap has a certificate like any other.

mod candidate;
mod climb;
mod difference;
mod epa2;
mod epa3;
mod extent;
mod gjk;
mod hull;
mod newton;
mod peak;
mod polish;
mod refine;
mod separation;
mod side;
mod simplex;
mod simplex2;
mod simplex3;
#[cfg(test)]
mod tests;
mod units;
mod witness;

pub(crate) use peak::{Peak, Peaks};
pub(crate) use separation::Separation;
pub(crate) use simplex::Simplicial;
pub(crate) use units::Units;

use crate::math::{Pose, Vector};
use crate::shape::SupportMap;
pub(crate) use difference::safe_reach;
use difference::{CorePair, rounding_error};
use gjk::Answer;

/// Returns the signed distance of two solids with radii, its normal and its points, in the frame of
/// the first; `pose12` is the pose of the second in that frame.
///
/// `None` if the solids are certainly farther apart than `limit`: a plane separates them by more,
/// beyond rounding. At a distance of exactly `limit` the result is `Some`. With an infinite limit
/// and finite input it is always `Some`. NaN or infinity in the pose gives `None`.
///
/// `distance` is the height of `normal` minus both radii. Let `s` be the sum of the bounding radii
/// of the cores and of the distance of their origins. `distance` falls short of the exact value by
/// a few `N::EPSILON · s` for flat-faced cores and for curved ones that provide their curvature
/// ([`SupportMap::curved_support`]); for other curved cores by about the larger of that and `2⁻⁴⁰ ·
/// s`. If a whole ring of normals is nearly as good, as for deep overlaps of nearly coaxial
/// cylinders or cones, the ring of a round side is searched ([`SupportMap::round_side`]). If there
/// is no round side, and all normals nearby are about as good, as in the middle of a ball, a local
/// search gives the result; then `distance` may fall short by more. The points lie on the cores to
/// the same accuracy; on curved cores that do not provide their curvature, to about the square root
/// of that accuracy at worst. Among equally good normals, as for coincident centres, the choice is
/// deterministic. Two cores that are single coincident points define no direction; the normal is
/// then the first axis.
///
/// Cost: about ten support points of each solid if the cores are apart, a few dozen if they
/// overlap, some hundreds at most.
pub(crate) fn separation<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    limit: N,
) -> Option<Separation<N, D>>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let pair = CorePair::new(a, b, pose12)?;
    of_pair(&pair, &pair.start(), [a.rounding(), b.rounding()], limit)
}

/// Returns the result of [`separation`] for solids whose cores have neither edges nor rims, except
/// that one may be a segment. Finding the best normal of an overlap then takes fewer steps.
pub(crate) fn smooth_separation<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    limit: N,
) -> Option<Separation<N, D>>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let pair = CorePair::new(a, b, pose12)?.between_smooth_cores();
    of_pair(&pair, &pair.start(), [a.rounding(), b.rounding()], limit)
}

/// Returns the result of [`separation`] for solids whose cores are hulls of points, without the
/// steps for curved cores. The search starts along the unit vector `start`; `None` stands for the
/// line of the centres.
pub(crate) fn flat_separation<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    limit: N,
    start: Option<&Vector<N, D>>,
) -> Option<Separation<N, D>>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let pair = CorePair::new(a, b, pose12)?.between_flat_cores();
    let start = start.copied().unwrap_or_else(|| pair.start());
    of_pair(&pair, &start, [a.rounding(), b.rounding()], limit)
}

/// Returns the result of [`separation`] for solids with a known set of possible normals of an
/// overlap. The best of these is found without growing a polytope; results are equal up to
/// rounding.
pub(crate) fn separation_by<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    limit: N,
    peaks: &dyn Peaks<N, D>,
) -> Option<Separation<N, D>>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let pair = CorePair::new(a, b, pose12)?.with_peaks(peaks);
    of_pair(&pair, &pair.start(), [a.rounding(), b.rounding()], limit)
}

/// Returns whether two solids certainly overlap. The proof is a simplex of points of the core
/// difference that contains a ball around the origin, far larger than rounding errors.
/// Alternatively it is two core points whose distance is below the sum of the radii by more than
/// the radius of that ball. `false` proves nothing; it is also returned if the depth along the line
/// of the centres is less than `min_depth`, in units of the pair.
///
/// If the result is `true`, [`separation`] returns a negative distance. Cost: about four support
/// points of each solid, until a separating plane or such a simplex is found.
pub(crate) fn overlap<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    min_depth: N,
) -> bool
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let Some(pair) = CorePair::new(a, b, pose12) else { return false };
    let radius = (a.rounding() + b.rounding()) / pair.scale();
    gjk::overlaps(&pair, &pair.start(), radius, min_depth)
}

/// Returns the `distance` of [`separation`], `None` if that is `None`, or zero if a certain
/// overlap, as defined by [`overlap`], is found during the search.
pub(crate) fn distance<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    limit: N,
) -> Option<N>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    distance_of_pair(&CorePair::new(a, b, pose12)?, [a.rounding(), b.rounding()], limit)
}

/// Returns the `distance` of [`flat_separation`], `None` if that is `None`, or zero if a certain
/// overlap, as defined by [`overlap`], is found during the search. The search starts along the line
/// of the centres.
pub(crate) fn flat_distance<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    limit: N,
) -> Option<N>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let pair = CorePair::new(a, b, pose12)?.between_flat_cores();
    distance_of_pair(&pair, [a.rounding(), b.rounding()], limit)
}

/// Returns the `distance` of [`separation_by`], `None` if that is `None`, or zero if a certain
/// overlap, as defined by [`overlap`], is found during the search.
pub(crate) fn distance_by<N, A, B, const D: usize>(
    a: &A,
    b: &B,
    pose12: &Pose<N, D>,
    limit: N,
    peaks: &dyn Peaks<N, D>,
) -> Option<N>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let pair = CorePair::new(a, b, pose12)?.with_peaks(peaks);
    distance_of_pair(&pair, [a.rounding(), b.rounding()], limit)
}

fn distance_of_pair<N, A, B, const D: usize>(
    pair: &CorePair<'_, N, A, B, D>,
    radii: [N; 2],
    limit: N,
) -> Option<N>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let radius = (radii[0] + radii[1]) / pair.scale();
    let limit = limit_of_cores(pair, radii, limit);
    Some(match gjk::answer(pair, &pair.start(), limit, Some(radius))? {
        Answer::Overlap => N::ZERO,
        Answer::Signed(found) => pair.restored(&found).rounded(radii[0], radii[1]).distance,
    })
}

fn of_pair<N, A, B, const D: usize>(
    pair: &CorePair<'_, N, A, B, D>,
    start: &Vector<N, D>,
    radii: [N; 2],
    limit: N,
) -> Option<Separation<N, D>>
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let found = gjk::solve(pair, start, limit_of_cores(pair, radii, limit))?;
    Some(pair.restored(&found).rounded(radii[0], radii[1]))
}

/// Returns the limit for the distance of the cores, in units of the pair, raised by the rounding
/// error.
fn limit_of_cores<N, A, B, const D: usize>(
    pair: &CorePair<'_, N, A, B, D>,
    radii: [N; 2],
    limit: N,
) -> N
where
    N: Simplicial<D>,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    let core_limit = (limit + radii[0] + radii[1]) / pair.scale();
    let slack = rounding_error::<N>() * (N::ONE + core_limit.abs());
    core_limit + slack
}
