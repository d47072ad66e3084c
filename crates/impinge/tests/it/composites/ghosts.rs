//! Tests ghost cells and ghost triangles, which surround a tile of terrain. The contacts of a solid
//! that slides over the seam of two tiles have the normals of a single surface, whether the tiles
//! are several objects or one compound.

use crate::support::samples::stride;

use impinge::math::{Isometry2, Isometry3, Point, Real, Vector};
use impinge::narrow_phase::{ContactPrediction, contact_manifolds};
use impinge::query::ContactManifold;
use impinge::shape::{
    Ball, Capsule, CompositeShape, Compound, ConvexHull, Cuboid, Cylinder, EdgeNeighbor,
    HeightField, MeshError, Shape, ShapeHandle, TriMesh, Triangle,
};

/// Number of cells of a tile along each axis. Cells have the width 1, so this is also the width of
/// the tile.
const CELLS: usize = 4;

type Height = fn(f64, f64) -> f64;

fn flat(_: f64, _: f64) -> f64 {
    0.0
}

fn wavy(x: f64, z: f64) -> f64 {
    0.3 * (0.7 * x).sin() + 0.2 * (0.9 * z + 0.4).cos()
}

/// Returns heights over `cells` cells from `low` along each axis, plus `border` cells at each end,
/// row by row.
fn heights<N: Real>(low: [f64; 2], cells: usize, border: usize, height: Height) -> Vec<N> {
    let count = cells + 2 * border + 1;
    let at = |index: usize, low: f64| low - border as f64 + index as f64;
    let all = (0..count).flat_map(|row| (0..count).map(move |column| (row, column)));
    all.map(|(row, column)| N::lit(height(at(column, low[0]), at(row, low[1])))).collect()
}

/// Returns a square field over these heights, in a frame with its origin at the field's centre.
fn field<N: Real>(low: [f64; 2], cells: usize, border: usize, height: Height) -> HeightField<N, 3> {
    let (count, extent) = (cells + 2 * border + 1, N::lit((cells + 2 * border) as f64));
    let heights = heights(low, cells, border, height);
    let field = HeightField::<N, 3>::new(
        count,
        count,
        heights,
        Vector::<N, 3>::new(extent, N::ONE, extent),
    );
    if border > 0 { field.with_ghost_border() } else { field }
}

/// Returns the mesh of a field, in the frame of the field; its ghosts are the ghosts of the field.
fn mesh<N: Real>(field: &HeightField<N, 3>) -> TriMesh<N, 3> {
    let columns = field.columns();
    let points = (0..field.rows() * columns).map(|at| field.point(at / columns, at % columns));
    let (mut own, mut ghosts) = (Vec::new(), Vec::new());
    for cell in 0..field.num_cells() {
        let [row, column] = [cell / (columns - 1), cell % (columns - 1)];
        let at = |row: usize, column: usize| u32::try_from(row * columns + column).expect("few");
        let [a, b] = [at(row, column), at(row + 1, column)];
        let is_ghost = field.is_ghost(u32::try_from(2 * cell).expect("few"));
        let list = if is_ghost { &mut ghosts } else { &mut own };
        list.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
    }
    TriMesh::new(points.collect(), own).with_ghosts(&ghosts)
}

fn at3<N: Real>(x: f64, y: f64, z: f64) -> Isometry3<N> {
    Isometry3::translation(N::lit(x), N::lit(y), N::lit(z))
}

/// Returns the four tiles around the origin, each with its pose.
fn tiles<N: Real>(
    border: usize,
    height: Height,
    is_mesh: bool,
) -> Vec<(Isometry3<N>, ShapeHandle<N, 3>)> {
    let size = CELLS as f64;
    let lows = [[-size, -size], [0.0, -size], [-size, 0.0], [0.0, 0.0]];
    let tile = |low: [f64; 2]| {
        let field = field(low, CELLS, border, height);
        let shape = if is_mesh { ShapeHandle::new(mesh(&field)) } else { ShapeHandle::new(field) };
        (at3(low[0] + 0.5 * size, 0.0, low[1] + 0.5 * size), shape)
    };
    lows.into_iter().map(tile).collect()
}

fn solids<N: Real>() -> Vec<ShapeHandle<N, 3>> {
    let l = N::lit;
    let corners = [[-0.4, -0.3, -0.4], [0.4, -0.3, -0.4], [0.0, -0.3, 0.5], [0.0, 0.4, 0.0]];
    let corners = corners.map(|[x, y, z]| Point::<N, 3>::new(l(x), l(y), l(z)));
    vec![
        ShapeHandle::new(Ball::new(l(0.4))),
        ShapeHandle::new(Cuboid::new(Vector::<N, 3>::new(l(0.4), l(0.3), l(0.35)))),
        ShapeHandle::new(Capsule::<N, 3>::new(l(0.3), l(0.25))),
        ShapeHandle::new(Cylinder::new(l(0.3), l(0.35))),
        ShapeHandle::new(ConvexHull::from_points(&corners)),
    ]
}

/// Returns the normals of the contacts of a shape and a solid, from the shape to the solid.
fn normals<N: Real>(
    shape: &dyn Shape<N, 3>,
    at: &Isometry3<N>,
    solid: &dyn Shape<N, 3>,
    pose: &Isometry3<N>,
) -> Vec<Vector<N, 3>> {
    let prediction = ContactPrediction::new(N::lit(0.01), N::ZERO, N::ZERO);
    let found = contact_manifolds(at, shape, pose, solid, &prediction, None);
    let contacts = found.iter().flat_map(ContactManifold::contacts);
    contacts.map(|tracked| *tracked.contact.normal).collect()
}

/// Returns the normals, directed upwards, of the triangles in the up to nine cells around a
/// position.
fn fronts<N: Real>(field: &HeightField<N, 3>, x: f64, z: f64) -> Vec<Vector<N, 3>> {
    let around = |at: f64| (0..2 * CELLS).filter(move |cell| (*cell as f64 - 3.5 - at).abs() < 1.5);
    let cells = around(z).flat_map(|row| around(x).map(move |column| (row, column)));
    let triangles = cells.flat_map(|(row, column)| field.triangles(row, column)).flatten();
    let upward = |triangle: Triangle<N, 3>| {
        let [a, b, c] = triangle.corners();
        let normal = (b - a).cross(&(c - a)).normalize();
        if normal.y < N::ZERO { -normal } else { normal }
    };
    triangles.map(upward).collect()
}

/// Slides each solid over the seams, by default with every third step. Returns the number of
/// contact normals on the tiles that are neither contact normals of the undivided field at the same
/// pose nor close to the normals of its faces there.
fn bumps<N: Real>(border: usize, height: Height, is_mesh: bool, as_one: bool) -> usize {
    let whole = field::<N>([-4.0, -4.0], 2 * CELLS, 0, height);
    let tiles = tiles::<N>(border, height, is_mesh);
    let tiles = if as_one {
        vec![(at3(0.0, 0.0, 0.0), ShapeHandle::new(Compound::new(tiles)))]
    } else {
        tiles
    };
    let (mut bumps, mut touching, mut poses) = (0, 0, 0);
    for solid in solids::<N>() {
        let low = solid.local_aabb().mins().y.as_f64();
        for step in (0..120).step_by(stride(3)) {
            // The path does not follow the diagonals of cells; every second step is exactly on a
            // line through the common corner of all tiles.
            let x = -1.49 + 0.025 * f64::from(step);
            let z = 0.31 * x + if step % 2 == 0 { 0.0 } else { 0.6 };
            let pose = at3(x, height(x, z) - low - 0.02, z);
            let expected = normals(&whole, &at3(0.0, 0.0, 0.0), &*solid, &pose);
            assert!(!expected.is_empty(), "it touches the field");
            let found: Vec<_> =
                tiles.iter().flat_map(|(at, tile)| normals(&**tile, at, &*solid, &pose)).collect();
            assert!(!found.is_empty(), "it touches a tile: {solid:?} at {x}, {z}");
            touching += found.len();
            poses += 1;
            // At a ridge the surface has all normals between the normals of its two faces.
            let fronts = fronts(&whole, x, z);
            let is_known = |normal: &&Vector<N, 3>| {
                let is_near =
                    |other: &Vector<N, 3>, most: f64| (*normal - other).norm() < N::lit(most);
                expected.iter().any(|other| is_near(other, 1e-3))
                    || fronts.iter().any(|front| is_near(front, 0.1))
            };
            bumps += found.iter().filter(|normal| !is_known(normal)).count();
        }
    }
    assert!(touching > poses, "{touching} contacts at {poses} poses");
    bumps
}

/// Tests tiles of both kinds, as several objects and as one compound. By default only every second
/// combination is tested, beginning with `first`.
fn check<N: Real>(first: usize) {
    let all = [(false, false), (true, false), (true, true), (false, true)];
    for (is_mesh, as_one) in all.into_iter().skip(first % stride(2)).step_by(stride(2)) {
        let what = format!("mesh: {is_mesh}, one compound: {as_one}");
        let heights: [(Height, &str); 2] = [(flat, "flat"), (wavy, "wavy")];
        for (height, name) in heights {
            assert_eq!(bumps::<N>(1, height, is_mesh, as_one), 0, "{name}, {what}");
            let without = bumps::<N>(0, height, is_mesh, as_one);
            assert!(without > 20 / stride(3), "{name}, without ghosts: {without}, {what}");
        }
    }
}

#[test]
fn nothing_bumps_into_the_seams_of_tiles() {
    check::<f32>(0);
    check::<f64>(1);
}

fn line<N: Real>(low: f64, border: usize, height: fn(f64) -> f64) -> HeightField<N, 2> {
    let count = CELLS + 2 * border;
    let heights = (0..=count).map(|at| N::lit(height(low - border as f64 + at as f64)));
    let scale = Vector::<N, 2>::new(N::lit(count as f64), N::ONE);
    let field = HeightField::<N, 2>::new(heights.collect(), scale);
    if border > 0 { field.with_ghost_border() } else { field }
}

/// Slides solids over the seam of two flat fields in 2D, and returns the number of contact normals
/// that are not upward.
fn line_bumps<N: Real>(border: usize) -> usize {
    let l = N::lit;
    let solids: [ShapeHandle<N, 2>; 3] = [
        ShapeHandle::new(Ball::new(l(0.4))),
        ShapeHandle::new(Cuboid::new(Vector::<N, 2>::new(l(0.4), l(0.3)))),
        ShapeHandle::new(Capsule::<N, 2>::new(l(0.3), l(0.25))),
    ];
    let prediction = ContactPrediction::new(l(0.01), N::ZERO, N::ZERO);
    let mut bumps = 0;
    for solid in &solids {
        let low = solid.local_aabb().mins().y.as_f64();
        for step in 0..200 {
            let pose = Isometry2::translation(l(-1.0 + 0.01 * f64::from(step)), l(-low - 0.02));
            let mut count = 0;
            for start in [-4.0, 0.0] {
                let tile = line::<N>(start, border, |_| 0.0);
                let at = Isometry2::translation(l(start + 2.0), N::ZERO);
                let found = contact_manifolds(&at, &tile, &pose, &**solid, &prediction, None);
                count += found.len();
                let is_up = |normal: &Vector<N, 2>| normal.y >= N::ONE - l(1e-5);
                let contacts = found.iter().flat_map(ContactManifold::contacts);
                bumps += contacts.filter(|tracked| !is_up(&tracked.contact.normal)).count();
            }
            assert!(count > 0, "step {step}");
        }
    }
    bumps
}

#[test]
fn nothing_bumps_into_the_ends_of_lines() {
    assert_eq!((line_bumps::<f32>(1), line_bumps::<f64>(1)), (0, 0));
    assert!(line_bumps::<f32>(0) > 20, "without ghosts");
}

#[test]
fn ghosts_are_not_touched_and_no_parts() {
    let with = field::<f64>([0.0, 0.0], CELLS, 1, wavy);
    let part = with.num_parts() - 1;
    assert!(with.is_ghost(part) && !with.is_hole(part));
    assert_eq!(with.triangles(0, 0), [None, None]);
    assert!(with.clone().with_diagonals(Default::default()).is_ghost(part), "they stay");
    let mut changed = with.clone();
    changed.set_ghost(0, 0, false);
    assert!(changed.height_at(-2.5, -2.5).is_some() && with.height_at(-2.5, -2.5).is_none());
    let tile = mesh(&with);
    assert_eq!((tile.num_parts(), tile.num_triangles()), (32, 32));
    assert_eq!((tile.triangles().len(), tile.ghosts().len()), (32, 40));
    assert_eq!(tile.local_aabb().maxs().x, 2.0);
    assert!(!tile.is_closed(), "ghosts do not close it");
    let borders = (0..32).flat_map(|part| (0..3).map(move |side| tile_side(part, side)));
    let borders = borders.filter(|&(part, side)| tile.neighbor(part, side) == EdgeNeighbor::Border);
    assert_eq!(borders.count(), 16);
    let scaled = tile.try_scaled(&Vector::<f64, 3>::new(2.0, 1.0, -1.0)).expect("no zero");
    assert_eq!((scaled.num_triangles(), scaled.ghosts().len()), (32, 40), "they are scaled, too");
    let merged = tile.clone().with_vertices_merged();
    assert_eq!(merged.ghosts().len(), 40);
    let refused = tile.try_with_ghosts(&[[0, 1, 999]]);
    let expected = MeshError::NoSuchVertex { part: 32, vertex: 999, vertices: 49 };
    assert_eq!(refused.err(), Some(expected));
}

const fn tile_side(part: u32, side: u32) -> (u32, u32) {
    (part, side)
}
