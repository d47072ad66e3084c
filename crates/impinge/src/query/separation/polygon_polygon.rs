//! Segments, triangles, boxes and polygons among themselves in the plane, rounded or not.
//!
//! The signed distance of two convex sets is the largest gap that any direction leaves between them
//! (negative where every direction finds them overlapping). Where they overlap, a normal of one of
//! their sides attains it. Where they are apart, the gap is a concave function of the direction
//! while it is positive, so that the nearest points are ends of, or lie on, the sides next to the
//! best normal.

use super::outline::{Outline, Reach};
use super::polygon_lanes::{self, Verdict};
use super::rectangle_axes::Rectangles;
use super::segments::nearest_of_ends;
use crate::convex::Separation;
use crate::math::simd::Level;
use crate::math::{Point, Real, Vector, max, min, perp, unit};
use crate::query::Pair;
use crate::shape::Kind;

/// The separation of two outlines.
///
/// Equal gaps: the sides of the first solid come before those of the second, in their order. Points
/// at one place are parted along the first axis of the first solid's frame. Cost: the product of
/// the numbers of vertices.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 2>, limit: N) -> Option<Separation<N, 2>> {
    let known = known_axis(pair);
    match polygon_lanes::between(Level::new(), pair, known, limit) {
        Verdict::Beyond => None,
        Verdict::Found(found) => Some(found).filter(|found| found.distance <= limit),
        Verdict::Undecided => of_outlines(pair, known, limit),
    }
}

/// The best axis of two boxes, which have their own way to it.
fn known_axis<N: Real>(pair: &Pair<'_, N, 2>) -> Option<Axis<N>> {
    let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (&pair.first, &pair.second) else {
        return None;
    };
    let (half1, half2) = (*cuboid1.half_extents(), *cuboid2.half_extents());
    Some(Rectangles { half1, half2, pose12: pair.pose12 }.best_axis())
}

/// [`separation`] of any outlines; the best axis may be known.
fn of_outlines<N: Real>(
    pair: &Pair<'_, N, 2>,
    known: Option<Axis<N>>,
    limit: N,
) -> Option<Separation<N, 2>> {
    let outline1 = Outline::of(pair, &pair.first);
    let outline2 = Outline::of(pair, &pair.second).placed(&pair.pose12);
    let rounding = outline1.rounding + outline2.rounding;
    let noise = N::lit(4.0) * N::EPSILON * max(outline1.reach(), outline2.reach());
    let best = known.unwrap_or_else(|| best_axis(&outline1, &outline2));
    // A lower bound: what it rejects by more than rounding is out of reach.
    if best.gap - rounding > limit + N::lit(16.0) * (noise + N::EPSILON * rounding) {
        return None;
    }
    let cores = if best.gap <= N::ZERO {
        overlapping(&outline1, &outline2, &best, noise)
    } else {
        apart(&outline1, &outline2, &best, noise)
    };
    let found = cores.rounded(outline1.rounding, outline2.rounding);
    (found.distance <= limit).then_some(found)
}

/// A direction from the first outline to the second and the gap that it leaves between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis<N: Real> {
    pub(super) gap: N,
    pub(super) normal: Vector<N, 2>,
}

/// The gap between two outlines along a direction.
fn axis<N: Real>(outline1: &Outline<N>, outline2: &Outline<N>, normal: Vector<N, 2>) -> Axis<N> {
    Axis { gap: -outline2.height(&-normal) - outline1.height(&normal), normal }
}

/// The direction of the largest gap among the normals of all sides and the tips.
fn best_axis<N: Real>(outline1: &Outline<N>, outline2: &Outline<N>) -> Axis<N> {
    let (reach1, reach2) = (Reach::of(outline1), Reach::of(outline2));
    let mut best: Option<Axis<N>> = None;
    let mut attempt = |normal: Vector<N, 2>| {
        let gap = -reach2.along(&-normal) - reach1.along(&normal);
        if best.is_none_or(|best| gap > best.gap) {
            best = Some(Axis { gap, normal });
        }
    };
    outline1.visit_axes(&mut attempt);
    outline2.visit_axes(&mut |normal| attempt(-normal));
    // Two points have no sides: the direction between them will do.
    best.unwrap_or_else(|| {
        let between = unit(&(outline2.vertices[0] - outline1.vertices[0]));
        axis(outline1, outline2, between.map_or_else(Vector::<N, 2>::x, |(along, _)| along))
    })
}

/// Outlines that touch or overlap: the points are in the middle of what the two features that face
/// each other have in common.
fn overlapping<N: Real>(
    outline1: &Outline<N>,
    outline2: &Outline<N>,
    best: &Axis<N>,
    noise: N,
) -> Separation<N, 2> {
    let tangent = perp(&best.normal);
    let [low1, high1] = outline1.feature(&best.normal, &tangent, noise);
    let [low2, high2] = outline2.feature(&-best.normal, &tangent, noise);
    in_middle([low1, high1], [low2.0, high2.0], best)
}

/// The points in the middle of what two features have in common: the lowest and highest vertices of the
/// first, and where along the tangent those of the second are.
pub(super) fn in_middle<N: Real>(
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

/// Outlines that are apart along the best axis.
fn apart<N: Real>(
    outline1: &Outline<N>,
    outline2: &Outline<N>,
    best: &Axis<N>,
    noise: N,
) -> Separation<N, 2> {
    let (near1, near2) = (outline1.support(&best.normal), outline2.support(&-best.normal));
    let mut points =
        nearest_points(outline1, outline2, &around(near1, outline1), &around(near2, outline2));
    let mut direct = direct_axis(outline1, outline2, &points, best, noise);
    // Rounding may have hidden the best axis behind another one that is nearly parallel.
    if (points[1] - points[0]).norm() - direct.gap > N::lit(4.0) * noise {
        let all = |outline: &Outline<N>| (0..outline.vertices.len()).collect::<Vec<_>>();
        points = nearest_points(outline1, outline2, &all(outline1), &all(outline2));
        direct = direct_axis(outline1, outline2, &points, best, noise);
    }
    Separation { distance: direct.gap, normal: direct.normal, point1: points[0], point2: points[1] }
}

/// The two sides that meet at a vertex.
fn around<N: Real>(vertex: usize, outline: &Outline<N>) -> [usize; 2] {
    [outline.previous(vertex), vertex]
}

/// The nearest points of some sides of one outline and some of another.
fn nearest_points<N: Real>(
    outline1: &Outline<N>,
    outline2: &Outline<N>,
    sides1: &[usize],
    sides2: &[usize],
) -> [Point<N, 2>; 2] {
    let mut best = [outline1.vertices[0], outline2.vertices[0]];
    let mut least = N::INFINITY;
    for &side1 in sides1 {
        for &side2 in sides2 {
            let (point1, point2) = nearest_of_ends(&outline1.side(side1), &outline2.side(side2));
            let squared = (point2 - point1).norm_squared();
            if squared < least {
                (best, least) = ([point1, point2], squared);
            }
        }
    }
    best
}

/// The direction between two nearest points.
///
/// Or the best axis: where the points lie one above the other along it, because it is free of the
/// rounding of the points; and where the points are so close that the direction between them is
/// mostly rounding and leaves a smaller gap.
fn direct_axis<N: Real>(
    outline1: &Outline<N>,
    outline2: &Outline<N>,
    points: &[Point<N, 2>; 2],
    best: &Axis<N>,
    tolerance: N,
) -> Axis<N> {
    // What the rounding of the gaps adds up to; the direction of close points loses far more.
    let slack = N::lit(8.0) * tolerance;
    let between = points[1] - points[0];
    let beside = (between - best.normal * best.gap).norm();
    let direct = unit(&between)
        .filter(|_| beside > tolerance)
        .map(|(normal, length)| (length, axis(outline1, outline2, normal)));
    match direct {
        Some((gap, direct)) if direct.gap + slack >= best.gap => Axis { gap, ..direct },
        _ => *best,
    }
}

#[cfg(test)]
pub(super) mod tests {
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

    /// Pairs of all kinds in the lanes of each instruction set, against one number after the other.
    fn eight_at_a_time<N: Real>(seed: u64) {
        use crate::query::separation::hulls::tests::Random;
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
            let expected = of_outlines(&pair, known_axis(&pair), N::INFINITY);
            let expected = expected.expect("nothing is beyond infinity");
            for level in Level::available() {
                let found = polygon_lanes::between(level, &pair, known_axis(&pair), N::INFINITY);
                count += 1;
                if let Verdict::Found(found) = found {
                    let what = || format!("{found:?} not {expected:?}: {kinds:?} {pose12:?}");
                    let close = N::lit(64.0) * N::EPSILON;
                    assert!((found.distance - expected.distance).abs() <= close, "{}", what());
                    let way = found.point2 - found.point1 - found.normal * found.distance;
                    assert!(way.norm() <= close, "the normal leads there: {}", what());
                    decided += 1;
                    overlapping += usize::from(found.distance < N::ZERO);
                }
            }
        }
        assert!(decided * 10 > count * 9, "{decided} of {count} are usual");
        assert!(overlapping * 4 > decided, "{overlapping} of {decided} overlap");
    }

    /// A ball, a segment, a capsule, a triangle, a box or a polygon.
    pub(in crate::query::separation) fn solid_of<N: Real>(
        random: &mut crate::query::separation::hulls::tests::Random,
        kind: usize,
    ) -> Box<dyn Shape<N, 2>> {
        let half = random.vector::<N>().xy().abs();
        // On a grid in half of the cases: parallel sides, and ties.
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
                let points: Vec<_> = (0..8).map(|_| point()).collect();
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
    fn numbers_that_end_are_left_to_one_after_the_other() {
        let cuboid = Cuboid::new(Vector::<f32, 2>::new(1.0, 1.0));
        for bad in [f32::NAN, f32::INFINITY] {
            let mut pose12 = Pose::<f32, 2>::identity();
            pose12.translation.x = bad;
            let kind = cuboid.geometry().0;
            let pair = Pair { first: kind, second: kind, pose12 };
            let expected = of_outlines(&pair, known_axis(&pair), 1.0);
            let found = separation(&pair, 1.0);
            assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{bad}");
        }
    }

    #[test]
    fn a_flat_triangle_is_a_segment() {
        let line = Triangle::new(p(0.0, 0.0), p(2.0, 0.0), p(1.0, 0.0));
        let found = of(&line, &line, 5.0, 0.0);
        assert_eq!((found.distance, found.normal.x), (3.0, 1.0), "in a row");
        let point = Triangle::new(p(0.0, 0.0), p(0.0, 0.0), p(0.0, 0.0));
        assert_eq!(of(&point, &point, 3.0, 4.0).distance, 5.0, "points");
        assert_eq!(of(&point, &point, 0.0, 0.0).normal, Vector::<f64, 2>::x(), "at one place");
    }
}
