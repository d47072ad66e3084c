//! Recordings as pages, if the module contains the engine of the page (the feature `page`).

use pyo3::prelude::*;

/// Returns the recording as one HTML file that shows it; `None` if the module was built without the
/// page.
///
/// # Errors
/// `ValueError` if the bytes are not a recording.
#[cfg(feature = "page")]
#[pyfunction]
pub(crate) fn recording_page(
    py: Python<'_>,
    bytes: &[u8],
    title: &str,
) -> PyResult<Option<String>> {
    let page = py.detach(|| impinge_html::export(&impinge_html::Assets::embedded(), bytes, title));
    page.map(Some).map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))
}

/// Returns `None`: the module was built without the page.
#[cfg(not(feature = "page"))]
#[pyfunction]
pub(crate) const fn recording_page(_bytes: &[u8], _title: &str) -> Option<String> {
    None
}
