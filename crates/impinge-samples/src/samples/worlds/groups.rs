//! Collision groups and pair filters.

use impinge::world::{BroadPhasePairFilter, CollisionObject};
use impinge_record::Registry;
use impinge_scenes::sparse_drift;

use crate::prelude::*;
use crate::scene::Play;

/// The number of teams. The team of an object is its index modulo this number.
const TEAMS: usize = 3;

/// Drifting boxes, each a member of the group of its team.
#[derive(Debug, Default)]
pub(crate) struct Groups<const D: usize> {
    /// The scene with the boxes.
    play: Play<D>,
}

impl<const D: usize> Groups<D>
where
    f32: Dimension<D>,
{
    /// Sets the groups of all objects by the rule in `panel`, and registers or removes the pair
    /// filter.
    fn assign(&self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let handles = self.play.handles().iter();
        for (index, object) in handles.enumerate() {
            // Two objects may touch if each is in a group that the other whitelists, and in no
            // group that the other blacklists.
            let team = index % TEAMS;
            let mut groups = CollisionGroups::new();
            groups.set_membership(&[team]);
            match panel.chosen("rule") {
                "own team" => groups.set_whitelist(&[team]),
                "other teams" => groups.set_blacklist(&[team]),
                "nobody" => groups.set_whitelist(&[]),
                _ => {}
            }
            world.set_collision_groups(*object, groups)?;
        }
        // A filter is code. So the recording contains only its name; the registry has the filter.
        if panel.is_set("filter") {
            world.register_broad_phase_pair_filter("same first digit")?;
        } else {
            world.unregister_broad_phase_pair_filter("same first digit");
        }
        Ok(())
    }
}

/// Returns the team of an object from its label; `None` for other labels.
fn team(label: &str) -> Option<usize> {
    let index: usize = label.strip_prefix("object ")?.parse().ok()?;
    Some(index % TEAMS)
}

/// A pair filter that accepts a pair only if the numbers of its objects begin with the same digit.
#[derive(Clone, Copy, Debug)]
struct SameFirstDigit;

impl<const D: usize> BroadPhasePairFilter<f32, D, String> for SameFirstDigit
where
    f32: Space<D>,
{
    fn is_pair_valid(
        &self,
        one: &CollisionObject<f32, D, String>,
        two: &CollisionObject<f32, D, String>,
    ) -> bool {
        let digit = |label: &str| label.chars().find(char::is_ascii_digit);
        digit(one.data()) == digit(two.data())
    }
}

impl<const D: usize> Sample<D> for Groups<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        let rules = &["everybody", "own team", "other teams", "nobody"];
        Panel::new().choice("rule", "Each touches", "own team", rules).flag(
            "filter",
            "Only numbers with the same first digit",
            false,
        )
    }

    fn registry(&self) -> Registry<f32, D, String> {
        Registry::new().with_filter("same first digit", SameFirstDigit)
    }

    /// Adds the boxes of the scene, in which all pairs may touch, then sets their groups.
    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.play = Play::start(sparse_drift(90), world)?;
        self.assign(world, panel)
    }

    /// Sets the groups again. Groups can change at any time; contacts begin and end at the next
    /// update.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        self.assign(world, panel)
    }

    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.play.advance(world)
    }

    /// Returns the numbers of contacts within teams and between teams. The teams are taken from the
    /// labels, not from the groups, so that the numbers verify the rule.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        // Each manifold counts as one contact.
        let is_within: Vec<_> = world
            .contact_views()
            .map(|(one, two, _)| team(one.data()) == team(two.data()))
            .collect();
        let within = is_within.iter().filter(|is_within| **is_within).count();
        vec![
            Readout::new("Contacts within a team", within),
            Readout::new("Contacts between teams", is_within.len() - within),
        ]
    }
}
