//! Impacts of boxes that touch corner on corner or edge on edge at the start, where the normals of
//! two faces tie: tiles, compounds and meshes must neither stop what slides along them nor hold what
//! moves away.

use impinge::dim2::query::ConstantVelocities as Turning2;
use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Space, Vector};
use impinge::query::{ImpactOptions, Moving, impact, nonlinear_time_of_impact};
use impinge::shape::{Compound, Cuboid, ShapeHandle, TriMesh};

/// A still shape made of boxes with the half extents 1, and the places of their centres.
struct Tiles<N: Space<D>, const D: usize> {
    shape: ShapeHandle<N, D>,
    places: Vec<[f64; D]>,
}

/// Returns whether a box with the half extents 1 at `at` hits a tile by moving at `velocity` for a
/// quarter: whether the two touch, and the largest gap along an axis gets smaller, or overlap, and
/// it does not get larger. Boxes that do not touch are too far apart.
fn hits<const D: usize>(tile: &[f64; D], at: &[f64; D], velocity: &[f64; D]) -> bool {
    let gap = |axis: usize| (at[axis] - tile[axis]).abs() - 2.0;
    let largest = (0..D).map(gap).fold(f64::MIN, f64::max);
    let opening = |axis: usize| velocity[axis] * (at[axis] - tile[axis]).signum();
    let opening = (0..D).filter(|axis| gap(*axis) == largest).map(opening).fold(f64::MIN, f64::max);
    largest == 0.0 && opening < 0.0 || largest < 0.0 && opening <= 0.0
}

fn placed<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    at: [f64; D],
) -> Isometry<N, R, D> {
    Isometry::from_parts(Vector::<N, D>::from(at.map(N::lit)).into(), R::identity())
}

/// Calls `visit` with all vectors whose components are -1, 0 or 1.
fn each_velocity<const D: usize>(mut visit: impl FnMut([f64; D])) {
    for number in 0..3_usize.pow(u32::try_from(D).expect("few")) {
        visit(std::array::from_fn(|axis| {
            [0.0, -1.0, 1.0][number / 3_usize.pow(u32::try_from(axis).expect("few")) % 3]
        }));
    }
}

/// Asserts for all velocities that a box at `at` has an impact with the tiles if and only if it
/// approaches one of those that it touches.
fn check<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    tiles: &Tiles<N, D>,
    at: [f64; D],
) -> usize {
    let mover = Cuboid::new(Vector::<N, D>::repeat(N::ONE));
    let options = ImpactOptions::new().with_max_time(N::lit(0.25));
    let (here, place) = (Isometry::<N, R, D>::identity(), placed::<N, R, D>(at));
    let mut count = 0;
    each_velocity(|velocity| {
        let expected = tiles.places.iter().any(|tile| hits(tile, &at, &velocity));
        let moves = Vector::<N, D>::from(velocity.map(N::lit));
        let (still, moving) =
            (Moving::still(&here, &*tiles.shape), Moving::new(&place, &moves, &mover));
        let found = impact(&still, &moving, &options);
        let name = || format!("{at:?} moving by {velocity:?} onto {:?}", tiles.shape);
        assert_eq!(found.is_some(), expected, "{found:?} from {}", name());
        let found = impact(&moving, &still, &options);
        assert_eq!(found.is_some(), expected, "{found:?} exchanged, from {}", name());
        count += usize::from(expected);
    });
    count
}

fn tile<N: Space<D>, const D: usize>() -> ShapeHandle<N, D> {
    ShapeHandle::new(Cuboid::new(Vector::<N, D>::repeat(N::ONE)))
}

fn in_plane<N: Space<2, Isometry = Isometry2<N>>>() {
    let one = Tiles { shape: tile::<N, 2>(), places: vec![[0.0; 2]] };
    let places: Vec<[f64; 2]> = vec![[-2.0, 0.0], [0.0, 0.0], [2.0, 0.0]];
    let children = places.iter().map(|place| (placed(*place), tile::<N, 2>())).collect();
    let row = Tiles { shape: ShapeHandle::new(Compound::new(children)), places };
    let mut hits = 0;
    let touching = [[2.0, 2.0], [-2.0, 2.0], [2.0, -2.0], [-2.0, -2.0], [0.0, 2.0], [-2.0, 0.5]];
    let overlapping = [[1.75, 1.75], [-1.75, 1.75], [1.75, -1.5], [-1.5, -1.5], [0.5, 1.75]];
    for at in touching.into_iter().chain(overlapping) {
        hits += check::<N, UnitComplex<N>, 2>(&one, at);
    }
    for at in [[0.0, 2.0], [1.0, 2.0], [0.5, -2.0], [2.0, -2.0], [4.0, 2.0], [4.0, 0.0]] {
        hits += check::<N, UnitComplex<N>, 2>(&row, at);
    }
    assert!(hits > 12, "{hits} hits");
}

fn in_space<N: Space<3, Isometry = Isometry3<N>>>() {
    let surface = impinge::procedural::space::cuboid(&Cuboid::new(Vector::<N, 3>::repeat(N::ONE)));
    let mesh = TriMesh::new(surface.vertices, surface.triangles);
    let shapes = [
        tile::<N, 3>(),
        ShapeHandle::new(mesh.clone()),
        ShapeHandle::new(mesh.clone().one_sided()),
        ShapeHandle::new(mesh.solid()),
    ];
    for shape in shapes {
        let one = Tiles { shape, places: vec![[0.0; 3]] };
        for at in
            [[2.0, 2.0, 0.0], [0.0, 2.0, 2.0], [-2.0, 0.0, -2.0], [2.0, 2.0, 2.0], [0.0, 2.0, 0.5]]
        {
            check::<N, UnitQuaternion<N>, 3>(&one, at);
        }
    }
    for count in [2, 9] {
        let grid = (0..count).map(|number: u32| {
            let [x, z] = if count == 2 { [number, 0] } else { [number % 3, number / 3] };
            [2.0 * f64::from(x) - 2.0, 0.0, 2.0 * f64::from(z) - 2.0]
        });
        let places: Vec<[f64; 3]> = grid.collect();
        let children = places.iter().map(|place| (placed(*place), tile::<N, 3>())).collect();
        let floor = Tiles { shape: ShapeHandle::new(Compound::new(children)), places };
        for at in [
            [0.0, 2.0, 0.0],
            [-2.0, 2.0, -2.0],
            [-1.0, 2.0, 0.0],
            [0.5, 2.0, 0.5],
            [-1.0, -2.0, -2.0],
        ] {
            check::<N, UnitQuaternion<N>, 3>(&floor, at);
        }
    }
}

#[test]
fn squares_leave_and_slide_along_corners() {
    in_plane::<f64>();
    in_plane::<f32>();
}

#[test]
fn cubes_leave_and_slide_along_edges() {
    in_space::<f64>();
    in_space::<f32>();
}

#[test]
fn separate_tiles_do_not_stop_a_player() {
    // Each tile is a shape of its own, as in a world; without rotation both searches agree.
    let (tile, player) = (Cuboid::new(Vector::<f64, 2>::repeat(1.0)), [0.0, 2.0]);
    let options = ImpactOptions::new().with_max_time(0.25);
    each_velocity::<2>(|velocity| {
        let mut hits = 0;
        for x in [-2.0, 0.0, 2.0] {
            let (here, at) = (placed([x, 0.0]), placed::<f64, _, 2>(player));
            let rest = Turning2::<f64>::still(here);
            let moves = Turning2::<f64>::new(at, velocity.into(), 0.0);
            let found = nonlinear_time_of_impact(&rest, &tile, &moves, &tile, &options);
            hits += usize::from(found.is_some());
        }
        assert_eq!(hits > 0, velocity[1] < 0.0, "{hits} hits by {velocity:?}");
    });
}
