//! The entry points that are compiled here rather than in the caller.
//!
//! Generic code is compiled where it is first used with concrete types. These `static`s use the hot
//! entry points with all four combinations of scalar and dimension, so that they are compiled in
//! this crate, at this crate's optimisation level; callers reach them by function pointer. This
//! module is the one place that floors below may see of floors above.

use core::fmt;

use crate::convex::Separation;
use crate::math::Real;
use crate::query::separation::{Algorithm, in_world, separation_in_plane, separation_in_space};
use crate::query::{Moving, Placed, advance};

/// The separation of two solids in the world, within a limit.
type InWorld<N, const D: usize> =
    fn(&Placed<'_, N, D>, &Placed<'_, N, D>, N) -> Option<Separation<N, D>>;
/// The time at which two moving solids touch.
type Advance<N, const D: usize> = fn(&Moving<'_, N, D>, &Moving<'_, N, D>) -> Option<N>;

/// Function pointers to the entry points for one scalar and dimension.
pub struct Tables<N: Real, const D: usize> {
    /// The separation of any pair.
    pub(crate) separation: Algorithm<N, D>,
    pub(crate) separation_in_world: InWorld<N, D>,
    pub(crate) time_of_impact: Advance<N, D>,
}

impl<N: Real, const D: usize> fmt::Debug for Tables<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tables").finish_non_exhaustive()
    }
}

impl<N: Real> Tables<N, 2> {
    const fn in_plane() -> Self {
        Self {
            separation: separation_in_plane,
            separation_in_world: in_world,
            time_of_impact: advance,
        }
    }
}

impl<N: Real> Tables<N, 3> {
    const fn in_space() -> Self {
        Self {
            separation: separation_in_space,
            separation_in_world: in_world,
            time_of_impact: advance,
        }
    }
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

static PLANE_F32: Tables<f32, 2> = Tables::in_plane();
static SPACE_F32: Tables<f32, 3> = Tables::in_space();
#[cfg(feature = "f64")]
static PLANE_F64: Tables<f64, 2> = Tables::in_plane();
#[cfg(feature = "f64")]
static SPACE_F64: Tables<f64, 3> = Tables::in_space();

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
