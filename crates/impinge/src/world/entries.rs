//! Functions of worlds without the user's data type, so that they can be compiled in this crate.

use super::bodies::WorldBody;
use super::changes::{ChangeList, ChangeTargets};
use super::dirty::{DirtyTree, DirtyVisitor};
use super::fork::DefaultBroadPhase;
use super::objects::Slot;
use super::queries::cast::Cast;
use super::queries::shape;
use super::{ContactViewPiece, ContactViews, WorldBroadPhase, WorldError, narrow_phase};
use crate::bounding_volume::{Aabb, Ray};
use crate::collide::Placed;
use crate::convex::Separation;
use crate::math::{Point, Space, Vector};
use crate::narrow_phase::{
    ContactStream, DefaultNarrowPhase, Events, GeometricQueryType, Interaction, ObjectTable,
};
use crate::partitioning::Sweep;
use crate::query::{Impact, ImpactOptions, PointProjection, RayIntersection};
use crate::shape::{Geometry, Shape, ShapeHandle};
use crate::tables::compiled;

compiled! {
    /// The functions of worlds that are compiled in this crate.
    trait WorldEntries;

    /// Creates the broad phase of a new world.
    fn new_broad_phase(margin: N) -> Box<WorldBroadPhase<N, D>> = boxed_broad_phase;

    fn set_isometry(
        body: &mut WorldBody<N, D>,
        changes: &mut ChangeList<N, D>,
        isometry: <N as Space<D>>::Isometry,
    ) -> Result<(), WorldError> = WorldBody::set_isometry;

    fn set_predicted(
        body: &mut WorldBody<N, D>,
        changes: &mut ChangeList<N, D>,
        isometry: <N as Space<D>>::Isometry,
        predicted: <N as Space<D>>::Isometry,
    ) -> Result<(), WorldError> = WorldBody::set_predicted;

    fn set_shape(
        body: &mut WorldBody<N, D>,
        changes: &mut ChangeList<N, D>,
        shape: ShapeHandle<N, D>,
    ) = WorldBody::set_shape;

    fn set_query(
        body: &mut WorldBody<N, D>,
        changes: &mut ChangeList<N, D>,
        query: GeometricQueryType<N>,
    ) = WorldBody::set_query;

    fn set_skin(body: &mut WorldBody<N, D>, changes: &mut ChangeList<N, D>, skin: N) =
        WorldBody::set_skin;

    fn flush(
        changes: &mut ChangeList<N, D>,
        body: &mut WorldBody<N, D>,
        targets: &mut ChangeTargets<'_, N, D>,
    ) = ChangeList::flush;

    /// Creates a tree of dirty objects.
    fn new_dirty_tree(
        has_all: bool,
        boxes: &mut dyn Iterator<Item = (u32, Aabb<N, D>)>,
    ) -> DirtyTree<D> = DirtyTree::new;

    fn put_dirty(tree: &mut DirtyTree<D>, id: u32, aabb: &Aabb<N, D>) = DirtyTree::put;

    fn take_dirty(tree: &mut DirtyTree<D>, id: u32) = DirtyTree::take;

    fn dirty_by_time(
        tree: &DirtyTree<D>,
        sweep: &Sweep<N, D>,
        limit: N,
        found: &mut DirtyVisitor<'_, N>,
    ) = DirtyTree::by_time;

    fn dirty_by_distance(
        tree: &DirtyTree<D>,
        own: &Aabb<N, D>,
        limit: N,
        found: &mut DirtyVisitor<'_, N>,
    ) = DirtyTree::by_distance;

    /// Casts a ray against an object; `None` without a hit. See `WorldBody::cast_ray`.
    fn cast_ray(
        body: &WorldBody<N, D>,
        ray: &Ray<N, D>,
        latest: N,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> = WorldBody::cast_ray;

    /// Returns the projection of `point` on an object, and its distance; `None` if the shape is
    /// empty, and possibly if the distance exceeds `farthest`. See `WorldBody::project`.
    fn project(
        body: &WorldBody<N, D>,
        point: &Point<N, D>,
        solid: bool,
        farthest: N,
    ) -> Option<(PointProjection<N, D>, N)> = WorldBody::project;

    /// Returns `true` if the object contains a point, boundary included.
    fn holds(body: &WorldBody<N, D>, point: &Point<N, D>) -> bool = WorldBody::holds;

    /// Iterates over all manifolds, read in place if possible; `slots` has the handles of the
    /// objects.
    fn contact_views<'a>(
        narrow_phase: &'a DefaultNarrowPhase<N, D>,
        table: &'a ObjectTable<N, D>,
        slots: &'a [Slot],
    ) -> ContactViews<'a, N, D> = narrow_phase::views_of;

    fn contact_view_pieces<'a>(
        narrow_phase: &'a DefaultNarrowPhase<N, D>,
        table: &'a ObjectTable<N, D>,
        slots: &'a [Slot],
        pieces: usize,
    ) -> Vec<ContactViewPiece<'a, N, D>> = narrow_phase::view_pieces_of;

    /// Fills a stream with all manifolds; `slots` has the handles of the objects.
    fn read_contacts(
        narrow_phase: &DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        slots: &[Slot],
        stream: &mut ContactStream<N, D>,
    ) = narrow_phase::read_all;

    fn update_pair(
        narrow_phase: &mut DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        key: [u32; 2],
        events: &mut Events,
    ) -> bool = DefaultNarrowPhase::update_pair;

    fn pair_started(
        narrow_phase: &mut DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        first: u32,
        second: u32,
    ) = DefaultNarrowPhase::pair_started;

    fn begin_and_end_pairs(
        narrow_phase: &mut DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        interactions: &[Interaction],
        events: &mut Events,
    ) = DefaultNarrowPhase::begin_and_end_pairs;

    fn pair_stopped(
        narrow_phase: &mut DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        first: u32,
        second: u32,
        events: &mut Events,
    ) = DefaultNarrowPhase::pair_stopped;

    fn object_changed(
        narrow_phase: &mut DefaultNarrowPhase<N, D>,
        table: &ObjectTable<N, D>,
        object: u32,
        events: &mut Events,
    ) = DefaultNarrowPhase::object_changed;
}

compiled! {
    /// The functions for single objects in queries. They are small enough to be inlined in an
    /// optimised program.
    inlined trait SmallWorldEntries;

    /// Returns `true` if the exact box of an object overlaps or touches `aabb`.
    fn overlaps_aabb(body: &WorldBody<N, D>, aabb: &Aabb<N, D>) -> bool = shape::overlaps_aabb;

    /// Returns a shape placed at a position.
    fn placed_at<'a>(
        position: &<N as Space<D>>::Isometry,
        shape: Geometry<'a, N, D>,
    ) -> Placed<'a, N, D> = Placed::of_isometry;

    /// Returns the box of a placed shape, grown by its rounding errors; `None` if the position is
    /// not finite.
    fn placed_aabb(
        position: &<N as Space<D>>::Isometry,
        shape: &dyn Shape<N, D>,
    ) -> Option<Aabb<N, D>> = shape::placed_aabb;

    /// Returns `true` if a placed shape touches or overlaps an object.
    fn touches(placed: &Placed<'_, N, D>, body: &WorldBody<N, D>) -> bool = shape::touches;

    /// Returns the separation of a placed shape and an object; `None` if their distance exceeds
    /// `limit`.
    fn separation_from(
        placed: &Placed<'_, N, D>,
        body: &WorldBody<N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> = shape::separation_from;

    /// Creates a shape cast; `None` if the position or velocity is not finite.
    fn new_cast<'a>(
        position: &<N as Space<D>>::Isometry,
        velocity: &Vector<N, D>,
        shape: &'a dyn Shape<N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<Cast<'a, N, D>> = Cast::new;

    /// Returns the time and the impact of the cast shape on an object; `None` if the shape does not
    /// hit the object by time `latest`.
    fn cast_impact(
        cast: &Cast<'_, N, D>,
        body: &WorldBody<N, D>,
        latest: N,
    ) -> Option<(N, Impact<N, D>)> = Cast::impact;
}

fn boxed_broad_phase<N: Space<D>, const D: usize>(margin: N) -> Box<WorldBroadPhase<N, D>> {
    Box::new(DefaultBroadPhase::new(margin))
}
