//! Cache keys of composites: whether a composite changed, without a look at its parts.

use core::sync::atomic::{AtomicUsize, Ordering};

/// Identifies one state of a composite: two composites with equal revisions have the same parts and
/// options.
///
/// A composite takes a new number when it is made and at each change; copies keep the number until
/// they change. The counter wraps around after `usize::MAX`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(unnameable_types, reason = "in the interface of `CompositeShape`")]
pub struct Revision {
    number: usize,
    /// One bit for each option; options are set without a new number.
    options: u8,
}

/// How many numbers were taken so far; wraps.
static NUMBERS: AtomicUsize = AtomicUsize::new(0);

impl Revision {
    /// A revision with a number not taken before.
    pub(in crate::shape) fn new() -> Self {
        Self { number: NUMBERS.fetch_add(1, Ordering::Relaxed), options: 0 }
    }

    /// This revision with the given options.
    pub(in crate::shape) fn with(self, options: &[bool]) -> Self {
        let bits = options.iter().fold(0, |bits, &option| bits << 1 | u8::from(option));
        Self { options: bits, ..self }
    }
}
