//! The update of a world, and the replacement of its phases.

use super::filter::{Filtering, UpdateFilter};
use super::{CollisionObject, CollisionWorld, WorldBroadPhase, WorldsNarrowPhase};
use crate::math::Space;
use crate::narrow_phase::{
    CollisionObjectHandle, ContactEvent, Events, Interaction, ProximityEvent,
};
use crate::query::Proximity;

/// Maximum number of pairs passed to the narrow phase at once. It is small enough that the rows of
/// the pairs' objects are still in the cache when these rows are released.
const BATCH: usize = 512;

type HandlePair = (CollisionObjectHandle, CollisionObjectHandle);

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Applies the changes since the last update, computes pairs, contacts and proximities, and
    /// collects the events.
    ///
    /// The events of the last update are discarded, unless [`Self::keep_events`] was called. Events
    /// that removals and [`Self::update_pair`] queued since then come first.
    pub fn update(&mut self) {
        self.update_filtered(None);
    }

    /// Updates the world as [`Self::update`] does, with an additional pair filter. It may borrow
    /// and change data of the caller: the joints of a solver, or a table of pairs to ignore.
    ///
    /// The filter is called once for each pair that this update would start, after groups and all
    /// registered filters have allowed it; if it returns `false`, the pair does not start. The
    /// object with the smaller handle is the first argument, and the order of calls does not depend
    /// on the number of threads. Like every pair filter it must not change over time: it is called
    /// when the boxes of two objects begin to overlap. Later updates do not call any filter again
    /// for this pair, whether it started or was refused.
    ///
    /// To call the filter again, call [`Self::refilter_pairs`] or [`Self::refilter_pairs_of`]
    /// before the update: pairs that the filter refuses then stop, with their events, and pairs
    /// that it allows start. After a change of registered filters, groups or fixed marks the
    /// affected pairs are filtered again too, and after the replacement of a phase all pairs are.
    /// Pairs of an object with itself are not filtered.
    ///
    /// If the filter panics, it is not called any more in this update. The pairs without an answer
    /// stay as they were (in a new narrow phase they do not start), the update ends, and the panic
    /// goes on. The next update filters the pairs of their objects again.
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::<f32, u8>::new(0.02);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let links = [0, 1, 2].map(|link| {
    ///     let position = Isometry::translation(0.5 * f32::from(link), 0.0);
    ///     world.add(position, ball.clone(), groups, ContactQuery::default(), link)
    /// });
    /// let mut joints = vec![(0, 1), (1, 2)];
    /// world.update_with(&mut |a, b| !joints.contains(&(*a.data(), *b.data())));
    /// assert_eq!(world.contact_pairs().count(), 1, "the first and the last");
    ///
    /// // A joint breaks: the pairs of the object that it held are filtered again.
    /// joints.pop();
    /// world.refilter_pairs_of(links[2]);
    /// world.update_with(&mut |a, b| !joints.contains(&(*a.data(), *b.data())));
    /// assert_eq!(world.contact_pairs().count(), 2);
    /// ```
    #[expect(clippy::type_complexity, reason = "what a closure of the user's looks like")]
    pub fn update_with(
        &mut self,
        filter: &mut dyn FnMut(&CollisionObject<N, D, T>, &CollisionObject<N, D, T>) -> bool,
    ) {
        self.update_filtered(Some(filter));
    }

    fn update_filtered(&mut self, filter: Option<UpdateFilter<'_, N, D, T>>) {
        let mut filtering = Filtering::new(filter);
        self.recent.note(self.objects.changes.len());
        self.begin_events();
        if self.next_broad_phase.is_some() || self.next_narrow_phase.is_some() {
            self.update_with_other_phases(&mut filtering);
        } else {
            self.write_changes();
            self.update_broad_phase(&mut filtering);
            self.narrow_phase.update(&self.objects, &mut self.events);
        }
        self.filters.note_update();
        self.events.sort();
        self.recent.note(self.interactions.len().max(self.events.len()));
        if let Some(look) = self.recent.end_update(self.objects.num_slots()) {
            self.objects.give_back(look);
            self.events.give_back(look);
            look.trim(&mut self.interactions);
            look.trim(&mut self.algorithms);
        }
        filtering.finish(self);
    }

    /// Starts the batch of events of an update with the queued events. If the events of the last
    /// update are kept, the batch is appended to them; otherwise it replaces them. Drops the
    /// removed objects whose handles are in no event any more.
    fn begin_events(&mut self) {
        if !core::mem::take(&mut self.keeps_events) {
            self.events.clear();
        }
        self.events.begin_batch(&mut self.queued);
        self.removed.keep_referenced(&self.events);
    }

    /// Makes the next update keep the events of the last update and append its own. So a program
    /// that updates twice in a step can read the events of both updates together.
    ///
    /// The events of each update form a batch in canonical order; a `Started` in the first batch
    /// can be followed by a `Stopped` of the same pair in the second batch. The call affects one
    /// update; to collect the events of several updates, call this before each of them except the
    /// first.
    ///
    /// ```
    /// use impinge::dim2::events::ContactEvent;
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::<f32, ()>::new(0.02);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let [a, b] = [0.0, 1.5].map(|x| {
    ///     let position = Isometry::translation(x, 0.0);
    ///     world.add(position, ball.clone(), groups, ContactQuery::default(), ())
    /// });
    /// world.update();
    /// world.set_position(b, Isometry::translation(9.0, 0.0));
    /// world.keep_events();
    /// world.update();
    /// assert_eq!(world.contact_events(), [ContactEvent::Started(a, b), ContactEvent::Stopped(a, b)]);
    /// ```
    pub const fn keep_events(&mut self) {
        self.keeps_events = true;
    }

    /// Writes the changes since the last update to the object table and the broad phase. Starts or
    /// stops pairs of objects with themselves. The narrow phase then chooses the algorithms again
    /// for the pairs of objects whose shape, query type or skin changed.
    fn write_changes(&mut self) {
        self.objects.flush(&mut *self.broad_phase, &mut self.algorithms);
        for index in self.objects.changes.take_self_changed() {
            let body = self.objects.body(index).expect("what changed in the update is there");
            let (handle, started) = (body.handle, body.has_self_pair());
            self.begin_or_end_pair((handle, handle), started);
        }
        for &index in &self.algorithms {
            let body = self.objects.body(index).expect("what changed in the update is there");
            self.narrow_phase.handle_change(&mut self.events, &self.objects, body.handle);
        }
    }

    /// Updates the broad phase, collects the pairs that started and stopped in `interactions`, and
    /// passes them to the narrow phase.
    fn update_broad_phase(&mut self, filtering: &mut Filtering<'_, N, D, T>) {
        let Self { objects, filters, broad_phase, narrow_phase, interactions, .. } = self;
        let mut filter = |handle1: &CollisionObjectHandle, handle2: &CollisionObjectHandle| {
            if !objects.can_interact(handle1.index(), handle2.index()) {
                return false;
            }
            if filtering.allows_all(filters) {
                return true;
            }
            let (first, second) = in_order(*handle1, *handle2);
            let both = objects.get(first).zip(objects.get(second));
            both.is_some_and(|(co1, co2)| {
                filtering.allow(filters, co1, co2).unwrap_or_else(|| {
                    narrow_phase.contact_pair(objects, first, second).is_some()
                        || narrow_phase.proximity_pair(objects, first, second).is_some()
                })
            })
        };
        interactions.clear();
        broad_phase.update(&mut filter, &mut |&handle1, &handle2, has_started| {
            interactions.push((in_order(handle1, handle2), has_started));
        });
        let interactions = core::mem::take(&mut self.interactions);
        self.begin_and_end_pairs(&interactions);
        self.interactions = interactions;
        self.objects.table.compact();
    }

    /// Passes a started or stopped pair to the narrow phase.
    fn begin_or_end_pair(&mut self, pair: HandlePair, has_started: bool) {
        self.begin_and_end_pairs(&[(pair, has_started)]);
    }

    /// Passes started and stopped pairs to the narrow phase, in chunks of [`BATCH`]. The object
    /// table has rows only for objects with pairs in the narrow phase, and for objects of the
    /// chunk.
    fn begin_and_end_pairs(&mut self, interactions: &[Interaction]) {
        interactions.chunks(BATCH).for_each(|some| self.begin_and_end_batch(some));
    }

    fn begin_and_end_batch(&mut self, interactions: &[Interaction]) {
        for ((first, second), _) in interactions.iter().filter(|(_, has_started)| *has_started) {
            self.objects.acquire_row(first.index());
            self.objects.acquire_row(second.index());
        }
        let (events, objects) = (&mut self.events, &self.objects);
        self.narrow_phase.handle_interactions(events, objects, interactions);
        for (pair, _) in interactions.iter().filter(|(_, has_started)| !has_started) {
            self.release_rows(*pair);
        }
    }

    /// Releases the table row of each object of a stopped pair, unless the narrow phase has another
    /// pair of the object.
    pub(super) fn release_rows(&mut self, pair: HandlePair) {
        for handle in [pair.0, pair.1] {
            if !self.narrow_phase.has_pairs_of(handle) {
                self.objects.table.release(handle.index());
            }
        }
    }
}

/// Returns two handles in canonical order, the smaller first.
pub(super) fn in_order(
    handle1: CollisionObjectHandle,
    handle2: CollisionObjectHandle,
) -> HandlePair {
    if handle2 < handle1 { (handle2, handle1) } else { (handle1, handle2) }
}

/// The status of a pair: `Touching` if it has contact points, `Near` with its proximity if that is
/// not `Disjoint`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum StepStatus {
    Touching,
    Near(Proximity),
}

/// Replacing the phases. The present phases are used until the next update, which creates all
/// proxies anew.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Replaces the broad phase. The new broad phase must be empty; it can have any type that is
    /// `Clone`, `Send` and `Sync`.
    ///
    /// The new broad phase takes over at the next update, which reports changes as any other update
    /// does, and ends all marks.
    pub fn set_broad_phase(&mut self, broad_phase: Box<WorldBroadPhase<N, D>>) {
        self.next_broad_phase = Some(broad_phase);
    }

    /// Returns the broad phase that found the pairs of the last update.
    #[cfg(feature = "debug_render")]
    pub(crate) fn broad_phase(&self) -> &WorldBroadPhase<N, D> {
        &*self.broad_phase
    }

    /// Replaces the narrow phase. The new narrow phase must have no pairs; it can have any type
    /// that is `Clone`.
    ///
    /// The new narrow phase takes over at the next update, which reports changes as any other
    /// update does, and ends all marks. Contacts get new ids.
    pub fn set_narrow_phase(&mut self, narrow_phase: Box<dyn WorldsNarrowPhase<N, D, T>>) {
        self.next_narrow_phase = Some(narrow_phase);
    }

    /// Updates with a new broad phase or a new narrow phase. All proxies are new, so the broad
    /// phase reports every pair as started. If the narrow phase stays, it keeps its pairs: most
    /// started pairs are already there, and old pairs that the broad phase no longer reports are
    /// stopped. A new narrow phase starts without pairs; its events are the differences between the
    /// old and the new statuses.
    fn update_with_other_phases(&mut self, filtering: &mut Filtering<'_, N, D, T>) {
        self.end_marks();
        let Some(mut narrow_phase) = self.next_narrow_phase.take() else {
            let before = self.renew_proxies();
            self.write_changes();
            let now = self.started_pairs(filtering);
            self.stop_all_but(&now, before);
            return self.narrow_phase.update(&self.objects, &mut self.events);
        };
        let before = self.statuses();
        if let (Some(old), Some(new)) = (self.narrow_phase.ids(), narrow_phase.ids()) {
            core::mem::swap(old, new);
        }
        self.narrow_phase = narrow_phase;
        let pairs = self.renew_proxies();
        self.write_changes();
        let alone = self.objects.bodies().filter(|body| body.has_self_pair());
        for handle in alone.map(|body| body.handle).collect::<Vec<_>>() {
            // Has no effect for a pair with itself that began in this update.
            self.begin_or_end_pair((handle, handle), true);
        }
        self.started_pairs(filtering);
        pairs.into_iter().for_each(|pair| self.release_rows(pair));
        self.narrow_phase.update(&self.objects, &mut Events::default());
        push_differences(&before, &self.statuses(), &mut self.events);
    }

    /// Removes all proxies and creates new ones, in the next broad phase if there is one. Returns
    /// the pairs of the removed proxies.
    fn renew_proxies(&mut self) -> Vec<HandlePair> {
        let known = self.objects.bodies().map(|body| (body.handle, body.proxy));
        let (handles, proxies): (Vec<_>, Vec<_>) = known.unzip();
        let mut pairs = Vec::new();
        self.broad_phase.remove(&proxies, &mut |&handle1, &handle2| {
            pairs.push(in_order(handle1, handle2));
        });
        if let Some(broad_phase) = self.next_broad_phase.take() {
            self.broad_phase = broad_phase;
        }
        for handle in handles {
            let body = self.objects.body(handle.index()).expect("it was listed as there");
            let volume = self.objects.changes.volume(body);
            let proxy = self.broad_phase.create_proxy(volume, handle);
            self.objects.set_proxy(handle, proxy);
        }
        pairs
    }

    /// Updates the broad phase and returns the pairs that started, sorted.
    fn started_pairs(&mut self, filtering: &mut Filtering<'_, N, D, T>) -> Vec<HandlePair> {
        self.update_broad_phase(filtering);
        let started = self.interactions.iter().filter(|(_, has_started)| *has_started);
        let mut pairs: Vec<_> = started.map(|&(pair, _)| pair).collect();
        pairs.sort_unstable();
        pairs
    }

    /// Stops the pairs of `before` that are not in the sorted list `now`.
    fn stop_all_but(&mut self, now: &[HandlePair], before: Vec<HandlePair>) {
        for pair in before {
            if now.binary_search(&pair).is_err() {
                self.begin_or_end_pair(pair, false);
            }
        }
    }

    /// Returns the pairs that have contacts or are not disjoint, with their statuses, in ascending
    /// order.
    fn statuses(&self) -> Vec<(HandlePair, StepStatus)> {
        let contacts = self.narrow_phase.contact_pairs(&self.objects);
        let touching = contacts.filter(|(_, _, pair)| pair.num_contacts() > 0);
        let touching = touching.map(|(h1, h2, _)| ((h1, h2), StepStatus::Touching));
        let proximities = self.narrow_phase.proximity_pairs(&self.objects);
        let near = proximities.filter(|(_, _, pair)| pair.proximity() != Proximity::Disjoint);
        let near = near.map(|(h1, h2, pair)| ((h1, h2), StepStatus::Near(pair.proximity())));
        let mut statuses: Vec<_> = touching.chain(near).collect();
        statuses.sort_unstable();
        statuses
    }
}

/// Pushes the events for the differences between two sorted lists of statuses.
fn push_differences(
    before: &[(HandlePair, StepStatus)],
    after: &[(HandlePair, StepStatus)],
    events: &mut Events,
) {
    let find = |list: &[(HandlePair, StepStatus)], pair| {
        let found = list.binary_search_by_key(&pair, |&(other, _)| other);
        found.ok().map(|index| list[index].1)
    };
    for &(pair, status) in before {
        push_change(pair, Some(status), find(after, pair), events);
    }
    for &(pair, status) in after {
        if find(before, pair).is_none() {
            push_change(pair, None, Some(status), events);
        }
    }
}

/// Pushes the events for the change from one status of a pair to another. `None` is the status of a
/// pair that is disjoint or does not exist.
fn push_change(
    pair: HandlePair,
    before: Option<StepStatus>,
    after: Option<StepStatus>,
    events: &mut Events,
) {
    let (collider1, collider2) = pair;
    let touching = |status| status == Some(StepStatus::Touching);
    let proximity = |status| match status {
        Some(StepStatus::Near(proximity)) => proximity,
        _ => Proximity::Disjoint,
    };
    if touching(before) && !touching(after) {
        events.push_contact(ContactEvent::Stopped(collider1, collider2));
    }
    if touching(after) && !touching(before) {
        events.push_contact(ContactEvent::Started(collider1, collider2));
    }
    let (prev_status, new_status) = (proximity(before), proximity(after));
    events.push_proximity(ProximityEvent { collider1, collider2, prev_status, new_status });
}
