//! The trait [`BroadPhasePairFilter`] for 3D.

use super::world::CollisionObject;
use crate::math::Real;

/// A filter that decides which pairs of objects may interact; see
/// [`crate::world::BroadPhasePairFilter`].
///
/// Closures that take two references to objects and return a `bool` implement this trait.
///
/// ```
/// use impinge::dim3::world::{BroadPhasePairFilter, CollisionObject, CollisionWorld};
///
/// struct SameParity;
///
/// impl<T> BroadPhasePairFilter<f32, T> for SameParity {
///     fn is_pair_valid(&self, a: &CollisionObject<f32, T>, b: &CollisionObject<f32, T>) -> bool {
///         a.handle().uid() % 2 == b.handle().uid() % 2
///     }
/// }
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// world.register_broad_phase_pair_filter("parity", SameParity);
/// ```
pub trait BroadPhasePairFilter<N: Real, T>: Send + Sync {
    /// Returns `true` if the two objects may interact. The handle of `co1` is smaller than the
    /// handle of `co2`.
    fn is_pair_valid(&self, co1: &CollisionObject<N, T>, co2: &CollisionObject<N, T>) -> bool;
}

impl<N: Real, T, F> crate::world::BroadPhasePairFilter<N, 3, T> for F
where
    F: BroadPhasePairFilter<N, T>,
{
    fn is_pair_valid(&self, co1: &CollisionObject<N, T>, co2: &CollisionObject<N, T>) -> bool {
        BroadPhasePairFilter::is_pair_valid(self, co1, co2)
    }
}

impl<N: Real, T, F> BroadPhasePairFilter<N, T> for F
where
    F: Fn(&CollisionObject<N, T>, &CollisionObject<N, T>) -> bool + Send + Sync,
{
    fn is_pair_valid(&self, co1: &CollisionObject<N, T>, co2: &CollisionObject<N, T>) -> bool {
        self(co1, co2)
    }
}
