//! Outlines of up to eight vertices: their sides, and their vertices, all at once.
//!
//! The sides alone are tried first. Where their best normal leads to the nearest points, as it mostly does
//! ([`Facing::settled`]), the tips of sharp corners are not looked at. What is not usual is left to
//! [`super::polygon_polygon`]: more vertices, sides of no length, numbers that end, and nearest points that do not
//! meet the best axis.

use super::polygon_nearest::Facing;
use super::polygon_polygon::Axis;
use crate::convex::Separation;
use crate::math::lanes::{dot, either, highest_lane, load, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Matrix, Point, Pose, Real, Vector, Wide, cross2, max};
use crate::query::Pair;
use crate::shape::{Kind, Polytope, Segment, Triangle};

/// How many vertices are looked at side by side.
pub(super) const LANES: usize = 8;

/// A number for each vertex.
pub(super) type Row<N> = [N; LANES];

/// How the search ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict<N: Real> {
    /// The outlines are farther apart than the limit.
    Beyond,
    Found(Separation<N, 2>),
    /// The usual ways do not lead to an answer.
    Undecided,
}

/// The separation of two solids; the best axis may be known.
pub(super) fn between<N: Real>(
    level: Level,
    pair: &Pair<'_, N, 2>,
    known: Option<Axis<N>>,
    limit: N,
) -> Verdict<N> {
    with_lanes!(level, simd => search::<_, N, N::Lanes<_>>(simd, pair, known, limit))
}

#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pair: &Pair<'_, N, 2>,
    known: Option<Axis<N>>,
    limit: N,
) -> Verdict<N> {
    let Some(own) = Outline::<N, V>::of(simd, &pair.first) else { return Verdict::Undecided };
    let Some(other) = Outline::<N, V>::of(simd, &pair.second) else { return Verdict::Undecided };
    let other = other.placed(simd, &pair.pose12);
    let rounding = own.rounding + other.rounding;
    let noise = N::lit(4.0) * N::EPSILON * highest_lane(own.sizes().larger(other.sizes()));
    // Closures are not inlined into vector code.
    let sides = match known {
        Some(known) => known,
        None => match best_side(simd, &own, &other) {
            Some(sides) => sides,
            None => return Verdict::Undecided,
        },
    };
    // A lower bound: what it rejects by more than rounding is out of reach.
    let reach = limit + N::lit(16.0) * (noise + N::EPSILON * rounding);
    if sides.gap - rounding > reach {
        return Verdict::Beyond;
    }
    let outlines = [&own, &other];
    let cores = Facing::of(simd, outlines, &sides, noise).settled();
    let found = match cores {
        Some(cores) => Some(cores.rounded(own.rounding, other.rounding)),
        None => {
            let best = if known.is_some() { sides } else { best_axis(simd, &own, &other, sides) };
            if best.gap - rounding > reach {
                return Verdict::Beyond;
            }
            of_axis(simd, outlines, &best, noise)
        }
    };
    found.map_or(Verdict::Undecided, Verdict::Found)
}

/// The separation of two outlines whose best axis is known; `None` if that is not the one of the nearest
/// points.
#[inline(always)]
pub(super) fn of_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    outlines: [&Outline<N, V>; 2],
    best: &Axis<N>,
    noise: N,
) -> Option<Separation<N, 2>> {
    let cores = Facing::of(simd, outlines, best, noise).separation(simd)?;
    Some(cores.rounded(outlines[0].rounding, outlines[1].rounding))
}

/// A polygon in some frame.
pub(super) struct Outline<N: Real, V> {
    pub(super) vertices: [V; 2],
    /// Of a point anything.
    pub(super) normals: [V; 2],
    /// The same coordinates as numbers.
    pub(super) rows: [Row<N>; 2],
    pub(super) count: usize,
    has_sides: bool,
    pub(super) rounding: N,
}

impl<N: Real, V> Outline<N, V> {
    /// The outline of a solid in its own frame; `None` of other kinds and of polygons of more vertices, and where
    /// the length of a side is no usual number.
    #[inline(always)]
    pub(super) fn of<S: Simd>(simd: S, kind: &Kind<'_, N, 2>) -> Option<Self>
    where
        V: Wide<S, Scalar = N>,
    {
        match kind {
            Kind::Ball(ball) => {
                let zero = [V::all(simd, N::ZERO); 2];
                Some(Self::of_sides(zero, zero, 1, ball.radius()))
            }
            Kind::Segment(segment) => Self::of_segment(simd, segment, N::ZERO),
            Kind::Capsule(capsule) => Self::of_segment(simd, capsule.segment(), capsule.radius()),
            Kind::Triangle(triangle) => Self::of_triangle(simd, triangle),
            Kind::Cuboid(cuboid) => Some(Self::of_box(simd, cuboid.half_extents())),
            Kind::Polytope(polygon) => Self::of_polytope(simd, polygon),
            _ => None,
        }
    }

    #[inline(always)]
    pub(super) fn of_segment<S: Simd>(simd: S, segment: &Segment<N, 2>, radius: N) -> Option<Self>
    where
        V: Wide<S, Scalar = N>,
    {
        let [is_last, _] = later_lanes::<S, N, V>(simd);
        let a: [V; 2] = spread(simd, &segment.a().coords);
        let b: [V; 2] = spread(simd, &segment.b().coords);
        let (vertices, ends) = (either(is_last, &b, &a), either(is_last, &a, &b));
        Self::of_ends(simd, vertices, ends, 2, radius)
    }

    /// The corners may be given in either order.
    #[inline(always)]
    fn of_triangle<S: Simd>(simd: S, triangle: &Triangle<N, 2>) -> Option<Self>
    where
        V: Wide<S, Scalar = N>,
    {
        let [a, b, c] = triangle.corners();
        let is_clockwise = cross2(&(b - a), &(c - a)) < N::ZERO;
        let (b, c) = if is_clockwise { (c, b) } else { (b, c) };
        let [is_later, is_last] = later_lanes::<S, N, V>(simd);
        let a: [V; 2] = spread(simd, &a.coords);
        let b: [V; 2] = spread(simd, &b.coords);
        let c: [V; 2] = spread(simd, &c.coords);
        let vertices = either(is_last, &c, &either(is_later, &b, &a));
        let ends = either(is_last, &a, &either(is_later, &c, &b));
        Self::of_ends(simd, vertices, ends, 3, N::ZERO)
    }

    #[inline(always)]
    fn of_box<S: Simd>(simd: S, half: &Vector<N, 2>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let (no, yes) = (N::ZERO, N::ONE);
        let xs = V::load(simd, &[-yes, yes, yes, -yes, -yes, -yes, -yes, -yes]);
        let ys = V::load(simd, &[-yes, -yes, yes, yes, yes, yes, yes, yes]);
        let normals = [
            V::load(simd, &[-no, yes, no, -yes, -yes, -yes, -yes, -yes]),
            V::load(simd, &[-yes, no, yes, -no, -no, -no, -no, -no]),
        ];
        let vertices = [xs * V::all(simd, half.x), ys * V::all(simd, half.y)];
        Self::of_sides(vertices, normals, 4, N::ZERO)
    }

    #[inline(always)]
    fn of_polytope<S: Simd>(simd: S, polygon: &Polytope<N, 2>) -> Option<Self>
    where
        V: Wide<S, Scalar = N>,
    {
        let ([vertices], [planes]) = (polygon.blocks(), polygon.planes()) else { return None };
        let (vertices, normals) = (load(simd, vertices), load(simd, &planes.normals));
        Some(Self::of_sides(vertices, normals, polygon.vertices().len(), N::ZERO))
    }

    /// The outline of these vertices, of which the sides end there; `None` as above.
    #[inline(always)]
    fn of_ends<S: Simd>(
        simd: S,
        vertices: [V; 2],
        ends: [V; 2],
        count: usize,
        radius: N,
    ) -> Option<Self>
    where
        V: Wide<S, Scalar = N>,
    {
        let side = [ends[0] - vertices[0], ends[1] - vertices[1]];
        let squared = dot(&side, &side);
        let is_usual = squared.simd_gt(V::all(simd, N::MIN_POSITIVE.sqrt()))
            & squared.simd_lt(V::all(simd, N::MAX.sqrt()));
        if !is_usual.all_true() {
            return None;
        }
        let length = squared.sqrt();
        let normals = [side[1] / length, -(side[0] / length)];
        Some(Self::of_sides(vertices, normals, count, radius))
    }

    /// The outline of these vertices and normals of sides.
    #[inline(always)]
    fn of_sides<S: Simd>(vertices: [V; 2], normals: [V; 2], count: usize, radius: N) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let mut rows = [[N::ZERO; LANES]; 2];
        vertices[0].store(&mut rows[0]);
        vertices[1].store(&mut rows[1]);
        Self { vertices, normals, rows, count, has_sides: count > 1, rounding: radius }
    }

    /// The same outline seen from the frame in which its own has the given pose.
    #[inline(always)]
    pub(super) fn placed<S: Simd>(mut self, simd: S, pose: &Pose<N, 2>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let turned = self.turned(simd, &self.vertices, &pose.rotation);
        let at = &pose.translation;
        self.vertices = [turned[0] + V::all(simd, at.x), turned[1] + V::all(simd, at.y)];
        self.normals = self.turned(simd, &self.normals, &pose.rotation);
        self.vertices[0].store(&mut self.rows[0]);
        self.vertices[1].store(&mut self.rows[1]);
        self
    }

    #[inline(always)]
    fn turned<S: Simd>(&self, simd: S, v: &[V; 2], by: &Matrix<N, 2>) -> [V; 2]
    where
        V: Wide<S, Scalar = N>,
    {
        let row1 = [V::all(simd, by[(0, 0)]), V::all(simd, by[(0, 1)])];
        let row2 = [V::all(simd, by[(1, 0)]), V::all(simd, by[(1, 1)])];
        [dot(&row1, v), dot(&row2, v)]
    }

    #[inline(always)]
    pub(super) fn at(&self, vertex: usize) -> Point<N, 2> {
        Point::<N, 2>::new(self.rows[0][vertex], self.rows[1][vertex])
    }

    #[inline(always)]
    pub(super) fn next(&self, vertex: usize) -> usize {
        if vertex + 1 < self.count { vertex + 1 } else { 0 }
    }

    #[inline(always)]
    pub(super) fn previous(&self, vertex: usize) -> usize {
        if vertex > 0 { vertex - 1 } else { self.count - 1 }
    }

    /// For each vertex a length that its distance from the origin does not exceed, within a factor of 2.
    #[inline(always)]
    fn sizes<S: Simd>(&self) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        self.vertices[0].abs() + self.vertices[1].abs()
    }

    /// The greatest of these lengths.
    #[inline(always)]
    pub(super) fn size<S: Simd>(&self) -> N
    where
        V: Wide<S, Scalar = N>,
    {
        highest_lane(self.sizes())
    }

    /// How far the vertices lie along a direction.
    #[inline(always)]
    pub(super) fn along<S: Simd>(&self, simd: S, direction: &Vector<N, 2>) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        dot(&[V::all(simd, direction.x), V::all(simd, direction.y)], &self.vertices)
    }

    /// How far each side is along its normal.
    #[inline(always)]
    pub(super) fn offsets<S: Simd>(&self) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        dot(&self.normals, &self.vertices)
    }

    /// How far the outline reaches along each of eight directions.
    #[inline(always)]
    pub(super) fn reach<S: Simd>(&self, simd: S, directions: &[V; 2]) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        let mut most = V::all(simd, -N::INFINITY);
        // The last vertex fills the rest.
        let halves = if self.count > LANES / 2 { 2 } else { 1 };
        for half in 0..halves {
            for lane in 0..LANES / 2 {
                let vertex = (half * LANES / 2 + lane) & (LANES - 1);
                let at = [V::all(simd, self.rows[0][vertex]), V::all(simd, self.rows[1][vertex])];
                most = dot(directions, &at).larger(most);
            }
        }
        most
    }

    /// The directions half-way between the normals of the sides at each vertex, and where they count:
    /// where the angle is sharper than a right one.
    #[inline(always)]
    pub(super) fn tips<S: Simd>(&self, simd: S) -> ([V; 2], V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let mut before = [[N::ZERO; LANES + 1]; 2];
        for (row, normals) in before.iter_mut().zip(&self.normals) {
            normals.store(&mut row[1..]);
            row[0] = row[self.count.min(LANES)];
        }
        let before = [V::load(simd, &before[0][..LANES]), V::load(simd, &before[1][..LANES])];
        let after = &self.normals;
        let zero = V::all(simd, N::ZERO);
        let is_tip = dot(&before, after).simd_lt(zero);
        // Turned by a quarter: from normals to the directions of the sides.
        let tip = [-before[1] - -after[1], before[0] - after[0]];
        let length = dot(&tip, &tip).sqrt();
        ([tip[0] / length, tip[1] / length], is_tip)
    }
}

/// All lanes but the first, and all but the first two.
#[inline(always)]
fn later_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S) -> [V::Mask; 2] {
    let (no, yes) = (N::ZERO, N::ONE);
    let zero = V::all(simd, no);
    [
        V::load(simd, &[no, yes, yes, yes, yes, yes, yes, yes]).simd_gt(zero),
        V::load(simd, &[no, no, yes, yes, yes, yes, yes, yes]).simd_gt(zero),
    ]
}

/// The greatest of eight numbers, and the first lane that has it.
#[inline(always)]
pub(super) fn highest<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, numbers: V) -> (N, usize) {
    let mut lanes = [N::ZERO; LANES];
    numbers.store(&mut lanes);
    let [a, b, c, d, e, f, g, h] = lanes;
    let most = max(max(max(a, e), max(c, g)), max(max(b, f), max(d, h)));
    let is_most = numbers.simd_eq(V::all(simd, most)).to_bitmask();
    (most, (is_most.trailing_zeros() as usize).min(LANES - 1))
}

/// The side of one outline whose normal leaves the largest gap to another: the gap and the normal.
#[inline(always)]
fn best_side_of_one<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
) -> (N, Vector<N, 2>) {
    if !own.has_sides {
        return (-N::INFINITY, Vector::<N, 2>::zeros());
    }
    let back = [-own.normals[0], -own.normals[1]];
    let (gap, side) = highest(simd, -other.reach(simd, &back) - own.offsets());
    (gap, lane(&own.normals, side).coords)
}

/// The same of the tips; `None` of an outline without any.
#[inline(always)]
fn best_tip_of_one<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
) -> Option<(N, Vector<N, 2>)> {
    if !own.has_sides {
        return None;
    }
    let (tips, is_tip) = own.tips(simd);
    if !is_tip.any_true() {
        return None;
    }
    let none = V::all(simd, -N::INFINITY);
    let (gap, tip) = highest(simd, is_tip.select(gaps(simd, own, other, &tips), none));
    Some((gap, lane(&tips, tip).coords))
}

/// The gaps between two outlines along directions away from the first.
#[inline(always)]
fn gaps<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
    directions: &[V; 2],
) -> V {
    let back = [-directions[0], -directions[1]];
    -other.reach(simd, &back) - own.reach(simd, directions)
}

/// The direction of the largest gap among the normals of all sides, those of the first outline before those of
/// the second. `None` for two points.
#[inline(always)]
fn best_side<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
) -> Option<Axis<N>> {
    if !own.has_sides && !other.has_sides {
        return None;
    }
    let (first, second) = (best_side_of_one(simd, own, other), best_side_of_one(simd, other, own));
    Some(if second.0 > first.0 {
        Axis { gap: second.0, normal: -second.1 }
    } else {
        Axis { gap: first.0, normal: first.1 }
    })
}

/// The direction of the largest gap, where that among the normals of the sides is known.
#[inline(always)]
fn best_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
    mut best: Axis<N>,
) -> Axis<N> {
    if let Some((gap, tip)) = best_tip_of_one(simd, own, other)
        && gap > best.gap
    {
        best = Axis { gap, normal: tip };
    }
    if let Some((gap, tip)) = best_tip_of_one(simd, other, own)
        && gap > best.gap
    {
        best = Axis { gap, normal: -tip };
    }
    best
}

/// The vector in a lane.
#[inline(always)]
pub(super) fn lane<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    vectors: &[V; 2],
    lane: usize,
) -> Point<N, 2> {
    let mut rows = [[N::ZERO; LANES]; 2];
    vectors[0].store(&mut rows[0]);
    vectors[1].store(&mut rows[1]);
    Point::<N, 2>::new(rows[0][lane], rows[1][lane])
}
