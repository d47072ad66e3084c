//! Pictures of contacts with surfaces: internal edges, and one-sided surfaces.

use super::{AMBER, INK, WIDTH, check_svg, note, options};
use impinge::debug_render::{DebugDrawing, DebugRender, Drawn, Style};
use impinge::dim2::prelude::*;
use impinge_view::SvgPicture;

type FloorWorld = CollisionWorld<f64, ()>;

/// Slides a box over a floor with a penetration of 0.06, until a contact normal is tilted by more
/// than 30 degrees from the vertical. With `stop`, places the box only at that x coordinate.
/// Returns the world, and the x coordinate of the box with such a normal; `None` if there is none.
fn slide(floor: Polyline<f64>, height: f64, stop: Option<f64>) -> (FloorWorld, Option<f64>) {
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let mut world = FloorWorld::new(0.02);
    let floor = ShapeHandle::new(floor);
    world.add(Isometry::translation(0.0, height), floor, everybody, contacts, ());
    let parcel = ShapeHandle::new(Cuboid::new(Vector::new(0.6, 0.45)));
    let parcel = world.add(Isometry::identity(), parcel, everybody, contacts, ());
    let positions = (0..200).map(|step| f64::from(step) * 0.01 - 1.0);
    for x in stop.map_or_else(|| positions.collect(), |x| vec![x]) {
        world.set_position(parcel, Isometry::translation(x, height + 0.45 - 0.06));
        world.update();
        if world.contact_views().any(|(_, _, view)| view.normal().x.abs() > 0.5) {
            return (world, Some(x));
        }
    }
    (world, None)
}

#[test]
fn internal_edges() {
    let floor = Polyline::open((-3..=3).map(|x| Point::new(f64::from(x), 0.0)).collect());
    let (alone, caught) = slide(floor.clone().with_internal_edges_kept(), 0.0, None);
    assert!(caught.is_some(), "segments on their own stop the box");
    let (mended, bump) = slide(floor, -1.9, caught);
    assert_eq!(bump, None, "the floor as a whole does not");
    let mut options = options::<f64>();
    options.contact_normal = Some(Style { color: AMBER, size: 0.7 });
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "Internal edges",
        "A box on a floor of six segments. Above, each segment is taken on its own, and one end of a segment pushes the box sideways. \
         Below, the floor is one surface, and all normals are up.",
    );
    for world in [&alone, &mended] {
        DebugDrawing::new(options).world(world, &mut picture);
    }
    for (x, y) in (-3..=3).flat_map(|x| [(x, 0.0), (x, -1.9)]) {
        picture.point(&Point::new(f64::from(x), y), 0.06, INK, Drawn::Object);
    }
    note(&mut picture, [-3.0, 1.2], "each segment on its own: a ghost contact");
    note(&mut picture, [-3.0, -0.8], "one surface: no contact at internal edges");
    check_svg("internal-edges", &picture);
}

#[test]
fn two_sides_or_one() {
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let mut world = FloorWorld::new(0.02);
    // The vertices go from right to left: the front, the right side of each segment, faces up.
    let hills = [[2.4, 0.0], [1.2, 0.3], [0.0, -0.1], [-1.2, 0.2], [-2.4, 0.0]].map(Point::from);
    let both = Polyline::open(hills.to_vec());
    let ball = ShapeHandle::new(Ball::new(0.5));
    for (x, surface) in [(0.0, both.clone()), (6.0, both.one_sided())] {
        world.add(
            Isometry::translation(x, 0.0),
            ShapeHandle::new(surface),
            everybody,
            contacts,
            (),
        );
        for (side, y) in [(-1.2, 0.6), (1.2, -0.1)] {
            world.add(Isometry::translation(x + side, y), ball.clone(), everybody, contacts, ());
        }
    }
    world.update();
    let touching = world.contact_pairs().filter(|(_, _, pair)| pair.num_contacts() > 0).count();
    assert_eq!(touching, 3, "all but the ball behind the surface with one side");
    let mut options = options::<f64>();
    options.contact_normal = Some(Style { color: AMBER, size: 0.7 });
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "Sides of a surface",
        "A ball above and a ball below a chain of segments. With two sides both balls have contacts, with one only the upper ball.",
    );
    DebugDrawing::new(options).world(&world, &mut picture);
    note(&mut picture, [-2.4, 1.5], "two sides");
    note(&mut picture, [3.6, 1.5], "one_sided()");
    check_svg("sides", &picture);
}
