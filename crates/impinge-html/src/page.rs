//! Builds the HTML of a page from its parts.

use std::borrow::Cow;
use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use impinge_record::{is_packed, pack};
use serde_json::{Value, json};

use crate::assets::Assets;
use crate::error::HtmlError;

/// Returns a self-contained HTML page that shows a recording.
///
/// A recording that is not packed is packed first. The end of the recording may be missing, but
/// its last record must be complete: [`Replay::salvage`](impinge_record::Replay::salvage) returns
/// such bytes. The page contains recording and engine in base64, which makes them a third larger.
///
/// # Errors
/// If the bytes cannot be packed, or if the template does not contain each placeholder exactly
/// once.
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

/// Writes the page of the samples as `index.html` into a folder, which is created if it does not
/// exist. For each sample the page shows the picture `thumbnails/NAME.png` of this folder, if there
/// is such a file.
///
/// # Errors
/// If the folder or the file cannot be written, or if the template does not contain each
/// placeholder exactly once.
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
    /// A JSON object that describes what the page opens: a recording, a live recording or the
    /// samples.
    pub(crate) scene: Value,
    /// The bytes of a packed recording; empty if the page contains none.
    pub(crate) recording: &'a [u8],
}

impl Page<'_> {
    /// Returns the HTML of the page. All parts are inserted in one pass, so that a placeholder
    /// within a part is not replaced.
    pub(crate) fn html(&self, assets: &Assets) -> Result<String, HtmlError> {
        // No part may contain the end tag of its own element. A script may not contain `<!--`.
        // In JSON `<` can be written as an escape. In strings of scripts and styles a backslash
        // behind `<` breaks the sequence. Outside of strings these sequences do not occur.
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
