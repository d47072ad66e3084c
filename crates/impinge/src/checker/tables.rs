//! The entry points of the checker that are compiled in this crate.

use super::filter::{RobotFilter, Surroundings};
use super::frames::OnNode;
use super::rows::RowsOf;
use super::{Body, Checker, FrameTree, NearestColumns, Obstacle, answers, checks, frames};
use crate::batch::{BatchError, Control};
use crate::math::{Pose, Space};

/// What the checker asks of this crate, for one scalar and dimension.
pub(crate) struct CheckerTables<N: Space<D>, const D: usize> {
    pub(super) place: PlaceFn<N, D>,
    pub(super) robot: RobotFn<N, D>,
    pub(super) surroundings: SurroundingsFn<N, D>,
    pub(super) are_free: ColumnFn<N, D, bool>,
    pub(super) first_pairs: ColumnFn<N, D, [u32; 2]>,
    pub(super) nearest: NearestFn<N, D>,
}

type Done = Result<(), BatchError>;
type PlaceFn<N, const D: usize> =
    fn(OnTree<'_, N, D>, &[N], &Control<'_>, RowsOf<'_, Pose<N, D>>) -> Done;
/// A tree, and what is on its nodes.
type OnTree<'a, N, const D: usize> = (&'a FrameTree<N, D>, &'a [OnNode<N, D>]);
type RobotFn<N, const D: usize> =
    fn(&FrameTree<N, D>, &[Body<N, D>], &[[u32; 2]]) -> RobotFilter<D>;
type SurroundingsFn<N, const D: usize> =
    fn(&FrameTree<N, D>, &RobotFilter<D>, &[Obstacle<N, D>], &[[u32; 2]]) -> Surroundings<D>;
type ColumnFn<N, const D: usize, T> = fn(&Checker<N, D>, (&[N], N), &Control<'_>, &mut [T]) -> Done;
type NearestFn<N, const D: usize> =
    fn(&Checker<N, D>, (&[N], N, usize), &Control<'_>, NearestColumns<'_, N>) -> Done;

impl<N: Space<D>, const D: usize> CheckerTables<N, D> {
    pub(crate) const fn new() -> Self {
        Self {
            place: frames::place,
            robot: checks::robot,
            surroundings: Surroundings::new,
            are_free: answers::are_free,
            first_pairs: answers::first_pairs,
            nearest: answers::nearest,
        }
    }
}
