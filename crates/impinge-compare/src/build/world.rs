//! Worlds of axis-aligned boxes in impinge, rapier and ncollide: they are built, moved and read.

use impinge::math::Isometry3;
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::shape::{Cuboid, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld};
use ncollide3d::pipeline as ncollide;

use crate::broad::swarm::{Cell, is_borderline};
use crate::broad::{MARGIN, key};
use crate::world::PREDICTION;
use crate::world::ours::read;
pub use crate::world::rapier::space::Colliders as Rapier;

/// A world of boxes.
pub trait World: Send {
    /// Adds a box. Its index is the number of boxes added before.
    fn add(&mut self, cell: &Cell<3>);

    /// Moves some boxes and updates.
    fn step(&mut self, moved: &[(u32, Cell<3>)]);

    /// Reads every contact point. Returns the number of points and the sum of their depths.
    fn read(&self) -> (usize, f32);

    /// Returns the pairs with contact points, as [`key`]s.
    fn touching(&self) -> Vec<u64>;
}

/// Returns the touching pairs of a world, sorted and without duplicates. Pairs for which rounding
/// decides whether they touch are omitted.
pub fn certainly_touching(world: &dyn World, cells: &[Cell<3>]) -> Vec<u64> {
    let mut pairs = world.touching();
    let ends = |key: &u64| [key >> 32, key & 0xffff_ffff].map(|n| &cells[n as usize]);
    pairs.retain(|key| {
        let [a, b] = ends(key);
        !is_borderline(a, b, f64::from(PREDICTION))
    });
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// A world of impinge.
pub struct Ours {
    world: CollisionWorld<f32, 3, u32>,
    handles: Vec<CollisionObjectHandle>,
}

impl Ours {
    /// Creates an empty world.
    pub fn new() -> Self {
        Self { world: CollisionWorld::new(MARGIN), handles: Vec::new() }
    }
}

impl World for Ours {
    fn add(&mut self, cell: &Cell<3>) {
        let number = u32::try_from(self.handles.len()).expect("there are fewer boxes");
        let [x, y, z] = cell.center;
        let shape = ShapeHandle::new(Cuboid::new(cell.half.into()));
        let query = GeometricQueryType::Contacts(PREDICTION / 2.0, 0.0);
        let place = Isometry3::translation(x, y, z);
        self.handles.push(self.world.add(place, shape, CollisionGroups::new(), query, number));
    }

    fn step(&mut self, moved: &[(u32, Cell<3>)]) {
        for (n, cell) in moved {
            let [x, y, z] = cell.center;
            let place = Isometry3::translation(x, y, z);
            self.world.set_position(self.handles[*n as usize], place);
        }
        self.world.update();
    }

    fn read(&self) -> (usize, f32) {
        let reading = read(&self.world);
        (reading.points, reading.depth as f32)
    }

    fn touching(&self) -> Vec<u64> {
        let manifolds = self.world.contact_views();
        let touching = manifolds.filter(|(_, _, manifold)| manifold.len() > 0);
        touching.map(|(a, b, _)| key(*a.data(), *b.data())).collect()
    }
}

/// The colliders have no bodies, the cheapest setup of rapier.
impl World for Rapier {
    fn add(&mut self, cell: &Cell<3>) {
        let [x, y, z] = cell.half;
        let collider = rapier3d::prelude::ColliderBuilder::cuboid(x, y, z);
        self.add(collider.translation(cell.center.into()));
    }

    fn step(&mut self, moved: &[(u32, Cell<3>)]) {
        for (n, cell) in moved {
            self.get_mut(*n as usize).set_translation(cell.center.into());
        }
        self.step();
    }

    fn read(&self) -> (usize, f32) {
        let reading = self.read();
        (reading.points, reading.depth as f32)
    }

    fn touching(&self) -> Vec<u64> {
        let numbers = self.touching().into_iter();
        numbers.map(|(a, b)| key(a as u32, b as u32)).collect()
    }
}

/// A world of ncollide.
pub struct Ncollide {
    world: ncollide::CollisionWorld<f32, u32>,
    handles: Vec<ncollide::CollisionObjectSlabHandle>,
}

impl Ncollide {
    /// Creates an empty world.
    pub fn new() -> Self {
        Self { world: ncollide::CollisionWorld::new(MARGIN), handles: Vec::new() }
    }
}

fn ncollide_place(cell: &Cell<3>) -> ncollide3d::math::Isometry<f32> {
    let [x, y, z] = cell.center;
    ncollide3d::math::Isometry::translation(x, y, z)
}

impl World for Ncollide {
    fn add(&mut self, cell: &Cell<3>) {
        use ncollide3d::shape::{Cuboid, ShapeHandle};
        let number = u32::try_from(self.handles.len()).expect("there are fewer boxes");
        let shape = ShapeHandle::new(Cuboid::new(cell.half.into()));
        let query = ncollide::GeometricQueryType::Contacts(PREDICTION / 2.0, 0.0);
        let (place, groups) = (ncollide_place(cell), ncollide::CollisionGroups::new());
        self.handles.push(self.world.add(place, shape, groups, query, number).0);
    }

    fn step(&mut self, moved: &[(u32, Cell<3>)]) {
        for (n, cell) in moved {
            let object = self.world.objects.get_mut(self.handles[*n as usize]);
            object.expect("nothing was removed").set_position(ncollide_place(cell));
        }
        self.world.update();
    }

    fn read(&self) -> (usize, f32) {
        let pairs = self.world.contact_pairs(false);
        let contacts = pairs.flat_map(|(_, _, _, manifold)| manifold.contacts());
        contacts.fold((0, 0.0), |(count, sum), tracked| (count + 1, sum + tracked.contact.depth))
    }

    fn touching(&self) -> Vec<u64> {
        let number =
            |handle| *self.world.collision_object(handle).expect("nothing was removed").data();
        let pairs = self.world.contact_pairs(false);
        let touching = pairs.filter(|(_, _, _, manifold)| manifold.len() > 0);
        touching.map(|(a, b, _, _)| key(number(a), number(b))).collect()
    }
}
