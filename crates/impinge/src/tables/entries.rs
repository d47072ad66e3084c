//! The entries of queries and of pairs.

use super::{ByDimension, Here, compiled};
use crate::bounding_volume::Ray;
use crate::broad_phase::PairFinder;
use crate::collide::{ManifoldRequest, Placed, mesh, separation};
use crate::convex::Separation;
#[cfg(feature = "debug_render")]
use crate::debug_render::Sketch;
use crate::math::Point;
use crate::narrow_phase::{
    CompositeState, ContactState, DefaultNarrowPhase, Events, KeptContacts, ObjectTable, Posed,
    proximity_of,
};
use crate::query::composite::{self, PartPoint, RayQuestion};
use crate::query::point::SurfacePoint;
use crate::query::ray::Span;
use crate::query::{
    ContactManifold, Flight, Impact, ImpactOptions, ManifoldView, Moving, Proximity,
    RayIntersection, TrackedContact, Witness, impact_of_flight, impact_of_pair, time_of_pair,
    witness_in_world as witness_of_placed,
};
use crate::shape::{CompositeShape, Kind};

compiled! {
    /// Queries and pairs.
    trait Entries;

    /// The separation of two placed shapes, up to a limit.
    fn separation_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> = separation::in_world;

    /// Their deepest contact.
    fn contact_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> = mesh::contact_in_world;

    /// Their separation, or any overlap of their parts.
    fn touching_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> = separation::touching_in_world;

    /// Their distance alone.
    fn distance_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
    ) -> Option<N> = separation::distance_in_world;

    /// Their nearest points; the flag asks for features, too.
    fn witness_in_world(
        one: &Placed<'_, N, D>,
        other: &Placed<'_, N, D>,
        limit: N,
        with_features: bool,
    ) -> Option<Witness<N, D>> = witness_of_placed;

    /// When two solids that move along lines touch, and where.
    fn impact(
        one: &Moving<'_, N, D>,
        other: &Moving<'_, N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<Impact<N, D>> = impact_of_pair;

    /// When they touch.
    fn time_of_impact(
        one: &Moving<'_, N, D>,
        other: &Moving<'_, N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<N> = time_of_pair;

    /// When two solids that turn touch, and where.
    fn nonlinear_impact(
        flight: &Flight<'_, N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<Impact<N, D>> = impact_of_flight;

    /// When the line of a ray is inside a solid.
    fn ray_span(solid: Kind<'_, N, D>, ray: &Ray<N, D>) -> Option<Span<N, D>> =
        <Here as ByDimension<N, D>>::ray_span;

    /// The point of the boundary of a solid that is nearest to a point.
    fn surface_point(solid: Kind<'_, N, D>, point: &Point<N, D>) -> SurfacePoint<N, D> =
        <Here as ByDimension<N, D>>::surface_point;

    /// The part of a composite that is nearest to a point; any that holds it with the flag.
    fn nearest_part(
        parts: &dyn CompositeShape<N, D>,
        point: &Point<N, D>,
        touching: bool,
    ) -> Option<PartPoint<N, D>> = composite::nearest_part;

    /// Visits each part of a composite that a ray hits.
    fn each_hit(
        parts: &dyn CompositeShape<N, D>,
        question: &RayQuestion<N, D>,
        found: &mut dyn FnMut(RayIntersection<N, D>) -> N,
    ) = composite::each_hit;

    /// A ray meets a composite by a time.
    fn is_crossed(parts: &dyn CompositeShape<N, D>, ray: &Ray<N, D>, max_time: N) -> bool =
        composite::is_crossed;

    /// Updates the contacts of two convex solids.
    fn update_contacts(
        state: &mut ContactState<N, D>,
        posed: &Posed<'_, N, D>,
        request: &ManifoldRequest<N>,
    ) = ContactState::update;

    /// Their manifold as users keep it, in the memory of `old`.
    fn public_manifold(
        state: &ContactState<N, D>,
        posed: &Posed<'_, N, D>,
        pair_number: u64,
        old: ContactManifold<N, D>,
    ) -> ContactManifold<N, D> = ContactState::manifolds;

    /// Updates the contacts of two shapes with a composite among them.
    fn update_composites(
        state: &mut CompositeState<N, D>,
        posed: &Posed<'_, N, D>,
        request: &ManifoldRequest<N>,
    ) = CompositeState::update;

    /// Their manifolds as users keep them, in the memory of `old`.
    fn composite_manifolds(
        state: &CompositeState<N, D>,
        posed: &Posed<'_, N, D>,
        pair_number: u64,
        old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> = CompositeState::manifolds;

    /// A contact of a manifold that is read in place, with its kinematic.
    fn tracked_contact(view: &ManifoldView<'_, N, D>, index: usize) -> TrackedContact<N, D> =
        ManifoldView::tracked;

    /// Whether two shapes intersect, are within a margin, or farther apart.
    fn proximity(posed: &Posed<'_, N, D>, margin: N) -> Proximity = proximity_of;

    /// The step of a narrow phase.
    fn update_pairs(
        narrow_phase: &mut DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        events: &mut Events,
    ) = DefaultNarrowPhase::update_pairs_here;

    /// The step of a broad phase: what is pending, the filter, and what hears of changes.
    fn find_pairs(
        finder: &mut PairFinder<N, D>,
        may_meet: &mut dyn FnMut(u32, u32) -> bool,
        changed: &mut dyn FnMut(u32, u32, bool),
    ) = PairFinder::update;

    /// Adds the drawing of a convex solid to a mesh.
    #[cfg(feature = "debug_render")]
    fn sketch(solid: Kind<'_, N, D>, sketch: &mut Sketch<N, D>) = <Here as ByDimension<N, D>>::sketch;
}
