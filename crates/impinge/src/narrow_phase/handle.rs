//! Handles of objects.

use crate::generation::Generation;

/// The handle of a collision object. Within a world that is not rewound, a handle never refers to a
/// different object than the one for which it was issued.
///
/// A world refuses a handle of another world like a stale handle, even if both worlds were filled
/// in the same way. Only a clone and its original both accept the handles issued before the clone.
/// (Handle tables are distinguished by a tag of 16 bits, which is reused after 65535 tables; a
/// world has one table for its objects, and others for its broad phase and its marks.)
/// [`CollisionWorld::counterpart`] translates handles of other worlds, and also deserialized
/// handles, which belong to no world: the serialized form is the index and the generation.
///
/// Handles are ordered by the index in the handle table, then by generation. This is the canonical
/// order of pairs, events and query results.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// let mut add = || world.add(Isometry::identity(), ball.clone(), CollisionGroups::new(), query, ());
/// let (first, second) = (add(), add());
/// assert!(first < second && (first.uid(), second.uid()) == (0, 1));
/// world.remove(&[first]);
/// let third = world.add(Isometry::identity(), ball, CollisionGroups::new(), query, ());
/// assert_eq!(third.uid(), first.uid(), "the index is used again");
/// assert!(third != first && !world.contains(first), "the handle is not");
/// ```
///
/// [`CollisionWorld::counterpart`]: crate::world::CollisionWorld::counterpart
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CollisionObjectHandle {
    index: u32,
    generation: Generation,
}

impl CollisionObjectHandle {
    /// Creates the handle of the object with this index in the table and this generation.
    #[inline]
    pub(crate) const fn new(index: u32, generation: Generation) -> Self {
        Self { index, generation }
    }

    /// Returns the index in the handle table. Indices are dense, and in order of creation until the
    /// first removal.
    #[inline]
    #[must_use]
    pub const fn uid(&self) -> usize {
        self.index as usize
    }

    /// Returns the index in the handle table as the `u32` that the handle stores.
    #[inline]
    pub(crate) const fn index(self) -> u32 {
        self.index
    }

    /// Returns the generation, which identifies the world and, among all objects with this index,
    /// the object.
    #[inline]
    pub(crate) const fn generation(self) -> Generation {
        self.generation
    }
}

/// Two objects in canonical order, and whether their pair started (`true`) or stopped.
pub type Interaction = ((CollisionObjectHandle, CollisionObjectHandle), bool);
