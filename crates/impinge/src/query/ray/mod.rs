//! Ray queries.
//!
//! The solids are convex, so the line of a ray is inside during a single span of time. Each shape's
//! file computes that span, most in closed form; [`span`] converts it to the result for a solid or
//! a hollow shape. One table per dimension (`ray2`, `ray3`) has the algorithm of each shape.

mod ball;
mod batch;
mod capsule;
mod clip;
mod cone;
mod cuboid;
mod cylinder;
mod ellipsoid;
pub(crate) mod mesh3;
mod passing;
mod plane;
mod polytope;
pub(crate) mod ray2;
pub(crate) mod ray3;
mod rounded;
mod segment;
mod span;
mod support_map;
mod tapered_capsule;
mod triangle2;
mod triangle3;
mod volume;

use crate::tables::{ByDimension, entries};
pub use batch::RayBatch;
use passing::may_hold;
pub(crate) use passing::surely_misses;
pub(crate) use span::Span;

use core::cmp::Ordering;

use super::PointProjection;
use super::composite::RayQuestion;
use super::point::length;
use crate::bounding_volume::Ray;
use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, Space, Vector, max_component};
use crate::shape::{CompositeShape, FeatureId, Geometry, Kind, Shape};

/// The first hit of a ray on a solid: its time and geometry.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point, Vector};
/// use impinge::dim2::query::{Ray, RayCast};
/// use impinge::dim2::shape::Ball;
///
/// let ray = Ray::new(Point::new(-5.0_f32, 0.0), Vector::new(2.0, 0.0));
/// let hit = Ball::new(1.0).toi_and_normal_with_ray(&Isometry::identity(), &ray, true);
/// let hit = hit.expect("straight ahead");
/// assert_eq!((hit.toi, ray.point_at(hit.toi), hit.normal), (2.0, Point::new(-1.0, 0.0), -Vector::x()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayIntersection<N: Real, const D: usize> {
    /// The time of impact, zero or more, in units of the length of the ray's direction: the hit
    /// point is `ray.point_at(toi)`.
    pub toi: N,
    /// The outward unit normal of the solid at the hit point, in the frame of the query. The normal
    /// points out of the solid also where a ray leaves a hollow shape. On a set without thickness
    /// it points against the ray.
    ///
    /// The normal is zero if the ray of a solid query starts inside, or on the boundary and leads
    /// out; if a ray starts on a side or thin set and runs along it; or if its direction is zero.
    pub normal: Vector<N, D>,
    /// The feature that was hit. A hit on a vertex or an edge may have the id of one of the faces
    /// there. A ray that starts inside a solid has the nearer of the two features ahead and behind.
    pub feature: FeatureId,
    /// The index of the composite's part that was hit, which has the feature; 0 for a convex solid.
    pub part: u32,
}

/// Queries of a ray and a solid; implemented for every [`Shape`].
///
/// With `solid`, a shape is the set with its interior: a ray that starts inside or on the boundary
/// hits at time zero. Without `solid` a shape is its boundary alone, and a ray that starts inside
/// hits where it leaves. A ray that only touches the boundary hits. A ray whose direction is zero
/// is a point: it hits at time zero if that point is in the set. A ray that is not finite hits
/// nothing.
///
/// Sets without thickness (segments; triangles in 3D) are hit where the ray meets them within
/// rounding: a few units in the last place of the distances involved.
///
/// A composite is the union of its parts, and the ray is cast against each part separately. With
/// `solid`, a ray that starts in a part, or inside a [solid](crate::shape::TriMesh::solid) mesh or
/// polyline, hits at time zero. Without `solid`, the boundaries of all parts are hit, also inside
/// other parts. Of parts hit at the same time, the lowest index is returned. Parts whose common
/// corners are bitwise equal, as in a mesh or a height field, leave no gap: a ray through a common
/// side or corner hits at least one of them, however far from the origin (Woop, Benthin and Wald,
/// "Watertight Ray/Triangle Intersection", 2013). The cost is a search for the parts along the ray,
/// up to the hit; [`Self::intersects_ray`] ends at any part that is hit.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::{Ray, RayCast};
/// use impinge::dim3::shape::Cuboid;
///
/// let (cube, place) = (Cuboid::new(Vector::repeat(1.0_f32)), Isometry::translation(5.0, 0.0, 0.0));
/// let ray = Ray::new(Point::origin(), Vector::x());
/// assert_eq!(cube.toi_with_ray(&place, &ray, true), Some(4.0));
/// assert!(cube.first_hit_with_ray(&place, &ray, 3.0, true).is_none(), "too short");
/// let inner = Ray::new(Point::new(5.0, 0.0, 0.0), Vector::x());
/// assert_eq!(cube.toi_with_ray(&place, &inner, true), Some(0.0), "solid");
/// assert_eq!(cube.toi_with_ray(&place, &inner, false), Some(1.0), "where it leaves");
/// ```
pub trait RayCast<N: Space<D>, const D: usize> {
    /// Returns the result of [`Self::cast_local_ray_until`] with an infinite `max_time`.
    fn cast_local_ray(&self, ray: &Ray<N, D>, solid: bool) -> Option<RayIntersection<N, D>> {
        self.cast_local_ray_until(ray, N::INFINITY, solid)
    }

    /// Returns the first hit in the local frame, if it is at `max_time` or before. `None` if there
    /// is none, and if `max_time` is negative or NaN. The time is in units of the ray's direction.
    ///
    /// The results of all other methods agree with the results of this method.
    #[doc(alias = "cast_local_ray")]
    fn cast_local_ray_until(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
    ) -> Option<RayIntersection<N, D>>;

    /// Runs [`Self::cast_local_ray_until`] for many rays. `hits[i]` becomes the result for
    /// `batch.rays[i]`, bitwise equal, also on several threads with the feature `parallel`.
    ///
    /// ```
    /// use impinge::dim3::math::{Point, Vector};
    /// use impinge::dim3::query::Ray;
    /// use impinge::dim3::shape::Ball;
    /// use impinge::query::{RayBatch, RayCast};
    ///
    /// let rays = [0.0, 0.5, 3.0].map(|y| Ray::new(Point::new(-4.0_f32, y, 0.0), Vector::x()));
    /// let mut hits = [None; 3];
    /// Ball::new(1.0).cast_local_rays(&RayBatch::new(&rays).until(10.0), &mut hits);
    /// assert_eq!(hits[0].map(|hit| hit.toi), Some(3.0));
    /// assert_eq!(hits[1], Ball::new(1.0).cast_local_ray(&rays[1], true));
    /// assert_eq!(hits[2], None, "it passes above");
    /// ```
    ///
    /// # Panics
    /// If `hits` does not have as many entries as there are rays.
    #[track_caller]
    fn cast_local_rays(
        &self,
        batch: &RayBatch<'_, N, D>,
        hits: &mut [Option<RayIntersection<N, D>>],
    ) {
        let RayBatch { max_time, solid, .. } = *batch;
        batch.each(hits, |ray| self.cast_local_ray_until(ray, max_time, solid));
    }

    /// Runs [`Self::first_hit_with_ray`] for many rays; see [`Self::cast_local_rays`].
    ///
    /// # Panics
    /// If `hits` does not have as many entries as there are rays.
    #[track_caller]
    fn cast_rays<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        batch: &RayBatch<'_, N, D>,
        hits: &mut [Option<RayIntersection<N, D>>],
    ) {
        let pose = R::view(m).pose();
        let local: Vec<_> = batch.rays.iter().map(|r| r.inverse_transformed_by(&pose)).collect();
        self.cast_local_rays(&RayBatch { rays: &local, ..*batch }, hits);
        for hit in hits.iter_mut().flatten() {
            hit.normal = entries::rotated_vector(&pose, &hit.normal);
        }
    }

    /// Returns the first hit on each part of a composite up to `max_time`, sorted by time and then
    /// by part index, in the local frame. For a convex solid the result is its first hit.
    ///
    /// Each part has one hit: where the ray enters it, or at time zero if the ray starts in it.
    /// Without `solid`, a part in which the ray starts is hit where the ray leaves it.
    fn local_ray_hits(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
    ) -> Vec<RayIntersection<N, D>> {
        self.cast_local_ray_until(ray, max_time, solid).into_iter().collect()
    }

    /// Returns whether the ray, given in the local frame, hits the solid up to `max_time`.
    fn intersects_local_ray(&self, ray: &Ray<N, D>, max_time: N) -> bool {
        self.cast_local_ray_until(ray, max_time, true).is_some()
    }

    /// Returns the result of [`Self::first_hit_with_ray`] with an infinite `max_time`.
    fn toi_and_normal_with_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> {
        self.first_hit_with_ray(m, ray, N::INFINITY, solid)
    }

    /// Returns the first hit up to `max_time` on the solid placed at `m`, with its normal in the
    /// world frame. `None` if there is none, and if `max_time` is negative or NaN. The time is in
    /// units of the ray's direction.
    #[doc(alias = "toi_and_normal_with_ray")]
    fn first_hit_with_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> {
        cast_at(self, &R::view(m).pose(), ray, max_time, solid)
    }

    /// Returns the first hit up to `max_time` on the shape placed at `m` for which `counts` is
    /// true. For a composite, `counts` is called with the first hits on its parts, each at most
    /// once and in no particular order; for a convex solid with its first hit. The normals are in
    /// the world frame.
    ///
    /// Use it to cull back faces: a ray hits a triangle in 3D on `Face(0)` from the front, where
    /// its corners appear counter-clockwise, and on `Face(1)` from behind.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Point, Vector};
    /// use impinge::dim3::query::{Ray, RayCast};
    /// use impinge::dim3::shape::{Cuboid, FeatureId, TriMesh};
    /// use impinge::procedural::space;
    ///
    /// let surface = space::cuboid(&Cuboid::new(Vector::repeat(1.0_f32)));
    /// let (room, here) = (TriMesh::try_from(surface).expect("good triangles"), Isometry::identity());
    /// let ray = Ray::new(Point::new(-3.0, 0.25, 0.5), Vector::x());
    /// let hit = |is_seen: fn(FeatureId) -> bool| {
    ///     let found = room.first_hit_where(&here, &ray, 10.0, true, |hit| is_seen(hit.feature));
    ///     found.map(|hit| (hit.toi, hit.normal.x))
    /// };
    /// assert_eq!(hit(|_| true), Some((2.0, -1.0)), "the near wall");
    /// assert_eq!(hit(|feature| feature != FeatureId::Face(0)), Some((4.0, -1.0)), "the far wall, from inside");
    /// assert_eq!(hit(|feature| feature != FeatureId::Face(1)), Some((2.0, -1.0)), "from outside");
    /// ```
    fn first_hit_where<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
        counts: impl Fn(&RayIntersection<N, D>) -> bool,
    ) -> Option<RayIntersection<N, D>> {
        self.all_hits_with_ray(m, ray, max_time, solid).into_iter().find(|hit| counts(hit))
    }

    /// Returns the hits of [`Self::local_ray_hits`] on the shape placed at `m`, in the world frame.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Point, Vector};
    /// use impinge::dim3::query::Ray;
    /// use impinge::dim3::shape::Ball;
    /// use impinge::query::RayCast;
    ///
    /// let (ball, place) = (Ball::new(1.0_f32), Isometry::translation(5.0, 0.0, 0.0));
    /// let ray = Ray::new(Point::origin(), Vector::x());
    /// let hits = ball.all_hits_with_ray(&place, &ray, 10.0, true);
    /// assert_eq!(hits.len(), 1, "a convex solid has one part");
    /// assert_eq!((hits[0].toi, hits[0].part, hits[0].normal), (4.0, 0, -Vector::x()));
    /// assert!(ball.all_hits_with_ray(&place, &ray, 3.0, true).is_empty(), "too early");
    /// ```
    fn all_hits_with_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
    ) -> Vec<RayIntersection<N, D>> {
        let pose = R::view(m).pose();
        let mut hits = self.local_ray_hits(&entries::ray_within(ray, &pose), max_time, solid);
        hits.iter_mut().for_each(|hit| hit.normal = entries::rotated_vector(&pose, &hit.normal));
        hits
    }

    /// Returns the time of the hit of [`Self::first_hit_with_ray`] with an infinite `max_time`.
    fn toi_with_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        solid: bool,
    ) -> Option<N> {
        let local = entries::ray_within(ray, &R::view(m).pose());
        self.cast_local_ray(&local, solid).map(|hit| hit.toi)
    }

    /// Returns whether the ray hits the solid placed at `m`.
    fn intersects_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
    ) -> bool {
        let local = entries::ray_within(ray, &R::view(m).pose());
        self.intersects_local_ray(&local, N::INFINITY)
    }
}

impl<N: Space<D>, const D: usize, S: Shape<N, D> + ?Sized> RayCast<N, D> for S {
    fn cast_local_ray_until(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> {
        entries::cast_on(self.geometry(), ray, max_time, solid)
    }

    fn cast_local_rays(
        &self,
        batch: &RayBatch<'_, N, D>,
        hits: &mut [Option<RayIntersection<N, D>>],
    ) {
        batch.each_chunk(hits, |batch, hits| {
            entries::cast_many_on(self.geometry(), batch, &mut |number, hit| hits[number] = hit);
        });
    }

    fn local_ray_hits(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
    ) -> Vec<RayIntersection<N, D>> {
        let Some(parts) = self.geometry().as_composite() else {
            return self.cast_local_ray_until(ray, max_time, solid).into_iter().collect();
        };
        let mut hits = Vec::new();
        entries::each_hit(parts, &RayQuestion { ray: *ray, max_time, solid }, &mut |hit| {
            hits.push(hit);
            max_time
        });
        hits.sort_unstable_by(
            |a, b| {
                if is_before(a, b) { Ordering::Less } else { Ordering::Greater }
            },
        );
        hits
    }

    fn first_hit_where<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
        counts: impl Fn(&RayIntersection<N, D>) -> bool,
    ) -> Option<RayIntersection<N, D>> {
        let pose = R::view(m).pose();
        let local = entries::ray_within(ray, &pose);
        let in_world = |hit: RayIntersection<N, D>| RayIntersection {
            normal: entries::rotated_vector(&pose, &hit.normal),
            ..hit
        };
        let counts = |hit: &RayIntersection<N, D>| counts(&in_world(*hit));
        let first = match self.geometry().as_composite() {
            Some(parts) => first_that(parts, &RayQuestion { ray: local, max_time, solid }, counts),
            None => self.cast_local_ray_until(&local, max_time, solid).filter(counts),
        };
        first.map(in_world)
    }

    fn intersects_local_ray(&self, ray: &Ray<N, D>, max_time: N) -> bool {
        let Some(parts) = self.geometry().as_composite() else {
            return self.cast_local_ray_until(ray, max_time, true).is_some();
        };
        let mut hits = false;
        entries::each_hit(parts, &RayQuestion { ray: *ray, max_time, solid: true }, &mut |_| {
            hits = true;
            -N::ONE
        });
        hits
    }
}

/// Implements [`RayCast::first_hit_with_ray`] for a pose.
#[inline]
pub(crate) fn cast_at<N: Space<D>, const D: usize>(
    shape: &(impl RayCast<N, D> + ?Sized),
    pose: &Pose<N, D>,
    ray: &Ray<N, D>,
    max_time: N,
    solid: bool,
) -> Option<RayIntersection<N, D>> {
    let local = ray.inverse_transformed_by(pose);
    let hit = shape.cast_local_ray_until(&local, max_time, solid)?;
    Some(RayIntersection { normal: entries::rotated_vector(pose, &hit.normal), ..hit })
}

/// Implements [`RayCast::cast_local_ray_until`].
#[inline]
pub(crate) fn cast_on<N: Space<D>, const D: usize>(
    geometry: Geometry<'_, N, D>,
    ray: &Ray<N, D>,
    max_time: N,
    solid: bool,
) -> Option<RayIntersection<N, D>> {
    let kind = geometry.0;
    if let Kind::Composite(parts) = kind {
        let question = RayQuestion { ray: *ray, max_time, solid };
        return match parts.as_mesh() {
            Some(mesh) => <N::Algorithms>::first_on_mesh(mesh, &question),
            None => first_that(parts, &question, |_| true),
        };
    }
    let surface_point = |point: &_| entries::surface_point(kind, point).projection(point);
    let project = |point: &_| may_hold(kind, point).then(|| surface_point(point));
    let hit = cast(ray, solid, project, |ray| entries::ray_span(kind, ray));
    hit.filter(|hit| hit.toi <= max_time)
}

/// The callback for the result of a ray, given the ray's index.
pub(crate) type Answers<'a, N, const D: usize> =
    &'a mut dyn FnMut(usize, Option<RayIntersection<N, D>>);

/// Runs [`cast_on`] for each ray of a batch, in no particular order.
pub(crate) fn cast_many_on<N: Space<D>, const D: usize>(
    geometry: Geometry<'_, N, D>,
    batch: &RayBatch<'_, N, D>,
    answer: Answers<'_, N, D>,
) {
    let mesh = geometry.as_composite().and_then(CompositeShape::as_mesh);
    if mesh.is_some_and(|mesh| <N::Algorithms>::first_hits_on_mesh(mesh, batch, answer)) {
        return;
    }
    let RayBatch { rays, max_time, solid } = *batch;
    for (number, ray) in rays.iter().enumerate() {
        answer(number, cast_on(geometry, ray, max_time, solid));
    }
}

/// Returns the earliest hit that `counts` accepts; in a tie, on the part of lowest index.
#[inline]
pub(crate) fn first_that<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    question: &RayQuestion<N, D>,
    counts: impl Fn(&RayIntersection<N, D>) -> bool,
) -> Option<RayIntersection<N, D>> {
    let mut first: Option<RayIntersection<N, D>> = None;
    entries::each_hit(parts, question, &mut |hit| {
        let is_first = first.is_none_or(|first| is_before(&hit, &first));
        first = if is_first && counts(&hit) { Some(hit) } else { first };
        first.map_or(question.max_time, |first| first.toi)
    });
    first
}

/// Returns whether hit `a` is earlier than `b`, or at the same time on a part with a lower index.
/// The hits must be on different parts, and no time may be NaN.
fn is_before<N: Real, const D: usize>(
    a: &RayIntersection<N, D>,
    b: &RayIntersection<N, D>,
) -> bool {
    a.toi < b.toi || (a.toi == b.toi && a.part < b.part)
}

/// Returns the hit of a ray that starts in the set: at time zero, without a normal.
pub(crate) fn at_start<N: Real, const D: usize>(feature: FeatureId) -> RayIntersection<N, D> {
    RayIntersection { toi: N::ZERO, normal: Vector::<N, D>::zeros(), feature, part: 0 }
}

/// Implements the common part of all casts: non-finite and zero directions, and scaling.
///
/// `project` is called if the ray may start inside; it may return `None` if it starts outside.
/// `span` is called for finite rays whose direction was divided by a power of two, so that its
/// largest component is between 1 and 2 and its powers stay in range.
fn cast<N: Real, const D: usize>(
    ray: &Ray<N, D>,
    solid: bool,
    project: impl FnOnce(&Point<N, D>) -> Option<(PointProjection<N, D>, FeatureId)>,
    span: impl FnOnce(&Ray<N, D>) -> Option<Span<N, D>>,
) -> Option<RayIntersection<N, D>> {
    if !ray.origin.iter().chain(ray.dir.iter()).all(|x| x.is_finite_number()) {
        return None;
    }
    let speed = max_component(&ray.dir);
    if speed == N::ZERO {
        let (nearest, feature) = project(&ray.origin)?;
        let on_boundary = length(&(ray.origin - nearest.point)) == N::ZERO;
        let hits = if solid { nearest.is_inside } else { on_boundary };
        return hits.then(|| at_start(feature));
    }
    let unit = speed.power_of_two_below();
    let hit = span(&Ray::new(ray.origin, ray.dir / unit)).and_then(|span| span.first_hit(solid));
    let Some(hit) = hit else {
        // By rounding, a crossing at the start may seem to be before the start.
        let start = if solid { project(&ray.origin) } else { None };
        return start
            .filter(|(nearest, _)| nearest.is_inside)
            .map(|(_, feature)| at_start(feature));
    };
    let toi = hit.toi / unit;
    toi.is_finite_number().then_some(RayIntersection { toi, ..hit })
}
