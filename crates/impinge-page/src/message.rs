//! The layout that messages and responses have in common.

use crate::EngineError;

/// Returns the bytes of a message: the length of the padded text in four bytes (little-endian), the
/// JSON text padded with spaces to a multiple of four bytes, and the payload.
///
/// ```
/// let bytes = impinge_page::message(r#"{"do": "samples"}"#, &[7]);
/// assert_eq!(bytes.len(), 4 + 20 + 1);
/// assert_eq!(bytes[..4], [20, 0, 0, 0]);
/// let (text, payload) = impinge_page::parts(&bytes)?;
/// assert_eq!((text.trim_ascii_end().len(), payload), (17, &[7][..]));
/// # Ok::<(), impinge_page::EngineError>(())
/// ```
#[must_use]
pub fn message(text: &str, payload: &[u8]) -> Vec<u8> {
    let padded = text.len().next_multiple_of(4);
    let length = u32::try_from(padded).unwrap_or(u32::MAX);
    let mut bytes = Vec::with_capacity(4 + padded + payload.len());
    bytes.extend(length.to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.resize(4 + padded, b' ');
    bytes.extend(payload);
    bytes
}

/// Splits a message into text and payload. Does not check whether the text is JSON, or UTF-8.
///
/// # Errors
/// If there are fewer bytes than the length of the text requires.
pub fn parts(bytes: &[u8]) -> Result<(&[u8], &[u8]), EngineError> {
    let truncated = |wanted| EngineError::Truncated { wanted, found: bytes.len() };
    let (length, rest) = bytes.split_first_chunk::<4>().ok_or_else(|| truncated(4))?;
    let length = u32::from_le_bytes(*length);
    let wanted = 4 + u64::from(length);
    let split = usize::try_from(length).ok().filter(|length| *length <= rest.len());
    let split = split.ok_or_else(|| truncated(wanted))?;
    // The payload begins at a multiple of four. Without a payload the padding may be missing.
    let aligned = split.next_multiple_of(4).min(rest.len());
    Ok((&rest[..split], &rest[aligned..]))
}
