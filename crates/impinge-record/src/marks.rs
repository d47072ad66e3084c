//! The time line of a recording: the changes and events of each update, and the offsets of the key
//! frames.

use impinge::narrow_phase::ContactEvent;
use impinge::world::CollisionWorld;

use crate::call::Call;
use crate::space::Recordable;

/// The number of events of each kind in an update.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EventCounts {
    /// The number of pairs that started touching.
    pub started: u32,
    /// The number of pairs that stopped touching.
    pub stopped: u32,
    /// The number of pairs whose proximity changed.
    pub proximities: u32,
}

impl EventCounts {
    /// Counts the events of the last update.
    pub(crate) fn of<N: Recordable<D>, const D: usize, T>(world: &CollisionWorld<N, D, T>) -> Self {
        let contacts = world.contact_events();
        let is_start = |event: &&ContactEvent| matches!(event, ContactEvent::Started(..));
        let started = contacts.iter().filter(is_start).count();
        Self {
            started: small(started),
            stopped: small(contacts.len() - started),
            proximities: small(world.proximity_events().len()),
        }
    }
}

/// The counts of changes for an update: its events, and the calls since the previous update.
///
/// ```
/// use impinge::dim3::math::Isometry;
/// use impinge::dim3::shape::{Ball, ShapeHandle};
/// use impinge::dim3::world::{CollisionGroups, GeometricQueryType};
/// use impinge_record::{EventCounts, Mark, Recorder, Registry, Replay};
///
/// let registry = Registry::<f32, 3, ()>::new();
/// let mut recorder = Recorder::new(0.02, registry.clone())?;
/// let (ball, contacts) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Contacts(0.0, 0.0));
/// for x in [0.0, 1.5] {
///     let position = Isometry::translation(x, 0.0, 0.0);
///     recorder.add(position, ball.clone(), CollisionGroups::new(), contacts, ())?;
/// }
/// recorder.update();
/// recorder.update();
///
/// let replay = Replay::open(recorder.finish().bytes, &registry).expect("it was just written");
/// let events = EventCounts { started: 1, ..EventCounts::default() };
/// let first = Mark { added: 2, events: Some(events), ..Mark::default() };
/// let second = Mark { events: Some(EventCounts::default()), ..Mark::default() };
/// assert_eq!(replay.marks(), [first, second], "nothing was played");
/// # Ok::<(), impinge_record::RecordError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mark {
    /// The number of added objects. Objects of the initial state and of key frames are not counted.
    pub added: u32,
    /// The number of removed objects.
    pub removed: u32,
    /// The number of calls that set a position, counted per object: an object that is moved twice
    /// counts twice. Predicted positions that a key frame repeats do not count again.
    pub moved: u32,
    /// The number of other changes: of shapes, groups, query types, data, filters, skins, fixed
    /// flags, and requests to filter again. Fixed flags and skins that a key frame repeats do not
    /// count again.
    pub changed: u32,
    /// The number of queries.
    pub queries: u32,
    /// The events of the update; `None` in recordings of version 1.
    pub events: Option<EventCounts>,
}

impl Mark {
    /// Counts a call.
    fn count<N: Recordable<D>, const D: usize>(&mut self, call: &Call<N, D>) {
        match call {
            Call::Add(_) => self.added += 1,
            Call::Remove(indices) => self.removed += small(indices.len()),
            Call::SetPositions(positions) => self.moved += small(positions.len()),
            Call::Predict { .. } => self.moved += 1,
            Call::SetShape { .. }
            | Call::SetGroups { .. }
            | Call::SetQueryType { .. }
            | Call::SetData { .. }
            | Call::SetFixed { .. }
            | Call::SetSkin { .. }
            | Call::Refilter(_)
            | Call::RegisterFilter(_)
            | Call::UnregisterFilter(_) => self.changed += 1,
            Call::Query(_) => self.queries += 1,
            Call::Update(observation) => self.events = observation.counts,
            Call::Shape(_)
            | Call::KeyFrame(_)
            | Call::Refuse(_)
            | Call::KeepEvents
            | Call::UpdatePair(_)
            | Call::End { .. } => {}
        }
    }
}

/// Returns `true` for the calls that a recorder writes again after a key frame.
const fn is_repeated<N: Recordable<D>, const D: usize>(call: &Call<N, D>) -> bool {
    matches!(call, Call::SetFixed { .. } | Call::SetSkin { .. } | Call::Predict { .. })
}

/// Converts a count to 32 bits. All counts fit: counted items take bytes of the recording, or are
/// pairs of a world.
fn small(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// A position in the recording from which a world can be rebuilt: a key frame, or the beginning.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FrameMark {
    /// The number of updates before the key frame.
    pub(crate) step: usize,
    /// The offset of the key frame's record.
    pub(crate) offset: usize,
    /// The first step at which a world that is rebuilt from this key frame has the recorded events.
    /// In its first update all pairs start, and `keep_events` may carry these events over to later
    /// updates.
    whole_from: usize,
}

/// The positions of the updates and key frames of a recording, and the changes of each update.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timeline {
    /// The offset of the first record.
    pub(crate) start: usize,
    /// The changes of each update.
    pub(crate) marks: Vec<Mark>,
    /// The key frames, in order of their steps.
    frames: Vec<FrameMark>,
    /// Whether `keep_events` was called since the last update.
    keeps_events: bool,
    /// Whether a key frame came since the last update. The records between a key frame and its
    /// update repeat properties of objects.
    is_repeating: bool,
    /// The counts of the calls since the last update.
    next: Mark,
}

impl Timeline {
    /// Adds a call whose record begins at `offset`.
    pub(crate) fn note<N: Recordable<D>, const D: usize>(
        &mut self,
        call: &Call<N, D>,
        offset: usize,
    ) {
        if !(self.is_repeating && is_repeated(call)) {
            self.next.count(call);
        }
        match call {
            Call::KeyFrame(_) => {
                self.is_repeating = true;
                let step = self.marks.len();
                self.frames.push(FrameMark { step, offset, whole_from: step + 2 });
            }
            Call::KeepEvents => self.keeps_events = true,
            Call::Update(_) => self.note_update(),
            _ => {}
        }
    }

    fn note_update(&mut self) {
        self.marks.push(std::mem::take(&mut self.next));
        self.is_repeating = false;
        let step = self.marks.len();
        if std::mem::take(&mut self.keeps_events) {
            let begun = self.frames.iter_mut().rev().take_while(|frame| frame.whole_from >= step);
            begun.filter(|frame| frame.whole_from == step).for_each(|frame| frame.whole_from += 1);
        }
    }

    /// Returns the last key frame from which the world at a step can be rebuilt with its events; if
    /// there is none, the beginning of the recording.
    pub(crate) fn frame_before(&self, step: usize) -> FrameMark {
        let frames = self.frames.partition_point(|frame| frame.whole_from <= step);
        let beginning = FrameMark { step: 0, offset: self.start, whole_from: 0 };
        self.frames[..frames].last().copied().unwrap_or(beginning)
    }
}
