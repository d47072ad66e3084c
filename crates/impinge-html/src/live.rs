//! A small server for browsers on this machine, which shows the recording of a running program.

use std::io::{self, Write as _};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use serde_json::json;

use crate::assets::Assets;
use crate::connection::Connection;
use crate::error::HtmlError;
use crate::log::{More, PIECE, SharedLog};
use crate::page::Page;
use crate::request::{self, Route};

/// The maximum number of requests that are served at once. Further requests get the status 503
/// after [`ADMISSION_TIMEOUT`].
const MAX_CLIENTS: usize = 32;

/// The maximum number of connections whose requests are incomplete. A further connection closes the
/// oldest of them, so that silent connections cannot keep a browser out.
const MAX_PENDING: usize = 32;

/// The time limit for the head of a request, and for each 64 KiB of a response. A connection that
/// exceeds the limit is closed.
const IO_TIMEOUT: Duration = Duration::from_secs(5);

/// The interval at which a response that waits for further bytes of the log checks whether its
/// client is still connected.
const POLL: Duration = Duration::from_millis(250);

/// The maximum time for which a request waits for one of the [`MAX_CLIENTS`] slots. It is longer
/// than [`POLL`]: within that interval the server notices that a client has disconnected, and frees
/// its slot.
const ADMISSION_TIMEOUT: Duration = Duration::from_secs(1);

/// The maximum time for which a stopping server waits until its clients have read the rest of their
/// responses.
const DRAIN_TIMEOUT: Duration = Duration::from_secs(1);

/// A server that shows the recording of a running program in a browser on the same machine.
///
/// [`Self::send`] takes the bytes that
/// [`Recorder::take_bytes`](impinge_record::Recorder::take_bytes) returns. The page follows the
/// growing recording. A page that is opened later gets the recording from its beginning, so the
/// server keeps all bytes. Each connection has its own thread: a slow or closed browser blocks
/// neither the program nor other browsers. Up to 32 browsers follow at once.
///
/// The server listens on 127.0.0.1 only, and accepts only requests to the names `127.0.0.1` and
/// `localhost`. Only the server's own page may read the recording: requests of other sites for it
/// are rejected. Dropping the server ends the recording; open pages keep the received data.
///
/// ```no_run
/// # fn run(assets: impinge_html::Assets) -> Result<(), Box<dyn std::error::Error>> {
/// use impinge_html::Live;
/// use impinge_record::{Recorder, Registry};
///
/// let mut recorder = Recorder::<f32, 3, String>::new(0.02, Registry::new())?;
/// let live = Live::start(&assets, "My world", 0)?;
/// eprintln!("watch {}", live.url());
/// for _ in 0..1000 {
///     recorder.update();
///     live.send(&recorder.take_bytes());
/// }
/// # Ok(()) }
/// ```
#[derive(Debug)]
pub struct Live {
    address: SocketAddr,
    log: Arc<SharedLog>,
    acceptor: Option<JoinHandle<()>>,
}

/// The data that the threads of all connections share.
#[derive(Debug)]
struct Server {
    port: u16,
    page: String,
    log: Arc<SharedLog>,
}

impl Live {
    /// Starts a server on a port; 0 selects a free port. The recording is empty at first.
    ///
    /// # Errors
    /// If the port is in use or not allowed, if no thread can be started, or if the template does
    /// not contain each placeholder exactly once.
    pub fn start(assets: &Assets, title: &str, port: u16) -> Result<Self, HtmlError> {
        let scene = json!({"open": "live", "title": title, "log": "/log"});
        let page = Page { title, scene, recording: &[] }.html(assets)?;
        let refused = |error| HtmlError::Port { port, error };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(refused)?;
        let address = listener.local_addr().map_err(refused)?;
        let log = Arc::new(SharedLog::default());
        let server = Arc::new(Server { port: address.port(), page, log: Arc::clone(&log) });
        let acceptor = thread::Builder::new().spawn(move || accept(&listener, &server));
        Ok(Self { address, log, acceptor: Some(acceptor.map_err(refused)?) })
    }

    /// Returns the address to open in a browser on this machine.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Appends bytes to the recording and wakes up the threads that send it. Costs a copy of the
    /// bytes; does not wait until a browser has received them.
    pub fn send(&self, bytes: &[u8]) {
        self.log.append(bytes);
    }
}

/// Closes the log, which ends the responses that follow it. Clients that are still reading get at
/// most a second for the rest.
impl Drop for Live {
    fn drop(&mut self) {
        self.log.close();
        // A connection to the server's own port wakes up the accepting thread.
        let woken = TcpStream::connect_timeout(&self.address, DRAIN_TIMEOUT).is_ok();
        if let Some(acceptor) = self.acceptor.take().filter(|_| woken) {
            // The thread does not panic, and there is nothing to clean up if it did.
            let _ended = acceptor.join();
        }
        self.log.wait_for_clients(DRAIN_TIMEOUT);
    }
}

/// Accepts connections until the log is closed.
fn accept(listener: &TcpListener, server: &Arc<Server>) {
    for stream in listener.incoming() {
        if server.log.is_closed() {
            return;
        }
        let Ok(stream) = stream else {
            // Too many files are open, or the client has gone: the next connection may succeed.
            thread::sleep(Duration::from_millis(10));
            continue;
        };
        let own = Arc::clone(server);
        // If no thread can be started, the connection is closed. An error of `serve` means that the
        // client has gone; it is ignored.
        let _spawned = thread::Builder::new().spawn(move || own.serve(stream));
    }
}

impl Server {
    fn serve(&self, stream: TcpStream) -> io::Result<()> {
        let route = self.route(stream.try_clone()?)?;
        let mut connection = Connection::new(stream, IO_TIMEOUT)?;
        let Some(_client) = self.log.enter(MAX_CLIENTS, ADMISSION_TIMEOUT) else {
            let status = "503 Service Unavailable";
            return respond(&mut connection, status, status.as_bytes());
        };
        match route {
            Route::Page => respond(&mut connection, "200 OK", self.page.as_bytes()),
            Route::Log => self.stream_log(&mut connection),
            Route::Refused(status) => respond(&mut connection, status, status.as_bytes()),
        }
    }

    /// Reads a request and selects the response. While the request is incomplete, the connection is
    /// registered as pending, so that newer connections can close it.
    fn route(&self, stream: TcpStream) -> io::Result<Route> {
        let mut connection = Connection::new(stream.try_clone()?, IO_TIMEOUT)?;
        let _pending = self.log.wait_for_request(stream, MAX_PENDING);
        request::read(&mut connection, self.port)
    }

    /// Sends the bytes of the log in chunks, as they arrive, until the log is closed or the client
    /// has gone.
    fn stream_log(&self, connection: &mut Connection) -> io::Result<()> {
        let kind = "Content-Type: application/octet-stream\r\nTransfer-Encoding: chunked\r\n";
        connection.write_all(head("200 OK", kind).as_bytes())?;
        let mut offset = 0;
        loop {
            let bytes = match self.log.wait_from(offset, POLL) {
                More::Bytes(bytes) => bytes,
                More::End => Vec::new(),
                More::Nothing if connection.is_gone() => return Ok(()),
                More::Nothing => continue,
            };
            let mut chunk = format!("{:x}\r\n", bytes.len()).into_bytes();
            chunk.extend(&bytes);
            chunk.extend(b"\r\n");
            connection.allow(IO_TIMEOUT);
            connection.write_all(&chunk)?;
            offset += bytes.len();
            if bytes.is_empty() {
                return connection.flush();
            }
        }
    }
}

/// Returns the head of a response with this status and these header fields, followed by fields that
/// forbid caching and the use by other sites.
fn head(status: &str, fields: &str) -> String {
    format!(
        "HTTP/1.1 {status}\r\n{fields}Cache-Control: no-store\r\nConnection: close\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\nX-Content-Type-Options: nosniff\r\n\
         Content-Security-Policy: frame-ancestors 'self'\r\n\r\n"
    )
}

fn respond(connection: &mut Connection, status: &str, body: &[u8]) -> io::Result<()> {
    let kind = if status == "200 OK" { "html" } else { "plain" };
    let length = body.len();
    let fields =
        format!("Content-Type: text/{kind}; charset=utf-8\r\nContent-Length: {length}\r\n");
    connection.write_all(head(status, &fields).as_bytes())?;
    for piece in body.chunks(PIECE) {
        connection.allow(IO_TIMEOUT);
        connection.write_all(piece)?;
    }
    connection.flush()
}
