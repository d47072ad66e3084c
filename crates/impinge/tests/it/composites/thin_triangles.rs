//! Compares nearest points on thin triangles, down to segments and points, with the exact result.
//! Tests single triangles, meshes and faces of hulls in 3D, and outlines in 2D. Errors are in units
//! of epsilon times the size of the scene.

use std::collections::BTreeMap;

use impinge::math::{Isometry3, Point, Real, Space};
use impinge::query::{Barycentric, PointQuery, distance};
use impinge::shape::{Ball, ConvexHull, Segment, Tetrahedron, TriMesh, Triangle};
use impinge_reference::geometry::vector as plain;
use impinge_reference::precise::Quad;
use impinge_reference::precise::vector::{
    Vector, add, dot, exact, negate, norm, perpendicular, reject, scale, sub, unit,
};
use impinge_reference::random::Random;

/// Greatest error allowed, in units of epsilon times the size of the scene.
const UNITS: f64 = 16.0;

fn fraction<const D: usize>([a, b]: [&Vector<D>; 2], p: &Vector<D>) -> Quad {
    let along = sub(b, a);
    let whole = dot(&along, &along);
    if whole == Quad::ZERO {
        return whole;
    }
    (dot(&sub(p, a), &along) / whole).max(Quad::ZERO).min(Quad::ONE)
}

fn between<const D: usize>([a, b]: [&Vector<D>; 2], share: Quad) -> Vector<D> {
    add(a, &scale(&sub(b, a), share))
}

fn on_segment<const D: usize>(ends: [&Vector<D>; 2], p: &Vector<D>) -> Vector<D> {
    between(ends, fraction(ends, p))
}

/// Returns the distance of a point from a triangle, and proves it. A point of the triangle is at
/// that distance, and a plane at that distance separates the triangle from the point.
fn exact_distance(corners: &[[f64; 3]; 3], p: &[f64; 3]) -> f64 {
    let (corners, p) = (corners.map(|corner| exact(&corner)), exact(p));
    let length = |at: usize| norm(&sub(&corners[(at + 1) % 3], &corners[at])).to_f64();
    let from = (0..3).max_by(|&a, &b| length(a).total_cmp(&length(b))).expect("three");
    let [a, b, c] = [0, 1, 2].map(|at| corners[(from + at) % 3]);
    let (place, peak) = (fraction([&a, &b], &p), fraction([&a, &b], &c));
    let end = match place <= peak {
        true if peak > Quad::ZERO => between([&a, &c], place / peak),
        true => c,
        false => between([&b, &c], (Quad::ONE - place) / (Quad::ONE - peak)),
    };
    let chord = [&between([&a, &b], place), &end];
    let candidates = [[&a, &b], [&b, &c], [&c, &a], chord].map(|ends| on_segment(ends, &p));
    let apart = |q: &Vector<3>| norm(&sub(&p, q));
    let nearest =
        candidates.iter().min_by(|q, r| apart(q).partial_cmp(&apart(r)).expect("numbers"));
    let offset = sub(&p, nearest.expect("four"));
    let normal = perpendicular(&[sub(&a, &c), sub(&b, &c)]);
    let sides = [[&a, &b], [&b, &c], [&c, &a]].map(|[from, to]| sub(to, from));
    let sides = sides.iter().filter(|side| norm(side) > Quad::ZERO);
    let beside = sides.map(|side| reject(&offset, side));
    let parted = beside.chain([offset, normal, negate(&normal)]).filter_map(|way| unit(&way));
    let low = |direction: Vector<3>| {
        let heights = corners.map(|corner| dot(&direction, &sub(&p, &corner)));
        heights[0].min(heights[1]).min(heights[2])
    };
    let low = parted.map(low).fold(Quad::ZERO, Quad::max);
    let (high, size) = (norm(&offset), largest(&[corners[0], corners[1], corners[2], p]));
    assert!((high - low).to_f64() <= 2e-17 * size, "{low:?} to {high:?}: {corners:?} {p:?}");
    high.to_f64()
}

fn largest<const D: usize>(points: &[Vector<D>]) -> f64 {
    points.iter().map(|point| norm(point).to_f64()).fold(0.0, f64::max)
}

fn power(exponent: i32) -> f64 {
    2.0_f64.powi(exponent)
}

fn rounded<N: Real, const D: usize>(v: [f64; D]) -> [f64; D] {
    v.map(|x| N::lit(x).as_f64())
}

fn mixed(random: &mut Random, [a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (random.share(), random.share());
    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
    std::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * u + (c[axis] - a[axis]) * v)
}

/// Returns a thin triangle and two unit vectors: its thin direction and its normal.
fn triangle<N: Real>(random: &mut Random) -> ([[f64; 3]; 3], [[f64; 3]; 2]) {
    let along = if random.chance(0.2) { plain::axis(0) } else { random.unit_vector() };
    let across = plain::perpendicular(&[along, random.unit_vector()]);
    let length = random.magnitude(1.0, 5);
    let digits = if N::EPSILON.as_f64() > 1e-10 { 24 } else { 52 };
    let height = length * 2.0 / random.magnitude(1.0, digits);
    let peak = match random.below(6) {
        0 => random.share() * 2.0 * height / length,
        1 => 1.0 - random.share() * 2.0 * height / length,
        2 => random.range(-0.5, 1.5),
        3 => [0.0, 0.5, 1.0][random.below(3)],
        _ => random.share(),
    };
    let away = [0.0, 20.0, 1e6][random.below(3)];
    let a = plain::add(&plain::scale(&random.unit_vector(), away), &random.vector(length));
    let b = plain::add(&a, &plain::scale(&along, length));
    let mut c = plain::add(&a, &plain::scale(&along, length * peak));
    if random.chance(0.9) {
        c = plain::add(&c, &plain::scale(&across, height));
    }
    let mut corners = match random.below(20) {
        0 => [a, b, a],
        1 => [a, b, b],
        2 => [a, a, a],
        _ => [a, b, c],
    };
    corners.rotate_left(random.below(3));
    (corners.map(rounded::<N, 3>), [across, plain::perpendicular(&[along, across])])
}

/// Returns a point near a triangle, and whether it lies on the triangle up to the rounding of its
/// coordinates.
fn asked(
    random: &mut Random,
    corners: &[[f64; 3]; 3],
    [across, normal]: [[f64; 3]; 2],
) -> ([f64; 3], bool) {
    let [a, b, c] = *corners;
    let length = plain::norm(&plain::sub(&b, &a)) + plain::norm(&plain::sub(&c, &a));
    let inner = mixed(random, corners);
    let on_line = |share: f64| std::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * share);
    let moved = |way: [f64; 3], size: f64| plain::add(&inner, &plain::scale(&way, size));
    match random.below(8) {
        0 => (inner, true),
        1 => (on_line(random.share()), true),
        2 => (corners[random.below(3)], true),
        3 => (on_line(random.range(-2.0, 3.0)), false),
        4 => (moved(normal, length / random.magnitude(1.0, 50)), false),
        5 => (moved(across, length / random.magnitude(1.0, 50)), false),
        6 => (moved(random.unit_vector(), length / random.magnitude(1.0, 50)), false),
        _ => (moved(random.unit_vector(), length * random.magnitude(1.0, 20)), false),
    }
}

/// The worst error of each kind of query, in units of epsilon times the size of the scene, with a
/// description of its case.
#[derive(Default)]
struct Worst(BTreeMap<&'static str, (f64, String)>);

impl Worst {
    fn note(&mut self, name: &'static str, units: f64, what: impl FnOnce() -> String) {
        let worst = self.0.entry(name).or_insert((0.0, String::new()));
        if units > worst.0 || units.is_nan() {
            *worst = (units, what());
        }
    }

    fn check(&self) {
        for (name, (units, what)) in &self.0 {
            assert!(*units <= UNITS, "{name} is off by {units} units: {what}");
        }
    }
}

/// A triangle and a point, in `f64` and in the scalar type scaled by `factor`.
struct Scene<N: Real> {
    corners: [[f64; 3]; 3],
    point: [f64; 3],
    factor: f64,
    of_scalar: ([Point<N, 3>; 3], Point<N, 3>),
}

impl<N: Space<3>> Scene<N> {
    fn new(corners: [[f64; 3]; 3], point: [f64; 3], factor: f64) -> Self {
        let point = rounded::<N, 3>(point);
        let narrow = |p: [f64; 3]| Point::<N, 3>::from(p.map(|x| N::lit(x * factor)));
        Self { corners, point, factor, of_scalar: (corners.map(narrow), narrow(point)) }
    }

    fn size(&self) -> f64 {
        let [a, b, c] = self.corners;
        largest(&[a, b, c, self.point].map(|point| exact(&point)))
    }

    /// Returns the distance from the point to the farthest corner.
    fn extent(&self) -> f64 {
        largest(&self.corners.map(|corner| sub(&exact(&corner), &exact(&self.point))))
    }

    fn wide(&self, point: &Point<N, 3>) -> [f64; 3] {
        let coordinates: [N; 3] = point.coords.into();
        coordinates.map(|x| x.as_f64() / self.factor)
    }

    fn what(&self) -> String {
        format!("{:?} and {:?}, times {}", self.corners, self.point, self.factor)
    }

    fn ask(&self, worst: &mut Worst, is_own: bool) {
        let ([a, b, c], point) = &self.of_scalar;
        let here = Isometry3::<N>::identity();
        let triangle = Triangle::new(*a, *b, *c);
        let truth = exact_distance(&self.corners, &self.point);
        let unit = N::EPSILON.as_f64() * self.size();
        let found = triangle.distance_to_point(&here, point, true);
        let wide = found.as_f64() / self.factor;
        let mut note = |name, error: f64| worst.note(name, error.abs() / unit, || self.what());
        note("distance", wide - truth);
        let holds = triangle.contains_point(&here, point);
        assert!(holds || !is_own, "holds its own points: {}", self.what());
        assert_eq!(holds, found == N::ZERO, "one fact: {}", self.what());
        let (projected, location) = triangle.project_local_point_with_location(point, false);
        let nearest = self.wide(&projected.point);
        note("off the triangle", exact_distance(&self.corners, &nearest));
        let apart = norm(&sub(&exact(&nearest), &exact(&self.point))).to_f64();
        note("projection", apart - truth);
        let Barycentric::Triangle(weights) = location.barycentric else { panic!("a triangle") };
        assert!(weights.iter().all(|&weight| weight >= N::ZERO), "{weights:?}: {}", self.what());
        let mean = a.coords * weights[0] + b.coords * weights[1] + c.coords * weights[2];
        let mean = self.wide(&Point::from(mean));
        note("weights", norm(&sub(&exact(&mean), &exact(&nearest))).to_f64());
        if self.factor == 1.0 {
            let at = Isometry3::<N>::translation(point.x, point.y, point.z);
            let of_ball = distance(&here, &triangle, &at, &Ball::new(N::ZERO));
            note("beside that of a ball", of_ball.as_f64() - wide);
        }
        self.ask_mesh(worst, truth);
    }

    /// Records the error of the distance from a mesh of the triangle. The unit is epsilon times the
    /// distance from the point to the farthest corner, wherever the mesh lies.
    fn ask_mesh(&self, worst: &mut Worst, truth: f64) {
        let (corners, point) = &self.of_scalar;
        let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]);
        let found = mesh.signed_distance_to_local_point(point).as_f64() / self.factor;
        let unit = N::EPSILON.as_f64() * self.extent().max(f64::MIN_POSITIVE / N::EPSILON.as_f64());
        worst.note("mesh", (found - truth).abs() / unit, || self.what());
    }
}

fn scenes<N: Space<3>>(seed: u64, far: i32) {
    let (mut random, mut worst) = (Random::new(seed), Worst::default());
    for _ in 0..4000 {
        let (corners, frame) = triangle::<N>(&mut random);
        let (point, is_own) = asked(&mut random, &corners, frame);
        let factor = power([0, 0, far, -far][random.below(4)]);
        Scene::<N>::new(corners, point, factor).ask(&mut worst, is_own);
    }
    worst.check();
}

#[test]
fn triangles_in_single_precision() {
    scenes::<f32>(1, 97);
}

#[test]
fn triangles_in_double_precision() {
    scenes::<f64>(2, 660);
}

#[test]
fn a_needle_holds_its_own_point() {
    let needle = Triangle::new(
        Point::<f64, 3>::new(-19.999998092651367, 20.0, 20.0),
        Point::<f64, 3>::new(19.99998664855957, -20.000011444091797, 20.0),
        Point::<f64, 3>::new(0.0, 0.0, 20.0),
    );
    let own = Point::<f64, 3>::new(13.92673975328195, -13.926757064739975, 20.0);
    assert_eq!(needle.distance_to_point(&Isometry3::identity(), &own, true), 0.0, "a point of it");
}

const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Returns six times the signed volume of a tetrahedron.
fn volume([a, b, c, d]: [&Vector<3>; 4]) -> Quad {
    let (u, v, w) = (sub(b, a), sub(c, a), sub(d, a));
    let minor = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
    minor(1, 2) * w[0] + minor(2, 0) * w[1] + minor(0, 1) * w[2]
}

/// Compares signed distances of points from tetrahedra that have a thin triangle as a face with the
/// exact distance. Each tetrahedron is tested as a solid, as a hull and as a closed mesh; for the
/// mesh only the magnitude of the distance is compared.
fn tetrahedra<N: Space<3>>(seed: u64) {
    let (mut random, mut worst, mut count) = (Random::new(seed), Worst::default(), 0);
    for _ in 0..2000 {
        let (base, frame) = triangle::<N>(&mut random);
        let (point, _) = asked(&mut random, &base, frame);
        let point = rounded::<N, 3>(point);
        let top = plain::add(&mixed(&mut random, &base), &random.vector(4.0));
        let corners = [base[0], base[1], base[2], rounded::<N, 3>(top)];
        let wide = corners.each_ref().map(exact);
        let asked = exact(&point);
        let within = FACES.iter().enumerate().all(|(out, &[i, j, k])| {
            let own = volume([&wide[i], &wide[j], &wide[k], &wide[out]]).to_f64();
            let seen = volume([&wide[i], &wide[j], &wide[k], &asked]).to_f64();
            own != 0.0 && own * seen >= 0.0
        });
        let from_faces = FACES.map(|face| exact_distance(&face.map(|at| corners[at]), &point));
        let truth = from_faces.into_iter().fold(f64::INFINITY, f64::min);
        let truth = if within { -truth } else { truth };
        let narrow = |p: [f64; 3]| Point::<N, 3>::from(p.map(N::lit));
        let solid = Tetrahedron::new(corners.map(narrow));
        let unit = N::EPSILON.as_f64() * largest(&[wide[0], wide[1], wide[2], wide[3], asked]);
        let found = solid.signed_distance_to_local_point(&narrow(point)).as_f64();
        let what = || format!("{corners:?} and {point:?}: {found}, not {truth}");
        // A tetrahedron without volume uses the generic path. Far from the origin, planes are only
        // as exact as the coordinates, and sharp corners multiply that error.
        if solid.polytope().is_some() && norm(&wide[0]).to_f64() < 100.0 {
            worst.note("tetrahedron", (found - truth).abs() / unit, what);
            count += 1;
        }
        if let Ok(hull) = ConvexHull::try_from_points(&corners.map(narrow)) {
            let found = hull.signed_distance_to_local_point(&narrow(point)).as_f64();
            worst.note("hull", (found - truth).abs() / unit, what);
        }
        let faces = FACES.map(|face| face.map(|at| u32::try_from(at).expect("small")));
        let mesh = TriMesh::new(corners.map(narrow).to_vec(), faces.to_vec());
        if let Some(found) = mesh.signed_distance(&narrow(point)) {
            worst.note("closed mesh", (found.as_f64().abs() - truth.abs()).abs() / unit, what);
        }
    }
    assert!(count > 200, "{count} have a volume");
    worst.check();
}

#[test]
fn tetrahedra_in_single_precision() {
    tetrahedra::<f32>(3);
}

#[test]
fn tetrahedra_in_double_precision() {
    tetrahedra::<f64>(4);
}

/// Compares the distances of points from the outlines of thin triangles in 2D, and from segments,
/// with the exact distance.
fn outlines<N: Space<2>>(seed: u64) {
    let (mut random, mut worst) = (Random::new(seed), Worst::default());
    for _ in 0..4000 {
        let [along, away] = [(); 2].map(|()| random.unit_vector::<2>());
        let length = random.magnitude(1.0, 5);
        let a = plain::scale(&away, [0.0, 20.0, 1e6][random.below(3)]);
        let b = plain::add(&a, &plain::scale(&along, length));
        let across = plain::perpendicular(&[along]);
        let mut near = |size: f64| {
            let along = plain::add(&a, &plain::scale(&along, length * random.range(-0.2, 1.2)));
            plain::add(&along, &plain::scale(&across, size / random.magnitude(1.0, 50)))
        };
        let corners = [a, b, near(length)].map(rounded::<N, 2>);
        let point = rounded::<N, 2>(near(4.0 * length));
        let (wide, asked) = (corners.each_ref().map(exact), exact(&point));
        let unit = N::EPSILON.as_f64() * largest(&[wide[0], wide[1], wide[2], asked]);
        let from_side = |at: usize| {
            let side = [&wide[at], &wide[(at + 1) % 3]];
            norm(&sub(&asked, &on_segment(side, &asked))).to_f64()
        };
        let narrow = |p: [f64; 2]| Point::<N, 2>::from(p.map(N::lit));
        let ([a, b, c], point) = (corners.map(narrow), narrow(point));
        let what = || format!("{corners:?} and {point:?}");
        let found = Triangle::new(a, b, c).signed_distance_to_local_point(&point).as_f64().abs();
        let truth = from_side(0).min(from_side(1)).min(from_side(2));
        worst.note("outline", (found - truth).abs() / unit, what);
        let found = Segment::new(a, b).signed_distance_to_local_point(&point).as_f64();
        worst.note("segment", (found - from_side(0)).abs() / unit, what);
    }
    worst.check();
}

#[test]
fn outlines_in_the_plane() {
    outlines::<f32>(5);
    outlines::<f64>(6);
}
