//! rapier's `CollisionPipeline` in the plane; the twin of `rapier3` with other constructors.
//!
//! Set up as in the tests of that pipeline: colliders without bodies,
//! which cost it less than kinematic ones, all collision types active (colliders without bodies are
//! fixed, and fixed ones ignore one another otherwise), the workspace kept between steps, no hooks
//! and no events. Its boxes are loosened by 0.04, as those of the scenes are.

use impinge_scenes::{Placement, Scene, SceneShape};
use rapier2d::prelude::*;

use super::PREDICTION;
use super::contender::{Contender, Reading};

/// A world of rapier.
pub struct Rapier {
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    pipeline: CollisionPipeline,
    handles: Vec<ColliderHandle>,
    moved: Vec<(ColliderHandle, Pose)>,
}

impl Rapier {
    /// A world with the objects of a scene as they are at step 0.
    pub fn new(scene: &Scene<2>) -> Self {
        let mut colliders = ColliderSet::new();
        let handles = (0..scene.objects.len()).map(|n| {
            let collider = builder(&scene.objects[n].shape)
                .position(pose(&scene.placement(n, 0)))
                .active_collision_types(ActiveCollisionTypes::all())
                .user_data(n as u128);
            colliders.insert(collider)
        });
        let handles = handles.collect();
        Self {
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::new(),
            bodies: RigidBodySet::new(),
            colliders,
            pipeline: CollisionPipeline::new(),
            handles,
            moved: Vec::new(),
        }
    }

    fn index(&self, handle: ColliderHandle) -> usize {
        usize::try_from(self.colliders[handle].user_data).expect("it was an index")
    }
}

fn builder(shape: &SceneShape<2>) -> ColliderBuilder {
    match shape {
        SceneShape::Ball { radius } => ColliderBuilder::ball(*radius as f32),
        SceneShape::Cuboid { half_extents: [x, y] } => {
            ColliderBuilder::cuboid(*x as f32, *y as f32)
        }
        SceneShape::Capsule { half_height, radius } => {
            ColliderBuilder::capsule_y(*half_height as f32, *radius as f32)
        }
        SceneShape::Plane { normal } => {
            ColliderBuilder::new(SharedShape::halfspace(vector(normal)))
        }
        SceneShape::Segment { ends: [a, b] } => ColliderBuilder::segment(vector(a), vector(b)),
        SceneShape::Triangle { corners } => {
            let [a, b, c] = counter_clockwise(*corners);
            ColliderBuilder::triangle(vector(&a), vector(&b), vector(&c))
        }
        SceneShape::Convex { points } => {
            let points: Vec<_> = points.iter().map(vector).collect();
            ColliderBuilder::convex_hull(&points).expect("the points span all dimensions")
        }
        SceneShape::Polyline { vertices } => {
            ColliderBuilder::polyline(vertices.iter().map(vector).collect(), None)
        }
        SceneShape::HeightField { heights, extents, .. } => {
            let heights = heights.iter().map(|height| *height as f32).collect();
            ColliderBuilder::heightfield(heights, vector(extents))
        }
        SceneShape::Cylinder { .. } | SceneShape::Cone { .. } | SceneShape::TriMesh { .. } => {
            unreachable!("not of the plane")
        }
    }
}

/// The order that rapier counts on: of a clockwise triangle it misses contacts.
fn counter_clockwise([a, b, c]: [[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if turn < 0.0 { [a, c, b] } else { [a, b, c] }
}

fn vector(v: &[f64; 2]) -> Vector {
    Vector::from(v.map(|x| x as f32))
}

fn pose(placement: &Placement<2>) -> Pose {
    let [x, y] = placement.translation.map(|x| x as f32);
    let [cosine, sine] = placement.complex().map(|x| x as f32);
    Pose::from_parts(Vector::new(x, y), Rotation::from_cos_sin_unchecked(cosine, sine))
}

impl Contender<2> for Rapier {
    fn prepare(&mut self, moved: &[(usize, Placement<2>)]) {
        self.moved.clear();
        self.moved.extend(moved.iter().map(|(n, placement)| (self.handles[*n], pose(placement))));
    }

    fn step(&mut self) {
        for (handle, pose) in &self.moved {
            self.colliders[*handle].set_position(*pose);
        }
        self.pipeline.step(
            PREDICTION,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &(),
            &(),
        );
    }

    fn read(&self) -> Reading {
        let mut reading = Reading::default();
        let manifolds = self.narrow_phase.contact_pairs().flat_map(|pair| pair.manifolds());
        for point in manifolds.flat_map(|manifold| &manifold.points) {
            reading.points += 1;
            reading.depth -= f64::from(std::hint::black_box(point).dist);
        }
        reading
    }

    fn touching(&self) -> Vec<(usize, usize)> {
        let near = |pair: &&ContactPair| {
            let mut points = pair.manifolds().iter().flat_map(|manifold| &manifold.points);
            points.any(|point| point.dist <= PREDICTION)
        };
        let indices = |pair: &ContactPair| {
            let (a, b) = (self.index(pair.collider1), self.index(pair.collider2));
            (a.min(b), a.max(b))
        };
        let mut pairs: Vec<_> =
            self.narrow_phase.contact_pairs().filter(near).map(indices).collect();
        pairs.sort_unstable();
        pairs
    }
}
