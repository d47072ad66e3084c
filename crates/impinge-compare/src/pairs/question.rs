//! The queries of the suite, their results, and the interface of the contenders.

use crate::measure::Times;

/// The query that is run for every pair of a case.
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

/// The prediction of contacts: the distance up to which two solids have contacts.
pub const PREDICTION: f32 = 0.1;

/// The maximum time in impact queries.
pub const LONGEST_TIME: f32 = 10.0;

/// The tolerance of results. Solids are about 1 in size.
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

    /// Returns the number of pairs whose results differ. `distance` is that of the regime. If the
    /// solids just touch, rounding decides their proximity, so no difference is counted.
    pub fn differences(self, ours: &[Answer], theirs: &[Answer], distance: f64) -> usize {
        let is_undecided = self == Self::Proximity && distance.abs() <= f64::from(TOLERANCE);
        if is_undecided {
            return 0;
        }
        ours.iter().zip(theirs).filter(|(a, b)| a.differs(**b)).count()
    }
}

/// The result of one query for one pair, as a number.
///
/// | query | number |
/// |---|---|
/// | distance | the distance |
/// | contact | the signed distance |
/// | manifold | the least signed distance of all contacts |
/// | proximity | 0 if the solids overlap, otherwise 1 |
/// | time of impact | the time |
///
/// Infinity means that there is no contact or impact. NaN means that the contender does not support
/// the query.
#[derive(Clone, Copy, Debug)]
pub struct Answer(pub f32);

impl Answer {
    /// There is no contact or impact.
    pub const NONE: Self = Self(f32::INFINITY);
    /// The contender has no algorithm for the pair.
    pub const UNSUPPORTED: Self = Self(f32::NAN);

    /// Returns the result of a proximity query.
    pub fn touching(is_touching: bool) -> Self {
        Self(if is_touching { 0.0 } else { 1.0 })
    }

    /// Returns the least of some signed distances; [`Self::NONE`] if it exceeds the prediction.
    pub fn deepest(distances: impl Iterator<Item = f32>) -> Self {
        let least = distances.fold(f32::INFINITY, f32::min);
        if least <= PREDICTION { Self(least) } else { Self::NONE }
    }

    pub fn is_supported(self) -> bool {
        !self.0.is_nan()
    }

    /// Returns `true` if there is a result.
    pub fn is_some(self) -> bool {
        self.0.is_finite()
    }

    fn differs(self, other: Self) -> bool {
        let is_near = (self.0 - other.0).abs() <= TOLERANCE;
        !(is_near || self.0 == other.0)
    }
}

/// A library, or a way to use it, that runs the queries of a case.
pub trait Contender {
    /// Returns the name in the table.
    fn name(&self) -> &'static str;

    /// Returns `true` if the contender supports this query.
    fn treats(&self, question: Question) -> bool;

    /// Drops the state of earlier rounds and prepares for the query; not timed.
    fn reset(&mut self, question: Question);

    /// Runs the next round: the query once for every pair; timed.
    fn ask(&mut self, question: Question);

    /// Returns the results of the last round, one for each pair; not timed.
    fn answers(&self, question: Question) -> Vec<Answer>;

    /// Returns the name of a part of the work that has its own row, and the times of this part per
    /// pair: those of all rounds since the reset except the first. `None` if the contender has no
    /// such part.
    fn part(&self) -> Option<(&'static str, Times)> {
        None
    }
}

/// The set of placements of the second solids in a round.
#[derive(Clone, Copy, Debug)]
pub enum Stand {
    /// One of the two unrelated sets.
    Set(usize),
    /// One of the slightly moved sets.
    Moved(usize),
}

/// Returns the placements of the second solids in a round. For cold manifolds the two unrelated
/// sets alternate, for warm manifolds the slightly moved sets. All other queries use the first set.
pub fn stand(question: Question, round: usize) -> Stand {
    match question {
        Question::ManifoldCold => Stand::Set(round % 2),
        Question::ManifoldWarm => Stand::Moved(round % 4),
        _ => Stand::Set(0),
    }
}
