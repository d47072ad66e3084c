//! Runs of links, one per object, in a shared pool of cache lines.

/// Links in one line.
const PER_LINE: usize = 8;

/// One end of a pair, as the object at the other end sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Link {
    /// The number of the object at the other end.
    pub(super) partner: u32,
    /// Where the pair stands in the dense array.
    pub(super) pair: u32,
}

/// Eight links in a cache line of their own.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
struct Line {
    links: [Link; PER_LINE],
}

/// Where the links of one object stand: `2^class` lines from `start`, `len` links in use.
///
/// `class` is [`Run::NONE`] while the object has no lines yet.
#[derive(Clone, Copy, Debug)]
struct Run {
    start: u32,
    len: u32,
    class: u8,
}

impl Run {
    const NONE: u8 = u8::MAX;
    const EMPTY: Self = Self { start: 0, len: 0, class: Self::NONE };

    /// How many links fit.
    fn capacity(self) -> usize {
        if self.class == Self::NONE { 0 } else { PER_LINE << self.class }
    }
}

/// The runs of all objects.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    pool: Vec<Line>,
    /// Starts of abandoned runs, by class.
    free: Vec<Vec<u32>>,
    /// By object.
    runs: Vec<Run>,
}

/// A position or count as the `u32` it is stored as.
pub(super) fn small(value: usize) -> u32 {
    u32::try_from(value).expect("a pair table holds fewer than 2^32 entries")
}

impl Lines {
    /// Makes room for the object.
    pub(super) fn reach(&mut self, object: u32) {
        let needed = object as usize + 1;
        if self.runs.len() < needed {
            self.runs.resize(needed, Run::EMPTY);
        }
    }

    /// One more than the largest object number seen.
    pub(super) fn objects(&self) -> usize {
        self.runs.len()
    }

    /// How many links the object has; 0 for one never seen.
    #[inline]
    pub(super) fn count(&self, object: u32) -> usize {
        self.runs.get(object as usize).map_or(0, |run| run.len as usize)
    }

    /// The links of the object, in their order in memory.
    pub(super) fn links(&self, object: u32) -> impl Iterator<Item = Link> + '_ {
        let run = self.runs.get(object as usize).copied().unwrap_or(Run::EMPTY);
        let lines = (run.len as usize).div_ceil(PER_LINE);
        let start = run.start as usize;
        let all = self.pool[start..start + lines].iter().flat_map(|line| line.links);
        all.take(run.len as usize)
    }

    /// The link at `place` among the links of the object.
    #[inline]
    pub(super) fn link(&self, object: u32, place: u32) -> Link {
        let start = self.runs[object as usize].start as usize;
        self.pool[start + place as usize / PER_LINE].links[place as usize % PER_LINE]
    }

    /// The link at `place` among the links of the object, to write.
    #[inline]
    pub(super) fn link_mut(&mut self, object: u32, place: u32) -> &mut Link {
        let start = self.runs[object as usize].start as usize;
        &mut self.pool[start + place as usize / PER_LINE].links[place as usize % PER_LINE]
    }

    /// Adds a link and says at which place.
    #[inline]
    pub(super) fn push(&mut self, object: u32, link: Link) -> u32 {
        let run = self.runs[object as usize];
        if run.len as usize == run.capacity() {
            self.enlarge(object);
        }
        self.runs[object as usize].len = run.len + 1;
        *self.link_mut(object, run.len) = link;
        run.len
    }

    /// Moves the run of the object to one of twice the size.
    fn enlarge(&mut self, object: u32) {
        let old = self.runs[object as usize];
        let class = if old.class == Run::NONE { 0 } else { old.class + 1 };
        let start = self.take_run(class);
        if old.class != Run::NONE {
            let from = old.start as usize;
            self.pool.copy_within(from..from + (1 << old.class), start as usize);
            self.free[usize::from(old.class)].push(old.start);
        }
        self.runs[object as usize] = Run { start, len: old.len, class };
    }

    /// A run of `2^class` lines: an abandoned one or new lines at the end of the pool.
    fn take_run(&mut self, class: u8) -> u32 {
        let class = usize::from(class);
        if self.free.len() <= class {
            self.free.resize(class + 1, Vec::new());
        }
        self.free[class].pop().unwrap_or_else(|| {
            let start = small(self.pool.len());
            self.pool.resize(self.pool.len() + (1 << class), Line::default());
            start
        })
    }

    /// Takes the link at `place` out; the object's last link moves there and is returned, unless
    /// it was the one taken.
    pub(super) fn swap_remove(&mut self, object: u32, place: u32) -> Option<Link> {
        let last = self.runs[object as usize].len - 1;
        let moved = self.link(object, last);
        *self.link_mut(object, place) = moved;
        self.runs[object as usize].len = last;
        if last == 0 {
            self.release(object);
        }
        (place != last).then_some(moved)
    }

    /// Gives the run of an object without links back to the pool.
    fn release(&mut self, object: u32) {
        let run = self.runs[object as usize];
        self.free[usize::from(run.class)].push(run.start);
        self.runs[object as usize] = Run::EMPTY;
    }

    /// Forgets every link and keeps the memory.
    pub(super) fn clear(&mut self) {
        self.pool.clear();
        self.free.clear();
        self.runs.clear();
    }

    /// Checks that no two runs share a line and none leaves the pool.
    pub(super) fn validate(&self) -> Result<(), String> {
        let mut used = vec![false; self.pool.len()];
        let live = self.runs.iter().filter(|run| run.class != Run::NONE);
        let live = live.map(|run| (run.start, usize::from(run.class)));
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
        let fits = |run: &Run| run.len as usize <= run.capacity();
        self.runs.iter().all(fits).then_some(()).ok_or("a run is overfull".to_owned())
    }
}
