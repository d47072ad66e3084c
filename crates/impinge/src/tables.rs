//! The entry points that are compiled here rather than in the caller.
//!
//! Generic code is compiled where it is first used with concrete types. These `static`s use the hot
//! entry points with all four combinations of scalar and dimension, so that they are compiled in
//! this crate, at this crate's optimisation level; callers reach them by function pointer. This
//! module is the one place that floors below may see of floors above.

use core::fmt;

use crate::batch::{BatchTables, SolidGroup, update_group2, update_group3};
use crate::bounding_volume::{Aabb, Ray};
use crate::broad_phase::{DBVTBroadPhase, PairFinder};
use crate::checker::CheckerTables;
use crate::collide::far::{Apart, are_beyond};
use crate::collide::mesh::{CompositeContacts, over2, over3, update_chain, update_on_surface};
use crate::collide::packet::{GapVisitor, LANES, PartPacket, TiledParts};
use crate::collide::parts::{AxisSlabs, Between, part_gaps2, part_gaps3};
use crate::collide::separation::{
    Algorithm, Projection, distance_in_plane, distance_in_space, distance_in_world, gaps2, gaps3,
    in_world, seen_in_plane, seen_in_space, separation_in_plane, separation_in_space,
    touching_in_world,
};
use crate::collide::{
    ConvexPair, ManifoldRequest, OnFace, Pair, Placed, RawManifold, Solid, between2, build3,
    contact_in_world, contacts2, contacts3, distances2, distances3, on_face2, on_face3,
    separations2, separations3, tangents2, tangents3, witness_feature2, witness_feature3,
    witness_features2, witness_features3,
};
use crate::convex::Separation;
#[cfg(feature = "debug_render")]
use crate::debug_render::{Sketch, sketch2, sketch3};
use crate::math::{Point, Pose, Real, Space, Vector};
use crate::narrow_phase::{
    CollisionObjectHandle, CompositeState, ContactState, DefaultNarrowPhase, DueContacts, Events,
    GeometricQueryType, Interaction, KeptContacts, ObjectTable, Posed, proximity_of, update_lanes2,
    update_lanes3,
};
use crate::partitioning::{BoxTree, BoxTreeError, Question, Sweep};
use crate::query::composite::{PartPoint, RayQuestion, each_hit, is_crossed, nearest_part};
pub use crate::query::mass::MassKernel;
use crate::query::point::{SurfacePoint, point2, point3};
use crate::query::ray::{Span, ray2, ray3};
use crate::query::{
    ContactManifold, Flight, Impact, ImpactOptions, ManifoldView, Moving, PointProjection,
    Proximity, RayIntersection, TrackedContact, Witness, impact_of_flight, impact_of_pair,
    time_of_pair, witness_in_world,
};
use crate::shape::{CompositeShape, FeatureId, FieldTable, Kind, MeshTable, ShapeHandle, Triangle};
use crate::world::{
    ChangeList, DirtyTree, DirtyVisitor, Readers, WorldBody, WorldBroadPhase, WorldError,
};

/// Function pointers to the entry points for one scalar and dimension.
pub struct Tables<N: Space<D>, const D: usize> {
    /// The one fact about a pair of solids; see [`crate::query`].
    pub(crate) separation: Algorithm<N, D>,
    /// That of many triangles from one solid, if there is an algorithm for many.
    pub(crate) gaps: GapsFn<N, D>,
    /// How far each of eight parts is from what is in slabs, at least.
    pub(crate) part_gaps: PartGapsFn<N, D>,
    /// Brings the contacts of a convex solid and a chain of segments, or of a ball and a surface, up to date;
    /// returns false where the generic path must do it.
    pub(crate) update_quickly: QuickFn<N, D>,
    /// Its distance, and any that is not positive of solids that overlap clearly.
    pub(crate) distance: DistanceFn<N, D>,
    /// How a solid sees a point; nothing where there is no closed form.
    pub(crate) seen: SeenFn<N, D>,
    /// Contacts along the normal of a triangle; answers false where it makes none.
    pub(crate) on_face: OnFaceFn<N, D>,
    /// The contact points of a pair whose separation is known.
    pub(crate) between: BetweenFn<N, D>,
    /// Two shapes are certainly farther apart than a limit.
    pub(crate) are_beyond: fn(&Apart<'_, N, D>, N) -> bool,
    pub(crate) separation_in_world: InWorldFn<N, D>,
    pub(crate) contact_in_world: InWorldFn<N, D>,
    /// The same, but content with any overlap of parts.
    pub(crate) touching_in_world: InWorldFn<N, D>,
    /// Its distance alone.
    pub(crate) distance_in_world: DistanceInWorldFn<N, D>,
    pub(crate) witness_in_world: WitnessFn<N, D>,
    /// The features that the nearest points of two convex solids lie on.
    pub(crate) witness_features: FeaturesFn<N, D>,
    /// The same of one of the solids alone, the second if that is said.
    pub(crate) witness_feature: FeatureFn<N, D>,
    /// The feature of a triangle that a ball is over; the last argument is what counts as rounding.
    pub(crate) over: OverFn<N, D>,
    /// When two moving solids touch, and where.
    pub(crate) impact: ImpactFn<N, D>,
    pub(crate) time_of_impact: TimeFn<N, D>,
    pub(crate) nonlinear_impact: NonlinearImpactFn<N, D>,
    /// When the line of a ray is inside a solid.
    pub(crate) ray_span: fn(Kind<'_, N, D>, &Ray<N, D>) -> Option<Span<N, D>>,
    /// The point of a solid's boundary that is nearest to a point.
    pub(crate) surface_point: fn(Kind<'_, N, D>, &Point<N, D>) -> SurfacePoint<N, D>,
    /// The part of a composite that is nearest to a point; any that holds it with the flag.
    pub(crate) nearest_part: NearestPartFn<N, D>,
    /// Calls with each part of a composite that a ray hits.
    pub(crate) each_hit: EachHitFn<N, D>,
    /// A ray meets a composite by a time.
    pub(crate) is_crossed: fn(&dyn CompositeShape<N, D>, &Ray<N, D>, N) -> bool,
    /// The contact points of a pair.
    pub(crate) contacts: ContactsFn<N, D>,
    /// The distances of many pairs of convex solids, up to a limit.
    pub(crate) distances: DistancesOfPairsFn<N, D>,
    /// Their separations.
    pub(crate) separations: SeparationsOfPairsFn<N, D>,
    /// Those of some pairs of a group, several at a time, if that can be done.
    pub(crate) update_lanes: UpdateLanesFn<N, D>,
    /// The same of pairs of a batch.
    pub(crate) update_group: UpdateGroupFn<N, D>,
    pub(crate) batch: BatchTables<N, D>,
    pub(crate) checker: CheckerTables<N, D>,
    /// Two directions across a normal; the second is zero in 2D.
    pub(crate) tangents: fn(&Vector<N, D>) -> [Vector<N, D>; 2],
    pub(crate) update_contacts: fn(&mut ContactState<N, D>, &Posed<'_, N, D>, &ManifoldRequest<N>),
    pub(crate) public_manifold: PublicManifoldFn<N, D>,
    pub(crate) update_composites:
        fn(&mut CompositeState<N, D>, &Posed<'_, N, D>, &ManifoldRequest<N>),
    pub(crate) composite_manifolds: CompositeManifoldsFn<N, D>,
    /// A contact of a manifold that is read in place, with its kinematic.
    pub(crate) tracked_contact: fn(&ManifoldView<'_, N, D>, usize) -> TrackedContact<N, D>,
    pub(crate) proximity: fn(&Posed<'_, N, D>, N) -> Proximity,
    pub(crate) update_pairs: fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, &mut Events),
    /// The step of a broad phase: what is pending, the filter, and what hears of changes.
    pub(crate) find_pairs: FindPairsFn<N, D>,
    pub(crate) world: WorldTables<N, D>,
    pub(crate) partitioning: PartitioningTables<N, D>,
    pub(crate) mesh: MeshTable<N, D>,
    pub(crate) height_field: FieldTable<N, D>,
    /// Adds what is drawn of a convex solid to a mesh.
    #[cfg(feature = "debug_render")]
    pub(crate) sketch: SketchFn<N, D>,
}

#[cfg(feature = "debug_render")]
type SketchFn<N, const D: usize> = fn(Kind<'_, N, D>, &mut Sketch<N, D>);
type InWorldFn<N, const D: usize> =
    fn(&Placed<'_, N, D>, &Placed<'_, N, D>, N) -> Option<Separation<N, D>>;
type DistanceInWorldFn<N, const D: usize> =
    fn(&Placed<'_, N, D>, &Placed<'_, N, D>, N) -> Option<N>;
type DistanceFn<N, const D: usize> = fn(&Pair<'_, N, D>, N) -> Option<N>;
type DistancesOfPairsFn<N, const D: usize> = fn(&mut [ConvexPair<'_, N, D>], N, &mut [Option<N>]);
type SeparationsOfPairsFn<N, const D: usize> =
    fn(&mut [ConvexPair<'_, N, D>], N, &mut [Option<Separation<N, D>>]);
type SeenFn<N, const D: usize> = fn(Kind<'_, N, D>, &Point<N, D>) -> Option<Projection<N, D>>;
type WitnessFn<N, const D: usize> =
    fn(&Placed<'_, N, D>, &Placed<'_, N, D>, N, bool) -> Option<Witness<N, D>>;
type FeatureFn<N, const D: usize> = fn(&Pair<'_, N, D>, &Separation<N, D>, N, bool) -> FeatureId;
type OverFn<N, const D: usize> = fn(&Triangle<N, D>, &Point<N, D>, N) -> Option<FeatureId>;
type GapsFn<N, const D: usize> =
    fn(&TiledParts<'_, N, D>, Kind<'_, N, D>, &Pose<N, D>, N, N, GapVisitor<'_, N, D>) -> bool;
type PartGapsFn<N, const D: usize> = fn(&AxisSlabs<N, D>, &PartPacket<N, D>, N) -> [N; LANES];
type QuickFn<N, const D: usize> =
    fn(&mut CompositeContacts<N, D>, &Between<'_, N, D>, &ManifoldRequest<N>) -> bool;
type OnFaceFn<N, const D: usize> =
    fn(&Pair<'_, N, D>, &OnFace<N, D>, &mut RawManifold<N, D>) -> bool;
type BetweenFn<N, const D: usize> =
    fn(&Pair<'_, N, D>, &Separation<N, D>, &ManifoldRequest<N>, &mut RawManifold<N, D>);
type FeaturesFn<N, const D: usize> = fn(&Pair<'_, N, D>, &Separation<N, D>) -> [FeatureId; 2];
type NearestPartFn<N, const D: usize> =
    fn(&dyn CompositeShape<N, D>, &Point<N, D>, bool) -> Option<PartPoint<N, D>>;
type EachHitFn<N, const D: usize> =
    fn(&dyn CompositeShape<N, D>, &RayQuestion<N, D>, &mut dyn FnMut(RayIntersection<N, D>) -> N);
type ImpactFn<N, const D: usize> =
    fn(&Moving<'_, N, D>, &Moving<'_, N, D>, &ImpactOptions<N>) -> Option<Impact<N, D>>;
type TimeFn<N, const D: usize> =
    fn(&Moving<'_, N, D>, &Moving<'_, N, D>, &ImpactOptions<N>) -> Option<N>;
type NonlinearImpactFn<N, const D: usize> =
    fn(&Flight<'_, N, D>, &ImpactOptions<N>) -> Option<Impact<N, D>>;
type PublicManifoldFn<N, const D: usize> =
    fn(&ContactState<N, D>, &Posed<'_, N, D>, u64, ContactManifold<N, D>) -> ContactManifold<N, D>;
type CompositeManifoldsFn<N, const D: usize> = fn(
    &CompositeState<N, D>,
    &Posed<'_, N, D>,
    u64,
    Vec<ContactManifold<N, D>>,
) -> Vec<ContactManifold<N, D>>;
type ContactsFn<N, const D: usize> =
    fn(&Pair<'_, N, D>, &ManifoldRequest<N>, &mut RawManifold<N, D>);
type UpdateLanesFn<N, const D: usize> =
    fn([&Solid<N, D>; 2], &mut DueContacts<'_, '_, N, D>) -> bool;
type UpdateGroupFn<N, const D: usize> =
    fn([&Solid<N, D>; 2], &mut SolidGroup<'_, '_, N, D>) -> bool;
type FindPairsFn<N, const D: usize> =
    fn(&mut PairFinder<N, D>, &mut dyn FnMut(u32, u32) -> bool, &mut dyn FnMut(u32, u32, bool));

/// Making and searching a tree over a user's boxes.
pub(crate) struct PartitioningTables<N: Space<D>, const D: usize> {
    pub(crate) build: BuildFn<N, D>,
    pub(crate) refit: RefitFn<N, D>,
    pub(crate) each: AnswerFn<N, D>,
    pub(crate) by_time: InOrderFn<N, D, Sweep<N, D>>,
    pub(crate) near_first: InOrderFn<N, D, Sweep<N, D>>,
    pub(crate) by_distance: InOrderFn<N, D, Aabb<N, D>>,
    pub(crate) nearest_first: InOrderFn<N, D, Aabb<N, D>>,
}

type BuildFn<N, const D: usize> = fn(Vec<Aabb<N, D>>) -> Result<BoxTree<N, D>, BoxTreeError>;
type RefitFn<N, const D: usize> = fn(&mut BoxTree<N, D>, &[Aabb<N, D>]) -> Result<(), BoxTreeError>;
type AnswerFn<N, const D: usize> = fn(&BoxTree<N, D>, &Question<'_, N, D>, &mut dyn FnMut(u32));
type InOrderFn<N, const D: usize, Q> = fn(&BoxTree<N, D>, &Q, N, &mut dyn FnMut(u32, N) -> N);

impl<N: Space<D>, const D: usize> PartitioningTables<N, D> {
    const fn new() -> Self {
        Self {
            build: BoxTree::build,
            refit: BoxTree::refit_to,
            each: BoxTree::answer,
            by_time: BoxTree::by_time,
            near_first: BoxTree::near_first,
            by_distance: BoxTree::by_distance,
            nearest_first: BoxTree::nearest_first,
        }
    }
}

/// What a world asks of the floors below it, and of its own part that knows no users' data.
pub(crate) struct WorldTables<N: Space<D>, const D: usize> {
    pub(crate) new_broad_phase: fn(N) -> Box<WorldBroadPhase<N, D>>,
    pub(crate) set_isometry: SetIsometryFn<N, D>,
    pub(crate) set_predicted: SetPredictedFn<N, D>,
    pub(crate) set_shape: fn(&mut WorldBody<N, D>, &mut ChangeList<N, D>, ShapeHandle<N, D>),
    pub(crate) set_query: fn(&mut WorldBody<N, D>, &mut ChangeList<N, D>, GeometricQueryType<N>),
    pub(crate) set_skin: fn(&mut WorldBody<N, D>, &mut ChangeList<N, D>, N),
    pub(crate) flush: FlushFn<N, D>,
    /// Making, changing and searching the tree of dirty objects.
    pub(crate) new_dirty_tree: NewDirtyFn<N, D>,
    pub(crate) put_dirty: fn(&mut DirtyTree<D>, u32, &Aabb<N, D>),
    pub(crate) take_dirty: fn(&mut DirtyTree<D>, u32),
    pub(crate) dirty_by_time: SearchDirtyFn<N, D, Sweep<N, D>>,
    pub(crate) dirty_by_distance: SearchDirtyFn<N, D, Aabb<N, D>>,
    /// A ray, a point and a point once more, against one object.
    pub(crate) cast_ray: CastRayFn<N, D>,
    pub(crate) project: ProjectFn<N, D>,
    pub(crate) holds: fn(&WorldBody<N, D>, &Point<N, D>) -> bool,
    pub(crate) update_pair:
        fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, [u32; 2], &mut Events) -> bool,
    pub(crate) pair_started: fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, u32, u32),
    pub(crate) begin_and_end_pairs:
        fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, &[Interaction], &mut Events),
    pub(crate) pair_stopped:
        fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, u32, u32, &mut Events),
    pub(crate) object_changed:
        fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, u32, &mut Events),
}

type SetIsometryFn<N, const D: usize> = fn(
    &mut WorldBody<N, D>,
    &mut ChangeList<N, D>,
    <N as Space<D>>::Isometry,
) -> Result<(), WorldError>;
type NewDirtyFn<N, const D: usize> =
    fn(bool, &mut dyn Iterator<Item = (u32, Aabb<N, D>)>) -> DirtyTree<D>;
type SetPredictedFn<N, const D: usize> = fn(
    &mut WorldBody<N, D>,
    &mut ChangeList<N, D>,
    <N as Space<D>>::Isometry,
    <N as Space<D>>::Isometry,
) -> Result<(), WorldError>;
type FlushFn<N, const D: usize> =
    fn(&mut ChangeList<N, D>, &mut WorldBody<N, D>, &mut Readers<'_, N, D>);
type SearchDirtyFn<N, const D: usize, Q> = fn(&DirtyTree<D>, &Q, N, &mut DirtyVisitor<'_, N>);
type CastRayFn<N, const D: usize> =
    fn(&WorldBody<N, D>, &Ray<N, D>, N, bool) -> Option<RayIntersection<N, D>>;
type ProjectFn<N, const D: usize> =
    fn(&WorldBody<N, D>, &Point<N, D>, bool, N) -> Option<(PointProjection<N, D>, N)>;

impl<N: Space<D>, const D: usize> WorldTables<N, D> {
    const fn new() -> Self {
        Self {
            new_broad_phase,
            set_isometry: WorldBody::set_isometry,
            set_predicted: WorldBody::set_predicted,
            set_shape: WorldBody::set_shape,
            set_query: WorldBody::set_query,
            set_skin: WorldBody::set_skin,
            flush: ChangeList::flush,
            new_dirty_tree: DirtyTree::new,
            put_dirty: DirtyTree::put,
            take_dirty: DirtyTree::take,
            dirty_by_time: DirtyTree::by_time,
            dirty_by_distance: DirtyTree::by_distance,
            cast_ray: WorldBody::cast_ray,
            project: WorldBody::project,
            holds: WorldBody::holds,
            update_pair: DefaultNarrowPhase::update_pair,
            pair_started: DefaultNarrowPhase::pair_started,
            begin_and_end_pairs: DefaultNarrowPhase::begin_and_end_pairs,
            pair_stopped: DefaultNarrowPhase::pair_stopped,
            object_changed: DefaultNarrowPhase::object_changed,
        }
    }
}

/// The broad phase of a new world.
fn new_broad_phase<N: Space<D>, const D: usize>(margin: N) -> Box<WorldBroadPhase<N, D>> {
    Box::new(DBVTBroadPhase::<N, Aabb<N, D>, CollisionObjectHandle>::new(margin))
}

impl<N: Space<D>, const D: usize> fmt::Debug for Tables<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tables").finish_non_exhaustive()
    }
}

/// What differs by dimension.
struct Particular<N: Space<D>, const D: usize> {
    separation: Algorithm<N, D>,
    gaps: GapsFn<N, D>,
    part_gaps: PartGapsFn<N, D>,
    update_quickly: QuickFn<N, D>,
    distance: DistanceFn<N, D>,
    distances: DistancesOfPairsFn<N, D>,
    separations: SeparationsOfPairsFn<N, D>,
    seen: SeenFn<N, D>,
    contacts: ContactsFn<N, D>,
    update_lanes: UpdateLanesFn<N, D>,
    update_group: UpdateGroupFn<N, D>,
    tangents: fn(&Vector<N, D>) -> [Vector<N, D>; 2],
    witness_features: FeaturesFn<N, D>,
    witness_feature: FeatureFn<N, D>,
    over: OverFn<N, D>,
    on_face: OnFaceFn<N, D>,
    between: BetweenFn<N, D>,
    ray_span: fn(Kind<'_, N, D>, &Ray<N, D>) -> Option<Span<N, D>>,
    surface_point: fn(Kind<'_, N, D>, &Point<N, D>) -> SurfacePoint<N, D>,
    mesh: MeshTable<N, D>,
    height_field: FieldTable<N, D>,
    #[cfg(feature = "debug_render")]
    sketch: SketchFn<N, D>,
}

impl<N: Real> Particular<N, 2> {
    const IN_PLANE: Self = Self {
        separation: separation_in_plane,
        gaps: gaps2,
        part_gaps: part_gaps2,
        update_quickly: update_chain,
        distance: distance_in_plane,
        distances: distances2,
        separations: separations2,
        seen: seen_in_plane,
        contacts: contacts2,
        update_lanes: update_lanes2,
        update_group: update_group2,
        tangents: tangents2,
        witness_features: witness_features2,
        witness_feature: witness_feature2,
        over: over2,
        on_face: on_face2,
        between: between2,
        ray_span: ray2::span,
        surface_point: point2::surface_point,
        mesh: MeshTable::<N, 2>::IN_PLANE,
        height_field: FieldTable::<N, 2>::IN_PLANE,
        #[cfg(feature = "debug_render")]
        sketch: sketch2,
    };
}

impl<N: Real> Particular<N, 3> {
    const IN_SPACE: Self = Self {
        separation: separation_in_space,
        gaps: gaps3,
        part_gaps: part_gaps3,
        update_quickly: update_on_surface,
        distance: distance_in_space,
        distances: distances3,
        separations: separations3,
        seen: seen_in_space,
        contacts: contacts3,
        update_lanes: update_lanes3,
        update_group: update_group3,
        tangents: tangents3,
        witness_features: witness_features3,
        witness_feature: witness_feature3,
        over: over3,
        on_face: on_face3,
        between: build3,
        ray_span: ray3::span,
        surface_point: point3::surface_point,
        mesh: MeshTable::<N, 3>::IN_SPACE,
        height_field: FieldTable::<N, 3>::IN_SPACE,
        #[cfg(feature = "debug_render")]
        sketch: sketch3,
    };
}

impl<N: Space<D>, const D: usize> Tables<N, D> {
    /// The tables around what differs by dimension.
    const fn around(particular: &Particular<N, D>) -> Self {
        Self {
            separation: particular.separation,
            gaps: particular.gaps,
            part_gaps: particular.part_gaps,
            update_quickly: particular.update_quickly,
            distance: particular.distance,
            distances: particular.distances,
            separations: particular.separations,
            seen: particular.seen,
            are_beyond,
            separation_in_world: in_world,
            contact_in_world,
            touching_in_world,
            distance_in_world,
            witness_in_world,
            witness_features: particular.witness_features,
            witness_feature: particular.witness_feature,
            over: particular.over,
            on_face: particular.on_face,
            between: particular.between,
            impact: impact_of_pair,
            time_of_impact: time_of_pair,
            nonlinear_impact: impact_of_flight,
            ray_span: particular.ray_span,
            surface_point: particular.surface_point,
            nearest_part,
            each_hit,
            is_crossed,
            contacts: particular.contacts,
            update_lanes: particular.update_lanes,
            update_group: particular.update_group,
            batch: BatchTables::new(),
            checker: CheckerTables::new(),
            tangents: particular.tangents,
            update_contacts: ContactState::update,
            public_manifold: ContactState::manifolds,
            update_composites: CompositeState::update,
            composite_manifolds: CompositeState::manifolds,
            tracked_contact: |view, index| view.tracked(index),
            proximity: proximity_of,
            update_pairs: DefaultNarrowPhase::update_pairs_here,
            find_pairs: PairFinder::update,
            world: WorldTables::new(),
            partitioning: PartitioningTables::new(),
            mesh: particular.mesh,
            height_field: particular.height_field,
            #[cfg(feature = "debug_render")]
            sketch: particular.sketch,
        }
    }
}

/// A scalar whose tables are compiled in this crate. Sealed by being unnameable outside.
pub trait Compiled: Sized {
    /// The tables of the plane.
    fn plane() -> &'static Tables<Self, 2>
    where
        Self: Real;
    /// The tables of space.
    fn space() -> &'static Tables<Self, 3>
    where
        Self: Real;
}

static PLANE_F32: Tables<f32, 2> = Tables::around(&Particular::IN_PLANE);
static SPACE_F32: Tables<f32, 3> = Tables::around(&Particular::IN_SPACE);
#[cfg(feature = "f64")]
static PLANE_F64: Tables<f64, 2> = Tables::around(&Particular::IN_PLANE);
#[cfg(feature = "f64")]
static SPACE_F64: Tables<f64, 3> = Tables::around(&Particular::IN_SPACE);

impl Compiled for f32 {
    #[inline]
    fn plane() -> &'static Tables<Self, 2> {
        &PLANE_F32
    }

    #[inline]
    fn space() -> &'static Tables<Self, 3> {
        &SPACE_F32
    }
}

#[cfg(feature = "f64")]
impl Compiled for f64 {
    #[inline]
    fn plane() -> &'static Tables<Self, 2> {
        &PLANE_F64
    }

    #[inline]
    fn space() -> &'static Tables<Self, 3> {
        &SPACE_F64
    }
}
