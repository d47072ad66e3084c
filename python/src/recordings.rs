//! Recordings as pages, where the module carries the engine of the page (the feature `page`).

use pyo3::prelude::*;

/// The recording as one HTML file that shows it; `None` where the module was built without the page.
///
/// # Errors
/// `ValueError` if the bytes are no recording.
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

/// The recording as one HTML file that shows it; `None` where the module was built without the page.
#[cfg(not(feature = "page"))]
#[pyfunction]
pub(crate) const fn recording_page(_bytes: &[u8], _title: &str) -> Option<String> {
    None
}
