//! Trees over boxes from the crates `bvh` and `rstar`, which support both dimensions.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use bvh::point_query::PointDistance;
use bvh::ray::Ray;
use impinge::math::Point;
use impinge::math::na::SVector;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::race::Contender;
use super::scene::{Corners, Library, Questions, Scene};

/// The tree of `bvh`.
pub struct BvhTree<const D: usize> {
    boxes: Vec<Leaf<D>>,
    tree: Bvh<f32, D>,
}

/// A box with its index.
#[derive(Clone, Debug)]
struct Leaf<const D: usize> {
    id: u32,
    aabb: Aabb<f32, D>,
    node: usize,
}

impl<const D: usize> Bounded<f32, D> for Leaf<D> {
    fn aabb(&self) -> Aabb<f32, D> {
        self.aabb
    }
}

impl<const D: usize> BHShape<f32, D> for Leaf<D> {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl<const D: usize> PointDistance<f32, D> for Leaf<D> {
    fn distance_squared(&self, point: Point<f32, D>) -> f32 {
        self.aabb.min_distance_squared(point)
    }
}

fn bounds<const D: usize>((low, high): &Corners<D>) -> Aabb<f32, D> {
    Aabb::with_bounds(Point::from(*low), Point::from(*high))
}

impl<const D: usize> BvhTree<D> {
    /// Builds the tree over the boxes of a scene.
    pub fn new(scene: &Scene<D>) -> Self {
        let leaf = |(id, corners)| Leaf { id, aabb: bounds(corners), node: 0 };
        let mut boxes: Vec<_> = (0..).zip(&scene.boxes).map(leaf).collect();
        let tree = Bvh::build(&mut boxes);
        Self { boxes, tree }
    }
}

impl<const D: usize> Library<D> for BvhTree<D> {
    fn contenders<'a>(&'a self, questions: &Questions<D>) -> Vec<Contender<'a>> {
        let (name, tree, boxes) = ("bvh", &self.tree, self.boxes.as_slice());
        let contender = match questions {
            Questions::BoxRays(rays, reach) => {
                let ray = |(from, to): &([f32; D], [f32; D])| {
                    Ray::new(Point::from(*from), SVector::from(*to))
                };
                let (rays, reach) = (rays.iter().map(ray).collect(), *reach);
                Contender::best(name, rays, move |ray| {
                    let first = tree.nearest_traverse_iterator(ray, boxes).next()?;
                    let (enter, _) = ray.intersection_slice_for_aabb(&first.aabb)?;
                    (enter <= reach).then_some((first.id, enter))
                })
            }
            Questions::BoxNearest(points) => {
                let points = points.iter().map(|at| Point::from(*at)).collect();
                Contender::best(name, points, move |point| {
                    tree.nearest_to(*point, boxes).map(|(leaf, distance)| (leaf.id, distance))
                })
            }
            Questions::BoxContaining(points) => {
                let points = points.iter().map(|at| Point::from(*at)).collect();
                Contender::all(name, points, move |point: &Point<f32, D>, found| {
                    tree.traverse_iterator(point, boxes).for_each(|leaf| found(leaf.id));
                })
            }
            Questions::BoxOverlapping(asked) => {
                let asked = asked.iter().map(bounds).collect();
                Contender::all(name, asked, move |aabb: &Aabb<f32, D>, found| {
                    tree.traverse_iterator(aabb, boxes).for_each(|leaf| found(leaf.id));
                })
            }
            _ => return Vec::new(),
        };
        vec![contender]
    }
}

/// The tree of `rstar`, a crate without ray queries.
pub struct RstarTree<const D: usize> {
    tree: RTree<GeomWithData<Rectangle<[f32; D]>, u32>>,
}

impl<const D: usize> RstarTree<D> {
    /// Builds the tree over the boxes of a scene.
    pub fn new(scene: &Scene<D>) -> Self {
        let leaf = |(id, (low, high)): (u32, &Corners<D>)| {
            GeomWithData::new(Rectangle::from_corners(*low, *high), id)
        };
        Self { tree: RTree::bulk_load((0..).zip(&scene.boxes).map(leaf).collect()) }
    }
}

impl<const D: usize> Library<D> for RstarTree<D> {
    fn contenders<'a>(&'a self, questions: &Questions<D>) -> Vec<Contender<'a>> {
        let (name, tree) = ("rstar", &self.tree);
        let contender = match questions {
            Questions::BoxNearest(points) => {
                Contender::best(name, points.clone(), move |point: &[f32; D]| {
                    let nearest = tree.nearest_neighbor_with_distance_2(*point);
                    nearest.map(|(leaf, squared)| (leaf.data, squared.sqrt()))
                })
            }
            Questions::BoxContaining(points) => {
                Contender::all(name, points.clone(), move |point: &[f32; D], found| {
                    tree.locate_all_at_point(*point).for_each(|leaf| found(leaf.data));
                })
            }
            Questions::BoxOverlapping(boxes) => {
                let boxes = boxes.iter().map(|(low, high)| AABB::from_corners(*low, *high));
                Contender::all(name, boxes.collect(), move |aabb: &AABB<[f32; D]>, found| {
                    let meeting = tree.locate_in_envelope_intersecting(*aabb);
                    meeting.for_each(|leaf| found(leaf.data));
                })
            }
            _ => return Vec::new(),
        };
        vec![contender]
    }
}
