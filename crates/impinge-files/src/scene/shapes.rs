//! Converts the shapes of a document to shapes of the library.

use std::collections::BTreeMap;
use std::path::PathBuf;

use impinge::math::{Point, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, Compound, Cuboid, Ellipsoid, Plane, Polyline, Rounded, Segment, Shape,
    ShapeError, ShapeHandle, TaperedCapsule, TriMesh, Triangle,
};
use impinge_record::{
    Field, LibraryError, MAX_DEPTH, MAX_PARTS, Problem as RecordProblem, ShapeData,
};

use super::pose::{Placement, unit, vector};
use super::{MeshTable, SceneSpace};
use crate::error::{Fault, Within};
use crate::files::check;
use crate::format::{ChildFile, DiagonalsFile, HeightFieldFile, MeshSource, ShapeFile, ShapeRef};
use crate::{Dimension, Limit, Problem};

/// Identifies the shape of a mesh file: its path, part, bits of the scale, and kind. Sources with
/// equal keys share one shape.
type MeshKey = (PathBuf, Option<String>, [u64; 3], u8);

/// Builds shapes. Each named shape is built once.
pub(super) struct Builder<'a, N: SceneSpace<D>, const D: usize> {
    dimension: Dimension,
    shapes: &'a BTreeMap<String, ShapeFile>,
    meshes: &'a MeshTable,
    made: BTreeMap<&'a str, ShapeHandle<N, D>>,
    of_files: BTreeMap<MeshKey, ShapeHandle<N, D>>,
    /// The number of vertices and triangle corners of the shapes that were built from mesh files so
    /// far.
    elements: usize,
    /// The names of the shapes that contain the shape under construction, to detect cycles.
    holders: Vec<&'a str>,
    depth: u32,
}

impl<'a, N: SceneSpace<D>, const D: usize> Builder<'a, N, D> {
    /// Creates a builder that has not built any shape yet.
    pub(super) const fn new(
        dimension: Dimension,
        shapes: &'a BTreeMap<String, ShapeFile>,
        meshes: &'a MeshTable,
    ) -> Self {
        Self {
            dimension,
            shapes,
            meshes,
            made: BTreeMap::new(),
            of_files: BTreeMap::new(),
            elements: 0,
            holders: Vec::new(),
            depth: 0,
        }
    }

    /// Returns the shape of a reference. A named shape is built at its first use, an inline shape
    /// at each use.
    pub(super) fn make(&mut self, shape: &ShapeRef) -> Result<ShapeHandle<N, D>, Fault> {
        let limit = MAX_DEPTH as usize;
        if self.depth > MAX_DEPTH {
            return Err(Problem::TooMany { what: "nested shapes", given: limit + 1, limit }.into());
        }
        self.depth += 1;
        let made = match shape {
            ShapeRef::Name(name) => self.named(name),
            ShapeRef::Inline(shape) => self.inline(shape),
        };
        self.depth -= 1;
        made
    }

    fn named(&mut self, name: &str) -> Result<ShapeHandle<N, D>, Fault> {
        let shapes = self.shapes;
        let (name, shape) =
            shapes.get_key_value(name).ok_or_else(|| Problem::UnknownShape(name.to_owned()))?;
        if let Some(made) = self.made.get(name.as_str()) {
            return Ok(made.clone());
        }
        if let Some(first) = self.holders.iter().position(|holder| holder == name) {
            let names = self.holders[first..].iter().copied().chain([name.as_str()]);
            return Err(Problem::ShapeCycle(names.map(str::to_owned).collect()).into());
        }
        self.holders.push(name);
        let made = self.inline(shape);
        self.holders.pop();
        let made = made.map_err(|fault| fault.within(name).within("shapes").absolute())?;
        self.made.insert(name, made.clone());
        Ok(made)
    }

    /// Builds an inline shape. The path of an error starts with the kind of the shape.
    fn inline(&mut self, shape: &ShapeFile) -> Result<ShapeHandle<N, D>, Fault> {
        self.shape(shape).within(kind_of(shape))
    }

    fn shape(&mut self, shape: &ShapeFile) -> Result<ShapeHandle<N, D>, Fault> {
        match shape {
            ShapeFile::Ball { radius } => handle(Ball::try_new(N::lit(*radius)).within("radius")),
            ShapeFile::Cuboid { half_extents: given } => {
                let half_extents = coordinates(given).within("half_extents")?;
                handle(Cuboid::try_new(half_extents).within("half_extents"))
            }
            ShapeFile::Ellipsoid { half_axes: given } => {
                let half_axes = coordinates(given).within("half_axes")?;
                handle(Ellipsoid::try_new(half_axes).within("half_axes"))
            }
            ShapeFile::Segment { ends } => {
                let [a, b] = corners(ends, "ends")?;
                handle(Segment::try_new(a, b))
            }
            ShapeFile::Triangle { corners: given } => {
                let [a, b, c] = corners(given, "corners")?;
                handle(Triangle::try_new(a, b, c))
            }
            ShapeFile::Capsule { radius, half_height, ends } => {
                capsule(*radius, *half_height, ends.as_ref())
            }
            ShapeFile::TaperedCapsule { radii, half_height, ends } => {
                tapered_capsule(*radii, *half_height, ends.as_ref())
            }
            ShapeFile::HalfSpace { normal } => self.half_space(normal),
            ShapeFile::ConvexHull { points: given } => {
                Ok(N::convex_hull(&points(given, "points")?).within("points")?)
            }
            ShapeFile::Cylinder { half_height, radius } => {
                self.own(&ShapeData::Cylinder([*half_height, *radius].map(N::lit)), "a cylinder")
            }
            ShapeFile::Cone { half_height, radius } => {
                self.own(&ShapeData::Cone([*half_height, *radius].map(N::lit)), "a cone")
            }
            ShapeFile::Tetrahedron { corners: given } => {
                let tetrahedron = ShapeData::Tetrahedron(corners(given, "corners")?);
                self.own(&tetrahedron, "a tetrahedron").within("corners")
            }
            ShapeFile::ConvexPolygon { points: given } => {
                let outline = ShapeData::Outline(points(given, "points")?);
                self.own(&outline, "a convex polygon").within("points")
            }
            ShapeFile::HeightField(file) => {
                self.own(&field(file, self.dimension)?, "a height field")
            }
            ShapeFile::Polyline { vertices, segments, closed, one_sided } => {
                let line = line(points(vertices, "vertices")?, segments.as_deref(), *closed)?;
                Ok(ShapeHandle::new(if *one_sided { N::one_sided_line(line) } else { line }))
            }
            ShapeFile::Mesh { vertices, triangles, one_sided } => {
                let mesh = TriMesh::try_new(points(vertices, "vertices")?, triangles.clone())?;
                Ok(ShapeHandle::new(if *one_sided { N::one_sided_mesh(mesh) } else { mesh }))
            }
            ShapeFile::Rounded { shape, radius } => self.rounded(shape, *radius),
            ShapeFile::Compound { children } => self.compound(children),
            ShapeFile::MeshFile(source) => self.mesh_file(source),
        }
    }

    /// Builds the shape of a mesh file. Sources with equal path, part, scale and kind share one
    /// shape.
    fn mesh_file(&mut self, source: &MeshSource) -> Result<ShapeHandle<N, D>, Fault> {
        let scale = source.scale.factors().map(f64::to_bits);
        let key = (source.path.clone(), source.part.clone(), scale, source.kind as u8);
        if let Some(made) = self.of_files.get(&key) {
            return Ok(made.clone());
        }
        let files = &self.meshes.files;
        let total = self.elements.saturating_add(self.meshes.elements(source)?);
        check(Limit::Elements, total, files.allowed(files.limits.elements))?;
        self.elements = total;
        let made: ShapeHandle<N, D> = self.meshes.shape(source)?;
        self.of_files.insert(key, made.clone());
        Ok(made)
    }

    fn rounded(&mut self, shape: &ShapeRef, radius: f64) -> Result<ShapeHandle<N, D>, Fault> {
        let inner = self.make(shape).within("shape")?;
        handle(Rounded::try_from_handle(inner, N::lit(radius)).map_err(sized))
    }

    fn half_space(&self, normal: &[f64]) -> Result<ShapeHandle<N, D>, Fault> {
        let normal = vector(normal, self.dimension).and_then(unit).within("normal")?;
        let normal = Vector::from_fn(|axis, _| N::lit(normal[axis]));
        Ok(ShapeHandle::new(Plane::<N, D>::new(Unit::new_normalize(normal))))
    }

    /// Builds a shape that exists in one dimension only.
    fn own(&self, data: &ShapeData<N, D>, what: &'static str) -> Result<ShapeHandle<N, D>, Fault> {
        N::own_shape(data).map_err(|problem| match problem {
            RecordProblem::Library(error) => sized(error),
            _ => Problem::WrongDimension { what, dimension: self.dimension }.into(),
        })
    }

    fn compound(&mut self, children: &[ChildFile]) -> Result<ShapeHandle<N, D>, Fault> {
        let mut made = Vec::with_capacity(children.len());
        let mut parts = 0;
        for (index, child) in children.iter().enumerate() {
            let child = self.child(child).within(&format!("children[{index}]"))?;
            parts += num_parts(&child.1);
            if parts > MAX_PARTS {
                let (what, given, limit) = ("parts", parts, MAX_PARTS);
                return Err(Problem::TooMany { what, given, limit }.into());
            }
            made.push(child);
        }
        Ok(ShapeHandle::new(Compound::try_new(made).within("children")?))
    }

    fn child(&mut self, child: &ChildFile) -> Result<(N::Isometry, ShapeHandle<N, D>), Fault> {
        let shape = self.make(&child.shape).within("shape")?;
        let at = Placement::read(&child.position, self.dimension).within("position")?;
        Ok((at.isometry::<N, D>()?, shape))
    }
}

/// Returns the name of the member for a kind of shape.
const fn kind_of(shape: &ShapeFile) -> &'static str {
    match shape {
        ShapeFile::Ball { .. } => "ball",
        ShapeFile::Cuboid { .. } => "cuboid",
        ShapeFile::Capsule { .. } => "capsule",
        ShapeFile::TaperedCapsule { .. } => "tapered_capsule",
        ShapeFile::Segment { .. } => "segment",
        ShapeFile::Triangle { .. } => "triangle",
        ShapeFile::Ellipsoid { .. } => "ellipsoid",
        ShapeFile::HalfSpace { .. } => "half_space",
        ShapeFile::Rounded { .. } => "rounded",
        ShapeFile::Cylinder { .. } => "cylinder",
        ShapeFile::Cone { .. } => "cone",
        ShapeFile::Tetrahedron { .. } => "tetrahedron",
        ShapeFile::ConvexHull { .. } => "convex_hull",
        ShapeFile::ConvexPolygon { .. } => "convex_polygon",
        ShapeFile::Polyline { .. } => "polyline",
        ShapeFile::Mesh { .. } => "mesh",
        ShapeFile::HeightField(_) => "height_field",
        ShapeFile::Compound { .. } => "compound",
        ShapeFile::MeshFile(_) => "mesh_file",
    }
}

/// Wraps a shape in a handle.
fn handle<N: SceneSpace<D>, const D: usize>(
    made: Result<impl Shape<N, D>, impl Into<Fault>>,
) -> Result<ShapeHandle<N, D>, Fault> {
    made.map(ShapeHandle::new).map_err(Into::into)
}

/// Converts an error of the library. If it concerns a size, its path becomes the member of the
/// document that contains this size, since the library and the document name sizes differently.
fn sized(error: impl Into<LibraryError>) -> Fault {
    let error = error.into();
    let member = match &error {
        LibraryError::Shape(
            ShapeError::Negative { what, .. } | ShapeError::NotFinite { what, .. },
        ) => match *what {
            "the radius" => Some("radius"),
            "the half height" => Some("half_height"),
            "the first radius" => Some("radii[0]"),
            "the second radius" => Some("radii[1]"),
            _ => None,
        },
        _ => None,
    };
    member.into_iter().fold(error.into(), Fault::within)
}

/// Converts coordinates to a vector; an error if their number differs from the dimension.
pub(super) fn coordinates<N: SceneSpace<D>, const D: usize>(
    numbers: &[f64],
) -> Result<Vector<N, D>, Problem> {
    if numbers.len() != D {
        return Err(Problem::WrongLength { needed: D, given: numbers.len() });
    }
    Ok(Vector::from_fn(|axis, _| N::lit(numbers[axis])))
}

/// Converts a list of points. The path of an error starts with `member` and the index.
fn points<N: SceneSpace<D>, const D: usize>(
    given: &[Vec<f64>],
    member: &str,
) -> Result<Vec<Point<N, D>>, Fault> {
    let read = |(index, numbers): (usize, &Vec<f64>)| {
        coordinates(numbers).map(Point::from).within(&format!("{member}[{index}]"))
    };
    given.iter().enumerate().map(read).collect()
}

/// Converts a list of `COUNT` points.
fn corners<N: SceneSpace<D>, const D: usize, const COUNT: usize>(
    given: &[Vec<f64>; COUNT],
    member: &str,
) -> Result<[Point<N, D>; COUNT], Fault> {
    let read: Vec<Point<N, D>> = points(given, member)?;
    Ok(core::array::from_fn(|index| read[index]))
}

/// The segment of a capsule: half its length on the y axis, or its two ends.
enum EndsOf<N: SceneSpace<D>, const D: usize> {
    HalfHeight(N),
    Points([Point<N, D>; 2]),
}

fn ends_of<N: SceneSpace<D>, const D: usize>(
    half_height: Option<f64>,
    ends: Option<&[Vec<f64>; 2]>,
) -> Result<EndsOf<N, D>, Fault> {
    match (half_height, ends) {
        (Some(half_height), None) => Ok(EndsOf::HalfHeight(N::lit(half_height))),
        (None, Some(ends)) => Ok(EndsOf::Points(corners(ends, "ends")?)),
        _ => Err(Problem::Members("one of half_height and ends is needed").into()),
    }
}

fn capsule<N: SceneSpace<D>, const D: usize>(
    radius: f64,
    half_height: Option<f64>,
    ends: Option<&[Vec<f64>; 2]>,
) -> Result<ShapeHandle<N, D>, Fault> {
    let radius = N::lit(radius);
    let made = match ends_of::<N, D>(half_height, ends)? {
        EndsOf::HalfHeight(half_height) => Capsule::try_new(half_height, radius),
        EndsOf::Points([a, b]) => Capsule::try_from_ends(a, b, radius),
    };
    handle(made.map_err(sized))
}

fn tapered_capsule<N: SceneSpace<D>, const D: usize>(
    radii: [f64; 2],
    half_height: Option<f64>,
    ends: Option<&[Vec<f64>; 2]>,
) -> Result<ShapeHandle<N, D>, Fault> {
    let [lower, upper] = radii.map(N::lit);
    let made = match ends_of::<N, D>(half_height, ends)? {
        EndsOf::HalfHeight(half_height) => TaperedCapsule::try_new(half_height, lower, upper),
        EndsOf::Points([a, b]) => TaperedCapsule::try_from_ends(a, b, [lower, upper]),
    };
    handle(made.map_err(sized))
}

fn line<N: SceneSpace<D>, const D: usize>(
    vertices: Vec<Point<N, D>>,
    segments: Option<&[[u32; 2]]>,
    is_closed: bool,
) -> Result<Polyline<N, D>, Fault> {
    Ok(match segments {
        Some(_) if is_closed => {
            return Err(Problem::Members("segments and closed exclude each other").into());
        }
        Some(segments) => Polyline::try_new(vertices, segments.to_vec())?,
        None if is_closed => Polyline::try_closed(vertices)?,
        None => Polyline::try_open(vertices)?,
    })
}

/// The mark of a removed cell in 2D (its segment) and in 3D (both its triangles).
const HOLE: [u8; 2] = [1, 3];
/// The mark of a cell that is cut along the backward diagonal.
const BACKWARD: u8 = 4;
/// The mark of a ghost cell.
const GHOST: u8 = 8;

/// Returns the data of a height field, with a mark for each cell.
fn field<N: SceneSpace<D>, const D: usize>(
    file: &HeightFieldFile,
    dimension: Dimension,
) -> Result<ShapeData<N, D>, Fault> {
    let HeightFieldFile { heights, columns, scale, holes, ghosts, diagonals, one_sided } = file;
    let columns = match (dimension, columns) {
        (Dimension::Two, None) => heights.len(),
        (Dimension::Three, Some(columns)) => *columns,
        _ => {
            let rule = "columns is needed in 3D, and does not exist in 2D";
            return Err(Problem::Members(rule).into());
        }
    };
    let is_line = dimension == Dimension::Two;
    let row = columns.saturating_sub(1);
    let rows = if is_line { 1 } else { (heights.len() / columns.max(1)).saturating_sub(1) };
    let is_backward = |cell: usize| match diagonals {
        DiagonalsFile::Forward => false,
        DiagonalsFile::Backward => true,
        DiagonalsFile::Alternating => (cell / row + cell % row) % 2 == 1,
    };
    let cells = 0..rows * row;
    let mut marks: Vec<u8> =
        cells.map(|cell| if !is_line && is_backward(cell) { BACKWARD } else { 0 }).collect();
    let hole = HOLE[usize::from(!is_line)];
    for (name, cells, bits) in [("holes", holes, hole), ("ghosts", ghosts, GHOST)] {
        for (index, &cell) in cells.iter().enumerate() {
            let (what, given, limit) = ("cells", cell.saturating_add(1), marks.len());
            let mark = marks.get_mut(cell).ok_or(Problem::TooMany { what, given, limit });
            *mark.within(&format!("{name}[{index}]"))? |= bits;
        }
    }
    Ok(ShapeData::HeightField(Field {
        columns,
        heights: heights.iter().copied().map(N::lit).collect(),
        scale: coordinates(scale).within("scale")?,
        marks,
        is_one_sided: *one_sided,
        keeps_internal_edges: false,
    }))
}

/// Returns the number of parts of a shape; 1 if it is not a composite.
fn num_parts<N: SceneSpace<D>, const D: usize>(shape: &ShapeHandle<N, D>) -> usize {
    shape.geometry().as_composite().map_or(1, |composite| composite.num_parts() as usize)
}
