//! Names of objects.

/// The name of a collision object; it never comes to mean another object of its world.
///
/// Worlds count each for itself: a handle means something only to the world that gave it.
///
/// Ordered by the index in the handle table, then by generation: this is the canonical order of
/// pairs, events and query results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CollisionObjectHandle {
    index: u32,
    generation: u32,
}

impl CollisionObjectHandle {
    /// The handle of the `generation`-th object at an index of the table.
    #[inline]
    pub(crate) const fn new(index: u32, generation: u32) -> Self {
        Self { index, generation }
    }

    /// The index in the handle table: dense, and in order of creation until the first removal.
    #[inline]
    #[must_use]
    pub const fn uid(&self) -> usize {
        self.index as usize
    }

    /// The index in the handle table, as it is stored.
    #[inline]
    pub(crate) const fn index(self) -> u32 {
        self.index
    }

    /// How many objects held this index before.
    #[inline]
    pub(crate) const fn generation(self) -> u32 {
        self.generation
    }
}

/// Two objects in order, and whether they started to be a pair (`true`) or stopped.
pub type Interaction = ((CollisionObjectHandle, CollisionObjectHandle), bool);
