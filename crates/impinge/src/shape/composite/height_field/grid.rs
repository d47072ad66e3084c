//! Heights over a grid: the positions of the grid points, and the search that 2D and 3D share.

use core::ops::Range;

use smallvec::SmallVec;

use super::pyramid::{HeightSpan, Pyramid, PyramidBlock};
use super::question::FieldProbe;
use crate::math::{Mapped, Point, Real, max, min};

/// Heights in rows and columns, and the positions of the rows and columns. In 2D there is one row.
///
/// A grid point is (`xs[column]`, height · `y_scale`, `zs[row]`). All code reads coordinates from
/// here, so that neighbouring cells have bitwise equal corners.
#[derive(Clone, Debug)]
pub(super) struct Grid<N: Real> {
    pub(super) columns: usize,
    /// The unscaled heights, row by row.
    pub(super) heights: Vec<N>,
    pub(super) xs: Vec<N>,
    pub(super) zs: Vec<N>,
    pub(super) y_scale: N,
}

impl<N: Real> Grid<N> {
    /// Returns whether all grid lines along x, and all along z, have distinct positions.
    /// Conservative: also false if the extent is so small, or the lines so many, that rounding
    /// could make positions equal. Always false in 2D, where all z are zero.
    pub(super) fn has_extent(&self) -> bool {
        [&self.xs, &self.zs].iter().all(|lines| {
            let is_wide = lines[0].abs() > N::MIN_POSITIVE / N::EPSILON;
            is_wide && N::lit(4.0 * lines.len() as f64) * N::EPSILON < N::ONE
        })
    }
}

/// Returns the positions of `count` grid lines that divide `extent` evenly around zero; 0 for a
/// single line.
///
/// The positions are symmetric: the last is exactly minus the first. They never decrease for a
/// positive extent and never increase for a negative one.
pub(super) fn lines<N: Real>(count: usize, extent: N) -> Vec<N> {
    let number = |x: i64| N::lit(x as f64);
    let last = i64::try_from(count).expect("a vector has fewer elements") - 1;
    if last == 0 {
        return vec![N::ZERO];
    }
    (0..=last).map(|line| number(2 * line - last) / number(2 * last) * extent).collect()
}

/// An AABB: the minimum and maximum of x, y and z. In 2D z is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GridExtent<N: Real> {
    pub(super) low: [N; 3],
    pub(super) high: [N; 3],
}

impl<N: Real> GridExtent<N> {
    /// Returns the smallest box around two points.
    pub(super) fn between(a: [N; 3], b: [N; 3]) -> Self {
        let (mut low, mut high) = (a, b);
        for axis in 0..3 {
            low[axis] = min(a[axis], b[axis]);
            high[axis] = max(a[axis], b[axis]);
        }
        Self { low, high }
    }

    /// Returns the smallest box around the points, of which there must be at least one.
    pub(super) fn around(points: &[[N; 3]]) -> Self {
        let mut extent = Self { low: points[0], high: points[0] };
        for point in &points[1..] {
            for (axis, &x) in point.iter().enumerate() {
                extent.low[axis] = min(extent.low[axis], x);
                extent.high[axis] = max(extent.high[axis], x);
            }
        }
        extent
    }
}

/// The interface through which the search reads a height field: cells of a grid, each with up to
/// two parts.
pub(super) trait GridCells<N: Real> {
    fn grid(&self) -> &Grid<N>;
    fn pyramid(&self) -> &Pyramid<N>;
    /// Returns the range of the unscaled heights of the cell's parts that are neither holes nor
    /// ghosts; the empty span if there are none.
    fn cell_span(&self, row: usize, column: usize) -> HeightSpan<N>;
    /// Returns the parts of a cell that are neither holes nor ghosts, and their boxes.
    fn parts(&self, row: usize, column: usize) -> SmallVec<[(u32, GridExtent<N>); 2]>;
}

impl<N: Real> Grid<N> {
    pub(super) fn height(&self, row: usize, column: usize) -> N {
        self.heights[row * self.columns + column]
    }

    pub(super) fn at(&self, row: usize, column: usize) -> [N; 3] {
        [self.xs[column], self.height(row, column) * self.y_scale, self.zs[row]]
    }

    pub(super) fn point(&self, row: usize, column: usize) -> Point<N, 3> {
        Point::from(self.at(row, column))
    }

    /// Returns the box of a block whose cells have the unscaled heights `span`; `None` if the span
    /// is empty.
    fn extent(
        &self,
        block: PyramidBlock,
        cells: [usize; 2],
        span: HeightSpan<N>,
    ) -> Option<GridExtent<N>> {
        if span[0] > span[1] {
            return None;
        }
        let end = |first: usize, count: usize| min_index((first + 1) << block.level, count);
        let (row, column) = (block.row << block.level, block.column << block.level);
        let (last_row, last_column) = (end(block.row, cells[0]), end(block.column, cells[1]));
        // In 2D there is one row of cells, whose points all have the same z.
        let last_row = min_index(last_row, self.zs.len() - 1);
        // Rounding keeps the order of products, so the scaled span is the span of the scaled
        // heights.
        let [low, high] = span.mapped(|height| height * self.y_scale);
        let near = [self.xs[column], low, self.zs[row]];
        Some(GridExtent::between(near, [self.xs[last_column], high, self.zs[last_row]]))
    }
}

/// Returns the box of the field: in x and z around all cells, in y around the parts that are
/// neither holes nor ghosts. `None` if there are no such parts.
pub(super) fn whole<N: Real>(field: &impl GridCells<N>) -> Option<GridExtent<N>> {
    let pyramid = field.pyramid();
    let span = pyramid.span(pyramid.top(), &|row, column| field.cell_span(row, column));
    field.grid().extent(pyramid.top(), pyramid.cells(), span)
}

fn min_index(a: usize, b: usize) -> usize {
    if a < b { a } else { b }
}

/// Calls `visit` with each part whose box has a key at or below `limit`, and with that key. `key`
/// returns a number of at least zero, or `None` to skip the box; the key of a box must not exceed
/// the key of a box inside it. `visit` returns the new limit, which never grows.
///
/// Descends the pyramid; the child block with the smallest key comes first. The stack grows by at
/// most three blocks per level.
pub(super) fn search<N: Real>(
    field: &impl GridCells<N>,
    limit: N,
    key: impl Fn(&GridExtent<N>) -> Option<N>,
    mut visit: impl FnMut(u32, N) -> N,
) {
    let (grid, pyramid) = (field.grid(), field.pyramid());
    let cell_span = |row, column| field.cell_span(row, column);
    let key_of = |block: PyramidBlock| {
        let span = pyramid.span(block, &cell_span);
        key(&grid.extent(block, pyramid.cells(), span)?)
    };
    let mut lowest = limit;
    let mut stack: SmallVec<[(N, PyramidBlock); 40]> = SmallVec::new();
    stack.extend(key_of(pyramid.top()).map(|key| (key, pyramid.top())));
    while let Some((bound, block)) = stack.pop() {
        let is_within = bound <= lowest;
        if !is_within {
            continue;
        }
        if block.level == 0 {
            for (part, extent) in field.parts(block.row, block.column) {
                if let Some(own) = key(&extent).filter(|own| *own <= lowest) {
                    lowest = min(lowest, visit(part, own));
                }
            }
            continue;
        }
        let base = stack.len();
        for child in pyramid.children(block) {
            if let Some(own) = key_of(child).filter(|own| *own <= lowest) {
                push_sorted(&mut stack, base, own, child);
            }
        }
    }
}

/// Calls `visit` once with each part whose box overlaps the probe.
///
/// The grid lines determine the range of cells under the probe. Up to [`FEW_CELLS`] cells are
/// tested one by one. For more cells the pyramid is descended, which skips blocks above or below
/// the probe.
pub(super) fn overlapping<N: Real>(
    field: &impl GridCells<N>,
    probe: &FieldProbe<N>,
    mut visit: impl FnMut(u32),
) {
    let ([low_x, _, low_z], [high_x, _, high_z]) = probe.corners();
    let columns = cells_between(&field.grid().xs, low_x, high_x);
    let rows = cells_between(&field.grid().zs, low_z, high_z);
    if rows.len().saturating_mul(columns.len()) > FEW_CELLS {
        let found = |part, _| {
            visit(part);
            N::ZERO
        };
        return search(field, N::ZERO, |extent| probe.overlap(extent), found);
    }
    for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
        for (part, extent) in field.parts(row, column) {
            if probe.overlap(&extent).is_some() {
                visit(part);
            }
        }
    }
}

/// The maximum number of cells that [`overlapping`] tests one by one.
const FEW_CELLS: usize = 32;

/// Returns the range of the cells along one axis that have a point in common with `low..=high`. A
/// cell lies between two consecutive grid lines; a single line has one cell, which lies on the
/// line.
fn cells_between<N: Real>(lines: &[N], low: N, high: N) -> Range<usize> {
    let last = lines.len() - 1;
    let (before, until) = if lines[last] < lines[0] {
        (lines.partition_point(|&x| x > high), lines.partition_point(|&x| x >= low))
    } else {
        (lines.partition_point(|&x| x < low), lines.partition_point(|&x| x <= high))
    };
    // Cell `i` lies between lines `i` and `i + 1`.
    before.saturating_sub(1)..min_index(until, if last == 0 { 1 } else { last })
}

/// Inserts `block` into `stack[base..]`, which is sorted by key with the smallest key last.
fn push_sorted<N: Real>(
    stack: &mut SmallVec<[(N, PyramidBlock); 40]>,
    base: usize,
    key: N,
    block: PyramidBlock,
) {
    let index = (base..stack.len()).find(|&at| stack[at].0 <= key).unwrap_or(stack.len());
    stack.insert(index, (key, block));
}
