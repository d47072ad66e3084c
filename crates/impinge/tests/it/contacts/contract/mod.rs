//! Tests the contract of contacts (`ARCHITECTURE.md`) for every two kinds of convex solids.
//! Contacts come from `contact`, from a generator alone, and from worlds of 1, 7, 8, 9 and 20 pairs
//! of these kinds. Each pair of kinds has twenty scenes: apart within the prediction, touching,
//! shallow, deep and one inside the other; aligned, nearly aligned and arbitrarily rotated; some
//! with sizes of zero, far from the origin, or of very different sizes; with and without an angular
//! prediction; with predictions equal to the distance or slightly less. Each scene is also scaled
//! by 2⁻²⁰ and 2²⁰. [`Share`] selects the part of this that a run tests.
//!
//! Depths are compared with the reference, not with another path of the library, for all pairs in
//! 2D and for all pairs without curved faces. For other pairs the reference has to search for the
//! normal, so it is used for one scene in five. The rest are checked by the separation along their
//! normal and by the positions of their points. The area that points span is tested in
//! `cases/manifolds.rs`.

use crate::contacts::contact_points::{forms, turns};
use crate::support::samples::{samples, stride};

mod answers;
mod laws;
mod report;
mod scene;
mod tolerances;

use std::collections::{BTreeMap, BTreeSet};

use answers::{Batch, Lone, Points};
use forms::{PLANE, SPACE, plane, space};
use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Real, Space};
use impinge_reference::precise;
use laws::{Judge, are_same, kept};
use report::Report;
use scene::{SCENES, Scene, Stage};
use tolerances::is_known;
use turns::{turns2, turns3};

/// Numbers of pairs in a world. The narrow phase computes batches of eight: one pair, one less than
/// a batch, a full batch, and one more.
const BATCHES: [usize; 4] = [1, 7, 8, 9];

/// Returns how often each pair of kinds is tested, with another seed each time: once, or more often
/// with at least a hundred times the samples.
fn rounds() -> u64 {
    1 + samples(1) as u64 / 100
}

/// The part of the scenes of a pair of kinds that is tested: all with ten times the samples, an
/// eighth by default. Each pair of kinds then has two or three scenes, with other regimes than the
/// next pair, and one pair of kinds in eight is placed in worlds.
struct Share {
    /// Differs from pair to pair, and for the same pair from scalar to scalar.
    offset: u64,
    stride: u64,
}

impl Share {
    /// Returns `true` if the laws are tested for scene `number` alone.
    fn is_judged(&self, number: usize) -> bool {
        (self.offset + number as u64).is_multiple_of(self.stride)
    }

    /// Returns `true` if all scenes are placed in worlds.
    fn is_in_worlds(&self) -> bool {
        // With this summand, each kind is in the worlds of each scalar and dimension by default.
        (self.offset + 5).is_multiple_of(self.stride)
    }

    /// Returns the least number of answers that a round must give.
    fn least(&self) -> usize {
        let judged = (0..SCENES).filter(|&number| self.is_judged(number)).count();
        14 * judged + if self.is_in_worlds() { 12 * SCENES } else { 0 }
    }
}

/// All scenes of a pair of kinds. Scenes with odd numbers exchange the two kinds.
struct Kinds<'a, N: Real, R, const D: usize> {
    stage: &'a Stage<N, R, D>,
    names: [&'static str; 2],
    scenes: Vec<Scene<N, R, D>>,
}

impl<N, R, const D: usize> Stage<N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    fn convex(&self) -> Vec<usize> {
        let composite = ["polyline", "height field", "compound", "mesh", "closed mesh"];
        (0..self.names.len()).filter(|&kind| !composite.contains(&self.names[kind])).collect()
    }

    fn check(&self, seed: u64) {
        let (kinds, mut report) = (self.convex(), Report::default());
        let pairs = kinds.iter().flat_map(|one| kinds.iter().map(move |two| [*one, *two]));
        let mut least = 0;
        for (index, pair) in (0..).zip(pairs.filter(|[one, two]| one <= two)) {
            if pair.map(|kind| self.names[kind]) == ["half-space"; 2] {
                continue;
            }
            let share = Share { offset: index + seed, stride: stride(8) as u64 };
            for round in 0..rounds() {
                let seed = seed + 1000 * index + 1_000_000 * round;
                self.check_kinds(pair, seed, &share, &mut report);
                least += share.least();
            }
        }
        let (asked, broken) = (report.asked(), report.broken(is_known::<D>));
        assert!(asked > least, "{asked} answers, at least {least} are expected");
        assert!(broken.is_empty(), "of {asked} answers:\n{}", broken.join("\n"));
    }

    /// Tests the share of the scenes of one pair of kinds, for one seed.
    fn check_kinds(&self, pair: [usize; 2], seed: u64, share: &Share, report: &mut Report) {
        let names = pair.map(|kind| self.names[kind]);
        let scene = |number: usize| {
            let [one, two] = pair;
            self.scene([[one, two], [two, one]][number % 2], number, seed + number as u64)
        };
        if share.is_in_worlds() {
            let scenes = (0..SCENES).map(scene).collect();
            Kinds { stage: self, names, scenes }.check(share, report);
            return;
        }
        for number in (0..SCENES).filter(|&number| share.is_judged(number)) {
            let scene = &scene(number);
            Judge { stage: self, scene, names, number, report: &mut *report }.alone();
        }
    }
}

impl<N, R, const D: usize> Kinds<'_, N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    fn judge<'a>(&'a self, number: usize, report: &'a mut Report) -> Judge<'a, N, R, D> {
        let (stage, scene) = (self.stage, &self.scenes[number]);
        Judge { stage, scene, names: self.names, number, report }
    }

    fn check(&self, share: &Share, report: &mut Report) {
        let alone = (0..SCENES).map(|number| {
            let mut judge = self.judge(number, report);
            if share.is_judged(number) { judge.alone() } else { judge.points() }
        });
        let alone: Vec<Points<N, D>> = alone.collect();
        self.in_motion(report);
        for (index, count) in BATCHES.into_iter().enumerate() {
            let first = (index * 5) % (SCENES - count);
            let batch = Batch::new(&self.scenes[first..first + count]).points();
            for (number, points) in (first..).zip(batch) {
                self.is_as_alone(number, [&alone[number], &points], report);
            }
        }
    }

    /// Law 5: the contacts of a pair have the same bits alone and in any batch.
    fn is_as_alone(&self, number: usize, [alone, found]: [&Points<N, D>; 2], report: &mut Report) {
        let what = || format!("alone {alone:?}, in a batch {found:?}");
        self.judge(number, report).holds("5 batches", are_same(alone, found), what);
    }

    /// Moves the second solid of each scene a small step and back, in one world of all scenes and
    /// alone. Asserts that both keep the same ids and give equal contacts.
    fn in_motion(&self, report: &mut Report) {
        let mut batch = Batch::new(&self.scenes);
        let mut lones: Vec<Lone<N, D>> = (0..SCENES).map(|_| Lone::new()).collect();
        let mut given = vec![BTreeSet::new(); SCENES];
        let mut owners = BTreeMap::new();
        let mut before: [Vec<Points<N, D>>; 2] =
            [vec![Vec::new(); SCENES], vec![Vec::new(); SCENES]];
        let moved: Vec<_> = self.scenes.iter().map(Scene::moved).collect();
        for is_moved in [false, false, true, false] {
            let places = || {
                let both = self.scenes.iter().zip(&moved);
                both.map(|(scene, moved)| if is_moved { moved } else { &scene.poses })
            };
            batch.move_to(places().map(|poses| &poses[1]));
            let found = batch.points();
            for (number, poses) in places().enumerate() {
                let scene = &self.scenes[number];
                let (limit, angle) = (scene.limit, scene.angle);
                let points = lones[number].ask(poses.each_ref(), scene.shapes(), limit, angle);
                let mut judge = self.judge(number, report);
                let olds = [&before[0][number], &before[1][number]];
                judge.names(olds[0], &points, &mut given[number]);
                let [ids, in_batch] = [kept(olds[0], &points), kept(olds[1], &found[number])];
                let is_own = |id| *owners.entry(id).or_insert(number) == number;
                let are_own = found[number].iter().map(|point| point.id).all(is_own);
                judge.holds("4 ids in batches", ids == in_batch && are_own, || {
                    format!("{ids:?} alone, {in_batch:?} in a batch")
                });
                self.is_as_alone(number, [&points, &found[number]], report);
                before[0][number] = points;
            }
            before[1] = found;
        }
    }
}

fn in_plane<N: Real>(seed: u64) {
    let stage = Stage::<N, UnitComplex<N>, 2> {
        names: &PLANE,
        form: plane,
        turns: turns2::<N, true>(),
        precise: |pose| {
            let turn = [pose.rotation.re, pose.rotation.im].map(N::as_f64);
            precise::Pose::from_complex(pose.translation.vector.map(N::as_f64).into(), turn)
        },
    };
    stage.check(seed);
}

fn in_space<N: Real>(seed: u64) {
    let stage = Stage::<N, UnitQuaternion<N>, 3> {
        names: &SPACE,
        form: space,
        turns: turns3::<N, true>(),
        precise: |pose| {
            let turn = pose.rotation.coords.map(N::as_f64).into();
            precise::Pose::from_quaternion(pose.translation.vector.map(N::as_f64).into(), turn)
        },
    };
    stage.check(seed);
}

#[test]
fn contacts_in_the_plane_f32() {
    in_plane::<f32>(1);
}

#[test]
fn contacts_in_the_plane_f64() {
    in_plane::<f64>(2);
}

#[test]
fn contacts_in_space_f32() {
    in_space::<f32>(3);
}

#[test]
fn contacts_in_space_f64() {
    in_space::<f64>(4);
}
