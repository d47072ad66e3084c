//! Recordings as HTML pages, if the module contains the viewer (the feature `page`).

use pyo3::prelude::*;

/// Returns one HTML file that shows the recording; `None` if the module was built without the
/// viewer.
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

/// Returns `None`, because the module was built without the viewer.
#[cfg(not(feature = "page"))]
#[pyfunction]
pub(crate) const fn recording_page(_bytes: &[u8], _title: &str) -> Option<String> {
    None
}
