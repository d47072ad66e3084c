//! A normal and the proof of how far it separates.

use super::difference::{Difference, Vertex};
use crate::math::{Real, Vector};

/// A unit vector from the first core to the second with its certificate.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupportCandidate<N: Real, const D: usize> {
    pub(super) normal: Vector<N, D>,
    /// `min n·b − max n·a`: a lower bound of the signed distance, whatever the normal.
    pub(super) height: N,
    /// The point of the difference at that height.
    pub(super) vertex: Vertex<N, D>,
}

impl<N: Real, const D: usize> SupportCandidate<N, D> {
    /// Computes the certificate of a unit vector.
    #[inline]
    pub(super) fn along<S>(difference: &S, normal: Vector<N, D>) -> Self
    where
        S: Difference<N, D> + ?Sized,
    {
        let vertex = difference.lowest(&normal);
        Self { normal, height: normal.dot(&vertex.point), vertex }
    }

    /// Replaces this by `other` if that proves more; returns whether it did.
    #[inline]
    pub(super) fn improve(&mut self, other: &Self) -> bool {
        let better = other.height > self.height;
        if better {
            *self = *other;
        }
        better
    }

    /// Replaces this by `other` if that proves as much, up to `slack`.
    pub(super) fn prefer(&mut self, other: Self, slack: N) {
        if other.height >= self.height - slack {
            *self = other;
        }
    }
}
