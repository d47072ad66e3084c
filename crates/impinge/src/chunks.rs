//! Runs work on a long list in chunks: in order or, with the feature `parallel`, on several
//! threads.
//!
//! ```text
//!   range    | 0..64 | 64..128 | 128..192 | 192..200 |     the last may be shorter
//!   columns  |   c   |    c    |    c     |    c     |     the slots of the same elements
//!             \______________/   \__________________/
//!                 one half          the other half         rayon splits halves further, for idle threads
//! ```
//!
//! The boundaries of the chunks depend only on the number of elements, and no chunk reads results
//! of another chunk. So the bits of the results do not depend on the number of threads.

use core::ops::{ControlFlow, Range};

/// The number of elements that one thread computes at a time: enough to outweigh the overhead of a
/// chunk, few enough to end soon after a cancellation.
pub(crate) const CHUNK: usize = 64;

/// Output slots of a range of elements, which can be split together with the range.
pub(crate) trait Cut: Sized + Send {
    /// Splits off the slots of the first `at` elements; returns these slots and the remaining
    /// slots.
    fn cut(self, at: usize) -> (Self, Self);
}

/// A slot for each element, or an empty column.
impl<T: Send> Cut for &mut [T] {
    #[inline]
    fn cut(self, at: usize) -> (Self, Self) {
        let at = at.min(self.len());
        self.split_at_mut(at)
    }
}

/// No slots, for work that writes its results elsewhere.
impl Cut for () {
    fn cut(self, _: usize) -> ((), ()) {
        ((), ())
    }
}

/// A slot for each chunk.
pub(crate) struct PerChunk<'a, T>(pub(crate) &'a mut [T]);

impl<T: Send> Cut for PerChunk<'_, T> {
    fn cut(self, at: usize) -> (Self, Self) {
        let at = at.div_ceil(CHUNK).min(self.0.len());
        let (front, back) = self.0.split_at_mut(at);
        (Self(front), Self(back))
    }
}

/// Calls `work` with each chunk of a range and its slots, until a call returns `Break`. If several
/// threads run `work`, some later chunks may still run after that call.
pub(crate) fn each_chunk<C: Cut>(
    range: Range<usize>,
    columns: C,
    work: &(impl Fn(Range<usize>, C) -> ControlFlow<()> + Sync),
) -> ControlFlow<()> {
    #[cfg(feature = "parallel")]
    if range.len() > CHUNK && rayon::current_num_threads() > 1 {
        return in_halves(range, columns, work);
    }
    in_order(range, columns, work)
}

/// Runs the chunks one after the other.
fn in_order<C: Cut>(
    range: Range<usize>,
    mut columns: C,
    work: &impl Fn(Range<usize>, C) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let mut start = range.start;
    while start < range.end {
        let end = range.end.min(start + CHUNK);
        let (chunk, rest) = columns.cut(end - start);
        work(start..end, chunk)?;
        (start, columns) = (end, rest);
    }
    ControlFlow::Continue(())
}

/// Runs both halves of the chunks in parallel. The recursion depth is the logarithm of their
/// number.
#[cfg(feature = "parallel")]
fn in_halves<C: Cut>(
    range: Range<usize>,
    columns: C,
    work: &(impl Fn(Range<usize>, C) -> ControlFlow<()> + Sync),
) -> ControlFlow<()> {
    if range.len() <= CHUNK {
        return work(range, columns);
    }
    let half = range.len().div_ceil(CHUNK) / 2 * CHUNK;
    let middle = range.start + half;
    let (front, back) = columns.cut(half);
    let (one, other) = rayon::join(
        || in_halves(range.start..middle, front, work),
        || in_halves(middle..range.end, back, work),
    );
    if one.is_break() { one } else { other }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_has_its_slot() {
        for count in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 5 * CHUNK, 7 * CHUNK + 3] {
            let mut found = vec![0; count];
            let work = |range: Range<usize>, slots: &mut [usize]| {
                assert!(
                    range.start.is_multiple_of(CHUNK) && range.len() <= CHUNK,
                    "a chunk: {range:?}"
                );
                assert_eq!(slots.len(), range.len(), "a slot for each");
                for (slot, index) in slots.iter_mut().zip(range) {
                    *slot = index + 1;
                }
                ControlFlow::Continue(())
            };
            assert!(each_chunk(0..count, &mut found[..], &work).is_continue(), "to the end");
            assert!(found.iter().copied().eq(1..=count), "{count} elements");
        }
    }

    #[test]
    fn columns_that_are_not_wanted_stay_empty() {
        let work = |_: Range<usize>, slots: &mut [u8]| {
            assert!(slots.is_empty(), "there are none");
            ControlFlow::Continue(())
        };
        assert!(each_chunk(0..3 * CHUNK, &mut [][..], &work).is_continue(), "to the end");
    }

    #[test]
    fn in_order_nothing_follows_a_break() {
        let mut found = vec![false; 4 * CHUNK];
        let work = |range: Range<usize>, slots: &mut [bool]| {
            slots.fill(true);
            if range.start == CHUNK { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        assert!(in_order(0..4 * CHUNK, &mut found[..], &work).is_break(), "the work breaks");
        assert_eq!(found.iter().filter(|&&is_done| is_done).count(), 2 * CHUNK, "two chunks");
    }
}
