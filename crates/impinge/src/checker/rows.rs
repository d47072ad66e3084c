//! An output column with several values for each configuration.

use crate::chunks::Cut;

/// Slots with one row of `width` values for each configuration. The slice is cut only between rows.
pub(super) struct RowsOf<'a, T> {
    slots: &'a mut [T],
    width: usize,
}

impl<'a, T> RowsOf<'a, T> {
    pub(super) const fn new(slots: &'a mut [T], width: usize) -> Self {
        Self { slots, width }
    }

    /// Returns the number of rows; 0 if `width` is 0.
    pub(super) fn rows(&self) -> usize {
        self.slots.len().checked_div(self.width).unwrap_or(0)
    }

    pub(super) const fn into_slice(self) -> &'a mut [T] {
        self.slots
    }
}

impl<T: Send> Cut for RowsOf<'_, T> {
    fn cut(self, at: usize) -> (Self, Self) {
        let at = (at * self.width).min(self.slots.len());
        let (front, back) = self.slots.split_at_mut(at);
        (Self::new(front, self.width), Self::new(back, self.width))
    }
}
