//! Random operations with marks, rewinds, forks and copies: the world must end up like a new world
//! on which the same operations are performed from the start.

use std::collections::VecDeque;
use std::hash::{Hash, Hasher};

use impinge::broad_phase::DBVTBroadPhase;
use impinge::narrow_phase::{CollisionObjectHandle, DefaultNarrowPhase};
use impinge::query::Ray;
use impinge::shape::{Compound, ShapeHandle};
use impinge::world::{CollisionObject, CollisionWorld, QueryFilter, WorldError, WorldMark};
use impinge_reference::random::Random;

use super::draw::{self, Grid};
use crate::support::samples::samples;
use crate::support::scene_stage::{Digest, digest_state};
use crate::support::world_stage::vector;

/// Number of objects from which on operations add none.
const MOST: usize = 40;
/// Number of marks that the world keeps.
const MARKS: usize = 5;

/// The numbers of the filters that may be registered; the name of a filter is its number as text.
pub(super) const FILTERS: [usize; 2] = [3, 5];

pub(super) type World<N, const D: usize> = CollisionWorld<N, D, u64>;

/// Returns a new world that keeps [`MARKS`] marks. If `seed` is even, the world reuses the contacts
/// of pairs that hardly move.
pub(super) fn new_world<N: Grid<D>, const D: usize>(seed: u64) -> World<N, D> {
    let mut world = World::new(N::lit(0.125));
    if seed.is_multiple_of(2) {
        world.set_narrow_phase(Box::new(DefaultNarrowPhase::new().reusing(N::lit(0.02))));
        world.update();
    }
    world.keep_marks(MARKS);
    world
}

pub(super) fn position<N: Grid<D>, const D: usize>(random: &mut Random) -> N::Isometry {
    let at = std::array::from_fn(|_| random.range(-3.0, 3.0));
    N::posed(at, random).0
}

/// Returns a convex shape, or a compound of one or two convex shapes.
fn shape<N: Grid<D>, const D: usize>(random: &mut Random) -> ShapeHandle<N, D> {
    if random.chance(0.8) {
        return draw::shape::<N, D>(random).0;
    }
    let mut child = |x: f64| {
        let mut at = [0.0; D];
        at[0] = x;
        (N::posed(at, random).0, draw::shape::<N, D>(random).0)
    };
    let mut children = vec![child(-0.75), child(0.75)];
    children.retain(|(_, shape)| {
        shape.local_aabb().maxs()[0].is_finite_number()
            && shape.local_aabb().mins()[0].is_finite_number()
    });
    if children.is_empty() {
        return draw::shape::<N, D>(random).0;
    }
    ShapeHandle::new(Compound::new(children))
}

/// Performs the operation that `seed` determines; equal worlds stay equal. Validates the world
/// after an update.
fn operate<N: Grid<D>, const D: usize>(world: &mut World<N, D>, seed: u64) {
    if is_updated_by(world, seed) {
        world.validate().expect("the parts of the world agree");
    }
}

/// Performs the operation that `seed` determines; returns whether it is an update.
pub(super) fn is_updated_by<N: Grid<D>, const D: usize>(
    world: &mut World<N, D>,
    seed: u64,
) -> bool {
    let random = &mut Random::new(seed);
    let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
    let kind = random.below(100);
    if handles.len() < 4 || (kind < 12 && handles.len() < MOST) {
        let (groups, _) = draw::groups(random);
        let (query_type, _) = draw::query_type(random);
        world.add(position::<N, D>(random), shape(random), groups, query_type, random.bits());
        return false;
    }
    let handle = *random.pick(&handles);
    let number = *random.pick(&FILTERS);
    match kind {
        0..14 => world.remove(&[handle]),
        14..40 => world.set_position(handle, position::<N, D>(random)),
        40..44 => world.set_shape(handle, shape(random)),
        44..47 => world.set_collision_groups(handle, draw::groups(random).0),
        47..51 => world.set_query_type(handle, draw::query_type::<N>(random).0),
        51..53 => world.set_fixed(handle, random.chance(0.5)),
        53..55 => world.set_skin(handle, N::lit(*random.pick(&[0.0, 0.125, 0.25]))),
        55..57 => {
            let (now, then) = (position::<N, D>(random), position::<N, D>(random));
            world.set_position_with_prediction(handle, now, then);
        }
        57..59 => *world.collision_object_mut(handle).expect("alive").data_mut() = random.bits(),
        59..61 => N::register(world, &number.to_string(), number),
        61..63 => world.unregister_broad_phase_pair_filter(&number.to_string()),
        63 => world.refilter_pairs_of(handle),
        64 => world.keep_events(),
        65..72 => {
            world.update_pair(handle, *random.pick(&handles));
        }
        72 => drop(world.take_removed(handle)),
        _ => {
            world.update();
            return true;
        }
    }
    false
}

/// Returns the digest of everything that a world reports, in order.
pub(super) fn digest<N: Grid<D>, const D: usize>(world: &World<N, D>) -> u64 {
    let mut digest = Digest::new();
    for object in world.collision_objects() {
        let handle = object.handle();
        (handle, object.data(), object.proxy_handle(), object.is_fixed()).hash(&mut digest);
        digest.write(format!("{:?}", (object.position(), object.query_type())).as_bytes());
        digest.write(format!("{:?}", world.predicted_position(handle)).as_bytes());
        digest.write(format!("{:?}", world.skin(handle)).as_bytes());
        let partners = world.pairs_with(handle).map(CollisionObject::handle);
        partners.for_each(|partner| partner.hash(&mut digest));
    }
    digest_state(world, &mut digest);
    for (object1, object2, view) in world.contact_views() {
        (object1.handle(), object2.handle(), view.len()).hash(&mut digest);
    }
    world.contact_pairs().for_each(|(a, b, _)| (a.handle(), b.handle()).hash(&mut digest));
    world.vacant_indices().for_each(|index| index.hash(&mut digest));
    let named = world.contact_events().iter().map(|event| event.handles().0);
    named.for_each(|handle| world.removed_object(handle).map(|o| *o.data()).hash(&mut digest));
    let ray = Ray::new(vector([-4.0; D]).into(), vector([1.0; D]));
    let hit = world.first_ray_hit(&ray, N::lit(20.0), true, &QueryFilter::new());
    hit.map(|(object, hit)| (object.handle(), hit.toi.bits())).hash(&mut digest);
    digest.write(format!("{world:?}").as_bytes());
    digest.finish()
}

/// A world, the seeds of its operations from the start, and its digest after each.
struct Timeline<N: Grid<D>, const D: usize> {
    seed: u64,
    world: World<N, D>,
    told: Vec<u64>,
    digests: Vec<u64>,
    /// Marks with the number of operations before each.
    marks: VecDeque<(WorldMark, usize)>,
}

impl<N: Grid<D>, const D: usize> Timeline<N, D> {
    fn new(seed: u64) -> Self {
        let (told, digests, marks) = (Vec::new(), Vec::new(), VecDeque::new());
        Self { seed, world: new_world(seed), told, digests, marks }
    }

    fn tell(&mut self, seed: u64) {
        operate(&mut self.world, seed);
        self.told.push(seed);
        self.digests.push(digest(&self.world));
    }

    fn mark(&mut self) {
        self.marks.push_back((self.world.mark(), self.told.len()));
        if self.marks.len() > MARKS {
            let (gone, _) = self.marks.pop_front().expect("more than one");
            assert_eq!(self.world.try_rewind(gone), Err(WorldError::MarkGone(gone)), "dropped");
        }
    }

    /// Rewinds to a mark, and sometimes performs the same operations again.
    fn rewind(&mut self, random: &mut Random) {
        if self.marks.is_empty() {
            return;
        }
        let place = random.below(self.marks.len());
        let (mark, length) = self.marks[place];
        self.world.rewind(mark);
        if let Some(&before) = length.checked_sub(1).and_then(|last| self.digests.get(last)) {
            assert_eq!(digest(&self.world), before, "as it was {length} operations from the start");
        }
        for (later, _) in self.marks.drain(place + 1..) {
            assert_eq!(self.world.try_rewind(later), Err(WorldError::MarkGone(later)), "later");
        }
        let undone = self.told.split_off(length);
        let digests = self.digests.split_off(length);
        if random.chance(0.6) {
            undone.iter().for_each(|&seed| self.tell(seed));
            assert_eq!(self.digests[length..], digests, "the same bits");
        }
    }

    /// Performs the same operations on the world and on a clone, compares their digests, and
    /// sometimes continues with the clone.
    fn fork(&mut self, random: &mut Random) {
        let mut clone = self.world.clone();
        if random.chance(0.5) {
            clone = new_world(self.seed + 1);
            (0..random.below(30)).for_each(|_| operate(&mut clone, random.bits()));
            clone.clone_from(&self.world);
        }
        if let Some(&(mark, _)) = self.marks.front() {
            assert_eq!(clone.try_rewind(mark), Err(WorldError::MarkGone(mark)), "of the original");
        }
        for seed in (0..random.below(8)).map(|_| random.bits()).collect::<Vec<_>>() {
            self.tell(seed);
            operate(&mut clone, seed);
            assert_eq!(Some(&digest(&clone)), self.digests.last(), "both come to the same");
        }
        if random.chance(0.5) {
            operate(&mut self.world, random.bits());
            self.world = clone;
            self.world.keep_marks(MARKS);
            self.marks.clear();
        }
    }

    fn exchange_phases(&mut self) {
        self.world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::lit(0.125))));
        self.world.update();
        self.world.validate().expect("the parts of the world agree");
        for (mark, _) in self.marks.drain(..) {
            assert_eq!(self.world.try_rewind(mark), Err(WorldError::MarkGone(mark)), "ended");
        }
    }

    /// Asserts that a new world has the same digest after each of the operations.
    fn check(&self) {
        let mut world = new_world::<N, D>(self.seed);
        for (place, (&seed, &expected)) in self.told.iter().zip(&self.digests).enumerate() {
            operate(&mut world, seed);
            assert_eq!(digest(&world), expected, "after operation {place} of {}", self.told.len());
        }
    }
}

fn run<N: Grid<D>, const D: usize>(seed: u64) {
    let random = &mut Random::new(seed);
    let mut timeline = Timeline::<N, D>::new(seed);
    let (mut returns, mut forks, mut most) = (0, 0, 0);
    for _ in 0..samples(1200) {
        match random.below(100) {
            0..8 => timeline.mark(),
            8..11 => {
                timeline.rewind(random);
                returns += 1;
            }
            11 => {
                timeline.fork(random);
                forks += 1;
            }
            _ => timeline.tell(random.bits()),
        }
        most = most.max(timeline.world.contact_manifolds().count());
    }
    timeline.check();
    timeline.exchange_phases();
    assert!(returns > 20 && forks > 4 && most > 20, "{returns} {forks} {most}");
}

#[test]
fn worlds_that_go_back_and_fork_in_plane() {
    run::<f32, 2>(1);
    run::<f64, 2>(2);
}

#[test]
fn worlds_that_go_back_and_fork_in_space() {
    run::<f32, 3>(4);
    run::<f64, 3>(3);
}

/// Asserts that a handle from before a clone refers to the object in both worlds, and that removing
/// the object from one world leaves it in the other.
#[test]
fn handles_of_two_branches() {
    let mut world = new_world::<f32, 2>(1);
    (0..30).for_each(|seed| operate(&mut world, seed));
    let clone = world.clone();
    let all = |world: &World<f32, 2>| -> Vec<CollisionObjectHandle> {
        world.collision_objects().map(CollisionObject::handle).collect()
    };
    assert_eq!(all(&world), all(&clone));
    world.remove(&all(&clone)[..1]);
    assert!(clone.contains(all(&clone)[0]) && !world.contains(all(&clone)[0]));
}
