//! Found by fuzzing: an angular prediction must never suppress a contact within the linear
//! prediction. Where `contact` finds a contact of a solid and a surface, a world must find one with
//! any angular prediction.

use impinge::math::na::{Quaternion, Translation3, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Unit, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::contact;
use impinge::shape::{Ball, Capsule, ConvexHull, Cuboid, Cylinder, Segment, Shape, Triangle};
use impinge::shape::{Compound, Plane, Polyline, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_reference::random::Random;

use crate::support::samples::samples;

fn point<N: Real, const D: usize>(random: &mut Random, limit: u32) -> Point<N, D> {
    Point::from(Vector::<N, D>::from_fn(|_, _| N::lit(random.grid(limit, 3))))
}

/// Returns a mesh of a few triangles between six random corners; some triangles occur twice, with
/// opposite windings.
fn mesh<N: Space<3>>(random: &mut Random) -> ShapeHandle<N, 3> {
    let corners: Vec<Point<N, 3>> = (0..6).map(|_| point(random, 4)).collect();
    let mut triangles = Vec::new();
    for _ in 0..4 {
        let [a, b, c] = [(); 3].map(|()| u32::try_from(random.below(6)).expect("small"));
        if a != b && b != c && c != a {
            triangles.extend([[a, b, c], [c, b, a]].into_iter().take(1 + random.below(2)));
        }
    }
    triangles.push([0, 1, 2]);
    ShapeHandle::new(TriMesh::new(corners, triangles))
}

fn solid3<N: Space<3>>(random: &mut Random) -> ShapeHandle<N, 3> {
    let [a, b, c] = [(); 3].map(|()| point::<N, 3>(random, 2));
    let sizes = [(); 3].map(|()| N::lit(random.single(0.1, 2.0)));
    match random.below(7) {
        0 => ShapeHandle::new(Segment::new(a, b)),
        1 => ShapeHandle::new(Capsule::new(sizes[0], sizes[1] * N::HALF)),
        2 => ShapeHandle::new(Cuboid::new(Vector::from(sizes))),
        3 => ShapeHandle::new(Triangle::new(a, b, c)),
        4 => ShapeHandle::new(Ball::new(sizes[0])),
        5 => ShapeHandle::new(Cylinder::new(sizes[0], sizes[1])),
        _ => {
            let shift = Vector::<N, 3>::repeat(N::lit(0.3));
            ShapeHandle::new(ConvexHull::from_points(&[a, b, c, a + shift, Point::origin()]))
        }
    }
}

fn place3<N: Real>(random: &mut Random) -> Isometry3<N> {
    let [i, j, k, w] = random.quaternion().map(N::lit);
    let at = point::<N, 3>(random, 4).coords;
    let turn = UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k));
    Isometry3::from_parts(Translation3::from(at), turn)
}

fn line<N: Space<2>>(random: &mut Random) -> ShapeHandle<N, 2> {
    let ends: Vec<Point<N, 2>> = (0..6).map(|_| point(random, 4)).collect();
    ShapeHandle::new(Polyline::open(ends))
}

fn solid2<N: Space<2>>(random: &mut Random) -> ShapeHandle<N, 2> {
    let [a, b, c] = [(); 3].map(|()| point::<N, 2>(random, 2));
    let sizes = [(); 2].map(|()| N::lit(random.single(0.1, 2.0)));
    match random.below(5) {
        0 => ShapeHandle::new(Segment::new(a, b)),
        1 => ShapeHandle::new(Capsule::new(sizes[0], sizes[1] * N::HALF)),
        2 => ShapeHandle::new(Cuboid::new(Vector::from(sizes))),
        3 => ShapeHandle::new(Triangle::new(a, b, c)),
        _ => ShapeHandle::new(Ball::new(sizes[0])),
    }
}

fn place2<N: Real>(random: &mut Random) -> Isometry2<N> {
    Isometry2::new(point::<N, 2>(random, 4).coords, N::lit(random.range(-3.0, 3.0)))
}

/// A pose, and the shape that it places.
type Placed<N, const D: usize> = (<N as Space<D>>::Isometry, ShapeHandle<N, D>);

/// Returns the number of contact points of two shapes in a world; zero if they are no pair. Each
/// has half of `prediction` as its linear prediction, and `angle` as its angular prediction.
fn contacts_of<N: Space<D>, const D: usize>(
    pair: [&Placed<N, D>; 2],
    prediction: N,
    angle: f64,
) -> usize {
    let mut world = CollisionWorld::<N, D, ()>::new(N::lit(0.02));
    let query = GeometricQueryType::Contacts(prediction * N::HALF, N::lit(angle));
    let [a, b] = pair
        .map(|(pose, shape)| world.add(*pose, shape.clone(), CollisionGroups::new(), query, ()));
    world.update();
    world.contact_pair(a, b).map_or(0, |pair| pair.num_contacts())
}

/// Tests many pairs of a solid and a surface that are more than 0.01 apart, with predictions of
/// 1.02 and 0.98 times their distance. The larger prediction must give contacts and the smaller
/// none.
fn ask_all<N: Space<D>, const D: usize>(
    seed: u64,
    make: impl Fn(&mut Random) -> [Placed<N, D>; 2],
    distance: impl Fn(&Placed<N, D>, &Placed<N, D>) -> Option<N>,
) {
    let (rounds, mut random, mut count) = (samples(60), Random::new(seed), 0);
    for round in 0..rounds {
        let [solid, surface] = make(&mut random);
        let Some(distance) = distance(&solid, &surface).filter(|&d| d > N::lit(0.01)) else {
            continue;
        };
        count += 1;
        for angle in [0.0, 0.1, 1.0, 5.0] {
            for pair in [[&solid, &surface], [&surface, &solid]] {
                for (share, is_near) in [(1.02, true), (0.98, false)] {
                    let found = contacts_of(pair, distance * N::lit(share), angle);
                    let what = format!("{round}, {angle}, {distance}: {solid:?} {surface:?}");
                    assert_eq!(found > 0, is_near, "{found} contacts: {what}");
                }
            }
        }
    }
    assert!(count * 6 > rounds, "{count} of {rounds} pairs are apart");
}

fn in_space<N: Space<3, Isometry = Isometry3<N>>>(seed: u64) {
    let make =
        |random: &mut Random| [(place3(random), solid3(random)), (place3(random), mesh(random))];
    ask_all::<N, 3>(seed, make, |one, two| {
        let found = contact(&one.0, &*one.1 as &dyn Shape<N, 3>, &two.0, &*two.1, N::lit(20.0));
        found.map(|found| -found.depth)
    });
}

fn in_the_plane<N: Space<2, Isometry = Isometry2<N>>>(seed: u64) {
    let make =
        |random: &mut Random| [(place2(random), solid2(random)), (place2(random), line(random))];
    ask_all::<N, 2>(seed, make, |one, two| {
        let found = contact(&one.0, &*one.1 as &dyn Shape<N, 2>, &two.0, &*two.1, N::lit(20.0));
        found.map(|found| -found.depth)
    });
}

#[test]
fn what_is_near_has_a_contact_in_space() {
    in_space::<f32>(1);
    in_space::<f64>(2);
}

#[test]
fn what_is_near_has_a_contact_in_the_plane() {
    in_the_plane::<f32>(3);
    in_the_plane::<f64>(4);
}

/// Returns the number of contacts of a floor and a box that stands on an edge of its bottom, tilted
/// by `tilt`.
fn corners_of_tilted_box<N: Space<3, Isometry = Isometry3<N>>>(
    solid: &ShapeHandle<N, 3>,
    floor: &ShapeHandle<N, 3>,
    tilt: f64,
    angle: f64,
) -> usize {
    // The edge at the left end of the bottom lies on the floor.
    let (sine, cosine) = Real::sine_cosine(tilt);
    let at = [cosine - sine, cosine + sine, 0.0].map(N::lit);
    let pose = Isometry3::new(Vector::from(at), Vector::<N, 3>::z() * N::lit(tilt));
    let upon = (pose, solid.clone());
    let below = (Isometry3::identity(), floor.clone());
    let pairs = [[&upon, &below], [&below, &upon]];
    let [count, flipped] = pairs.map(|pair| contacts_of(pair, N::lit(1e-3), angle));
    assert_eq!(count, flipped, "whichever is first: {solid:?} {floor:?} {tilt} {angle}");
    count
}

/// Tests that corners beyond the prediction have contacts if a rotation by the angular prediction
/// brings them within it.
fn corners_that_turning_brings_near<N: Space<3, Isometry = Isometry3<N>>>() {
    let one = Vector::<N, 3>::repeat(N::ONE);
    let corner =
        |index: u32| {
            Point::from(Vector::<N, 3>::from_fn(|axis, _| {
                if index >> axis & 1 == 1 { N::ONE } else { -N::ONE }
            }))
        };
    let corners: Vec<_> = (0..8).map(corner).collect();
    let wide = Cuboid::new(Vector::<N, 3>::new(N::lit(8.0), N::ONE, N::lit(8.0)));
    let lowered = |index: usize| {
        let place = |axis: usize| corners[index][axis] * wide.half_extents()[axis];
        Point::<N, 3>::new(place(0), place(1) - N::ONE, place(2))
    };
    let slab: Vec<_> = (0..8).map(lowered).collect();
    let alone = |shape: &ShapeHandle<N, 3>| {
        ShapeHandle::new(Compound::new(vec![(Isometry3::identity(), shape.clone())]))
    };
    let [cube, hull] =
        [ShapeHandle::new(Cuboid::new(one)), ShapeHandle::new(ConvexHull::from_points(&corners))];
    let solids = [alone(&cube), cube, hull];
    let slab = ShapeHandle::new(ConvexHull::from_points(&slab));
    let plane = ShapeHandle::new(Plane::new(Unit::new_unchecked(Vector::<N, 3>::y())));
    let floors = [alone(&slab), slab, plane];
    for (solid, floor) in solids.iter().flat_map(|solid| floors.iter().map(move |f| (solid, f))) {
        for tilt in [0.01, 0.1, 0.25] {
            let counts = [0.0, tilt / 8.0, tilt]
                .map(|angle| corners_of_tilted_box(solid, floor, tilt, angle));
            assert_eq!(counts, [2, 2, 4], "{solid:?} on {floor:?}, tilted by {tilt}");
        }
    }
}

#[test]
fn corners_that_turning_brings_near_are_contacts() {
    corners_that_turning_brings_near::<f32>();
    corners_that_turning_brings_near::<f64>();
}

/// Pairs of a box on a wider box, which the library computes in batches. The pairs of a batch have
/// different angular predictions.
#[test]
fn corners_of_boxes_in_batches() {
    type V = Vector<f64, 3>;
    let mut world = CollisionWorld::<f64, 3, ()>::new(0.02);
    let shapes = [V::new(1.0, 1.0, 1.0), V::new(4.0, 1.0, 4.0)].map(Cuboid::new);
    let mut expected = Vec::new();
    for index in 0..43_u32 {
        let (tilt, angle) = (0.05_f64, [0.0, 0.2, 0.004][index as usize % 3]);
        let (sine, cosine) = Real::sine_cosine(tilt);
        let away = V::new(0.0, 0.0, 20.0 * f64::from(index));
        let at = away + V::new(cosine - sine, cosine + sine + 1.0, 0.0);
        let pose = Isometry3::new(at, V::z() * tilt);
        let query = GeometricQueryType::Contacts(5e-4, angle);
        let groups = CollisionGroups::new();
        let upon = world.add(pose, ShapeHandle::new(shapes[0]), groups, query, ());
        let floor = Isometry3::new(away, V::zeros());
        let below = world.add(floor, ShapeHandle::new(shapes[1]), groups, query, ());
        expected.push((upon, below, if angle > tilt { 4 } else { 2 }));
    }
    world.update();
    for (upon, below, count) in expected {
        let found = world.contact_pair(upon, below).map_or(0, |pair| pair.num_contacts());
        assert_eq!(found, count, "{upon:?}");
    }
}

/// Asserts that all legs of a table have a contact at distance 0, although the corners of its top
/// span more and are within the angular prediction, too.
fn tables_stand_on_their_legs<N: Space<3, Isometry = Isometry3<N>>>() {
    let at = |x: f64, y: f64, z: f64| {
        Isometry3::new(Vector::from([x, y, z].map(N::lit)), Vector::zeros())
    };
    let block = |half: [f64; 3]| ShapeHandle::new(Cuboid::new(Vector::from(half.map(N::lit))));
    let feet = [(-0.8, -0.8), (-0.8, 0.8), (0.8, -0.8), (0.8, 0.8)];
    let mut parts = vec![(at(0.0, 0.15, 0.0), block([0.9, 0.05, 0.9]))];
    parts.extend(feet.map(|(x, z)| (at(x, 0.05, z), block([0.05; 3]))));
    let table = ShapeHandle::new(Compound::new(parts));
    let corners = [[-8.0, -8.0], [-8.0, 8.0], [8.0, -8.0], [8.0, 8.0]];
    let corners = corners.map(|[x, z]| Point::<N, 3>::new(N::lit(x), N::ZERO, N::lit(z)));
    let floors = [
        (0.0, ShapeHandle::new(Plane::new(Unit::new_unchecked(Vector::<N, 3>::y())))),
        (0.0, ShapeHandle::new(TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [1, 3, 2]]))),
        (-1.0, block([8.0, 1.0, 8.0])),
    ];
    for (height, floor) in floors {
        let mut world = CollisionWorld::<N, 3, ()>::new(N::lit(0.02));
        let query = GeometricQueryType::Contacts(N::lit(0.01), N::lit(0.09));
        let groups = CollisionGroups::new();
        world.add(at(0.0, height, 0.0), floor.clone(), groups, query, ());
        world.add(at(0.0, 0.0, 0.0), table.clone(), groups, query, ());
        world.update();
        let mut touched = [false; 4];
        for (_, _, view) in world.contact_views() {
            for contact in view.contacts().map(|point| point.contact) {
                let own = feet.map(|(x, z)| {
                    let near = |at: N, foot: f64| (at - N::lit(foot)).abs() <= N::lit(0.06);
                    near(contact.world1.x, x) && near(contact.world1.z, z)
                });
                let is_touching = contact.depth.abs() < N::lit(1e-4);
                touched
                    .iter_mut()
                    .zip(own)
                    .for_each(|(foot, is_own)| *foot |= is_own && is_touching);
            }
        }
        assert_eq!(touched, [true; 4], "on {floor:?}");
    }
}

#[test]
fn tables_on_floors_stand_on_their_legs() {
    tables_stand_on_their_legs::<f32>();
    tables_stand_on_their_legs::<f64>();
}
