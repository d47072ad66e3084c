//! The best normal of an overlap, named by those who know where such normals can lie.

use smallvec::SmallVec;

use super::Separation;
use super::candidate::SupportCandidate;
use super::difference::{Difference, Vertex};
use super::polish::polish;
use super::simplex::Simplicial;
use super::witness::{locate, placed};
use crate::math::{Real, Vector};

/// The best normal of two cores that overlap, in the frame of the first and units of the pair.
#[derive(Clone, Debug)]
pub(crate) struct Peak<N: Real, const D: usize> {
    /// From the first core to the second: no other is better by more than was asked for.
    pub(crate) normal: Vector<N, D>,
    /// It is that of a flat face: there is none a little better beside it.
    pub(crate) is_exact: bool,
    /// It is one of a ring of normals of a round side, and others of it may be a little better.
    pub(crate) is_ring: bool,
    /// Points of each core, mixes of which lie across from each other along the normal.
    pub(crate) on1: SmallVec<[Vector<N, D>; 8]>,
    pub(crate) on2: SmallVec<[Vector<N, D>; 8]>,
}

/// Two cores of which it is known where the best normal of an overlap can lie.
pub(crate) trait Peaks<N: Real, const D: usize> {
    /// The best normal up to `gap`, in units of 1 / `shrink`; `None` leaves it to a search.
    fn best(&self, shrink: N, gap: N) -> Option<Peak<N, D>>;
}

/// The answer with the normal that was named, brought to the last digits where cores are curved.
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
