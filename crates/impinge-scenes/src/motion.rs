//! Motion as a pure function of the number of the step.

use crate::{Placement, rounded};

/// A number that runs to and fro between two bounds at constant speed: a triangle wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
    /// The value at step 0, within the bounds.
    pub start: f64,
    /// The change per step, of either sign, until the first bound is met.
    pub speed: f64,
}

impl Wave {
    /// A number that stays.
    #[must_use]
    pub fn rest(at: f64) -> Self {
        let at = rounded(at);
        Self { low: at, high: at, start: at, speed: 0.0 }
    }

    /// A number that runs between bounds from a start within them.
    #[must_use]
    pub fn new(bounds: (f64, f64), start: f64, speed: f64) -> Self {
        let (low, high) = (rounded(bounds.0), rounded(bounds.1));
        Self { low, high, start: rounded(start).clamp(low, high), speed: rounded(speed) }
    }

    /// The value at a step, rounded to `f32`.
    #[must_use]
    pub fn at(&self, step: u32) -> f64 {
        let width = self.high - self.low;
        if self.speed == 0.0 || width <= 0.0 {
            return self.start;
        }
        let way = self.start - self.low + self.speed * f64::from(step);
        let lap = way - (way / (2.0 * width)).floor() * (2.0 * width);
        let folded = if lap > width { 2.0 * width - lap } else { lap };
        // Rounding may have left the bounds by a unit in the last place.
        rounded(self.low + folded).clamp(self.low, self.high)
    }
}

/// Waves in all directions and a turn that goes to and fro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<const D: usize> {
    /// The translation, by coordinate.
    pub place: [Wave; D],
    /// The axis of the turn, of length 1; (0, 0, 1) in the plane.
    pub axis: [f64; 3],
    /// The tangent of half the angle.
    pub tangent: Wave,
}

impl<const D: usize> Motion<D> {
    /// An object that stays where it is, not turned.
    #[must_use]
    pub fn rest(at: [f64; D]) -> Self {
        Self::translation(at.map(Wave::rest))
    }

    /// An object that moves but does not turn.
    #[must_use]
    pub fn translation(place: [Wave; D]) -> Self {
        Self { place, axis: [0.0, 0.0, 1.0], tangent: Wave::rest(0.0) }
    }

    /// The same motion frozen at step 0.
    #[must_use]
    pub fn frozen(&self) -> Self {
        let stop = |wave: &Wave| Wave::rest(wave.start);
        Self { place: self.place.each_ref().map(stop), tangent: stop(&self.tangent), ..*self }
    }

    /// Where the object is at a step.
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
