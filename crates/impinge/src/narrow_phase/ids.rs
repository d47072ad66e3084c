//! Allocation of contact ids.
//!
//! No id is issued twice in a world, even if its narrow phase is replaced: the new narrow phase
//! continues the counter. Only a rewind resets the counter, to its value at the mark.

/// A counter that issues an identifier for each pair. Between rewinds, no two pairs of a world ever
/// have the same identifier.
///
/// A contact id consists of the identifier of its pair and a number within the pair. So pairs that
/// are updated in parallel need no coordination.
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
    /// Creates an allocator that has not issued any identifier.
    #[must_use]
    pub const fn new() -> Self {
        Self { next: 0 }
    }

    /// Issues the next identifier. It is never `u64::MAX`, which belongs to
    /// [`ContactId::NULL`](crate::query::ContactId::NULL): no program creates 2⁶⁴ pairs.
    pub fn allocate(&mut self) -> u64 {
        self.next += 1;
        self.next - 1
    }
}
