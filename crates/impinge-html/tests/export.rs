//! Tests that an exported file contains all parts and the given recording, that the page of the
//! samples is written, and that broken input is an error.

use std::fs;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use impinge_html::{Assets, HtmlError, export, gallery};
use impinge_record::{Recorder, Registry, pack, unpack, validate};
use tempfile::TempDir;

const TEMPLATE: &str = "<title>{{TITLE}}</title><style>{{STYLE}}</style>\
    <script id=scene>{{SCENE}}</script><script id=recording>{{RECORDING}}</script>\
    <script id=wasm>{{WASM}}</script><script id=program>{{SCRIPT}}</script>";

/// Returns assets with this template and an empty style, script and engine.
fn plain(template: String) -> Assets {
    Assets { template, style: String::new(), script: String::new(), module: Vec::new() }
}

fn recording() -> Vec<u8> {
    let recorder = Recorder::<f64, 2, ()>::new(0.02, Registry::new());
    let mut recorder = recorder.expect("a usable margin");
    (0..5).for_each(|_| recorder.update());
    recorder.finish().bytes
}

/// Returns the content of the script element with this id.
fn part<'a>(html: &'a str, id: &str) -> &'a str {
    let (_, rest) = html.split_once(&format!("<script id={id}>")).expect("the part is there");
    rest.split_once("</script>").expect("the part ends").0
}

#[test]
fn all_parts_are_in_the_file() {
    let folder = TempDir::new().expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.path().join(name), bytes).expect("a temporary file");
    };
    write("page.html", TEMPLATE.as_bytes());
    write("page.css", b"body { content: '{{SCRIPT}}</style>' }");
    write("page.js", b"run('</script><!-- {{TITLE}}')");
    write("page.wasm.gz", &[0x1f, 0x8b, 0xff]);
    let assets = Assets::from_folder(&folder).expect("four files");
    let html = export(&assets, &recording(), "a </title><b> & \"c\"").expect("a recording");

    assert!(
        html.starts_with("<title>a &lt;/title&gt;&lt;b&gt; &amp; &quot;c&quot;</title>"),
        "{html}"
    );
    assert!(html.contains("<style>body { content: '{{SCRIPT}}<\\/style>' }</style>"), "{html}");
    assert_eq!(part(&html, "program"), "run('<\\/script><\\!-- {{TITLE}}')");
    let scene: serde_json::Value = serde_json::from_str(part(&html, "scene")).expect("JSON");
    assert_eq!(
        (&scene["open"], &scene["title"]),
        (&"recording".into(), &"a </title><b> & \"c\"".into())
    );
    assert!(!part(&html, "scene").contains('<'), "nothing ends the script");
    assert_eq!(STANDARD.decode(part(&html, "wasm")).expect("base64"), [0x1f, 0x8b, 0xff]);
    let packed = STANDARD.decode(part(&html, "recording")).expect("base64");
    assert_eq!(packed, pack(&recording()).expect("a recording"));
    let unpacked = unpack(&packed).expect("it was packed");
    assert_eq!(validate(&unpacked, &Registry::<f64, 2, ()>::new()), Ok(None));
    let again = export(&assets, &packed, "a </title><b> & \"c\"").expect("a packed recording");
    assert!(again == html, "what is packed is not packed again");
}

#[test]
fn the_gallery_is_a_folder() {
    let folder = TempDir::new().expect("a temporary folder");
    let site = folder.path().join("deep/site");
    gallery(&plain(TEMPLATE.to_owned()), &site).expect("the folder is made");
    let html = fs::read_to_string(site.join("index.html")).expect("it is written");
    let scene: serde_json::Value = serde_json::from_str(part(&html, "scene")).expect("JSON");
    assert_eq!(scene["open"], "samples");
    assert_eq!(part(&html, "recording"), "");
}

#[test]
fn errors_say_what_is_wrong() {
    let folder = TempDir::new().expect("a temporary folder");
    let page = folder.path().join("page.html");
    fs::write(&page, TEMPLATE).expect("a temporary file");
    let missing = Assets::from_folder(&folder).expect_err("three files are missing");
    assert!(missing.to_string().contains("page.css"), "{missing}");
    for (template, count) in
        [(TEMPLATE.replace("{{WASM}}", ""), 0), (TEMPLATE.replace("{{SCRIPT}}", "{{WASM}}"), 2)]
    {
        let error = export(&plain(template), &recording(), "").expect_err("a broken template");
        let HtmlError::Placeholder { name: "WASM", count: found } = error else {
            panic!("{error}")
        };
        assert_eq!(found, count);
    }
    let error = export(&plain(TEMPLATE.to_owned()), b"text", "").expect_err("no recording");
    assert!(matches!(error, HtmlError::Recording(_)), "{error}");
    let error = gallery(&plain(TEMPLATE.to_owned()), &page).expect_err("a file is no folder");
    assert!(error.to_string().contains("page.html"), "{error}");
}
