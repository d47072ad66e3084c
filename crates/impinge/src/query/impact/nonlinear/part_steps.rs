//! Advances the pairs of parts of two composites one by one.

use super::super::bounds::Rate;
use super::{BodyPoses, Configuration, ImpactSearch, Mode, Step};
use crate::collide::parts::{PairVisitor, PartSweep};
use crate::collide::separation::separation;
use crate::math::{Space, min};

/// The maximum number of separate steps of two parts before all parts are tested again.
const MAX_PART_STEPS: usize = 64;

/// The search for the largest step in which no two parts use up the excess. Each pair of parts is
/// advanced separately, until it uses up the excess or reaches the end of the step found so far.
pub(super) struct PartSteps<'s, 'b, 'a, N: Space<D>, const D: usize> {
    pub(super) search: &'s ImpactSearch<'a, N, D>,
    pub(super) configuration: &'s Configuration<'b, 'a, N, D>,
    pub(super) mode: Mode<N>,
    /// The distance of two parts at which the excess is used up.
    pub(super) spent: N,
    /// An upper bound of the approach of any two parts.
    pub(super) rate: Rate<N>,
    pub(super) step: Step<N>,
}

impl<'a, N: Space<D>, const D: usize> PartSteps<'_, '_, 'a, N, D> {
    /// Returns the distance by which two parts may still approach at the given poses, and a time
    /// during which they certainly do not use up that distance. `None` if they cannot use it up in
    /// the time `left`, by an upper bound of their speed in any direction.
    fn alone(&self, poses: &BodyPoses<'_, 'a, N, D>, parts: [u32; 2], left: N) -> Option<(N, N)> {
        let (moment, end) = (&poses.moment, self.search.end);
        let placed = poses.between.parts(parts);
        let parts = moment.parts(&placed, &poses.pose1);
        let travel = min(moment.rate_of(&parts, end).travel(left), self.rate.travel(left));
        let found = separation(&placed.pair(), self.spent + travel)?;
        let gap = found.distance - self.spent;
        Some((gap, moment.safe_time_of(&parts, &found.normal, gap, end)))
    }
}

impl<N: Space<D>, const D: usize> PairVisitor<N, D> for PartSteps<'_, '_, '_, N, D> {
    fn limit(&self) -> N {
        self.spent
    }

    fn sweep(&self, which: usize) -> Option<PartSweep<N, D>> {
        Some(self.configuration.poses.moment.sweep(which, &self.rate, self.step.time))
    }

    fn visit(&mut self, parts: [u32; 2]) {
        let (start, longest) = (self.configuration.poses.moment.time, self.step.time);
        let Some((_, mut time)) = self.alone(&self.configuration.poses, parts, longest) else {
            return;
        };
        let mut near_steps = 0;
        // Parts in contact may separate and come back, so all parts are tested after each step of
        // two such parts.
        let tries = if matches!(self.mode, Mode::Apart) { MAX_PART_STEPS } else { 0 };
        for _ in 0..tries {
            if time >= longest {
                return;
            }
            let Some(poses) = self.search.poses_at(start + time) else { break };
            let Some((gap, safe)) = self.alone(&poses, parts, longest - time) else { return };
            near_steps = if gap <= self.configuration.near() { near_steps + 1 } else { 0 };
            if gap <= self.configuration.tolerance || start + (time + safe) <= start + time {
                break;
            }
            time += safe;
        }
        if time < longest {
            self.step = Step { time, near_steps };
        }
    }
}
