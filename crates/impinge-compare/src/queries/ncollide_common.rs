// Source shared by the modules for both crates of ncollide; included by `ncollide.rs`.

use ncollide::bounding_volume::AABB;
use ncollide::math::{Isometry, Point, Vector};
use ncollide::partitioning::{BVH, BestFirstVisitStatus, BestFirstVisitor, DBVT, DBVTLeaf};
use ncollide::query::visitors::{
    BoundingVolumeInterferencesCollector, PointInterferencesCollector,
};
use ncollide::query::{PointQuery, Ray, RayCast};

/// The contender: a tree of boxes.
pub struct Ncollide {
    tree: DBVT<f32, u32, AABB<f32>>,
}

impl Ncollide {
    /// Builds the tree over the boxes of a scene. The tree of ncollide has no bulk build, so that
    /// the boxes are inserted one by one.
    pub fn new(scene: &Scene<DIM>) -> Self {
        let mut tree = DBVT::new();
        for (n, corners) in (0..).zip(&scene.boxes) {
            tree.insert(DBVTLeaf::new(aabb(corners), n));
        }
        Self { tree }
    }
}

fn aabb((low, high): &Corners<DIM>) -> AABB<f32> {
    AABB::new(Point::from(*low), Point::from(*high))
}

/// A best-first visitor that orders boxes by the time or distance that the function returns. A box
/// for which it returns `None` is excluded.
struct Cheapest<F>(F);

impl<F: Fn(&AABB<f32>) -> Option<f32>> BestFirstVisitor<f32, u32, AABB<f32>> for Cheapest<F> {
    type Result = (u32, f32);

    fn visit(
        &mut self,
        _: f32,
        aabb: &AABB<f32>,
        id: Option<&u32>,
    ) -> BestFirstVisitStatus<f32, Self::Result> {
        match (self.0)(aabb) {
            None => BestFirstVisitStatus::Stop,
            Some(cost) => {
                BestFirstVisitStatus::Continue { cost, result: id.map(|id| (*id, cost)) }
            }
        }
    }
}

impl Library<DIM> for Ncollide {
    fn contenders<'a>(&'a self, questions: &Questions<DIM>) -> Vec<Contender<'a>> {
        let (name, tree, here) = ("ncollide", &self.tree, Isometry::identity());
        let contender = match questions {
            Questions::BoxRays(rays, reach) => {
                let ray = |(from, to): &([f32; DIM], [f32; DIM])| {
                    Ray::new(Point::from(*from), Vector::from(*to))
                };
                let (rays, reach) = (rays.iter().map(ray).collect(), *reach);
                Contender::best(name, rays, move |ray| {
                    let time = |aabb: &AABB<f32>| aabb.toi_with_ray(&here, ray, reach, true);
                    tree.best_first_search(&mut Cheapest(time)).map(|(_, best)| best)
                })
            }
            Questions::BoxNearest(points) => {
                let points = points.iter().map(|at| Point::from(*at)).collect();
                Contender::best(name, points, move |point| {
                    let far = |aabb: &AABB<f32>| Some(aabb.distance_to_point(&here, point, true));
                    tree.best_first_search(&mut Cheapest(far)).map(|(_, best)| best)
                })
            }
            Questions::BoxContaining(points) => {
                let mut buffer = Vec::new();
                let points = points.iter().map(|at| Point::from(*at)).collect();
                Contender::all(name, points, move |point, found| {
                    tree.visit(&mut PointInterferencesCollector::new(point, &mut buffer));
                    buffer.drain(..).for_each(found);
                })
            }
            Questions::BoxOverlapping(boxes) => {
                let mut buffer = Vec::new();
                let boxes = boxes.iter().map(aabb).collect();
                Contender::all(name, boxes, move |aabb, found| {
                    tree.visit(&mut BoundingVolumeInterferencesCollector::new(aabb, &mut buffer));
                    buffer.drain(..).for_each(found);
                })
            }
            _ => return Vec::new(),
        };
        vec![contender]
    }
}
