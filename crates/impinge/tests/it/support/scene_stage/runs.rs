//! The scenes whose hashes are in the golden file, and the ways in which they are played.

#![allow(dead_code, reason = "each test uses a part")]

use std::collections::VecDeque;
use std::hash::Hasher;

use impinge::broad_phase::DBVTBroadPhase;
use impinge::broad_phase::Lanes;
use impinge_scenes::Scene;

use crate::scene_stage::{Digest, Play, Player, digest_state};

/// The hash of a run, and how many contacts and events there were.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Outcome {
    pub(crate) hash: u64,
    pub(crate) contacts: usize,
    pub(crate) events: usize,
}

/// A scene and the number of steps.
#[derive(Clone)]
pub(crate) struct Run<const D: usize> {
    pub(crate) scene: Scene<D>,
    pub(crate) steps: u32,
}

impl<const D: usize> Run<D> {
    /// Returns the key of this scene with a scalar in the golden file.
    pub(crate) fn key(&self, scalar: &str) -> String {
        let name = self.scene.name.replace(' ', "-").replace('%', "percent");
        format!("{name} {D} {scalar}")
    }

    /// Runs the scene in a world whose broad phase uses the given instruction set.
    pub(crate) fn play<N: Play<D>>(&self, lanes: Option<Lanes>) -> Outcome {
        let mut player = Player::<N, D>::new(self.scene.clone(), 1.0);
        if let Some(lanes) = lanes {
            let margin = N::lit(self.scene.margin);
            let broad_phase = DBVTBroadPhase::with_lanes(margin, lanes).expect("a margin");
            player.world.set_broad_phase(Box::new(broad_phase));
        }
        let mut score = Score { digest: Digest::new(), outcome: Outcome::default() };
        for _ in 0..self.steps {
            player.step();
            score.note(&player);
        }
        score.finish()
    }

    /// Runs the scene with a mark before each step. After every tenth new step it rewinds by at
    /// most eight steps and runs these again; after every seventh it continues with a clone.
    pub(crate) fn play_again<N: Play<D>>(&self) -> Outcome {
        let mut player = Player::<N, D>::new(self.scene.clone(), 1.0);
        let mut score = Score { digest: Digest::new(), outcome: Outcome::default() };
        let (mut marks, mut farthest) = (VecDeque::new(), 0);
        while player.step_number() < self.steps {
            marks.push_back((player.mark(), score.clone()));
            player.step();
            score.note(&player);
            if player.step_number() <= farthest {
                continue;
            }
            farthest = player.step_number();
            if farthest % 10 == 0 {
                let first = marks.len().saturating_sub(8);
                let (mark, before) = &marks[first];
                player.rewind(mark);
                score = before.clone();
                marks.clear();
            } else if farthest % 7 == 0 {
                player.world = player.world.clone();
                marks.clear();
            }
        }
        score.finish()
    }
}

/// Digest and counts of a run so far.
#[derive(Clone, Debug)]
struct Score {
    digest: Digest,
    outcome: Outcome,
}

impl Score {
    /// Digests what the world reports after a step.
    fn note<N: Play<D>, const D: usize>(&mut self, player: &Player<N, D>) {
        let (world, outcome) = (&player.world, &mut self.outcome);
        digest_state(world, &mut self.digest);
        outcome.contacts += world.contact_manifolds().map(|(_, _, m)| m.len()).sum::<usize>();
        outcome.events += world.contact_events().len() + world.proximity_events().len();
    }

    fn finish(self) -> Outcome {
        Outcome { hash: self.digest.finish(), ..self.outcome }
    }
}

/// Expands `$then` with the list of all runs, each with the name of its test.
macro_rules! for_each_run {
    ($then:ident) => {
        $then! {
            pile_in_plane: Run { scene: pile::<2>(600), steps: 20 };
            pile_in_space: Run { scene: pile::<3>(150), steps: 20 };
            sparse_drift_in_plane: Run { scene: sparse_drift::<2>(2500), steps: 12 };
            sparse_drift_in_space: Run { scene: sparse_drift::<3>(600), steps: 30 };
            mixed_shapes_in_plane: Run { scene: mixed_shapes::<2>(300), steps: 30 };
            mixed_shapes_in_space: Run { scene: mixed_shapes::<3>(240), steps: 20 };
            mixed_sizes_in_plane: Run { scene: mixed_sizes::<2>(600), steps: 30 };
            mixed_sizes_in_space: Run { scene: mixed_sizes::<3>(600), steps: 30 };
            spawn_and_despawn_in_plane: Run { scene: spawn_and_despawn::<2>(500), steps: 40 };
            spawn_and_despawn_in_space: Run { scene: spawn_and_despawn::<3>(500), steps: 30 };
            tower_in_plane: Run { scene: tower::<2>(400), steps: 20 };
            tower_in_space: Run { scene: tower::<3>(400), steps: 20 };
            few_moving_in_plane: Run { scene: few_moving::<2>(3000), steps: 60 };
            few_moving_in_space: Run { scene: few_moving::<3>(3000), steps: 40 };
        }
    };
}
