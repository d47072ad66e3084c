//! The contender impinge: its world, and its tree of boxes.

use impinge::bounding_volume::Aabb;
use impinge::math::na::{Quaternion, Translation, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::partitioning::BoxTree;
use impinge::query::{ImpactOptions, Ray};
use impinge::shape::{Ball, Cuboid, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld, QueryFilter};
use impinge_scenes::{Placement, SceneShape};

use super::race::Contender;
use super::scene::{Corners, Library, Questions, Scene, Solid};

type Isometry<const D: usize> = <f32 as Space<D>>::Isometry;

/// A function that converts a placement to an isometry.
type Turn<const D: usize> = fn(&Placement<D>) -> Isometry<D>;

/// The number of updates before the queries. No object moves during them, and they are enough for
/// the trees to reach their final order.
const UPDATES: usize = 128;

/// The contender: a world and a tree of boxes of the same scene.
pub struct Impinge<const D: usize>
where
    f32: Space<D>,
{
    name: &'static str,
    isometry: Turn<D>,
    world: CollisionWorld<f32, D, u32>,
    tree: BoxTree<f32, D>,
}

/// Creates the 2D contender.
pub fn plane(scene: &Scene<2>) -> Impinge<2> {
    Impinge::new("impinge", scene, 0, |placement| {
        let [cosine, sine] = placement.complex().map(|x| x as f32);
        let rotation = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(Translation::from(placement.translation.map(|x| x as f32)), rotation)
    })
}

/// Creates the 3D contender.
pub fn space(scene: &Scene<3>) -> Impinge<3> {
    moved("impinge", scene, 0)
}

/// Creates the 3D contender in which the first `count` objects have moved since the last update.
pub fn moved(name: &'static str, scene: &Scene<3>, count: usize) -> Impinge<3> {
    Impinge::new(name, scene, count, |placement| {
        let [i, j, k, w] = placement.quaternion().map(|x| x as f32);
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation::from(placement.translation.map(|x| x as f32)), rotation)
    })
}

impl<const D: usize> Impinge<D>
where
    f32: Space<D>,
{
    /// Creates the contender. No object interacts with another, so that the world has queries but
    /// no pairs. The first `moved` objects get their positions in the scene after the last update;
    /// until then, they are 0.5 lower on the first axis.
    fn new(name: &'static str, scene: &Scene<D>, moved: usize, isometry: Turn<D>) -> Self {
        let mut world = CollisionWorld::new(0.02);
        let mut nobody = CollisionGroups::new();
        nobody.set_whitelist(&[]);
        let mut handles = Vec::new();
        for (n, (shape, placement)) in (0_u32..).zip(&scene.objects) {
            let (mut from, query) = (*placement, GeometricQueryType::Proximity(0.0));
            from.translation[0] -= if (n as usize) < moved { 0.5 } else { 0.0 };
            handles.push(world.add(isometry(&from), solid(shape), nobody, query, n));
        }
        (0..UPDATES).for_each(|_| world.update());
        for (handle, (_, placement)) in handles.iter().zip(&scene.objects).take(moved) {
            world.set_position(*handle, isometry(placement));
        }
        let tree = BoxTree::from_boxes(&scene.boxes.iter().map(aabb).collect::<Vec<_>>());
        Self { name, isometry, world, tree }
    }

    fn placed(&self, (shape, placement): &Solid<D>) -> (Isometry<D>, ShapeHandle<f32, D>) {
        ((self.isometry)(placement), solid(shape))
    }
}

fn solid<const D: usize>(shape: &SceneShape<D>) -> ShapeHandle<f32, D>
where
    f32: Space<D>,
{
    match shape {
        SceneShape::Ball { radius } => ShapeHandle::new(Ball::new(*radius as f32)),
        SceneShape::Cuboid { half_extents } => {
            let half_extents = Vector::<f32, D>::from(half_extents.map(|x| x as f32));
            ShapeHandle::new(Cuboid::new(half_extents))
        }
        other => unreachable!("{other:?} is not in these scenes"),
    }
}

fn aabb<const D: usize>((low, high): &Corners<D>) -> Aabb<f32, D> {
    Aabb::new(Point::from(*low), Point::from(*high))
}

/// Converts a ray to a ray of impinge.
pub fn ray<const D: usize>((from, to): &super::scene::Ray<D>) -> Ray<f32, D> {
    Ray::new(Point::from(*from), Vector::<f32, D>::from(*to))
}

fn points<const D: usize>(points: &[[f32; D]]) -> Vec<Point<f32, D>> {
    points.iter().map(|point| Point::from(*point)).collect()
}

impl<const D: usize> Library<D> for Impinge<D>
where
    f32: Space<D>,
{
    /// Returns the contenders of this library; all others are compared with the first of them.
    fn contenders<'a>(&'a self, questions: &Questions<D>) -> Vec<Contender<'a>> {
        match questions {
            Questions::Rays(..) | Questions::Casts(..) => self.on_the_way(questions),
            Questions::Nearest(..) | Questions::Containing(_) | Questions::Overlapping(_) => {
                self.at_rest(questions)
            }
            _ => self.among_boxes(questions),
        }
    }
}

impl<const D: usize> Impinge<D>
where
    f32: Space<D>,
{
    fn on_the_way<'a>(&'a self, questions: &Questions<D>) -> Vec<Contender<'a>> {
        let (name, world, all) = (self.name, &self.world, QueryFilter::new());
        match questions {
            Questions::Rays(rays, reach) => {
                let (rays, reach) = (rays.iter().map(ray).collect(), *reach);
                vec![Contender::best(name, rays, move |ray| {
                    let (object, hit) = world.first_ray_hit(ray, reach, true, &all)?;
                    Some((*object.data(), hit.toi))
                })]
            }
            Questions::Casts(casts, reach) => {
                let options = ImpactOptions::new().with_max_time(*reach);
                let cast =
                    |(solid, to): &(_, [f32; D])| (self.placed(solid), Vector::<f32, D>::from(*to));
                let casts = casts.iter().map(cast).collect();
                vec![Contender::best(name, casts, move |((at, shape), to)| {
                    let (object, hit) = world.cast_shape(at, to, &**shape, &options, &all)?;
                    Some((*object.data(), hit.toi))
                })]
            }
            _ => Vec::new(),
        }
    }

    fn at_rest<'a>(&'a self, questions: &Questions<D>) -> Vec<Contender<'a>> {
        let (name, world, all) = (self.name, &self.world, QueryFilter::new());
        match questions {
            Questions::Nearest(asked) => {
                vec![Contender::best(name, points(asked), move |point| {
                    let (object, found) = world.project_point(point, f32::INFINITY, true, &all)?;
                    Some((*object.data(), (found.point - point).norm()))
                })]
            }
            Questions::Containing(asked) => {
                vec![Contender::all(name, points(asked), move |point, found| {
                    world.objects_containing(point, &all).for_each(|object| found(*object.data()));
                })]
            }
            Questions::Overlapping(solids) => {
                let solids = solids.iter().map(|solid| self.placed(solid)).collect();
                vec![Contender::all(name, solids, move |(at, shape), found| {
                    let touching = world.objects_overlapping(at, &**shape, &all);
                    touching.for_each(|object| found(*object.data()));
                })]
            }
            _ => Vec::new(),
        }
    }

    fn among_boxes<'a>(&'a self, questions: &Questions<D>) -> Vec<Contender<'a>> {
        let (world, tree, all) = (&self.world, &self.tree, QueryFilter::new());
        let numbered = |(index, key)| (index as u32, key);
        match questions {
            Questions::BoxRays(rays, reach) => {
                let (rays, reach) = (rays.iter().map(ray).collect(), *reach);
                vec![Contender::best("impinge", rays, move |ray| {
                    tree.first_hit(ray, reach).map(numbered)
                })]
            }
            Questions::BoxNearest(asked) => {
                vec![Contender::best("impinge", points(asked), move |point| {
                    tree.nearest(point, f32::INFINITY).map(numbered)
                })]
            }
            Questions::BoxContaining(asked) => {
                vec![Contender::all("impinge", points(asked), move |point, found| {
                    tree.visit_containing(point, |index| found(index as u32));
                })]
            }
            Questions::BoxOverlapping(asked) => {
                let asked: Vec<_> = asked.iter().map(aabb).collect();
                let of_tree = Contender::all("impinge", asked.clone(), move |aabb, found| {
                    tree.visit_overlapping(aabb, |index| found(index as u32));
                });
                let of_world = Contender::all("impinge world", asked, move |aabb, found| {
                    world.objects_in_aabb(aabb, &all).for_each(|object| found(*object.data()));
                });
                vec![of_tree, of_world]
            }
            _ => Vec::new(),
        }
    }
}
