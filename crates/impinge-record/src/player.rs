//! Applies recorded calls to a world.

use impinge::bounding_volume::Aabb;
use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::Pose;
use impinge::narrow_phase::{CollisionObjectHandle, DefaultNarrowPhase, GeometricQueryType};
use impinge::shape::{Ball, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld};

use crate::RecordData;
use crate::call::{Call, KeyFrame, ObjectData};
use crate::divergence::Difference;
use crate::error::Problem;
use crate::query::{Asked, CastQuestion, PlacedShape, Query, Question, RayQuestion, answer_hash};
use crate::question_data::{QueryData, QuestionData};
use crate::recorder::index_of;
use crate::registry::Registry;
use crate::shapes::ShapeTable;
use crate::space::Recordable;
use crate::state::{Observation, Observer};

/// The data to which records refer: shapes, named filters and the margin.
#[derive(Debug)]
pub(crate) struct Resources<N: Recordable<D>, const D: usize, T> {
    pub(crate) shapes: ShapeTable<N, D>,
    pub(crate) registry: Registry<N, D, T>,
    pub(crate) margin: N,
}

/// A world, with the handles of its objects by their index in the recording.
#[derive(Debug)]
pub(crate) struct Player<N: Recordable<D>, const D: usize, T> {
    pub(crate) world: CollisionWorld<N, D, T>,
    handles: Vec<Option<CollisionObjectHandle>>,
    observer: Observer,
    /// The sorted pairs of indices that the filter of the next update rejects; empty if it rejects
    /// none, or if the update has no filter.
    refused: Vec<[u32; 2]>,
    /// The queries since the last update, with their results.
    asked: Vec<Asked<N, D>>,
    /// The queries between the last two updates, with their results.
    pub(crate) queries: Vec<Asked<N, D>>,
    /// Whether no call was applied yet, apart from those that define shapes. A key frame then
    /// creates the objects; otherwise it only replaces the phases.
    is_new: bool,
    /// Whether a key frame has created the objects and no update followed. In the next update all
    /// pairs start.
    is_remade: bool,
    /// Whether the events of the last update include events of a rebuilt world, which differ from
    /// the recorded events.
    has_other_events: bool,
    /// Whether `keep_events` was called since the last update.
    keeps_events: bool,
}

/// The bound of the new indices that a replay passes over. A recorded world may have retired indices
/// above all its objects before the recording began, and no key frame lists those. The bound limits
/// the memory that an invalid recording can request.
const MAX_UNKNOWN: usize = 1 << 10;

/// Replaces the phases of a world (the broad phase and the narrow phase) by new ones, whose pairs
/// start at the next update. The later results then depend only on the objects, not on the history
/// of the world.
pub(crate) fn exchange_phases<N: Recordable<D>, const D: usize, T>(
    world: &mut CollisionWorld<N, D, T>,
    margin: N,
) {
    let broad_phase = DBVTBroadPhase::<N, Aabb<N, D>, CollisionObjectHandle>::new(margin);
    world.set_broad_phase(Box::new(broad_phase));
    world.set_narrow_phase(Box::new(DefaultNarrowPhase::<N, D>::new()));
}

impl<N: Recordable<D>, const D: usize, T: RecordData> Player<N, D, T> {
    /// Creates a player with a new world.
    pub(crate) fn new(margin: N) -> Result<Self, Problem> {
        Ok(Self::around(CollisionWorld::try_new(margin)?))
    }

    /// Creates a player that applies the calls to `world`, which must have no objects.
    pub(crate) fn around(world: CollisionWorld<N, D, T>) -> Self {
        let (handles, asked, queries) = (Vec::new(), Vec::new(), Vec::new());
        let (observer, refused) = (Observer::default(), Vec::new());
        Self {
            world,
            handles,
            observer,
            refused,
            asked,
            queries,
            is_new: true,
            is_remade: false,
            has_other_events: false,
            keeps_events: false,
        }
    }

    /// Applies a call. Returns the difference between its result and the recorded one; `None` if
    /// they are equal.
    pub(crate) fn apply(
        &mut self,
        call: Call<N, D>,
        resources: &Resources<N, D, T>,
    ) -> Result<Option<Difference>, Problem> {
        let is_new = std::mem::replace(&mut self.is_new, false);
        match call {
            Call::Shape(_) | Call::End { .. } => self.is_new = is_new,
            Call::Add(object) => self.add(object, resources)?,
            Call::SetPositions(positions) => self.set_positions(&positions)?,
            Call::SetShape { index, shape } => {
                let shape = resources.shapes.get(shape)?.clone();
                self.world.try_set_shape(self.handle(index)?, shape)?;
            }
            Call::SetGroups { index, groups } => {
                self.world.try_set_collision_groups(self.handle(index)?, groups)?;
            }
            Call::SetQueryType { index, query_type } => {
                self.world.try_set_query_type(self.handle(index)?, query_type)?;
            }
            Call::SetData { index, data } => self.set_data(index, &data)?,
            Call::SetFixed { index, is_fixed } => {
                self.world.try_set_fixed(self.handle(index)?, is_fixed)?;
            }
            Call::SetSkin { index, skin } => self.world.try_set_skin(self.handle(index)?, skin)?,
            Call::Predict { index, position, predicted } => {
                let handle = self.handle(index)?;
                self.world.try_set_position_with_prediction(handle, position, predicted)?;
            }
            Call::Refilter(None) => self.world.refilter_pairs(),
            Call::Refilter(Some(index)) => {
                self.world.try_refilter_pairs_of(self.handle(index)?)?;
            }
            Call::Refuse(pairs) => self.refuse(pairs),
            Call::KeepEvents => {
                self.world.keep_events();
                self.keeps_events = true;
            }
            Call::UpdatePair([one, two]) => {
                self.world.try_update_pair(self.handle(one)?, self.handle(two)?)?;
            }
            Call::Remove(indices) => self.remove(&indices)?,
            Call::RegisterFilter(name) => self.register(&name, resources)?,
            Call::UnregisterFilter(name) => {
                self.world.unregister_broad_phase_pair_filter(&name);
            }
            Call::Query(query) => return self.ask(&query, resources),
            Call::KeyFrame(frame) if is_new => self.remake(frame, resources)?,
            Call::KeyFrame(_) => self.begin_anew(resources.margin),
            Call::Update(recorded) => return Ok(self.update(&recorded)),
        }
        Ok(None)
    }

    /// Returns the handle of the object with an index; an error if there is none.
    fn handle(&self, index: u32) -> Result<CollisionObjectHandle, Problem> {
        let handle = self.handles.get(index as usize).copied().flatten();
        handle.ok_or(Problem::NoSuchObject(index))
    }

    /// Adds an object, which must get the recorded index.
    fn add(
        &mut self,
        object: ObjectData<N, D>,
        resources: &Resources<N, D, T>,
    ) -> Result<(), Problem> {
        let ObjectData { index, position, shape, groups, query_type, data } = object;
        let (shape, data) = (resources.shapes.get(shape)?.clone(), data_of(&data)?);
        let passed = self.pass_retired(index)?;
        let added = self.world.try_add(position, shape, groups, query_type, data);
        // In this order the free indices are those of before, without `index`.
        passed.iter().rev().try_for_each(|index| self.remove(&[*index]))?;
        self.enter(added?, index)
    }

    /// Holds the places of the indices that the world would assign before `index`, and returns
    /// these indices in order.
    ///
    /// The recorded world has retired them: it does not reuse an index whose generations are
    /// exhausted. A world that is rebuilt at a key frame counts generations from 0, so it would
    /// still assign them. The temporary objects do not change results, which are in the order of
    /// handles.
    fn pass_retired(&mut self, index: u32) -> Result<Vec<u32>, Problem> {
        let mut passed = Vec::new();
        while let Some(next) = self.next_before(index) {
            self.hold_place(next)?;
            passed.push(next);
        }
        Ok(passed)
    }

    /// Returns the index that the world assigns next, if it differs from `index` and the world may
    /// assign `index` afterwards; otherwise `None`.
    fn next_before(&self, index: u32) -> Option<u32> {
        let (free, new) = (self.world.vacant_indices().next_back(), self.handles.len());
        let is_before = match free {
            Some(free) => free != index as usize,
            None => new < MAX_UNKNOWN.min(index as usize),
        };
        u32::try_from(free.unwrap_or(new)).ok().filter(|_| is_before)
    }

    /// Stores the handle of a new object, which must have the recorded index.
    fn enter(&mut self, handle: CollisionObjectHandle, index: u32) -> Result<(), Problem> {
        if handle.uid() != index as usize {
            return Err(Problem::OtherIndex { recorded: index, replayed: handle.uid() });
        }
        // The world assigned the index. So it exceeds the largest earlier index by at most one, and
        // the list grows little.
        if self.handles.len() <= handle.uid() {
            self.handles.resize(handle.uid() + 1, None);
        }
        self.handles[handle.uid()] = Some(handle);
        Ok(())
    }

    /// Moves objects one by one. A recorder writes this call only if all of them can be moved.
    fn set_positions(&mut self, positions: &[(u32, N::Isometry)]) -> Result<(), Problem> {
        for (index, position) in positions {
            self.world.try_set_position(self.handle(*index)?, *position)?;
        }
        Ok(())
    }

    /// Replaces the data of an object. Filters that read it are not called again for existing
    /// pairs.
    fn set_data(&mut self, index: u32, data: &[u8]) -> Result<(), Problem> {
        let handle = self.handle(index)?;
        let object = self.world.collision_object_mut(handle);
        *object.ok_or(Problem::NoSuchObject(index))?.data_mut() = data_of(data)?;
        Ok(())
    }

    /// Makes the next update reject these pairs.
    fn refuse(&mut self, mut pairs: Vec<[u32; 2]>) {
        pairs.sort_unstable();
        self.refused = pairs;
    }

    /// Updates the world. If the filter of the recorded update rejected pairs, this update rejects
    /// the same pairs.
    fn update_world(&mut self) {
        let refused = std::mem::take(&mut self.refused);
        if refused.is_empty() {
            return self.world.update();
        }
        self.world.update_with(&mut |one, two| {
            refused.binary_search(&[one, two].map(|object| index_of(object.handle()))).is_err()
        });
    }

    /// Removes objects, which frees their indices.
    fn remove(&mut self, indices: &[u32]) -> Result<(), Problem> {
        let handles: Result<Vec<_>, _> = indices.iter().map(|index| self.handle(*index)).collect();
        self.world.try_remove(&handles?)?;
        indices.iter().for_each(|index| self.handles[*index as usize] = None);
        Ok(())
    }

    /// Registers a filter of the registry by its name.
    fn register(&mut self, name: &str, resources: &Resources<N, D, T>) -> Result<(), Problem> {
        let is_known = resources.registry.register(name, &mut self.world);
        if is_known { Ok(()) } else { Err(Problem::UnknownFilter(name.to_owned())) }
    }

    /// Runs a recorded query and compares the hash of its result with the recorded one.
    fn ask(
        &mut self,
        query: &QueryData<N, D>,
        resources: &Resources<N, D, T>,
    ) -> Result<Option<Difference>, Problem> {
        let handles = query.excluded.iter().map(|index| self.handle(*index));
        let excluded = handles.collect::<Result<_, _>>()?;
        let question = question_of(&query.question, &resources.shapes)?;
        let asked = Query { question, groups: query.groups, excluded };
        let answer = asked.ask(&self.world);
        let is_same = answer_hash(&answer) == query.answer;
        self.asked.push(Asked { query: asked, answer, is_same });
        Ok((!is_same).then_some(Difference::Answer))
    }

    /// Replaces the phases of the world, as the recorder did at the key frame.
    fn begin_anew(&mut self, margin: N) {
        exchange_phases(&mut self.world, margin);
        self.observer = Observer::default();
    }

    /// Adds the objects of a key frame with their indices to an empty world.
    fn remake(
        &mut self,
        frame: KeyFrame<N, D>,
        resources: &Resources<N, D, T>,
    ) -> Result<(), Problem> {
        // The filters are registered now, and first called by the next update.
        for name in &frame.filters {
            self.register(name, resources)?;
        }
        let mut vacant = frame.vacant.clone();
        vacant.sort_unstable();
        let mut vacant = vacant.into_iter().peekable();
        for object in frame.objects {
            while let Some(index) = vacant.next_if(|index| *index < object.index) {
                self.hold_place(index)?;
            }
            self.add(object, resources)?;
        }
        vacant.try_for_each(|index| self.hold_place(index))?;
        // The free indices are freed in this order, so that the last one is used next.
        frame.vacant.iter().try_for_each(|index| self.remove(&[*index]))?;
        self.begin_anew(resources.margin);
        self.is_remade = true;
        Ok(())
    }

    /// Adds a temporary object that only occupies an index. The caller removes the temporary object
    /// before the next update.
    fn hold_place(&mut self, index: u32) -> Result<(), Problem> {
        let (position, ball) = (N::isometry(&Pose::identity()), Ball::try_new(N::ONE)?);
        let (shape, groups) = (ShapeHandle::new(ball), CollisionGroups::empty());
        let query_type = GeometricQueryType::Proximity(N::ZERO);
        let handle = self.world.try_add(position, shape, groups, query_type, T::default())?;
        self.enter(handle, index)
    }

    /// Updates the world and compares its hashes with the recorded ones. The hashes of objects are
    /// compared only if the hash of the state differs.
    fn update(&mut self, recorded: &Observation) -> Option<Difference> {
        let before = self.observer.clone();
        self.update_world();
        self.queries = std::mem::take(&mut self.asked);
        let replayed = self.observer.observe(&self.world);
        // The recorded world had its pairs before the key frame, while in a rebuilt world all pairs
        // start. Events that differ for this reason are not compared.
        let keeps_events = std::mem::take(&mut self.keeps_events);
        let has_other_events = std::mem::take(&mut self.is_remade);
        self.has_other_events = has_other_events || self.has_other_events && keeps_events;
        if replayed.state != recorded.state {
            let known = recorded.changed.as_ref();
            let known = known.map(|changed| before.after(changed, &self.observer));
            let object = known.and_then(|known| self.observer.difference(&known));
            return Some(object.unwrap_or(Difference::State));
        }
        let are_same = self.has_other_events || replayed.events == recorded.events;
        (!are_same).then_some(Difference::Events)
    }
}

/// Decodes the user data of an object.
fn data_of<T: RecordData>(bytes: &[u8]) -> Result<T, Problem> {
    T::from_bytes(bytes).ok_or(Problem::BadValue { what: "the data of an object" })
}

/// Converts a recorded query to one with shapes instead of their indices.
fn question_of<N: Recordable<D>, const D: usize>(
    question: &QuestionData<N, D>,
    shapes: &ShapeTable<N, D>,
) -> Result<Question<N, D>, Problem> {
    let placed = |position: &N::Isometry, shape: u32| -> Result<PlacedShape<N, D>, Problem> {
        Ok(PlacedShape { position: *position, shape: shapes.get(shape)?.clone() })
    };
    Ok(match question {
        QuestionData::Ray { all, ray, max_time, solid } => {
            let question = RayQuestion { ray: *ray, max_time: *max_time, solid: *solid };
            if *all { Question::RayHits(question) } else { Question::FirstRayHit(question) }
        }
        QuestionData::Containing(point) => Question::Containing(*point),
        QuestionData::Project { point, max_distance, solid } => {
            Question::ProjectPoint { point: *point, max_distance: *max_distance, solid: *solid }
        }
        QuestionData::InAabb(aabb) => Question::InAabb(*aabb),
        QuestionData::Overlapping { position, shape } => {
            Question::Overlapping(placed(position, *shape)?)
        }
        QuestionData::Nearest { position, shape, count, max_distance } => Question::Nearest {
            from: placed(position, *shape)?,
            count: *count,
            max_distance: *max_distance,
        },
        QuestionData::Cast(cast) => {
            let start = placed(&cast.position, cast.shape)?;
            let question = CastQuestion { start, velocity: cast.velocity, options: cast.options };
            if cast.all { Question::CastShapeAll(question) } else { Question::CastShape(question) }
        }
    })
}
