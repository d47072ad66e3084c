//! Tests contacts with surfaces over several updates. The contacts of balls must equal the contacts
//! of the generic path, which defines them. The deepest contact of a ball, a box or a hull must be
//! the contact that a query returns, up to rounding.

use super::CompositeContacts;
use super::chain_tests::{assert_one_contact, assert_same};
use crate::collide::ManifoldRequest;
use crate::collide::pair::{Ordered, Placed};
use crate::collide::parts::Between;
use crate::collide::separation::hulls::tests::Random;
use crate::math::{Point, Pose, Real, Space, Vector};
use crate::samples::samples;
use crate::shape::{Ball, ConvexHull, Cuboid, HeightField, Shape, TriMesh};

/// Number of updates of each solid.
const STEPS: usize = 6;
/// Number of vertices along each side of a terrain.
const POINTS: u32 = 9;

/// Returns heights over a grid: rough if `kind` is 0, gentle if it is 1, else flat with steps.
fn heights<N: Real>(random: &mut Random, kind: usize) -> Vec<N> {
    let mut next = |_| {
        let change = random.vector::<N>().x;
        match kind {
            0 => change * N::HALF,
            1 => change * N::lit(0.03),
            _ if change > N::HALF => N::lit(0.25),
            _ => N::ZERO,
        }
    };
    (0..POINTS * POINTS).map(&mut next).collect()
}

/// Returns a mesh over a grid, with some of these variations at random: each triangle has its own
/// vertices; some triangles are left out, turned over or without area; two vertices are moved, one
/// of them to the position of another vertex; contacts with internal edges are kept.
fn mesh_of<N: Space<3>>(random: &mut Random, heights: &[N]) -> TriMesh<N, 3> {
    let vertex_at = |at: u32| {
        let [x, z] = [at % POINTS, at / POINTS].map(|n| N::lit(f64::from(n) * 0.5 - 2.0));
        Point::<N, 3>::new(x, heights[at as usize], z)
    };
    let mut vertices: Vec<_> = (0..POINTS * POINTS).map(vertex_at).collect();
    let cells = (0..POINTS * (POINTS - 1)).filter(|at| at % POINTS + 1 < POINTS);
    let triangles = cells.flat_map(|a| {
        let (b, c, d) = (a + POINTS, a + POINTS + 1, a + 1);
        if a % 3 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [d, b, c]] }
    });
    let is_torn = random.pick(4) == 0;
    let mut triangles: Vec<_> = triangles.filter(|_| !is_torn || random.pick(9) > 0).collect();
    if random.pick(4) == 0 {
        triangles.push([0, 1, 2]);
        triangles.iter_mut().step_by(7).for_each(|triangle| triangle.swap(0, 1));
    }
    if random.pick(3) == 0 {
        vertices = triangles.iter().flatten().map(|&at| vertices[at as usize]).collect();
        let count = u32::try_from(triangles.len()).expect("few");
        triangles = (0..count).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect();
    }
    let mut mesh = TriMesh::new(vertices.clone(), triangles);
    if random.pick(5) == 0 {
        vertices[40] = vertices[41];
        vertices[30].y += N::lit(0.1);
        mesh.set_vertices(&vertices);
    }
    if random.pick(6) == 0 { mesh.with_internal_edges_kept() } else { mesh }
}

/// Returns a terrain around the origin: a mesh or a height field, one-sided or two-sided.
fn ground_of<N: Space<3>>(random: &mut Random, round: usize) -> Box<dyn Shape<N, 3>> {
    let heights = heights::<N>(random, round % 3);
    let is_one_sided = random.pick(3) == 0;
    if random.pick(2) == 0 {
        let mesh = mesh_of(random, &heights);
        return Box::new(if is_one_sided { mesh.one_sided() } else { mesh });
    }
    let extent = |random: &mut Random| N::lit([4.0, -4.0, 4.0, 4.0, 0.0][random.pick(5)]);
    let extents = Vector::<N, 3>::new(extent(random), N::ONE, extent(random));
    let points = POINTS as usize;
    let hole = random.pick(64);
    let field = HeightField::<N, 3>::new(points, points, heights, extents)
        .with_holes(|row, column| row * 8 + column == hole);
    Box::new(if is_one_sided { field.one_sided() } else { field })
}

/// A solid, and the height of its centre above flat terrain on which it lies.
type Solid<N> = (Box<dyn Shape<N, 3>>, N);

fn ball_of<N: Space<3>>(random: &mut Random) -> Solid<N> {
    let ball = Ball::new(N::lit([0.0, 0.05, 0.3, 0.6, 2.0][random.pick(5)]));
    (Box::new(ball), ball.radius())
}

/// Returns a box, perhaps flat, or a hull of a box's corners and further points.
fn flat_of<N: Space<3>>(random: &mut Random) -> Solid<N> {
    let mut half = random.vector::<N>().map(|more| N::ONE + more * N::lit(0.1));
    half.iter_mut().for_each(|half| {
        *half *= N::lit([0.02, 0.2, 0.3, 0.45, 0.7, 0.9][random.pick(6)]);
    });
    let height = half.y;
    if random.pick(2) == 0 {
        if random.pick(6) == 0 {
            half[random.pick(3)] = N::ZERO;
        }
        return (Box::new(Cuboid::new(half)), height);
    }
    let corner = |at: usize| {
        let sign = |axis: usize| if at >> axis & 1 == 0 { -half[axis] } else { half[axis] };
        Point::<N, 3>::new(sign(0), sign(1), sign(2))
    };
    let mut corners: Vec<_> = (0..8).map(corner).collect();
    for _ in 0..random.pick(9) {
        corners.push(Point::from(random.vector::<N>().component_mul(&half) * N::lit(1.3)));
    }
    (Box::new(ConvexHull::from_points(&corners)), height)
}

/// Moves one solid and asserts, at each step, that the contacts do not depend on whether
/// `update_quickly` is tried before the generic path, and that queries return the deepest contact.
/// Returns the number of updates by the specialised path, and the number of contact points.
fn follow<N: Space<3>>(
    (solid, height): Solid<N>,
    random: &mut Random,
    round: usize,
) -> (usize, usize) {
    let terrain = ground_of::<N>(random, round);
    let far = N::lit([0.0, 40.0][random.pick(2)]);
    let under = Pose { translation: Vector::<N, 3>::repeat(far), ..random.turn::<N>() };
    let mut position = random.vector::<N>() * N::lit(1.8);
    position.y =
        height * N::lit([1.0, 0.9, -1.0][random.pick(3)]) + random.vector::<N>().y * N::lit(0.2);
    if random.pick(4) == 0 {
        // Moves the solid over a vertex or an edge of the grid.
        position.x = N::HALF;
    }
    let mut tilt = [Pose::identity(), random.turn::<N>()][random.pick(2)];
    let request = ManifoldRequest::new(
        N::lit([0.002, 0.3][random.pick(2)]),
        N::lit([0.0, 0.2][random.pick(2)]),
        [4, 4, 1][random.pick(3)],
    );
    let (mut quick, mut slow) = (CompositeContacts::default(), CompositeContacts::default());
    let (mut done, mut points) = (0, 0);
    for step in 0..STEPS {
        let pose = under.compose(&Pose { translation: position, ..tilt });
        let placed1 = Placed::of_pose(&pose, solid.geometry());
        let placed2 = Placed::of_pose(&under, terrain.geometry());
        let between = Between::of_ordered(&Ordered::new(&placed1, &placed2));
        let is_done = quick.update_quickly(&between, &request);
        if !is_done {
            quick.update_in_general(&between, false, &request);
        }
        slow.update_in_general(&between, false, &request);
        let what = || format!("{solid:?} on {terrain:?} at {pose:?}, step {step}");
        assert_same(&quick, &slow, what);
        assert_one_contact([&placed1, &placed2], request.prediction, what);
        (done, points) = (done + usize::from(is_done), points + quick.len());
        position += random.vector::<N>() * N::lit(0.04);
        if random.pick(8) == 0 {
            tilt = random.turn::<N>();
        }
    }
    (done, points)
}

fn compare<N: Space<3>>(seed: u64, solid_of: impl Fn(&mut Random) -> Solid<N>, has_own_path: bool) {
    let random = &mut Random(seed);
    let (rounds, mut done, mut points) = (samples(40), 0, 0);
    for round in 0..rounds {
        let (of_one, found) = follow::<N>(solid_of(random), random, round);
        (done, points) = (done + of_one, points + found);
    }
    assert!(!has_own_path || done * 2 > rounds * STEPS, "{done} updates by the quick path");
    assert!(points > rounds * STEPS / 2, "{points} points");
}

#[test]
fn balls_have_the_contacts_of_the_generic_path() {
    compare::<f32>(11, ball_of, true);
    compare::<f64>(12, ball_of, true);
}

#[test]
fn boxes_and_hulls_have_the_contact_of_a_query() {
    compare::<f32>(13, flat_of, false);
    compare::<f64>(14, flat_of, false);
}
