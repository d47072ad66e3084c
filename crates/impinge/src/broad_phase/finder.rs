//! The broad phase without users' data. It receives ids and boxes, and reports the pairs of ids
//! that start or stop.

use core::fmt;

use super::BroadPhaseError;
use super::events::PairEvents;
use super::exact_boxes::{ExactBoxes, LooseBounds};
use super::rest::RestPass;
use super::rewind::{BoxNote, FinderHead};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::bvh::{Bounds, Changes, Joiner, Lanes, NONE, Tree};
use crate::journal::Journal;
use crate::math::Real;
use crate::memory::{Look, Recent, clone_fields};
use crate::pairs::PairTable;

/// The container in which the finder keeps an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Container {
    /// No container: the object does not exist, or no update has applied its first box yet.
    Nowhere,
    /// The tree of moving objects.
    Moving,
    /// The tree of still objects, which have not changed for some time.
    Still,
    /// The list of unbounded objects.
    Unbounded,
}

/// Mark of an object whose loosened box changed since the last update. Every object with the mark
/// [`REFILTER`] has this mark, too.
pub(super) const CHANGED: u8 = 1;
/// Mark of an object whose pairs must all be filtered again.
pub(super) const REFILTER: u8 = 2;

/// A box that the next update applies to object `id`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting<N: Real, const D: usize> {
    pub(super) id: u32,
    pub(super) aabb: Aabb<N, D>,
}

/// Finds and keeps the pairs of objects whose loosened boxes overlap and that the filter allows. An
/// object is identified by a small index, its id.
///
/// The loosened box of an object is its exact box grown by the margin and rounded outwards to
/// `f32`. It is replaced only when the exact box leaves it, or when an unbounded object becomes
/// bounded, so objects that move little cost almost nothing. An object is unbounded if a face of
/// its loosened box is beyond the range of `f32`. Unbounded objects are in a list, and each of them
/// is tested against every object that changed.
///
/// Arrays with one entry for each object are indexed by id. Objects that have not changed for a
/// while move to a second tree, the tree of still objects. An update searches that tree only for
/// pairs with changed objects.
pub struct PairFinder<N: Real, const D: usize> {
    margin: N,
    /// Exact boxes at the last update.
    pub(super) exact: Vec<Aabb<N, D>>,
    pub(super) loose: Vec<Bounds<D>>,
    /// By id: the loosened boxes at the last update. Valid only for unbounded objects with the mark
    /// [`CHANGED`]; the array may be shorter than the number of ids.
    previous: Vec<Bounds<D>>,
    pub(super) containers: Vec<Container>,
    pub(super) marks: Vec<u8>,
    /// By id: the value of `clock` in the update in which the loosened box last changed.
    pub(super) last_change: Vec<u32>,
    pub(super) waiting: Vec<Waiting<N, D>>,
    /// Scratch: indices in `waiting` of the boxes that leave their loosened boxes, or whose objects
    /// are in no tree.
    outside: Vec<u32>,
    /// By id: the object's index in `waiting`, or [`NONE`].
    pub(super) waiting_at: Vec<u32>,
    /// Objects that have a mark, each once.
    pub(super) changes: Vec<u32>,
    /// Objects whose pairs the next update filters again; ids may repeat, and may belong to removed
    /// objects.
    pub(super) to_refilter: Vec<u32>,
    pub(super) refilters_all: bool,
    pub(super) moving: Tree<D>,
    pub(super) still: Tree<D>,
    pub(super) unbounded: Vec<u32>,
    pub(super) pairs: PairTable,
    pub(super) joiner: Joiner<D>,
    /// Objects whose pairs in the table are tested one by one, because the join of the trees does
    /// not report all of their pairs that end.
    pub(super) searched: Vec<u32>,
    /// Scratch: objects that move to the tree of still objects in an update.
    pub(super) resting: Vec<u32>,
    pub(super) found: Changes,
    pub(super) pair_events: PairEvents,
    pub(super) lanes: Lanes,
    /// Number of updates so far; wraps around.
    pub(super) clock: u32,
    pub(super) rest_pass: RestPass,
    pub(super) recent: Recent,
    pub(super) journal: Journal<BoxNote<N, D>, FinderHead<N, D>>,
}

clone_fields!([N: Real, const D: usize] PairFinder<N, D> {
    margin, exact, loose, previous, containers, marks, last_change, waiting, outside, waiting_at, changes, to_refilter,
    refilters_all, moving, still, unbounded, pairs, joiner, searched, resting, found, pair_events, lanes, clock,
    rest_pass, recent, journal,
});

impl<N: Real, const D: usize> fmt::Debug for PairFinder<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PairFinder")
            .field("margin", &self.margin)
            .field("num_pairs", &self.pairs.len())
            .finish_non_exhaustive()
    }
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Creates a finder without objects, which loosens boxes by `margin`.
    ///
    /// # Errors
    /// If the margin is negative, infinite or NaN.
    pub fn try_new(margin: N) -> Result<Self, BroadPhaseError> {
        Self::with_lanes(margin, Lanes::detect())
    }

    /// Creates a finder with this SIMD vector width; see [`Self::try_new`]. For tests.
    pub(super) fn with_lanes(margin: N, lanes: Lanes) -> Result<Self, BroadPhaseError> {
        let is_usable = margin >= N::ZERO && margin.is_finite_number();
        if !is_usable {
            return Err(BroadPhaseError::BadMargin(margin.as_f64()));
        }
        Ok(Self {
            margin,
            exact: Vec::new(),
            loose: Vec::new(),
            previous: Vec::new(),
            containers: Vec::new(),
            marks: Vec::new(),
            last_change: Vec::new(),
            waiting: Vec::new(),
            outside: Vec::new(),
            waiting_at: Vec::new(),
            changes: Vec::new(),
            to_refilter: Vec::new(),
            refilters_all: false,
            moving: Tree::new(lanes),
            still: Tree::sparing(lanes),
            unbounded: Vec::new(),
            pairs: PairTable::new(),
            joiner: Joiner::default(),
            searched: Vec::new(),
            resting: Vec::new(),
            found: Changes::default(),
            pair_events: PairEvents::default(),
            lanes,
            clock: 0,
            rest_pass: RestPass::NONE,
            recent: Recent::default(),
            journal: Journal::default(),
        })
    }

    /// Returns the margin by which boxes are loosened.
    pub const fn margin(&self) -> N {
        self.margin
    }

    /// Returns the pairs of the last update, except those removed since, in unspecified order.
    pub fn pairs(&self) -> &[(u32, u32)] {
        self.pairs.pairs()
    }

    /// Returns the exact box of the last update; before the first update of the object, its initial
    /// box. The object must exist.
    pub fn exact(&self, id: u32) -> &Aabb<N, D> {
        &self.exact[id as usize]
    }

    /// Returns the loosened box of an object; `None` before its first update and if there is no
    /// such object.
    pub fn loosened(&self, id: u32) -> Option<&Bounds<D>> {
        let is_known = *self.containers.get(id as usize)? != Container::Nowhere;
        is_known.then(|| &self.loose[id as usize])
    }

    /// Calls `visit` with the bounds of each node of both trees: first of the tree of moving
    /// objects.
    #[cfg(feature = "debug_render")]
    pub(super) fn each_node(&self, visit: &mut dyn FnMut(&Bounds<D>)) {
        self.moving.each_node(visit);
        self.still.each_node(visit);
    }

    /// Adds an object. It has pairs from the next update on. `id` must be unused; ids should be
    /// dense.
    pub fn insert(&mut self, id: u32, aabb: Aabb<N, D>) {
        let needed = id as usize + 1;
        if self.containers.len() < needed {
            self.exact.resize(needed, aabb);
            self.loose.resize(needed, Bounds::NOWHERE);
            self.containers.resize(needed, Container::Nowhere);
            self.marks.resize(needed, 0);
            self.last_change.resize(needed, 0);
            self.waiting_at.resize(needed, NONE);
        }
        debug_assert_eq!(self.containers[id as usize], Container::Nowhere, "object {id} exists");
        self.exact[id as usize] = aabb;
        self.set(id, aabb);
    }

    /// Sets the box that the next update applies to an object; of several calls, only the last has
    /// an effect.
    #[inline]
    pub fn set(&mut self, id: u32, aabb: Aabb<N, D>) {
        let at = self.waiting_at[id as usize];
        if at == NONE {
            self.waiting_at[id as usize] = small(self.waiting.len());
            self.waiting.push(Waiting { id, aabb });
        } else {
            self.waiting[at as usize].aabb = aabb;
        }
    }

    /// Makes the next update filter every pair of the object again.
    pub fn refilter(&mut self, id: u32) {
        self.to_refilter.push(id);
    }

    /// Makes the next update filter every pair again.
    pub fn refilter_all(&mut self) {
        self.refilters_all = true;
    }

    /// Returns the packed pairs that contain at least one of the objects, each once, ascending.
    pub(super) fn pairs_of(&self, ids: &[u32]) -> Vec<u64> {
        let of_one = |&a: &u32| self.pairs.partners(a).map(move |(b, _)| crate::pairs::pack(a, b));
        let mut keys: Vec<u64> = ids.iter().flat_map(of_one).collect();
        keys.sort_unstable();
        keys.dedup();
        keys
    }

    /// Removes an object and its pairs at once, without waiting for an update.
    pub fn remove(&mut self, id: u32) {
        self.note(id);
        while let Some(pair) = self.pairs.any_pair_of(id) {
            self.pairs.remove_at(pair);
        }
        self.remove_from_container(id);
        let index = id as usize;
        let at = core::mem::replace(&mut self.waiting_at[index], NONE);
        if at != NONE {
            self.waiting.swap_remove(at as usize);
            if let Some(moved) = self.waiting.get(at as usize) {
                self.waiting_at[moved.id as usize] = at;
            }
        }
        // `changes` has entries here only if a filter panicked in the last update. `to_refilter`
        // may keep the id: an object that reuses it is new, so all its pairs are filtered in any
        // case.
        self.changes.retain(|&other| other != id);
        self.marks[index] = 0;
    }

    /// Removes the object from its tree or list.
    pub(super) fn remove_from_container(&mut self, id: u32) {
        match core::mem::replace(&mut self.containers[id as usize], Container::Nowhere) {
            Container::Nowhere => {}
            Container::Moving => self.moving.remove(id),
            Container::Still => self.still.remove(id),
            Container::Unbounded => self.unbounded.retain(|&other| other != id),
        }
    }

    /// Applies the waiting boxes, in the order of their list.
    pub(super) fn apply_waiting(&mut self) {
        let mut waiting = core::mem::take(&mut self.waiting);
        let mut outside = core::mem::take(&mut self.outside);
        if self.journal.is_on() {
            waiting.iter().for_each(|one| self.note(one.id));
        }
        self.list_outside(&waiting, &mut outside);
        for &at in &outside {
            let Waiting { id, aabb } = &waiting[at as usize];
            self.update_loose(*id, aabb);
        }
        waiting.clear();
        outside.clear();
        (self.waiting, self.outside) = (waiting, outside);
    }

    /// Stores the waiting boxes as exact boxes. Lists in `outside` the objects whose exact box
    /// leaves the loosened box, and those in no tree, by their index in `waiting`.
    fn list_outside(&mut self, waiting: &[Waiting<N, D>], outside: &mut Vec<u32>) {
        outside.clear();
        outside.resize(waiting.len(), 0);
        let bounds = LooseBounds { containers: &self.containers, loose: &self.loose };
        let exact_boxes =
            ExactBoxes { first: 0, exact: &mut self.exact, waiting_at: &mut self.waiting_at };
        let count = exact_boxes.write(&bounds, waiting, 0, outside);
        outside.truncate(count);
    }

    /// Computes a new loosened box for an object whose exact box left the old one, or that is in no
    /// tree. An unbounded object keeps its loosened box while a face of its exact box is beyond the
    /// range of `f32` and the loosened box contains the exact box.
    #[inline]
    fn update_loose(&mut self, id: u32, aabb: &Aabb<N, D>) {
        let index = id as usize;
        let loose = Bounds::enclosing(&aabb.loosened(self.margin));
        if self.containers[index] == Container::Moving && loose.is_finite() {
            // The tree keeps the old box until its refit, which reads the new box from `loose`.
            self.last_change[index] = self.clock;
            self.mark(id, CHANGED);
            self.loose[index] = loose;
            return self.moving.set_later(id);
        }
        let tight = Bounds::enclosing(aabb);
        let is_unbounded = self.containers[index] == Container::Unbounded && !tight.is_finite();
        if !(is_unbounded && self.loose[index].contains(&tight)) {
            self.last_change[index] = self.clock;
            self.reinsert(id, loose);
        }
    }

    /// Moves an object from its container to the tree of moving objects if `loose` is finite, else
    /// to the list of unbounded objects.
    #[inline(never)]
    fn reinsert(&mut self, id: u32, loose: Bounds<D>) {
        let index = id as usize;
        let before = self.before(id);
        self.mark(id, CHANGED);
        self.loose[index] = loose;
        let is_bounded = loose.is_finite();
        if !is_bounded || self.containers[index] == Container::Unbounded {
            self.searched.push(id);
        }
        self.remove_from_container(id);
        if is_bounded {
            self.containers[index] = Container::Moving;
            self.moving.insert(id, &loose, &before);
        } else {
            self.set_previous(id, before);
            self.containers[index] = Container::Unbounded;
            self.unbounded.push(id);
        }
    }

    fn set_previous(&mut self, id: u32, before: Bounds<D>) {
        if self.previous.len() <= id as usize {
            self.previous.resize(id as usize + 1, Bounds::NOWHERE);
        }
        self.previous[id as usize] = before;
    }

    /// Returns the loosened box of an object at the last update. [`Bounds::NOWHERE`] if there was
    /// none, or if all pairs of the object must begin anew.
    pub(super) fn before(&self, id: u32) -> Bounds<D> {
        let index = id as usize;
        let in_tree = match self.containers[index] {
            Container::Nowhere => Some(Bounds::NOWHERE),
            Container::Moving => self.moving.before(id),
            Container::Still => self.still.before(id),
            Container::Unbounded if self.marks[index] & CHANGED != 0 => Some(self.previous[index]),
            Container::Unbounded => Some(self.loose[index]),
        };
        // If all pairs must begin anew, the tree stores the empty box. An unbounded box overlaps
        // the empty box, but not [`Bounds::NOWHERE`].
        in_tree.filter(|before| *before != Bounds::EMPTY).unwrap_or(Bounds::NOWHERE)
    }

    #[inline]
    fn mark(&mut self, id: u32, mark: u8) {
        let marks = &mut self.marks[id as usize];
        if *marks & CHANGED == 0 {
            self.changes.push(id);
        }
        *marks |= CHANGED | mark;
    }

    /// Resets the old box of each object in `to_refilter`, or of all objects if `refilters_all`, so
    /// that all pairs of these objects begin anew.
    pub(super) fn apply_refilters(&mut self) {
        let mut to_refilter = core::mem::take(&mut self.to_refilter);
        if core::mem::take(&mut self.refilters_all) {
            to_refilter = (0..small(self.containers.len())).collect();
        }
        for &id in &to_refilter {
            match self.containers[id as usize] {
                Container::Nowhere => continue,
                Container::Moving => self.moving.forget_before(id),
                Container::Still => self.still.forget_before(id),
                Container::Unbounded => self.set_previous(id, Bounds::NOWHERE),
            }
            self.mark(id, REFILTER);
            self.searched.push(id);
        }
        to_refilter.clear();
        self.to_refilter = to_refilter;
    }

    /// Returns the length of `waiting`, which includes entries of removed objects.
    pub(super) fn num_waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Releases the memory of lists that have been short for some time, and surplus capacity of the
    /// arrays indexed by id. The tree of moving objects releases its own memory.
    pub(super) fn give_back(&mut self, look: Look) {
        look.trim(&mut self.waiting);
        for list in [&mut self.outside, &mut self.changes, &mut self.to_refilter] {
            look.trim(list);
        }
        look.trim(&mut self.searched);
        look.trim(&mut self.resting);
        look.trim(&mut self.found.began);
        look.trim(&mut self.found.ended);
        self.pair_events.give_back(look);
        look.fit(&mut self.exact);
        look.fit(&mut self.loose);
        look.fit(&mut self.containers);
        look.fit(&mut self.marks);
        look.fit(&mut self.last_change);
        look.fit(&mut self.waiting_at);
        self.joiner.give_back(look);
        self.still.fit(look);
        self.pairs.fit(look);
    }

    /// Returns `true` if the next update has nothing to do.
    pub(super) fn is_idle(&self) -> bool {
        let is_refiltering = self.refilters_all || !self.to_refilter.is_empty();
        self.waiting.is_empty() && self.changes.is_empty() && !is_refiltering
    }

    /// Checks every invariant; for tests.
    ///
    /// # Errors
    /// Returns a sentence that names the violated invariant.
    pub fn validate(&self) -> Result<(), String> {
        self.moving.validate()?;
        self.still.validate()?;
        self.pairs.validate()?;
        for (id, &container) in (0..).zip(&self.containers) {
            let index = id as usize;
            let bounds = (self.moving.bounds(id), self.still.bounds(id));
            let listed = self.unbounded.iter().filter(|&&other| other == id).count();
            let loose = Some(self.loose[index]);
            let is_contained = match container {
                Container::Nowhere => bounds == (None, None) && listed == 0,
                Container::Moving => bounds == (loose, None) && listed == 0,
                Container::Still => bounds == (None, loose) && listed == 0,
                Container::Unbounded => bounds == (None, None) && listed == 1,
            };
            if !is_contained {
                return Err(format!("object {id} is not {container:?}: {bounds:?}, {listed}"));
            }
            let tight = Bounds::enclosing(&self.exact[index]);
            if container != Container::Nowhere && !self.loose[index].contains(&tight) {
                return Err(format!("the exact box of {id} leaves its loosened box"));
            }
        }
        let is_listed = |(at, one): (u32, &Waiting<N, D>)| self.waiting_at[one.id as usize] == at;
        let num_waiting = self.waiting_at.iter().filter(|&&at| at != NONE).count();
        if !(0..).zip(&self.waiting).all(is_listed) || num_waiting != self.waiting.len() {
            return Err("list and indices of waiting boxes differ".to_owned());
        }
        let is_pair =
            |&(a, b): &(u32, u32)| self.loose[a as usize].overlaps(&self.loose[b as usize]);
        let overlap = self.pairs.pairs().iter().all(is_pair) || !self.is_idle();
        overlap.then_some(()).ok_or("a pair does not overlap".to_owned())
    }
}

/// Converts an index or a count to a `u32` id; panics if it does not fit.
#[inline]
pub(super) fn small(value: usize) -> u32 {
    u32::try_from(value).expect("fewer than 2^32 objects")
}
