//! Runs long computations with the interpreter released, shows their progress, and stops them on
//! Ctrl-C or at an exception.
//!
//! Signals and progress bars belong to the calling thread. That thread sleeps while another thread
//! computes. It wakes every [`TICK`] to check signals and to show progress. After an exception it
//! stops the computation through the progress callback of the batch.

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use core::time::Duration;
use std::panic::resume_unwind;
use std::thread;

use impinge::batch::{BatchError, Control};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::answer::Extent;
use crate::threads::Crew;

/// The largest number of elements that are computed in the calling thread, if there is no progress
/// bar. The library does not divide batches of this size among threads either.
const SMALL: usize = 64;

/// The interval at which signals are checked and progress is updated.
const TICK: Duration = Duration::from_millis(50);

/// The options of a call.
#[derive(Debug, Default)]
pub(crate) struct Call {
    /// The number of threads; by default one for each core.
    threads: Option<usize>,
    /// An object with the method `update(n)`, such as a bar of tqdm.
    progress: Option<Py<PyAny>>,
}

impl Call {
    /// Creates a call from the arguments of Python.
    pub(crate) fn new(threads: Option<Threads>, progress: Option<Py<PyAny>>) -> Self {
        Self { threads: threads.map(|threads| threads.0), progress }
    }
}

/// The number of threads that a call may use: at least one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Threads(usize);

impl FromPyObject<'_, '_> for Threads {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        count(given, "threads").map(Self)
    }
}

/// Reads a positive integer, the argument `name`.
pub(crate) fn count(given: Borrowed<'_, '_, PyAny>, name: &str) -> PyResult<usize> {
    match given.extract::<usize>() {
        Ok(number) if number > 0 => Ok(number),
        Err(error) if error.is_instance_of::<PyTypeError>(given.py()) => {
            let kind = given.get_type().name()?;
            Err(PyTypeError::new_err(format!("{name} is a {kind}, where an integer is needed")))
        }
        _ => {
            let value = given.str()?;
            Err(PyValueError::new_err(format!("{name} is {value}: it is at least 1, or None")))
        }
    }
}

/// A callback that receives the number of finished elements, and may stop the work.
type Report<'a> = &'a (dyn Fn(usize) -> ControlFlow<()> + Sync);

/// Runs `work` for `extent`. Releases the interpreter meanwhile, unless the query is quick and has
/// no progress bar.
///
/// # Errors
/// Exceptions of the work and the progress bar, and `KeyboardInterrupt`; the work has then stopped.
#[inline]
pub(crate) fn supervise<T: Send>(
    py: Python<'_>,
    extent: Extent,
    call: &Call,
    work: impl Fn(&Control<'_>) -> Result<T, BatchError> + Sync,
) -> PyResult<Result<T, BatchError>> {
    if matches!(extent, Extent::Lone { is_quick: true }) && call.progress.is_none() {
        return Ok(work(&Control::new()));
    }
    released(py, extent.len(), call, |report| match report {
        Some(report) => work(&Control::with_progress(report)),
        None => work(&Control::new()),
    })
}

/// Returns the results of `ask` for each element, in order, with the interpreter released. The threads share
/// chunks of elements.
///
/// # Errors
/// Exceptions of the progress bar, and `KeyboardInterrupt`.
pub(crate) fn each<T: Send>(
    py: Python<'_>,
    len: usize,
    call: &Call,
    ask: impl Fn(usize) -> T + Sync,
) -> PyResult<Vec<T>> {
    released(py, len, call, |report| match report {
        Some(report) => in_chunks(len, report, &ask),
        None => (0..len).map(&ask).collect(),
    })
}

/// Runs `work` with the interpreter released: in this thread if there are at most [`SMALL`]
/// elements and no progress bar, otherwise in another thread that reports progress.
fn released<T: Send>(
    py: Python<'_>,
    len: usize,
    call: &Call,
    work: impl Fn(Option<Report<'_>>) -> T + Sync,
) -> PyResult<T> {
    if len <= SMALL && call.progress.is_none() {
        return Ok(py.detach(|| work(None)));
    }
    let crew = Crew::of(py, call.threads)?;
    py.detach(|| beside(call, &crew, &work))
}

/// Computes chunks of [`SMALL`] elements on all threads, and reports each. After a stop the
/// remaining chunks are left out of the results.
fn in_chunks<T: Send>(
    len: usize,
    report: Report<'_>,
    ask: &(impl Fn(usize) -> T + Sync),
) -> Vec<T> {
    let (done, is_stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let chunks = (0..len.div_ceil(SMALL)).into_par_iter().map(|chunk| {
        if is_stopped.load(Ordering::Relaxed) {
            return Vec::new();
        }
        let begin = chunk * SMALL;
        let found: Vec<T> = (begin..len.min(begin + SMALL)).map(ask).collect();
        let before = done.fetch_add(found.len(), Ordering::Relaxed);
        if report(before + found.len()).is_break() {
            is_stopped.store(true, Ordering::Relaxed);
        }
        found
    });
    let chunks: Vec<Vec<T>> = chunks.collect();
    chunks.into_iter().flatten().collect()
}

/// Runs `work` in another thread, which this thread supervises. The interpreter is released.
fn beside<T: Send>(
    call: &Call,
    crew: &Crew,
    work: &(impl Fn(Option<Report<'_>>) -> T + Sync),
) -> PyResult<T> {
    let watch = Watch::default();
    let report = |done| watch.report(done);
    let caller = thread::current();
    thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let found = crew.run(|| work(Some(&report)));
            watch.is_finished.store(true, Ordering::Release);
            caller.unpark();
            found
        });
        let outcome = watch.wait(call);
        let found = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
        outcome.map(|()| found)
    })
}

/// The state shared by the calling thread and the thread that computes.
#[derive(Debug, Default)]
struct Watch {
    done: AtomicUsize,
    is_stopped: AtomicBool,
    is_finished: AtomicBool,
}

impl Watch {
    /// Reports that the worker has finished `done` elements.
    fn report(&self, done: usize) -> ControlFlow<()> {
        self.done.fetch_max(done, Ordering::Relaxed);
        if self.is_stopped.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Waits for the worker, shows its progress, and stops it at the first exception.
    fn wait(&self, call: &Call) -> PyResult<()> {
        let (mut shown, mut outcome) = (0, Ok(()));
        loop {
            let is_finished = self.is_finished.load(Ordering::Acquire);
            if outcome.is_ok() {
                outcome = Python::attach(|py| self.tick(py, call, &mut shown));
                self.is_stopped.store(outcome.is_err(), Ordering::Relaxed);
            }
            if is_finished {
                return outcome;
            }
            thread::park_timeout(TICK);
        }
    }

    fn tick(&self, py: Python<'_>, call: &Call, shown: &mut usize) -> PyResult<()> {
        py.check_signals()?;
        let done = self.done.load(Ordering::Relaxed);
        if let Some(bar) = call.progress.as_ref().filter(|_| done > *shown) {
            bar.call_method1(py, "update", (done - *shown,))?;
            *shown = done;
        }
        Ok(())
    }
}
