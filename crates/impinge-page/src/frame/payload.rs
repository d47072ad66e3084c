//! The payload of a frame: consecutive sections of numbers.

use serde::Serialize;

/// The offset of a section in bytes, and the number of its elements.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Section(usize, usize);

/// Sections of numbers with four bytes each, little-endian.
#[derive(Debug, Default)]
pub(crate) struct Payload(pub(crate) Vec<u8>);

impl Payload {
    /// Appends numbers as a section.
    pub(crate) fn floats(&mut self, numbers: &[f32]) -> Section {
        self.section(numbers.len(), numbers.iter().map(|number| number.to_le_bytes()))
    }

    /// Appends indices or colours as a section.
    pub(crate) fn words(&mut self, words: &[u32]) -> Section {
        self.section(words.len(), words.iter().map(|word| word.to_le_bytes()))
    }

    fn section(&mut self, count: usize, numbers: impl Iterator<Item = [u8; 4]>) -> Section {
        let start = self.0.len();
        self.0.resize(start + 4 * count, 0);
        // Copied in place: appending four bytes at a time would check the capacity for each number.
        for (into, bytes) in self.0[start..].chunks_exact_mut(4).zip(numbers) {
            into.copy_from_slice(&bytes);
        }
        Section(start, count)
    }
}
