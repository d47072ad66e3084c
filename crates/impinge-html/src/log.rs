//! A recording that grows, and its readers, which wait for more of it.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The bytes that are copied at once for a reader, while the lock is held.
const PIECE: usize = 64 * 1024;

/// Bytes to which more are appended, for any number of readers, until it is closed.
#[derive(Debug, Default)]
pub(crate) struct SharedLog {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    bytes: Vec<u8>,
    is_closed: bool,
    /// Connections that are served.
    clients: usize,
}

impl SharedLog {
    /// The lock is held for short copies only, which do not panic: it is never poisoned.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Appends bytes; waits for no reader.
    pub(crate) fn append(&self, bytes: &[u8]) {
        self.state().bytes.extend(bytes);
        self.changed.notify_all();
    }

    /// Nothing is appended any more.
    pub(crate) fn close(&self) {
        self.state().is_closed = true;
        self.changed.notify_all();
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.state().is_closed
    }

    /// Some bytes from an offset on, as soon as there are any; none after the last one.
    pub(crate) fn wait_from(&self, offset: usize) -> Vec<u8> {
        let waits = |state: &mut State| state.bytes.len() <= offset && !state.is_closed;
        let state = self.changed.wait_while(self.state(), waits);
        let state = state.unwrap_or_else(PoisonError::into_inner);
        let end = state.bytes.len().min(offset.saturating_add(PIECE));
        state.bytes.get(offset..end).unwrap_or_default().to_vec()
    }

    /// Counts a client, unless there are `limit` already.
    pub(crate) fn enter(&self, limit: usize) -> bool {
        let mut state = self.state();
        let is_admitted = state.clients < limit;
        state.clients += usize::from(is_admitted);
        is_admitted
    }

    /// A client has gone.
    pub(crate) fn leave(&self) {
        self.state().clients -= 1;
        self.changed.notify_all();
    }

    /// Waits until all clients have gone, or for so long.
    pub(crate) fn wait_for_clients(&self, longest: Duration) {
        let waits = |state: &mut State| state.clients > 0;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        // Whether some are left makes no difference: their connections end with the program.
        drop(waited);
    }
}
