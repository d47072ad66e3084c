//! The searches of height fields, compiled in this crate.

use core::fmt;

use super::HeightField;
use super::grid::{GridCells, overlapping, search};
use super::pyramid::Pyramid;
use super::question::{FieldProbe, lifted};
use crate::bounding_volume::Aabb;
use crate::math::{Real, Space, Vector};

/// Function pointers for one dimension.
#[derive(Clone, Copy)]
pub(crate) struct FieldTable<N: Real, const D: usize> {
    /// The pyramid over the cells as they are.
    pub(super) pyramid: fn(&HeightField<N, D>) -> Pyramid<N>,
    pub(super) overlapping: OverlappingFn<N, D>,
    pub(super) nearest: FieldOrderFn<N, D, Aabb<N, D>>,
    /// Of a box and its velocity.
    pub(super) cast: FieldOrderFn<N, D, (Aabb<N, D>, Vector<N, D>)>,
}

type OverlappingFn<N, const D: usize> = fn(&HeightField<N, D>, &Aabb<N, D>, &mut dyn FnMut(u32));
type FieldOrderFn<N, const D: usize, Q> =
    fn(&HeightField<N, D>, &Q, N, &mut dyn FnMut(u32, N) -> N);

/// The functions of a dimension that has height fields.
const fn of_cells<N: Real, const D: usize>() -> FieldTable<N, D>
where
    HeightField<N, D>: GridCells<N>,
{
    FieldTable {
        pyramid: |field| {
            Pyramid::new(field.pyramid().cells(), |row, column| field.cell_span(row, column))
        },
        overlapping: |field, aabb, visit| {
            if let Some(probe) = FieldProbe::new(aabb) {
                overlapping(field, &probe, visit);
            }
        },
        nearest: |field, aabb, limit, visit| {
            if let Some(probe) = FieldProbe::new(aabb) {
                search(field, limit, |extent| probe.distance(extent), visit);
            }
        },
        cast: |field, (aabb, velocity), limit, visit| {
            if let (Some(probe), Some(velocity)) = (FieldProbe::new(aabb), lifted(velocity)) {
                search(field, limit, |extent| probe.time(&velocity, extent), visit);
            }
        },
    }
}

impl<N: Real> FieldTable<N, 2> {
    pub(crate) const IN_PLANE: Self = of_cells();
}

impl<N: Real> FieldTable<N, 3> {
    pub(crate) const IN_SPACE: Self = of_cells();
}

/// The functions compiled in this crate.
pub(super) fn table<N: Space<D>, const D: usize>() -> &'static FieldTable<N, D> {
    &N::tables().height_field
}

impl<N: Real, const D: usize> fmt::Debug for FieldTable<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FieldTable").finish_non_exhaustive()
    }
}
