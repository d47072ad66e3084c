//! The items of which a recording contains only the names: shapes of user-defined types, and pair
//! filters.

use core::fmt;
use std::collections::BTreeMap;
use std::sync::Arc;

use impinge::math::Space;
use impinge::shape::ShapeHandle;
use impinge::world::{BroadPhasePairFilter, CollisionWorld};

/// A function that registers a filter in a world.
type Register<N, const D: usize, T> = Arc<dyn Fn(&mut CollisionWorld<N, D, T>) + Send + Sync>;

/// Shapes of user-defined types and pair filters, by name. A recording contains only the names. The
/// program that replays it must register equal shapes and filters under the same names.
///
/// ```
/// use impinge::dim2::world::CollisionObject;
/// use impinge_record::Registry;
///
/// type Object = CollisionObject<f64, u32>;
/// let registry = Registry::<f64, 2, u32>::new()
///     .with_filter("odd", |a: &Object, b: &Object| (a.data() + b.data()) % 2 == 1);
/// assert!(registry.has_filter("odd") && !registry.has_filter("even"));
/// ```
pub struct Registry<N: Space<D>, const D: usize, T> {
    shapes: BTreeMap<String, ShapeHandle<N, D>>,
    filters: BTreeMap<String, Register<N, D, T>>,
}

impl<N: Space<D>, const D: usize, T> Registry<N, D, T> {
    /// Creates an empty registry.
    #[must_use]
    pub const fn new() -> Self {
        Self { shapes: BTreeMap::new(), filters: BTreeMap::new() }
    }

    /// Adds a shape under a name. The name stands for this handle and its clones.
    #[must_use]
    pub fn with_shape(mut self, name: &str, shape: ShapeHandle<N, D>) -> Self {
        self.shapes.insert(name.to_owned(), shape);
        self
    }

    /// Adds a pair filter under a name.
    #[must_use]
    pub fn with_filter<F>(mut self, name: &str, filter: F) -> Self
    where
        F: BroadPhasePairFilter<N, D, T> + Clone + 'static,
    {
        let own = name.to_owned();
        let register = move |world: &mut CollisionWorld<N, D, T>| {
            world.register_broad_phase_pair_filter(&own, filter.clone());
        };
        self.filters.insert(name.to_owned(), Arc::new(register));
        self
    }

    /// Returns `true` if a filter has this name.
    #[must_use]
    pub fn has_filter(&self, name: &str) -> bool {
        self.filters.contains_key(name)
    }

    /// Returns the shape with this name; `None` if there is none.
    #[must_use]
    pub fn shape(&self, name: &str) -> Option<&ShapeHandle<N, D>> {
        self.shapes.get(name)
    }

    /// Returns the name of a shape: the first one in alphabetical order if it has several, `None`
    /// if it has none.
    pub(crate) fn name_of(&self, shape: &ShapeHandle<N, D>) -> Option<&str> {
        let mut shapes = self.shapes.iter();
        shapes.find(|(_, own)| own.is_same(shape)).map(|(name, _)| name.as_str())
    }

    /// Registers the filter with this name in a world; returns `false` if there is none.
    pub(crate) fn register(&self, name: &str, world: &mut CollisionWorld<N, D, T>) -> bool {
        let register = self.filters.get(name);
        if let Some(register) = register {
            register(world);
        }
        register.is_some()
    }
}

impl<N: Space<D>, const D: usize, T> Default for Registry<N, D, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Space<D>, const D: usize, T> Clone for Registry<N, D, T> {
    fn clone(&self) -> Self {
        Self { shapes: self.shapes.clone(), filters: self.filters.clone() }
    }
}

impl<N: Space<D>, const D: usize, T> fmt::Debug for Registry<N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let filters: Vec<_> = self.filters.keys().collect();
        f.debug_struct("Registry").field("shapes", &self.shapes).field("filters", &filters).finish()
    }
}
