//! The place of a chord that is nearest to a cylinder or a cone, or deepest inside.

use super::profile::Profile;
use super::{NearestHull, RevolvedPlace, still};
use crate::math::{Real, Vector, max, min};

/// Cap on the points looked at, about four of which are needed.
const STEPS: usize = 16;
/// Cap on the bisections among them: there are none but where parts are passed over, and where the distance has a
/// kink, inside the solid.
const HALVINGS: usize = 4;

/// A search along a chord: the shares of the way between which the slope changes its sign.
struct ChordSearch<N: Real> {
    ends: [Vector<N, 3>; 2],
    along: Vector<N, 3>,
    length: N,
    bounds: [N; 2],
    /// Whether the slope has been found to fall at the one and to rise at the other.
    is_known: [bool; 2],
    halvings: usize,
}

impl<N: Real> ChordSearch<N> {
    /// `None` of a chord without length.
    fn new(ends: [Vector<N, 3>; 2], falls: bool) -> Option<Self> {
        let along = ends[1] - ends[0];
        let length = along.norm();
        let (bounds, is_known) = ([N::ZERO, N::ONE], [falls, false]);
        (length > still()).then_some(Self { ends, along, length, bounds, is_known, halvings: 0 })
    }

    /// Where the chord is nearest to the middle of the solid.
    fn start(&self) -> N {
        let share = -self.ends[0].dot(&self.along) / (self.length * self.length);
        max(min(share, N::ONE), N::ZERO)
    }

    /// The point at a share of the way, measured from the nearer end.
    fn at(&self, share: N) -> Vector<N, 3> {
        if share <= N::HALF {
            self.ends[0] + self.along * share
        } else {
            self.ends[1] - self.along * (N::ONE - share)
        }
    }

    /// Notes the slope at a share.
    fn note(&mut self, share: N, slope: N) {
        let rises = usize::from(slope > N::ZERO);
        (self.bounds[rises], self.is_known[rises]) = (share, true);
    }

    /// Where to look after a share, if it is in doubt; ends that have not been looked at count.
    fn admitted(&self, target: N) -> Option<N> {
        let [low, high] = self.bounds;
        if target > low && target < high {
            return Some(target);
        }
        let beyond = usize::from(target >= high);
        (!self.is_known[beyond]).then_some(self.bounds[beyond])
    }

    /// Halfway, if that has not been tried too often.
    fn halved(&mut self) -> Option<N> {
        self.halvings += 1;
        let [low, high] = self.bounds;
        (self.halvings <= HALVINGS).then_some((low + high) * N::HALF)
    }
}

impl<N: Real> Profile<N> {
    /// The place of a chord that is nearest, and what of the chord is needed for it; `falls` tells that it is not
    /// the first end.
    pub(super) fn along(
        &self,
        ends: [Vector<N, 3>; 2],
        falls: bool,
    ) -> Option<(NearestHull<N>, RevolvedPlace<N>)> {
        let mut search = ChordSearch::new(ends, falls)?;
        let mut share = search.start();
        for _ in 0..STEPS {
            let seen = self.seen_from(search.at(share));
            let (slope, way) = (seen.slope(&search.along), seen.way_down(&search.along));
            let is_end =
                share <= N::ZERO && slope >= N::ZERO || share >= N::ONE && slope <= N::ZERO;
            if is_end {
                return Some((NearestHull::Point(seen.point), RevolvedPlace::of(self, &seen)));
            }
            let is_level = slope.abs() <= still::<N>() * search.length;
            if is_level || way.is_some_and(|way| way.abs() * search.length <= still()) {
                return Some((
                    NearestHull::Chord(ends),
                    RevolvedPlace::across(self, &seen, &(search.along / search.length))?,
                ));
            }
            search.note(share, slope);
            let ahead = if slope > N::ZERO { -N::ONE } else { N::ONE };
            let next = search.admitted(share + way.unwrap_or(ahead));
            share = match next {
                Some(next) => next,
                // Inside it is a kink.
                None if seen.distance < N::ZERO => return None,
                None => {
                    let to_rim = seen.way_to_rim(self, &search.along);
                    let next = to_rim.and_then(|way| search.admitted(share + way));
                    next.or_else(|| search.halved())?
                }
            };
        }
        None
    }
}
