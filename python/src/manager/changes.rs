//! The recent changes of objects.

use std::collections::{BTreeSet, VecDeque};

/// The largest number of stored changes. After more changes, recomputing a cached result takes less
/// time than updating it change by change.
const KEPT: usize = 256;

/// The changes of a crowd, numbered from its beginning.
#[derive(Debug, Default)]
pub(super) struct Changes {
    count: u64,
    /// The indices of the objects that changed last, the latest at the end.
    recent: VecDeque<u32>,
}

impl Changes {
    /// Records that an object was added, moved or removed.
    pub(super) fn note(&mut self, index: u32) {
        self.count += 1;
        if self.recent.len() == KEPT {
            self.recent.pop_front();
        }
        self.recent.push_back(index);
    }

    /// The number of changes so far.
    pub(super) const fn now(&self) -> u64 {
        self.count
    }

    /// Returns the objects that changed after the first `then` changes, each once; `None` if more
    /// changes happened since than are stored.
    pub(super) fn since(&self, then: u64) -> Option<BTreeSet<u32>> {
        let count = usize::try_from(self.count - then).ok()?;
        let begin = self.recent.len().checked_sub(count)?;
        Some(self.recent.range(begin..).copied().collect())
    }

    /// Whether the object may have changed after the first `then` changes. Also `true` if some of
    /// these changes are no longer stored.
    pub(super) fn may_include(&self, index: u32, then: u64) -> bool {
        let count = usize::try_from(self.count - then).unwrap_or(usize::MAX);
        count > self.recent.len() || self.recent.iter().rev().take(count).any(|&one| one == index)
    }
}
