//! Compares the manifolds of batches with those that a new generator computes for each pair.

use impinge::batch::{Control, ManifoldRows, OnePose, PairBatch, Shapes, Side};
use impinge::math::{AbstractRotation, Isometry, Isometry3, Pose, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, IdAllocator,
    PairManifoldGenerator,
};
use impinge::query::ContactManifold;
use impinge::shape::{Ball, Capsule, Cuboid, Segment, ShapeHandle};

use super::scene::{Scene, assert_number, assert_point, on_threads, scene2, scene3};
use crate::support::query_support::random::Random;

/// Asserts that the rows of pair `index` have the points of the expected manifolds; returns the
/// number of points.
fn check<N: Space<D>, const D: usize>(
    rows: &ManifoldRows<N, D>,
    index: usize,
    expected: &[&ContactManifold<N, D>],
) -> usize {
    let numbered = (0..).zip(expected);
    let points = numbered.flat_map(|(number, manifold)| {
        manifold.contacts().iter().map(move |tracked| (number, tracked))
    });
    let (points, what): (Vec<_>, _) = (points.collect(), format!("pair {index}"));
    let slots = rows.points_of(index);
    assert_eq!(slots.len(), points.len(), "{what}");
    for (slot, &(number, tracked)) in slots.zip(&points) {
        assert_eq!(rows.manifold[slot], number, "{what}");
        assert_point(&rows.point1[slot], Some(tracked.contact.world1), &what);
        assert_point(&rows.point2[slot], Some(tracked.contact.world2), &what);
        let normal = Vector::<N, D>::from(rows.normal[slot]);
        assert_eq!(normal, *tracked.contact.normal, "{what}");
        assert_number(rows.depth[slot], tracked.contact.depth, &what);
        let parts = (rows.part1[slot], rows.part2[slot]);
        assert_eq!(parts, (tracked.part1, tracked.part2), "{what}");
        let features = (rows.feature1[slot], rows.feature2[slot]);
        let (kinematic, what) = (&tracked.kinematic, &what);
        assert_eq!(features, (kinematic.feature1(), kinematic.feature2()), "{what}");
    }
    points.len()
}

fn rows_of_all<N, R, const D: usize>(scene: &Scene<N, R, D>)
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Sync,
{
    let dispatcher = DefaultContactDispatcher::<D>::new();
    let mut rows = ManifoldRows::new();
    let (mut points, mut most) = (0, 0);
    for (threads, limit, max_points) in [(1, 0.0, None), (4, 0.25, None), (4, 0.25, Some(1))] {
        let prediction = ContactPrediction::new(N::lit(limit), N::ZERO, N::lit(limit * 0.25));
        let batch = scene.batch();
        on_threads(threads, || {
            batch.manifolds(&prediction, max_points, &Control::new(), &mut rows)
        })
        .expect("good");
        assert_eq!((rows.num_pairs(), rows.starts[0]), (scene.len(), 0), "a row for each");
        assert_eq!(rows.starts[scene.len()], rows.num_points(), "the last ends with the points");
        for index in 0..scene.len() {
            let mut generator =
                max_points.map_or_else(Default::default, PairManifoldGenerator::new);
            let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
            let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
            let ids = &mut IdAllocator::new();
            generator.update(&dispatcher, m1, g1, m2, g2, &prediction, ids);
            let mut expected = Vec::new();
            generator.contacts(&mut expected);
            points += check(&rows, index, &expected);
            most = most.max(expected.len());
        }
    }
    assert!(points > scene.len() && most > 1, "{points} points, {most} manifolds of one pair");
}

#[test]
fn points_are_those_of_new_generators() {
    rows_of_all(&scene2::<f32>(0.0).thinned());
    rows_of_all(&scene2::<f64>(1e6).thinned());
    rows_of_all(&scene3::<f32>(0.0).thinned());
    rows_of_all(&scene3::<f64>(0.0).thinned());
}

/// Pairs of all kinds that are computed in lanes, in random order, so that the last group of a kind
/// is incomplete. All solids are near each other.
#[test]
fn lanes_take_pairs_of_mixed_kinds() {
    let random = &mut Random(3, false);
    let mut end = || random.vector::<f64, 3>().into();
    let shapes: [ShapeHandle<f64, 3>; 5] = [
        ShapeHandle::new(Ball::new(0.75)),
        ShapeHandle::new(Cuboid::new(Vector::<f64, 3>::new(1.0, 0.5, 0.75))),
        ShapeHandle::new(Capsule::<f64, 3>::new(1.0, 0.25)),
        ShapeHandle::new(Segment::new(end(), end())),
        ShapeHandle::new(Cuboid::new(Vector::<f64, 3>::repeat(1.0))),
    ];
    let picks: [Vec<u32>; 2] =
        [(); 2].map(|()| (0..1001).map(|_| (random.bits() % 5) as u32).collect());
    let mut place =
        || Isometry3::from_parts((random.vector::<f64, 3>() * 1.5).into(), random.turn3());
    let poses = [(); 2].map(|()| (0..1001).map(|_| place()).collect::<Vec<_>>());
    let scene = Scene { shapes: shapes.to_vec(), picks, poses };
    rows_of_lanes(&scene);
}

fn rows_of_lanes(scene: &Scene<f64, impinge::math::na::UnitQuaternion<f64>, 3>) {
    let prediction = ContactPrediction::new(0.1, 0.0, 0.0);
    let mut rows = ManifoldRows::new();
    scene.batch().manifolds(&prediction, None, &Control::new(), &mut rows).expect("good");
    let (dispatcher, mut touching) = (DefaultContactDispatcher::<3>::new(), 0);
    for index in 0..scene.len() {
        let mut generator = PairManifoldGenerator::default();
        let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
        let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
        generator.update(&dispatcher, m1, g1, m2, g2, &prediction, &mut IdAllocator::new());
        let mut expected = Vec::new();
        generator.contacts(&mut expected);
        touching += usize::from(check(&rows, index, &expected) > 0);
    }
    assert!(touching > 300 && touching < 900, "{touching} of {} touch", scene.len());
}

#[test]
fn what_was_in_the_rows_is_replaced() {
    let (cube, here) =
        (Cuboid::new(Vector::<f64, 3>::repeat(1.0)), OnePose(Pose::<f64, 3>::identity()));
    let places = [1.75, 9.0].map(|y| Pose::from_translation(Vector::<f64, 3>::new(0.0, y, 0.0)));
    let one = Side::try_new(Shapes::One(&cube), &here).expect("one");
    let both = Side::try_new(Shapes::One(&cube), &places).expect("two");
    let batch = PairBatch::try_new(one, both).expect("one and two");
    let prediction = ContactPrediction::new(0.0, 0.0, 0.0);
    let mut rows = ManifoldRows::new();
    for _ in 0..2 {
        batch.manifolds(&prediction, None, &Control::new(), &mut rows).expect("good");
        assert_eq!((rows.num_pairs(), &rows.starts[..]), (2, &[0, 4, 4][..]), "four points");
        assert_eq!(rows.depth, [0.25; 4], "a face on a face");
    }
    let nobody: [Pose<f64, 3>; 0] = [];
    let nobody = Side::try_new(Shapes::One(&cube), &nobody).expect("none");
    let batch = PairBatch::try_new(one, nobody).expect("none against one");
    batch.manifolds(&prediction, None, &Control::new(), &mut rows).expect("good");
    assert_eq!((rows.num_pairs(), rows.num_points()), (0, 0), "no pair is left");
}
