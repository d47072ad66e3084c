//! The parts that all pages have in common.

use std::fs;
use std::path::Path;

use crate::error::HtmlError;

/// The parts that all pages have in common: all but the title, the scene and the recording.
#[derive(Clone, Debug)]
pub struct Assets {
    /// The HTML template. It must contain each of the placeholders `{{TITLE}}`, `{{STYLE}}`,
    /// `{{SCENE}}`, `{{RECORDING}}`, `{{WASM}}` and `{{SCRIPT}}` exactly once.
    pub template: String,
    /// The style sheet.
    pub style: String,
    /// The bundled script of the page.
    pub script: String,
    /// The engine: a WebAssembly module, compressed by gzip.
    pub module: Vec<u8>,
}

impl Assets {
    /// Reads the files `page.html`, `page.css`, `page.js` and `page.wasm.gz` of a folder.
    ///
    /// # Errors
    /// If one of the files cannot be read, or a text is not UTF-8.
    pub fn from_folder(folder: impl AsRef<Path>) -> Result<Self, HtmlError> {
        let text = |name: &str| {
            let path = folder.as_ref().join(name);
            fs::read_to_string(&path).map_err(HtmlError::file(&path))
        };
        let module = folder.as_ref().join("page.wasm.gz");
        Ok(Self {
            template: text("page.html")?,
            style: text("page.css")?,
            script: text("page.js")?,
            module: fs::read(&module).map_err(HtmlError::file(&module))?,
        })
    }

    /// Returns the parts that are embedded in this program.
    #[cfg(feature = "page")]
    #[must_use]
    pub fn embedded() -> Self {
        Self {
            template: include_str!("../../impinge-page/web/page.html").to_owned(),
            style: include_str!("../../impinge-page/web/page.css").to_owned(),
            script: include_str!("../../impinge-page/web/dist/page.js").to_owned(),
            module: include_bytes!(concat!(env!("OUT_DIR"), "/page.wasm.gz")).to_vec(),
        }
    }
}
