//! What is asked, and what is answered.

use crate::measure::Times;

/// What is asked of every pair of a case.
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

/// How far ahead contacts are wanted.
pub const PREDICTION: f32 = 0.1;

/// Impacts after this time are not wanted.
pub const LONGEST_TIME: f32 = 10.0;

/// Two answers differ if they are farther apart than this; solids are about 1 across.
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

    /// By how many two lists of answers differ, to pairs at a distance.
    pub fn differences(self, ours: &[Answer], theirs: &[Answer], distance: f64) -> usize {
        let is_undecided = self == Self::Proximity && distance.abs() <= f64::from(TOLERANCE);
        if is_undecided {
            return 0;
        }
        ours.iter().zip(theirs).filter(|(a, b)| a.differs(**b)).count()
    }
}

/// One number that says it all: the distance; the signed distance of the contact, or of the deepest
/// contact of all manifolds; zero for solids that touch and one for others; the time of impact.
/// Infinite for none, NaN for a question that the contender cannot answer.
#[derive(Clone, Copy, Debug)]
pub struct Answer(pub f32);

impl Answer {
    /// There is none.
    pub const NONE: Self = Self(f32::INFINITY);
    /// The contender has no algorithm for the pair.
    pub const UNSUPPORTED: Self = Self(f32::NAN);

    /// Whether two solids touch.
    pub fn touching(is_touching: bool) -> Self {
        Self(if is_touching { 0.0 } else { 1.0 })
    }

    /// That of the deepest contact not farther than the prediction, of signed distances.
    pub fn deepest(distances: impl Iterator<Item = f32>) -> Self {
        let least = distances.fold(f32::INFINITY, f32::min);
        if least <= PREDICTION { Self(least) } else { Self::NONE }
    }

    pub fn is_supported(self) -> bool {
        !self.0.is_nan()
    }

    /// It says that there is something.
    pub fn is_some(self) -> bool {
        self.0.is_finite()
    }

    fn differs(self, other: Self) -> bool {
        let is_near = (self.0 - other.0).abs() <= TOLERANCE;
        !(is_near || self.0 == other.0)
    }
}

/// One of those who answer.
pub trait Contender {
    /// The name in the table.
    fn name(&self) -> &'static str;

    /// Whether it is one for this question.
    fn treats(&self, question: Question) -> bool;

    /// Forgets what it kept of earlier rounds, and gets ready for a question; not timed.
    fn reset(&mut self, question: Question);

    /// The next round: answers the question once for every pair; timed.
    fn ask(&mut self, question: Question);

    /// The answers of the last round, one for each pair; not timed.
    fn answers(&self, question: Question) -> Vec<Answer>;

    /// A part of what it does that has a row of its own: its name, and its times per pair in the rounds since
    /// it began anew but the first.
    fn part(&self) -> Option<(&'static str, Times)> {
        None
    }
}

/// Which placements of the second solids a round is about.
#[derive(Clone, Copy, Debug)]
pub enum Stand {
    /// One of the two sets.
    Set(usize),
    /// One of the sets that are a little moved.
    Moved(usize),
}

/// Where the second solids stand in a round: cold ones jump from set to set, warm ones move a little,
/// all others stay.
pub fn stand(question: Question, round: usize) -> Stand {
    match question {
        Question::ManifoldCold => Stand::Set(round % 2),
        Question::ManifoldWarm => Stand::Moved(round % 4),
        _ => Stand::Set(0),
    }
}
