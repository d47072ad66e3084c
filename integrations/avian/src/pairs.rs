//! The state of pairs with a composite, kept between two steps.

use core::fmt;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use bevy_ecs::prelude::{Entity, Resource};
use impinge::narrow_phase::{IdAllocator, PairManifoldGenerator};

use crate::scaling::Dimension;

/// The number of locks. Pairs are distributed over them, so threads seldom wait for each other.
const SHARDS: usize = 256;
/// The number of ended pairs that may remain before a sweep, in addition to the number of living
/// pairs.
const SPARE: usize = 64;

/// The two entities of a pair, in the order of Avian's contact graph.
type Key = (Entity, Entity);
type Shard<const D: usize> = BTreeMap<Key, Box<PairState<D>>>;

/// A resource with the contacts of each pair that contains a mesh, a polyline, a height field or a
/// compound. The plugin inserts it, unless the app already has one.
///
/// Contact points keep their ids while they move over the parts. Contacts are reused until a
/// collider has moved, relative to the other, by more than the tolerance of contact reuse. Pairs of
/// convex shapes are recomputed in each step and have no state. An app with rollback stores a clone
/// of this resource together with Avian's `ContactGraph`, or [clears](Self::clear) it. After
/// clearing, points get new ids, and the solver starts those contacts from zero impulses.
#[derive(Resource)]
pub struct PairContacts<const D: usize>
where
    f32: Dimension<D>,
{
    shards: Box<[Mutex<Shard<D>>]>,
    tolerance: f32,
}

/// The contacts of one pair.
#[derive(Clone)]
pub(crate) struct PairState<const D: usize>
where
    f32: Dimension<D>,
{
    pub(crate) generator: PairManifoldGenerator<f32, D>,
    /// Allocates contact ids, which must be unique only within the pair.
    pub(crate) ids: IdAllocator,
}

impl<const D: usize> PairState<D>
where
    f32: Dimension<D>,
{
    pub(crate) fn new(tolerance: f32) -> Self {
        let generator = PairManifoldGenerator::default();
        let reuses = tolerance > 0.0;
        let generator = if reuses { generator.reusing(tolerance) } else { generator };
        Self { generator, ids: IdAllocator::new() }
    }
}

/// Returns the shard of a pair, by Fibonacci hashing of both entities (Knuth, volume 3, section
/// 6.4): entities are small numbers.
fn shard_of((one, other): Key) -> usize {
    let mixed =
        (one.to_bits().rotate_left(26) ^ other.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (mixed >> 40) as usize % SHARDS
}

/// Locks a shard, also after a panic of another thread: a panic leaves the map valid.
fn locked<T>(shard: &Mutex<T>) -> MutexGuard<'_, T> {
    shard.lock().unwrap_or_else(PoisonError::into_inner)
}

fn shards<const D: usize>(shard: impl Fn(usize) -> Shard<D>) -> Box<[Mutex<Shard<D>>]>
where
    f32: Dimension<D>,
{
    (0..SHARDS).map(|index| Mutex::new(shard(index))).collect()
}

impl<const D: usize> PairContacts<D>
where
    f32: Dimension<D>,
{
    /// The default tolerance: a tenth of Avian's default `contact_tolerance`, in Avian's unit of
    /// length.
    pub const TOLERANCE: f32 = 5e-4;

    /// Creates the resource without pairs. Contacts are reused, with new depths, while no point of
    /// the smaller collider has moved farther than `tolerance` relative to the other. With a
    /// tolerance that is zero, negative, infinite or NaN, contacts are recomputed in each step.
    #[must_use]
    pub fn reusing(tolerance: f32) -> Self {
        let tolerance = if tolerance.is_finite() { tolerance.max(0.0) } else { 0.0 };
        Self { shards: shards(|_| Shard::default()), tolerance }
    }

    /// Returns the number of stored pairs, including those that ended recently.
    #[must_use]
    pub fn len(&self) -> usize {
        self.shards.iter().map(|shard| locked(shard).len()).sum()
    }

    /// Whether no pair is stored.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Removes the state of all pairs.
    pub fn clear(&mut self) {
        self.shards = shards(|_| Shard::default());
    }

    /// Calls `update` with the state of the pair `key`, which is created if it does not exist.
    /// Holds the lock of the pair's shard during the call.
    pub(crate) fn with<R>(&self, key: Key, update: impl FnOnce(&mut PairState<D>) -> R) -> R {
        let begin = || Box::new(PairState::new(self.tolerance));
        update(locked(&self.shards[shard_of(key)]).entry(key).or_insert_with(begin))
    }

    /// Removes the pairs for which `lives` returns `false`, but only if more than `2 * count +
    /// SPARE` are stored; `count` is the number of living pairs.
    pub(crate) fn sweep(&mut self, count: usize, mut lives: impl FnMut(Key) -> bool) {
        if self.len() <= 2 * count + SPARE {
            return;
        }
        for shard in &mut self.shards {
            shard.get_mut().unwrap_or_else(PoisonError::into_inner).retain(|&key, _| lives(key));
        }
    }
}

impl<const D: usize> Default for PairContacts<D>
where
    f32: Dimension<D>,
{
    fn default() -> Self {
        Self::reusing(Self::TOLERANCE)
    }
}

impl<const D: usize> Clone for PairContacts<D>
where
    f32: Dimension<D>,
{
    fn clone(&self) -> Self {
        let shards = shards(|index| locked(&self.shards[index]).clone());
        Self { shards, tolerance: self.tolerance }
    }
}

impl<const D: usize> fmt::Debug for PairContacts<D>
where
    f32: Dimension<D>,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PairContacts").field("len", &self.len()).finish_non_exhaustive()
    }
}
