//! Compares the contacts of a world, which updates many pairs in one batch, with the contacts of a
//! generator for each single pair. They are equal to the bit in every step, even when both reuse
//! contacts. The pairs are of hulls, boxes and meshes.
//!
//! Each generator computes its pair in the same steps as the world, but knows only the poses and
//! the shapes.

use impinge::math::na::{Translation3, UnitQuaternion};
use impinge::math::{Isometry3, Point, Real, Space, Vector};
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher,
    DefaultNarrowPhase, GeometricQueryType, IdAllocator, PairManifoldGenerator,
};
use impinge::query::ContactManifold;
use impinge::shape::{Capsule, ConvexHull, Cuboid, Cylinder, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};

/// Random numbers from -1 to 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let bits = u32::try_from(self.0 >> 33).expect("31 bits are left");
        f64::from(bits) / f64::from(1_u32 << 30) - 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        [self.next(), self.next(), self.next()]
    }
}

/// Pose of a solid in `f64`. Its position is scaled and both are rounded for the world and the
/// generator.
#[derive(Clone, Copy)]
struct Place {
    at: [f64; 3],
    turn: UnitQuaternion<f64>,
}

impl Place {
    fn moved(&self, noise: &mut Noise, size: f64) -> Self {
        let [at, turn] = [noise.vector(), noise.vector()];
        let turn = UnitQuaternion::from_scaled_axis(Vector::<f64, 3>::from(turn) * size);
        Self {
            at: std::array::from_fn(|axis| self.at[axis] + at[axis] * size),
            turn: turn * self.turn,
        }
    }

    fn isometry<N: Real>(&self, scale: f64) -> Isometry3<N> {
        let at = Vector::<N, 3>::from(self.at.map(|x| N::lit(x * scale)));
        let turn = self.turn.into_inner().coords.map(N::lit);
        let turn = UnitQuaternion::new_normalize(turn.into());
        Isometry3::from_parts(Translation3::from(at), turn)
    }
}

/// Returns a patch of uneven triangles, about as large as the other shapes.
fn mesh<N: Space<3>>(noise: &mut Noise, scale: f64) -> ShapeHandle<N, 3> {
    let mut vertex = |n: u32| {
        let [x, z] = [n % 4, n / 4].map(|k| f64::from(k) * 0.6 - 0.9);
        Point::from([x, 0.5 + 0.05 * noise.next(), z].map(|x| N::lit(x * scale)))
    };
    let vertices = (0..16).map(&mut vertex).collect();
    let cell = |n: u32| [[n, n + 4, n + 5], [n, n + 5, n + 1]];
    let cells = (0..12).filter(|n| n % 4 < 3);
    ShapeHandle::new(TriMesh::new(vertices, cells.flat_map(cell).collect()))
}

fn shape<N: Space<3>>(noise: &mut Noise, kind: usize, scale: f64) -> ShapeHandle<N, 3> {
    let scaled = |v: [f64; 3]| Vector::<N, 3>::from(v.map(|x| N::lit(x * scale)));
    let point = |noise: &mut Noise| {
        let v = noise.vector();
        // Points on a sphere, or on a grid, which makes faces flush.
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let v = if kind == 1 { v.map(|x| x / length) } else { v.map(|x| (x * 1.6).round()) };
        Point::from(scaled(v.map(|x| x * 0.6)))
    };
    let length = |x: f64| N::lit(x * scale);
    match kind {
        3 => return mesh(noise, scale),
        4 => return ShapeHandle::new(Cylinder::new(length(0.5), length(0.4))),
        5 => return ShapeHandle::new(Capsule::<N, 3>::new(length(0.3), length(0.3))),
        _ => {}
    }
    if kind > 0 {
        let points: Vec<_> = (0..14).map(|_| point(noise)).collect();
        if let Ok(hull) = ConvexHull::try_from_points(&points) {
            return ShapeHandle::new(hull);
        }
    }
    ShapeHandle::new(Cuboid::new(scaled([0.5, 0.4, 0.6])))
}

/// Returns the contacts and kinematics of manifolds as text, without the ids.
fn facts<N: Real>(manifolds: &[&ContactManifold<N, 3>]) -> Vec<String> {
    let contacts = manifolds.iter().flat_map(|manifold| manifold.contacts());
    contacts.map(|tracked| format!("{:?} {:?}", tracked.contact, tracked.kinematic)).collect()
}

/// Returns the text of the contacts of a pair in a world.
fn said_of<N: Space<3>>(
    world: &CollisionWorld<N, 3, ()>,
    [one, other]: [CollisionObjectHandle; 2],
) -> Vec<String> {
    let all = world.contact_manifolds();
    let own =
        all.filter(|(object1, object2, _)| (object1.handle(), object2.handle()) == (one, other));
    facts(&own.map(|(_, _, manifold)| manifold).collect::<Vec<_>>())
}

/// A pair in the world, and its separate generator.
struct Twins<N: Space<3>> {
    places: [Place; 2],
    shapes: [ShapeHandle<N, 3>; 2],
    handles: [CollisionObjectHandle; 2],
    twin: PairManifoldGenerator<N, 3>,
}

/// Returns the size of a step: mostly small. Every sixteenth step is a jump, and some steps do not
/// move.
fn size(noise: &mut Noise, step: usize) -> f64 {
    const SIZES: [f64; 8] = [1e-3, 3e-4, 1e-3, 0.0, 1e-5, 2e-3, 1e-3, 1e-7];
    let is_jump = step % 16 == 15;
    if is_jump { noise.next() * 0.2 } else { SIZES[step % 8] * noise.next().abs() }
}

/// Makes an empty world reuse contacts within a tolerance, if that is positive; returns a generator
/// for its pairs.
fn keeping<N: Space<3>>(
    world: &mut CollisionWorld<N, 3, ()>,
    tolerance: N,
) -> PairManifoldGenerator<N, 3> {
    let generator = PairManifoldGenerator::default();
    if tolerance <= N::ZERO {
        return generator;
    }
    world.set_narrow_phase(Box::new(DefaultNarrowPhase::new().reusing(tolerance)));
    generator.reusing(tolerance)
}

/// Compares the contacts of a world with those of the generators for some steps, reusing contacts
/// within the tolerance if that is positive; returns how many manifolds were compared.
fn follow<N: Space<3, Isometry = Isometry3<N>>>(
    seed: u64,
    [scale, tolerance]: [f64; 2],
    far: f64,
) -> usize {
    let noise = &mut Noise(seed);
    let margin = N::lit(0.0625 * scale);
    let mut world = CollisionWorld::<N, 3, ()>::new(margin);
    let generator = keeping(&mut world, N::lit(tolerance * scale));
    let query = GeometricQueryType::Contacts(margin, N::ZERO);
    let mut pairs = Vec::new();
    for index in 0..48_usize {
        let kinds = [[index % 3, index / 2 % 3], [3, index / 6], [4, index % 6], [5, 5]];
        let shapes = kinds[index / 12].map(|kind| shape(noise, kind, scale));
        let corner = [far + 8.0 * f64::from(u32::try_from(index).expect("few")), 0.0, 0.0];
        let here = Place { at: corner, turn: UnitQuaternion::identity() };
        let there = here.moved(noise, [0.0, 1.0][index % 2]);
        // Above as if resting there, or to either side, so that the order of the two may change on
        // the path.
        let away = [[0.0, 0.95, 0.0], [0.05, 1.0, 0.2], [0.7, 0.6, 0.1], [-0.001, 0.9, 0.3]];
        let at = std::array::from_fn(|axis| corner[axis] + away[index % 4][axis]);
        let places = [here, Place { at, ..there }];
        let add = |which: usize| {
            let place = places[which].isometry(scale);
            world.add(place, shapes[which].clone(), CollisionGroups::new(), query, ())
        };
        let handles = [0, 1].map(add);
        pairs.push(Twins { places, shapes, handles, twin: generator.clone() });
    }
    let (mut compared, mut ids) = (0, IdAllocator::new());
    let (dispatcher, linear) = (DefaultContactDispatcher::new(), margin + margin);
    let prediction = ContactPrediction::new(linear, N::ZERO, N::ZERO);
    for step in 0..80 {
        world.update();
        let said: Vec<_> = pairs.iter().map(|twins| said_of(&world, twins.handles)).collect();
        for (index, twins) in pairs.iter_mut().enumerate() {
            let [one, other] = twins.places.map(|place| place.isometry::<N>(scale));
            let [shape1, shape2] = &twins.shapes;
            let twin = &mut twins.twin;
            twin.update(
                &dispatcher,
                &one,
                shape1.as_ref(),
                &other,
                shape2.as_ref(),
                &prediction,
                &mut ids,
            );
            let mut expected = Vec::new();
            twin.contacts(&mut expected);
            assert_eq!(said[index], facts(&expected), "pair {index} in step {step}");
            compared += usize::from(!expected.is_empty());
            // Sometimes replaces a shape, but not by an equal shape: the world would then compute
            // the pair anew, unlike the generator.
            let is_equal = index / 6 % 3 == 0 && tolerance > 0.0;
            if step % 40 == 20 && index % 6 == 0 && !is_equal {
                twins.shapes[1] = shape(noise, index / 6 % 3, scale);
                world.set_shape(twins.handles[1], twins.shapes[1].clone());
            }
            let size = size(noise, step);
            let which = (index + step) % 2;
            twins.places[which] = twins.places[which].moved(noise, size);
            world.set_position(twins.handles[which], twins.places[which].isometry(scale));
        }
    }
    compared
}

#[test]
fn a_world_has_the_contacts_of_generators() {
    let compared = [
        follow::<f32>(1, [1.0, 0.0], 0.0),
        follow::<f64>(2, [1.0, 0.0], 0.0),
        follow::<f32>(3, [1e-3, 0.0], 0.0),
        follow::<f64>(4, [1e4, 0.0], 0.0),
        follow::<f32>(5, [1.0, 0.0], 1000.0),
        follow::<f32>(6, [1.0, 0.005], 0.0),
        follow::<f64>(7, [1.0, 0.005], 0.0),
    ];
    assert!(compared.iter().all(|&compared| compared > 1000), "{compared:?} manifolds");
}
