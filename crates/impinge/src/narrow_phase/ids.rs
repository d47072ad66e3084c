//! Allocation of contact ids.
//!
//! No id is given twice, even when phases are replaced: the counter moves on to the new phase.

/// Gives each pair a number that no other pair of the same world has or had.
///
/// A contact id consists of its pair's number and a number within the pair, so that pairs updated
/// at the same time need no coordination.
///
/// ```
/// use impinge::dim2::narrow_phase::IdAllocator;
///
/// let mut ids = IdAllocator::new();
/// assert_ne!(ids.allocate(), ids.allocate());
/// ```
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IdAllocator {
    next: u64,
}

impl IdAllocator {
    /// Creates an allocator that has given no number yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { next: 0 }
    }

    /// Returns the next number. It is never `u64::MAX`, the number of
    /// [`ContactId::NULL`](crate::query::ContactId::NULL): no program creates 2⁶⁴ pairs.
    pub fn allocate(&mut self) -> u64 {
        self.next += 1;
        self.next - 1
    }
}
