//! Compares the signed distances of closed meshes and lines with other definitions of the inside:
//! winding numbers, angle-weighted pseudonormals, and the closed form for boxes.

use crate::support::query_support;

use impinge::math::{Point, Real, Vector, cross};
use impinge::procedural::space as surfaces;
use impinge::query::PointQuery;
use impinge::shape::{Ball, CompositeShape, Cuboid, EdgeNeighbor, FeatureId, Polyline, TriMesh};
use query_support::random::Random;

type Mesh = TriMesh<f64, 3>;
type P3 = Point<f64, 3>;

fn mesh<N: Real>(corners: &[P3], triangles: Vec<[u32; 3]>) -> TriMesh<N, 3> {
    let vertices = corners.iter().map(|corner| Point::from(corner.coords.map(N::lit)));
    TriMesh::new(vertices.collect(), triangles)
}

/// Rounds the coordinates to `f32`, so that both scalars have the same corners.
fn rounded(point: P3) -> P3 {
    Point::from(point.coords.map(|x| x.as_f32().as_f64()))
}

/// Returns the corners and triangles of the box between two corners.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> (Vec<P3>, Vec<[u32; 3]>) {
    let (low, high) = (P3::from(low), P3::from(high));
    let surface = surfaces::cuboid(&Cuboid::new((high - low) * 0.5));
    let middle = (low.coords + high.coords) * 0.5;
    (surface.vertices.iter().map(|corner| corner + middle).collect(), surface.triangles)
}

fn joined(bodies: &[(Vec<P3>, Vec<[u32; 3]>)]) -> (Vec<P3>, Vec<[u32; 3]>) {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for (own, named) in bodies {
        let first = u32::try_from(corners.len()).expect("few");
        triangles.extend(named.iter().map(|names| names.map(|name| name + first)));
        corners.extend(own);
    }
    (corners, triangles)
}

/// Returns a ball with bumps and thin spikes.
fn bumpy(random: &mut Random, subdivisions: u32) -> (Vec<P3>, Vec<[u32; 3]>) {
    let surface = surfaces::ball(&Ball::new(1.0_f64), subdivisions);
    let mut bump = |corner: &P3| {
        let spike = if random.bits().is_multiple_of(16) { 4.0 } else { 1.0 };
        rounded(corner * (random.within(0.6, 1.4) * spike))
    };
    (surface.vertices.iter().map(&mut bump).collect(), surface.triangles)
}

/// Returns a ring of square section around the z axis, thin on one side.
fn ring() -> (Vec<P3>, Vec<[u32; 3]>) {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for step in 0..24_u32 {
        let angle = f64::from(step) * std::f64::consts::TAU / 24.0;
        let thick = 0.02 + 0.4 * (angle * 0.5).sin().abs();
        for (out, up) in [(thick, 0.0), (0.0, thick), (-thick, 0.0), (0.0, -thick)] {
            let radius = 2.0 + out;
            corners.push(rounded(P3::new(radius * angle.cos(), radius * angle.sin(), up)));
        }
    }
    for (step, side) in (0..24).flat_map(|step| (0..4).map(move |side| (step, side))) {
        let at = |step: u32, side: u32| 4 * (step % 24) + side % 4;
        let (a, b) = (at(step, side), at(step, side + 1));
        let (c, d) = (at(step + 1, side), at(step + 1, side + 1));
        triangles.extend([[a, c, d], [a, d, b]]);
    }
    (corners, triangles)
}

/// Returns the winding number of a surface around a point: the sum of solid angles over 4π (Van
/// Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983).
fn solid_angles(mesh: &Mesh, point: &P3) -> f64 {
    let one = |part: u32| {
        let [a, b, c] = mesh.triangle(part).corners().map(|corner| corner - point);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let over = a.dot(&cross(&b, &c));
        let under = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * over.atan2(under)
    };
    (0..mesh.num_parts()).map(one).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Returns the cosine between the pseudonormal of the nearest feature and the direction to the
/// point; negative inside (Bærentzen and Aanæs, "Signed distance computation using the angle
/// weighted pseudonormal", 2005).
fn pseudonormal(mesh: &Mesh, point: &P3) -> f64 {
    let (nearest, location) = mesh.project_local_point_with_location(point, false);
    let normal = |part: u32| mesh.normal(part).expect("an area");
    let sum = match location.feature {
        FeatureId::Face(_) => normal(location.part),
        FeatureId::Edge(side) => match mesh.neighbor(location.part, side) {
            EdgeNeighbor::Triangle { index, .. } => normal(location.part) + normal(index),
            other => panic!("{other:?} across a side of a manifold"),
        },
        FeatureId::Vertex(corner) => {
            let apex = mesh.triangle(location.part).corners()[corner as usize];
            let mut sum = Vector::<f64, 3>::zeros();
            for part in 0..mesh.num_parts() {
                let corners = *mesh.triangle(part).corners();
                if let Some(at) = corners.iter().position(|corner| *corner == apex) {
                    let side = |turn: usize| (corners[(at + turn) % 3] - apex).normalize();
                    sum += normal(part) * side(1).dot(&side(2)).acos();
                }
            }
            sum
        }
    };
    (point - nearest.point).normalize().dot(&sum.normalize())
}

/// Returns a random point: around the mesh, close to its surface, or on a line through a corner
/// parallel to an axis.
fn asked(random: &mut Random, mesh: &Mesh) -> P3 {
    let part = u32::try_from(random.bits() % u64::from(mesh.num_parts())).expect("few");
    let corners = *mesh.triangle(part).corners();
    let anywhere = P3::from(random.vector::<f64, 3>() * 3.0);
    match random.bits() % 3 {
        0 => rounded(anywhere),
        1 => rounded(corners[0] + random.vector::<f64, 3>() * 0.1),
        _ => {
            let axis = usize::try_from(random.bits() % 3).expect("few");
            let mut point = corners[1];
            point[axis] = rounded(anywhere)[axis];
            point
        }
    }
}

fn check_against_twins(corners: &[P3], triangles: &[[u32; 3]], seed: u64) -> [usize; 2] {
    let random = &mut Random(seed, false);
    let exact = mesh::<f64>(corners, triangles.to_vec());
    let single = mesh::<f32>(corners, triangles.to_vec());
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..600 {
        let point = asked(random, &exact);
        let distance =
            exact.distance_to_point(&impinge::dim3::na::Isometry3::identity(), &point, false);
        if distance < 1e-5 {
            continue;
        }
        let winding = solid_angles(&exact, &point);
        let is_inside = (winding - 1.0).abs() < 1e-6;
        assert!(is_inside || winding.abs() < 1e-6, "{winding} is whole at {point}");
        let cosine = pseudonormal(&exact, &point);
        assert!(cosine.abs() < 1e-6 || (cosine < 0.0) == is_inside, "{cosine} at {point}");
        let expected = if is_inside { -distance } else { distance };
        assert_eq!(exact.signed_distance(&point), Some(expected), "{point}");
        assert_eq!(exact.encloses(&point), Some(is_inside), "{point}");
        let near = Point::from(point.coords.map(Real::as_f32));
        let found = single.signed_distance(&near).expect("a volume").as_f64();
        assert!((found - expected).abs() < 1e-5, "{found} instead of {expected} at {point}");
        assert_eq!(single.encloses(&near), Some(is_inside), "{point}");
        inside += usize::from(is_inside);
        outside += usize::from(!is_inside);
    }
    [inside, outside]
}

#[test]
fn signs_are_those_of_solid_angles_and_pseudonormals() {
    let mut counts = [0, 0];
    for seed in 0..6 {
        let random = &mut Random(seed, false);
        let (corners, triangles) = bumpy(random, 6 + 2 * u32::try_from(seed).expect("few"));
        let found = check_against_twins(&corners, &triangles, seed);
        counts = [counts[0] + found[0], counts[1] + found[1]];
    }
    let (corners, triangles) = ring();
    let [inside, outside] = check_against_twins(&corners, &triangles, 9);
    assert!(inside > 50 && outside > 200, "{inside} in the ring, {outside} not");
    assert!(counts.iter().all(|&count| count > 700), "{counts:?} inside and outside");
}

/// Compares the signed distance of a mesh of several boxes with its closed form, at all points of a
/// grid. The grid contains the corners, so many points share coordinates with corners or are
/// equally near to several faces.
fn check_grid<N: Real>(bodies: &[([f64; 3], [f64; 3])], offset: f64) {
    let moved = |corner: [f64; 3]| corner.map(|x| x + offset);
    let all: Vec<_> = bodies.iter().map(|&(low, high)| cuboid(moved(low), moved(high))).collect();
    let (corners, triangles) = joined(&all);
    let mesh = mesh::<N>(&corners, triangles);
    assert!(mesh.is_volume(), "{bodies:?}");
    let steps = || (-2..11).map(|step| f64::from(step) * 0.5);
    for (x, y, z) in
        steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| (x, y, z))))
    {
        let at = [x, y, z];
        let expected =
            bodies.iter().map(|(low, high)| to_box(at, low, high)).fold(f64::MAX, nearer);
        let point = Point::from(Vector::<f64, 3>::from(moved(at)).map(N::lit));
        let found = mesh.signed_distance(&point).expect("a volume").as_f64();
        assert!((found - expected).abs() < 1e-6, "{found} not {expected} at {at:?} {bodies:?}");
        assert_eq!(mesh.encloses(&point), Some(expected <= 0.0), "{at:?} of {bodies:?}");
    }
}

/// Returns the signed distance of a point from the boundary of a box.
fn to_box(at: [f64; 3], low: &[f64; 3], high: &[f64; 3]) -> f64 {
    let beyond: [f64; 3] = std::array::from_fn(|i| f64::max(low[i] - at[i], at[i] - high[i]));
    let deepest = beyond.iter().copied().fold(f64::MIN, f64::max);
    if deepest <= 0.0 {
        return deepest;
    }
    beyond.iter().map(|x| f64::max(*x, 0.0).powi(2)).sum::<f64>().sqrt()
}

/// Combines the signed distances `a` and `b` of a point from two surfaces. The result has the
/// smaller magnitude, and is negative if the point is in at least one of the bodies.
fn nearer(a: f64, b: f64) -> f64 {
    let size = f64::min(a.abs(), b.abs());
    if a < 0.0 || b < 0.0 { -size } else { size }
}

#[test]
fn ties_and_bodies_that_touch() {
    let unit = ([0.0; 3], [2.0; 3]);
    let scenes = [
        vec![unit],
        vec![unit, ([2.0, 2.0, 2.0], [4.0; 3])],
        vec![unit, ([2.0, 2.0, 0.0], [4.0, 4.0, 2.0])],
        vec![unit, ([2.0, 0.0, 0.0], [4.0, 2.0, 2.0])],
        vec![unit, ([1.0, 1.0, 1.0], [3.0; 3])],
        vec![([0.0; 3], [4.0, 4.0, 1.0]), ([1.0, 1.0, 1.0], [2.0, 2.0, 4.0])],
    ];
    for bodies in &scenes {
        // At 2^20 the resolution of `f32` is 1/8, so all halves stay exact.
        for offset in [0.0, 1_048_576.0] {
            check_grid::<f32>(bodies, offset);
            check_grid::<f64>(bodies, offset);
        }
    }
}

#[test]
fn cavities_and_bodies_turned_inside_out() {
    let (outer, inner) = (cuboid([0.0; 3], [6.0; 3]), cuboid([2.0; 3], [4.0; 3]));
    let turned = |(corners, triangles): (Vec<P3>, Vec<[u32; 3]>)| {
        (corners, triangles.iter().map(|&[a, b, c]| [a, c, b]).collect())
    };
    let at = |mesh: &Mesh, x: f64| mesh.signed_distance(&P3::new(x, 3.0, 3.0));
    let (corners, triangles) = joined(&[outer.clone(), turned(inner.clone())]);
    let hollow = mesh::<f64>(&corners, triangles);
    assert_eq!([3.0, 1.0, -1.0].map(|x| at(&hollow, x)), [Some(1.0), Some(-1.0), Some(1.0)]);
    let (corners, triangles) = joined(&[outer, inner.clone()]);
    let twice = mesh::<f64>(&corners, triangles);
    assert_eq!(at(&twice, 3.0), Some(-1.0), "inside of both");
    let (corners, triangles) = turned(inner);
    assert_eq!(at(&mesh(&corners, triangles), 3.5), Some(-0.5), "whichever way it winds");
}

#[test]
fn what_is_not_closed_encloses_nothing() {
    let (corners, triangles) = cuboid([-1.0; 3], [1.0; 3]);
    let middle = P3::origin();
    let whole = mesh::<f64>(&corners, triangles.clone());
    assert!(whole.is_closed() && whole.is_oriented() && whole.is_volume(), "a box");
    let mut open = triangles.clone();
    open.pop();
    let mut flipped = triangles.clone();
    flipped[4].swap(0, 1);
    let mut doubled = triangles.clone();
    doubled.push(triangles[0]);
    for bad in [open, flipped, doubled] {
        let mesh = mesh::<f64>(&corners, bad);
        assert!(!mesh.is_volume(), "no volume");
        assert_eq!((mesh.encloses(&middle), mesh.signed_distance(&middle)), (None, None));
    }
    // Adds a triangle with a repeated corner, as in meshes of spheres at the poles.
    let mut filled = triangles;
    let [a, b, _] = filled[0];
    filled.push([a, b, b]);
    assert_eq!(mesh::<f64>(&corners, filled).signed_distance(&middle), Some(-1.0), "filler");
}

#[test]
fn parted_corners_open_a_mesh() {
    // Each triangle has its own three vertices; the mesh treats vertices at one position as equal.
    let (corners, triangles) = cuboid([-1.0; 3], [1.0; 3]);
    let soup: Vec<P3> = triangles.iter().flatten().map(|&at| corners[at as usize]).collect();
    let names = (0..).take(triangles.len()).map(|part| [3 * part, 3 * part + 1, 3 * part + 2]);
    let mut mesh = mesh::<f32>(&soup, names.collect());
    let middle = Point::origin();
    assert_eq!(mesh.signed_distance(&middle), Some(-1.0), "by position, not by index");
    let vertices: Vec<_> = mesh.vertices().to_vec();
    let grown: Vec<_> = vertices.iter().map(|corner| corner * 2.0).collect();
    mesh.set_vertices(&grown);
    assert_eq!(mesh.signed_distance(&middle), Some(-2.0), "all move together");
    let mut parted = grown;
    parted[0] *= 1.5;
    mesh.set_vertices(&parted);
    assert_eq!(mesh.encloses(&middle), None, "a corner stands off");
    mesh.set_vertices(&vertices);
    assert_eq!(mesh.encloses(&middle), Some(true), "closed again");
}

fn check_extremes<N: Real>(scales: &[f64]) {
    let random = &mut Random(21, false);
    let (corners, triangles) = bumpy(random, 8);
    let plain = mesh::<N>(&corners, triangles.clone());
    let exact = mesh::<f64>(&corners, triangles.clone());
    let points: Vec<P3> = (0..60).map(|_| asked(random, &exact)).collect();
    for &scale in scales {
        let grown: Vec<_> = plain.vertices().iter().map(|corner| corner * N::lit(scale)).collect();
        let grown = TriMesh::new(grown, triangles.clone());
        for point in &points {
            let point = Point::from(point.coords.map(N::lit));
            let expected = plain.signed_distance(&point).map(|found| found * N::lit(scale));
            assert_eq!(grown.signed_distance(&(point * N::lit(scale))), expected, "{scale}");
        }
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let point = Point::<N, 3>::new(N::ZERO, N::lit(bad), N::ZERO);
        assert_eq!(plain.encloses(&point), Some(false), "{bad}");
        assert_eq!(plain.signed_distance(&point), Some(N::INFINITY), "{bad}");
    }
}

#[test]
fn scales_and_points_that_are_none() {
    // Powers of two, so that scaling is exact.
    let [up, down] = [80, -80].map(|power| 2.0_f64.powi(power));
    check_extremes::<f32>(&[up, down]);
    check_extremes::<f64>(&[up, down, up.powi(6), down.powi(6)]);
}

/// Returns the winding number of a closed line around a point, by angles.
fn turns(corners: &[Point<f64, 2>], point: &Point<f64, 2>) -> f64 {
    let around = |at: usize| {
        let [u, v] = [at, at + 1].map(|at| corners[at % corners.len()] - point);
        (u.x * v.y - u.y * v.x).atan2(u.dot(&v))
    };
    (0..corners.len()).map(around).sum::<f64>() / std::f64::consts::TAU
}

fn check_lines<N: Real>() {
    let (mut inside, mut outside) = (0, 0);
    for seed in 0..40 {
        let random = &mut Random(seed, false);
        // Corners on a grid, so that many are collinear; the line crosses itself.
        let mut whole = || (random.within(-4.0, 4.0)).round();
        let corners: Vec<_> = (0..12).map(|_| Point::<f64, 2>::new(whole(), whole())).collect();
        let here = corners.iter().map(|corner| Point::from(corner.coords.map(N::lit))).collect();
        let line = Polyline::<N, 2>::closed(here);
        assert!(line.is_outline(), "closed");
        let steps = || (-10..11).map(|step| f64::from(step) * 0.5);
        for (x, y) in steps().flat_map(|x| steps().map(move |y| (x, y))) {
            let point = Point::<N, 2>::new(N::lit(x), N::lit(y));
            let distance = line.signed_distance_to_local_point(&point);
            let found = line.signed_distance(&point).expect("closed");
            assert_eq!(found.abs(), distance, "to the line");
            assert_eq!(line.encloses(&point), Some(found <= N::ZERO), "{x} {y} of {corners:?}");
            if distance > N::ZERO {
                let winding = turns(&corners, &Point::<f64, 2>::new(x, y));
                let is_inside = winding.abs() > 0.5;
                assert_eq!(found < N::ZERO, is_inside, "{winding} at {x} {y} of {corners:?}");
                inside += u32::from(is_inside);
                outside += u32::from(!is_inside);
            }
        }
    }
    assert!(inside > 1000 && outside > 1000, "{inside} inside and {outside} outside");
}

#[test]
fn lines_enclose_what_they_wind_around() {
    check_lines::<f32>();
    check_lines::<f64>();
    let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]].map(Point::<f64, 2>::from).to_vec();
    let open = Polyline::open(corners.clone());
    assert_eq!(open.encloses(&Point::<f64, 2>::new(1.0, 1.0)), None, "open");
    let against = Polyline::new(corners, vec![[0, 1], [1, 2], [0, 2]]);
    assert!(against.is_closed() && !against.is_outline(), "one segment runs against the others");
    assert_eq!(against.signed_distance(&Point::<f64, 2>::new(1.0, 1.0)), None, "no outline");
}
