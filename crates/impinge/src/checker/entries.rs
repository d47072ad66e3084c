//! Entry points of checkers: functions whose generic code this crate compiles for each scalar and
//! dimension.

use super::filter::{RobotFilter, Surroundings};
use super::frames::OnNode;
use super::rows::RowsOf;
use super::{Body, Checker, FrameTree, NearestColumns, Obstacle, answers, checks, frames};
use crate::batch::{BatchError, Control};
use crate::math::Pose;
use crate::tables::compiled;

type Done = Result<(), BatchError>;

compiled! {
    /// Entry points of checkers, compiled once per scalar type and dimension.
    trait CheckerEntries where feature = "batch";

    /// Writes the poses of objects at constant poses on the nodes of a tree, for each configuration
    /// in `values`.
    fn place(
        tree: (&FrameTree<N, D>, &[OnNode<N, D>]),
        values: &[N],
        control: &Control<'_>,
        rows: RowsOf<'_, Pose<N, D>>,
    ) -> Done = frames::place;

    fn robot(
        tree: &FrameTree<N, D>,
        bodies: &[Body<N, D>],
        pairs: &[[u32; 2]],
    ) -> RobotFilter<D> = checks::robot;

    fn surroundings(
        tree: &FrameTree<N, D>,
        robot: &RobotFilter<D>,
        obstacles: &[Obstacle<N, D>],
        pairs: &[[u32; 2]],
    ) -> Surroundings<D> = Surroundings::new;

    /// Runs [`Checker::are_free`]; `asked` has the configurations and the clearance.
    fn are_free(
        checker: &Checker<N, D>,
        asked: (&[N], N),
        control: &Control<'_>,
        out: &mut [bool],
    ) -> Done = answers::are_free;

    fn first_pairs(
        checker: &Checker<N, D>,
        asked: (&[N], N),
        control: &Control<'_>,
        out: &mut [[u32; 2]],
    ) -> Done = answers::first_pairs;

    /// Runs [`Checker::nearest`]; `asked` has the configurations, the limit, and the number of
    /// configurations.
    fn nearest(
        checker: &Checker<N, D>,
        asked: (&[N], N, usize),
        control: &Control<'_>,
        out: NearestColumns<'_, N>,
    ) -> Done = answers::nearest;
}
