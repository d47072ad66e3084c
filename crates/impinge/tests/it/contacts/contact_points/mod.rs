//! Tests that contact points lie on the surfaces of both solids, opposite each other along the
//! normal: for every pair of kinds in both orders, both dimensions and both scalars; apart,
//! touching, shallow and deep; with arbitrary rotations, and with axes along the normal or nearly
//! so.

use crate::support::query_support;
use crate::support::samples::samples;

pub(crate) mod forms;
pub(crate) mod turns;

use std::collections::BTreeMap;

use forms::{Form, PLANE, SPACE, Sizes, local, plane, space};
use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry3, Point, Pose, Real, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, GeometricQueryType,
    IdAllocator, PairManifoldGenerator,
};
use impinge::query::{Contact, contact};
use impinge::shape::{Cone, Cuboid, ShapeKind};
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_reference::geometry::vector::scale;
use impinge_reference::random::Random;
use turns::{Turns, turned3, turns2, turns3};

/// Greatest error of contact points, in units of `EPSILON` times the size of the scene. That size
/// is the sum of both bounding radii, the distance between the origins of the solids, and the
/// distance of the first from the world's origin.
const UNITS: f64 = 64.0;
/// Greatest error in `f64` for solids with a curved side, in the units of [`UNITS`]: about 1e-8 of
/// the size. If the separation is nearly the same along a circle of normals, the search ends with
/// an iteration along that circle, which is only this accurate.
const ROUND: f64 = 5e7;

/// Returns the greatest error allowed for the contact points of two kinds, in units.
fn allowed<N: Real>(names: [&str; 2]) -> f64 {
    let round = ["cylinder", "cone", "tapered", "compound"];
    let is_round = names.iter().any(|name| round.iter().any(|round| name.contains(round)));
    if is_round && N::EPSILON.as_f64() < 1e-10 { ROUND } else { UNITS }
}

/// Returns the number of random scenes for each ordered pair of kinds.
fn rounds() -> usize {
    samples(2)
}

/// Signed distances as multiples of the bounding radius of the second solid, which counts as at
/// least 0.1. `None` keeps the drawn position, usually with the origins close to each other.
const GAPS: [Option<f64>; 7] =
    [Some(0.05), Some(1e-5), Some(0.0), Some(-1e-6), Some(-1e-2), Some(-0.3), None];

/// Generators of the solids and rotations of one dimension.
struct Stage<N: Real, R, const D: usize> {
    names: &'static [&'static str],
    form: fn(usize, Sizes, &mut Random) -> Form<N, D>,
    turns: Turns<R>,
}

/// Statistics of one source of contacts and one pair of kinds: contacts tested, contacts beyond the
/// allowed error, the worst error in units, and its description.
#[derive(Default)]
struct Wrong {
    asked: usize,
    wrong: usize,
    worst: f64,
    what: String,
}

type Wrongs = BTreeMap<String, Wrong>;

/// Two placed solids, the prediction for their contacts, and the unit of errors.
struct Scene<N: Real, R, const D: usize> {
    forms: [Form<N, D>; 2],
    poses: [Isometry<N, R, D>; 2],
    prediction: N,
    unit: f64,
}

impl<N, R, const D: usize> Stage<N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    fn scene(&self, kinds: [usize; 2], random: &mut Random) -> Scene<N, R, D> {
        let ratio = *random.pick(&[1.0, 1.0, 1.0, 0.03, 30.0]);
        let forms = [0, 1].map(|index| {
            let least = [0.1, 0.1 * ratio][index];
            (self.form)(kinds[index], Sizes { least, zeros: false }, random)
        });
        let lean = match random.below(4) {
            0 => 0.0,
            _ => 10.0_f64.powf(-random.range(2.0, 17.0)),
        };
        let aligned = (self.turns.straight)(random) * (self.turns.tilt)(lean, random);
        let turn = if random.chance(0.25) { (self.turns.any)(random) } else { aligned };
        // The second solid is above or below the first: exactly, with an offset of 1e-7, or with
        // any offset up to the sum of their bounding radii along each axis.
        let beside = *random.pick(&[0.0, 0.0, 1e-7, 1.0]);
        let reach = forms[0].reach + forms[1].reach;
        let mut away = scale(&random.vector::<D>(1.0), beside * reach);
        let gap = *random.pick(&GAPS);
        away[1] =
            gap.map_or(random.pick(&[0.0, 0.01]) * reach, |_| random.pick(&[1.5, -1.5]) * reach);
        let away = Vector::<N, D>::from(away.map(N::lit));
        let mut poses = [R::identity(), turn]
            .map(|turn| Isometry::from_parts(Vector::<N, D>::zeros().into(), turn));
        poses[1].translation.vector = away;
        let prediction = N::lit(0.1 * reach);
        if let Some(gap) = gap {
            bring(&forms, &mut poses, N::lit(gap * forms[1].reach.max(0.1)));
        }
        if random.chance(0.25) {
            let turn = (self.turns.any)(random);
            for pose in &mut poses {
                pose.translation.vector = turn.transform_vector(&pose.translation.vector);
                pose.rotation = turn.clone() * pose.rotation.clone();
            }
        }
        if random.chance(0.125) {
            let far = Vector::<N, D>::from(random.vector::<D>(1e6).map(N::lit));
            poses.iter_mut().for_each(|pose| pose.translation.vector += far);
        }
        let at = poses.each_ref().map(|pose| pose.translation.vector.map(N::as_f64));
        let size = reach + (at[1] - at[0]).norm() + at[0].norm();
        Scene { forms, poses, prediction, unit: N::EPSILON.as_f64() * size }
    }

    /// Asserts for random scenes of every ordered pair of kinds that no error of a contact exceeds
    /// the allowed error. Skips pairs of two half-spaces, which have no contact points.
    fn check(&self, seed: u64) {
        let (mut random, mut wrongs) = (Random::new(seed), Wrongs::new());
        for (kind1, kind2) in pairs(self.names.len()) {
            let names = [self.names[kind1], self.names[kind2]];
            if names == ["half-space"; 2] {
                continue;
            }
            for _ in 0..rounds() {
                let seed = random.bits();
                let scene = self.scene([kind1, kind2], &mut Random::new(seed));
                scene.ask(names, seed, &mut wrongs);
            }
        }
        let wrong = wrongs.iter().filter(|(_, wrong)| wrong.wrong > 0);
        let lines: Vec<String> = wrong
            .map(|(name, Wrong { asked, wrong, worst, what })| {
                format!("{name}: {wrong} of {asked}, at most {worst:.1} units: {what}")
            })
            .collect();
        let all: usize = wrongs.values().map(|wrong| wrong.asked).sum();
        assert!(lines.is_empty(), "of {all} contacts:\n{}", lines.join("\n"));
        assert!(all > self.names.len() * self.names.len() * rounds(), "{all} contacts");
    }
}

fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |kind1| (0..count).map(move |kind2| (kind1, kind2)))
}

/// Moves the second solid along the normal until the signed distance is about `gap`.
fn bring<N, R, const D: usize>(forms: &[Form<N, D>; 2], poses: &mut [Isometry<N, R, D>; 2], gap: N)
where
    N: Space<D>,
    R: AbstractRotation<N, D>,
{
    let [shape1, shape2] = forms.each_ref().map(|form| &*form.shape);
    if let Some(found) = contact(&poses[0], shape1, &poses[1], shape2, N::INFINITY) {
        poses[1].translation.vector += found.normal.into_inner() * (found.depth + gap);
    }
}

impl<N, R, const D: usize> Scene<N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    fn ask(&self, names: [&str; 2], seed: u64, wrongs: &mut Wrongs) {
        let [shape1, shape2] = self.forms.each_ref().map(|form| &*form.shape);
        let [pose1, pose2] = &self.poses;
        let allowed = allowed::<N>(names);
        let mut note = |source: &str, found: &[Contact<N, D>]| {
            let name = format!("{source}, {} and {}", names[0], names[1]);
            let wrong = wrongs.entry(name).or_default();
            for contact in found {
                let (error, what) = self.error(contact, source);
                wrong.asked += 1;
                wrong.wrong += usize::from(error > allowed || error.is_nan());
                if error > wrong.worst || error.is_nan() {
                    wrong.worst = error;
                    wrong.what = format!("{what}; seed {seed}");
                }
            }
        };
        let found = contact(pose1, shape1, pose2, shape2, self.prediction);
        note("contact", found.as_slice());
        note("manifold", &self.of_generator());
        note("world", &self.of_world());
    }

    fn of_generator(&self) -> Vec<Contact<N, D>> {
        let [shape1, shape2] = self.forms.each_ref().map(|form| &*form.shape);
        let [pose1, pose2] = &self.poses;
        let (mut generator, mut ids) = (PairManifoldGenerator::default(), IdAllocator::new());
        let dispatcher = DefaultContactDispatcher::<D>::new();
        let prediction = ContactPrediction::new(self.prediction, N::ZERO, N::ZERO);
        let able =
            generator.update(&dispatcher, pose1, shape1, pose2, shape2, &prediction, &mut ids);
        assert!(able, "all shapes are served");
        let mut manifolds = Vec::new();
        generator.contacts(&mut manifolds);
        manifolds.iter().flat_map(|found| found.contacts()).map(|found| found.contact).collect()
    }

    fn of_world(&self) -> Vec<Contact<N, D>> {
        let mut world = CollisionWorld::<N, D, usize>::new(N::lit(0.01));
        let query = GeometricQueryType::Contacts(self.prediction * N::HALF, N::ZERO);
        for (index, (form, pose)) in self.forms.iter().zip(&self.poses).enumerate() {
            world.add(pose.clone(), form.shape.clone(), CollisionGroups::new(), query, index);
        }
        world.update();
        let manifolds = world.contact_manifolds();
        manifolds.flat_map(|(_, _, found)| found.contacts()).map(|found| found.contact).collect()
    }

    /// Returns the error of a contact in units of `self.unit`, and a description of the case. The
    /// contact that `contact` returns for two convex solids must lie exactly on both surfaces. A
    /// contact of composites is the deepest point of a manifold, whose normal is that of a face.
    fn error(&self, found: &Contact<N, D>, source: &str) -> (f64, String) {
        let unit = self.unit;
        let of_composites =
            self.forms.iter().any(|form| form.shape.geometry().kind() == ShapeKind::Composite);
        let is_exact = source == "contact" && !of_composites;
        // Parts whose normals differ by less than 1/1024 form one patch with one normal.
        let is_patch = source != "contact" && of_composites;
        let of_patch = if is_patch { found.depth.as_f64().abs() / 512.0 } else { 0.0 };
        let off = |index: usize, point| {
            let (form, pose) = (&self.forms[index], Pose::from_isometry(&self.poses[index]));
            let beside = if is_exact { 0.0 } else { form.beside + of_patch };
            let off = form.off(&local(&pose, point)) - beside;
            if off < 0.0 { 0.0 } else { off / unit }
        };
        let offs = [off(0, &found.world1), off(1, &found.world2)];
        let way = found.world2 - found.world1 + found.normal.into_inner() * found.depth;
        let aside = way.norm().as_f64() / unit;
        let worst = offs.iter().fold(aside, |most, &off| if off <= most { most } else { off });
        let [form1, form2] = self.forms.each_ref().map(|form| &form.text);
        let what = format!(
            "{offs:.1?} and {aside:.1} across: {found:?} of {form1} at {:?} and {form2} at {:?}",
            self.poses[0], self.poses[1]
        );
        (worst, what)
    }
}

fn in_plane<N: Real>(seed: u64) {
    let stage =
        Stage::<N, UnitComplex<N>, 2> { names: &PLANE, form: plane, turns: turns2::<N, false>() };
    stage.check(seed);
}

fn in_space<N: Real>(seed: u64) {
    let stage = Stage::<N, UnitQuaternion<N>, 3> {
        names: &SPACE,
        form: space,
        turns: turns3::<N, false>(),
    };
    stage.check(seed);
}

/// Tests that the apex of a cone is its contact point with a box if the normal points up, however
/// small the tilt of the cone's axis.
fn apex<N: Real>() {
    let mut random = Random::new(5);
    let sizes = Vector::<N, 3>::new(N::lit(5.0), N::TWO, N::lit(5.0));
    let (cone, cuboid) = (Cone::new(N::ONE, N::TWO), Cuboid::new(sizes));
    let identity = Isometry3::<N>::identity();
    for lean in (0..17).map(|digits| 10.0_f64.powi(-digits) * 0.1).chain([0.0]) {
        let [x, z] = random.unit_vector::<2>();
        let turn = turned3::<N, false>(Vector::<f64, 3>::new(x, 0.0, z) * lean);
        let tilted = Isometry3::from_parts(identity.translation, turn);
        let found = contact(&tilted, &cone, &identity, &cuboid, N::ZERO).expect("deep");
        let top = if found.normal.y > N::ZERO { N::ONE } else { -N::ONE };
        let expected = tilted * Point::<N, 3>::new(N::ZERO, N::ONE, N::ZERO);
        let off = (found.world1 - expected).norm();
        assert!(
            top < N::ZERO || off <= N::lit(64.0) * N::EPSILON,
            "{lean}: off by {off}: {found:?}"
        );
    }
    let found = contact(&identity, &cone, &identity, &cuboid, N::ZERO).expect("deep");
    assert_eq!(found.normal.y, N::ONE, "up");
    assert_eq!(found.world1, Point::<N, 3>::new(N::ZERO, N::ONE, N::ZERO), "the apex");
}

#[test]
fn the_apex_of_a_cone_touches() {
    apex::<f32>();
    apex::<f64>();
}

#[test]
fn points_lie_on_both_solids_in_the_plane_f32() {
    in_plane::<f32>(1);
}

#[test]
fn points_lie_on_both_solids_in_the_plane_f64() {
    in_plane::<f64>(2);
}

#[test]
fn points_lie_on_both_solids_in_space_f32() {
    in_space::<f32>(3);
}

#[test]
fn points_lie_on_both_solids_in_space_f64() {
    in_space::<f64>(4);
}
