//! Queries as data, and their results.

use impinge::bounding_volume::{Aabb, Ray};
use impinge::math::{Point, Space, Vector};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::query::{ClosestPoints, Impact, ImpactOptions, PointProjection, RayIntersection};
use impinge::shape::ShapeHandle;
use impinge::world::{CollisionGroups, CollisionWorld, NearObject, QueryFilter};

use crate::digest::Digest;
use crate::space::Recordable;

/// The kind of a query with its arguments. Each variant corresponds to a method of
/// [`CollisionWorld`](impinge::world::CollisionWorld).
#[derive(Clone, Debug)]
pub enum Question<N: Space<D>, const D: usize> {
    /// A query by `first_ray_hit`.
    FirstRayHit(RayQuestion<N, D>),
    /// A query by `ray_hits`.
    RayHits(RayQuestion<N, D>),
    /// A query by `objects_containing`.
    Containing(Point<N, D>),
    /// A query by `project_point`. Unless `solid`, a point inside an object is projected to its
    /// boundary.
    ProjectPoint {
        /// The point.
        point: Point<N, D>,
        /// The maximum distance of a result.
        max_distance: N,
        /// Whether a point inside is its own projection.
        solid: bool,
    },
    /// A query by `objects_in_aabb`.
    InAabb(Aabb<N, D>),
    /// A query by `objects_overlapping`.
    Overlapping(PlacedShape<N, D>),
    /// A query by `nearest_objects`.
    Nearest {
        /// The shape from which distances are measured.
        from: PlacedShape<N, D>,
        /// The maximum number of objects.
        count: u32,
        /// The maximum distance of a result.
        max_distance: N,
    },
    /// A query by `cast_shape`.
    CastShape(CastQuestion<N, D>),
    /// A query by `cast_shape_all`.
    CastShapeAll(CastQuestion<N, D>),
}

/// The arguments of a ray cast.
#[derive(Clone, Copy, Debug)]
pub struct RayQuestion<N: Space<D>, const D: usize> {
    /// The ray.
    pub ray: Ray<N, D>,
    /// The maximum time of a hit.
    pub max_time: N,
    /// Whether rays that begin inside a solid hit it at time zero.
    pub solid: bool,
}

/// A shape and its position.
#[derive(Clone, Debug)]
pub struct PlacedShape<N: Space<D>, const D: usize> {
    /// The position, in the world frame.
    pub position: N::Isometry,
    /// The shape.
    pub shape: ShapeHandle<N, D>,
}

/// The arguments of a shape cast.
#[derive(Clone, Debug)]
pub struct CastQuestion<N: Space<D>, const D: usize> {
    /// The shape at the start of its motion.
    pub start: PlacedShape<N, D>,
    /// The velocity, in the world frame.
    pub velocity: Vector<N, D>,
    /// The options of the cast, such as the maximum time and the target distance.
    pub options: ImpactOptions<N>,
}

/// A query with its filter.
///
/// A predicate is code and cannot be recorded, so the filter consists of groups and excluded
/// objects. [`Recorder::ask_where`](crate::Recorder::ask_where) converts a predicate to excluded
/// objects.
#[derive(Clone, Debug)]
pub struct Query<N: Space<D>, const D: usize> {
    /// The kind of the query with its arguments.
    pub question: Question<N, D>,
    /// The groups of the query; `None` admits all objects.
    pub groups: Option<CollisionGroups>,
    /// The excluded objects; stale handles are ignored.
    pub excluded: Vec<CollisionObjectHandle>,
}

impl<N: Space<D>, const D: usize> Query<N, D> {
    /// Creates a query that admits all objects.
    #[must_use]
    pub const fn new(question: Question<N, D>) -> Self {
        Self { question, groups: None, excluded: Vec::new() }
    }
}

/// A query of a recording, and its result in the replayed world.
#[derive(Clone, Debug)]
pub struct Asked<N: Space<D>, const D: usize> {
    /// The query.
    pub query: Query<N, D>,
    /// The result, computed by the replay.
    pub answer: Vec<Found<N, D>>,
    /// Whether the result is equal to the recorded one, to the bit.
    pub is_same: bool,
}

/// An object in the result of a query.
#[derive(Clone, Copy, Debug)]
pub struct Found<N: Space<D>, const D: usize> {
    /// The object.
    pub handle: CollisionObjectHandle,
    /// The data that the query computed for it.
    pub detail: Detail<N, D>,
}

/// The data that a query computes for an object.
#[derive(Clone, Copy, Debug)]
pub enum Detail<N: Space<D>, const D: usize> {
    /// No data: the query returns only the objects at a point, in a box or overlapping a shape.
    Object,
    /// The hit of a ray.
    Ray(RayIntersection<N, D>),
    /// The projection of a point.
    Projection(PointProjection<N, D>),
    /// The distance between an object and the shape of the query, and their closest points.
    Near {
        /// The distance.
        distance: N,
        /// The closest points.
        points: ClosestPoints<N, D>,
    },
    /// The impact of a shape cast.
    Impact(Impact<N, D>),
}

impl<N: Space<D>, const D: usize> Found<N, D> {
    const fn object(handle: CollisionObjectHandle) -> Self {
        Self { handle, detail: Detail::Object }
    }

    const fn near<T>(near: &NearObject<'_, N, D, T>) -> Self {
        let detail = Detail::Near { distance: near.distance, points: near.points };
        Self { handle: near.object.handle(), detail }
    }
}

impl<N: Space<D>, const D: usize> Query<N, D> {
    /// Runs the query in a world. The results are in the order of the corresponding method.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point};
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    /// use impinge_record::{Query, Question};
    ///
    /// let mut world = CollisionWorld::<f32, ()>::new(0.02);
    /// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// let ball = world.add(Isometry::identity(), ball, CollisionGroups::new(), query, ());
    /// let found = Query::new(Question::Containing(Point::new(0.5, 0.0))).ask(&world);
    /// assert_eq!(found[0].handle, ball);
    /// ```
    #[must_use]
    pub fn ask<T>(&self, world: &CollisionWorld<N, D, T>) -> Vec<Found<N, D>> {
        let mut filter = QueryFilter::new();
        for &handle in &self.excluded {
            filter = filter.exclude(handle);
        }
        if let Some(groups) = self.groups {
            filter = filter.groups(groups);
        }
        self.question.ask(world, &filter)
    }
}

impl<N: Space<D>, const D: usize> Question<N, D> {
    fn ask<T>(
        &self,
        world: &CollisionWorld<N, D, T>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<Found<N, D>> {
        match self {
            Self::FirstRayHit(RayQuestion { ray, max_time, solid }) => {
                let hit = world.first_ray_hit(ray, *max_time, *solid, filter);
                let found = hit.map(|(object, hit)| (object.handle(), Detail::Ray(hit)));
                found.into_iter().map(Found::from).collect()
            }
            Self::RayHits(RayQuestion { ray, max_time, solid }) => {
                let hits = world.ray_hits(ray, *max_time, *solid, filter).into_iter();
                hits.map(|(object, hit)| (object.handle(), Detail::Ray(hit)).into()).collect()
            }
            Self::Containing(point) => {
                let objects = world.objects_containing(point, filter);
                objects.map(|object| Found::object(object.handle())).collect()
            }
            Self::ProjectPoint { point, max_distance, solid } => {
                let found = world.project_point(point, *max_distance, *solid, filter);
                let found = found.map(|(object, at)| (object.handle(), Detail::Projection(at)));
                found.into_iter().map(Found::from).collect()
            }
            Self::InAabb(aabb) => {
                let objects = world.objects_in_aabb(aabb, filter);
                objects.map(|object| Found::object(object.handle())).collect()
            }
            Self::Overlapping(PlacedShape { position, shape }) => {
                let objects = world.objects_overlapping(position, &**shape, filter);
                objects.map(|object| Found::object(object.handle())).collect()
            }
            Self::Nearest { from: PlacedShape { position, shape }, count, max_distance } => {
                let count = *count as usize;
                let near = world.nearest_objects(position, &**shape, count, *max_distance, filter);
                near.iter().map(Found::near).collect()
            }
            Self::CastShape(CastQuestion { start, velocity, options }) => {
                let PlacedShape { position, shape } = start;
                let hit = world.cast_shape(position, velocity, &**shape, options, filter);
                let found = hit.map(|(object, impact)| (object.handle(), Detail::Impact(impact)));
                found.into_iter().map(Found::from).collect()
            }
            Self::CastShapeAll(CastQuestion { start, velocity, options }) => {
                let PlacedShape { position, shape } = start;
                let hits = world.cast_shape_all(position, velocity, &**shape, options, filter);
                let found = hits.into_iter();
                found.map(|(object, hit)| (object.handle(), Detail::Impact(hit)).into()).collect()
            }
        }
    }
}

impl<N: Space<D>, const D: usize> From<(CollisionObjectHandle, Detail<N, D>)> for Found<N, D> {
    fn from((handle, detail): (CollisionObjectHandle, Detail<N, D>)) -> Self {
        Self { handle, detail }
    }
}

/// Returns the hash of a result: of the indices of its objects and all bits of their details.
pub(crate) fn answer_hash<N: Recordable<D>, const D: usize>(answer: &[Found<N, D>]) -> u64 {
    let mut digest = Digest::new();
    for found in answer {
        digest.index(found.handle.uid());
        digest_detail(&found.detail, &mut digest);
    }
    digest.finish()
}

fn digest_detail<N: Recordable<D>, const D: usize>(detail: &Detail<N, D>, digest: &mut Digest) {
    match detail {
        Detail::Object => {}
        Detail::Ray(hit) => {
            digest.numbers(&[hit.toi]);
            digest.numbers(hit.normal.as_slice());
            digest.feature(hit.feature);
            digest.word(u64::from(hit.part));
        }
        Detail::Projection(at) => {
            digest.word(u64::from(at.is_inside));
            digest.numbers(at.point.coords.as_slice());
        }
        Detail::Near { distance, points } => {
            digest.numbers(&[*distance]);
            if let ClosestPoints::WithinMargin(point1, point2) = points {
                digest.numbers(point1.coords.as_slice());
                digest.numbers(point2.coords.as_slice());
            }
        }
        Detail::Impact(impact) => {
            digest.numbers(&[impact.toi]);
            digest.numbers(impact.world1.coords.as_slice());
            digest.numbers(impact.world2.coords.as_slice());
            digest.numbers(impact.normal.as_slice());
            digest.feature(impact.feature1);
            digest.feature(impact.feature2);
            digest.word(u64::from(impact.part1));
            digest.word(u64::from(impact.part2));
        }
    }
}
