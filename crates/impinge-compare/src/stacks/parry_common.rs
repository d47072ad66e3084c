// Source shared by the modules for both crates of parry; included by `parry.rs`.

use std::collections::BTreeMap;

use parry::bounding_volume::{Aabb, BoundingVolume};
use parry::math::{Pose, Rotation, Vector};
use parry::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
};
use parry::shape::SharedShape;

/// The shapes of a scene, and the state of the pairs whose boxes overlap.
pub struct Parry {
    shapes: Vec<SharedShape>,
    pairs: BTreeMap<[usize; 2], Pair>,
    /// The id of the most recent new contact; ids begin with 1.
    newest: u64,
}

/// The state that parry keeps for a pair from step to step. The user data of a point is its id, or
/// zero if the point is new.
#[derive(Default)]
struct Pair {
    manifolds: Vec<ContactManifold<(), u64>>,
    workspace: Option<ContactManifoldsWorkspace>,
}

impl Parry {
    /// Creates the shapes of a scene.
    pub fn new(stack: &Stack<DIM>) -> Self {
        let shapes = stack.items.iter().map(|item| match &item.solid {
            Solid::One(shape) => builder(shape).shape,
            Solid::Compound(parts) => {
                let parts = parts.iter().map(|(at, shape)| (pose(at), builder(shape).shape));
                SharedShape::compound(parts.collect())
            }
        });
        Self { shapes: shapes.collect(), pairs: BTreeMap::new(), newest: 0 }
    }

    /// Returns the sorted pairs of bodies whose boxes, enlarged by half of the prediction, overlap.
    /// Pairs of two fixed bodies are omitted.
    fn near(&self, bodies: &[Body<f32, DIM>], poses: &[Pose]) -> Vec<[usize; 2]> {
        let margin = PREDICTION as f32 / 2.0;
        let boxes = self.shapes.iter().zip(poses).map(|(shape, pose)| {
            let Aabb { mins, maxs, .. } = shape.compute_aabb(pose);
            Aabb::new(mins - Vector::splat(margin), maxs + Vector::splat(margin))
        });
        let boxes: Vec<_> = boxes.collect();
        let is_fixed = |n: usize| bodies[n].inverse_mass == 0.0;
        let all = (0..boxes.len()).flat_map(|a| (a + 1..boxes.len()).map(move |b| [a, b]));
        all.filter(|&[a, b]| !(is_fixed(a) && is_fixed(b)) && boxes[a].intersects(&boxes[b]))
            .collect()
    }
}

impl ContactSource<f32, DIM> for Parry {
    type Id = u64;

    fn contacts(&mut self, bodies: &[Body<f32, DIM>]) -> Vec<Contact<f32, DIM, u64>> {
        let poses: Vec<_> = bodies.iter().map(|body| pose_of(&body.pose)).collect();
        let near = self.near(bodies, &poses);
        self.pairs.retain(|key, _| near.binary_search(key).is_ok());
        let mut contacts = Vec::new();
        for key in near {
            let [(shape1, pose1), (shape2, pose2)] =
                key.map(|n| (&self.shapes[n], &poses[n]));
            let Pair { manifolds, workspace } = self.pairs.entry(key).or_default();
            let pose12 = pose1.inv_mul(pose2);
            let prediction = PREDICTION as f32;
            DefaultQueryDispatcher
                .contact_manifolds(&pose12, &**shape1, &**shape2, prediction, manifolds, workspace)
                .expect("parry has all pairs of the scenes");
            for manifold in manifolds {
                read(manifold, key, [pose1, pose2], &mut self.newest, &mut contacts);
            }
        }
        contacts
    }
}

/// Reads the points of a manifold that are within the prediction, as rapier does. New points get
/// new ids.
fn read(
    manifold: &mut ContactManifold<(), u64>,
    bodies: [usize; 2],
    [pose1, pose2]: [&Pose; 2],
    newest: &mut u64,
    contacts: &mut Vec<Contact<f32, DIM, u64>>,
) {
    let pose1 = manifold.subshape_pos1().map_or(*pose1, |part| *pose1 * *part);
    let pose2 = manifold.subshape_pos2().map_or(*pose2, |part| *pose2 * *part);
    let normal = pose1.rotation * manifold.local_n1;
    for point in manifold.points.iter_mut().filter(|point| point.dist < PREDICTION as f32) {
        if point.data == 0 {
            *newest += 1;
            point.data = *newest;
        }
        let world = [pose1 * point.local_p1, pose2 * point.local_p2];
        contacts.push(Contact {
            bodies,
            points: world.map(|point| point.to_array().into()),
            normal: normal.to_array().into(),
            depth: -point.dist,
            id: point.data,
        });
    }
}
