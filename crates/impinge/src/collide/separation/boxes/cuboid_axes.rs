//! Separating axis test of two boxes in 3D.
//!
//! Gottschalk, Lin and Manocha, "`OBBTree`" (1996): two boxes are apart iff one of 15 directions
//! separates them; if none does, the shortest separating translation is along the direction with
//! the least overlap.
//!
//! ```text
//!   Face1(i)       axis i of box 1                    3 directions
//!   Face2(j)       axis j of box 2                    3
//!   Edges(i, j)    axis i of box 1 x axis j of box 2  9; nearly parallel axes are skipped
//! ```
//!
//! The 8-pair form of this test is in `collide/batch/boxes/`.

use crate::math::{Matrix, Pose, Real, Vector, cross, max, min};

/// Two boxes, the second at `pose12` in the frame of the first.
pub(crate) struct BoxPair<N: Real> {
    /// Half extents of the first box.
    pub(crate) half1: Vector<N, 3>,
    /// Half extents of the second box.
    pub(crate) half2: Vector<N, 3>,
    pub(crate) pose12: Pose<N, 3>,
}

/// One of the 15 directions of the test. The indices number the axes of the boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AxisKind {
    /// The normal of a face of the first box.
    Face1(usize),
    /// The normal of a face of the second box.
    Face2(usize),
    /// The common perpendicular of an edge of each box, along these axes.
    Edges(usize, usize),
}

/// Unit vector from the first box to the second, and the signed gap along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BoxAxis<N: Real> {
    pub(crate) kind: AxisKind,
    /// Unit vector from the first box to the second, in the frame of the first.
    pub(crate) normal: Vector<N, 3>,
    /// Signed distance along the normal; negative for an overlap.
    pub(crate) gap: N,
}

impl<N: Real> BoxPair<N> {
    /// Returns the length that counts as rounding error for this pair.
    pub(crate) fn rounding_error(&self) -> N {
        let size = self.half1.sum() + self.half2.sum() + self.pose12.translation.amax();
        N::lit(4.0) * N::EPSILON * size
    }

    /// Returns an axis of the second box in the frame of the first.
    pub(crate) fn axis2(&self, axis: usize) -> Vector<N, 3> {
        self.pose12.rotation.column(axis).into_owned()
    }

    /// Returns the direction of the largest gap. In a tie, faces of the first box come before faces
    /// of the second. A pair of edges is chosen only if its gap exceeds that of the best face by
    /// more than rounding, because faces give better points.
    pub(crate) fn best_axis(&self) -> BoxAxis<N> {
        let abs_rotation = self.pose12.rotation.abs();
        let (face, gap) = self.best_face(&abs_rotation);
        match self.best_edges(&abs_rotation, max(gap + self.rounding_error(), gap)) {
            Some((edges, gap)) => self.axis(edges, gap),
            None => self.axis(face, gap),
        }
    }

    /// Returns the face normal with the largest gap; `abs_rotation` holds the absolute values of
    /// the rotation matrix.
    fn best_face(&self, abs_rotation: &Matrix<N, 3>) -> (AxisKind, N) {
        let (t, mut best, mut gap) = (&self.pose12.translation, AxisKind::Face1(0), N::ZERO);
        for i in 0..3 {
            let extent2 = (0..3).fold(N::ZERO, |sum, j| sum + abs_rotation[(i, j)] * self.half2[j]);
            let found = t[i].abs() - self.half1[i] - extent2;
            if i == 0 || found > gap {
                (best, gap) = (AxisKind::Face1(i), found);
            }
        }
        for j in 0..3 {
            let extent1 = (0..3).fold(N::ZERO, |sum, i| sum + abs_rotation[(i, j)] * self.half1[i]);
            let along = (0..3).fold(N::ZERO, |sum, i| sum + self.pose12.rotation[(i, j)] * t[i]);
            let found = along.abs() - extent1 - self.half2[j];
            if found > gap {
                (best, gap) = (AxisKind::Face2(j), found);
            }
        }
        (best, gap)
    }

    /// Returns the pair of edges with the largest gap; `None` unless the gap exceeds `least`.
    ///
    /// The length of the cross product of two axes is the sine of their angle. Dividing a negative
    /// gap by the sine can only lower it. So a pair of edges is skipped without a square root if
    /// its undivided gap is not positive and not above the largest gap so far. The components of
    /// the cross product along the axes of the second box are computed as differences of two
    /// products. They also equal entries of the rotation up to rounding. But they are small if the
    /// sine is small, and their errors are divided by the sine; the differences have smaller
    /// errors.
    fn best_edges(&self, abs_rotation: &Matrix<N, 3>, least: N) -> Option<(AxisKind, N)> {
        let (r, t) = (&self.pose12.rotation, &self.pose12.translation);
        let (mut best, mut bound) = (None, least);
        for i in 0..3 {
            let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                let along = t[i2] * r[(i1, j)] - t[i1] * r[(i2, j)];
                let extent1 =
                    self.half1[i1] * abs_rotation[(i2, j)] + self.half1[i2] * abs_rotation[(i1, j)];
                let product1 = (r[(i1, j)] * r[(i2, j1)] - r[(i2, j)] * r[(i1, j1)]).abs();
                let product2 = (r[(i1, j)] * r[(i2, j2)] - r[(i2, j)] * r[(i1, j2)]).abs();
                let extent2 = self.half2[j1] * product1 + self.half2[j2] * product2;
                let slack = along.abs() - extent1 - extent2;
                if slack <= min(bound, N::ZERO) {
                    continue;
                }
                let sine = (r[(i1, j)] * r[(i1, j)] + r[(i2, j)] * r[(i2, j)]).sqrt();
                // Parallel edges add no direction that the faces do not have.
                if sine > N::lit(16.0) * N::EPSILON && slack > bound * sine {
                    (best, bound) = (Some(AxisKind::Edges(i, j)), slack / sine);
                }
            }
        }
        best.map(|edges| (edges, bound))
    }

    /// Completes an axis of the given kind and gap with its unit vector, which points from the
    /// first box to the second.
    fn axis(&self, kind: AxisKind, gap: N) -> BoxAxis<N> {
        let direction = match kind {
            AxisKind::Face1(axis) => Vector::<N, 3>::ith(axis, N::ONE),
            AxisKind::Face2(axis) => self.axis2(axis),
            AxisKind::Edges(axis1, axis2) => {
                let across = cross(&Vector::<N, 3>::ith(axis1, N::ONE), &self.axis2(axis2));
                across / across.norm()
            }
        };
        let towards = direction.dot(&self.pose12.translation);
        let normal = if towards < N::ZERO { -direction } else { direction };
        BoxAxis { kind, normal, gap }
    }
}
