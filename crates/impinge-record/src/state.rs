//! Hashes of a world after an update: of the whole state, of its events, and of each changed
//! object.

use impinge::narrow_phase::{ContactEvent, ContactPair, GeometricQueryType, ProximityEvent};
use impinge::query::{ContactPoint, Proximity};
use impinge::world::{CollisionObject, CollisionWorld};

use crate::digest::{Digest, id_parts};
use crate::divergence::{Difference, ObjectField};
use crate::marks::EventCounts;
use crate::space::Recordable;

/// The recorded hashes of one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ObjectHashes {
    /// The index of the object.
    pub(crate) index: u32,
    /// The hash of the properties that calls set, such as the position and the groups.
    pub(crate) description: u32,
    /// The hash of the pairs in which the object is the first, with their contacts.
    pub(crate) pairs: u32,
}

/// The hashes and counts that are recorded with an update.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Observation {
    /// The hash of all objects and pairs.
    pub(crate) state: u64,
    /// The hash of the events of the update.
    pub(crate) events: u64,
    /// The number of events of each kind in the update; `None` in version 1 of the format.
    pub(crate) counts: Option<EventCounts>,
    /// The objects whose hashes differ from their hashes after the previous update, in the order of
    /// indices; `None` in packed recordings.
    pub(crate) changed: Option<Vec<ObjectHashes>>,
}

/// The state that is needed to compute the hashes of the next update.
#[derive(Clone, Debug, Default)]
pub(crate) struct Observer {
    /// The pair index of the first contact. Pair indices are hashed relative to it, since their
    /// values are not reset when the phases are replaced.
    first_pair: Option<u64>,
    /// The two hashes of each object by index; zero for indices without an object at the last
    /// update.
    known: Vec<[u32; 2]>,
}

impl Observer {
    /// Computes the hashes after an update. Costs O(objects + pairs + contacts).
    pub(crate) fn observe<N: Recordable<D>, const D: usize, T>(
        &mut self,
        world: &CollisionWorld<N, D, T>,
    ) -> Observation {
        let pairs = self.pair_digests(world);
        // Objects are in the order of their indices, so lists by index only grow at the end.
        let mut all = Digest::new();
        let mut changed = Vec::new();
        let mut known = Vec::with_capacity(self.known.len());
        for object in world.collision_objects() {
            let index = object.handle().uid();
            let description = description_digest(world, object);
            all.index(index);
            all.word(description.finish());
            all.word(pairs[index].finish());
            known.resize(index, [0; 2]);
            let hashes = [description.folded(), pairs[index].folded()];
            known.push(hashes);
            if self.known.get(index) != Some(&hashes) {
                let [description, pairs] = hashes;
                let index = u32::try_from(index).expect("an index has 31 bits");
                changed.push(ObjectHashes { index, description, pairs });
            }
        }
        self.known = known;
        let (state, events) = (all.finish(), events_hash(world));
        let counts = Some(EventCounts::of(world));
        Observation { state, events, counts, changed: Some(changed) }
    }

    /// Returns the hashes by index after applying the recorded changes, for the indices that are
    /// known to `replayed`, the observer after the same update. Ignores larger indices, so an
    /// invalid recording cannot request memory. Hashes of indices without an object are out of
    /// date.
    pub(crate) fn after(&self, changed: &[ObjectHashes], replayed: &Self) -> Vec<[u32; 2]> {
        let mut known = self.known.clone();
        known.resize(replayed.known.len(), [0; 2]);
        for ObjectHashes { index, description, pairs } in changed {
            if let Some(hashes) = known.get_mut(*index as usize) {
                *hashes = [*description, *pairs];
            }
        }
        known
    }

    /// Returns the first object whose hashes differ from the recorded ones; `None` if all agree.
    pub(crate) fn difference(&self, recorded: &[[u32; 2]]) -> Option<Difference> {
        let living = self.known.iter().enumerate().filter(|(_, hashes)| **hashes != [0; 2]);
        for (index, own) in living {
            let other = recorded.get(index).copied().unwrap_or_default();
            let field =
                if own[0] == other[0] { ObjectField::Pairs } else { ObjectField::Description };
            if *own != other {
                return Some(Difference::Object { index, field });
            }
        }
        None
    }

    /// Returns, by index, a hash of the pairs in which the object is the first one.
    fn pair_digests<N: Recordable<D>, const D: usize, T>(
        &mut self,
        world: &CollisionWorld<N, D, T>,
    ) -> Vec<Digest> {
        let reach = world.collision_objects().last().map_or(0, |object| object.handle().uid() + 1);
        let mut digests = vec![Digest::new(); reach];
        for (object1, object2, pair) in world.contact_pairs() {
            let digest = &mut digests[object1.handle().uid()];
            digest.index(object2.handle().uid());
            self.contacts(pair, digest);
        }
        for (object1, object2, pair) in world.proximity_pairs() {
            let digest = &mut digests[object1.handle().uid()];
            digest.index(object2.handle().uid());
            digest.word(proximity_number(pair.proximity()));
        }
        digests
    }

    /// Adds all manifolds of a pair, in their order.
    fn contacts<N: Recordable<D>, const D: usize>(
        &mut self,
        pair: ContactPair<'_, N, D>,
        digest: &mut Digest,
    ) {
        for view in pair.views() {
            digest.index(view.len());
            view.contacts().for_each(|point| self.point(&point, digest));
        }
    }

    /// Adds the geometry, the id, the features and the parts of a contact.
    fn point<N: Recordable<D>, const D: usize>(
        &mut self,
        point: &ContactPoint<N, D>,
        digest: &mut Digest,
    ) {
        let contact = &point.contact;
        digest.numbers(contact.world1.coords.as_slice());
        digest.numbers(contact.world2.coords.as_slice());
        digest.numbers(contact.normal.as_slice());
        digest.numbers(&[contact.depth]);
        let [pair, number] = id_parts(point.id);
        digest.word(pair.wrapping_sub(*self.first_pair.get_or_insert(pair)));
        digest.word(number);
        digest.feature(point.feature1);
        digest.feature(point.feature2);
        digest.word(u64::from(point.part1));
        digest.word(u64::from(point.part2));
    }
}

/// Returns the hash of the state of an object that calls have set: its position, groups, query
/// type, fixed flag, skin and predicted position.
fn description_digest<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    object: &CollisionObject<N, D, T>,
) -> Digest {
    let mut digest = Digest::new();
    digest.numbers(&N::isometry_numbers(object.position()));
    let groups = object.collision_groups();
    for mask in [groups.membership_mask(), groups.whitelist_mask(), groups.blacklist_mask()] {
        digest.word(u64::from(mask));
    }
    digest.word(u64::from(groups.can_interact_with_self()));
    match object.query_type() {
        GeometricQueryType::Contacts(linear, angular) => digest.numbers(&[linear, angular]),
        GeometricQueryType::Proximity(margin) => digest.numbers(&[margin]),
    }
    if object.is_fixed() {
        digest.word(1);
    }
    if let Some(skin) = world.skin(object.handle()).filter(|skin| *skin > N::ZERO) {
        digest.word(2);
        digest.numbers(&[skin]);
    }
    if let Some(predicted) = world.predicted_position(object.handle()) {
        digest.word(3);
        digest.numbers(&N::isometry_numbers(predicted));
    }
    digest
}

/// Returns the hash of the events of the last update, in their order.
fn events_hash<N: Recordable<D>, const D: usize, T>(world: &CollisionWorld<N, D, T>) -> u64 {
    let mut digest = Digest::new();
    for event in world.contact_events() {
        let (object1, object2) = event.handles();
        digest.word(u64::from(matches!(event, ContactEvent::Started(..))));
        digest.index(object1.uid());
        digest.index(object2.uid());
    }
    for ProximityEvent { collider1, collider2, prev_status, new_status } in world.proximity_events()
    {
        digest.index(collider1.uid());
        digest.index(collider2.uid());
        digest.word(proximity_number(*prev_status));
        digest.word(proximity_number(*new_status));
    }
    digest.finish()
}

/// Returns a code for a proximity. The code does not depend on the order of the variants in the
/// library.
const fn proximity_number(proximity: Proximity) -> u64 {
    match proximity {
        Proximity::Intersecting => 2,
        Proximity::WithinMargin => 3,
        Proximity::Disjoint => 4,
    }
}
