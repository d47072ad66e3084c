//! The registry of code that a saved world refers to by name: pair filters, and shapes of users'
//! types.

use core::fmt;
use std::collections::BTreeMap;
use std::sync::Arc;

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use super::{RestoreError, SavedWorld};
use crate::math::Space;
use crate::shape::{SavedShape, ShapeHandle};
use crate::world::{BroadPhasePairFilter, CollisionWorld};

/// Creates a shape from its data; `None` if the data is invalid.
type MakeShape<N, const D: usize> = dyn Fn(&[u8]) -> Option<ShapeHandle<N, D>> + Send + Sync;

/// Pair filters and shapes of users' types, by name. A saved world refers to them by name, because
/// code cannot be saved. See [`SavedWorld`] and [`SavedShape`] for examples.
pub struct Registry<N: Space<D>, const D: usize, T> {
    shapes: BTreeMap<String, Box<MakeShape<N, D>>>,
    filters: BTreeMap<String, Arc<dyn BroadPhasePairFilter<N, D, T>>>,
}

impl<N: Space<D>, const D: usize, T> Registry<N, D, T> {
    /// Creates an empty registry.
    #[must_use]
    pub const fn new() -> Self {
        Self { shapes: BTreeMap::new(), filters: BTreeMap::new() }
    }

    /// Registers a shape type. `make` receives the data of
    /// [`Shape::saved`](crate::shape::Shape::saved), which may come from an untrusted source, and
    /// returns the shape; `None` if the data is invalid.
    #[must_use]
    pub fn with_shape<F>(mut self, name: &str, make: F) -> Self
    where
        F: Fn(&[u8]) -> Option<ShapeHandle<N, D>> + Send + Sync + 'static,
    {
        self.shapes.insert(name.to_owned(), Box::new(make));
        self
    }

    /// Registers a pair filter under a name, as
    /// [`register_broad_phase_pair_filter`](CollisionWorld::register_broad_phase_pair_filter) does.
    /// If its results differ from those of the saved world's filter, pairs change when they are
    /// filtered again.
    #[must_use]
    pub fn with_filter<F>(mut self, name: &str, filter: F) -> Self
    where
        F: BroadPhasePairFilter<N, D, T> + 'static,
    {
        self.filters.insert(name.to_owned(), Arc::new(filter));
        self
    }

    /// Deserializes and restores a world, with [`SavedWorld`] and [`SavedWorld::restore`].
    ///
    /// # Errors
    /// If the data does not have the format of a saved world, or if [`SavedWorld::restore`] fails.
    /// In the second case the error has only the text of the [`RestoreError`].
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
