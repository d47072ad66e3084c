//! Contacts of scenes, from a generator that holds one pair alone, and from worlds that hold many.

use impinge::math::{AbstractRotation, Isometry, Real, Space};
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher,
    GeometricQueryType, IdAllocator, PairManifoldGenerator,
};
use impinge::query::TrackedContact;
use impinge::shape::Shape;
use impinge::world::{CollisionGroups, CollisionWorld};

use super::scene::Scene;

/// The contact points of a pair; empty if the pair has no contacts.
pub(crate) type Points<N, const D: usize> = Vec<TrackedContact<N, D>>;

/// A generator of one pair, which keeps its state from one call to the next.
pub(crate) struct Lone<N: Real, const D: usize> {
    generator: PairManifoldGenerator<N, D>,
    ids: IdAllocator,
}

impl<N: Space<D>, const D: usize> Lone<N, D> {
    pub(crate) fn new() -> Self {
        Self { generator: PairManifoldGenerator::default(), ids: IdAllocator::new() }
    }

    pub(crate) fn with_max_points(max_points: usize) -> Self {
        Self { generator: PairManifoldGenerator::new(max_points), ids: IdAllocator::new() }
    }

    pub(crate) fn ask(
        &mut self,
        [pose1, pose2]: [&N::Isometry; 2],
        [shape1, shape2]: [&dyn Shape<N, D>; 2],
        limit: N,
        angle: N,
    ) -> Points<N, D> {
        let dispatcher = DefaultContactDispatcher::<D>::new();
        let half = angle * N::HALF;
        let prediction = ContactPrediction::new(limit, half, half);
        let ids = &mut self.ids;
        let able =
            self.generator.update(&dispatcher, pose1, shape1, pose2, shape2, &prediction, ids);
        assert!(able, "all solids are served");
        let mut manifolds = Vec::new();
        self.generator.contacts(&mut manifolds);
        assert!(manifolds.len() <= 1, "two convex solids have one manifold");
        manifolds.iter().flat_map(|manifold| manifold.contacts()).copied().collect()
    }
}

/// A world of several scenes, whose poses may overlap: collision groups let only the two solids of
/// a scene interact.
pub(crate) struct Batch<N: Space<D>, const D: usize> {
    world: CollisionWorld<N, D, usize>,
    handles: Vec<[CollisionObjectHandle; 2]>,
}

impl<N, R, const D: usize> Batch<N, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    pub(crate) fn new(scenes: &[Scene<N, R, D>]) -> Self {
        let mut world = CollisionWorld::<N, D, usize>::new(N::lit(0.02));
        let place = |(index, scene): (usize, &Scene<N, R, D>)| {
            let query = GeometricQueryType::Contacts(scene.limit * N::HALF, scene.angle * N::HALF);
            let mut groups = CollisionGroups::new();
            groups.set_membership(&[index]);
            groups.set_whitelist(&[index]);
            [0, 1].map(|which| {
                let shape = scene.forms[which].shape.clone();
                world.add(scene.poses[which].clone(), shape, groups, query, index)
            })
        };
        let handles = scenes.iter().enumerate().map(place).collect();
        let mut batch = Self { world, handles };
        batch.world.update();
        batch
    }

    /// Moves the second solid of each scene.
    pub(crate) fn move_to<'a>(&mut self, poses: impl Iterator<Item = &'a Isometry<N, R, D>>)
    where
        R: 'a,
    {
        for (pose, handles) in poses.zip(&self.handles) {
            self.world.set_position(handles[1], pose.clone());
        }
        self.world.update();
    }

    /// Returns the contact points of each scene.
    pub(crate) fn points(&self) -> Vec<Points<N, D>> {
        let mut points = vec![Vec::new(); self.handles.len()];
        for (object, _, manifold) in self.world.contact_manifolds() {
            points[*object.data()].extend_from_slice(manifold.contacts());
        }
        points
    }
}
