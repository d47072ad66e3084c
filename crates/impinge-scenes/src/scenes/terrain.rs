//! Solids that slide and hop on hilly terrain.

use super::pile::{axis, signed_speed};
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::{Random, root};
use crate::{Motion, Placement, Scene, SceneObject, SceneShape, Wave, rounded};

/// The width of a cell of the terrain: half the size of most objects.
pub(super) const CELL: f64 = 0.5;
/// The number of cells between two random heights of the hills.
const HILL: usize = 16;

/// `count` balls, boxes, capsules and convex solids of size 1, equally many of each, on a hilly
/// mesh, which is the first object. It has 100 triangles per solid, a million for 10 000. In 2D the
/// terrain is a polyline of 10 segments per solid.
///
/// All move back and forth by 0.007 to 0.02 per step along each horizontal axis, over 0.5 to either
/// side, and up and down by ±0.05. At any time about two thirds of the solids touch the terrain,
/// each a few of its triangles, and few touch each other. No centre is ever below the terrain.
#[must_use]
pub fn terrain_mesh<const D: usize>(count: usize) -> Scene<D> {
    let ground = Ground::new(count, &mut Random::new(6));
    let shape = ground.mesh();
    Scene { name: "terrain mesh", ..scene(count, &ground, shape) }
}

/// The scene of [`terrain_mesh`], with the terrain as a height field.
#[must_use]
pub fn terrain_field<const D: usize>(count: usize) -> Scene<D> {
    let ground = Ground::<D>::new(count, &mut Random::new(6));
    let shape = ground.field();
    Scene { name: "terrain field", ..scene(count, &ground, shape) }
}

fn scene<const D: usize>(count: usize, ground: &Ground<D>, shape: SceneShape<D>) -> Scene<D> {
    let random = &mut Random::new(7);
    let ground_object = SceneObject::new(shape, NEAR_CONTACTS, Motion::rest([0.0; D]));
    let standing = (0..count).map(|n| standing(solid(n % 4, random), ground, random));
    let objects = std::iter::once(ground_object).chain(standing).collect();
    Scene { name: "terrain", margin: MARGIN, objects, steps: 100 }
}

pub(super) fn solid<const D: usize>(kind: usize, random: &mut Random) -> SceneShape<D> {
    let radius = rounded(random.between(0.3, 0.5));
    match kind {
        0 => SceneShape::Ball { radius },
        1 => {
            let half_extents = [0.0; D].map(|_: f64| rounded(random.between(0.3, 0.6)));
            SceneShape::Cuboid { half_extents }
        }
        2 => SceneShape::Capsule { half_height: radius, radius: rounded(0.6 * radius) },
        _ => SceneShape::Convex { points: stone(radius, random) },
    }
}

/// Returns the corners of a box, each moved towards the centre by up to a fifth, and one point
/// above the box.
fn stone<const D: usize>(radius: f64, random: &mut Random) -> Vec<[f64; D]> {
    let corners = (0..1_usize << D).map(|corner| {
        let shrink = random.between(0.8, 1.0) * radius;
        std::array::from_fn(|axis| rounded(if corner >> axis & 1 == 0 { -shrink } else { shrink }))
    });
    let mut points: Vec<_> = corners.collect();
    let mut top = [0.0; D];
    top[1] = rounded(1.5 * radius);
    points.push(top);
    points
}

/// Returns an object whose axis-aligned box stands on the terrain when the object has its rotation
/// of step 0 and is in the middle of its path.
fn standing<const D: usize>(
    shape: SceneShape<D>,
    ground: &Ground<D>,
    random: &mut Random,
) -> SceneObject<D> {
    let mut at = ground.somewhere(random);
    let turn = random.between(-0.1, 0.1);
    let axis = axis::<D>(random);
    let box_at_ground = shape.aabb(&Placement { tangent: turn, axis, ..Placement::at(at) });
    at[1] += box_at_ground.map_or(0.0, |(low, _)| at[1] - low[1]);
    let place = std::array::from_fn(|i| {
        let (way, slow, fast) = if i == 1 { (0.05, 0.002, 0.006) } else { (0.5, 0.007, 0.02) };
        let start = at[i] + random.between(-way, way);
        Wave::new((at[i] - way, at[i] + way), start, signed_speed(random, slow, fast))
    });
    let tangent = Wave::new((-0.1, 0.1), turn, random.between(0.001, 0.01));
    SceneObject::new(shape, NEAR_CONTACTS, Motion { place, axis, tangent })
}

/// Heights over a grid that is centred at the origin.
pub(super) struct Ground<const D: usize> {
    /// The numbers of rows and columns of vertices.
    pub(super) counts: [usize; 2],
    /// The width of a cell.
    cell: f64,
    heights: Vec<f64>,
}

impl<const D: usize> Ground<D> {
    pub(super) fn new(count: usize, random: &mut Random) -> Self {
        let counts = if D < 3 {
            [1, 10 * count.max(1) + 1]
        } else {
            // 50 cells of two triangles per object, rounded up to a square of cells.
            let side = root::<2>(50.0 * count.max(1) as f64).ceil();
            let vertices = (1_usize..).find(|n| *n as f64 > side).unwrap_or(2);
            [vertices; 2]
        };
        let hills = counts.map(|n| n / HILL + 2);
        let lattice: Vec<_> = (0..hills[0] * hills[1]).map(|_| random.between(-0.5, 0.5)).collect();
        let vertices = (0..counts[0]).flat_map(|row| (0..counts[1]).map(move |n| [row, n]));
        let heights =
            vertices.map(|at| rounded(hill(&lattice, hills[1], at) + random.between(-0.02, 0.02)));
        Self { counts, cell: CELL, heights: heights.collect() }
    }

    /// Returns a square (in 2D a line) at least as wide as `width`, without hills, but with the
    /// roughness of the hilly terrain.
    pub(super) fn plain(width: f64, cell: f64, random: &mut Random) -> Self {
        let vertices = (2_usize..).find(|n| (n - 1) as f64 * cell >= width).unwrap_or(2);
        let counts = [if D < 3 { 1 } else { vertices }, vertices];
        let heights = (0..counts[0] * counts[1]).map(|_| rounded(random.between(-0.02, 0.02)));
        Self { counts, cell, heights: heights.collect() }
    }

    /// Returns the extents of the terrain along the axes; the rows follow each other along the
    /// third axis.
    pub(super) fn extents(&self) -> [f64; D] {
        std::array::from_fn(|axis| match axis {
            0 => (self.counts[1] - 1) as f64 * self.cell,
            1 => 1.0,
            _ => (self.counts[0] - 1) as f64 * self.cell,
        })
    }

    pub(super) fn vertex(&self, [row, column]: [usize; 2]) -> [f64; D] {
        let extents = self.extents();
        std::array::from_fn(|axis| match axis {
            0 => column as f64 * self.cell - 0.5 * extents[0],
            1 => self.heights[row * self.counts[1] + column],
            _ => row as f64 * self.cell - 0.5 * extents[axis],
        })
    }

    pub(super) fn field(&self) -> SceneShape<D> {
        let heights = self.heights.clone();
        SceneShape::HeightField { counts: self.counts, heights, extents: self.extents() }
    }

    pub(super) fn mesh(&self) -> SceneShape<D> {
        let [rows, columns] = self.counts;
        let points = (0..rows).flat_map(|row| (0..columns).map(move |column| [row, column]));
        let vertices = points.map(|at| self.vertex(at)).collect();
        if D < 3 { SceneShape::Polyline { vertices } } else { self.triangles(vertices) }
    }

    fn triangles(&self, vertices: Vec<[f64; D]>) -> SceneShape<D> {
        let [rows, columns] = self.counts;
        let index = |row: usize, column: usize| {
            u32::try_from(row * columns + column).expect("fewer vertices than 32 bits number")
        };
        let cells = (1..rows).flat_map(|row| (1..columns).map(move |column| [row, column]));
        let triangles = cells.flat_map(|[row, column]| {
            let near = [index(row - 1, column - 1), index(row - 1, column)];
            let far = [index(row, column - 1), index(row, column)];
            // Counter-clockwise seen from above, where z points down if x points to the right.
            [[near[0], far[0], far[1]], [near[0], far[1], near[1]]]
        });
        SceneShape::TriMesh { triangles: triangles.collect(), vertices }
    }

    /// Returns a random point: a vertex, moved along the terrain by at most half a cell. It is no
    /// nearer to the border than the width of an object.
    pub(super) fn somewhere(&self, random: &mut Random) -> [f64; D] {
        let border = 3;
        let mut vertex = |count: usize| {
            border.min(count / 2) + random.below(count.saturating_sub(2 * border).max(1))
        };
        let mut at =
            self.vertex([if D < 3 { 0 } else { vertex(self.counts[0]) }, vertex(self.counts[1])]);
        for (_, x) in at.iter_mut().enumerate().filter(|(axis, _)| *axis != 1) {
            *x += random.between(-0.5, 0.5) * self.cell;
        }
        at
    }
}

/// Value noise: interpolates the random heights of a coarse lattice by cubics with zero slope at
/// the lattice points.
fn hill(lattice: &[f64], width: usize, at: [usize; 2]) -> f64 {
    let base = at.map(|n| n / HILL);
    let [down, right] = at.map(|n| {
        let t = (n % HILL) as f64 / HILL as f64;
        t * t * (3.0 - 2.0 * t)
    });
    let row = |row: usize| {
        let [a, b] = [0, 1].map(|step| lattice[row * width + base[1] + step]);
        a + (b - a) * right
    };
    let (near, far) = (row(base[0]), row(base[0] + 1));
    near + (far - near) * down
}
