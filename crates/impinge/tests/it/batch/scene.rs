//! Pairs of all shapes in all relative positions, for the tests of batches.

use impinge::batch::{PairBatch, PoseSource, Shapes, Side};
use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Point, Real, Space, Vector};
use impinge::shape::ShapeHandle;

use crate::support::query_support::random::Random;
use crate::support::samples::stride;
use crate::support::shape_table;

/// A batch of pairs: indices of their shapes in a list, and their poses.
pub(super) struct Scene<N: Real, R, const D: usize> {
    pub(super) shapes: Vec<ShapeHandle<N, D>>,
    pub(super) picks: [Vec<u32>; 2],
    pub(super) poses: [Vec<Isometry<N, R, D>>; 2],
}

/// Pairs every shape with every shape: at equal positions, with boxes that touch (1 apart if a box
/// is unbounded), and rotated, with positions up to 1, 4 and 40 apart. Some pairs also occur with a
/// NaN position. The first shape of each pair is at the point with all coordinates equal to `away`.
fn scene<N: Space<D>, R: AbstractRotation<N, D> + Copy, const D: usize>(
    table: shape_table::Shapes<N, D>,
    away: f64,
    turn: fn(&mut Random) -> R,
) -> Scene<N, R, D> {
    let random = &mut Random(17, false);
    let shapes: Vec<_> = table.into_iter().map(|(_, shape)| shape).collect();
    let mut scene = Scene { shapes, picks: Default::default(), poses: Default::default() };
    let origin = Vector::<N, D>::repeat(N::lit(away));
    let count = u32::try_from(scene.shapes.len()).expect("a few");
    for (pick1, pick2) in (0..count).flat_map(|one| (0..count).map(move |other| (one, other))) {
        let [box1, box2] = [pick1, pick2].map(|pick| scene.shapes[pick as usize].local_aabb());
        let mut beside = Vector::<N, D>::zeros();
        let gap = box1.maxs()[0] - box2.mins()[0];
        beside[0] = if gap.is_finite_number() { gap } else { N::ONE };
        let mut nowhere = Vector::<N, D>::zeros();
        nowhere[D - 1] = N::lit(f64::NAN);
        let still = R::identity();
        let places = [
            (still, still, Vector::<N, D>::zeros()),
            (still, still, beside),
            (turn(random), turn(random), random.vector()),
            (turn(random), turn(random), random.vector() * N::lit(4.0)),
            (turn(random), turn(random), random.vector() * N::lit(40.0)),
        ];
        let lost = (pick2 % 7 == 0).then_some((still, still, nowhere));
        for (turn1, turn2, by) in places.into_iter().chain(lost) {
            for (list, pick) in scene.picks.iter_mut().zip([pick1, pick2]) {
                list.push(pick);
            }
            scene.poses[0].push(Isometry::from_parts(origin.into(), turn1));
            scene.poses[1].push(Isometry::from_parts((origin + by).into(), turn2));
        }
    }
    scene
}

pub(super) fn scene2<N: Real>(away: f64) -> Scene<N, UnitComplex<N>, 2> {
    scene(shape_table::plane(N::ONE), away, Random::turn2)
}

pub(super) fn scene3<N: Real>(away: f64) -> Scene<N, UnitQuaternion<N>, 3> {
    scene(shape_table::space(N::ONE), away, Random::turn3)
}

impl<N: Real, R: Copy, const D: usize> Scene<N, R, D> {
    /// Keeps the pairs with the given indices, in the given order.
    pub(super) fn only(self, kept: impl Iterator<Item = usize> + Clone) -> Self {
        let picks = self.picks.each_ref().map(|list| kept.clone().map(|at| list[at]).collect());
        let poses = self.poses.each_ref().map(|list| kept.clone().map(|at| list[at]).collect());
        Self { picks, poses, ..self }
    }

    /// Keeps the last of every seven pairs of shapes, at all its positions; every pair if the
    /// [`stride`] is 1. The number of shapes, 18 or 23, is no multiple of seven, so each shape
    /// occurs on both sides. As all positions of a pair are kept, several pairs of the same kinds
    /// follow each other, which the library computes in lanes: also two boxes in 2D, and in 3D two
    /// capsules, and a triangle and a hull.
    pub(super) fn thinned(self) -> Self {
        let (step, count) = (stride(7), self.shapes.len());
        let number = |at: usize| self.picks[0][at] as usize * count + self.picks[1][at] as usize;
        let all = 0..self.picks[0].len();
        let kept: Vec<usize> = all.filter(|&at| number(at) % step == step - 1).collect();
        self.only(kept.iter().copied())
    }
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize> Scene<N, R, D> {
    pub(super) fn len(&self) -> usize {
        self.picks[0].len()
    }

    /// Returns the shape of pair `index` on side `side`.
    pub(super) fn shape(&self, side: usize, index: usize) -> &ShapeHandle<N, D> {
        &self.shapes[self.picks[side][index] as usize]
    }

    pub(super) fn picked(&self, side: usize) -> Shapes<'_, N, D> {
        Shapes::Picked { shapes: &self.shapes, picks: &self.picks[side] }
    }

    /// Returns a side of a batch: the shapes of the scene at `poses`.
    pub(super) fn side<'a>(
        &'a self,
        side: usize,
        poses: &'a dyn PoseSource<N, D>,
    ) -> Side<'a, N, D> {
        Side::try_new(self.picked(side), poses).expect("a pose for each")
    }

    pub(super) fn batch(&self) -> PairBatch<'_, N, D> {
        let [side1, side2] = [0, 1].map(|side| self.side(side, &self.poses[side]));
        PairBatch::try_new(side1, side2).expect("as many on both sides")
    }
}

/// Runs `run` on a pool of `threads` threads, which share the chunks of a batch if the feature
/// `parallel` is on.
pub(crate) fn on_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads").install(run)
}

/// Asserts that the coordinates have the bits of `expected`, or are all NaN if it is `None`.
#[track_caller]
pub(super) fn assert_point<N: Real, const D: usize>(
    found: &[N; D],
    expected: Option<Point<N, D>>,
    what: &str,
) {
    match expected {
        Some(expected) => {
            let bits = |x: &N| x.bits();
            assert!(found.iter().map(bits).eq(expected.iter().map(bits)), "{what}: {found:?}");
        }
        None => assert!(found.iter().all(|x| x.partial_cmp(x).is_none()), "{what}: {found:?}"),
    }
}

/// Asserts that two numbers have equal bits.
#[track_caller]
pub(crate) fn assert_number<N: Real>(found: N, expected: N, what: &str) {
    assert_eq!(found.bits(), expected.bits(), "{what}: {found} and {expected}");
}
