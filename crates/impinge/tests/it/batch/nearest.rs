//! Compares the nearest pair of a batch and its distance with the least distance of single calls.

use impinge::batch::{Control, OnePose, PairBatch, Shapes, Side};
use impinge::math::{AbstractRotation, Pose, Space, Vector};
use impinge::query::distance;
use impinge::shape::Ball;

use super::scene::{Scene, on_threads, scene2, scene3};

/// Returns the least distance of the pairs from index `from` on, with its index; at equal distances
/// the lowest index. `None` if no distance is finite.
fn least<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
    from: usize,
) -> Option<(usize, N)> {
    let mut least: Option<(usize, N)> = None;
    for index in from..scene.len() {
        let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
        let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
        let found = distance(m1, g1, m2, g2);
        if found.is_finite_number() && least.is_none_or(|(_, least)| found < least) {
            least = Some((index, found));
        }
    }
    least
}

/// Keeps the pairs that are more than 0.5 apart, and repeats them in reverse order. So each
/// distance occurs twice, and the lower index must win.
fn apart<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize>(
    scene: Scene<N, R, D>,
) -> Scene<N, R, D> {
    let mut distances = vec![N::ZERO; scene.len()];
    scene.batch().distances(&Control::new(), &mut distances).expect("good");
    let kept: Vec<usize> = (0..scene.len()).filter(|&index| distances[index] > N::HALF).collect();
    scene.only(kept.iter().chain(kept.iter().rev()).copied())
}

fn check<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize>(
    scene: Scene<N, R, D>,
) {
    let expected = least(&scene, 0);
    let find = |scene: &Scene<N, R, D>, limit| {
        scene.batch().nearest(limit, &Control::new()).expect("not cancelled")
    };
    assert_eq!(find(&scene, N::INFINITY), expected, "many touch: the first of them");
    assert_eq!(expected.map(|(_, distance)| distance), Some(N::ZERO), "they touch");
    let scene = apart(scene);
    let expected = least(&scene, 0);
    let (_, smallest) = expected.expect("some are apart");
    assert!(scene.len() > 500 && smallest > N::HALF, "{} are apart", scene.len());
    for threads in [1, 4] {
        for limit in [N::INFINITY, smallest, smallest * N::TWO] {
            let found = on_threads(threads, || find(&scene, limit));
            assert_eq!(found, expected, "the first of two, on {threads} threads");
        }
        let short = smallest * N::lit(0.999);
        assert_eq!(on_threads(threads, || find(&scene, short)), None, "beyond the limit");
    }
}

#[test]
fn the_least_of_all_by_distance_then_by_index() {
    check(scene2::<f32>(0.0));
    check(scene2::<f64>(1e6));
    check(scene3::<f32>(0.0));
    check(scene3::<f64>(0.0));
}

#[test]
fn of_equals_the_first_on_any_number_of_threads() {
    let ball = Ball::new(1.0_f64);
    let at = |x: f64| Pose::from_translation(Vector::<f64, 2>::new(x, 0.0));
    // All poses at the same distance, except two that are nearer by equal amounts.
    let mut poses = vec![at(10.0); 2000];
    let here = OnePose(at(0.0));
    let nearest = |poses: &Vec<Pose<f64, 2>>, threads| {
        let one = Side::try_new(Shapes::One(&ball), &here).expect("one");
        let all = Side::try_new(Shapes::One(&ball), poses).expect("many");
        let batch = PairBatch::try_new(all, one).expect("many against one");
        on_threads(threads, || batch.nearest(100.0, &Control::new()))
    };
    assert_eq!(nearest(&poses, 4), Ok(Some((0, 8.0))), "all are as far");
    (poses[1500], poses[777]) = (at(-6.0), at(6.0));
    for threads in [1, 4, 4, 4] {
        assert_eq!(nearest(&poses, threads), Ok(Some((777, 4.0))), "{threads} threads");
    }
    poses[1999] = at(1.0);
    assert_eq!(nearest(&poses, 4), Ok(Some((1999, 0.0))), "the last overlaps");
    poses[3] = at(2.0);
    assert_eq!(nearest(&poses, 4), Ok(Some((3, 0.0))), "touching is as near");
}

#[test]
fn limits_that_are_no_distances_count_as_zero() {
    let ball = Ball::new(1.0_f64);
    let poses = [3.0, 2.0].map(|x| Pose::from_translation(Vector::<f64, 2>::new(x, 0.0)));
    let here = OnePose(Pose::identity());
    let one = Side::try_new(Shapes::One(&ball), &here).expect("one");
    let both = Side::try_new(Shapes::One(&ball), &poses).expect("two");
    let batch = PairBatch::try_new(one, both).expect("one and two");
    for limit in [0.0, -1.0, f64::NAN] {
        assert_eq!(batch.nearest(limit, &Control::new()), Ok(Some((1, 0.0))), "{limit}");
    }
    let nobody: [Pose<f64, 2>; 0] = [];
    let nobody = Side::try_new(Shapes::One(&ball), &nobody).expect("none");
    let batch = PairBatch::try_new(one, nobody).expect("none against one");
    assert_eq!(batch.nearest(f64::INFINITY, &Control::new()), Ok(None), "of none none");
}
