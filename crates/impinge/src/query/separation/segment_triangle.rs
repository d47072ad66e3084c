//! Segments and capsules against triangles in space.
//!
//! Where the segment stays on one side of the plane, the nearest point is its lower end, if that is over the
//! triangle, or lies on a side. Where it pierces the triangle, the shortest way out is along the normal or the
//! common perpendicular of the segment and a side. What is not proved by two points that lie as far apart as
//! supporting planes is left to the general algorithm.

use super::rod::{Parting, Rod, Verdict, noise, settled};
use super::segments::nearest_of_segments;
use super::{general, wrong_kinds};
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, cross, max, min};
use crate::query::Pair;
use crate::shape::{Kind, SupportMap, Triangle};

/// Triangles with a smaller ratio of their height to their longest side are left to the general algorithm.
const THIN: f64 = 1.0 / 256.0;

/// The separation of a segment or capsule from a triangle.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    let Kind::Triangle(triangle) = pair.second else { wrong_kinds(pair) };
    let ask = |rod: &Rod<'_, N>, most: N| match Sheet::new(rod, triangle) {
        Some(sheet) => sheet.verdict(most),
        None => Verdict::Undecided,
    };
    settled(pair, triangle.reach(), limit, ask, || general::of_flat_cores(pair, limit))
}

/// A triangle and the segment.
struct Sheet<'a, N: Real> {
    rod: &'a Rod<'a, N>,
    corners: [Vector<N, 3>; 3],
    /// From each corner to the next.
    sides: [Vector<N, 3>; 3],
    normal: Vector<N, 3>,
    /// How high the ends of the segment are over the plane.
    heights: [N; 2],
    /// How far they are inside of each side as seen along the normal, times its length.
    insides: [[N; 2]; 3],
}

impl<'a, N: Real> Sheet<'a, N> {
    /// `None` of a triangle that is thin or hardly larger than rounding.
    fn new(rod: &'a Rod<'a, N>, triangle: &Triangle<N, 3>) -> Option<Self> {
        let [a, b, c] = triangle.corners();
        let sides = [(b - a) * rod.shrink, (c - b) * rod.shrink, (a - c) * rod.shrink];
        let across = cross(&sides[0], &sides[1]);
        let area = across.norm();
        let longest = max(sides[0].norm_squared(), sides[1].norm_squared());
        let longest = max(longest, sides[2].norm_squared());
        // Written so that what is no number has no normal.
        let is_wide = area > N::lit(THIN) * longest && longest > N::lit(4096.0) * noise() * noise();
        if !is_wide {
            return None;
        }
        let normal = across / area;
        let corners = [a, b, c].map(|corner| corner.coords * rod.shrink);
        let heights = rod.ends.map(|end| normal.dot(&(end - corners[0])));
        let mut insides = [[N::ZERO; 2]; 3];
        for at in 0..3 {
            let inward = cross(&normal, &sides[at]);
            insides[at] = rod.ends.map(|end| inward.dot(&(end - corners[at])));
        }
        Some(Self { rod, corners, sides, normal, heights, insides })
    }

    /// Both ends are farther beyond one side than that.
    fn is_beside(&self, most: N) -> bool {
        // The normal of a triangle that is almost thin is off by some noise.
        let room = most + N::lit(128.0) * noise();
        (0..3).any(|at| {
            let outside = -max(self.insides[at][0], self.insides[at][1]);
            outside > N::ZERO && outside * outside > room * room * self.sides[at].norm_squared()
        })
    }

    fn verdict(&self, most: N) -> Verdict<N> {
        let [a, b] = self.heights;
        let is_below = a + b < N::ZERO;
        let sign = if is_below { -N::ONE } else { N::ONE };
        let low = usize::from(b * sign < a * sign);
        let height = self.heights[low] * sign;
        if height > most || self.is_beside(max(most, N::ZERO)) {
            return Verdict::Beyond;
        }
        let found = if height > N::ZERO {
            let is_level = (a - b).abs() <= noise();
            self.above(low, sign).or_else(|| self.nearest(if is_level { sign } else { N::ZERO }))
        } else if self.is_pierced() {
            self.deepest(low, sign)
        } else {
            self.nearest(N::ZERO)
        };
        found.map_or(Verdict::Undecided, Verdict::Parted)
    }

    /// How far along a vector the triangle reaches.
    fn level(&self, along: &Vector<N, 3>) -> N {
        let [a, b, c] = &self.corners;
        max(max(along.dot(a), along.dot(b)), along.dot(c))
    }

    /// The place at a share of the way along the segment is seen inside of all sides, but for rounding.
    fn is_over(&self, share: N) -> bool {
        self.insides
            .iter()
            .all(|&[from, to]| from * (N::ONE - share) + to * share >= -noise::<N>() * noise())
    }

    /// The segment crosses the plane within the triangle.
    fn is_pierced(&self) -> bool {
        let [a, b] = self.heights;
        let share = a / (a - b);
        // One that lies in the plane is not said to cross it.
        share >= N::ZERO && share <= N::ONE && self.is_over(share)
    }

    /// The answer along the normal, at an end that is over the triangle or below it.
    fn above(&self, end: usize, sign: N) -> Option<Parting<N>> {
        let (on_rod, height) = (self.rod.ends[end], self.heights[end]);
        let on_solid = on_rod - self.normal * height;
        let outward = self.normal * sign;
        let is_over = self.insides.iter().all(|ends| ends[end] >= -noise::<N>() * noise());
        is_over.then_some(Parting { outward, on_rod, on_solid, distance: height * sign })
    }

    /// The shortest way out of a triangle that is pierced; the end that is nearest to the plane is given.
    fn deepest(&self, low: usize, sign: N) -> Option<Parting<N>> {
        let (mut best, mut gap) = (None, self.heights[low] * sign + N::TWO * noise());
        for (at, side) in self.sides.iter().enumerate() {
            let across = cross(side, &self.rod.along);
            let length = across.norm();
            if length <= noise() {
                continue;
            }
            for outward in [across / length, -across / length] {
                let height = self.rod.low(&outward) - self.level(&outward);
                if height > gap {
                    (best, gap) = (Some((at, outward)), height);
                }
            }
        }
        let Some((at, outward)) = best else { return self.above(low, sign) };
        let points = self.points_beside(at);
        self.rod.proved(outward, self.level(&outward), points)
    }

    /// The nearest points of the segment and a side.
    fn points_beside(&self, side: usize) -> [Vector<N, 3>; 2] {
        let ends = [self.corners[side], self.corners[(side + 1) % 3]].map(Point::from);
        let (on_rod, on_side) = nearest_of_segments(&self.rod.ends.map(Point::from), &ends);
        [on_rod.coords, on_side.coords]
    }

    /// The nearest points of the two, which are apart, if they lie on a side. A `level` segment lies along the
    /// plane, on the side of this sign; of one that does not it is zero.
    ///
    /// The way from the nearest point of a side leads out of the triangle: a side that all of the segment is
    /// inside of has none, but at a corner, which is that of another side too.
    fn nearest(&self, level: N) -> Option<Parting<N>> {
        let (mut best, mut least) = (0, N::INFINITY);
        let mut points = [Vector::<N, 3>::zeros(); 2];
        let clear = N::lit(4.0) * noise();
        for side in (0..3)
            .filter(|&side: &usize| min(self.insides[side][0], self.insides[side][1]) <= clear)
        {
            let candidate = self.points_beside(side);
            let squared = (candidate[0] - candidate[1]).norm_squared();
            if squared < least {
                (best, least, points) = (side, squared, candidate);
            }
        }
        let away = points[0] - points[1];
        if level != N::ZERO {
            let outward = self.normal * level;
            let found = self.rod.proved(outward, self.level(&outward), points);
            if found.is_some() {
                return found;
            }
        }
        self.beside(best, &away)
            .and_then(|outward| self.rod.proved(outward, self.level(&outward), points))
    }

    /// The unit vector from the nearest point of a side to that of the segment: their common perpendicular,
    /// which is right to the last bits however near the points are, where the way off lies along it.
    fn beside(&self, side: usize, away: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let across = cross(&self.sides[side], &self.rod.along);
        let length = across.norm();
        if length > noise() {
            let across = across / length;
            let along = across.dot(away);
            if (away - across * along).norm_squared() <= noise::<N>() * noise() {
                return Some(if along < N::ZERO { -across } else { across });
            }
        }
        let length = away.norm();
        (length > noise()).then(|| away / length)
    }
}
