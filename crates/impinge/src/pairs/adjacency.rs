//! The links of all objects: a cache line for each object with links, and a run of further lines
//! for an object with more than seven links.
//!
//! ```text
//! object   index ──> head (64 bytes): link 0 … link 6 | start | count and class
//!                                                        │
//! pool     line, line, ... <─── run of 2^class lines, 8 links each
//! indices  (object, partner) -> index of the link, for heavy objects (class >= 5)
//! ```

use super::link_indices::LinkIndices;
use crate::memory::{Look, clone_fields};

/// Number of links in a line.
const PER_LINE: usize = 8;
/// Number of links in a head, which uses the rest of its line to describe the run.
const INLINE: usize = PER_LINE - 1;
/// Idle heads, which have no owner, are dropped when their number exceeds half of all heads by more
/// than `MAX_IDLE`.
const MAX_IDLE: usize = 256;
/// Entry in `head_indices` of an object without links.
const NO_HEAD: u32 = u32::MAX;
/// The class of a head without a run. A run of class `c` has `2^c` lines.
const NO_RUN: u32 = 31;
/// The lowest class of a heavy object, which has had more than 135 links since it got its run. It
/// stays heavy until its run is released, so that objects do not alternate between both states.
/// Searching the 17 lines of the largest object that is not heavy costs about as much as a look-up
/// in the hash table.
const HEAVY: u32 = 5;

/// One end of a pair of objects A and B: A has a link to its partner B, and B has a link to A.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Link {
    /// The object at the other end.
    pub(super) partner: u32,
    /// Index of the pair in the dense array.
    pub(super) pair: u32,
}

/// The first links of an object, and the position of the run with its further links.
///
/// Most objects have at most seven partners, so they need only this line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Head {
    links: [Link; INLINE],
    /// The first line of the run, `2^class` lines long.
    start: u32,
    /// The class of the run in the lowest five bits ([`NO_RUN`] if there is none), and the number
    /// of links in the bits above.
    count_and_class: u32,
}

impl Head {
    /// The head of an object without links.
    const EMPTY: Self =
        Self { links: [Link { partner: 0, pair: 0 }; INLINE], start: 0, count_and_class: NO_RUN };

    /// Returns the number of links.
    const fn count(&self) -> u32 {
        self.count_and_class >> 5
    }

    /// Returns the class of the run, or [`NO_RUN`].
    const fn class(&self) -> u32 {
        self.count_and_class & 31
    }

    /// Sets the number of links; keeps the class.
    fn set_count(&mut self, count: u32) {
        assert!(count < 1 << 27, "an object has fewer than 2^27 partners");
        self.count_and_class = count << 5 | self.class();
    }

    /// Sets the first line and the class of the run; keeps the number of links.
    fn set_run(&mut self, start: u32, class: u32) {
        self.start = start;
        self.count_and_class = self.count_and_class & !31 | class;
    }

    /// Returns the number of links that fit in the head and the run.
    const fn capacity(&self) -> usize {
        if self.class() == NO_RUN { INLINE } else { INLINE + (PER_LINE << self.class()) }
    }
}

/// A cache line of a run, with eight links.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
struct Line {
    links: [Link; PER_LINE],
}

/// The links of all objects.
#[derive(Debug, Default)]
pub(super) struct Adjacency {
    /// By object: index of its head, or [`NO_HEAD`].
    head_indices: Vec<u32>,
    heads: Vec<Head>,
    /// Indices of heads without an owner, which have no links and no runs.
    idle: Vec<u32>,
    /// The lines of all runs, each run contiguous.
    pool: Vec<Line>,
    /// By class: the first lines of released runs.
    free: Vec<Vec<u32>>,
    /// The indices of the links of heavy objects. The index of a link is its position among the
    /// links of its object: first those in the head, then those in the run.
    link_indices: LinkIndices,
}

clone_fields!([] Adjacency { head_indices, heads, idle, pool, free, link_indices });

/// Returns the index of the link to `partner` among the first `count` of `links`; `None` if there
/// is none. Compares all of `links`, because a branch predictor cannot predict where a search ends.
#[inline]
fn position_of(links: &[Link], count: usize, partner: u32) -> Option<u32> {
    let hit = |at: usize| u32::from(links[at].partner == partner) << at;
    let hits = (0..links.len()).fold(0, |hits, at| hits | hit(at));
    let index = hits.trailing_zeros();
    ((index as usize) < count.min(links.len())).then_some(index)
}

/// Returns the key of the link from an object to a partner.
#[inline]
fn link_key(object: u32, partner: u32) -> u64 {
    u64::from(object) << 32 | u64::from(partner)
}

/// Converts an index or count to `u32`.
pub(super) fn small(value: usize) -> u32 {
    u32::try_from(value).expect("a pair table holds fewer than 2^32 entries")
}

impl Adjacency {
    /// Extends `head_indices` to contain the object.
    pub(super) fn extend_to(&mut self, object: u32) {
        let needed = object as usize + 1;
        if self.head_indices.len() < needed {
            self.head_indices.resize(needed, NO_HEAD);
        }
    }

    /// Returns one more than the largest object index that has had a link.
    pub(super) fn num_objects(&self) -> usize {
        self.head_indices.len()
    }

    /// Returns the index of the object's head; `None` if the object has no links.
    #[inline]
    fn head_index(&self, object: u32) -> Option<usize> {
        let at = *self.head_indices.get(object as usize)? as usize;
        (at < self.heads.len()).then_some(at)
    }

    /// Returns the head of the object; [`Head::EMPTY`] if it has no links.
    #[inline]
    fn head(&self, object: u32) -> &Head {
        self.head_index(object).map_or(&Head::EMPTY, |at| &self.heads[at])
    }

    /// Returns the number of links of the object; 0 also for an index that the table has never
    /// seen.
    #[inline]
    pub(super) fn count(&self, object: u32) -> usize {
        self.head(object).count() as usize
    }

    /// Iterates over the links of the object, in order of their indices.
    pub(super) fn links(&self, object: u32) -> impl Iterator<Item = Link> + '_ {
        let head = self.head(object);
        let count = head.count() as usize;
        let start = head.start as usize;
        let lines = start..start + count.saturating_sub(INLINE).div_ceil(PER_LINE);
        let rest = self.pool[lines].iter().flat_map(|line| &line.links);
        head.links.iter().chain(rest).take(count).copied()
    }

    /// Returns the last link of the object; `None` if it has no links.
    pub(super) fn last_link(&self, object: u32) -> Option<Link> {
        let at = self.head_index(object)?;
        Some(self.link(at, self.heads[at].count() - 1))
    }

    /// Returns link `index` of the object with head `at`; `index` must be less than its count.
    #[inline]
    fn link(&self, at: usize, index: u32) -> Link {
        let head = &self.heads[at];
        if let Some(link) = head.links.get(index as usize) {
            return *link;
        }
        let beyond = index as usize - INLINE;
        self.pool[head.start as usize + beyond / PER_LINE].links[beyond % PER_LINE]
    }

    /// Returns link `index` of the object with head `at`, for writing; `index` must be within its
    /// capacity.
    #[inline]
    fn link_mut(&mut self, at: usize, index: u32) -> &mut Link {
        let head = &mut self.heads[at];
        let index = index as usize;
        if index < INLINE {
            return &mut head.links[index];
        }
        let beyond = index - INLINE;
        &mut self.pool[head.start as usize + beyond / PER_LINE].links[beyond % PER_LINE]
    }

    /// Returns `true` if the object with head `at` is heavy. Its links are then in `link_indices`.
    #[inline]
    fn is_heavy(&self, at: usize) -> bool {
        (HEAVY..NO_RUN).contains(&self.heads[at].class())
    }

    /// Returns the index of the object's head, and the index of its link to the partner; `None` if
    /// there is no such link.
    #[inline]
    fn find(&self, object: u32, partner: u32) -> Option<(usize, u32)> {
        let at = self.head_index(object)?;
        let head = &self.heads[at];
        let count = head.count() as usize;
        let index = position_of(&head.links, count, partner);
        if index.is_some() || head.class() == NO_RUN {
            return Some((at, index?));
        }
        if head.class() >= HEAVY {
            return Some((at, self.link_indices.get(link_key(object, partner))?));
        }
        let (start, beyond) = (head.start as usize, count.saturating_sub(INLINE));
        let lines = self.pool[start..start + beyond.div_ceil(PER_LINE)].iter();
        lines.enumerate().find_map(|(line_at, line)| {
            let index = position_of(&line.links, beyond - line_at * PER_LINE, partner)?;
            Some((at, small(INLINE + line_at * PER_LINE) + index))
        })
    }

    /// Returns the index of the pair of `a` and `b` in the dense array; `None` if it is not there.
    /// Searches the links of the object that has fewer.
    #[inline]
    pub(super) fn pair_of(&self, a: u32, b: u32) -> Option<usize> {
        let a_is_lighter = self.count(a) <= self.count(b);
        let (from, to) = if a_is_lighter { (a, b) } else { (b, a) };
        let (at, index) = self.find(from, to)?;
        Some(self.link(at, index).pair as usize)
    }

    /// Replaces the object's link to `link.partner`, which must exist, by `link`.
    #[inline]
    pub(super) fn set_pair(&mut self, object: u32, link: Link) {
        let found = self.find(object, link.partner);
        let (at, index) = found.expect("both ends of a pair have links");
        *self.link_mut(at, index) = link;
    }

    /// Adds a link to the object. Its partner must be new to the object.
    #[inline]
    pub(super) fn push(&mut self, object: u32, link: Link) {
        let at = self.head_index(object).unwrap_or_else(|| self.take_head(object));
        let head = &mut self.heads[at];
        let count = head.count();
        if count as usize == head.capacity() {
            self.enlarge(object, at);
        }
        self.heads[at].set_count(count + 1);
        *self.link_mut(at, count) = link;
        if self.is_heavy(at) {
            self.link_indices.set(link_key(object, link.partner), count);
        }
    }

    /// Assigns an idle or a new head to the object, and returns the head's index.
    fn take_head(&mut self, object: u32) -> usize {
        let at = self.idle.pop().unwrap_or_else(|| {
            self.heads.push(Head::EMPTY);
            small(self.heads.len() - 1)
        });
        self.head_indices[object as usize] = at;
        at as usize
    }

    /// Removes the link to the partner and returns the index of the pair; `None` if there is no
    /// such link. The last link of the object takes the index of the removed one.
    #[inline]
    pub(super) fn remove(&mut self, object: u32, partner: u32) -> Option<usize> {
        let (at, index) = self.find(object, partner)?;
        let last = self.heads[at].count() - 1;
        let (taken, moved) = (self.link(at, index), self.link(at, last));
        *self.link_mut(at, index) = moved;
        self.heads[at].set_count(last);
        if self.is_heavy(at) {
            self.link_indices.set(link_key(object, moved.partner), index);
            self.link_indices.remove(link_key(object, partner));
        }
        if last as usize == INLINE {
            self.release(object, at);
        } else if last == 0 {
            self.head_indices[object as usize] = NO_HEAD;
            self.idle.push(small(at));
        }
        Some(taken.pair as usize)
    }

    /// Assigns a run of one line to an object without a run, else moves its run to a run of twice
    /// the size.
    fn enlarge(&mut self, object: u32, at: usize) {
        let (old_start, old_class) = self.run(at);
        if old_class == NO_RUN {
            let start = self.take_run(0);
            return self.heads[at].set_run(start, 0);
        }
        let start = self.take_run(old_class + 1);
        let from = old_start as usize;
        self.pool.copy_within(from..from + (1 << old_class), start as usize);
        self.free[old_class as usize].push(old_start);
        self.heads[at].set_run(start, old_class + 1);
        if old_class + 1 == HEAVY {
            self.index_links(object, at);
        }
    }

    /// Adds the links of an object that has become heavy to `link_indices`.
    #[cold]
    fn index_links(&mut self, object: u32, at: usize) {
        for index in 0..self.heads[at].count() {
            let partner = self.link(at, index).partner;
            self.link_indices.set(link_key(object, partner), index);
        }
    }

    /// Returns the first line and the class of the run of the object with head `at`.
    fn run(&self, at: usize) -> (u32, u32) {
        let head = &self.heads[at];
        (head.start, head.class())
    }

    /// Takes a run of `2^class` lines: a released run if there is one, else new lines at the end of
    /// the pool. Returns the index of the run's first line.
    fn take_run(&mut self, class: u32) -> u32 {
        let class = class as usize;
        if self.free.len() <= class {
            self.free.resize(class + 1, Vec::new());
        }
        self.free[class].pop().unwrap_or_else(|| {
            let start = small(self.pool.len());
            self.pool.resize(self.pool.len() + (1 << class), Line::default());
            start
        })
    }

    /// Releases the run of an object whose remaining links fit in its head.
    fn release(&mut self, object: u32, at: usize) {
        let (start, class) = self.run(at);
        if class >= HEAVY {
            let links = self.heads[at].links;
            links.iter().for_each(|link| self.link_indices.remove(link_key(object, link.partner)));
        }
        self.free[class as usize].push(start);
        self.heads[at].set_run(0, NO_RUN);
    }

    /// Releases memory: idle heads if there are many, and surplus capacity.
    pub(super) fn fit(&mut self, look: Look) {
        if self.idle.len() > self.heads.len() / 2 + MAX_IDLE {
            self.drop_idle();
        }
        look.fit(&mut self.head_indices);
        look.fit(&mut self.heads);
        look.fit(&mut self.pool);
    }

    /// Removes the idle heads, and sorts the others by object.
    fn drop_idle(&mut self) {
        let used = self.heads.len() - self.idle.len();
        let mut heads = Vec::with_capacity(used + used / 8);
        for at in self.head_indices.iter_mut().filter(|at| **at != NO_HEAD) {
            heads.push(self.heads[*at as usize]);
            *at = small(heads.len() - 1);
        }
        self.heads = heads;
        self.idle = Vec::new();
    }

    /// Checks that no two objects share a head and no two runs share a line, that runs are inside
    /// the pool, and that no object has more links than its capacity.
    pub(super) fn validate(&self) -> Result<(), String> {
        self.validate_heads()?;
        let mut used = vec![false; self.pool.len()];
        let live = self.heads.iter().filter(|head| head.class() != NO_RUN);
        let live = live.map(|head| (head.start, head.class() as usize));
        let free = self.free.iter().enumerate();
        let free = free.flat_map(|(class, starts)| starts.iter().map(move |&start| (start, class)));
        for (start, class) in live.chain(free) {
            for line in start as usize..start as usize + (1 << class) {
                let taken = used.get_mut(line).ok_or(format!("line {line} is outside the pool"))?;
                if core::mem::replace(taken, true) {
                    return Err(format!("line {line} belongs to two runs"));
                }
            }
        }
        let fits = |head: &Head| head.count() as usize <= head.capacity();
        self.heads.iter().all(fits).then_some(()).ok_or("a run is overfull".to_owned())?;
        self.validate_link_indices()
    }

    /// Checks that every head either belongs to one object and has links, or is idle and has none.
    fn validate_heads(&self) -> Result<(), String> {
        let mut owners = vec![0_u8; self.heads.len()];
        for (object, &at) in self.head_indices.iter().enumerate().filter(|(_, at)| **at != NO_HEAD)
        {
            let head = self.heads.get(at as usize).filter(|head| head.count() > 0);
            head.ok_or(format!("object {object} has the head {at}, which has no links"))?;
            owners[at as usize] += 1;
        }
        for &at in &self.idle {
            let is_empty = self.heads[at as usize].count_and_class == NO_RUN;
            is_empty.then_some(()).ok_or(format!("the idle head {at} has links"))?;
            owners[at as usize] += 1;
        }
        match owners.iter().position(|&count| count != 1) {
            Some(at) => Err(format!("head {at} belongs to {} objects", owners[at])),
            None => Ok(()),
        }
    }

    /// Checks that `link_indices` has exactly the links of the heavy objects.
    fn validate_link_indices(&self) -> Result<(), String> {
        let mut heavy = 0;
        let is_heavy = |object: &u32| self.head_index(*object).is_some_and(|at| self.is_heavy(at));
        for object in (0..small(self.head_indices.len())).filter(is_heavy) {
            for (index, link) in (0..).zip(self.links(object)) {
                if self.link_indices.get(link_key(object, link.partner)) != Some(index) {
                    return Err(format!("link {index} of the heavy {object} is lost"));
                }
            }
            heavy += self.count(object);
        }
        let listed = self.link_indices.len();
        (heavy == listed)
            .then_some(())
            .ok_or(format!("{heavy} links of heavy ones, {listed} listed"))
    }
}
