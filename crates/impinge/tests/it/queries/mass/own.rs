//! Tests custom shapes: known by their support points, by their parts, or with their own mass
//! properties.

use crate::support::composite_support::{Piece, Pieces};
use crate::support::query_support::random::Random;
use crate::support::query_support::solids::{Ellipsoid as OwnEllipsoid, RoundHull};

use impinge::bounding_volume::Aabb;
use impinge::math::{Matrix, Point, Pose, Real, Space, Vector};
use impinge::query::{MassError, MassProperties, mass_properties};
use impinge::shape::{
    Ball, CompositeShape, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, Geometry,
    Part, PartSearch, Rounded, Shape, SupportMap, Surface, TriMesh,
};

use super::{Found, Inertia, assert_alike, p3, unit, wide};

type V3 = Vector<f64, 3>;

/// A solid of the library known only by its support points, mapped by a matrix.
#[derive(Debug)]
struct Hidden<S, N: Real, const D: usize> {
    solid: S,
    map: Matrix<N, D>,
}

impl<S: SupportMap<N, D>, N: Real, const D: usize> SupportMap<N, D> for Hidden<S, N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let inner = self.map.tr_mul(direction);
        Point::from(self.map * self.solid.support_point(&inner).coords)
    }
}

impl<S, N: Space<D>, const D: usize> Shape<N, D> for Hidden<S, N, D>
where
    S: SupportMap<N, D> + std::fmt::Debug + 'static,
{
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        Aabb::unbounded()
    }
}

fn hidden<S, N: Inertia<D>, const D: usize>(solid: S, map: Matrix<N, D>) -> Found<D>
where
    S: SupportMap<N, D> + std::fmt::Debug + 'static,
{
    unit(&Hidden { solid, map })
}

/// Maps the mass properties `found` of a solid to those of the solid whose points are multiplied by
/// `map`, a matrix with the positive determinant `determinant`.
fn mapped<const D: usize>(found: &Found<D>, map: &Matrix<f64, D>, determinant: f64) -> Found<D> {
    let half_trace = found.2.trace() / (D as f64 - 1.0);
    let second = Matrix::<f64, D>::from_diagonal_element(half_trace) - found.2;
    let second = map * second * map.transpose() * determinant;
    let tensor = Matrix::<f64, D>::from_diagonal_element(second.trace()) - second;
    (found.0 * determinant, map * found.1, tensor)
}

#[test]
fn solids_of_the_plane_by_support_points() {
    let own = OwnEllipsoid { radii: Vector::<f64, 2>::new(3.0, 0.01) };
    let ellipse = unit(&Ellipsoid::new(Vector::<f64, 2>::new(3.0, 0.01)));
    assert_alike(&unit(&own), &ellipse, 1e-8, "a thin ellipse");
    let round = RoundHull::cuboid(&Vector::<f64, 2>::new(2.0, 0.5), 0.25);
    let expected = unit(&Rounded::new(Cuboid::new(Vector::<f64, 2>::new(2.0, 0.5)), 0.25));
    assert_alike(&unit(&round), &expected, 1e-8, "a rounded box");
    let corners: Vec<_> =
        [[0.0, 0.0], [5.0, 1.0], [5.0, 1.5], [1.0, 3.0]].map(Point::<f64, 2>::from).to_vec();
    let polygon = RoundHull { points: corners.clone(), rounding: 0.0 };
    let expected = unit(&ConvexPolygon::from_points(&corners));
    assert_alike(&unit(&polygon), &expected, 1e-13, "a polygon");
    let turned = Matrix::<f64, 2>::new(0.6, -0.8, 0.8, 0.6);
    let found = hidden(Cuboid::new(Vector::<f64, 2>::new(50.0, 1e-3)), turned);
    let expected = unit(&Cuboid::new(Vector::<f64, 2>::new(50.0, 1e-3)));
    assert_alike(&found, &expected, 1e-11, "a turned needle");
    let single = OwnEllipsoid { radii: Vector::<f32, 2>::new(3.0, 1.0) };
    let expected = unit(&Ellipsoid::new(Vector::<f32, 2>::new(3.0, 1.0)));
    assert_alike(&unit(&single), &expected, 3e-5, "in `f32`");
    let point = RoundHull { points: vec![corners[3]], rounding: 0.0 };
    assert_eq!(unit(&point), (0.0, corners[3].coords, Matrix::<f64, 2>::zeros()), "a point");
    let line = RoundHull { points: corners[..2].to_vec(), rounding: 0.0 };
    assert_eq!(unit(&line).0, 0.0, "a line");
}

/// Tests solids known only by their support points: as they are, rotated obliquely, and stretched
/// up to 10⁴ times or flattened to a hundredth before an oblique rotation. Each value may be off by
/// 2e-5 to 2e-4 of its size, depending on the solid.
#[test]
fn solids_of_space_by_support_points() {
    let random = &mut Random(5, false);
    let turned = random.turn3::<f64>().to_rotation_matrix().into_inner();
    let ways = [
        (Matrix::<f64, 3>::identity(), 1.0, "plain"),
        (turned, 1.0, "turned"),
        (turned * Matrix::<f64, 3>::from_diagonal(&V3::new(1.0, 100.0, 1.0)), 100.0, "long"),
        (turned * Matrix::<f64, 3>::from_diagonal(&V3::new(10.0, 1.0, 0.01)), 0.1, "flat"),
        (turned * Matrix::<f64, 3>::from_diagonal(&V3::new(1e4, 1.0, 1.0)), 1e4, "a needle"),
    ];
    let corners: Vec<_> = (0..20).map(|_| Point::from(random.vector::<f64, 3>())).collect();
    for (map, determinant, way) in ways {
        let expected = |shape: &dyn Shape<f64, 3>| mapped(&unit(shape), &map, determinant);
        let check = |name: &str, found: Found<3>, shape: &dyn Shape<f64, 3>, share: f64| {
            assert_alike(&found, &expected(shape), share, &format!("{name}, {way}"));
        };
        check("ball", hidden(Ball::new(1.0), map), &Ball::new(1.0), 2e-5);
        let cube = Cuboid::new(V3::repeat(1.0));
        check("cuboid", hidden(cube, map), &cube, 1e-4);
        let hull = ConvexHull::from_points(&corners);
        check("hull", hidden((*hull).clone(), map), &hull, 1e-4);
        let cylinder = Cylinder::new(1.0, 1.0);
        check("cylinder", hidden(cylinder, map), &cylinder, 1e-4);
        let cone = Cone::new(1.0, 1.0);
        check("cone", hidden(cone, map), &cone, 1e-4);
        let die = Rounded::new(Cuboid::new(V3::repeat(1.0)), 0.5);
        check("die", hidden(die.clone(), map), &die, 2e-4);
    }
}

#[test]
fn flat_and_broken_solids_of_space() {
    let square = [p3(1.0, 0.0, 2.0), p3(3.0, 0.0, 2.0), p3(3.0, 1.0, 2.0), p3(1.0, 1.0, 2.0)];
    let flat = unit(&RoundHull { points: square.to_vec(), rounding: 0.0 });
    assert_eq!(flat.0, 0.0, "no volume");
    assert!((flat.1 - V3::new(2.0, 0.5, 2.0)).norm() < 0.1, "{flat:?}");
    let rounded = unit(&RoundHull { points: square.to_vec(), rounding: 0.5 });
    let expected = unit(&Rounded::new(Cuboid::new(V3::new(1.0, 0.5, 0.0)), 0.5));
    assert_alike(&rounded, &(expected.0, V3::new(2.0, 0.5, 2.0), expected.2), 1e-4, "rounded");
    // A flat tetrahedron is known by its support points only.
    let tetrahedron = impinge::shape::Tetrahedron::new(square);
    let rounded = unit(&Rounded::new(tetrahedron, 0.5));
    assert_alike(&rounded, &(expected.0, V3::new(2.0, 0.5, 2.0), expected.2), 1e-4, "rounded");
    let broken = RoundHull { points: vec![p3(f64::NAN, 0.0, 0.0)], rounding: 0.0 };
    let refused = mass_properties(&broken, 1.0);
    assert!(matches!(refused, Err(MassError::NotFinite { .. })), "{refused:?}");
}

/// A solid that returns its own mass properties.
#[derive(Debug)]
struct Known(f64);

impl SupportMap<f64, 3> for Known {
    fn core_support(&self, direction: &V3) -> Point<f64, 3> {
        Ball::new(self.0).support_point(direction)
    }
}

impl Shape<f64, 3> for Known {
    fn geometry(&self) -> Geometry<'_, f64, 3> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<f64, 3> {
        Shape::<f64, 3>::local_aabb(&Ball::new(self.0))
    }

    fn unit_mass_properties(&self) -> Option<MassProperties<f64, 3>> {
        mass_properties(&Ball::new(self.0), 1.0).ok()
    }
}

#[test]
fn a_shape_may_know_better() {
    let (found, expected) =
        (mass_properties(&Known(2.0), 3.0), mass_properties(&Ball::new(2.0), 3.0));
    assert_eq!(wide(&found.expect("it says so")), wide(&expected.expect("a ball")), "what it says");
}

/// A mesh wrapped in a custom type. With `true`, the geometry of the wrapper is the mesh; otherwise
/// it is a custom composite with the surface of the mesh.
#[derive(Debug)]
struct Wrapped(TriMesh<f64, 3>, bool);

impl CompositeShape<f64, 3> for Wrapped {
    fn num_parts(&self) -> u32 {
        self.0.num_parts()
    }

    fn part(&self, part: u32) -> Part<'_, f64, 3> {
        self.0.part(part)
    }

    fn search(&self) -> &dyn PartSearch<f64, 3> {
        self.0.search()
    }

    fn surface(&self) -> Option<&dyn Surface<f64, 3>> {
        self.0.surface()
    }
}

impl Shape<f64, 3> for Wrapped {
    fn geometry(&self) -> Geometry<'_, f64, 3> {
        if self.1 { self.0.geometry() } else { Geometry::composite(self) }
    }

    fn local_aabb(&self) -> Aabb<f64, 3> {
        self.0.local_aabb()
    }
}

#[test]
fn composites_of_ones_own() {
    let surface = impinge::procedural::space::cuboid(&Cuboid::new(V3::new(1.0, 2.0, 3.0)));
    let mesh = TriMesh::new(surface.vertices, surface.triangles);
    let expected = unit(&Cuboid::new(V3::new(1.0, 2.0, 3.0)));
    assert_alike(&unit(&Wrapped(mesh.clone(), true)), &expected, 1e-14, "it stands for a mesh");
    let refused = mass_properties(&Wrapped(mesh, false), 1.0);
    assert_eq!(refused, Err(MassError::NotClosed { part: 0 }), "a surface of its own");
    let at = |x: f64| Pose::from_translation(V3::new(x, 0.0, 0.0));
    let halves = Pieces::new(vec![
        (at(-0.5), Piece::of(Cuboid::new(V3::new(0.5, 2.0, 3.0)))),
        (at(0.5), Piece::of(Cuboid::new(V3::new(0.5, 2.0, 3.0)))),
    ]);
    assert_alike(&unit(&halves), &expected, 1e-14, "two halves");
}
