//! Tests the drawings of shapes, worlds and queries, in both dimensions and with both scalars.

use std::collections::BTreeMap;

use impinge::bounding_volume::Ray;
use impinge::debug_render::{
    Color, DebugDrawing, DebugOptions, DebugRender, Drawn, MeshOptions, ShapeMesh, SweptShape,
};
use impinge::math::{Point, Pose, Real, Space, Unit, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::{ClosestPoints, ImpactOptions, PointQuery};
use impinge::shape::{
    Ball, Capsule, CompositeShape, Compound, Cuboid, HalfSpace, HeightField, Polyline, Rounded,
    Shape, ShapeHandle, ShapeKind, TriMesh,
};
use impinge::world::{CollisionGroups, CollisionWorld, QueryFilter};

use crate::support::query_support::random::Random;
use crate::support::query_support::samples::{PLANE, SPACE, Sample, sample2, sample3};

/// A back end that records all lines.
#[derive(Debug, PartialEq)]
struct Lines<N: Real, const D: usize>(Vec<Line<N, D>>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Line<N: Real, const D: usize> {
    ends: [Point<N, D>; 2],
    color: Color,
    what: Drawn,
}

impl<N: Space<D>, const D: usize> DebugRender<N, D> for Lines<N, D> {
    fn line(&mut self, ends: [Point<N, D>; 2], color: Color, what: Drawn) {
        self.0.push(Line { ends, color, what });
    }
}

impl<N: Real, const D: usize> Lines<N, D> {
    fn of(&self, what: Drawn) -> Vec<Line<N, D>> {
        self.0.iter().filter(|line| line.what == what).copied().collect()
    }
}

fn mesh_of<N: Space<D>, const D: usize>(shape: &dyn Shape<N, D>) -> ShapeMesh<N, D> {
    ShapeMesh::of(shape, &MeshOptions::default())
}

fn at<N: Space<D>, const D: usize>(coordinates: &[f64]) -> N::Isometry {
    N::isometry(&Pose::from_translation(vector(coordinates)))
}

/// Returns the vector with these first coordinates; the others are zero.
fn vector<N: Real, const D: usize>(coordinates: &[f64]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(coordinates.get(axis).copied().unwrap_or(0.0)))
}

/// Asserts that every index names a vertex, that all coordinates are finite, and that no line
/// occurs twice or has length zero.
fn assert_sound<N: Real, const D: usize>(mesh: &ShapeMesh<N, D>, name: &str) {
    let indices = mesh.lines.iter().flatten().chain(mesh.triangles.iter().flatten());
    for &index in indices {
        assert!((index as usize) < mesh.vertices.len(), "{name}: vertex {index}");
    }
    for vertex in &mesh.vertices {
        assert!(vertex.iter().all(|x| x.is_finite_number()), "{name}: {vertex}");
    }
    let mut lines: Vec<_> = mesh.lines.iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
    lines.sort_unstable();
    let count = lines.len();
    lines.dedup();
    assert_eq!(lines.len(), count, "{name}: a line twice");
    assert!(lines.iter().all(|[a, b]| a != b), "{name}: a line without length");
    assert!(!mesh.vertices.is_empty(), "{name}: nothing to see");
}

/// Asserts that random bounded solids of all kinds have their vertices on their surface; every
/// third has sizes of zero. Returns how many of their meshes have lines.
fn vertices_on_surfaces<N: Space<D>, const D: usize>(
    kinds: &[ShapeKind],
    sample: Sample<N, D>,
) -> usize {
    let mut with_lines = 0;
    for &kind in kinds.iter().filter(|&&kind| kind != ShapeKind::Plane) {
        for seed in 0..15 {
            let shape = sample(kind, &mut Random(seed, seed % 3 == 0), N::ONE);
            let (mesh, name) = (mesh_of(&*shape), format!("{kind:?} {seed}"));
            assert_sound(&mesh, &name);
            with_lines += usize::from(!mesh.lines.is_empty());
            for vertex in &mesh.vertices {
                let distance = shape.project_local_point(vertex).0.point - vertex;
                let allowed = N::EPSILON * N::lit(1024.0);
                assert!(distance.norm() <= allowed, "{name}: {vertex} is off by {distance}");
            }
        }
    }
    with_lines
}

#[test]
fn every_vertex_lies_on_the_surface() {
    let counts = [
        vertices_on_surfaces::<f32, 2>(&PLANE, sample2),
        vertices_on_surfaces::<f64, 2>(&PLANE, sample2),
        vertices_on_surfaces::<f32, 3>(&SPACE, sample3),
        vertices_on_surfaces::<f64, 3>(&SPACE, sample3),
    ];
    assert!(counts.iter().all(|&count| count > 120), "few are points: {counts:?}");
}

/// Asserts that the triangles of solids with an interior are counter-clockwise seen from outside.
/// `volume` returns a signed volume: in 3D of the simplex of a triangle and an inner point, in 2D
/// of the triangle.
fn triangles_face_outwards<N: Space<D>, const D: usize>(
    kinds: &[ShapeKind],
    sample: Sample<N, D>,
    volume: fn([Vector<f64, D>; 3]) -> f64,
) {
    let without = [ShapeKind::Plane, ShapeKind::Segment, ShapeKind::Triangle];
    for &kind in kinds.iter().filter(|kind| !without.contains(kind)) {
        let shape = sample(kind, &mut Random(7, false), N::ONE);
        let geometry = shape.geometry();
        let center = geometry.as_support_map().expect("it has an end").center();
        let mesh = mesh_of(&*shape);
        let corner = |index: u32| (mesh.vertices[index as usize] - center).map(N::as_f64);
        let volumes: Vec<_> =
            mesh.triangles.iter().map(|triangle| volume(triangle.map(corner))).collect();
        let rounding = 64.0 * N::EPSILON.as_f64();
        assert!(volumes.iter().all(|&volume| volume > -rounding), "{kind:?}: {volumes:?}");
        assert!(volumes.iter().sum::<f64>() > 0.01, "{kind:?} has an inside: {volumes:?}");
    }
}

#[test]
fn triangles_are_counter_clockwise() {
    let area = |[a, b, c]: [Vector<f64, 2>; 3]| (b - a).perp(&(c - a));
    let volume = |[a, b, c]: [Vector<f64, 3>; 3]| a.cross(&b).dot(&c);
    triangles_face_outwards::<f32, 2>(&PLANE, sample2, area);
    triangles_face_outwards::<f64, 2>(&PLANE, sample2, area);
    triangles_face_outwards::<f32, 3>(&SPACE, sample3, volume);
    triangles_face_outwards::<f64, 3>(&SPACE, sample3, volume);
}

/// Asserts that each edge of a box with half extents 1, 2, 3 runs along one axis, from one face to
/// the opposite one. The extents are unequal so that axes cannot be confused.
fn edges_of_boxes<N: Space<D>, const D: usize>(expected: usize) {
    let half = Vector::<N, D>::from_fn(|axis, _| N::lit([1.0, 2.0, 3.0][axis]));
    let mesh = mesh_of(&Cuboid::new(half));
    assert_eq!((mesh.vertices.len(), mesh.lines.len()), (1 << D, expected), "corners, edges");
    let mut along = [0; D];
    for ends in &mesh.lines {
        let [a, b] = ends.map(|end| mesh.vertices[end as usize]);
        let across: Vec<_> = (0..D).filter(|&axis| a[axis] != b[axis]).collect();
        let [axis] = across[..] else { panic!("{a} and {b} differ on one axis") };
        assert_eq!((b - a)[axis].abs(), N::TWO * half[axis], "from face to face");
        assert!((0..D).all(|axis| a[axis].abs() == half[axis]), "{a} is a corner");
        along[axis] += 1;
    }
    assert_eq!(along, [expected / D; D], "as many along each axis");
}

#[test]
fn boxes_have_their_edges() {
    edges_of_boxes::<f32, 2>(4);
    edges_of_boxes::<f64, 2>(4);
    edges_of_boxes::<f32, 3>(12);
    edges_of_boxes::<f64, 3>(12);
}

#[test]
fn rounded_polygons_have_straight_sides() {
    let square = Rounded::new(Cuboid::new(vector::<f64, 2>(&[1.0, 2.0])), 0.5);
    let mesh = mesh_of(&square);
    let mut lengths: Vec<_> = mesh
        .lines
        .iter()
        .map(|ends| ends.map(|end| mesh.vertices[end as usize]))
        .map(|[a, b]| (b - a).norm())
        .filter(|&length| length > 1.0)
        .collect();
    lengths.sort_by(f64::total_cmp);
    assert_eq!(lengths, [2.0, 2.0, 4.0, 4.0], "the sides of the box, moved outwards");
}

#[test]
fn half_spaces_have_the_given_extent() {
    let options = MeshOptions { half_space_extent: 3.0, ..MeshOptions::default() };
    let normal = Unit::new_normalize(vector::<f64, 3>(&[1.0, 2.0, -2.0]));
    let mesh = ShapeMesh::of(&HalfSpace::new(normal), &options);
    assert_sound(&mesh, "half-space");
    let heights: Vec<_> = mesh.vertices.iter().map(|v| normal.dot(&v.coords)).collect();
    assert!(heights.iter().all(|&height| height < 1e-12), "solid side: {heights:?}");
    assert_eq!(mesh.triangles.len(), 2, "a square");
    let level = mesh.vertices.iter().filter(|v| normal.dot(&v.coords) > -1e-12);
    let farthest = level.map(|v| v.coords.norm()).fold(0.0, f64::max);
    assert!((farthest - 3.0 * 2.0_f64.sqrt()).abs() < 1e-12, "its corners: {farthest}");
    let line = ShapeMesh::of(&HalfSpace::new(Unit::new_normalize(Vector::<f64, 2>::y())), &options);
    let level = |ends: &&[u32; 2]| ends.iter().all(|&end| line.vertices[end as usize].y == 0.0);
    assert_eq!(line.lines.iter().filter(level).count(), 1, "in 2D one line, and marks");
    let endless = MeshOptions { half_space_extent: f64::INFINITY, ..options };
    let nothing = ShapeMesh::of(&HalfSpace::new(normal), &endless);
    assert!(nothing.lines.is_empty() && nothing.vertices.is_empty(), "nothing finite is there");
}

#[test]
fn composites_are_their_parts_and_each_seam_is_one_line() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]];
    let mesh =
        TriMesh::new(corners.map(Point::<f32, 3>::from).to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    let drawn = mesh_of(&mesh);
    assert_eq!((drawn.vertices.len(), drawn.lines.len(), drawn.triangles.len()), (4, 5, 2));

    let field = HeightField::<f64, 3>::new(3, 3, vec![0.0; 9], vector(&[2.0, 1.0, 2.0]));
    let holes = field.clone().with_holes(|row, column| (row, column) == (0, 0));
    let [whole, rest] = [&field, &holes].map(|field| mesh_of(field).triangles.len());
    assert_eq!((whole, rest), (8, 6), "holes are left out");

    let line = Polyline::<f32, 2>::open([0.0, 1.0, 2.0].map(|x| Point::from([x, x * x])).to_vec());
    let drawn = mesh_of(&line);
    assert_eq!((drawn.vertices.len(), drawn.lines.len(), drawn.triangles.len()), (3, 2, 0));

    let inner = Compound::new(vec![(at::<f64, 3>(&[1.0]), ShapeHandle::new(holes))]);
    let brick = ShapeHandle::new(Cuboid::new(vector(&[0.5, 0.5, 0.5])));
    let parts =
        vec![(at::<f64, 3>(&[0.0, 5.0]), ShapeHandle::new(inner)), (at::<f64, 3>(&[]), brick)];
    let compound = Compound::new(parts);
    let drawn = mesh_of(&compound);
    assert_sound(&drawn, "compound");
    assert_eq!(drawn.triangles.len(), 6 + 12, "of nested parts, without holes");
    let raised = drawn.vertices.iter().filter(|v| v.y == 5.0).count();
    assert_eq!((raised, compound.num_parts()), (8, 9), "where the parts are");
}

#[test]
fn ids_follow_from_the_mesh() {
    let ids: Vec<_> = [0.5, 0.75, 0.5].map(|size| mesh_of::<f32, 3>(&Ball::new(size)).id).to_vec();
    assert_eq!(ids[0], ids[2]);
    assert_ne!(ids[0], ids[1]);
    let fine = MeshOptions { subdivisions: 25, ..MeshOptions::default() };
    assert_ne!(ShapeMesh::<f32, 3>::of(&Ball::new(0.5), &fine).id, ids[0]);
}

/// Returns a world of a half-space and five bounded shapes above it. Three overlap each other in a
/// row; a point and a box to the left of the row are sensors.
fn stage<N: Space<D>, const D: usize>() -> CollisionWorld<N, D, ()> {
    let mut world = CollisionWorld::new(N::lit(0.02));
    let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    let sensor = GeometricQueryType::Proximity(N::lit(0.5));
    let sizes = Vector::<N, D>::repeat(N::ONE);
    let up = Unit::new_normalize(vector(&[0.0, 1.0]));
    let shapes = [
        (ShapeHandle::new(HalfSpace::<N, D>::new(up)), [0.0, 0.0], contacts),
        (ShapeHandle::new(Cuboid::new(sizes)), [0.0, 0.75], contacts),
        (ShapeHandle::new(Capsule::new(N::ONE, N::HALF)), [1.25, 1.25], contacts),
        (ShapeHandle::new(Ball::new(N::ONE)), [2.5, 0.5], contacts),
        (ShapeHandle::new(Ball::new(N::ZERO)), [-1.25, 1.0], sensor),
        (ShapeHandle::new(Cuboid::new(sizes)), [-0.5, 1.0], sensor),
    ];
    for (shape, place, query) in shapes {
        world.add(at::<N, D>(&place), shape, CollisionGroups::new(), query, ());
    }
    world.update();
    world
}

/// Draws a world twice, asserts that both drawings are equal, and returns the lines. The lines of
/// an object have the object's uid as the red component of their colour.
fn picture<N: Space<D>, const D: usize>(
    world: &CollisionWorld<N, D, ()>,
    options: DebugOptions<N>,
) -> Lines<N, D> {
    let mut drawing = DebugDrawing::new(options).with_object_color(|handle| {
        Some(Color::rgb(u8::try_from(handle.uid()).expect("few objects"), 0, 0))
    });
    let (mut first, mut second) = (Lines(Vec::new()), Lines(Vec::new()));
    drawing.world(world, &mut first);
    drawing.world(world, &mut second);
    assert_eq!(first, second, "the same world gives the same picture");
    first
}

fn worlds<N: Space<D>, const D: usize>() {
    let world = stage::<N, D>();
    let drawn = picture(&world, DebugOptions::all());
    for line in &drawn.0 {
        let finite = line.ends.iter().all(|end| end.iter().all(|x| x.is_finite_number()));
        assert!(finite, "{line:?}");
    }
    let counts = drawn.0.iter().fold(BTreeMap::new(), |mut counts, line| {
        *counts.entry(line.what).or_insert(0) += 1;
        counts
    });
    let edges = D << (D - 1);
    // The half-space has no box, so 5 objects have one; 5 boxes fit in one node of the tree.
    assert_eq!(counts.get(&Drawn::TightBox), Some(&(5 * edges)), "{counts:?}");
    assert_eq!(counts.get(&Drawn::LoosenedBox), Some(&(5 * edges)), "{counts:?}");
    assert_eq!(counts.get(&Drawn::TreeNode), Some(&edges), "{counts:?}");
    assert!(counts.get(&Drawn::Proximity) > Some(&1), "{counts:?}");
    boxes_hold_their_objects(&world, &drawn);
    contact_points_lie_on_both(&world, &drawn);

    let nothing = picture(&world, DebugOptions::none());
    assert_eq!(nothing.0.len(), 0, "off draws nothing");
    let empty = picture::<N, D>(&CollisionWorld::default(), DebugOptions::all());
    assert_eq!(empty.0.len(), 0, "an empty world has nothing to draw");
}

fn boxes_hold_their_objects<N: Space<D>, const D: usize>(
    world: &CollisionWorld<N, D, ()>,
    drawn: &Lines<N, D>,
) {
    let (tight, loosened) = (drawn.of(Drawn::TightBox), drawn.of(Drawn::LoosenedBox));
    let objects = drawn.of(Drawn::Object);
    let edges = D << (D - 1);
    // The half-space is the first object and has no boxes.
    let boxes = tight.chunks(edges).zip(loosened.chunks(edges));
    for (object, (tight, loosened)) in world.collision_objects().skip(1).zip(boxes) {
        let number = u8::try_from(object.handle().uid()).expect("few objects");
        let lines = objects.iter().filter(|line| line.color.rgb[0] == number);
        let inner: Vec<_> = lines.flat_map(|line| line.ends).collect();
        let (tight, loosened) = (extremes(tight), extremes(loosened));
        assert!(!inner.is_empty() || object.shape().is_shape::<Ball<N>>(), "a point has no lines");
        for axis in 0..D {
            let [low, high] = tight.map(|corner| corner[axis]);
            let slack = N::EPSILON * N::lit(16.0);
            let holds = |x: N| x >= low - slack && x <= high + slack;
            assert!(inner.iter().all(|point| holds(point[axis])), "{number}: {tight:?}");
            assert!(loosened[0][axis] < low && high < loosened[1][axis], "by the margin");
        }
    }
}

/// Returns the least and the greatest coordinates of the ends of lines.
fn extremes<N: Real, const D: usize>(lines: &[Line<N, D>]) -> [Vector<N, D>; 2] {
    let ends: Vec<_> = lines.iter().flat_map(|line| line.ends.map(|end| end.coords)).collect();
    let low = ends.iter().fold(ends[0], |low, end| low.inf(end));
    [low, ends.iter().fold(ends[0], |high, end| high.sup(end))]
}

/// Asserts that each contact point is drawn as a cross of `D` lines centred at the point. Crosses
/// lie alternately on the first and the second shape of a pair.
fn contact_points_lie_on_both<N: Space<D>, const D: usize>(
    world: &CollisionWorld<N, D, ()>,
    drawn: &Lines<N, D>,
) {
    let lines = drawn.of(Drawn::ContactPoint);
    let middle = |cross: &[Line<N, D>]| {
        let [a, b] = cross[0].ends;
        a + (b - a) * N::HALF
    };
    let points: Vec<_> = lines.chunks(D).map(middle).collect();
    let pairs: Vec<_> = world
        .contact_manifolds()
        .flat_map(|(object1, object2, manifold)| vec![[object1, object2]; manifold.len()])
        .collect();
    assert_eq!(points.len(), 2 * pairs.len(), "one on each shape");
    assert!(pairs.len() > 3, "objects touch: {}", pairs.len());
    for (pair, points) in pairs.iter().zip(points.chunks(2)) {
        for (object, point) in pair.iter().zip(points) {
            let local = N::pose(object.position()).inverse_point(point);
            let distance = object.shape().signed_distance_to_local_point(&local).abs();
            assert!(distance < N::EPSILON * N::lit(64.0), "{point} is off by {distance}");
        }
    }
}

#[test]
fn worlds_are_drawn() {
    worlds::<f32, 2>();
    worlds::<f64, 2>();
    worlds::<f32, 3>();
    worlds::<f64, 3>();
}

#[test]
fn meshes_of_replaced_shapes_are_made_anew() {
    let mut world = CollisionWorld::<f64, 2, ()>::new(0.02);
    let line = Polyline::<f64, 2>::open([-1.0, 0.0, 1.0].map(|x| Point::from([x, 0.0])).to_vec());
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    let handle =
        world.add(at::<f64, 2>(&[]), ShapeHandle::new(line), CollisionGroups::new(), query, ());
    let mut drawing = DebugDrawing::default();
    for height in [1.0, 2.0, 3.0] {
        world.deform(handle, |line: &mut Polyline<f64, 2>| {
            line.set_vertices(&[-1.0, 0.0, 1.0].map(|x| Point::from([x, height * (1.0 - x * x)])));
        });
        let mut drawn = Lines(Vec::new());
        drawing.world(&world, &mut drawn);
        assert_eq!(extremes(&drawn.0)[1].y, height, "as it is now");
    }
    assert!(format!("{drawing:?}").contains("num_meshes: 1"), "old ones are dropped: {drawing:?}");
}

fn queries<N: Space<D>, const D: usize>() {
    let (world, mut drawing) = (stage::<N, D>(), DebugDrawing::new(DebugOptions::all()));
    let ray = Ray::new(Point::from(vector(&[0.0, 9.0])), vector::<N, D>(&[0.0, -2.0]));
    let (_, hit) =
        world.first_ray_hit(&ray, N::INFINITY, true, &QueryFilter::new()).expect("a box");
    let mut drawn = Lines(Vec::new());
    drawing.ray(&ray, N::INFINITY, &[hit], &mut drawn);
    let [line] = drawn.of(Drawn::Query)[..] else { panic!("one ray: {drawn:?}") };
    assert_eq!(line.ends, [ray.origin, ray.point_at(hit.toi)], "to the hit");
    assert!(drawn.of(Drawn::QueryHit).len() > D, "a cross and a normal");

    let ball = ShapeHandle::new(Ball::new(N::HALF));
    let sweep = SweptShape {
        shape: &ball,
        position: at::<N, D>(&[0.0, 9.0]),
        velocity: vector(&[0.0, -1.0]),
        max_time: N::lit(20.0),
    };
    let options = ImpactOptions::new().with_max_time(sweep.max_time);
    let start = &sweep.position;
    let hit = world.cast_shape(start, &sweep.velocity, &*ball, &options, &QueryFilter::new());
    let (_, impact) = hit.expect("it falls on the box");
    let (mut with_hit, mut without) = (Lines(Vec::new()), Lines(Vec::new()));
    drawing.cast(&sweep, Some(&impact), &mut with_hit);
    drawing.cast(&sweep, None, &mut without);
    let (mesh, way) = (mesh_of(&*ball).lines.len(), 1 + 2 * (D - 1));
    assert_eq!(without.0.len(), 2 * mesh + way, "start and end");
    assert_eq!(with_hit.of(Drawn::Query).len(), 3 * mesh + way, "and at the impact");
    let at_impact = &with_hit.0[mesh..2 * mesh];
    let lowest = extremes(at_impact)[0][1];
    assert!((lowest - impact.world1[1]).abs() < N::EPSILON * N::lit(64.0), "it touches: {lowest}");

    let (a, b) = (Point::origin(), Point::from(vector::<N, D>(&[3.0])));
    let mut drawn = Lines(Vec::new());
    drawing.closest_points(&ClosestPoints::WithinMargin(a, b), &mut drawn);
    assert_eq!((drawn.0[0].ends, drawn.0.len()), ([a, b], 1 + 2 * D), "and two crosses");
    drawing.closest_points(&ClosestPoints::Intersecting, &mut drawn);
    assert_eq!(drawn.0.len(), 1 + 2 * D, "nothing between solids that touch");
}

#[test]
fn queries_are_drawn() {
    queries::<f32, 2>();
    queries::<f64, 2>();
    queries::<f32, 3>();
    queries::<f64, 3>();
}

#[test]
fn what_is_not_finite_is_left_out() {
    let mut drawing = DebugDrawing::new(DebugOptions::all());
    let ball = ShapeHandle::new(Ball::new(1.0));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut drawn = Lines(Vec::new());
        let ray = Ray::new(Point::origin(), vector::<f64, 2>(&[bad, 1.0]));
        drawing.ray(&ray, 1.0, &[], &mut drawn);
        drawing.shape(&ball, &at::<f64, 2>(&[0.0, bad]), &mut drawn);
        let (position, velocity) = (at::<f64, 2>(&[bad]), Vector::<f64, 2>::zeros());
        let sweep = SweptShape { shape: &ball, position, velocity, max_time: 1.0 };
        drawing.cast(&sweep, None, &mut drawn);
        assert_eq!(drawn.0.len(), 0, "of {bad}: {drawn:?}");
    }
}

#[test]
fn the_area_of_a_manifold_goes_around_its_points() {
    let (world, mut drawn) = (stage::<f64, 3>(), Lines(Vec::new()));
    let (_, _, view) = world.contact_views().find(|(_, _, view)| view.len() == 4).expect("a face");
    let contacts = view.contacts().map(|point| point.contact);
    DebugDrawing::new(DebugOptions::all()).contacts(contacts, &mut drawn);
    let area: f64 = drawn
        .of(Drawn::Manifold)
        .chunks(3)
        .map(|sides| {
            let ([a, b], c) = (sides[0].ends, sides[1].ends[1]);
            (b - a).cross(&(c - a)).y.abs() / 2.0
        })
        .sum();
    assert!((area - 4.0).abs() < 1e-12, "the face of the box: {area}");
}
