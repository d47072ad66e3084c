//! The least and greatest heights of ever larger blocks of cells.
//!
//! The span of a block is exactly that of its cells, also after an edit.

use crate::math::{Mapped, Real, max, min};

/// The least and the greatest height; infinity and minus infinity of nothing.
pub(super) type HeightSpan<N> = [N; 2];

/// Nothing: a cell that is a hole.
pub(super) fn no_span<N: Real>() -> HeightSpan<N> {
    [N::INFINITY, -N::INFINITY]
}

pub(super) fn merged<N: Real>(a: HeightSpan<N>, b: HeightSpan<N>) -> HeightSpan<N> {
    [min(a[0], b[0]), max(a[1], b[1])]
}

/// Blocks of 2 × 2 cells, of 2 × 2 such blocks, … up to one block of all; at the far ends a block may
/// have fewer. The spans of the cells themselves are cheap to find and not kept.
///
/// About two thirds of a number per cell.
#[derive(Clone, Debug)]
pub(super) struct Pyramid<N: Real> {
    /// How many rows and columns of cells there are: one at least.
    cells: [usize; 2],
    /// The first holds blocks of 2 × 2 cells, the last one block.
    levels: Vec<PyramidLevel<N>>,
}

#[derive(Clone, Debug)]
struct PyramidLevel<N: Real> {
    columns: usize,
    /// Row by row.
    spans: Vec<HeightSpan<N>>,
}

/// A block: level 0 is that of the cells. It has the cells of the rows and columns from
/// `row << level` and `column << level` on, `1 << level` of each where there are so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PyramidBlock {
    pub(super) level: usize,
    pub(super) row: usize,
    pub(super) column: usize,
}

impl PyramidBlock {
    /// The blocks one level below; some may lie beyond the far ends.
    fn children(self) -> [Self; 4] {
        [(0, 0), (0, 1), (1, 0), (1, 1)].mapped(|(row, column)| Self {
            level: self.level - 1,
            row: 2 * self.row + row,
            column: 2 * self.column + column,
        })
    }
}

impl<N: Real> Pyramid<N> {
    /// Over rows and columns of cells, one of each at least.
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

    /// Over rows and columns of cells that are still to be looked at.
    pub(super) const fn unbuilt(cells: [usize; 2]) -> Self {
        Self { cells, levels: Vec::new() }
    }

    /// Its levels, with none left behind: for a field that brings them up to date by its own cells.
    pub(super) fn take(&mut self) -> Self {
        Self { cells: self.cells, levels: std::mem::take(&mut self.levels) }
    }

    /// The block of all cells.
    pub(super) const fn top(&self) -> PyramidBlock {
        PyramidBlock { level: self.levels.len(), row: 0, column: 0 }
    }

    /// How many rows and columns of cells there are.
    pub(super) const fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// The blocks one level below.
    pub(super) fn children(&self, block: PyramidBlock) -> impl Iterator<Item = PyramidBlock> {
        let [rows, columns] = self.cells;
        let children = block.children().into_iter();
        children.filter(move |child| {
            child.row << child.level < rows && child.column << child.level < columns
        })
    }

    /// The heights of a block.
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

    /// Brings the blocks around a cell up to date, from the cell up.
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
