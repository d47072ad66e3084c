//! Worlds for queries, and the same queries of every single object.

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::broad_phase::{BroadPhase, BroadPhaseError, DBVTBroadPhase, ProxyHandle};
use impinge::math::{
    AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Unit, Vector,
};
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::query::{
    ClosestPoints, Impact, ImpactOptions, Moving, PointProjection, PointQuery, Ray, RayCast,
    RayIntersection, closest_points, distance, impact,
};
use impinge::shape::{
    Ball, Capsule, Compound, Cuboid, Plane, Segment, Shape, ShapeHandle, Triangle,
};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld, NearObject, QueryFilter};
use impinge_reference::random::Random;

/// A world whose objects have a serial number as data.
pub(crate) type World<N, const D: usize> = CollisionWorld<N, D, usize>;
pub(crate) type Object<N, const D: usize> = CollisionObject<N, D, usize>;
pub(crate) type Filter<'a, N, const D: usize> = QueryFilter<'a, N, D, usize>;

/// A scalar and dimension in which queries of one solid and of two are available.
pub(crate) trait Stage<const D: usize>: Space<D> {
    fn pose_at(coordinates: [f64; D], turn: f64) -> Self::Isometry;
    fn distance(solid1: Placed<'_, Self, D>, solid2: Placed<'_, Self, D>) -> Self;
    fn closest(
        solid1: Placed<'_, Self, D>,
        solid2: Placed<'_, Self, D>,
        max: Self,
    ) -> ClosestPoints<Self, D>;
    fn ray(
        solid: Placed<'_, Self, D>,
        ray: &Ray<Self, D>,
        is_solid: bool,
    ) -> Option<RayIntersection<Self, D>>;
    fn project(
        solid: Placed<'_, Self, D>,
        point: &Point<Self, D>,
        is_solid: bool,
    ) -> (PointProjection<Self, D>, Self);
    fn impact(
        moving: (Placed<'_, Self, D>, Vector<Self, D>),
        still: Placed<'_, Self, D>,
        options: &ImpactOptions<Self>,
    ) -> Option<Impact<Self, D>>;
}

/// A pose and the solid at it.
pub(crate) type Placed<'a, N, const D: usize> =
    (&'a <N as Space<D>>::Isometry, &'a dyn Shape<N, D>);

impl<N: Real> Stage<2> for N {
    fn pose_at([x, y]: [f64; 2], turn: f64) -> Isometry2<N> {
        Isometry2::new(vector([x, y]), N::lit(turn))
    }
    fn distance(a: Placed<'_, N, 2>, b: Placed<'_, N, 2>) -> N {
        distance(a.0, a.1, b.0, b.1)
    }
    fn closest(a: Placed<'_, N, 2>, b: Placed<'_, N, 2>, max: N) -> ClosestPoints<N, 2> {
        closest_points(a.0, a.1, b.0, b.1, max)
    }
    fn ray(a: Placed<'_, N, 2>, ray: &Ray<N, 2>, is_solid: bool) -> Option<RayIntersection<N, 2>> {
        cast(a.0, a.1, ray, is_solid)
    }
    fn project(a: Placed<'_, N, 2>, p: &Point<N, 2>, is_solid: bool) -> (PointProjection<N, 2>, N) {
        project(a.0, a.1, p, is_solid)
    }
    fn impact(
        (a, velocity): (Placed<'_, N, 2>, Vector<N, 2>),
        b: Placed<'_, N, 2>,
        options: &ImpactOptions<N>,
    ) -> Option<Impact<N, 2>> {
        impact(&Moving::new(a.0, &velocity, a.1), &Moving::still(b.0, b.1), options)
    }
}

impl<N: Real> Stage<3> for N {
    fn pose_at([x, y, z]: [f64; 3], turn: f64) -> Isometry3<N> {
        Isometry3::new(vector([x, y, z]), vector([0.3 * turn, turn, -turn]))
    }
    fn distance(a: Placed<'_, N, 3>, b: Placed<'_, N, 3>) -> N {
        distance(a.0, a.1, b.0, b.1)
    }
    fn closest(a: Placed<'_, N, 3>, b: Placed<'_, N, 3>, max: N) -> ClosestPoints<N, 3> {
        closest_points(a.0, a.1, b.0, b.1, max)
    }
    fn ray(a: Placed<'_, N, 3>, ray: &Ray<N, 3>, is_solid: bool) -> Option<RayIntersection<N, 3>> {
        cast(a.0, a.1, ray, is_solid)
    }
    fn project(a: Placed<'_, N, 3>, p: &Point<N, 3>, is_solid: bool) -> (PointProjection<N, 3>, N) {
        project(a.0, a.1, p, is_solid)
    }
    fn impact(
        (a, velocity): (Placed<'_, N, 3>, Vector<N, 3>),
        b: Placed<'_, N, 3>,
        options: &ImpactOptions<N>,
    ) -> Option<Impact<N, 3>> {
        impact(&Moving::new(a.0, &velocity, a.1), &Moving::still(b.0, b.1), options)
    }
}

fn cast<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    pose: &Isometry<N, R, D>,
    shape: &dyn Shape<N, D>,
    ray: &Ray<N, D>,
    is_solid: bool,
) -> Option<RayIntersection<N, D>> {
    shape.toi_and_normal_with_ray(pose, ray, is_solid)
}

fn project<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    pose: &Isometry<N, R, D>,
    shape: &dyn Shape<N, D>,
    point: &Point<N, D>,
    is_solid: bool,
) -> (PointProjection<N, D>, N) {
    let signed = shape.distance_to_point(pose, point, is_solid);
    (shape.project_point(pose, point, is_solid), signed.abs())
}

pub(crate) fn vector<N: Real, const D: usize>(coordinates: [f64; D]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(coordinates[axis]))
}

pub(crate) fn point<N: Real, const D: usize>(coordinates: [f64; D]) -> Point<N, D> {
    Point::from(vector(coordinates))
}

/// Returns the coordinates of the point at `x` on the first axis.
pub(crate) fn on_x<const D: usize>(x: f64) -> [f64; D] {
    core::array::from_fn(|axis| if axis == 0 { x } else { 0.0 })
}

pub(crate) fn placed<N: Space<D>, const D: usize>(object: &Object<N, D>) -> Placed<'_, N, D> {
    (object.position(), &**object.shape())
}

/// Returns a random shape of a kind that exists in both dimensions, of a size from 0 to about 2, or
/// a compound of three.
pub(crate) fn random_shape<N: Stage<D>, const D: usize>(random: &mut Random) -> ShapeHandle<N, D> {
    if random.below(8) == 0 {
        let mut child = || {
            let pose = N::pose_at(random.vector::<D>(1.5), random.range(-3.0, 3.0));
            (pose, random_solid(random))
        };
        return ShapeHandle::new(Compound::new(vec![child(), child(), child()]));
    }
    random_solid(random)
}

fn random_solid<N: Space<D>, const D: usize>(random: &mut Random) -> ShapeHandle<N, D> {
    let size = N::lit(random.range(0.0, 2.0));
    let corner = |random: &mut Random| point(random.vector::<D>(2.0));
    match random.below(6) {
        0 | 1 => ShapeHandle::new(Ball::new(size)),
        2 => ShapeHandle::new(Cuboid::new(vector(random.vector::<D>(2.0).map(f64::abs)))),
        3 => ShapeHandle::new(Capsule::<N, D>::new(N::lit(random.range(0.0, 2.0)), size)),
        4 => ShapeHandle::new(Segment::new(corner(random), corner(random))),
        _ => ShapeHandle::new(Triangle::new(corner(random), corner(random), corner(random))),
    }
}

/// Returns the half-space of points whose last coordinate is at most zero.
pub(crate) fn ground<N: Space<D>, const D: usize>() -> ShapeHandle<N, D> {
    let up = Vector::<N, D>::from_fn(|axis, _| if axis + 1 == D { N::ONE } else { N::ZERO });
    ShapeHandle::new(Plane::new(Unit::new_unchecked(up)))
}

pub(crate) fn contacts<N: Real>() -> GeometricQueryType<N> {
    GeometricQueryType::Contacts(N::lit(0.01), N::ZERO)
}

/// Adds an object without rotation that may interact with every object; its data are its serial
/// number.
pub(crate) fn add<N: Stage<D>, const D: usize>(
    world: &mut World<N, D>,
    coordinates: [f64; D],
    shape: &ShapeHandle<N, D>,
) -> CollisionObjectHandle {
    let number = world.len();
    let position = N::pose_at(coordinates, 0.0);
    world.add(position, shape.clone(), CollisionGroups::new(), contacts(), number)
}

/// The handle of an object and its result; results of queries are compared as lists of rows.
pub(crate) type Row<A> = (CollisionObjectHandle, A);

pub(crate) fn rows<N: Space<D>, const D: usize, A>(found: Vec<(&Object<N, D>, A)>) -> Vec<Row<A>> {
    found.into_iter().map(|(object, answer)| (object.handle(), answer)).collect()
}

pub(crate) fn neighbors<N: Space<D>, const D: usize>(
    found: &[NearObject<'_, N, D, usize>],
) -> Vec<Row<(N, ClosestPoints<N, D>)>> {
    found.iter().map(|near| (near.object.handle(), (near.distance, near.points))).collect()
}

/// The library's broad phase with the provided methods of the trait instead of its own, so without
/// ordered searches.
#[derive(Clone, Debug)]
pub(crate) struct Unordered<N: Space<D>, const D: usize>(
    DBVTBroadPhase<N, Aabb<N, D>, CollisionObjectHandle>,
);

impl<N: Space<D>, const D: usize> Unordered<N, D> {
    pub(crate) fn new() -> Self {
        Self(DBVTBroadPhase::new(N::lit(0.1)))
    }
}

type Handle = CollisionObjectHandle;

impl<N: Space<D>, const D: usize> BroadPhase<N, Aabb<N, D>, Handle> for Unordered<N, D> {
    fn try_create_proxy(
        &mut self,
        bv: Aabb<N, D>,
        data: Handle,
    ) -> Result<ProxyHandle, BroadPhaseError> {
        self.0.try_create_proxy(bv, data)
    }
    fn try_remove(
        &mut self,
        handles: &[ProxyHandle],
        callback: &mut dyn FnMut(&Handle, &Handle),
    ) -> Result<(), BroadPhaseError> {
        self.0.try_remove(handles, callback)
    }
    fn try_deferred_set_bounding_volume(
        &mut self,
        handle: ProxyHandle,
        bv: Aabb<N, D>,
    ) -> Result<(), BroadPhaseError> {
        self.0.try_deferred_set_bounding_volume(handle, bv)
    }
    fn try_deferred_recompute_all_proximities_with(
        &mut self,
        handle: ProxyHandle,
    ) -> Result<(), BroadPhaseError> {
        self.0.try_deferred_recompute_all_proximities_with(handle)
    }
    fn deferred_recompute_all_proximities(&mut self) {
        self.0.deferred_recompute_all_proximities();
    }
    fn update(
        &mut self,
        filter: &mut dyn FnMut(&Handle, &Handle) -> bool,
        callback: &mut dyn FnMut(&Handle, &Handle, bool),
    ) {
        self.0.update(filter, callback);
    }
    fn interferences_with_bounding_volume<'a>(
        &'a self,
        bv: &Aabb<N, D>,
        out: &mut Vec<&'a Handle>,
    ) {
        self.0.interferences_with_bounding_volume(bv, out);
    }
    fn interferences_with_ray<'a>(
        &'a self,
        ray: &<Aabb<N, D> as BoundingVolume<N>>::Ray,
        out: &mut Vec<&'a Handle>,
    ) {
        self.0.interferences_with_ray(ray, out);
    }
    fn interferences_with_point<'a>(&'a self, point: &Point<N, D>, out: &mut Vec<&'a Handle>) {
        self.0.interferences_with_point(point, out);
    }
    fn num_interferences(&self) -> usize {
        self.0.num_interferences()
    }
    fn proxy(&self, handle: ProxyHandle) -> Option<(&Aabb<N, D>, &Handle)> {
        self.0.proxy(handle)
    }
}
