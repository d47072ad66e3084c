//! A picture of groups and filters.

use super::{AMBER, CLAY, SAGE, SLATE, WIDTH, check_svg, note, options};
use impinge::debug_render::{Color, DebugDrawing, Style};
use impinge::dim2::prelude::*;
use impinge_view::SvgPicture;

/// The role of an object, which determines its groups, its shape and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Role {
    Player,
    Ghost,
    Wall,
}

impl Role {
    /// Returns the groups: players are in group 0, ghosts in 1, walls in 2. Players and ghosts
    /// interact with walls, players also with players.
    fn groups(self) -> CollisionGroups {
        let (own, others): (usize, &[usize]) = match self {
            Self::Player => (0, &[0, 2]),
            Self::Ghost => (1, &[2]),
            Self::Wall => (2, &[0, 1]),
        };
        CollisionGroups::new().with_membership(&[own]).with_whitelist(others)
    }

    fn shape(self) -> ShapeHandle<f64> {
        match self {
            Self::Player => ShapeHandle::new(Ball::new(0.7)),
            Self::Ghost => ShapeHandle::new(Capsule::new(0.4, 0.45)),
            Self::Wall => ShapeHandle::new(Cuboid::new(Vector::new(0.4, 1.0))),
        }
    }

    fn color(self) -> Color {
        match self {
            Self::Player => SLATE,
            Self::Ghost => SAGE,
            Self::Wall => CLAY,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Player => "player",
            Self::Ghost => "ghost",
            Self::Wall => "wall",
        }
    }
}

#[test]
fn pairs_that_groups_allow() {
    let pairs = [
        [Role::Player, Role::Player],
        [Role::Player, Role::Ghost],
        [Role::Ghost, Role::Ghost],
        [Role::Player, Role::Wall],
        [Role::Ghost, Role::Wall],
    ];
    let mut world = CollisionWorld::<f64, _>::new(0.02);
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "Groups",
        "Five pairs of objects that overlap. Players touch players and walls, ghosts touch walls alone; where the groups forbid a pair \
         there is no contact.",
    );
    for (column, pair) in (0_u8..).zip(pairs) {
        let left = f64::from(column) * 3.2;
        for (role, shift) in pair.into_iter().zip([0.0, 0.7]) {
            let place = Isometry::translation(left + shift, 0.0);
            world.add(place, role.shape(), role.groups(), ContactQuery::default(), role);
        }
        note(&mut picture, [left - 0.7, -1.6], &format!("{}, {}", pair[0].name(), pair[1].name()));
    }
    world.update();
    let touching = world.contact_pairs().filter(|(_, _, pair)| pair.num_contacts() > 0);
    let touching: Vec<_> = touching.map(|(one, other, _)| [*one.data(), *other.data()]).collect();
    assert_eq!(touching, [pairs[0], pairs[3], pairs[4]], "and no others");
    let mut options = options::<f64>();
    options.contact_normal = Some(Style { color: AMBER, size: 0.7 });
    let colors: Vec<_> =
        world.collision_objects().map(|o| (o.handle(), o.data().color())).collect();
    let color_of = move |handle| colors.iter().find(|(own, _)| *own == handle).map(|(_, c)| *c);
    DebugDrawing::new(options).with_object_color(color_of).world(&world, &mut picture);
    check_svg("groups", &picture);
}
