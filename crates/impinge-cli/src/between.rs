//! How two objects are to each other: the fields of `check` and `distance`.

use core::cmp::Ordering;
use core::fmt::Write as _;

use impinge::query::Witness;
use impinge_record::Recordable;
use serde::Serialize;

use crate::number::{Number, tuple};
use crate::output::{CLEAR, FAINT, NAME, NEAR, TOUCHES};
use crate::summary::State;

/// Two objects and the points where they are nearest or deepest. What is null has no bound: half-spaces
/// that overlap for ever.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Between {
    pub(crate) first: String,
    pub(crate) second: String,
    pub(crate) state: State,
    /// Zero if they touch.
    pub(crate) distance: Option<Number>,
    /// Zero unless they overlap.
    pub(crate) depth: Option<Number>,
    pub(crate) point1: Option<Vec<Number>>,
    pub(crate) point2: Option<Vec<Number>>,
    /// From the first to the second, of length 1.
    pub(crate) normal: Option<Vec<Number>>,
    pub(crate) part1: Option<u32>,
    pub(crate) part2: Option<u32>,
}

impl Between {
    /// Two objects with the nearest points of their shapes; near if these are within a margin.
    pub(crate) fn apart_or_not<N: Recordable<D>, const D: usize>(
        names: [String; 2],
        found: &Witness<N, D>,
        margin: N,
    ) -> Self {
        let distance = impinge::math::max(found.distance, N::ZERO);
        let depth = impinge::math::max(-found.distance, N::ZERO);
        let state = if found.distance <= N::ZERO {
            State::Touch
        } else if distance <= margin {
            State::Near
        } else {
            State::Apart
        };
        let [first, second] = names;
        Self {
            first,
            second,
            state,
            distance: Some(Number::new(distance)),
            depth: Some(Number::new(depth)),
            point1: Some(Number::of_point(&found.point1)),
            point2: Some(Number::of_point(&found.point2)),
            normal: Some(Number::of_vector(&found.normal)),
            part1: Some(found.part1),
            part2: Some(found.part2),
        }
    }

    /// Two objects without nearest points: half-spaces that overlap without bound, or something infinitely
    /// far away.
    pub(crate) fn unbounded(names: [String; 2], state: State) -> Self {
        let [first, second] = names;
        let (distance, depth, point1, point2) = (None, None, None, None);
        let (normal, part1, part2) = (None, None, None);
        Self { first, second, state, distance, depth, point1, point2, normal, part1, part2 }
    }

    /// The deepest first, then the nearest; without bound before all.
    pub(crate) fn by_depth(&self, other: &Self) -> Ordering {
        let key = |one: &Self| match (one.depth, one.distance) {
            (Some(depth), Some(distance)) => distance.value() - depth.value(),
            _ => f64::NEG_INFINITY,
        };
        let by_name = || self.first.cmp(&other.first).then_with(|| self.second.cmp(&other.second));
        key(self).total_cmp(&key(other)).then_with(by_name)
    }

    /// A line: the state, the names, and how deep or how far apart.
    pub(crate) fn headline(&self, text: &mut String) {
        let style = match self.state {
            State::Touch => TOUCHES,
            State::Near => NEAR,
            State::Apart => CLEAR,
        };
        let Self { first, second, state, .. } = self;
        let word = state.word();
        let _ =
            write!(text, "{style}{word:5}{style:#} {NAME}{first}{NAME:#} {NAME}{second}{NAME:#}");
        let _ = match (state, self.depth, self.distance) {
            (State::Touch, Some(depth), _) => writeln!(text, "  depth {depth}"),
            (State::Touch, None, _) => writeln!(text, "  without bound"),
            (_, _, Some(distance)) => writeln!(text, "  distance {distance}"),
            (_, _, None) => writeln!(text, "  infinitely far"),
        };
    }

    /// A second line: the points and the normal.
    pub(crate) fn points(&self, text: &mut String) {
        if let (Some(point1), Some(point2), Some(normal)) =
            (&self.point1, &self.point2, &self.normal)
        {
            let [point1, point2, normal] = [point1, point2, normal].map(|numbers| tuple(numbers));
            let _ = writeln!(
                text,
                "      {FAINT}from{FAINT:#} {point1} {FAINT}to{FAINT:#} {point2} {FAINT}along{FAINT:#} {normal}"
            );
        }
    }
}
