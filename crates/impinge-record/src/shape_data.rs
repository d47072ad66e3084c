//! Shapes as plain data: the arguments of the constructors of the library.

use impinge::math::{Point, Space, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, Compound, Cuboid, EdgeNeighbor, Ellipsoid, Plane, Polyline, Rounded, Segment,
    Shape, ShapeHandle, TaperedCapsule, TriMesh, Triangle,
};

use crate::bytes::{Sink, Source};
use crate::error::{Problem, ReadError, RecordError};
use crate::space::{Recordable, Scalar};

/// A shape by value. Shapes within it are indices in the list of shapes of the recording.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the fields are the arguments of the constructors")]
pub enum ShapeData<N: Space<D>, const D: usize> {
    Ball(N),
    Segment([Point<N, D>; 2]),
    Capsule { ends: [Point<N, D>; 2], radius: N },
    Triangle([Point<N, D>; 3]),
    Cuboid(Vector<N, D>),
    Ellipsoid(Vector<N, D>),
    TaperedCapsule { ends: [Point<N, D>; 2], radii: [N; 2] },
    HalfSpace(Vector<N, D>),
    Rounded { shape: u32, radius: N },
    Polyline(Mesh<N, D, 2>),
    TriMesh(Mesh<N, D, 3>),
    Compound(Vec<(N::Isometry, u32)>),
    Named(String),
    Outline(Vec<Point<N, D>>),
    Hull { points: Vec<Point<N, D>>, faces: Vec<Vec<u32>> },
    Cylinder([N; 2]),
    Cone([N; 2]),
    Tetrahedron([Point<N, D>; 4]),
    HeightField(Field<N, D>),
}

/// The value of the byte `sides` for a solid. For a surface the byte is 1 if it is one-sided,
/// otherwise 0.
const SOLID: u8 = 2;
/// The name of the byte `sides` in errors.
const SIDES: &str = "the sides of a mesh";
/// A bit that is added to the byte `sides` of a mesh with ghosts.
const GHOSTS: u8 = 4;

/// The arguments of a triangle mesh or a polyline; `ENDS` is the number of vertices of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh<N: Space<D>, const D: usize, const ENDS: usize> {
    /// The vertices.
    pub vertices: Vec<Point<N, D>>,
    /// The vertex indices of each triangle or segment.
    pub parts: Vec<[u32; ENDS]>,
    /// The vertex indices of each ghost triangle of a mesh; empty for a polyline.
    pub ghosts: Vec<[u32; ENDS]>,
    /// Whether the shape has no contacts from behind; also `true` for a solid.
    pub is_one_sided: bool,
    /// Whether the shape is a solid instead of a surface.
    pub is_solid: bool,
    /// Whether contacts treat each part separately.
    pub keeps_internal_edges: bool,
}

/// The arguments of a height field.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<N: Space<D>, const D: usize> {
    /// The number of heights in a row; in 2D the number of all heights.
    pub columns: usize,
    /// The heights, row by row.
    pub heights: Vec<N>,
    /// The extents of the whole field; the y component is the factor of the heights.
    pub scale: Vector<N, D>,
    /// A byte for each cell: bits 0 and 1 mark removed parts, bit 2 a backward diagonal, bit 3 a
    /// ghost.
    pub marks: Vec<u8>,
    /// Whether the field has no contacts from behind.
    pub is_one_sided: bool,
    /// Whether contacts treat each part separately.
    pub keeps_internal_edges: bool,
}

/// Converts a shape to data. For a rounded shape or a compound, `number` returns the index of each
/// shape that it contains. `None` for a user-defined type.
pub(crate) fn data_of<N: Recordable<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    number: &mut dyn FnMut(&ShapeHandle<N, D>) -> Result<u32, RecordError>,
) -> Result<Option<ShapeData<N, D>>, RecordError> {
    if let Some(rounded) = shape.as_shape::<Rounded<N, D>>() {
        let (shape, radius) = (number(rounded.shape())?, rounded.radius());
        return Ok(Some(ShapeData::Rounded { shape, radius }));
    }
    if let Some(compound) = shape.as_shape::<Compound<N, D>>() {
        let mut children = Vec::with_capacity(compound.num_children());
        for (at, child) in compound.children() {
            children.push((*at, number(child)?));
        }
        return Ok(Some(ShapeData::Compound(children)));
    }
    let data = solid_data(&**shape).or_else(|| mesh_data(&**shape));
    Ok(data.or_else(|| N::own_data(&**shape)))
}

/// Converts the convex shapes that exist in both dimensions, and the half-space; `None` for other
/// shapes.
fn solid_data<N: Recordable<D>, const D: usize>(
    shape: &dyn Shape<N, D>,
) -> Option<ShapeData<N, D>> {
    let ends = |segment: &Segment<N, D>| [*segment.a(), *segment.b()];
    Some(if let Some(ball) = shape.as_shape::<Ball<N>>() {
        ShapeData::Ball(ball.radius())
    } else if let Some(segment) = shape.as_shape::<Segment<N, D>>() {
        ShapeData::Segment(ends(segment))
    } else if let Some(capsule) = shape.as_shape::<Capsule<N, D>>() {
        ShapeData::Capsule { ends: ends(capsule.segment()), radius: capsule.radius() }
    } else if let Some(triangle) = shape.as_shape::<Triangle<N, D>>() {
        ShapeData::Triangle(*triangle.corners())
    } else if let Some(cuboid) = shape.as_shape::<Cuboid<N, D>>() {
        ShapeData::Cuboid(*cuboid.half_extents())
    } else if let Some(ellipsoid) = shape.as_shape::<Ellipsoid<N, D>>() {
        ShapeData::Ellipsoid(*ellipsoid.half_axes())
    } else if let Some(capsule) = shape.as_shape::<TaperedCapsule<N, D>>() {
        ShapeData::TaperedCapsule { ends: ends(capsule.segment()), radii: capsule.radii() }
    } else {
        ShapeData::HalfSpace(shape.as_shape::<Plane<N, D>>()?.normal().into_inner())
    })
}

/// Converts polylines and meshes; `None` for other shapes.
fn mesh_data<N: Recordable<D>, const D: usize>(shape: &dyn Shape<N, D>) -> Option<ShapeData<N, D>> {
    if let Some(line) = shape.as_shape::<Polyline<N, D>>() {
        return Some(ShapeData::Polyline(Mesh {
            vertices: line.vertices().to_vec(),
            parts: line.segments().to_vec(),
            ghosts: Vec::new(),
            is_one_sided: line.is_one_sided(),
            is_solid: line.is_solid(),
            keeps_internal_edges: line.keeps_internal_edges(),
        }));
    }
    let mesh = shape.as_shape::<TriMesh<N, D>>()?;
    Some(ShapeData::TriMesh(Mesh {
        vertices: mesh.vertices().to_vec(),
        parts: mesh.triangles().to_vec(),
        ghosts: mesh.ghosts().to_vec(),
        is_one_sided: mesh.is_one_sided(),
        is_solid: mesh.is_solid(),
        keeps_internal_edges: mesh.keeps_internal_edges(),
    }))
}

/// Returns `true` if two shapes with equal data have the same adjacency between their parts. Shapes
/// other than polylines and meshes have no stored adjacency, so the result is `true`.
pub(crate) fn joins_alike<N: Recordable<D>, const D: usize>(
    shape1: &dyn Shape<N, D>,
    shape2: &dyn Shape<N, D>,
) -> bool {
    if let (Some(one), Some(two)) =
        (shape1.as_shape::<Polyline<N, D>>(), shape2.as_shape::<Polyline<N, D>>())
    {
        let joined =
            |line: &Polyline<N, D>, part: u32| [0, 1].map(|end| line.joined(part, end).to_vec());
        return (0..).take(one.num_segments()).all(|part| joined(one, part) == joined(two, part));
    }
    let neighbors = |mesh: &TriMesh<N, D>, part: u32| -> [EdgeNeighbor; 3] {
        [0, 1, 2].map(|side| mesh.neighbor(part, side))
    };
    match (shape1.as_shape::<TriMesh<N, D>>(), shape2.as_shape::<TriMesh<N, D>>()) {
        (Some(one), Some(two)) => {
            (0..).take(one.num_triangles()).all(|part| neighbors(one, part) == neighbors(two, part))
        }
        _ => true,
    }
}

impl<N: Recordable<D>, const D: usize> ShapeData<N, D> {
    /// Creates the shape with the constructors that check their arguments. `shape` returns the
    /// shape with an index.
    ///
    /// # Errors
    /// If a constructor rejects the values, if `shape` returns an error, if the shape is a named
    /// one, or if this dimension has no such shape.
    pub fn make(
        &self,
        shape: &dyn Fn(u32) -> Result<ShapeHandle<N, D>, Problem>,
    ) -> Result<ShapeHandle<N, D>, Problem> {
        Ok(match self {
            Self::Ball(radius) => ShapeHandle::new(Ball::try_new(*radius)?),
            Self::Segment([a, b]) => ShapeHandle::new(Segment::try_new(*a, *b)?),
            Self::Capsule { ends: [a, b], radius } => {
                ShapeHandle::new(Capsule::try_from_ends(*a, *b, *radius)?)
            }
            Self::Triangle([a, b, c]) => ShapeHandle::new(Triangle::try_new(*a, *b, *c)?),
            Self::Cuboid(half_extents) => ShapeHandle::new(Cuboid::try_new(*half_extents)?),
            Self::Ellipsoid(half_axes) => ShapeHandle::new(Ellipsoid::try_new(*half_axes)?),
            Self::TaperedCapsule { ends: [a, b], radii } => {
                ShapeHandle::new(TaperedCapsule::try_from_ends(*a, *b, *radii)?)
            }
            Self::HalfSpace(normal) => half_space(normal)?,
            Self::Rounded { shape: inner, radius } => {
                ShapeHandle::new(Rounded::try_from_handle(shape(*inner)?, *radius)?)
            }
            Self::Polyline(mesh) => line_of_parts(mesh)?,
            Self::TriMesh(mesh) => mesh_of_parts(mesh)?,
            Self::Compound(children) => {
                let children = children.iter().map(|(at, child)| Ok((*at, shape(*child)?)));
                ShapeHandle::new(Compound::try_new(children.collect::<Result<_, Problem>>()?)?)
            }
            Self::Named(name) => return Err(Problem::UnknownShape(name.clone())),
            _ => return N::own_shape(self),
        })
    }

    /// Returns the indices of the shapes within this shape.
    pub(crate) fn inner(&self) -> Vec<u32> {
        match self {
            Self::Rounded { shape, .. } => vec![*shape],
            Self::Compound(children) => children.iter().map(|(_, child)| *child).collect(),
            _ => Vec::new(),
        }
    }
}

/// Creates a half-space. The normal is not normalized, since that could change its bits.
fn half_space<N: Recordable<D>, const D: usize>(
    normal: &Vector<N, D>,
) -> Result<ShapeHandle<N, D>, Problem> {
    Ok(ShapeHandle::new(Plane::<N, D>::try_new(Unit::new_unchecked(*normal))?))
}

/// Creates a polyline from its arguments.
fn line_of_parts<N: Recordable<D>, const D: usize>(
    mesh: &Mesh<N, D, 2>,
) -> Result<ShapeHandle<N, D>, Problem> {
    let line = Polyline::try_new(mesh.vertices.clone(), mesh.parts.clone())?;
    let line = if mesh.is_one_sided { N::one_sided_line(line) } else { line };
    let line = if mesh.is_solid { N::solid_line(line)? } else { line };
    let line = if mesh.keeps_internal_edges { line.with_internal_edges_kept() } else { line };
    Ok(ShapeHandle::new(line))
}

/// Creates a mesh from its arguments.
fn mesh_of_parts<N: Recordable<D>, const D: usize>(
    parts: &Mesh<N, D, 3>,
) -> Result<ShapeHandle<N, D>, Problem> {
    let mesh = TriMesh::try_new(parts.vertices.clone(), parts.parts.clone())?;
    let mesh = if parts.ghosts.is_empty() { mesh } else { mesh.try_with_ghosts(&parts.ghosts)? };
    let mesh = if parts.is_one_sided { N::one_sided_mesh(mesh) } else { mesh };
    let mesh = if parts.is_solid { N::solid_mesh(mesh)? } else { mesh };
    let mesh = if parts.keeps_internal_edges { mesh.with_internal_edges_kept() } else { mesh };
    Ok(ShapeHandle::new(mesh))
}

/// Writes the fields of shapes.
impl Sink {
    /// Writes points without their count, which the reader knows.
    pub(crate) fn points<N: Scalar, const D: usize>(&mut self, points: &[Point<N, D>]) {
        points.iter().for_each(|point| self.numbers(point.coords.as_slice()));
    }

    /// Writes points with their count.
    fn point_list<N: Scalar, const D: usize>(&mut self, points: &[Point<N, D>]) {
        self.count(points.len());
        self.points(points);
    }

    pub(crate) fn isometry<N: Recordable<D>, const D: usize>(&mut self, isometry: &N::Isometry) {
        self.numbers(&N::isometry_numbers(isometry));
    }

    /// Writes the vertices, the parts, the byte `sides`, a flag, and the ghosts if there are any.
    fn mesh<N: Recordable<D>, const D: usize, const ENDS: usize>(
        &mut self,
        mesh: &Mesh<N, D, ENDS>,
    ) {
        self.point_list(&mesh.vertices);
        self.count(mesh.parts.len());
        mesh.parts.iter().flatten().for_each(|corner| self.word(*corner));
        let sides = if mesh.is_solid { SOLID } else { u8::from(mesh.is_one_sided) };
        let has_ghosts = !mesh.ghosts.is_empty();
        self.byte(if has_ghosts { sides + GHOSTS } else { sides });
        self.flag(mesh.keeps_internal_edges);
        if has_ghosts {
            self.count(mesh.ghosts.len());
            mesh.ghosts.iter().flatten().for_each(|corner| self.word(*corner));
        }
    }

    /// Writes the arguments of a height field: the number of heights in a row, the heights, the
    /// scale, the marks and two flags.
    fn field<N: Recordable<D>, const D: usize>(&mut self, field: &Field<N, D>) {
        self.count(field.columns);
        self.count(field.heights.len());
        self.numbers(&field.heights);
        self.numbers(field.scale.as_slice());
        self.blob(&field.marks);
        self.flag(field.is_one_sided);
        self.flag(field.keeps_internal_edges);
    }

    /// Writes the points of a hull, then the vertex indices of each face.
    fn hull<N: Scalar, const D: usize>(&mut self, points: &[Point<N, D>], faces: &[Vec<u32>]) {
        self.point_list(points);
        self.count(faces.len());
        for face in faces {
            self.count(face.len());
            face.iter().for_each(|corner| self.word(*corner));
        }
    }

    /// Writes the children of a compound: their positions and the indices of their shapes, which
    /// are defined before.
    fn children<N: Recordable<D>, const D: usize>(&mut self, children: &[(N::Isometry, u32)]) {
        self.count(children.len());
        for (at, child) in children {
            self.isometry::<N, D>(at);
            self.word(*child);
        }
    }

    /// Writes the kind of a shape, then its fields.
    pub(crate) fn shape<N: Recordable<D>, const D: usize>(&mut self, shape: &ShapeData<N, D>) {
        self.byte(shape.kind());
        match shape {
            ShapeData::Ball(radius) => self.number(*radius),
            ShapeData::Segment(ends) => self.points(ends),
            ShapeData::Capsule { ends, radius } => {
                self.points(ends);
                self.number(*radius);
            }
            ShapeData::Triangle(corners) => self.points(corners),
            ShapeData::Cuboid(vector)
            | ShapeData::Ellipsoid(vector)
            | ShapeData::HalfSpace(vector) => self.numbers(vector.as_slice()),
            ShapeData::TaperedCapsule { ends, radii } => {
                self.points(ends);
                self.numbers(radii);
            }
            ShapeData::Rounded { shape, radius } => {
                self.word(*shape);
                self.number(*radius);
            }
            ShapeData::Polyline(mesh) => self.mesh(mesh),
            ShapeData::TriMesh(mesh) => self.mesh(mesh),
            ShapeData::Compound(children) => self.children::<N, D>(children),
            ShapeData::Named(name) => self.blob(name.as_bytes()),
            ShapeData::Outline(points) => self.point_list(points),
            ShapeData::Hull { points, faces } => self.hull(points, faces),
            ShapeData::Cylinder(sizes) | ShapeData::Cone(sizes) => self.numbers(sizes),
            ShapeData::Tetrahedron(corners) => self.points(corners),
            ShapeData::HeightField(field) => self.field(field),
        }
    }
}

impl<N: Space<D>, const D: usize> ShapeData<N, D> {
    /// Returns the code of the kind of shape in the format.
    const fn kind(&self) -> u8 {
        match self {
            Self::Ball(_) => 0,
            Self::Segment(_) => 1,
            Self::Capsule { .. } => 2,
            Self::Triangle(_) => 3,
            Self::Cuboid(_) => 4,
            Self::Ellipsoid(_) => 5,
            Self::TaperedCapsule { .. } => 6,
            Self::HalfSpace(_) => 7,
            Self::Rounded { .. } => 8,
            Self::Polyline(_) => 9,
            Self::TriMesh(_) => 10,
            Self::Compound(_) => 11,
            Self::Named(_) => 12,
            Self::Outline(_) => 13,
            Self::Hull { .. } => 14,
            Self::Cylinder(_) => 15,
            Self::Cone(_) => 16,
            Self::Tetrahedron(_) => 17,
            Self::HeightField(_) => 18,
        }
    }
}

/// Reads the fields of shapes.
impl Source<'_> {
    pub(crate) fn vector<N: Scalar, const D: usize>(&mut self) -> Result<Vector<N, D>, ReadError> {
        let numbers = self.numbers::<N>(D)?;
        Ok(Vector::<N, D>::from_column_slice(&numbers))
    }

    pub(crate) fn point<N: Scalar, const D: usize>(&mut self) -> Result<Point<N, D>, ReadError> {
        self.vector().map(Point::from)
    }

    fn points<N: Scalar, const D: usize, const COUNT: usize>(
        &mut self,
    ) -> Result<[Point<N, D>; COUNT], ReadError> {
        let mut points = [Point::<N, D>::origin(); COUNT];
        for point in &mut points {
            *point = self.point()?;
        }
        Ok(points)
    }

    fn point_list<N: Scalar, const D: usize>(&mut self) -> Result<Vec<Point<N, D>>, ReadError> {
        self.list(D * N::BYTES, Self::point)
    }

    /// Reads an isometry unchanged, whether or not its rotation is valid. The world rejects
    /// isometries that are not finite.
    pub(crate) fn isometry<N: Recordable<D>, const D: usize>(
        &mut self,
    ) -> Result<N::Isometry, ReadError> {
        let numbers = self.numbers(N::ISOMETRY_NUMBERS)?;
        N::isometry_of(&numbers).ok_or_else(|| self.error(Problem::Truncated))
    }

    fn pair<N: Scalar>(&mut self) -> Result<[N; 2], ReadError> {
        Ok([self.number()?, self.number()?])
    }

    fn mesh<N: Recordable<D>, const D: usize, const ENDS: usize>(
        &mut self,
    ) -> Result<Mesh<N, D, ENDS>, ReadError> {
        let vertices = self.point_list()?;
        let parts = self.corners()?;
        // Bits of `sides`: bit 0 for a one-sided surface, bit 1 for a solid, bit 2 if there are
        // ghosts. Polylines have no ghosts.
        let sides = self.choice(if ENDS == 3 { 7 } else { 3 }, SIDES)?;
        let keeps_internal_edges = self.flag()?;
        let ghosts = if sides < GHOSTS { Vec::new() } else { self.corners()? };
        let (is_one_sided, is_solid) = (sides % GHOSTS > 0, sides % GHOSTS == SOLID);
        if sides % GHOSTS > SOLID {
            return Err(self.error(Problem::BadValue { what: SIDES }));
        }
        Ok(Mesh { vertices, parts, ghosts, is_one_sided, is_solid, keeps_internal_edges })
    }

    /// Reads a list of parts, each as its vertex indices.
    fn corners<const ENDS: usize>(&mut self) -> Result<Vec<[u32; ENDS]>, ReadError> {
        self.list(4 * ENDS, |source| {
            let mut part = [0; ENDS];
            for corner in &mut part {
                *corner = source.word()?;
            }
            Ok(part)
        })
    }

    fn field<N: Recordable<D>, const D: usize>(&mut self) -> Result<Field<N, D>, ReadError> {
        Ok(Field {
            columns: self.word()? as usize,
            heights: self.list(N::BYTES, Self::number)?,
            scale: self.vector()?,
            marks: self.blob()?.to_vec(),
            is_one_sided: self.flag()?,
            keeps_internal_edges: self.flag()?,
        })
    }

    /// Reads the faces of a hull. A face takes at least the four bytes of its count.
    fn faces(&mut self) -> Result<Vec<Vec<u32>>, ReadError> {
        self.list(4, |source| source.list(4, Self::word))
    }

    /// Reads a shape that [`Sink::shape`] has written.
    pub(crate) fn shape<N: Recordable<D>, const D: usize>(
        &mut self,
    ) -> Result<ShapeData<N, D>, ReadError> {
        let kind = self.choice(19, "the kind of a shape")?;
        Ok(match kind {
            0 => ShapeData::Ball(self.number()?),
            1 => ShapeData::Segment(self.points()?),
            2 => ShapeData::Capsule { ends: self.points()?, radius: self.number()? },
            3 => ShapeData::Triangle(self.points()?),
            4 => ShapeData::Cuboid(self.vector()?),
            5 => ShapeData::Ellipsoid(self.vector()?),
            6 => ShapeData::TaperedCapsule { ends: self.points()?, radii: self.pair()? },
            7 => ShapeData::HalfSpace(self.vector()?),
            8 => ShapeData::Rounded { shape: self.word()?, radius: self.number()? },
            9 => ShapeData::Polyline(self.mesh()?),
            10 => ShapeData::TriMesh(self.mesh()?),
            11 => ShapeData::Compound(self.list(4 + N::ISOMETRY_NUMBERS * N::BYTES, |source| {
                Ok((source.isometry::<N, D>()?, source.word()?))
            })?),
            12 => ShapeData::Named(self.text()?),
            13 => ShapeData::Outline(self.point_list()?),
            14 => ShapeData::Hull { points: self.point_list()?, faces: self.faces()? },
            15 => ShapeData::Cylinder(self.pair()?),
            16 => ShapeData::Cone(self.pair()?),
            17 => ShapeData::Tetrahedron(self.points()?),
            _ => ShapeData::HeightField(self.field()?),
        })
    }
}
