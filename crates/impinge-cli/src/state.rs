//! The state of a pair: touching, near or apart.

use core::fmt;

use anstyle::Style;
use impinge_files::Printable;
use serde::Serialize;

use crate::output::{CLEAR, NAME, NEAR, TOUCHES};

/// The state of a pair of objects, by their distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum State {
    /// The distance of the objects is zero.
    Touch,
    /// The objects are apart, but within the clearance or margin.
    Near,
    /// The objects are farther apart than the clearance or margin.
    Apart,
}

impl State {
    /// Writes the beginning of a line about a pair: the state and the two names.
    pub(crate) fn headline(
        self,
        f: &mut fmt::Formatter<'_>,
        first: &str,
        second: &str,
    ) -> fmt::Result {
        let (word, style): (_, Style) = match self {
            Self::Touch => ("touch", TOUCHES),
            Self::Near => ("near", NEAR),
            Self::Apart => ("apart", CLEAR),
        };
        let [first, second] = [first, second].map(Printable);
        // The state is padded to the longest word, so that the names in several lines are aligned.
        write!(f, "{style}{word:5}{style:#} {NAME}{first}{NAME:#} {NAME}{second}{NAME:#}")
    }
}
