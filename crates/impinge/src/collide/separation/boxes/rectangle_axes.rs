//! Separating axis test of two boxes in 2D.

use crate::collide::separation::polygons::polygon_polygon::Axis;
use crate::math::{Pose, Real, Vector};

/// Two boxes, the second at `pose12` in the frame of the first.
pub(in crate::collide::separation) struct Rectangles<N: Real> {
    pub(in crate::collide::separation) half1: Vector<N, 2>,
    pub(in crate::collide::separation) half2: Vector<N, 2>,
    pub(in crate::collide::separation) pose12: Pose<N, 2>,
}

impl<N: Real> Rectangles<N> {
    /// Returns the normal of a side with the largest gap, pointing from the first box to the
    /// second.
    ///
    /// In a tie, sides of the first box come before sides of the second, each in the order of its
    /// outline: bottom, right, top, left.
    pub(in crate::collide::separation) fn best_axis(&self) -> Axis<N> {
        let abs_rotation = self.pose12.rotation.abs();
        let offset = self.pose12.translation;
        let extents2 = abs_rotation * self.half2;
        let first = [0, 1].map(|axis| {
            let along = offset[axis];
            let is_positive = if axis == 0 { along >= N::ZERO } else { along > N::ZERO };
            let gap = along.abs() - self.half1[axis] - extents2[axis];
            (gap, rank(axis, is_positive), axis, is_positive)
        });
        let (gap, _, axis, is_positive) = better(first[0], first[1]);
        let normal = signed(Vector::<N, 2>::ith(axis, N::ONE), is_positive);
        let best = Axis { gap, normal };
        let offset2 = self.pose12.inverse_vector(&offset);
        let extents1 = abs_rotation.tr_mul(&self.half1);
        let second = [0, 1].map(|axis| {
            let along = offset2[axis];
            let is_positive = if axis == 0 { along > N::ZERO } else { along >= N::ZERO };
            let gap = along.abs() - self.half2[axis] - extents1[axis];
            // The side of the second box that faces the first is opposite to the normal.
            (gap, rank(axis, !is_positive), axis, is_positive)
        });
        let (gap, _, axis, is_positive) = better(second[0], second[1]);
        if gap <= best.gap {
            return best;
        }
        let along = self.pose12.rotation.column(axis).into_owned();
        Axis { gap, normal: signed(along, is_positive) }
    }
}

/// Returns the position of a side in the outline: 0 bottom, 1 right, 2 top, 3 left.
const fn rank(axis: usize, is_positive: bool) -> usize {
    match (axis, is_positive) {
        (0, true) => 1,
        (0, false) => 3,
        (_, true) => 2,
        (_, false) => 0,
    }
}

/// Gap, position of the side in the outline, axis, and whether the second box lies in the positive
/// direction of the axis from the first.
type FoundAxis<N> = (N, usize, usize, bool);

/// Returns the axis with the larger gap; in a tie, the axis whose side comes first in the outline.
fn better<N: Real>(one: FoundAxis<N>, other: FoundAxis<N>) -> FoundAxis<N> {
    if other.0 > one.0 || other.0 == one.0 && other.1 < one.1 { other } else { one }
}

fn signed<N: Real>(vector: Vector<N, 2>, is_positive: bool) -> Vector<N, 2> {
    if is_positive { vector } else { -vector }
}
