//! Selects the page that the command writes or serves.

use impinge_html::Assets;

use crate::args::PageArgs;
use crate::error::CliError;

/// Returns the files of the page from the folder in the arguments, or the embedded files if no
/// folder is given.
pub(crate) fn assets(args: &PageArgs) -> Result<Assets, CliError> {
    match &args.folder {
        Some(folder) => Ok(Assets::from_folder(folder)?),
        None => embedded().ok_or(CliError::NoPage),
    }
}

#[cfg(feature = "page")]
#[expect(clippy::unnecessary_wraps, reason = "a command without the feature has none")]
fn embedded() -> Option<Assets> {
    Some(Assets::embedded())
}

#[cfg(not(feature = "page"))]
const fn embedded() -> Option<Assets> {
    None
}
