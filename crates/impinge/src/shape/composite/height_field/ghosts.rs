//! Ghosts: cells that continue the surface across the seams beside them, but that no query finds.
//!
//! ```text
//!    tile A            tile B          A and B are separate fields. Each also has samples of the
//!  ──┬──┬──┬┄┄┐     ┌┄┄┬──┬──┬──       other beyond its own border, as ghosts (┄).
//! ```
//!
//! So in each field the surface continues across the seam.

use super::HeightField;
use crate::math::Real;

impl<N: Real> HeightField<N, 2> {
    /// Makes each cell a ghost if and only if `is_ghost(cell)` returns `true`; see
    /// [`Self::set_ghost`].
    #[must_use]
    pub fn with_ghosts(mut self, mut is_ghost: impl FnMut(usize) -> bool) -> Self {
        let cells = self.num_cells();
        for cell in 0..cells {
            self.marks.set_ghost(cell, is_ghost(cell), cells);
        }
        self.rebuild();
        self
    }

    /// Makes the first and the last cell ghosts. Use it for a field whose outermost heights are
    /// samples of the neighbouring fields: solids then do not catch on the ends of the field.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Vector};
    /// use impinge::dim2::query::{self, ContactPrediction};
    /// use impinge::dim2::shape::{Ball, HeightField};
    ///
    /// // A flat field from -1 to 1, with one more sample at each end.
    /// let field = HeightField::<f32>::new(vec![0.0; 5], Vector::new(4.0, 1.0)).with_ghost_border();
    /// assert_eq!(field.height_at(1.5), None, "a ghost");
    /// // A ball beyond the end touches the last point, with the normal of the continued flat line.
    /// let (ball, at) = (Ball::new(0.5), Isometry::translation(1.0625, 0.48));
    /// let found = query::contact_manifolds(
    ///     &Isometry::identity(), &field, &at, &ball, &ContactPrediction::new(0.01, 0.0, 0.0), None);
    /// let mut contacts = found.iter().flat_map(|manifold| manifold.contacts());
    /// assert!(contacts.all(|tracked| tracked.contact.normal.y == 1.0));
    /// ```
    #[must_use]
    pub fn with_ghost_border(self) -> Self {
        let last = self.num_cells() - 1;
        self.with_ghosts(|cell| cell == 0 || cell == last)
    }

    /// Returns whether the part is a ghost; see [`Self::set_ghost`].
    ///
    /// # Panics
    /// If there is no such part.
    #[must_use]
    pub fn is_ghost(&self, part: u32) -> bool {
        self.marks.is_ghost(self.cell_of(part))
    }

    /// Makes a cell a ghost, or restores its segment. No search or contact finds a ghost, but the
    /// line continues across the seams beside it. A hole stays a hole.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn set_ghost(&mut self, cell: usize, is_ghost: bool) {
        assert!(cell < self.num_cells(), "there is no cell {cell}");
        self.marks.set_ghost(cell, is_ghost, self.num_cells());
        self.refresh(cell);
    }
}

impl<N: Real> HeightField<N, 3> {
    /// Makes each cell a ghost if and only if `is_ghost(row, column)` returns `true`; see
    /// [`Self::set_ghost`].
    #[must_use]
    pub fn with_ghosts(mut self, mut is_ghost: impl FnMut(usize, usize) -> bool) -> Self {
        let [rows, columns] = self.pyramid.cells();
        for cell in 0..rows * columns {
            let is_ghost = is_ghost(cell / columns, cell % columns);
            self.marks.set_ghost(cell, is_ghost, rows * columns);
        }
        self.rebuild();
        self
    }

    /// Makes the outermost ring of cells ghosts. Use it for a tile of a terrain whose outermost
    /// heights are samples of the neighbouring tiles: solids then do not catch on the seams between
    /// tiles.
    ///
    /// ```
    /// use impinge::dim3::math::Vector;
    /// use impinge::dim3::shape::HeightField;
    ///
    /// // A tile of 4 x 4 cells, 8 metres wide, and a ring of cells of its neighbours.
    /// let tile = HeightField::<f32>::new(7, 7, vec![0.0; 49], Vector::new(12.0, 1.0, 12.0));
    /// let tile = tile.with_ghost_border();
    /// assert!(tile.height_at(3.9, 0.0).is_some() && tile.height_at(4.1, 0.0).is_none());
    /// assert!(tile.is_ghost(0) && !tile.is_hole(0));
    /// ```
    #[must_use]
    pub fn with_ghost_border(self) -> Self {
        let [last_row, last_column] = self.pyramid.cells().map(|count| count - 1);
        self.with_ghosts(|row, column| {
            row == 0 || row == last_row || column == 0 || column == last_column
        })
    }

    /// Returns whether the part belongs to a ghost cell; see [`Self::set_ghost`].
    ///
    /// # Panics
    /// If there is no such part.
    #[must_use]
    pub fn is_ghost(&self, part: u32) -> bool {
        self.marks.is_ghost(self.locate(part).1)
    }

    /// Makes a cell a ghost, or restores its triangles. No search or contact finds a ghost, but the
    /// surface continues across the seams beside it. Holes in the cell stay holes.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn set_ghost(&mut self, row: usize, column: usize, is_ghost: bool) {
        let (cell, cells) = (self.cell(row, column), self.num_cells());
        self.marks.set_ghost(cell, is_ghost, cells);
        self.refresh(row, column);
    }
}
