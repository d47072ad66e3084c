//! Height fields in 2D: one segment per cell.

use super::entries;
use smallvec::{SmallVec, smallvec};

use super::grid::{Grid, GridCells, GridExtent, whole};
use super::pyramid::{HeightSpan, Pyramid, merged, no_span};
use super::{HeightField, check_count, check_heights, check_parts, grid};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::error::or_panic;
use crate::shape::scale::Scale;
use crate::shape::{
    CompositeShape, Geometry, Part, PartSearch, PartSolid, Revision, ScaleError, Segment, Shape,
    ShapeError, ShapeHandle, Surface, SurfaceAccess,
};

impl<N: Real> HeightField<N, 2> {
    /// Returns the field of the given heights; see [`Self::try_new`].
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(heights: Vec<N>, scale: Vector<N, 2>) -> Self {
        or_panic(Self::try_new(heights, scale))
    }

    /// Returns the field of the given heights, at least two. There are no holes, and contacts arise
    /// on both sides.
    ///
    /// # Errors
    /// If there are fewer than two heights; if a component of the scale, a height, or a height
    /// times the scale is not finite; or if the segments do not fit 32-bit indices.
    pub fn try_new(heights: Vec<N>, scale: Vector<N, 2>) -> Result<Self, ShapeError> {
        check_count(heights.len())?;
        check_parts(heights.len() as u64 - 1)?;
        let grid = grid([1, heights.len()], heights, &scale, N::ZERO)?;
        let pyramid = Pyramid::unbuilt([1, grid.columns - 1]);
        let mut field = Self::around(grid, pyramid, scale);
        field.rebuild();
        Ok(field)
    }

    /// Makes each cell a hole if and only if `is_hole(cell)` returns `true`.
    #[must_use]
    pub fn with_holes(mut self, mut is_hole: impl FnMut(usize) -> bool) -> Self {
        let cells = self.num_cells();
        for cell in 0..cells {
            self.marks.set_hole(cell, 0, is_hole(cell), cells);
        }
        self.rebuild();
        self
    }

    /// Returns the field scaled along the axes of its frame, about its origin: the scale of the
    /// field is multiplied by `scale`.
    ///
    /// # Errors
    /// If a factor is zero or not finite, or a scaled coordinate is not finite.
    pub fn try_scaled(&self, scale: &Vector<N, 2>) -> Result<Self, ScaleError> {
        let scale = Scale::try_new(scale)?.vector(&self.scale);
        Ok(self.with_scale(scale, N::ZERO)?)
    }

    /// Returns the unscaled height at `index`.
    ///
    /// # Panics
    /// If `index` is not below the number of heights.
    #[must_use]
    pub fn height(&self, index: usize) -> N {
        self.grid.heights[index]
    }

    /// Returns the point of the line that has the height with index `index`, with the scale
    /// applied.
    ///
    /// # Panics
    /// If `index` is not below the number of heights.
    #[must_use]
    pub fn point(&self, index: usize) -> Point<N, 2> {
        let [x, y, _] = self.grid.at(0, index);
        Point::<N, 2>::new(x, y)
    }

    /// Returns the segment of a cell, from point `cell` to the next point; `None` for a hole or a
    /// ghost.
    ///
    /// # Panics
    /// If there is no such cell.
    #[must_use]
    pub fn segment(&self, cell: usize) -> Option<Segment<N, 2>> {
        let segment = Segment::new(self.point(cell), self.point(cell + 1));
        Some(segment).filter(|_| !self.marks.is_untouched(cell, 0))
    }

    /// Returns whether the part is a hole. The index of a part equals the index of its cell.
    ///
    /// # Panics
    /// If there is no such part.
    #[must_use]
    pub fn is_hole(&self, part: u32) -> bool {
        self.marks.is_hole(self.cell_of(part), 0)
    }

    /// Returns the scaled height of the line at `x`; `None` beside the field, at a hole and at a
    /// ghost.
    #[must_use]
    pub fn height_at(&self, x: N) -> Option<N> {
        let ends = [-N::INFINITY, N::INFINITY].map(|y| Point::<N, 2>::new(x, y));
        let column = Aabb::try_new(ends[0], ends[1]).ok()?;
        let mut found = None;
        self.overlapping(&column, &mut |part| {
            let [a, b] = [part as usize, part as usize + 1].map(|index| self.point(index));
            let run = b.x - a.x;
            let share = if run == N::ZERO { N::ZERO } else { (x - a.x) / run };
            found = found.or(Some(a.y + (b.y - a.y) * share));
        });
        found
    }

    /// Sets the unscaled height at `index`.
    ///
    /// # Errors
    /// If the height, or the height times the scale, is not finite; the field is then unchanged.
    ///
    /// # Panics
    /// If `index` is not below the number of heights.
    pub fn set_height(&mut self, index: usize, height: N) -> Result<(), ShapeError> {
        check_heights(&[height], 1, self.grid.y_scale)
            .map_err(|_| ShapeError::HeightNotFinite { row: 0, column: index })?;
        self.grid.heights[index] = height;
        for cell in [index.checked_sub(1), Some(index)].into_iter().flatten() {
            if cell < self.num_cells() {
                self.refresh(cell);
            }
        }
        Ok(())
    }

    /// Replaces all unscaled heights.
    ///
    /// # Errors
    /// If the number of heights differs, or a height or its product with the scale is not finite;
    /// the field is then unchanged.
    pub fn set_heights(&mut self, heights: Vec<N>) -> Result<(), ShapeError> {
        let (given, needed) = (heights.len(), self.grid.heights.len());
        if given != needed {
            return Err(ShapeError::WrongHeightCount { given, needed });
        }
        check_heights(&heights, needed, self.grid.y_scale)?;
        self.grid.heights = heights;
        self.rebuild();
        Ok(())
    }

    /// Makes a cell a hole, or restores its segment.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn set_hole(&mut self, cell: usize, is_hole: bool) {
        assert!(cell < self.num_cells(), "there is no cell {cell}");
        self.marks.set_hole(cell, 0, is_hole, self.num_cells());
        self.refresh(cell);
    }

    pub(super) fn refresh(&mut self, cell: usize) {
        let mut pyramid = self.pyramid.take();
        pyramid.refresh(0, cell, |row, column| self.cell_span(row, column));
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

    #[track_caller]
    pub(super) fn cell_of(&self, part: u32) -> usize {
        assert!((part as usize) < self.num_cells(), "there is no part {part}");
        part as usize
    }
}

/// Returns the range of the unscaled heights at the two ends of a cell.
fn step_span<N: Real>(grid: &Grid<N>, cell: usize) -> HeightSpan<N> {
    let [a, b] = [grid.heights[cell], grid.heights[cell + 1]];
    merged([a, a], [b, b])
}

impl<N: Real> GridCells<N> for HeightField<N, 2> {
    fn grid(&self) -> &Grid<N> {
        &self.grid
    }

    fn pyramid(&self) -> &Pyramid<N> {
        &self.pyramid
    }

    fn cell_span(&self, _: usize, cell: usize) -> HeightSpan<N> {
        if self.marks.is_untouched(cell, 0) { no_span() } else { step_span(&self.grid, cell) }
    }

    fn parts(&self, _: usize, cell: usize) -> SmallVec<[(u32, GridExtent<N>); 2]> {
        if self.marks.is_untouched(cell, 0) {
            return SmallVec::new();
        }
        let extent = GridExtent::between(self.grid.at(0, cell), self.grid.at(0, cell + 1));
        smallvec![(u32::try_from(cell).expect("32 bits number the segments"), extent)]
    }
}

impl<N: Real> PartSearch<N, 2> for HeightField<N, 2> {
    fn bounds(&self) -> Aabb<N, 2> {
        self.local_aabb()
    }

    fn overlapping(&self, aabb: &Aabb<N, 2>, visit: &mut dyn FnMut(u32)) {
        entries::cells_overlapping(self, aabb, visit);
    }

    fn nearest(&self, aabb: &Aabb<N, 2>, limit: N, visit: &mut dyn FnMut(u32, N) -> N) {
        entries::nearest_cells(self, aabb, limit, visit);
    }

    fn cast(
        &self,
        aabb: &Aabb<N, 2>,
        velocity: &Vector<N, 2>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        entries::first_cells(self, aabb, velocity, limit, visit);
    }
}

impl<N: Real> CompositeShape<N, 2> for HeightField<N, 2> {
    fn num_parts(&self) -> u32 {
        u32::try_from(self.num_cells()).expect("32 bits number the segments")
    }

    /// Returns the segment of a part, also of a hole or a ghost.
    fn part(&self, part: u32) -> Part<'_, N, 2> {
        let cell = self.cell_of(part);
        let segment = Segment::new(self.point(cell), self.point(cell + 1));
        Part { pose: Pose::identity(), solid: PartSolid::Segment(segment) }
    }

    fn search(&self) -> &dyn PartSearch<N, 2> {
        self
    }

    fn revision(&self) -> Option<Revision> {
        Some(self.revision_with_options())
    }

    fn surface(&self) -> Option<&dyn Surface<N, 2>> {
        (self.is_one_sided || !self.keeps_internal_edges).then_some(self)
    }

    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, 2>> {
        self.surface().map(|_| SurfaceAccess::of_own(self))
    }

    /// Visits the indices of the two heights at the ends of the segment.
    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        visit(part.into());
        visit(u64::from(part) + 1);
    }

    fn has_ghosts(&self) -> bool {
        self.marks.has_ghosts()
    }

    fn built_in(&self) -> Option<&dyn Shape<N, 2>> {
        Some(self)
    }
}

impl<N: Real> Shape<N, 2> for HeightField<N, 2> {
    fn geometry(&self) -> Geometry<'_, N, 2> {
        Geometry::composite(self)
    }

    /// Returns the box of the field: in x around all cells, in y around the parts that are neither
    /// holes nor ghosts; the origin if there are no such parts.
    fn local_aabb(&self) -> Aabb<N, 2> {
        match whole(self) {
            Some(GridExtent { low, high }) => {
                Aabb::new(Point::<N, 2>::new(low[0], low[1]), Point::<N, 2>::new(high[0], high[1]))
            }
            None => Aabb::around(Point::origin(), Vector::<N, 2>::zeros()),
        }
    }

    fn scaled(&self, scale: &Vector<N, 2>) -> Result<ShapeHandle<N, 2>, ScaleError> {
        Ok(ShapeHandle::new(self.try_scaled(scale)?))
    }
}
