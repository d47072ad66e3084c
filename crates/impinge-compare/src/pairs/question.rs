//! Queries and results.

use crate::measure::Times;

/// The query for every pair of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    Distance,
    Contact,
    Proximity,
    Impact,
    ManifoldCold,
    ManifoldWarm,
    ManifoldUndisturbed,
}

/// The prediction of contacts.
pub const PREDICTION: f32 = 0.1;

/// The maximum time of impacts.
pub const LONGEST_TIME: f32 = 10.0;

/// Two results differ if their difference exceeds this; solids are of size about 1.
const TOLERANCE: f32 = 2e-3;

impl Question {
    pub const ALL: [Self; 7] = [
        Self::Distance,
        Self::Contact,
        Self::Proximity,
        Self::Impact,
        Self::ManifoldCold,
        Self::ManifoldWarm,
        Self::ManifoldUndisturbed,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Contact => "contact",
            Self::Proximity => "proximity",
            Self::Impact => "time of impact",
            Self::ManifoldCold => "manifold cold",
            Self::ManifoldWarm => "manifold warm",
            Self::ManifoldUndisturbed => "manifold undisturbed",
        }
    }

    pub fn is_manifold(self) -> bool {
        matches!(self, Self::ManifoldCold | Self::ManifoldWarm | Self::ManifoldUndisturbed)
    }

    /// Returns the number of differences between two lists of results, for pairs at a distance.
    pub fn differences(self, ours: &[Answer], theirs: &[Answer], distance: f64) -> usize {
        let is_undecided = self == Self::Proximity && distance.abs() <= f64::from(TOLERANCE);
        if is_undecided {
            return 0;
        }
        ours.iter().zip(theirs).filter(|(a, b)| a.differs(**b)).count()
    }
}

/// A number that represents a result: the distance; the signed distance of the contact, or of the deepest
/// contact of all manifolds; zero for touching solids and one for others; the time of impact. Infinite for no
/// result, NaN for a query that the contender does not support.
#[derive(Clone, Copy, Debug)]
pub struct Answer(pub f32);

impl Answer {
    /// No result.
    pub const NONE: Self = Self(f32::INFINITY);
    /// The contender has no algorithm for the pair.
    pub const UNSUPPORTED: Self = Self(f32::NAN);

    /// Whether two solids touch.
    pub fn touching(is_touching: bool) -> Self {
        Self(if is_touching { 0.0 } else { 1.0 })
    }

    /// Returns the smallest of the signed distances within the prediction.
    pub fn deepest(distances: impl Iterator<Item = f32>) -> Self {
        let least = distances.fold(f32::INFINITY, f32::min);
        if least <= PREDICTION { Self(least) } else { Self::NONE }
    }

    pub fn is_supported(self) -> bool {
        !self.0.is_nan()
    }

    /// Whether there is a result.
    pub fn is_some(self) -> bool {
        self.0.is_finite()
    }

    fn differs(self, other: Self) -> bool {
        let is_near = (self.0 - other.0).abs() <= TOLERANCE;
        !(is_near || self.0 == other.0)
    }
}

/// A contender.
pub trait Contender {
    /// The name in the table.
    fn name(&self) -> &'static str;

    /// Whether it supports this question.
    fn treats(&self, question: Question) -> bool;

    /// Drops the state of earlier rounds, and prepares a question; not timed.
    fn reset(&mut self, question: Question);

    /// Runs the next round: the question once for every pair; timed.
    fn ask(&mut self, question: Question);

    /// Returns the results of the last round, one for each pair; not timed.
    fn answers(&self, question: Question) -> Vec<Answer>;

    /// Returns a part of its work that has a row of its own: its name, and its times per pair in all rounds
    /// since the reset except the first.
    fn part(&self) -> Option<(&'static str, Times)> {
        None
    }
}

/// The placements of the second solids in a round.
#[derive(Clone, Copy, Debug)]
pub enum Stand {
    /// One of the two sets.
    Set(usize),
    /// One of the slightly moved sets.
    Moved(usize),
}

/// Returns the placements of the second solids in a round: cold ones jump from set to set, warm ones move
/// slightly, all others stay.
pub fn stand(question: Question, round: usize) -> Stand {
    match question {
        Question::ManifoldCold => Stand::Set(round % 2),
        Question::ManifoldWarm => Stand::Moved(round % 4),
        _ => Stand::Set(0),
    }
}
