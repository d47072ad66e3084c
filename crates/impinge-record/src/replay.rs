//! Recordings played: to any step, forwards and backwards.

use impinge::world::CollisionWorld;

use crate::RecordData;
use crate::call::Call;
use crate::error::{Problem, ReadError};
use crate::log::{Checker, Raw};
use crate::player::{Player, Resources};
use crate::registry::Registry;
use crate::shapes::ShapeTable;
use crate::space::Recordable;

/// In what a replay first differs from its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Divergence {
    /// The number of updates before the call that differs.
    pub step: usize,
    /// The offset of its record in bytes.
    pub offset: usize,
    /// What differs.
    pub difference: Difference,
}

/// What differs between a replay and its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Difference {
    /// An object after an update: the first in order of the handles.
    Object {
        /// The index of its handle.
        index: usize,
        /// What of it.
        field: ObjectField,
    },
    /// The state after an update, though the hashes of all objects agree: these have 32 bits.
    State,
    /// The events of an update.
    Events,
    /// The answer of a query.
    Answer,
}

/// What of an object differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectField {
    /// Its position, groups or query type.
    Description,
    /// The pairs in which it is the first, their contacts and proximities.
    Pairs,
}

/// A key frame by the number of updates before it.
#[derive(Clone, Copy, Debug)]
struct FrameMark {
    step: usize,
    offset: usize,
}

/// A recording and the world that it makes, at a step: after so many updates.
///
/// Going forwards applies the calls of each step, or those from a key frame on, if one is nearer. Going backwards
/// makes the world anew, from the last key frame at least two updates before the step, or from the start.
///
/// Memory: the shapes of the recording, eight bytes for each update, and one world.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
/// use impinge_record::{Recorder, Registry, Replay};
///
/// let registry = Registry::<f32, 2, ()>::new();
/// let mut recorder = Recorder::new(0.02, registry.clone())?;
/// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// let ball = recorder.add(Isometry::identity(), ball, CollisionGroups::new(), query, ())?;
/// for step in 0..10_u8 {
///     recorder.set_position(ball, Isometry::translation(f32::from(step), 0.0))?;
///     recorder.update();
/// }
/// let bytes = recorder.finish().bytes;
///
/// let mut replay = Replay::open(&bytes, &registry).expect("it was just written");
/// let x = |replay: &Replay<'_, f32, 2, ()>| {
///     replay.world().collision_objects().next().map(|ball| ball.position().translation.x)
/// };
/// replay.seek(10).expect("its calls can be applied");
/// assert_eq!(x(&replay), Some(9.0));
/// replay.seek(3).expect("its calls can be applied");
/// assert_eq!((x(&replay), replay.step(), replay.len()), (Some(2.0), 3, 10));
/// # Ok::<(), impinge_record::RecordError>(())
/// ```
#[derive(Debug)]
pub struct Replay<'a, N: Recordable<D>, const D: usize, T> {
    bytes: &'a [u8],
    resources: Resources<N, D, T>,
    /// Where the first record begins.
    start: usize,
    /// Where the record after each update begins.
    steps: Vec<usize>,
    frames: Vec<FrameMark>,
    player: Player<N, D, T>,
    step: usize,
    /// Where the next record begins.
    offset: usize,
    divergence: Option<Divergence>,
}

impl<'a, N: Recordable<D>, const D: usize, T: RecordData> Replay<'a, N, D, T> {
    /// A recording at step 0: before the first call. All of it is read and its shapes are made.
    ///
    /// # Errors
    /// If the bytes are not a whole recording of this scalar and dimension, by this version of the format or an
    /// earlier one; if the registry lacks a name.
    pub fn open(bytes: &'a [u8], registry: &Registry<N, D, T>) -> Result<Self, ReadError> {
        let mut checker = Checker::new(bytes);
        let (margin, start) = checker.header::<N, D>()?;
        let resources = Resources { shapes: ShapeTable::new(), registry: registry.clone(), margin };
        let made = Player::new(margin).map_err(|problem| ReadError { offset: 0, problem });
        let (steps, frames, player) = (Vec::new(), Vec::new(), made?);
        let (step, offset, divergence) = (0, start, None);
        let mut replay =
            Self { bytes, resources, start, steps, frames, player, step, offset, divergence };
        replay.scan(&mut checker)?;
        Ok(replay)
    }

    /// Reads all records: their checksums and fields, the shapes, and where updates and key frames are.
    fn scan(&mut self, checker: &mut Checker<'_>) -> Result<(), ReadError> {
        let mut offset = self.start;
        loop {
            let raw = Raw::at(self.bytes, offset)?;
            checker.check(offset..raw.fields.end)?;
            let call = raw.call::<N, D>(self.bytes)?;
            let error = |problem| ReadError { offset, problem };
            match call {
                Call::Shape(shape) => {
                    let Resources { shapes, registry, .. } = &mut self.resources;
                    shapes.define(&shape, registry).map_err(error)?;
                }
                Call::KeyFrame(_) => self.frames.push(FrameMark { step: self.steps.len(), offset }),
                Call::Update(_) => self.steps.push(raw.end),
                Call::End { updates } => return self.check_end(updates, raw.end),
                _ => {}
            }
            offset = raw.end;
        }
    }

    /// The last record counts the updates, and nothing follows it.
    fn check_end(&self, updates: u64, offset: usize) -> Result<(), ReadError> {
        if updates != self.steps.len() as u64 {
            let problem = Problem::BadValue { what: "the number of updates" };
            return Err(ReadError { offset, problem });
        }
        let is_last = offset == self.bytes.len();
        let problem = Problem::TrailingBytes;
        if is_last { Ok(()) } else { Err(ReadError { offset, problem }) }
    }

    /// The world at the step.
    #[must_use]
    pub const fn world(&self) -> &CollisionWorld<N, D, T> {
        &self.player.world
    }

    /// How many updates the world has had.
    #[must_use]
    pub const fn step(&self) -> usize {
        self.step
    }

    /// How many updates the recording has.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.steps.len()
    }

    /// The recording has no update.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// The first difference from the recording in what was played so far, in any direction.
    #[must_use]
    pub const fn divergence(&self) -> Option<Divergence> {
        self.divergence
    }

    /// Goes to a step, forwards or backwards: to where its update has just been. Beyond the last step it goes to
    /// the last.
    ///
    /// # Errors
    /// If a call cannot be applied: the bytes are of no recorder. The world is then after the calls before it.
    pub fn seek(&mut self, step: usize) -> Result<(), ReadError> {
        let step = step.min(self.len());
        let frames = self.frames.partition_point(|frame| frame.step + 2 <= step);
        let frame = frames.checked_sub(1).map(|last| self.frames[last]);
        let is_nearer = frame.is_some_and(|frame| frame.step > self.step);
        if step < self.step || is_nearer {
            self.restart(frame.unwrap_or(FrameMark { step: 0, offset: self.start }))?;
        }
        while self.step < step {
            self.apply_next()?;
        }
        Ok(())
    }

    /// Applies the calls after the last update too, where queries may be.
    fn finish(&mut self) -> Result<(), ReadError> {
        while self.offset < self.bytes.len() {
            self.apply_next()?;
        }
        Ok(())
    }

    /// A new world before a key frame, or before the first call.
    fn restart(&mut self, mark: FrameMark) -> Result<(), ReadError> {
        let FrameMark { step, offset } = mark;
        let made = Player::new(self.resources.margin);
        self.player = made.map_err(|problem| ReadError { offset, problem })?;
        (self.step, self.offset) = (step, offset);
        Ok(())
    }

    fn apply_next(&mut self) -> Result<(), ReadError> {
        let offset = self.offset;
        let raw = Raw::at(self.bytes, offset)?;
        let call = raw.call::<N, D>(self.bytes)?;
        let is_update = matches!(call, Call::Update(_));
        let applied = self.player.apply(call, &self.resources);
        let difference = applied.map_err(|problem| ReadError { offset, problem })?;
        let step = self.step;
        let found = difference.map(|difference| Divergence { step, offset, difference });
        self.divergence = self.divergence.or(found);
        self.step += usize::from(is_update);
        self.offset = raw.end;
        Ok(())
    }
}

/// Plays a whole recording and compares every hash: `None` if the replay is the recording, to the bit.
///
/// Where the hash of the state differs, the hashes of its objects, which the recording has too, name the first
/// object in order of the handles.
///
/// # Errors
/// As [`Replay::open`] and [`Replay::seek`].
pub fn validate<N: Recordable<D>, const D: usize, T: RecordData>(
    bytes: &[u8],
    registry: &Registry<N, D, T>,
) -> Result<Option<Divergence>, ReadError> {
    let mut replay = Replay::open(bytes, registry)?;
    // Every call from the first on, whatever key frames there are.
    replay.finish()?;
    Ok(replay.divergence)
}
