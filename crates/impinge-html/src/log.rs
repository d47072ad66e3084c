//! A recording that grows, and its readers, which wait for more of it.

use std::collections::BTreeMap;
use std::net::{Shutdown, TcpStream};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The bytes that are copied at once for a reader, while the lock is held.
pub(crate) const PIECE: usize = 64 * 1024;

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
    /// Requests that are answered.
    clients: usize,
    /// Connections whose requests are not whole, by their order.
    pending: BTreeMap<u64, TcpStream>,
    /// The connections so far.
    connections: u64,
}

/// What a reader gets that waited.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum More {
    /// The next bytes.
    Bytes(Vec<u8>),
    /// Nothing in the time that it waited.
    Nothing,
    /// There are no more.
    End,
}

/// A request that is answered, until this is dropped.
#[derive(Debug)]
pub(crate) struct Client<'a>(&'a SharedLog);

/// A connection whose request is not whole, until this is dropped.
#[derive(Debug)]
pub(crate) struct Pending<'a> {
    log: &'a SharedLog,
    number: u64,
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

    /// Nothing is appended any more. Connections whose requests are not whole end.
    pub(crate) fn close(&self) {
        let mut state = self.state();
        state.is_closed = true;
        state.pending.values().for_each(end);
        drop(state);
        self.changed.notify_all();
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.state().is_closed
    }

    /// Some bytes from an offset on, as soon as there are any, or nothing after so long.
    pub(crate) fn wait_from(&self, offset: usize, longest: Duration) -> More {
        let waits = |state: &mut State| state.bytes.len() <= offset && !state.is_closed;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        let (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let end = state.bytes.len().min(offset.saturating_add(PIECE));
        match state.bytes.get(offset..end) {
            Some(bytes) if !bytes.is_empty() => More::Bytes(bytes.to_vec()),
            _ if state.is_closed => More::End,
            _ => More::Nothing,
        }
    }

    /// Counts a client; one that comes when there are `limit` waits for a place, but not longer than this.
    pub(crate) fn enter(&self, limit: usize, longest: Duration) -> Option<Client<'_>> {
        let waits = |state: &mut State| state.clients >= limit && !state.is_closed;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let is_admitted = state.clients < limit;
        state.clients += usize::from(is_admitted);
        is_admitted.then(|| Client(self))
    }

    /// Keeps a connection while its request is read. If there are `limit` already, the first of them ends.
    pub(crate) fn wait_for_request(&self, stream: TcpStream, limit: usize) -> Pending<'_> {
        let mut state = self.state();
        state.connections += 1;
        let number = state.connections;
        if state.pending.len() >= limit
            && let Some((_, first)) = state.pending.pop_first()
        {
            end(&first);
        }
        if state.is_closed {
            end(&stream);
        }
        state.pending.insert(number, stream);
        Pending { log: self, number }
    }

    /// Waits until all clients have gone, or for so long.
    pub(crate) fn wait_for_clients(&self, longest: Duration) {
        let waits = |state: &mut State| state.clients + state.pending.len() > 0;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        // Whether some are left makes no difference: their connections end with the program.
        drop(waited);
    }
}

/// Ends a connection, so that the thread that waits for it goes on. It may have ended before.
fn end(stream: &TcpStream) {
    let _ended = stream.shutdown(Shutdown::Both);
}

impl Drop for Client<'_> {
    fn drop(&mut self) {
        self.0.state().clients -= 1;
        self.0.changed.notify_all();
    }
}

impl Drop for Pending<'_> {
    fn drop(&mut self) {
        self.log.state().pending.remove(&self.number);
        self.log.changed.notify_all();
    }
}
