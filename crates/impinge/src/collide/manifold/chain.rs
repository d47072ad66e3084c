//! Contacts of a segment of a chain and a 2D solid, passed to a closure one by one instead of
//! stored in a manifold.
//!
//! The contacts equal, bit for bit, those of [`build_between`](super::build_between), without its
//! limit on their number, and of [`build_along`](super::build_along). The separations come from
//! `collide/separation/chain/`.

use super::along::extremes;
use super::frame::{Candidate, Candidates, ContactFrame, Which};
use super::interval::{FeatureInterval, Shared};
use super::witness::beside_ball;
use super::{Along, Pair, add_witness, deepest, tangents2};
use crate::collide::RawPoint;
use crate::convex::Separation;
use crate::math::{Real, Space, max};
use crate::shape::{FeatureId, Kind};

/// A segment of a chain and a solid other than a half-space, in canonical order: the solid comes
/// first if it is a ball or a segment.
pub(crate) struct SegmentPair<'a, N: Real> {
    /// The two solids, in the frame of the first.
    pub(crate) pair: Pair<'a, N, 2>,
    /// Largest length that counts as a rounding error.
    pub(crate) tolerance: N,
    /// Points beyond this distance are not visited.
    pub(crate) prediction: N,
}

impl<N: Real> SegmentPair<'_, N> {
    /// Returns the feature of the chain's segment that the separation's point lies on. `None` with
    /// a ball if the point is at both ends of the segment, up to rounding.
    pub(crate) fn touched(&self, found: &Separation<N, 2>) -> Option<FeatureId> {
        if let Kind::Ball(_) = self.pair.first {
            return beside_ball(&self.pair, found);
        }
        let frame = self.frame(found);
        let own = match self.pair.second {
            Kind::Segment(_) => self.second(&frame)?,
            _ => self.first(&frame)?,
        };
        Some(own.at_witness(&frame))
    }

    /// Visits the contacts of the two solids, whose separation is `witness`. There are none if its
    /// distance is beyond the prediction, NaN or infinite. Returns `None` if a supporting feature
    /// is neither a corner nor a side or, for a ball, if [`Self::touched`] returns `None`.
    pub(crate) fn between(
        &self,
        witness: &Separation<N, 2>,
        mut visit: impl FnMut(RawPoint<N, 2>),
    ) -> Option<()> {
        if !(witness.distance <= self.prediction && witness.distance.is_finite_number()) {
            return Some(());
        }
        if let Kind::Ball(_) = self.pair.first {
            let touched = beside_ball(&self.pair, witness)?;
            visit(Candidate::alone(witness, [FeatureId::Face(0), touched]).with_id(0));
            return Some(());
        }
        let frame = self.frame(witness);
        let (first, second) = (self.first(&frame)?, self.second(&frame)?);
        let mut candidates = Candidates::new();
        if first.is_side && second.is_side {
            Shared { frame: &frame, first: &first, second: &second }.candidates(&mut candidates);
        }
        let level = witness.distance + self.tolerance;
        if !candidates.iter().any(|candidate| candidate.distance <= level) {
            let parts = [first.at_witness(&frame), second.at_witness(&frame)];
            add_witness(&frame.witness, parts, &mut candidates);
        }
        // The smallest distance is exactly that of the separation.
        let nearest = deepest(&candidates, level);
        candidates[nearest].distance = witness.distance;
        candidates.iter().for_each(|candidate| visit(candidate.with_id(0)));
        Some(())
    }

    /// Visits the contacts along the normal of `along`. Returns `None` if a supporting feature is
    /// neither a corner nor a side.
    pub(crate) fn along(
        &self,
        along: &Along<N, 2>,
        mut visit: impl FnMut(RawPoint<N, 2>),
    ) -> Option<()>
    where
        N: Space<2>,
    {
        let frame = self.frame(&extremes(&self.pair, &along.normal, None)?);
        let (first, second) = (self.first(&frame)?, self.second(&frame)?);
        let shared = Shared { frame: &frame, first: &first, second: &second };
        let (mut candidates, tolerance) = (Candidates::new(), self.tolerance);
        let (at1, at2) = (&first.corners[0], &second.corners[0]);
        match (first.is_side, second.is_side) {
            (true, true) => shared.candidates(&mut candidates),
            (false, false) => {
                if (at1.flat - at2.flat).norm() <= N::TWO * tolerance {
                    let parts = [at1.id, at2.id];
                    shared.push_pair(&at1.point, &at2.point, parts, &mut candidates);
                }
            }
            (false, true) => {
                if let Some(on) = second.locate(at1.flat.x, tolerance) {
                    let under = second.under(at1.flat.x);
                    shared.push_pair(&at1.point, &under, [at1.id, on], &mut candidates);
                }
            }
            (true, false) => {
                if let Some(on) = first.locate(at2.flat.x, tolerance) {
                    let under = first.under(at2.flat.x);
                    shared.push_pair(&under, &at2.point, [on, at2.id], &mut candidates);
                }
            }
        }
        // Points nearer than `least` by more than rounding lie beside the face, below its plane,
        // and are dropped.
        let kept = candidates.iter().filter(|found| found.distance >= along.least - tolerance);
        for candidate in kept {
            let point = candidate.with_id(0);
            visit(RawPoint { distance: max(point.distance, along.least), ..point });
        }
        Some(())
    }

    fn frame(&self, witness: &Separation<N, 2>) -> ContactFrame<N, 2> {
        ContactFrame::known(witness, tangents2(&witness.normal), self.tolerance, self.prediction)
    }

    /// Returns the supporting feature of the first solid; `None` if it is neither a corner nor a
    /// side.
    #[inline]
    fn first(&self, frame: &ContactFrame<N, 2>) -> Option<FeatureInterval<N>> {
        match self.pair.first {
            Kind::Segment(segment) => Some(FeatureInterval::of_segment(segment, frame)),
            other => FeatureInterval::of(Which::First, other, None, frame),
        }
    }

    #[inline]
    fn second(&self, frame: &ContactFrame<N, 2>) -> Option<FeatureInterval<N>> {
        FeatureInterval::of(Which::Second, self.pair.second, Some(&self.pair.pose12), frame)
    }
}
