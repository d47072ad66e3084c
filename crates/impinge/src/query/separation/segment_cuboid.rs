//! Segments and capsules against boxes in space.
//!
//! The squared distance of a point from a box is a sum over the axes, so that along a segment its slope is
//! linear between the places where the segment crosses the planes of faces: the nearest place is found
//! between two of these. Where the two overlap, the separating axis test over three faces and three pairs of
//! edges is exact. What is not proved by two points that lie as far apart as supporting planes is left to
//! the general algorithm.

use super::rod::{Parting, Rod, Verdict, noise, settled};
use super::segments::nearest_of_segments;
use super::{general, wrong_kinds};
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, max, min};
use crate::query::Pair;
use crate::shape::{Kind, SupportMap};

/// The separation of a segment or capsule from a box.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let Kind::Cuboid(cuboid) = pair.second else { wrong_kinds(pair) };
    let ask = |rod: &Rod<'_, N>, most: N| {
        let half = cuboid.half_extents() * rod.shrink;
        Crate { rod, half }.verdict(most)
    };
    settled(pair, cuboid.reach(), limit, ask, || general::of_flat_cores(pair, limit))
}

/// A box and the segment.
struct Crate<'a, N: Real> {
    rod: &'a Rod<'a, N>,
    half: Vector<N, 3>,
}

impl<N: Real> Crate<'_, N> {
    fn verdict(&self, most: N) -> Verdict<N> {
        let (axis, sign, gap) = self.best_face();
        if gap > most {
            return Verdict::Beyond;
        }
        let found = if gap > N::ZERO {
            self.nearest()
        } else {
            match self.best_edge(gap + N::TWO * noise()) {
                None => self.at_face(axis, sign, gap),
                Some((_, _, gap)) if gap > N::ZERO => self.nearest(),
                Some((axis, outward, gap)) => self.at_edge(axis, &outward, gap),
            }
        };
        found.map_or(Verdict::Undecided, Verdict::Parted)
    }

    /// The axis and side of the face that the segment is highest above, and how high; the first of equals.
    fn best_face(&self) -> (usize, N, N) {
        let [a, b] = &self.rod.ends;
        let mut best = (0, N::ONE, -N::INFINITY);
        for axis in 0..3 {
            let above = min(a[axis], b[axis]) - self.half[axis];
            let below = -self.half[axis] - max(a[axis], b[axis]);
            if max(above, below) > best.2 {
                let sign = if above >= below { N::ONE } else { -N::ONE };
                best = (axis, sign, max(above, below));
            }
        }
        best
    }

    /// The axis of the edges that leave the largest gap, if it is larger than `least`, the unit vector along
    /// which they do, and the gap.
    fn best_edge(&self, least: N) -> Option<(usize, Vector<N, 3>, N)> {
        let (from, along) = (&self.rod.ends[0], &self.rod.along);
        let (mut best, mut bound) = (None, least);
        for (axis, one, other) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let (x, y) = (-along[other], along[one]);
            let height = x * from[one] + y * from[other];
            let reach = x.abs() * self.half[one] + y.abs() * self.half[other];
            let sine = (x * x + y * y).sqrt();
            // Written so that what is parallel to the axis, or no number, says nothing.
            let is_plain = sine > noise() && (height.abs() - reach) > bound * sine;
            if is_plain {
                let turned = if height < N::ZERO { -sine } else { sine };
                let mut outward = Vector::<N, 3>::zeros();
                (outward[one], outward[other]) = (x / turned, y / turned);
                bound = (height.abs() - reach) / sine;
                best = Some((axis, outward, bound));
            }
        }
        best
    }

    /// How far along a vector the box reaches.
    fn level(&self, along: &Vector<N, 3>) -> N {
        along[0].abs() * self.half[0]
            + along[1].abs() * self.half[1]
            + along[2].abs() * self.half[2]
    }

    /// The answer along the normal of a face that the segment reaches below.
    fn at_face(&self, axis: usize, sign: N, gap: N) -> Option<Parting<N>> {
        let [a, b] = &self.rod.ends;
        let climb = (b[axis] - a[axis]) * sign;
        let on_rod = if climb.abs() <= noise() {
            self.middle_over(axis)?
        } else if climb < N::ZERO {
            *b
        } else {
            *a
        };
        let room = noise::<N>();
        let is_over = (0..3).all(|at| at == axis || on_rod[at].abs() <= self.half[at] + room);
        let mut on_solid = on_rod;
        on_solid[axis] = self.half[axis] * sign;
        let outward = Vector::<N, 3>::ith(axis, sign);
        is_over.then_some(Parting { outward, on_rod, on_solid, distance: gap })
    }

    /// The middle of the part of the segment that lies over a face.
    fn middle_over(&self, face: usize) -> Option<Vector<N, 3>> {
        let (from, along) = (&self.rod.ends[0], &self.rod.along);
        let (mut first, mut last) = (N::ZERO, N::ONE);
        for axis in (0..3).filter(|&axis| axis != face) {
            if along[axis].abs() <= noise() {
                continue;
            }
            let [one, other] =
                [-self.half[axis], self.half[axis]].map(|side| (side - from[axis]) / along[axis]);
            (first, last) = (max(first, min(one, other)), min(last, max(one, other)));
        }
        (first <= last).then(|| self.rod.at((first + last) * N::HALF))
    }

    /// The answer along the common perpendicular of the segment and the edges along an axis.
    fn at_edge(&self, axis: usize, outward: &Vector<N, 3>, gap: N) -> Option<Parting<N>> {
        let mut ends = [Point::origin(); 2];
        for at in 0..3 {
            let side = if outward[at] < N::ZERO { -self.half[at] } else { self.half[at] };
            (ends[0][at], ends[1][at]) = (if at == axis { -side } else { side }, side);
        }
        let core = self.rod.ends.map(Point::from);
        let (on_rod, on_solid) = nearest_of_segments(&core, &ends);
        let [on_rod, on_solid] = [on_rod.coords, on_solid.coords];
        let aside = on_rod - on_solid - outward * gap;
        let is_across = aside.norm_squared() <= N::lit(16.0) * noise::<N>() * noise();
        is_across.then_some(Parting { outward: *outward, on_rod, on_solid, distance: gap })
    }

    /// The nearest points of the two, which are apart.
    fn nearest(&self) -> Option<Parting<N>> {
        let share = self.nearest_share();
        let on_rod = self.rod.at(share);
        let on_solid = on_rod.zip_map(&self.half, |x, half| min(max(x, -half), half));
        let away = on_rod - on_solid;
        let points = [on_rod, on_solid];
        let is_off = |axis: &usize| away[*axis].abs() > noise();
        let (count, axis) =
            (0..3).filter(is_off).fold((0, 0), |(count, _), axis| (count + 1, axis));
        if count == 1 {
            let sign = if away[axis] < N::ZERO { -N::ONE } else { N::ONE };
            let outward = Vector::<N, 3>::ith(axis, sign);
            let found = self.rod.proved(outward, self.half[axis], points);
            if found.is_some() {
                return found;
            }
        }
        let is_between = share > N::ZERO && share < N::ONE;
        let across = if is_between { self.perpendicular(&away) } else { None };
        let outward = across.or_else(|| {
            let length = away.norm();
            (length > noise()).then(|| away / length)
        })?;
        self.rod.proved(outward, self.level(&outward), points)
    }

    /// Of a way off that leads from an edge of the box, the direction perpendicular to it and the segment:
    /// right to the last bits however near the two are. `None` off a corner or a face, or where these are
    /// parallel.
    fn perpendicular(&self, away: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let (axis, one, other) = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
            .into_iter()
            .find(|&(axis, ..)| away[axis] == N::ZERO)?;
        if away[one] == N::ZERO || away[other] == N::ZERO {
            return None;
        }
        let along = &self.rod.along;
        let (x, y) = (-along[other], along[one]);
        let sine = (x * x + y * y).sqrt();
        if sine <= N::lit(1.0 / 64.0) * along[axis].abs() || sine <= noise() {
            return None;
        }
        let turned = if x * away[one] + y * away[other] < N::ZERO { -sine } else { sine };
        let mut outward = Vector::<N, 3>::zeros();
        (outward[one], outward[other]) = (x / turned, y / turned);
        Some(outward)
    }

    /// The share of the way along the segment at which it is nearest to the box.
    fn nearest_share(&self) -> N {
        let (from, along) = (&self.rod.ends[0], &self.rod.along);
        let slope = |share: N| {
            let at = self.rod.at(share);
            let part = |axis: usize| {
                let inside = min(max(at[axis], -self.half[axis]), self.half[axis]);
                along[axis] * (at[axis] - inside)
            };
            part(0) + part(1) + part(2)
        };
        let (mut low, mut high) = ((N::ZERO, slope(N::ZERO)), (N::ONE, slope(N::ONE)));
        if low.1 >= N::ZERO {
            return N::ZERO;
        }
        if high.1 <= N::ZERO {
            return N::ONE;
        }
        let sides =
            (0..3).flat_map(|axis| [-self.half[axis], self.half[axis]].map(|at| (axis, at)));
        for (axis, side) in sides {
            let share = (side - from[axis]) / along[axis];
            // Written so that what is no number is passed over.
            if share > low.0 && share < high.0 {
                let slope = slope(share);
                let end = if slope < N::ZERO { &mut low } else { &mut high };
                *end = (share, slope);
            }
        }
        low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1))
    }
}
