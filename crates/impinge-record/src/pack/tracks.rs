//! Predicts the next pose of one object from its last poses.

use std::array;

use super::poses::{Layout, PoseKind};

/// The maximum number of scalars of a pose.
pub(super) const MAX_NUMBERS: usize = 7;

/// The bits of the scalars of a pose; unused entries are 0.
pub(super) type Bits = [u64; MAX_NUMBERS];

type Numbers = [f64; MAX_NUMBERS];

/// The number of candidates that predict each scalar.
const CANDIDATES: usize = 4;

/// The predictions of each candidate, as ordered integers.
pub(super) type Predictions = [Bits; CANDIDATES];

/// The number of poses that are stored for predictions.
const HISTORY: usize = 5;

/// The last pose of an object, and what its moves have taught.
#[derive(Clone, Debug, Default)]
pub(super) struct Track {
    last: Bits,
    /// `None` until the object is moved. Most objects of many recordings are never moved.
    moves: Option<Box<Moves>>,
}

/// The last poses of an object that was moved, and the costs of the candidates.
#[derive(Clone, Debug)]
struct Moves {
    /// The last poses, the latest first. NaN and infinities in them give predictions that are not
    /// used.
    history: [Numbers; HISTORY],
    /// For each scalar and candidate, the average length of its residuals in sixteenths of a bit.
    /// The average is exponential: the latest residual has the weight 1/4.
    costs: [[u32; CANDIDATES]; MAX_NUMBERS],
}

impl Track {
    /// Returns the predictions of all candidates. If the object is placed, each candidate predicts
    /// the last pose.
    pub(super) fn predictions(&mut self, layout: &Layout, kind: PoseKind) -> Predictions {
        let last = self.last.map(|bits| layout.ordered(bits));
        if kind == PoseKind::Placed {
            return [last; CANDIDATES];
        }
        let [same, others @ ..] = &mut [last; CANDIDATES];
        let extrapolated = self.moves(layout).extrapolated(layout);
        for (prediction, numbers) in others.iter_mut().zip(extrapolated) {
            for (own, number) in prediction.iter_mut().zip(numbers).take(layout.numbers) {
                // Predictions that are not finite are not used, since the bits of a computed NaN
                // differ between machines.
                if number.is_finite() {
                    *own = layout.ordered(bits_of(number, layout));
                }
            }
        }
        let [first, second, third] = *others;
        [*same, first, second, third]
    }

    /// Returns the last poses; before the first move all of them are the last pose.
    fn moves(&mut self, layout: &Layout) -> &mut Moves {
        let last = self.last;
        self.moves.get_or_insert_with(|| {
            let numbers = last.map(|bits| number_of(bits, layout));
            Box::new(Moves { history: [numbers; HISTORY], costs: Default::default() })
        })
    }

    /// Returns the prediction of the candidate with the lowest cost. Among equal costs it is the
    /// first candidate.
    pub(super) fn best(&self, number: usize, predictions: &Predictions) -> u64 {
        let costs = self.moves.as_ref().map_or([0; CANDIDATES], |moves| moves.costs[number]);
        let costs = costs.iter().zip(predictions);
        costs.min_by_key(|(cost, _)| **cost).map_or(0, |(_, prediction)| prediction[number])
    }

    /// Stores a pose and updates the costs of the candidates. A placed object that has another pose
    /// than the last one starts a new history; with the same pose nothing changes.
    pub(super) fn learn(
        &mut self,
        layout: &Layout,
        pose: &Bits,
        kind: PoseKind,
        predictions: &Predictions,
    ) {
        match kind {
            PoseKind::Placed if *pose != self.last => *self = Self { last: *pose, moves: None },
            PoseKind::Placed => {}
            PoseKind::Moved => {
                self.moves(layout).learn(layout, pose, predictions);
                self.last = *pose;
            }
        }
    }
}

impl Moves {
    /// Returns three extrapolations of the last pose: by the last step, by the last step plus its
    /// change since the step before, and by the mean of the last four steps.
    fn extrapolated(&self, layout: &Layout) -> [Numbers; CANDIDATES - 1] {
        let [now, before, earlier, _, earliest] = &self.history;
        let mut again: Numbers = array::from_fn(|i| now[i] + (now[i] - before[i]));
        let bent = array::from_fn(|i| 3.0 * (now[i] - before[i]) + earlier[i]);
        let mean = array::from_fn(|i| now[i] + (now[i] - earliest[i]) / 4.0);
        // The extrapolation of the rotation repeats the last step. For complex numbers and
        // quaternions q1 q0^-1 q1 = (2 (q0 . q1) q1 - |q1|^2 q0) / |q0|^2. The formula does not
        // assume unit length: rotations of poses deviate from it in the last bits, and small errors
        // would change many residuals.
        let rotation = layout.dimension..layout.numbers;
        let dot = |one: &Numbers, two: &Numbers| {
            rotation.clone().fold(0.0, |sum, i| sum + one[i] * two[i])
        };
        let [twice, square1, square0] =
            [2.0 * dot(before, now), dot(now, now), dot(before, before)];
        for i in rotation.clone() {
            again[i] = (twice * now[i] - square1 * before[i]) / square0;
        }
        [again, bent, mean]
    }

    /// Stores a pose and updates the costs of the candidates.
    fn learn(&mut self, layout: &Layout, pose: &Bits, predictions: &Predictions) {
        for (number, costs) in self.costs.iter_mut().enumerate().take(layout.numbers) {
            let actual = layout.ordered(pose[number]);
            for (cost, prediction) in costs.iter_mut().zip(predictions) {
                let residual = layout.residual(actual, prediction[number]);
                let length = u64::BITS - residual.leading_zeros();
                *cost = (3 * *cost + 16 * length) / 4;
            }
        }
        self.history.rotate_right(1);
        self.history[0] = pose.map(|bits| number_of(bits, layout));
    }
}

/// Returns the number with these bits; the conversion from `f32` is exact.
fn number_of(bits: u64, layout: &Layout) -> f64 {
    match u32::try_from(bits) {
        Ok(bits) if layout.scalar_bytes == 4 => f64::from(f32::from_bits(bits)),
        _ => f64::from_bits(bits),
    }
}

/// Returns the bits of the number, rounded to the scalar of the recording.
#[expect(clippy::cast_possible_truncation, reason = "the nearest number is meant")]
fn bits_of(number: f64, layout: &Layout) -> u64 {
    match layout.scalar_bytes {
        4 => u64::from((number as f32).to_bits()),
        _ => number.to_bits(),
    }
}
