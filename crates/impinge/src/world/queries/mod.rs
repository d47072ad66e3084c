//! Queries among all objects of a world: with rays, points, boxes, solids at rest and moving
//! solids.
//!
//! The broad phase proposes objects with their boxes as of the last update. A tree of dirty objects
//! proposes the objects whose boxes have changed since. So queries respect every change at once.
//! Each proposed object is then tested exactly by the queries for one or two solids.

pub(super) mod cast;
mod filter;
mod point;
mod ranking;
mod ray;
mod search;
pub(super) mod shape;
mod single_object;

use core::fmt;

pub use filter::QueryFilter;
use smallvec::SmallVec;

use self::search::WorldProbe;
use super::{CollisionObject, CollisionWorld};
use crate::bounding_volume::Aabb;
use crate::math::Space;
use crate::query::ClosestPoints;

/// Number of objects that a query collects without allocating.
const INLINE: usize = 16;

/// An object near the point or solid of a query.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter};
///
/// let mut world = CollisionWorld::new(0.02_f32);
/// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// world.add(Isometry::translation(5.0, 0.0), ball, CollisionGroups::new(), query, "tree");
/// let (probe, here) = (Ball::new(1.0), Isometry::identity());
/// let found = world.nearest_objects(&here, &probe, 1, 10.0, &QueryFilter::new());
/// assert_eq!((*found[0].object.data(), found[0].distance), ("tree", 3.0));
/// ```
pub struct NearObject<'a, N: Space<D>, const D: usize, T> {
    /// The object.
    pub object: &'a CollisionObject<N, D, T>,
    /// The distance: zero if the object touches or overlaps the query's point or solid.
    pub distance: N,
    /// The nearest points in the world frame: first on the query's point or solid, then on the
    /// object. Never [`ClosestPoints::Disjoint`].
    pub points: ClosestPoints<N, D>,
}

impl<N: Space<D>, const D: usize, T> Clone for NearObject<'_, N, D, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<N: Space<D>, const D: usize, T> Copy for NearObject<'_, N, D, T> {}

impl<N: Space<D>, const D: usize, T> fmt::Debug for NearObject<'_, N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NearObject")
            .field("object", &self.object.handle())
            .field("distance", &self.distance)
            .field("points", &self.points)
            .finish()
    }
}

/// Functions by which queries find the objects to test.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the objects that the filter allows and whose boxes have a key ([`WorldProbe`]) of at
    /// most `limit`, each once, in order of their handles. A few objects with a larger key may be
    /// included, so the caller must test each object exactly.
    fn matching<'a>(
        &'a self,
        probe: &WorldProbe<N, D>,
        limit: N,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        let mut objects: SmallVec<[&'a CollisionObject<N, D, T>; INLINE]> = SmallVec::new();
        self.any_matching(probe, limit, |object| {
            objects.push(object);
            false
        });
        objects.retain(|object| self.allows(object, filter));
        objects.sort_unstable_by_key(|object| object.body.handle);
        objects.into_iter()
    }

    /// Returns `true` if `passes` returns `true` for an object whose box has a key ([`WorldProbe`])
    /// of at most `limit`. `passes` may also be called for a few objects with a larger key. It is
    /// called at most once for each object, and not again after it has returned `true`.
    fn any_matching<'a>(
        &'a self,
        probe: &WorldProbe<N, D>,
        limit: N,
        mut passes: impl FnMut(&'a CollisionObject<N, D, T>) -> bool,
    ) -> bool {
        if matches!(probe, WorldProbe::Near(aabb) if !aabb.holds_finite_point()) {
            // No tree search visits boxes at infinity, so all objects are tested.
            return self.objects.iter().any(passes);
        }
        let mut is_found = false;
        self.propose(probe, limit, |object, limit| {
            is_found = passes(object);
            if is_found { -N::ONE } else { limit }
        });
        is_found
    }

    /// Returns the objects that the filter allows and whose boxes may overlap `aabb`, in order of
    /// their handles. The caller must test each object exactly.
    fn overlapping_aabb<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        self.matching(&WorldProbe::Near(*aabb), N::ZERO, filter)
    }
}
