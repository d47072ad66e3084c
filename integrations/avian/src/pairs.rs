//! What is kept of pairs with a composite between two steps.

use core::fmt;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use bevy_ecs::prelude::{Entity, Resource};
use impinge::narrow_phase::{IdAllocator, PairManifoldGenerator};

use crate::scaling::Dimension;

/// Locks beside each other: threads that work on different pairs seldom wait for one another.
const SHARDS: usize = 256;
/// Pairs that may be kept for nothing before ended ones are looked for.
const SPARE: usize = 64;

/// The two entities of a pair, in the order of Avian's graph of contacts.
type Key = (Entity, Entity);
type Shard<const D: usize> = BTreeMap<Key, Box<PairState<D>>>;

/// What is known of the pairs in which a mesh, a line, a height field or a compound meets something: a resource that the
/// plugin adds, unless there is one.
///
/// By it contact points keep their names while they move over the parts, and contacts are kept while neither collider
/// moves much beside the other. Two convex shapes are asked anew in each step. An app that goes back in time, for
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
    /// Of the pair alone: names need to differ within a pair.
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

/// A thread that panicked left a map that is whole.
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

    /// No pair yet. Contacts are kept, and only their depths measured anew, while no point of the smaller collider has moved
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

    /// Calls `update` with what is kept of a pair.
    pub(crate) fn with<R>(&self, key: Key, update: impl FnOnce(&mut PairState<D>) -> R) -> R {
        let begin = || Box::new(PairState::new(self.tolerance));
        update(locked(&self.shards[shard_of(key)]).entry(key).or_insert_with(begin))
    }

    /// Forgets the pairs that do not live, if they are many among `count` that do.
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
