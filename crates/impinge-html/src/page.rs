//! Builds an HTML file from its parts.

use std::borrow::Cow;
use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use impinge_record::{is_packed, pack};
use serde_json::{Value, json};

use crate::assets::Assets;
use crate::error::HtmlError;

/// Returns a page that shows a recording, as one self-contained file.
///
/// The recording is packed, unless it is already. Its end may be missing, but it must end with a complete record:
/// [`Replay::salvage`](impinge_record::Replay::salvage) returns such bytes. The page has about four thirds of the bytes
/// of its parts; the time is that of packing.
///
/// # Errors
/// If the bytes cannot be packed, or the template lacks a placeholder or has one twice.
///
/// ```
/// use impinge_html::{Assets, export};
/// use impinge_record::{Recorder, Registry};
///
/// let mut recorder = Recorder::<f32, 3, ()>::new(0.02, Registry::new())?;
/// recorder.update();
/// let assets = Assets {
///     template: "{{TITLE}} {{STYLE}} {{SCENE}} {{RECORDING}} {{WASM}} {{SCRIPT}}".to_owned(),
///     style: String::new(),
///     script: "run()".to_owned(),
///     module: Vec::new(),
/// };
/// let page = export(&assets, &recorder.finish().bytes, "Nothing < something")?;
/// assert!(page.starts_with("Nothing &lt; something ") && page.ends_with("run()"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn export(assets: &Assets, recording: &[u8], title: &str) -> Result<String, HtmlError> {
    let packed =
        if is_packed(recording) { Cow::Borrowed(recording) } else { Cow::Owned(pack(recording)?) };
    let scene = json!({"open": "recording", "title": title});
    Page { title, scene, recording: &packed }.html(assets)
}

/// Writes the page of the samples as `index.html` in a folder, which is created if it does not exist. The page shows
/// `thumbnails/NAME.png` of this folder for each sample that has one.
///
/// # Errors
/// If the file cannot be written, or the template lacks a placeholder or has one twice.
pub fn gallery(assets: &Assets, folder: impl AsRef<Path>) -> Result<(), HtmlError> {
    let (folder, title) = (folder.as_ref(), "impinge: samples");
    let scene = json!({"open": "samples", "title": title});
    let page = Page { title, scene, recording: &[] }.html(assets)?;
    fs::create_dir_all(folder).map_err(HtmlError::file(folder))?;
    let path = folder.join("index.html");
    fs::write(&path, page).map_err(HtmlError::file(&path))
}

/// The content of a page besides its assets.
#[derive(Debug)]
pub(crate) struct Page<'a> {
    pub(crate) title: &'a str,
    /// The description of what the page opens.
    pub(crate) scene: Value,
    /// A packed recording, or empty.
    pub(crate) recording: &'a [u8],
}

impl Page<'_> {
    /// Returns the whole page. All parts are inserted in one pass: a placeholder within a part is not replaced.
    pub(crate) fn html(&self, assets: &Assets) -> Result<String, HtmlError> {
        // No part may close its element. In JSON a character can be written as an escape, and in strings of scripts and
        // styles after a backslash; outside of strings the sequences do not occur.
        let scene = self.scene.to_string().replace('<', "\\u003c");
        let script = assets.script.replace("</script", "<\\/script").replace("<!--", "<\\!--");
        let parts = [
            ("TITLE", escaped(self.title)),
            ("STYLE", assets.style.replace("</style", "<\\/style")),
            ("SCENE", scene),
            ("RECORDING", STANDARD.encode(self.recording)),
            ("WASM", STANDARD.encode(&assets.module)),
            ("SCRIPT", script),
        ];
        let mut placeholders = Vec::with_capacity(parts.len());
        for (name, part) in parts {
            let placeholder = format!("{{{{{name}}}}}");
            let found: Vec<_> = assets.template.match_indices(&placeholder).collect();
            let [(start, _)] = found[..] else {
                return Err(HtmlError::Placeholder { name, count: found.len() });
            };
            placeholders.push((start..start + placeholder.len(), part));
        }
        placeholders.sort_by_key(|(range, _)| range.start);
        let (mut html, mut end) = (String::new(), 0);
        for (range, part) in placeholders {
            html.push_str(&assets.template[end..range.start]);
            html.push_str(&part);
            end = range.end;
        }
        html.push_str(&assets.template[end..]);
        Ok(html)
    }
}

/// Escapes a text for HTML.
fn escaped(text: &str) -> String {
    let pairs = [("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ("\"", "&quot;"), ("'", "&#39;")];
    pairs.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
}
