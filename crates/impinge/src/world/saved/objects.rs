//! The objects of a saved world.

use serde::{Deserialize, Serialize};

use super::super::bodies::{MAX_CHANGES, WorldBody};
use super::super::changes::BodyChanges;
use super::super::error::{usable_pose, usable_query};
use super::super::fork::DefaultBroadPhase;
use super::super::objects::Slot;
use super::super::removed::RemovedObjects;
use super::super::{CollisionGroups, CollisionObject, CollisionObjects};
use crate::broad_phase::ProxyHandle;
use crate::generation::Generation;
use crate::math::numbers::{Damage, Numbers, ensure};
use crate::math::{Real, Space};
use crate::narrow_phase::saved::PairRecord;
use crate::narrow_phase::{CollisionObjectHandle, GeometricQueryType, ObjectRow};
use crate::shape::ShapeHandle;
use crate::shape::saved::{ShapeRecords, UnsavedShape, shape_of};

/// The record of an object in its present state.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "N: Real, T: Serialize", deserialize = "N: Real, T: Deserialize<'de>"))]
pub(super) struct ObjectRecord<N: Real, T> {
    index: u32,
    row: RowRecord<N>,
    groups: CollisionGroups,
    is_fixed: bool,
    predicted: Option<Numbers<N>>,
    /// The kinds of changes since the last update; `None` if there are none.
    changes: Option<BodyChanges>,
    /// The row of the object table, which has the state of the last update. `None` if the object
    /// has no row, or if its row equals the present state.
    table: Option<RowRecord<N>>,
    data: T,
}

/// The record of the properties of an object that the narrow phase reads.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
struct RowRecord<N: Real> {
    shape: u32,
    position: Numbers<N>,
    query: QueryRecord<N>,
    skin: Option<Numbers<N>>,
}

/// The record of a query type: both predictions, or the margin.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
enum QueryRecord<N: Real> {
    Contacts(Numbers<N>),
    Proximity(Numbers<N>),
}

/// The record of a removed object whose handle is in an event.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "N: Real, T: Serialize", deserialize = "N: Real, T: Deserialize<'de>"))]
pub(super) struct RemovedRecord<N: Real, T> {
    generation: u16,
    /// The index and the generation of the object's [`ProxyHandle`].
    proxy: (u32, u16),
    object: ObjectRecord<N, T>,
}

/// By handle index: the row of the object table and the skin at the last update, for an object with
/// pairs that has changed since.
pub(super) type RestoredRows<N, const D: usize> = Vec<Option<(ObjectRow<N, D>, N)>>;

impl<N: Real> RowRecord<N> {
    fn of<const D: usize>(
        shape: u32,
        position: &N::Isometry,
        query: GeometricQueryType<N>,
        skin: N,
    ) -> Self
    where
        N: Space<D>,
    {
        let query = match query {
            GeometricQueryType::Contacts(linear, angular) => {
                QueryRecord::Contacts(Numbers::of([linear, angular]))
            }
            GeometricQueryType::Proximity(margin) => QueryRecord::Proximity(Numbers::of([margin])),
        };
        let skin = (skin > N::ZERO).then(|| Numbers::of([skin]));
        Self { shape, position: Numbers::of_isometry::<D>(position), query, skin }
    }

    /// Returns the row and the skin.
    fn restore<const D: usize>(
        &self,
        handle: CollisionObjectHandle,
        shapes: &[ShapeHandle<N, D>],
    ) -> Result<(ObjectRow<N, D>, N), Damage>
    where
        N: Space<D>,
    {
        let isometry = usable_isometry::<N, D>(&self.position)?;
        let query = match &self.query {
            QueryRecord::Contacts(numbers) => {
                let [linear, angular] = numbers.array()?;
                GeometricQueryType::Contacts(linear, angular)
            }
            QueryRecord::Proximity(margin) => {
                let [margin] = margin.array()?;
                GeometricQueryType::Proximity(margin)
            }
        };
        let query = usable_query(query).map_err(|error| Damage::found(&error))?;
        let skin = match &self.skin {
            Some(skin) => skin.array::<1>()?[0],
            None => N::ZERO,
        };
        ensure(skin >= N::ZERO && skin.is_finite_number(), "a skin is no length")?;
        let shape = shape_of(shapes, self.shape)?.clone();
        Ok((ObjectRow { handle, isometry, shape, query }, skin))
    }
}

fn usable_isometry<N: Space<D>, const D: usize>(
    numbers: &Numbers<N>,
) -> Result<N::Isometry, Damage> {
    let isometry = numbers.isometry()?;
    usable_pose::<N, D>(&isometry, None).map_err(|error| Damage::found(&error))?;
    Ok(isometry)
}

impl<N: Space<D>, const D: usize, T> CollisionObjects<N, D, T> {
    /// Returns the records of the objects, in order of their handle indices.
    pub(super) fn records(
        &self,
        shapes: &mut ShapeRecords<N>,
    ) -> Result<Vec<ObjectRecord<N, &T>>, UnsavedShape> {
        self.iter().map(|object| self.record(object, shapes)).collect()
    }

    fn record<'a>(
        &self,
        object: &'a CollisionObject<N, D, T>,
        shapes: &mut ShapeRecords<N>,
    ) -> Result<ObjectRecord<N, &'a T>, UnsavedShape> {
        let (body, table) = (&object.body, &self.table);
        let index = body.index();
        let row = row(body, self.changes.skin(index), shapes)?;
        let mut record = described(object, row);
        record.predicted = self.changes.prediction(body).map(Numbers::of_isometry::<D>);
        record.changes = self.changes.of_body(body);
        if table.has_row(index) {
            let shape = shapes.number(table.shape(index))?;
            let (position, query) = (table.isometry(index), table.query(index));
            let row = RowRecord::of::<D>(shape, position, query, table.skin(index));
            record.table = (!row.has_bits_of(&record.row)).then_some(row);
        }
        Ok(record)
    }

    /// Creates a table of handles without objects, from the generations by index and the free
    /// indices.
    pub(super) fn restored(generations: Vec<u16>, free: Vec<u32>) -> Result<Self, Damage> {
        ensure(generations.len() <= MAX_CHANGES as usize, "there are too many handles")?;
        let mut objects = Self::new();
        let slot = |count| Slot::without_object(objects.first.with_count(count));
        objects.slots = generations.into_iter().map(slot).collect();
        objects.free = free;
        Ok(objects)
    }

    /// Adds all objects under their handles. Returns the rows at the last update of the objects
    /// that have changed since.
    pub(super) fn put_all(
        &mut self,
        records: Vec<ObjectRecord<N, T>>,
        shapes: &[ShapeHandle<N, D>],
    ) -> Result<RestoredRows<N, D>, Damage> {
        let mut rows = RestoredRows::new();
        rows.resize_with(self.slots.len(), || None);
        let are_sorted = records.is_sorted_by(|one, other| one.index < other.index);
        ensure(are_sorted, "objects are not in order")?;
        for record in records {
            let slot = self.slots.get(record.index as usize);
            let slot = slot.ok_or(Damage("an object has no handle".into()))?;
            let handle = CollisionObjectHandle::new(record.index, slot.generation);
            if let Some(row) = &record.table {
                rows[handle.uid()] = Some(row.restore(handle, shapes)?);
            }
            self.put(handle, record, shapes)?;
        }
        let exists = |&index: &u32| (index as usize) < self.slots.len();
        ensure(self.free.iter().all(exists), "there is no such handle to be free")?;
        Ok(rows)
    }

    fn put(
        &mut self,
        handle: CollisionObjectHandle,
        record: ObjectRecord<N, T>,
        shapes: &[ShapeHandle<N, D>],
    ) -> Result<(), Damage> {
        let (predicted, changes) = (record.predicted.as_ref(), record.changes);
        let predicted = predicted.map(usable_isometry::<N, D>).transpose()?;
        let (mut object, skin) = record.restore(handle, NOT_YET, shapes)?;
        let body = &mut object.body;
        if let Some(predicted) = predicted {
            body.restore_predicted();
            self.changes.predict(handle.index(), predicted);
        }
        if skin > N::ZERO {
            self.changes.put_skin(handle.index(), skin);
            self.table.set_skin(handle.index(), skin);
        }
        if let Some(changes) = changes {
            self.changes.restore_changes(body, changes);
        }
        let place = u32::try_from(self.records.len()).map_err(|_| Damage("many objects".into()))?;
        self.slots[handle.uid()].record = place;
        self.records.push(object);
        Ok(())
    }

    /// Stores the handle of an object's proxy in the object, and returns the object's handle.
    pub(super) fn take_proxy(
        &mut self,
        index: u32,
        proxy: ProxyHandle,
    ) -> Result<CollisionObjectHandle, Damage> {
        let place = self.slots.get(index as usize).map(|slot| slot.record as usize);
        let object = place.and_then(|place| self.records.get_mut(place));
        let body = &mut object.ok_or(Damage("a proxy has no object".into()))?.body;
        ensure(body.proxy == NOT_YET, "an object has two proxies")?;
        body.proxy = proxy;
        Ok(body.handle)
    }

    /// Writes the rows of the objects of all pairs to the object table, and marks the objects that
    /// have a pair with themselves. Fails if an object has no proxy, or if an object of a pair does
    /// not exist.
    pub(super) fn lend_all(
        &mut self,
        pairs: &[PairRecord<N>],
        rows: &mut RestoredRows<N, D>,
    ) -> Result<(), Damage> {
        ensure(self.bodies().all(|body| body.proxy != NOT_YET), "an object has no proxy")?;
        for &PairRecord { objects: [first, second], .. } in pairs {
            for index in [first, second] {
                self.lend_again(index, rows)?;
            }
            if first == second
                && let Some(object) =
                    self.records.get_mut(self.slots[first as usize].record as usize)
            {
                object.body.toggle_self_pair();
            }
        }
        Ok(())
    }

    fn lend_again(&mut self, index: u32, rows: &mut RestoredRows<N, D>) -> Result<(), Damage> {
        ensure(self.body(index).is_some(), "a pair has no objects")?;
        match rows[index as usize].take() {
            Some((row, skin)) => {
                self.table.set_skin(index, skin);
                self.table.acquire(index, || row);
            }
            None => self.acquire_row(index),
        }
        Ok(())
    }

    /// Checks that the broad phase has, for each object that is not dirty, the volume that follows
    /// from the object's state.
    pub(super) fn check_boxes(&self, broad_phase: &DefaultBroadPhase<N, D>) -> Result<(), Damage> {
        let is_right = |body: &WorldBody<N, D>| {
            let is_dirty = self.changes.is_dirty(body);
            is_dirty || *broad_phase.given_volume(body.proxy) == self.changes.volume(body)
        };
        ensure(self.bodies().all(is_right), "the box of an object is another one's")
    }

    /// Iterates over the proxies of each pair of two different objects. Omits pairs whose objects
    /// do not exist.
    pub(super) fn proxies_of<'a>(
        &'a self,
        pairs: &'a [PairRecord<N>],
    ) -> impl Iterator<Item = [ProxyHandle; 2]> + 'a {
        let two = pairs.iter().map(|pair| pair.objects).filter(|[first, second]| first != second);
        two.filter_map(|[first, second]| Some([self.body(first)?.proxy, self.body(second)?.proxy]))
    }
}

/// A placeholder for the proxy of an object, until the broad phase is restored.
const NOT_YET: ProxyHandle = ProxyHandle::new(u32::MAX, u16::MAX);

/// Returns the record of an object's present shape, position, query type and skin.
fn row<N: Space<D>, const D: usize>(
    body: &WorldBody<N, D>,
    skin: N,
    shapes: &mut ShapeRecords<N>,
) -> Result<RowRecord<N>, UnsavedShape> {
    let shape = shapes.number(&body.shape)?;
    Ok(RowRecord::of::<D>(shape, &body.isometry, body.query.get(), skin))
}

/// Returns the record of an object with `row` as its present properties, without prediction,
/// changes and table row.
fn described<N: Space<D>, const D: usize, T>(
    object: &CollisionObject<N, D, T>,
    row: RowRecord<N>,
) -> ObjectRecord<N, &T> {
    let CollisionObject { body, data } = object;
    ObjectRecord {
        index: body.index(),
        row,
        groups: body.groups,
        is_fixed: body.is_fixed(),
        predicted: None,
        changes: None,
        table: None,
        data,
    }
}

impl<N: Real, T> ObjectRecord<N, T> {
    /// Restores the object, without its prediction, changes and table row. Returns the object and
    /// its skin.
    fn restore<const D: usize>(
        self,
        handle: CollisionObjectHandle,
        proxy: ProxyHandle,
        shapes: &[ShapeHandle<N, D>],
    ) -> Result<(CollisionObject<N, D, T>, N), Damage>
    where
        N: Space<D>,
    {
        let (row, skin) = self.row.restore(handle, shapes)?;
        let mut body = WorldBody::new(row, self.groups, proxy);
        if self.is_fixed {
            body.restore_fixed();
        }
        Ok((CollisionObject { body, data: self.data }, skin))
    }
}

impl<N: Space<D>, const D: usize, T> RemovedObjects<N, D, T> {
    /// Returns the records of the removed objects, in order of their handles.
    pub(super) fn records<'a>(
        &'a self,
        shapes: &mut ShapeRecords<N>,
    ) -> Result<Vec<RemovedRecord<N, &'a T>>, UnsavedShape> {
        let record = |object: &'a CollisionObject<N, D, T>| {
            let CollisionObject { body, .. } = object;
            let proxy =
                (u32::try_from(body.proxy.uid()).unwrap_or(u32::MAX), body.proxy.generation());
            let object = described(object, row(body, N::ZERO, shapes)?);
            Ok(RemovedRecord { generation: body.handle.generation().count(), proxy, object })
        };
        self.objects.values().map(record).collect()
    }

    /// Restores the removed objects whose handles are in events, with handles of the table whose
    /// first generation is `first`.
    pub(super) fn restore(
        &mut self,
        records: Vec<RemovedRecord<N, T>>,
        first: Generation,
        shapes: &[ShapeHandle<N, D>],
    ) -> Result<(), Damage> {
        for RemovedRecord { generation, proxy, object } in records {
            let handle = CollisionObjectHandle::new(object.index, first.with_count(generation));
            let (object, _) = object.restore(handle, ProxyHandle::new(proxy.0, proxy.1), shapes)?;
            self.objects.insert(handle, object);
        }
        Ok(())
    }
}

impl<N: Real> RowRecord<N> {
    /// Returns `true` if both records are equal, and their positions have the same bits.
    fn has_bits_of(&self, other: &Self) -> bool {
        let bits = |numbers: &Numbers<N>| numbers.clone().into_vec().into_iter().map(Real::bits);
        self == other && bits(&self.position).eq(bits(&other.position))
    }
}
