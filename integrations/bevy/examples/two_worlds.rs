//! Two worlds in one app: the living and the ghosts. An entity may be in both, with a collider for each.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_impinge::d2::prelude::*;
use bevy_math::Vec2;
use bevy_transform::prelude::*;

/// The key of the second world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ghosts;

fn count(
    mut living: MessageReader<CollisionStarted>,
    mut ghosts: MessageReader<CollisionStarted<Ghosts>>,
    mut counts: ResMut<Counts>,
) {
    counts.living += living.read().count();
    counts.ghosts += ghosts.read().count();
}

#[derive(Resource, Default)]
struct Counts {
    living: usize,
    ghosts: usize,
}

fn main() {
    let mut app = App::new();
    app.add_plugins((
        ImpingePlugin::default().in_schedule(Update),
        ImpingePlugin::default().in_schedule(Update).in_world::<Ghosts>(),
    ));
    app.init_resource::<Counts>().add_systems(Update, count.after(ImpingeSystems::Report));
    let world = app.world_mut();
    let (circle, wall) = (Collider::circle(1.0), Collider::rectangle(0.5, 8.0));
    let at = |x: f32| Transform::from_xyz(x, 0.0, 0.0);
    // Walls stop the living; the world of ghosts has no walls.
    let wall = world.spawn((wall, at(1.0))).id();
    let hero = world.spawn((circle.clone(), at(0.0))).id();
    let ghost = world.spawn((circle.clone().in_world::<Ghosts>(), at(0.0))).id();
    // A medium is in both worlds.
    let medium = (circle.clone(), circle.in_world::<Ghosts>(), at(0.5));
    let medium = world.spawn(medium).id();
    app.update();

    let living = app.world().resource::<Collisions>();
    let ghosts = app.world().resource::<Collisions<Ghosts>>();
    let counts = app.world().resource::<Counts>();
    println!("{} pairs of the living, {} of ghosts", counts.living, counts.ghosts);
    assert_eq!((counts.living, counts.ghosts), (3, 1));
    assert!(living.are_touching(hero, wall) && !living.contains(ghost));
    assert!(ghosts.are_touching(ghost, medium) && !ghosts.contains(wall));
    let all = SpatialFilter::new();
    assert_eq!(living.entities_at(Vec2::new(1.2, 0.0), &all), [wall, medium]);
    assert_eq!(ghosts.entities_at(Vec2::new(1.2, 0.0), &all), [medium]);

    app.world_mut().despawn(medium);
    app.update();
    let living = app.world().resource::<Collisions>();
    assert_eq!(living.contact_pairs().count(), 1, "the medium left both worlds");
    assert!(app.world().resource::<Collisions<Ghosts>>().touching(ghost).is_empty());
}
