//! Replays recordings to any step, forwards and backwards.

use impinge::world::CollisionWorld;

use crate::RecordData;
use crate::call::Call;
use crate::divergence::Divergence;
use crate::error::{Problem, ReadError};
use crate::log::{Cursor, Header, Raw};
use crate::marks::{FrameMark, Mark, Timeline};
use crate::player::{Player, Resources};
use crate::query::Asked;
use crate::registry::Registry;
use crate::shapes::ShapeTable;
use crate::space::Recordable;

/// A recording and its world at a step, which is the number of applied updates.
///
/// To go forwards, a replay applies the calls of each step; if a key frame lies between, it
/// rebuilds the world from the key frame instead. To go backwards, it rebuilds the world from the
/// last key frame at least two updates before the step, or from the start.
///
/// A replay takes the memory of the recording and its shapes, of a [`Mark`] for each update, and of
/// one world.
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
/// let mut replay = Replay::open(bytes, &registry).expect("it was just written");
/// let x = |replay: &Replay<f32, 2, ()>| {
///     replay.world().collision_objects().next().map(|ball| ball.position().translation.x)
/// };
/// replay.seek(10).expect("its calls can be applied");
/// assert_eq!(x(&replay), Some(9.0));
/// replay.seek(3).expect("its calls can be applied");
/// assert_eq!((x(&replay), replay.step(), replay.len()), (Some(2.0), 3, 10));
/// # Ok::<(), impinge_record::RecordError>(())
/// ```
#[derive(Debug)]
pub struct Replay<N: Recordable<D>, const D: usize, T> {
    bytes: Vec<u8>,
    resources: Resources<N, D, T>,
    /// The position up to which the records were read.
    cursor: Cursor,
    timeline: Timeline,
    /// Whether the last record was read.
    is_complete: bool,
    /// The error after which no more bytes are accepted.
    damage: Option<ReadError>,
    loss: Option<Loss>,
    player: Player<N, D, T>,
    /// Whether the caller may have changed the world.
    is_changed: bool,
    step: usize,
    /// The offset of the next record to be played.
    offset: usize,
    /// The offset of the first record after the update of the current step.
    settled: usize,
    divergence: Option<Divergence>,
}

/// The unreadable end of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Loss {
    /// The offset at which the unreadable part begins; the bytes before it are kept.
    pub offset: usize,
    /// The number of bytes of the unreadable part; 0 if the bytes end after a complete record.
    pub bytes: usize,
    /// The reason why the part could not be read.
    pub error: ReadError,
}

/// The way in which reading ended without an error.
#[derive(Debug)]
enum Reading {
    /// The last record was read.
    Ended,
    /// The next record, or the header, is incomplete. The error describes the missing part.
    Waits(ReadError),
}

impl<N: Recordable<D>, const D: usize, T: RecordData> Replay<N, D, T> {
    /// Opens a recording at step 0, before the first call. Reads all records and makes the shapes.
    ///
    /// # Errors
    /// If the bytes are not a complete recording of this scalar and dimension, in this version of
    /// the format or an earlier one, or if the registry lacks a shape of the recording.
    pub fn open(
        bytes: impl Into<Vec<u8>>,
        registry: &Registry<N, D, T>,
    ) -> Result<Self, ReadError> {
        let mut replay = Self::growing(registry);
        replay.bytes = bytes.into();
        match replay.scan()? {
            Reading::Ended => Ok(replay),
            Reading::Waits(error) => Err(error),
        }
    }

    /// Creates a replay of a recording without bytes, to which [`Self::push`] appends bytes as they
    /// arrive. The world has no objects.
    ///
    /// ```
    /// use impinge_record::{Recorder, Registry, Replay};
    ///
    /// let registry = Registry::<f64, 3, ()>::new();
    /// let mut recorder = Recorder::new(0.02, registry.clone())?;
    /// let mut replay = Replay::growing(&registry);
    /// for _ in 0..3 {
    ///     recorder.update();
    ///     assert_eq!(replay.push(&recorder.take_bytes()), Ok(1), "one update more");
    /// }
    /// assert!(replay.len() == 3 && !replay.is_complete());
    /// replay.push(&recorder.finish().bytes).expect("it goes on");
    /// assert!(replay.is_complete());
    /// # Ok::<(), impinge_record::RecordError>(())
    /// ```
    #[must_use]
    pub fn growing(registry: &Registry<N, D, T>) -> Self {
        // When the header is read, a world with its margin replaces this one.
        let (shapes, margin) = (ShapeTable::new(), N::ZERO);
        Self {
            bytes: Vec::new(),
            resources: Resources { shapes, registry: registry.clone(), margin },
            cursor: Cursor::default(),
            timeline: Timeline::default(),
            is_complete: false,
            damage: None,
            loss: None,
            player: Player::around(CollisionWorld::default()),
            is_changed: false,
            step: 0,
            offset: 0,
            settled: 0,
            divergence: None,
        }
    }

    /// Opens a recording whose end is damaged, or missing because the program crashed. Reads all
    /// records up to the first that is incomplete or invalid. [`Self::loss`] describes the rest.
    ///
    /// Records after a damaged one are not read: each checksum covers the bytes of all earlier
    /// records, so nothing after the first wrong checksum can be trusted.
    ///
    /// # Errors
    /// As [`Self::open`], if the header cannot be read.
    ///
    /// ```
    /// use impinge_record::{Problem, Recorder, Registry, Replay};
    ///
    /// let registry = Registry::<f32, 2, ()>::new();
    /// let mut recorder = Recorder::new(0.02, registry.clone())?;
    /// (0..5).for_each(|_| recorder.update());
    /// let mut bytes = recorder.take_bytes();
    /// bytes.truncate(bytes.len() - 1);
    ///
    /// assert!(Replay::open(bytes.clone(), &registry).is_err(), "the fifth update is not whole");
    /// let replay = Replay::salvage(bytes, &registry).expect("it has a header");
    /// let loss = replay.loss().expect("there is one");
    /// assert_eq!((replay.len(), loss.error.problem.clone()), (4, Problem::Truncated));
    /// # Ok::<(), impinge_record::RecordError>(())
    /// ```
    pub fn salvage(
        bytes: impl Into<Vec<u8>>,
        registry: &Registry<N, D, T>,
    ) -> Result<Self, ReadError> {
        let mut replay = Self::growing(registry);
        replay.bytes = bytes.into();
        let error = match replay.scan() {
            Ok(Reading::Ended) => return Ok(replay),
            Ok(Reading::Waits(error)) | Err(error) => error,
        };
        let offset = replay.cursor.offset();
        if offset == 0 {
            return Err(error);
        }
        let bytes = replay.bytes.len() - offset;
        replay.bytes.truncate(offset);
        replay.loss = Some(Loss { offset, bytes, error });
        Ok(replay)
    }

    /// Appends bytes to a growing recording, and reads the records that are now complete. Returns
    /// the number of updates among these records. The current step does not change.
    ///
    /// # Errors
    /// As [`Self::open`], but incomplete records are no error: they wait for the rest. After an
    /// error the replay keeps the earlier records, and every later call returns the same error.
    pub fn push(&mut self, bytes: &[u8]) -> Result<usize, ReadError> {
        if let Some(damage) = &self.damage {
            return Err(damage.clone());
        }
        let before = self.len();
        self.bytes.extend(bytes);
        match self.scan() {
            Ok(_) => Ok(self.len() - before),
            Err(error) => {
                self.damage = Some(error.clone());
                Err(error)
            }
        }
    }

    /// Reads the complete records that were not read yet: verifies their checksums and fields,
    /// creates the shapes, and extends the time line.
    fn scan(&mut self) -> Result<Reading, ReadError> {
        if self.cursor.offset() == 0 {
            match self.scan_header() {
                Err(error) if Header::is_begun(&self.bytes, &error) => {
                    return Ok(Reading::Waits(error));
                }
                header => header?,
            }
        }
        while !self.is_complete {
            match Raw::at(&self.bytes, self.cursor.offset()) {
                Ok(raw) => self.scan_record(&raw)?,
                Err(error) => return Ok(Reading::Waits(error)),
            }
        }
        let offset = self.cursor.offset();
        let is_last = offset == self.bytes.len();
        let problem = Problem::TrailingBytes;
        if is_last { Ok(Reading::Ended) } else { Err(ReadError { offset, problem }) }
    }

    /// Reads the header, and creates the world with its margin.
    fn scan_header(&mut self) -> Result<(), ReadError> {
        let mut cursor = self.cursor.clone();
        let margin = cursor.header(&self.bytes)?;
        let made = Player::new(margin).map_err(|problem| ReadError { offset: 0, problem });
        (self.player, self.resources.margin) = (made?, margin);
        self.timeline.start = cursor.offset();
        (self.offset, self.settled) = (cursor.offset(), cursor.offset());
        self.cursor = cursor;
        Ok(())
    }

    fn scan_record(&mut self, raw: &Raw) -> Result<(), ReadError> {
        let (mut cursor, offset) = (self.cursor.clone(), self.cursor.offset());
        cursor.pass(&self.bytes, raw.fields.end)?;
        let call = raw.call::<N, D>(&self.bytes)?;
        match &call {
            Call::Shape(shape) => {
                let Resources { shapes, registry, .. } = &mut self.resources;
                let defined = shapes.define(shape, registry);
                defined.map_err(|problem| ReadError { offset, problem })?;
            }
            Call::End { updates } => {
                self.check_end(*updates, raw.end)?;
                self.is_complete = true;
            }
            _ => self.timeline.note(&call, offset),
        }
        self.cursor = cursor;
        Ok(())
    }

    /// Checks the number of updates in the last record.
    fn check_end(&self, updates: u64, offset: usize) -> Result<(), ReadError> {
        let problem = Problem::BadValue { what: "the number of updates" };
        let is_right = updates == self.len() as u64;
        if is_right { Ok(()) } else { Err(ReadError { offset, problem }) }
    }

    /// Returns the received bytes of the recording; after [`Self::salvage`] without the lost part.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns `true` if the last record was received. Only a growing or salvaged recording may
    /// lack it.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Returns the part that [`Self::salvage`] has dropped; `None` if nothing was lost.
    #[must_use]
    pub const fn loss(&self) -> Option<&Loss> {
        self.loss.as_ref()
    }

    /// Returns the world at the current step.
    #[must_use]
    pub const fn world(&self) -> &CollisionWorld<N, D, T> {
        &self.player.world
    }

    /// Returns the world, to be changed for experiments. The next [`Self::seek`], even to the same
    /// step, rebuilds the world without the changes.
    pub const fn world_mut(&mut self) -> &mut CollisionWorld<N, D, T> {
        self.is_changed = true;
        &mut self.player.world
    }

    /// Returns the current step: the number of updates of the world.
    #[must_use]
    pub const fn step(&self) -> usize {
        self.step
    }

    /// Returns the number of updates of the recording.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.timeline.marks.len()
    }

    /// Returns `true` if the recording has no update.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.timeline.marks.is_empty()
    }

    /// Returns the time line: a mark for each update. The time line is available without replaying.
    #[must_use]
    pub fn marks(&self) -> &[Mark] {
        &self.timeline.marks
    }

    /// Returns the queries between the previous update and the current one, in order. Their results
    /// were computed when they were replayed, before the current update. At step 0 there are none.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point};
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
    /// use impinge_record::{Query, Question, Recorder, Registry, Replay};
    ///
    /// let registry = Registry::<f32, 2, ()>::new();
    /// let mut recorder = Recorder::new(0.02, registry.clone())?;
    /// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// recorder.add(Isometry::identity(), ball, CollisionGroups::new(), query, ())?;
    /// recorder.update();
    /// recorder.ask(&Query::new(Question::Containing(Point::new(0.5, 0.0))))?;
    /// recorder.update();
    ///
    /// let mut replay = Replay::open(recorder.finish().bytes, &registry).expect("just written");
    /// replay.seek(2).expect("its calls can be applied");
    /// let [asked] = replay.queries() else { panic!("there is one query") };
    /// assert_eq!((asked.answer.len(), asked.is_same), (1, true));
    /// # Ok::<(), impinge_record::RecordError>(())
    /// ```
    #[must_use]
    pub fn queries(&self) -> &[Asked<N, D>] {
        &self.player.queries
    }

    /// Returns the first difference from the recording that was found in the replayed steps; `None`
    /// if there was none.
    #[must_use]
    pub const fn divergence(&self) -> Option<Divergence> {
        self.divergence
    }

    /// Goes to a step, forwards or backwards: to the state just after its update. A step beyond the
    /// last one goes to the last one.
    ///
    /// # Errors
    /// If a call cannot be applied, because the registry lacks a pair filter or the bytes were not
    /// written by a recorder. The calls before it remain applied.
    pub fn seek(&mut self, step: usize) -> Result<(), ReadError> {
        let step = step.min(self.len());
        let frame = self.timeline.frame_before(step);
        let is_beyond = step == self.step && self.offset != self.settled;
        if step < self.step || is_beyond || frame.step > self.step || self.is_changed {
            self.restart(frame)?;
        }
        while self.step < step {
            self.apply_next()?;
        }
        Ok(())
    }

    /// Goes to the end, and also applies the calls after the last update. If the recorded world was
    /// never updated, its objects exist only there.
    ///
    /// # Errors
    /// As [`Self::seek`].
    pub fn seek_end(&mut self) -> Result<(), ReadError> {
        // At the last step, calls that are applied stay: a growing recording goes on from them.
        if self.is_changed || self.step < self.len() {
            self.seek(self.len())?;
        }
        self.finish()
    }

    /// Applies all remaining calls.
    fn finish(&mut self) -> Result<(), ReadError> {
        while self.offset < self.cursor.offset() {
            self.apply_next()?;
        }
        Ok(())
    }

    /// Creates a new world, and goes to a key frame or to the first call.
    fn restart(&mut self, mark: FrameMark) -> Result<(), ReadError> {
        let FrameMark { step, offset, .. } = mark;
        let made = Player::new(self.resources.margin);
        self.player = made.map_err(|problem| ReadError { offset, problem })?;
        (self.step, self.offset, self.settled, self.is_changed) = (step, offset, offset, false);
        Ok(())
    }

    fn apply_next(&mut self) -> Result<(), ReadError> {
        let offset = self.offset;
        let raw = Raw::at(&self.bytes, offset)?;
        let call = raw.call::<N, D>(&self.bytes)?;
        let is_update = matches!(call, Call::Update(_));
        let applied = self.player.apply(call, &self.resources);
        let difference = applied.map_err(|problem| ReadError { offset, problem })?;
        let step = self.step;
        let found = difference.map(|difference| Divergence { step, offset, difference });
        self.divergence = self.divergence.or(found);
        self.offset = raw.end;
        if is_update {
            (self.step, self.settled) = (self.step + 1, self.offset);
        }
        Ok(())
    }
}

/// Replays a whole recording and compares every hash. Returns `None` if the replay is equal to the
/// recording, to the bit.
///
/// If the hash of the state differs, the hashes of objects determine the first differing object in
/// the order of handles. A recording that was packed has no hashes of objects; the difference is
/// then [`Difference::State`](crate::Difference::State).
///
/// # Errors
/// As [`Replay::open`] and [`Replay::seek`].
pub fn validate<N: Recordable<D>, const D: usize, T: RecordData>(
    bytes: &[u8],
    registry: &Registry<N, D, T>,
) -> Result<Option<Divergence>, ReadError> {
    let mut replay = Replay::open(bytes, registry)?;
    // All calls are applied from the first one on; key frames do not skip any.
    replay.finish()?;
    Ok(replay.divergence)
}
