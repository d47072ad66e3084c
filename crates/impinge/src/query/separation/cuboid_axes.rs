//! The separating axis test of two boxes in space.
//!
//! Gottschalk, Lin and Manocha, "`OBBTree`" (1996): two boxes are apart iff one of 15 directions says
//! so, and if not, the one that says so least badly is the direction of the shortest way out.

use crate::math::{Pose, Real, Vector, cross, max};

/// Two boxes, the second placed in the frame of the first.
pub(super) struct Boxes<N: Real> {
    pub(super) half1: Vector<N, 3>,
    pub(super) half2: Vector<N, 3>,
    pub(super) pose12: Pose<N, 3>,
}

/// Which of the 15 directions it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AxisKind {
    /// The normal of a face of the first box.
    Face1(usize),
    /// The normal of a face of the second box.
    Face2(usize),
    /// Perpendicular to an edge of each.
    Edges(usize, usize),
}

/// A unit direction from the first box to the second, and the gap it leaves between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BoxAxis<N: Real> {
    pub(super) kind: AxisKind,
    pub(super) normal: Vector<N, 3>,
    pub(super) gap: N,
}

impl<N: Real> Boxes<N> {
    /// What arithmetic on these numbers cannot resolve.
    pub(super) fn noise(&self) -> N {
        let size = self.half1.sum() + self.half2.sum() + self.pose12.translation.amax();
        N::lit(4.0) * N::EPSILON * size
    }

    /// An axis of the second box in the frame of the first.
    pub(super) fn axis2(&self, axis: usize) -> Vector<N, 3> {
        self.pose12.rotation.column(axis).into_owned()
    }

    /// The gap along a unit direction, turned to point from the first box to the second.
    fn along(&self, kind: AxisKind, direction: Vector<N, 3>) -> BoxAxis<N> {
        let towards = direction.dot(&self.pose12.translation);
        let normal = if towards < N::ZERO { -direction } else { direction };
        let in_second = self.pose12.inverse_vector(&direction);
        let reach1 = direction.abs().dot(&self.half1);
        let reach2 = in_second.abs().dot(&self.half2);
        BoxAxis { kind, normal, gap: towards.abs() - reach1 - reach2 }
    }

    /// The direction of the largest gap. Faces of the first box come before those of the second, and
    /// an edge pair must beat the best face by more than rounding: faces give better points.
    pub(super) fn best_axis(&self) -> BoxAxis<N> {
        let unit_axis = |axis: usize| Vector::<N, 3>::ith(axis, N::ONE);
        let mut best = self.along(AxisKind::Face1(0), unit_axis(0));
        for axis in 1..3 {
            best = better(best, self.along(AxisKind::Face1(axis), unit_axis(axis)), N::ZERO);
        }
        for axis in 0..3 {
            best = better(best, self.along(AxisKind::Face2(axis), self.axis2(axis)), N::ZERO);
        }
        let noise = self.noise();
        let mut best_edges: Option<BoxAxis<N>> = None;
        for (axis1, axis2) in (0..9).map(|pair| (pair / 3, pair % 3)) {
            let Some(direction) = self.edge_direction(axis1, axis2) else { continue };
            let found = self.along(AxisKind::Edges(axis1, axis2), direction);
            best_edges = Some(best_edges.map_or(found, |best| better(best, found, N::ZERO)));
        }
        best_edges.map_or(best, |edges| better(best, edges, noise))
    }

    /// The unit direction perpendicular to an edge of each box; `None` for parallel edges, where
    /// the faces suffice.
    fn edge_direction(&self, axis1: usize, axis2: usize) -> Option<Vector<N, 3>> {
        let across = cross(&Vector::<N, 3>::ith(axis1, N::ONE), &self.axis2(axis2));
        let sine = across.norm();
        (sine > N::lit(16.0) * N::EPSILON).then(|| across / sine)
    }
}

/// `other` if it leaves a gap larger by more than `margin`.
fn better<N: Real>(best: BoxAxis<N>, other: BoxAxis<N>, margin: N) -> BoxAxis<N> {
    if other.gap > max(best.gap + margin, best.gap) { other } else { best }
}
