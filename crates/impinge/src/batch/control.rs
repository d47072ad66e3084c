//! Progress reports of batches, and cancellation.

use core::fmt;
use core::ops::{ControlFlow, Range};
use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use super::BatchError;
use crate::chunks::{CHUNK, Cut, PerChunk, each_chunk};

/// A callback that receives the number of finished elements.
type Report<'a> = &'a (dyn Fn(usize) -> ControlFlow<()> + Sync);

/// The maximum number of chunks whose lists are filled before [`Progress::collect`] passes them on.
/// It bounds the memory of these lists.
const CHUNKS_PER_WAVE: usize = 1024;

/// A callback that receives the progress of a batch and may cancel the batch.
///
/// The callback is called after each chunk of 64 elements, and after the last chunk, which may be
/// shorter. It receives the number of elements finished so far, which grows with each call; in the
/// last call this is the number of all elements. If the callback returns `Break`, the batch ends
/// with [`BatchError::Cancelled`] and the callback is not called again. With the feature `parallel`
/// the calls come from the threads of the pool, one at a time; the callback must not run work on
/// the pool itself, such as another batch, because it could wait for itself.
///
/// ```
/// use core::ops::ControlFlow;
/// use impinge::dim2::batch::{BatchError, Control, OnePose, PairBatch, Shapes, Side};
/// use impinge::dim2::math::Pose;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, poses) = (Ball::new(1.0_f64), vec![Pose::identity(); 1000]);
/// let here = OnePose(Pose::identity());
/// let one = Side::try_new(Shapes::One(&ball), &here)?;
/// let batch = PairBatch::try_new(one, Side::try_new(Shapes::One(&ball), &poses)?)?;
/// let mut distances = vec![0.0; 1000];
///
/// let until = |done: usize| if done < 500 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
/// let found = batch.distances(&Control::with_progress(&until), &mut distances);
/// assert_eq!(found, Err(BatchError::Cancelled { done: 512 }));
/// batch.distances(&Control::new(), &mut distances)?;
/// # Ok::<(), BatchError>(())
/// ```
#[derive(Clone, Copy, Default)]
pub struct Control<'a> {
    report: Option<Report<'a>>,
}

impl<'a> Control<'a> {
    /// Creates a control without a callback: the batch always runs to its end.
    #[must_use]
    pub const fn new() -> Self {
        Self { report: None }
    }

    /// Creates a control that calls `report` with the number of finished elements after each chunk.
    #[must_use]
    pub const fn with_progress(report: &'a (dyn Fn(usize) -> ControlFlow<()> + Sync)) -> Self {
        Self { report: Some(report) }
    }
}

impl fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Control").field("has_progress", &self.report.is_some()).finish()
    }
}

/// The number of finished elements of a running batch, and whether the batch is cancelled.
pub(crate) struct Progress<'a> {
    report: Option<Report<'a>>,
    /// The number of elements last reported. The lock is held while the callback runs.
    done: Mutex<usize>,
    is_cancelled: AtomicBool,
}

impl<'a> Progress<'a> {
    pub(crate) const fn new(control: &Control<'a>) -> Self {
        let is_cancelled = AtomicBool::new(false);
        Self { report: control.report, done: Mutex::new(0), is_cancelled }
    }

    /// Runs a batch of `count` elements. Calls `work` once for each chunk, with the chunk's range
    /// of elements and its part of `columns`.
    pub(crate) fn run<C: Cut>(
        &self,
        count: usize,
        columns: C,
        work: impl Fn(Range<usize>, C) + Sync,
    ) -> Result<(), BatchError> {
        self.each(0..count, columns, &work)
    }

    /// Runs a batch of `count` elements in which `work` fills one list for each chunk. Passes these
    /// lists to `take` in the order of the chunks. `take` must empty the list, since a later chunk
    /// reuses it.
    pub(crate) fn collect<T: Default + Send>(
        &self,
        count: usize,
        work: impl Fn(Range<usize>, &mut T) + Sync,
        mut take: impl FnMut(&mut T),
    ) -> Result<(), BatchError> {
        let mut lists: Vec<T> = Vec::new();
        lists.resize_with(count.div_ceil(CHUNK).min(CHUNKS_PER_WAVE), T::default);
        let mut start = 0;
        while start < count {
            let end = count.min(start + CHUNKS_PER_WAVE * CHUNK);
            // One list for each chunk: the last chunk would fill all lists that are left.
            let lists = &mut lists[..(end - start).div_ceil(CHUNK)];
            self.each(start..end, PerChunk(lists), &|range, PerChunk(lists)| {
                lists.iter_mut().for_each(|list| work(range.clone(), list));
            })?;
            lists.iter_mut().for_each(&mut take);
            start = end;
        }
        Ok(())
    }

    fn each<C: Cut>(
        &self,
        range: Range<usize>,
        columns: C,
        work: &(impl Fn(Range<usize>, C) + Sync),
    ) -> Result<(), BatchError> {
        let chunk = |range: Range<usize>, columns| {
            if self.is_cancelled.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            let count = range.len();
            work(range, columns);
            self.advance(count)
        };
        match each_chunk(range, columns, &chunk) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => {
                let done = *self.done.lock().unwrap_or_else(PoisonError::into_inner);
                Err(BatchError::Cancelled { done })
            }
        }
    }

    /// Reports that `count` more elements are finished. Returns `Break` if the batch is cancelled.
    fn advance(&self, count: usize) -> ControlFlow<()> {
        let Some(report) = self.report else { return ControlFlow::Continue(()) };
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        if self.is_cancelled.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        *done += count;
        let flow = report(*done);
        self.is_cancelled.store(flow.is_break(), Ordering::Relaxed);
        flow
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::sync::atomic::AtomicUsize;

    /// The lists of the last wave are fewer than those of the first, and each chunk is computed
    /// once.
    #[test]
    fn each_chunk_is_computed_once() {
        let (calls, chunks) = (AtomicUsize::new(0), CHUNKS_PER_WAVE + 2);
        let work = |range: Range<usize>, list: &mut Vec<usize>| {
            calls.fetch_add(1, Ordering::Relaxed);
            list.push(range.start);
        };
        let mut starts = Vec::new();
        let progress = Progress::new(&Control::new());
        let done = progress.collect(chunks * CHUNK, work, |list| starts.append(list));
        assert_eq!((done, calls.into_inner()), (Ok(()), chunks), "none twice");
        assert!(starts.iter().copied().eq((0..chunks).map(|chunk| chunk * CHUNK)), "in order");
    }
}
