// Source shared by the modules for both dimensions; included by `parry.rs`.

use rapier::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier::parry::partitioning::{Bvh, BvhBuildStrategy};
use rapier::parry::query::{DefaultQueryDispatcher, PointQuery, Ray, RayCast, ShapeCastOptions};
use rapier::parry::shape::{Ball, Cuboid, SharedShape};
use rapier::prelude::*;

/// The number of steps of rapier after which its tree is fully optimized.
const STEPS: usize = 80;

/// The contender rapier: colliders without bodies, which ignore each other.
pub struct Rapier {
    broad_phase: BroadPhaseBvh,
    bodies: RigidBodySet,
    colliders: ColliderSet,
}

impl Rapier {
    /// Creates a world with all objects of a scene.
    pub fn new(scene: &Scene<DIM>) -> Self {
        let (mut colliders, bodies) = (ColliderSet::new(), RigidBodySet::new());
        for (n, (shape, placement)) in scene.objects.iter().enumerate() {
            let collider = ColliderBuilder::new(solid(shape)).position(pose(placement));
            colliders.insert(collider.user_data(n as u128));
        }
        let mut world = Self { broad_phase: BroadPhaseBvh::new(), bodies, colliders };
        world.settle();
        world
    }

    fn settle(&mut self) {
        let (mut pipeline, mut narrow_phase) = (CollisionPipeline::new(), NarrowPhase::new());
        let mut islands = IslandManager::new();
        for _ in 0..STEPS {
            pipeline.step(
                0.002,
                &mut islands,
                &mut self.broad_phase,
                &mut narrow_phase,
                &mut self.bodies,
                &mut self.colliders,
                &(),
                &(),
            );
        }
    }

    fn pipeline(&self) -> QueryPipeline<'_> {
        let (bodies, colliders) = (&self.bodies, &self.colliders);
        let all = QueryFilter::default();
        self.broad_phase.as_query_pipeline(&DefaultQueryDispatcher, bodies, colliders, all)
    }

    fn index(&self, handle: ColliderHandle) -> u32 {
        index_of(&self.colliders[handle])
    }
}

fn index_of(collider: &Collider) -> u32 {
    u32::try_from(collider.user_data).expect("it was an index")
}

fn solid(shape: &SceneShape<DIM>) -> SharedShape {
    match shape {
        SceneShape::Ball { radius } => SharedShape::new(Ball::new(*radius as f32)),
        SceneShape::Cuboid { half_extents } => {
            SharedShape::new(Cuboid::new(vector(&half_extents.map(|x| x as f32))))
        }
        other => unreachable!("{other:?} is not in these scenes"),
    }
}

fn vector(v: &[f32; DIM]) -> Vector {
    Vector::from(*v)
}

/// Converts a ray to a ray of parry.
pub fn ray((from, to): &crate::queries::scene::Ray<DIM>) -> Ray {
    Ray::new(vector(from), vector(to))
}

fn vectors(points: &[[f32; DIM]]) -> Vec<Vector> {
    points.iter().map(vector).collect()
}

fn aabb((low, high): &Corners<DIM>) -> Aabb {
    Aabb::new(vector(low), vector(high))
}

fn placed((shape, placement): &Solid<DIM>) -> (Pose, SharedShape) {
    (pose(placement), solid(shape))
}

impl Library<DIM> for Rapier {
    fn contenders<'a>(&'a self, questions: &Questions<DIM>) -> Vec<Contender<'a>> {
        let (name, pipeline) = ("rapier", self.pipeline());
        let contender = match questions {
            Questions::Rays(rays, reach) => {
                let (rays, reach) = (rays.iter().map(ray).collect(), *reach);
                Contender::best(name, rays, move |ray| {
                    // The variant with a normal is called, since the other contenders compute the
                    // normal too.
                    let (handle, hit) = pipeline.cast_ray_and_get_normal(ray, reach, true)?;
                    Some((self.index(handle), hit.time_of_impact))
                })
            }
            Questions::Casts(casts, reach) => {
                let options = ShapeCastOptions::with_max_time_of_impact(*reach);
                let casts = casts.iter().map(|(solid, to)| (placed(solid), vector(to))).collect();
                Contender::best(name, casts, move |((at, shape), to)| {
                    let (handle, hit) = pipeline.cast_shape(at, *to, &**shape, options)?;
                    Some((self.index(handle), hit.time_of_impact))
                })
            }
            Questions::Nearest(points) => {
                Contender::best(name, vectors(points), move |point: &Vector| {
                    let (handle, found) = pipeline.project_point(*point, f32::MAX, true)?;
                    Some((self.index(handle), found.point.distance(*point)))
                })
            }
            Questions::Containing(points) => {
                Contender::all(name, vectors(points), move |point, found| {
                    pipeline.intersect_point(*point).for_each(|(_, it)| found(index_of(it)));
                })
            }
            Questions::Overlapping(solids) => {
                let solids = solids.iter().map(placed).collect();
                Contender::all(name, solids, move |(at, shape): &(Pose, SharedShape), found| {
                    let touching = pipeline.intersect_shape(*at, &**shape);
                    touching.for_each(|(_, it)| found(index_of(it)));
                })
            }
            // The boxes in rapier's tree are enlarged; therefore the exact boxes are tested too.
            Questions::BoxOverlapping(boxes) => {
                let boxes = boxes.iter().map(aabb).collect();
                Contender::all("rapier world", boxes, move |aabb: &Aabb, found| {
                    let near = pipeline.intersect_aabb_conservative(*aabb);
                    near.filter(|(_, it)| it.compute_aabb().intersects(aabb))
                        .for_each(|(_, it)| found(index_of(it)));
                })
            }
            _ => return Vec::new(),
        };
        vec![contender]
    }
}

/// The contender parry: its tree over boxes, and the solids in them.
pub struct Parry {
    /// The solids with their poses.
    pub solids: Vec<(Pose, SharedShape)>,
    tree: Bvh,
    boxes: Vec<Aabb>,
}

impl Parry {
    /// Builds a tree over all objects of a scene, with the better of parry's two build strategies.
    pub fn new(scene: &Scene<DIM>) -> Self {
        let boxes: Vec<_> = scene.boxes.iter().map(aabb).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        Self { solids: scene.objects.iter().map(placed).collect(), tree, boxes }
    }

    fn among_boxes<'a>(&'a self, questions: &Questions<DIM>) -> Option<Contender<'a>> {
        let (name, tree, boxes) = ("parry", &self.tree, &self.boxes);
        Some(match questions {
            Questions::BoxRays(rays, reach) => {
                let (rays, reach) = (rays.iter().map(ray).collect(), *reach);
                Contender::best(name, rays, move |ray| {
                    tree.cast_ray(ray, reach, |n, best| {
                        boxes[n as usize].cast_local_ray(ray, best, true)
                    })
                })
            }
            Questions::BoxNearest(points) => {
                Contender::best(name, vectors(points), move |point: &Vector| {
                    let nearest = tree.project_point(*point, f32::MAX, |n, _| {
                        Some(boxes[n as usize].project_local_point(*point, true))
                    });
                    nearest.map(|(n, (distance, _))| (n, distance))
                })
            }
            Questions::BoxContaining(points) => {
                let points = points.iter().map(|at| aabb(&(*at, *at))).collect();
                Contender::all(name, points, move |at, found| {
                    tree.intersect_aabb(at).for_each(found);
                })
            }
            Questions::BoxOverlapping(asked) => {
                let asked = asked.iter().map(aabb).collect();
                Contender::all(name, asked, move |aabb, found| {
                    tree.intersect_aabb(aabb).for_each(found);
                })
            }
            _ => return None,
        })
    }
}

impl Library<DIM> for Parry {
    fn contenders<'a>(&'a self, questions: &Questions<DIM>) -> Vec<Contender<'a>> {
        let (name, tree, solids) = ("parry", &self.tree, &self.solids);
        let contender = match questions {
            Questions::Rays(rays, reach) => {
                let (rays, reach) = (rays.iter().map(ray).collect(), *reach);
                Contender::best(name, rays, move |ray| {
                    tree.cast_ray(ray, reach, |n, best| {
                        let (at, solid) = &solids[n as usize];
                        let hit = solid.cast_ray_and_get_normal(at, ray, best, true)?;
                        Some(std::hint::black_box(hit).time_of_impact)
                    })
                })
            }
            Questions::Nearest(points) => {
                Contender::best(name, vectors(points), move |point: &Vector| {
                    let nearest = tree.project_point(*point, f32::MAX, |n, _| {
                        let (at, solid) = &solids[n as usize];
                        Some(solid.project_point(at, *point, true))
                    });
                    nearest.map(|(n, (distance, _))| (n, distance))
                })
            }
            Questions::Containing(points) => {
                let points = points.iter().map(|at| (vector(at), aabb(&(*at, *at)))).collect();
                Contender::all(name, points, move |(point, aabb): &(Vector, Aabb), found| {
                    let holds = |n: &u32| {
                        let (at, solid) = &solids[*n as usize];
                        solid.contains_point(at, *point)
                    };
                    tree.intersect_aabb(aabb).filter(holds).for_each(found);
                })
            }
            other => return self.among_boxes(other).into_iter().collect(),
        };
        vec![contender]
    }
}
