//! Tests composites in worlds: manifolds per patch, contact ids, events, one-sided and two-sided
//! surfaces, angular predictions, and shapes that touch themselves or are deformed.

use crate::support::scene_stage;
use crate::support::slides;

use impinge::dim2::shape::Polyline as Polyline2;
use impinge::math::na::{Translation3, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, GeometricQueryType};
use impinge::query::{ContactManifold, Proximity, TrackedContact};
use impinge::shape::{Ball, Compound, Cuboid, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld, WorldError};
use scene_stage::assert_views_agree;
use slides::{PATTERNS, Pattern, Random, grid};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

fn v<N: Real>(x: f64, y: f64, z: f64) -> Vector<N, 3> {
    Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

fn at<N: Real>(x: f64, y: f64, z: f64) -> Isometry3<N> {
    Isometry3::from_parts(Translation3::from(v(x, y, z)), UnitQuaternion::identity())
}

fn turned<N: Real>(place: [f64; 3], axis: [f64; 3]) -> Isometry3<N> {
    let turn = UnitQuaternion::from_scaled_axis(v(axis[0], axis[1], axis[2]));
    Isometry3::from_parts(Translation3::from(v(place[0], place[1], place[2])), turn)
}

fn cube<N: Real + Space<3>>(half: f64) -> ShapeHandle<N, 3> {
    ShapeHandle::new(Cuboid::new(v(half, half, half)))
}

/// A world whose contact queries have the prediction 0.02.
struct Stage<N: Space<D>, const D: usize> {
    world: World<N, D>,
}

impl<N: Space<D>, const D: usize> Stage<N, D> {
    fn new() -> Self {
        Self { world: World::new(N::lit(0.02)) }
    }

    fn add(&mut self, pose: N::Isometry, shape: ShapeHandle<N, D>) -> CollisionObjectHandle {
        let query = GeometricQueryType::Contacts(N::lit(0.01), N::ZERO);
        self.world.add(pose, shape, CollisionGroups::new(), query, ())
    }

    fn update(&mut self) {
        self.world.update();
        self.world.validate().expect("sound");
    }

    fn manifolds(
        &self,
        a: CollisionObjectHandle,
        b: CollisionObjectHandle,
    ) -> Vec<ContactManifold<N, D>> {
        let Some(pair) = self.world.contact_pair(a, b) else { return Vec::new() };
        let (mut out, counted) = (Vec::new(), pair.num_contacts());
        pair.contacts(&mut out);
        assert_eq!(counted, out.iter().map(|one| one.len()).sum::<usize>(), "all are counted");
        assert_views_agree(&self.world);
        let listed = self.world.contact_manifolds();
        let listed = listed.filter(|(first, second, _)| {
            [first.handle(), second.handle()] == [a, b]
                || [second.handle(), first.handle()] == [a, b]
        });
        let listed: Vec<_> = listed.map(|(_, _, manifold)| manifold.clone()).collect();
        let out: Vec<_> = out.into_iter().cloned().collect();
        assert_eq!(listed, out, "both ways to read agree");
        out
    }

    fn contacts(
        &self,
        a: CollisionObjectHandle,
        b: CollisionObjectHandle,
    ) -> Vec<TrackedContact<N, D>> {
        self.manifolds(a, b).iter().flat_map(|manifold| manifold.contacts().to_vec()).collect()
    }
}

#[test]
fn a_box_on_a_floor_of_200_triangles_is_one_manifold_of_four_points() {
    for pattern in PATTERNS {
        for is_floor_first in [false, true] {
            let mut stage = Stage::<f32, 3>::new();
            let floor = ShapeHandle::new(grid::<f32>(10, 0.3, [0.0; 3], pattern, |_, _| 0.0));
            let place = turned([0.1, 0.49, -0.07], [0.0, 0.3, 0.0]);
            let (floor, cube) = if is_floor_first {
                (stage.add(at(0.0, 0.0, 0.0), floor), stage.add(place, cube(0.5)))
            } else {
                let cube = stage.add(place, cube(0.5));
                (stage.add(at(0.0, 0.0, 0.0), floor), cube)
            };
            stage.update();
            let manifolds = stage.manifolds(floor, cube);
            assert_eq!(manifolds.len(), 1, "{pattern:?}: one patch");
            assert_eq!(manifolds[0].len(), 4, "{pattern:?}: four points");
            let up = if is_floor_first { 1.0 } else { -1.0 };
            for tracked in manifolds[0].contacts() {
                let contact = &tracked.contact;
                assert!((contact.depth - 0.01).abs() < 1e-6, "{pattern:?}: {contact:?}");
                assert_eq!(contact.normal.y, up, "{pattern:?}: {contact:?}");
                let on_cube = if is_floor_first { contact.world2 } else { contact.world1 };
                let local = place.inverse_transform_point(&on_cube);
                let is_corner = (local.x.abs() - 0.5).abs() + (local.z.abs() - 0.5).abs() < 1e-4;
                assert!(is_corner, "{pattern:?}: {local}");
                let (own, other) = if is_floor_first {
                    (tracked.part1, tracked.part2)
                } else {
                    (tracked.part2, tracked.part1)
                };
                assert_eq!(other, 0, "the box is its own part");
                assert!(own < 200, "a triangle of the floor");
            }
        }
    }
}

#[test]
fn names_last_while_parts_and_features_do() {
    let mut stage = Stage::<f64, 3>::new();
    let floor = grid::<f64>(10, 1.0, [0.0; 3], Pattern::Slash, |_, _| 0.0);
    let floor = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(floor));
    // From this position on, none of the four lower corners of the cube leaves its triangle of the
    // floor.
    let cube = stage.add(at(0.35, 0.49, 0.12), cube(0.9));
    stage.world.set_position(cube, at(0.35, 0.89, 0.12));
    stage.update();
    let ids = |stage: &Stage<f64, 3>| -> Vec<_> {
        stage.contacts(floor, cube).iter().map(|tracked| tracked.id).collect()
    };
    let before = ids(&stage);
    assert_eq!(before.len(), 4, "four corners");
    for step in 0..5 {
        let moved = f64::from(step) * 0.004;
        stage.world.set_position(cube, turned([0.35 + moved, 0.89, 0.12], [0.0, 0.1 * moved, 0.0]));
        stage.update();
        assert_eq!(ids(&stage), before, "step {step}");
    }
    stage.world.set_position(cube, at(0.35, 0.93, 0.12));
    stage.update();
    assert!(ids(&stage).is_empty(), "lifted off");
    assert_eq!(stage.world.contact_events(), [ContactEvent::Stopped(floor, cube)], "told");
    stage.world.set_position(cube, at(0.35, 0.89, 0.12));
    stage.update();
    assert_eq!(stage.world.contact_events(), [ContactEvent::Started(floor, cube)], "told");
    assert!(ids(&stage).iter().all(|id| !before.contains(id)), "new contacts have new names");
}

/// Returns a surface of two planes that meet along z and rise outwards with these slopes: a valley,
/// or a roof for negative slopes.
fn fold(left: f64, right: f64) -> TriMesh<f64, 3> {
    let slope = move |x: f64, _: f64| if x < 0.0 { -x * left } else { x * right };
    grid::<f64>(12, 0.5, [0.0; 3], Pattern::Zigzag, slope)
}

#[test]
fn a_ball_in_a_valley_touches_both_slopes() {
    let mut stage = Stage::<f64, 3>::new();
    let valley = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(fold(1.0, 1.0)));
    let root = std::f64::consts::SQRT_2;
    for z in [0.0, 0.13, -0.4] {
        let ball = stage.add(at(0.0, root * 0.5 - 0.01, z), ShapeHandle::new(Ball::new(0.5)));
        stage.update();
        let manifolds = stage.manifolds(valley, ball);
        assert_eq!(manifolds.len(), 2, "{manifolds:?}");
        for manifold in &manifolds {
            let contact = manifold.contacts()[0].contact;
            assert!((contact.normal.x.abs() - 0.5 * root).abs() < 1e-9, "{contact:?}");
            assert!((contact.depth - 0.01 / root).abs() < 1e-9, "{contact:?}");
        }
        stage.world.remove(&[ball]);
    }
}

#[test]
fn a_ball_rolls_over_a_ridge_without_a_jump() {
    let mut stage = Stage::<f64, 3>::new();
    let roof = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(fold(-0.5, -0.5)));
    let ball = stage.add(at(9.0, 0.0, 0.0), ShapeHandle::new(Ball::new(0.5)));
    let steep = (1.0_f64 + 0.25).sqrt();
    let mut last: Option<Vector<f64, 3>> = None;
    for step in -100..=100 {
        // The centre of the ball keeps the distance 0.49 from the roof.
        let s = f64::from(step) * 0.01;
        let turn = 0.49 * 0.5_f64.atan();
        let (x, y, normal_x) = if s.abs() <= turn {
            let angle = s / 0.49;
            (0.49 * angle.sin(), 0.49 * angle.cos(), angle.sin())
        } else {
            let along = s.abs() - turn;
            let (sine, cosine) = (0.5 / steep, 1.0 / steep);
            let x = 0.49 * sine + along * cosine;
            (x * s.signum(), 0.49 * cosine - along * sine, sine * s.signum())
        };
        stage.world.set_position(ball, at(x, y, 0.21));
        stage.update();
        let contacts = stage.contacts(roof, ball);
        assert_eq!(contacts.len(), 1, "step {step}: {contacts:?}");
        let contact = contacts[0].contact;
        assert!((contact.depth - 0.01).abs() < 1e-9, "step {step}: {contact:?}");
        assert!((contact.normal.x - normal_x).abs() < 1e-6, "step {step}: {contact:?}, {normal_x}");
        if let Some(last) = last {
            assert!((last - *contact.normal).norm() < 0.03, "step {step}: a jump");
        }
        last = Some(*contact.normal);
    }
}

/// Returns a plateau with a wall down to the floor: two right angles, one convex and one concave.
fn cliff() -> TriMesh<f64, 3> {
    let mesh = grid::<f64>(16, 0.5, [0.0; 3], Pattern::Zigzag, |_, _| 0.0);
    let profile = |x: f64| -> [f64; 2] {
        // The profile along x: the top, the wall from 0 down to -2, the floor.
        if x <= 0.0 {
            [x, 0.0]
        } else if x <= 2.0 {
            [0.0, -x]
        } else {
            [x - 2.0, -2.0]
        }
    };
    let vertices = mesh.vertices().iter().map(|p| {
        let [x, y] = profile(p.x);
        Point::<f64, 3>::new(x, y, p.z)
    });
    TriMesh::new(vertices.collect(), mesh.triangles().to_vec())
}

#[test]
fn a_box_pushed_over_a_cliff_is_never_deep_in_the_wall() {
    for is_one_sided in [false, true] {
        for tilt in [0.0_f64, 0.02, -0.02] {
            let mesh = if is_one_sided { cliff().one_sided() } else { cliff() };
            let mut stage = Stage::<f64, 3>::new();
            let cliff = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(mesh));
            let cube = stage.add(at(-2.0, 0.49, 0.1), cube(0.5));
            for step in 0..160 {
                let x = f64::from(step) * 0.0131 - 1.6;
                let rise = 0.49 + tilt.abs() * 0.5;
                stage.world.set_position(cube, turned([x, rise, 0.13], [0.0, 0.2, tilt]));
                stage.update();
                let contacts = stage.contacts(cliff, cube);
                if x < -0.1 {
                    assert!(!contacts.is_empty(), "on the top at {x}");
                }
                for tracked in contacts {
                    let contact = tracked.contact;
                    let label =
                        format!("one-sided {is_one_sided}, tilt {tilt}, x {x}: {contact:?}");
                    assert!(contact.depth < 0.0101 + 2.0 * tilt.abs(), "{label}");
                    assert!(x >= -0.1 || contact.normal.y > 0.99, "{label}");
                }
            }
        }
    }
}

#[test]
fn a_box_in_a_corner_touches_each_wall() {
    let mut stage = Stage::<f64, 3>::new();
    let cliff = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(cliff()));
    let cube = stage.add(at(0.48, -1.51, 0.1), cube(0.5));
    stage.update();
    let manifolds = stage.manifolds(cliff, cube);
    assert_eq!(manifolds.len(), 2, "{manifolds:?}");
    for manifold in &manifolds {
        let contact = manifold.deepest_contact().expect("not empty").contact;
        let (across, up) = (contact.normal.x, contact.normal.y);
        if up > 0.5 {
            assert!((contact.depth - 0.01).abs() < 1e-9 && up == 1.0, "{contact:?}");
        } else {
            assert!((contact.depth - 0.02).abs() < 1e-9 && across == 1.0, "{contact:?}");
        }
        assert_eq!(manifold.len(), 4, "{manifold:?}");
    }
}

#[test]
fn one_side_and_two() {
    let floor = || grid::<f64>(8, 0.5, [0.0; 3], Pattern::Slash, |_, _| 0.0);
    // The winding of the grid decides whether its front faces up. A one-sided grid lets bodies pass
    // from the back.
    for (shape, is_one_sided) in [(floor(), false), (floor().one_sided(), true)] {
        let front = shape.normal(0).expect("an area").y;
        let mut stage = Stage::<f64, 3>::new();
        let floor = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(shape));
        for side in [1.0, -1.0] {
            let ball = stage.add(at(0.1, side * 0.49, 0.2), ShapeHandle::new(Ball::new(0.5)));
            stage.update();
            let contacts = stage.contacts(floor, ball);
            if is_one_sided && side != front {
                assert!(contacts.is_empty(), "from behind: {contacts:?}");
            } else {
                assert_eq!(contacts.len(), 1, "side {side}: {contacts:?}");
                assert_eq!(contacts[0].contact.normal.y, side, "side {side}: {contacts:?}");
            }
            stage.world.remove(&[ball]);
        }
    }
}

#[test]
fn a_solid_pushed_halfway_through_stays_on_its_side() {
    let floor = grid::<f64>(8, 0.5, [0.0; 3], Pattern::Random, |_, _| 0.0);
    let mut stage = Stage::<f64, 3>::new();
    let floor = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(floor));
    for shape in [ShapeHandle::new(Ball::new(0.5)), cube(0.5)] {
        let solid = stage.add(at(0.1, 0.45, 0.2), shape);
        for step in 0..20 {
            let y = 0.45 - f64::from(step) * 0.041;
            stage.world.set_position(solid, at(0.1 + 0.02 * f64::from(step), y, 0.2));
            stage.update();
            let contacts = stage.contacts(floor, solid);
            assert!(!contacts.is_empty(), "step {step}, y {y}");
            for tracked in contacts {
                let contact = tracked.contact;
                assert!((contact.normal.y - 1.0).abs() < 1e-9, "step {step}: {contact:?}");
            }
        }
        stage.world.remove(&[solid]);
    }
}

#[test]
fn a_ball_rolls_round_the_border_of_a_sheet() {
    let sheet = grid::<f64>(4, 0.5, [0.0; 3], Pattern::Slash, |_, _| 0.0);
    let mut stage = Stage::<f64, 3>::new();
    let sheet = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(sheet));
    let ball = stage.add(at(0.0, 9.0, 0.0), ShapeHandle::new(Ball::new(0.3)));
    for step in -60..=60 {
        let (radius, s) = (0.299, f64::from(step) * 0.02);
        let turn = std::f64::consts::FRAC_PI_2 * radius;
        let (x, y) = if s.abs() <= turn {
            let angle = s / radius;
            (1.0 + radius * angle.cos(), radius * angle.sin())
        } else {
            (1.0 - (s.abs() - turn), radius * s.signum())
        };
        stage.world.set_position(ball, at(x, y, 0.11));
        stage.update();
        let contacts = stage.contacts(sheet, ball);
        assert_eq!(contacts.len(), 1, "step {step}: {contacts:?}");
        let contact = contacts[0].contact;
        assert!((contact.depth - 0.001).abs() < 1e-9, "step {step}: {contact:?}");
    }
}

#[test]
fn kinematics_foretell_small_motions_to_second_order() {
    let hill = |x: f64, z: f64| 0.3 * x + 0.1 * z;
    let floor_shape = ShapeHandle::new(grid::<f64>(8, 0.7, [0.0; 3], Pattern::Zigzag, hill));
    let up = Vector::<f64, 3>::new(-0.3, 1.0, -0.1).normalize();
    let turn = UnitQuaternion::rotation_between(&Vector::y(), &up).expect("not opposite");
    let mut errors = Vec::new();
    for size in [1e-2, 1e-3] {
        let mut stage = Stage::<f64, 3>::new();
        let place = Isometry3::from_parts(Translation3::from(up * 0.395), turn);
        let frame = turned([3.0, 1.0, -2.0], [0.3, -0.2, 0.5]);
        let floor = stage.add(frame, floor_shape.clone());
        let cube = stage.add(frame * place, cube(0.4));
        stage.update();
        let before = stage.contacts(floor, cube);
        assert!(before.len() >= 4, "{before:?}");
        for tracked in &before {
            let same = tracked.kinematic.contact(&frame, &(frame * place));
            assert!((same.world1 - tracked.contact.world1).norm() < 1e-9, "itself");
            assert!((same.depth - tracked.contact.depth).abs() < 1e-9, "itself");
        }
        let nudge = turned([size, 0.3 * size, -size], [size, -size, 0.5 * size]);
        let sway = turned([size, size, 0.0], [0.0, size, size]);
        let (frame2, place2) = (frame * sway, frame * place * nudge);
        stage.world.set_position(floor, frame2);
        stage.world.set_position(cube, place2);
        stage.update();
        let after = stage.contacts(floor, cube);
        let mut worst: f64 = 0.0;
        for new in &after {
            let Some(old) = before.iter().find(|old| old.id == new.id) else { continue };
            let moved = old.kinematic.contact(&frame2, &place2);
            worst = worst.max((moved.depth - new.contact.depth).abs());
            worst = worst.max((*moved.normal - *new.contact.normal).norm());
        }
        errors.push(worst);
    }
    assert!(errors[0] < 50.0 * 1e-4 && errors[1] < 50.0 * 1e-6, "second order: {errors:?}");
}

#[test]
fn a_hundred_boxes_on_hills() {
    let play = || {
        let mut random = Random::new(2);
        let mut stage = Stage::<f32, 3>::new();
        let hill = |x: f64, z: f64| 0.2 * ((x * 1.3).sin() + (z * 0.9).cos());
        let hills = ShapeHandle::new(grid::<f32>(30, 0.5, [0.0; 3], Pattern::Random, hill));
        let hills = stage.add(at(0.0, 0.0, 0.0), hills);
        let boxes: Vec<_> = (0..100)
            .map(|i| {
                let (x, z) = (f64::from(i % 10) - 4.5, f64::from(i / 10) - 4.5);
                stage.add(at(x, hill(x, z) + 0.35, z), cube(0.3))
            })
            .collect();
        let (mut seen, mut log) = (std::collections::BTreeMap::new(), Vec::new());
        for step in 0..10 {
            for &handle in &boxes {
                let old = *stage.world.collision_object(handle).expect("alive").position();
                let nudge = turned(
                    [random.unit() * 0.02, -0.008, random.unit() * 0.02],
                    [random.unit() * 0.02, 0.0, random.unit() * 0.02],
                );
                stage.world.set_position(handle, nudge * old);
            }
            stage.update();
            for (a, b, manifold) in stage.world.contact_manifolds() {
                for tracked in manifold.contacts() {
                    let pair = (a.handle(), b.handle());
                    let known = seen.entry(tracked.id).or_insert(pair);
                    assert_eq!(*known, pair, "step {step}: a name of two pairs");
                    log.push((tracked.id, tracked.contact.depth.to_bits()));
                }
            }
            let mut all: Vec<_> = stage
                .world
                .contact_manifolds()
                .flat_map(|(_, _, manifold)| manifold.contacts().to_vec())
                .map(|tracked| tracked.id)
                .collect();
            let count = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), count, "step {step}: no name twice at a time");
        }
        let touching = boxes.iter().filter(|&&handle| {
            stage.world.contact_pair(hills, handle).is_some_and(|pair| pair.num_contacts() > 0)
        });
        assert!(touching.count() > 60, "most boxes lie on the hills");
        log
    };
    assert_eq!(play(), play(), "the same bits");
}

#[test]
fn compounds_meet_compounds_and_meshes() {
    let pieces = |offset: f64| -> ShapeHandle<f64, 3> {
        let children = vec![
            (at(-0.5 - offset, 0.0, 0.0), cube::<f64>(0.25)),
            (at(0.5, 0.0, 0.0), ShapeHandle::new(Ball::new(0.25))),
        ];
        ShapeHandle::new(Compound::<f64, 3>::new(children))
    };
    let mut stage = Stage::<f64, 3>::new();
    let floor = ShapeHandle::new(grid::<f64>(10, 0.4, [0.0; 3], Pattern::Soup, |_, _| 0.0));
    let floor = stage.add(at(0.0, 0.0, 0.0), floor);
    let lower = stage.add(at(0.0, 0.24, 0.0), pieces(0.0));
    let upper = stage.add(at(0.0, 0.73, 0.0), pieces(0.0));
    stage.update();
    let on_floor = stage.manifolds(floor, lower);
    assert_eq!(on_floor.iter().map(ContactManifold::len).sum::<usize>(), 4, "one patch of both");
    assert_eq!(on_floor.len(), 1, "{on_floor:?}");
    for tracked in on_floor[0].contacts() {
        assert!((tracked.contact.depth - 0.01).abs() < 1e-9, "{tracked:?}");
    }
    let between = stage.contacts(lower, upper);
    assert!(between.len() >= 4, "{between:?}");
    for tracked in &between {
        assert_eq!(tracked.part1, tracked.part2, "alike on alike");
        assert!((tracked.contact.depth - 0.01).abs() < 1e-9, "{tracked:?}");
        assert!((tracked.contact.normal.y - 1.0).abs() < 1e-9, "{tracked:?}");
    }
}

#[test]
fn meshes_lie_on_meshes() {
    let mut stage = Stage::<f64, 3>::new();
    let floor = ShapeHandle::new(grid::<f64>(10, 0.4, [0.0; 3], Pattern::Random, |_, _| 0.0));
    let plate = ShapeHandle::new(grid::<f64>(5, 0.3, [0.0; 3], Pattern::Zigzag, |_, _| 0.0));
    let floor = stage.add(at(0.0, 0.0, 0.0), floor);
    let plate = stage.add(turned([0.05, 0.004, 0.02], [0.0, 0.3, 0.0]), plate);
    stage.update();
    let manifolds = stage.manifolds(floor, plate);
    assert_eq!(manifolds.len(), 1, "{manifolds:#?}");
    assert_eq!(manifolds[0].len(), 4, "{manifolds:?}");
    for tracked in manifolds[0].contacts() {
        assert!((tracked.contact.depth + 0.004).abs() < 1e-9, "{tracked:?}");
        assert!((tracked.contact.normal.y - 1.0).abs() < 1e-9, "{tracked:?}");
    }
}

fn rope(height: f64) -> Vec<Point<f64, 2>> {
    // A line to the right and back again, `height` above the first half.
    let out = (0..8).map(|i| Point::<f64, 2>::new(f64::from(i) * 0.5, 0.0));
    let back = (0..8).rev().map(|i| Point::<f64, 2>::new(f64::from(i) * 0.5 + 0.2, height));
    out.chain(back).collect()
}

#[test]
fn a_rope_touches_itself() {
    let mut groups = CollisionGroups::new();
    let contacts = GeometricQueryType::Contacts(0.01, 0.0);
    let mut world = CollisionWorld::<f64, 2, ()>::new(0.02);
    let shape = ShapeHandle::new(Polyline2::<f64>::open(rope(0.015)));
    let handle = world.add(
        Isometry2::new(Vector::<f64, 2>::new(3.0, 1.0), 0.4),
        shape,
        groups,
        contacts,
        (),
    );
    world.update();
    assert!(world.contact_pair(handle, handle).is_none(), "not asked for");
    groups.enable_self_collision();
    world.set_collision_groups(handle, groups);
    world.update();
    world.validate().expect("sound");
    assert_eq!(world.contact_events(), [ContactEvent::Started(handle, handle)], "it began");
    let pairs: Vec<_> = world.contact_pairs().map(|(a, b, _)| (a.handle(), b.handle())).collect();
    assert_eq!(pairs, [(handle, handle)], "listed");
    for (_, _, manifold) in world.contact_manifolds() {
        for tracked in manifold.contacts() {
            assert!((tracked.contact.depth + 0.015).abs() < 1e-9, "{tracked:?}");
            assert!(tracked.part1 < tracked.part2, "each pair of parts once");
        }
    }
    let ids = |world: &CollisionWorld<f64, 2, ()>| -> Vec<_> {
        let manifolds = world.contact_manifolds();
        manifolds.flat_map(|(_, _, m)| m.contacts().to_vec()).map(|t| t.id).collect()
    };
    let before = ids(&world);
    world.deform(handle, |line: &mut Polyline2<f64>| line.set_vertices(&rope(0.012)));
    assert_eq!(ids(&world), before, "the last update's until the next");
    world.update();
    assert!(world.contact_events().is_empty(), "it goes on");
    assert_eq!(ids(&world), before, "under the same names");
    world.deform(handle, |line: &mut Polyline2<f64>| line.set_vertices(&rope(0.5)));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Stopped(handle, handle)], "unfolded");
    world.deform(handle, |line: &mut Polyline2<f64>| line.set_vertices(&rope(0.0)));
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Started(handle, handle)], "folded flat");
    groups.disable_self_collision();
    world.set_collision_groups(handle, groups);
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Stopped(handle, handle)], "forbidden");
    groups.enable_self_collision();
    world.set_collision_groups(handle, groups);
    world.set_query_type(handle, GeometricQueryType::Proximity(0.01));
    world.update();
    let near = world.proximity_pair(handle, handle).map(|pair| pair.proximity());
    assert_eq!(near, Some(Proximity::Intersecting), "flat on itself");
    world.remove(&[handle]);
    world.update();
    assert_eq!(world.proximity_events().len(), 1, "it is over");
    world.validate().expect("sound");
}

#[test]
fn removal_and_exchange_of_phases_with_pairs_of_one() {
    let mut groups = CollisionGroups::new();
    groups.enable_self_collision();
    let contacts = GeometricQueryType::Contacts(0.01, 0.0);
    let mut world = CollisionWorld::<f64, 2, ()>::new(0.02);
    let add = |world: &mut CollisionWorld<f64, 2, ()>| {
        let shape = ShapeHandle::new(Polyline2::<f64>::open(rope(0.015)));
        world.add(Isometry2::identity(), shape, groups, contacts, ())
    };
    let first = add(&mut world);
    // A convex solid never touches itself.
    let ball = ShapeHandle::new(Ball::new(0.5));
    world.add(Isometry2::translation(9.0, 9.0), ball, groups, contacts, ());
    world.update();
    assert_eq!(world.contact_events(), [ContactEvent::Started(first, first)], "one of the two");
    world.set_narrow_phase(Box::new(impinge::dim2::narrow_phase::DefaultNarrowPhase::new()));
    world.update();
    world.validate().expect("sound");
    assert!(world.contact_events().is_empty(), "nothing changed");
    assert!(world.contact_pair(first, first).is_some(), "known to the new one");
    let broad = impinge::broad_phase::DBVTBroadPhase::new(0.02);
    world.set_broad_phase(Box::new(broad));
    world.update();
    world.validate().expect("sound");
    assert!(world.contact_events().is_empty(), "nothing changed");
    world.remove(&[first]);
    let again = add(&mut world);
    world.update();
    let (gone, new) = (ContactEvent::Stopped(first, first), ContactEvent::Started(again, again));
    assert_eq!(world.contact_events(), [gone, new], "one ends, another begins");
}

#[test]
fn deforming_what_cannot_be_deformed() {
    let contacts = GeometricQueryType::Contacts(0.01, 0.0);
    let mut world = CollisionWorld::<f64, 2, ()>::new(0.02);
    let ball = ShapeHandle::new(Ball::new(0.5));
    let ball = world.add(Isometry2::identity(), ball, CollisionGroups::new(), contacts, ());
    let result = world.try_deform(ball, |_: &mut Polyline2<f64>| panic!("not called"));
    assert_eq!(result, Err(WorldError::ShapeType(ball)), "another type");
    world.remove(&[ball]);
    let result = world.try_deform(ball, |_: &mut Ball<f64>| panic!("not called"));
    assert_eq!(result, Err(WorldError::StaleHandle(ball)), "gone");
}

#[test]
fn a_wave_lifts_a_box_that_keeps_its_names() {
    let mesh = grid::<f64>(6, 1.0, [0.0; 3], Pattern::Slash, |_, _| 0.0);
    let mut stage = Stage::<f64, 3>::new();
    let floor = stage.add(at(0.0, 0.0, 0.0), ShapeHandle::new(mesh.clone()));
    let other = stage.add(at(50.0, 0.0, 0.0), ShapeHandle::new(mesh.clone()));
    let cube = stage.add(at(0.3, 0.895, 0.12), cube(0.9));
    stage.update();
    let before: Vec<_> = stage.contacts(floor, cube).iter().map(|tracked| tracked.id).collect();
    assert_eq!(before.len(), 4, "at rest");
    let raised: Vec<_> = mesh.vertices().iter().map(|p| p + Vector::y() * 0.01).collect();
    stage.world.deform(floor, |mesh: &mut TriMesh<f64, 3>| mesh.set_vertices(&raised));
    stage.update();
    let after = stage.contacts(floor, cube);
    let names: Vec<_> = after.iter().map(|tracked| tracked.id).collect();
    assert_eq!(names, before, "the same contacts");
    assert!(after.iter().all(|t| (t.contact.depth - 0.015).abs() < 1e-9), "deeper: {after:?}");
    let shape = stage.world.collision_object(other).expect("alive").shape();
    let shape = shape.as_shape::<TriMesh<f64, 3>>().expect("a mesh");
    assert_eq!(shape.vertices(), mesh.vertices(), "others keep theirs");
}

#[test]
fn points_that_turning_brings_near_lie_on_other_parts() {
    // A tilted box: one side touches, and the other comes down when the box rotates.
    let lean = turned([0.05, 0.5, 0.1], [0.0, 0.0, 0.02]);
    let floor = ShapeHandle::new(grid::<f64>(10, 0.3, [0.0; 3], Pattern::Slash, |_, _| 0.0));
    let mut stage = Stage::<f64, 3>::new();
    let floor = stage.add(at(0.0, 0.0, 0.0), floor);
    let cube = stage.add(lean, cube(0.5));
    for (angle, is_wide) in [(0.0, false), (0.05, true)] {
        stage.world.set_query_type(cube, GeometricQueryType::Contacts(0.0, angle));
        stage.world.set_query_type(floor, GeometricQueryType::Contacts(0.001, 0.0));
        stage.update();
        let manifolds = stage.manifolds(floor, cube);
        assert_eq!((manifolds.len(), manifolds[0].len()), (1, 4), "{manifolds:?}");
        let across = |tracked: &TrackedContact<f64, 3>| {
            lean.inverse_transform_point(&tracked.contact.world2).x
        };
        let highest = manifolds[0].contacts().iter().map(across).fold(-1.0, f64::max);
        assert_eq!(highest > 0.499, is_wide, "angle {angle}: {manifolds:?}");
    }
}
