//! The entry points that are compiled here rather than in the caller.
//!
//! Generic code is compiled where it is first used with concrete types. These `static`s use the hot
//! entry points with all four combinations of scalar and dimension, so that they are compiled in
//! this crate, at this crate's optimisation level; callers reach them by function pointer. This
//! module is the one place that floors below may see of floors above.

use core::fmt::Debug;
use core::marker::PhantomData;

use crate::bounding_volume::Ray;
use crate::math::{Point, Real};
use crate::query::point::{SurfacePoint, point2, point3};
use crate::query::ray::{Span, ray2, ray3};
use crate::shape::Kind;

/// Function pointers to the entry points for one scalar and dimension.
#[derive(Debug)]
pub struct Tables<N: Real, const D: usize> {
    pub(crate) marker: PhantomData<N>,
    /// When the line of a ray is inside a solid.
    pub(crate) ray_span: fn(Kind<'_, N, D>, &Ray<N, D>) -> Option<Span<N, D>>,
    /// The point of a solid's boundary that is nearest to a point.
    pub(crate) surface_point: fn(Kind<'_, N, D>, &Point<N, D>) -> SurfacePoint<N, D>,
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

static PLANE_F32: Tables<f32, 2> =
    Tables { marker: PhantomData, ray_span: ray2::span, surface_point: point2::surface_point };
static SPACE_F32: Tables<f32, 3> =
    Tables { marker: PhantomData, ray_span: ray3::span, surface_point: point3::surface_point };
#[cfg(feature = "f64")]
static PLANE_F64: Tables<f64, 2> =
    Tables { marker: PhantomData, ray_span: ray2::span, surface_point: point2::surface_point };
#[cfg(feature = "f64")]
static SPACE_F64: Tables<f64, 3> =
    Tables { marker: PhantomData, ray_span: ray3::span, surface_point: point3::surface_point };

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
