//! Rewinding a world to a mark: an earlier state of the world that the user has marked.
//!
//! While there are marks, each part records its state before it changes
//! ([`Journal`](crate::journal::Journal)). State that takes little memory is copied as a whole with
//! the mark ([`WorldHead`]).
//!
//! | state | recorded by | restored by |
//! |---|---|---|
//! | objects, with data, skins and predictions | `body_mut`, `body_mut_to_move`, `get_mut`, `insert`, `remove` and `flush` of `CollisionObjects` | replacing each record |
//! | rows of objects with pairs | `set`, `set_position`, `acquire`, `release` and `set_skin` of `ObjectTable` | writing the rows again |
//! | boxes, proxies and their pairs | `apply_waiting` and `remove` of `PairFinder`; `PairTable`; `DBVTBroadPhase` | setting the boxes in the trees, whose order affects time alone |
//! | contacts and proximities | `Group`; before an update `PairGroups::note` and `note_due` | writing each pair to its row at the mark, since `contact_views` reads in the order of the rows |
//!
//! The order of partners in a `PairTable` is not restored, so no result may depend on it.
//! `Run::play_again` of the tests simulates every golden scene and rewinds it after every tenth
//! step; `world_model/forks.rs` tests random operations.

use std::collections::VecDeque;

use crate::generation::Generation;
use crate::math::Space;
use crate::narrow_phase::Events;
use crate::world::error::or_panic;
use crate::world::filter::Filters;
use crate::world::removed::RemovedObjects;
use crate::world::{CollisionWorld, WorldBroadPhase, WorldError, WorldsNarrowPhase};

/// Number of marks that a world keeps unless the user sets another number.
const DEFAULT_MARKS: usize = 8;

/// A state in the history of a world, to which the world can return: see [`CollisionWorld::mark`].
///
/// A world refuses marks of other worlds, including its clones and the world of which it is a
/// clone.
///
/// ```
/// use impinge::dim2::world::{CollisionWorld, WorldError};
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let mark = world.mark();
/// assert_eq!(world.try_rewind(mark), Ok(()));
/// assert_eq!(world.clone().try_rewind(mark), Err(WorldError::MarkGone(mark)));
/// world.keep_marks(0);
/// assert_eq!(world.try_rewind(mark), Err(WorldError::MarkGone(mark)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct WorldMark {
    history: Generation,
    number: u64,
}

/// The state of a world that a mark copies as a whole: events, filters, removed objects, custom
/// phases, and the phases that the next update will install.
pub(in crate::world) struct WorldHead<N: Space<D>, const D: usize, T> {
    number: u64,
    events: Events,
    queued: Events,
    keeps_events: bool,
    removed: RemovedObjects<N, D, T>,
    filters: Filters<N, D, T>,
    /// The present broad phase if it is custom; `None` for the library's own, whose journal records
    /// its changes. `narrow_phase` follows the same rule.
    broad_phase: Option<Box<WorldBroadPhase<N, D>>>,
    narrow_phase: Option<Box<dyn WorldsNarrowPhase<N, D, T>>>,
    next_broad_phase: Option<Box<WorldBroadPhase<N, D>>>,
    next_narrow_phase: Option<Box<dyn WorldsNarrowPhase<N, D, T>>>,
}

/// The marks of a world.
pub(in crate::world) struct History<N: Space<D>, const D: usize, T> {
    /// Identifies the marks of this world; `None` before the first mark.
    name: Option<Generation>,
    next: u64,
    most: usize,
    /// The marks, in ascending order of their numbers.
    heads: VecDeque<WorldHead<N, D, T>>,
}

impl<N: Space<D>, const D: usize, T> History<N, D, T> {
    /// Creates a history without marks.
    pub(in crate::world) const fn new() -> Self {
        Self { name: None, next: 0, most: DEFAULT_MARKS, heads: VecDeque::new() }
    }

    /// Creates a history without marks that keeps at most `most` marks.
    #[cfg(feature = "serde")]
    pub(in crate::world) fn for_marks(most: usize) -> Self {
        Self { most, ..Self::new() }
    }

    /// The maximal number of marks.
    #[cfg(feature = "serde")]
    pub(in crate::world) const fn most_marks(&self) -> usize {
        self.most
    }

    /// Creates a history without marks and with the same maximum, for a clone.
    pub(super) fn without_marks(&self) -> Self {
        Self { most: self.most, ..Self::new() }
    }
}

/// Marks, and the return to the state of a mark.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Marks the present state, so that [`Self::rewind`] can restore it: for example before a step
    /// with guessed inputs, in a game over a network.
    ///
    /// The latest 8 marks are kept, or as many as [`Self::keep_marks`] sets; beyond that the oldest
    /// mark ends. All marks end when another broad or narrow phase takes over. A clone has no
    /// marks.
    ///
    /// While there are marks, the world records old state before each change: each object and each
    /// pair once between two marks. A mark itself costs 0.4 to 16 µs: a clone of the events, of the
    /// pending changes and filters, and of custom phases if the world has any. With 100 of 10 000
    /// objects moving and a mark before each update, a step takes 7 % longer in a dense pile, 18 to
    /// 21 % where some hundred pairs are computed, and 11 to 15 % where there is nothing to compute
    /// (9 µs become 10.5 µs).
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::<f32, u32>::new(0.02);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let [_, player] = [0.0, 5.0].map(|x| {
    ///     world.add(Isometry::translation(x, 0.0), ball.clone(), groups, ContactQuery::default(), 0)
    /// });
    /// world.update();
    ///
    /// let before = world.mark();
    /// let mut play = |x| {
    ///     world.rewind(before);
    ///     world.set_position(player, Isometry::translation(x, 0.0));
    ///     world.update();
    ///     let id = |world: &CollisionWorld<f32, u32>| Some(world.contact_manifolds().next()?.2.deepest_contact()?.id);
    ///     (world.contact_events().to_vec(), id(&world))
    /// };
    /// let guessed = play(4.0);
    /// let corrected = play(1.5);
    /// assert_ne!(guessed, corrected);
    /// assert_eq!(corrected, play(1.5), "the same calls give the same bits");
    /// ```
    pub fn mark(&mut self) -> WorldMark
    where
        T: Clone,
    {
        let number = self.history.next;
        let history = *self.history.name.get_or_insert_with(Generation::of_new_table);
        self.history.next += 1;
        let head = self.head(number);
        self.objects.mark(number);
        if let Some(phase) = self.default_broad_phase() {
            phase.mark(number);
        }
        if let Some(phase) = self.default_narrow_phase() {
            phase.mark(number);
        }
        self.history.heads.push_back(head);
        self.drop_old_marks();
        WorldMark { history, number }
    }

    /// Sets the greatest number of marks from now on; the latest ones are kept. 0 ends all marks
    /// and their cost.
    pub fn keep_marks(&mut self, most: usize) {
        self.history.most = most;
        self.drop_old_marks();
    }

    /// Restores the state that the world had at the mark: objects with their data, shapes, groups,
    /// query types, pairs, contacts with their ids, events, filters, and the changes that wait for
    /// the next update. The same calls as before then give the same bits, including handles of
    /// added objects. So a handle that was issued after the mark refers to no object until the same
    /// handle is issued again, possibly for another object. All queries, pairs and contacts have
    /// the results that they had at the mark, in the same order.
    ///
    /// The mark stays, so that the world can return to it again; later marks end. The cost is
    /// proportional to the changes since the mark: undoing 8 updates takes as long as two to five
    /// updates. Manifolds of [`Self::contact_manifolds`] that changed are built again on first
    /// access.
    ///
    /// # Panics
    /// If the mark has ended or belongs to another world; [`Self::try_rewind`] returns an error
    /// instead.
    #[track_caller]
    pub fn rewind(&mut self, mark: WorldMark)
    where
        T: Clone,
    {
        or_panic(self.try_rewind(mark));
    }

    /// Restores the state of a mark; see [`Self::rewind`].
    ///
    /// # Errors
    /// If the mark has ended or belongs to another world. Then the world is unchanged.
    pub fn try_rewind(&mut self, mark: WorldMark) -> Result<(), WorldError>
    where
        T: Clone,
    {
        let WorldMark { history, number } = mark;
        let is_own = self.history.name == Some(history);
        let place = self.history.heads.iter().position(|head| head.number == number);
        let place = place.filter(|_| is_own).ok_or(WorldError::MarkGone(mark))?;
        self.history.heads.truncate(place + 1);
        self.objects.rewind(number);
        if let Some(phase) = self.default_broad_phase() {
            phase.rewind(number);
        }
        if let Some(phase) = self.default_narrow_phase() {
            phase.rewind(number);
        }
        if let Some(head) = self.history.heads.pop_back() {
            self.bring_back(&head);
            self.history.heads.push_back(head);
        }
        Ok(())
    }

    /// Ends all marks.
    pub(in crate::world) fn end_marks(&mut self) {
        let most = self.history.most;
        self.keep_marks(0);
        self.history.most = most;
    }

    /// Ends the oldest marks beyond the maximum.
    fn drop_old_marks(&mut self) {
        let heads = &mut self.history.heads;
        let surplus = heads.len().saturating_sub(self.history.most);
        if surplus == 0 {
            return;
        }
        heads.drain(..surplus);
        let first = heads.front().map_or(u64::MAX, |head| head.number);
        self.objects.forget_before(first);
        if let Some(phase) = self.default_broad_phase() {
            phase.forget_before(first);
        }
        if let Some(phase) = self.default_narrow_phase() {
            phase.forget_before(first);
        }
    }

    fn head(&mut self, number: u64) -> WorldHead<N, D, T>
    where
        T: Clone,
    {
        let is_default =
            [self.default_broad_phase().is_some(), self.default_narrow_phase().is_some()];
        WorldHead {
            number,
            events: self.events.clone(),
            queued: self.queued.clone(),
            keeps_events: self.keeps_events,
            removed: self.removed.clone(),
            filters: self.filters.clone(),
            broad_phase: (!is_default[0]).then(|| self.broad_phase.clone()),
            narrow_phase: (!is_default[1]).then(|| self.narrow_phase.clone()),
            next_broad_phase: self.next_broad_phase.clone(),
            next_narrow_phase: self.next_narrow_phase.clone(),
        }
    }

    fn bring_back(&mut self, head: &WorldHead<N, D, T>)
    where
        T: Clone,
    {
        self.events.clone_from(&head.events);
        self.queued.clone_from(&head.queued);
        self.keeps_events = head.keeps_events;
        self.removed.clone_from(&head.removed);
        self.filters.clone_from(&head.filters);
        if let Some(phase) = &head.broad_phase {
            self.broad_phase = phase.clone();
        }
        if let Some(phase) = &head.narrow_phase {
            self.narrow_phase = phase.clone();
        }
        self.next_broad_phase = head.next_broad_phase.clone();
        self.next_narrow_phase = head.next_narrow_phase.clone();
    }
}
