//! What a world says after an update, in numbers and by pairs.

use impinge::narrow_phase::{ContactEvent, ProximityEvent};
use impinge::query::Proximity;
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_record::Recordable;
use serde::Serialize;

use crate::number::Number;
use crate::recording::Named;

/// How the objects of a pair are to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum State {
    /// Their distance is zero.
    Touch,
    /// They are apart, but within what was asked.
    Near,
    /// They are farther apart.
    Apart,
}

impl State {
    /// The state as printed.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Touch => "touch",
            Self::Near => "near",
            Self::Apart => "apart",
        }
    }
}

/// The numbers of a step.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct StepSummary {
    pub(crate) step: usize,
    pub(crate) objects: usize,
    pub(crate) touching: usize,
    pub(crate) near: usize,
    pub(crate) contacts: usize,
    pub(crate) started: usize,
    pub(crate) stopped: usize,
}

/// Two objects that touch or are near each other.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct PairSummary {
    pub(crate) first: String,
    pub(crate) second: String,
    pub(crate) state: State,
    /// The number of contact points; 0 for pairs of which proximity alone is wanted.
    pub(crate) contacts: usize,
    /// Of the deepest contact; negative if it is a predicted one.
    pub(crate) depth: Option<Number>,
}

/// The pairs of a world that touch or are near: those with contacts first, each in order of the handles.
pub(crate) fn pairs<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
) -> Vec<PairSummary>
where
    CollisionObject<N, D, T>: Named,
{
    let mut pairs = Vec::new();
    for (first, second, pair) in world.contact_pairs() {
        let depths = pair.views().map(|view| view.deepest_contact().contact.depth);
        let deepest = depths.reduce(impinge::math::max);
        let Some(depth) = deepest else { continue };
        let state = if depth < N::ZERO { State::Near } else { State::Touch };
        let (contacts, depth) = (pair.num_contacts(), Some(Number::new(depth)));
        let (first, second) = (first.name(), second.name());
        pairs.push(PairSummary { first, second, state, contacts, depth });
    }
    for (first, second, pair) in world.proximity_pairs() {
        let state = match pair.proximity() {
            Proximity::Intersecting => State::Touch,
            Proximity::WithinMargin => State::Near,
            Proximity::Disjoint => continue,
        };
        let (first, second) = (first.name(), second.name());
        pairs.push(PairSummary { first, second, state, contacts: 0, depth: None });
    }
    pairs
}

/// The numbers of a world after so many updates.
pub(crate) fn summary<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    step: usize,
) -> StepSummary
where
    CollisionObject<N, D, T>: Named,
{
    let pairs = pairs(world);
    let count = |state| pairs.iter().filter(|pair| pair.state == state).count();
    let events = world.contact_events().iter();
    let started = events.filter(|event| matches!(event, ContactEvent::Started(..))).count();
    let changes = world.proximity_events().iter();
    let enters = |event: &&ProximityEvent| event.new_status == Proximity::Intersecting;
    let leaves = |event: &&ProximityEvent| event.prev_status == Proximity::Intersecting;
    let entered = changes.clone().filter(enters).count();
    let left = changes.filter(leaves).count();
    StepSummary {
        step,
        objects: world.len(),
        touching: count(State::Touch),
        near: count(State::Near),
        contacts: pairs.iter().map(|pair| pair.contacts).sum(),
        started: started + entered,
        stopped: world.contact_events().len() - started + left,
    }
}
