//! Height fields: a line in 2D, a surface in 3D, given by heights over a grid.
//!
//! Triangles, boxes and seams are all made from the heights when they are asked for; what is kept is the
//! least and the greatest height of ever larger blocks of cells ([`Pyramid`]), which takes the place of
//! a tree. What the plane and space share stands in [`grid`]; `line.rs` and `sheet.rs` are the two.

mod entries;
mod grid;
mod line;
mod marks;
mod pyramid;
mod question;
mod sheet;
mod surface;

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
/// It is as thin as its triangles (segments): below it there is nothing. Heights are multiplied by the
/// y component of the scale. The other components are the extents of the whole field, which lies
/// symmetrically around the local y axis: columns go along x, rows along z, both towards the positive
/// side; a negative extent turns them around, and a negative y component turns the field upside down.
///
/// **Front.** The front is the side that heights grow towards: that of +y, or of −y if the scale's y
/// component is negative. Both sides can be touched, or the front alone if asked by `one_sided`.
///
/// **Seams.** Contacts see the field as one surface (see [`Surface`](crate::shape::Surface)), with the rule and
/// the tolerance that [`TriMesh`](crate::shape::TriMesh) has. [`Self::with_internal_edges_kept`] switches
/// this off.
///
/// **Cells.** Between four neighbouring heights lies a cell of two triangles, parts `2 · cell` and
/// `2 · cell + 1`; which way they divide it says [`Diagonal`]. The corners of a triangle run
/// counter-clockwise seen from the front, so that in 3D `Face(0)` is the front. In 2D a cell,
/// and part, is the segment from one height to the next. Parts may be removed: such holes keep their
/// number, but no search finds them, and a seam beside one is a border.
///
/// Making it takes one pass over the heights, changing a height time in proportion to the logarithm of
/// their number. Memory: about two numbers per height, and a byte per cell where there are holes or
/// single cells with a diagonal of their own.
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
    /// Without the options.
    revision: Revision,
}

impl<N: Real, const D: usize> HeightField<N, D> {
    /// The unscaled heights, row by row.
    #[must_use]
    pub fn heights(&self) -> &[N] {
        &self.grid.heights
    }

    /// The extents of the field, and what heights are multiplied by.
    #[must_use]
    pub const fn scale(&self) -> &Vector<N, D> {
        &self.scale
    }

    /// How many cells there are, holes included.
    #[must_use]
    pub fn num_cells(&self) -> usize {
        let [rows, columns] = self.pyramid.cells();
        rows * columns
    }

    /// Nothing touches the field from behind.
    #[must_use]
    pub const fn is_one_sided(&self) -> bool {
        self.is_one_sided
    }

    /// Lets nothing touch the field from behind.
    #[must_use]
    pub const fn one_sided(mut self) -> Self {
        self.is_one_sided = true;
        self
    }

    /// Contacts treat each part on its own; see [`Self::with_internal_edges_kept`].
    #[must_use]
    pub const fn keeps_internal_edges(&self) -> bool {
        self.keeps_internal_edges
    }

    /// Makes contacts treat each part on its own, with all its edges and corners, as if it had no
    /// neighbours.
    #[must_use]
    pub const fn with_internal_edges_kept(mut self) -> Self {
        self.keeps_internal_edges = true;
        self
    }

    /// Names the field with its options.
    fn named(&self) -> Revision {
        self.revision.with(&[self.is_one_sided, self.keeps_internal_edges])
    }

    /// The same field with other extents, those along z in `depth`.
    fn with_scale(&self, scale: Vector<N, D>, depth: N) -> Result<Self, ShapeError> {
        let mut scaled = self.clone();
        let heights = std::mem::take(&mut scaled.grid.heights);
        scaled.grid = grid([scaled.grid.zs.len(), scaled.grid.columns], heights, &scale, depth)?;
        Ok(Self { scale, revision: Revision::new(), ..scaled })
    }

    /// The field between these lines: both sides can be touched, and contacts see one surface.
    fn around(grid: Grid<N>, pyramid: Pyramid<N>, scale: Vector<N, D>) -> Self {
        let marks = Marks::new(Diagonals::Forward);
        let (is_one_sided, keeps_internal_edges, revision) = (false, false, Revision::new());
        Self { grid, pyramid, marks, scale, is_one_sided, keeps_internal_edges, revision }
    }

    /// The scale has an odd number of negative components.
    fn is_mirrored(&self) -> bool {
        self.scale.iter().filter(|&&factor| factor < N::ZERO).count() % 2 == 1
    }
}

/// The grid of rows and columns with `rows[0]` of them along z, or one row in 2D.
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

/// Every height is finite, also times the scale.
fn check_heights<N: Real>(heights: &[N], columns: usize, y_scale: N) -> Result<(), ShapeError> {
    let is_bad = |height: &N| !(*height * y_scale).is_finite_number() || !height.is_finite_number();
    match heights.iter().position(is_bad) {
        Some(at) => Err(ShapeError::HeightNotFinite { row: at / columns, column: at % columns }),
        None => Ok(()),
    }
}

/// Two along an axis at least.
fn check_count(given: usize) -> Result<(), ShapeError> {
    if given < 2 { Err(ShapeError::TooFewHeights { given, needed: 2 }) } else { Ok(()) }
}

/// So many parts can be numbered.
fn check_parts(needed: u64) -> Result<(), ShapeError> {
    match u32::try_from(needed) {
        Ok(_) => Ok(()),
        Err(_) => Err(ShapeError::TooManyParts { needed }),
    }
}
