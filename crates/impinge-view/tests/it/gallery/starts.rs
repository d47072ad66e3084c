//! A picture of the table of casts that begin apart, touching, or penetrating.

use super::{BLUE, INK, RED, WIDTH, check_svg, note, options};
use impinge::debug_render::{DebugDrawing, DebugRender, Drawn};
use impinge::dim2::prelude::*;
use impinge_view::SvgPicture;

/// The horizontal and the vertical distance between cells of the table.
const CELL: [f64; 2] = [4.6, 3.1];

/// Draws a box at `height` above a floor, its velocity and the impact. Returns the time of impact;
/// `None` if there is no impact.
fn draw_start(
    corner: Vector<f64>,
    height: f64,
    velocity: Vector<f64>,
    picture: &mut SvgPicture,
) -> Option<f64> {
    let floor = ShapeHandle::new(Cuboid::new(Vector::new(1.7, 0.3)));
    let parcel = ShapeHandle::new(Cuboid::new(Vector::new(0.7, 0.5)));
    let here = Isometry::from(corner);
    let start = Isometry::from(corner + Vector::new(0.0, 0.8 + height));
    let (thrown, still) = (Moving::new(&start, &velocity, &*parcel), Moving::still(&here, &*floor));
    let hit = impact(&thrown, &still, &ImpactOptions::new());
    let mut drawing = DebugDrawing::new(options::<f64>());
    drawing.shape(&floor, &here, picture);
    drawing.shape(&parcel, &start, picture);
    let middle = Point::from(start.translation.vector);
    picture.arrow(&middle, &(middle + velocity * 0.9), BLUE, Drawn::Query);
    if let Some(hit) = hit {
        picture.point(&hit.world2, 0.16, RED, Drawn::QueryHit);
    }
    let toi = hit.map(|hit| hit.toi);
    let (text, color) =
        toi.map_or_else(|| ("none".to_owned(), INK), |toi| (format!("impact at {toi:.2}"), RED));
    let below = Point::from(corner + Vector::new(-0.6, -0.95));
    picture.text(&below, &text, color, Drawn::QueryHit);
    toi
}

#[test]
fn starts_of_casts() {
    let mut picture = SvgPicture::plane(WIDTH).without_legend().with_title(
        "Starts of casts",
        "Nine casts of a box over a floor: apart, touching and overlapping at the start, and approaching, sliding and separating.",
    );
    let velocities =
        [("approaching", [0.0, -1.0]), ("sliding", [1.0, 0.0]), ("separating", [0.0, 1.0])];
    let heights = [("apart", 0.4), ("touching", 0.0), ("overlapping", -0.3)];
    let mut table = Vec::new();
    for (row, (_, height)) in (0_u8..).zip(heights) {
        let found = (0_u8..).zip(velocities).map(|(column, (_, velocity))| {
            let corner = Vector::new(f64::from(column) * CELL[0], f64::from(row) * -CELL[1]);
            draw_start(corner, height, Vector::from(velocity), &mut picture)
        });
        table.push(found.collect::<Vec<_>>());
    }
    for (column, (name, _)) in (0_u8..).zip(velocities) {
        note(&mut picture, [f64::from(column) * CELL[0] - 0.8, 2.0], name);
    }
    for (row, (name, _)) in (0_u8..).zip(heights) {
        note(&mut picture, [-3.9, f64::from(row) * -CELL[1] + 0.3], name);
    }
    let apart = table[0][0].expect("the floor is below");
    assert!((apart - 0.4).abs() < 1e-12, "the height at unit speed: {apart}");
    assert_eq!(table[0][1..], [None, None], "apart, and not approaching");
    assert_eq!(table[1], [Some(0.0), None, None], "touching");
    assert_eq!(table[2], [Some(0.0), Some(0.0), None], "overlapping");
    check_svg("starts", &picture);
}
