//! Finds the point of the difference of two cores that is nearest to the origin.
//!
//! ```text
//!              difference                upper = |nearest point of the simplex|
//!           .-------.                    along = nearest / upper, the next normal
//!    o - - -|*      |                    lower = height of `along`: its lowest support point
//!      lower '.     |                    upper - lower <= gap: done
//!             '-----'
//! ```
//!
//! E. Gilbert, D. Johnson and S. Keerthi, "A Fast Procedure for Computing the Distance Between
//! Complex Objects in Three-Dimensional Space" (1988). Stopping on the gap between the bounds
//! follows G. van den Bergen, "A Fast and Robust GJK Implementation for Collision Detection of
//! Convex Objects" (1999).

use smallvec::SmallVec;

use super::Separation;
use super::candidate::SupportCandidate;
use super::difference::{Difference, rounding_error, tolerance};
use super::newton::converges;
use super::polish::{lowest, polish};
use super::refine::{Bundle, refine};
use super::simplex::{NearestOfSimplex, Simplex, Simplicial};
use super::witness::{Mix, finish, locate, placed};
use crate::math::{Real, Vector, max, unit_or};

/// Cap on the number of support points. Flat faces take about six, curved ones up to about thirty.
/// A search that ends at the cap is refined from the best normal so far.
const ROUNDS: usize = 64;

/// Radius of the ball around the origin that proves a certain overlap, in units of the pair: 2⁻¹⁰,
/// far larger than rounding errors.
const CLEAR: f64 = 1.0 / 1024.0;

/// The reason why [`GjkSearch::run`] ended.
enum Outcome {
    /// A plane separates the difference from the origin by more than the limit.
    Beyond,
    /// The difference contains the origin or is nearer to it than the rounding error, or a
    /// coordinate is NaN.
    Overlap,
    /// The nearest point is found, rounding prevents a nearer one, or the search has reached its
    /// cap.
    Apart,
    /// A point of the difference is nearer to the origin than `near`.
    Near,
}

/// State of a search for the nearest point.
struct GjkSearch<N: Real, const D: usize> {
    simplex: Simplex<N, D>,
    /// Best normal so far; its height is the largest lower bound of the distance.
    best: SupportCandidate<N, D>,
    /// Normal of the nearest point so far.
    last: SupportCandidate<N, D>,
    /// Length of the nearest point so far: an upper bound of the distance.
    upper: N,
    /// Gap between upper and lower bound at which the search stops.
    gap: N,
    /// Whether the search stops on the height of `last`, whose points face each other, instead of
    /// on the height of `best`.
    for_points: bool,
    /// The search ends with [`Outcome::Near`] at a point whose distance from the origin is below
    /// this value; never if the value is not positive.
    near: N,
}

/// Result of a search for two cores.
pub(super) enum Answer<N: Real, const D: usize> {
    Signed(Separation<N, D>),
    /// The cores, inflated by their radii, certainly overlap; the depth is not computed.
    Overlap,
}

/// Returns the separation of the difference from the origin, in units of the pair, searched from
/// the unit vector `start`; `None` if a plane proves that the distance is above `limit`.
pub(super) fn solve<N, S, const D: usize>(
    difference: &S,
    start: &Vector<N, D>,
    limit: N,
) -> Option<Separation<N, D>>
where
    N: Simplicial<D>,
    S: Difference<N, D>,
{
    match answer(difference, start, limit, None)? {
        Answer::Signed(found) => Some(found),
        Answer::Overlap => unreachable!("nobody was content with an overlap"),
    }
}

/// Returns the result of [`solve`]. If `rounding`, the sum of both radii, is `Some`, the search
/// ends at a certain overlap of the inflated cores (see [`overlaps`]). An [`Answer::Signed`] equals
/// the result of [`solve`] bit for bit. `None` if [`solve`] returns `None`.
pub(super) fn answer<N, S, const D: usize>(
    difference: &S,
    start: &Vector<N, D>,
    limit: N,
    rounding: Option<N>,
) -> Option<Answer<N, D>>
where
    N: Simplicial<D>,
    S: Difference<N, D>,
{
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    search.near = rounding.map_or(N::ZERO, near);
    let mut outcome = Outcome::Apart;
    let rough: &[N] = if difference.is_flat() { &[] } else { &[coarse_gap(), rough_gap()] };
    for &gap in rough {
        search.gap = gap;
        outcome = search.run(difference, limit);
        if !matches!(outcome, Outcome::Apart) {
            break;
        }
        if let Some(polished) = search.polished(difference) {
            return (polished.distance <= limit).then_some(Answer::Signed(polished));
        }
    }
    if matches!(outcome, Outcome::Apart) {
        search.gap = gap();
        outcome = search.run(difference, limit);
    }
    match outcome {
        Outcome::Beyond => None,
        Outcome::Near => Some(Answer::Overlap),
        Outcome::Overlap if rounding.is_some_and(|radius| search.clears(difference, radius)) => {
            Some(Answer::Overlap)
        }
        Outcome::Overlap => Some(Answer::Signed(search.finish_overlap(difference))),
        Outcome::Apart => Some(Answer::Signed(search.finish(difference))),
    }
}

/// Returns the distance of two core points below which solids with this sum of radii overlap for
/// certain.
fn near<N: Real>(rounding: N) -> N {
    rounding - N::lit(CLEAR)
}

/// Returns whether the difference inflated by `radius` certainly contains the origin. The proof is
/// a simplex that contains a ball of radius [`CLEAR`] around the origin, or a point nearer to the
/// origin than `radius − CLEAR`. Returns `false` without a search if the depth along `start` is
/// less than `min_depth`.
pub(super) fn overlaps<N, S, const D: usize>(
    difference: &S,
    start: &Vector<N, D>,
    radius: N,
    min_depth: N,
) -> bool
where
    N: Simplicial<D>,
    S: Difference<N, D>,
{
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    search.near = near(radius);
    if search.best.height > radius - min_depth {
        return false;
    }
    match search.run(difference, radius) {
        Outcome::Near => true,
        Outcome::Overlap => search.is_clear(),
        Outcome::Beyond | Outcome::Apart => false,
    }
}

/// Returns the normal of the nearest point of a difference that is well away from the origin.
pub(super) fn nearest_normal<N: Simplicial<D>, const D: usize>(
    difference: &impl Difference<N, D>,
    start: &Vector<N, D>,
) -> Vector<N, D> {
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    (search.gap, search.for_points) = (rounding_error(), false);
    search.run(difference, N::INFINITY);
    search.best.normal
}

/// Returns the result of [`nearest_normal`] to the precision of the arithmetic, and the simplex
/// whose hull contains the nearest point.
pub(super) fn nearest_simplex<N: Simplicial<D>, const D: usize>(
    difference: &impl Difference<N, D>,
    start: &Vector<N, D>,
) -> (Vector<N, D>, Simplex<N, D>) {
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    search.gap = N::ZERO;
    search.run(difference, N::INFINITY);
    (search.last.normal, search.simplex)
}

impl<N: Simplicial<D>, const D: usize> GjkSearch<N, D> {
    fn new(first: SupportCandidate<N, D>) -> Self {
        Self {
            simplex: Simplex::new(first.vertex),
            best: first,
            last: first,
            upper: N::INFINITY,
            gap: gap(),
            for_points: true,
            near: N::ZERO,
        }
    }

    /// Returns whether the difference inflated by `radius` certainly contains the origin, by the
    /// proofs of [`overlaps`]. For solids that lie symmetrically, the search along the line of
    /// their centres may end with the origin on a corner, edge or face of the simplex. Such a
    /// simplex proves nothing. A second search from a skew axis avoids this case.
    fn clears(&self, difference: &impl Difference<N, D>, radius: N) -> bool {
        self.is_clear() || overlaps(difference, &skew_axis(), radius, N::ZERO)
    }

    /// Returns whether the simplex contains a ball of radius `CLEAR` around the origin.
    fn is_clear(&self) -> bool {
        let points = self.simplex.points();
        N::nearest(points).enclosed && N::clears(points, N::lit(CLEAR))
    }

    fn run(&mut self, difference: &impl Difference<N, D>, limit: N) -> Outcome {
        let mut nearest = N::nearest(self.simplex.points());
        for _ in 0..ROUNDS {
            // Written so that NaN counts as an overlap, because the loops for overlaps end by their
            // caps.
            let away = nearest.squared > rounding_error::<N>() * rounding_error();
            if nearest.enclosed || !away {
                return Outcome::Overlap;
            }
            self.upper = nearest.squared.sqrt();
            if self.upper < self.near {
                return Outcome::Near;
            }
            let candidate = SupportCandidate::along(difference, nearest.point / self.upper);
            self.best.improve(&candidate);
            self.last = candidate;
            if self.best.height > limit {
                return Outcome::Beyond;
            }
            let proof = if self.for_points { &self.last } else { &self.best };
            let closed = self.upper - proof.height <= self.gap;
            let known = closed || self.simplex.contains(&candidate.vertex);
            match if known { None } else { self.advanced(&nearest) } {
                Some(next) => nearest = next,
                None => {
                    self.best.prefer(candidate, N::EPSILON);
                    return Outcome::Apart;
                }
            }
        }
        Outcome::Apart
    }

    /// Adds the last support point to the simplex; returns the new nearest point. `None`, and no
    /// change, if the new point is not nearer to the origin: the precision of the arithmetic is
    /// reached.
    fn advanced(&mut self, nearest: &NearestOfSimplex<N, D>) -> Option<NearestOfSimplex<N, D>> {
        self.simplex.push(self.last.vertex);
        let next = N::nearest(self.simplex.points());
        if next.squared >= nearest.squared {
            self.simplex.pop();
            return None;
        }
        self.simplex.keep(&next.weights);
        Some(next)
    }

    /// Returns whether the gap between the bounds is larger than twice the tolerance.
    fn open(&self) -> bool {
        let closed = self.upper - self.best.height <= N::TWO * tolerance();
        !closed
    }

    /// Returns whether the bounds agree up to rounding. Slivers give poor nearest points, so
    /// rounding may also put the upper bound below the lower.
    fn met(&self) -> bool {
        (self.upper - self.best.height).abs() <= N::TWO * gap()
    }

    /// Returns the separation from the simplex, refined first if the bounds do not agree. They do
    /// not agree near touching, where the direction of the nearest point is mostly rounding error,
    /// and if one solid is much larger than the other. If the refined bounds still differ, runs
    /// EPA, too, and returns the result with the larger distance.
    fn finish(&mut self, difference: &dyn Difference<N, D>) -> Separation<N, D> {
        if self.met() {
            return self.final_separation(difference);
        }
        let mut bundle: Bundle<N, D> = SmallVec::from_slice(self.simplex.vertices());
        if converges(difference, &mut self.best) {
            bundle.push(self.best.vertex);
            return locate(difference, &self.best, &bundle);
        }
        bundle.extend([self.best.vertex, self.last.vertex]);
        refine(difference, &mut bundle, &mut self.best);
        let near = lowest(&bundle, &self.best.normal);
        let apart = match polish(difference, &mut self.best, &near) {
            Some(mix) => placed(&self.best, &mix, N::HALF),
            None => locate(difference, &self.best, &bundle),
        };
        if !self.open() {
            return apart;
        }
        let deep = N::deepest(difference, &self.simplex);
        if deep.distance > apart.distance { deep } else { apart }
    }

    /// Returns the separation if the difference contains the origin, or nearly does: from the
    /// simplex if the height of `best` is zero or more, up to rounding, since the solids then only
    /// touch; else by EPA.
    fn finish_overlap(&self, difference: &dyn Difference<N, D>) -> Separation<N, D> {
        if self.best.height >= -rounding_error::<N>() {
            return self.final_separation(difference);
        }
        N::deepest(difference, &self.simplex)
    }

    /// Returns the separation that Newton's method finds from the current normal. `None` unless the
    /// method ends at points whose distance equals the height of the normal, and this height is
    /// above the rounding error.
    fn polished(&self, difference: &dyn Difference<N, D>) -> Option<Separation<N, D>> {
        let mut best = self.best;
        let mix = polish(difference, &mut best, self.simplex.vertices())?;
        let is_apart = best.height > rounding_error();
        is_apart.then(|| placed(&best, &mix, N::HALF))
    }

    /// Returns the separation at the end of a search whose bounds agree, or whose best normal
    /// separates the difference from the origin up to rounding. The normal `last` of the nearest
    /// point replaces `best` if it is equally good up to rounding and no points were found that
    /// face each other along `best`.
    fn final_separation(&self, difference: &dyn Difference<N, D>) -> Separation<N, D> {
        let (mix, mut best) = (Mix::of(&self.simplex), self.best);
        if let Some(polished) = polish(difference, &mut best, self.simplex.vertices()) {
            return placed(&best, &polished, N::HALF);
        }
        let raised = best.height > self.best.height;
        if !raised && !mix.meets(&best) {
            // The simplex is a sliver, and the mix of its vertices does not confirm the computed
            // nearest point.
            if converges(difference, &mut best) {
                return locate(difference, &best, &[best.vertex]);
            }
            best.prefer(self.last, N::TWO * gap());
        }
        finish(difference, &best, &mix, self.simplex.vertices())
    }
}

/// Returns a unit vector whose components all differ, so that it lies in no plane of symmetry of a
/// box that is aligned with the axes.
fn skew_axis<N: Real, const D: usize>() -> Vector<N, D> {
    let mut next = N::ONE;
    let skew = Vector::<N, D>::from_fn(|_, _| {
        next *= N::lit(0.618);
        next
    });
    unit_or(&skew, skew)
}

/// Returns the gap at which Newton's method is first tried for curved cores; the method mostly
/// finds the answer from there.
fn coarse_gap<N: Real>() -> N {
    max(rough_gap(), N::lit(1.0 / 128.0))
}

/// Returns the gap at which Newton's method is tried again, if it failed at [`coarse_gap`]: 2⁻⁹ in
/// `f32`, 2⁻¹⁹ in `f64`.
fn rough_gap<N: Real>() -> N {
    N::TWO * tolerance::<N>().sqrt()
}

/// Returns the gap between the bounds of the distance at which the search stops: 2⁻²⁰ in `f32`,
/// 2⁻⁴⁶ in `f64`.
fn gap<N: Real>() -> N {
    max(rounding_error(), N::lit(1.0 / 70_368_744_177_664.0))
}
