//! Tests the server over raw connections, with valid and invalid requests.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use impinge_html::{Assets, HtmlError, Live};

/// Starts a server on a port; 0 selects a free port.
fn serve(port: u16) -> Result<Live, HtmlError> {
    let assets = Assets {
        template: "{{TITLE}}|{{STYLE}}|{{SCENE}}|{{RECORDING}}|{{WASM}}|{{SCRIPT}}".to_owned(),
        style: String::new(),
        script: "run()".to_owned(),
        module: Vec::new(),
    };
    Live::start(&assets, "a <world>", port)
}

fn started() -> Live {
    serve(0).expect("some port is free")
}

/// Returns the host name and the port of a server, separated by a colon.
fn host(live: &Live) -> String {
    let url = live.url();
    url.trim_start_matches("http://").trim_end_matches('/').to_owned()
}

fn connect(live: &Live) -> BufReader<TcpStream> {
    let stream = TcpStream::connect(host(live)).expect("it listens");
    stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a timeout");
    BufReader::new(stream)
}

/// Sends a request for `path` to the server, with `host` in the field `Host`. Returns the
/// connection, read up to the body of the response, and the head of the response.
fn ask(live: &Live, path: &str, host: &str) -> (BufReader<TcpStream>, String) {
    let mut connection = connect(live);
    let request = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n");
    connection.get_mut().write_all(request.as_bytes()).expect("it reads");
    let mut head = String::new();
    while !head.ends_with("\r\n\r\n") {
        assert!(connection.read_line(&mut head).expect("it answers") > 0, "it ends: {head}");
    }
    (connection, head)
}

/// Returns the next chunk of a stream; it is empty at the end of the stream.
fn chunk(connection: &mut BufReader<TcpStream>) -> Vec<u8> {
    let mut length = String::new();
    connection.read_line(&mut length).expect("a length");
    let length = usize::from_str_radix(length.trim(), 16).expect("a hexadecimal number");
    let mut bytes = vec![0; length + 2];
    connection.read_exact(&mut bytes).expect("as many bytes");
    assert!(bytes.ends_with(b"\r\n"), "a chunk ends");
    bytes.truncate(length);
    bytes
}

/// Reads chunks of a stream until they have at least `count` bytes in total, and returns all these
/// bytes.
fn bytes(connection: &mut BufReader<TcpStream>, count: usize) -> Vec<u8> {
    let mut all = Vec::new();
    while all.len() < count {
        let more = chunk(connection);
        assert!(!more.is_empty(), "the stream ended after {} bytes", all.len());
        all.extend(more);
    }
    all
}

#[test]
fn the_page() {
    let live = started();
    assert!(live.url().starts_with("http://127.0.0.1:"), "{}", live.url());
    let (mut connection, head) = ask(&live, "/", &host(&live));
    assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{head}");
    assert!(head.contains("\r\nContent-Type: text/html; charset=utf-8\r\n"), "{head}");
    let mut page = String::new();
    connection.read_to_string(&mut page).expect("the whole page");
    assert!(head.contains(&format!("\r\nContent-Length: {}\r\n", page.len())), "{head}");
    let parts: Vec<_> = page.split('|').collect();
    let scene: serde_json::Value = serde_json::from_str(parts[2]).expect("JSON");
    assert_eq!(scene, serde_json::json!({"open": "live", "title": "a <world>", "log": "/log"}));
    assert_eq!((parts[0], parts[5]), ("a &lt;world&gt;", "run()"));
}

#[test]
fn the_log_grows_and_late_clients_get_all_of_it() {
    let live = started();
    live.send(b"first");
    let (mut early, head) = ask(&live, "/log", &host(&live));
    assert!(head.contains("\r\nTransfer-Encoding: chunked\r\n"), "{head}");
    assert_eq!(bytes(&mut early, 5), b"first");
    live.send(b"");
    live.send(b"second");
    assert_eq!(bytes(&mut early, 6), b"second");
    let (mut late, _) = ask(&live, "/log", &host(&live).replace("127.0.0.1", "localhost"));
    assert_eq!(bytes(&mut late, 11), b"firstsecond");
    let long: Vec<u8> = (0..200_000_u32).map(|i| i.to_le_bytes()[0]).collect();
    live.send(&long);
    for connection in [&mut early, &mut late] {
        assert!(bytes(connection, long.len()) == long, "many chunks");
    }
    drop(live);
    for mut connection in [early, late] {
        assert_eq!(chunk(&mut connection), b"", "the stream ends");
        assert_eq!(connection.read(&mut [0]).expect("it is closed"), 0);
    }
}

#[test]
fn other_names_and_paths_are_refused() {
    let live = started();
    live.send(b"secret");
    let port = host(&live).replace("127.0.0.1", "");
    for (path, host, status) in [
        ("/log", format!("evil.example{port}"), "403"),
        ("/", "127.0.0.1".to_owned(), "403"),
        ("/log/..", host(&live), "404"),
    ] {
        let (mut connection, head) = ask(&live, path, &host);
        assert!(head.starts_with(&format!("HTTP/1.1 {status} ")), "{host}{path}: {head}");
        let mut rest = String::new();
        connection.read_to_string(&mut rest).expect("it closes");
        assert!(!rest.contains("secret"), "{rest}");
    }
    let mut connection = connect(&live);
    let long = vec![b'a'; 40_000];
    // The server may close the connection before all bytes are written.
    let _written = connection.get_mut().write_all(&[b"GET /", &long[..]].concat());
    let mut answer = Vec::new();
    let _closed = connection.read_to_end(&mut answer);
    assert!(answer.is_empty() || answer.starts_with(b"HTTP/1.1 431 "), "no endless heads");
}

#[test]
fn a_client_that_is_slow_or_gone_holds_nobody_up() {
    let live = started();
    let silent = connect(&live);
    let (stuck, _) = ask(&live, "/log", &host(&live));
    let (gone, _) = ask(&live, "/log", &host(&live));
    drop(gone);
    let piece = vec![1; 1 << 20];
    // 64 MiB are more than the buffers of a connection hold, and `stuck` is not read.
    (0..64).for_each(|_| live.send(&piece));
    let (mut quick, _) = ask(&live, "/log", &host(&live));
    assert_eq!(bytes(&mut quick, 64 << 20).len(), 64 << 20);
    // These two connections are not read: dropping the server must not wait for them.
    drop(live);
    drop((silent, stuck));
}

/// A number of connections that is larger than both limits of the server, which are 32.
const MANY: usize = 100;

#[test]
fn clients_that_have_gone_keep_nobody_out() {
    let live = started();
    live.send(b"log");
    for _ in 0..MANY {
        // Each connection is dropped without being read further, as by a page that is reloaded. The
        // server sends no data meanwhile, so no failed write reveals the closed connection.
        let (mut connection, _) = ask(&live, "/log", &host(&live));
        assert_eq!(bytes(&mut connection, 3), b"log");
    }
    let (mut last, _) = ask(&live, "/log", &host(&live));
    assert_eq!(bytes(&mut last, 3), b"log");
}

#[test]
fn clients_beyond_the_limit_are_told_so() {
    let live = started();
    let streams: Vec<_> = (0..32).map(|_| ask(&live, "/log", &host(&live))).collect();
    assert!(streams.iter().all(|(_, head)| head.starts_with("HTTP/1.1 200 ")), "32 follow");
    let (_, head) = ask(&live, "/log", &host(&live));
    assert!(head.starts_with("HTTP/1.1 503 "), "{head}");
}

#[test]
fn silent_connections_keep_nobody_out() {
    let live = started();
    let silent: Vec<_> = (0..MANY)
        .map(|_| {
            let mut connection = connect(&live);
            // The server may have closed the connection already, in favour of newer ones.
            let _written = connection.get_mut().write_all(b"G");
            connection
        })
        .collect();
    let (_, head) = ask(&live, "/", &host(&live));
    assert!(head.starts_with("HTTP/1.1 200 "), "{head}");
    drop((live, silent));
}

#[test]
fn other_sites_do_not_get_the_log() {
    let live = started();
    live.send(b"secret");
    for field in ["Sec-Fetch-Site: cross-site", "Origin: http://evil.example"] {
        let mut connection = connect(&live);
        let request = format!("GET /log HTTP/1.1\r\nHost: {}\r\n{field}\r\n\r\n", host(&live));
        connection.get_mut().write_all(request.as_bytes()).expect("it reads");
        let mut answer = String::new();
        connection.read_to_string(&mut answer).expect("it answers, and closes");
        assert!(answer.starts_with("HTTP/1.1 403 ") && !answer.contains("secret"), "{answer}");
    }
}

#[test]
fn a_port_in_use_is_an_error() {
    let live = started();
    let port = host(&live).rsplit_once(':').expect("a port").1.parse().expect("a number");
    let error = serve(port).expect_err("it is in use");
    assert!(matches!(error, HtmlError::Port { port: other, .. } if other == port), "{error}");
    assert!(error.to_string().contains(&port.to_string()), "{error}");
}
