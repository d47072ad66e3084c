//! The entry points that are compiled here rather than in the caller.
//!
//! Generic code is compiled where it is first used with concrete types. These `static`s use the hot
//! entry points with all four combinations of scalar and dimension, so that they are compiled in
//! this crate, at this crate's optimisation level; callers reach them by function pointer. This
//! module is the one place that floors below may see of floors above.

use core::fmt;

use crate::bounding_volume::Aabb;
use crate::broad_phase::{DBVTBroadPhase, PairFinder};
use crate::convex::Separation;
use crate::math::{Real, Space};
use crate::narrow_phase::{
    CollisionObjectHandle, ContactState, DefaultNarrowPhase, Events, ObjectTable, Posed,
    proximity_of,
};
use crate::query::{ContactManifold, ManifoldRequest, Pair, Proximity, RawManifold};
use crate::shape::ShapeHandle;
use crate::world::{Bodies, WorldBroadPhase};

pub(crate) type FindPairs<N, const D: usize> =
    fn(&mut PairFinder<N, D>, &mut dyn FnMut(u32, u32) -> bool, &mut dyn FnMut(u32, u32, bool));

/// Function pointers to the entry points for one scalar and dimension.
pub struct Tables<N: Space<D>, const D: usize> {
    /// The one fact about a pair of solids; see [`crate::query`].
    pub(crate) separation: SeparationFn<N, D>,
    /// Contact points from that fact and the features of the two solids.
    pub(crate) manifold: ManifoldFn<N, D>,
    pub(crate) update_contacts: fn(&mut ContactState<N, D>, &Posed<'_, N, D>, &ManifoldRequest<N>),
    pub(crate) public_manifold:
        fn(&ContactState<N, D>, &Posed<'_, N, D>, u64) -> ContactManifold<N, D>,
    pub(crate) proximity: fn(&Posed<'_, N, D>, N) -> Proximity,
    pub(crate) update_pairs: UpdatePairsFn<N, D>,
    pub(crate) find_pairs: FindPairs<N, D>,
    pub(crate) world: WorldTables<N, D>,
}

/// What a world asks of the floors below it, and of its own part that knows no users' data.
pub(crate) struct WorldTables<N: Space<D>, const D: usize> {
    pub(crate) new_broad_phase: fn(N) -> Box<WorldBroadPhase<N, D>>,
    pub(crate) set_isometry: fn(&mut Bodies<N, D>, u32, N::Isometry),
    pub(crate) set_shape: fn(&mut Bodies<N, D>, u32, ShapeHandle<N, D>),
    pub(crate) flush: FlushFn<N, D>,
    pub(crate) pair_started: fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, u32, u32),
    pub(crate) pair_stopped:
        fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, u32, u32, &mut Events),
    pub(crate) object_changed:
        fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, u32, &mut Events),
}

type FlushFn<N, const D: usize> =
    fn(&mut Bodies<N, D>, &mut ObjectTable<N, D>, &mut WorldBroadPhase<N, D>, &mut Vec<u32>);

impl<N: Space<D>, const D: usize> WorldTables<N, D> {
    const fn new() -> Self {
        Self {
            new_broad_phase,
            set_isometry: Bodies::set_isometry,
            set_shape: Bodies::set_shape,
            flush: Bodies::flush,
            pair_started: DefaultNarrowPhase::pair_started,
            pair_stopped: DefaultNarrowPhase::pair_stopped,
            object_changed: DefaultNarrowPhase::object_changed,
        }
    }
}

/// The broad phase of a new world.
fn new_broad_phase<N: Space<D>, const D: usize>(margin: N) -> Box<WorldBroadPhase<N, D>> {
    Box::new(DBVTBroadPhase::<N, Aabb<N, D>, CollisionObjectHandle>::new(margin))
}

pub(crate) type SeparationFn<N, const D: usize> =
    fn(&Pair<'_, N, D>, N) -> Option<Separation<N, D>>;
pub(crate) type ManifoldFn<N, const D: usize> =
    fn(&Pair<'_, N, D>, &Separation<N, D>, &ManifoldRequest<N>, &mut RawManifold<N, D>);
pub(crate) type UpdatePairsFn<N, const D: usize> =
    fn(&mut DefaultNarrowPhase<N, D>, &ObjectTable<N, D>, &mut Events);

impl<N: Space<D>, const D: usize> fmt::Debug for Tables<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tables").finish_non_exhaustive()
    }
}

impl<N: Space<D>, const D: usize> Tables<N, D> {
    /// The tables around what differs by dimension.
    const fn around(separation: SeparationFn<N, D>, manifold: ManifoldFn<N, D>) -> Self {
        Self {
            separation,
            manifold,
            update_contacts: ContactState::update,
            public_manifold: ContactState::manifold,
            proximity: proximity_of,
            update_pairs: DefaultNarrowPhase::update_pairs_here,
            find_pairs: PairFinder::update,
            world: WorldTables::new(),
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

static PLANE_F32: Tables<f32, 2> = Tables::around(separation2, build2);
static SPACE_F32: Tables<f32, 3> = Tables::around(separation3, build3);
#[cfg(feature = "f64")]
static PLANE_F64: Tables<f64, 2> = Tables::around(separation2, build2);
#[cfg(feature = "f64")]
static SPACE_F64: Tables<f64, 3> = Tables::around(separation3, build3);

impl Compiled for f32 {
    fn plane() -> &'static Tables<Self, 2> {
        &PLANE_F32
    }

    fn space() -> &'static Tables<Self, 3> {
        &SPACE_F32
    }
}

#[cfg(feature = "f64")]
impl Compiled for f64 {
    fn plane() -> &'static Tables<Self, 2> {
        &PLANE_F64
    }

    fn space() -> &'static Tables<Self, 3> {
        &SPACE_F64
    }
}
fn separation2<N: Real>(_: &Pair<'_, N, 2>, _: N) -> Option<Separation<N, 2>> {
    None
}
fn separation3<N: Real>(_: &Pair<'_, N, 3>, _: N) -> Option<Separation<N, 3>> {
    None
}
fn build2<N: Real>(
    _: &Pair<'_, N, 2>,
    _: &Separation<N, 2>,
    _: &ManifoldRequest<N>,
    _: &mut RawManifold<N, 2>,
) {
}
fn build3<N: Real>(
    _: &Pair<'_, N, 3>,
    _: &Separation<N, 3>,
    _: &ManifoldRequest<N>,
    _: &mut RawManifold<N, 3>,
) {
}
