//! Parts of scenes: placements, flat and hilly terrain, hulls.

use impinge_scenes::{Placement, Random, SceneShape};

/// The tangent of π/8: half of the angle π/4.
pub(crate) const EIGHTH_TURN: f64 = 0.198_912_367_379_658;
/// The tangent of 0.15: half of the angle 0.3.
pub(crate) const TURN_03: f64 = 0.151_135_218_058_295_1;
/// The tangent of π/4: half of the angle π/2.
pub(crate) const QUARTER_TURN: f64 = 1.0;

/// Returns a placement with a rotation about an axis, given by the tangent of half its angle.
pub(crate) fn turned<const D: usize>(at: [f64; D], axis: [f64; 3], tangent: f64) -> Placement<D> {
    Placement { axis, tangent, ..Placement::at(at) }
}

/// Returns a placement with a rotation about the vertical axis.
pub(crate) fn spun(at: [f64; 3], tangent: f64) -> Placement<3> {
    turned(at, [0.0, 1.0, 0.0], tangent)
}

/// Returns `tan(n a / 2)` for `tangent = tan(a / 2)`, by the addition theorem of the tangent.
pub(crate) fn times(tangent: f64, n: usize) -> f64 {
    (0..n).fold(0.0, |sum, _| (sum + tangent) / (1.0 - sum * tangent))
}

/// Returns a cube, in 2D a square, of edge 1.
pub(crate) fn cube<const D: usize>() -> SceneShape<D> {
    SceneShape::Cuboid { half_extents: [0.5; D] }
}

/// Returns the half-space `y <= 0`.
pub(crate) fn half_space<const D: usize>() -> SceneShape<D> {
    SceneShape::Plane { normal: core::array::from_fn(|axis| if axis == 1 { 1.0 } else { 0.0 }) }
}

/// Returns a mesh of `columns` × `rows` square cells of a given size around the origin, with two
/// triangles per cell. The heights of the vertices are a function of column and row.
pub(crate) fn mesh(
    [columns, rows]: [usize; 2],
    cell: f64,
    height: impl Fn(usize, usize) -> f64,
) -> SceneShape<3> {
    let middle = [columns, rows].map(|n| 0.5 * cell * n as f64);
    let corners = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)));
    let vertices = corners.map(|(column, row)| {
        let [x, z] =
            [(column, middle[0]), (row, middle[1])].map(|(n, half)| n as f64 * cell - half);
        [x, height(column, row), z]
    });
    let number = |n: usize| u32::try_from(n).expect("a scene has few vertices");
    let at = |column: usize, row: usize| number(row * (columns + 1) + column);
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        [[a, c, d], [a, d, b]]
    });
    SceneShape::TriMesh { vertices: vertices.collect(), triangles: triangles.collect() }
}

/// Returns a mesh of twelve by twelve cells of size 1.
pub(crate) fn flat_mesh() -> SceneShape<3> {
    mesh([12, 12], 1.0, |_, _| 0.0)
}

/// Returns a height field of `columns` × `rows` cells over a rectangle around the origin, with
/// heights as a function of column and row.
pub(crate) fn field(
    [columns, rows]: [usize; 2],
    [width, depth]: [f64; 2],
    height: impl Fn(usize, usize) -> f64,
) -> SceneShape<3> {
    let counts = [rows + 1, columns + 1];
    let corners = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)));
    let heights = corners.map(|(column, row)| height(column, row)).collect();
    SceneShape::HeightField { counts, heights, extents: [width, 1.0, depth] }
}

/// Returns the height function of a terrain with hollows in which solids come to rest: one hollow
/// of depth `depth` for every two cells in each direction.
pub(crate) fn egg_box(depth: f64) -> impl Fn(usize, usize) -> f64 {
    move |column, row| if column % 2 == 1 && row % 2 == 1 { -depth } else { 0.0 }
}

/// Returns a regular dodecahedron of inradius 0.5 that lies on a face. Its corners are (±1, ±1,
/// ±1), (0, ±1/φ, ±φ) and their cyclic permutations. A face has the normal (0, φ, 1), which is
/// rotated to the vertical.
pub(crate) fn dodecahedron() -> SceneShape<3> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut points = Vec::new();
    for [a, b] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        points.extend([[a, b, -1.0], [a, b, 1.0]]);
        let (short, long) = (a / golden, b * golden);
        points.extend([[0.0, short, long], [short, long, 0.0], [long, 0.0, short]]);
    }
    let length = (golden * golden + 1.0).sqrt();
    let (cosine, sine) = (golden / length, 1.0 / length);
    let lie = |[x, y, z]: [f64; 3]| [x, y * cosine + z * sine, z * cosine - y * sine];
    let points: Vec<_> = points.into_iter().map(lie).collect();
    let top = points.iter().fold(0.0, |top, p| if p[1] > top { p[1] } else { top });
    let near_top = |y: f64| if y.abs() > 0.999 * top { 0.5 * y.signum() } else { 0.5 * y / top };
    let points = points.into_iter().map(|[x, y, z]| [0.5 * x / top, near_top(y), 0.5 * z / top]);
    SceneShape::Convex { points: points.collect() }
}

/// Returns a hull with a flat top and a flat bottom at the heights ±0.4, each of `sides` random
/// corners. The other corners are random points of a sphere of radius 0.6; if a height exceeds 0.35
/// in magnitude, it is multiplied by 0.35.
pub(crate) fn flat_hull(random: &mut Random, sides: usize) -> SceneShape<3> {
    let mut points = Vec::new();
    for height in [-0.4, 0.4] {
        for _ in 0..sides {
            let [x, z] = random.direction::<2>();
            let radius = random.between(0.4, 0.5);
            points.push([x * radius, height, z * radius]);
        }
    }
    for _ in 0..4 * sides {
        let [x, y, z] = random.direction::<3>().map(|x| 0.6 * x);
        points.push([x, if y.abs() < 0.35 { y } else { 0.35 * y }, z]);
    }
    SceneShape::Convex { points }
}

/// Returns the hull of random points of a sphere.
pub(crate) fn round_hull(random: &mut Random, points: usize, radius: f64) -> SceneShape<3> {
    let points = (0..points).map(|_| random.direction::<3>().map(|x| x * radius));
    SceneShape::Convex { points: points.collect() }
}
