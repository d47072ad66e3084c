//! When lists give memory back.
//!
//! A list that has been long keeps its memory, so that a step takes none from the allocator. What was long
//! once, when everything came at the same time, would keep it for ever. So whoever owns lists notes how
//! long they were, and once in [`PERIOD`] updates gives back what was not needed since. Short lists keep
//! what they have; all outcomes depend on lengths alone.

/// Implements `Clone` field by field, so that `clone_from` writes into the lists that are there. A field that is
/// missing does not compile.
macro_rules! clone_fields {
    ([$($generics:tt)*] $type:ty { $($field:ident),* $(,)? }) => {
        impl<$($generics)*> Clone for $type {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone()),* }
            }

            fn clone_from(&mut self, source: &Self) {
                $(self.$field.clone_from(&source.$field);)*
            }
        }
    };
}
pub(crate) use clone_fields;

/// Updates between two looks at the lists.
const PERIOD: u32 = 64;
/// The entries for which a list may keep memory.
const KEPT: usize = 4096;
/// The bytes that a list may have to spare.
const SPARE: usize = 16384;

/// How long the lists of an owner have been lately, and how many things it has.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recent {
    updates: u32,
    longest: usize,
    count: usize,
}

/// What a look at the lists may act on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    /// How long a list has been at most since the last look.
    pub(crate) longest: usize,
    /// No more things are there than at the last look.
    pub(crate) is_settled: bool,
}

impl Recent {
    /// Notes that some list was so long in this update.
    pub(crate) fn note(&mut self, length: usize) {
        self.longest = self.longest.max(length);
    }

    /// Ends an update in which there were so many things; now and then it is time for a look.
    pub(crate) fn end_update(&mut self, count: usize) -> Option<Look> {
        self.updates += 1;
        if self.updates < PERIOD {
            return None;
        }
        let look = Look { longest: self.longest, is_settled: count <= self.count };
        *self = Self { count, ..Self::default() };
        Some(look)
    }
}

impl Look {
    /// Gives back what a list of passing use has beyond what was needed lately, if that is most of it.
    pub(crate) fn trim<T>(self, list: &mut Vec<T>) {
        if list.capacity() > KEPT && list.capacity() / 4 > self.longest {
            list.shrink_to((2 * self.longest).max(list.len()));
        }
    }

    /// Leaves a list that has stopped to grow an eighth to spare.
    pub(crate) fn fit<T>(self, list: &mut Vec<T>) {
        let spare = list.len() / 8;
        let surplus = list.capacity() - list.len();
        if self.is_settled && surplus > 2 * spare && surplus * size_of::<T>() > SPARE {
            list.shrink_to(list.len() + spare);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The looks of some updates in which a list was so long.
    fn looks(recent: &mut Recent, updates: u32, length: usize, count: usize) -> Vec<Look> {
        let one = |_| {
            recent.note(length);
            recent.end_update(count)
        };
        (0..updates).filter_map(one).collect()
    }

    #[test]
    fn what_is_used_is_kept() {
        let (mut recent, mut list) = (Recent::default(), Vec::<u8>::with_capacity(100_000));
        for look in looks(&mut recent, 5 * PERIOD, 30_000, 7) {
            look.trim(&mut list);
        }
        assert!(list.capacity() >= 100_000, "more than a quarter is in use");
    }

    #[test]
    fn what_was_needed_once_is_given_back() {
        let (mut recent, mut list) = (Recent::default(), Vec::<u8>::with_capacity(100_000));
        let first = looks(&mut recent, 1, 90_000, 7);
        let later = looks(&mut recent, PERIOD, 10, 7);
        assert_eq!((first.len(), later.len()), (0, 1), "one look in a period");
        later[0].trim(&mut list);
        assert!(list.capacity() >= 90_000, "used in this period");
        for look in looks(&mut recent, PERIOD, 10, 7) {
            look.trim(&mut list);
        }
        assert!((20..=KEPT).contains(&list.capacity()), "{}", list.capacity());
        let mut short = Vec::<u8>::with_capacity(KEPT);
        looks(&mut recent, PERIOD, 0, 7)[0].trim(&mut short);
        assert!(short.capacity() >= KEPT, "short lists keep what they have");
    }

    #[test]
    fn lists_that_grow_keep_their_room() {
        let (mut recent, mut list) = (Recent::default(), vec![0_u8; 50_000]);
        list.reserve_exact(50_000);
        looks(&mut recent, PERIOD, 0, 49_000)[0].fit(&mut list);
        assert!(list.capacity() >= 100_000, "it has grown since the last look");
        looks(&mut recent, PERIOD, 0, 49_000)[0].fit(&mut list);
        assert!((56_250..60_000).contains(&list.capacity()), "{}", list.capacity());
        looks(&mut recent, PERIOD, 0, 49_000)[0].fit(&mut list);
        assert!(list.capacity() >= 56_250, "and no less");
    }
}
