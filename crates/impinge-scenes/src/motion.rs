//! Motions as pure functions of the step number.

use crate::{Placement, rounded};

/// A triangle wave: a number that moves back and forth between two bounds at constant speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
    /// The value at step 0, within the bounds.
    pub start: f64,
    /// The change per step, of either sign, until the value reaches a bound.
    pub speed: f64,
}

impl Wave {
    /// Creates a wave with the constant value `at`, rounded to `f32`.
    #[must_use]
    pub fn rest(at: f64) -> Self {
        let at = rounded(at);
        Self { low: at, high: at, start: at, speed: 0.0 }
    }

    /// Creates a wave between two bounds. `start` is clamped to the bounds, and all numbers are
    /// rounded to `f32`.
    #[must_use]
    pub fn new(bounds: (f64, f64), start: f64, speed: f64) -> Self {
        let (low, high) = (rounded(bounds.0), rounded(bounds.1));
        Self { low, high, start: rounded(start).clamp(low, high), speed: rounded(speed) }
    }

    /// Returns the value at a step, rounded to `f32`.
    #[must_use]
    pub fn at(&self, step: u32) -> f64 {
        let width = self.high - self.low;
        if self.speed == 0.0 || width <= 0.0 {
            return self.start;
        }
        let way = self.start - self.low + self.speed * f64::from(step);
        let lap = way - (way / (2.0 * width)).floor() * (2.0 * width);
        let folded = if lap > width { 2.0 * width - lap } else { lap };
        // Rounding may exceed a bound by a unit in the last place.
        rounded(self.low + folded).clamp(self.low, self.high)
    }
}

/// A motion: a wave for each coordinate, and a rotation about a fixed axis whose angle is a wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<const D: usize> {
    /// The translation, one wave for each coordinate.
    pub place: [Wave; D],
    /// The unit vector along the axis of the rotation; (0, 0, 1) in 2D.
    pub axis: [f64; 3],
    /// The tangent of half the angle of the rotation.
    pub tangent: Wave,
}

impl<const D: usize> Motion<D> {
    /// Creates the motion of an object at rest at a point, without a rotation.
    #[must_use]
    pub fn rest(at: [f64; D]) -> Self {
        Self::translation(at.map(Wave::rest))
    }

    /// Creates the motion of an object that moves without a rotation.
    #[must_use]
    pub fn translation(place: [Wave; D]) -> Self {
        Self { place, axis: [0.0, 0.0, 1.0], tangent: Wave::rest(0.0) }
    }

    /// Returns a constant motion: the placement at step 0.
    #[must_use]
    pub fn frozen(&self) -> Self {
        let stop = |wave: &Wave| Wave::rest(wave.start);
        Self { place: self.place.each_ref().map(stop), tangent: stop(&self.tangent), ..*self }
    }

    /// Returns the placement of the object at a step.
    #[must_use]
    pub fn at(&self, step: u32) -> Placement<D> {
        Placement {
            translation: self.place.each_ref().map(|wave| wave.at(step)),
            axis: self.axis,
            tangent: self.tangent.at(step),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn to_and_fro_by_hand() {
        let wave = Wave::new((1.0, 3.0), 2.0, 0.75);
        let values: Vec<f64> = (0..7).map(|step| wave.at(step)).collect();
        assert_eq!(values, [2.0, 2.75, 2.5, 1.75, 1.0, 1.75, 2.5]);
        let back = Wave::new((1.0, 3.0), 1.25, -0.5);
        assert_eq!([back.at(0), back.at(1), back.at(2)], [1.25, 1.25, 1.75], "from the low bound");
    }

    #[test]
    fn far_steps_stay_within_bounds() {
        let wave = Wave::new((-0.1, 0.3), 0.05, 0.0123);
        for step in (0..u32::MAX).step_by(123_456_789) {
            assert!((wave.low..=wave.high).contains(&wave.at(step)), "step {step}");
        }
        assert_eq!(Wave::rest(0.1).at(5), rounded(0.1), "at rest");
    }
}
