//! Tests the mass properties of closed meshes and closed lines, also in compounds, and that open
//! meshes and lines are refused.

use impinge::math::{Isometry2, Isometry3, Point, Real, Unit, Vector};
use impinge::procedural::space as surfaces;
use impinge::query::{MassError, mass_properties};
use impinge::shape::{
    Ball, Compound, ConvexHull, Cuboid, Cylinder, HeightField, Plane, Polyline, Shape, ShapeHandle,
    TriMesh,
};

use super::{Inertia, assert_alike, p2, p3, unit};

type V3 = Vector<f64, 3>;

/// Returns the vertices and triangles of a box around a point, optionally with reversed windings.
fn cuboid(half: [f64; 3], at: [f64; 3], is_inverted: bool) -> (Vec<Point<f64, 3>>, Vec<[u32; 3]>) {
    let surface = surfaces::cuboid(&Cuboid::new(V3::from(half)));
    let vertices = surface.vertices.iter().map(|vertex| vertex + V3::from(at)).collect();
    let turned = |[a, b, c]: [u32; 3]| if is_inverted { [a, c, b] } else { [a, b, c] };
    (vertices, surface.triangles.into_iter().map(turned).collect())
}

#[expect(clippy::type_complexity, reason = "corners and faces")]
fn mesh<N: Real>(bodies: &[(Vec<Point<f64, 3>>, Vec<[u32; 3]>)]) -> TriMesh<N, 3> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (own, named) in bodies {
        let first = u32::try_from(vertices.len()).expect("few");
        triangles.extend(named.iter().map(|names| names.map(|name| name + first)));
        vertices.extend(own.iter().map(|vertex| Point::from(vertex.coords.map(N::lit))));
    }
    TriMesh::new(vertices, triangles)
}

fn closed_meshes<N: Inertia<3>>() {
    let share = 16.0 * N::EPSILON.as_f64();
    let boxed = |half: [f64; 3]| unit(&Cuboid::new(Vector::<N, 3>::from(half.map(N::lit))));
    let (half, at) = ([1.0, 2.0, 0.5], [3.0, -1.0, 0.25]);
    let (mass, _, tensor) = boxed(half);
    let expected = (mass, V3::from(at), tensor);
    for is_inverted in [false, true] {
        let found = unit(&mesh::<N>(&[cuboid(half, at, is_inverted)]));
        assert_alike(&found, &expected, share, "whichever way round");
    }
    // Tests a box with a cavity, and a mesh of two bodies.
    let hollow = mesh::<N>(&[cuboid([2.0; 3], [0.0; 3], false), cuboid([1.0; 3], [0.0; 3], true)]);
    let (outer, inner) = (boxed([2.0; 3]), boxed([1.0; 3]));
    let expected = (outer.0 - inner.0, V3::zeros(), outer.2 - inner.2);
    assert_alike(&unit(&hollow), &expected, share, "a hollow box");
    let two = mesh::<N>(&[
        cuboid([1.0; 3], [-2.0, 0.0, 0.0], false),
        cuboid([1.0; 3], [2.0, 0.0, 0.0], false),
    ]);
    let found = unit(&two);
    assert!((found.0 - 16.0).abs() < share && found.1.norm() < share, "{found:?}");
    assert!(
        (found.2[(1, 1)] - (inner.2[(1, 1)] + 8.0 * 4.0) * 2.0).abs() < share * 80.0,
        "{found:?}"
    );
    // Two coincident triangles with opposite windings enclose no volume.
    let (vertices, _) = cuboid([1.0; 3], [5.0; 3], false);
    let sheet = mesh::<N>(&[(vertices, vec![[0, 1, 2], [2, 1, 0]])]);
    let found = unit(&sheet);
    assert!(found.0 == 0.0 && (found.1 - V3::repeat(5.0)).amax() <= 1.0, "{found:?}");
}

#[test]
fn meshes_that_are_closed() {
    closed_meshes::<f32>();
    closed_meshes::<f64>();
    // The surface of a hull has the mass properties of the hull.
    let corners: Vec<_> = (0..40_u32)
        .map(f64::from)
        .map(|k| p3((k * 1.3).sin() * 2.0, (k * 2.1).cos(), (k * 0.7).sin() + 4.0))
        .collect();
    let hull = ConvexHull::from_points(&corners);
    let surface = surfaces::convex_hull(&hull);
    let found = unit(&TriMesh::new(surface.vertices, surface.triangles));
    assert_alike(&found, &unit(&hull), 1e-13, "a hull");
    let cylinder = Cylinder::new(1.0, 0.5);
    let surface = surfaces::cylinder(&cylinder, 256);
    let found = unit(&TriMesh::new(surface.vertices, surface.triangles));
    assert_alike(&found, &unit(&cylinder), 1e-3, "a cylinder of triangles");
}

#[test]
fn meshes_that_are_open() {
    let (vertices, triangles) = cuboid([1.0; 3], [0.0; 3], false);
    for missing in 0..triangles.len() {
        let mut some = triangles.clone();
        let [a, b, _] = some.remove(missing);
        let open = mesh::<f64>(&[(vertices.clone(), some.clone())]);
        let Err(MassError::NotClosed { part }) = mass_properties(&open, 1.0) else {
            panic!("triangle {missing} is missing")
        };
        let named = some[part as usize];
        assert!(named.contains(&a) || named.contains(&b), "{named:?} is beside it");
    }
    let mut turned = triangles;
    turned[7].swap(0, 1);
    let turned = mesh::<f64>(&[(vertices, turned)]);
    assert!(
        matches!(mass_properties(&turned, 1.0), Err(MassError::NotClosed { .. })),
        "turned over"
    );
    let field = HeightField::<f64, 3>::new(2, 2, vec![0.0; 4], V3::repeat(1.0));
    assert_eq!(mass_properties(&field, 1.0), Err(MassError::NotClosed { part: 0 }));
}

#[test]
fn lines_and_meshes_of_the_plane() {
    let corners =
        [p2(0.0, 0.0), p2(4.0, 0.0), p2(4.0, 1.0), p2(1.0, 1.0), p2(1.0, 3.0), p2(0.0, 3.0)];
    let outline = Polyline::closed(corners.to_vec());
    let reversed = Polyline::closed(corners.iter().rev().copied().collect());
    let filled = TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [3, 2, 0], [0, 3, 4], [0, 5, 4]]);
    // An L shape of two rectangles.
    let place = |x: f64, y: f64, w: f64, h: f64| {
        let half = Vector::<f64, 2>::new(w * 0.5, h * 0.5);
        (Isometry2::translation(x + w * 0.5, y + h * 0.5), ShapeHandle::new(Cuboid::new(half)))
    };
    let compound = Compound::new(vec![place(0.0, 0.0, 4.0, 1.0), place(0.0, 1.0, 1.0, 2.0)]);
    let expected = unit(&compound);
    assert!((expected.0 - 6.0).abs() < 1e-15, "the area");
    let shapes: [&dyn Shape<f64, 2>; 3] = [&outline, &reversed, &filled];
    for shape in shapes {
        assert_alike(&unit(shape), &expected, 1e-14, "an L");
    }
    let open = Polyline::open(corners.to_vec());
    assert_eq!(mass_properties(&open, 1.0), Err(MassError::NotClosed { part: 0 }));
    let wire = Polyline::closed(vec![p3(0.0, 0.0, 0.0), p3(1.0, 0.0, 0.0), p3(0.0, 1.0, 0.0)]);
    assert_eq!(mass_properties(&wire, 1.0), Err(MassError::NotClosed { part: 0 }));
}

/// Asserts that the error for a part inside nested compounds reports the index of the part in the
/// outermost compound.
#[test]
fn errors_in_compounds_name_the_part() {
    let ball = ShapeHandle::new(Ball::new(1.0));
    let ground = ShapeHandle::new(Plane::<f64, 3>::new(Unit::new_unchecked(V3::y())));
    let closed = ShapeHandle::new(mesh::<f64>(&[cuboid([1.0; 3], [0.0; 3], false)]));
    let (vertices, mut triangles) = cuboid([1.0; 3], [0.0; 3], false);
    triangles.pop();
    let open = ShapeHandle::new(mesh::<f64>(&[(vertices, triangles)]));
    let here = Isometry3::identity();
    let compound = |shapes: &[&ShapeHandle<f64, 3>]| {
        let children = shapes.iter().map(|shape| (here, (*shape).clone()));
        ShapeHandle::new(Compound::new(children.collect()))
    };
    let inner = compound(&[&ball, &ground]);
    let outer = compound(&[&closed, &ball, &inner]);
    let refused = mass_properties(&*outer, 1.0).expect_err("it has a half-space");
    assert_eq!(refused, MassError::Unbounded { part: 12 + 1 + 1 });
    assert_eq!(outer.path_to_part(14).as_slice(), [2, 1], "where it is");
    let outer = compound(&[&closed, &open]);
    let Err(MassError::NotClosed { part }) = mass_properties(&*outer, 1.0) else {
        panic!("a mesh is open")
    };
    assert_eq!(outer.path_to_part(part)[0], 1, "the second child");
    // The density is requested once for each child, in order.
    let (mut asked, outer) =
        (Vec::new(), compound(&[&closed, &compound(&[&ball, &closed]), &ball]));
    let body = impinge::query::mass_properties_with(&*outer, &mut |path| {
        asked.push(path.to_vec());
        0.5
    });
    assert_eq!(asked, [vec![0], vec![1, 0], vec![1, 1], vec![2]], "in order");
    let mass = body.expect("solids").mass();
    let expected = 0.5 * (16.0 + 2.0 * unit::<f64, 3>(&Ball::new(1.0)).0);
    assert!((mass - expected).abs() < 1e-13, "overlaps count twice");
}

/// Asserts that small triangles far from each other keep their areas.
#[test]
fn small_triangles_far_apart_have_their_areas() {
    for far in [1e3, 3e8] {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let beyond = corners.map(|[x, y]| [x + far, y + far]);
        let vertices = corners.into_iter().chain(beyond).map(Point::<f64, 2>::from).collect();
        let mesh = TriMesh::<f64, 2>::new(vertices, vec![[0, 1, 2], [3, 4, 5]]);
        let body = mass_properties(&mesh, 1.0).expect("two areas");
        assert_eq!(body.mass(), 1.0, "{far} apart");
    }
}
