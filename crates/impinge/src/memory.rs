//! Release of the unused memory of lists.
//!
//! A list keeps its capacity when it is cleared, so that a step need not allocate. But a list that
//! was long only once, such as after a bulk insertion, would keep that capacity for ever. So the
//! owner of lists records their lengths in each update. Every [`PERIOD`] updates it releases
//! capacity that was not needed since the last check. Short lists keep their capacity. The
//! decisions depend on lengths and capacities alone.

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
/// empty lists, and `clone_from` keeps the lists of the target.
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

/// The number of updates between two checks of the lists.
const PERIOD: u32 = 64;
/// A temporary list with at most this capacity, in entries, is never shrunk; see [`Look::trim`].
const KEPT: usize = 4096;
/// A list with at most this much unused capacity, in bytes, is never shrunk; see [`Look::fit`].
const SPARE: usize = 16384;

/// Statistics of the updates since the last check of an owner's lists.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recent {
    updates: u32,
    longest: usize,
    count: usize,
}

/// The statistics of one period, which decide how lists are shrunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    /// The greatest recorded length of any list since the last check.
    pub(crate) longest: usize,
    /// Whether the number of objects has not increased since the last check.
    pub(crate) is_stable: bool,
}

impl Recent {
    /// Records the length of a list in this update.
    pub(crate) fn note(&mut self, length: usize) {
        self.longest = self.longest.max(length);
    }

    /// Ends an update with `count` objects. Returns the statistics in the last update of a period,
    /// else `None`.
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
    /// Shrinks a list of temporary data if its capacity exceeds [`KEPT`] and less than a quarter of
    /// it was needed in the period.
    pub(crate) fn trim<T>(self, list: &mut Vec<T>) {
        if list.capacity() > KEPT && list.capacity() / 4 > self.longest {
            list.shrink_to((2 * self.longest).max(list.len()));
        }
    }

    /// If the number of objects has stopped growing, shrinks a list whose unused capacity exceeds a
    /// quarter of its length and [`SPARE`] bytes; leaves an eighth of its length unused.
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

    /// Returns the statistics of all periods that end in `updates` updates, with a list of length
    /// `length` and `count` objects.
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
