//! Connections with a deadline.

use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// The connection of a client, with a deadline.
///
/// A time limit of the operating system restarts with each read and write, so a client that sends
/// single bytes would never reach the limit. A deadline does not move: all reads and writes share
/// the remaining time.
#[derive(Debug)]
pub(crate) struct Connection {
    stream: TcpStream,
    deadline: Instant,
}

impl Connection {
    /// Creates a connection whose deadline is `time` from now.
    pub(crate) fn new(stream: TcpStream, time: Duration) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        Ok(Self { stream, deadline: Instant::now() + time })
    }

    /// Sets the deadline to `time` from now.
    pub(crate) fn allow(&mut self, time: Duration) {
        self.deadline = Instant::now() + time;
    }

    /// Returns `true` if the client has closed its side of the connection or has sent further
    /// bytes, or if the connection has failed.
    ///
    /// A client sends only its request, which was read before this call. A client that closes its
    /// side of the connection does not wait for a response.
    pub(crate) fn is_gone(&mut self) -> bool {
        let mut byte = [0];
        let read = self.stream.set_nonblocking(true).and_then(|()| self.stream.read(&mut byte));
        let is_waiting = read.is_err_and(|error| error.kind() == io::ErrorKind::WouldBlock);
        !is_waiting || self.stream.set_nonblocking(false).is_err()
    }

    /// Returns the remaining time; an error if the deadline has passed.
    fn left(&self) -> io::Result<Duration> {
        let left = self.deadline.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(left) }
    }
}

impl Read for Connection {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(Some(self.left()?))?;
        self.stream.read(buffer)
    }
}

impl Write for Connection {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(Some(self.left()?))?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    /// Returns both ends of a connection; the deadline of the server's end has passed.
    fn pair() -> (Connection, TcpStream) {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let client = TcpStream::connect(listener.local_addr().expect("an address"));
        let (server, _) = listener.accept().expect("a client");
        (Connection::new(server, Duration::ZERO).expect("it is open"), client.expect("a server"))
    }

    #[test]
    fn bytes_do_not_move_the_deadline() {
        let (mut server, mut client) = pair();
        client.write_all(b"GET /").expect("it is open");
        let late = |result: io::Result<usize>| result.map_err(|error| error.kind());
        assert_eq!(
            late(server.read(&mut [0])),
            Err(io::ErrorKind::TimedOut),
            "though a byte is there"
        );
        assert_eq!(late(server.write(b"HTTP")), Err(io::ErrorKind::TimedOut));
        server.allow(Duration::from_secs(60));
        assert_eq!(late(server.read(&mut [0; 8])), Ok(5));
    }

    #[test]
    fn a_client_that_closes_or_talks_on_is_gone() {
        let (mut waiting, client) = pair();
        assert!(!waiting.is_gone() && !waiting.is_gone(), "it waits");
        drop(client);
        // The loop ends, since the operating system delivers the end of the connection soon.
        while !waiting.is_gone() {}
        let (mut server, mut talker) = pair();
        talker.write_all(b"more").expect("it is open");
        while !server.is_gone() {}
    }
}
