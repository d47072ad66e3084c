// The rest, for both crates; included by `rapier.rs`.

/// Colliders without bodies, numbered as they come, and the pipeline they go through.
pub struct Colliders {
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    pipeline: CollisionPipeline,
    handles: Vec<ColliderHandle>,
}

impl Colliders {
    /// None.
    pub fn new() -> Self {
        Self {
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::new(),
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            pipeline: CollisionPipeline::new(),
            handles: Vec::new(),
        }
    }

    /// One more, which may touch every other.
    pub fn add(&mut self, collider: ColliderBuilder) {
        let number = self.handles.len();
        let collider = collider
            .active_collision_types(ActiveCollisionTypes::all())
            .user_data(number as u128);
        self.handles.push(self.colliders.insert(collider));
    }

    /// One of them, to be moved.
    pub fn get_mut(&mut self, number: usize) -> &mut Collider {
        &mut self.colliders[self.handles[number]]
    }

    /// Finds what touches what.
    pub fn step(&mut self) {
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

    /// Reads every contact point.
    pub fn read(&self) -> Reading {
        let mut reading = Reading::default();
        let manifolds = self.narrow_phase.contact_pairs().flat_map(|pair| pair.manifolds());
        for point in manifolds.flat_map(|manifold| &manifold.points) {
            reading.points += 1;
            reading.depth -= f64::from(std::hint::black_box(point).dist);
        }
        reading
    }

    /// The numbers of those that touch, the smaller first, in order.
    pub fn touching(&self) -> Vec<(usize, usize)> {
        let near = |pair: &&ContactPair| {
            let mut points = pair.manifolds().iter().flat_map(|manifold| &manifold.points);
            points.any(|point| point.dist <= PREDICTION)
        };
        let numbers = |pair: &ContactPair| {
            let (a, b) = (self.number(pair.collider1), self.number(pair.collider2));
            (a.min(b), a.max(b))
        };
        let pairs = self.narrow_phase.contact_pairs().filter(near);
        let mut pairs: Vec<_> = pairs.map(numbers).collect();
        pairs.sort_unstable();
        pairs
    }

    fn number(&self, handle: ColliderHandle) -> usize {
        usize::try_from(self.colliders[handle].user_data).expect("it was a number")
    }
}

/// The objects of a scene, and where they go next.
pub struct Rapier {
    colliders: Colliders,
    moved: Vec<(usize, Pose)>,
}

impl Rapier {
    /// A world with the objects of a scene as they are at step 0.
    pub fn new(scene: &Scene<DIM>) -> Self {
        let mut colliders = Colliders::new();
        for (n, object) in scene.objects.iter().enumerate() {
            colliders.add(builder(&object.shape).position(pose(&scene.placement(n, 0))));
        }
        Self { colliders, moved: Vec::new() }
    }
}

impl Contender<DIM> for Rapier {
    fn prepare(&mut self, moved: &[(usize, Placement<DIM>)]) {
        self.moved.clear();
        self.moved.extend(moved.iter().map(|(n, placement)| (*n, pose(placement))));
    }

    fn step(&mut self) {
        for (n, pose) in &self.moved {
            self.colliders.get_mut(*n).set_position(*pose);
        }
        self.colliders.step();
    }

    fn read(&self) -> Reading {
        self.colliders.read()
    }

    fn touching(&self) -> Vec<(usize, usize)> {
        self.colliders.touching()
    }
}
