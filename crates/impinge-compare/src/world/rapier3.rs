//! rapier's `CollisionPipeline` in space; the twin of `rapier2` with other constructors.
//!
//! Set up as in the tests of that pipeline: colliders without bodies,
//! which cost it less than kinematic ones, all collision types active (colliders without bodies are
//! fixed, and fixed ones ignore one another otherwise), the workspace kept between steps, no hooks
//! and no events. Its boxes are loosened by 0.04, as those of the scenes are.

use impinge_scenes::{Placement, Scene, SceneShape};
use rapier3d::prelude::*;

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
    pub fn new(scene: &Scene<3>) -> Self {
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

fn builder(shape: &SceneShape<3>) -> ColliderBuilder {
    match shape {
        SceneShape::Ball { radius } => ColliderBuilder::ball(*radius as f32),
        SceneShape::Cuboid { half_extents: [x, y, z] } => {
            ColliderBuilder::cuboid(*x as f32, *y as f32, *z as f32)
        }
        SceneShape::Capsule { half_height, radius } => {
            ColliderBuilder::capsule_y(*half_height as f32, *radius as f32)
        }
        SceneShape::Plane { normal } => {
            ColliderBuilder::new(SharedShape::halfspace(vector(normal)))
        }
        SceneShape::Segment { ends: [a, b] } => ColliderBuilder::segment(vector(a), vector(b)),
        SceneShape::Triangle { corners: [a, b, c] } => {
            ColliderBuilder::triangle(vector(a), vector(b), vector(c))
        }
        SceneShape::Convex { points } => {
            let points: Vec<_> = points.iter().map(vector).collect();
            ColliderBuilder::convex_hull(&points).expect("the points span all dimensions")
        }
        SceneShape::Cylinder { half_height, radius } => {
            ColliderBuilder::cylinder(*half_height as f32, *radius as f32)
        }
        SceneShape::Cone { half_height, radius } => {
            ColliderBuilder::cone(*half_height as f32, *radius as f32)
        }
        SceneShape::TriMesh { vertices, triangles } => {
            let vertices = vertices.iter().map(vector).collect();
            ColliderBuilder::trimesh(vertices, triangles.clone()).expect("the mesh is sound")
        }
        SceneShape::HeightField { counts, heights, extents } => {
            ColliderBuilder::new(SharedShape::new(field(*counts, heights, extents)))
        }
        SceneShape::Polyline { .. } => unreachable!("not of space"),
    }
}

/// Cells whose bit is set have the diagonal that those of the scene have.
fn field([rows, columns]: [usize; 2], heights: &[f64], extents: &[f64; 3]) -> HeightField {
    let by_column = (0..columns)
        .flat_map(|column| (0..rows).map(move |row| heights[row * columns + column] as f32));
    let mut field =
        HeightField::new(Array2::new(rows, columns, by_column.collect()), vector(extents));
    for (row, column) in (1..rows).flat_map(|row| (1..columns).map(move |column| (row, column))) {
        field.set_cell_status(row - 1, column - 1, HeightFieldCellStatus::ZIGZAG_SUBDIVISION);
    }
    field
}

fn vector(v: &[f64; 3]) -> Vector {
    Vector::from(v.map(|x| x as f32))
}

fn pose(placement: &Placement<3>) -> Pose {
    let [x, y, z] = placement.translation.map(|x| x as f32);
    let [i, j, k, w] = placement.quaternion().map(|x| x as f32);
    Pose::from_parts(Vector::new(x, y, z), Rotation::from_xyzw(i, j, k, w))
}

impl Contender<3> for Rapier {
    fn prepare(&mut self, moved: &[(usize, Placement<3>)]) {
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
