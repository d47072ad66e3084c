//! Entry points of queries, generators, the narrow phase and the broad phase.

use super::{ByDimension, Here, compiled};
use crate::bounding_volume::Ray;
use crate::broad_phase::PairFinder;
use crate::collide::{Placed, mesh, separation};
use crate::convex::Separation;
#[cfg(feature = "debug_render")]
use crate::debug_render::Sketch;
use crate::math::{self, IsometryRef, Point, Pose, Vector};
use crate::narrow_phase::{
    self, CompositeState, ContactPrediction, ContactState, DefaultNarrowPhase, Events, IdAllocator,
    KeptContacts, ObjectTable, PairManifoldGenerator,
};
use crate::query::composite::{self, PartPoint, RayQuestion};
use crate::query::point::{self, SurfacePoint};
use crate::query::ray::{self, Answers, Span};
use crate::query::{
    self, ClosestPoints, Contact, ContactManifold, ContactPoint, Flight, Impact, ImpactOptions,
    ManifoldView, Moving, PointLocation, PointProjection, Proximity, RayBatch, RayIntersection,
    TrackedContact, Witness, impact_of_flight, impact_of_pair, time_of_pair,
    witness_in_world as witness_of_placed,
};
use crate::shape::{CompositeShape, FeatureId, Geometry, Kind, Shape};

compiled! {
    /// Entries that are always called, compiled once for each scalar and dimension.
    trait Entries;

    /// Computes the separation of two placed shapes in the world frame; `None` beyond `limit`.
    fn separation_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> = separation::in_world;

    /// Computes the deepest contact of two placed shapes in the world frame; `None` beyond `limit`.
    fn contact_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> = mesh::contact_in_world;

    /// Computes the separation of two placed shapes in the world frame; `None` beyond `limit`. For
    /// overlapping composites, returns the separation of any two overlapping parts.
    fn touching_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> = separation::touching_in_world;

    /// Computes the distance of two placed shapes, without points; `None` beyond `limit`. The
    /// result for an overlap is zero or negative.
    fn distance_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<N> = separation::distance_in_world;

    /// Computes the nearest points of two placed shapes, or the deepest points if they overlap;
    /// `None` beyond `limit`. Computes the features of these points if `with_features` is true.
    fn witness_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
        with_features: bool,
    ) -> Option<Witness<N, D>> = witness_of_placed;

    /// Computes the time at which two solids that translate first touch, and the contact at that
    /// time; `None` without an impact.
    fn impact(
        one: &Moving<'_, N, D>,
        other: &Moving<'_, N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<Impact<N, D>> = impact_of_pair;

    /// Computes the time at which two solids that translate first touch; `None` without an impact.
    fn time_of_impact(
        one: &Moving<'_, N, D>,
        other: &Moving<'_, N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<N> = time_of_pair;

    /// Computes the time at which two solids that translate and rotate first touch, and the contact
    /// at that time; `None` without an impact.
    fn nonlinear_impact(
        flight: &Flight<'_, N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<Impact<N, D>> = impact_of_flight;

    /// Computes [`ByDimension::ray_span`].
    fn ray_span(solid: Kind<'_, N, D>, ray: &Ray<N, D>) -> Option<Span<N, D>> =
        <Here as ByDimension<N, D>>::ray_span;

    /// Returns the point of the boundary of a solid that is nearest to a point.
    fn surface_point(solid: Kind<'_, N, D>, point: &Point<N, D>) -> SurfacePoint<N, D> =
        <Here as ByDimension<N, D>>::surface_point;

    /// Returns the part of a composite that is nearest to a point; `None` if there are no parts. If
    /// `touching` is true, any part that contains the point may be returned.
    fn nearest_part(
        parts: &dyn CompositeShape<N, D>,
        point: &Point<N, D>,
        touching: bool,
    ) -> Option<PartPoint<N, D>> = composite::nearest_part;

    /// Calls `found` with the first hit of a ray on each part of a composite. `found` returns the
    /// new maximum time of hits; a negative time ends the search.
    fn each_hit(
        parts: &dyn CompositeShape<N, D>,
        question: &RayQuestion<N, D>,
        found: &mut dyn FnMut(RayIntersection<N, D>) -> N,
    ) = composite::each_hit;

    /// Returns `true` if a ray meets a composite at or before `max_time`.
    fn is_crossed(parts: &dyn CompositeShape<N, D>, ray: &Ray<N, D>, max_time: N) -> bool =
        composite::is_crossed;

    /// Updates the contacts of a generator for a single pair.
    fn update_generator(
        generator: &mut PairManifoldGenerator<N, D>,
        isometries: [&<N as math::Space<D>>::Isometry; 2],
        shapes: [&dyn Shape<N, D>; 2],
        prediction: &ContactPrediction<N>,
        ids: &mut IdAllocator,
    ) = PairManifoldGenerator::refresh;

    /// Returns the manifolds of a generator in the public form; reuses the memory of `old`.
    fn read_generator(
        generator: &PairManifoldGenerator<N, D>,
        old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> = PairManifoldGenerator::read;

    /// Returns the manifold of two convex solids in the public form; reuses the memory of `old`.
    fn public_manifold(
        state: &ContactState<N, D>,
        placed: &[Placed<'_, N, D>; 2],
        pair_number: u64,
        old: ContactManifold<N, D>,
    ) -> ContactManifold<N, D> = ContactState::manifolds;

    /// Returns the manifolds of a pair with a composite in the public form; reuses the memory of
    /// `old`.
    fn composite_manifolds(
        state: &CompositeState<N, D>,
        placed: &[Placed<'_, N, D>; 2],
        pair_number: u64,
        old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> = CompositeState::manifolds;

    /// Converts a view to a manifold that owns its data, in the memory of `old`.
    fn manifold_of_view(
        view: &ManifoldView<'_, N, D>,
        old: ContactManifold<N, D>,
    ) -> ContactManifold<N, D> = ManifoldView::manifold_in;

    /// Returns contact `index` of a manifold view, with its kinematic.
    fn tracked_contact(view: &ManifoldView<'_, N, D>, index: usize) -> TrackedContact<N, D> =
        ManifoldView::tracked;

    /// Updates the contacts and proximities of a narrow phase, and records the events.
    fn update_pairs(
        narrow_phase: &mut DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        events: &mut Events,
    ) = DefaultNarrowPhase::update_pairs_here;

    /// Updates a broad phase. `may_meet` returns whether a pair is allowed; `changed` receives each
    /// pair that started (`true`) or stopped (`false`).
    fn find_pairs(
        finder: &mut PairFinder<N, D>,
        may_meet: &mut dyn FnMut(u32, u32) -> bool,
        changed: &mut dyn FnMut(u32, u32, bool),
    ) = PairFinder::update;

    /// Adds the lines and triangles of a convex solid to a sketch.
    #[cfg(feature = "debug_render")]
    fn sketch(solid: Kind<'_, N, D>, sketch: &mut Sketch<N, D>) = <Here as ByDimension<N, D>>::sketch;
}

compiled! {
    /// Entries that are small enough to be inlined in an optimised build.
    inlined trait SmallEntries;

    /// Converts an isometry to a pose.
    fn pose_of(isometry: IsometryRef<'_, N, D>) -> Pose<N, D> = math::pose_of;

    /// Computes the distance of two shapes.
    fn distance(
        isometry1: IsometryRef<'_, N, D>,
        shape1: &dyn Shape<N, D>,
        isometry2: IsometryRef<'_, N, D>,
        shape2: &dyn Shape<N, D>,
    ) -> N = query::distance_at;

    /// Computes the deepest contact of two shapes; `None` if they are farther apart than
    /// `prediction`.
    fn contact(
        isometry1: IsometryRef<'_, N, D>,
        shape1: &dyn Shape<N, D>,
        isometry2: IsometryRef<'_, N, D>,
        shape2: &dyn Shape<N, D>,
        prediction: N,
    ) -> Option<Contact<N, D>> = query::contact_at;

    /// Computes the nearest points of two shapes that are at most `max_distance` apart.
    fn closest_points(
        isometry1: IsometryRef<'_, N, D>,
        shape1: &dyn Shape<N, D>,
        isometry2: IsometryRef<'_, N, D>,
        shape2: &dyn Shape<N, D>,
        max_distance: N,
    ) -> ClosestPoints<N, D> = query::closest_points_at;

    /// Computes whether two shapes intersect, are at most `margin` apart, or are farther apart.
    fn proximity_at(
        isometry1: IsometryRef<'_, N, D>,
        shape1: &dyn Shape<N, D>,
        isometry2: IsometryRef<'_, N, D>,
        shape2: &dyn Shape<N, D>,
        margin: N,
    ) -> Proximity = query::proximity_at;

    /// Computes the nearest points of two shapes, or the deepest points if they overlap, with their
    /// parts and features; `None` beyond `max_distance`.
    fn witness(
        isometry1: IsometryRef<'_, N, D>,
        shape1: &dyn Shape<N, D>,
        isometry2: IsometryRef<'_, N, D>,
        shape2: &dyn Shape<N, D>,
        max_distance: N,
    ) -> Option<Witness<N, D>> = query::witness_at;

    /// Calls `each` with a view of each manifold of two shapes, computed without the contacts of an
    /// earlier step.
    fn each_contact_manifold(
        isometry1: IsometryRef<'_, N, D>,
        shape1: &dyn Shape<N, D>,
        isometry2: IsometryRef<'_, N, D>,
        shape2: &dyn Shape<N, D>,
        prediction: &ContactPrediction<N>,
        max_points: Option<usize>,
        each: &mut dyn FnMut(ManifoldView<'_, N, D>),
    ) = narrow_phase::each_manifold_at;

    /// Creates a shape at a pose that moves with a constant velocity.
    fn moving<'a>(
        isometry: IsometryRef<'_, N, D>,
        velocity: &Vector<N, D>,
        shape: &'a dyn Shape<N, D>,
    ) -> Moving<'a, N, D> = Moving::at;

    /// Returns the first hit of a ray at or before `max_time`, in the frame of the shape; `None` if
    /// there is none.
    fn cast_on(
        shape: Geometry<'_, N, D>,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> = ray::cast_on;

    /// Computes the first hits of many rays, in the frame of the shape.
    fn cast_many_on(
        shape: Geometry<'_, N, D>,
        batch: &RayBatch<'_, N, D>,
        answer: Answers<'_, N, D>,
    ) = ray::cast_many_on;

    /// Transforms a ray to the frame of a shape at `pose`.
    fn ray_within(ray: &Ray<N, D>, pose: &Pose<N, D>) -> Ray<N, D> = Ray::inverse_transformed_by;

    /// Rotates a direction to the world frame.
    fn rotated_vector(pose: &Pose<N, D>, local: &Vector<N, D>) -> Vector<N, D> = Pose::vector;

    /// Transforms a point to the frame of a shape at `pose`.
    fn point_within(pose: &Pose<N, D>, outer: &Point<N, D>) -> Point<N, D> = Pose::inverse_point;

    /// Returns the nearest point of the boundary of a shape, in its frame.
    fn project_on(
        shape: Geometry<'_, N, D>,
        point: &Point<N, D>,
    ) -> (PointProjection<N, D>, FeatureId) = point::project_on;

    /// Projects a point onto a shape, or onto its boundary if `solid` is false, and returns the
    /// location of the projection. All points are in the frame of the shape.
    fn locate_on(
        shape: Geometry<'_, N, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> (PointProjection<N, D>, PointLocation<N>) = point::locate_on;

    /// Returns the distance of a point in the frame of a shape from the shape's boundary, negative
    /// inside.
    fn signed_distance_on(shape: Geometry<'_, N, D>, point: &Point<N, D>) -> N =
        point::signed_distance_on;

    /// Returns `true` if a shape contains a point in the frame of the shape.
    fn holds(shape: Geometry<'_, N, D>, point: &Point<N, D>) -> bool = point::holds;

    /// Transforms the projection of `point` from the frame of a shape at `pose` to the world frame.
    fn placed_projection(
        local: &PointProjection<N, D>,
        pose: &Pose<N, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> PointProjection<N, D> = point::placed;

    /// Returns the normal of a manifold view twice: as stored, and in the world frame.
    fn own_normal(view: &ManifoldView<'_, N, D>) -> [Vector<N, D>; 2] = ManifoldView::own_normal;

    /// Returns contact `index` of a manifold view, in the world frame.
    fn contact_of_view(
        view: &ManifoldView<'_, N, D>,
        index: usize,
        normal: &[Vector<N, D>; 2],
    ) -> ContactPoint<N, D> = ManifoldView::contact;
}
