//! What two outlines that face each other share: the ends of a stretch, or the nearest pair of points.

use super::super::facet::lifted_by;
use super::super::frame::Candidate;
use super::super::{RawManifold, choose};
use super::part::Part;
use crate::math::{Point, Real, Vector, max, min};
use crate::query::RawPoint;
use crate::query::separation::meeting::Meeting;
use crate::shape::FeatureId;

/// What the two solids show each other.
pub(super) struct Facing<'a, N: Real> {
    pub(super) meeting: &'a Meeting<N>,
    /// What each of them shows.
    pub(super) parts: [&'a Part<N>; 2],
    pub(super) distance: N,
    pub(super) tolerance: N,
}

/// One end of the stretch that two sides share.
#[derive(Clone, Copy)]
struct SharedEnd<N> {
    place: N,
    /// Of the first solid and of the second, which end it is: [`BETWEEN`] of one of them, perhaps.
    ends: [usize; 2],
}

/// No end of a side, but something between them.
const BETWEEN: usize = 2;

impl<N> SharedEnd<N> {
    /// The ends of the first solid come before those of the second, in their order.
    #[inline(always)]
    fn rank(&self) -> usize {
        3 * self.ends[0] + self.ends[1]
    }
}

/// The ends of the stretch that two sides share, in the order in which they are named, and how many they are.
type Shared<N> = ([SharedEnd<N>; 2], usize);

impl<N: Real> Facing<'_, N> {
    #[inline(always)]
    pub(super) fn build(&self, prediction: N, out: &mut RawManifold<N, 2>) -> bool {
        let Some((ends, count)) = self.shared() else { return false };
        let mut found = Contacts::new(&self.meeting.normal, (self.distance, self.tolerance));
        for end in &ends[..count] {
            let candidate = self.candidate(end);
            if candidate.distance <= prediction + self.tolerance {
                let distance = min(candidate.distance, prediction);
                found.push(Candidate { distance, ..candidate });
            }
        }
        if !found.has_nearest() {
            let Some(witness) = self.witness() else { return false };
            if found.count > 0 {
                found.drop_namesakes(&witness);
            }
            found.push(witness);
        }
        found.settle(out);
        true
    }

    /// The ends of the stretch that the two sides share; none if one of the solids shows a corner. `None` where
    /// what lies within rounding decides.
    #[inline(always)]
    fn shared(&self) -> Option<Shared<N>> {
        let [first, second] = self.parts;
        let none = SharedEnd { place: N::ZERO, ends: [BETWEEN; 2] };
        let least = N::lit(8.0) * self.tolerance;
        let is_short1 = first.is_side && first.length().abs() <= least;
        if is_short1 || second.is_side && second.length().abs() <= least {
            return None;
        }
        if !(first.is_side && second.is_side) {
            return Some(([none; 2], 0));
        }
        if self.meeting.best.is_none() {
            return self.shared_at_corners();
        }
        let (low1, low2) = (first.low(), second.low());
        let low = self.shared_end([low1, low2], N::ONE)?;
        let high = self.shared_end([1 - low1, 1 - low2], -N::ONE)?;
        let length = high.place - low.place;
        if length <= least {
            return (length < -least).then_some(([none; 2], 0));
        }
        Some((if low.rank() > high.rank() { [high, low] } else { [low, high] }, 2))
    }

    /// Of two ends the one that is farther in, `inward` along the line of contact; both where they meet.
    #[inline(always)]
    fn shared_end(&self, ends: [usize; 2], inward: N) -> Option<SharedEnd<N>> {
        let [first, second] = self.parts;
        let (place1, place2) = (first.places[ends[0] & 1], second.places[ends[1] & 1]);
        let apart = (place1 - place2) * inward;
        if apart.abs() < N::lit(4.0) * self.tolerance {
            let are_one = apart.abs() <= N::lit(0.75) * self.tolerance;
            return are_one.then_some(SharedEnd { place: place1, ends });
        }
        Some(if apart > N::ZERO {
            SharedEnd { place: place1, ends: [ends[0], BETWEEN] }
        } else {
            SharedEnd { place: place2, ends: [BETWEEN, ends[1]] }
        })
    }

    /// [`Self::shared`] of sides that start from corners above each other: these, and where both lead the same
    /// way, the nearer of their other ends.
    #[inline(never)]
    fn shared_at_corners(&self) -> Option<Shared<N>> {
        let [first, second] = self.parts;
        let near =
            SharedEnd { place: first.places[first.near & 1], ends: [first.near, second.near] };
        let (far1, far2) = (1 - first.near, 1 - second.near);
        let (reach1, reach2) = (first.places[far1 & 1], second.places[far2 & 1]);
        if (reach1 < N::ZERO) != (reach2 < N::ZERO) {
            return Some(([near; 2], 1));
        }
        let inward = if reach1 < N::ZERO { N::ONE } else { -N::ONE };
        let far = self.shared_end([far1, far2], inward)?;
        Some((if far.ends[0] < first.near { [far, near] } else { [near, far] }, 2))
    }

    /// The contact at an end of the stretch.
    #[inline(always)]
    fn candidate(&self, end: &SharedEnd<N>) -> Candidate<N, 2> {
        let (share1, height1, id1) = self.reached(0, end);
        let (_, height2, id2) = self.reached(1, end);
        let lift1 = self.lift(0, end.place, height1);
        let lift2 = self.lift(1, end.place, height2);
        let point1 = self.core(end.ends[0], share1) + self.meeting.normal * lift1;
        let distance = max(height2 - height1 - lift1 - lift2, self.distance);
        Self::at(end.place, point1, distance, [id1, id2])
    }

    /// Where a solid is at an end of the stretch: how far along the side, how high, and what is there.
    #[inline(always)]
    fn reached(&self, which: usize, shared: &SharedEnd<N>) -> (N, N, FeatureId) {
        let (part, end) = (self.parts[which & 1], shared.ends[which & 1]);
        if end < BETWEEN {
            return (N::ZERO, part.heights[end & 1], part.end(end));
        }
        let share = part.share(shared.place);
        (share, part.heights[0] + part.rise() * share, part.id)
    }

    /// The point of the first solid's core at an end of its part, or that far between the ends.
    #[inline(always)]
    fn core(&self, end: usize, share: N) -> Point<N, 2> {
        let corners = &self.parts[0].corners;
        if end < BETWEEN {
            return self.meeting.corner(0, corners[end & 1]);
        }
        let from = self.meeting.corner(0, corners[0]);
        from + (self.meeting.corner(0, corners[1]) - from) * share
    }

    #[inline(always)]
    fn at(place: N, point1: Point<N, 2>, distance: N, features: [FeatureId; 2]) -> Candidate<N, 2> {
        let flat = Vector::<N, 2>::new(place, N::ZERO);
        Candidate { point1, distance, flat, features, kept_id: None }
    }

    /// How far the rounded surface of a solid is above a point of its core; see [`super::super::facet::Facet::lift`].
    #[inline(always)]
    fn lift(&self, which: usize, place: N, height: N) -> N {
        let radius = self.meeting.radii[which & 1];
        if radius <= N::ZERO {
            return N::ZERO;
        }
        let part = self.parts[which & 1];
        let (rise, length) = (part.rise(), part.length());
        let cosine = length.abs() / (length * length + rise * rise).sqrt();
        let down = if which == 0 { -height } else { height - self.meeting.gap };
        let away = place - part.places[part.near & 1];
        lifted_by((radius, cosine), (down + radius, radius), away * away)
    }

    /// The nearest pair of points, where no end of the stretch is; `None` where rounding decides.
    #[inline(never)]
    fn witness(&self) -> Option<Candidate<N, 2>> {
        let [first, second] = self.parts;
        let (core, place) = match self.meeting.best {
            Some((0, _)) => {
                let place = second.places[second.near & 1];
                let (low, high) = (first.places[first.low()], first.places[1 - first.low()]);
                (self.core(BETWEEN, first.share(place)), min(max(place, low), high))
            }
            _ => (self.core(first.near, N::ZERO), first.places[first.near & 1]),
        };
        let is_level =
            |part: &Part<N>| part.is_side && part.rise().abs() <= N::lit(4.0) * self.tolerance;
        if is_level(first) && is_level(second) {
            return None;
        }
        let features =
            [first.named_at(place, self.tolerance), second.named_at(place, self.tolerance)];
        let point1 = core + self.meeting.normal * self.meeting.radii[0];
        Some(Self::at(place, point1, self.distance, features))
    }
}

/// The points that are found: the two ends of a stretch and the witness, at most.
struct Contacts<N: Real> {
    normal: Vector<N, 2>,
    distance: N,
    tolerance: N,
    points: [Candidate<N, 2>; 3],
    count: usize,
}

impl<N: Real> Contacts<N> {
    #[inline(always)]
    fn new(normal: &Vector<N, 2>, (distance, tolerance): (N, N)) -> Self {
        let none = [FeatureId::Face(0); 2];
        let none = Facing::at(N::ZERO, Point::origin(), N::ZERO, none);
        Self { normal: *normal, distance, tolerance, points: [none; 3], count: 0 }
    }

    #[inline(always)]
    fn push(&mut self, candidate: Candidate<N, 2>) {
        if let Some(place) = self.points.get_mut(self.count) {
            *place = candidate;
            self.count += 1;
        }
    }

    /// One of the points is as near as the solids are, but for rounding.
    #[inline(always)]
    fn has_nearest(&self) -> bool {
        let level = self.distance + self.tolerance;
        self.points.iter().take(self.count).any(|point| point.distance <= level)
    }

    /// The nearest pair of points is in place of another of the same name; see [`super::super::add_witness`].
    #[inline(never)]
    fn drop_namesakes(&mut self, witness: &Candidate<N, 2>) {
        let is_shared = witness.features.iter().all(|id| matches!(id, FeatureId::Face(_)));
        let (old, count) = (self.points, core::mem::take(&mut self.count));
        for point in old.iter().take(count) {
            if is_shared || point.features != witness.features {
                self.push(*point);
            }
        }
    }

    /// Replaces the points of a manifold: in place where they are the old ones.
    #[inline(always)]
    fn settle(&mut self, out: &mut RawManifold<N, 2>) {
        out.normal = self.normal;
        let found = &mut self.points[..self.count.min(3)];
        let old = out.points.as_mut_slice();
        let is_same = |(point, found): (&RawPoint<N, 2>, &Candidate<N, 2>)| {
            point.feature1 == found.features[0] && point.feature2 == found.features[1]
        };
        let is_old = found.len() == old.len() && old.iter().zip(&*found).all(is_same);
        if !is_old || found.len() > 2 {
            return choose(found, (self.distance, self.tolerance), 2, out);
        }
        for (point, found) in old.iter_mut().zip(found) {
            (point.point1, point.distance) = (found.point1, found.distance);
        }
    }
}
