//! Measures the errors of the contenders' results against the reference.
//!
//! A unit of rounding is epsilon of the scalar times the size of the scene. The loss of a normal is
//! the difference between the largest separation of the solids and their separation along this
//! normal.

use std::panic::{AssertUnwindSafe, catch_unwind};

use impinge_reference::precise::vector::{angle, exact, unit};
use impinge_reference::precise::{Quad, separation_along};

use super::form::{Ask, Outcome};
use super::sample::Known;

/// The largest loss of a tie, in units of rounding. A tie is a normal far from the best one, along
/// which the solids are separated equally up to rounding. If several normals are correct, a tie is
/// no error.
const AS_GOOD: f64 = 16.0;
/// The angle to the best normal, in radians, above which a normal can be a tie.
const ELSEWHERE: f64 = 0.05;
/// The exact distance or depth, in units of rounding, above which a wrong sign is counted.
const WRONG_SIDE: f64 = 64.0;

/// The errors of one contender in the samples of one or more rows.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    /// The number of samples that were run.
    pub asked: usize,
    /// The number of samples for which the contender has no algorithm.
    pub unsupported: usize,
    /// The number of samples in which the contender found no contact within the prediction, or
    /// panicked.
    pub missing: usize,
    /// The number of results with the wrong sign: solids that overlap by more than `WRONG_SIDE`
    /// units of rounding reported as separated, or solids that are apart by more than this reported
    /// as overlapping.
    pub wrong_sign: usize,
    /// The number of ties: normals that differ from the best one but separate equally well.
    pub ties: usize,
    /// The errors in units of rounding: of the distance if the solids are apart, otherwise of the
    /// depth.
    pub units: Vec<f64>,
    /// The errors of the distance or depth, divided by its exact value.
    pub relative: Vec<f64>,
    /// The angles between the normals and the best ones, in radians. Ties are omitted; a normal of
    /// length zero has an infinite angle.
    pub angle: Vec<f64>,
    /// The losses of the normals, in units of rounding.
    pub loss: Vec<f64>,
}

impl Errors {
    /// Runs one sample with a contender and records the errors of the result. `epsilon` is that of
    /// the scalar. A panic counts as a result without a contact.
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

/// Returns the 99.9th percentile and the largest error; `None` without errors.
pub fn extremes(errors: &[f64]) -> Option<[f64; 2]> {
    let mut sorted = errors.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    Some([sorted[last * 999 / 1000], sorted[last]])
}
