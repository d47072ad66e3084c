//! Saved worlds: the state that determines all later results of a world.
//!
//! | state | how it is saved |
//! |---|---|
//! | objects, with data, skins, predictions and changes since the last update | one record for each object |
//! | shapes | each once, as the input of its constructor ([`crate::shape::saved`]) |
//! | rows of objects with pairs | only rows that differ from the objects |
//! | boxes, proxies, waiting changes of boxes | unchanged; trees are built again, since their order affects only time |
//! | contacts and proximities | in the order in which they are read ([`crate::narrow_phase::saved`]) |
//! | events, and the removed objects whose handles they have | unchanged |
//! | pair filters | by name |
//!
//! A mark ([`CollisionWorld::mark`]) restores the same state; marks themselves are not saved.
//! Derived data are computed again. Data that contradicts itself is refused: a world restored from
//! arbitrary bytes is valid, or there is an error.

mod error;
mod objects;
mod registry;

use core::marker::PhantomData;

use serde::de::{Error as _, IgnoredAny, SeqAccess, Visitor};
use serde::ser::{Error as _, SerializeTuple};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub use self::error::{RestoreError, SaveError};
use self::objects::{ObjectRecord, RemovedRecord};
pub use self::registry::Registry;
use super::fork::{DefaultBroadPhase, History};
use super::{CollisionObjects, CollisionWorld, WorldBroadPhase, WorldsNarrowPhase};
use crate::broad_phase::saved::BroadRecord;
use crate::broad_phase::{DBVTBroadPhase, ProxyHandle};
use crate::generation::Generation;
use crate::math::numbers::{Damage, Numbers, ensure};
use crate::math::{Mapped, Real, Space};
use crate::memory::Recent;
use crate::narrow_phase::saved::{NarrowRecord, PhaseRecord, SubstepRecord};
use crate::narrow_phase::{
    CollisionObjectHandle, ContactEvent, DefaultNarrowPhase, Events, ProximityEvent,
};
use crate::shape::saved::{ShapeRecord, ShapeRecords, make_all};
use crate::world::filter::Filters;
use crate::world::removed::RemovedObjects;

/// The version of the format; data of any other version is refused.
const VERSION: u32 = 1;

/// The data of a saved world that has been read but not validated.
///
/// Deserialize this type instead of a [`CollisionWorld`] if the world needs a [`Registry`], if
/// errors should have the type [`RestoreError`], or if the world is a field of a larger saved
/// state. Numbers keep all their bits in every format of serde.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{
///     CollisionGroups, CollisionObject, CollisionWorld, ContactQuery, Registry, RestoreError, SavedWorld,
/// };
///
/// let teams = |a: &CollisionObject<f32, u8>, b: &CollisionObject<f32, u8>| a.data() != b.data();
/// let mut world = CollisionWorld::<f32, u8>::new(0.02);
/// world.register_broad_phase_pair_filter("teams", teams);
/// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
/// for (x, team) in [(0.0, 1), (1.5, 1), (3.0, 2)] {
///     let at = Isometry::translation(x, 0.0);
///     world.add(at, ball.clone(), groups, ContactQuery::default(), team);
/// }
/// world.update();
/// let text = serde_json::to_string(&world).expect("all of it can be saved");
///
/// let saved: SavedWorld<f32, u8> = serde_json::from_str(&text).expect("saved just now");
/// let unknown = RestoreError::UnknownFilter("teams".to_owned());
/// assert_eq!(saved.restore(&Registry::new()).err(), Some(unknown));
///
/// let saved: SavedWorld<f32, u8> = serde_json::from_str(&text).expect("saved just now");
/// let restored = saved.restore(&Registry::new().with_filter("teams", teams)).expect("the filter is there");
/// assert_eq!(restored.contact_manifolds().count(), 1);
/// ```
#[derive(Debug)]
pub struct SavedWorld<N: Real, const D: usize, T> {
    header: Header,
    /// `None` if the header has another version, scalar or dimension.
    record: Option<WorldRecord<N, T>>,
}

/// The first element of the data. It has the same fields in all versions of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Header {
    version: u32,
    /// Number of bits of a scalar: 32 or 64.
    scalar: u8,
    dimension: u8,
}

/// The second element of the data: all parts of the world.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "N: Real, T: Serialize", deserialize = "N: Real, T: Deserialize<'de>"))]
struct WorldRecord<N: Real, T> {
    shapes: Vec<ShapeRecord<N>>,
    /// By handle index: the number of objects that had this index before.
    generations: Vec<u16>,
    vacant: Vec<u32>,
    objects: Vec<ObjectRecord<N, T>>,
    removed: Vec<RemovedRecord<N, T>>,
    substeps: Vec<SubstepRecord<N>>,
    broad_phase: BroadRecord<N>,
    narrow_phase: NarrowRecord<N>,
    /// The margin of the broad phase that replaces the present one at the next update, if there is
    /// one.
    next_broad_phase: Option<Numbers<N>>,
    next_narrow_phase: Option<PhaseRecord<N>>,
    filters: Vec<String>,
    have_filters_changed: bool,
    events: EventsRecord,
    queued: EventsRecord,
    keeps_events: bool,
    marks: u64,
}

#[derive(Debug, Serialize, Deserialize)]
struct EventsRecord {
    contacts: Vec<ContactEvent>,
    proximities: Vec<ProximityEvent>,
}

impl EventsRecord {
    fn of(events: &Events) -> Self {
        let (contacts, proximities) = (events.contacts().to_vec(), events.proximities().to_vec());
        Self { contacts, proximities }
    }

    /// Restores the events, with handles of the table whose first generation is `first`.
    fn restore(self, first: Generation) -> Events {
        let mut events = Events::default();
        for event in self.contacts {
            events.push_contact(match event {
                ContactEvent::Started(a, b) => ContactEvent::Started(a.of(first), b.of(first)),
                ContactEvent::Stopped(a, b) => ContactEvent::Stopped(a.of(first), b.of(first)),
            });
        }
        for event in self.proximities {
            let [collider1, collider2] = [event.collider1, event.collider2].mapped(|h| h.of(first));
            events.push_proximity(ProximityEvent { collider1, collider2, ..event });
        }
        events
    }
}

impl Header {
    fn of<N, const D: usize>() -> Self {
        let scalar = u8::try_from(8 * size_of::<N>()).unwrap_or(0);
        Self { version: VERSION, scalar, dimension: u8::try_from(D).unwrap_or(0) }
    }

    /// Returns an error unless version, scalar and dimension equal those of `own`.
    fn check(self, own: Self) -> Result<(), RestoreError> {
        let Self { version, scalar, dimension } = self;
        if version != own.version {
            Err(RestoreError::Version { found: version })
        } else if scalar != own.scalar {
            Err(RestoreError::Scalar { found: scalar })
        } else if dimension != own.dimension {
            Err(RestoreError::Dimension { found: dimension })
        } else {
            Ok(())
        }
    }
}

/// Deserializes and restores a world that needs no [`Registry`]. A [`RestoreError`] becomes an
/// error of the deserializer, which has only its text; [`SavedWorld::restore`] returns the typed
/// error.
impl<'de, N: Space<D>, const D: usize, T: Deserialize<'de>> Deserialize<'de>
    for CollisionWorld<N, D, T>
{
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        Registry::new().restore(deserializer)
    }
}

/// Fails if a part of the world cannot be saved; see [`SaveError`].
impl<N: Space<D>, const D: usize, T: Serialize> Serialize for CollisionWorld<N, D, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.saved().map_err(S::Error::custom)?.serialize(serializer)
    }
}

impl<N: Real, const D: usize, T: Serialize> Serialize for SavedWorld<N, D, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Some(record) = &self.record else {
            return Err(S::Error::custom("the world of another kind has not been read"));
        };
        let mut tuple = serializer.serialize_tuple(2)?;
        tuple.serialize_element(&self.header)?;
        tuple.serialize_element(record)?;
        tuple.end()
    }
}

impl<'de, N: Real, const D: usize, T: Deserialize<'de>> Deserialize<'de> for SavedWorld<N, D, T> {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        let can_skip = deserializer.is_human_readable();
        deserializer.deserialize_tuple(2, WorldVisitor { can_skip, world: PhantomData })
    }
}

struct WorldVisitor<N, T, const D: usize> {
    /// Whether the format can skip a value of unknown type. If it can, a world of another version
    /// is read to its end.
    can_skip: bool,
    world: PhantomData<(N, T)>,
}

impl<'de, N: Real, const D: usize, T: Deserialize<'de>> Visitor<'de> for WorldVisitor<N, T, D> {
    type Value = SavedWorld<N, D, T>;

    fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("a saved world: its kind and its parts")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<Self::Value, A::Error> {
        let missing = |what| A::Error::custom(format!("the {what} of the world are missing"));
        let header: Header = parts.next_element()?.ok_or_else(|| missing("version and kind"))?;
        if header.check(Header::of::<N, D>()).is_ok() {
            let record = parts.next_element()?.ok_or_else(|| missing("parts"))?;
            return Ok(SavedWorld { header, record: Some(record) });
        }
        if self.can_skip {
            parts.next_element::<IgnoredAny>()?;
        }
        Ok(SavedWorld { header, record: None })
    }
}

/// Saving a world.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the data of the world, which borrows the user's data. Serializing the world itself
    /// has the same result, but without typed errors.
    ///
    /// After the same calls the restored world has the same results as this world, bit for bit:
    /// contacts with their ids, events (also queued ones), and handles of new objects. Marks are
    /// not saved. The restored world has its own [handles](CollisionObjectHandle):
    /// [`Self::counterpart`] translates handles of the saved world, also deserialized handles.
    ///
    /// Costs a copy of the saved data.
    ///
    /// # Errors
    /// If the world has a custom phase, a custom dispatcher, a compound with too many parts, or a
    /// shape of a user's type that does not implement [`Shape::saved`](crate::shape::Shape::saved);
    /// see [`SaveError`].
    pub fn saved(&self) -> Result<SavedWorld<N, D, &T>, SaveError> {
        Ok(SavedWorld { header: Header::of::<N, D>(), record: Some(self.record()?) })
    }

    fn record(&self) -> Result<WorldRecord<N, &T>, SaveError> {
        let broad_phase = default_broad_phase(&*self.broad_phase)?;
        let narrow_phase = default_narrow_phase(&*self.narrow_phase)?;
        let next_broad_phase = match &self.next_broad_phase {
            Some(next) => {
                let margin = default_broad_phase(&**next)?.unused_margin();
                Some(margin.ok_or(SaveError::BroadPhase)?)
            }
            None => None,
        };
        let next_narrow_phase = match &self.next_narrow_phase {
            Some(next) => {
                let phase = default_narrow_phase(&**next)?.phase_record();
                Some(phase.ok_or(SaveError::NarrowPhase)?)
            }
            None => None,
        };
        let mut shapes = ShapeRecords::new();
        let objects = self.objects.records(&mut shapes)?;
        let removed = self.removed.records(&mut shapes)?;
        Ok(WorldRecord {
            shapes: shapes.records,
            generations: self.objects.slots().iter().map(|slot| slot.generation.count()).collect(),
            vacant: self.objects.free.clone(),
            objects,
            removed,
            substeps: self.objects.table().substep_records(),
            broad_phase: broad_phase.record(|handle| handle.index()),
            narrow_phase: narrow_phase.record().ok_or(SaveError::NarrowPhase)?,
            next_broad_phase,
            next_narrow_phase,
            filters: self.filters.names().map(str::to_owned).collect(),
            have_filters_changed: self.filters.have_changed(),
            events: EventsRecord::of(&self.events),
            queued: EventsRecord::of(&self.queued),
            keeps_events: self.keeps_events,
            marks: self.history.most_marks() as u64,
        })
    }
}

fn default_broad_phase<N: Space<D>, const D: usize>(
    phase: &WorldBroadPhase<N, D>,
) -> Result<&DefaultBroadPhase<N, D>, SaveError> {
    phase.as_any().downcast_ref().ok_or(SaveError::BroadPhase)
}

fn default_narrow_phase<N: Space<D>, const D: usize, T>(
    phase: &dyn WorldsNarrowPhase<N, D, T>,
) -> Result<&DefaultNarrowPhase<N, D>, SaveError> {
    phase.as_any().downcast_ref().ok_or(SaveError::NarrowPhase)
}

impl<N: Space<D>, const D: usize, T> SavedWorld<N, D, T> {
    /// Restores the world. The registry provides the pair filters and the shapes of users' types.
    ///
    /// # Errors
    /// If the data has another version, scalar or dimension; if the registry lacks a name or
    /// rejects a shape; or if the data is invalid.
    pub fn restore(
        self,
        registry: &Registry<N, D, T>,
    ) -> Result<CollisionWorld<N, D, T>, RestoreError> {
        self.header.check(Header::of::<N, D>())?;
        let record = self.record.ok_or(Damage("there is no world".into()))?;
        record.restore(registry)
    }
}

impl<N: Real, T> WorldRecord<N, T> {
    fn restore<const D: usize>(
        self,
        registry: &Registry<N, D, T>,
    ) -> Result<CollisionWorld<N, D, T>, RestoreError>
    where
        N: Space<D>,
    {
        let shapes = make_all(self.shapes, &mut |saved| registry.shape(saved))?;
        let mut objects = CollisionObjects::restored(self.generations, self.vacant)?;
        let mut rows = objects.put_all(self.objects, &shapes)?;
        let first = objects.first;
        let mut removed = RemovedObjects::new();
        removed.restore(self.removed, first, &shapes)?;
        let mut broad_phase = self
            .broad_phase
            .restore(|object, proxy: ProxyHandle| objects.take_proxy(object, proxy))?;
        objects.lend_all(&self.narrow_phase.pairs, &mut rows)?;
        objects.table.restore_substeps(&self.substeps)?;
        broad_phase.restore_pairs(objects.proxies_of(&self.narrow_phase.pairs))?;
        let narrow_phase = self.narrow_phase.restore(&objects.table)?;
        objects.check_boxes(&broad_phase)?;
        objects.validate(&broad_phase).map_err(|what| Damage(what.into()))?;
        let next_broad_phase = self.next_broad_phase.as_ref().map(new_broad_phase).transpose()?;
        let next_narrow_phase = self.next_narrow_phase.map(|phase| phase.restore()).transpose()?;
        Ok(CollisionWorld {
            objects,
            broad_phase: Box::new(broad_phase),
            narrow_phase: Box::new(narrow_phase),
            next_broad_phase,
            next_narrow_phase: next_narrow_phase.map(|phase| Box::new(phase) as _),
            filters: registered(registry, &self.filters, self.have_filters_changed)?,
            events: self.events.restore(first),
            queued: self.queued.restore(first),
            keeps_events: self.keeps_events,
            removed,
            algorithms: Vec::new(),
            interactions: Vec::new(),
            recent: Recent::default(),
            history: History::for_marks(usize::try_from(self.marks).unwrap_or(usize::MAX)),
        })
    }
}

/// Creates an empty broad phase with this margin.
fn new_broad_phase<N: Space<D>, const D: usize>(
    margin: &Numbers<N>,
) -> Result<Box<WorldBroadPhase<N, D>>, Damage> {
    let [margin] = margin.array()?;
    let phase = DBVTBroadPhase::try_new(margin).map_err(|error| Damage::found(&error))?;
    Ok(Box::new(phase))
}

/// Registers the filters with these names, which must ascend.
fn registered<N: Space<D>, const D: usize, T>(
    registry: &Registry<N, D, T>,
    names: &[String],
    have_changed: bool,
) -> Result<Filters<N, D, T>, RestoreError> {
    ensure(names.is_sorted_by(|one, other| one < other), "names of filters are not in order")?;
    let mut filters = Filters::new();
    for name in names {
        filters.register(name, registry.filter(name)?);
    }
    filters.note_change(have_changed);
    Ok(filters)
}

impl CollisionObjectHandle {
    /// Returns the handle with the same index and generation in the table whose first generation is
    /// `first`.
    fn of(self, first: Generation) -> Self {
        Self::new(self.index(), first.with_count(self.generation().count()))
    }
}
