//! Where the names of contacts come from.
//!
//! A name is never given twice, also across an exchange of phases, which hands the counter on.

/// Gives each pair a number that no other pair of the same world has or had.
///
/// A contact is named by its pair's number and a number within the pair, so that names need no
/// coordination between pairs that are updated at the same time.
///
/// ```
/// use impinge::dim2::narrow_phase::IdAllocator;
///
/// let mut ids = IdAllocator::new();
/// assert_ne!(ids.allocate(), ids.allocate());
/// ```
#[derive(Clone, Debug, Default)]
pub struct IdAllocator {
    next: u64,
}

impl IdAllocator {
    /// An allocator that has given nothing yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { next: 0 }
    }

    /// The next number. It is never `u64::MAX`, the number of [`ContactId::NULL`](crate::query::ContactId::NULL):
    /// 2⁶⁴ pairs are more than any program makes.
    pub fn allocate(&mut self) -> u64 {
        self.next += 1;
        self.next - 1
    }
}
