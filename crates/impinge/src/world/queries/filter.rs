//! Filters that select the objects that a query considers.

use core::fmt;

use smallvec::SmallVec;

use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;
use crate::world::{CollisionGroups, CollisionObject};

/// Selects the objects that a query considers. Without conditions it selects all.
///
/// A query tests boxes first, then groups, excluded objects and the predicate, and exact geometry
/// last. `into()` converts [`CollisionGroups`] to a filter that has no other condition.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point, Vector};
/// use impinge::dim2::query::Ray;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{
///     CollisionGroups, CollisionObject, CollisionWorld, GeometricQueryType, QueryFilter,
/// };
///
/// let mut world = CollisionWorld::new(0.02_f32);
/// let (ball, proximity) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// let handles = [0.0, 10.0, 20.0].map(|x| {
///     let position = Isometry::translation(x, 0.0);
///     world.add(position, ball.clone(), CollisionGroups::new(), proximity, x)
/// });
///
/// let ray = Ray::new(Point::origin(), Vector::x());
/// let first = |filter: &QueryFilter<'_, f32, f32>| {
///     world.first_ray_hit(&ray, f32::INFINITY, true, filter).map(|(object, _)| *object.data())
/// };
/// assert_eq!(first(&QueryFilter::new()), Some(0.0), "it starts in this one");
/// let others = QueryFilter::new().exclude(handles[0]);
/// assert_eq!(first(&others), Some(10.0));
/// let is_far = |object: &CollisionObject<f32, f32>| *object.data() > 10.0;
/// assert_eq!(first(&QueryFilter::new().predicate(&is_far)), Some(20.0));
/// let mut nobody = CollisionGroups::new();
/// nobody.set_whitelist(&[]);
/// assert_eq!(first(&nobody.into()), None);
/// ```
pub struct QueryFilter<'a, N: Space<D>, const D: usize, T> {
    groups: Option<CollisionGroups>,
    excluded: SmallVec<[CollisionObjectHandle; 2]>,
    predicate: Option<&'a Predicate<'a, N, D, T>>,
}

/// A function of the user that returns whether a query considers an object.
type Predicate<'a, N, const D: usize, T> = dyn Fn(&CollisionObject<N, D, T>) -> bool + 'a;

impl<'a, N: Space<D>, const D: usize, T> QueryFilter<'a, N, D, T> {
    /// Creates a filter that allows all objects, whatever their groups.
    #[must_use]
    pub fn new() -> Self {
        Self { groups: None, excluded: SmallVec::new(), predicate: None }
    }

    /// Allows only objects that may interact with `groups`; replaces earlier groups.
    #[must_use]
    pub fn groups(self, groups: CollisionGroups) -> Self {
        Self { groups: Some(groups), ..self }
    }

    /// Excludes one more object, such as the object for which the query runs. A stale handle
    /// excludes nothing. To exclude more than a few objects, a predicate is faster.
    #[must_use]
    pub fn exclude(mut self, handle: CollisionObjectHandle) -> Self {
        self.excluded.push(handle);
        self
    }

    /// Allows only objects for which `predicate` returns `true`; replaces an earlier predicate.
    ///
    /// A query calls it at most once for each object, in unspecified order, and not for all
    /// objects.
    #[must_use]
    pub fn predicate(self, predicate: &'a dyn Fn(&CollisionObject<N, D, T>) -> bool) -> Self {
        Self { predicate: Some(predicate), ..self }
    }

    /// Returns `true` if groups and exclusions allow the object.
    #[inline]
    pub(super) fn admits(&self, handle: CollisionObjectHandle, groups: &CollisionGroups) -> bool {
        let can_interact = self.groups.is_none_or(|own| own.can_interact_with_groups(groups));
        can_interact && !self.excluded.contains(&handle)
    }

    /// Returns `true` if the predicate allows the object.
    pub(super) fn accepts(&self, object: &CollisionObject<N, D, T>) -> bool {
        self.predicate.is_none_or(|predicate| predicate(object))
    }
}

impl<N: Space<D>, const D: usize, T> Default for QueryFilter<'_, N, D, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Space<D>, const D: usize, T> Clone for QueryFilter<'_, N, D, T> {
    fn clone(&self) -> Self {
        Self { excluded: self.excluded.clone(), ..*self }
    }
}

impl<N: Space<D>, const D: usize, T> From<CollisionGroups> for QueryFilter<'_, N, D, T> {
    fn from(groups: CollisionGroups) -> Self {
        Self::new().groups(groups)
    }
}

impl<N: Space<D>, const D: usize, T> From<&CollisionGroups> for QueryFilter<'_, N, D, T> {
    fn from(groups: &CollisionGroups) -> Self {
        Self::from(*groups)
    }
}

impl<N: Space<D>, const D: usize, T> fmt::Debug for QueryFilter<'_, N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("QueryFilter")
            .field("groups", &self.groups)
            .field("excluded", &self.excluded)
            .field("has_predicate", &self.predicate.is_some())
            .finish()
    }
}
