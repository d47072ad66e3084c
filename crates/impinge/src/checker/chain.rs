//! Forward kinematics of eight configurations at a time.
//!
//! ```text
//!   frames   world ── a (fixed) ── b (turns) ── c (fixed) ── d (slides)
//!   nodes    world ─────────────── b ─────────────────────── d            a and c are constant poses on a node
//!   rows     rotation[column][row][lane], translation[row][lane]          one block for each node
//! ```
//!
//! The rotation by an angle θ with the generator K is I + sin θ K + (1 - cos θ) K² (O. Rodrigues), in 2D as in 3D. So
//! a joint's rotation in its parent is A + sin θ B + cos θ C with constant matrices.

use super::joint::{Frame, JointMotion};
use crate::math::lanes::{LanePose, by_axis, plus, times};
use crate::math::simd::Simd;
use crate::math::trigonometry::sine_cosine;
use crate::math::{Matrix, Pose, Real, Vector, Wide};

/// How many configurations are treated at once.
pub(super) const LANES: usize = 8;

/// A number for each of eight configurations.
pub(super) type LaneRow<N> = [N; LANES];

/// Poses in eight lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseRows<N, const D: usize> {
    /// By columns of the matrix.
    rotation: [[LaneRow<N>; D]; D],
    translation: [LaneRow<N>; D],
}

/// A frame that moves, on another or on the world.
#[derive(Clone, Debug)]
pub(super) struct Node<N: Real, const D: usize> {
    /// Which block of rows it moves on: 0 is the world, its own is one more than its index.
    pub(super) parent: usize,
    /// Where its joint is on the parent.
    pub(super) origin: Vector<N, D>,
    rotation: Swing<N, D>,
}

/// What a number does to a node.
#[derive(Clone, Debug)]
enum Swing<N: Real, const D: usize> {
    /// A, B and C of the rotation.
    Turn([Matrix<N, D>; 3]),
    /// The constant rotation, and the shift in the parent.
    Slide(Matrix<N, D>, Vector<N, D>),
}

impl<N: Real, const D: usize> Node<N, D> {
    /// A frame with a joint that moves, `origin` being that on the parent node; `None` without motion.
    pub(super) fn new(parent: usize, origin: &Pose<N, D>, frame: &Frame<N, D>) -> Option<Self> {
        let turned = origin.rotation;
        let rotation = match frame.joint.motion {
            JointMotion::Fixed => return None,
            JointMotion::Slide(axis) => Swing::Slide(turned, turned * axis),
            JointMotion::Turn(generator) => {
                let squared = generator * generator;
                let still = turned * (Matrix::<N, D>::identity() + squared);
                Swing::Turn([still, turned * generator, turned * -squared])
            }
        };
        Some(Self { parent, origin: origin.translation, rotation })
    }

    /// Its number is a length.
    pub(super) const fn slides(&self) -> bool {
        matches!(self.rotation, Swing::Slide(..))
    }

    /// The same in `f32`, moved by a shift if it moves on the world.
    pub(super) fn in_f32(&self, shift: &Vector<N, D>) -> Node<f32, D> {
        let origin = if self.parent == 0 { self.origin - shift } else { self.origin };
        let rotation = match &self.rotation {
            Swing::Turn(parts) => Swing::Turn(parts.map(|part| part.map(N::as_f32))),
            Swing::Slide(turned, way) => Swing::Slide(turned.map(N::as_f32), way.map(N::as_f32)),
        };
        Node { parent: self.parent, origin: origin.map(N::as_f32), rotation }
    }

    /// Its pose on its parent for eight numbers.
    #[inline(always)]
    fn moved<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, number: V) -> LanePose<V, D> {
        let all = |number: N| V::all(simd, number);
        let origin: [V; D] = by_axis(
            #[inline(always)]
            |axis| all(self.origin[axis]),
        );
        match &self.rotation {
            Swing::Turn([still, with_sine, with_cosine]) => {
                let [sine, cosine] = sine_cosine(simd, number);
                let rotation = by_axis(
                    #[inline(always)]
                    |column| {
                        by_axis(
                            #[inline(always)]
                            |row| {
                                let place = (row, column);
                                (all(still[place]) + sine * all(with_sine[place]))
                                    + cosine * all(with_cosine[place])
                            },
                        )
                    },
                );
                LanePose { rotation, translation: origin }
            }
            Swing::Slide(turned, way) => {
                let way: [V; D] = by_axis(
                    #[inline(always)]
                    |axis| all(way[axis]),
                );
                let place = Pose { rotation: *turned, translation: Vector::<N, D>::zeros() };
                let LanePose { rotation, .. } = LanePose::of(simd, &place);
                LanePose { rotation, translation: plus(&origin, &times(&way, number)) }
            }
        }
    }
}

impl<N: Real, const D: usize> PoseRows<N, D> {
    /// The world, or nothing yet.
    pub(super) fn identity() -> Self {
        let mut rows =
            Self { rotation: [[[N::ZERO; LANES]; D]; D], translation: [[N::ZERO; LANES]; D] };
        rows.rotation
            .iter_mut()
            .enumerate()
            .for_each(|(axis, column)| column[axis] = [N::ONE; LANES]);
        rows
    }

    /// The pose in one lane.
    pub(super) fn pose(&self, lane: usize) -> Pose<N, D> {
        Pose {
            rotation: Matrix::<N, D>::from_fn(|row, column| self.rotation[column][row][lane]),
            translation: Vector::<N, D>::from_fn(|row, _| self.translation[row][lane]),
        }
    }

    #[inline(always)]
    pub(super) fn load<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> LanePose<V, D> {
        let rotation = by_axis(
            #[inline(always)]
            |column| {
                by_axis(
                    #[inline(always)]
                    |row| V::load(simd, &self.rotation[column][row]),
                )
            },
        );
        let translation = by_axis(
            #[inline(always)]
            |row| V::load(simd, &self.translation[row]),
        );
        LanePose { rotation, translation }
    }

    /// The pose in one lane in all lanes.
    #[inline(always)]
    pub(super) fn spread<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        lane: usize,
    ) -> LanePose<V, D> {
        let rotation = by_axis(
            #[inline(always)]
            |column| {
                by_axis(
                    #[inline(always)]
                    |row| V::all(simd, self.rotation[column][row][lane]),
                )
            },
        );
        let translation = by_axis(
            #[inline(always)]
            |row| V::all(simd, self.translation[row][lane]),
        );
        LanePose { rotation, translation }
    }

    #[inline(always)]
    fn store<S: Simd, V: Wide<S, Scalar = N>>(&mut self, pose: &LanePose<V, D>) {
        for column in 0..D {
            for row in 0..D {
                pose.rotation[column][row].store(&mut self.rotation[column][row]);
            }
            pose.translation[column].store(&mut self.translation[column]);
        }
    }
}

/// The poses of all nodes for eight configurations: `numbers` has the number of each node, `rows` the world and a block
/// for each node.
#[inline(always)]
pub(super) fn forward<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    nodes: &[Node<N, D>],
    numbers: &[LaneRow<N>],
    rows: &mut [PoseRows<N, D>],
) {
    for (index, node) in nodes.iter().enumerate() {
        let inner: LanePose<V, D> = node.moved(simd, V::load(simd, &numbers[index]));
        let pose = if node.parent == 0 {
            inner
        } else {
            let outer: LanePose<V, D> = rows[node.parent].load(simd);
            let rotation = by_axis(
                #[inline(always)]
                |column| outer.vector(&inner.rotation[column]),
            );
            LanePose { rotation, translation: outer.point(&inner.translation) }
        };
        rows[index + 1].store(&pose);
    }
}
