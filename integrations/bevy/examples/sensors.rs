//! An automatic door: observers of a sensor count the visitors, and the door is open while there is
//! any.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d2::prelude::*;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

#[derive(Component, Default)]
struct Door {
    visitors: u32,
}

#[derive(Component)]
struct Visitor {
    speed: f32,
}

fn walk(mut visitors: Query<(&Visitor, &mut Transform)>) {
    for (visitor, mut transform) in &mut visitors {
        transform.translation.x += visitor.speed;
    }
}

fn main() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, TransformPlugin, ImpingePlugin::default()))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .add_systems(FixedUpdate, walk);
    let door =
        (Door::default(), Collider::rectangle(4.0, 4.0), Sensor, CollidingEntities::default());
    let door = app
        .world_mut()
        .spawn(door)
        .observe(|started: On<CollisionStarted>, mut doors: Query<&mut Door>| {
            assert!(started.is_sensor, "the door is one");
            if let Ok(mut door) = doors.get_mut(started.entity) {
                door.visitors += 1;
            }
        })
        .id();
    for (x, speed) in [(-5.0, 0.25), (-9.0, 0.5), (8.0, -0.125)] {
        let at = Transform::from_xyz(x, 0.0, 0.0);
        app.world_mut().spawn((Visitor { speed }, Collider::circle(0.5), at));
    }

    let mut line = String::new();
    for _ in 0..64 {
        app.update();
        let inside = app.world().get::<CollidingEntities>(door).expect("the door has it").len();
        line.push_str(if inside > 0 { "O" } else { "." });
        if inside > 0 {
            let total = app.world().get::<Door>(door).expect("it is there").visitors;
            assert!(total as usize >= inside, "each was counted when it came");
        }
    }
    let visitors = app.world().get::<Door>(door).expect("it is there").visitors;
    println!("{line}  O: open; {visitors} visitors");
    assert_eq!(visitors, 3);
    assert!(line.starts_with("...") && line.contains('O'), "closed, then open");
}
