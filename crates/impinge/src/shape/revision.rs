//! Cache keys of composites: they detect a change of a composite without a comparison of its parts.

use core::sync::atomic::{AtomicUsize, Ordering};

/// Identifies one state of a composite: two composites with equal revisions have equal parts and
/// options.
///
/// A composite takes a new number at construction and at each change of its parts; a clone keeps
/// the number until it changes. The counter wraps around after `usize::MAX`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(unnameable_types, reason = "in the interface of `CompositeShape`")]
pub struct Revision {
    number: usize,
    /// One bit per option; changing an option keeps the number.
    options: u8,
}

/// The next revision number; wraps around.
static NUMBERS: AtomicUsize = AtomicUsize::new(0);

impl Revision {
    /// Returns a revision with a number not taken before.
    pub(in crate::shape) fn new() -> Self {
        Self { number: NUMBERS.fetch_add(1, Ordering::Relaxed), options: 0 }
    }

    /// Returns this revision with the given options, at most 8.
    pub(in crate::shape) fn with(self, options: &[bool]) -> Self {
        let bits = options.iter().fold(0, |bits, &option| bits << 1 | u8::from(option));
        Self { options: bits, ..self }
    }
}
