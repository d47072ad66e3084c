//! Compares the pairs within a distance with a brute-force test of all pairs.

use impinge::batch::{BatchError, Control, OnePose, Shapes, Side, pairs_within, pairs_within_one};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Pose, Space, Unit, Vector};
use impinge::query::{Proximity, distance, proximity};
use impinge::shape::{Ball, Cuboid, Plane, ShapeHandle};

use super::scene::{Scene, on_threads, scene2, scene3};
use crate::support::composite_support::Pieces;
use crate::support::samples::stride;

/// Placed shapes from a scene.
struct Crowd<N: Space<D>, R, const D: usize> {
    shapes: Vec<ShapeHandle<N, D>>,
    poses: Vec<Isometry<N, R, D>>,
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize> Crowd<N, R, D> {
    /// Takes the second solids of every `step`-th pair of a scene, spread over a volume. Two have
    /// equal centres, and one is a hundred times as large as the others.
    fn of(scene: &Scene<N, R, D>, step: usize) -> Self {
        // In 2D the second shapes recur after 93 pairs, a multiple of three. From pair 8 on, a step
        // of a multiple of three still meets all of them, and NaN positions.
        let all = (8..scene.len()).step_by(step);
        let shapes = all.clone().map(|index| scene.shape(1, index).clone());
        let spread = |index: usize| {
            let pose = scene.poses[1][index];
            let by = |axis: usize| N::lit(((index * [7, 5, 3][axis]) % [23, 19, 17][axis]) as f64);
            let by = Vector::<N, D>::from_fn(|axis, _| by(axis));
            Isometry::from_parts((pose.translation.vector + by).into(), pose.rotation)
        };
        let mut crowd = Self { shapes: shapes.collect(), poses: all.map(spread).collect() };
        let huge = Cuboid::new(Vector::<N, D>::repeat(N::lit(100.0)));
        let far = Vector::<N, D>::repeat(N::lit(95.0));
        crowd.add(ShapeHandle::new(huge), Isometry { ..crowd.poses[1] });
        crowd.poses.last_mut().expect("it").translation.vector += far;
        crowd.add(crowd.shapes[0].clone(), crowd.poses[0]);
        crowd
    }

    fn add(&mut self, shape: ShapeHandle<N, D>, pose: Isometry<N, R, D>) {
        self.shapes.push(shape);
        self.poses.push(pose);
    }

    fn side(&self) -> Side<'_, N, D> {
        Side::try_new(Shapes::Each(&self.shapes), &self.poses).expect("as many")
    }

    fn are_within(&self, one: usize, other: &Self, two: usize, distance: N) -> bool {
        let (g1, g2) = (&*self.shapes[one], &*other.shapes[two]);
        proximity(&self.poses[one], g1, &other.poses[two], g2, distance) != Proximity::Disjoint
    }

    /// Returns the pairs of an element and another's element that are within the distance.
    fn brute(&self, other: &Self, distance: N) -> Vec<[u32; 2]> {
        self.brute_from(other, distance, |_| 0)
    }

    /// Returns the pairs of its own elements that are within the distance.
    fn brute_own(&self, distance: N) -> Vec<[u32; 2]> {
        self.brute_from(self, distance, |one| one + 1)
    }

    /// Returns the pairs within the distance of each element and another's elements from index
    /// `from(element)` on.
    fn brute_from(&self, other: &Self, distance: N, from: fn(usize) -> usize) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for one in 0..self.shapes.len() {
            for two in from(one)..other.shapes.len() {
                if self.are_within(one, other, two, distance) {
                    pairs.push([one, two].map(|index| u32::try_from(index).expect("few")));
                }
            }
        }
        pairs
    }
}

fn check<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
    [few, many]: [usize; 2],
) {
    let [few, many] = [few, many * stride(3)].map(|step| Crowd::of(scene, step));
    let count = many.shapes.len();
    let enough = 200 / stride(3);
    assert!(few.shapes.len() < 64 && count > enough, "{count} in more than one chunk of 64");
    for (threads, distance) in [(1, 0.0), (4, 0.5), (1, f64::INFINITY)] {
        let distance = N::lit(distance);
        on_threads(threads, || {
            let expected = few.brute(&many, distance);
            let found = pairs_within(&few.side(), &many.side(), distance, &Control::new());
            assert_eq!(found.as_ref(), Ok(&expected), "few and many within {distance}");
            let mut turned: Vec<_> = expected.iter().map(|&[one, other]| [other, one]).collect();
            turned.sort_unstable();
            let found = pairs_within(&many.side(), &few.side(), distance, &Control::new());
            assert_eq!(found, Ok(turned), "many and few within {distance}");
            let own = many.brute_own(distance);
            let found = pairs_within_one(&many.side(), distance, &Control::new());
            assert_eq!(found.as_ref(), Ok(&own), "among themselves within {distance}");
            let all = count * (count - 1) / 2;
            let is_some = own.len() * 100 > all && own.len() < all;
            assert!(is_some, "{} of {all} pairs within {distance}", own.len());
        });
    }
}

#[test]
fn pairs_are_those_that_single_calls_find() {
    check(&scene2::<f32>(0.0), [89, 7]);
    check(&scene2::<f64>(1e6), [89, 7]);
    check(&scene3::<f32>(0.0), [97, 13]);
    check(&scene3::<f64>(0.0), [97, 13]);
    check(&scene3::<f64>(1e6), [97, 13]);
}

/// Tests balls of radius 1 on a grid of spacing 3, whose neighbours are exactly 1 apart. Asserts
/// that the maximum distance is inclusive.
#[test]
fn touching_at_exactly_the_distance_counts() {
    for away in [0.0, 1048576.0] {
        let ball = Ball::new(1.0_f64);
        let at = |index: u32| {
            let [x, y] = [index % 20, index / 20].map(|x| 3.0 * f64::from(x) + away);
            Pose::from_translation(Vector::<f64, 2>::new(x, y))
        };
        let grid: Vec<_> = (0..400).map(at).collect();
        let side = Side::try_new(Shapes::One(&ball), &grid).expect("one ball");
        let within = |distance| pairs_within_one(&side, distance, &Control::new());
        let neighbours = within(1.0).expect("good");
        assert_eq!(neighbours.len(), 2 * 19 * 20, "beside and above");
        assert!(neighbours.is_sorted() && neighbours[..2] == [[0, 1], [0, 20]], "ascending");
        assert_eq!(within(1.0_f64.next_down()), Ok(Vec::new()), "a little less");
        assert_eq!(within(1.25).map(|pairs| pairs.len()), Ok(760), "not the diagonals");
        assert_eq!(within(2.25).map(|pairs| pairs.len()), Ok(760 + 2 * 19 * 19), "these");
    }
}

#[test]
fn half_spaces_meet_all_that_is_near_them() {
    let tilted = Unit::new_normalize(Vector::<f64, 2>::new(1.0, 3.0));
    let (ball, cuboid) = (Ball::new(0.5), Cuboid::new(Vector::<f64, 2>::new(0.5, 0.25)));
    let shapes: Vec<ShapeHandle<f64, 2>> = vec![
        ShapeHandle::new(Plane::new(tilted)),
        ShapeHandle::new(ball),
        ShapeHandle::new(Plane::new(Unit::new_unchecked(Vector::<f64, 2>::y()))),
        ShapeHandle::new(cuboid),
    ];
    let shapes: Vec<_> = shapes.iter().cycle().take(100).cloned().collect();
    let place = |index: u32| {
        let [x, y] = [index % 10, index / 10].map(|x| f64::from(x) - 5.0);
        Isometry2::translation(3.0 * x, 2.0 * y)
    };
    let crowd = Crowd { shapes, poses: (0..100).map(place).collect() };
    for distance in [0.0, 1.0, 7.5] {
        let expected = crowd.brute_own(distance);
        let found = pairs_within_one(&crowd.side(), distance, &Control::new()).expect("good");
        assert_eq!(found, expected, "within {distance}");
    }
}

#[test]
fn what_is_nowhere_has_no_pairs() {
    let (ball, nobody) = (ShapeHandle::new(Ball::new(1.0_f64)), Pieces::<f64, 2>::new(vec![]));
    let shapes = [ball.clone(), ShapeHandle::new(nobody), ball.clone(), ball.clone(), ball];
    let mut poses = [Pose::<f64, 2>::identity(); 5];
    poses[2].translation[1] = f64::NAN;
    poses[3].rotation[(0, 1)] = f64::INFINITY;
    let side = Side::try_new(Shapes::Each(&shapes), &poses).expect("as many");
    for distance in [0.0, 5.0, f64::INFINITY] {
        let found = pairs_within_one(&side, distance, &Control::new());
        assert_eq!(found, Ok(vec![[0, 4]]), "within {distance}");
        let found = pairs_within(&side, &side, distance, &Control::new());
        assert_eq!(found, Ok(vec![[0, 0], [0, 4], [4, 0], [4, 4]]), "within {distance}");
    }
    let empty: [Pose<f64, 2>; 0] = [];
    let empty = Side::try_new(Shapes::Each(&[]), &empty).expect("none");
    assert_eq!(pairs_within(&empty, &side, 1.0, &Control::new()), Ok(Vec::new()), "none");
    assert_eq!(pairs_within_one(&empty, 1.0, &Control::new()), Ok(Vec::new()), "none");
}

#[test]
fn distances_that_are_none_are_refused() {
    let (ball, here) = (Ball::new(1.0_f64), OnePose(Pose::<f64, 2>::identity()));
    let side = Side::try_new(Shapes::One(&ball), &here).expect("one");
    let error = pairs_within(&side, &side, -0.5, &Control::new()).expect_err("negative");
    assert_eq!(error, BatchError::Distance { value: -0.5 }, "by its value");
    assert_eq!(error.to_string(), "the distance is -0.5, where zero or more is needed", "so");
    let error = pairs_within_one(&side, f64::NAN, &Control::new()).expect_err("no distance");
    assert!(matches!(error, BatchError::Distance { value } if value.is_nan()), "{error}");
}

/// Places every two shapes side by side along an axis, so that the gap of their boxes is their
/// distance up to rounding. The tree must propose each pair at exactly the distance of the single
/// call, whether that was rounded up or down.
fn at_their_own_distance<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) {
    let mut apart = 0;
    for index in 0..scene.len() {
        let (shape1, shape2) = (scene.shape(0, index), scene.shape(1, index));
        let (pose1, mut pose2) = (scene.poses[0][index], scene.poses[1][index]);
        pose2.translation.vector = pose1.translation.vector;
        pose2.translation.vector[index % D] += N::lit(3.1 + 0.01 * (index % 97) as f64);
        let found = distance(&pose1, &**shape1, &pose2, &**shape2);
        let (one, other) = (OnePose(pose1), OnePose(pose2));
        let one = Side::try_new(Shapes::One(&**shape1), &one).expect("one");
        let other = Side::try_new(Shapes::One(&**shape2), &other).expect("one");
        let pairs = pairs_within(&one, &other, found, &Control::new());
        assert_eq!(pairs, Ok(vec![[0, 0]]), "pair {index} at {found}");
        apart += usize::from(found > N::ZERO);
    }
    assert!(apart * 3 > scene.len(), "{apart} of {} are apart", scene.len());
}

#[test]
fn the_tree_proposes_what_is_at_exactly_the_distance() {
    at_their_own_distance(&scene2::<f32>(0.0));
    at_their_own_distance(&scene2::<f32>(1e4));
    at_their_own_distance(&scene3::<f32>(0.0));
    at_their_own_distance(&scene3::<f64>(1e6));
}
