//! Shape casts among the objects of a world.

use super::QueryFilter;
use super::ranking::RankRange;
use super::search::WorldProbe;
use super::shape::placed_aabb;
use crate::collide::Placed;
use crate::math::{Space, Vector, max};
use crate::query::{Impact, ImpactOptions, Moving, impact};
use crate::shape::Shape;
use crate::world::bodies::{WorldBody, grown};
use crate::world::entries;
use crate::world::{CollisionObject, CollisionWorld};

/// Shape casts: a solid moves through the world along a straight line, without rotation, while the
/// objects of the world are at rest.
///
/// An [`Impact`] is in the world frame, with both solids at the time of impact; its first solid is
/// the moving one. Contacts at time zero follow the rules of [`impact`]: by default, a solid that
/// moves away from an object does not hit it. If a number of the position or velocity is not
/// finite, nothing is hit.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the object that a moving solid hits first, and the impact; at equal times the object
    /// with the smallest handle. `None` if the solid hits nothing by the maximum time of `options`.
    ///
    /// Costs a tree search, and an [`impact`] for a few objects whose boxes lie on the path.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point, Vector};
    /// use impinge::dim2::query::ImpactOptions;
    /// use impinge::dim2::shape::{Ball, Cuboid, ShapeHandle};
    /// use impinge::dim2::world::{
    ///     CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f64);
    /// let (post, contacts) = (
    ///     ShapeHandle::new(Cuboid::new(Vector::new(0.5, 1.0))),
    ///     GeometricQueryType::Contacts(0.0, 0.0),
    /// );
    /// for (x, y) in [(9.0, 0.0), (5.0, 0.0), (3.0, 4.0)] {
    ///     let position = Isometry::translation(x, y);
    ///     world.add(position, post.clone(), CollisionGroups::new(), contacts, x);
    /// }
    ///
    /// let (start, velocity, ball) = (Isometry::identity(), Vector::new(2.0, 0.0), Ball::new(0.5));
    /// let (options, all) = (ImpactOptions::new(), QueryFilter::new());
    /// let hit = world.cast_shape(&start, &velocity, &ball, &options, &all);
    /// let (object, impact) = hit.expect("two are in the way");
    /// assert_eq!((*object.data(), impact.toi), (5.0, 2.0));
    /// assert_eq!(impact.world2, Point::new(4.5, 0.0), "on the object");
    /// assert_eq!(impact.normal.x, 1.0, "towards the object");
    ///
    /// let short = options.with_max_time(1.0);
    /// assert!(world.cast_shape(&start, &velocity, &ball, &short, &all).is_none());
    /// assert_eq!(world.cast_shape_all(&start, &velocity, &ball, &options, &all).len(), 2);
    /// ```
    #[must_use]
    pub fn cast_shape(
        &self,
        position: &N::Isometry,
        velocity: &Vector<N, D>,
        shape: &dyn Shape<N, D>,
        options: &ImpactOptions<N>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Option<(&CollisionObject<N, D, T>, Impact<N, D>)> {
        let cast = entries::new_cast(position, velocity, shape, options)?;
        let found = self.best(&cast.probe, options.max_time, filter, &|body, latest| {
            entries::cast_impact(&cast, body, latest)
        });
        found.map(|(object, _, impact)| (object, impact))
    }

    /// Returns all objects that a solid hits if it moves on through every object, each with its
    /// first impact, in ascending order of time, then of handle. See [`Self::cast_shape`] for the
    /// arguments.
    #[must_use]
    pub fn cast_shape_all(
        &self,
        position: &N::Isometry,
        velocity: &Vector<N, D>,
        shape: &dyn Shape<N, D>,
        options: &ImpactOptions<N>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<(&CollisionObject<N, D, T>, Impact<N, D>)> {
        let Some(cast) = entries::new_cast(position, velocity, shape, options) else {
            return Vec::new();
        };
        self.ranked_impacts(&cast, RankRange::for_all(options.max_time), filter)
    }

    fn ranked_impacts(
        &self,
        cast: &Cast<'_, N, D>,
        range: RankRange<N>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<(&CollisionObject<N, D, T>, Impact<N, D>)> {
        let found = self.rank(&cast.probe, range, filter, &|body, latest| {
            entries::cast_impact(cast, body, latest)
        });
        found.into_iter().map(|(object, _, impact)| (object, impact)).collect()
    }
}

/// A moving solid, and the probe for the boxes on its path.
pub(crate) struct Cast<'a, N: Space<D>, const D: usize> {
    probe: WorldProbe<N, D>,
    moving: Moving<'a, N, D>,
    options: ImpactOptions<N>,
}

impl<'a, N: Space<D>, const D: usize> Cast<'a, N, D> {
    /// Creates the cast; `None` if the position or velocity is not finite.
    pub(crate) fn new(
        position: &N::Isometry,
        velocity: &Vector<N, D>,
        shape: &'a dyn Shape<N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<Self> {
        let aabb = placed_aabb(position, shape)?;
        let grown_aabb = grown(&aabb, max(options.target_distance, N::ZERO));
        let placed = Placed::of_isometry(position, shape.geometry());
        let is_finite = velocity.iter().all(|x| x.is_finite_number());
        is_finite.then_some(Self {
            probe: WorldProbe::Cast(grown_aabb, *velocity),
            moving: Moving { placed, velocity: *velocity },
            options: *options,
        })
    }
}

impl<N: Space<D>, const D: usize> Cast<'_, N, D> {
    /// Returns the time of the first impact with an object, and the impact; `None` if there is none
    /// by `latest`.
    pub(crate) fn impact(&self, body: &WorldBody<N, D>, latest: N) -> Option<(N, Impact<N, D>)> {
        let options = self.options.with_max_time(latest);
        let at_rest = Vector::<N, D>::zeros();
        let found = body.ask(|shape| {
            let placed = Placed::of_isometry(&body.isometry, shape);
            let object = Moving { placed, velocity: at_rest };
            impact(&self.moving, &object, &options)
        })?;
        Some((found.toi, found))
    }
}
