//! Tests that queries of single pairs are scale invariant: shapes with corners on a grid, whose
//! features often meet in degenerate ways, are scaled by powers of two.

use crate::support::query_support;

use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::query::{ImpactOptions, Moving, contact, distance, impact, proximity, witness};
use impinge::shape::{
    Ball, Capsule, Compound, Cuboid, HeightField, Polyline, Segment, Shape, ShapeHandle, TriMesh,
    Triangle,
};
use query_support::random::Random;

/// Exponents of the factors by which shapes are scaled.
const POWERS: [i32; 5] = [-20, -7, 5, 9, 20];

/// Returns a random corner on a grid of spacing 0.25.
fn corner<const D: usize>(random: &mut Random) -> [f64; D] {
    std::array::from_fn(|_| (random.signed() * 4.5).round() * 0.25)
}

/// Random corners, from which shapes of any size are made.
struct Draw<const D: usize> {
    corners: Vec<[f64; D]>,
    kind: usize,
}

fn draw<const D: usize>(random: &mut Random, kind: usize) -> Draw<D> {
    let mut corners: Vec<[f64; D]> = (0..6).map(|_| corner(random)).collect();
    if corners[1] == corners[0] {
        corners[1][0] += 0.5;
    }
    Draw { corners, kind }
}

impl<const D: usize> Draw<D> {
    fn points<N: Real>(&self, scale: f64) -> Vec<Point<N, D>> {
        let scaled = |corner: &[f64; D]| Point::from(corner.map(|x| N::lit(x * scale)));
        self.corners.iter().map(scaled).collect()
    }

    fn half<N: Real>(&self, scale: f64) -> Vector<N, D> {
        let sizes = self.corners[0].map(|x: f64| N::lit((x.abs() + 0.25) * scale));
        Vector::<N, D>::from(sizes)
    }

    /// Returns a shape of the kind, if it is one that exists in both dimensions; `None` for the
    /// other kinds.
    fn shape<N: Space<D>>(&self, scale: f64) -> Option<ShapeHandle<N, D>> {
        let p = self.points::<N>(scale);
        Some(match self.kind {
            0 => ShapeHandle::new(Segment::new(p[0], p[1])),
            1 => ShapeHandle::new(Triangle::new(p[0], p[1], p[2])),
            2 => ShapeHandle::new(Cuboid::new(self.half(scale))),
            3 => ShapeHandle::new(Ball::new(self.half::<N>(scale)[0])),
            4 => ShapeHandle::new(
                Capsule::try_from_ends(p[0], p[1], N::lit(0.25 * scale)).expect("finite"),
            ),
            5 => ShapeHandle::new(Polyline::<N, D>::new(p, vec![[0, 1], [2, 3]])),
            6 => ShapeHandle::new(Polyline::<N, D>::open(p)),
            7 => ShapeHandle::new(TriMesh::<N, D>::new(p, vec![[0, 1, 2], [2, 1, 3], [3, 4, 5]])),
            8 => {
                let parts = [Segment::new(p[0], p[1]), Segment::new(p[2], p[3])];
                let identity = N::isometry(&impinge::math::Pose::identity());
                let parts = parts.map(|part| (identity, ShapeHandle::new(part)));
                ShapeHandle::new(Compound::<N, D>::new(parts.to_vec()))
            }
            _ => return None,
        })
    }
}

/// Returns the results of queries of two shapes: all lengths, all numbers that do not scale, and
/// all discrete results as text.
fn answers2<N: Space<2, Isometry = Isometry2<N>>>(
    shapes: [&dyn Shape<N, 2>; 2],
    offset: Vector<N, 2>,
    unit: N,
) -> (Vec<N>, Vec<N>, String) {
    let (here, there) = (Isometry2::identity(), Isometry2::new(offset, N::ZERO));
    let [one, other] = shapes;
    let (mut lengths, mut plain) = (vec![distance(&here, one, &there, other)], Vec::new());
    let mut words = format!("{:?}", proximity(&here, one, &there, other, unit * N::HALF));
    for prediction in [N::ZERO, unit * N::HALF] {
        if let Some(found) = contact(&here, one, &there, other, prediction) {
            lengths.push(found.depth);
            lengths.extend(found.world1.coords.iter().chain(found.world2.coords.iter()));
            plain.extend(found.normal.iter());
        }
        words += &format!(" {}", lengths.len());
    }
    if let Some(found) = witness(&here, one, &there, other, N::INFINITY) {
        lengths.push(found.distance);
        plain.extend(found.normal.iter());
    }
    let velocity = Vector::<N, 2>::new(-unit, unit * N::HALF);
    let moving = Moving::new(&there, &velocity, other);
    for at_start in [false, true] {
        let options = ImpactOptions::new().with_contact_at_start(at_start);
        if let Some(hit) = impact(&Moving::still(&here, one), &moving, &options) {
            plain.push(hit.toi);
            plain.extend(hit.normal.iter());
            lengths.extend(hit.world1.coords.iter());
            words += &format!(" {:?} {} {}", hit.status, hit.part1, hit.part2);
        }
    }
    (lengths, plain, words)
}

/// Returns the results of [`answers2`], in 3D.
fn answers3<N: Space<3, Isometry = Isometry3<N>>>(
    shapes: [&dyn Shape<N, 3>; 2],
    offset: Vector<N, 3>,
    unit: N,
) -> (Vec<N>, Vec<N>, String) {
    let (here, there) = (Isometry3::identity(), Isometry3::new(offset, Vector::zeros()));
    let [one, other] = shapes;
    let (mut lengths, mut plain) = (vec![distance(&here, one, &there, other)], Vec::new());
    let mut words = format!("{:?}", proximity(&here, one, &there, other, unit * N::HALF));
    for prediction in [N::ZERO, unit * N::HALF] {
        if let Some(found) = contact(&here, one, &there, other, prediction) {
            lengths.push(found.depth);
            lengths.extend(found.world1.coords.iter().chain(found.world2.coords.iter()));
            plain.extend(found.normal.iter());
        }
        words += &format!(" {}", lengths.len());
    }
    if let Some(found) = witness(&here, one, &there, other, N::INFINITY) {
        lengths.push(found.distance);
        plain.extend(found.normal.iter());
    }
    let velocity = Vector::<N, 3>::new(-unit, unit * N::HALF, unit * N::lit(0.25));
    let moving = Moving::new(&there, &velocity, other);
    for at_start in [false, true] {
        let options = ImpactOptions::new().with_contact_at_start(at_start);
        if let Some(hit) = impact(&Moving::still(&here, one), &moving, &options) {
            plain.push(hit.toi);
            plain.extend(hit.normal.iter());
            lengths.extend(hit.world1.coords.iter());
            words += &format!(" {:?} {} {}", hit.status, hit.part1, hit.part2);
        }
    }
    (lengths, plain, words)
}

/// Returns `true` if the numbers of `scaled` are those of `usual` times `scale`, to the bit, up to
/// the sign of zero.
fn are_scaled<N: Real>(usual: &[N], scaled: &[N], scale: N) -> bool {
    let is_scaled =
        |(a, b): (&N, &N)| (*a * scale).bits() == b.bits() || *a == N::ZERO && *b == N::ZERO;
    usual.len() == scaled.len() && usual.iter().zip(scaled).all(is_scaled)
}

/// Asserts that random shapes at other scales have the same results as at scale 1, with scaled
/// lengths.
fn hold<N: Space<D>, const D: usize>(
    seed: u64,
    answers: impl Fn([&dyn Shape<N, D>; 2], Vector<N, D>, N) -> (Vec<N>, Vec<N>, String),
) {
    let random = &mut Random(seed, false);
    for round in 0..1500 {
        let [one, other] = [5 + round % 4, round / 4 % 9].map(|kind| draw::<D>(random, kind));
        let offset = if round % 3 == 0 { corner::<D>(random) } else { [0.0; D] };
        let at = |scale: f64| {
            let [one, other] = [&one, &other].map(|draw| draw.shape::<N>(scale).expect("a kind"));
            let offset = Vector::<N, D>::from(offset.map(|x| N::lit(x * scale)));
            answers([&*one, &*other], offset, N::lit(scale))
        };
        let (lengths, plain, words) = at(1.0);
        for power in POWERS {
            let scale = 2.0_f64.powi(power);
            let scaled = at(scale);
            let what = format!(
                "kinds {} and {} of {:?} {:?} at {offset:?}, 2^{power}: {lengths:?} {scaled:?}",
                one.kind, other.kind, one.corners, other.corners
            );
            assert_eq!(words, scaled.2, "{what}");
            assert!(are_scaled(&lengths, &scaled.0, N::lit(scale)), "{what}");
            assert!(are_scaled(&plain, &scaled.1, N::ONE), "{plain:?} {what}");
        }
    }
}

#[test]
fn answers_on_a_grid_of_the_plane_scale() {
    hold::<f32, 2>(51, answers2);
    hold::<f64, 2>(52, answers2);
}

#[test]
fn answers_on_a_grid_of_space_scale() {
    hold::<f32, 3>(53, answers3);
    hold::<f64, 3>(54, answers3);
}

/// Asserts that segments that cross and touch have the depth of the crossing, with the numbers of a
/// bug report, also at sizes that are not powers of two.
#[test]
fn segments_that_cross_and_touch_have_the_depth_of_the_crossing() {
    fn check<N: Space<2, Isometry = Isometry2<N>>>() {
        for power in -30..30 {
            for share in [1.0, 1.5, 31.0 / 16.0, 1.1] {
                let size = share * 2.0_f64.powi(power);
                let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x * size), N::lit(y * size));
                let corners = vec![p(0.5, -0.5), p(-0.5, 0.5), p(0.0, 0.5), p(0.5, 0.0)];
                let line = Polyline::<N, 2>::new(corners, vec![[0, 1], [2, 3]]);
                let (probe, here) =
                    (Segment::new(p(0.0, 0.5), p(-0.5, 0.0)), Isometry2::identity());
                let found = contact(&here, &line, &here, &probe, N::ZERO).expect("they touch");
                let depth = found.depth.as_f64() / size;
                assert!((depth - 0.125_f64.sqrt()).abs() < 1e-6, "{depth} at {size}");
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

/// Asserts that height fields with scaled heights give scaled results.
#[test]
fn height_fields_scale() {
    let random = &mut Random(55, false);
    for _ in 0..300 {
        let heights: Vec<f64> = (0..5).map(|_| (random.signed() * 3.0).round() * 0.25).collect();
        let probe = draw::<2>(random, 0);
        let at = |scale: f64| {
            let heights = heights.iter().map(|y| y * scale).collect();
            let field =
                HeightField::<f64, 2>::new(heights, Vector::<f64, 2>::new(2.0 * scale, 1.0));
            let probe = probe.shape::<f64>(scale).expect("a segment");
            answers2([&field, &*probe], Vector::<f64, 2>::zeros(), scale)
        };
        let usual = at(1.0);
        for power in POWERS {
            let (scale, scaled) = (2.0_f64.powi(power), at(2.0_f64.powi(power)));
            assert_eq!(usual.2, scaled.2, "{heights:?} {:?}", probe.corners);
            assert!(are_scaled(&usual.0, &scaled.0, scale), "{heights:?} {:?}", probe.corners);
        }
    }
}
