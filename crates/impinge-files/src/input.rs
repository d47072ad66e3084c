//! Files as bytes, and the endings of their names.

use std::fs;
use std::path::Path;

use crate::{FileError, Problem};

/// The bytes of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    fs::read(path).map_err(|error| FileError::whole(path, Problem::io(&error)))
}

/// The ending of a name in lower case, without its dot; empty if there is none.
pub(crate) fn extension(path: &Path) -> String {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.unwrap_or_default().to_ascii_lowercase()
}
