//! A growing recording, and its waiting readers.

use std::collections::BTreeMap;
use std::net::{Shutdown, TcpStream};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The number of bytes that are copied at once for a reader, while the lock is held.
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
    /// The number of requests in service.
    clients: usize,
    /// Connections with incomplete requests, by their order.
    pending: BTreeMap<u64, TcpStream>,
    /// The number of connections so far.
    connections: u64,
}

/// The result of waiting for more bytes.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum More {
    /// The next bytes.
    Bytes(Vec<u8>),
    /// No bytes arrived in time.
    Nothing,
    /// The log is closed and read completely.
    End,
}

/// A request in service, until this is dropped.
#[derive(Debug)]
pub(crate) struct Client<'a>(&'a SharedLog);

/// A connection with an incomplete request, until this is dropped.
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

    /// Appends bytes; does not wait for readers.
    pub(crate) fn append(&self, bytes: &[u8]) {
        self.state().bytes.extend(bytes);
        self.changed.notify_all();
    }

    /// Closes the log. Connections with incomplete requests end.
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

    /// Returns bytes from an offset on, as soon as there are any, or [`More::Nothing`] after `longest`.
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

    /// Counts a client. If there are `limit` clients it waits for a slot, at most for `longest`.
    pub(crate) fn enter(&self, limit: usize, longest: Duration) -> Option<Client<'_>> {
        let waits = |state: &mut State| state.clients >= limit && !state.is_closed;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let is_admitted = state.clients < limit;
        state.clients += usize::from(is_admitted);
        is_admitted.then(|| Client(self))
    }

    /// Keeps a connection while its request is read. If there are `limit` already, the oldest of them is
    /// closed.
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

    /// Waits until all clients have gone, at most for `longest`.
    pub(crate) fn wait_for_clients(&self, longest: Duration) {
        let waits = |state: &mut State| state.clients + state.pending.len() > 0;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        // The result is ignored: remaining connections end with the program.
        drop(waited);
    }
}

/// Closes a connection, so that the thread that waits for it continues. It may be closed already.
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
