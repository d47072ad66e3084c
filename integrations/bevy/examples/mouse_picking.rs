//! Picking with a mouse: a ray from a camera through the pixel of the cursor finds the foremost entity. Pixels are
//! drawn as text, one ray each, so the example needs no window.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d3::prelude::*;
use bevy_math::{Dir3, Quat, Ray3d, Vec2, Vec3};
use bevy_transform::prelude::*;

const COLUMNS: u16 = 60;
const ROWS: u16 = 20;

/// Returns the ray through a cursor position, with coordinates from 0 to 1, as
/// `Camera::viewport_to_world` does with a window.
fn through(cursor: Vec2) -> Ray3d {
    let eye = Vec3::new(0.0, 2.0, 10.0);
    let on_screen = Vec3::new(4.0 * (cursor.x - 0.5), 2.5 * (0.5 - cursor.y), -4.0);
    Ray3d::new(eye, Dir3::new(on_screen).expect("the screen is in front of the eye"))
}

fn main() {
    let mut app = App::new();
    app.add_plugins(ImpingePlugin::default().in_schedule(Update));
    let turned = Quat::from_rotation_y(0.7);
    let things = [
        (
            "B",
            Collider::cuboid(2.0, 2.0, 2.0),
            Transform::from_xyz(-3.0, 1.0, 0.0).with_rotation(turned),
        ),
        ("S", Collider::sphere(1.25), Transform::from_xyz(1.0, 1.25, 1.0)),
        ("C", Collider::cylinder(1.0, 4.0), Transform::from_xyz(2.5, 2.0, -2.0)),
        (".", Collider::half_space(Vec3::Y), Transform::IDENTITY),
    ];
    let named = things
        .map(|(name, collider, at)| app.world_mut().spawn((Name::new(name), collider, at)).id());
    app.update();

    let collisions = app.world().resource::<Collisions>();
    let pick = |cursor: Vec2| collisions.cast_ray(through(cursor), 100.0, &SpatialFilter::new());
    let name = |entity| app.world().get::<Name>(entity).map_or(" ", |name| name.as_str());
    for row in 0..ROWS {
        let pixel = |column: u16| {
            let cursor =
                Vec2::new(f32::from(column) / f32::from(COLUMNS), f32::from(row) / f32::from(ROWS));
            pick(cursor).map_or(" ", |hit| name(hit.entity))
        };
        println!("{}", (0..COLUMNS).map(pixel).collect::<String>());
    }

    let picked = pick(Vec2::new(0.62, 0.55)).expect("something is there");
    println!("under the cursor: {} at {:.2}", name(picked.entity), picked.point);
    assert_eq!(picked.entity, named[1], "the sphere is before the cylinder");
    let centre = Vec3::new(1.0, 1.25, 1.0);
    assert!(((picked.point - centre).length() - 1.25).abs() < 1e-4, "on its surface");
    assert!((picked.normal - (picked.point - centre) / 1.25).length() < 1e-3, "and its normal");
    let sky = pick(Vec2::new(0.5, 0.0));
    assert!(sky.is_none(), "the sky is empty: {sky:?}");
}
