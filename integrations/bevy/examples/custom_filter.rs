//! A pair filter that reads components: players of one team do not collide, until one of them changes its team.

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::{SystemParam, SystemParamItem};
use bevy_impinge::d2::prelude::*;
use bevy_transform::prelude::*;

#[derive(Component, Clone, Copy, PartialEq)]
enum Team {
    Red,
    Blue,
}

#[derive(SystemParam)]
struct Teams<'w, 's> {
    teams: Query<'w, 's, &'static Team>,
}

impl PairFilter for Teams<'_, '_> {
    fn allows(param: &mut SystemParamItem<'_, '_, Self>, one: Entity, other: Entity) -> bool {
        match (param.teams.get(one), param.teams.get(other)) {
            (Ok(one), Ok(other)) => one != other,
            _ => true,
        }
    }
}

/// Calls the filter again for the pairs of players that changed their team: a filter is called only
/// once per pair.
fn ask_again(changed: Query<Entity, Changed<Team>>, mut collisions: ResMut<Collisions>) {
    for entity in &changed {
        collisions.refilter(entity);
    }
}

fn main() {
    let mut app = App::new();
    app.add_plugins(ImpingePlugin::default().in_schedule(Update).with_filter::<Teams>())
        .add_systems(Update, ask_again.before(ImpingeSystems::Step));
    let players = [Team::Red, Team::Red, Team::Blue]
        .map(|team| app.world_mut().spawn((team, Collider::circle(1.0))).id());
    let ball = app.world_mut().spawn((Collider::circle(0.2), Transform::default())).id();
    app.update();

    let pairs = |app: &App| {
        let collisions = app.world().resource::<Collisions>();
        collisions.contact_pairs().map(|pair| (pair.entity, pair.other)).collect::<Vec<_>>()
    };
    let [red, other_red, blue] = players;
    println!("at first {} pairs", pairs(&app).len());
    assert_eq!(pairs(&app).len(), 5, "all but the two of red");
    assert!(!pairs(&app).contains(&(red, other_red)), "of one team");
    assert!(app.world().resource::<Collisions>().are_touching(blue, ball), "the ball has no team");

    app.world_mut().entity_mut(other_red).insert(Team::Blue);
    app.update();
    println!("after the change {} pairs", pairs(&app).len());
    assert!(pairs(&app).contains(&(red, other_red)), "enemies now");
    assert!(!pairs(&app).contains(&(other_red, blue)), "friends now");
    assert_eq!(pairs(&app).len(), 5);
}
