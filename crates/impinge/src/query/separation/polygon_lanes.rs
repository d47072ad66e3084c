//! Outlines of up to eight vertices: their sides, and their vertices, all at once.
//!
//! The algorithm of [`super::polygon_polygon`], which defines the answers, bit for bit. What is not usual
//! is left to it: more vertices, sides of no length, numbers that end, and nearest points that do not
//! meet the best axis.

use super::polygon_nearest::nearest_points;
use super::polygon_polygon::Axis;
use crate::convex::Separation;
use crate::math::lanes::{dot, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Matrix, Point, Pose, Real, Vector, Wide, cross2, max, perp, unit};
use crate::shape::{Kind, Polytope, Segment, Triangle};

/// How many vertices are looked at side by side.
pub(super) const LANES: usize = 8;

/// A number for each vertex.
pub(in crate::query) type Row<N> = [N; LANES];

/// A convex polygon in its own frame, swollen by a rounding radius; its last vertex fills the rest.
pub(super) struct Polygon<N: Real> {
    vertices: [Row<N>; 2],
    sides: PolygonSides<N>,
    count: usize,
    rounding: N,
}

/// The sides, each at the vertex that it starts from.
enum PolygonSides<N: Real> {
    /// Their outward unit normals.
    Normals([Row<N>; 2]),
    /// Where they end.
    Ends([Row<N>; 2]),
    /// A point has none.
    None,
}

impl<N: Real> Polygon<N> {
    /// `None` for solids of other kinds and for polygons of more vertices.
    pub(super) fn of(kind: &Kind<'_, N, 2>) -> Option<Self> {
        Some(match kind {
            Kind::Ball(ball) => {
                let (zero, sides) = ([[N::ZERO; LANES]; 2], PolygonSides::None);
                Self { vertices: zero, sides, count: 1, rounding: ball.radius() }
            }
            Kind::Segment(segment) => Self::of_segment(segment, N::ZERO),
            Kind::Capsule(capsule) => Self::of_segment(capsule.segment(), capsule.radius()),
            Kind::Triangle(triangle) => Self::of_triangle(triangle),
            Kind::Cuboid(cuboid) => Self::of_box(cuboid.half_extents()),
            Kind::Polytope(polygon) => return Self::of_polytope(polygon),
            _ => return None,
        })
    }

    pub(super) fn of_segment(segment: &Segment<N, 2>, rounding: N) -> Self {
        let (a, b) = (segment.a(), segment.b());
        let row = |x: N, y: N| [x, y, y, y, y, y, y, y];
        let sides = PolygonSides::Ends([row(b.x, a.x), row(b.y, a.y)]);
        Self { vertices: [row(a.x, b.x), row(a.y, b.y)], sides, count: 2, rounding }
    }

    fn of_triangle(triangle: &Triangle<N, 2>) -> Self {
        let [a, b, c] = triangle.corners();
        let is_clockwise = cross2(&(b - a), &(c - a)) < N::ZERO;
        let (b, c) = if is_clockwise { (c, b) } else { (b, c) };
        let row = |x: N, y: N, z: N| [x, y, z, z, z, z, z, z];
        let vertices = [row(a.x, b.x, c.x), row(a.y, b.y, c.y)];
        let sides = PolygonSides::Ends([row(b.x, c.x, a.x), row(b.y, c.y, a.y)]);
        Self { vertices, sides, count: 3, rounding: N::ZERO }
    }

    fn of_box(half: &Vector<N, 2>) -> Self {
        let (x, y) = (half.x, half.y);
        let (zero, one) = (N::ZERO, N::ONE);
        let vertices = [[-x, x, x, -x, -x, -x, -x, -x], [-y, -y, y, y, y, y, y, y]];
        let normals = [
            [-zero, one, zero, -one, -one, -one, -one, -one],
            [-one, zero, one, -zero, -zero, -zero, -zero, -zero],
        ];
        Self { vertices, sides: PolygonSides::Normals(normals), count: 4, rounding: N::ZERO }
    }

    fn of_polytope(polygon: &Polytope<N, 2>) -> Option<Self> {
        let ([vertices], [planes]) = (polygon.blocks(), polygon.planes()) else { return None };
        let sides = PolygonSides::Normals(planes.normals);
        Some(Self {
            vertices: *vertices,
            sides,
            count: polygon.vertices().len(),
            rounding: N::ZERO,
        })
    }
}

/// How the search ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict<N: Real> {
    /// The outlines are farther apart than the limit.
    Beyond,
    Found(Separation<N, 2>),
    /// The usual ways do not lead to an answer.
    Undecided,
}

/// The separation of two polygons; the best axis may be known.
pub(super) fn between<N: Real>(
    level: Level,
    polygons: [&Polygon<N>; 2],
    pose12: &Pose<N, 2>,
    known: Option<Axis<N>>,
    limit: N,
) -> Verdict<N> {
    with_lanes!(level, simd => search::<_, N, N::Lanes<_>>(simd, polygons, pose12, known, limit))
}

#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [polygon1, polygon2]: [&Polygon<N>; 2],
    pose12: &Pose<N, 2>,
    known: Option<Axis<N>>,
    limit: N,
) -> Verdict<N> {
    let Some(own) = Outline::<N, V>::of(simd, polygon1) else { return Verdict::Undecided };
    let Some(other) = Outline::<N, V>::of(simd, polygon2) else { return Verdict::Undecided };
    let other = other.placed(simd, pose12);
    let rounding = own.rounding + other.rounding;
    let noise = N::lit(4.0) * N::EPSILON * max(own.size(simd), other.size(simd));
    let best = match known {
        Some(best) => best,
        None => match best_axis(simd, &own, &other) {
            Some(best) => best,
            None => return Verdict::Undecided,
        },
    };
    // A lower bound: what it rejects by more than rounding is out of reach.
    if best.gap - rounding > limit + N::lit(16.0) * (noise + N::EPSILON * rounding) {
        return Verdict::Beyond;
    }
    match of_axis(simd, [&own, &other], &best, noise) {
        Some(found) => Verdict::Found(found),
        None => Verdict::Undecided,
    }
}

/// The separation of two outlines whose best axis is known; `None` if that is not the one of the nearest
/// points.
#[inline(always)]
pub(super) fn of_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [own, other]: [&Outline<N, V>; 2],
    best: &Axis<N>,
    noise: N,
) -> Option<Separation<N, 2>> {
    let is_number = best.gap.is_finite_number();
    if !is_number {
        return None;
    }
    let cores = if best.gap <= N::ZERO {
        overlapping(simd, own, other, best, noise)
    } else {
        apart(simd, own, other, best, noise)?
    };
    Some(cores.rounded(own.rounding, other.rounding))
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
    /// `None` if the length of a side is no usual number.
    #[inline(always)]
    pub(super) fn of<S: Simd>(simd: S, polygon: &Polygon<N>) -> Option<Self>
    where
        V: Wide<S, Scalar = N>,
    {
        let Polygon { vertices: rows, ref sides, count, rounding } = *polygon;
        let vertices = [V::load(simd, &rows[0]), V::load(simd, &rows[1])];
        match sides {
            PolygonSides::Normals(normals) => {
                let normals = [V::load(simd, &normals[0]), V::load(simd, &normals[1])];
                Some(Self::of_sides(vertices, normals, count, rounding))
            }
            PolygonSides::None => Some(Self::of_sides(vertices, vertices, count, rounding)),
            PolygonSides::Ends(ends) => {
                let ends = [V::load(simd, &ends[0]), V::load(simd, &ends[1])];
                Self::of_ends(simd, vertices, ends, count, rounding)
            }
        }
    }

    /// The outline of these vertices, of which the sides end there; `None` as above.
    #[inline(always)]
    pub(super) fn of_ends<S: Simd>(
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
    pub(super) fn of_sides<S: Simd>(
        vertices: [V; 2],
        normals: [V; 2],
        count: usize,
        radius: N,
    ) -> Self
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
    fn at(&self, vertex: usize) -> Point<N, 2> {
        Point::<N, 2>::new(self.rows[0][vertex], self.rows[1][vertex])
    }

    #[inline(always)]
    fn next(&self, vertex: usize) -> usize {
        if vertex + 1 < self.count { vertex + 1 } else { 0 }
    }

    #[inline(always)]
    fn previous(&self, vertex: usize) -> usize {
        if vertex > 0 { vertex - 1 } else { self.count - 1 }
    }

    /// A length that no vertex exceeds in distance from the origin, within a factor of 2.
    #[inline(always)]
    pub(super) fn size<S: Simd>(&self, simd: S) -> N
    where
        V: Wide<S, Scalar = N>,
    {
        highest(simd, self.vertices[0].abs() + self.vertices[1].abs()).0
    }

    /// How far the vertices lie along a direction.
    #[inline(always)]
    fn along<S: Simd>(&self, simd: S, direction: &Vector<N, 2>) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        dot(&[V::all(simd, direction.x), V::all(simd, direction.y)], &self.vertices)
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

/// The best of the directions of one outline: the gap that it leaves to another, and the direction.
#[inline(always)]
fn best_of_one<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
) -> (N, Vector<N, 2>) {
    let gaps = gaps(simd, own, other, &own.normals);
    let (gap, side) = highest(simd, gaps);
    let (tips, is_tip) = own.tips(simd);
    if is_tip.any_true() {
        let none = V::all(simd, -N::INFINITY);
        let at_tips = is_tip.select(self::gaps(simd, own, other, &tips), none);
        let (tip_gap, tip) = highest(simd, at_tips);
        // The side at a vertex comes before its tip.
        if tip_gap > gap || tip_gap == gap && tip < side {
            return (tip_gap, lane(&tips, tip).coords);
        }
    }
    (gap, lane(&own.normals, side).coords)
}

/// The gaps between two outlines along directions away from the first.
#[inline(always)]
pub(super) fn gaps<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
    directions: &[V; 2],
) -> V {
    let back = [-directions[0], -directions[1]];
    -other.reach(simd, &back) - own.reach(simd, directions)
}

/// The direction of the largest gap among the normals of all sides and the tips: those of the first
/// outline come before those of the second. `None` for two points.
#[inline(always)]
fn best_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
) -> Option<Axis<N>> {
    if !own.has_sides && !other.has_sides {
        return None;
    }
    let none = (-N::INFINITY, Vector::<N, 2>::zeros());
    let first = if own.has_sides { best_of_one(simd, own, other) } else { none };
    let second = if other.has_sides { best_of_one(simd, other, own) } else { none };
    Some(if second.0 > first.0 {
        Axis { gap: second.0, normal: -second.1 }
    } else {
        Axis { gap: first.0, normal: first.1 }
    })
}

/// Outlines that touch or overlap.
#[inline(always)]
fn overlapping<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
    best: &Axis<N>,
    noise: N,
) -> Separation<N, 2> {
    let tangent = perp(&best.normal);
    let [low1, high1] = feature(simd, own, &best.normal, &tangent, noise);
    let [low2, high2] = feature(simd, other, &-best.normal, &tangent, noise);
    super::polygon_polygon::in_middle([low1, high1], [low2.0, high2.0], best)
}

/// The lowest and highest of the vertices that reach within `tolerance` of the farthest along a normal, as
/// measured along a tangent.
#[inline(always)]
fn feature<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    outline: &Outline<N, V>,
    normal: &Vector<N, 2>,
    tangent: &Vector<N, 2>,
    tolerance: N,
) -> [(N, Point<N, 2>); 2] {
    let (_, support) = highest(simd, outline.along(simd, normal));
    let farthest = outline.at(support);
    let below = [
        V::all(simd, farthest.x) - outline.vertices[0],
        V::all(simd, farthest.y) - outline.vertices[1],
    ];
    let across = [V::all(simd, normal.x), V::all(simd, normal.y)];
    let is_near = dot(&across, &below).simd_le(V::all(simd, tolerance));
    let along = outline.along(simd, tangent);
    let (high, most) = highest(simd, is_near.select(along, V::all(simd, -N::INFINITY)));
    let (low, least) = highest(simd, is_near.select(-along, V::all(simd, -N::INFINITY)));
    let middle = tangent.dot(&farthest.coords);
    // Of equals the farthest counts, then the first.
    [
        if -low == middle { (middle, farthest) } else { (-low, outline.at(least)) },
        if high == middle { (middle, farthest) } else { (high, outline.at(most)) },
    ]
}

/// Outlines that are apart along the best axis; `None` if that is not the one of the nearest points.
#[inline(always)]
fn apart<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
    best: &Axis<N>,
    noise: N,
) -> Option<Separation<N, 2>> {
    let (_, near1) = highest(simd, own.along(simd, &best.normal));
    let (_, near2) = highest(simd, other.along(simd, &-best.normal));
    let (around1, around2) = (around(own, near1), around(other, near2));
    let points = nearest_points::<S, N, V>(simd, &around1, &around2)?;
    let between = points.1 - points.0;
    let slack = N::lit(8.0) * noise;
    let beside = (between - best.normal * best.gap).norm();
    let direct = unit(&between).filter(|_| beside > noise);
    let mut axis = *best;
    if let Some((normal, length)) = direct {
        let high1 = highest(simd, own.along(simd, &normal)).0;
        let high2 = highest(simd, other.along(simd, &-normal)).0;
        if -high2 - high1 + slack >= best.gap {
            axis = Axis { gap: length, normal };
        }
    }
    let is_met = between.norm() - axis.gap <= N::lit(4.0) * noise;
    let (point1, point2) = points;
    is_met.then_some(Separation { distance: axis.gap, normal: axis.normal, point1, point2 })
}

/// A vertex between the one before and the one after.
#[inline(always)]
fn around<N: Real, V>(outline: &Outline<N, V>, vertex: usize) -> [Point<N, 2>; 3] {
    [outline.at(outline.previous(vertex)), outline.at(vertex), outline.at(outline.next(vertex))]
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
