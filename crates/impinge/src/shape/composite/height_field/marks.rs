//! Exceptions of single cells: holes, ghosts, and diagonals that differ from the rule.

/// The diagonal of a cell: the two corners that the common side of its two triangles joins.
///
/// Rows and columns are counted in the grid of heights. Triangle 0 of a cell has the side between
/// the cell's two corners with the smaller column index.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::shape::{Diagonal, HeightField};
///
/// let mut field = HeightField::new(2, 2, vec![0.0_f32, 0.0, 0.0, 1.0], Vector::repeat(1.0));
/// assert_eq!(field.diagonal(0, 0), Diagonal::Forward);
/// field.set_diagonal(0, 0, Diagonal::Backward);
/// assert_eq!(field.diagonal(0, 0), Diagonal::Backward);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Diagonal {
    /// From (row, column) to (row + 1, column + 1).
    #[default]
    Forward,
    /// From (row, column + 1) to (row + 1, column).
    Backward,
}

/// The rule that sets the diagonals of all cells of a height field.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::shape::{Diagonals, HeightField};
///
/// let field = HeightField::new(2, 3, vec![0.0_f32; 6], Vector::repeat(1.0));
/// let field = field.with_diagonals(Diagonals::Zigzag);
/// assert_ne!(field.diagonal(0, 0), field.diagonal(0, 1));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Diagonals {
    /// Every diagonal is [`Diagonal::Forward`].
    #[default]
    Forward,
    /// Every diagonal is [`Diagonal::Backward`].
    Backward,
    /// A chessboard pattern: forward where row + column is even, else backward.
    Zigzag,
}

impl Diagonals {
    const fn of(self, row: usize, column: usize) -> Diagonal {
        let is_backward = match self {
            Self::Forward => false,
            Self::Backward => true,
            Self::Zigzag => (row + column) % 2 == 1,
        };
        if is_backward { Diagonal::Backward } else { Diagonal::Forward }
    }
}

/// The rule for the diagonals of all cells, and the exceptions of single cells.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks {
    diagonals: Diagonals,
    /// For each cell: bits 0 and 1 mark part 0 and 1 as holes, bit 2 reverses the diagonal, bit 3
    /// marks a ghost. Empty until a cell is marked.
    bits: Vec<u8>,
    /// The number of ghost cells.
    ghosts: usize,
}

const OTHER_DIAGONAL: u8 = 4;
const GHOST: u8 = 8;

impl Marks {
    /// Returns marks without exceptions.
    pub(super) const fn new(diagonals: Diagonals) -> Self {
        Self { diagonals, bits: Vec::new(), ghosts: 0 }
    }

    /// Returns these marks with the rule `diagonals`. Diagonals of single cells that differed from
    /// the previous rule are reset to the new rule; holes and ghosts stay.
    pub(super) fn with_diagonals(mut self, diagonals: Diagonals) -> Self {
        self.bits.iter_mut().for_each(|bits| *bits &= !OTHER_DIAGONAL);
        Self { diagonals, ..self }
    }

    /// Returns the rule and the bits of each cell; the bits are empty if no cell was ever marked.
    #[cfg(feature = "serde")]
    pub(super) fn parts(&self) -> (Diagonals, &[u8]) {
        (self.diagonals, &self.bits)
    }

    /// Restores the marks that [`Self::parts`] returned; `bits` is empty or has one entry per cell.
    #[cfg(feature = "serde")]
    pub(super) fn of_parts(diagonals: Diagonals, bits: Vec<u8>) -> Self {
        let ghosts = bits.iter().filter(|&bits| bits & GHOST != 0).count();
        Self { diagonals, bits, ghosts }
    }

    /// Returns whether part `k`, 0 or 1, of a cell is a hole.
    pub(super) fn is_hole(&self, cell: usize, k: usize) -> bool {
        self.has(cell, 1 << k)
    }

    pub(super) fn set_hole(&mut self, cell: usize, k: usize, is_hole: bool, cells: usize) {
        self.set(cell, 1 << k, is_hole, cells);
    }

    /// Returns whether the cell is a ghost: its parts continue the surface across the seams around
    /// it, but no query finds them.
    pub(super) fn is_ghost(&self, cell: usize) -> bool {
        self.has(cell, GHOST)
    }

    pub(super) const fn has_ghosts(&self) -> bool {
        self.ghosts > 0
    }

    pub(super) fn set_ghost(&mut self, cell: usize, is_ghost: bool, cells: usize) {
        self.ghosts += usize::from(is_ghost);
        self.ghosts -= usize::from(self.is_ghost(cell));
        self.set(cell, GHOST, is_ghost, cells);
    }

    /// Returns whether queries skip part `k` of a cell: the part is a hole, or the cell is a ghost.
    pub(super) fn is_untouched(&self, cell: usize, k: usize) -> bool {
        self.has(cell, 1 << k | GHOST)
    }

    /// Returns the diagonal of the cell at `row` and `column`, in a grid of `columns` cells per
    /// row.
    pub(super) fn diagonal(&self, [row, column]: [usize; 2], columns: usize) -> Diagonal {
        let default_diagonal = self.diagonals.of(row, column);
        match (default_diagonal, self.has(row * columns + column, OTHER_DIAGONAL)) {
            (default_diagonal, false) => default_diagonal,
            (Diagonal::Forward, true) => Diagonal::Backward,
            (Diagonal::Backward, true) => Diagonal::Forward,
        }
    }

    pub(super) fn set_diagonal(
        &mut self,
        [row, column]: [usize; 2],
        [rows, columns]: [usize; 2],
        diagonal: Diagonal,
    ) {
        let is_other = diagonal != self.diagonals.of(row, column);
        self.set(row * columns + column, OTHER_DIAGONAL, is_other, rows * columns);
    }

    fn has(&self, cell: usize, bit: u8) -> bool {
        self.bits.get(cell).is_some_and(|bits| bits & bit != 0)
    }

    fn set(&mut self, cell: usize, bit: u8, is_set: bool, cells: usize) {
        if self.bits.is_empty() && is_set {
            self.bits = vec![0; cells];
        }
        if let Some(bits) = self.bits.get_mut(cell) {
            *bits = if is_set { *bits | bit } else { *bits & !bit };
        }
    }
}
