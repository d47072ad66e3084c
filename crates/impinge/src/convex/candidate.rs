//! A normal, and the lower bound of the signed distance that it proves.

use super::difference::{Difference, Vertex};
use crate::math::{Real, Vector};

/// A unit vector from the first core to the second, and its height, which is a lower bound of the
/// signed distance of the cores.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupportCandidate<N: Real, const D: usize> {
    pub(super) normal: Vector<N, D>,
    /// `min n·b − max n·a` for this normal `n`: a lower bound of the signed distance, for any
    /// normal.
    pub(super) height: N,
    /// Point of the difference that is lowest along `normal`, at this height.
    pub(super) vertex: Vertex<N, D>,
}

impl<N: Real, const D: usize> SupportCandidate<N, D> {
    /// Makes the candidate of a unit vector: computes its support point and its height.
    #[inline]
    pub(super) fn along<S>(difference: &S, normal: Vector<N, D>) -> Self
    where
        S: Difference<N, D> + ?Sized,
    {
        let vertex = difference.lowest(&normal);
        Self { normal, height: normal.dot(&vertex.point), vertex }
    }

    /// Replaces this candidate by `other` if the height of `other` is larger; returns whether it
    /// was replaced.
    #[inline]
    pub(super) fn improve(&mut self, other: &Self) -> bool {
        let better = other.height > self.height;
        if better {
            *self = *other;
        }
        better
    }

    /// Replaces this candidate by `other` unless the height of `other` is lower by more than
    /// `slack`.
    pub(super) fn prefer(&mut self, other: Self, slack: N) {
        if other.height >= self.height - slack {
            *self = other;
        }
    }
}
