//! The entry points of batches that are compiled in this crate.

use super::{
    BatchError, ClosestColumns, ContactColumns, Control, HitColumns, ImpactColumns, ManifoldRows,
    PairBatch, PointBatch, ProjectionColumns, RayColumns, Side, Tiles, WitnessColumns, manifolds,
    pairs, points, rays, within,
};
use crate::bounding_volume::Aabb;
use crate::math::Space;
use crate::narrow_phase::ContactPrediction;
use crate::query::{ImpactOptions, Proximity};

/// What batches ask of this crate, for one scalar and dimension.
pub(crate) struct BatchTables<N: Space<D>, const D: usize> {
    pub(super) distances: DistancesFn<N, D>,
    pub(super) closest_points: ClosestFn<N, D>,
    pub(super) witnesses: WitnessesFn<N, D>,
    pub(super) proximities: ProximitiesFn<N, D>,
    pub(super) contacts: BatchContactsFn<N, D>,
    pub(super) impacts: ImpactsFn<N, D>,
    pub(super) manifolds: ManifoldsFn<N, D>,
    pub(super) nearest: NearestFn<N, D>,
    pub(super) pairs_within: PairsWithinFn<N, D>,
    pub(super) boxes: BoxesFn<N, D>,
    pub(super) pairs_in_tile: PairsInTileFn<N, D>,
    pub(super) project: ProjectAllFn<N, D>,
    pub(super) signed_distances: PointsFn<N, D, N>,
    pub(super) contains: PointsFn<N, D, bool>,
    pub(super) cast: CastFn<N, D>,
}

type Done = Result<(), BatchError>;
type DistancesFn<N, const D: usize> = fn(&PairBatch<'_, N, D>, &Control<'_>, &mut [N]) -> Done;
type ClosestFn<N, const D: usize> =
    fn(&PairBatch<'_, N, D>, N, &Control<'_>, ClosestColumns<'_, N, D>) -> Done;
type WitnessesFn<N, const D: usize> =
    fn(&PairBatch<'_, N, D>, N, &Control<'_>, WitnessColumns<'_, N, D>) -> Done;
type ProximitiesFn<N, const D: usize> =
    fn(&PairBatch<'_, N, D>, N, &Control<'_>, &mut [Proximity]) -> Done;
type BatchContactsFn<N, const D: usize> =
    fn(&PairBatch<'_, N, D>, N, &Control<'_>, ContactColumns<'_, N, D>) -> Done;
type ImpactsFn<N, const D: usize> = fn(
    &PairBatch<'_, N, D>,
    [&[[N; D]]; 2],
    &ImpactOptions<N>,
    &Control<'_>,
    ImpactColumns<'_, N, D>,
) -> Done;
type ManifoldsFn<N, const D: usize> = fn(
    &PairBatch<'_, N, D>,
    (&ContactPrediction<N>, Option<usize>),
    &Control<'_>,
    &mut ManifoldRows<N, D>,
) -> Done;
type NearestFn<N, const D: usize> =
    fn(&PairBatch<'_, N, D>, N, &Control<'_>) -> Result<Option<(usize, N)>, BatchError>;
type PairsWithinFn<N, const D: usize> = fn(
    &Side<'_, N, D>,
    Option<&Side<'_, N, D>>,
    N,
    &Control<'_>,
) -> Result<Vec<[u32; 2]>, BatchError>;
type BoxesFn<N, const D: usize> =
    fn(&Side<'_, N, D>, &Control<'_>) -> Result<Vec<Option<Aabb<N, D>>>, BatchError>;
type PairsInTileFn<N, const D: usize> =
    fn(&Side<'_, N, D>, &Tiles<N, D>, u32, &Control<'_>) -> Result<Vec<[u32; 2]>, BatchError>;
type ProjectAllFn<N, const D: usize> =
    fn(&PointBatch<'_, N, D>, bool, &Control<'_>, ProjectionColumns<'_, N, D>) -> Done;
type PointsFn<N, const D: usize, T> = fn(&PointBatch<'_, N, D>, &Control<'_>, &mut [T]) -> Done;
type CastFn<N, const D: usize> =
    fn(&RayColumns<'_, N, D>, &Control<'_>, HitColumns<'_, N, D>) -> Done;

impl<N: Space<D>, const D: usize> BatchTables<N, D> {
    pub(crate) const fn new() -> Self {
        Self {
            distances: pairs::distances,
            closest_points: pairs::closest_points,
            witnesses: pairs::witnesses,
            proximities: pairs::proximities,
            contacts: pairs::contacts,
            impacts: pairs::impacts,
            manifolds: manifolds::manifolds,
            nearest: pairs::nearest,
            pairs_within: within::pairs_of,
            boxes: within::boxes_of,
            pairs_in_tile: within::pairs_of_tile,
            project: points::project,
            signed_distances: points::signed_distances,
            contains: points::contains,
            cast: rays::cast,
        }
    }
}
