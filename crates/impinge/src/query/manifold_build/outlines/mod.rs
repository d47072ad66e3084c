//! Two solids of the plane with up to eight corners, rounded or not, in one go.
//!
//! As [`super::stretch`], which is the definition but for rounding: what separates them
//! ([`meeting`]) names the corners that are nearest, each solid shows the side at its corner that leans less,
//! or the corner alone, and the contact points are the ends of what the two sides share. What lies within
//! rounding of something else that would have another name, or is no usual number, is left to that.

use fearless_simd::Level;

use super::facet::lifted;
use super::frame::{Candidate, rounding};
use super::overlap::Candidates;
use super::{ManifoldRequest, Pair, RawManifold, choose};
use crate::math::{Point, Real, Vector, cross2, max, min};
use crate::query::separation::bare;
use crate::query::separation::meeting::{Meeting, meeting};
use crate::shape::{FACING_SINE_SQUARED, FeatureId, Geometry, Kind};

/// The squared sine of the lean up to which a segment shows itself; see [`super::facet::LEAST_COSINE`].
const SEGMENT_SINE_SQUARED: f64 = 0.75;

/// Builds the manifold of two solids; answers whether it did.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) -> bool {
    let (Some(names1), Some(names2)) = (Names::of(&pair.first), Names::of(&pair.second)) else {
        return false;
    };
    let tolerance = rounding(pair);
    // Two segments have lanes of their own, which give the bits of the general way.
    let are_segments = names1 == Names::Segment && names2 == Names::Segment;
    // So have two boxes their own separating axis, of which the last digit is another.
    let are_boxes = names1 == Names::Box && names2 == Names::Box;
    let is_left = are_segments || are_boxes || is_out_of_order(pair);
    let is_ordinary = request.sine <= N::ZERO && request.max_points > 1 && !is_left;
    if !(is_ordinary && tolerance.is_finite_number()) {
        return false;
    }
    let kinds = [&pair.first, &pair.second];
    let noise = N::lit(4.0) * tolerance;
    let Some(meeting) = meeting(Level::new(), kinds, &pair.pose12, noise) else { return false };
    let distance = meeting.gap - meeting.radii[0] - meeting.radii[1];
    if distance > request.prediction {
        out.points.clear();
        return true;
    }
    let parts = [(0, names1), (1, names2)]
        .map(|(which, names)| Part::of(&meeting, which, (names, tolerance)));
    let facing = Facing { meeting: &meeting, parts, distance, tolerance };
    facing.build(request.prediction, out)
}

/// Rounded solids are parted as what is within them is, whose order may be the opposite: of that the last digit
/// is another.
fn is_out_of_order<N: Real>(pair: &Pair<'_, N, 2>) -> bool {
    let [first, second] = [pair.first, pair.second].map(|kind| Geometry(bare(kind).0).kind());
    matches!(pair.second, Kind::Rounded(_)) && first > second
}

/// How the corners and sides of an outline are named.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Names {
    /// As they are numbered.
    Plain,
    /// Those of a triangle whose corners run clockwise.
    Clockwise,
    Box,
    Segment,
    /// A ball is a point swollen by its radius.
    Ball,
}

impl Names {
    /// `None` for solids without an outline, and for triangles that are hardly more than a line.
    fn of<N: Real>(kind: &Kind<'_, N, 2>) -> Option<Self> {
        Some(match kind {
            Kind::Ball(_) => Self::Ball,
            Kind::Segment(_) | Kind::Capsule(_) => Self::Segment,
            Kind::Cuboid(_) => Self::Box,
            Kind::Polytope(_) => Self::Plain,
            Kind::Triangle(triangle) => {
                let [a, b, c] = triangle.corners();
                let (side1, side2) = (b - a, c - a);
                let area = cross2(&side1, &side2);
                let squares = side1.norm_squared() + side2.norm_squared();
                let is_thin = area.abs() <= N::lit(1024.0) * N::EPSILON * squares;
                return (!is_thin).then_some(if area < N::ZERO {
                    Self::Clockwise
                } else {
                    Self::Plain
                });
            }
            Kind::Rounded(solid) => match solid.inner().0 {
                Kind::Rounded(_) | Kind::Capsule(_) | Kind::Ball(_) => return None,
                inner => return Self::of(&inner),
            },
            _ => return None,
        })
    }

    fn corner(self, number: usize) -> FeatureId {
        const BOX: [u32; 4] = [0, 1, 3, 2];
        const CLOCKWISE: [u32; 4] = [0, 2, 1, 1];
        match self {
            Self::Plain | Self::Segment => FeatureId::Vertex(small(number)),
            Self::Box => FeatureId::Vertex(BOX[number & 3]),
            Self::Clockwise => FeatureId::Vertex(CLOCKWISE[number & 3]),
            Self::Ball => FeatureId::Face(0),
        }
    }

    fn side(self, number: usize) -> FeatureId {
        const BOX: [u32; 4] = [3, 0, 2, 1];
        const CLOCKWISE: [u32; 4] = [2, 1, 0, 0];
        match self {
            Self::Plain => FeatureId::Face(small(number)),
            Self::Segment => FeatureId::Edge(0),
            Self::Ball => FeatureId::Face(0),
            Self::Box => FeatureId::Face(BOX[number & 3]),
            Self::Clockwise => FeatureId::Face(CLOCKWISE[number & 3]),
        }
    }

    /// The squared sine of the lean up to which a side is shown.
    fn most_lean<N: Real>(self) -> N {
        N::lit(if self == Self::Segment { SEGMENT_SINE_SQUARED } else { FACING_SINE_SQUARED })
    }
}

/// A number below eight.
#[expect(clippy::cast_possible_truncation, reason = "three bits are left")]
const fn small(number: usize) -> u32 {
    (number & 7) as u32
}

/// What a solid shows of itself: a side, or the corner at both of its ends.
struct Part<N: Real> {
    id: FeatureId,
    is_side: bool,
    /// In the order of the outline.
    ends: [End<N>; 2],
    /// The end that is nearest to the other solid.
    near: usize,
}

/// A corner seen along the normal: its place on the line of contact and its height above it, from the
/// farthest corner of the first solid.
#[derive(Clone, Copy)]
struct End<N: Real> {
    id: FeatureId,
    point: Point<N, 2>,
    place: N,
    height: N,
}

impl<N: Real> Part<N> {
    #[inline]
    fn of(meeting: &Meeting<N>, which: usize, (names, tolerance): (Names, N)) -> Self {
        match meeting.best {
            Some((best, side)) if best == which => Self::best(meeting, which, side, names),
            _ => Self::beside(meeting, which, (names, tolerance)),
        }
    }

    /// The side that is the best.
    fn best(meeting: &Meeting<N>, which: usize, side: usize, names: Names) -> Self {
        let next = meeting.next(which, side);
        let level = if which == 0 { N::ZERO } else { meeting.gap };
        let mut ends = [side, next].map(|corner| End::of(meeting, which, corner, names));
        (ends[0].height, ends[1].height) = (level, level);
        Self::side(names.side(side), ends, 0).in_order(names, side)
    }

    /// The side at the nearest corner that leans less, or the corner.
    fn beside(meeting: &Meeting<N>, which: usize, (names, tolerance): (Names, N)) -> Self {
        let corner = meeting.corners[which];
        let mut near = End::of(meeting, which, corner, names);
        near.height = if which == 0 { N::ZERO } else { meeting.gap };
        if names == Names::Ball {
            return Self { id: near.id, is_side: false, ends: [near; 2], near: 0 };
        }
        let (next, before) = (meeting.next(which, corner), meeting.previous(which, corner));
        let far = [next, before].map(|corner| meeting.corner(which, corner) - near.point);
        let [(rise1, squared1), (rise2, squared2)] =
            far.map(|side| (side.dot(&meeting.normal).powi(2), side.norm_squared()));
        let (lean1, lean2) = (rise1 * squared2, rise2 * squared1);
        // Of equal sides that of the lower number counts.
        let is_next = if corner > 0 { lean1 < lean2 } else { lean1 <= lean2 };
        let (rise, squared) = if is_next { (rise1, squared1) } else { (rise2, squared2) };
        let is_side = rise <= names.most_lean::<N>() * squared;
        if !is_side {
            // A segment that is seen end on has no corner that is the nearest for certain.
            let other = End::of(meeting, which, next, names);
            let is_end_on =
                names == Names::Segment && (other.place - near.place).abs() <= tolerance;
            let id = if is_end_on { names.side(corner) } else { near.id };
            return Self { id, is_side, ends: [near; 2], near: 0 };
        }
        if is_next {
            let far = End::of(meeting, which, next, names);
            Self::side(names.side(corner), [near, far], 0).in_order(names, corner)
        } else {
            let far = End::of(meeting, which, before, names);
            Self::side(names.side(before), [far, near], 1).in_order(names, before)
        }
    }

    fn side(id: FeatureId, ends: [End<N>; 2], near: usize) -> Self {
        Self { id, is_side: true, ends, near }
    }

    /// A segment has its ends in one order, from whichever hand it is seen.
    fn in_order(mut self, names: Names, side: usize) -> Self {
        if names == Names::Segment && side > 0 {
            self.ends.swap(0, 1);
            self.near = 1 - self.near;
        }
        self
    }

    fn near(&self) -> &End<N> {
        &self.ends[self.near]
    }

    /// From the first end to the second.
    fn length(&self) -> N {
        self.ends[1].place - self.ends[0].place
    }

    /// The index of the end with the smaller place.
    fn low(&self) -> usize {
        usize::from(self.length() < N::ZERO)
    }

    /// The point of the core at a place, and its height.
    fn at(&self, place: N) -> (Point<N, 2>, N) {
        let [from, to] = &self.ends;
        let share = min(max((place - from.place) / self.length(), N::ZERO), N::ONE);
        (
            from.point + (to.point - from.point) * share,
            from.height + (to.height - from.height) * share,
        )
    }

    /// The smallest part that holds a place.
    fn named_at(&self, place: N, tolerance: N) -> FeatureId {
        let is_near = |end: &&End<N>| (end.place - place).abs() <= N::TWO * tolerance;
        self.ends.iter().find(is_near).filter(|_| self.is_side).map_or(self.id, |end| end.id)
    }
}

impl<N: Real> End<N> {
    #[inline(always)]
    fn of(meeting: &Meeting<N>, which: usize, corner: usize, names: Names) -> Self {
        let (point, normal) = (meeting.corner(which, corner), &meeting.normal);
        let arm = point - meeting.corner(0, meeting.corners[0]);
        let tangent = Vector::<N, 2>::new(normal.y, -normal.x);
        Self { id: names.corner(corner), point, place: tangent.dot(&arm), height: normal.dot(&arm) }
    }
}

/// What the two solids show each other.
struct Facing<'a, N: Real> {
    meeting: &'a Meeting<N>,
    parts: [Part<N>; 2],
    distance: N,
    tolerance: N,
}

/// One end of the stretch that two sides share: an end of one of them, or of both.
struct SharedEnd<N> {
    place: N,
    /// Of the first solid and of the second, which end it is.
    ends: [Option<usize>; 2],
}

impl<N: Real> Facing<'_, N> {
    fn build(&self, prediction: N, out: &mut RawManifold<N, 2>) -> bool {
        let Some(shared) = self.shared() else { return false };
        let mut candidates = Candidates::new();
        for end in shared.iter().flatten() {
            let candidate = self.candidate(end);
            if candidate.distance <= prediction + self.tolerance {
                let distance = min(candidate.distance, prediction);
                candidates.push(Candidate { distance, ..candidate });
            }
        }
        let level = self.distance + self.tolerance;
        if !candidates.iter().any(|candidate| candidate.distance <= level) {
            let Some(witness) = self.witness() else { return false };
            let is_face = |id: &FeatureId| matches!(id, FeatureId::Face(_));
            let is_shared = witness.features.iter().all(is_face);
            candidates.retain(|other| is_shared || other.features != witness.features);
            candidates.push(witness);
        }
        out.normal = self.meeting.normal;
        settle(&mut candidates, (self.distance, self.tolerance), out);
        true
    }

    /// The ends of the stretch that the two sides share, in the order in which they are named; none if one of
    /// the solids shows a corner. `None` where what lies within rounding decides.
    fn shared(&self) -> Option<[Option<SharedEnd<N>>; 2]> {
        let [first, second] = &self.parts;
        let least = N::lit(8.0) * self.tolerance;
        let is_short = |part: &Part<N>| part.is_side && part.length().abs() <= least;
        if is_short(first) || is_short(second) {
            return None;
        }
        if !(first.is_side && second.is_side) {
            return Some([None, None]);
        }
        if self.meeting.best.is_none() {
            return self.shared_at_corners();
        }
        let (low1, low2) = (first.low(), second.low());
        let low = self.shared_end([low1, low2], N::ONE)?;
        let high = self.shared_end([1 - low1, 1 - low2], -N::ONE)?;
        let length = high.place - low.place;
        if length <= least {
            return (length < -least).then_some([None, None]);
        }
        let is_turned = match (low.ends, high.ends) {
            ([Some(low), _], [Some(high), _]) | ([None, Some(low)], [None, Some(high)]) => {
                low > high
            }
            ([None, _], [Some(_), _]) => true,
            _ => false,
        };
        Some(if is_turned { [Some(high), Some(low)] } else { [Some(low), Some(high)] })
    }

    /// Of two ends the one that is farther in, `inward` along the line of contact; both where they meet.
    fn shared_end(&self, ends: [usize; 2], inward: N) -> Option<SharedEnd<N>> {
        let places = [self.parts[0].ends[ends[0]].place, self.parts[1].ends[ends[1]].place];
        let apart = (places[0] - places[1]) * inward;
        if apart.abs() <= N::lit(0.75) * self.tolerance {
            return Some(SharedEnd { place: places[0], ends: ends.map(Some) });
        }
        if apart.abs() < N::lit(4.0) * self.tolerance {
            return None;
        }
        Some(if apart > N::ZERO {
            SharedEnd { place: places[0], ends: [Some(ends[0]), None] }
        } else {
            SharedEnd { place: places[1], ends: [None, Some(ends[1])] }
        })
    }

    /// [`Self::shared`] of sides that start from corners above each other: these, and where both lead the same
    /// way, the nearer of their other ends.
    fn shared_at_corners(&self) -> Option<[Option<SharedEnd<N>>; 2]> {
        let [first, second] = &self.parts;
        let near =
            SharedEnd { place: first.near().place, ends: [Some(first.near), Some(second.near)] };
        let [far1, far2] = [first, second].map(|part| 1 - part.near);
        let reach = [first.ends[far1].place, second.ends[far2].place];
        if (reach[0] < N::ZERO) != (reach[1] < N::ZERO) {
            return Some([Some(near), None]);
        }
        let inward = if reach[0] < N::ZERO { N::ONE } else { -N::ONE };
        let far = self.shared_end([far1, far2], inward)?;
        let is_turned = matches!(far.ends[0], Some(far) if far < first.near);
        Some(if is_turned { [Some(far), Some(near)] } else { [Some(near), Some(far)] })
    }

    /// The contact at an end of the stretch.
    fn candidate(&self, end: &SharedEnd<N>) -> Candidate<N, 2> {
        let [(point, height1, id1), (_, height2, id2)] = [0, 1].map(|which| {
            let part = &self.parts[which];
            end.ends[which].map_or_else(
                || {
                    let (point, height) = part.at(end.place);
                    (point, height, part.id)
                },
                |end| (part.ends[end].point, part.ends[end].height, part.ends[end].id),
            )
        });
        let lift1 = self.lift(0, end.place, height1);
        let lift2 = self.lift(1, end.place, height2);
        let point1 = point + self.meeting.normal * lift1;
        let distance = max(height2 - height1 - lift1 - lift2, self.distance);
        self.at(end.place, point1, distance, [id1, id2])
    }

    fn at(
        &self,
        place: N,
        point1: Point<N, 2>,
        distance: N,
        features: [FeatureId; 2],
    ) -> Candidate<N, 2> {
        let flat = Vector::<N, 2>::new(place, N::ZERO);
        Candidate { point1, distance, flat, features, kept_id: None }
    }

    /// How far the rounded surface of a solid is above a point of its core; see [`super::facet::Facet::lift`].
    #[inline]
    fn lift(&self, which: usize, place: N, height: N) -> N {
        let radius = self.meeting.radii[which];
        if radius <= N::ZERO {
            return N::ZERO;
        }
        let part = &self.parts[which];
        let rise = part.ends[1].height - part.ends[0].height;
        let length = part.length();
        let cosine = length.abs() / (length * length + rise * rise).sqrt();
        let down = if which == 0 { -height } else { height - self.meeting.gap };
        let away = Vector::<N, 2>::new(place - part.near().place, N::ZERO);
        lifted((radius, cosine), (down + radius, radius), &away)
    }

    /// The nearest pair of points, where no end of the stretch is; `None` where rounding decides.
    fn witness(&self) -> Option<Candidate<N, 2>> {
        let [first, second] = &self.parts;
        let (core, place) = match self.meeting.best {
            Some((0, _)) => {
                let place = second.near().place;
                let (low, high) =
                    (first.ends[first.low()].place, first.ends[1 - first.low()].place);
                (first.at(place).0, min(max(place, low), high))
            }
            _ => (first.near().point, first.near().place),
        };
        let is_level = |part: &Part<N>| {
            let rise = part.ends[1].height - part.ends[0].height;
            part.is_side && rise.abs() <= N::lit(4.0) * self.tolerance
        };
        if is_level(first) && is_level(second) {
            return None;
        }
        let features = [first, second].map(|part| part.named_at(place, self.tolerance));
        let point1 = core + self.meeting.normal * self.meeting.radii[0];
        Some(self.at(place, point1, self.distance, features))
    }
}

/// Replaces the points of a manifold: in place where they are the old ones.
fn settle<N: Real>(
    candidates: &mut Candidates<N, 2>,
    (distance, tolerance): (N, N),
    out: &mut RawManifold<N, 2>,
) {
    let is_old = candidates.len() == out.points.len()
        && candidates
            .iter()
            .zip(&out.points)
            .all(|(candidate, point)| candidate.features == [point.feature1, point.feature2]);
    if !is_old || candidates.len() > 2 {
        return choose(candidates, (distance, tolerance), 2, out);
    }
    for (point, candidate) in out.points.iter_mut().zip(candidates.iter()) {
        (point.point1, point.distance) = (candidate.point1, candidate.distance);
    }
}
