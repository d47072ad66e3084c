//! Forward kinematics of 8 configurations at a time, one in each SIMD lane.
//!
//! ```text
//!   frames   world ── a (fixed) ── b (turns) ── c (fixed) ── d (slides)
//!   nodes    world ─────────────── b ─────────────────────── d            a and c are constant poses on a node
//!   rows     rotation[column][row][lane], translation[row][lane]          one block for each node
//! ```
//!
//! The rotation by an angle θ with the generator K is I + sin θ K + (1 - cos θ) K² (O. Rodrigues),
//! in 2D as in 3D. So the rotation of a joint in its parent's frame is A + sin θ B + cos θ C with
//! constant matrices A, B, C.

use super::joint::{Frame, JointMotion};
use crate::math::lanes::{bits, load, plus};
use crate::math::simd::Simd;
use crate::math::trigonometry::sine_cosine;
use crate::math::{Matrix, Pose, Real, Vector, Wide, filled};

/// The number of configurations that are computed at once.
pub(super) const LANES: usize = 8;

/// A number for each of 8 configurations, one per lane.
pub(super) type LaneRow<N> = [N; LANES];

/// The poses of a frame in 8 configurations, one per lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseRows<N, const D: usize> {
    /// The rotation matrix, column by column.
    rotation: [[LaneRow<N>; D]; D],
    translation: [LaneRow<N>; D],
}

/// A frame with a moving joint. Its parent is another node or the world; frames with fixed joints
/// in between are merged into `origin`.
#[derive(Clone, Debug)]
pub(super) struct Node<N: Real, const D: usize> {
    /// The index of the parent's block of rows: 0 is the world, and the block of node `i` is `i +
    /// 1`.
    pub(super) parent: usize,
    /// The position of the node's joint in the parent's frame.
    pub(super) origin: Vector<N, D>,
    rotation: Swing<N, D>,
}

/// The motion of a node as a function of its joint value.
#[derive(Clone, Debug)]
enum Swing<N: Real, const D: usize> {
    /// A revolute joint: the matrices A, B and C of its rotation.
    Turn([Matrix<N, D>; 3]),
    /// A prismatic joint: its constant rotation, and the unit direction of its slide in the
    /// parent's frame.
    Slide(Matrix<N, D>, Vector<N, D>),
}

impl<N: Real, const D: usize> Node<N, D> {
    /// Creates the node of a frame whose joint is at `origin` in the frame of the parent node;
    /// `None` for a fixed joint.
    pub(super) fn new(parent: usize, origin: &Pose<N, D>, frame: &Frame<N, D>) -> Option<Self> {
        let rotation = origin.rotation;
        let rotation = match frame.joint.motion {
            JointMotion::Fixed => return None,
            JointMotion::Slide(axis) => Swing::Slide(rotation, rotation * axis),
            JointMotion::Turn(generator) => {
                let squared = generator * generator;
                let still = rotation * (Matrix::<N, D>::identity() + squared);
                Swing::Turn([still, rotation * generator, rotation * -squared])
            }
        };
        Some(Self { parent, origin: origin.translation, rotation })
    }

    /// Returns the node's rotation in its parent's frame if it is constant, as for a prismatic
    /// joint; else `None`.
    pub(super) const fn constant_rotation(&self) -> Option<Matrix<N, D>> {
        match &self.rotation {
            Swing::Slide(rotation, _) => Some(*rotation),
            Swing::Turn(_) => None,
        }
    }

    /// Returns whether the joint is prismatic. Its value is then a length.
    pub(super) const fn slides(&self) -> bool {
        matches!(self.rotation, Swing::Slide(..))
    }

    /// Converts the node to `f32`. If its parent is the world, subtracts `shift` from its origin.
    pub(super) fn in_f32(&self, shift: &Vector<N, D>) -> Node<f32, D> {
        let origin = if self.parent == 0 { self.origin - shift } else { self.origin };
        let rotation = match &self.rotation {
            Swing::Turn(parts) => Swing::Turn(parts.map(|part| part.map(N::as_f32))),
            Swing::Slide(rotation, axis) => {
                Swing::Slide(rotation.map(N::as_f32), axis.map(N::as_f32))
            }
        };
        Node { parent: self.parent, origin: origin.map(N::as_f32), rotation }
    }

    /// Returns column `column` of the node's rotation in its parent's frame in each lane, from the
    /// sine and the cosine of the joint value.
    #[inline(always)]
    fn column<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        column: usize,
        [sine, cosine]: &[V; 2],
    ) -> [V; D] {
        let all = |matrix: &Matrix<N, D>, row: usize| V::all(simd, matrix[(row, column)]);
        filled(
            #[inline(always)]
            |row| match &self.rotation {
                Swing::Slide(rotation, _) => all(rotation, row),
                Swing::Turn([still, with_sine, with_cosine]) => {
                    (all(still, row) + *sine * all(with_sine, row))
                        + *cosine * all(with_cosine, row)
                }
            },
        )
    }

    /// Returns the node's position in its parent's frame in each lane; `number` is the joint value.
    #[inline(always)]
    fn position<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, number: V) -> [V; D] {
        filled(
            #[inline(always)]
            |row| {
                let origin = V::all(simd, self.origin[row]);
                match &self.rotation {
                    Swing::Slide(_, axis) => origin + V::all(simd, axis[row]) * number,
                    Swing::Turn(_) => origin,
                }
            },
        )
    }
}

impl<N: Real, const D: usize> PoseRows<N, D> {
    /// Returns the identity in all lanes: the block of the world, and the initial value of other
    /// blocks.
    pub(super) fn identity() -> Self {
        let mut rows =
            Self { rotation: [[[N::ZERO; LANES]; D]; D], translation: [[N::ZERO; LANES]; D] };
        rows.rotation
            .iter_mut()
            .enumerate()
            .for_each(|(axis, column)| column[axis] = [N::ONE; LANES]);
        rows
    }

    /// Returns the pose in one lane.
    pub(super) fn pose(&self, lane: usize) -> Pose<N, D> {
        Pose {
            rotation: Matrix::<N, D>::from_fn(|row, column| self.rotation[column][row][lane]),
            translation: Vector::<N, D>::from_fn(|row, _| self.translation[row][lane]),
        }
    }

    /// Rotates a local direction in each lane to the outer frame.
    #[inline(always)]
    fn vector<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, local: &[V; D]) -> [V; D] {
        filled(
            #[inline(always)]
            |row| {
                let mut sum = V::load(simd, &self.rotation[0][row]) * local[0];
                for (column, &x) in local.iter().enumerate().skip(1) {
                    sum += V::load(simd, &self.rotation[column][row]) * x;
                }
                sum
            },
        )
    }

    /// Transforms a local point in each lane to the outer frame.
    #[inline(always)]
    pub(super) fn point<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, local: &[V; D]) -> [V; D] {
        plus(&self.vector(simd, local), &load(simd, &self.translation))
    }

    /// Transforms 8 local points by the pose in one lane to the outer frame.
    #[inline(always)]
    pub(super) fn points_in<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        lane: usize,
        local: &[V; D],
    ) -> [V; D] {
        filled(
            #[inline(always)]
            |row| {
                let mut sum = V::all(simd, self.rotation[0][row][lane]) * local[0];
                for (column, &x) in local.iter().enumerate().skip(1) {
                    sum += V::all(simd, self.rotation[column][row][lane]) * x;
                }
                sum + V::all(simd, self.translation[row][lane])
            },
        )
    }

    /// Returns a bit mask of the lanes in which the position is at most `most` in magnitude on each
    /// axis and the rotation is finite.
    #[inline(always)]
    pub(super) fn lanes_within<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, most: N) -> u8 {
        let most = V::all(simd, most);
        // A NaN or infinite angle makes the whole rotation NaN, so one of its numbers suffices.
        let mut within = V::load(simd, &self.rotation[0][0]).abs().simd_le(most);
        for axis in 0..D {
            within &= V::load(simd, &self.translation[axis]).abs().simd_le(most);
        }
        bits(within)
    }
}

/// Computes the poses of all nodes for 8 configurations. `numbers` has one row of joint values for
/// each node. `rows` has the block of the world, followed by one block for each node.
#[inline(always)]
pub(super) fn forward<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    nodes: &[Node<N, D>],
    numbers: &[LaneRow<N>],
    rows: &mut [PoseRows<N, D>],
) {
    for (index, node) in nodes.iter().enumerate() {
        let number = V::load(simd, &numbers[index]);
        let swing = if node.slides() { [number; 2] } else { sine_cosine(simd, number) };
        let (before, own) = rows.split_at_mut(index + 1);
        let (parent, own) = (&before[node.parent], &mut own[0]);
        // If the parent is the world, the product with the identity is skipped. The result is
        // bitwise equal.
        let is_inner = node.parent != 0;
        for column in 0..D {
            let inner = node.column(simd, column, &swing);
            let outer = if is_inner { parent.vector(simd, &inner) } else { inner };
            store(&outer, &mut own.rotation[column]);
        }
        let inner = node.position(simd, number);
        let outer = if is_inner { parent.point(simd, &inner) } else { inner };
        store(&outer, &mut own.translation);
    }
}

/// Stores the vector of each lane, one row for each coordinate.
#[inline(always)]
pub(super) fn store<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    from: &[V; D],
    to: &mut [LaneRow<N>; D],
) {
    for axis in 0..D {
        from[axis].store(&mut to[axis]);
    }
}
