// Source shared by the modules for both crates of rapier; included by `rapier.rs`.

/// Colliders without bodies and their pipeline. The index of a collider is its position in the
/// order of addition.
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
    /// Creates an empty set.
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

    /// Adds a collider that may touch every other collider.
    pub fn add(&mut self, collider: ColliderBuilder) {
        let number = self.handles.len();
        self.handles.push(ColliderHandle::invalid());
        self.put(number, numbered(collider, number));
    }

    /// Reserves the next index for a collider that is not alive yet.
    pub fn skip(&mut self) {
        self.handles.push(ColliderHandle::invalid());
    }

    /// Inserts a collider made by [`numbered`] at its index.
    pub fn put(&mut self, number: usize, collider: Collider) {
        self.handles[number] = self.colliders.insert(collider);
    }

    /// Removes a collider.
    pub fn remove(&mut self, number: usize) {
        let handle = std::mem::replace(&mut self.handles[number], ColliderHandle::invalid());
        let Self { islands, bodies, colliders, .. } = self;
        colliders.remove(handle, islands, bodies, &mut SoftBodySet::new(), false);
    }

    /// Returns a collider, so that its position can be changed.
    pub fn get_mut(&mut self, number: usize) -> &mut Collider {
        &mut self.colliders[self.handles[number]]
    }

    /// Updates the broad phase and computes all contacts.
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

    /// Returns the pairs of indices of touching colliders, sorted, the smaller index first. Sensors
    /// touch if they intersect.
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
        for (collider1, collider2, _) in self.narrow_phase.intersection_pairs().filter(|met| met.2)
        {
            let (a, b) = (self.number(collider1), self.number(collider2));
            pairs.push((a.min(b), a.max(b)));
        }
        pairs.sort_unstable();
        pairs
    }

    fn number(&self, handle: ColliderHandle) -> usize {
        usize::try_from(self.colliders[handle].user_data).expect("it was a number")
    }
}

/// Builds a collider that may touch every other one, with its index as user data.
fn numbered(collider: ColliderBuilder, number: usize) -> Collider {
    collider.active_collision_types(ActiveCollisionTypes::all()).user_data(number as u128).build()
}

/// The contender: the colliders of a scene, and their pending changes.
pub struct Rapier {
    colliders: Colliders,
    builders: Vec<ColliderBuilder>,
    gone: Vec<usize>,
    born: Vec<(usize, Collider)>,
    moved: Vec<(usize, Pose)>,
}

impl Rapier {
    /// Creates a world with the objects of a scene at step 0. Objects with proximity queries are
    /// sensors; their margins are not supported.
    pub fn new(scene: &Scene<DIM>) -> Self {
        let (mut colliders, mut builders) = (Colliders::new(), Vec::new());
        for (n, object) in scene.objects.iter().enumerate() {
            let is_sensor = matches!(object.query, SceneQuery::Proximity { .. });
            let builder = builder(&object.shape).sensor(is_sensor);
            if scene.is_alive(n, 0) {
                colliders.add(builder.clone().position(pose(&scene.placement(n, 0))));
            } else {
                colliders.skip();
            }
            builders.push(builder);
        }
        Self { colliders, builders, gone: Vec::new(), born: Vec::new(), moved: Vec::new() }
    }
}

impl Contender<DIM> for Rapier {
    fn prepare(&mut self, change: &Change<DIM>) {
        self.gone.clone_from(&change.gone);
        let born = change
            .born
            .iter()
            .map(|(n, at)| (*n, numbered(self.builders[*n].clone().position(pose(at)), *n)));
        self.born = born.collect();
        self.moved.clear();
        self.moved.extend(change.moved.iter().map(|(n, placement)| (*n, pose(placement))));
    }

    fn step(&mut self) {
        self.gone.iter().for_each(|n| self.colliders.remove(*n));
        for (n, collider) in self.born.drain(..) {
            self.colliders.put(n, collider);
        }
        for (n, pose) in &self.moved {
            self.colliders.get_mut(*n).set_position(*pose);
        }
        self.colliders.step();
    }

    fn read(&mut self) -> Reading {
        self.colliders.read()
    }

    fn touching(&self) -> Vec<(usize, usize)> {
        self.colliders.touching()
    }
}
