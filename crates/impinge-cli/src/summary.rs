//! The pairs of a world after an update, and the counts of a step.

use core::fmt;
use std::collections::BTreeSet;

use impinge::narrow_phase::CollisionObjectHandle;
use impinge::query::Proximity;
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_record::Recordable;
use serde::Serialize;

use crate::log::{Label, name_of};
use crate::number::Number;
use crate::state::State;

/// The pairs that touch, by contacts or by proximity. The object with the smaller index is first.
pub(crate) type TouchingPairs = BTreeSet<[CollisionObjectHandle; 2]>;

/// The numbers of objects, pairs and contacts of a world after a step, and of changes by the step.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct StepSummary {
    /// The number of updates made so far.
    pub(crate) step: usize,
    pub(crate) objects: usize,
    /// The number of pairs that touch, by contacts or by proximity.
    pub(crate) touching: usize,
    /// The number of pairs that are apart, but have predicted contacts or are within their margin.
    pub(crate) near: usize,
    /// The number of contact points of all pairs.
    pub(crate) contacts: usize,
    /// The number of pairs that touch, but did not touch after the step before. A pair that starts
    /// to have predicted contacts has not started touching.
    pub(crate) started: usize,
    /// The number of pairs that touched after the step before, but do not touch, also because an
    /// object was removed.
    pub(crate) stopped: usize,
}

/// Two objects that touch or are near each other.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PairSummary {
    pub(crate) first: String,
    pub(crate) second: String,
    #[serde(flatten)]
    pub(crate) numbers: PairNumbers,
}

/// The state and the contacts of a pair.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct PairNumbers {
    pub(crate) state: State,
    /// The number of contact points; 0 for pairs that have a proximity query.
    pub(crate) contacts: usize,
    /// The depth of the deepest contact, negative if it is predicted; `None` for pairs that have a
    /// proximity query.
    pub(crate) depth: Option<Number>,
}

/// Returns the pairs of a world that touch or are near: first the pairs with contact queries, then
/// the pairs with proximity queries. Both groups are sorted by the handles of their objects.
fn near_pairs<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
) -> impl Iterator<Item = ([&CollisionObject<N, D, T>; 2], PairNumbers)> {
    let contacts = world.contact_pairs().filter_map(|(first, second, pair)| {
        let depths = pair.views().map(|view| view.deepest_contact().contact.depth);
        let depth = depths.reduce(impinge::math::max)?;
        let state = if depth < N::ZERO { State::Near } else { State::Touch };
        let (contacts, depth) = (pair.num_contacts(), Some(Number::new(depth)));
        Some(([first, second], PairNumbers { state, contacts, depth }))
    });
    let proximities = world.proximity_pairs().filter_map(|(first, second, pair)| {
        let state = match pair.proximity() {
            Proximity::Intersecting => State::Touch,
            Proximity::WithinMargin => State::Near,
            Proximity::Disjoint => return None,
        };
        Some(([first, second], PairNumbers { state, contacts: 0, depth: None }))
    });
    contacts.chain(proximities)
}

/// Returns the pairs of a recorded world that touch or are near, with the names of their objects.
pub(crate) fn pairs<N: Recordable<D>, const D: usize>(
    world: &CollisionWorld<N, D, Label>,
) -> Vec<PairSummary> {
    let named = near_pairs(world).map(|(objects, numbers)| {
        let [first, second] = objects.map(name_of);
        PairSummary { first, second, numbers }
    });
    named.collect()
}

/// Returns `true` if any two objects touch. The search ends at the first touching pair.
pub(crate) fn touches<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
) -> bool {
    near_pairs(world).any(|(_, pair)| pair.state == State::Touch)
}

/// Returns the pairs of a world that touch.
pub(crate) fn touching_pairs<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
) -> TouchingPairs {
    let touching = near_pairs(world).filter(|(_, pair)| pair.state == State::Touch);
    touching.map(|(objects, _)| objects.map(CollisionObject::handle)).collect()
}

/// Returns the counts of a world after `step` updates. `before` and `after` are the pairs that
/// touch after the update before and after this one.
///
/// Events are not counted: contacts also start with predicted points, which do not touch.
pub(crate) fn summary<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    step: usize,
    [before, after]: [&TouchingPairs; 2],
) -> StepSummary {
    let pairs: Vec<_> = near_pairs(world).map(|(_, pair)| pair).collect();
    StepSummary {
        step,
        objects: world.len(),
        touching: after.len(),
        near: pairs.iter().filter(|pair| pair.state == State::Near).count(),
        contacts: pairs.iter().map(|pair| pair.contacts).sum(),
        started: after.difference(before).count(),
        stopped: before.difference(after).count(),
    }
}

impl fmt::Display for PairSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let PairNumbers { state, contacts, depth } = self.numbers;
        state.headline(f, &self.first, &self.second)?;
        if let Some(depth) = depth {
            write!(f, ", {contacts} contacts, depth {depth}")?;
        }
        writeln!(f)
    }
}
