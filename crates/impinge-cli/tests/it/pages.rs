//! Tests of `export`, `view` and `samples`: the pages contain whole or damaged recordings, a server
//! follows a growing one, and bad input gives errors.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::process::{ChildStdout, Stdio};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use impinge_record::{Registry, Replay, unpack};
use impinge_view::Image;

use crate::support::Desk;

/// Returns the number of steps of a recording of a 3D world in `f64`, after checking that all of
/// them replay to the same bits.
fn steps(bytes: Vec<u8>) -> usize {
    let replay = Replay::<f64, 3, Vec<u8>>::open(bytes, &Registry::new());
    let mut replay = replay.expect("a recording");
    let last = replay.len();
    replay.seek(last).expect("calls that can be made");
    assert_eq!(replay.divergence(), None, "the same bits");
    last
}

/// Returns the recording that a page contains, unpacked.
fn recording(page: &str) -> Vec<u8> {
    let packed = STANDARD.decode(page.lines().nth(2).expect("a line")).expect("base64");
    unpack(&packed).expect("a packed recording")
}

#[test]
fn a_page_has_the_recording_of_a_file() {
    let desk = Desk::recorded();
    let report = desk.json("export balls.implog -o balls.html --title A<B", 0);
    let page = fs::read_to_string(desk.path("balls.html")).expect("a page");
    assert_eq!(report["bytes"], page.len());
    assert!(page.starts_with("A&lt;B\n"), "the title is escaped: {page}");
    assert_eq!(steps(recording(&page)), 30);
}

#[test]
fn a_page_has_the_recording_of_a_scene() {
    let desk = Desk::new();
    let ran = desk.run("export balls.json -o balls.html --steps 12");
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    let page = fs::read_to_string(desk.path("balls.html")).expect("a page");
    assert!(page.starts_with("balls.json\n"), "the file is the title");
    assert_eq!(steps(recording(&page)), 12);
}

/// Creates a folder with a recording of 30 updates, the last of which is incomplete. Also returns
/// the bytes of the whole records.
fn cut() -> (Desk, Vec<u8>) {
    let desk = Desk::recorded();
    let mut bytes = fs::read(desk.path("balls.implog")).expect("a recording");
    let end = Replay::<f64, 3, Vec<u8>>::salvage(&bytes[..bytes.len() - 20], &Registry::new());
    let end = end.expect("a header");
    assert_eq!(end.len(), 29, "an update is lost");
    // A part of the last record follows the whole records.
    bytes.truncate(end.bytes().len() + 3);
    desk.write("cut.implog", &bytes);
    (desk, end.bytes().to_vec())
}

#[test]
fn a_page_has_what_is_left_of_a_recording() {
    let (desk, kept) = cut();
    let ran = desk.run("export cut.implog -o cut.html");
    assert_eq!(ran.code, 0, "{ran:?}");
    assert!(ran.err.contains("29 steps are kept, 3 bytes left out"), "{ran:?}");
    let page = fs::read_to_string(desk.path("cut.html")).expect("a page");
    // Packing omits the hashes of objects, so both recordings are compared after packing and
    // unpacking.
    let packed = impinge_record::pack(&kept).expect("whole records");
    assert!(recording(&page) == unpack(&packed).expect("just packed"), "whole records alone");
}

#[test]
fn a_browser_sees_what_is_left_of_a_recording() {
    let (desk, kept) = cut();
    let mut command = desk.command();
    command.args(["view", "cut.implog"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the command");
    let mut stream = follow(child.stdout.take().expect("a pipe"));
    // The stream continues until the command ends, so it is read only until the whole records have
    // arrived.
    let mut answer = Vec::new();
    let is_sent = |answer: &[u8]| answer.windows(kept.len()).any(|bytes| bytes == kept);
    while !is_sent(&answer) {
        let mut piece = [0; 4096];
        let count = stream.read(&mut piece).expect("an answer");
        assert!(count > 0, "the stream ends");
        answer.extend(&piece[..count]);
    }
    child.kill().expect("it runs");
    let mut err = String::new();
    child.stderr.take().expect("a pipe").read_to_string(&mut err).expect("text");
    assert!(err.contains("29 steps are kept, 3 bytes left out"), "{err}");
    child.wait().expect("an end");
    let tail = [&kept[..], b"\r\n"].concat();
    assert!(answer.ends_with(&tail), "whole records alone");
}

#[test]
fn no_page_is_made_of_bad_input() {
    let desk = Desk::new();
    desk.write("damaged.implog", b"\x89IPREC\r\nand no more");
    for (arguments, named) in [
        ("export damaged.implog -o out.html", "damaged.implog"),
        ("export nothing.json -o out.html", "nothing.json"),
        ("export balls.json -o no/folder.html", "folder.html"),
        ("export balls.json -o out.html --page nowhere", "nowhere"),
        ("export balls.json -o out.html --dt -1", "-1"),
        ("samples -o balls.json", "balls.json"),
    ] {
        let ran = desk.run(arguments);
        assert_eq!(ran.code, 2, "{arguments}: {ran:?}");
        assert!(ran.err.contains(named), "{arguments}: {}", ran.err);
        assert!(!desk.path("out.html").exists(), "{arguments}");
    }
}

#[test]
fn a_command_without_a_page_says_how_to_get_one() {
    let desk = Desk::new();
    let mut command = desk.command();
    command.env_remove("IMPINGE_PAGE").args(["export", "balls.json", "-o", "out.html"]);
    let output = command.output().expect("the command");
    let err = String::from_utf8_lossy(&output.stderr);
    if cfg!(feature = "page") {
        assert_eq!((output.status.code(), &*err), (Some(0), ""));
    } else {
        assert_eq!(output.status.code(), Some(2));
        assert!(err.contains("--features page") && err.contains("--page"), "{err}");
    }
}

/// Returns the body of a response, without the lengths of its chunks.
fn body(answer: &[u8]) -> Vec<u8> {
    let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").expect("an end of the head");
    let (mut rest, mut body) = (&answer[end + 4..], Vec::new());
    loop {
        let line = rest.windows(2).position(|bytes| bytes == b"\r\n").expect("a length");
        let digits = std::str::from_utf8(&rest[..line]).expect("digits");
        let length = usize::from_str_radix(digits, 16).expect("a number");
        if length == 0 {
            return body;
        }
        body.extend(&rest[line + 2..line + 2 + length]);
        rest = &rest[line + 4 + length..];
    }
}

/// Requests the recording at the address that the command prints, and returns the stream of the
/// response.
fn follow(out: ChildStdout) -> TcpStream {
    let mut line = String::new();
    BufReader::new(out).read_line(&mut line).expect("the address");
    let address = line.trim().trim_start_matches("http://").trim_end_matches('/');
    let mut stream = TcpStream::connect(address).expect("a server");
    write!(stream, "GET /log HTTP/1.1\r\nHost: {address}\r\n\r\n").expect("a request");
    stream
}

#[test]
fn a_browser_follows_a_scene() {
    let desk = Desk::new();
    let mut command = desk.command();
    command.args(["view", "balls.json", "--steps", "40"]).stdout(Stdio::piped());
    let mut child = command.spawn().expect("the command");
    let mut stream = follow(child.stdout.take().expect("a pipe"));
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("an answer");
    assert_eq!(child.wait().expect("an end").code(), Some(0));
    assert_eq!(steps(body(&answer)), 40);
}

#[test]
fn a_port_in_use_is_named() {
    let desk = Desk::new();
    let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
    let port = listener.local_addr().expect("an address").port();
    let ran = desk.run(&format!("view balls.json --steps 1 --port {port}"));
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains(&port.to_string()), "{}", ran.err);
}

#[test]
fn the_gallery_has_a_picture_of_each_sample() {
    let desk = Desk::new();
    let report = desk.json("samples -o gallery --size 160x100", 0);
    let samples = report["samples"].as_array().expect("a list");
    assert!(samples.len() >= 24, "{}", samples.len());
    let page = fs::read_to_string(desk.path("gallery/index.html")).expect("a page");
    assert!(page.contains(r#""open":"samples""#), "{page}");
    for sample in samples {
        let name = sample["name"].as_str().expect("a name");
        let bytes = fs::read(desk.path(&format!("gallery/thumbnails/{name}.png")));
        let image = Image::from_png(&bytes.expect("a picture")).expect("a picture");
        let background = image.pixel(0, 0);
        let drawn = image.pixels().iter().filter(|pixel| **pixel != background).count();
        assert!(drawn > 20, "{name} has {drawn} pixels of something");
        let is_contact = |[r, g, b, _]: &&[u8; 4]| *r > 230 && *g < 120 && *b < 110;
        let contacts = image.pixels().iter().filter(is_contact).count();
        assert!(contacts * 4 < drawn * 3, "{name}: contacts are {contacts} of {drawn} pixels");
    }
}
