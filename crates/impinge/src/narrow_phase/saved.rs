//! The narrow phase in a saved world: its pairs, in the order in which contacts are read.
//!
//! The manifold requests of pairs and the copies of their solids are not saved, but computed from
//! the object table. The touching flags are computed from the contacts. The algorithm of each pair
//! is chosen again, so that data cannot assign a pair to another algorithm.

use serde::{Deserialize, Serialize};

use super::default_narrow_phase::new_entry;
use super::entry::{ContactEntry, ProximityEntry, Status};
use super::group::{Group, PairKey};
use super::objects::ObjectSolid;
use super::pair_groups::{GroupId, Location};
use super::reuse::Reference;
use super::rewind::Parts;
use super::state::{CompositeState, KeptPoints, OrderedContacts};
use super::substep::PairSolids;
use super::{
    DefaultContactDispatcher, DefaultNarrowPhase, DefaultProximityDispatcher, ObjectTable,
};
use super::{IdAllocator, PairQuery};
use crate::collide::mesh::saved::CompositeRecord;
use crate::collide::saved::ManifoldRecord;
use crate::collide::{CompositeContacts, ManifoldRequest};
use crate::math::numbers::{Damage, Numbers, ensure};
use crate::math::{Mapped, Real, Space};
use crate::query::Proximity;

/// The record of a narrow phase without pairs: the maximum number of points of a manifold, and the
/// tolerance of contact reuse if that is enabled.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct PhaseRecord<N: Real> {
    max_points: u32,
    tolerance: Option<Numbers<N>>,
}

/// The record of a narrow phase.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct NarrowRecord<N: Real> {
    phase: PhaseRecord<N>,
    ids: IdAllocator,
    pub(crate) pairs: Vec<PairRecord<N>>,
}

/// The record of a pair.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct PairRecord<N: Real> {
    /// The handle indices of both objects, the smaller first; equal for the pair of an object with
    /// itself.
    pub(crate) objects: PairKey,
    is_due: bool,
    state: StateRecord<N>,
    reference: Option<ReferenceRecord<N>>,
}

/// The record of the state of a pair, for each kind of query and shape.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
enum StateRecord<N: Real> {
    Contacts { number: u64, is_swapped: bool, manifold: ManifoldRecord<N> },
    Composite { number: u64, is_swapped: bool, contacts: CompositeRecord<N> },
    Proximity(Proximity),
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
struct ReferenceRecord<N: Real> {
    /// The relative pose, then the bound `reach`.
    numbers: Numbers<N>,
    distances: Numbers<N>,
    pause: u8,
}

/// The record of a pair that was computed since the last update.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct SubstepRecord<N: Real> {
    objects: PairKey,
    /// The poses of both objects at the time of the computation.
    poses: Numbers<N>,
}

impl<N: Real, const D: usize> Reference<N, D> {
    fn record(&self) -> ReferenceRecord<N> {
        let mut numbers = Numbers::default();
        numbers.extend_pose(&self.pose21);
        numbers.extend(&[self.reach]);
        let distances = Numbers::of(self.distances.iter().copied());
        ReferenceRecord { numbers, distances, pause: self.pause }
    }
}

impl<N: Real> ReferenceRecord<N> {
    /// Restores the reference of a pair that has `contacts` contacts.
    fn restore<const D: usize>(&self, contacts: usize) -> Result<Reference<N, D>, Damage> {
        let (pose21, reach) = self.numbers.all(|n| Ok((n.pose()?, n.number()?)))?;
        // A paused reference is set again before it is used, so its distances may belong to earlier
        // contacts.
        let is_used = self.pause == 0 && reach.is_finite_number();
        let is_whole = self.distances.len() == contacts || !is_used;
        ensure(is_whole, "a reference has other distances than contacts")?;
        let distances = self.distances.clone().into_vec().into();
        Ok(Reference { pose21, reach, pause: self.pause, distances })
    }
}

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Returns the record of the phase without pairs; `None` if it has a custom dispatcher.
    pub(crate) fn phase_record(&self) -> Option<PhaseRecord<N>> {
        let max_points = self.contact_dispatcher.built_in_for_all()?;
        let is_reusing = self.groups.composites.references.is_some();
        let record = PhaseRecord {
            max_points: u32::try_from(max_points).unwrap_or(u32::MAX),
            tolerance: is_reusing.then(|| Numbers::of([self.tolerance])),
        };
        self.proximity_dispatcher.is_built_in_for_all().then_some(record)
    }

    /// Returns the record of the phase; `None` if it has a custom dispatcher.
    pub(crate) fn record(&self) -> Option<NarrowRecord<N>> {
        let phase = self.phase_record()?;
        let mut pairs = Vec::with_capacity(self.pairs.len());
        for group in self.groups.contacts.all() {
            pairs.extend(group.pair_records(Reference::record, |entry| {
                let (raw, is_swapped) = entry.state.kept();
                StateRecord::Contacts { number: entry.number, is_swapped, manifold: raw.record() }
            }));
        }
        pairs.extend(self.groups.composites.pair_records(Reference::record, |entry| {
            let OrderedContacts { swapped, contacts } = &entry.state;
            let (number, is_swapped) = (entry.number, *swapped);
            StateRecord::Composite { number, is_swapped, contacts: contacts.record() }
        }));
        for group in self.groups.proximity.all() {
            let unused = |(): &()| unreachable!("proximities have no references");
            let state = |entry: &ProximityEntry<N>| StateRecord::Proximity(entry.status.0);
            pairs.extend(group.pair_records(unused, state));
        }
        Some(NarrowRecord { phase, ids: self.ids.clone(), pairs })
    }
}

impl<S: Parts, V, R> Group<S, V, R> {
    /// Iterates over the records of the pairs, in order of their rows.
    fn pair_records<'a, N: Real>(
        &'a self,
        reference: impl Fn(&R) -> ReferenceRecord<N> + 'a,
        state: impl Fn(&S) -> StateRecord<N> + 'a,
    ) -> impl Iterator<Item = PairRecord<N>> + 'a {
        (0..self.keys.len()).map(move |at| PairRecord {
            objects: self.keys[at],
            is_due: self.dirty[at],
            state: state(&self.states[at]),
            reference: self.references.as_ref().map(|references| reference(&references[at])),
        })
    }
}

impl<S: Parts, V: Default, R: Clone + Default> Group<S, V, R> {
    /// Adds a saved pair, which is dirty only if `is_due` is `true`, and returns its row.
    fn push_restored(
        &mut self,
        (key, state): (PairKey, S),
        is_touching: bool,
        is_due: bool,
    ) -> u32 {
        let row = self.push(key, state, is_touching);
        self.dirty[row as usize] = is_due;
        row
    }

    /// Sets the reference of the pair in a row, if the group stores references.
    fn restore_reference(&mut self, row: u32, reference: Option<R>) {
        if let Some((references, reference)) = self.references.as_mut().zip(reference) {
            references[row as usize] = reference;
        }
    }
}

impl<N: Real> PhaseRecord<N> {
    /// Restores the phase, without pairs.
    pub(crate) fn restore<const D: usize>(&self) -> Result<DefaultNarrowPhase<N, D>, Damage>
    where
        N: Space<D>,
    {
        let contacts = DefaultContactDispatcher::<D>::with_max_points(self.max_points as usize);
        let proximity = DefaultProximityDispatcher::<D>::new();
        let phase = DefaultNarrowPhase::with_dispatchers(Box::new(contacts), Box::new(proximity));
        let Some(tolerance) = &self.tolerance else { return Ok(phase) };
        let [tolerance] = tolerance.array()?;
        phase.try_reusing(tolerance).map_err(|error| Damage::found(&error))
    }
}

impl<N: Real> NarrowRecord<N> {
    /// Restores the phase with its pairs. `table` must have the rows of their objects.
    pub(crate) fn restore<const D: usize>(
        self,
        table: &ObjectTable<N, D>,
    ) -> Result<DefaultNarrowPhase<N, D>, Damage>
    where
        N: Space<D>,
    {
        let mut phase = self.phase.restore()?;
        phase.ids = self.ids;
        for pair in &self.pairs {
            let [first, second] = pair.objects;
            let is_known = first <= second && table.has_row(first) && table.has_row(second);
            ensure(is_known, "a pair has no objects")?;
            ensure(phase.pairs.insert(first, second).is_new, "a pair is there twice")?;
            let location = phase.restore_pair(table, pair)?;
            phase.locations.push(location);
            if pair.is_due {
                phase.dirty_pairs.push(pair.objects);
            }
        }
        Ok(phase)
    }
}

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Adds the state of a saved pair to its group and returns its location. Fails if the state
    /// does not have the kind of the pair's algorithm.
    fn restore_pair(
        &mut self,
        table: &ObjectTable<N, D>,
        pair: &PairRecord<N>,
    ) -> Result<Location, Damage> {
        let (key, other) = (pair.objects, || Damage("a pair is kept as another sort is".into()));
        let (group, max_points) = self.built_in_group(table, key).ok_or_else(other)?;
        let (query, groups) = (table.query(key[0]).pair(table.query(key[1])), &mut self.groups);
        let reference = |contacts| pair.reference.as_ref().map(|r| r.restore(contacts)).transpose();
        let row = match (group, query, &pair.state) {
            (
                GroupId::Contacts(kinds),
                PairQuery::Contacts { linear, angular },
                StateRecord::Contacts { number, is_swapped, manifold },
            ) => {
                let request =
                    ManifoldRequest::new(table.beyond_skins(key, linear), angular, max_points);
                let mut entry = new_entry(table, key, request, *number);
                entry.state.keep(manifold.restore()?, *is_swapped);
                let (group, contacts) = (groups.contacts.made(kinds), entry.state.len());
                let row = group.push_restored((key, entry), contacts > 0, pair.is_due);
                group.restore_reference(row, reference(contacts)?);
                row
            }
            (
                GroupId::Composites,
                PairQuery::Contacts { linear, angular },
                StateRecord::Composite { number, is_swapped, contacts },
            ) => {
                let request =
                    ManifoldRequest::new(table.beyond_skins(key, linear), angular, max_points);
                let mut entry = ContactEntry::<N, CompositeState<N, D>>::new(request, *number);
                let order = if *is_swapped { [key[1], key[0]] } else { key };
                let shapes = order.mapped(|object| table.shape(object).geometry());
                let contacts = CompositeContacts::restored(contacts, shapes)?;
                entry.state = OrderedContacts { swapped: *is_swapped, contacts };
                let (group, contacts) = (&mut groups.composites, entry.state.len());
                let row = group.push_restored((key, entry), contacts > 0, pair.is_due);
                group.restore_reference(row, reference(contacts)?);
                row
            }
            (
                GroupId::Proximity(kinds),
                PairQuery::Proximity { margin },
                StateRecord::Proximity(status),
            ) => {
                let entry = ProximityEntry { margin, status: Status(*status) };
                let group = groups.proximity.made(kinds);
                group.push_restored((key, entry), false, pair.is_due)
            }
            _ => return Err(other()),
        };
        Ok(Location { group, row })
    }
}

impl<N: Space<D>, const D: usize> ObjectTable<N, D> {
    /// Returns the records of the pairs that were computed since the last update.
    pub(crate) fn substep_records(&self) -> Vec<SubstepRecord<N>> {
        let record = |pair: &PairSolids<N, D>| {
            let mut poses = Numbers::default();
            pair.solids.iter().for_each(|solid| poses.extend_pose(&solid.pose));
            SubstepRecord { objects: pair.key, poses }
        };
        self.substeps.iter().map(record).collect()
    }

    /// Restores the pairs that were computed since the last update. Fails if they are not in order,
    /// or if an object has no row.
    pub(crate) fn restore_substeps(&mut self, records: &[SubstepRecord<N>]) -> Result<(), Damage> {
        let are_sorted = records.is_sorted_by(|one, other| one.objects < other.objects);
        ensure(are_sorted, "substeps are not in order")?;
        for SubstepRecord { objects, poses } in records {
            ensure(objects.iter().all(|&object| self.has_row(object)), "a substep has no objects")?;
            let poses = poses.all(|poses| Ok([poses.pose()?, poses.pose()?]))?;
            let [first, second] = [0, 1].map(|side| {
                let shape = self.shape(objects[side]).clone();
                ObjectSolid { pose: poses[side], shape }
            });
            self.substeps.push(PairSolids { key: *objects, solids: [first, second] });
        }
        Ok(())
    }
}
