//! Tests that bodies do not bump at the inner corners of polylines and of areas of triangles.

use avian_impinge::d2;
use avian2d::prelude::*;
use bevy_app::FixedUpdate;
use bevy_ecs::prelude::*;
use bevy_math::{Dir2, Vec2};
use bevy_transform::prelude::*;

use crate::scenes2::{Backend, Impinge, app, dynamic, fixed, line, place, steps, strip, velocity};

/// Moves a body along a flat floor. Returns the largest vertical speed, the largest vertical
/// displacement, and the final speed along x. The 16 steps in which friction turns sliding into
/// rolling do not count.
fn bump<B: Backend>(floor: B::Collider, body: B::Collider, height: f32, friction: f32) -> [f32; 3] {
    let mut app = app::<B>();
    fixed::<B>(&mut app, floor, Vec2::ZERO);
    let body = dynamic::<B>(&mut app, body, Vec2::new(-8.0, height));
    let rule = Friction::new(friction).with_combine_rule(CoefficientCombine::Min);
    app.world_mut().entity_mut(body).insert(rule);
    steps(&mut app, 20);
    *app.world_mut().get_mut::<LinearVelocity>(body).expect("a body") =
        LinearVelocity(Vec2::X * 4.0);
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

/// Returns the results of [`bump`] for a ball and for a box, on a polyline, on an area of
/// triangles, and on a half-plane.
fn bumps<B: Backend>() -> [[[f32; 3]; 2]; 3] {
    let floors = [line::<B>(40, 0.5, |_| 0.0), strip::<B>(40, 0.5), B::half_space()];
    floors.map(|floor| {
        let ball = bump::<B>(floor.clone(), B::circle(0.5), 0.5, 0.5);
        [ball, bump::<B>(floor, B::rectangle(1.0, 0.6), 0.3, 0.0)]
    })
}

#[test]
fn bodies_roll_and_slide_without_bumps() {
    let found = bumps::<Impinge>();
    println!("impinge: {found:?}");
    // Within a step, the solver rotates the contact together with a rolling disk. So the disk hops
    // slightly on any floor.
    let smooth = found[2][0][0];
    for [ball, parcel] in found {
        assert!(ball[0] < 1.1 * smooth && ball[1] < 2e-3, "{ball:?} beside {smooth}");
        assert!((ball[2] - 8.0 / 3.0).abs() < 0.01, "what slides at 4 rolls at 8/3: {ball:?}");
        assert!(parcel[0] < 1e-3 && parcel[1] < 1e-3, "{parcel:?}");
        assert!((parcel[2] - 4.0).abs() < 1e-3, "nothing brakes it: {parcel:?}");
    }
}

#[cfg(feature = "parry")]
#[test]
fn beside_parry() {
    let found = bumps::<crate::scenes2::Parry>();
    println!("parry: {found:?}");
    assert!(found.as_flattened().as_flattened().iter().all(|x| x.is_finite()));
}

#[derive(Component)]
struct Walker;

/// Moves characters forwards, then down to the ground, by shape casts.
fn walk(
    spatial: d2::SpatialQuery<'_, '_>,
    mut walkers: Query<'_, '_, (Entity, &mut Transform), With<Walker>>,
) {
    let (config, shape) = (d2::ShapeCastConfig::default(), d2::Collider::capsule(0.3, 0.8));
    for (entity, mut transform) in &mut walkers {
        let filter = SpatialQueryFilter::from_excluded_entities([entity]);
        let cast = |from: Vec2, direction, config: &_| {
            spatial.cast_shape(&shape, from, 0.0, direction, config, &filter)
        };
        let up = transform.translation.truncate() + Vec2::Y * 0.2;
        let step = d2::ShapeCastConfig { max_distance: 0.05, ..config };
        let ahead = up + Vec2::X * cast(up, Dir2::X, &step).map_or(0.05, |hit| hit.distance);
        let fall = d2::ShapeCastConfig { max_distance: 0.5, target_distance: 0.01, ..config };
        let down = cast(ahead, Dir2::NEG_Y, &fall).map_or(0.5, |hit| hit.distance);
        transform.translation = (ahead - Vec2::Y * down).extend(0.0);
    }
}

#[test]
fn a_character_walks_up_a_line() {
    let mut app = app::<Impinge>();
    app.add_systems(FixedUpdate, walk);
    let ground = |x: f32| 0.25 * x.max(0.0);
    fixed::<Impinge>(&mut app, line::<Impinge>(40, 0.5, ground), Vec2::ZERO);
    let at = Transform::from_xyz(-4.0, 0.71, 0.0);
    let body = (RigidBody::Kinematic, d2::Collider::capsule(0.3, 0.8), at, Walker);
    let walker = app.world_mut().spawn(body).id();
    let mut last = place(&app, walker);
    for _ in 0..160 {
        steps(&mut app, 1);
        let at = place(&app, walker);
        assert!((at.y - last.y).abs() < 0.05, "no jump from {last} to {at}");
        last = at;
    }
    // The lower half disk touches the slope beside its lowest point. So the capsule is higher above
    // the slope than above flat ground, by r (1/cos - 1).
    let off = last.y - (0.7 + ground(last.x) + 0.3 * (1.0625_f32.sqrt() - 1.0));
    assert!(last.x > 3.5 && (-0.001..0.03).contains(&off), "{off} at {last}");
}
