//! Tests that bodies do not bump at the inner edges of meshes.

use avian3d::prelude::*;
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::{Dir3, Quat, Vec3};
use bevy_transform::prelude::*;

use avian_impinge::d3;

use crate::scenes3::{Backend, Impinge, app, dynamic, fixed, place, sheet, steps, velocity};

/// Moves a body along a flat floor, not parallel to the edges of its cells. Returns the largest
/// vertical speed, the largest vertical displacement, and the final speed along x. The 16 steps in
/// which friction turns sliding into rolling do not count.
fn bump<B: Backend>(floor: B::Collider, body: B::Collider, height: f32, friction: f32) -> [f32; 3] {
    let mut app = app::<B>();
    fixed::<B>(&mut app, floor, Vec3::ZERO);
    let body = dynamic::<B>(&mut app, body, Vec3::new(-8.0, height, -1.3));
    let rule = Friction::new(friction).with_combine_rule(CoefficientCombine::Min);
    app.world_mut().entity_mut(body).insert(rule);
    steps(&mut app, 20);
    let along = Vec3::new(4.0, 0.0, 0.7);
    *app.world_mut().get_mut::<LinearVelocity>(body).expect("a body") = LinearVelocity(along);
    // Friction first turns sliding into rolling.
    steps(&mut app, 16);
    let (mut fastest, mut farthest) = (0.0_f32, 0.0_f32);
    for _ in 0..192 {
        steps(&mut app, 1);
        fastest = fastest.max(velocity(&app, body).y.abs());
        farthest = farthest.max((place(&app, body).y - height).abs());
    }
    [fastest, farthest, velocity(&app, body).x]
}

/// Returns the results of [`bump`] for a ball and for a box on a floor.
fn bumps_on<B: Backend>(floor: B::Collider) -> [[f32; 3]; 2] {
    let ball = bump::<B>(floor.clone(), B::sphere(0.5), 0.5, 0.5);
    [ball, bump::<B>(floor, B::cuboid(1.0, 0.6, 0.8), 0.3, 0.0)]
}

/// Returns the results of [`bumps_on`] a mesh and a half-space.
fn bumps<B: Backend>() -> [[[f32; 3]; 2]; 2] {
    [sheet::<B>(40, 0.5, |_, _| 0.0), B::half_space()].map(bumps_on::<B>)
}

#[test]
fn bodies_roll_and_slide_without_bumps() {
    let found = bumps::<Impinge>();
    println!("impinge: {found:?}");
    // Within a step, the solver rotates the contact together with a rolling ball. So the ball hops
    // slightly on any floor.
    let smooth = found[1][0][0];
    for [ball, parcel] in found {
        assert!(ball[0] < 1.1 * smooth && ball[1] < 2e-3, "{ball:?} beside {smooth}");
        assert!((ball[2] - 20.0 / 7.0).abs() < 0.01, "what slides at 4 rolls at 20/7: {ball:?}");
        assert!(parcel[0] < 1e-3 && parcel[1] < 1e-3, "{parcel:?}");
        assert!((parcel[2] - 4.0).abs() < 1e-3, "nothing brakes it: {parcel:?}");
    }
}

#[cfg(feature = "parry")]
#[test]
fn beside_parry() {
    use crate::scenes3::{Parry, grid};

    let found = bumps::<Parry>();
    let (vertices, triangles) = grid(40, 0.5, |_, _| 0.0);
    let plain = bumps_on::<Parry>(Collider::trimesh(vertices, triangles));
    println!("parry: {found:?}, without a flag {plain:?}");
    let all = [found[0], found[1], plain];
    assert!(all.as_flattened().as_flattened().iter().all(|x| x.is_finite()));
}

/// Returns the height of a ground that is flat for x < 0 and rises by one in four for x > 0.
fn ground(x: f32, _: f32) -> f32 {
    0.25 * x.max(0.0)
}

#[derive(Component)]
struct Walker;

/// Moves characters forwards, then down to the ground, by shape casts.
fn walk(
    spatial: d3::SpatialQuery<'_, '_>,
    mut walkers: Query<'_, '_, (Entity, &Walker, &mut Transform)>,
) {
    let (config, shape) = (d3::ShapeCastConfig::default(), d3::Collider::capsule(0.3, 0.8));
    for (entity, _, mut transform) in &mut walkers {
        let filter = SpatialQueryFilter::from_excluded_entities([entity]);
        let up = transform.translation + Vec3::Y * 0.2;
        let cast = |from, direction, config: &_| {
            spatial.cast_shape(&shape, from, Quat::IDENTITY, direction, config, &filter)
        };
        let step = d3::ShapeCastConfig { max_distance: 0.05, ..config };
        let forward = cast(up, Dir3::X, &step).map_or(0.05, |hit| hit.distance);
        let ahead = up + Vec3::X * forward;
        let fall = d3::ShapeCastConfig { max_distance: 0.5, target_distance: 0.01, ..config };
        let down = cast(ahead, Dir3::NEG_Y, &fall).map_or(0.5, |hit| hit.distance);
        transform.translation = ahead - Vec3::Y * down;
    }
}

#[test]
fn a_character_walks_up_a_mesh() {
    let mut app = app::<Impinge>();
    app.add_systems(bevy_app::FixedUpdate, walk);
    fixed::<Impinge>(&mut app, sheet::<Impinge>(40, 0.5, ground), Vec3::ZERO);
    let at = Transform::from_xyz(-4.0, 0.71, 0.1);
    let body = (RigidBody::Kinematic, d3::Collider::capsule(0.3, 0.8), at, Walker);
    let walker = app.world_mut().spawn(body).id();
    let mut last = place(&app, walker);
    for _ in 0..160 {
        steps(&mut app, 1);
        let at = place(&app, walker);
        // The lower half ball touches the slope beside its lowest point. So the capsule is higher
        // above the slope than above flat ground, by r (1/cos - 1).
        let lift = if at.x > 0.3 { 0.3 * (1.0625_f32.sqrt() - 1.0) } else { 0.0 };
        let off = at.y - (0.7 + ground(at.x, at.z) + lift);
        assert!((-0.001..0.03).contains(&off) || at.x < -3.9, "{off} at {at}");
        assert!((at.y - last.y).abs() < 0.05, "no jump from {last} to {at}");
        last = at;
    }
    assert!(last.x > 3.5, "{last}");
}

/// Asserts that a kinematic capsule pushes a dynamic box over a mesh, and that the box stays on the
/// mesh.
#[test]
fn a_kinematic_body_pushes_a_box() {
    let mut app: App = app::<Impinge>();
    fixed::<Impinge>(&mut app, sheet::<Impinge>(40, 0.5, |_, _| 0.0), Vec3::ZERO);
    let parcel =
        dynamic::<Impinge>(&mut app, Impinge::cuboid(0.5, 0.5, 0.5), Vec3::new(0.0, 0.25, 0.1));
    let shape = d3::Collider::capsule(0.3, 0.8);
    let pusher = (RigidBody::Kinematic, shape, Transform::from_xyz(-2.0, 0.72, 0.1));
    let pusher = app.world_mut().spawn((pusher, LinearVelocity(Vec3::X))).id();
    steps(&mut app, 5 * 64);
    let [parcel, pusher] = [parcel, pusher].map(|body| place(&app, body));
    assert!((pusher.x - 3.0).abs() < 0.05, "{pusher}");
    assert!(parcel.x > 3.4 && (parcel.y - 0.25).abs() < 0.02, "{parcel}");
}

/// Tests a body of three balls, each of which lies in a groove with a different slope, so the
/// contacts have six normals. Avian matches the points of successive steps for pairs with at most
/// four manifolds; for pairs with more, the back end does.
#[test]
fn many_manifolds_start_from_their_impulses() {
    let slopes = [0.5_f32, 0.8, 1.2];
    let ground = |_: f32, z: f32| {
        let groove = (((z + 3.0) / 2.0).floor() as usize).min(2);
        let (slope, middle) = (slopes[groove], 2.0 * groove as f32 - 2.0);
        1.0 - 0.5 * (1.0 + slope * slope).sqrt() + slope * (z - middle).abs()
    };
    let mut app = app::<Impinge>();
    fixed::<Impinge>(&mut app, sheet::<Impinge>(24, 0.25, ground), Vec3::ZERO);
    let at = |z: f32| (Vec3::Z * z, Quat::IDENTITY, d3::Collider::sphere(0.5));
    let body = d3::Collider::compound([-2.0, 0.0, 2.0].map(at).to_vec());
    let body = dynamic::<Impinge>(&mut app, body, Vec3::Y);
    steps(&mut app, 120);
    let aside = (place(&app, body) - Vec3::Y).length();
    assert!(aside < 0.02 && velocity(&app, body).length() < 0.01, "{aside}");
    let graph = app.world().resource::<ContactGraph>();
    let pair = graph.iter_active_touching().next().expect("it lies there");
    assert!(pair.manifolds.len() > 4, "{}", pair.manifolds.len());
    for point in pair.manifolds.iter().flat_map(|manifold| &manifold.points) {
        assert!(point.warm_start_normal_impulse > 0.0, "{point:?}");
    }
}
