//! Tests the contacts of a solid's face and triangles, which are computed 8 at a time in SIMD
//! lanes. Asserts that they span the overlap of both outlines, up to rounding, and that all SIMD
//! levels give the same bits. Also tests edges and corners of the solid, and the bounds `nearest`
//! and `least` of the distance.

use super::clip::{Outline, common, prism, regular};
use crate::collide::manifold::face_lanes::{ClipRequest, FaceClip, FaceSolid};
use crate::collide::packet::{LANES, PartPacket};
use crate::collide::{RawPoint, RawPoints};
use crate::math::simd::Level;
use crate::math::xorshift::Xorshift;
use crate::math::{Matrix, Point, Real, Vector, cross, min, orthonormal_basis};
use crate::shape::{Cuboid, FeatureId, Shape};

type Corners<N> = [Point<N, 3>; 3];

/// Triangles in the frame of a solid, and the clip request of each.
struct Scene<N: Real> {
    triangles: Vec<Corners<N>>,
    requests: Vec<ClipRequest<N>>,
}

/// Contact points of one triangle; `None` if the lane is undecided and the caller has to clip the
/// pair.
type Found<N> = Option<Vec<RawPoint<N, 3>>>;

/// Returns the unit normal of a triangle, with the sign that makes its z component non-negative.
fn upward<N: Real>([a, b, c]: &Corners<N>) -> Vector<N, 3> {
    let normal = cross(&(b - a), &(c - a)).normalize();
    if normal.z < N::ZERO { -normal } else { normal }
}

impl<N: Real> Scene<N> {
    fn new(solid: &dyn Shape<N, 3>, triangles: Vec<(Corners<N>, Vector<N, 3>)>) -> Self {
        let solid = solid.geometry().0;
        let mut scene = Self { triangles: Vec::new(), requests: Vec::new() };
        for (triangle, normal) in triangles {
            let request = ClipRequest::new(solid, normal, None, -N::INFINITY);
            scene.triangles.push(triangle);
            scene.requests.push(request.expect("a box or a hull"));
        }
        scene
    }

    /// Clips all triangles. They are passed to the kernel in a frame in which the solid has the
    /// rotation `turn` and its origin at `origin`; the returned points are in the frame of the
    /// solid.
    fn found(
        &self,
        level: Level,
        solid: &dyn Shape<N, 3>,
        (turn, origin): (&Matrix<N, 3>, Vector<N, 3>),
    ) -> Vec<Found<N>> {
        let geometry = solid.geometry();
        let lanes = FaceSolid { solid: geometry.0, turn, origin, prediction: N::lit(10.0) };
        let mut all = vec![None; self.triangles.len()];
        let mut clip = FaceClip::blank();
        for (first, (triangles, requests)) in
            self.triangles.chunks(LANES).zip(self.requests.chunks(LANES)).enumerate()
        {
            let (mut packet, mut points) = (PartPacket::blank(), RawPoints::new());
            for (lane, corners) in triangles.iter().enumerate() {
                packet.put(lane, &corners.map(|corner| Point::from(turn * corner.coords + origin)));
            }
            let mut start = 0;
            let packet = (&packet, requests);
            lanes.each_clip_at(level, packet, &mut clip, &mut points, |lane, lowest, points| {
                let own = points[start..].to_vec();
                start = points.len();
                if let Some(lowest) = lowest {
                    let least = own.iter().map(|point| point.distance).fold(N::INFINITY, min);
                    assert!(lowest == least, "the least distance is {least:?}");
                    all[first * LANES + lane] = Some(own);
                }
            });
        }
        all
    }
}

fn projected_along<N: Real>(point: &Point<N, 3>, normal: &Vector<N, 3>) -> [f64; 2] {
    let (u, v) = orthonormal_basis(normal);
    [point.coords.dot(&u).as_f64(), point.coords.dot(&v).as_f64()]
}

/// Returns twice the area of the convex hull of some points.
fn hull_area(positions: &[[f64; 2]]) -> f64 {
    let mut sorted = positions.to_vec();
    sorted.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    let mut hull: Outline = Vec::new();
    for pass in 0..2 {
        let (start, mut side) = (hull.len(), Outline::new());
        let each = |side: &mut Outline, p: [f64; 2]| {
            while let [.., a, b] = side[..]
                && (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) <= 0.0
            {
                side.pop();
            }
            side.push(p);
        };
        if pass == 0 {
            sorted.iter().for_each(|&p| each(&mut side, p));
        } else {
            sorted.iter().rev().for_each(|&p| each(&mut side, p));
        }
        side.pop();
        hull.truncate(start);
        hull.extend(side);
    }
    outline_area(&hull)
}

fn outline_area(outline: &Outline) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>().abs()
}

/// Returns the bottom of a solid that stands on the plane z = 0, in the order of its outline.
fn bottom(outline: &Outline) -> Vec<Point<f64, 3>> {
    outline.iter().map(|&[x, y]| Point::<f64, 3>::new(x, y, 0.0)).collect()
}

/// Asserts that the points of one triangle span the overlap of the triangle and the bottom of the
/// solid, projected along the normal. Each point must lie on the bottom, and at its distance from
/// the triangle; points with the id of a vertex must lie at that corner.
fn check<N: Real>(
    outline: &Outline,
    corners: &Corners<N>,
    normal: &Vector<N, 3>,
    found: &[RawPoint<N, 3>],
) {
    let tolerance = 400.0 * N::EPSILON.as_f64();
    let ring = |points: &[Point<f64, 3>]| -> Outline {
        let projected: Outline =
            points.iter().map(|p| projected_along(p, &normal.map(Real::as_f64))).collect();
        let turn = projected
            .iter()
            .zip(projected.iter().cycle().skip(1))
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0]);
        if turn.sum::<f64>() < 0.0 { projected.into_iter().rev().collect() } else { projected }
    };
    let corners = corners.map(|corner| Point::from(corner.coords.map(Real::as_f64)));
    let (own, face) = (ring(&corners), ring(&bottom(outline)));
    let shared = outline_area(&common(&own, &face));
    let positions: Vec<_> =
        found.iter().map(|point| projected_along(&point.point1, normal)).collect();
    let spanned = hull_area(&positions);
    assert!((spanned - shared).abs() <= 4.0 * tolerance, "spans {spanned} of {shared}");
    let (normal, up) = (normal.map(Real::as_f64), upward(&corners));
    for point in found {
        let (position, distance) =
            (Point::from(point.point1.coords.map(Real::as_f64)), point.distance.as_f64());
        let foot = position - normal * distance;
        assert!(position.z.abs() <= tolerance, "on the bottom: {position}");
        assert!(up.dot(&(foot - corners[0])).abs() <= tolerance, "on the triangle: {foot}");
        let is_at = |at: &Point<f64, 3>, corner: &Point<f64, 3>| (at - corner).norm() <= tolerance;
        match point.feature1 {
            FeatureId::Vertex(_) => {
                assert!(
                    bottom(outline).iter().any(|corner| is_at(&position, corner)),
                    "{position}"
                );
            }
            FeatureId::Edge(_) => {}
            FeatureId::Face(_) => assert!(matches!(point.feature2, FeatureId::Vertex(_))),
        }
        if let FeatureId::Vertex(corner) = point.feature2 {
            assert!(is_at(&foot, &corners[corner as usize]), "{foot} is corner {corner}");
        }
    }
}

/// Returns two frames for the triangles: the frame of the solid, and a random frame.
fn frames<N: Real>(random: &mut Xorshift) -> [(Matrix<N, 3>, Vector<N, 3>); 2] {
    let (normal, _) = (random.vector::<N>(1.0).normalize(), 0);
    let (u, v) = orthonormal_basis(&normal);
    let turn = Matrix::<N, 3>::from_columns(&[u, v, normal]);
    [(Matrix::<N, 3>::identity(), Vector::<N, 3>::zeros()), (turn, random.vector(2.0))]
}

/// Returns random triangles close to the plane z = 0, tilted by less than 26°, so that the bottom
/// of a solid on the plane is its supporting feature. With `on_grid`, the corners lie on a grid, so
/// that corners and sides of the outlines coincide.
fn triangles<N: Real>(random: &mut Xorshift, on_grid: bool) -> Vec<Corners<N>> {
    let mut corner = |at: usize| {
        let mut position = random.vector::<N>(2.0);
        position.z = N::lit(0.4 * random.next());
        if on_grid {
            position = position.map(|x| N::lit((2.0 * x.as_f64()).round() / 2.0));
            position.z = N::lit(-0.25 * (at % 2) as f64);
        }
        Point::from(position)
    };
    let all = (0..24).map(|_| [corner(0), corner(1), corner(2)]);
    let is_wide = |corners: &Corners<N>| {
        let [a, b, c] = corners;
        let is_upright = upward(corners).z > N::lit(0.9);
        is_upright && cross(&(b - a), &(c - a)).norm() > N::lit(0.3)
    };
    all.filter(is_wide).collect()
}

/// Runs [`check`] on the contact points of a solid and random triangles. In the solid's own frame,
/// its bottom is at height `-lift`. Returns the numbers of undecided and of decided triangles.
fn check_all<N: Real>(
    outline: &Outline,
    (solid, lift): (&dyn Shape<N, 3>, N),
    random: &mut Xorshift,
    on_grid: bool,
) -> [usize; 2] {
    let (mut counts, up) = ([0; 2], Vector::<N, 3>::z() * lift);
    let placed = triangles(random, on_grid).into_iter();
    let placed = placed.map(|corners| (corners.map(|corner| corner - up), upward(&corners)));
    let scene = Scene::new(solid, placed.collect());
    for (turn, origin) in frames(random) {
        let found = scene.found(Level::new(), solid, (&turn, origin));
        for ((moved, request), found) in scene.triangles.iter().zip(&scene.requests).zip(found) {
            counts[usize::from(found.is_some())] += 1;
            if let Some(mut found) = found {
                found.iter_mut().for_each(|point| point.point1 += up);
                check(outline, &moved.map(|corner| corner + up), &request.normal, &found);
            }
        }
    }
    counts
}

fn all_is_shared<N: Real>() {
    let mut random = Xorshift(11);
    let square: Outline = vec![[-1.0, -1.5], [1.0, -1.5], [1.0, 1.5], [-1.0, 1.5]];
    let (triangle, octagon) = (regular(3, [0.1, 0.0], 1.5, 0.3), regular(8, [0.0, 0.2], 1.2, 0.1));
    // The origin of a box is its centre, so its bottom is at height -1.
    let cuboid = Cuboid::new(Vector::<N, 3>::new(N::ONE, N::lit(1.5), N::ONE));
    let hulls = [&triangle, &octagon].map(|outline| prism::<N>(outline, [0.0, 2.0]));
    let solids: [(&Outline, &dyn Shape<N, 3>, N); 3] = [
        (&square, &cuboid, N::ONE),
        (&triangle, &hulls[0], N::ZERO),
        (&octagon, &hulls[1], N::ZERO),
    ];
    let mut counts = [0; 2];
    for (outline, solid, lift) in solids {
        for round in 0..60 {
            let [left, found] = check_all(outline, (solid, lift), &mut random, round % 3 == 0);
            counts = [counts[0] + left, counts[1] + found];
        }
    }
    assert!(counts[1] > 4000 && counts[0] < counts[1] / 20, "left, found: {counts:?}");
}

#[test]
fn all_that_a_face_and_a_triangle_share_is_spanned() {
    all_is_shared::<f32>();
    all_is_shared::<f64>();
}

fn lanes_do_not_matter<N: Real>() {
    let (mut random, mut points) = (Xorshift(5), 0);
    let solid = Cuboid::new(Vector::<N, 3>::new(N::ONE, N::lit(0.7), N::HALF));
    for _ in 0..100 {
        let mut triangle = || {
            let corners = [0, 1, 2].map(|_| {
                let position = random.vector::<N>(1.5);
                Point::<N, 3>::new(position.x, position.y, position.z * N::lit(0.1) - N::HALF)
            });
            let tilted = upward(&corners) + random.vector::<N>(0.3);
            (corners, tilted.normalize())
        };
        let scene = Scene::new(&solid, (0..13).map(|_| triangle()).collect());
        for (turn, origin) in frames(&mut random) {
            let all: Vec<_> = Level::available()
                .into_iter()
                .map(|level| scene.found(level, &solid, (&turn, origin)))
                .collect();
            points += all[0].iter().flatten().map(Vec::len).sum::<usize>();
            assert!(all.iter().all(|other| *other == all[0]), "the same bits at each level");
        }
    }
    assert!(points > 1000, "{points} points");
}

#[test]
fn lanes_have_the_bits_of_one() {
    lanes_do_not_matter::<f32>();
    lanes_do_not_matter::<f64>();
}

#[test]
fn what_touches_is_as_near_as_is_known() {
    let solid = Cuboid::new(Vector::<f64, 3>::repeat(1.0));
    let corners = [[-3.0, -3.0, -1.2], [3.0, -3.0, -1.2], [0.0, 4.0, -1.2]].map(Point::from);
    let up = Vector::<f64, 3>::z();
    let clip = |nearest: Option<f64>, least: f64| {
        let request = ClipRequest::new(solid.geometry().0, up, nearest, least).expect("a face");
        let scene = Scene { triangles: vec![corners], requests: vec![request] };
        let identity = (&Matrix::<f64, 3>::identity(), Vector::<f64, 3>::zeros());
        scene.found(Level::new(), &solid, identity).remove(0)
    };
    let near = clip(Some(0.2 - 1e-16), -f64::INFINITY).expect("that near");
    assert_eq!((near.len(), near[0].distance), (4, 0.2 - 1e-16), "as it is known");
    assert!(clip(Some(0.1), -f64::INFINITY).is_none(), "no point is that near");
    assert_eq!(clip(None, 0.2).expect("all are").len(), 4, "none is nearer");
    assert_eq!(clip(None, 0.3).expect("none is").len(), 0, "all are nearer than they can be");
}

#[test]
fn edges_and_corners_of_a_solid_are_clipped_too() {
    let solid = Cuboid::new(Vector::<f64, 3>::repeat(1.0));
    let found = |up: [f64; 3], size: f64| {
        let normal = Vector::<f64, 3>::from(up).normalize();
        let (u, v) = orthonormal_basis(&normal);
        let low = Point::from(-normal * 2.0);
        let corners = [
            low - u * size - v * size,
            low + u * (3.0 * size) - v * size,
            low + v * (3.0 * size) - u * size,
        ];
        let scene = Scene::new(&solid, vec![(corners, normal)]);
        let identity = (&Matrix::<f64, 3>::identity(), Vector::<f64, 3>::zeros());
        scene.found(Level::new(), &solid, identity).remove(0)
    };
    let edge = found([0.0, 1.0, 1.0], 2.0).expect("in lanes");
    assert_eq!(edge.len(), 2, "the ends of an edge: {edge:?}");
    let depth = 2.0 - 2.0_f64.sqrt();
    for point in &edge {
        assert!((point.distance - depth).abs() < 1e-14, "{point:?}");
        assert!((point.point1.y + 1.0).abs() < 1e-14 && (point.point1.z + 1.0).abs() < 1e-14);
        assert!(matches!(point.feature1, FeatureId::Vertex(_)), "{point:?}");
    }
    let short = found([0.0, 1.0, 1.0], 0.3).expect("in lanes");
    assert_eq!(short.len(), 2, "where the edge leaves the triangle: {short:?}");
    assert!(short.iter().all(|point| matches!(point.feature2, FeatureId::Edge(_))), "{short:?}");
    let corner = found([1.0, 1.0, 1.0], 2.0).expect("in lanes");
    assert_eq!(corner.len(), 1, "{corner:?}");
    let error = (corner[0].point1 - Point::from([-1.0; 3])).norm();
    assert!(error < 1e-14 && (corner[0].distance - 2.0 + 3.0_f64.sqrt()).abs() < 1e-14);
}
