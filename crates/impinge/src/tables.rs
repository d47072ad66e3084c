//! The entry points that are compiled here rather than in the caller.
//!
//! Generic code is compiled where it is first used with concrete types. These `static`s use the hot
//! entry points with all four combinations of scalar and dimension, so that they are compiled in
//! this crate, at this crate's optimisation level; callers reach them by function pointer. This
//! module is the one place that floors below may see of floors above.

use core::fmt::Debug;

use crate::broad_phase::PairFinder;
use crate::math::Real;

/// The step of a broad phase: what is pending, the filter, and what hears of changes.
pub(crate) type FindPairs<N, const D: usize> =
    fn(&mut PairFinder<N, D>, &mut dyn FnMut(u32, u32) -> bool, &mut dyn FnMut(u32, u32, bool));

/// Function pointers to the entry points for one scalar and dimension.
#[derive(Debug)]
pub struct Tables<N: Real, const D: usize> {
    /// `PairFinder::update`.
    pub(crate) find_pairs: FindPairs<N, D>,
}

/// A scalar whose tables are compiled in this crate. Sealed by being unnameable outside.
pub trait Compiled: Sized {
    /// The tables of the plane.
    fn plane() -> &'static Tables<Self, 2>
    where
        Self: Real;
    /// The tables of space.
    fn space() -> &'static Tables<Self, 3>
    where
        Self: Real;
}

static PLANE_F32: Tables<f32, 2> = Tables { find_pairs: PairFinder::<f32, 2>::update };
static SPACE_F32: Tables<f32, 3> = Tables { find_pairs: PairFinder::<f32, 3>::update };
#[cfg(feature = "f64")]
static PLANE_F64: Tables<f64, 2> = Tables { find_pairs: PairFinder::<f64, 2>::update };
#[cfg(feature = "f64")]
static SPACE_F64: Tables<f64, 3> = Tables { find_pairs: PairFinder::<f64, 3>::update };

impl Compiled for f32 {
    fn plane() -> &'static Tables<Self, 2> {
        &PLANE_F32
    }

    fn space() -> &'static Tables<Self, 3> {
        &SPACE_F32
    }
}

#[cfg(feature = "f64")]
impl Compiled for f64 {
    fn plane() -> &'static Tables<Self, 2> {
        &PLANE_F64
    }

    fn space() -> &'static Tables<Self, 3> {
        &SPACE_F64
    }
}
