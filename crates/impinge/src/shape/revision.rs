//! Knowing a composite again without looking at its parts.

use core::sync::atomic::{AtomicUsize, Ordering};

/// Names one state of a composite: two of one name have the same parts and the same options.
///
/// Each composite gets a number when it is made and another at each change; copies keep the number until they change.
/// The numbers start again after as many as a `usize` counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(unnameable_types, reason = "in the interface of `CompositeShape`")]
pub struct Revision {
    number: usize,
    /// A bit for each option that is set without a new number.
    options: u8,
}

/// Numbers given so far; wraps.
static NUMBERS: AtomicUsize = AtomicUsize::new(0);

impl Revision {
    /// A name not given before.
    pub(in crate::shape) fn new() -> Self {
        Self { number: NUMBERS.fetch_add(1, Ordering::Relaxed), options: 0 }
    }

    /// The name of the state with these options.
    pub(in crate::shape) fn with(self, options: &[bool]) -> Self {
        let bits = options.iter().fold(0, |bits, &option| bits << 1 | u8::from(option));
        Self { options: bits, ..self }
    }
}
