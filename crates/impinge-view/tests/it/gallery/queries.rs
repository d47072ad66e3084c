//! Pictures of rays, casts, and nearest objects.

use super::{BLUE, INK, VIOLET, WIDTH, check_svg, options, turned2};
use impinge::debug_render::{DebugDrawing, DebugRender, Drawn, Style, SweptShape};
use impinge::dim2::prelude::*;
use impinge_view::SvgPicture;

type NamedWorld = CollisionWorld<f64, &'static str>;

/// Returns a world with solids of five kinds in a row, at different heights.
fn obstacles() -> NamedWorld {
    let mut world = NamedWorld::new(0.02);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let pentagon = [[0.0, 0.9], [-0.86, 0.28], [-0.53, -0.73], [0.53, -0.73], [0.86, 0.28]];
    let solids = [
        (ShapeHandle::new(Ball::new(0.7)), turned2(2.2, 0.4, 0.0), "ball"),
        (ShapeHandle::new(Cuboid::new(Vector::new(0.7, 0.5))), turned2(4.4, -0.6, 0.5), "cuboid"),
        (ShapeHandle::new(Capsule::new(0.6, 0.35)), turned2(6.5, 0.9, 0.9), "capsule"),
        (
            ShapeHandle::new(ConvexPolygon::from_points(&pentagon.map(Point::from))),
            turned2(8.6, -0.3, 0.2),
            "polygon",
        ),
        (
            ShapeHandle::new(Ellipse::new(Vector::new(0.9, 0.5))),
            turned2(10.9, 1.0, -0.3),
            "ellipse",
        ),
    ];
    for (shape, place, name) in solids {
        world.add(place, shape, everybody, contacts, name);
    }
    world
}

#[test]
fn rays() {
    let world = obstacles();
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "Ray casts",
        "Rays from one point among five solids, each with its hits and their normals.",
    );
    let mut drawing = DebugDrawing::new(options::<f64>());
    drawing.world(&world, &mut picture);
    let mut counts = Vec::new();
    for (slope, name) in [(-0.6, "none"), (0.03, "every hit"), (-0.16, "the first hit")] {
        let ray = Ray::new(Point::new(0.0, 0.3), Vector::new(1.0, slope));
        let everything = QueryFilter::new();
        let hits: Vec<_> = match name {
            "the first hit" => world
                .first_ray_hit(&ray, 12.0, true, &everything)
                .into_iter()
                .map(|(_, hit)| hit)
                .collect(),
            _ => world
                .ray_hits(&ray, 12.0, true, &everything)
                .into_iter()
                .map(|(_, hit)| hit)
                .collect(),
        };
        let end = match name {
            "the first hit" => f64::INFINITY,
            "none" => 4.0,
            _ => 12.0,
        };
        drawing.ray(&ray, end, &hits, &mut picture);
        counts.push(hits.len());
    }
    assert_eq!(counts[0], 0, "one passes below all of them");
    assert!(counts[1] >= 2 && counts[2] == 1, "{counts:?}");
    check_svg("rays", &picture);
}

#[test]
fn shape_cast() {
    let mut world = NamedWorld::new(0.02);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let hills =
        [[0.0, 0.0], [2.0, 0.2], [4.0, 0.0], [6.0, 1.1], [7.5, 1.5], [9.0, 0.6], [11.0, 0.5]];
    let hills = ShapeHandle::new(Polyline::open(hills.map(Point::from).to_vec()));
    world.add(Isometry::identity(), hills, everybody, contacts, "hills");
    let shape = ShapeHandle::new(Capsule::new(0.45, 0.4));
    let position = turned2(1.0, 2.6, 1.2);
    let velocity = Vector::new(1.0, -0.28);
    let options_of_cast = ImpactOptions::new();
    let hit =
        world.cast_shape(&position, &velocity, &*shape, &options_of_cast, &QueryFilter::new());
    let (_, hit) = hit.expect("the hills are in the way");
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "A shape cast",
        "A capsule at its start, at the impact on a chain of segments with the point and the normal there.",
    );
    let mut drawing = DebugDrawing::new(options::<f64>());
    drawing.world(&world, &mut picture);
    let sweep = SweptShape { shape: &shape, position, velocity, max_time: f64::INFINITY };
    drawing.cast(&sweep, Some(&hit), &mut picture);
    let at = |time: f64| {
        Point::from(sweep.position_at(time).translation.vector) + Vector::new(-0.3, 0.85)
    };
    for (time, name) in [(0.0, "start".to_owned()), (hit.toi, format!("impact at {:.2}", hit.toi))]
    {
        picture.text(&at(time), &name, INK, Drawn::Query);
    }
    check_svg("shape-cast", &picture);
}

#[test]
fn nearest_objects() {
    let mut world = obstacles();
    world.update();
    let (shape, position) =
        (ShapeHandle::new(Cuboid::new(Vector::new(0.45, 0.45))), turned2(6.2, -1.6, 0.4));
    let mut options = options::<f64>();
    options.proximity = Some(Style { color: VIOLET, size: 0.12 });
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "Nearest objects",
        "A square, and the three objects nearest to it: lines join the closest points, and the distances are beside them.",
    );
    let mut drawing = DebugDrawing::new(options);
    drawing.world(&world, &mut picture);
    let asking = Style { color: BLUE, size: 0.1 };
    options.object = Some(asking);
    DebugDrawing::new(options).shape(&shape, &position, &mut picture);
    let found = world.nearest_objects(&position, &*shape, 3, f64::INFINITY, &QueryFilter::new());
    for near in &found {
        drawing.closest_points(&near.points, &mut picture);
        let ClosestPoints::WithinMargin(from, to) = near.points else { panic!("all are apart") };
        let middle = from + (to - from) * 0.5;
        picture.text(&middle, &format!("{:.2}", near.distance), VIOLET, Drawn::Proximity);
    }
    assert_eq!(found.len(), 3, "as many as asked for");
    assert!(found.is_sorted_by_key(|near| near.distance), "the nearest first");
    check_svg("nearest", &picture);
}
