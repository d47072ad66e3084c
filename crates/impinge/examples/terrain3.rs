//! Tracks in snow: a heavy ball rolls over a height field. Each step lowers the heights below the
//! ball to its underside, and the contacts follow. Before this the ball is deep in the snow;
//! afterwards it touches the snow, up to the curvature between grid points. The output is the snow
//! from above, and the depth of the deepest contact before and after.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim3::prelude::*;

type World = CollisionWorld<f64, &'static str>;

/// The field has a size of 16 × 8 around the origin, with points a quarter apart.
const EXTENT: [f64; 2] = [16.0, 8.0];
const CELL: f64 = 0.25;
const COLUMNS: usize = 65;
const ROWS: usize = 33;
const RADIUS: f64 = 1.0;
/// The depth by which the ball is pressed into the snow.
const PRESSED: f64 = 0.25;

/// Returns x and z of a grid point. Rows follow each other along z, columns along x.
fn place(index: usize) -> [f64; 2] {
    let (row, column) = (index / COLUMNS, index % COLUMNS);
    [column as f64 * CELL - EXTENT[0] / 2.0, row as f64 * CELL - EXTENT[1] / 2.0]
}

/// Returns the height of the underside of the ball at a position; `None` if the ball does not cover
/// the position.
fn underside(center: &Vector<f64>, [x, z]: [f64; 2]) -> Option<f64> {
    let across_squared = (x - center.x).powi(2) + (z - center.z).powi(2);
    (across_squared < RADIUS * RADIUS).then(|| center.y - (RADIUS * RADIUS - across_squared).sqrt())
}

/// Lowers all heights inside the ball to its underside. Returns the number of lowered heights.
fn press(world: &mut World, snow: CollisionObjectHandle, center: &Vector<f64>) -> u32 {
    world.deform(snow, |field: &mut HeightField<f64>| {
        let mut lowered = 0;
        for index in 0..ROWS * COLUMNS {
            let (row, column) = (index / COLUMNS, index % COLUMNS);
            let below = underside(center, place(index));
            if let Some(height) = below.filter(|height| *height < field.height(row, column)) {
                field.set_height(row, column, height).expect("a finite height");
                lowered += 1;
            }
        }
        lowered
    })
}

/// Returns the depth of the deepest contact; `None` without contacts.
fn deepest(world: &World) -> Option<f64> {
    let depths =
        world.contact_views().map(|(_, _, manifold)| manifold.deepest_contact().contact.depth);
    depths.reduce(f64::max)
}

fn main() {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.02));
    let scale = Vector::new(EXTENT[0], 1.0, EXTENT[1]);
    let field = HeightField::<f64>::new(ROWS, COLUMNS, vec![0.0; ROWS * COLUMNS], scale);
    let snow = world.add(Isometry::identity(), ShapeHandle::new(field), groups, query, "snow");
    let ball = ShapeHandle::new(Ball::new(RADIUS));
    let ball = world.add(Isometry::translation(0.0, 10.0, 0.0), ball, groups, query, "ball");

    // The edges of the snow's triangles are chords of the ball. The depth of an edge in the ball is
    // at most the sagitta e² / 8r of the longest edge e, and a little more where the surface is
    // steep. If the lowest point of the ball is over a grid point, the ball touches the snow there.
    let sagitta = 2.0 * CELL * CELL / (8.0 * RADIUS);
    let (mut fresh, mut settled) = (0.0_f64, 0.0_f64);
    for step in 0..=48_u8 {
        let x = -6.0 + f64::from(step) * CELL;
        let center = Vector::new(x, RADIUS - PRESSED, if x < 0.0 { -1.0 } else { 1.0 });
        world.set_position(ball, Isometry::from(center));
        world.update();
        fresh = fresh.max(deepest(&world).expect("the ball is pressed into the snow"));
        press(&mut world, snow, &center);
        world.update();
        let after = deepest(&world).expect("it still touches what it has pressed down");
        settled = settled.max(after);
        assert_eq!(press(&mut world, snow, &center), 0, "once is enough");
    }

    let object = world.collision_object(snow).expect("the snow is never removed");
    let field = object.shape().as_shape::<HeightField<f64>>().expect("the snow is a field");
    for row in (0..ROWS).step_by(2) {
        let mark = |column| match field.height(row, column) {
            height if height < -0.2 => '#',
            height if height < -0.1 => '+',
            height if height < 0.0 => '-',
            _ => '.',
        };
        println!("{}", (0..COLUMNS).map(mark).collect::<String>());
    }
    println!("deepest contact before pressing {fresh:.4}, after {settled:.4}");

    assert!(
        (fresh - PRESSED).abs() < 1e-9,
        "on fresh snow the ball is in by as much as it is pressed"
    );
    assert!(settled < 2.0 * sagitta, "{settled} after, {sagitta} by the formula");
    let lowest = field.heights().iter().copied().fold(0.0, f64::min);
    assert_eq!(lowest, -PRESSED, "the track is as deep as the ball was pressed");
    // A ball of radius 1, pressed in by a quarter, cuts the plane in a disk of radius √(1 − 0.75²)
    // = 0.66: two grid points to each side.
    let across = (0..ROWS).filter(|row| field.height(*row, 20) < 0.0).count();
    assert_eq!(across, 5, "the width of the track at x = −3");
}
