//! Segments, triangles, boxes and polygons against each other in 2D, with or without a radius.
//!
//! The signed distance of two convex sets is the largest gap that any direction leaves between them
//! (negative if they overlap along all directions). If they overlap, a normal of one of their sides
//! has this largest gap. If they are apart, the gap is a concave function of the direction where it
//! is positive, so the nearest points lie on the sides next to the best normal, ends included.
//!
//! Eight sides are tried at a time, each against all vertices of the other solid. If the best
//! normal leads to the nearest points, as it does for most pairs ([`OutlinePair::clear_case`]), the
//! tips of sharp corners are skipped. The rest falls back to the [general
//! algorithm](crate::collide::separation::general): outlines with too many vertices, sides whose
//! squared length is close to underflow or overflow, and nearest points that do not lie along the
//! best axis.

use super::outline::{LANES, PolygonOutline, highest, lane};
use super::polygon_nearest::OutlinePair;
use crate::collide::Pair;
use crate::collide::separation::boxes::rectangle_axes::Rectangles;
use crate::collide::separation::general;
use crate::collide::separation::segments::segment_lanes;
use crate::collide::separation::shared_corner;
use crate::convex::Separation;
use crate::math::lanes::{load, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide, max, min, unit};
use crate::shape::Kind;

/// A unit direction from the first outline to the second, and the signed gap along it.
#[derive(Clone, Copy, Debug)]
pub(in crate::collide::separation) struct Axis<N: Real> {
    pub(in crate::collide::separation) gap: N,
    pub(in crate::collide::separation) normal: Vector<N, 2>,
}

/// Result of the search for the separation of two outlines.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OutlineResult<N: Real> {
    /// The outlines are farther apart than the limit.
    Beyond,
    Found(Separation<N, 2>),
    /// The kernel has no result; the general algorithm has to decide.
    Undecided,
}

/// Returns the separation of two outlines; `None` above `limit`.
///
/// In a tie, sides of the first solid come before sides of the second, each in their order. Two
/// coinciding points have the first axis of the first solid's frame as normal. Cost: the product of
/// the numbers of vertices.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 2>,
    limit: N,
) -> Option<Separation<N, 2>> {
    if let Some(found) = segment_lanes::separation(pair) {
        return Some(found).filter(|found| found.distance <= limit);
    }
    separation_of_outlines(pair, limit)
}

/// Computes [`separation`] without the closed form for two segments.
pub(in crate::collide::separation) fn separation_of_outlines<N: Real>(
    pair: &Pair<'_, N, 2>,
    limit: N,
) -> Option<Separation<N, 2>> {
    match between(Level::new(), pair, limit) {
        OutlineResult::Beyond => None,
        OutlineResult::Found(found) => Some(shared_corner::with_shared_corner(pair, found))
            .filter(|found| found.distance <= limit),
        OutlineResult::Undecided => general::separation(pair, limit),
    }
}

/// Runs [`search`] with the instruction set `level`, on which the result does not depend.
fn between<N: Real>(level: Level, pair: &Pair<'_, N, 2>, limit: N) -> OutlineResult<N> {
    let known = known_axis(pair);
    with_lanes!(level, simd => search::<_, N, N::Lanes<_>>(simd, pair, known, limit))
}

/// Returns the best axis of two boxes, computed by [`Rectangles`]; `None` for other kinds.
fn known_axis<N: Real>(pair: &Pair<'_, N, 2>) -> Option<Axis<N>> {
    let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (&pair.first, &pair.second) else {
        return None;
    };
    let (half1, half2) = (*cuboid1.half_extents(), *cuboid2.half_extents());
    Some(Rectangles { half1, half2, pose12: pair.pose12 }.best_axis())
}

/// Searches for the axis with the largest gap and computes the separation from it. Tries the
/// normals of sides and, if these do not decide, the tips of corners. If `known` is `Some`, it is
/// the axis, and no other is tried.
#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pair: &Pair<'_, N, 2>,
    known: Option<Axis<N>>,
    limit: N,
) -> OutlineResult<N> {
    let Some(own) = PolygonOutline::of::<S, V>(simd, &pair.first) else {
        return OutlineResult::Undecided;
    };
    let Some(other) = PolygonOutline::of::<S, V>(simd, &pair.second) else {
        return OutlineResult::Undecided;
    };
    let other = other.placed::<S, V>(simd, &pair.pose12);
    let outlines = [&own, &other];
    let rounding = own.rounding + other.rounding;
    let rounding_error =
        N::lit(4.0) * N::EPSILON * max(own.size::<S, V>(simd), other.size::<S, V>(simd));
    // No closure is used here, because closures are not inlined into vector code.
    let sides = match known {
        Some(known) => known,
        None => best_side::<S, N, V>(simd, &own, &other),
    };
    // The gap is a lower bound: beyond the limit by more than rounding it rejects the pair.
    let max_gap = limit + N::lit(16.0) * (rounding_error + N::EPSILON * rounding);
    if sides.gap - rounding > max_gap {
        return OutlineResult::Beyond;
    }
    let outlines_along = OutlinePair::of::<S, V>(simd, outlines, &sides, rounding_error);
    let found = match outlines_along.clear_case() {
        Some(cores) => Some(cores.rounded(own.rounding, other.rounding)),
        None => {
            let is_known = known.is_some();
            let best = if is_known { sides } else { best_axis::<S, N, V>(simd, outlines, sides) };
            if best.gap - rounding > max_gap {
                return OutlineResult::Beyond;
            }
            of_axis::<S, N, V>(simd, outlines, &best, rounding_error)
        }
    };
    found.map_or(OutlineResult::Undecided, OutlineResult::Found)
}

/// Returns the separation of two outlines along their best axis; `None` if the axis is not the
/// direction of the nearest points.
#[inline(always)]
pub(in crate::collide::separation) fn of_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    outlines: [&PolygonOutline<N>; 2],
    best: &Axis<N>,
    rounding_error: N,
) -> Option<Separation<N, 2>> {
    let outlines_along = OutlinePair::of::<S, V>(simd, outlines, best, rounding_error);
    let cores = outlines_along.separation::<S, V>(simd)?;
    Some(cores.rounded(outlines[0].rounding, outlines[1].rounding))
}

/// Returns the normal of a side with the largest gap; in a tie, the side of the first outline wins.
/// For two points, the direction between them, or the x axis if they coincide.
#[inline(always)]
fn best_side<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &PolygonOutline<N>,
    other: &PolygonOutline<N>,
) -> Axis<N> {
    if own.is_point() && other.is_point() {
        let between = other.at(0) - own.at(0);
        let x = (Vector::<N, 2>::x(), N::ZERO);
        let (normal, _) = unit(&between).unwrap_or(x);
        return Axis { gap: normal.dot(&between), normal };
    }
    let first = best_side_of_one::<S, N, V>(simd, own, other);
    let second = best_side_of_one::<S, N, V>(simd, other, own);
    if second.gap > first.gap { Axis { gap: second.gap, normal: -second.normal } } else { first }
}

/// Returns the normal of a side of `own` with the largest gap to `other`; the first side wins a
/// tie. A point has no sides: its gap is minus infinity.
#[inline(always)]
fn best_side_of_one<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &PolygonOutline<N>,
    other: &PolygonOutline<N>,
) -> Axis<N> {
    let mut best = Axis { gap: -N::INFINITY, normal: Vector::<N, 2>::zeros() };
    if own.is_point() {
        return best;
    }
    for (number, block) in own.blocks().iter().enumerate() {
        let [x, y]: [V; 2] = load(simd, &block.normals);
        let [at_x, at_y]: [V; 2] = load(simd, &block.vertices);
        let offsets = x * at_x + y * at_y;
        let (gap, side) = highest(simd, -other.extent(simd, &[-x, -y]) - offsets);
        if gap > best.gap {
            best = Axis { gap, normal: own.normal(number * LANES + side) };
        }
    }
    best
}

/// Returns the direction with the largest gap among `best`, which is the best normal of a side, and
/// the tips of both outlines; `best` wins a tie.
#[inline(always)]
fn best_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [own, other]: [&PolygonOutline<N>; 2],
    mut best: Axis<N>,
) -> Axis<N> {
    if let Some(tip) = best_tip_of_one::<S, N, V>(simd, own, other)
        && tip.gap > best.gap
    {
        best = tip;
    }
    if let Some(tip) = best_tip_of_one::<S, N, V>(simd, other, own)
        && tip.gap > best.gap
    {
        best = Axis { gap: tip.gap, normal: -tip.normal };
    }
    best
}

/// Returns the tip of `own` with the largest gap to `other`; the first tip wins a tie. `None`
/// without tips.
#[inline(always)]
fn best_tip_of_one<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &PolygonOutline<N>,
    other: &PolygonOutline<N>,
) -> Option<Axis<N>> {
    let mut best: Option<Axis<N>> = None;
    let none = V::all(simd, -N::INFINITY);
    let blocks = if own.is_point() { 0 } else { own.blocks().len() };
    for block in 0..blocks {
        let (tips, is_tip) = own.tips::<S, V>(simd, block);
        if !is_tip.any_true() {
            continue;
        }
        let gaps = -other.extent(simd, &[-tips[0], -tips[1]]) - own.extent(simd, &tips);
        let (gap, tip) = highest(simd, is_tip.select(gaps, none));
        if best.is_none_or(|best| gap > best.gap) {
            best = Some(Axis { gap, normal: lane(&tips, tip).coords });
        }
    }
    best
}

/// Returns the separation at the middle of the overlap interval of two features. `low1` and `high1`
/// are the ends of the first feature with their coordinates along the tangent, `low2` and `high2`
/// the coordinates of the ends of the second.
pub(in crate::collide::separation) fn in_middle<N: Real>(
    [low1, high1]: [(N, Point<N, 2>); 2],
    [low2, high2]: [N; 2],
    best: &Axis<N>,
) -> Separation<N, 2> {
    let middle = (max(low1.0, low2) + min(high1.0, high2)) * N::HALF;
    let length = high1.0 - low1.0;
    let share = if length > N::ZERO { (middle - low1.0) / length } else { N::ZERO };
    let point1 = low1.1 + (high1.1 - low1.1) * max(min(share, N::ONE), N::ZERO);
    let point2 = point1 + best.normal * best.gap;
    Separation { distance: best.gap, normal: best.normal, point1, point2 }
}

#[cfg(test)]
pub(in crate::collide::separation) mod tests {
    use super::*;
    use crate::math::{Matrix, Pose};
    use crate::shape::{Ball, Capsule, ConvexPolygon, Cuboid, Segment, Shape, Triangle};

    fn p(x: f64, y: f64) -> Point<f64, 2> {
        Point::<f64, 2>::new(x, y)
    }

    fn of(
        shape1: &dyn Shape<f64, 2>,
        shape2: &dyn Shape<f64, 2>,
        x: f64,
        y: f64,
    ) -> Separation<f64, 2> {
        let pose12 = Pose::from_translation(Vector::<f64, 2>::new(x, y));
        let pair = Pair { first: shape1.geometry().0, second: shape2.geometry().0, pose12 };
        separation(&pair, f64::INFINITY).expect("nothing is beyond infinity")
    }

    #[test]
    fn crossing_segments_have_a_depth() {
        let flat = Segment::new(p(-3.0, 0.0), p(3.0, 0.0));
        let upright = Segment::new(p(0.0, -1.0), p(0.0, 2.0));
        let found = of(&flat, &upright, 0.0, 0.0);
        assert_eq!((found.distance, found.normal.y), (-1.0, 1.0), "up by one");
        assert_eq!(found.point1, p(0.0, 0.0), "on the flat one");
        assert_eq!(found.point2, p(0.0, -1.0), "the low end of the upright one");
    }

    #[test]
    fn segments_in_a_row() {
        let segment = Segment::new(p(-1.0, 0.0), p(1.0, 0.0));
        let apart = of(&segment, &segment, 5.0, 0.0);
        assert_eq!((apart.distance, apart.normal.x), (3.0, 1.0), "end to end");
        let over = of(&segment, &segment, 1.0, 0.0);
        assert_eq!((over.distance, over.normal.x), (0.0, 0.0), "they leave sideways");
        assert_eq!(over.point1, p(0.5, 0.0), "in the middle of the overlap");
    }

    #[test]
    fn boxes_side_by_side_corner_to_corner_and_deep() {
        let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 2.0));
        let side = of(&cuboid, &cuboid, 3.0, 1.0);
        assert_eq!((side.distance, side.normal.x), (1.0, 1.0), "side by side");
        let corner = of(&cuboid, &cuboid, 5.0, 8.0);
        assert_eq!((corner.distance, corner.point1), (5.0, p(1.0, 2.0)), "3 out and 4 up");
        let deep = of(&cuboid, &cuboid, -0.5, 1.0);
        assert_eq!((deep.distance, deep.normal.x), (-1.5, -1.0), "back to the left");
        assert_eq!(deep.point1, p(-1.0, 0.5), "in the middle of what the sides share");
    }

    #[test]
    fn triangle_in_either_order_and_capsule() {
        let capsule = Capsule::<f64, 2>::new(1.0, 0.25);
        for corners in
            [[p(0.0, 0.0), p(4.0, 0.0), p(0.0, 3.0)], [p(0.0, 3.0), p(4.0, 0.0), p(0.0, 0.0)]]
        {
            let [a, b, c] = corners;
            // The right end of the capsule's lower ball is one unit left of the triangle's side.
            let found = of(&capsule, &Triangle::new(a, b, c), 1.25, -1.0);
            assert_eq!((found.distance, found.normal.x), (1.0, 1.0), "beside the upright side");
        }
    }

    #[test]
    fn a_polygon_pokes_and_swallows() {
        let corners = [p(2.0, 0.0), p(0.0, 1.0), p(-2.0, 0.0), p(0.0, -1.0)];
        let diamond = ConvexPolygon::new(&corners);
        let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0));
        let poked = of(&cuboid, &diamond, 2.5, 0.25);
        assert_eq!((poked.distance, poked.normal.x), (-0.5, 1.0), "by its left tip");
        assert_eq!(poked.point1, p(1.0, 0.25), "the side above the tip");
        let ball = Ball::new(0.5);
        let inside = of(&ball, &diamond, 0.0, 0.0);
        let expected = -0.5 - 2.0 / 5.0_f64.sqrt();
        assert!((inside.distance - expected).abs() < 1e-15, "to a side and beyond");
    }

    /// Asserts, for random pairs from [`solid_of`] except two balls and on each instruction set,
    /// that the search has the distance of the general algorithm up to rounding, and points that
    /// face each other along the normal; and that it decides more than nine tenths of the pairs.
    fn eight_at_a_time<N: Real>(seed: u64) {
        use crate::collide::separation::hulls::tests::Random;
        let random = &mut Random(seed);
        let (mut decided, mut overlapping, mut count) = (0, 0, 0);
        for round in 0..3000 {
            let kinds = [random.pick(6), random.pick(6)];
            if kinds == [0, 0] {
                continue;
            }
            let shapes = kinds.map(|kind| solid_of::<N>(random, kind));
            let turn = random.turn::<N>().rotation;
            let size = [1.0_f64, 1e-3, 1e3][round % 3];
            let angle = Vector::<N, 2>::new(turn.m11, turn.m21);
            let (cosine, sine) = (angle.normalize().x, angle.normalize().y);
            let rotation = Matrix::<N, 2>::new(cosine, -sine, sine, cosine);
            let translation = random.vector::<N>().xy() * N::lit(1.5 * size.min(1.0));
            let pose12 = Pose { rotation, translation };
            let [first, second] = [&shapes[0], &shapes[1]].map(|shape| shape.geometry().0);
            let pair = Pair { first, second, pose12 };
            let expected = general::separation(&pair, N::INFINITY);
            let expected = expected.expect("nothing is beyond infinity");
            for level in Level::available() {
                let found = between(level, &pair, N::INFINITY);
                count += 1;
                if let OutlineResult::Found(found) = found {
                    let what = || format!("{found:?} not {expected:?}: {kinds:?} {pose12:?}");
                    let close = N::lit(64.0) * N::EPSILON;
                    assert!((found.distance - expected.distance).abs() <= close, "{}", what());
                    let offset = found.point2 - found.point1 - found.normal * found.distance;
                    assert!(offset.norm() <= close, "the normal leads there: {}", what());
                    decided += 1;
                    overlapping += usize::from(found.distance < N::ZERO);
                }
            }
        }
        assert!(decided * 10 > count * 9, "{decided} of {count} are decided");
        assert!(overlapping * 4 > decided, "{overlapping} of {decided} overlap");
    }

    /// Draws a ball, a segment, a capsule, a triangle, a box or a polygon, selected by `kind`.
    pub(in crate::collide::separation) fn solid_of<N: Real>(
        random: &mut crate::collide::separation::hulls::tests::Random,
        kind: usize,
    ) -> Box<dyn Shape<N, 2>> {
        let half = random.vector::<N>().xy().abs();
        // Half of the cases lie on a grid, which gives parallel sides and ties.
        let on_grid = random.pick(2) == 0;
        let mut point = || {
            let point = random.vector::<N>().xy();
            let rounded = point.map(|x| (x * N::lit(4.0)).round() * N::lit(0.25));
            Point::from(if on_grid { rounded } else { point })
        };
        let [a, b, c] = [point(), point(), point()];
        match kind {
            0 => Box::new(Ball::new(half.x)),
            1 => Box::new(Segment::new(a, b)),
            2 => Box::new(Capsule::<N, 2>::new(half.x, half.y)),
            3 => Box::new(Triangle::new(a, b, c)),
            4 => Box::new(Cuboid::new(half)),
            _ => {
                let points: Vec<_> = (0..30).map(|_| point()).collect();
                match ConvexPolygon::try_from_points(&points) {
                    Ok(polygon) => Box::new(polygon),
                    Err(_) => Box::new(Cuboid::new(half)),
                }
            }
        }
    }

    #[test]
    fn all_vertices_at_once_are_as_far_apart() {
        eight_at_a_time::<f32>(7);
        eight_at_a_time::<f64>(8);
    }

    #[test]
    fn where_numbers_end_there_is_no_separation() {
        let cuboid = Cuboid::new(Vector::<f32, 2>::new(1.0, 1.0));
        for bad in [f32::NAN, f32::INFINITY] {
            let mut pose12 = Pose::<f32, 2>::identity();
            pose12.translation.x = bad;
            let kind = cuboid.geometry().0;
            let pair = Pair { first: kind, second: kind, pose12 };
            assert_eq!(separation(&pair, 1.0), None, "{bad}");
        }
    }

    #[test]
    fn a_flat_triangle_is_a_segment() {
        let line = Triangle::new(p(0.0, 0.0), p(2.0, 0.0), p(1.0, 0.0));
        let found = of(&line, &line, 5.0, 0.0);
        assert_eq!((found.distance, found.normal.x), (3.0, 1.0), "in a row");
        let point = Triangle::new(p(0.0, 0.0), p(0.0, 0.0), p(0.0, 0.0));
        assert_eq!(of(&point, &point, 3.0, 4.0).distance, 5.0, "points");
        assert_eq!(of(&point, &point, 0.0, 0.0).normal, Vector::<f64, 2>::x(), "at one position");
    }
}
