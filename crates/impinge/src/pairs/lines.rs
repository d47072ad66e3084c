//! The links of each object: a cache line of its own, and a run of further lines if it has many.

use super::places::Places;

/// Links in one line.
const PER_LINE: usize = 8;
/// Links in the line that every object has, beside what describes the rest.
const INLINE: usize = PER_LINE - 1;
/// The class of a run that is not there.
const NO_RUN: u32 = 31;
/// The class from which on an object is heavy: more than 135 links came. It stays so until its run
/// is given back, so that objects do not come and go between the two. Searching the seventeen lines
/// of the heaviest light object costs about what the table does.
const HEAVY: u32 = 5;

/// One end of a pair, as the object at the other end sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Link {
    /// The number of the object at the other end.
    pub(super) partner: u32,
    /// Where the pair stands in the dense array.
    pub(super) pair: u32,
}

/// The first links of an object, and where the others are.
///
/// Most objects have few partners: for them everything is in this one line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Head {
    links: [Link; INLINE],
    /// The first line of the run, `2^class` lines long.
    start: u32,
    /// The class of the run in the lowest five bits, [`NO_RUN`] while there is none; above them the
    /// number of links.
    count_and_class: u32,
}

impl Head {
    const EMPTY: Self =
        Self { links: [Link { partner: 0, pair: 0 }; INLINE], start: 0, count_and_class: NO_RUN };

    const fn count(&self) -> u32 {
        self.count_and_class >> 5
    }

    const fn class(&self) -> u32 {
        self.count_and_class & 31
    }

    fn set_count(&mut self, count: u32) {
        assert!(count < 1 << 27, "an object has fewer than 2^27 partners");
        self.count_and_class = count << 5 | self.class();
    }

    fn set_run(&mut self, start: u32, class: u32) {
        self.start = start;
        self.count_and_class = self.count_and_class & !31 | class;
    }

    /// How many links fit.
    const fn capacity(&self) -> usize {
        if self.class() == NO_RUN { INLINE } else { INLINE + (PER_LINE << self.class()) }
    }
}

/// Eight links in a cache line.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
struct Line {
    links: [Link; PER_LINE],
}

/// The links of all objects.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    /// By object.
    heads: Vec<Head>,
    /// The runs.
    pool: Vec<Line>,
    /// Starts of abandoned runs, by class.
    free: Vec<Vec<u32>>,
    /// The places of the links of heavy objects.
    places: Places,
}

/// Where among the first `count` links that to the partner stands. All are looked at: where a search
/// ends, no processor foresees.
#[inline]
fn place_in(links: &[Link], count: usize, partner: u32) -> Option<u32> {
    let hit = |at: usize| u32::from(links[at].partner == partner) << at;
    let hits = (0..links.len()).fold(0, |hits, at| hits | hit(at));
    let place = hits.trailing_zeros();
    ((place as usize) < count.min(links.len())).then_some(place)
}

/// The link from an object to a partner, as one number.
#[inline]
fn directed(object: u32, partner: u32) -> u64 {
    u64::from(object) << 32 | u64::from(partner)
}

/// A position or count as the `u32` it is stored as.
pub(super) fn small(value: usize) -> u32 {
    u32::try_from(value).expect("a pair table holds fewer than 2^32 entries")
}

impl Lines {
    /// Makes room for the object.
    pub(super) fn reach(&mut self, object: u32) {
        let needed = object as usize + 1;
        if self.heads.len() < needed {
            self.heads.resize(needed, Head::EMPTY);
        }
    }

    /// One more than the largest object number seen.
    pub(super) fn objects(&self) -> usize {
        self.heads.len()
    }

    /// How many links the object has; 0 for one never seen.
    #[inline]
    pub(super) fn count(&self, object: u32) -> usize {
        self.heads.get(object as usize).map_or(0, |head| head.count() as usize)
    }

    /// The links of the object, by place.
    pub(super) fn links(&self, object: u32) -> impl Iterator<Item = Link> + '_ {
        let head = self.heads.get(object as usize).unwrap_or(&Head::EMPTY);
        let count = head.count() as usize;
        let start = head.start as usize;
        let lines = start..start + count.saturating_sub(INLINE).div_ceil(PER_LINE);
        let rest = self.pool[lines].iter().flat_map(|line| &line.links);
        head.links.iter().chain(rest).take(count).copied()
    }

    /// The last link of the object, if it has any.
    pub(super) fn last_link(&self, object: u32) -> Option<Link> {
        let last = self.count(object).checked_sub(1)?;
        Some(self.link(object, small(last)))
    }

    /// The link at `place` among the links of the object.
    #[inline]
    fn link(&self, object: u32, place: u32) -> Link {
        let head = &self.heads[object as usize];
        if let Some(link) = head.links.get(place as usize) {
            return *link;
        }
        let beyond = place as usize - INLINE;
        self.pool[head.start as usize + beyond / PER_LINE].links[beyond % PER_LINE]
    }

    /// The link at `place` among the links of the object, to write.
    #[inline]
    fn link_mut(&mut self, object: u32, place: u32) -> &mut Link {
        let head = &mut self.heads[object as usize];
        let place = place as usize;
        if place < INLINE {
            return &mut head.links[place];
        }
        let beyond = place - INLINE;
        &mut self.pool[head.start as usize + beyond / PER_LINE].links[beyond % PER_LINE]
    }

    /// The object has so many links that it should not be searched.
    #[inline]
    fn is_heavy(&self, object: u32) -> bool {
        self.heads.get(object as usize).is_some_and(|head| (HEAVY..NO_RUN).contains(&head.class()))
    }

    /// The place of the link to the partner among the links of the object.
    #[inline]
    fn find(&self, object: u32, partner: u32) -> Option<u32> {
        let head = self.heads.get(object as usize)?;
        let count = head.count() as usize;
        let place = place_in(&head.links, count, partner);
        if place.is_some() || head.class() == NO_RUN {
            return place;
        }
        if head.class() >= HEAVY {
            return self.places.get(directed(object, partner));
        }
        let (start, beyond) = (head.start as usize, count.saturating_sub(INLINE));
        let lines = self.pool[start..start + beyond.div_ceil(PER_LINE)].iter();
        lines.enumerate().find_map(|(at, line)| {
            let place = place_in(&line.links, beyond - at * PER_LINE, partner)?;
            Some(small(INLINE + at * PER_LINE) + place)
        })
    }

    /// Where the pair stands in the dense array, if the two have one: asks the one with fewer links.
    #[inline]
    pub(super) fn pair_of(&self, a: u32, b: u32) -> Option<usize> {
        let a_is_lighter = self.count(a) <= self.count(b);
        let (from, to) = if a_is_lighter { (a, b) } else { (b, a) };
        Some(self.link(from, self.find(from, to)?).pair as usize)
    }

    /// Tells the link from the object to the partner, which must be there, where the pair stands.
    #[inline]
    pub(super) fn set_pair(&mut self, object: u32, link: Link) {
        let place = self.find(object, link.partner).expect("both ends of a pair have links");
        *self.link_mut(object, place) = link;
    }

    /// Adds a link.
    #[inline]
    pub(super) fn push(&mut self, object: u32, link: Link) {
        let head = &mut self.heads[object as usize];
        let count = head.count();
        if count as usize == head.capacity() {
            self.enlarge(object);
        }
        self.heads[object as usize].set_count(count + 1);
        *self.link_mut(object, count) = link;
        if self.is_heavy(object) {
            self.places.set(directed(object, link.partner), count);
        }
    }

    /// Takes the link to the partner out, if it is there, and says where the pair stands. The
    /// object's last link takes its place.
    #[inline]
    pub(super) fn remove(&mut self, object: u32, partner: u32) -> Option<usize> {
        let place = self.find(object, partner)?;
        let last = self.heads[object as usize].count() - 1;
        let (taken, moved) = (self.link(object, place), self.link(object, last));
        *self.link_mut(object, place) = moved;
        self.heads[object as usize].set_count(last);
        if self.is_heavy(object) {
            self.places.set(directed(object, moved.partner), place);
            self.places.remove(directed(object, partner));
        }
        if last as usize == INLINE {
            self.release(object);
        }
        Some(taken.pair as usize)
    }

    /// Gives the object a run, or moves its run to one of twice the size.
    fn enlarge(&mut self, object: u32) {
        let (old_start, old_class) = self.run(object);
        if old_class == NO_RUN {
            let start = self.take_run(0);
            return self.heads[object as usize].set_run(start, 0);
        }
        let start = self.take_run(old_class + 1);
        let from = old_start as usize;
        self.pool.copy_within(from..from + (1 << old_class), start as usize);
        self.free[old_class as usize].push(old_start);
        self.heads[object as usize].set_run(start, old_class + 1);
        if old_class + 1 == HEAVY {
            self.enter_places(object);
        }
    }

    /// Enters the links of an object that became heavy.
    #[cold]
    fn enter_places(&mut self, object: u32) {
        for place in 0..self.heads[object as usize].count() {
            let partner = self.link(object, place).partner;
            self.places.set(directed(object, partner), place);
        }
    }

    fn run(&self, object: u32) -> (u32, u32) {
        let head = &self.heads[object as usize];
        (head.start, head.class())
    }

    /// A run of `2^class` lines: an abandoned one or new lines at the end of the pool.
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

    /// Gives the run of an object back to the pool; what it has left fits its head.
    fn release(&mut self, object: u32) {
        let (start, class) = self.run(object);
        if class >= HEAVY {
            let links = self.heads[object as usize].links;
            links.iter().for_each(|link| self.places.remove(directed(object, link.partner)));
        }
        self.free[class as usize].push(start);
        self.heads[object as usize].set_run(0, NO_RUN);
    }

    /// Forgets every link and keeps the memory.
    pub(super) fn clear(&mut self) {
        self.heads.clear();
        self.pool.clear();
        self.free.clear();
        self.places.clear();
    }

    /// Checks that no two runs share a line, none leaves the pool, and none is overfull.
    pub(super) fn validate(&self) -> Result<(), String> {
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
        self.validate_places()
    }

    /// Every link of a heavy object is listed, and no other.
    fn validate_places(&self) -> Result<(), String> {
        let mut heavy = 0;
        for object in (0..small(self.heads.len())).filter(|&object| self.is_heavy(object)) {
            for (place, link) in (0..).zip(self.links(object)) {
                if self.places.get(directed(object, link.partner)) != Some(place) {
                    return Err(format!("link {place} of the heavy {object} is lost"));
                }
            }
            heavy += self.count(object);
        }
        let listed = self.places.len();
        (heavy == listed)
            .then_some(())
            .ok_or(format!("{heavy} links of heavy ones, {listed} listed"))
    }
}
