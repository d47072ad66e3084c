//! Tests rays against composites: no ray passes between adjacent parts, and the hits equal those of
//! the single parts.

use crate::support::composite_support;
use crate::support::query_support;
use crate::support::samples::{samples, stride};

use composite_support::scenes::Maker;
use composite_support::{Piece, Pieces, Slow};
use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry2, Isometry3, Point, Pose, Real, Space, Vector};
use impinge::procedural::space as surfaces;
use impinge::query::{Ray, RayCast, RayIntersection};
use impinge::shape::{Ball, CompositeShape, Cuboid, HeightField, Polyline, Shape, TriMesh};
use query_support::random::Random;
use query_support::samples::{PLANE, SPACE, sample2, sample3};

/// Offsets from the origin, for meshes of size 100.
const OFFSETS: [f64; 3] = [0.0, 1e3, 1e6];

/// A closed surface of size 100 and its centre, both moved away from the origin.
struct Closed<N: Real> {
    mesh: TriMesh<N, 3>,
    middle: Point<N, 3>,
}

fn closed<N: Real>(which: usize, offset: f64) -> Closed<N> {
    let hundred = N::lit(100.0);
    let surface = match which {
        0 => surfaces::cuboid(&Cuboid::new(Vector::<N, 3>::new(hundred, hundred, hundred))),
        1 => surfaces::ball(&Ball::new(hundred), 12),
        _ => surfaces::ball(&Ball::new(hundred), 40),
    };
    let by = Vector::<N, 3>::new(N::lit(offset), N::lit(-offset), N::lit(offset * 0.5));
    let vertices = surface.vertices.iter().map(|vertex| vertex + by).collect();
    Closed { mesh: TriMesh::new(vertices, surface.triangles), middle: Point::from(by) }
}

/// Returns a point on a side of a triangle: a corner, the midpoint, or any point of the side.
fn on_side<N: Real>(random: &mut Random, corners: &[Point<N, 3>; 3]) -> Point<N, 3> {
    let side = usize::try_from(random.bits() % 3).expect("few");
    let (a, b) = (corners[side], corners[(side + 1) % 3]);
    let share = match random.bits() % 3 {
        0 => N::ZERO,
        1 => N::HALF,
        _ => N::lit(random.within(0.0, 1.0)),
    };
    a + (b - a) * share
}

/// Casts rays at points of edges and at corners of closed surfaces: from within, and from outside
/// through the centre. Asserts that the surface stops each ray from within and that rays from
/// outside enter and leave; returns the number of rays.
fn through_closed<N: Real>(world: f64) -> usize {
    let mut shots = 0;
    let random = &mut Random(7, false);
    for (which, own) in (0..3).flat_map(|which| OFFSETS.map(|own| (which, own))) {
        let Closed { mesh, middle } = closed::<N>(which, own);
        let by = Vector::<N, 3>::new(N::lit(world), N::lit(world), N::lit(-world));
        for shot in 0..samples(150) {
            let turn = if shot % 2 == 0 { random.turn3() } else { UnitQuaternion::identity() };
            let m = Isometry3::from_parts(by.into(), turn);
            let part = u32::try_from(random.bits() % u64::from(mesh.num_parts())).expect("few");
            let corners = *mesh.triangle(part).corners();
            let target = on_side(random, &corners);
            let start = middle + random.vector::<N, 3>() * N::lit(40.0);
            let ray = Ray::new(m * start, m * (target - start));
            let hits = mesh.all_hits_with_ray(&m, &ray, N::INFINITY, true);
            assert!(!hits.is_empty(), "{which} {own} {world}: {ray:?} is aimed at {part}");
            let toi = mesh.toi_with_ray(&m, &ray, true).expect("a hit");
            assert_eq!(toi, hits[0].toi, "the first of all");
            assert!(mesh.intersects_ray(&m, &ray), "any");
            let outside = Ray::new(ray.origin + ray.dir * N::TWO, -ray.dir);
            let hits = mesh.all_hits_with_ray(&m, &outside, N::INFINITY, true);
            // One hit where the ray enters, and one where it leaves.
            assert!(hits.len() >= 2, "{which} {own} {world}: {outside:?} {hits:?}");
            shots += 2;
        }
    }
    shots
}

#[test]
fn no_ray_slips_through_a_closed_surface() {
    let mut shots = 0;
    for world in OFFSETS {
        shots += through_closed::<f32>(world) + through_closed::<f64>(world);
    }
    assert!(shots > samples(10_000), "{shots}");
}

/// Returns a field with heights between 0 and 3, on a grid of 12 by 9 cells.
fn grid<N: Real>() -> HeightField<N, 3> {
    let random = &mut Random(3, false);
    let heights = (0..13 * 10).map(|_| N::lit(random.within(0.0, 3.0))).collect();
    HeightField::<N, 3>::new(
        10,
        13,
        heights,
        Vector::<N, 3>::new(N::lit(60.0), N::ONE, N::lit(45.0)),
    )
}

/// Returns a mesh of the triangles of the field, translated by `by`; each triangle has its own
/// vertices.
fn meshed<N: Real>(field: &HeightField<N, 3>, by: &Vector<N, 3>) -> TriMesh<N, 3> {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for part in 0..field.num_parts() {
        let first = 3 * part;
        triangles.push([first, first + 1, first + 2]);
        let part = field.part(part);
        let impinge::shape::PartSolid::Triangle(triangle) = part.solid else { panic!("triangles") };
        points.extend(triangle.corners().map(|corner| corner + by));
    }
    TriMesh::new(points, triangles)
}

fn through_grid<N: Real>(world: f64) -> usize {
    let random = &mut Random(11, false);
    let field = grid::<N>();
    let by = Vector::<N, 3>::new(N::lit(world), N::lit(-world), N::lit(world));
    let mesh = meshed(&field, &by);
    let m = Isometry3::from_parts(by.into(), UnitQuaternion::identity());
    let here = Isometry3::identity();
    let mut shots = 0;
    for _ in 0..samples(1800) {
        let part = u32::try_from(random.bits() % u64::from(field.num_parts())).expect("few");
        let local = meshed_corners(&field, part);
        let target = on_side(random, &local);
        // A ray at the border of the field may miss because of rounding.
        let inner = target.x.abs() < N::lit(29.0) && target.z.abs() < N::lit(21.0);
        if !inner {
            continue;
        }
        let lean = if random.bits() & 1 == 0 { 0.0 } else { 3.0 };
        let up = Vector::<N, 3>::new(
            N::lit(random.signed() * lean),
            N::lit(8.0),
            N::lit(random.signed() * lean),
        );
        let ray = Ray::new(target + by + up, -up);
        let on_field = field.toi_with_ray(&m, &ray, true);
        assert!(on_field.is_some(), "{world} {ray:?} is aimed at {part} of the field");
        let on_mesh = mesh.toi_with_ray(&here, &ray, true);
        assert!(on_mesh.is_some(), "{world} {ray:?} is aimed at {part} of the mesh");
        shots += 2;
    }
    shots
}

fn meshed_corners<N: Real>(field: &HeightField<N, 3>, part: u32) -> [Point<N, 3>; 3] {
    match field.part(part).solid {
        impinge::shape::PartSolid::Triangle(triangle) => *triangle.corners(),
        other => panic!("{other:?} is no triangle"),
    }
}

#[test]
fn no_ray_slips_through_a_grid() {
    let shots: usize =
        OFFSETS.iter().map(|&world| through_grid::<f32>(world) + through_grid::<f64>(world)).sum();
    assert!(shots > samples(10_000), "{shots}");
}

/// Returns a closed line around a centre, a filled mesh of the same outline, their points, and the
/// centre.
fn round<N: Real>(offset: f64) -> (Polyline<N, 2>, TriMesh<N, 2>, Vec<Point<N, 2>>, Point<N, 2>) {
    let middle = Point::<N, 2>::new(N::lit(offset), N::lit(-offset));
    let corner = |index: u32| {
        let angle = f64::from(index) * 0.314_159_265_358_979_3;
        middle + Vector::<N, 2>::new(N::lit(80.0 * angle.cos()), N::lit(100.0 * angle.sin()))
    };
    let mut points: Vec<_> = (0..20).map(corner).collect();
    let line = Polyline::closed(points.clone());
    points.push(middle);
    let fan = (0..20).map(|index| [20, index, (index + 1) % 20]).collect();
    (line, TriMesh::new(points.clone(), fan), points, middle)
}

fn through_round<N: Real>(world: f64, own: f64) {
    let random = &mut Random(5, false);
    let (line, mesh, points, middle) = round::<N>(own);
    let by = Vector::<N, 2>::new(N::lit(world), N::lit(world));
    let m = Isometry2::from_parts(by.into(), UnitComplex::identity());
    for shot in 0..1000 {
        let at = shot % 20;
        let share = N::lit([0.0, 0.5, random.within(0.0, 1.0)][shot / 20 % 3]);
        let target = points[at] + (points[(at + 1) % 20] - points[at]) * share;
        let start = middle + random.vector::<N, 2>() * N::lit(30.0);
        let ray = Ray::new(start + by, target - start);
        assert!(line.intersects_ray(&m, &ray), "{world} {own} {ray:?} to {at}");
        let outside = Ray::new(start + by + ray.dir * N::TWO, -ray.dir);
        assert!(line.intersects_ray(&m, &outside), "{world} {own} {outside:?} from {at}");
        assert!(mesh.intersects_ray(&m, &outside), "{world} {own} {outside:?} filled {at}");
    }
}

#[test]
fn no_ray_slips_through_a_closed_line() {
    for (world, own) in OFFSETS.iter().flat_map(|&world| OFFSETS.map(|own| (world, own))) {
        through_round::<f32>(world, own);
        through_round::<f64>(world, own);
    }
}

/// Returns the hits of all parts up to `max_time`, each part tested on its own, sorted by time and
/// then by part.
fn brute<N: Space<D>, const D: usize>(
    parts: &Pieces<N, D>,
    ray: &Ray<N, D>,
    max_time: N,
    solid: bool,
) -> Vec<RayIntersection<N, D>> {
    let mut hits = Vec::new();
    for (part, (pose, piece)) in (0..).zip(&parts.parts) {
        let hit = piece.as_shape().cast_local_ray(&ray.inverse_transformed_by(pose), solid);
        if let Some(hit) = hit.filter(|hit| hit.toi <= max_time) {
            hits.push(RayIntersection { normal: pose.vector(&hit.normal), part, ..hit });
        }
    }
    hits.sort_by(|a, b| (a.toi, a.part).partial_cmp(&(b.toi, b.part)).expect("times"));
    hits
}

fn all_hits<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
    scale: f64,
) {
    let (mut many, mut none, mut composites) = (0, 0, 0);
    // The ninth from 5 on has few and many parts, and 14 of them with the flag.
    for seed in (0..60).skip(5 % stride(9)).step_by(stride(9)) {
        composites += 1;
        let random = &mut Random(seed, seed % 7 == 0);
        let scale = N::lit(scale);
        let scene = maker.scene(random, usize::try_from(seed % 40).expect("few"), scale);
        for shot in 0..30 {
            let origin = Point::from(random.vector::<N, D>() * (scale * N::lit(6.0)));
            let aim = random.vector::<N, D>() * (scale * N::lit(3.0));
            let dir = aim - origin.coords;
            let ray = Ray::new(origin, if shot == 0 { Vector::<N, D>::zeros() } else { dir });
            let solid = shot % 2 == 0;
            for max_time in [N::INFINITY, N::ONE, N::ZERO] {
                let expected = brute(&scene.fast, &ray, max_time, solid);
                let found = scene.fast.local_ray_hits(&ray, max_time, solid);
                assert_eq!(found, expected, "{seed} {ray:?}");
                let first = scene.fast.cast_local_ray_until(&ray, max_time, solid);
                assert_eq!(first, expected.first().copied(), "{seed} {ray:?}");
                assert_eq!(
                    scene.slow.cast_local_ray_until(&ray, max_time, solid),
                    first,
                    "whatever the search proposes"
                );
                let any = scene.fast.intersects_local_ray(&ray, max_time);
                if solid {
                    assert_eq!(any, first.is_some(), "{seed} {ray:?}");
                }
                many += u32::from(found.len() > 1);
                none += u32::from(found.is_empty());
            }
            assert_eq!(scene.fast.cast_local_ray_until(&ray, -N::ONE, solid), None, "before");
            assert_eq!(scene.fast.cast_local_ray_until(&ray, N::lit(f64::NAN), solid), None, "NaN");
        }
    }
    let are_some = 3 * many > 2 * composites && 3 * none > 5 * composites;
    assert!(are_some, "{many} with several hits, {none} without, of {composites} composites");
}

#[test]
fn hits_are_those_of_the_parts() {
    for scale in [1.0, 1e-3, 1e4] {
        all_hits(
            &Maker::<f32, _, 2> { kinds: &PLANE, sample: sample2, turn: Random::turn2 },
            scale,
        );
        all_hits(
            &Maker::<f32, _, 3> { kinds: &SPACE, sample: sample3, turn: Random::turn3 },
            scale,
        );
        all_hits(
            &Maker::<f64, _, 2> { kinds: &PLANE, sample: sample2, turn: Random::turn2 },
            scale,
        );
        all_hits(
            &Maker::<f64, _, 3> { kinds: &SPACE, sample: sample3, turn: Random::turn3 },
            scale,
        );
    }
}

#[test]
fn solid_and_hollow_unions() {
    // Two squares of half extent 1, which overlap between x = 1 and x = 2.
    let square = || Piece::of(Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0)));
    let at = |x: f64| Pose::from_translation(Vector::<f64, 2>::new(x, 0.0));
    let two = Pieces::new(vec![(at(1.0), square()), (at(2.0), square())]);
    let here = Isometry2::identity();
    let right = |x: f64| Ray::new(Point::<f64, 2>::new(x, 0.0), Vector::<f64, 2>::x());
    let times = |x, solid| -> Vec<(f64, u32)> {
        let hits = two.all_hits_with_ray(&here, &right(x), 10.0, solid);
        hits.iter().map(|hit| (hit.toi, hit.part)).collect()
    };
    assert_eq!(times(-1.0, true), [(1.0, 0), (2.0, 1)], "where it enters each");
    assert_eq!(times(0.5, true), [(0.0, 0), (0.5, 1)], "it starts in the first");
    assert_eq!(times(0.5, false), [(0.5, 1), (1.5, 0)], "into one and out of the other");
    assert_eq!(times(1.5, true), [(0.0, 0), (0.0, 1)], "by part at one time");
    let first = two.first_hit_with_ray(&here, &right(-1.0), 1.5, true).expect("in time");
    assert_eq!((first.toi, first.normal.x), (1.0, -1.0), "against the ray");
    assert!(two.first_hit_with_ray(&here, &right(-1.0), 0.5, true).is_none(), "too late");
}

#[test]
fn rays_that_are_none_and_composites_of_nothing() {
    let ball = || vec![(Pose::<f32, 3>::identity(), Piece::of(Ball::new(1.0_f32)))];
    let (fast, slow) = (Pieces::new(ball()), Slow::new(ball()));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let origins = [Point::<f32, 3>::new(bad, 0.0, 0.0), Point::origin()];
        let dirs = [Vector::<f32, 3>::x(), Vector::<f32, 3>::new(bad, 1.0, 0.0)];
        for ray in origins.iter().zip(dirs).map(|(origin, dir)| Ray::new(*origin, dir)) {
            assert!(fast.local_ray_hits(&ray, f32::INFINITY, true).is_empty(), "{ray:?}");
            assert!(slow.local_ray_hits(&ray, f32::INFINITY, true).is_empty(), "{ray:?}");
        }
    }
    let none = Pieces::<f32, 3>::new(Vec::new());
    let ray = Ray::new(Point::origin(), Vector::<f32, 3>::x());
    assert!(!none.intersects_local_ray(&ray, f32::INFINITY), "nothing to hit");
    assert_eq!(none.local_aabb(), impinge::bounding_volume::Aabb::unbounded(), "of nothing");
}
