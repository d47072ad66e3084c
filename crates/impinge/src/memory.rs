//! Releasing memory of lists.
//!
//! A list that has been long keeps its memory, so that a step does not allocate. Without limit, a
//! list that was long once, such as after a bulk insertion, would keep it for ever. So owners of
//! lists note their lengths, and once in [`PERIOD`] updates release memory that was not needed
//! since. Short lists keep theirs; the results depend on lengths alone.

/// Implements `Clone` field by field, so that `clone_from` reuses the memory of lists. A missing
/// field does not compile.
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

/// Implements `Clone` for scratch lists, which have no meaning between two updates: a clone has
/// empty ones, and `clone_from` keeps those of the target.
macro_rules! clone_empty {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> Clone for $type {
            fn clone(&self) -> Self {
                Self::default()
            }

            fn clone_from(&mut self, _: &Self) {}
        }
    };
}
pub(crate) use clone_empty;

/// Updates between two checks of the lists.
const PERIOD: u32 = 64;
/// Number of entries up to which a list always keeps its memory.
const KEPT: usize = 4096;
/// Number of spare bytes up to which a list always keeps its memory.
const SPARE: usize = 16384;

/// Recent lengths of an owner's lists, and its number of objects.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recent {
    updates: u32,
    longest: usize,
    count: usize,
}

/// Statistics of a period, by which lists are shrunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    /// The greatest length of a list since the last check.
    pub(crate) longest: usize,
    /// The number of objects has not increased since the last check.
    pub(crate) is_stable: bool,
}

impl Recent {
    /// Notes the length of a list in this update.
    pub(crate) fn note(&mut self, length: usize) {
        self.longest = self.longest.max(length);
    }

    /// Ends an update with `count` objects; returns the statistics when a period is over.
    pub(crate) fn end_update(&mut self, count: usize) -> Option<Look> {
        self.updates += 1;
        if self.updates < PERIOD {
            return None;
        }
        let look = Look { longest: self.longest, is_stable: count <= self.count };
        *self = Self { count, ..Self::default() };
        Some(look)
    }
}

impl Look {
    /// Shrinks a temporary list if less than a quarter of it was needed lately.
    pub(crate) fn trim<T>(self, list: &mut Vec<T>) {
        if list.capacity() > KEPT && list.capacity() / 4 > self.longest {
            list.shrink_to((2 * self.longest).max(list.len()));
        }
    }

    /// Shrinks a list that has stopped growing to an eighth of spare capacity.
    pub(crate) fn fit<T>(self, list: &mut Vec<T>) {
        let spare = list.len() / 8;
        let surplus = list.capacity() - list.len();
        if self.is_stable && surplus > 2 * spare && surplus * size_of::<T>() > SPARE {
            list.shrink_to(list.len() + spare);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the checks in a number of updates with a list of this length.
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
    fn lists_that_grow_keep_their_capacity() {
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
