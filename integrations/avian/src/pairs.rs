//! The state of pairs with a composite, kept between two steps.

use core::fmt;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use bevy_ecs::prelude::{Entity, Resource};
use impinge::narrow_phase::{IdAllocator, PairManifoldGenerator};

use crate::scaling::Dimension;

/// Number of locks. Pairs are spread over them, so that threads seldom wait for one another.
const SHARDS: usize = 256;
/// Number of ended pairs that may be kept before a sweep.
const SPARE: usize = 64;

/// The two entities of a pair, in the order of Avian's graph of contacts.
type Key = (Entity, Entity);
type Shard<const D: usize> = BTreeMap<Key, Box<PairState<D>>>;

/// A resource with the contacts of each pair that contains a mesh, a polyline, a height field or a compound. The plugin
/// adds it, unless the app has one.
///
/// Contact points keep their ids while they move over the parts, and contacts are reused while the colliders hardly move
/// relative to each other. Pairs of convex shapes are computed anew in each step and have no state. An app that goes back in time, for
/// rollback, keeps a clone of it beside Avian's `ContactGraph`, or [clears](Self::clear) it: then points get new names, and the
/// solver starts those contacts from zero.
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
    /// Allocates ids for this pair alone: they must differ within a pair only.
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

/// Entities are small numbers: Fibonacci hashing of both (Knuth, volume 3, section 6.4).
fn shard_of((one, other): Key) -> usize {
    let mixed =
        (one.to_bits().rotate_left(26) ^ other.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (mixed >> 40) as usize % SHARDS
}

/// Locks a shard; a thread that panicked left its map intact.
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
    /// The tolerance of `default()`: a tenth of Avian's own for contacts, in Avian's unit of length.
    pub const TOLERANCE: f32 = 5e-4;

    /// Holds no pair. Contacts are reused, with new depths, while no point of the smaller collider has moved
    /// farther than the tolerance beside the other. Zero, and what is negative or no number, computes them each time.
    #[must_use]
    pub fn reusing(tolerance: f32) -> Self {
        let tolerance = if tolerance.is_finite() { tolerance.max(0.0) } else { 0.0 };
        Self { shards: shards(|_| Shard::default()), tolerance }
    }

    /// How many pairs are kept, those that ended lately included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.shards.iter().map(|shard| locked(shard).len()).sum()
    }

    /// No pair is kept.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Forgets all pairs.
    pub fn clear(&mut self) {
        self.shards = shards(|_| Shard::default());
    }

    /// Calls `update` with the state of the pair `key`; holds a lock meanwhile.
    pub(crate) fn with<R>(&self, key: Key, update: impl FnOnce(&mut PairState<D>) -> R) -> R {
        let begin = || Box::new(PairState::new(self.tolerance));
        update(locked(&self.shards[shard_of(key)]).entry(key).or_insert_with(begin))
    }

    /// Removes the pairs that are not alive, if more than twice `count`, the number of living pairs, are kept.
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
