//! Checks accessors of glTF files: their types, and that their data lie within the buffers.
//!
//! The crate `gltf` checks neither the types, nor the ranges, nor the indices of sparse accessors.
//! This module checks each accessor before the crate reads it.

use gltf::accessor::sparse::Sparse;
use gltf::accessor::{DataType, Dimensions};
use gltf::{Accessor, buffer};

use super::raw::FormatError;

/// The required form of an accessor: the component types that it may have, and its dimensions
/// (scalar or vector).
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout<'a> {
    pub(super) types: &'a [DataType],
    pub(super) dimensions: Dimensions,
}

/// Elements of equal size at a constant stride in a view of a buffer.
struct Block<'a> {
    view: buffer::View<'a>,
    /// The offset of the first element from the start of the view, in bytes.
    offset: usize,
    count: usize,
    /// The size of an element in bytes.
    size: usize,
}

/// Checks an accessor against the required type and the sizes of the buffers.
pub(super) fn check(
    accessor: &Accessor<'_>,
    buffers: &[&[u8]],
    layout: Layout<'_>,
) -> Result<(), FormatError> {
    let name = accessor.index();
    check_numbers(accessor, buffers, layout)
        .map_err(|what| FormatError::syntax(None, format!("accessor {name}: {what}")))
}

fn check_numbers(
    accessor: &Accessor<'_>,
    buffers: &[&[u8]],
    layout: Layout<'_>,
) -> Result<(), &'static str> {
    let is_usable = layout.types.contains(&accessor.data_type());
    if !is_usable || accessor.dimensions() != layout.dimensions {
        return Err("numbers of another type are needed");
    }
    let (count, size) = (accessor.count(), accessor.size());
    // Without a view, all elements are 0 except the sparse elements. The caller limits the number
    // of elements.
    if let Some(view) = accessor.view() {
        Block { view, offset: accessor.offset(), count, size }.bytes(buffers)?;
    }
    accessor.sparse().map_or(Ok(()), |sparse| check_sparse(&sparse, accessor, buffers))
}

/// Checks the sparse elements, which replace elements of the view: one value for each index, with
/// increasing indices in range.
fn check_sparse(
    sparse: &Sparse<'_>,
    accessor: &Accessor<'_>,
    buffers: &[&[u8]],
) -> Result<(), &'static str> {
    let (count, indices, values) = (sparse.count(), sparse.indices(), sparse.values());
    let size = accessor.size();
    Block { view: values.view(), offset: values.offset(), count, size }.bytes(buffers)?;
    let size = indices.index_type().size();
    let block = Block { view: indices.view(), offset: indices.offset(), count, size };
    let (bytes, stride) = (block.bytes(buffers)?, block.stride());
    let numbers = bytes.chunks(stride).map(|bytes| {
        let low_to_high = bytes.iter().take(size).rev();
        low_to_high.fold(0_usize, |number, byte| number << 8 | usize::from(*byte))
    });
    let numbers: Vec<usize> = numbers.collect();
    // The crate `gltf` ignores an element that follows one with a larger index.
    let is_increasing = numbers.is_sorted_by(|one, next| one < next);
    let is_in_range = numbers.last().is_some_and(|last| *last < accessor.count());
    if is_increasing && is_in_range { Ok(()) } else { Err("its sparse indices are out of order") }
}

impl Block<'_> {
    /// Returns the distance in bytes between the starts of two consecutive elements.
    fn stride(&self) -> usize {
        self.view.stride().unwrap_or(self.size)
    }

    /// Returns the bytes from the first element to the end of the last. An error if there are no
    /// elements, if they overlap, or if the view or its buffer is too short.
    fn bytes<'b>(&self, buffers: &[&'b [u8]]) -> Result<&'b [u8], &'static str> {
        let steps = self.count.checked_sub(1).ok_or("it is empty")?;
        if self.stride() < self.size {
            return Err("its numbers overlap");
        }
        let length = self.stride().checked_mul(steps).and_then(|end| end.checked_add(self.size));
        let end = length.and_then(|length| length.checked_add(self.offset));
        let end = end.filter(|end| *end <= self.view.length());
        let view_end = self.view.offset().checked_add(self.view.length());
        let buffer = buffers.get(self.view.buffer().index());
        let view = buffer.zip(view_end).and_then(|(bytes, end)| bytes.get(self.view.offset()..end));
        let bytes = view.zip(end).and_then(|(bytes, end)| bytes.get(self.offset..end));
        bytes.ok_or("it reaches beyond its buffer")
    }
}
