//! A growing recording that several readers follow.

use std::collections::BTreeMap;
use std::net::{Shutdown, TcpStream};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The maximum number of bytes that are copied for a reader while the lock is held.
pub(crate) const PIECE: usize = 64 * 1024;

/// A sequence of bytes that grows until it is closed. Any number of readers can wait for more
/// bytes. The log also counts the clients and the pending connections of the server.
#[derive(Debug, Default)]
pub(crate) struct SharedLog {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    bytes: Vec<u8>,
    is_closed: bool,
    /// The number of requests that are being served.
    clients: usize,
    /// The connections with incomplete requests, by their number.
    pending: BTreeMap<u64, TcpStream>,
    /// The number of connections so far. It is the number of the newest connection.
    connections: u64,
}

/// The result of waiting for more bytes.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum More {
    /// The next bytes, at least one.
    Bytes(Vec<u8>),
    /// No bytes arrived within the time limit.
    Nothing,
    /// The log is closed, and the reader has all its bytes.
    End,
}

/// A slot for a request that is being served; dropping it frees the slot.
#[derive(Debug)]
pub(crate) struct Client<'a>(&'a SharedLog);

/// A registered connection with an incomplete request; dropping it removes the registration.
#[derive(Debug)]
pub(crate) struct Pending<'a> {
    log: &'a SharedLog,
    number: u64,
}

impl SharedLog {
    /// Locks the state. The lock is never poisoned, since it is only held for short copies that do
    /// not panic.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Appends bytes, without waiting for readers.
    pub(crate) fn append(&self, bytes: &[u8]) {
        self.state().bytes.extend(bytes);
        self.changed.notify_all();
    }

    /// Closes the log and all connections with incomplete requests.
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

    /// Waits until there are bytes from `offset` on, and returns at most [`PIECE`] of them. If
    /// there are none, returns [`More::End`] once the log is closed, or [`More::Nothing`] after
    /// `longest`.
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

    /// Takes one of `limit` slots for a client. If all slots are taken, waits until one is free or
    /// the log is closed, at most for `longest`; `None` if all slots are still taken.
    pub(crate) fn enter(&self, limit: usize, longest: Duration) -> Option<Client<'_>> {
        let waits = |state: &mut State| state.clients >= limit && !state.is_closed;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        let is_admitted = state.clients < limit;
        state.clients += usize::from(is_admitted);
        is_admitted.then(|| Client(self))
    }

    /// Registers a connection while its request is read. If `limit` connections are registered
    /// already, the oldest of them is closed. If the log is closed, so is the new connection.
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

    /// Waits until no slot is taken and no connection is registered, at most for `longest`.
    pub(crate) fn wait_for_clients(&self, longest: Duration) {
        let waits = |state: &mut State| state.clients + state.pending.len() > 0;
        let waited = self.changed.wait_timeout_while(self.state(), longest, waits);
        // The result is ignored: remaining connections end with the program.
        drop(waited);
    }
}

/// Closes a connection, so that the thread that reads from it continues. The connection may be
/// closed already.
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
