//! Compares composites with a brute-force scan of their parts, against convex solids, half-spaces
//! and other composites. Both orders of the shapes must agree to the bit, in whatever order the
//! search proposes parts.

use crate::support::composite_support;
use crate::support::query_support;

use composite_support::scenes::{Maker, Scene};
use composite_support::{Piece, Pieces};
use impinge::math::{
    AbstractRotation, Isometry, Isometry2, Isometry3, Point, Pose, Real, Space, Unit, Vector,
};
use impinge::query::{
    ClosestPoints, Proximity, Witness, closest_points, contact, distance, proximity, witness,
};
use impinge::shape::{Ball, CompositeShape, Cuboid, FeatureId, Plane, Shape, Triangle};
use query_support::random::Random;
use query_support::samples::{PLANE, SPACE, sample2, sample3};

macro_rules! makers {
    ($n:ty) => {
        (
            Maker::<$n, _, 2> { kinds: &PLANE, sample: sample2, turn: Random::turn2 },
            Maker::<$n, _, 3> { kinds: &SPACE, sample: sample3, turn: Random::turn3 },
        )
    };
}

/// Two placed shapes.
struct Two<'a, N: Real, R, const D: usize> {
    m1: &'a Isometry<N, R, D>,
    g1: &'a dyn Shape<N, D>,
    m2: &'a Isometry<N, R, D>,
    g2: &'a dyn Shape<N, D>,
}

impl<N: Space<D>, R: AbstractRotation<N, D>, const D: usize> Two<'_, N, R, D> {
    fn witness(&self, limit: N) -> Option<Witness<N, D>> {
        witness(self.m1, self.g1, self.m2, self.g2, limit)
    }

    /// Asserts that all distance queries of the pair agree, and that swapping the shapes flips the
    /// witness; `noise` is the rounding error allowed in lengths.
    fn check(&self, noise: N) {
        let Self { m1, g1, m2, g2 } = *self;
        let found = self.witness(N::INFINITY).expect("they are some distance apart");
        let swapped = witness(m2, g2, m1, g1, N::INFINITY).expect("so they are swapped");
        assert_eq!(swapped.flipped(), found, "{g1:?} {g2:?}");
        let moved = found.point1 + found.normal.into_inner() * found.distance;
        assert!((moved - found.point2).norm() <= noise, "{found:?}");
        assert!((found.normal.norm() - N::ONE).abs() <= N::lit(16.0) * N::EPSILON, "{found:?}");

        let apart = if found.distance > N::ZERO { found.distance } else { N::ZERO };
        assert_eq!(distance(m1, g1, m2, g2), apart, "{found:?}");
        assert_eq!(distance(m2, g2, m1, g1), apart, "{found:?}");
        let expected = if found.distance > N::ZERO {
            ClosestPoints::WithinMargin(found.point1, found.point2)
        } else {
            ClosestPoints::Intersecting
        };
        assert_eq!(closest_points(m1, g1, m2, g2, N::INFINITY), expected, "{found:?}");
        let near = if apart > N::ZERO { Proximity::Disjoint } else { Proximity::Intersecting };
        assert_eq!(proximity(m1, g1, m2, g2, N::ZERO), near, "{found:?}");
        if apart > N::ZERO {
            assert_eq!(proximity(m2, g2, m1, g1, apart), Proximity::WithinMargin, "at its margin");
            assert_eq!(self.witness(apart), Some(found), "the limit changes nothing");
            assert_eq!(self.witness(apart * N::HALF), None, "and cuts off");
        }
    }
}

/// Asserts that the part with the witness's index `part1` has, without the other parts, the
/// witness's distance from the other shape.
fn check_parts<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    found: &Witness<N, D>,
    two: (&Scene<N, R, D>, &Isometry<N, R, D>),
    other: (&dyn Shape<N, D>, &Isometry<N, R, D>),
    noise: N,
) {
    let (scene, m1) = two;
    let (place, (_, piece)) =
        (&scene.places[found.part1 as usize], &scene.fast.parts[found.part1 as usize]);
    let alone = witness(&(m1 * place), piece.as_shape(), other.1, other.0, N::INFINITY);
    let alone = alone.expect("some distance apart");
    assert!((alone.distance - found.distance).abs() <= noise, "{found:?} {alone:?}");
}

fn against_convex<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
    seed: u64,
    scale: N,
) -> bool {
    let random = &mut Random(seed, seed.is_multiple_of(5));
    let scene = maker.scene(random, 1 + usize::try_from(seed % 23).expect("few"), scale);
    let solid = maker.solid(random, scale * N::lit([1.0, 0.01, 5.0][(seed % 3) as usize]));
    let m1 = maker.place(random, scale * N::lit(4.0));
    let m2 = maker.place(random, scale * N::lit(4.0));
    let noise = scale * (N::EPSILON * N::lit(4096.0) + N::lit(1e-9));

    let two = Two { m1: &m1, g1: &scene.fast, m2: &m2, g2: &*solid };
    two.check(noise);
    let found = two.witness(N::INFINITY).expect("a witness");
    let slow = witness(&m1, &scene.slow, &m2, &*solid, N::INFINITY).expect("a witness");
    assert_eq!(found, slow, "whatever the search proposes");
    let brute = scene.brute(&m1, &m2, &*solid);
    assert!((brute - found.distance).abs() <= noise, "{seed} {brute:?} {found:?}");
    check_parts(&found, (&scene, &m1), (&*solid, &m2), noise);
    let touch = contact(&m1, &scene.fast, &m2, &*solid, N::INFINITY).expect("a contact");
    if found.distance > N::ZERO {
        assert_eq!((-touch.depth, touch.normal), (found.distance, found.normal), "one fact");
    }
    found.distance <= N::ZERO
}

#[test]
fn against_convex_solids() {
    let mut overlaps = 0;
    let (plane, space) = makers!(f32);
    let (plane64, space64) = makers!(f64);
    for seed in 0..150 {
        overlaps += u32::from(against_convex(&plane, seed, 1.0));
        overlaps += u32::from(against_convex(&space, seed, 1.0));
        overlaps += u32::from(against_convex(&plane64, seed, 1.0));
        overlaps += u32::from(against_convex(&space64, seed, 1.0));
    }
    assert!((100..500).contains(&overlaps), "{overlaps} of 600 overlap");
}

#[test]
fn tiny_and_huge() {
    let (plane, space) = makers!(f32);
    let (plane64, space64) = makers!(f64);
    for seed in 0..30 {
        for scale in [1e-6, 1e6] {
            against_convex(&plane, seed, scale);
            against_convex(&space, seed, scale);
        }
        for scale in [1e-30, 1e30] {
            against_convex(&plane64, seed, scale);
            against_convex(&space64, seed, scale);
        }
    }
}

fn against_composites<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
    seed: u64,
) -> bool {
    let random = &mut Random(seed, false);
    let count = |bits: u64| 1 + usize::try_from(bits % 11).expect("few");
    let scene1 = maker.scene(random, count(seed), N::ONE);
    let scene2 = maker.scene(random, count(seed / 3 + 4), N::ONE);
    let (m1, m2) = (maker.place(random, N::lit(4.0)), maker.place(random, N::lit(4.0)));
    let noise = N::EPSILON * N::lit(8192.0) + N::lit(1e-9);
    let two = Two { m1: &m1, g1: &scene1.fast, m2: &m2, g2: &scene2.fast };
    two.check(noise);
    let found = two.witness(N::INFINITY).expect("a witness");
    let slow = witness(&m1, &scene1.slow, &m2, &scene2.slow, N::INFINITY).expect("a witness");
    assert_eq!(found, slow, "whatever the search proposes");
    let mut brute = N::INFINITY;
    for (place, (_, piece)) in scene2.places.iter().zip(&scene2.fast.parts) {
        let one = scene1.brute(&m1, &(&m2 * place), piece.as_shape());
        brute = if one < brute { one } else { brute };
    }
    assert!((brute - found.distance).abs() <= noise, "{seed} {brute:?} {found:?}");
    found.distance <= N::ZERO
}

#[test]
fn against_each_other() {
    let mut overlaps = 0;
    let (plane, space) = makers!(f32);
    let (plane64, space64) = makers!(f64);
    for seed in 0..80 {
        overlaps += u32::from(against_composites(&plane, seed));
        overlaps += u32::from(against_composites(&space, seed));
        overlaps += u32::from(against_composites(&plane64, seed));
        overlaps += u32::from(against_composites(&space64, seed));
    }
    assert!((60..260).contains(&overlaps), "{overlaps} of 320 overlap");
}

/// Compares composites with half-spaces: the distance is the least signed distance of all parts.
fn against_planes<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
) {
    for seed in 0..40 {
        let random = &mut Random(seed, false);
        let scene = maker.scene(random, 9, N::ONE);
        let plane = Plane::<N, D>::new(Unit::new_unchecked(random.direction::<N, D>()));
        let (m1, m2) = (maker.place(random, N::lit(5.0)), maker.place(random, N::lit(5.0)));
        let noise = N::EPSILON * N::lit(1024.0);
        let two = Two { m1: &m1, g1: &scene.fast, m2: &m2, g2: &plane };
        two.check(noise);
        let found = two.witness(N::INFINITY).expect("a witness");
        let brute = scene.brute(&m1, &m2, &plane);
        assert!((brute - found.distance).abs() <= noise, "{seed} {brute:?} {found:?}");
    }
}

#[test]
fn against_half_spaces() {
    let (plane, space) = makers!(f32);
    against_planes(&plane);
    against_planes(&space);
    let (plane, space) = makers!(f64);
    against_planes(&plane);
    against_planes(&space);
}

/// Tests that a composite of one part, whose pose in the composite is the identity, has the
/// distance of that part up to rounding.
fn wrapped<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(maker: &Maker<N, R, D>) {
    for seed in 0..60 {
        let random = &mut Random(seed, false);
        let (solid, other) = (maker.solid(random, N::ONE), maker.solid(random, N::ONE));
        let one = Pieces::wrapped(Pose::identity(), Piece::Shape(solid.clone()));
        let m1 = Isometry::from_parts(random.vector::<N, D>().into(), R::identity());
        let m2 = maker.place(random, N::lit(3.0));
        let bare = witness(&m1, &*solid, &m2, &*other, N::INFINITY).expect("a witness");
        let found = witness(&m1, &one, &m2, &*other, N::INFINITY).expect("a witness");
        // The order of operations may differ, so results agree only up to rounding.
        let noise = N::EPSILON * N::lit(1024.0) + N::lit(1e-9);
        assert!((bare.distance - found.distance).abs() <= noise, "{bare:?} {found:?}");
        assert_eq!((found.part1, found.part2), (0, 0), "the only part");
    }
}

#[test]
fn one_part_is_that_part() {
    let (plane, space) = makers!(f32);
    wrapped(&plane);
    wrapped(&space);
    let (plane, space) = makers!(f64);
    wrapped(&plane);
    wrapped(&space);
}

#[test]
fn equal_distances_go_to_the_first_part() {
    // Four squares of half extent 1 around the origin, equally near to a ball in their middle.
    let at = |x: f64, y: f64| Pose::from_translation(Vector::<f64, 2>::new(x, y));
    let square = || Piece::of(Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0)));
    let around = [at(3.0, 0.0), at(0.0, 3.0), at(-3.0, 0.0), at(0.0, -3.0)];
    let ring = Pieces::new(around.iter().map(|pose| (*pose, square())).collect());
    let (ball, here) = (Ball::new(0.5), Isometry2::identity());
    let found = witness(&here, &ball, &here, &ring, 9.0).expect("near");
    assert_eq!((found.part2, found.distance), (0, 1.5), "the first of four");
    let found = witness(&here, &ring, &here, &ball, 9.0).expect("near");
    assert_eq!((found.part1, found.normal.x), (0, -1.0), "in both orders");
    let found = witness(&here, &ring, &here, &ring, 9.0).expect("near");
    assert_eq!((found.part1, found.part2, found.distance), (0, 0, -2.0), "each in itself");
}

#[test]
fn features_are_those_of_the_part() {
    let p = Point::<f64, 3>::new;
    let points = [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(4.0, 0.0, 4.0), p(0.0, 0.0, 4.0)];
    let mesh = Pieces::mesh(&points, &[[0, 2, 1], [0, 3, 2]]);
    let here = Isometry3::identity();
    let ball = Ball::new(1.0);
    let at = |x, y, z| {
        let place = Isometry3::translation(x, y, z);
        witness(&here, &mesh, &place, &ball, 9.0).expect("near")
    };
    let face = at(3.0, 2.0, 1.0);
    assert_eq!((face.part1, face.feature1), (0, FeatureId::Face(0)), "above the first triangle");
    assert_eq!((face.point1, face.distance), (p(3.0, 0.0, 1.0), 1.0), "one above");
    let edge = at(-3.0, 4.0, 1.0);
    assert_eq!((edge.part1, edge.feature1), (1, FeatureId::Edge(0)), "the side from 0 to 3");
    let corner = at(7.0, 0.0, -4.0);
    assert_eq!((corner.part1, corner.feature1), (0, FeatureId::Vertex(2)), "the second point");
    assert_eq!((corner.feature2, corner.part2), (FeatureId::Face(0), 0), "of the ball");
}

#[test]
fn no_parts_are_nowhere() {
    let (none, ball) = (Pieces::<f32, 3>::new(Vec::new()), Ball::new(1.0_f32));
    let here = Isometry3::identity();
    assert_eq!(none.num_parts(), 0, "no parts");
    assert_eq!(distance(&here, &none, &here, &ball), f32::INFINITY, "infinitely far");
    assert_eq!(witness(&here, &ball, &here, &none, f32::INFINITY), None, "no witness");
    assert_eq!(witness(&here, &none, &here, &none, f32::INFINITY), None, "nor of two");
    assert_eq!(proximity(&here, &none, &here, &ball, 1e30), Proximity::Disjoint, "never near");
    assert_eq!(contact(&here, &none, &here, &ball, 1e30), None, "no contact");
}

#[test]
fn what_is_not_finite_is_far() {
    let one = Pieces::wrapped(Pose::identity(), Piece::of(Ball::new(1.0_f32)));
    let here = Isometry3::identity();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let there = Isometry3::translation(bad, 0.0, 0.0);
        assert_eq!(distance(&here, &one, &there, &one), f32::INFINITY, "{bad}");
        assert_eq!(witness(&there, &one, &here, &Ball::new(1.0), 1.0), None, "{bad}");
    }
    assert_eq!(witness(&here, &one, &here, &one, f32::NAN), None, "no limit");
}

/// Returns the witness of a ball above a mesh of two triangles, which lie `far` from the origin of
/// the mesh.
fn over_far_floor(far: f32, world: f32) -> Witness<f32, 3> {
    let p = |x: f32, z: f32| Point::<f32, 3>::new(far + x, -far, far + z);
    let points = [p(0.0, 0.0), p(4.0, 0.0), p(4.0, 4.0), p(0.0, 4.0)];
    let mesh = Pieces::mesh(&points, &[[0, 2, 1], [0, 3, 2]]);
    // The offsets are powers of two, so that the positions themselves are exact.
    let m1 = Isometry3::translation(world, world, world);
    let m2 = Isometry3::translation(world + far + 1.0, world - far + 1.0, world + far + 2.0);
    witness(&m1, &mesh, &m2, &Ball::new(0.7), 9.0).expect("near")
}

#[test]
fn far_from_either_origin_is_as_exact() {
    let near = over_far_floor(0.0, 0.0);
    assert!((near.distance - 0.3).abs() < 1e-6, "{near:?}");
    for far in [0.0, 1024.0, 131_072.0] {
        for world in [0.0, 1024.0, 1_048_576.0] {
            let found = over_far_floor(far, world);
            assert_eq!(found.distance, near.distance, "{far} {world}");
            assert_eq!(found.normal, near.normal, "{far} {world}");
            assert_eq!((found.part1, found.feature1), (near.part1, near.feature1), "{far} {world}");
        }
    }
}

#[test]
fn far_meshes_against_each_other() {
    let mesh = |far: f32, y: f32| {
        let p = |x: f32, z: f32| Point::<f32, 3>::new(far + x, y, far + z);
        let points = [p(0.0, 0.0), p(4.0, 0.0), p(4.0, 4.0), p(0.0, 4.0)];
        Pieces::mesh(&points, &[[0, 2, 1], [0, 3, 2]])
    };
    let here = Isometry3::identity();
    for far in [0.0, 1024.0, 131_072.0] {
        let (low, high) = (mesh(far, 0.25), mesh(far, 0.375));
        let found = witness(&here, &low, &here, &high, 9.0).expect("near");
        assert_eq!((found.distance, found.normal.y), (0.125, 1.0), "{far}");
        let tiny = Triangle::new(
            Point::<f32, 3>::new(far + 1.0, 0.5, far + 1.0),
            Point::<f32, 3>::new(far + 2.0, 0.5, far + 1.0),
            Point::<f32, 3>::new(far + 1.0, 0.5, far + 2.0),
        );
        let one = Pieces::wrapped(Pose::identity(), Piece::Triangle(tiny));
        let found = witness(&here, &one, &here, &low, 9.0).expect("near");
        assert_eq!((found.distance, found.normal.y), (0.25, -1.0), "{far}");
    }
}
