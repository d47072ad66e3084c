//! The best normal of two overlapping cores, for pairs whose possible normals are known.

use smallvec::SmallVec;

use super::Separation;
use super::candidate::SupportCandidate;
use super::difference::{Difference, Vertex};
use super::polish::polish;
use super::simplex::Simplicial;
use super::witness::{locate, placed};
use crate::math::{Real, Vector};

/// Best normal of two overlapping cores, in the frame of the first and in units of the pair.
#[derive(Clone, Debug)]
pub(crate) struct Peak<N: Real, const D: usize> {
    /// Unit vector from the first core to the second. No other normal has a height larger by more
    /// than the requested gap.
    pub(crate) normal: Vector<N, D>,
    /// Whether `normal` is the normal of a flat face. No normal close to it is then slightly
    /// better.
    pub(crate) is_exact: bool,
    /// Whether `normal` belongs to the ring of normals of a round side, where another normal may be
    /// slightly better.
    pub(crate) is_ring: bool,
    /// Points of the first core. Some weighted mean of these points faces some weighted mean of
    /// `on2` along `normal`.
    pub(crate) on1: SmallVec<[Vector<N, D>; 8]>,
    /// Points of the second core.
    pub(crate) on2: SmallVec<[Vector<N, D>; 8]>,
}

/// Two cores with a known set of possible normals of an overlap.
pub(crate) trait Peaks<N: Real, const D: usize> {
    /// Returns a normal whose height is the largest up to `gap`; `None` leaves the choice to a
    /// search. The result is in units of the pair: lengths are multiplied by `shrink`.
    fn best(&self, shrink: N, gap: N) -> Option<Peak<N, D>>;
}

/// Returns the separation along the normal of `peak`, which Newton's method refines unless it is
/// exact.
pub(super) fn at_peak<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    peak: &Peak<N, D>,
) -> Separation<N, D> {
    let mut best = SupportCandidate::along(difference, peak.normal);
    let mut vertices = SmallVec::<[Vertex<N, D>; 16]>::new();
    for on1 in &peak.on1 {
        let of = |on2: &Vector<N, D>| Vertex { point: on2 - on1, on1: *on1, on2: *on2 };
        vertices.extend(peak.on2.iter().map(of));
    }
    let polished = if peak.is_exact { None } else { polish(difference, &mut best, &vertices) };
    match polished {
        Some(mix) => placed(&best, &mix, N::HALF),
        None => {
            vertices.push(best.vertex);
            locate(difference, &best, &vertices)
        }
    }
}
