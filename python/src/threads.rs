//! Pools of threads. Each pool is used in the process that created it only.
//!
//! After `fork` the child has the memory of its parent's pools but none of their threads: work for such a pool never
//! starts. Rayon's global pool belongs to the process that loaded this module ([`note_process`]). Any other process is
//! a child of that process, and creates pools of its own when it first needs them.
//!
//! ```text
//!                    | first process          | a child
//!   threads=None     | rayon's global pool    | [`POOLS`], one thread for each core
//!   threads=1        | [`POOLS`]              | [`POOLS`]
//!   threads=n        | a pool for this call   | a pool for this call
//!   other work       | rayon's global pool    | the calling thread alone ([`settle`])
//! ```
//!
//! Pools belong to a process id. Each call that may divide work compares this id with the current process id. Other
//! work checks a flag that Python sets in a child ([`note_fork`]). Only threads that hold the interpreter lock the
//! list of pools. Python forks while it holds the interpreter, so a child never finds the list locked.

use core::cell::Cell;
use core::sync::atomic::{AtomicBool, Ordering};
use std::process;
use std::sync::{Arc, Mutex, OnceLock, TryLockError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// The process that owns the threads of rayon's global pool.
static FIRST: OnceLock<u32> = OnceLock::new();

/// Whether this process is a child of the first one.
static IS_CHILD: AtomicBool = AtomicBool::new(false);

/// The cached pools, and the process that they belong to.
static POOLS: Mutex<Pools> = Mutex::new(Pools { process: 0, all: None, one: None });

thread_local! {
    /// The id of the child process in which this thread became a pool of one thread; 0 if it is no such pool.
    static SETTLED: Cell<u32> = const { Cell::new(0) };
}

/// The pools that are kept between calls: one with a thread for each core, and one with a single
/// thread.
struct Pools {
    /// The id of the process that owns the pools.
    process: u32,
    /// A pool with a thread for each core.
    all: Option<Arc<ThreadPool>>,
    one: Option<Arc<ThreadPool>>,
}

/// The threads of one call.
pub(crate) enum Crew {
    /// Rayon's global pool.
    Global,
    Pool(Arc<ThreadPool>),
}

impl Crew {
    /// Returns `threads` threads; one for each core if `threads` is `None`.
    ///
    /// # Errors
    /// `RuntimeError` if the system cannot start threads.
    pub(crate) fn of(_attached: Python<'_>, threads: Option<usize>) -> PyResult<Self> {
        let process = process::id();
        let pool = match threads {
            None if is_first(process) => return Ok(Self::Global),
            None => kept(process, 0, |pools| &mut pools.all),
            Some(1) => kept(process, 1, |pools| &mut pools.one),
            Some(count) => make(count),
        };
        let refused = |error| PyRuntimeError::new_err(format!("no threads: {error}"));
        Ok(Self::Pool(pool.map_err(refused)?))
    }

    /// Runs `work`, which these threads may divide.
    pub(crate) fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match self {
            Self::Global => work(),
            Self::Pool(pool) => pool.install(work),
        }
    }
}

/// Records that this process loaded the module, and makes Python call [`note_fork`] in its children.
pub(crate) fn note_process(module: &Bound<'_, PyModule>) -> PyResult<()> {
    FIRST.get_or_init(process::id);
    let py = module.py();
    // Windows has no `fork`.
    if let Some(register) = py.import("os")?.getattr_opt("register_at_fork")? {
        let hook = PyDict::new(py);
        hook.set_item("after_in_child", wrap_pyfunction!(note_fork, module)?)?;
        register.call((), Some(&hook))?;
    }
    Ok(())
}

/// Records that this process is a child. Python calls this function in each child after `fork`.
#[pyfunction]
fn note_fork() {
    IS_CHILD.store(true, Ordering::Relaxed);
}

/// Prepares the calling thread for work outside of a [`Crew`]. In a child such work would be
/// divided among threads that do not exist, so the calling thread becomes a pool of one thread at
/// the first call. This costs a few kilobytes for each thread.
///
/// # Errors
/// `RuntimeError` if the system cannot create a pool.
pub(crate) fn settle() -> PyResult<()> {
    if !IS_CHILD.load(Ordering::Relaxed) {
        return Ok(());
    }
    let process = process::id();
    if SETTLED.get() == process {
        return Ok(());
    }
    // A thread that became a pool of one thread in the parent is still one in the child, because
    // this pool has no other thread.
    if rayon::current_thread_index().is_none() {
        let own = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
        own.map_err(|error| PyRuntimeError::new_err(format!("no pool: {error}")))?;
    }
    SETTLED.set(process);
    Ok(())
}

fn is_first(process: u32) -> bool {
    *FIRST.get_or_init(|| process) == process
}

/// Returns the pool in the slot that `place` selects, for the current process. A missing pool is
/// created with `count` threads, see [`make`].
fn kept(
    process: u32,
    count: usize,
    place: impl FnOnce(&mut Pools) -> &mut Option<Arc<ThreadPool>>,
) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    let mut pools = match POOLS.try_lock() {
        Ok(pools) => pools,
        Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
        // A fork that bypassed Python left the list locked for ever.
        Err(TryLockError::WouldBlock) => return make(count),
    };
    if pools.process != process {
        let stale = core::mem::replace(&mut *pools, Pools { process, all: None, one: None });
        // Dropping a pool waits for its threads, which exist in the parent only.
        core::mem::forget(stale);
    }
    let place = place(&mut pools);
    if let Some(pool) = place {
        return Ok(pool.clone());
    }
    Ok(place.insert(make(count)?).clone())
}

/// Creates a pool of `count` threads; with 0, one for each core.
fn make(count: usize) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    ThreadPoolBuilder::new().num_threads(count).build().map(Arc::new)
}
