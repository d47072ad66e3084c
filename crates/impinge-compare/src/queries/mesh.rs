//! Ray casts against one mesh: hills whose triangles are stored in random order.

use std::time::Duration;

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use glam::Vec3A;
use impinge::math::{Isometry3, Point};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::RayCast;
use impinge::shape::{ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld, QueryFilter};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::RayHit;
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use rapier3d::parry;
use rapier3d::parry::query::RayCast as _;

use super::obvhs_trees::answer;
use super::race::{Contender, Rule, race};
use super::scene::{Random, Ray};
use super::{TOLERANCE, ours, rounds, wanted};
use crate::Arguments;
use crate::table::Row;

/// The number of rays of each kind.
const RAYS: usize = 20_000;

/// The amplitude of the hills; the cells of the mesh are squares of edge 1.
const HEIGHT: f64 = 6.0;

/// The mesh as plain data, the common input of all contenders.
struct Hills {
    edge: usize,
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// Times steep rays and grazing rays against hills of `edge`² cells, each of two triangles.
pub fn run(edge: usize, arguments: &Arguments) -> Vec<Row> {
    let case = |name: &str| format!("rays {name} on {} triangles", 2 * edge * edge);
    let names = ["down", "grazing"].map(case);
    if !names.iter().any(|case| arguments.wants_case(case)) {
        return Vec::new();
    }
    let hills = Hills::new(edge);
    let worlds = Worlds::new(&hills);
    let mut rows = Vec::new();
    for (case, rays) in names.iter().zip([hills.down(), hills.grazing()]) {
        if arguments.wants_case(case) {
            let (rule, all) = (Rule::Best(TOLERANCE), worlds.contenders(&rays));
            rows.extend(race(case, rule, RAYS, rounds(arguments), wanted(all, arguments)));
        }
    }
    rows
}

impl Hills {
    fn new(edge: usize) -> Self {
        let at = |n: usize| (n % (edge + 1), n / (edge + 1));
        let vertices = (0..(edge + 1) * (edge + 1)).map(|n| {
            let (x, z) = at(n);
            let (x, z) = (x as f64, z as f64);
            [x, height(x, z), z].map(|x| x as f32)
        });
        let mut triangles: Vec<_> =
            (0..edge * edge).flat_map(|n| cell(n % edge, n / edge, edge)).collect();
        let mut random = Random(7);
        for n in (1..triangles.len()).rev() {
            triangles.swap(n, random.below(n + 1));
        }
        Self { edge, vertices: vertices.collect(), triangles }
    }

    /// Returns rays that start above all hills and point down, at 17 degrees from the vertical.
    fn down(&self) -> Vec<Ray<3>> {
        self.rays(3.0 * HEIGHT, |random| {
            let [x, z] = random.direction::<2>().map(|x| 0.3 * x);
            [x, -1.0, z]
        })
    }

    /// Returns rays that start above all hills and point down by 1 to 10 degrees, so that they pass
    /// over some hills.
    fn grazing(&self) -> Vec<Ray<3>> {
        self.rays(1.1 * HEIGHT, |random| {
            let [x, z] = random.direction::<2>();
            [x, -random.between(0.02, 0.18), z]
        })
    }

    fn rays(&self, height: f64, to: impl Fn(&mut Random) -> [f64; 3]) -> Vec<Ray<3>> {
        let (mut random, edge) = (Random(11), self.edge as f64);
        let mut ray = || {
            let from = [random.between(0.0, edge), height, random.between(0.0, edge)];
            let to = to(&mut random);
            let length = to.iter().map(|x| x * x).sum::<f64>().sqrt();
            (from.map(|x| x as f32), to.map(|x| (x / length) as f32))
        };
        (0..RAYS).map(|_| ray()).collect()
    }
}

/// Returns the height at a point: a sum of waves of different lengths.
fn height(x: f64, z: f64) -> f64 {
    let long = (0.05 * x).sin() * (0.043 * z).cos();
    HEIGHT * (0.7 * long + 0.25 * (0.31 * x + 0.2 * z).sin() + 0.05 * (1.9 * x - 1.3 * z).sin())
}

/// Returns the two triangles of a cell; their front sides are above.
fn cell(x: usize, z: usize, edge: usize) -> [[u32; 3]; 2] {
    let corner = |dx: usize, dz: usize| ((z + dz) * (edge + 1) + x + dx) as u32;
    [[corner(0, 0), corner(0, 1), corner(1, 0)], [corner(1, 0), corner(0, 1), corner(1, 1)]]
}

/// The mesh in the form of each contender.
struct Worlds {
    ours: TriMesh<f32, 3>,
    world: CollisionWorld<f32, 3, u32>,
    parry: parry::shape::TriMesh,
    wide: CwBvh,
    wide_triangles: Vec<RtTriangle>,
    tree: Bvh<f32, 3>,
    leaves: Vec<Leaf>,
}

/// A triangle for `bvh`.
#[derive(Clone, Debug)]
struct Leaf {
    id: u32,
    corners: [Point<f32, 3>; 3],
    node: usize,
}

impl Bounded<f32, 3> for Leaf {
    fn aabb(&self) -> Aabb<f32, 3> {
        let [a, b, c] = &self.corners;
        Aabb::empty().grow(a).grow(b).grow(c)
    }
}

impl BHShape<f32, 3> for Leaf {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Worlds {
    fn new(hills: &Hills) -> Self {
        let vertices: Vec<_> = hills.vertices.iter().map(|at| Point::from(*at)).collect();
        let ours = TriMesh::new(vertices.clone(), hills.triangles.clone());
        let mut world = CollisionWorld::new(0.02);
        let (groups, query) = (CollisionGroups::new(), GeometricQueryType::Proximity(0.0));
        world.add(Isometry3::identity(), ShapeHandle::new(ours.clone()), groups, query, 0);
        world.update();
        let of_parry = hills.vertices.iter().map(|at| parry::math::Vector::from(*at)).collect();
        let parry = parry::shape::TriMesh::new(of_parry, hills.triangles.clone());
        let corners = |triangle: &[u32; 3]| triangle.map(|n| vertices[n as usize]);
        let leaf = |(id, triangle)| Leaf { id, corners: corners(triangle), node: 0 };
        let mut leaves: Vec<_> = (0..).zip(&hills.triangles).map(leaf).collect();
        let tree = Bvh::build(&mut leaves);
        let (wide, wide_triangles) = wide(hills);
        let parry = parry.expect("there are triangles");
        Self { ours, world, parry, wide, wide_triangles, tree, leaves }
    }

    /// Returns the contenders with the rays converted. impinge is the first one, with which the
    /// others are compared.
    fn contenders(&self, rays: &[Ray<3>]) -> Vec<Contender<'_>> {
        let own: Vec<_> = rays.iter().map(ours::ray).collect();
        let (mesh, world, parry) = (&self.ours, &self.world, &self.parry);
        let of_mesh = Contender::best("impinge", own.clone(), move |ray| {
            mesh.cast_local_ray_until(ray, f32::MAX, true).map(|hit| (hit.part, hit.toi))
        });
        let all = QueryFilter::new();
        let of_world = Contender::best("impinge world", own, move |ray| {
            let (_, hit) = world.first_ray_hit(ray, f32::MAX, true, &all)?;
            Some((hit.part, hit.toi))
        });
        let rays_of_parry = rays.iter().map(super::parry::space::ray).collect();
        let of_parry = Contender::best("parry", rays_of_parry, move |ray| {
            let hit = parry.cast_local_ray_and_get_normal(ray, f32::MAX, true)?;
            Some((hit.subshape, hit.time_of_impact))
        });
        vec![of_mesh, of_world, of_parry, self.obvhs(rays), self.bvh(rays)]
    }

    fn obvhs(&self, rays: &[Ray<3>]) -> Contender<'_> {
        let (tree, triangles) = (&self.wide, &self.wide_triangles);
        let rays = rays.iter().map(|ray| super::obvhs_trees::ray(ray, f32::MAX)).collect();
        Contender::best("obvhs cwbvh", rays, move |ray: &obvhs::ray::Ray| {
            let mut hit = RayHit::none();
            let is_hit = tree.ray_traverse(*ray, &mut hit, |ray, at| triangles[at].intersect(ray));
            answer(&hit, is_hit, &tree.primitive_indices)
        })
    }

    /// The traversal returns boxes from near to far; it ends at the first box behind the best hit.
    fn bvh(&self, rays: &[Ray<3>]) -> Contender<'_> {
        let (tree, leaves) = (&self.tree, self.leaves.as_slice());
        let ray = |(from, to): &Ray<3>| bvh::ray::Ray::new(Point::from(*from), (*to).into());
        Contender::best("bvh", rays.iter().map(ray).collect(), move |ray| {
            let mut best: Option<(u32, f32)> = None;
            for leaf in tree.nearest_traverse_iterator(ray, leaves) {
                let enter = ray.intersection_slice_for_aabb(&leaf.aabb()).map_or(0.0, |it| it.0);
                if best.is_some_and(|(_, time)| time < enter) {
                    break;
                }
                let [a, b, c] = &leaf.corners;
                let time = ray.intersects_triangle(a, b, c).distance;
                if time < best.map_or(f32::INFINITY, |best| best.1) {
                    best = Some((leaf.id, time));
                }
            }
            best
        })
    }
}

/// Returns the tree of `obvhs`, and the triangles in the order of its leaves.
fn wide(hills: &Hills) -> (CwBvh, Vec<RtTriangle>) {
    let corners = |triangle: &[u32; 3]| triangle.map(|n| Vec3A::from(hills.vertices[n as usize]));
    let triangle = |triangle: &[u32; 3]| {
        let [v0, v1, v2] = corners(triangle);
        Triangle { v0, v1, v2 }
    };
    let triangles: Vec<_> = hills.triangles.iter().map(triangle).collect();
    let effort = BvhBuildParams::medium_build();
    let tree = build_cwbvh_from_tris(&triangles, effort, &mut Duration::default());
    let ordered = tree.primitive_indices.iter().map(|&n| RtTriangle::from(&triangles[n as usize]));
    let ordered = ordered.collect();
    (tree, ordered)
}
