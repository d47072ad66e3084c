//! Errors of results.

use std::panic::{AssertUnwindSafe, catch_unwind};

use impinge_reference::precise::vector::{angle, exact, unit};
use impinge_reference::precise::{Quad, separation_along};

use super::form::{Ask, Outcome};
use super::sample::Known;

/// A normal that separates as well as the best one up to this many units of rounding, but points in
/// another direction, is no error: several normals are correct.
const AS_GOOD: f64 = 16.0;
/// The smallest angle to the best normal that counts as another direction, in radians.
const ELSEWHERE: f64 = 0.05;
/// Results on the wrong side of zero by more than this many units are counted.
const WRONG_SIDE: f64 = 64.0;

/// The errors of one contender in the samples of one row.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    /// The number of samples.
    pub asked: usize,
    /// The number of samples for which the contender has no algorithm.
    pub unsupported: usize,
    /// The number of samples without a contact although the distance is less than the prediction,
    /// or in which the contender panicked.
    pub missing: usize,
    /// The number of samples reported as apart that overlap, or the reverse, by more than rounding.
    pub wrong_sign: usize,
    /// The number of normals that differ from the best one but separate as well.
    pub ties: usize,
    /// The errors of the distance if the solids are apart, otherwise of the depth, in units of
    /// rounding of the size of the scene.
    pub units: Vec<f64>,
    /// The errors relative to the distance or depth.
    pub relative: Vec<f64>,
    /// The angles between the normals and the best ones, in radians, without ties.
    pub angle: Vec<f64>,
    /// The differences between the largest separation and that along the normal, in units of
    /// rounding of the size of the scene.
    pub loss: Vec<f64>,
}

impl Errors {
    /// Runs one sample and records the errors of the result.
    pub fn ask<const D: usize>(&mut self, ask: Ask<D>, known: &Known<D>, epsilon: f64) {
        let prediction = 2.0 * known.truth.size;
        let outcome = catch_unwind(AssertUnwindSafe(|| ask(&known.sample, prediction)))
            .unwrap_or(Outcome::Nothing { distance: f64::NAN });
        self.asked += 1;
        let unit = epsilon * known.truth.size;
        let truth = known.truth.distance;
        match outcome {
            Outcome::Unsupported => self.unsupported += 1,
            Outcome::Nothing { distance } => {
                self.missing += 1;
                if truth > Quad::ZERO {
                    self.value(distance, truth, unit);
                }
            }
            Outcome::Found { distance, signed, normal } => {
                let value = if truth > Quad::ZERO { distance } else { signed };
                self.value(value, truth, unit);
                let (exact, slack) = (truth.to_f64(), WRONG_SIDE * unit);
                let too_deep = exact > slack && (signed < 0.0 || distance == 0.0);
                let too_far = exact < -slack && (signed > 0.0 || distance > slack);
                self.wrong_sign += usize::from(too_deep || too_far);
                self.normal(&normal, known, unit);
            }
        }
    }

    fn value(&mut self, value: f64, truth: Quad, unit: f64) {
        let error = (Quad::new(value) - truth).abs().to_f64();
        let error = if value.is_nan() { f64::INFINITY } else { error };
        self.units.push(error / unit);
        self.relative.push(error / truth.abs().to_f64());
    }

    fn normal<const D: usize>(&mut self, normal: &[f64; D], known: &Known<D>, rounding: f64) {
        let Some(direction) = unit(&exact(normal)) else {
            self.angle.push(f64::INFINITY);
            return;
        };
        let [solid1, solid2] = &known.solids;
        let [pose1, pose2] = &known.poses;
        let along = separation_along(solid1, pose1, solid2, pose2, normal);
        let loss = along.map_or(0.0, |along| (known.truth.distance - along).to_f64() / rounding);
        let angle = angle(&direction, &known.truth.normal);
        self.loss.push(loss.max(0.0));
        if loss <= AS_GOOD && angle > ELSEWHERE && !known.is_of_half_space() {
            self.ties += 1;
        } else {
            self.angle.push(angle);
        }
    }

    /// Adds the errors that another thread recorded.
    pub fn extend(&mut self, other: &Self) {
        self.asked += other.asked;
        self.unsupported += other.unsupported;
        self.missing += other.missing;
        self.wrong_sign += other.wrong_sign;
        self.ties += other.ties;
        self.units.extend_from_slice(&other.units);
        self.relative.extend_from_slice(&other.relative);
        self.angle.extend_from_slice(&other.angle);
        self.loss.extend_from_slice(&other.loss);
    }
}

/// Returns the largest error and the 99.9th percentile; `None` without errors.
pub fn extremes(errors: &[f64]) -> Option<[f64; 2]> {
    let mut sorted = errors.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    Some([sorted[last * 999 / 1000], sorted[last]])
}
