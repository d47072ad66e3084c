//! Debug drawing: the colliders and contacts of a world as lines of Bevy's gizmos. With a window, `DebugGizmosPlugin`
//! is sufficient; here the lines go to a buffer and are counted.

use bevy_app::prelude::*;
use bevy_gizmos::config::DefaultGizmoConfigGroup;
use bevy_gizmos::gizmos::GizmoBuffer;
use bevy_impinge::d3::DebugGizmos;
use bevy_impinge::d3::prelude::*;
use bevy_impinge::impinge::debug_render::DebugOptions;
use bevy_transform::prelude::*;

type Lines = GizmoBuffer<DefaultGizmoConfigGroup, ()>;

fn main() {
    let mut app = App::new();
    app.add_plugins(ImpingePlugin::default().in_schedule(Update));
    app.world_mut().spawn(Collider::cuboid(4.0, 1.0, 4.0));
    let cube = Collider::cuboid(1.0, 1.0, 1.0);
    app.world_mut().spawn((cube, Transform::from_xyz(0.0, 0.875, 0.0)));
    app.update();

    let collisions = app.world().resource::<Collisions>();
    let mut drawing = DebugGizmos::default();
    let mut count = |options: DebugOptions<f32>| {
        let mut lines = Lines::new();
        drawing.set_options(options);
        drawing.draw(collisions, &mut lines);
        lines.buffer().list_positions.len() / 2
    };
    let everything = count(DebugOptions::default());
    let mut only_objects = DebugOptions::none();
    only_objects.object = DebugOptions::all().object;
    let objects = count(only_objects);
    println!("{objects} lines of objects, {everything} with contacts");
    assert_eq!(objects, 2 * 12, "the edges of two boxes");
    assert!(everything > objects, "and four contacts");
    assert_eq!(count(DebugOptions::none()), 0);
}
