//! Reads HTTP requests and selects the responses.

use std::io::{self, Read};

/// The maximum length of the head of a request, in bytes.
const MAX_HEAD: usize = 16 * 1024;

/// The maximum number of header fields of a request.
const MAX_HEADERS: usize = 64;

/// The response to a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Route {
    /// The page.
    Page,
    /// The growing recording.
    Log,
    /// An error page with this status.
    Refused(&'static str),
}

/// Reads the head of a request to a server on `port`, and selects the response.
///
/// # Errors
/// If the connection ends before the head is complete, or reading fails, for instance after the
/// deadline.
pub(crate) fn read(stream: &mut impl Read, port: u16) -> io::Result<Route> {
    let mut head = Vec::new();
    let mut piece = [0; 1024];
    loop {
        let count = stream.read(&mut piece)?;
        if count == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        head.extend(&piece[..count]);
        match route(&head, port) {
            Some(route) => return Ok(route),
            None if head.len() > MAX_HEAD => {
                return Ok(Route::Refused("431 Request Header Fields Too Large"));
            }
            None => {}
        }
    }
}

/// Returns the response to a request with this head; `None` if the head is incomplete.
fn route(head: &[u8], port: u16) -> Option<Route> {
    let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
    let mut request = httparse::Request::new(&mut headers);
    match request.parse(head) {
        Ok(httparse::Status::Partial) => return None,
        Ok(httparse::Status::Complete(_)) => {}
        Err(_) => return Some(Route::Refused("400 Bad Request")),
    }
    let is_own = |header: &httparse::Header<'_>| is_own_host(header.value, port);
    let mut hosts = request.headers.iter().filter(|one| one.name.eq_ignore_ascii_case("host"));
    Some(match (request.method, request.path, hosts.next()) {
        (_, _, host) if !host.is_some_and(is_own) || hosts.next().is_some() => {
            Route::Refused("403 Forbidden")
        }
        (Some("GET"), Some("/"), _) => Route::Page,
        (Some("GET"), Some("/log"), _) if is_foreign(request.headers, port) => {
            Route::Refused("403 Forbidden")
        }
        (Some("GET"), Some("/log"), _) => Route::Log,
        (Some("GET"), _, _) => Route::Refused("404 Not Found"),
        _ => Route::Refused("405 Method Not Allowed"),
    })
}

/// Returns `true` if the `Host` of a request is `127.0.0.1` or `localhost` with the server's port.
/// A page of another site could use any other name that resolves to this machine (DNS rebinding),
/// and must not read the recording. Browsers omit the port if it is 80.
fn is_own_host(host: &[u8], port: u16) -> bool {
    ["127.0.0.1", "localhost"].iter().any(|name| host == format!("{name}:{port}").as_bytes())
        || (port == 80 && [&b"127.0.0.1"[..], b"localhost"].contains(&host))
}

/// Returns `true` if a page of another site sent the request. Browsers report the site in
/// `Sec-Fetch-Site` or `Origin`, and a page cannot change these fields. A page from another port of
/// this machine is another site too. Requests with neither field, which most programs other than
/// browsers send, are not foreign.
fn is_foreign(headers: &[httparse::Header<'_>], port: u16) -> bool {
    headers.iter().any(|header| {
        let is_it = |name: &str| header.name.eq_ignore_ascii_case(name);
        let value = header.value;
        let is_own_site = || [&b"same-origin"[..], b"none"].contains(&value);
        let is_own = || value.strip_prefix(b"http://").is_some_and(|host| is_own_host(host, port));
        is_it("sec-fetch-site") && !is_own_site() || is_it("origin") && !is_own()
    })
}

#[cfg(test)]
mod tests {
    use super::{Route, route};

    #[test]
    fn other_sites_do_not_get_the_log() {
        let ask = |path: &str, field: &str| {
            let head = format!("GET {path} HTTP/1.1\r\nHost: localhost:81\r\n{field}\r\n\r\n");
            route(head.as_bytes(), 81)
        };
        for own in [
            "Sec-Fetch-Site: same-origin",
            "sec-fetch-site: none",
            "Origin: http://localhost:81",
            "Origin: http://127.0.0.1:81",
        ] {
            assert_eq!(ask("/log", own), Some(Route::Log), "{own}");
        }
        for foreign in [
            "Sec-Fetch-Site: cross-site",
            "SEC-FETCH-SITE: same-site",
            "Origin: https://evil.example",
            "Origin: http://localhost:3000",
            "Origin: null",
            "Sec-Fetch-Site: same-origin\r\nSec-Fetch-Site: cross-site",
        ] {
            assert_eq!(ask("/log", foreign), Some(Route::Refused("403 Forbidden")), "{foreign}");
            assert_eq!(ask("/", foreign), Some(Route::Page), "a link may lead to the page");
        }
    }

    #[test]
    fn routes_by_hand() {
        let ask = |line: &str, host: &str| {
            route(format!("{line} HTTP/1.1\r\nAccept: */*\r\nHost: {host}\r\n\r\n").as_bytes(), 81)
        };
        assert_eq!(ask("GET /", "127.0.0.1:81"), Some(Route::Page));
        assert_eq!(ask("GET /log", "localhost:81"), Some(Route::Log));
        assert_eq!(ask("GET /other", "localhost:81"), Some(Route::Refused("404 Not Found")));
        assert_eq!(ask("POST /", "localhost:81"), Some(Route::Refused("405 Method Not Allowed")));
        for host in ["", "evil.example:81", "localhost", "localhost:82", "localhost:81.example"] {
            assert_eq!(ask("GET /log", host), Some(Route::Refused("403 Forbidden")), "{host}");
        }
        let twice = ask("GET /", "localhost:81\r\nHost: localhost:81");
        assert_eq!(twice, Some(Route::Refused("403 Forbidden")), "which one is meant?");
        assert_eq!(route(b"GET / HTTP/1.1\r\nHost: loc", 81), None, "not whole");
        assert_eq!(route(b"\x16\x03\x01\x02", 81), Some(Route::Refused("400 Bad Request")));
    }
}
