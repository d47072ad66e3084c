//! Algorithms on convex sets, known by their support points: no shapes, no pairs, no state.
//!
//! [`separation`] gives the signed distance of two rounded convex solids. They
//! run on the cores: the difference of the cores (all `b − a`) is searched for its point nearest to
//! the origin ([`gjk`]) or, where it holds the origin, for its nearest supporting plane (`epa2`,
//! `epa3`). A normal `n` is never trusted for how it was found, but for its *certificate*: the
//! height `h(n) = min n·b − max n·a`, by two support points, up to which `n` separates the cores.
//! The signed distance is the largest height over all unit vectors. Where the cores are curved and say
//! how, Newton's method brings the last digits (`polish`).
//!
//! All this happens in units in which the pair is about 1 large (`difference`), reached by an exact
//! power of two; so every tolerance is a plain multiple of the machine epsilon, and scaling both
//! solids by a power of two scales the answer bit by bit.
//!
//! [`gjk`] and `epa` find a normal from nothing; `refine` (support points), `climb` (apart from each other),
//! `newton` and `polish` (curvature) and `side` (the ring of a round side) find a better normal near a good one;
//! `witness` finds the points that belong to it. Every loop has a cap, and the answer at the cap is certified
//! like any other.

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
use difference::{CorePair, noise};
use gjk::Answer;

/// The signed distance of two rounded solids, its normal and the points it lies between, in the
/// frame of the first; `pose12` is the pose of the second in that frame.
///
/// `None` if the solids are certainly farther apart than `limit`: a plane was found that shows it,
/// by more than rounding errors. At a distance of just `limit` the answer is `Some`; with an
/// infinite limit it always is, for finite input. Not a number anywhere in the pose gives `None`.
///
/// `distance` is the certificate of `normal`. With `s` the sum of the reaches of the cores and of
/// the distance of their origins, it falls short of the exact signed distance by a few
/// `N::EPSILON · s` for cores with flat faces and for curved ones that say how they bend
/// ([`SupportMap::curved_support`]); for others that are curved by about the larger of that and
/// `2⁻⁴⁰ · s`; where a whole ring of normals is nearly as good, as deep in nearly coaxial cylinders or cones, the
/// ring of a round side is searched ([`SupportMap::round_side`]), and only where that is none and all around is
/// about as good, as in the middle of a ball, a local search ends the work, which may fall short by more. The
/// points lie on the cores to the same accuracy, on curved ones that do not say how they bend to about its
/// square root at worst.
/// Where several normals are equally good (coincident centres, say) one is picked, the
/// same each time. Cores that are single coincident points have no direction at all: the first
/// axis is taken.
///
/// Costs about ten support points of each solid where the cores are apart, a few dozen where they
/// overlap; at most some hundreds.
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

/// [`separation`] of solids whose cores have neither edges nor rims, but that one may be a segment: the best normal
/// of an overlap is found in fewer steps.
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

/// [`separation`] of solids whose cores are hulls of points, which is found the same way but for all
/// that is done about curved ones. The search starts along a unit vector, if one is given.
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

/// [`separation`] of solids of which it is known where the best normal of an overlap can lie: that is found
/// without growing a polytope, and the same up to rounding.
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

/// Whether two solids certainly overlap: points of the difference of their cores span a simplex that holds
/// a ball around the origin, of a size that no rounding comes near, or points of the cores are nearer to each
/// other than their rounding by as much. `false` says nothing, and is the answer where the way out along the
/// line of their middles is shorter than `min_depth`, in units of the pair.
///
/// Where it is `true`, [`separation`] gives a negative distance. Costs as many support points as it takes to
/// find a separating plane or such a simplex, about four.
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

/// The distance in [`separation`] of two solids, or zero if they certainly overlap, as [`overlap`] finds it on
/// the way.
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

/// The distance in [`flat_separation`], or zero if the solids certainly overlap, as [`distance`].
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

/// The distance in [`separation_by`], or zero if the solids certainly overlap, as [`distance`].
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

/// A limit of the solids as one of their cores, in units of the pair.
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
    let slack = noise::<N>() * (N::ONE + core_limit.abs());
    core_limit + slack
}
