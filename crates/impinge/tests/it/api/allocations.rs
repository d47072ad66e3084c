//! Tests that a step without new pairs or objects allocates no memory, once all buffers have grown
//! to their final size.

use impinge::dim2::shape::ConvexPolygon;
use impinge::math::na::{Translation2, Translation3, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, DefaultNarrowPhase, GeometricQueryType};
use impinge::shape::{
    Ball, Capsule, ConvexHull, Cuboid, Cylinder, HeightField, Polyline, ShapeHandle, TriMesh,
};
use impinge::world::{CollisionGroups, CollisionWorld};

/// Number of steps after which all poses repeat.
const PERIOD: u32 = 16;
/// Number of objects along each axis.
const ROW: usize = 6;

/// The parts of the scene that differ by dimension: poses and shapes.
trait Stage<const D: usize>: Space<D> {
    fn place(at: Vector<Self, D>, turn: f64) -> Self::Isometry;
    fn own_shapes() -> Vec<ShapeHandle<Self, D>>;
}

impl<N: Real> Stage<2> for N {
    fn place(at: Vector<N, 2>, turn: f64) -> Isometry2<N> {
        Isometry2::from_parts(Translation2::from(at), UnitComplex::new(N::lit(turn)))
    }

    fn own_shapes() -> Vec<ShapeHandle<N, 2>> {
        let corners = [[0.5, 0.0], [0.0, 0.5], [-0.5, 0.1], [-0.2, -0.5]];
        let corners = corners.map(|[x, y]| Point::<N, 2>::new(N::lit(x), N::lit(y)));
        vec![ShapeHandle::new(ConvexPolygon::from_points(&corners))]
    }
}

impl<N: Real> Stage<3> for N {
    fn place(at: Vector<N, 3>, turn: f64) -> Isometry3<N> {
        let axis = Vector::<N, 3>::new(N::lit(turn), N::lit(turn * 0.5), N::lit(turn * 0.25));
        let turn = UnitQuaternion::from_scaled_axis(axis);
        Isometry3::from_parts(Translation3::from(at), turn)
    }

    fn own_shapes() -> Vec<ShapeHandle<N, 3>> {
        let corners = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [-0.5, 0.1, 0.3], [-0.2, -0.5, 0.2]];
        let corners = corners
            .map(|corner: [f64; 3]| Point::<N, 3>::from(Vector::<N, 3>::from(corner.map(N::lit))));
        let hull = ShapeHandle::new(ConvexHull::from_points(&corners));
        vec![hull, ShapeHandle::new(Cylinder::new(N::lit(0.4), N::lit(0.3)))]
    }
}

fn shapes<N: Stage<D>, const D: usize>() -> Vec<ShapeHandle<N, D>> {
    let half = Vector::<N, D>::repeat(N::lit(0.45));
    let mut shapes = N::own_shapes();
    shapes.push(ShapeHandle::new(Ball::new(N::lit(0.5))));
    shapes.push(ShapeHandle::new(Cuboid::new(half)));
    shapes.push(ShapeHandle::new(Capsule::new(N::lit(0.3), N::lit(0.25))));
    shapes
}

/// Returns the pose of object `index` at `step`: on a grid of unit cells, swinging, so that
/// neighbours begin and cease to touch.
fn pose<N: Stage<D>, const D: usize>(index: usize, step: u32) -> N::Isometry {
    let phase = (step as usize + index * 5) % PERIOD as usize;
    let swing = (phase.min(PERIOD as usize - phase) as f64 - 4.0) * 0.06;
    let at = Vector::<N, D>::from_fn(|axis, _| {
        let place = index / ROW.pow(u32::try_from(axis).expect("0 to 2")) % ROW;
        N::lit(place as f64 + if (index + axis).is_multiple_of(2) { swing } else { -swing })
    });
    N::place(at, swing)
}

struct Grid<N: Stage<D>, const D: usize> {
    world: CollisionWorld<N, D, ()>,
    handles: Vec<CollisionObjectHandle>,
    step: u32,
}

impl<N: Stage<D>, const D: usize> Grid<N, D> {
    fn new(narrow_phase: DefaultNarrowPhase<N, D>) -> Self {
        let mut world = CollisionWorld::new(N::lit(0.02));
        world.set_narrow_phase(Box::new(narrow_phase));
        let shapes = shapes::<N, D>();
        let add = |index: usize| {
            let limit = N::lit(0.01);
            let query = match index % 5 {
                0 => GeometricQueryType::Proximity(limit),
                _ => GeometricQueryType::Contacts(limit, N::ZERO),
            };
            let shape = shapes[index % shapes.len()].clone();
            world.add(pose::<N, D>(index, 0), shape, CollisionGroups::new(), query, ())
        };
        let count = ROW.pow(u32::try_from(D).expect("2 or 3"));
        let handles = (0..count).map(add).collect();
        Self { world, handles, step: 0 }
    }

    /// Simulates one period. Returns the number of events, and the sum of the contact points of all
    /// steps.
    fn play(&mut self) -> (usize, usize) {
        let (mut events, mut contacts) = (0, 0);
        for _ in 0..PERIOD {
            self.step += 1;
            for (index, handle) in self.handles.iter().enumerate() {
                self.world.set_position(*handle, pose::<N, D>(index, self.step));
            }
            self.world.update();
            events += self.world.contact_events().len() + self.world.proximity_events().len();
            contacts += self.world.contact_views().map(|(_, _, view)| view.len()).sum::<usize>();
        }
        (events, contacts)
    }
}

fn takes_nothing<N: Stage<D>, const D: usize>(narrow_phase: DefaultNarrowPhase<N, D>) {
    let mut grid = Grid::<N, D>::new(narrow_phase);
    for _ in 0..4 {
        grid.play();
    }
    let mut found = (0, 0);
    let used = allocation_counter::measure(|| found = grid.play());
    assert!(found.0 > 100 && found.1 > 200, "a lively period: {found:?}");
    // `contact_views` returns a boxed iterator: one allocation for each step.
    assert_eq!(used.count_total, u64::from(PERIOD), "{used:?}");
}

#[test]
fn a_lively_step_takes_no_memory() {
    takes_nothing::<f32, 2>(DefaultNarrowPhase::new());
    takes_nothing::<f64, 2>(DefaultNarrowPhase::new());
    takes_nothing::<f32, 3>(DefaultNarrowPhase::new());
    takes_nothing::<f64, 3>(DefaultNarrowPhase::new());
}

#[test]
fn nor_where_contacts_are_kept() {
    takes_nothing::<f32, 2>(DefaultNarrowPhase::new().reusing(0.05));
    takes_nothing::<f64, 3>(DefaultNarrowPhase::new().reusing(0.05));
}

/// Asserts that updates allocate no memory while a solid slides to and fro over a surface with
/// hills.
fn slides_without_memory<const D: usize>(ground: ShapeHandle<f32, D>, solid: ShapeHandle<f32, D>)
where
    f32: Stage<D>,
{
    let mut world = CollisionWorld::<f32, D, ()>::new(0.02);
    let query = GeometricQueryType::Contacts(0.01, 0.0);
    let place = |step: u32| {
        let mut at = Vector::<f32, D>::zeros();
        at[0] = step.min(PERIOD - step) as f32 * 0.05;
        at[1] = 0.4;
        <f32 as Stage<D>>::place(at, 0.0)
    };
    let origin = <f32 as Stage<D>>::place(Vector::<f32, D>::zeros(), 0.0);
    world.add(origin, ground, CollisionGroups::new(), query, ());
    let handle = world.add(place(0), solid, CollisionGroups::new(), query, ());
    let mut slide = || {
        let mut contacts = 0;
        for step in 0..PERIOD {
            world.set_position(handle, place(step));
            world.update();
            contacts += world.contact_views().map(|(_, _, view)| view.len()).sum::<usize>();
        }
        contacts
    };
    // Within these 8 periods the surface comes to rest, and all buffers grow to their final size.
    for _ in 0..8 {
        slide();
    }
    let mut contacts = 0;
    let used = allocation_counter::measure(|| contacts = slide());
    assert!(contacts >= PERIOD as usize, "{contacts} contacts");
    // `contact_views` returns a boxed iterator: one allocation for each step.
    assert_eq!(used.count_total, u64::from(PERIOD), "{used:?}");
}

#[test]
fn sliding_over_composites_takes_no_memory() {
    let height = |n: usize| if n.is_multiple_of(2) { 0.0_f32 } else { 0.05 };
    let heights: Vec<f32> = (0..9).map(height).collect();
    let line = (0..9).map(|n| Point::<f32, 2>::new(n as f32 * 0.5 - 2.0, height(n))).collect();
    let polyline = ShapeHandle::new(Polyline::open(line));
    let field =
        ShapeHandle::new(HeightField::<f32, 2>::new(heights, Vector::<f32, 2>::new(4.0, 1.0)));
    let (ball, half) = (Ball::new(0.4), Vector::<f32, 2>::repeat(0.4));
    for ground in [polyline, field] {
        slides_without_memory(ground.clone(), ShapeHandle::new(ball));
        slides_without_memory(ground, ShapeHandle::new(Cuboid::new(half)));
    }
    let heights: Vec<f32> = (0..81).map(|n| height(n / 9 + n % 9)).collect();
    let at = |n: usize| [(n % 9) as f32 * 0.5 - 2.0, heights[n], (n / 9) as f32 * 0.5 - 2.0];
    let vertices = (0..81).map(|n| Point::<f32, 3>::from(Vector::<f32, 3>::from(at(n)))).collect();
    let cells = (0..64_u32).map(|cell| cell / 8 * 9 + cell % 8);
    let triangles = cells.flat_map(|n| [[n, n + 9, n + 10], [n, n + 10, n + 1]]).collect();
    let mesh = ShapeHandle::new(TriMesh::new(vertices, triangles));
    let extents = Vector::<f32, 3>::new(4.0, 1.0, 4.0);
    let field = ShapeHandle::new(HeightField::<f32, 3>::new(9, 9, heights, extents));
    slides_without_memory(mesh, ShapeHandle::new(ball));
    slides_without_memory(field, ShapeHandle::new(ball));
}
