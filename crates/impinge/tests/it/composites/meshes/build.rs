//! Tests which meshes are refused, and the neighbours, normals and boxes of the parts of meshes.

use impinge::dim3::procedural;
use impinge::math::na::{Isometry3, Point3, Vector3};
use impinge::math::{Pose, Real, Space, max};
use impinge::shape::{
    Ball, CompositeShape, Cone, Cuboid, EdgeNeighbor, MeshError, Polyline, Shape, ShapeKind,
    TriMesh,
};
use impinge_reference::random::Random;

use super::{grid, mesh, points, soup, sphere, vector};

const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn refused(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> MeshError {
    TriMesh::<f32, 3>::try_new(points(vertices), triangles.to_vec()).expect_err("bad input")
}

#[test]
fn bad_meshes_are_refused_by_name() {
    assert_eq!(refused(&SQUARE, &[]), MeshError::Empty, "no triangle");
    let named = MeshError::NoSuchVertex { part: 1, vertex: 4, vertices: 4 };
    assert_eq!(refused(&SQUARE, &[[0, 1, 2], [0, 4, 2]]), named, "out of range");
    assert_eq!(named.to_string(), "part 1 names vertex 4, but there are 4 vertices", "in words");
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        let mut vertices = SQUARE;
        vertices[3][1] = bad;
        let expected = MeshError::VertexNotFinite { vertex: 3 };
        assert_eq!(refused(&vertices, &[[0, 1, 2]]), expected, "{bad}, though unused");
    }
    let lines = |vertices: &[[f64; 2]]| Polyline::<f64, 2>::try_open(points(vertices));
    let few = |given| MeshError::TooFewVertices { given };
    assert_eq!(lines(&[]).expect_err("nothing"), few(0), "no vertex");
    assert_eq!(lines(&[[0.0; 2]]).expect_err("a point"), few(1), "one vertex");
    let closed = Polyline::<f64, 2>::try_closed(points(&[[1.0, 2.0]]));
    assert_eq!(closed.expect_err("a point"), few(1), "one vertex");
    let infinite = lines(&[[0.0, 1.0], [f64::INFINITY, 0.0]]).expect_err("infinite");
    assert_eq!(infinite, MeshError::VertexNotFinite { vertex: 1 }, "the second");
    let segments = Polyline::<f32, 3>::try_new(points(&SQUARE), vec![[0, 1], [7, 0]]);
    let named = MeshError::NoSuchVertex { part: 1, vertex: 7, vertices: 4 };
    assert_eq!(segments.expect_err("out of range"), named, "the second");
}

#[test]
#[should_panic(expected = "part 0 names vertex 9, but there are 4")]
fn new_panics_in_words() {
    let _ = mesh::<f32, 3>(&SQUARE, &[[0, 1, 9]]);
}

/// Compares the neighbours of triangles with a scan of all sides of all triangles.
fn check_neighbors<N: Space<D>, const D: usize>(mesh: &TriMesh<N, D>) {
    let ends = |triangle: u32, side: u32| {
        let corners = mesh.triangles()[triangle as usize];
        [side, (side + 1) % 3].map(|at| mesh.vertices()[corners[at as usize] as usize])
    };
    let count = u32::try_from(mesh.num_triangles()).expect("few");
    let sides = || (0..count).flat_map(|triangle| (0..3).map(move |side| (triangle, side)));
    for (triangle, side) in sides() {
        let [a, b] = ends(triangle, side);
        let others: Vec<_> = sides()
            .filter(|&(other, across)| {
                let [from, to] = ends(other, across);
                other != triangle && a != b && ([from, to] == [a, b] || [to, from] == [a, b])
            })
            .collect();
        let expected = match others.as_slice() {
            [] => EdgeNeighbor::Border,
            &[(index, across)] => {
                EdgeNeighbor::Triangle { index, is_flipped: ends(index, across) == [a, b] }
            }
            _ => EdgeNeighbor::Several,
        };
        assert_eq!(mesh.neighbor(triangle, side), expected, "side {side} of {triangle}");
    }
}

fn surfaces<N: Real>() -> Vec<TriMesh<N, 3>> {
    let cuboid = procedural::cuboid(&Cuboid::new(vector([1.0, 2.0, 3.0])));
    let cone = procedural::cone(&Cone::new(N::ONE, N::TWO), 12);
    let good = |surface| TriMesh::try_from(surface).expect("a good surface");
    vec![good(cuboid), good(cone), sphere(8)]
}

#[test]
fn closed_surfaces_have_neighbors_everywhere() {
    for mesh in surfaces::<f32>() {
        check_neighbors(&mesh);
        assert!(mesh.is_closed() && mesh.is_oriented(), "no border, one outside");
        let soup = soup(&mesh);
        check_neighbors(&soup);
        assert!(soup.is_closed() && soup.is_oriented(), "by position");
        let merged = soup.with_vertices_merged();
        assert_eq!(merged.vertices().len(), mesh.vertices().len(), "each once");
        assert_eq!(merged.num_triangles(), mesh.num_triangles(), "the same");
        for part in 0..mesh.num_parts() {
            assert_eq!(merged.triangle(part), mesh.triangle(part), "in place");
        }
    }
}

/// Asserts that merging vertices keeps vertices apart that were moved away from each other.
#[test]
fn vertices_that_were_moved_apart_are_not_merged() {
    let corners = |torn: [f64; 2]| {
        let torn = [torn[0], torn[1], 0.0];
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], torn, [-1.0, 0.0, 0.0]]
    };
    let mut torn = mesh::<f64, 3>(&corners([0.0; 2]), &[[0, 1, 2], [3, 2, 4]]);
    assert_eq!(torn.clone().with_vertices_merged().vertices().len(), 4, "0 and 3 are one");
    torn.set_vertices(&points(&corners([-0.25, -0.5])));
    let merged = torn.clone().with_vertices_merged();
    for part in 0..2 {
        assert_eq!(merged.triangle(part), torn.triangle(part), "triangle {part} stays");
    }
}

#[test]
fn open_flat_and_odd_meshes() {
    let (vertices, triangles) = grid(3, |x, y| [x, y]);
    let floor = mesh::<f64, 2>(&vertices, &triangles);
    check_neighbors(&floor);
    assert!(!floor.is_closed() && floor.is_oriented(), "with a border");
    let fan = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [2, 2, 4]];
    let fan = mesh::<f64, 3>(&[SQUARE.as_slice(), &[[0.5, 0.5, 3.0]]].concat(), &fan);
    check_neighbors(&fan);
    assert_eq!(fan.neighbor(0, 0), EdgeNeighbor::Several, "three at one edge");
    assert_eq!(fan.neighbor(3, 0), EdgeNeighbor::Border, "no length");
    assert!(!fan.is_oriented() && !fan.is_closed(), "neither");
    let flipped = mesh::<f32, 3>(&SQUARE, &[[0, 1, 2], [0, 3, 2], [0, 1, 2]]);
    check_neighbors(&flipped);
}

/// Tests a band of eight quadrilaterals with half a twist, in which neighbouring triangles cannot
/// all have matching windings.
#[test]
fn a_moebius_strip_has_one_seam_too_many() {
    let mut vertices = Vec::new();
    for step in 0..8 {
        let (sine, cosine) = (f64::from(step) * std::f64::consts::FRAC_PI_4).sine_cosine();
        let (rise, out) = (f64::from(step) * std::f64::consts::FRAC_PI_8).sine_cosine();
        for side in [-0.3, 0.3] {
            let radius = 2.0 + side * out;
            vertices.push([radius * cosine, radius * sine, side * rise]);
        }
    }
    let quad = |i: u32| {
        let (a, b) = (2 * i, 2 * i + 1);
        let [c, d] = if i == 7 { [1, 0] } else { [a + 2, b + 2] };
        [[a, c, b], [b, c, d]]
    };
    let strip = mesh::<f64, 3>(&vertices, &(0..8).flat_map(quad).collect::<Vec<_>>());
    check_neighbors(&strip);
    assert!(!strip.is_oriented() && !strip.is_closed(), "one side, one border");
    let is_flipped = |side: &(u32, u32)| {
        matches!(strip.neighbor(side.0, side.1), EdgeNeighbor::Triangle { is_flipped: true, .. })
    };
    let sides = (0..16).flat_map(|triangle| (0..3).map(move |side| (triangle, side)));
    assert_eq!(sides.filter(is_flipped).count(), 2, "one seam, seen from both sides");
}

#[test]
fn adjacent_parts_share_a_corner() {
    let welded = soup(&sphere::<f32>(6));
    for (a, b) in (0..welded.num_parts()).flat_map(|a| (0..a).map(move |b| (a, b))) {
        let (first, second) = (welded.triangle(a), welded.triangle(b));
        let expected = first.corners().iter().any(|corner| second.corners().contains(corner));
        assert_eq!(welded.are_adjacent(a, b), expected, "{a} and {b}");
    }
}

#[test]
fn parts_are_the_triangles_in_order() {
    let mesh = surfaces::<f64>().remove(0);
    assert_eq!(Shape::<f64, 3>::geometry(&mesh).kind(), ShapeKind::Composite, "of parts");
    for part in 0..mesh.num_parts() {
        let found = mesh.part(part);
        assert_eq!(found.pose, Pose::identity(), "in the frame of the mesh");
        let expected = mesh.triangle(part).local_aabb();
        assert_eq!(found.solid.as_shape().local_aabb(), expected, "part {part}");
        let shape: &dyn Shape<f64, 3> = &mesh;
        assert_eq!(shape.path_to_part(part).as_slice(), [part], "no nesting");
    }
}

#[test]
fn scaling_keeps_the_front_outside() {
    for scale in [[2.0, 0.5, 1.0], [-1.0, 2.0, 3.0], [-1.0, -1.0, 1.0], [-2.0, -2.0, -2.0]] {
        let scaled = sphere::<f32>(8).one_sided().try_scaled(&vector(scale)).expect("not zero");
        assert!(scaled.is_one_sided() && scaled.is_closed(), "as before");
        for part in 0..scaled.num_parts() {
            let normal = scaled.normal(part).expect("an area");
            let corner = scaled.triangle(part).corners()[0];
            assert!(normal.dot(&corner.coords) > 0.0, "{scale:?}: {part} faces outwards");
        }
    }
    let refused = |scale| sphere::<f32>(4).try_scaled(&vector(scale)).expect_err("bad scale");
    assert_eq!(refused([1.0, 0.0, 1.0]), MeshError::BadScale { axis: 1, value: 0.0 }, "zero");
    let infinite = MeshError::BadScale { axis: 2, value: f64::INFINITY };
    assert_eq!(refused([1.0, 1.0, f64::INFINITY]), infinite, "infinite");
    let far = sphere::<f32>(4).try_scaled(&vector([3e38; 3])).expect("in range");
    let overflown = far.try_scaled(&vector([2.0; 3])).expect_err("out of range");
    assert_eq!(overflown, MeshError::VertexNotFinite { vertex: 0 }, "the pole");
}

#[test]
fn flipping_turns_the_normals() {
    let mesh = sphere::<f64>(6);
    let flipped = mesh.clone().flipped();
    for part in 0..mesh.num_parts() {
        let turned = flipped.normal(part).map(|normal| -normal);
        assert_eq!(turned, mesh.normal(part), "{part}");
    }
}

#[test]
fn triangles_without_area_have_no_normal() {
    let far = 1e4;
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [far, far, 0.0]];
    let flat = mesh::<f32, 3>(&vertices, &[[0, 1, 2], [0, 0, 1], [1, 1, 1], [0, 1, 3]]);
    assert_eq!([0, 1, 2].map(|part| flat.normal(part)), [None; 3], "a line or a point");
    assert_eq!(flat.normal(3), Some(Vector3::z()), "however long");
    for magnitude in [1e-30_f64, 1e-15, 1e15, 1e30] {
        let small = SQUARE.map(|p| p.map(|x| x * magnitude));
        let small = mesh::<f32, 3>(&small, &[[0, 2, 1]]);
        assert_eq!(small.normal(0), Some(-Vector3::z()), "{magnitude}");
    }
}

/// Asserts for random poses that all corners lie in the box up to rounding, and in the sphere. Each
/// upper face of the box may be at most `looseness` beyond the corners.
fn check_boxes<N: Space<3>>(mesh: &TriMesh<N, 3>, looseness: N) {
    let mut random = Random::new(5);
    for _ in 0..20 {
        let axis = vector::<N, 3>(random.vector(2.0));
        let pose = Isometry3::new(vector([3.0, -2.0, 1.0]), axis);
        let pose = Pose::from_isometry(&pose);
        let placed: Vec<Point3<N>> = mesh.vertices().iter().map(|p| pose.point(p)).collect();
        let (aabb, sphere) = (mesh.aabb(&pose), mesh.local_bounding_sphere());
        let rounding = N::lit(16.0) * N::EPSILON; // of coordinates up to 4
        for (corner, local) in placed.iter().zip(mesh.vertices()) {
            assert!(aabb.distance_to_point(corner) <= rounding, "{corner} is outside");
            assert!((local - sphere.center()).norm() <= sphere.radius(), "{local} is outside");
        }
        for axis in 0..3 {
            let highest = placed.iter().map(|p| p[axis]).fold(-N::INFINITY, max);
            let loose = aabb.maxs()[axis] - highest;
            assert!(loose <= looseness, "axis {axis} is loose by {loose}");
        }
    }
}

#[test]
fn boxes_are_tight() {
    check_boxes(&sphere::<f32>(8), 4e-6);
    check_boxes(&sphere::<f64>(8), 1e-14);
    check_boxes(&sphere::<f32>(64), 1e-5);
    check_boxes(&sphere::<f64>(64), 1e-5);
    for bad in [f64::NAN, f64::INFINITY] {
        let nowhere = Pose::from_translation(vector([bad, 0.0, 0.0]));
        let mut turned = Pose::identity();
        turned.rotation[(0, 1)] = f32::lit(bad);
        for pose in [nowhere, turned] {
            for mesh in [sphere::<f32>(64), sphere(4)] {
                assert!(!mesh.aabb(&pose).is_bounded(), "nowhere is everywhere: {pose:?}");
            }
        }
    }
    let ball = procedural::ball(&Ball::new(2.0_f32), 4);
    let octahedron = TriMesh::try_from(ball).expect("good");
    assert_eq!(octahedron.local_aabb().maxs(), &Point3::new(2.0, 2.0, 2.0), "the smallest");
}
