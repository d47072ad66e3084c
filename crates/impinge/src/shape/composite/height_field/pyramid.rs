//! The minimum and maximum heights of blocks of cells, in levels of doubling block size.
//!
//! The span of a block is exactly the union of the spans of its cells, also after an edit.

use crate::math::{Mapped, Real, max, min};

/// The minimum and maximum height; `[∞, −∞]` for the empty span.
pub(super) type HeightSpan<N> = [N; 2];

/// Returns the empty span, which holes and ghosts have.
pub(super) fn no_span<N: Real>() -> HeightSpan<N> {
    [N::INFINITY, -N::INFINITY]
}

pub(super) fn merged<N: Real>(a: HeightSpan<N>, b: HeightSpan<N>) -> HeightSpan<N> {
    [min(a[0], b[0]), max(a[1], b[1])]
}

/// Levels of blocks: 2 × 2 cells, then 2 × 2 of these blocks, … up to one block of all cells.
/// Blocks in the last row or column may be smaller. The spans of single cells are cheap to compute
/// and not stored.
///
/// Memory: about two thirds of a scalar per cell.
#[derive(Clone, Debug)]
pub(super) struct Pyramid<N: Real> {
    /// The counts of rows and columns of cells, at least one each.
    cells: [usize; 2],
    /// The levels from fine to coarse: the first has blocks of 2 × 2 cells, the last has one block.
    levels: Vec<PyramidLevel<N>>,
}

#[derive(Clone, Debug)]
struct PyramidLevel<N: Real> {
    columns: usize,
    /// The spans of the blocks, row by row.
    spans: Vec<HeightSpan<N>>,
}

/// A block of cells; at level 0 a single cell. It covers the rows
/// `row << level..(row + 1) << level` and the corresponding columns, clipped to the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PyramidBlock {
    pub(super) level: usize,
    pub(super) row: usize,
    pub(super) column: usize,
}

impl PyramidBlock {
    /// Returns the four blocks one level below; some may lie outside the grid.
    fn children(self) -> [Self; 4] {
        [(0, 0), (0, 1), (1, 0), (1, 1)].mapped(|(row, column)| Self {
            level: self.level - 1,
            row: 2 * self.row + row,
            column: 2 * self.column + column,
        })
    }
}

impl<N: Real> Pyramid<N> {
    /// Builds the pyramid; `cells` has the counts of rows and columns of cells, at least one each.
    pub(super) fn new(
        cells: [usize; 2],
        cell_span: impl Fn(usize, usize) -> HeightSpan<N>,
    ) -> Self {
        let mut pyramid = Self { cells, levels: Vec::new() };
        let [mut rows, mut columns] = cells;
        while rows > 1 || columns > 1 {
            (rows, columns) = (rows.div_ceil(2), columns.div_ceil(2));
            let level = pyramid.levels.len() + 1;
            let mut spans = Vec::with_capacity(rows * columns);
            for row in 0..rows {
                for column in 0..columns {
                    spans.push(
                        pyramid.span_of_children(PyramidBlock { level, row, column }, &cell_span),
                    );
                }
            }
            pyramid.levels.push(PyramidLevel { columns, spans });
        }
        pyramid
    }

    /// Returns a pyramid without levels, to be built later.
    pub(super) const fn unbuilt(cells: [usize; 2]) -> Self {
        Self { cells, levels: Vec::new() }
    }

    /// Moves the levels out and leaves a pyramid without levels, so that `cell_span` can borrow the
    /// field during an update.
    pub(super) fn take(&mut self) -> Self {
        Self { cells: self.cells, levels: std::mem::take(&mut self.levels) }
    }

    /// Returns the block that contains all cells.
    pub(super) const fn top(&self) -> PyramidBlock {
        PyramidBlock { level: self.levels.len(), row: 0, column: 0 }
    }

    /// Returns the counts of rows and columns of cells.
    pub(super) const fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Returns the child blocks, one level below, that lie inside the grid.
    pub(super) fn children(&self, block: PyramidBlock) -> impl Iterator<Item = PyramidBlock> {
        let [rows, columns] = self.cells;
        let children = block.children().into_iter();
        children.filter(move |child| {
            child.row << child.level < rows && child.column << child.level < columns
        })
    }

    /// Returns the span of a block; `cell_span` computes it at level 0.
    pub(super) fn span(
        &self,
        block: PyramidBlock,
        cell_span: &impl Fn(usize, usize) -> HeightSpan<N>,
    ) -> HeightSpan<N> {
        let Some(above_cells) = block.level.checked_sub(1) else {
            return cell_span(block.row, block.column);
        };
        let level = &self.levels[above_cells];
        level.spans[block.row * level.columns + block.column]
    }

    /// Updates the blocks that contain a cell, from the lowest level up.
    pub(super) fn refresh(
        &mut self,
        row: usize,
        column: usize,
        cell_span: impl Fn(usize, usize) -> HeightSpan<N>,
    ) {
        for level in 1..=self.levels.len() {
            let block = PyramidBlock { level, row: row >> level, column: column >> level };
            let span = self.span_of_children(block, &cell_span);
            let level = &mut self.levels[level - 1];
            level.spans[block.row * level.columns + block.column] = span;
        }
    }

    fn span_of_children(
        &self,
        block: PyramidBlock,
        cell_span: &impl Fn(usize, usize) -> HeightSpan<N>,
    ) -> HeightSpan<N> {
        let spans = self.children(block).map(|child| self.span(child, cell_span));
        spans.fold(no_span(), merged)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_spans_all_cells() {
        for cells in [[1, 1], [1, 2], [3, 1], [5, 7], [8, 8]] {
            let number = |row: usize, column: usize| {
                f64::from(u8::try_from(row * 10 + column).expect("few"))
            };
            let span = |row: usize, column: usize| [number(row, column), number(row, column) + 0.5];
            let pyramid = Pyramid::new(cells, span);
            let last = number(cells[0] - 1, cells[1] - 1);
            assert_eq!(pyramid.span(pyramid.top(), &span), [0.0, last + 0.5], "{cells:?}");
        }
    }
}
