//! Tests contact ids in a world, and the contacts that kinematics predict for the next step.

use crate::support::samples::samples;
use crate::support::scene_stage;

use std::collections::BTreeMap;

use impinge::math::na::{Translation, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Real, Unit, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, GeometricQueryType};
use impinge::query::{Contact, ContactId, ContactKinematic, TrackedContact};
use impinge::shape::{Ball, Capsule, Cuboid, Plane, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_scenes::{Placement, SceneShape, mixed_shapes, pile, spawn_and_despawn};
use scene_stage::{Play, Player, shape_of};

pub(super) type World<N, const D: usize> = CollisionWorld<N, D, ()>;

pub(super) fn cuboid<N: Real, const D: usize>(half: [f64; D]) -> ShapeHandle<N, D> {
    ShapeHandle::new(Cuboid::new(Vector::<N, D>::from_fn(|axis, _| N::lit(half[axis]))))
}

/// Returns the pose at `x` along the floor and at `height`, rotated about `axis`. `tangent` is the
/// tangent of half the rotation angle.
fn pose<N: Play<D>, const D: usize>(
    x: f64,
    height: f64,
    (axis, tangent): ([f64; 3], f64),
) -> N::Isometry {
    let mut translation = [0.0; D];
    (translation[0], translation[1]) = (x, height);
    N::pose_of(&Placement { translation, axis, tangent }, 1.0)
}

const UP: [f64; 3] = [0.0, 1.0, 0.0];
pub(super) const ACROSS: [f64; 3] = [0.0, 0.0, 1.0];

/// A world after its first update, with a cube that rests on a floor; the floor is added first or
/// last.
struct Floor<N: Play<D>, const D: usize> {
    world: World<N, D>,
    floor: CollisionObjectHandle,
    cube: CollisionObjectHandle,
}

impl<N: Play<D>, const D: usize> Floor<N, D> {
    fn new(floor: &ShapeHandle<N, D>, is_floor_first: bool) -> Self {
        let mut world = World::<N, D>::new(N::lit(0.02));
        let query = GeometricQueryType::Contacts(N::lit(0.05), N::ZERO);
        let mut add = |x: f64, height: f64, shape: ShapeHandle<N, D>| {
            let at = pose::<N, D>(x, height, (ACROSS, 0.0));
            world.add(at, shape, CollisionGroups::new(), query, ())
        };
        let (floor, cube) = if is_floor_first {
            (add(0.0, -2.0, floor.clone()), add(-3.0, 0.49, cuboid([0.5; D])))
        } else {
            let cube = add(-3.0, 0.49, cuboid([0.5; D]));
            (add(0.0, -2.0, floor.clone()), cube)
        };
        world.update();
        Self { world, floor, cube }
    }

    fn contacts(&self) -> Vec<TrackedContact<N, D>> {
        contacts_of(&self.world, self.floor, self.cube)
    }

    fn ids(&self) -> Vec<ContactId> {
        self.contacts().iter().map(|tracked| tracked.id).collect()
    }
}

pub(super) fn contacts_of<N: Play<D>, const D: usize>(
    world: &World<N, D>,
    handle1: CollisionObjectHandle,
    handle2: CollisionObjectHandle,
) -> Vec<TrackedContact<N, D>> {
    let mut manifolds = Vec::new();
    if let Some(pair) = world.contact_pair(handle1, handle2) {
        pair.contacts(&mut manifolds);
    }
    manifolds.iter().flat_map(|manifold| manifold.contacts()).copied().collect()
}

/// Returns a box of half height 2 and a half-space. Placed at height -2, the upper face of the box
/// is at height 0, and the surface of the half-space at height -2.
fn floors<N: Play<D>, const D: usize>() -> [ShapeHandle<N, D>; 2] {
    let mut half = [20.0; D];
    half[1] = 2.0;
    let high = Plane::new(Unit::new_unchecked(Vector::<N, D>::from_fn(|axis, _| {
        if axis == 1 { N::ONE } else { N::ZERO }
    })));
    [cuboid(half), ShapeHandle::new(high)]
}

/// Asserts that contact ids persist for a thousand steps while the cube slides, sinks and rises,
/// and rotates.
fn names_last<N: Play<D>, const D: usize>(turn: impl Fn(f64) -> ([f64; 3], f64)) {
    for (index, shape) in floors::<N, D>().iter().enumerate() {
        // The origin of the half-space is on its surface; the origin of the box is 2 below its
        // upper face.
        let lift = if index == 0 { 0.0 } else { -2.0 };
        for is_floor_first in [true, false] {
            let mut scene = Floor::<N, D>::new(shape, is_floor_first);
            let place = |step: f64| {
                let rise = 0.02 * (step - 2.0 * (step / 40.0).floor() * 20.0 - 20.0).abs() / 20.0;
                pose::<N, D>(-3.0 + 0.006 * step, lift + 0.48 + rise, turn(step))
            };
            scene.world.set_position(scene.cube, place(0.0));
            scene.world.update();
            let first = scene.ids();
            assert_eq!(first.len(), 1 << (D - 1), "a face of the cube");
            for step in 1..=1000 {
                scene.world.set_position(scene.cube, place(f64::from(step)));
                scene.world.update();
                assert_eq!(scene.ids(), first, "floor {index}, step {step}");
            }
        }
    }
}

#[test]
fn names_outlast_a_thousand_steps() {
    let sliding = |_| (ACROSS, 0.0);
    names_last::<f32, 2>(sliding);
    names_last::<f64, 2>(sliding);
    names_last::<f32, 3>(sliding);
    names_last::<f64, 3>(sliding);
    // Rocks the cube by half a degree to both sides.
    let rocking = |step: f64| (ACROSS, 0.0045 * ((step / 50.0) % 4.0 - 2.0).abs() - 0.0045);
    names_last::<f32, 2>(rocking);
    names_last::<f64, 2>(rocking);
    names_last::<f32, 3>(rocking);
    names_last::<f64, 3>(rocking);
    // Rotates slowly by 143 degrees. In 2D there is no rotation about the vertical.
    let spinning = |step: f64| (UP, 0.003 * step);
    names_last::<f32, 3>(spinning);
    names_last::<f64, 3>(spinning);
}

fn names_outlast_shapes<N: Play<D>, const D: usize>() {
    let [floor, _] = floors::<N, D>();
    let mut scene = Floor::<N, D>::new(&floor, true);
    let first = scene.ids();
    for half in [0.505, 0.51, 0.5] {
        scene.world.set_shape(scene.cube, cuboid([half; D]));
        scene.world.update();
        assert_eq!(scene.ids(), first, "the corners are still there");
        assert_eq!(scene.world.contact_events(), [], "nothing began or ended");
    }
    let mut wide = [21.0; D];
    wide[1] = 2.0;
    scene.world.set_shape(scene.floor, cuboid(wide));
    scene.world.update();
    assert_eq!(scene.ids(), first, "so is the face");
    scene.world.set_shape(scene.cube, ShapeHandle::new(Ball::new(N::HALF)));
    scene.world.update();
    assert_eq!(scene.world.contact_events(), [], "they touch as before");
    let round = scene.ids();
    assert_eq!(round.len(), 1, "at one point");
    assert!(!first.contains(&round[0]), "which is no corner");
}

/// Asserts that contacts that begin again have new ids, whether or not the broad phase kept the
/// pair in between.
fn names_end_with_contacts<N: Play<D>, const D: usize>() {
    let [floor, _] = floors::<N, D>();
    let mut scene = Floor::<N, D>::new(&floor, false);
    let (floor, cube) = (scene.floor, scene.cube);
    let pair = (floor.min(cube), floor.max(cube));
    let mut seen = scene.ids();
    let near = pose::<N, D>(0.0, 0.49, (ACROSS, 0.0));
    // The first height is so small that the broad phase keeps the pair; at the other two it drops
    // the pair.
    for height in [0.7, 3.0, 1e6] {
        scene.world.set_position(cube, pose::<N, D>(0.0, height, (ACROSS, 0.0)));
        scene.world.update();
        assert_eq!(
            scene.world.contact_events(),
            [ContactEvent::Stopped(pair.0, pair.1)],
            "at {height}"
        );
        scene.world.set_position(cube, near);
        scene.world.update();
        assert_eq!(
            scene.world.contact_events(),
            [ContactEvent::Started(pair.0, pair.1)],
            "at {height}"
        );
        let names = scene.ids();
        assert!(names.iter().all(|name| !seen.contains(name)), "new names at {height}");
        seen.extend(names);
    }
    let area = GeometricQueryType::Proximity(N::ZERO);
    let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    for query in [area, contacts] {
        scene.world.set_query_type(cube, query);
        scene.world.update();
    }
    let names = scene.ids();
    assert_eq!(names.len(), 1 << (D - 1), "a face again");
    assert!(names.iter().all(|name| !seen.contains(name)), "new names after proximity");
}

#[test]
fn names_follow_features_and_touch() {
    names_outlast_shapes::<f32, 2>();
    names_outlast_shapes::<f64, 2>();
    names_outlast_shapes::<f32, 3>();
    names_outlast_shapes::<f64, 3>();
    names_end_with_contacts::<f32, 2>();
    names_end_with_contacts::<f64, 2>();
    names_end_with_contacts::<f32, 3>();
    names_end_with_contacts::<f64, 3>();
}

type Pair = (CollisionObjectHandle, CollisionObjectHandle);

/// Asserts that a contact id belongs to one pair and is never used again after its contact ended.
fn names_are_unique<N: Play<D>, const D: usize>() {
    for scene in [spawn_and_despawn(400), mixed_shapes(300), pile(100)] {
        let mut player = Player::<N, D>::new(scene, 1.0);
        let mut seen: BTreeMap<ContactId, (Pair, usize)> = BTreeMap::new();
        let (mut returned, steps) = (0, samples(6).min(40));
        for step in 0..steps {
            player.step();
            for (object1, object2, manifold) in player.world.contact_manifolds() {
                let pair = (object1.handle(), object2.handle());
                for tracked in manifold.contacts() {
                    let (known, last) = *seen.entry(tracked.id).or_insert((pair, step));
                    assert_eq!(known, pair, "{:?} is the name of two", tracked.id);
                    assert!(step - last < 2, "{:?} came back", tracked.id);
                    returned += usize::from(step > last);
                    seen.insert(tracked.id, (pair, step));
                }
            }
        }
        let is_lively = 2 * seen.len() > 25 * steps && returned > 25 * steps;
        assert!(is_lively, "{} names in {steps} steps, {returned}", seen.len());
    }
}

#[test]
fn names_are_never_given_twice() {
    names_are_unique::<f32, 2>();
    names_are_unique::<f64, 2>();
    names_are_unique::<f32, 3>();
    names_are_unique::<f64, 3>();
}

/// Moves poses and predicts contacts. Both need the isometry type of the dimension.
trait Move<const D: usize>: Play<D> {
    /// Returns the pose after a motion for `time` with a linear velocity and an angular velocity
    /// about its origin.
    fn moved(at: &Self::Isometry, motion: &([f64; D], [f64; 3]), time: f64) -> Self::Isometry;

    fn predict(
        kinematic: &ContactKinematic<Self, D>,
        poses: &[Self::Isometry; 2],
    ) -> Contact<Self, D>;
}

fn step_of<N: Real, const D: usize>(velocity: &[f64; D], time: f64) -> Translation<N, D> {
    Translation::from(Vector::<N, D>::from_fn(|axis, _| N::lit(velocity[axis] * time)))
}

impl<N: Real> Move<2> for N {
    fn moved(at: &Isometry2<N>, motion: &([f64; 2], [f64; 3]), time: f64) -> Isometry2<N> {
        let turn = UnitComplex::new(N::lit(motion.1[2] * time)) * at.rotation;
        Isometry2::from_parts(step_of(&motion.0, time) * at.translation, turn)
    }

    fn predict(k: &ContactKinematic<N, 2>, [m1, m2]: &[Isometry2<N>; 2]) -> Contact<N, 2> {
        k.contact(m1, m2)
    }
}

impl<N: Real> Move<3> for N {
    fn moved(at: &Isometry3<N>, motion: &([f64; 3], [f64; 3]), time: f64) -> Isometry3<N> {
        let axis = Vector::<N, 3>::from_fn(|axis, _| N::lit(motion.1[axis] * time));
        let turn = UnitQuaternion::new(axis) * at.rotation;
        Isometry3::from_parts(step_of(&motion.0, time) * at.translation, turn)
    }

    fn predict(k: &ContactKinematic<N, 3>, [m1, m2]: &[Isometry3<N>; 2]) -> Contact<N, 3> {
        k.contact(m1, m2)
    }
}

/// Two solids in contact, with the motion of each.
struct Case<N: Play<D>, const D: usize> {
    name: &'static str,
    shapes: [ShapeHandle<N, D>; 2],
    poses: [N::Isometry; 2],
    motions: [([f64; D], [f64; 3]); 2],
}

impl<N: Move<D>, const D: usize> Case<N, D> {
    /// Returns two contacts at `time` for each contact that lasts: the prediction from time zero,
    /// and the contact computed at `time`. Sorted by descending depth at time zero.
    fn predicted(&self, time: f64) -> Vec<[Contact<N, D>; 2]> {
        let mut world = World::<N, D>::new(N::lit(0.02));
        let query = GeometricQueryType::Contacts(N::lit(0.1), N::ZERO);
        let [first, second] = [0, 1].map(|n| {
            world.add(self.poses[n], self.shapes[n].clone(), CollisionGroups::new(), query, ())
        });
        world.update();
        let mut before = contacts_of(&world, first, second);
        before.sort_by(|a, b| b.contact.depth.as_f64().total_cmp(&a.contact.depth.as_f64()));
        let poses = [0, 1].map(|n| N::moved(&self.poses[n], &self.motions[n], time));
        world.set_positions(&[(first, poses[0]), (second, poses[1])]);
        world.update();
        let after = contacts_of(&world, first, second);
        let both = before.iter().filter_map(|tracked| {
            let now = after.iter().find(|now| now.id == tracked.id)?;
            Some([N::predict(&tracked.kinematic, &poses), now.contact])
        });
        let both: Vec<_> = both.collect();
        assert!(!both.is_empty(), "{}: no contact stays", self.name);
        both
    }

    /// Asserts that predictions are exact for points, lines and planes fixed to their solids, up to
    /// `loss`, the error of the computed contacts.
    fn check_exact(&self, loss: f64) {
        for time in [0.08, 0.04, 0.02] {
            for [predicted, found] in self.predicted(time) {
                let [depth, points] = differences(&predicted, &found);
                let fine = depth + points <= loss;
                assert!(fine, "{}: {predicted:?} {found:?} after {time}", self.name);
            }
        }
    }

    /// Asserts that the prediction error of the deepest contact is of second order: halving the
    /// time divides it by four in the limit, and by at least three here. Returns whether the errors
    /// exceed rounding.
    fn check_second_order(&self) -> bool {
        let rounding = 256.0 * N::EPSILON.as_f64();
        let errors = [0.08, 0.04, 0.02].map(|time| {
            let [predicted, found] = self.predicted(time)[0];
            differences(&predicted, &found)[0]
        });
        for two in errors.windows(2) {
            let fine = two[1] * 3.0 <= two[0] || two[1] <= rounding;
            assert!(fine, "{}: {errors:?}", self.name);
        }
        assert!(errors[0] < 0.2, "{}: {errors:?}", self.name);
        errors[0] > rounding
    }
}

fn differences<N: Real, const D: usize>(a: &Contact<N, D>, b: &Contact<N, D>) -> [f64; 2] {
    let points = (a.world1 - b.world1).norm() + (a.world2 - b.world2).norm();
    let normals = (a.normal.into_inner() - b.normal.into_inner()).norm();
    [((a.depth - b.depth).abs() + normals).as_f64(), points.as_f64()]
}

fn motion<const D: usize>(seed: u32) -> ([f64; D], [f64; 3]) {
    let number = |n: usize| f64::from((seed * 7 + u32::try_from(n).expect("small") * 5) % 11);
    let velocity = std::array::from_fn(|axis| (number(axis) - 5.0) / 10.0);
    let spin = [0, 1, 2].map(|axis| (number(axis + 3) - 5.0) / 10.0);
    (velocity, spin)
}

/// Asserts that the contacts predicted by kinematics are exact up to rounding, for all kinds of
/// features that exist in both dimensions.
fn kinematics_predict<N: Move<D>, const D: usize>() {
    let turned = (ACROSS, 0.1);
    let level = (ACROSS, 0.0);
    let [floor, plane] = floors::<N, D>();
    let cube = cuboid::<N, D>([0.5; D]);
    let capsule = ShapeHandle::new(Capsule::new(N::HALF, N::lit(0.25)));
    let ball = || ShapeHandle::new(Ball::<N>::new(N::HALF));
    let at = |x: f64, height: f64, turn| pose::<N, D>(x, height, turn);
    let origin = at(0.0, -2.0, level);
    let rounding = 256.0 * N::EPSILON.as_f64();
    for seed in 1..12 {
        let motions = [motion(seed), motion(seed + 20)];
        let case = |name, shape1: &ShapeHandle<N, D>, pose1, shape2: &ShapeHandle<N, D>, pose2| {
            let shapes = [shape1.clone(), shape2.clone()];
            let poses = [pose1, pose2];
            Case::<N, D> { name, shapes, poses, motions }.check_exact(rounding);
        };
        case("ball and box", &floor, origin, &ball(), at(1.0, 0.47, level));
        case("ball and plane", &plane, at(0.0, 0.0, level), &ball(), at(1.0, 0.53, level));
        case("ball and ball", &ball(), at(0.0, 0.0, level), &ball(), at(0.6, 0.75, level));
        case("ball and corner", &cube, at(0.0, 0.0, level), &ball(), at(0.85, 0.85, level));
        case("corner and plane", &plane, at(0.0, 0.0, level), &cube, at(0.0, 0.6, turned));
        case("corner and box", &floor, origin, &cube, at(0.0, 0.59, turned));
        case("tip and box", &floor, origin, &capsule, at(0.0, 0.73, turned));
        case("side and ball", &capsule, at(0.0, 0.0, turned), &ball(), at(0.73, 0.0, level));
    }
}

#[test]
fn kinematics_of_flat_and_round_solids_are_exact() {
    kinematics_predict::<f32, 2>();
    kinematics_predict::<f64, 2>();
    kinematics_predict::<f32, 3>();
    kinematics_predict::<f64, 3>();
}

/// Asserts in 3D that predictions are exact up to rounding for crossing edges and up to half of the
/// digits for crossed cylinders, and that errors for rims are of second order in time.
fn kinematics_predict_in_space<N: Move<3>>() {
    let cylinder = SceneShape::Cylinder { half_height: 0.5, radius: 0.25 };
    let (cube, cylinder) = (cuboid::<N, 3>([0.5; 3]), shape_of::<N, 3>(&cylinder, 1.0));
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    let eighth = 0.414_213_562_373_095_05;
    let edge1 = (ACROSS, eighth);
    let edge2 = ([1.0, 0.0, 0.0], eighth);
    let [_, plane] = floors::<N, 3>();
    let cone = shape_of::<N, 3>(&SceneShape::Cone { half_height: 0.5, radius: 0.5 }, 1.0);
    let mut measured = 0;
    for seed in 1..12 {
        let motions = [motion(seed), motion(seed + 20)];
        let at = |x: f64, height: f64, turn| pose::<N, 3>(x, height, turn);
        let poses = [at(0.0, 0.0, edge1), at(0.0, 2.0 * diagonal - 0.02, edge2)];
        Case { name: "edges", shapes: [cube.clone(), cube.clone()], poses, motions }
            .check_exact(256.0 * N::EPSILON.as_f64());
        let poses = [at(0.0, 0.0, (ACROSS, 1.0)), at(0.0, 0.48, ([1.0, 0.0, 0.0], 0.8))];
        let shapes = [cylinder.clone(), cylinder.clone()];
        // The search determines contact points on curved solids to half of the digits.
        let loss = 8.0 * N::EPSILON.as_f64().sqrt();
        Case { name: "crossed cylinders", shapes, poses, motions }.check_exact(loss);
        // The solids stand tilted on their rims. The lowest point of a rim moves along it as the
        // solid rotates.
        for (name, shape) in [("rim of a cylinder", &cylinder), ("rim of a cone", &cone)] {
            let poses = [at(0.0, 0.0, (ACROSS, 0.0)), at(0.0, 0.55, (ACROSS, 0.2))];
            let shapes = [plane.clone(), shape.clone()];
            measured += usize::from(Case { name, shapes, poses, motions }.check_second_order());
            let (poses, shapes) = ([poses[1], poses[0]], [shape.clone(), plane.clone()]);
            measured += usize::from(Case { name, shapes, poses, motions }.check_second_order());
        }
    }
    assert!(measured > 22, "{measured} of 44 cases are of second order, the others exact");
}

#[test]
fn kinematics_are_right_to_second_order() {
    kinematics_predict_in_space::<f32>();
    kinematics_predict_in_space::<f64>();
}
