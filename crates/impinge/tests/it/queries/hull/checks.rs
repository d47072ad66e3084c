//! Slow checks of the properties that define a hull.

use impinge::math::{Point, Real, Vector};
use impinge::transformation::{IndexedHull, convex_hull3};

use super::points::P3;

/// Errors of a hull in rounding units of the points: `EPSILON · max |coordinate|`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured {
    /// Greatest height of a given point above the highest vertex of a face, along its normal.
    pub(crate) outside: f64,
    /// Greatest depth of a vertex of a face below the highest vertex of that face, along the
    /// normal.
    pub(crate) bent: f64,
}

pub(crate) fn cast<N: Real>(points: &[P3]) -> Vec<Point<N, 3>> {
    points.iter().map(|p| Point::from(p.coords.map(N::lit))).collect()
}

/// Returns the points scaled to about 1, and the rounding unit at that scale.
fn normalized<N: Real>(points: &[Point<N, 3>]) -> (Vec<P3>, f64) {
    let exact: Vec<P3> = points.iter().map(|p| Point::from(p.coords.map(Real::as_f64))).collect();
    let size =
        exact.iter().flat_map(|p| p.iter().copied()).fold(0.0, |size: f64, x| size.max(x.abs()));
    // A power of two near the size, so that the division is exact.
    let scale = size.max(f64::MIN_POSITIVE).log2().floor().min(1023.0).exp2();
    (exact.iter().map(|p| p / scale).collect(), N::EPSILON.as_f64() * (size / scale))
}

fn sides<N: Real>(hull: &IndexedHull<N>) -> Vec<(usize, usize)> {
    let around = |ring: &Vec<usize>| {
        (0..ring.len()).map(|at| (ring[at], ring[(at + 1) % ring.len()])).collect::<Vec<_>>()
    };
    hull.faces.iter().flat_map(around).collect()
}

/// Asserts that the surface is closed and has the topology of a sphere, that every vertex is on a
/// face, and that no directed side occurs twice.
fn topology<N: Real>(hull: &IndexedHull<N>) {
    assert!(hull.vertices.windows(2).all(|pair| pair[0] < pair[1]), "ascending");
    let mut used = hull.faces.concat();
    used.sort_unstable();
    used.dedup();
    assert_eq!(used, hull.vertices, "the vertices are those of the faces");
    let mut forward = sides(hull);
    let mut backward: Vec<_> = forward.iter().map(|&(from, to)| (to, from)).collect();
    forward.sort_unstable();
    backward.sort_unstable();
    assert_eq!(forward, backward, "each side has one twin");
    assert!(forward.windows(2).all(|pair| pair[0] != pair[1]), "no side is there twice");
    let edges = forward.len() / 2;
    assert_eq!(hull.vertices.len() + hull.faces.len(), edges + 2, "Euler");
}

/// Asserts that the topology and the normals of a hull are right, and measures its errors over all
/// points. With very many points it examines only some of the faces.
pub(crate) fn check<N: Real>(points: &[Point<N, 3>], hull: &IndexedHull<N>) -> Measured {
    topology(hull);
    let (exact, unit) = normalized(points);
    let mut measured = Measured { outside: 0.0, bent: 0.0 };
    let stride = 1 + exact.len() * hull.faces.len() / 20_000_000;
    assert_eq!(hull.normals.len(), hull.faces.len(), "a normal for each face");
    for (ring, normal) in hull.faces.iter().zip(&hull.normals).step_by(stride) {
        let normal = normal.map(Real::as_f64);
        assert!((normal.norm() - 1.0).abs() < 4.0 * N::EPSILON.as_f64(), "unit: {normal}");
        let height = |p: &P3| normal.dot(&(p - exact[ring[0]])) / unit;
        let heights = || ring.iter().map(|&v| height(&exact[v]));
        let top = heights().fold(f64::NEG_INFINITY, f64::max);
        measured.bent = heights().map(|height| top - height).fold(measured.bent, f64::max);
        let above = exact.iter().map(|p| height(p) - top);
        measured.outside = above.fold(measured.outside, f64::max);
        for at in 0..ring.len() {
            let [a, b, c] = [0, 1, 2].map(|step| exact[ring[(at + step) % ring.len()]]);
            let outside_chord = (b - a).cross(&(c - b)).dot(&normal) / ((c - a).norm() * unit);
            assert!(outside_chord >= -8.0, "a face turns right by {outside_chord}: {ring:?}");
        }
    }
    measured.outside = measured.outside.max(cut_off(&exact, hull) / unit);
    measured
}

/// Returns the largest distance by which points extend beyond the vertices along the axes and
/// diagonals. This finds points that are cut off at the rim of a flat set, where no face points.
fn cut_off<N: Real>(points: &[P3], hull: &IndexedHull<N>) -> f64 {
    let reach = |along: &Vector<f64, 3>, points: &mut dyn Iterator<Item = &P3>| {
        points.map(|p| along.dot(&p.coords)).fold(f64::NEG_INFINITY, f64::max)
    };
    let third = |digit: i32| f64::from(digit % 3 - 1);
    let directions = (0..27).filter(|&n| n != 13).map(|n| [third(n), third(n / 3), third(n / 9)]);
    let missing = directions.map(|along| {
        let along = Vector::<f64, 3>::from(along).normalize();
        let vertices = &mut hull.vertices.iter().map(|&vertex| &points[vertex]);
        reach(&along, &mut points.iter()) - reach(&along, vertices)
    });
    missing.fold(0.0, f64::max)
}

/// Computes the hull of points, given as `f64`, with the scalar `N`, and returns it. Asserts the
/// documented tolerance of 8 units.
pub(crate) fn hull_of<N: Real>(name: &str, points: &[P3]) -> IndexedHull<N> {
    hull_within::<N>(8.0, name, points)
}

/// Returns the hull of points, and asserts that no point lies more than `outside` units in front of
/// a face.
pub(crate) fn hull_within<N: Real>(outside: f64, name: &str, points: &[P3]) -> IndexedHull<N> {
    let points = cast::<N>(points);
    let hull = convex_hull3(&points).unwrap_or_else(|error| panic!("{name}: {error}"));
    let measured = check(&points, &hull);
    assert!(measured.outside <= outside && measured.bent <= 8.0, "{name}: {measured:?}");
    hull
}
