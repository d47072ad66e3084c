//! Reads the buffers of glTF files: from the file itself, from data URIs, and from other files,
//! each of which is read once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::Gltf;
use gltf::buffer::Source;
use percent_encoding::percent_decode_str;

use super::raw::FormatError;
use crate::Problem;
use crate::files::Files;
use crate::text::Quoted;

/// The bytes of all buffers. Buffers from one file share their bytes.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    /// The decoded bytes of data URIs, and the bytes of other files.
    read: Vec<Vec<u8>>,
    /// For each buffer of the document, the index of its bytes in `read`; `None` for the binary
    /// chunk of the document.
    places: Vec<Option<usize>>,
    /// The index in `read` for each file that was read, by its path without symbolic links.
    files: BTreeMap<PathBuf, usize>,
}

impl Buffers {
    /// Reads the buffers of a document. Paths are relative to `folder`. An error if a buffer is
    /// shorter than the document says.
    pub(super) fn read(
        document: &Gltf,
        folder: &Path,
        files: &mut Files,
    ) -> Result<Self, FormatError> {
        let mut buffers = Self::default();
        for buffer in document.buffers() {
            let place = match buffer.source() {
                Source::Bin => None,
                Source::Uri(uri) => Some(buffers.resource(uri, folder, files)?),
            };
            buffers.places.push(place);
            let given = buffers.bytes(place, document).len();
            if given < buffer.length() {
                let (index, needed) = (buffer.index(), buffer.length());
                let message = format!("buffer {index} has {given} bytes of {needed}");
                return Err(FormatError::syntax(None, message));
            }
        }
        Ok(buffers)
    }

    /// Returns the bytes of each buffer.
    pub(super) fn slices<'a>(&'a self, document: &'a Gltf) -> Vec<&'a [u8]> {
        self.places.iter().map(|place| self.bytes(*place, document)).collect()
    }

    fn bytes<'a>(&'a self, place: Option<usize>, document: &'a Gltf) -> &'a [u8] {
        match place {
            Some(place) => &self.read[place],
            None => document.blob.as_deref().unwrap_or_default(),
        }
    }

    /// Returns the index in `read` of the bytes of a URI. Each file is read once; each data URI is
    /// decoded.
    fn resource(
        &mut self,
        uri: &str,
        folder: &Path,
        files: &mut Files,
    ) -> Result<usize, FormatError> {
        if let Some(data) = uri.strip_prefix("data:") {
            return Ok(self.add(inline(data)?));
        }
        let wrong = |problem| match problem {
            Problem::Io { kind, message } => {
                Problem::Io { kind, message: format!("the buffer {}: {message}", Quoted(uri)) }
            }
            problem => problem,
        };
        let name = uri.strip_prefix("file://").unwrap_or(uri);
        let name = percent_decode_str(name).decode_utf8_lossy();
        let path = files.locate(&folder.join(&*name)).map_err(wrong)?;
        if let Some(place) = self.files.get(&path) {
            return Ok(*place);
        }
        let place = self.add(files.read(&path).map_err(wrong)?);
        self.files.insert(path, place);
        Ok(place)
    }

    fn add(&mut self, bytes: Vec<u8>) -> usize {
        self.read.push(bytes);
        self.read.len() - 1
    }
}

fn inline(data: &str) -> Result<Vec<u8>, FormatError> {
    let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
    let encoded = encoded.ok_or_else(|| FormatError::syntax(None, "a data URI is not base64"))?;
    let decoded = STANDARD.decode(encoded);
    decoded.map_err(|error| FormatError::syntax(None, format!("a data URI: {error}")))
}
