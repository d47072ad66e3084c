//! Tests laws of every impact: nothing touches before it, the solids touch at it, and the order of
//! the arguments does not matter. Each pair of kinds, in both dimensions and with both scalars, is
//! compared with the distance at many times on the path.

use crate::support::query_support;

use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Point, Real, Space, Vector, max};
use impinge::query::{
    ConstantVelocities, Impact, ImpactOptions, ImpactStatus, Moving, RigidMotion, contact, impact,
    nonlinear_time_of_impact,
};
use impinge::shape::{Compound, Shape, ShapeHandle, ShapeKind};
use query_support::random::Random;
use query_support::samples::{PLANE, SPACE, Sample, sample2, sample3};

/// Number of pairs tested for each two kinds.
const SEEDS: u64 = 6;

/// Number of steps into which a path is divided; each step gives times at which the distance is
/// computed.
const LOOKS: u32 = 48;

/// Functions that make random solids, rotations and motions of one dimension.
struct Maker<N: Space<D>, R, const D: usize> {
    sample: Sample<N, D>,
    turn: fn(&mut Random) -> R,
    spin: fn(&N::Isometry, &Vector<N, D>, &mut Random, N) -> ConstantVelocities<N, D>,
}

/// Two shapes and their motions.
struct Scene<N: Space<D>, const D: usize> {
    shapes: [Box<dyn Shape<N, D>>; 2],
    positions: [N::Isometry; 2],
    velocities: [Vector<N, D>; 2],
    motions: [ConstantVelocities<N, D>; 2],
    options: ImpactOptions<N>,
    what: String,
}

/// Parameters of a scene.
#[derive(Clone, Copy, Debug)]
struct Setting {
    kinds: [ShapeKind; 2],
    seed: u64,
    /// Scale of the random angular velocities, in radians per unit of time.
    turn: f64,
}

impl<N, R, const D: usize> Maker<N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy,
{
    fn make(&self, setting: &Setting) -> Scene<N, D> {
        let random = &mut Random(setting.seed ^ 0xca57, false);
        let origin = random.vector::<N, D>();
        let shapes = setting.kinds.map(|kind| (self.sample)(kind, random, N::ONE));
        let away = random.direction::<N, D>() * N::lit(5.0);
        let places =
            [origin, origin + away].map(|at| Isometry::from_parts(at.into(), (self.turn)(random)));
        // One body moves towards the other or past it, and both drift.
        let drift = random.vector::<N, D>() * N::lit(0.5);
        let aim = away + random.vector::<N, D>() * N::lit(2.0);
        let velocities = [drift + aim, drift + random.vector::<N, D>() * N::lit(0.25)];
        let motions = [0, 1].map(|index| {
            (self.spin)(&places[index], &velocities[index], random, N::lit(setting.turn))
        });
        let target = N::lit([0.0, 0.0, 0.25][usize::try_from(setting.seed % 3).expect("small")]);
        let options = ImpactOptions::new().with_max_time(N::TWO).with_target_distance(target);
        let what = format!("{setting:?}");
        Scene { shapes, positions: places, velocities, motions, options, what }
    }
}

impl<N, R, const D: usize> Scene<N, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy,
    ConstantVelocities<N, D>: RigidMotion<N, D>,
{
    /// Returns the signed distance of the shapes at two poses, minus the target distance.
    fn gap(&self, m1: &Isometry<N, R, D>, m2: &Isometry<N, R, D>) -> N {
        let found = contact(m1, &*self.shapes[0], m2, &*self.shapes[1], N::INFINITY);
        found.map_or(-N::INFINITY, |found| -found.depth) - self.options.target_distance
    }

    fn straight(&self, time: N) -> N {
        let [m1, m2] = [0, 1].map(|index| {
            let mut place = self.positions[index];
            place.translation.vector += self.velocities[index] * time;
            place
        });
        self.gap(&m1, &m2)
    }

    fn extent(&self) -> N {
        let sizes = [0, 1].map(|index| {
            let shape = &self.shapes[index];
            let reach = |map: &dyn impinge::shape::SupportMap<N, D>| map.reach() + map.rounding();
            shape.geometry().as_support_map().map_or(N::ONE, reach)
                + self.positions[index].translation.vector.norm()
        });
        sizes[0] + sizes[1] + N::lit(8.0)
    }

    /// Asserts that nothing touches before the impact and that the solids touch at it; `noise` is
    /// the rounding error allowed in distances. Returns `true` if the solids are apart at the start
    /// and their impact has the status `Reached`.
    fn check(&self, found: Option<&Impact<N, D>>, gap: &dyn Fn(N) -> N, noise: N) -> bool {
        let what = &self.what;
        let end = found.map_or(self.options.max_time, |found| found.toi);
        assert!(end >= N::ZERO && end <= self.options.max_time, "{end} {what}");
        let start = gap(N::ZERO);
        let is_at_start = found.is_some_and(|found| found.status.is_at_start());
        assert!(!is_at_start || end == N::ZERO, "{found:?} {what}");
        if start <= noise {
            // The policy decides whether a start in contact is an impact, but its status is
            // determined.
            let is_named = found.is_none_or(|found| found.toi > N::ZERO || is_at_start);
            assert!(is_named, "{found:?} starts at {start} {what}");
            let status = found.map(|found| found.status);
            let is_deep = is_at_start && start < -noise;
            assert!(
                !is_deep || status == Some(ImpactStatus::PenetratingAtStart),
                "{status:?} {what}"
            );
            return false;
        }
        assert!(!is_at_start, "{found:?} starts at {start} {what}");
        for look in 0..LOOKS {
            let share = N::lit(f64::from(look) / f64::from(LOOKS));
            // Samples the whole path, and more densely near its end.
            for time in [end * share, end * (N::ONE - share * share * share)] {
                let before = gap(time);
                assert!(before > -noise, "{before} at {time}, before {found:?} {what}");
            }
        }
        let Some(found) = found else { return false };
        assert_eq!((found.part1, found.part2), (0, 0), "{what}");
        let reached = found.status == ImpactStatus::Reached;
        let last = gap(end);
        assert!(!reached || last.abs() <= noise, "{last} at the end {found:?} {what}");
        let way = found.world2 - found.world1;
        let along = found.normal.dot(&way);
        assert!((found.normal.norm() - N::ONE).abs() < N::EPSILON * N::lit(32.0), "{what}");
        let expected = last + self.options.target_distance;
        assert!((along - expected).abs() <= noise, "{along}, not {expected} {what}");
        assert!((way.norm() - expected).abs() <= noise, "{way:?}, not {expected} long {what}");
        reached
    }

    fn linear(&self) -> bool {
        let [one, two] = [0, 1].map(|index| {
            Moving::new(&self.positions[index], &self.velocities[index], &*self.shapes[index])
        });
        let found = impact(&one, &two, &self.options);
        let swapped = impact(&two, &one, &self.options).map(|found| found.flipped());
        assert_eq!(found, swapped, "{}", self.what);
        assert!(
            found.is_none_or(|found| found.status != ImpactStatus::StepsSpent),
            "{}",
            self.what
        );
        self.check(found.as_ref(), &|time| self.straight(time), self.noise())
    }

    /// Returns the error allowed in distances, which covers the larger rounding errors of curved
    /// solids.
    fn noise(&self) -> N {
        max(N::EPSILON * N::lit(1024.0), N::lit(1e-9)) * self.extent()
    }

    /// Tests the laws for bodies that also rotate; `told` boxes their motions. Returns the status
    /// of the impact; `None` without an impact.
    fn turning(&self, setting: &Setting, told: Told<N, D>) -> Option<ImpactStatus> {
        let [one, two] = self.motions.map(told);
        let [shape1, shape2] = &self.shapes;
        // Without tolerance: the default of a millionth of the sizes would accept a gap where
        // bounds are loose.
        let options = self.options.with_tolerance(N::ZERO);
        let found = nonlinear_time_of_impact(&*one, &**shape1, &*two, &**shape2, &options);
        let swapped = nonlinear_time_of_impact(&*two, &**shape2, &*one, &**shape1, &options);
        assert_eq!(found, swapped.map(|found| found.flipped()), "{}", self.what);
        let noise = self.noise() * N::lit(1.0 + setting.turn * 0.1);
        self.check(found.as_ref(), &|time| self.gap_at(time), noise);
        found.map(|found| found.status)
    }

    fn gap_at(&self, time: N) -> N {
        let [one, two] = &self.motions;
        self.gap(&one.position_at(time), &two.position_at(time))
    }
}

/// A function that boxes a motion, either as it is or wrapped in [`Opaque`].
type Told<N, const D: usize> = fn(ConstantVelocities<N, D>) -> Box<dyn RigidMotion<N, D>>;

/// A motion reduced to the required methods of the trait, its positions and bounds. So no closed
/// form for its type can be used.
struct Opaque<M>(M);

impl<N: Space<D>, M: RigidMotion<N, D>, const D: usize> RigidMotion<N, D> for Opaque<M> {
    fn position_at(&self, time: N) -> N::Isometry {
        self.0.position_at(time)
    }

    fn speed_bound(&self, from: N, to: N) -> N {
        self.0.speed_bound(from, to)
    }

    fn turn_bound(&self, from: N, to: N) -> N {
        self.0.turn_bound(from, to)
    }

    fn local_center(&self) -> Point<N, D> {
        self.0.local_center()
    }
}

/// Tests the laws for straight and rotating motions of all pairs of kinds. Asserts that many of the
/// motions have an impact, and that few searches are given up.
fn laws<N, R, const D: usize>(kinds: &[ShapeKind], maker: &Maker<N, R, D>)
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy,
    ConstantVelocities<N, D>: RigidMotion<N, D>,
{
    let (mut scenes, mut straight, mut turning, mut spent) = (0, 0, [0; 2], [0; 2]);
    let known: Told<N, D> = |motion| Box::new(motion);
    let opaque: Told<N, D> = |motion| Box::new(Opaque(motion));
    for (kind1, kind2) in kinds.iter().flat_map(|k1| kinds.iter().map(move |k2| (*k1, *k2))) {
        for seed in 0..SEEDS {
            let turn = [0.5, 4.0, 60.0][usize::try_from(seed % 3).expect("small")];
            let setting = Setting { kinds: [kind1, kind2], seed, turn };
            let scene = maker.make(&setting);
            scenes += 1;
            straight += u32::from(scene.linear());
            for (count, told) in [known, opaque].into_iter().enumerate() {
                match scene.turning(&setting, told) {
                    Some(ImpactStatus::StepsSpent) => spent[count] += 1,
                    Some(_) => turning[count] += 1,
                    None => {}
                }
            }
        }
    }
    assert!(straight > scenes / 4, "{straight} of {scenes}");
    assert!(turning.iter().all(|&hits| hits > scenes / 4), "{turning:?} of {scenes}");
    assert!(spent[0] < scenes / 50 && spent[1] < scenes / 10, "{spent:?} of {scenes} given up");
}

/// Places two solids so that they touch, or are at the target distance, with a known normal, and
/// moves the second solid back along its path. Asserts that the impact has the time of that path
/// and the known normal, both for the solid and for a composite with the solid as its only part.
///
/// Until then, the planes perpendicular to the normal at the nearest points separate the solids, so
/// there is no earlier impact. At least one of the solids is round, or the target distance is
/// positive, so that the normal is unique.
fn known_normals<N, R, const D: usize>(kinds: &[ShapeKind], maker: &Maker<N, R, D>)
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy,
{
    let (mut tried, mut worst) = (0, (N::ZERO, String::new()));
    for kinds in kinds.iter().flat_map(|k1| kinds.iter().map(move |k2| [*k1, *k2])) {
        for seed in 0..SEEDS {
            let random = &mut Random(seed ^ 0x9017, false);
            let shapes = kinds
                .map(|kind| ShapeHandle::from_arc((maker.sample)(kind, random, N::ONE).into()));
            let turns = [0; 2].map(|_| (maker.turn)(random));
            let normal = random.direction::<N, D>();
            let touches = seed % 3 > 0 && kinds.iter().any(|kind| is_round(*kind));
            let target = N::lit(if touches { 0.0 } else { 0.25 });
            let Some(touch1) = outermost(&*shapes[0], &turns[0], &normal) else { continue };
            let Some(touch2) = outermost(&*shapes[1], &turns[1], &-normal) else { continue };
            let toward = -normal + random.vector::<N, D>() * N::lit(0.75);
            let time = N::lit(random.within(0.5, 3.0));
            let m1 = Isometry::from_parts((-touch1).into(), turns[0]);
            let m2 =
                Isometry::from_parts((normal * target - touch2 - toward * time).into(), turns[1]);
            let compound = Compound::new(vec![(Isometry::identity(), shapes[1].clone())]);
            let seconds: [&dyn Shape<N, D>; 2] = [&*shapes[1], &compound];
            for second in seconds {
                let (one, two) =
                    (Moving::still(&m1, &*shapes[0]), Moving::new(&m2, &toward, second));
                let options = ImpactOptions::new().with_target_distance(target);
                let found = impact(&one, &two, &options).expect("on the way");
                assert!((found.toi - time).abs() < N::lit(1e-4), "{found:?} at {time} {kinds:?}");
                let off = (found.normal.into_inner() - normal).norm() / N::EPSILON;
                if off > worst.0 {
                    worst = (off, format!("{kinds:?} {seed} {found:?}"));
                }
                tried += 1;
            }
        }
    }
    assert!(tried > 1000, "{tried}");
    assert!(worst.0 < N::lit(1024.0), "epsilon off: {worst:?}");
}

/// Returns `true` if the solid has a unique normal at each of its points.
fn is_round(kind: ShapeKind) -> bool {
    use ShapeKind::{Ball, Capsule, Ellipsoid, Rounded, SupportMap, TaperedCapsule};
    matches!(kind, Ball | Capsule | Ellipsoid | Rounded | SupportMap | TaperedCapsule)
}

/// Returns the outermost point of a rotated solid in a direction; `None` for half-spaces.
fn outermost<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    turn: &R,
    toward: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let map = shape.geometry().as_support_map()?;
    let core = map.core_support(&turn.inverse_transform_vector(toward));
    Some(turn.transform_vector(&core.coords) + toward * map.rounding())
}

fn plane<N: Real>() -> Maker<N, UnitComplex<N>, 2> {
    Maker {
        sample: sample2,
        turn: Random::turn2,
        spin: |place, linear, random, turn| {
            let center = random.vector::<N, 2>() * N::HALF;
            ConstantVelocities::<N, 2>::new(*place, *linear, turn * N::lit(random.signed()))
                .with_local_center(center.into())
        },
    }
}

fn space<N: Real>() -> Maker<N, UnitQuaternion<N>, 3> {
    Maker {
        sample: sample3,
        turn: Random::turn3,
        spin: |place, linear, random, turn| {
            let center = random.vector::<N, 3>() * N::HALF;
            ConstantVelocities::<N, 3>::new(*place, *linear, random.vector::<N, 3>() * turn)
                .with_local_center(center.into())
        },
    }
}

#[test]
fn normals_are_those_of_the_time_found() {
    known_normals(&PLANE, &plane::<f32>());
    known_normals(&PLANE, &plane::<f64>());
    known_normals(&SPACE, &space::<f32>());
    known_normals(&SPACE, &space::<f64>());
}

#[test]
fn in_the_plane_f32() {
    laws(&PLANE, &plane::<f32>());
}

#[test]
fn in_the_plane_f64() {
    laws(&PLANE, &plane::<f64>());
}

#[test]
fn in_space_f32() {
    laws(&SPACE, &space::<f32>());
}

#[test]
fn in_space_f64() {
    laws(&SPACE, &space::<f64>());
}
