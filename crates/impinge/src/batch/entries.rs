//! Entry points of batches: functions whose generic code this crate compiles for each scalar and
//! dimension, so that the user's crate need not.

use super::{
    BatchError, ClosestColumns, ContactColumns, Control, HitColumns, ImpactColumns, ManifoldRows,
    PairBatch, PointBatch, ProjectionColumns, RayColumns, Side, Tiles, WitnessColumns, manifolds,
    pairs, points, rays, within,
};
use crate::bounding_volume::Aabb;
use crate::narrow_phase::ContactPrediction;
use crate::query::{ImpactOptions, Proximity};
use crate::tables::compiled;

type Done = Result<(), BatchError>;

compiled! {
    /// Entry points of batches.
    trait BatchEntries where feature = "batch";

    fn distances(pairs: &PairBatch<'_, N, D>, control: &Control<'_>, out: &mut [N]) -> Done =
        pairs::distances;

    fn closest_points(
        pairs: &PairBatch<'_, N, D>,
        limit: N,
        control: &Control<'_>,
        out: ClosestColumns<'_, N, D>,
    ) -> Done = pairs::closest_points;

    fn witnesses(
        pairs: &PairBatch<'_, N, D>,
        limit: N,
        control: &Control<'_>,
        out: WitnessColumns<'_, N, D>,
    ) -> Done = pairs::witnesses;

    fn proximities(
        pairs: &PairBatch<'_, N, D>,
        margin: N,
        control: &Control<'_>,
        out: &mut [Proximity],
    ) -> Done = pairs::proximities;

    fn contacts(
        pairs: &PairBatch<'_, N, D>,
        prediction: N,
        control: &Control<'_>,
        out: ContactColumns<'_, N, D>,
    ) -> Done = pairs::contacts;

    fn impacts(
        pairs: &PairBatch<'_, N, D>,
        velocities: [&[[N; D]]; 2],
        options: &ImpactOptions<N>,
        control: &Control<'_>,
        out: ImpactColumns<'_, N, D>,
    ) -> Done = pairs::impacts;

    /// Runs [`PairBatch::manifolds`]; `asked` has the prediction and the maximum number of points
    /// of a manifold.
    fn manifolds(
        pairs: &PairBatch<'_, N, D>,
        asked: (&ContactPrediction<N>, Option<usize>),
        control: &Control<'_>,
        out: &mut ManifoldRows<N, D>,
    ) -> Done = manifolds::manifolds;

    /// Returns the index and distance of the nearest pair within `limit`.
    fn nearest(
        pairs: &PairBatch<'_, N, D>,
        limit: N,
        control: &Control<'_>,
    ) -> Result<Option<(usize, N)>, BatchError> = pairs::nearest;

    /// Returns the pairs of two sides, or of one side with itself, that are at most `distance`
    /// apart.
    fn pairs_within(
        side: &Side<'_, N, D>,
        other: Option<&Side<'_, N, D>>,
        distance: N,
        control: &Control<'_>,
    ) -> Result<Vec<[u32; 2]>, BatchError> = within::pairs_of;

    fn boxes(
        side: &Side<'_, N, D>,
        control: &Control<'_>,
    ) -> Result<Vec<Option<Aabb<N, D>>>, BatchError> = within::boxes_of;

    fn pairs_in_tile(
        side: &Side<'_, N, D>,
        tiles: &Tiles<N, D>,
        tile: u32,
        control: &Control<'_>,
    ) -> Result<Vec<[u32; 2]>, BatchError> = within::pairs_of_tile;

    fn project(
        points: &PointBatch<'_, N, D>,
        solid: bool,
        control: &Control<'_>,
        out: ProjectionColumns<'_, N, D>,
    ) -> Done = points::project;

    fn signed_distances(
        points: &PointBatch<'_, N, D>,
        control: &Control<'_>,
        out: &mut [N],
    ) -> Done = points::signed_distances;

    fn contains(
        points: &PointBatch<'_, N, D>,
        control: &Control<'_>,
        out: &mut [bool],
    ) -> Done = points::contains;

    fn cast(
        rays: &RayColumns<'_, N, D>,
        control: &Control<'_>,
        out: HitColumns<'_, N, D>,
    ) -> Done = rays::cast;
}
