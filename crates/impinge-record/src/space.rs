//! The requirements of recordings on scalar and dimension.

use impinge::math::{Point, Real, Space};
use impinge::shape::{
    Cone, ConvexHull, ConvexPolygon, Cylinder, Diagonal, HeightField, MeshError, Polyline, Shape,
    ShapeHandle, Tetrahedron, TriMesh,
};

use crate::Problem;
use crate::shape_data::{Field, ShapeData};

/// The scalars of recordings: `f32` and `f64`.
pub trait Scalar: Real {
    /// The number of bytes of a number.
    const BYTES: usize;
}

impl Scalar for f32 {
    const BYTES: usize = 4;
}

impl Scalar for f64 {
    const BYTES: usize = 8;
}

/// A scalar and a dimension whose worlds can be recorded: every [`Scalar`] with `D` = 2 and `D` =
/// 3.
pub trait Recordable<const D: usize>: Space<D> + Scalar {
    /// The number of scalars that represent an isometry.
    const ISOMETRY_NUMBERS: usize;

    /// Returns the scalars of an isometry: the translation, then the cosine and sine of the
    /// rotation in 2D, or the components i, j, k, w of its quaternion in 3D. The scalars of the
    /// rotation are not normalized, since that could change bits.
    fn isometry_numbers(isometry: &Self::Isometry) -> Vec<Self> {
        Self::numbers(isometry)[..Self::ISOMETRY_NUMBERS].to_vec()
    }

    /// Returns the isometry with these scalars. Its rotation is not normalized. `None` if the
    /// number of scalars is wrong.
    fn isometry_of(numbers: &[Self]) -> Option<Self::Isometry> {
        let mut padded = [Self::ZERO; 7];
        padded[..Self::ISOMETRY_NUMBERS].copy_from_slice(numbers.get(..Self::ISOMETRY_NUMBERS)?);
        (numbers.len() == Self::ISOMETRY_NUMBERS).then(|| Self::of_numbers(&padded))
    }

    /// Converts a shape to data if its type exists in this dimension but not in the other; `None`
    /// for other shapes.
    fn own_data(shape: &dyn Shape<Self, D>) -> Option<ShapeData<Self, D>>;

    /// Creates a shape from the data of [`Self::own_data`].
    ///
    /// # Errors
    /// If the library rejects the values, or if this dimension has no such shape.
    fn own_shape(data: &ShapeData<Self, D>) -> Result<ShapeHandle<Self, D>, Problem>;

    /// Returns the one-sided polyline in 2D; in 3D the polyline itself.
    fn one_sided_line(line: Polyline<Self, D>) -> Polyline<Self, D>;

    /// Returns the one-sided mesh in 3D; in 2D the mesh itself.
    fn one_sided_mesh(mesh: TriMesh<Self, D>) -> TriMesh<Self, D>;

    /// Returns the solid polyline in 2D; in 3D the polyline itself.
    ///
    /// # Errors
    /// If the polyline bounds no area or is inside out.
    fn solid_line(line: Polyline<Self, D>) -> Result<Polyline<Self, D>, MeshError>;

    /// Returns the solid mesh in 3D; in 2D the mesh itself, since 2D meshes are filled.
    ///
    /// # Errors
    /// If the mesh bounds no volume or is inside out.
    fn solid_mesh(mesh: TriMesh<Self, D>) -> Result<TriMesh<Self, D>, MeshError>;
}

/// The problem of data for a shape that this dimension does not have.
const FOREIGN: Problem = Problem::BadValue { what: "the kind of a shape" };

impl<N: Scalar> Recordable<2> for N {
    const ISOMETRY_NUMBERS: usize = 4;

    fn own_data(shape: &dyn Shape<N, 2>) -> Option<ShapeData<N, 2>> {
        if let Some(polygon) = shape.as_shape::<ConvexPolygon<N>>() {
            return Some(ShapeData::Outline(polygon.vertices().to_vec()));
        }
        shape.as_shape::<HeightField<N, 2>>().map(|field| ShapeData::HeightField(line_data(field)))
    }

    fn own_shape(data: &ShapeData<N, 2>) -> Result<ShapeHandle<N, 2>, Problem> {
        match data {
            ShapeData::Outline(points) => Ok(ShapeHandle::new(ConvexPolygon::try_new(points)?)),
            ShapeData::HeightField(field) => Ok(ShapeHandle::new(line_of(field)?)),
            _ => Err(FOREIGN),
        }
    }

    fn one_sided_line(line: Polyline<N, 2>) -> Polyline<N, 2> {
        line.one_sided()
    }

    fn one_sided_mesh(mesh: TriMesh<N, 2>) -> TriMesh<N, 2> {
        mesh
    }

    fn solid_line(line: Polyline<N, 2>) -> Result<Polyline<N, 2>, MeshError> {
        line.try_solid()
    }

    fn solid_mesh(mesh: TriMesh<N, 2>) -> Result<TriMesh<N, 2>, MeshError> {
        Ok(mesh)
    }
}

impl<N: Scalar> Recordable<3> for N {
    const ISOMETRY_NUMBERS: usize = 7;

    fn own_data(shape: &dyn Shape<N, 3>) -> Option<ShapeData<N, 3>> {
        if let Some(hull) = shape.as_shape::<ConvexHull<N>>() {
            let faces = hull.faces().iter().map(|face| hull.face_vertices(face).to_vec());
            return Some(hull_data(hull, faces.collect()));
        }
        if let Some(cylinder) = shape.as_shape::<Cylinder<N>>() {
            return Some(ShapeData::Cylinder([cylinder.half_height(), cylinder.radius()]));
        }
        if let Some(cone) = shape.as_shape::<Cone<N>>() {
            return Some(ShapeData::Cone([cone.half_height(), cone.radius()]));
        }
        if let Some(tetrahedron) = shape.as_shape::<Tetrahedron<N>>() {
            return Some(ShapeData::Tetrahedron(*tetrahedron.corners()));
        }
        shape.as_shape::<HeightField<N, 3>>().map(|field| ShapeData::HeightField(sheet_data(field)))
    }

    fn own_shape(data: &ShapeData<N, 3>) -> Result<ShapeHandle<N, 3>, Problem> {
        Ok(match data {
            ShapeData::Hull { points, faces } => ShapeHandle::new(hull_of(points, faces)?),
            ShapeData::Cylinder([height, radius]) => {
                ShapeHandle::new(Cylinder::try_new(*height, *radius)?)
            }
            ShapeData::Cone([height, radius]) => ShapeHandle::new(Cone::try_new(*height, *radius)?),
            ShapeData::Tetrahedron(corners) => ShapeHandle::new(Tetrahedron::try_new(*corners)?),
            ShapeData::HeightField(field) => ShapeHandle::new(sheet_of(field)?),
            _ => return Err(FOREIGN),
        })
    }

    fn one_sided_line(line: Polyline<N, 3>) -> Polyline<N, 3> {
        line
    }

    fn one_sided_mesh(mesh: TriMesh<N, 3>) -> TriMesh<N, 3> {
        mesh.one_sided()
    }

    fn solid_line(line: Polyline<N, 3>) -> Result<Polyline<N, 3>, MeshError> {
        Ok(line)
    }

    fn solid_mesh(mesh: TriMesh<N, 3>) -> Result<TriMesh<N, 3>, MeshError> {
        mesh.try_solid()
    }
}

/// Converts a hull. The faces are omitted if the convex hull of the points is equal to the hull, to
/// the bit.
fn hull_data<N: Scalar>(hull: &ConvexHull<N>, faces: Vec<Vec<u32>>) -> ShapeData<N, 3> {
    let points = hull.vertices().to_vec();
    let is_given_by_points = hull_of(&points, &[]).is_ok_and(|other| other == *hull);
    ShapeData::Hull { points, faces: if is_given_by_points { Vec::new() } else { faces } }
}

/// Creates a hull with these faces; if there are none, the convex hull of the points.
fn hull_of<N: Scalar>(
    points: &[Point<N, 3>],
    faces: &[Vec<u32>],
) -> Result<ConvexHull<N>, Problem> {
    if faces.is_empty() {
        return Ok(ConvexHull::try_from_points(points)?);
    }
    Ok(ConvexHull::try_new(points, faces)?)
}

/// The bits of [`Field::marks`].
const HOLES: [u8; 2] = [1, 2];
const BACKWARD: u8 = 4;
const GHOST: u8 = 8;

/// Converts a height field in 2D to data with a mark for each segment.
fn line_data<N: Scalar>(field: &HeightField<N, 2>) -> Field<N, 2> {
    let mark = |cell| u8::from(field.is_hole(cell)) + GHOST * u8::from(field.is_ghost(cell));
    let marks = (0..).take(field.num_cells()).map(mark);
    Field {
        columns: field.heights().len(),
        heights: field.heights().to_vec(),
        scale: *field.scale(),
        marks: marks.collect(),
        is_one_sided: field.is_one_sided(),
        keeps_internal_edges: field.keeps_internal_edges(),
    }
}

/// Creates a height field in 2D from its arguments.
fn line_of<N: Scalar>(data: &Field<N, 2>) -> Result<HeightField<N, 2>, Problem> {
    let field = HeightField::<N, 2>::try_new(data.heights.clone(), data.scale)?;
    check_marks(data, field.num_cells(), HOLES[0] + GHOST)?;
    let has = |cell: usize, bit: u8| data.marks[cell] & bit != 0;
    let field = field.with_holes(|cell| has(cell, HOLES[0])).with_ghosts(|cell| has(cell, GHOST));
    let field = if data.is_one_sided { field.one_sided() } else { field };
    Ok(if data.keeps_internal_edges { field.with_internal_edges_kept() } else { field })
}

/// Converts a height field in 3D to data with a mark for each cell of two triangles. The diagonal
/// of each cell is written, whichever rule has set it.
fn sheet_data<N: Scalar>(field: &HeightField<N, 3>) -> Field<N, 3> {
    let columns = field.columns() - 1;
    let mark = |cell: u32| {
        let [row, column] = [cell as usize / columns, cell as usize % columns];
        let is_backward = field.diagonal(row, column) == Diagonal::Backward;
        let parts = [field.is_hole(2 * cell), field.is_hole(2 * cell + 1)];
        u8::from(parts[0]) * HOLES[0]
            + u8::from(parts[1]) * HOLES[1]
            + u8::from(is_backward) * BACKWARD
            + u8::from(field.is_ghost(2 * cell)) * GHOST
    };
    Field {
        columns: field.columns(),
        heights: field.heights().to_vec(),
        scale: *field.scale(),
        marks: (0..).take(field.num_cells()).map(mark).collect(),
        is_one_sided: field.is_one_sided(),
        keeps_internal_edges: field.keeps_internal_edges(),
    }
}

/// Creates a height field in 3D from its arguments. The constructor rejects heights that do not
/// form complete rows.
fn sheet_of<N: Scalar>(data: &Field<N, 3>) -> Result<HeightField<N, 3>, Problem> {
    let rows = data.heights.len() / data.columns.max(1);
    let heights = data.heights.clone();
    let mut field = HeightField::<N, 3>::try_new(rows, data.columns, heights, data.scale)?;
    check_marks(data, field.num_cells(), HOLES[0] + HOLES[1] + BACKWARD + GHOST)?;
    let columns = data.columns - 1;
    for (cell, mark) in (0..).zip(&data.marks).filter(|(_, mark)| **mark != 0) {
        let [row, column] = [cell as usize / columns, cell as usize % columns];
        if mark & BACKWARD != 0 {
            field.set_diagonal(row, column, Diagonal::Backward);
        }
        field.set_ghost(row, column, mark & GHOST != 0);
        for (part, hole) in (2 * cell..).zip(HOLES) {
            field.set_part_hole(part, mark & hole != 0);
        }
    }
    let field = if data.is_one_sided { field.one_sided() } else { field };
    Ok(if data.keeps_internal_edges { field.with_internal_edges_kept() } else { field })
}

/// Checks that there is one mark for each cell, and that marks have only bits of `bits`.
fn check_marks<N: Recordable<D>, const D: usize>(
    field: &Field<N, D>,
    cells: usize,
    bits: u8,
) -> Result<(), Problem> {
    let is_usable = field.marks.len() == cells && field.marks.iter().all(|mark| mark & !bits == 0);
    if is_usable { Ok(()) } else { Err(Problem::BadValue { what: "the marks of a height field" }) }
}
