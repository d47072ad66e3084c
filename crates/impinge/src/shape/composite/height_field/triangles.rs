//! Height fields in 3D: two triangles per cell.

use super::entries;
use smallvec::SmallVec;

use super::grid::{Grid, GridCells, GridExtent, whole};
use super::marks::{Diagonal, Diagonals};
use super::pyramid::{HeightSpan, Pyramid, merged, no_span};
use super::{HeightField, check_count, check_heights, check_parts, grid};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Vector, max, max_component, min};
use crate::shape::error::or_panic;
use crate::shape::scale::Scale;
use crate::shape::{
    CompositeShape, Geometry, Part, PartSearch, PartSolid, Revision, ScaleError, Shape, ShapeError,
    ShapeHandle, Surface, SurfaceAccess, Triangle,
};

/// A point of the grid: its row and column.
pub(super) type GridPoint = [usize; 2];

impl<N: Real> HeightField<N, 3> {
    /// Returns the field of rows and columns of heights, given row by row; see [`Self::try_new`].
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(rows: usize, columns: usize, heights: Vec<N>, scale: Vector<N, 3>) -> Self {
        or_panic(Self::try_new(rows, columns, heights, scale))
    }

    /// Returns the field of rows and columns of heights, at least two of each, given row by row.
    /// All diagonals are forward, there are no holes, and contacts arise on both sides.
    ///
    /// # Errors
    /// If there are fewer than two rows or columns, or the number of heights is not their product;
    /// if a component of the scale, a height, or a height times the scale is not finite; or if the
    /// triangles do not fit 32-bit indices.
    pub fn try_new(
        rows: usize,
        columns: usize,
        heights: Vec<N>,
        scale: Vector<N, 3>,
    ) -> Result<Self, ShapeError> {
        check_count(rows)?;
        check_count(columns)?;
        let grid = grid([rows, columns], heights, &scale, scale.z)?;
        check_parts(((rows - 1) * (columns - 1)) as u64 * 2)?;
        let mut field = Self::around(grid, Pyramid::unbuilt([rows - 1, columns - 1]), scale);
        field.rebuild();
        Ok(field)
    }

    /// Sets the diagonals of all cells; holes and ghosts stay.
    #[must_use]
    pub fn with_diagonals(mut self, diagonals: Diagonals) -> Self {
        self.marks = self.marks.with_diagonals(diagonals);
        self.rebuild();
        self
    }

    /// Makes both triangles of each cell holes if and only if `is_hole(row, column)` returns
    /// `true`.
    #[must_use]
    pub fn with_holes(mut self, mut is_hole: impl FnMut(usize, usize) -> bool) -> Self {
        let [rows, columns] = self.pyramid.cells();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)))
        {
            let (cell, is_hole) = (row * columns + column, is_hole(row, column));
            self.marks.set_hole(cell, 0, is_hole, rows * columns);
            self.marks.set_hole(cell, 1, is_hole, rows * columns);
        }
        self.rebuild();
        self
    }

    /// Returns the field scaled along the axes of its frame, about its origin: the scale of the
    /// field is multiplied by `scale`.
    ///
    /// # Errors
    /// If a factor is zero or not finite, or a scaled coordinate is not finite.
    pub fn try_scaled(&self, scale: &Vector<N, 3>) -> Result<Self, ScaleError> {
        let scale = Scale::try_new(scale)?.vector(&self.scale);
        Ok(self.with_scale(scale, scale.z)?)
    }

    /// Returns the number of rows of heights, one more than rows of cells.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.pyramid.cells()[0] + 1
    }

    /// Returns the number of columns of heights, one more than columns of cells.
    #[must_use]
    pub const fn columns(&self) -> usize {
        self.grid.columns
    }

    /// Returns the unscaled height at a row and column.
    ///
    /// # Panics
    /// If there is no such row or column.
    #[must_use]
    pub fn height(&self, row: usize, column: usize) -> N {
        self.check_point(row, column);
        self.grid.height(row, column)
    }

    /// Returns the scaled point of the surface at a row and column.
    ///
    /// # Panics
    /// If there is no such row or column.
    #[must_use]
    pub fn point(&self, row: usize, column: usize) -> Point<N, 3> {
        self.check_point(row, column);
        self.grid.point(row, column)
    }

    /// Returns the index of the cell at a row and column; its triangles are the parts `2 · cell`
    /// and `2 · cell + 1`.
    ///
    /// # Panics
    /// If there is no such cell.
    #[must_use]
    pub fn cell(&self, row: usize, column: usize) -> usize {
        let [rows, columns] = self.pyramid.cells();
        assert!(
            row < rows && column < columns,
            "there is no cell at row {row}, column {column}: there are {rows} × {columns}"
        );
        row * columns + column
    }

    /// Returns the diagonal of the cell at a row and column.
    ///
    /// # Panics
    /// If there is no such cell.
    #[must_use]
    pub fn diagonal(&self, row: usize, column: usize) -> Diagonal {
        let _ = self.cell(row, column);
        self.marks.diagonal([row, column], self.pyramid.cells()[1])
    }

    /// Returns the two triangles of a cell; `None` for a triangle that is a hole or belongs to a
    /// ghost.
    ///
    /// # Panics
    /// If there is no such cell.
    #[must_use]
    pub fn triangles(&self, row: usize, column: usize) -> [Option<Triangle<N, 3>>; 2] {
        let cell = self.cell(row, column);
        [0, 1].map(|k| {
            let triangle = self.triangle_of(self.corners_in(row, column, k));
            Some(triangle).filter(|_| !self.marks.is_untouched(cell, k))
        })
    }

    /// Returns whether the part is a hole.
    ///
    /// # Panics
    /// If there is no such part.
    #[must_use]
    pub fn is_hole(&self, part: u32) -> bool {
        let (_, cell, k) = self.locate(part);
        self.marks.is_hole(cell, k)
    }

    /// Returns the scaled height of the surface at (x, z); `None` beside the field, at a hole and
    /// at a ghost.
    #[must_use]
    pub fn height_at(&self, x: N, z: N) -> Option<N> {
        let over = Vector::<N, 3>::new(x, N::ZERO, z);
        let mut found = None;
        let line = Vector::<N, 3>::new(N::ZERO, N::INFINITY, N::ZERO);
        let column = Aabb::try_new(Point::from(over - line), Point::from(over + line)).ok()?;
        self.overlapping(&column, &mut |part| {
            let corners = self.corners(part).map(|[row, column]| self.grid.point(row, column));
            found = found.or_else(|| height_over(&corners, x, z));
        });
        found
    }
}

/// Methods that modify the field. They do not affect a world that holds the shape: shared shapes
/// are immutable.
impl<N: Real> HeightField<N, 3> {
    /// Sets the unscaled height at a row and column.
    ///
    /// # Errors
    /// If the height, or the height times the scale, is not finite; the field is then unchanged.
    ///
    /// # Panics
    /// If there is no such row or column.
    pub fn set_height(&mut self, row: usize, column: usize, height: N) -> Result<(), ShapeError> {
        self.check_point(row, column);
        check_heights(&[height], 1, self.grid.y_scale)
            .map_err(|_| ShapeError::HeightNotFinite { row, column })?;
        self.grid.heights[row * self.grid.columns + column] = height;
        let [rows, columns] = self.pyramid.cells();
        for near_row in row.saturating_sub(1)..=min_index(row, rows - 1) {
            for near_column in column.saturating_sub(1)..=min_index(column, columns - 1) {
                self.refresh(near_row, near_column);
            }
        }
        Ok(())
    }

    /// Replaces all unscaled heights, given row by row.
    ///
    /// # Errors
    /// If the number of heights differs, or a height or its product with the scale is not finite;
    /// the field is then unchanged.
    pub fn set_heights(&mut self, heights: Vec<N>) -> Result<(), ShapeError> {
        let (given, needed) = (heights.len(), self.grid.heights.len());
        if given != needed {
            return Err(ShapeError::WrongHeightCount { given, needed });
        }
        check_heights(&heights, self.grid.columns, self.grid.y_scale)?;
        self.grid.heights = heights;
        self.rebuild();
        Ok(())
    }

    /// Makes both triangles of a cell holes, or restores them.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn set_hole(&mut self, row: usize, column: usize, is_hole: bool) {
        let (cell, cells) = (self.cell(row, column), self.num_cells());
        self.marks.set_hole(cell, 0, is_hole, cells);
        self.marks.set_hole(cell, 1, is_hole, cells);
        self.refresh(row, column);
    }

    /// Makes one triangle a hole, or restores it; `part` is its index.
    ///
    /// # Panics
    /// If there is no such part.
    pub fn set_part_hole(&mut self, part: u32, is_hole: bool) {
        let ([row, column], cell, k) = self.locate(part);
        self.marks.set_hole(cell, k, is_hole, self.num_cells());
        self.refresh(row, column);
    }

    /// Changes the diagonal of a cell. Its parts keep their indices, and a part that is a hole
    /// stays a hole.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn set_diagonal(&mut self, row: usize, column: usize, diagonal: Diagonal) {
        let _ = self.cell(row, column);
        self.marks.set_diagonal([row, column], self.pyramid.cells(), diagonal);
        self.refresh(row, column);
    }

    pub(super) fn refresh(&mut self, row: usize, column: usize) {
        let mut pyramid = self.pyramid.take();
        pyramid.refresh(row, column, |row, column| self.cell_span(row, column));
        (self.pyramid, self.revision) = (pyramid, Revision::new());
    }

    /// Rebuilds the pyramid after the marks were replaced.
    #[cfg(feature = "serde")]
    pub(in crate::shape) fn with_all_rebuilt(mut self) -> Self {
        self.rebuild();
        self
    }

    pub(super) fn rebuild(&mut self) {
        self.pyramid = entries::pyramid_over(self);
        self.revision = Revision::new();
    }
}

/// Conversions from part indices to triangles.
impl<N: Real> HeightField<N, 3> {
    #[track_caller]
    fn check_point(&self, row: usize, column: usize) {
        let (rows, columns) = (self.rows(), self.columns());
        assert!(
            row < rows && column < columns,
            "there is no height at row {row}, column {column}: there are {rows} × {columns}"
        );
    }

    /// Returns the row and column of the cell of a part, the index of the cell, and 0 or 1 for the
    /// triangle in the cell.
    #[track_caller]
    pub(super) fn locate(&self, part: u32) -> (GridPoint, usize, usize) {
        let (cell, k) = (part as usize / 2, part as usize % 2);
        assert!(cell < self.num_cells(), "there is no part {part}");
        let columns = self.pyramid.cells()[1];
        ([cell / columns, cell % columns], cell, k)
    }

    /// Returns the corners of a part, counter-clockwise seen from the front.
    pub(super) fn corners(&self, part: u32) -> [GridPoint; 3] {
        let ([row, column], _, k) = self.locate(part);
        self.corners_in(row, column, k)
    }

    /// Returns the corners of triangle `k` of the cell at a row and column, counter-clockwise seen
    /// from the front.
    pub(super) fn corners_in(&self, row: usize, column: usize, k: usize) -> [GridPoint; 3] {
        let [a, b, c, d] =
            [[row, column], [row + 1, column], [row + 1, column + 1], [row, column + 1]];
        let diagonal = self.marks.diagonal([row, column], self.pyramid.cells()[1]);
        let corners = match (diagonal, k) {
            (Diagonal::Forward, 0) => [a, b, c],
            (Diagonal::Forward, _) => [a, c, d],
            (Diagonal::Backward, 0) => [a, b, d],
            (Diagonal::Backward, _) => [d, b, c],
        };
        // A mirroring scale reverses the winding.
        let [first, second, third] = corners;
        if self.is_mirrored() { [first, third, second] } else { corners }
    }

    fn triangle_of(&self, corners: [GridPoint; 3]) -> Triangle<N, 3> {
        Triangle::of_finite(corners.map(|[row, column]| self.grid.point(row, column)))
    }

    /// Returns whether triangle `k` of the cell at a row and column is a hole.
    pub(super) fn is_hole_in(&self, row: usize, column: usize, k: usize) -> bool {
        self.marks.is_hole(row * self.pyramid.cells()[1] + column, k)
    }
}

/// Returns the range of the unscaled heights at the four corners of a cell, regardless of holes.
fn square_span<N: Real>(grid: &Grid<N>, row: usize, column: usize) -> HeightSpan<N> {
    let above = row * grid.columns + column;
    let below = above + grid.columns;
    let [a, b] = [grid.heights[above], grid.heights[above + 1]];
    let [c, d] = [grid.heights[below], grid.heights[below + 1]];
    [min(min(a, b), min(c, d)), max(max(a, b), max(c, d))]
}

fn min_index(a: usize, b: usize) -> usize {
    if a < b { a } else { b }
}

/// Returns the height of a triangle at (x, z); `None` outside the triangle, and for a triangle
/// without area seen along y.
fn height_over<N: Real>(corners: &[Point<N, 3>; 3], x: N, z: N) -> Option<N> {
    let [a, b, c] = corners;
    // Measured from (x, z), so `side(p, q)` is exactly `-side(q, p)`: a point at a side of two
    // triangles is beside at most one of them.
    let xs = in_own_unit([a.x - x, b.x - x, c.x - x]);
    let zs = in_own_unit([a.z - z, b.z - z, c.z - z]);
    let side = |p: usize, q: usize| xs[q] * zs[p] - zs[q] * xs[p];
    let weights = [side(1, 2), side(2, 0), side(0, 1)];
    let total = weights[0] + weights[1] + weights[2];
    let is_beside = weights.iter().any(|weight| *weight * total < N::ZERO);
    if is_beside || total == N::ZERO {
        return None;
    }
    let high = max(max(a.y, b.y), c.y);
    let low = min(min(a.y, b.y), c.y);
    let height = a.y + (b.y - a.y) * (weights[1] / total) + (c.y - a.y) * (weights[2] / total);
    Some(max(min(height, high), low))
}

/// Returns three lengths divided by a power of two near the largest of them, so that products of
/// results neither overflow nor underflow.
fn in_own_unit<N: Real>(lengths: [N; 3]) -> [N; 3] {
    let unit = max_component(&Vector::<N, 3>::from(lengths)).power_of_two_below();
    lengths.map(|length| length / unit)
}

impl<N: Real> GridCells<N> for HeightField<N, 3> {
    fn grid(&self) -> &Grid<N> {
        &self.grid
    }

    fn pyramid(&self) -> &Pyramid<N> {
        &self.pyramid
    }

    fn cell_span(&self, row: usize, column: usize) -> HeightSpan<N> {
        let cell = row * self.pyramid.cells()[1] + column;
        let is_untouched = [0, 1].map(|k| self.marks.is_untouched(cell, k));
        if is_untouched == [false, false] {
            return square_span(&self.grid, row, column);
        }
        let rest = [0, 1].into_iter().filter(|&k| !is_untouched[k]);
        let corners = rest.flat_map(|k| self.corners_in(row, column, k));
        let heights = corners.map(|[row, column]| self.grid.height(row, column));
        heights.map(|height| [height, height]).fold(no_span(), merged)
    }

    fn parts(&self, row: usize, column: usize) -> SmallVec<[(u32, GridExtent<N>); 2]> {
        let cell = row * self.pyramid.cells()[1] + column;
        let mut parts = SmallVec::new();
        for (k, number) in [(0, 0), (1, 1)] {
            if !self.marks.is_untouched(cell, k) {
                let corners = self.corners_in(row, column, k);
                let points = corners.map(|[row, column]| self.grid.at(row, column));
                let first = u32::try_from(2 * cell).expect("32 bits number the triangles");
                parts.push((first + number, GridExtent::around(&points)));
            }
        }
        parts
    }
}

impl<N: Real> PartSearch<N, 3> for HeightField<N, 3> {
    fn bounds(&self) -> Aabb<N, 3> {
        self.local_aabb()
    }

    fn overlapping(&self, aabb: &Aabb<N, 3>, visit: &mut dyn FnMut(u32)) {
        entries::cells_overlapping(self, aabb, visit);
    }

    fn nearest(&self, aabb: &Aabb<N, 3>, limit: N, visit: &mut dyn FnMut(u32, N) -> N) {
        entries::nearest_cells(self, aabb, limit, visit);
    }

    fn cast(
        &self,
        aabb: &Aabb<N, 3>,
        velocity: &Vector<N, 3>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        entries::first_cells(self, aabb, velocity, limit, visit);
    }
}

impl<N: Real> CompositeShape<N, 3> for HeightField<N, 3> {
    fn num_parts(&self) -> u32 {
        u32::try_from(2 * self.num_cells()).expect("32 bits number the triangles")
    }

    /// Returns the triangle of a part, also of a hole or a ghost.
    fn part(&self, part: u32) -> Part<'_, N, 3> {
        let triangle = self.triangle_of(self.corners(part));
        Part { pose: Pose::identity(), solid: PartSolid::Triangle(triangle) }
    }

    fn search(&self) -> &dyn PartSearch<N, 3> {
        self
    }

    fn revision(&self) -> Option<Revision> {
        Some(self.revision_with_options())
    }

    fn surface(&self) -> Option<&dyn Surface<N, 3>> {
        (self.is_one_sided || !self.keeps_internal_edges).then_some(self)
    }

    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, 3>> {
        self.surface().map(|_| SurfaceAccess::of_own(self))
    }

    /// Visits the indices of the triangle's grid points, counted row by row.
    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        for [row, column] in self.corners(part) {
            visit((row * self.grid.columns + column) as u64);
        }
    }

    fn has_ghosts(&self) -> bool {
        self.marks.has_ghosts()
    }

    fn built_in(&self) -> Option<&dyn Shape<N, 3>> {
        Some(self)
    }
}

impl<N: Real> Shape<N, 3> for HeightField<N, 3> {
    fn geometry(&self) -> Geometry<'_, N, 3> {
        Geometry::composite(self)
    }

    /// Returns the box of the field: in x and z around all cells, in y around the parts that are
    /// neither holes nor ghosts; the origin if there are no such parts.
    fn local_aabb(&self) -> Aabb<N, 3> {
        match whole(self) {
            Some(extent) => Aabb::new(Point::from(extent.low), Point::from(extent.high)),
            None => Aabb::around(Point::origin(), Vector::<N, 3>::zeros()),
        }
    }

    fn scaled(&self, scale: &Vector<N, 3>) -> Result<ShapeHandle<N, 3>, ScaleError> {
        Ok(ShapeHandle::new(self.try_scaled(scale)?))
    }
}
