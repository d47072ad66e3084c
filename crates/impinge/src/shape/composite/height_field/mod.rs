//! Height fields: a line in 2D, a surface in 3D, given by heights over a grid.
//!
//! Triangles, boxes and seams are computed from the heights on demand. Instead of a tree, only the
//! minimum and maximum height of blocks of cells is stored ([`Pyramid`]). [`mod@grid`] has the code
//! that 2D and 3D share; `segments.rs` is 2D, `triangles.rs` is 3D.
//!
//! ```text
//! column      c           c + 1
//!   row r     a ───────── d         corners of the two parts of a cell, not mirrored:
//!             │ ╲         │         forward (a–c) part 2·cell: a b c part 2·cell + 1: a c d
//!             │     ╲     │         backward (b–d) part 2·cell: a b d part 2·cell + 1: d b c
//!   row r + 1 b ───────── c
//! ```

mod entries;
mod ghosts;
mod grid;
mod marks;
mod pyramid;
mod question;
#[cfg(feature = "serde")]
mod saved;
mod segments;
mod surface;
mod triangles;

pub(crate) use entries::FieldEntries;
pub use marks::{Diagonal, Diagonals};

use self::grid::{Grid, lines};
use self::marks::Marks;
use self::pyramid::Pyramid;
use crate::math::{Real, Vector};
use crate::shape::Revision;
use crate::shape::ShapeError;
use crate::shape::error::finite;

/// A surface over a grid in the plane y = 0 (in 2D: a line over the x axis), given by its heights.
///
/// The field has no thickness: there is no solid below its triangles (segments). Heights are
/// multiplied by the y component of the scale. The other components are the extents of the whole
/// field, which lies symmetrically around the local y axis: the column index grows along +x, the
/// row index along +z. A negative extent reverses this direction, and a negative y component turns
/// the field upside down.
///
/// **Front.** The front is the side towards which heights grow: +y, or −y if the scale's y
/// component is negative. Contacts arise on both sides, or only on the front after `one_sided`.
///
/// **Seams.** Contacts treat the field as one surface (see [`Surface`](crate::shape::Surface)), by
/// the rule and the tolerance of [`TriMesh`](crate::shape::TriMesh).
/// [`Self::with_internal_edges_kept`] disables this.
///
/// **Cells.** Four neighbouring heights form a cell of two triangles, parts `2 · cell` and `2 ·
/// cell + 1`, divided along its [`Diagonal`]. The corners of a triangle run counter-clockwise seen
/// from the front, so in 3D `Face(0)` is the front. In 2D a cell is one part, the segment from one
/// height to the next. Parts may be holes: a hole keeps its part index, but no search finds it, and
/// a seam beside it is a border. Cells may be ghosts: no search finds a ghost, but the surface
/// continues across the seams beside it. So solids do not catch on the seams of a terrain made of
/// many fields (`with_ghost_border`).
///
/// Construction takes one pass over the heights; a change of one height costs O(log n). Memory:
/// about two numbers per height, and a byte per cell once any cell is a hole, a ghost or has a
/// diagonal that differs from the rule.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::{Ray, RayCast};
/// use impinge::dim3::shape::HeightField;
///
/// // A roof: the ridge in the middle runs along x.
/// let heights = vec![0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
/// let mut roof = HeightField::<f32>::new(3, 3, heights, Vector::new(8.0, 2.0, 4.0));
/// assert_eq!(roof.num_cells(), 4);
/// assert_eq!(roof.height_at(3.0, -1.0), Some(1.0), "half way up to a ridge of 2");
///
/// let down = Ray::new(Point::new(3.0, 5.0, -1.0), Vector::new(0.0, -1.0, 0.0));
/// let hit = roof.toi_with_ray(&Isometry::identity(), &down, true);
/// assert_eq!(hit, Some(4.0));
///
/// roof.set_hole(0, 1, true);
/// assert_eq!(roof.toi_with_ray(&Isometry::identity(), &down, true), None);
/// ```
#[derive(Clone)]
pub struct HeightField<N: Real, const D: usize> {
    grid: Grid<N>,
    pyramid: Pyramid<N>,
    marks: Marks,
    scale: Vector<N, D>,
    is_one_sided: bool,
    keeps_internal_edges: bool,
    /// The cache key of the heights, scale and marks; the options are not included.
    revision: Revision,
}

impl<N: Real, const D: usize> HeightField<N, D> {
    /// Returns the unscaled heights, row by row.
    #[must_use]
    pub fn heights(&self) -> &[N] {
        &self.grid.heights
    }

    /// Returns the scale: the extents of the field along x and z, and in y the factor of the
    /// heights.
    #[must_use]
    pub const fn scale(&self) -> &Vector<N, D> {
        &self.scale
    }

    /// Returns the number of cells, including holes and ghosts.
    #[must_use]
    pub fn num_cells(&self) -> usize {
        let [rows, columns] = self.pyramid.cells();
        rows * columns
    }

    /// Returns whether the field is one-sided: no contact arises from behind.
    #[must_use]
    pub const fn is_one_sided(&self) -> bool {
        self.is_one_sided
    }

    /// Makes the field one-sided: no contact arises from behind.
    #[must_use]
    pub const fn one_sided(mut self) -> Self {
        self.is_one_sided = true;
        self
    }

    /// Returns whether contacts treat each part as a separate solid; see
    /// [`Self::with_internal_edges_kept`].
    #[must_use]
    pub const fn keeps_internal_edges(&self) -> bool {
        self.keeps_internal_edges
    }

    /// Makes contacts treat each part as a separate solid, with all its edges and corners, as if it
    /// had no neighbours.
    #[must_use]
    pub const fn with_internal_edges_kept(mut self) -> Self {
        self.keeps_internal_edges = true;
        self
    }

    /// Returns the cache key of the field, including its options.
    fn revision_with_options(&self) -> Revision {
        self.revision.with(&[self.is_one_sided, self.keeps_internal_edges])
    }

    /// Returns the field with the scale `scale` in place of its own. `depth` is the extent along z,
    /// zero in 2D.
    ///
    /// # Errors
    /// If a coordinate is not finite.
    fn with_scale(&self, scale: Vector<N, D>, depth: N) -> Result<Self, ShapeError> {
        let mut scaled = self.clone();
        let heights = std::mem::take(&mut scaled.grid.heights);
        scaled.grid = grid([scaled.grid.zs.len(), scaled.grid.columns], heights, &scale, depth)?;
        Ok(Self { scale, revision: Revision::new(), ..scaled })
    }

    /// Returns the two-sided field over a grid, without holes or ghosts and with forward diagonals.
    fn around(grid: Grid<N>, pyramid: Pyramid<N>, scale: Vector<N, D>) -> Self {
        let marks = Marks::new(Diagonals::Forward);
        let (is_one_sided, keeps_internal_edges, revision) = (false, false, Revision::new());
        Self { grid, pyramid, marks, scale, is_one_sided, keeps_internal_edges, revision }
    }

    /// Returns whether the scale has an odd number of negative components.
    fn is_mirrored(&self) -> bool {
        self.scale.iter().filter(|&&factor| factor < N::ZERO).count() % 2 == 1
    }
}

/// Returns the grid of `rows` along z and `columns` along x; 2D has one row. An error if the number
/// of heights is not their product, or the scale or a height is not finite.
fn grid<N: Real, const D: usize>(
    [rows, columns]: [usize; 2],
    heights: Vec<N>,
    scale: &Vector<N, D>,
    depth: N,
) -> Result<Grid<N>, ShapeError> {
    finite("a component of the scale", scale)?;
    let needed = rows.saturating_mul(columns);
    if heights.len() != needed {
        return Err(ShapeError::WrongHeightCount { given: heights.len(), needed });
    }
    check_heights(&heights, columns, scale[1])?;
    let (xs, zs) = (lines(columns, scale[0]), lines(rows, depth));
    Ok(Grid { columns, heights, xs, zs, y_scale: scale[1] })
}

/// Checks that every height is finite, both unscaled and scaled by `y_scale`.
fn check_heights<N: Real>(heights: &[N], columns: usize, y_scale: N) -> Result<(), ShapeError> {
    let is_bad = |height: &N| !(*height * y_scale).is_finite_number() || !height.is_finite_number();
    match heights.iter().position(is_bad) {
        Some(at) => Err(ShapeError::HeightNotFinite { row: at / columns, column: at % columns }),
        None => Ok(()),
    }
}

/// Checks that there are at least two heights along an axis.
fn check_count(given: usize) -> Result<(), ShapeError> {
    if given < 2 { Err(ShapeError::TooFewHeights { given, needed: 2 }) } else { Ok(()) }
}

/// Checks that `needed` parts fit 32-bit indices.
fn check_parts(needed: u64) -> Result<(), ShapeError> {
    match u32::try_from(needed) {
        Ok(_) => Ok(()),
        Err(_) => Err(ShapeError::TooManyParts { needed }),
    }
}
