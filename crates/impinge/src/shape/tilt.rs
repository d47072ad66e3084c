//! The maximum tilt out of the supporting plane for a face or an edge that counts as the supporting
//! feature.

use crate::math::{Real, Vector};

/// The squared sine of atan(1/2), the limit of [`super::SupportMap::core_feature`].
pub(crate) const FACING_SINE_SQUARED: f64 = 0.2;

/// A maximum tilt, stored as its squared sine: small angles keep their relative precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tilt<N: Real> {
    sine_squared: N,
}

impl<N: Real> Tilt<N> {
    /// Returns the limit that [`super::SupportMap::core_feature`] applies.
    #[inline]
    pub(super) fn default_limit() -> Self {
        Self { sine_squared: N::lit(FACING_SINE_SQUARED) }
    }

    /// Returns the limit for the smallest angle that unit vectors in rounded arithmetic distinguish
    /// from zero.
    pub(super) fn least() -> Self {
        let sine = N::lit(64.0) * N::EPSILON;
        Self { sine_squared: sine * sine }
    }

    /// Returns the limit for `angle` radians, clamped to the range from [`Self::least`] to a little
    /// below a right angle. NaN is treated as a right angle.
    pub(super) fn of_angle(angle: N) -> Self {
        let largest = N::ONE - N::lit(0.001);
        let sine = if angle < N::lit(1.57) { angle.sine_cosine().0 } else { N::ONE };
        let squared = if sine > N::ZERO { sine * sine } else { N::ZERO };
        let least = Self::least().sine_squared;
        let sine_squared = if squared > least { squared } else { least };
        Self { sine_squared: if sine_squared < largest { sine_squared } else { largest } }
    }

    /// Returns whether a tilt with this squared sine is within the limit.
    #[inline]
    pub(super) fn admits(self, sine_squared: N) -> bool {
        sine_squared <= self.sine_squared
    }

    /// Returns whether the angle between the unit vectors `normal`, the normal of a face, and
    /// `direction` is within the limit.
    #[inline]
    pub(super) fn admits_face<const D: usize>(
        self,
        normal: &Vector<N, D>,
        direction: &Vector<N, D>,
    ) -> bool {
        let along = normal.dot(direction);
        along > N::ZERO && self.admits((direction - normal * along).norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_the_documented_angles() {
        let normal = Vector::<f64, 2>::new(1.0, 0.0);
        for (tilt, limit) in
            [(Tilt::<f64>::default_limit(), 0.5_f64.atan()), (Tilt::of_angle(0.3), 0.3)]
        {
            let at_angle = |angle: f64| Vector::<f64, 2>::new(angle.cos(), angle.sin());
            assert!(tilt.admits_face(&normal, &at_angle(limit - 1e-9)), "just inside {limit}");
            assert!(!tilt.admits_face(&normal, &at_angle(limit + 1e-9)), "just outside {limit}");
            assert!(!tilt.admits_face(&normal, &-at_angle(0.0)), "the back of a face never faces");
        }
        assert!(Tilt::<f32>::of_angle(-1.0).admits(0.0), "no angle is below the least");
        assert!(!Tilt::<f32>::of_angle(f32::INFINITY).admits(1.0), "nothing upright faces");
        assert!(Tilt::<f32>::of_angle(f32::NAN).admits(0.0), "NaN ends somewhere");
    }
}
