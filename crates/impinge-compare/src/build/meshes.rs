//! Contenders that build meshes. The meshes do not store the same data: impinge and ncollide always
//! compute the adjacency of triangles, parry optionally.

use impinge::math::Point;
use impinge::shape::{CompositeShape, TriMesh};
use impinge_reference::random::Random;
use ncollide3d::partitioning::BVH;
use ncollide3d::query::visitors::BoundingVolumeInterferencesCollector;
use parry3d::shape::{TriMesh as ParryMesh, TriMeshFlags};

use super::contenders::{ask, boxes, parry_aabb};
use super::measure::{Answer, Maker};
use crate::broad::aabb;
use crate::broad::swarm::Cell;

/// A terrain: triangles over a square grid of spacing 1, with random heights from 0 to 2.
pub struct Terrain {
    vertices: Vec<[f32; 3]>,
    /// The indices of the vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    cells: Vec<Cell<3>>,
}

impl Terrain {
    /// Creates a terrain with `side` squares along each side and two triangles for each square.
    pub fn new(side: u32) -> Self {
        let (mut random, row) = (Random::new(4), side + 1);
        let vertices: Vec<_> = (0..row * row)
            .map(|n| [(n % row) as f32, random.range(0.0, 2.0) as f32, (n / row) as f32])
            .collect();
        let corners = (0..side).flat_map(|z| (0..side).map(move |x| z * row + x));
        let triangles: Vec<_> =
            corners.flat_map(|n| [[n, n + row, n + 1], [n + 1, n + row, n + row + 1]]).collect();
        let cells = triangles.iter().map(|corners| around(&vertices, corners)).collect();
        Self { vertices, triangles, cells }
    }
}

fn around(vertices: &[[f32; 3]], corners: &[u32; 3]) -> Cell<3> {
    let corners = corners.map(|n| vertices[n as usize]);
    let bound = |axis: usize, choose: fn(f32, f32) -> f32| {
        choose(choose(corners[0][axis], corners[1][axis]), corners[2][axis])
    };
    let mins: [f32; 3] = std::array::from_fn(|axis| bound(axis, f32::min));
    let maxs: [f32; 3] = std::array::from_fn(|axis| bound(axis, f32::max));
    Cell {
        center: std::array::from_fn(|axis| 0.5 * (mins[axis] + maxs[axis])),
        half: std::array::from_fn(|axis| 0.5 * (maxs[axis] - mins[axis])),
    }
}

/// Returns the contenders that build meshes, and those that build trees of the boxes of the
/// triangles.
pub fn makers(terrain: &Terrain) -> Vec<Maker<'_>> {
    let fixed = TriMeshFlags::FIX_INTERNAL_EDGES;
    let mut makers = vec![
        Maker::new("impinge TriMesh", || ours(terrain)),
        Maker::new("parry TriMesh", || parry(terrain, TriMeshFlags::empty())),
        Maker::new("parry with edges", move || parry(terrain, fixed)),
        Maker::new("ncollide TriMesh", || ncollide(terrain)),
    ];
    makers.extend(boxes(&terrain.cells));
    makers
}

fn ours(terrain: &Terrain) -> Answer<'_> {
    let vertices = terrain.vertices.iter().map(|v| Point::from(*v)).collect();
    let mesh = TriMesh::<f32, 3>::new(vertices, terrain.triangles.clone());
    ask(&terrain.cells, move |question, found| {
        mesh.search().overlapping(&aabb(question), &mut |n| found.push(n));
    })
}

fn parry(terrain: &Terrain, flags: TriMeshFlags) -> Answer<'_> {
    let vertices = terrain.vertices.iter().map(|v| (*v).into()).collect();
    let mesh = ParryMesh::with_flags(vertices, terrain.triangles.clone(), flags);
    let mesh = mesh.expect("there are triangles");
    ask(&terrain.cells, move |question, found| {
        found.extend(mesh.bvh().intersect_aabb(&parry_aabb(question)));
    })
}

fn ncollide(terrain: &Terrain) -> Answer<'_> {
    use ncollide3d::bounding_volume::AABB;
    use ncollide3d::math::Point;
    let vertices = terrain.vertices.iter().map(|v| Point::from(*v)).collect();
    let triangles = terrain.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|n| n as usize);
        [a, b, c].into()
    });
    let mesh = ncollide3d::shape::TriMesh::new(vertices, triangles.collect(), None);
    ask(&terrain.cells, move |question, found| {
        let query = AABB::new(Point::from(question.mins()), Point::from(question.maxs()));
        let mut met = Vec::new();
        mesh.bvt().visit(&mut BoundingVolumeInterferencesCollector::new(&query, &mut met));
        found.extend(met.into_iter().map(|n| n as u32));
    })
}
