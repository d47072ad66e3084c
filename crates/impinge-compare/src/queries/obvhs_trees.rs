//! The trees of `obvhs` in 3D: one with compressed nodes of eight boxes, and one with nodes of two
//! boxes.

use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray, RayHit};
use rapier3d::parry::query::Ray as ParryRay;

use super::parry::space::Parry;
use super::race::Contender;
use super::scene::{Corners, Library, Questions, Scene};

/// Both trees, each with the boxes in the order of its leaves.
pub struct Obvhs<'p> {
    wide: CwBvh,
    wide_boxes: Vec<Aabb>,
    narrow: Bvh2,
    narrow_boxes: Vec<Aabb>,
    /// The solids of parry, since `obvhs` has none.
    solids: &'p Parry,
}

impl<'p> Obvhs<'p> {
    /// Builds the trees over the boxes of a scene, with the build effort meant for long-lived
    /// trees.
    pub fn new(scene: &Scene<3>, solids: &'p Parry) -> Self {
        let boxes: Vec<_> = scene.boxes.iter().map(aabb).collect();
        let (effort, mut time) = (BvhBuildParams::medium_build(), Duration::default());
        let wide = build_cwbvh(&boxes, effort, &mut time);
        let narrow = build_bvh2(&boxes, effort, &mut time);
        let ordered = |order: &[u32]| order.iter().map(|&n| boxes[n as usize]).collect();
        let wide_boxes = ordered(&wide.primitive_indices);
        let narrow_boxes = ordered(&narrow.primitive_indices);
        Self { wide, wide_boxes, narrow, narrow_boxes, solids }
    }
}

fn aabb((low, high): &Corners<3>) -> Aabb {
    Aabb::new(Vec3A::from(*low), Vec3A::from(*high))
}

/// Converts a ray to a ray of `obvhs` with the length `reach`.
pub fn ray((from, to): &([f32; 3], [f32; 3]), reach: f32) -> Ray {
    Ray::new(Vec3A::from(*from), Vec3A::from(*to), 0.0, reach)
}

/// Converts a hit to the index of the primitive and the time; `None` without a hit. `order` maps
/// positions in the tree to indices.
pub fn answer(hit: &RayHit, is_hit: bool, order: &[u32]) -> Option<(u32, f32)> {
    is_hit.then(|| (order[hit.primitive_id as usize], hit.t))
}

impl Obvhs<'_> {
    fn solids<'a>(&'a self, rays: &[([f32; 3], [f32; 3])], reach: f32) -> Contender<'a> {
        let (tree, solids) = (&self.wide, &self.solids.solids);
        let both = |asked| (ray(asked, reach), super::parry::space::ray(asked));
        let rays = rays.iter().map(both).collect();
        Contender::best("obvhs cwbvh + parry", rays, move |(ray, same): &(Ray, ParryRay)| {
            let mut hit = RayHit::none();
            let is_hit = tree.ray_traverse(*ray, &mut hit, |ray, at| {
                let (pose, solid) = &solids[tree.primitive_indices[at] as usize];
                let hit = solid.cast_ray_and_get_normal(pose, same, ray.tmax, true);
                std::hint::black_box(hit).map_or(f32::INFINITY, |hit| hit.time_of_impact)
            });
            answer(&hit, is_hit, &tree.primitive_indices)
        })
    }

    fn rays<'a>(&'a self, rays: &[([f32; 3], [f32; 3])], reach: f32) -> Vec<Contender<'a>> {
        let rays: Vec<_> = rays.iter().map(|asked| ray(asked, reach)).collect();
        let (wide, wide_boxes) = (&self.wide, &self.wide_boxes);
        let (narrow, narrow_boxes) = (&self.narrow, &self.narrow_boxes);
        let of_wide = Contender::best("obvhs cwbvh", rays.clone(), move |ray: &Ray| {
            let mut hit = RayHit::none();
            let test = |ray: &Ray, at: usize| wide_boxes[at].intersect_ray(ray);
            let is_hit = wide.ray_traverse(*ray, &mut hit, test);
            answer(&hit, is_hit, &wide.primitive_indices)
        });
        let of_narrow = Contender::best("obvhs bvh2", rays, move |ray: &Ray| {
            let mut hit = RayHit::none();
            let test = |ray: &Ray, at: usize| narrow_boxes[at].intersect_ray(ray);
            let is_hit = narrow.ray_traverse(*ray, &mut hit, test);
            answer(&hit, is_hit, &narrow.primitive_indices)
        });
        vec![of_wide, of_narrow]
    }

    /// Calls `found` with the index of each box of the leaf `node` that passes `test`. Returns
    /// `true`, by which the traversal continues.
    fn leaf(&self, node: u32, test: impl Fn(&Aabb) -> bool, found: &mut dyn FnMut(u32)) -> bool {
        let node = &self.narrow.nodes[node as usize];
        let first = node.first_index as usize;
        for at in first..first + node.prim_count as usize {
            if test(&self.narrow_boxes[at]) {
                found(self.narrow.primitive_indices[at]);
            }
        }
        true
    }
}

impl Library<3> for Obvhs<'_> {
    fn contenders<'a>(&'a self, questions: &Questions<3>) -> Vec<Contender<'a>> {
        let (name, tree) = ("obvhs bvh2", &self.narrow);
        match questions {
            Questions::Rays(rays, reach) => vec![self.solids(rays, *reach)],
            Questions::BoxRays(rays, reach) => self.rays(rays, *reach),
            Questions::BoxContaining(points) => {
                let points = points.iter().map(|at| Vec3A::from(*at)).collect();
                vec![Contender::all(name, points, move |point: &Vec3A, found| {
                    tree.point_traverse(*point, |_, node| {
                        self.leaf(node, |aabb| aabb.contains_point(*point), found)
                    });
                })]
            }
            Questions::BoxOverlapping(boxes) => {
                let boxes = boxes.iter().map(aabb).collect();
                vec![Contender::all(name, boxes, move |asked: &Aabb, found| {
                    tree.aabb_traverse(*asked, |_, node| {
                        self.leaf(node, |aabb| aabb.intersect_aabb(asked), found)
                    });
                })]
            }
            _ => Vec::new(),
        }
    }
}
