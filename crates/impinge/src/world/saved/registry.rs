//! The registry of what a saved world names instead of holding: filters, and shapes of the user.

use core::fmt;
use std::collections::BTreeMap;
use std::sync::Arc;

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use super::{RestoreError, SavedWorld};
use crate::math::Space;
use crate::shape::{SavedShape, ShapeHandle};
use crate::world::{BroadPhasePairFilter, CollisionWorld};

/// Makes a shape of its data.
type MakeShape<N, const D: usize> = dyn Fn(&[u8]) -> Option<ShapeHandle<N, D>> + Send + Sync;

/// Shapes of the user's own types and pair filters, by name: what is code, and not data. See [`SavedWorld`] and
/// [`SavedShape`] for examples.
pub struct Registry<N: Space<D>, const D: usize, T> {
    shapes: BTreeMap<String, Box<MakeShape<N, D>>>,
    filters: BTreeMap<String, Arc<dyn BroadPhasePairFilter<N, D, T>>>,
}

impl<N: Space<D>, const D: usize, T> Registry<N, D, T> {
    /// Names nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self { shapes: BTreeMap::new(), filters: BTreeMap::new() }
    }

    /// Names a type of shapes: `make` gets the data of [`Shape::saved`](crate::shape::Shape::saved), which may come from
    /// anywhere, and returns the shape, or `None` where the data is of none.
    #[must_use]
    pub fn with_shape<F>(mut self, name: &str, make: F) -> Self
    where
        F: Fn(&[u8]) -> Option<ShapeHandle<N, D>> + Send + Sync + 'static,
    {
        self.shapes.insert(name.to_owned(), Box::new(make));
        self
    }

    /// Names a pair filter, as [`register_broad_phase_pair_filter`](CollisionWorld::register_broad_phase_pair_filter)
    /// does. A filter that answers otherwise than it did makes pairs other ones once they are filtered again.
    #[must_use]
    pub fn with_filter<F>(mut self, name: &str, filter: F) -> Self
    where
        F: BroadPhasePairFilter<N, D, T> + 'static,
    {
        self.filters.insert(name.to_owned(), Arc::new(filter));
        self
    }

    /// Reads a world: in one call [`SavedWorld`] and [`SavedWorld::restore`].
    ///
    /// # Errors
    /// If the format does not find the fields of a world, or they make none; the latter as a text.
    pub fn restore<'de, De: Deserializer<'de>>(
        &self,
        deserializer: De,
    ) -> Result<CollisionWorld<N, D, T>, De::Error>
    where
        T: Deserialize<'de>,
    {
        SavedWorld::deserialize(deserializer)?.restore(self).map_err(De::Error::custom)
    }

    pub(super) fn shape(&self, saved: &SavedShape) -> Result<ShapeHandle<N, D>, RestoreError> {
        let name = || saved.name.clone();
        let make =
            self.shapes.get(&saved.name).ok_or_else(|| RestoreError::UnknownShape(name()))?;
        make(&saved.data).ok_or_else(|| RestoreError::RefusedShape(name()))
    }

    pub(super) fn filter(
        &self,
        name: &str,
    ) -> Result<Arc<dyn BroadPhasePairFilter<N, D, T>>, RestoreError> {
        let filter = self.filters.get(name).cloned();
        filter.ok_or_else(|| RestoreError::UnknownFilter(name.to_owned()))
    }
}

impl<N: Space<D>, const D: usize, T> Default for Registry<N, D, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Space<D>, const D: usize, T> fmt::Debug for Registry<N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (shapes, filters) = (self.shapes.keys(), self.filters.keys());
        f.debug_struct("Registry")
            .field("shapes", &shapes.collect::<Vec<_>>())
            .field("filters", &filters.collect::<Vec<_>>())
            .finish()
    }
}
