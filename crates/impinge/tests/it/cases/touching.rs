//! Surfaces that touch solids up to rounding: query and manifold must agree on whether they touch.
//!
//! Each triangle or segment has a corner or a side in the plane of a face, and both bodies have the
//! same pose. So the distance is zero up to the rounding of the rotation, with either sign.

use impinge::math::na::{Translation, UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, IdAllocator,
    PairManifoldGenerator,
};
use impinge::query::contact;
use impinge::shape::{
    Ball, Capsule, ConvexHull, ConvexPolygon, Cuboid, Polyline, Segment, Shape, TriMesh,
};

use crate::support::samples::samples;

/// Returns a pseudorandom number from -1 to 1.
fn noise(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    f64::from(u32::try_from(*state >> 33).expect("31 bits")) / f64::from(1_u32 << 30) - 1.0
}

fn point<N: Real, const D: usize>(at: [f64; D]) -> Point<N, D> {
    Point::from(at.map(N::lit))
}

/// Returns whether a surface and a solid touch: by the query and by the manifold, each in both
/// orders. Asserts that the depth is no larger than rounding errors.
fn touch<N: Space<D>, R, const D: usize>(
    pose: &Isometry<N, R, D>,
    surface: &dyn Shape<N, D>,
    solid: &dyn Shape<N, D>,
    angle: f64,
) -> [bool; 4]
where
    R: AbstractRotation<N, D> + Copy + std::fmt::Debug,
    Isometry<N, R, D>: Into<N::Isometry>,
{
    let prediction = ContactPrediction::new(N::ZERO, N::lit(angle), N::lit(angle));
    let placed: N::Isometry = (*pose).into();
    let ask = |first: &dyn Shape<N, D>, second: &dyn Shape<N, D>| {
        let mut generator = PairManifoldGenerator::<N, D>::default();
        let (dispatcher, mut ids) = (DefaultContactDispatcher::<D>::new(), IdAllocator::new());
        generator.update(&dispatcher, &placed, first, &placed, second, &prediction, &mut ids);
        let found = contact(pose, first, pose, second, N::ZERO);
        let depth = found.map_or(N::ZERO, |found| found.depth);
        assert!(depth <= N::lit(2048.0) * N::EPSILON, "{depth} deep at {pose:?}");
        [found.is_some(), generator.num_contacts() > 0]
    };
    let [query1, manifold1] = ask(surface, solid);
    let [query2, manifold2] = ask(solid, surface);
    [query1, manifold1, query2, manifold2]
}

/// Returns how many pairs of a surface and a solid touch at a pose, with and without an angular
/// prediction. Asserts that the four results of [`touch`] agree.
fn touching<N: Space<D>, R, const D: usize>(
    pose: &Isometry<N, R, D>,
    surfaces: &[Box<dyn Shape<N, D>>],
    solids: &[Box<dyn Shape<N, D>>],
) -> usize
where
    R: AbstractRotation<N, D> + Copy + std::fmt::Debug,
    Isometry<N, R, D>: Into<N::Isometry>,
{
    let mut count = 0;
    for (index1, surface) in surfaces.iter().enumerate() {
        for (index2, solid) in solids.iter().enumerate() {
            for angle in [0.0, 0.25] {
                let said = touch(pose, &**surface, &**solid, angle);
                let are_one = said.iter().all(|&is_touching| is_touching == said[0]);
                assert!(are_one, "surface {index1}, solid {index2}, {angle}: {said:?} {pose:?}");
                count += usize::from(said[0]);
            }
        }
    }
    count
}

/// Returns meshes at a face perpendicular to the x axis: with a side, a corner or a ridge in the
/// plane of the face, and the first mesh with additional triangles of size zero at a corner.
fn meshes<N: Space<3>>(face: f64) -> Vec<Box<dyn Shape<N, 3>>> {
    let mesh = |points: &[[f64; 3]], triangles: &[[u32; 3]]| -> Box<dyn Shape<N, 3>> {
        let points = points.iter().map(|&[x, y, z]| point([x - 1.0 + face, y, z])).collect();
        Box::new(TriMesh::new(points, triangles.to_vec()))
    };
    let side = [[1.0, 0.6875, 0.0], [1.0, 6.0625, -0.8125], [1.25, 7.125, 0.0]];
    let corner = [[1.0, 0.3, 0.2], [1.5, 0.9, 0.1], [1.3, -0.4, 0.7]];
    let ridge = [[1.0, -0.7, 0.3], [1.0, 0.8, -0.1], [1.6, 0.1, 1.1], [1.4, 0.3, -1.2]];
    vec![
        mesh(&side, &[[0, 1, 2]]),
        mesh(&side, &[[0, 1, 2], [0, 0, 0], [0, 0, 0]]),
        mesh(&corner, &[[0, 1, 2]]),
        mesh(&corner, &[[0, 1, 2], [0, 0, 0]]),
        mesh(&ridge, &[[0, 1, 2], [1, 0, 3]]),
    ]
}

fn in_space<N: Space<3, Isometry = Isometry3<N>>>() {
    let hull = [[1.0, 0.0, 0.0], [1.0, 9.0, 0.0], [1.0, 0.0, 9.0], [1.0, -9.0, -9.0], [0.0; 3]];
    let ends = [point([1.0, -8.0, 0.5]), point([1.0, 8.0, 0.5])];
    let vector = |at: [f64; 3]| Vector::<N, 3>::from(at.map(N::lit));
    let solids: Vec<Box<dyn Shape<N, 3>>> = vec![
        Box::new(Cuboid::new(vector([1.0, 9.0, 3.0]))),
        Box::new(Cuboid::new(vector([1.0, 0.5, 0.25]))),
        Box::new(ConvexHull::try_from_points(&hull.map(point)).expect("a pyramid")),
        Box::new(Segment::new(ends[0], ends[1])),
        Box::new(Capsule::new(N::lit(8.0), N::ONE)),
        Box::new(Ball::new(N::ONE)),
    ];
    // A box of width zero has both faces in the plane of the mesh.
    let flat: Vec<Box<dyn Shape<N, 3>>> = vec![
        Box::new(Cuboid::new(vector([0.0, 9.0, 3.0]))),
        Box::new(Cuboid::new(vector([0.0, 5.1875, 0.0]))),
    ];
    let (rounds, mut state, mut count) = (samples(20), 7, 0);
    for _ in 0..rounds {
        let mut next = || N::lit(noise(&mut state));
        let (axis, at) = ([next(), next(), next()], [next(), next(), next()]);
        let turn = UnitQuaternion::from_scaled_axis(Vector::<N, 3>::from(axis) * N::lit(3.0));
        let pose = Isometry3::from_parts(Translation::from(Vector::<N, 3>::from(at)), turn);
        count += touching(&pose, &meshes(1.0), &solids);
        count += touching(&pose, &meshes(0.0), &flat);
    }
    assert!(count > rounds, "{count} touch in {rounds} poses");
}

#[test]
fn queries_and_manifolds_agree_on_touching_in_space() {
    in_space::<f32>();
    in_space::<f64>();
}

fn in_the_plane<N: Space<2, Isometry = Isometry2<N>>>() {
    let line = |points: &[[f64; 2]]| -> Box<dyn Shape<N, 2>> {
        Box::new(Polyline::open(points.iter().map(|&at| point(at)).collect()))
    };
    let surfaces = [
        line(&[[1.0, -0.75], [1.0, 0.8]]),
        line(&[[1.5, -0.75], [1.0, 0.3], [1.3, 0.8]]),
        line(&[[1.5, -0.75], [1.0, 0.3], [1.0, 0.3], [1.0, 0.8], [2.0, 1.0]]),
    ];
    let polygon = [[1.0, -2.0], [1.0, 2.0], [-1.0, 0.1]].map(point);
    let solids: Vec<Box<dyn Shape<N, 2>>> = vec![
        Box::new(Cuboid::new(Vector::<N, 2>::new(N::ONE, N::lit(3.0)))),
        Box::new(Cuboid::new(Vector::<N, 2>::new(N::ONE, N::lit(0.25)))),
        Box::new(ConvexPolygon::try_new(&polygon).expect("a triangle")),
        Box::new(Capsule::new(N::lit(8.0), N::ONE)),
        Box::new(Ball::new(N::ONE)),
    ];
    let (rounds, mut state, mut count) = (samples(20), 7, 0);
    for _ in 0..rounds {
        let mut next = || N::lit(noise(&mut state));
        let (angle, at) = (next() * N::lit(3.0), [next(), next()]);
        let at = Translation::from(Vector::<N, 2>::from(at));
        count += touching(
            &Isometry2::from_parts(at, UnitComplex::from_angle(angle)),
            &surfaces,
            &solids,
        );
    }
    assert!(count > rounds, "{count} touch in {rounds} poses");
}

#[test]
fn queries_and_manifolds_agree_on_touching_in_the_plane() {
    in_the_plane::<f32>();
    in_the_plane::<f64>();
}

/// Boxes and triangles that stand exactly on the first vertex of a falling line touch it, in
/// queries and manifolds, with a prediction of zero.
fn on_vertices<N: Space<2, Isometry = Isometry2<N>>>() {
    for (half, dx, dy) in (1..=3).flat_map(|half| {
        (1..=9).flat_map(move |dx| {
            (1..=9).map(move |dy| (f64::from(half), f64::from(dx), f64::from(dy)))
        })
    }) {
        let ends = [[-half, -half], [dx - half, -half - dy]].map(point);
        let line = Polyline::<N, 2>::open(ends.to_vec());
        let corners = [[-half, -half], [half, -half], [half, half]].map(point);
        let solids: [Box<dyn Shape<N, 2>>; 2] = [
            Box::new(Cuboid::new(Vector::<N, 2>::repeat(N::lit(half)))),
            Box::new(ConvexPolygon::try_new(&corners).expect("a triangle")),
        ];
        for solid in solids {
            let said = touch(&Isometry2::identity(), &line, &*solid, 0.0);
            assert_eq!(said, [true; 4], "half {half}, falling by {dy} in {dx}: {solid:?}");
        }
    }
}

#[test]
fn solids_stand_exactly_on_vertices() {
    on_vertices::<f32>();
    on_vertices::<f64>();
}
