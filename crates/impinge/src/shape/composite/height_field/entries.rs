//! Entry points that build the pyramid of a height field and search it.

use super::HeightField;
use super::grid::{GridCells, overlapping, search};
use super::pyramid::Pyramid;
use super::question::{FieldProbe, lifted};
use crate::bounding_volume::Aabb;
use crate::math::{Real, Vector};
use crate::tables::compiled;

compiled! {
    /// Entry points of height fields, compiled once per scalar type.
    trait FieldEntries;

    /// Builds the pyramid over the cells that are neither holes nor ghosts.
    fn pyramid_over(field: &HeightField<N, D>) -> Pyramid<N> = new_pyramid;

    fn cells_overlapping(
        field: &HeightField<N, D>,
        aabb: &Aabb<N, D>,
        visit: &mut dyn FnMut(u32),
    ) = each_overlapping;

    fn nearest_cells(
        field: &HeightField<N, D>,
        aabb: &Aabb<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) = nearest_first;

    /// Visits the parts whose box a moving box hits up to the time `limit`; see [`first_met`].
    fn first_cells(
        field: &HeightField<N, D>,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) = first_met;
}

fn new_pyramid<N: Real, const D: usize>(field: &HeightField<N, D>) -> Pyramid<N>
where
    HeightField<N, D>: GridCells<N>,
{
    Pyramid::new(field.pyramid().cells(), |row, column| field.cell_span(row, column))
}

/// Visits the parts whose box overlaps `aabb`.
fn each_overlapping<N: Real, const D: usize>(
    field: &HeightField<N, D>,
    aabb: &Aabb<N, D>,
    visit: &mut dyn FnMut(u32),
) where
    HeightField<N, D>: GridCells<N>,
{
    if let Some(probe) = FieldProbe::new(aabb) {
        overlapping(field, &probe, visit);
    }
}

/// Visits the parts whose box is at most `limit` from `aabb`, with a lower bound of the distance.
/// `visit` returns the new limit, which never grows.
fn nearest_first<N: Real, const D: usize>(
    field: &HeightField<N, D>,
    aabb: &Aabb<N, D>,
    limit: N,
    visit: &mut dyn FnMut(u32, N) -> N,
) where
    HeightField<N, D>: GridCells<N>,
{
    if let Some(probe) = FieldProbe::new(aabb) {
        search(field, limit, |extent| probe.distance(extent), visit);
    }
}

/// Visits the parts whose box a moving box hits up to the time `limit`, with a lower bound of that
/// time. `visit` returns the new limit, which never grows.
fn first_met<N: Real, const D: usize>(
    field: &HeightField<N, D>,
    aabb: &Aabb<N, D>,
    velocity: &Vector<N, D>,
    limit: N,
    visit: &mut dyn FnMut(u32, N) -> N,
) where
    HeightField<N, D>: GridCells<N>,
{
    if let (Some(probe), Some(velocity)) = (FieldProbe::new(aabb), lifted(velocity)) {
        search(field, limit, |extent| probe.time(&velocity, extent), visit);
    }
}
