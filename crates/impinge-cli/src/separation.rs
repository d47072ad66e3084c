//! The distance or depth of two objects: the fields of the reports of `check` and `distance`.

use core::fmt;

use impinge::query::Witness;
use impinge_record::Recordable;
use serde::Serialize;

use crate::number::{Number, tuple};
use crate::output::FAINT;
use crate::state::State;

/// Two objects, and the points at which they are nearest or deepest. A field is null if its value
/// is unbounded or does not exist, as for half-spaces with an unbounded overlap.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Separation {
    pub(crate) first: String,
    pub(crate) second: String,
    pub(crate) state: State,
    /// The distance; zero if the objects touch.
    pub(crate) distance: Option<Number>,
    /// The depth, which is the length of the shortest translation that separates the objects; zero
    /// unless they overlap.
    pub(crate) depth: Option<Number>,
    /// The nearest or deepest point on the first object, in the world frame.
    pub(crate) point1: Option<Vec<Number>>,
    /// The nearest or deepest point on the second object, in the world frame.
    pub(crate) point2: Option<Vec<Number>>,
    /// The unit normal from the first object to the second.
    pub(crate) normal: Option<Vec<Number>>,
    /// The index of the part of the first object that contains the point; 0 for a convex shape.
    pub(crate) part1: Option<u32>,
    /// The index of the part of the second object that contains the point; 0 for a convex shape.
    pub(crate) part2: Option<u32>,
}

impl Separation {
    /// Converts a witness. The state is near if the objects are apart and their distance is at most
    /// `margin`.
    pub(crate) fn of_witness<N: Recordable<D>, const D: usize>(
        [first, second]: [String; 2],
        found: &Witness<N, D>,
        margin: N,
    ) -> Self {
        // The distance of a witness is signed: it is the negative depth if the objects overlap.
        let distance = impinge::math::max(found.distance, N::ZERO);
        let depth = impinge::math::max(-found.distance, N::ZERO);
        let state = if found.distance <= N::ZERO {
            State::Touch
        } else if distance <= margin {
            State::Near
        } else {
            State::Apart
        };
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

    /// Creates the fields for two objects without nearest points: half-spaces with an unbounded
    /// overlap, or objects at an infinite distance.
    pub(crate) fn unbounded([first, second]: [String; 2], state: State) -> Self {
        let (distance, depth, point1, point2) = (None, None, None, None);
        let (normal, part1, part2) = (None, None, None);
        Self { first, second, state, distance, depth, point1, point2, normal, part1, part2 }
    }
}

/// Writes a line with the state, the names and the length, and a line with the points and the
/// normal.
impl fmt::Display for Separation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.state.headline(f, &self.first, &self.second)?;
        match (self.state, self.depth, self.distance) {
            (State::Touch, Some(depth), _) => writeln!(f, "  depth {depth}")?,
            (State::Touch, None, _) => writeln!(f, "  without bound")?,
            (_, _, Some(distance)) => writeln!(f, "  distance {distance}")?,
            (_, _, None) => writeln!(f, "  infinitely far")?,
        }
        let (Some(point1), Some(point2), Some(normal)) = (&self.point1, &self.point2, &self.normal)
        else {
            return Ok(());
        };
        let [point1, point2, normal] = [point1, point2, normal].map(|numbers| tuple(numbers));
        writeln!(
            f,
            "      {FAINT}from{FAINT:#} {point1} {FAINT}to{FAINT:#} {point2} {FAINT}along{FAINT:#} {normal}"
        )
    }
}
