//! Meshes that are not made by the library, and scenes that consist of them.

use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::dim3::math::{Isometry, Point, Vector};
use impinge::math::{Real, Space};
use impinge::{dim2, math};

pub(crate) const SLATE: Color = Color::rgb(124, 146, 176);
pub(crate) const SAND: Color = Color::rgb(214, 190, 150);
pub(crate) const SAGE: Color = Color::rgb(150, 178, 146);
pub(crate) const CLAY: Color = Color::rgb(204, 128, 104);
pub(crate) const INK: Color = Color::rgb(90, 120, 150);
pub(crate) const RED: Color = Color::rgb(196, 54, 60);

/// The faces of a box. Corner `i` is at the upper end of axis `k` if bit `k` of `i` is set.
const FACES: [[u32; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

pub(crate) fn box_mesh<N: Real>(id: u64, half: [f64; 3]) -> ShapeMesh<N, 3> {
    let sign = |corner: u32, axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let corner =
        |corner| Point::from([0, 1, 2].map(|axis| N::lit(half[axis] * sign(corner, axis))));
    let edge = |from: u32, axis: u32| (from >> axis & 1 == 0).then_some([from, from | 1 << axis]);
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    ShapeMesh {
        id,
        vertices: (0..8).map(corner).collect(),
        lines: (0..24).filter_map(|index| edge(index % 8, index / 8)).collect(),
        triangles: FACES.into_iter().flat_map(halves).collect(),
    }
}

const AROUND: u32 = 48;
const RINGS: u32 = 24;

/// Returns the mesh of a ball by latitude and longitude, with three great circles as lines.
pub(crate) fn ball_mesh<N: Real>(id: u64, radius: f64) -> ShapeMesh<N, 3> {
    let step = std::f64::consts::TAU / f64::from(AROUND);
    let vertex = |ring: u32, turn: u32| {
        let (sine, cosine) = (f64::from(ring) * step).sine_cosine();
        let (east, north) = (f64::from(turn) * step).sine_cosine();
        Point::from([sine * north, cosine, sine * east].map(|x| N::lit(radius * x)))
    };
    let index = |ring: u32, turn: u32| ring * AROUND + turn % AROUND;
    let cells = (0..RINGS).flat_map(|ring| (0..AROUND).map(move |turn| (ring, turn)));
    let triangles = |(ring, turn)| {
        let (a, b) = (index(ring, turn), index(ring, turn + 1));
        let (c, d) = (index(ring + 1, turn), index(ring + 1, turn + 1));
        [[a, b, d], [a, d, c]]
    };
    let equator = (0..AROUND).map(|turn| [index(RINGS / 2, turn), index(RINGS / 2, turn + 1)]);
    let meridians = (0..RINGS).flat_map(|ring| {
        [0, 1, 2, 3].map(|q| [index(ring, q * AROUND / 4), index(ring + 1, q * AROUND / 4)])
    });
    ShapeMesh {
        id,
        vertices: (0..=RINGS).flat_map(|r| (0..AROUND).map(move |t| vertex(r, t))).collect(),
        lines: equator.chain(meridians).collect(),
        triangles: cells.flat_map(triangles).collect(),
    }
}

/// Returns the mesh of soft hills on a square with half extent `half`, with a grid of lines.
pub(crate) fn terrain_mesh<N: Real>(id: u64, half: f64, height: f64) -> ShapeMesh<N, 3> {
    const CELLS: u32 = 24;
    let at = |cell: u32| (f64::from(cell) / f64::from(CELLS) * 2.0 - 1.0) * half;
    let vertex = |row: u32, column: u32| {
        let (x, z) = (at(column), at(row));
        let y = height * ((x * 0.9).sine_cosine().0 + (z * 0.7 + 0.5).sine_cosine().1);
        Point::from([x, y, z].map(N::lit))
    };
    let index = |row: u32, column: u32| row * (CELLS + 1) + column;
    let cells = (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (row, column)));
    let triangles = |(row, column)| {
        let (a, b) = (index(row, column), index(row, column + 1));
        let (c, d) = (index(row + 1, column), index(row + 1, column + 1));
        [[a, c, d], [a, d, b]]
    };
    let pairs = (0..CELLS).flat_map(|to| (0..=CELLS).step_by(3).map(move |at| (to, at)));
    let lines = |(to, at)| [[index(at, to), index(at, to + 1)], [index(to, at), index(to + 1, at)]];
    ShapeMesh {
        id,
        vertices: (0..=CELLS).flat_map(|r| (0..=CELLS).map(move |c| vertex(r, c))).collect(),
        lines: pairs.flat_map(lines).collect(),
        triangles: cells.flat_map(triangles).collect(),
    }
}

/// Returns the mesh of a regular polygon.
pub(crate) fn polygon_mesh<N: Real>(id: u64, radius: f64, corners: u32) -> ShapeMesh<N, 2> {
    let vertex = |index: u32| {
        let angle = std::f64::consts::TAU * f64::from(index) / f64::from(corners);
        let (sine, cosine) = angle.sine_cosine();
        dim2::math::Point::from([cosine, sine].map(|x| N::lit(radius * x)))
    };
    ShapeMesh {
        id,
        vertices: (0..corners).map(vertex).collect(),
        lines: (0..corners).map(|index| [index, (index + 1) % corners]).collect(),
        triangles: (2..corners).map(|index| [0, index - 1, index]).collect(),
    }
}

/// Draws the triangles of a mesh as single triangles, without the lines and the outline of a mesh.
pub(crate) fn faces<N: Space<D>, const D: usize>(
    picture: &mut impl DebugRender<N, D>,
    mesh: &ShapeMesh<N, D>,
    color: Color,
) {
    for corners in &mesh.triangles {
        let corners: [math::Point<N, D>; 3] = corners.map(|index| mesh.vertices[index as usize]);
        picture.triangle(corners, color, Drawn::Object);
    }
}

fn moved<N: Real>(place: [f64; 3], turn: [f64; 3]) -> Isometry<N> {
    Isometry::new(Vector::from(place.map(N::lit)), Vector::from(turn.map(N::lit)))
}

/// Draws boxes and balls on a floor, and points and an arrow like contacts.
pub(crate) fn boxes<N: Real>(picture: &mut impl DebugRender<N, 3>) {
    let (floor, cube) = (box_mesh(1, [3.0, 0.15, 2.2]), box_mesh(2, [0.5; 3]));
    let (plank, ball) = (box_mesh(3, [1.1, 0.12, 0.5]), ball_mesh(4, 0.5));
    let what = Drawn::Object;
    picture.mesh(&floor, &moved([0.0, -0.15, 0.0], [0.0; 3]), SAND, what);
    picture.mesh(&cube, &moved([-1.4, 0.5, 0.2], [0.0, 0.2, 0.0]), SLATE, what);
    picture.mesh(&cube, &moved([0.1, 0.5, -0.1], [0.0, -0.15, 0.0]), SLATE, what);
    picture.mesh(&plank, &moved([-0.6, 1.12, 0.1], [0.0, 0.05, 0.0]), SAGE, what);
    picture.mesh(&ball, &moved([-0.6, 1.74, 0.1], [0.0; 3]), CLAY, what);
    picture.mesh(&ball, &moved([1.5, 0.48, 0.7], [0.3, 0.0, 0.2]), CLAY, what);
    let [down, up] = [[1.5, 0.0, 0.7], [1.5, 0.6, 0.7]].map(|x| Point::from(x.map(N::lit)));
    picture.arrow(&down, &up, RED, Drawn::ContactNormal);
    picture.point(&down, N::lit(0.08), RED, Drawn::ContactPoint);
    let corners = [[-1.0, 1.0, 0.5], [-1.0, 1.0, -0.3], [-0.3, 1.0, 0.4], [-0.3, 1.0, -0.4]];
    for corner in corners {
        let corner = Point::from(corner.map(N::lit));
        picture.point(&corner, N::lit(0.08), RED, Drawn::ContactPoint);
    }
}

/// Draws a ball and a box inside a box of glass.
pub(crate) fn glass<N: Real>(picture: &mut impl DebugRender<N, 3>) {
    let what = Drawn::Object;
    picture.mesh(&ball_mesh(1, 0.5), &moved([-0.5, -0.5, 0.2], [0.0; 3]), CLAY, what);
    picture.mesh(&box_mesh(2, [0.4; 3]), &moved([0.5, -0.6, -0.2], [0.0, 0.4, 0.0]), SAGE, what);
    let glass = Color::rgb(120, 160, 200).with_alpha(70);
    picture.mesh(&box_mesh(3, [1.2, 1.0, 0.9]), &moved([0.0; 3], [0.0; 3]), glass, what);
}

/// Draws balls and a box above hills, and a ray.
pub(crate) fn hills<N: Real>(picture: &mut impl DebugRender<N, 3>) {
    let what = Drawn::Object;
    picture.mesh(&terrain_mesh(1, 4.0, 0.4), &moved([0.0; 3], [0.0; 3]), SAGE, what);
    picture.mesh(&ball_mesh(2, 0.6), &moved([-1.5, 0.6, 1.5], [0.0; 3]), CLAY, what);
    picture.mesh(
        &box_mesh(3, [0.6, 0.4, 0.5]),
        &moved([1.6, 1.1, 0.8], [0.1, 0.5, 0.2]),
        SLATE,
        what,
    );
    let [from, to] = [[-3.5, 2.6, -2.0], [1.0, 1.2, 0.6]].map(|x| Point::from(x.map(N::lit)));
    picture.arrow(&from, &to, Color::rgb(52, 92, 160), Drawn::Query);
    picture.point(&to, N::lit(0.1), RED, Drawn::QueryHit);
}

/// Draws polygons on a floor in 2D, with a box, contacts, a ray and a text.
pub(crate) fn plane<N: Real>(picture: &mut impl DebugRender<N, 2>) {
    use dim2::math::{Isometry, Point, Vector};
    let at = |x: f64, y: f64| Point::new(N::lit(x), N::lit(y));
    let pose = |x, y, turn| Isometry::new(Vector::new(N::lit(x), N::lit(y)), N::lit(turn));
    let what = Drawn::Object;
    let floor = [at(-4.0, -0.5), at(4.0, -0.5), at(4.0, 0.0), at(-4.0, 0.0)].to_vec();
    let lines = vec![[0, 1], [1, 2], [2, 3], [3, 0]];
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    let floor = ShapeMesh { id: 1, vertices: floor, lines, triangles };
    picture.mesh(&floor, &pose(0.0, 0.0, 0.0), SAND, what);
    picture.mesh(&polygon_mesh(2, 0.8, 64), &pose(-2.0, 0.75, 0.0), CLAY, what);
    picture.mesh(&polygon_mesh(3, 1.0, 6), &pose(0.5, 0.86, 0.0), SLATE, what);
    picture.mesh(&polygon_mesh(4, 0.8, 3), &pose(2.6, 1.2, 0.7), SAGE, what);
    let gray = Color::rgb(140, 140, 148);
    let tight = [at(-2.8, -0.05), at(-1.2, -0.05), at(-1.2, 1.55), at(-2.8, 1.55)];
    for index in 0..4 {
        picture.line([tight[index], tight[(index + 1) % 4]], gray, Drawn::TightBox);
    }
    picture.arrow(&at(-2.0, 0.0), &at(-2.0, 0.6), RED, Drawn::ContactNormal);
    for x in [-2.0, 0.0, 1.0] {
        picture.point(&at(x, 0.0), N::lit(0.1), RED, Drawn::ContactPoint);
    }
    picture.arrow(&at(-3.8, 2.6), &at(0.1, 1.6), Color::rgb(52, 92, 160), Drawn::Query);
    picture.point(&at(0.1, 1.6), N::lit(0.1), Color::rgb(52, 92, 160), Drawn::QueryHit);
    picture.text(&at(0.1, 1.6), "hit < 1 & free", Color::rgb(52, 92, 160), Drawn::QueryHit);
}
