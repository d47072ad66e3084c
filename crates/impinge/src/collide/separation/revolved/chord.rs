//! Finds the point of a chord, a segment between two points of the flat solid, that is nearest to a
//! cylinder or cone, or deepest inside it.

use super::profile::Profile;
use super::{DirectedPoint, NearestHull, still};
use crate::math::{Real, Vector, max, min};

/// Largest number of points tried; about four are needed.
const STEPS: usize = 16;
/// Largest number of bisections among these points. The bounds are bisected if both the step of
/// Newton's method and the step to the rim lead beyond them. This happens if the nearest part of
/// the solid changes between two points. Inside the solid, the search gives up instead.
const HALVINGS: usize = 4;

/// A search along a chord for the point where the slope, the derivative of the distance along the
/// chord, changes its sign.
struct ChordSearch<N: Real> {
    /// Ends in the frame of the round solid, in units of the pair.
    ends: [Vector<N, 3>; 2],
    /// Vector from the first end to the second, and its length.
    along: Vector<N, 3>,
    length: N,
    /// Parameters from 0 to 1 between which the slope changes its sign.
    bounds: [N; 2],
    /// Whether the distance is known to fall at the lower bound, and to rise at the upper bound.
    is_known: [bool; 2],
    /// Number of bisections so far.
    halvings: usize,
}

impl<N: Real> ChordSearch<N> {
    /// Starts the search. `falls` says whether the distance is known to fall from the first end.
    /// `None` for a chord without length.
    fn new(ends: [Vector<N, 3>; 2], falls: bool) -> Option<Self> {
        let along = ends[1] - ends[0];
        let length = along.norm();
        let (bounds, is_known) = ([N::ZERO, N::ONE], [falls, false]);
        (length > still()).then_some(Self { ends, along, length, bounds, is_known, halvings: 0 })
    }

    /// Returns the parameter of the point of the chord nearest to the origin, which is the centre
    /// of the round solid.
    fn start(&self) -> N {
        let share = -self.ends[0].dot(&self.along) / (self.length * self.length);
        max(min(share, N::ONE), N::ZERO)
    }

    /// Returns the point at parameter `share` from 0 to 1, computed from the nearer end.
    fn at(&self, share: N) -> Vector<N, 3> {
        if share <= N::HALF {
            self.ends[0] + self.along * share
        } else {
            self.ends[1] - self.along * (N::ONE - share)
        }
    }

    /// Moves a bound to a parameter with a known slope: the upper bound if the distance rises
    /// there, else the lower bound.
    fn note(&mut self, share: N, slope: N) {
        let rises = usize::from(slope > N::ZERO);
        (self.bounds[rises], self.is_known[rises]) = (share, true);
    }

    /// Returns the parameter to try next: `target` if it is between the bounds, else the bound on
    /// its side. `None` if the slope at that bound is already known.
    fn admitted(&self, target: N) -> Option<N> {
        let [low, high] = self.bounds;
        if target > low && target < high {
            return Some(target);
        }
        let beyond = usize::from(target >= high);
        (!self.is_known[beyond]).then_some(self.bounds[beyond])
    }

    /// Returns the middle of the bounds; `None` after [`HALVINGS`] bisections.
    fn halved(&mut self) -> Option<N> {
        self.halvings += 1;
        let [low, high] = self.bounds;
        (self.halvings <= HALVINGS).then_some((low + high) * N::HALF)
    }
}

impl<N: Real> Profile<N> {
    /// Returns the point of a chord nearest to the solid, with its direction, and the smallest hull
    /// that contains it: this point or the chord. `falls` says whether the distance is known to
    /// fall from the first end. `None` for a chord without length, and if the search does not
    /// converge.
    pub(super) fn along(
        &self,
        ends: [Vector<N, 3>; 2],
        falls: bool,
    ) -> Option<(NearestHull<N>, DirectedPoint<N>)> {
        let mut search = ChordSearch::new(ends, falls)?;
        let mut share = search.start();
        for _ in 0..STEPS {
            let projected = self.project(search.at(share));
            let (slope, descent) =
                (projected.slope(&search.along), projected.descent(&search.along));
            let is_end =
                share <= N::ZERO && slope >= N::ZERO || share >= N::ONE && slope <= N::ZERO;
            if is_end {
                return Some((
                    NearestHull::Point(projected.point),
                    DirectedPoint::of(self, &projected),
                ));
            }
            let is_flat = slope.abs() <= still::<N>() * search.length;
            if is_flat || descent.is_some_and(|descent| descent.abs() * search.length <= still()) {
                return Some((
                    NearestHull::Chord(ends),
                    DirectedPoint::across(self, &projected, &(search.along / search.length))?,
                ));
            }
            search.note(share, slope);
            let sign = if slope > N::ZERO { -N::ONE } else { N::ONE };
            let next = search.admitted(share + descent.unwrap_or(sign));
            share = match next {
                Some(next) => next,
                // Inside, the slope changes its sign at a kink of the distance, which Newton's
                // method cannot find.
                None if projected.distance < N::ZERO => return None,
                None => {
                    let to_rim = projected.step_to_rim(self, &search.along);
                    let next = to_rim.and_then(|step| search.admitted(share + step));
                    next.or_else(|| search.halved())?
                }
            };
        }
        None
    }
}
