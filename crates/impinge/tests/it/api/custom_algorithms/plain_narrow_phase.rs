//! A custom narrow phase: a sorted map of pairs, each with its boxed algorithm. Every update
//! computes all pairs.

use std::collections::BTreeMap;

use super::dim::events::{ContactEvent, Events, ProximityEvent};
use super::dim::math::{DIM, Real};
use super::dim::narrow_phase::{
    CollisionObjectHandle, ContactAlgorithm, ContactDispatcher, ContactPair, ContactPairs,
    ContactPrediction, DefaultContactDispatcher, DefaultProximityDispatcher, IdAllocator,
    NarrowPhase, ProximityAlgorithm, ProximityDispatcher, ProximityPair, ProximityPairs,
};
use super::dim::query::Proximity;
use super::dim::world::{CollisionObject, CollisionObjects, GeometricQueryType};

type Handle = CollisionObjectHandle;
type Key = (Handle, Handle);

/// State kept for a pair between updates.
#[derive(Clone)]
struct Entry<N: Real> {
    work: Work<N>,
    is_touching: bool,
    status: Proximity,
}

#[derive(Clone)]
enum Work<N: Real> {
    Contacts(ContactAlgorithm<N>, ContactPrediction<N>),
    Proximity(ProximityAlgorithm<N>, N),
}

impl<N: Real> Work<N> {
    fn new<T>(a: &CollisionObject<N, T>, b: &CollisionObject<N, T>) -> Self {
        use GeometricQueryType::{Contacts, Proximity};
        let (shape1, shape2) = (a.shape().as_ref(), b.shape().as_ref());
        let margin = match (a.query_type(), b.query_type()) {
            (Contacts(linear1, angular1), Contacts(linear2, angular2)) => {
                let prediction = ContactPrediction::new(linear1 + linear2, angular1, angular2);
                let dispatcher = DefaultContactDispatcher::new();
                let algorithm = dispatcher.get_contact_algorithm(shape1, shape2);
                return Self::Contacts(algorithm.expect("for any two"), prediction);
            }
            (Proximity(margin1), Proximity(margin2)) => margin1 + margin2,
            (Proximity(margin), _) | (_, Proximity(margin)) => margin,
        };
        let dispatcher = DefaultProximityDispatcher::new();
        let algorithm = dispatcher.get_proximity_algorithm(shape1, shape2);
        Self::Proximity(algorithm.expect("for any two"), margin)
    }
}

/// All pairs, sorted by their handles.
#[derive(Clone, Default)]
pub(super) struct PlainNarrowPhase<N: Real> {
    pairs: BTreeMap<Key, Entry<N>>,
    ids: IdAllocator,
}

impl<N: Real> PlainNarrowPhase<N> {
    fn end(&mut self, key: Key, events: &mut Events) {
        if let Some(mut entry) = self.pairs.remove(&key) {
            note(key, &mut entry, (false, Proximity::Disjoint), events);
        }
    }
}

/// Pushes an event if the pair began or ceased to touch, and one if its proximity changed; then
/// stores the new state.
fn note<N: Real>(
    (collider1, collider2): Key,
    entry: &mut Entry<N>,
    (is_touching, new_status): (bool, Proximity),
    events: &mut Events,
) {
    if is_touching != entry.is_touching {
        let event = if is_touching { ContactEvent::Started } else { ContactEvent::Stopped };
        events.push_contact(event(collider1, collider2));
    }
    let prev_status = entry.status;
    events.push_proximity(ProximityEvent { collider1, collider2, prev_status, new_status });
    (entry.is_touching, entry.status) = (is_touching, new_status);
}

impl<N: Real, T> NarrowPhase<N, DIM, T> for PlainNarrowPhase<N> {
    fn update(&mut self, objects: &CollisionObjects<N, T>, events: &mut Events) {
        for (&key, entry) in &mut self.pairs {
            let both = objects.get(key.0).zip(objects.get(key.1)).expect("both live");
            let (a, b) = (both.0.shape().as_ref(), both.1.shape().as_ref());
            let (ma, mb) = (both.0.position(), both.1.position());
            let mut now = (false, Proximity::Disjoint);
            match &mut entry.work {
                Work::Contacts(algorithm, prediction) => {
                    let dispatcher = &DefaultContactDispatcher::new();
                    algorithm.update(dispatcher, ma, a, mb, b, prediction, &mut self.ids);
                    now.0 = algorithm.num_contacts() > 0;
                }
                Work::Proximity(algorithm, margin) => {
                    let dispatcher = &DefaultProximityDispatcher::new();
                    algorithm.update(dispatcher, ma, a, mb, b, *margin);
                    now.1 = algorithm.proximity();
                }
            }
            note(key, entry, now, events);
        }
    }

    fn handle_interaction(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, T>,
        handle1: Handle,
        handle2: Handle,
        started: bool,
    ) {
        assert!(handle1 < handle2, "in order");
        if !started {
            return self.end((handle1, handle2), events);
        }
        let both = objects.get(handle1).zip(objects.get(handle2)).expect("both live");
        let entry = || Entry {
            work: Work::new(both.0, both.1),
            is_touching: false,
            status: Proximity::Disjoint,
        };
        self.pairs.entry((handle1, handle2)).or_insert_with(entry);
    }

    fn handle_removal(
        &mut self,
        events: &mut Events,
        _: &CollisionObjects<N, T>,
        handle1: Handle,
        handle2: Handle,
    ) {
        self.end((handle1, handle2), events);
    }

    fn handle_change(&mut self, _: &mut Events, objects: &CollisionObjects<N, T>, handle: Handle) {
        let mine = self.pairs.iter_mut().filter(|(key, _)| key.0 == handle || key.1 == handle);
        for (key, entry) in mine {
            // The world has removed the pairs of removed objects before this call.
            let both = objects.get(key.0).zip(objects.get(key.1)).expect("both live");
            entry.work = Work::new(both.0, both.1);
        }
    }

    fn ids(&mut self) -> Option<&mut IdAllocator> {
        Some(&mut self.ids)
    }

    fn contact_pair<'a>(
        &'a self,
        _: &'a CollisionObjects<N, T>,
        handle1: Handle,
        handle2: Handle,
    ) -> Option<ContactPair<'a, N>> {
        match &self.pairs.get(&(handle1, handle2))?.work {
            Work::Contacts(algorithm, _) => Some(ContactPair::from_algorithm(&**algorithm)),
            Work::Proximity(..) => None,
        }
    }

    fn proximity_pair(
        &self,
        _: &CollisionObjects<N, T>,
        handle1: Handle,
        handle2: Handle,
    ) -> Option<ProximityPair> {
        let entry = self.pairs.get(&(handle1, handle2))?;
        matches!(entry.work, Work::Proximity(..)).then(|| ProximityPair::new(entry.status))
    }

    fn contact_pairs<'a>(&'a self, objects: &'a CollisionObjects<N, T>) -> ContactPairs<'a, N> {
        let pairs = self.pairs.keys();
        Box::new(pairs.filter_map(|&(a, b)| Some((a, b, self.contact_pair(objects, a, b)?))))
    }

    fn proximity_pairs<'a>(&'a self, objects: &'a CollisionObjects<N, T>) -> ProximityPairs<'a> {
        let pairs = self.pairs.keys();
        Box::new(pairs.filter_map(|&(a, b)| Some((a, b, self.proximity_pair(objects, a, b)?))))
    }
}
