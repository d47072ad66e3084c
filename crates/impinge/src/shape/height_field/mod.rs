//! Height fields: a line in the plane, a surface in space, given by heights over a grid.
//!
//! Triangles, boxes and seams are all made from the heights when they are asked for; what is kept is the
//! least and the greatest height of ever larger blocks of cells ([`Pyramid`]), which takes the place of
//! a tree. What the plane and space share stands in [`grid`]; `line.rs` and `sheet.rs` are the two.

mod grid;
mod line;
mod marks;
mod pyramid;
mod question;
mod sheet;

pub use marks::{Diagonal, Diagonals};

use self::grid::{Grid, lines};
use self::marks::Marks;
use self::pyramid::Pyramid;
use super::ShapeError;
use super::error::finite;
use crate::math::{Real, Vector};

/// A surface over a grid in the plane y = 0 (in the plane: a line over the x axis), given by its heights.
///
/// It is as thin as its triangles (segments): below it there is nothing. Heights are multiplied by the
/// y component of the scale. The other components are the extents of the whole field, which lies
/// symmetrically around the local y axis: columns go along x, rows along z, both towards the positive
/// side; a negative extent turns them around, and a negative y component turns the field upside down.
///
/// **Front.** The front is the side that heights grow towards: that of +y, or of −y if the scale's y
/// component is negative. Normally both sides are solid to the touch ([`Self::with_one_side`]).
///
/// **Cells.** Between four neighbouring heights lies a cell of two triangles, parts `2 · cell` and
/// `2 · cell + 1`; which way they divide it says [`Diagonal`]. The corners of a triangle run
/// counter-clockwise seen from the front, so that in space `Face(0)` is the front. In the plane a cell,
/// and part, is the segment from one height to the next. Parts may be removed: such holes keep their
/// number, but no search finds them, and a seam beside one is a border.
///
/// Making it takes one pass over the heights, changing a height time in proportion to the logarithm of
/// their number. Memory: about two numbers per height, and a byte per cell where there are holes or
/// single cells with a diagonal of their own.
///
/// ```
/// use impinge::dim3::na::{Isometry3, Point3, Vector3};
/// use impinge::dim3::query::{PointQuery, Ray, RayCast};
/// use impinge::dim3::shape::HeightField;
///
/// // A roof: the ridge in the middle runs along x.
/// let heights = vec![0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
/// let mut roof = HeightField::<f32>::new(3, 3, heights, Vector3::new(8.0, 2.0, 4.0));
/// assert_eq!(roof.num_cells(), 4);
/// assert_eq!(roof.height_at(3.0, -1.0), Some(1.0), "half way up to a ridge of 2");
///
/// let down = Ray::new(Point3::new(3.0, 5.0, -1.0), Vector3::new(0.0, -1.0, 0.0));
/// let hit = roof.cast_ray(&Isometry3::identity(), &down, f32::MAX, true).expect("it is there");
/// assert_eq!(hit.toi, 4.0);
///
/// roof.set_hole(0, 1, true);
/// assert!(roof.cast_ray(&Isometry3::identity(), &down, f32::MAX, true).is_none());
/// ```
#[derive(Clone, Debug)]
pub struct HeightField<N: Real, const D: usize> {
    grid: Grid<N>,
    pyramid: Pyramid<N>,
    marks: Marks,
    scale: Vector<N, D>,
    is_one_sided: bool,
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

    /// Only the front can be touched: what is behind the surface meets it without contact.
    #[must_use]
    pub const fn is_one_sided(&self) -> bool {
        self.is_one_sided
    }

    /// The same field with only the front to be touched, or with both sides.
    #[must_use]
    pub const fn with_one_side(mut self, is_one_sided: bool) -> Self {
        self.is_one_sided = is_one_sided;
        self
    }

    /// The sign of the front's y: 1 or −1.
    fn up(&self) -> N {
        if self.scale[1] < N::ZERO { -N::ONE } else { N::ONE }
    }
}

/// The grid of rows and columns with `rows[0]` of them along z, or one row in the plane.
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
    if given < 2 { Err(ShapeError::TooFewPoints { given, needed: 2 }) } else { Ok(()) }
}

/// So many parts can be numbered.
fn check_parts(needed: u64) -> Result<(), ShapeError> {
    match u32::try_from(needed) {
        Ok(_) => Ok(()),
        Err(_) => Err(ShapeError::TooManyParts { needed }),
    }
}
