//! The shapes, surfaces and rotations of samples whose types differ between 2D and 3D.

use impinge::math::na::{Quaternion, Translation2, Translation3, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Real, Vector};
use impinge::query::{ConstantVelocities, RigidMotion};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Diagonals, Ellipsoid,
    HeightField, Plane, Polyline, Rounded, Segment, ShapeHandle, TaperedCapsule, Tetrahedron,
    TriMesh, Triangle,
};
use impinge_record::Recordable;
use impinge_scenes::Placement;

use crate::place::{number, point, up, vector};

/// Functions that create shapes and motions in `D` dimensions. `f32`, the scalar of the samples,
/// implements them for `D` = 2 and `D` = 3.
pub(crate) trait Dimension<const D: usize>: Recordable<D> {
    /// The names of all solids. The half-space is the last.
    const SOLIDS: &'static [&'static str];

    /// The names of all solids except the half-space.
    const BOUNDED: &'static [&'static str] = match Self::SOLIDS.split_last() {
        Some((_, bounded)) => bounded,
        None => &[],
    };

    /// Returns a solid that exists in this dimension only; `None` for all other names. Its lengths
    /// are proportional to `size`.
    fn own_solid(kind: &str, size: f32) -> Option<ShapeHandle<f32, D>>;

    /// Returns the convex hull of points, which must span all dimensions.
    fn hull(points: &[Point<f32, D>]) -> ShapeHandle<f32, D>;

    /// Returns a surface around the origin, made of triangles in 3D and of segments in 2D. It has
    /// `cells` cells of size 1 along each horizontal axis. Its height is a function of x and z; z
    /// is 0 in 2D.
    fn surface(cells: usize, kind: SurfaceKind, height: &HeightFunction<'_>)
    -> ShapeHandle<f32, D>;

    /// Returns the motion of a body with velocity `linear` that rotates from x to y by `turn`
    /// radians per unit of time.
    fn spinning(
        start: Self::Isometry,
        linear: Vector<f32, D>,
        turn: f32,
    ) -> Box<dyn RigidMotion<f32, D>>;

    /// Converts a placement of `impinge-scenes` to a position.
    fn placed(placement: &Placement<D>) -> Self::Isometry;
}

/// A function that returns the height of a surface at x and z.
pub(crate) type HeightFunction<'a> = dyn Fn(f32, f32) -> f32 + 'a;

/// The kind of a surface, which also determines the kind of its contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SurfaceKind {
    /// A mesh or polyline with contacts of the whole surface, whose internal edges cause no tilted
    /// normals.
    Mesh,
    /// A mesh or polyline with the contacts of each triangle or segment by itself.
    MeshWithEdges,
    /// A one-sided mesh or polyline, without contacts from below.
    OneSidedMesh,
    /// A height field.
    Field,
}

/// Returns the solid with this name; a ball if the name is unknown. All lengths of a bounded solid
/// are proportional to `size`.
pub(crate) fn solid<const D: usize>(kind: &str, size: f32) -> ShapeHandle<f32, D>
where
    f32: Dimension<D>,
{
    if let Some(own) = f32::own_solid(kind, size) {
        return own;
    }
    let corner = |x: f32, y: f32| point::<D>([x * size, y * size, 0.0]);
    match kind {
        // The largest half extent of a solid is about `size`.
        "box" => ShapeHandle::new(Cuboid::new(vector([size, 0.7 * size, 0.5 * size]))),
        "capsule" => ShapeHandle::new(Capsule::new(0.6 * size, 0.4 * size)),
        "tapered capsule" => {
            ShapeHandle::new(TaperedCapsule::new(0.6 * size, 0.5 * size, 0.25 * size))
        }
        // A segment has no interior; a triangle has one in 2D only.
        "segment" => ShapeHandle::new(Segment::new(corner(-1.0, -0.3), corner(1.0, 0.3))),
        "triangle" => {
            let corners = (corner(-1.0, -0.6), corner(1.0, -0.6), corner(0.0, 0.9));
            ShapeHandle::new(Triangle::new(corners.0, corners.1, corners.2))
        }
        "ellipsoid" | "ellipse" => {
            ShapeHandle::new(Ellipsoid::new(vector([size, 0.6 * size, 0.8 * size])))
        }
        "rounded box" => {
            let core = Cuboid::new(vector([0.7 * size, 0.5 * size, 0.4 * size]));
            ShapeHandle::new(Rounded::new(core, 0.2 * size))
        }
        "half-space" => ShapeHandle::new(Plane::new(up())),
        _ => ShapeHandle::new(Ball::new(size)),
    }
}

impl Dimension<2> for f32 {
    const SOLIDS: &'static [&'static str] = &[
        "box",
        "ball",
        "capsule",
        "tapered capsule",
        "triangle",
        "segment",
        "ellipse",
        "rounded box",
        "polygon",
        "half-space",
    ];

    fn own_solid(kind: &str, size: Self) -> Option<ShapeHandle<Self, 2>> {
        // The corners are counter-clockwise. No two sides are parallel.
        let corners = [[-1.0, 0.0], [-0.4, -0.8], [0.5, -0.7], [1.0, 0.1], [0.0, 0.9]];
        let corners = corners.map(|[x, y]| Point::<Self, 2>::new(x * size, y * size));
        (kind == "polygon").then(|| ShapeHandle::new(ConvexPolygon::from_points(&corners)))
    }

    fn hull(points: &[Point<Self, 2>]) -> ShapeHandle<Self, 2> {
        ShapeHandle::new(ConvexPolygon::from_points(points))
    }

    fn surface(
        cells: usize,
        kind: SurfaceKind,
        height: &HeightFunction<'_>,
    ) -> ShapeHandle<Self, 2> {
        // Cells have size 1, so the width is equal to their number.
        let width = number(cells);
        let xs = (0..=cells).map(|n| number(n) - 0.5 * width);
        if kind == SurfaceKind::Field {
            let heights = xs.map(|x| height(x, 0.0)).collect();
            return ShapeHandle::new(HeightField::<Self, 2>::new(
                heights,
                vector([width, 1.0, 0.0]),
            ));
        }
        // The points go from right to left. The left side of a polyline is its back, which is then
        // below the surface.
        let points = xs.rev().map(|x| Point::<Self, 2>::new(x, height(x, 0.0)));
        let line = Polyline::open(points.collect());
        ShapeHandle::new(match kind {
            SurfaceKind::MeshWithEdges => line.with_internal_edges_kept(),
            SurfaceKind::OneSidedMesh => line.one_sided(),
            SurfaceKind::Mesh | SurfaceKind::Field => line,
        })
    }

    fn spinning(
        start: Isometry2<Self>,
        linear: Vector<Self, 2>,
        turn: Self,
    ) -> Box<dyn RigidMotion<Self, 2>> {
        Box::new(ConstantVelocities::<Self, 2>::new(start, linear, turn))
    }

    fn placed(placement: &Placement<2>) -> Isometry2<Self> {
        let [x, y] = placement.translation.map(Self::lit);
        let [cosine, sine] = placement.complex().map(Self::lit);
        let turn = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(Translation2::new(x, y), turn)
    }
}

impl Dimension<3> for f32 {
    const SOLIDS: &'static [&'static str] = &[
        "box",
        "ball",
        "capsule",
        "tapered capsule",
        "cylinder",
        "cone",
        "tetrahedron",
        "triangle",
        "segment",
        "ellipsoid",
        "rounded box",
        "hull",
        "half-space",
    ];

    fn own_solid(kind: &str, size: Self) -> Option<ShapeHandle<Self, 3>> {
        let corner =
            |x: Self, y: Self, z: Self| Point::<Self, 3>::new(x * size, y * size, z * size);
        match kind {
            // Cylinders and cones take half the height along y, then the radius.
            "cylinder" => Some(ShapeHandle::new(Cylinder::new(0.7 * size, 0.6 * size))),
            "cone" => Some(ShapeHandle::new(Cone::new(0.8 * size, 0.7 * size))),
            "tetrahedron" => Some(ShapeHandle::new(Tetrahedron::new([
                corner(-0.9, -0.5, -0.6),
                corner(0.9, -0.5, -0.6),
                corner(0.0, -0.5, 0.9),
                corner(0.0, 1.0, 0.0),
            ]))),
            "hull" => Some(ShapeHandle::new(ConvexHull::from_points(&[
                corner(-0.9, -0.3, -0.5),
                corner(0.8, -0.4, -0.7),
                corner(0.7, -0.5, 0.6),
                corner(-0.7, -0.6, 0.7),
                corner(-0.4, 0.6, -0.5),
                corner(0.5, 0.7, -0.3),
                corner(0.1, 0.8, 0.5),
            ]))),
            _ => None,
        }
    }

    fn hull(points: &[Point<Self, 3>]) -> ShapeHandle<Self, 3> {
        ShapeHandle::new(ConvexHull::from_points(points))
    }

    fn surface(
        cells: usize,
        kind: SurfaceKind,
        height: &HeightFunction<'_>,
    ) -> ShapeHandle<Self, 3> {
        let width = number(cells);
        let at = |n: usize| number(n) - 0.5 * width;
        // The vertices are in rows along x, in the order of the heights of a height field. Mesh and
        // height field have these vertices, so both kinds are the same surface.
        let vertices = (0..=cells).flat_map(|row| (0..=cells).map(move |column| [column, row]));
        let vertices = vertices.map(|[column, row]| {
            Point::<Self, 3>::new(at(column), height(at(column), at(row)), at(row))
        });
        if kind == SurfaceKind::Field {
            let heights = vertices.map(|vertex| vertex.y).collect();
            let side = cells + 1;
            let field = HeightField::<Self, 3>::new(
                side,
                side,
                heights,
                Vector::<Self, 3>::new(width, 1.0, width),
            );
            return ShapeHandle::new(field.with_diagonals(Diagonals::Zigzag));
        }
        let mesh = TriMesh::new(vertices.collect(), triangles(cells));
        ShapeHandle::new(match kind {
            SurfaceKind::MeshWithEdges => mesh.with_internal_edges_kept(),
            SurfaceKind::OneSidedMesh => mesh.one_sided(),
            SurfaceKind::Mesh | SurfaceKind::Field => mesh,
        })
    }

    fn spinning(
        start: Isometry3<Self>,
        linear: Vector<Self, 3>,
        turn: Self,
    ) -> Box<dyn RigidMotion<Self, 3>> {
        // A rotation from x to y is a rotation about z.
        let angular = Vector::<Self, 3>::z() * turn;
        Box::new(ConstantVelocities::<Self, 3>::new(start, linear, angular))
    }

    fn placed(placement: &Placement<3>) -> Isometry3<Self> {
        let [x, y, z] = placement.translation.map(Self::lit);
        let [i, j, k, w] = placement.quaternion().map(Self::lit);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation3::new(x, y, z), turn)
    }
}

/// Returns two triangles for each cell of a grid, counter-clockwise seen from above.
fn triangles(cells: usize) -> Vec<[u32; 3]> {
    let cells = u32::try_from(cells).expect("a surface of a sample has few cells");
    let side = cells + 1;
    let corners = (0..cells).flat_map(|row| (0..cells).map(move |column| row * side + column));
    corners
        .flat_map(|near| {
            let far = near + side;
            [[near, far, near + 1], [near + 1, far, far + 1]]
        })
        .collect()
}
