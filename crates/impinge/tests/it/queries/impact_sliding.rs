//! Solids that slide along others at the target distance of earlier impacts: along a wall far from
//! the origin, and over the borders of flush tiles. They never stop for longer than one query.

use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Vector};
use impinge::query::{ImpactOptions, Moving, impact};
use impinge::shape::{Ball, Capsule, Compound, ConvexHull, Cuboid, Polyline, Shape, ShapeHandle};

fn placed<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    at: Vector<N, D>,
) -> Isometry<N, R, D> {
    Isometry::from_parts(at.into(), R::identity())
}

/// Returns the time of impact of a solid that moves for a unit of time with a still shape.
fn time_to<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    still: (&dyn Shape<N, D>, Vector<N, D>),
    mover: (&dyn Shape<N, D>, Vector<N, D>),
    velocity: [f64; D],
    target: N,
) -> Option<N> {
    let (here, there) = (placed::<N, R, D>(still.1), placed::<N, R, D>(mover.1));
    let velocity = Vector::<N, D>::from(velocity.map(N::lit));
    let (still, moving) = (Moving::still(&here, still.0), Moving::new(&there, &velocity, mover.0));
    let options = ImpactOptions::new().with_max_time(N::ONE).with_target_distance(target);
    let (found, other) = (impact(&still, &moving, &options), impact(&moving, &still, &options));
    assert_eq!(found.map(|hit| hit.toi), other.map(|hit| hit.toi), "in either order");
    found.map(|hit| hit.toi)
}

/// Asserts that a solid that an impact stopped before a wall, `skin` away, slides along the wall
/// and leaves it, and does not come nearer. The wall is a unit box at `base` along the first axis.
fn slides_along_a_wall<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    wall: &dyn Shape<N, D>,
    mover: &dyn Shape<N, D>,
    base: f64,
    skin: f64,
) {
    let along =
        |axis: usize, speed: f64| core::array::from_fn(|at| if at == axis { speed } else { 0.0 });
    let at = |x: f64| Vector::<N, D>::from(along(0, x).map(N::lit));
    let (wall, target) = ((wall, at(base + 0.5)), N::lit(skin));
    let mut place = at(base - 1.5);
    let toi = time_to::<N, R, D>(wall, (mover, place), along(0, 2.0), target);
    place[0] += N::TWO * toi.expect("it reaches the wall");
    for axis in 1..D {
        for speed in [1.0, -1.0, 1e-3] {
            let found = time_to::<N, R, D>(wall, (mover, place), along(axis, speed), target);
            assert_eq!(found, None, "along the wall by {speed} at {base}, skin {skin}");
        }
    }
    let back = time_to::<N, R, D>(wall, (mover, place), along(0, -1.0), target);
    assert_eq!(back, None, "away from the wall at {base}, skin {skin}");
    let near = time_to::<N, R, D>(wall, (mover, place), along(0, 1.0), target);
    let noise = N::lit(8.0) * N::EPSILON * N::lit(base + 2.0);
    assert!(near.is_some_and(|toi| toi <= noise), "{near:?} into the wall at {base}, skin {skin}");
}

fn walls<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(movers: &[Mover<N, D>]) {
    let wall = Cuboid::new(Vector::<N, D>::repeat(N::HALF));
    for (mover, _) in movers {
        for base in [0.0, 1.0, 100.0, 250.0, 1000.0, 10_000.0] {
            for skin in [0.01, 0.015_625, 0.02, 0.05, 0.1] {
                slides_along_a_wall::<N, R, D>(&wall, &**mover, base, skin);
            }
        }
    }
}

/// Moves a solid over a row of flush tiles, at the target distance above them, in steps that end
/// early at each impact, and asserts that it gets as far as without tiles, except for the step at
/// each border.
fn passes_borders<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    tiles: &[(ShapeHandle<N, D>, Vector<N, D>)],
    mover: &dyn Shape<N, D>,
    height: f64,
    target: f64,
) {
    let (speed, start) = (0.125, -4.37);
    let mut at = Vector::<N, D>::zeros();
    (at[0], at[1]) = (N::lit(start), N::lit(height + target));
    let velocity = core::array::from_fn(|axis| if axis == 0 { speed } else { 0.0 });
    let mut stopped = 0;
    for step in 0..64 {
        let times = tiles.iter().filter_map(|(tile, place)| {
            time_to::<N, R, D>((&**tile, *place), (mover, at), velocity, N::lit(target))
        });
        let first = times.fold(N::ONE, |first, time| if time < first { time } else { first });
        stopped = if first < N::lit(1e-3) { stopped + 1 } else { 0 };
        assert!(stopped < 2, "stands at {} in step {step}, target {target}, {mover:?}", at[0]);
        at[0] += N::lit(speed) * first;
    }
    assert!(at[0] > N::lit(start + 6.0), "only at {}, target {target}, {mover:?}", at[0]);
}

fn borders<N: Space<D>, R: AbstractRotation<N, D> + Copy, const D: usize>(movers: &[Mover<N, D>])
where
    Isometry<N, R, D>: Into<N::Isometry>,
{
    let tile = || ShapeHandle::new(Cuboid::new(Vector::<N, D>::repeat(N::HALF)));
    let place = |column: i32| {
        let mut at = Vector::<N, D>::zeros();
        (at[0], at[1]) = (N::lit(f64::from(column) + 0.5), N::lit(-0.5));
        at
    };
    let alone: Vec<_> = (-6..6).map(|column| (tile(), place(column))).collect();
    let children = (-6..6).map(|column| (placed::<N, R, D>(place(column)).into(), tile()));
    let whole = ShapeHandle::new(Compound::new(children.collect()));
    let whole = vec![(whole, Vector::<N, D>::zeros())];
    for (mover, height) in movers {
        for target in [0.0, 0.01, 1.0 / 64.0, 0.1] {
            passes_borders::<N, R, D>(&alone, &**mover, *height, target);
            passes_borders::<N, R, D>(&whole, &**mover, *height, target);
        }
    }
}

/// A solid, and the height of its centre above a floor on which it stands.
type Mover<N, const D: usize> = (ShapeHandle<N, D>, f64);

fn in_plane<N: Space<2, Isometry = Isometry2<N>>>() {
    let movers: [Mover<N, 2>; 4] = [
        (ShapeHandle::new(Cuboid::new(Vector::<N, 2>::from([0.25, 0.75].map(N::lit)))), 0.75),
        (ShapeHandle::new(Cuboid::new(Vector::<N, 2>::from([0.35, 0.5].map(N::lit)))), 0.5),
        (ShapeHandle::new(Ball::new(N::HALF)), 0.5),
        (ShapeHandle::new(Capsule::new(N::HALF, N::lit(0.25))), 0.75),
    ];
    walls::<N, UnitComplex<N>, 2>(&movers);
    borders::<N, UnitComplex<N>, 2>(&movers);
}

fn in_space<N: Space<3, Isometry = Isometry3<N>>>() {
    let movers: [Mover<N, 3>; 3] = [
        (ShapeHandle::new(Cuboid::new(Vector::<N, 3>::from([0.25, 0.75, 0.3].map(N::lit)))), 0.75),
        (ShapeHandle::new(Ball::new(N::HALF)), 0.5),
        (ShapeHandle::new(Capsule::new(N::HALF, N::lit(0.25))), 0.75),
    ];
    walls::<N, UnitQuaternion<N>, 3>(&movers);
    borders::<N, UnitQuaternion<N>, 3>(&movers);
}

#[test]
fn solids_slide_in_the_plane() {
    in_plane::<f64>();
    in_plane::<f32>();
}

#[test]
fn solids_slide_in_space() {
    in_space::<f64>();
    in_space::<f32>();
}

/// Returns the time of impact of a solid with a tile `raised` above the floor on which it stands.
fn at_a_step<N: Space<2, Isometry = Isometry2<N>>>(raised: f64) -> Option<N> {
    let tile = Cuboid::new(Vector::<N, 2>::repeat(N::HALF));
    let mover = Cuboid::new(Vector::<N, 2>::from([0.25, 0.75].map(N::lit)));
    let at = |x: f64, y: f64| Vector::<N, 2>::from([x, y].map(N::lit));
    let (still, moving) = ((&tile as _, at(0.5, raised - 0.5)), (&mover as _, at(-0.5, 0.75)));
    time_to::<N, UnitComplex<N>, 2>(still, moving, [1.0, 0.0], N::ZERO)
}

#[test]
fn higher_tiles_stop_a_box() {
    for raised in [0.25, 1.0 / 64.0, 1e-4] {
        assert_eq!(at_a_step::<f64>(raised), Some(0.25), "raised by {raised}");
        assert_eq!(at_a_step::<f32>(raised), Some(0.25), "raised by {raised}");
    }
    assert_eq!(at_a_step::<f64>(-1e-9), None, "lower");
}

#[test]
fn a_ball_that_cuts_a_corner_hits_it() {
    // The ball touches the side of a corner that it then cuts by `cut`.
    for cut in [1e-6, 1e-4, 0.01] {
        let (ball, tile) = (Ball::new(0.5_f64), Cuboid::new(Vector::<f64, 2>::repeat(0.5)));
        let (height, half): (f64, f64) = (0.5 - cut, 0.5);
        let start = -(half * half - height * height).sqrt();
        let place = Vector::<f64, 2>::from([start, 0.5 + height]);
        let corner = Vector::<f64, 2>::from([0.5, 0.0]);
        let found =
            time_to::<f64, UnitComplex<f64>, 2>((&tile, corner), (&ball, place), [1.0, 0.0], 0.0);
        assert_eq!(found, Some(0.0), "cuts by {cut}");
    }
}

#[test]
fn a_hull_slides_from_one_segment_into_the_next() {
    let point = Point::<f64, 3>::from;
    let line = [[-2.0, 0.0, 1.0], [-2.0, -2.0, 1.0], [2.0, -2.0, -1.0], [2.0, -1.0, -1.0]];
    let line = Polyline::open(line.map(point).to_vec());
    let corners = [
        [0.0, 0.0, -1.0],
        [-2.0, -1.0, 2.0],
        [-1.0, 1.0, 1.0],
        [2.0, 1.0, -2.0],
        [1.0, 2.0, 0.0],
        [1.0, 2.0, 1.0],
        [1.0, 1.0, 1.0],
        [-2.0, -1.0, 0.0],
    ];
    let hull = ConvexHull::try_from_points(&corners.map(point)).expect("a solid");
    let (here, at) = (Vector::zeros(), Vector::<f64, 3>::from([0.0, -0.5, 1.0]));
    // The hull touches the first segment at the start, and its next one at half a unit of time.
    let velocity = [0.0, -1.0, -1.0];
    let found = time_to::<f64, UnitQuaternion<f64>, 3>((&line, here), (&hull, at), velocity, 0.0);
    assert!(found.is_some_and(|toi| (toi - 0.5).abs() < 1e-12), "{found:?}");
}
