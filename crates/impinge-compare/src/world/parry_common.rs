// Source shared by the modules for both crates of parry; included by `parry_tree.rs`.

use parry::bounding_volume::Aabb;
use parry::math::{Pose, Vector};
use parry::partitioning::{Bvh, BvhBuildStrategy, BvhLeafUpdateStatus, BvhWorkspace};
use parry::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
    QueryDispatcher,
};
use parry::shape::SharedShape;
use parry::utils::hashmap::HashMap;

/// An object. Its index is also that of its leaf in the tree.
struct Object {
    shape: SharedShape,
    pose: Pose,
    is_sensor: bool,
    /// The step in which the object was last moved, added or removed.
    changed: u32,
}

/// The state of two objects whose fat AABBs overlap.
#[derive(Default)]
struct Pair {
    manifolds: Vec<ContactManifold<(), ()>>,
    workspace: Option<ContactManifoldsWorkspace>,
    is_touching: bool,
}

/// The contender: the tree, the pairs, and the pending changes of objects.
pub struct ParryTree {
    objects: Vec<Object>,
    tree: Bvh,
    workspace: BvhWorkspace,
    pairs: HashMap<(u32, u32), Pair>,
    /// The pairs whose touching changed in the last step; `true` if they started to touch.
    events: Vec<((u32, u32), bool)>,
    step: u32,
    /// The margin by which boxes are enlarged to fat AABBs.
    margin: f32,
    /// The leaves that changed in this step, and those that changed in the previous one, whose
    /// marks the tree still has.
    changed: [Vec<u32>; 2],
    gone: Vec<u32>,
    born: Vec<(u32, Pose)>,
    moved: Vec<(u32, Pose)>,
}

impl ParryTree {
    /// Creates a world with the objects of a scene at step 0.
    pub fn new(scene: &Scene<DIM>) -> Self {
        let objects = scene.objects.iter().enumerate().map(|(n, object)| Object {
            shape: builder(&object.shape).shape,
            pose: pose(&scene.placement(n, 0)),
            is_sensor: matches!(object.query, SceneQuery::Proximity { .. }),
            changed: 0,
        });
        let objects: Vec<_> = objects.collect();
        let margin = scene.margin as f32;
        let alive = (0..objects.len()).filter(|n| scene.is_alive(*n, 0));
        let leaves = alive.map(|n| (n, loosened(&objects[n].aabb(), margin)));
        let tree = Bvh::from_iter(BvhBuildStrategy::default(), leaves);
        let (workspace, pairs, events, changed) = <_>::default();
        let (gone, born, moved) = <_>::default();
        let step = 0;
        let mut made = Self {
            objects,
            tree,
            workspace,
            pairs,
            events,
            step,
            margin,
            changed,
            gone,
            born,
            moved,
        };
        let Self { tree, workspace, pairs, .. } = &mut made;
        // The second refit clears the marks of new leaves.
        tree.refit(workspace);
        tree.refit(workspace);
        let mut begin = |a, b| {
            pairs.insert(key(a, b), Pair::default());
        };
        tree.traverse_bvtt_single_tree::<false>(workspace, &mut begin);
        made
    }

    /// Removes, adds and moves leaves, refits the tree, and creates the new pairs that it lists.
    fn update_tree(&mut self) {
        let Self { objects, tree, workspace, pairs, changed: [changed, before], .. } = self;
        std::mem::swap(changed, before);
        changed.clear();
        for n in &self.gone {
            tree.remove(*n);
            objects[*n as usize].changed = self.step;
        }
        // The tree enlarges boxes itself when it replaces an old box, but not when it adds one.
        let born = self.born.iter().map(|placed| (placed, self.margin));
        let moved = self.moved.iter().map(|placed| (placed, 0.0));
        for ((n, pose), margin) in born.chain(moved) {
            let object = &mut objects[*n as usize];
            (object.pose, object.changed) = (*pose, self.step);
            let aabb = loosened(&object.aabb(), margin);
            let status = tree.insert_or_update_partially(aabb, *n, self.margin);
            if status != BvhLeafUpdateStatus::Unchanged {
                changed.push(*n);
            }
        }
        // The limit of a sixteenth is that of rapier, which also refits the whole tree after a
        // removal.
        let few = (before.len() + changed.len()) * 16 < tree.leaf_count() as usize;
        if few && self.gone.is_empty() {
            tree.refit_partial(before, changed);
        } else {
            tree.optimize_incremental(workspace);
            tree.refit(workspace);
        }
        if !changed.is_empty() {
            let mut begin = |a, b| {
                pairs.entry(key(a, b)).or_default();
            };
            tree.traverse_bvtt_single_tree::<true>(workspace, &mut begin);
        }
    }

    /// Removes the pairs whose boxes are apart, and recomputes the others except those of which
    /// neither object moved.
    fn update_pairs(&mut self) {
        let Self { objects, tree, pairs, events, step, .. } = self;
        events.clear();
        pairs.retain(|&(a, b), pair| {
            let [one, two] = [a, b].map(|n| &objects[n as usize]);
            if one.changed != *step && two.changed != *step {
                return true;
            }
            let leaves = tree.leaf_node(a).zip(tree.leaf_node(b));
            let is_near = leaves.is_some_and(|(leaf1, leaf2)| leaf1.intersects(leaf2));
            let was_touching = pair.is_touching;
            pair.is_touching = is_near && pair.update(one, two);
            if pair.is_touching != was_touching {
                events.push(((a, b), pair.is_touching));
            }
            is_near
        });
    }
}

impl Object {
    /// Returns the AABB, enlarged by half of the prediction. So the boxes of objects within the
    /// prediction overlap.
    fn aabb(&self) -> Aabb {
        loosened(&self.shape.compute_aabb(&self.pose), PREDICTION / 2.0)
    }
}

impl Pair {
    /// Recomputes the pair. Returns `true` if the objects touch: by a contact point within the
    /// prediction, or by intersection if one of them is a sensor.
    fn update(&mut self, one: &Object, two: &Object) -> bool {
        let pose12 = one.pose.inv_mul(&two.pose);
        let (shape1, shape2) = (&*one.shape, &*two.shape);
        if one.is_sensor || two.is_sensor {
            let met = DefaultQueryDispatcher.intersection_test(&pose12, shape1, shape2);
            return met.is_ok_and(|met| met.intersecting);
        }
        let Self { manifolds, workspace, .. } = self;
        let made = DefaultQueryDispatcher
            .contact_manifolds(&pose12, shape1, shape2, PREDICTION, manifolds, workspace);
        let mut points = manifolds.iter().flat_map(|manifold| &manifold.points);
        made.is_ok() && points.any(|point| point.dist <= PREDICTION)
    }
}

fn loosened(aabb: &Aabb, margin: f32) -> Aabb {
    Aabb::new(aabb.mins - Vector::splat(margin), aabb.maxs + Vector::splat(margin))
}

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl Contender<DIM> for ParryTree {
    fn prepare(&mut self, change: &Change<DIM>) {
        let number = |n: usize| u32::try_from(n).expect("there are fewer objects");
        let placed = |list: &[(usize, Placement<DIM>)]| {
            list.iter().map(|(n, placement)| (number(*n), pose(placement))).collect()
        };
        self.gone = change.gone.iter().map(|n| number(*n)).collect();
        (self.born, self.moved) = (placed(&change.born), placed(&change.moved));
    }

    fn step(&mut self) {
        self.update_tree();
        self.update_pairs();
        self.step += 1;
        std::hint::black_box(&self.events);
    }

    fn read(&mut self) -> Reading {
        let mut reading = Reading::default();
        let manifolds = self.pairs.values().flat_map(|pair| &pair.manifolds);
        for point in manifolds.flat_map(|manifold| &manifold.points) {
            reading.points += 1;
            reading.depth -= f64::from(std::hint::black_box(point).dist);
        }
        reading
    }

    fn touching(&self) -> Vec<(usize, usize)> {
        let touching = self.pairs.iter().filter(|(_, pair)| pair.is_touching);
        let mut pairs: Vec<_> = touching.map(|(&(a, b), _)| (a as usize, b as usize)).collect();
        pairs.sort_unstable();
        pairs
    }
}
