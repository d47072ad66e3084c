//! The records that follow the header, and their fields.

use impinge::math::Space;
use impinge::narrow_phase::GeometricQueryType;
use impinge::world::{CollisionGroups, GroupError};

use crate::bytes::{Sink, Source};
use crate::error::{Problem, ReadError};
use crate::marks::EventCounts;
use crate::question_data::QueryData;
use crate::shape_data::ShapeData;
use crate::space::{Recordable, Scalar};
use crate::state::{ObjectHashes, Observation};

/// The codes of the records that packing splits into fields.
pub(crate) mod kinds {
    pub(crate) const ADD: u8 = 2;
    pub(crate) const SET_POSITIONS: u8 = 3;
    pub(crate) const KEY_FRAME: u8 = 12;
    pub(crate) const UPDATE: u8 = 15;
}

/// An object in a record: the arguments of the call that adds it, or its state in a key frame.
#[derive(Clone, Debug)]
pub(crate) struct ObjectData<N: Space<D>, const D: usize> {
    /// The index of the object's handle.
    pub(crate) index: u32,
    pub(crate) position: N::Isometry,
    /// The index of its shape in the recording.
    pub(crate) shape: u32,
    pub(crate) groups: CollisionGroups,
    pub(crate) query_type: GeometricQueryType<N>,
    pub(crate) data: Vec<u8>,
}

/// A snapshot of all objects, from which a world is rebuilt.
#[derive(Clone, Debug)]
pub(crate) struct KeyFrame<N: Space<D>, const D: usize> {
    /// The names of the registered filters.
    pub(crate) filters: Vec<String>,
    /// The free indices of objects; the last one is used next.
    pub(crate) vacant: Vec<u32>,
    /// The objects sorted by index.
    pub(crate) objects: Vec<ObjectData<N, D>>,
}

/// A record: a call of the recorder, or data for other records.
#[derive(Clone, Debug)]
pub(crate) enum Call<N: Space<D>, const D: usize> {
    /// Defines the next shape, whose index is the number of earlier shapes.
    Shape(ShapeData<N, D>),
    /// Adds an object. Its index is the next one that the world assigns.
    Add(ObjectData<N, D>),
    /// Moves objects. A recorder writes this record only if all of them were moved.
    SetPositions(Vec<(u32, N::Isometry)>),
    SetShape {
        index: u32,
        shape: u32,
    },
    SetGroups {
        index: u32,
        groups: CollisionGroups,
    },
    SetQueryType {
        index: u32,
        query_type: GeometricQueryType<N>,
    },
    SetData {
        index: u32,
        data: Vec<u8>,
    },
    SetFixed {
        index: u32,
        is_fixed: bool,
    },
    SetSkin {
        index: u32,
        skin: N,
    },
    /// Moves an object, with a prediction of its next position.
    Predict {
        index: u32,
        position: N::Isometry,
        predicted: N::Isometry,
    },
    /// Filters the pairs of one object again, or with `None` all pairs.
    Refilter(Option<u32>),
    /// Makes the next update reject these pairs of indices, which are sorted.
    Refuse(Vec<[u32; 2]>),
    KeepEvents,
    UpdatePair([u32; 2]),
    /// Removes objects. The index of the last one in the list is used next.
    Remove(Vec<u32>),
    RegisterFilter(String),
    UnregisterFilter(String),
    /// Runs a query, which does not change the world.
    Query(Box<QueryData<N, D>>),
    /// All objects of the world. A new player adds these objects. Every player then replaces the
    /// broad phase and the narrow phase of its world by new ones.
    KeyFrame(KeyFrame<N, D>),
    /// Updates the world, with the hashes of the state after it.
    Update(Observation),
    /// The last record, with the number of updates.
    End {
        updates: u64,
    },
}

impl<N: Recordable<D>, const D: usize> Call<N, D> {
    /// Returns the code of the kind of record in the format.
    pub(crate) const fn kind(&self) -> u8 {
        match self {
            Self::Shape(_) => 1,
            Self::Add(_) => kinds::ADD,
            Self::SetPositions(_) => kinds::SET_POSITIONS,
            Self::SetShape { .. } => 4,
            Self::SetGroups { .. } => 5,
            Self::SetQueryType { .. } => 6,
            Self::SetData { .. } => 7,
            Self::Remove(_) => 8,
            Self::RegisterFilter(_) => 9,
            Self::UnregisterFilter(_) => 10,
            Self::Query(_) => 11,
            Self::KeyFrame(_) => kinds::KEY_FRAME,
            Self::End { .. } => 14,
            Self::Update(_) => kinds::UPDATE,
            Self::SetFixed { .. } => 16,
            Self::SetSkin { .. } => 17,
            Self::Predict { .. } => 18,
            Self::Refilter(_) => 19,
            Self::Refuse(_) => 20,
            Self::KeepEvents => 21,
            Self::UpdatePair(_) => 22,
        }
    }

    /// Writes the fields of the record. [`Self::read`] reads them in the same order.
    pub(crate) fn write(&self, sink: &mut Sink) {
        match self {
            Self::Shape(shape) => sink.shape(shape),
            Self::Add(object) => sink.object(object),
            Self::SetPositions(positions) => {
                sink.count(positions.len());
                for (index, position) in positions {
                    sink.word(*index);
                    sink.isometry::<N, D>(position);
                }
            }
            Self::SetShape { index, shape } => sink.words(&[*index, *shape]),
            Self::SetGroups { index, groups } => {
                sink.word(*index);
                sink.groups(groups);
            }
            Self::SetQueryType { index, query_type } => {
                sink.word(*index);
                sink.query_type(*query_type);
            }
            Self::SetData { index, data } => {
                sink.word(*index);
                sink.blob(data);
            }
            Self::SetFixed { index, is_fixed } => {
                sink.word(*index);
                sink.flag(*is_fixed);
            }
            Self::SetSkin { index, skin } => {
                sink.word(*index);
                sink.number(*skin);
            }
            Self::Predict { index, position, predicted } => {
                sink.word(*index);
                sink.isometry::<N, D>(position);
                sink.isometry::<N, D>(predicted);
            }
            Self::Refilter(index) => {
                sink.flag(index.is_some());
                sink.words(index.as_slice());
            }
            Self::Refuse(pairs) => {
                sink.count(pairs.len());
                sink.words(pairs.as_flattened());
            }
            Self::KeepEvents => {}
            Self::UpdatePair(pair) => sink.words(pair),
            Self::Remove(indices) => {
                sink.count(indices.len());
                sink.words(indices);
            }
            Self::RegisterFilter(name) | Self::UnregisterFilter(name) => sink.blob(name.as_bytes()),
            Self::Query(query) => sink.query(query),
            Self::KeyFrame(frame) => sink.key_frame(frame),
            Self::Update(observation) => sink.observation(observation),
            Self::End { updates } => sink.long(*updates),
        }
    }

    /// Reads the fields of a record with this code; an error if bytes are left.
    pub(crate) fn read(kind: u8, source: &mut Source<'_>) -> Result<Self, ReadError> {
        let call = Self::fields(kind, source)?;
        source.finish()?;
        Ok(call)
    }

    /// Reads the fields of a record with the code [`Self::kind`].
    fn fields(kind: u8, source: &mut Source<'_>) -> Result<Self, ReadError> {
        Ok(match kind {
            1 => Self::Shape(source.shape()?),
            kinds::ADD => Self::Add(source.object()?),
            kinds::SET_POSITIONS => Self::SetPositions(
                source.list(4, |source| Ok((source.word()?, source.isometry::<N, D>()?)))?,
            ),
            4 => Self::SetShape { index: source.word()?, shape: source.word()? },
            5 => Self::SetGroups { index: source.word()?, groups: source.groups()? },
            6 => Self::SetQueryType { index: source.word()?, query_type: source.query_type()? },
            7 => Self::SetData { index: source.word()?, data: source.blob()?.to_vec() },
            8 => Self::Remove(source.list(4, Source::word)?),
            9 => Self::RegisterFilter(source.text()?),
            10 => Self::UnregisterFilter(source.text()?),
            11 => Self::Query(Box::new(source.query()?)),
            kinds::KEY_FRAME => Self::KeyFrame(source.key_frame()?),
            13 => Self::Update(source.first_observation()?),
            14 => Self::End { updates: source.long()? },
            kinds::UPDATE => Self::Update(source.observation()?),
            16 => Self::SetFixed { index: source.word()?, is_fixed: source.flag()? },
            17 => Self::SetSkin { index: source.word()?, skin: source.number()? },
            18 => Self::Predict {
                index: source.word()?,
                position: source.isometry::<N, D>()?,
                predicted: source.isometry::<N, D>()?,
            },
            19 => Self::Refilter(if source.flag()? { Some(source.word()?) } else { None }),
            20 => Self::Refuse(source.list(8, |source| Ok([source.word()?, source.word()?]))?),
            21 => Self::KeepEvents,
            22 => Self::UpdatePair([source.word()?, source.word()?]),
            _ => return Err(source.error(Problem::UnknownRecord(kind))),
        })
    }
}

/// Writes the fields of records.
impl Sink {
    pub(crate) fn words(&mut self, words: &[u32]) {
        words.iter().for_each(|word| self.word(*word));
    }

    /// Writes the three masks and the flag of self-interaction.
    pub(crate) fn groups(&mut self, groups: &CollisionGroups) {
        let lists = [groups.whitelist_mask(), groups.blacklist_mask()];
        self.word(groups.membership_mask());
        self.words(&lists);
        self.flag(groups.can_interact_with_self());
    }

    fn query_type<N: Scalar>(&mut self, query_type: GeometricQueryType<N>) {
        match query_type {
            GeometricQueryType::Contacts(linear, angular) => {
                self.byte(0);
                self.numbers(&[linear, angular]);
            }
            GeometricQueryType::Proximity(margin) => {
                self.byte(1);
                self.number(margin);
            }
        }
    }

    /// Writes an added object, or an object of a key frame.
    fn object<N: Recordable<D>, const D: usize>(&mut self, object: &ObjectData<N, D>) {
        self.word(object.index);
        self.isometry::<N, D>(&object.position);
        self.word(object.shape);
        self.groups(&object.groups);
        self.query_type(object.query_type);
        self.blob(&object.data);
    }

    fn key_frame<N: Recordable<D>, const D: usize>(&mut self, frame: &KeyFrame<N, D>) {
        self.count(frame.filters.len());
        frame.filters.iter().for_each(|name| self.blob(name.as_bytes()));
        self.count(frame.vacant.len());
        self.words(&frame.vacant);
        self.count(frame.objects.len());
        frame.objects.iter().for_each(|object| self.object(object));
    }

    /// Writes the hashes and counts of an update, and twelve bytes for each changed object.
    fn observation(&mut self, observation: &Observation) {
        self.long(observation.state);
        self.long(observation.events);
        let EventCounts { started, stopped, proximities } = observation.counts.unwrap_or_default();
        self.words(&[started, stopped, proximities]);
        self.flag(observation.changed.is_some());
        let Some(changed) = &observation.changed else { return };
        self.count(changed.len());
        for ObjectHashes { index, description, pairs } in changed {
            self.words(&[*index, *description, *pairs]);
        }
    }
}

/// Reads the fields of records.
impl Source<'_> {
    /// Reads the groups of an object. A mask with a bit above 29 is an error.
    pub(crate) fn groups(&mut self) -> Result<CollisionGroups, ReadError> {
        let offset = self.offset();
        let [membership, whitelist, blacklist] = [self.word()?, self.word()?, self.word()?];
        let groups = CollisionGroups::new()
            .try_with_membership_by_mask(membership)
            .and_then(|groups| groups.try_with_whitelist_by_mask(whitelist))
            .and_then(|groups| groups.try_with_blacklist_by_mask(blacklist));
        let refused = |error: GroupError| ReadError { offset, problem: error.into() };
        let mut groups = groups.map_err(refused)?;
        if self.flag()? {
            groups.enable_self_collision();
        }
        Ok(groups)
    }

    fn query_type<N: Scalar>(&mut self) -> Result<GeometricQueryType<N>, ReadError> {
        Ok(match self.choice(2, "the kind of a query type")? {
            0 => GeometricQueryType::Contacts(self.number()?, self.number()?),
            _ => GeometricQueryType::Proximity(self.number()?),
        })
    }

    fn object<N: Recordable<D>, const D: usize>(&mut self) -> Result<ObjectData<N, D>, ReadError> {
        Ok(ObjectData {
            index: self.word()?,
            position: self.isometry::<N, D>()?,
            shape: self.word()?,
            groups: self.groups()?,
            query_type: self.query_type()?,
            data: self.blob()?.to_vec(),
        })
    }

    fn key_frame<N: Recordable<D>, const D: usize>(&mut self) -> Result<KeyFrame<N, D>, ReadError> {
        Ok(KeyFrame {
            filters: self.list(4, Self::text)?,
            vacant: self.list(4, Self::word)?,
            objects: self.list(32, Self::object)?,
        })
    }

    /// Reads the observation of an update in format version 1.
    fn first_observation(&mut self) -> Result<Observation, ReadError> {
        let (state, events) = (self.long()?, self.long()?);
        Ok(Observation { state, events, counts: None, changed: Some(self.object_hashes()?) })
    }

    fn observation(&mut self) -> Result<Observation, ReadError> {
        let (state, events) = (self.long()?, self.long()?);
        let [started, stopped, proximities] = [self.word()?, self.word()?, self.word()?];
        let counts = Some(EventCounts { started, stopped, proximities });
        let changed = if self.flag()? { Some(self.object_hashes()?) } else { None };
        Ok(Observation { state, events, counts, changed })
    }

    fn object_hashes(&mut self) -> Result<Vec<ObjectHashes>, ReadError> {
        self.list(12, |source| {
            let [index, description, pairs] = [source.word()?, source.word()?, source.word()?];
            Ok(ObjectHashes { index, description, pairs })
        })
    }
}
