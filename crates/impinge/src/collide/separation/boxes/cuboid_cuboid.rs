//! Box against box in 3D.

use smallvec::SmallVec;

use super::cuboid_axes::{AxisKind, BoxAxis, BoxPair};
use crate::collide::Pair;
use crate::collide::separation::segments::nearest::nearest_of_segments;
use crate::collide::separation::{general, wrong_kinds};
use crate::convex::Separation;
use crate::math::{Mapped, Point, Pose, Real, Vector, max, min};
use crate::shape::Kind;

/// Returns the separation of two boxes; `None` above `limit`.
///
/// For overlapping boxes the separating axis test is exact. For boxes that are apart the test gives
/// a lower bound. The bound equals the distance if one of the two nearest points lies inside a
/// face, or if both lie inside edges that are not parallel. In other cases, such as two corners or
/// a corner and an edge, the general algorithm is used.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let boxes = of_pair(pair);
    along_best(pair, limit, &boxes, &boxes.best_axis())
}

/// Returns the result of [`separation`] if the axes decide it, because the boxes overlap or the
/// largest gap exceeds `limit`; the inner `None` is a distance above `limit`. The outer `None`
/// means that the axes do not decide it.
pub(in crate::collide::separation) fn decided_by_axes<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Option<Separation<N, 3>>> {
    let boxes = of_pair(pair);
    let best = boxes.best_axis();
    let is_decided = best.gap <= N::ZERO || is_beyond(&boxes, &best, limit);
    is_decided.then(|| along_best(pair, limit, &boxes, &best))
}

/// Returns the distance of [`separation`]; `None` above `limit`. For overlapping boxes it is the
/// gap along the best axis, and no points are computed.
pub(in crate::collide::separation) fn distance<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<N> {
    let boxes = of_pair(pair);
    let best = boxes.best_axis();
    if best.gap <= N::ZERO {
        return (best.gap <= limit).then_some(best.gap);
    }
    along_best(pair, limit, &boxes, &best).map(|found| found.distance)
}

fn of_pair<N: Real>(pair: &Pair<'_, N, 3>) -> BoxPair<N> {
    let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let (half1, half2) = (*cuboid1.half_extents(), *cuboid2.half_extents());
    BoxPair { half1, half2, pose12: pair.pose12 }
}

/// Returns the separation computed from `best`, the axis of the largest gap, or by the general
/// algorithm if the nearest points do not lie along this axis; `None` above `limit`.
fn along_best<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
    boxes: &BoxPair<N>,
    best: &BoxAxis<N>,
) -> Option<Separation<N, 3>> {
    if is_beyond(boxes, best, limit) {
        return None;
    }
    let found = along(boxes, best);
    let beside = found.point2 - found.point1 - best.normal * best.gap;
    let attained = best.gap <= N::ZERO || beside.norm() <= boxes.rounding_error();
    if attained {
        return (found.distance <= limit).then_some(found);
    }
    general::of_flat_cores_near(pair, limit, &best.normal)
}

/// Returns whether the gap along an axis exceeds `limit` by more than rounding.
fn is_beyond<N: Real>(boxes: &BoxPair<N>, axis: &BoxAxis<N>, limit: N) -> bool {
    axis.gap > limit + N::lit(16.0) * boxes.rounding_error()
}

/// Returns a separation with the normal and the gap of `axis`, and points of both boxes that face
/// each other along it.
fn along<N: Real>(boxes: &BoxPair<N>, axis: &BoxAxis<N>) -> Separation<N, 3> {
    let (normal, distance) = (axis.normal, axis.gap);
    let (point1, point2) = match axis.kind {
        AxisKind::Face1(index) => {
            let face = BoxReferenceFace { half: boxes.half1, axis: index, toward: normal[index] };
            let point2 = face.deepest(&boxes.half2, &boxes.pose12, distance);
            (face.onto(&point2), point2)
        }
        AxisKind::Face2(index) => {
            let toward = -boxes.axis2(index).dot(&normal);
            let face = BoxReferenceFace { half: boxes.half2, axis: index, toward };
            let point1 = face.deepest(&boxes.half1, &boxes.pose12.inverse(), distance);
            (boxes.pose12.point(&point1), boxes.pose12.point(&face.onto(&point1)))
        }
        AxisKind::Edges(axis1, axis2) => between_edges(boxes, axis1, axis2, &normal),
    };
    Separation { distance, normal, point1, point2 }
}

/// Returns the nearest points of two edges that face each other along `normal`: an edge of the
/// first box along its axis `axis1`, and an edge of the second box along its axis `axis2`.
fn between_edges<N: Real>(
    boxes: &BoxPair<N>,
    axis1: usize,
    axis2: usize,
    normal: &Vector<N, 3>,
) -> (Point<N, 3>, Point<N, 3>) {
    let edge1 = edge_toward(&boxes.half1, axis1, normal);
    let edge2 = edge_toward(&boxes.half2, axis2, &boxes.pose12.inverse_vector(&-normal));
    nearest_of_segments(&edge1, &edge2.mapped(|end| boxes.pose12.point(&end)))
}

/// Returns the edge of a box along `axis` that lies farthest in a direction.
fn edge_toward<N: Real>(
    half: &Vector<N, 3>,
    axis: usize,
    direction: &Vector<N, 3>,
) -> [Point<N, 3>; 2] {
    let corner = half.zip_map(direction, |h, d| if d < N::ZERO { -h } else { h });
    let (mut low, mut high) = (corner, corner);
    (low[axis], high[axis]) = (-half[axis], half[axis]);
    [Point::from(low), Point::from(high)]
}

/// A face of a box, in the box's frame: perpendicular to `axis`, at the end with the sign of
/// `toward`.
struct BoxReferenceFace<N: Real> {
    half: Vector<N, 3>,
    axis: usize,
    toward: N,
}

impl<N: Real> BoxReferenceFace<N> {
    fn sign(&self) -> N {
        if self.toward < N::ZERO { -N::ONE } else { N::ONE }
    }

    /// Returns the signed height of a point above the face.
    fn height(&self, point: &Point<N, 3>) -> N {
        self.sign() * point[self.axis] - self.half[self.axis]
    }

    /// Returns the point of the face nearest to a point.
    fn onto(&self, point: &Point<N, 3>) -> Point<N, 3> {
        let clamped = point.coords.zip_map(&self.half, |x, h| max(min(x, h), -h));
        let mut below = Point::from(clamped);
        below[self.axis] = self.sign() * self.half[self.axis];
        below
    }

    /// Clips a polygon to the side planes of the face, moved outwards by `slack`.
    fn above(&self, polygon: &Polygon<N>, slack: N) -> Polygon<N> {
        let across = [(self.axis + 1) % 3, (self.axis + 2) % 3];
        across.iter().fold(polygon.clone(), |polygon, &axis| {
            let bound = self.half[axis] + slack;
            clipped(&clipped(&polygon, axis, N::ONE, bound), axis, -N::ONE, bound)
        })
    }

    /// Returns the lowest of the points; `None` unless all others are higher by more than `slack`.
    fn alone(&self, points: &[Point<N, 3>], slack: N) -> Option<Point<N, 3>> {
        let lower = |a, b| if self.height(b) < self.height(a) { b } else { a };
        let lowest = points.iter().reduce(lower)?;
        let flat = self.height(lowest) + slack;
        let low = points.iter().filter(|point| self.height(point) <= flat);
        (low.count() == 1).then_some(*lowest)
    }

    /// Returns whether a point projects into the face.
    fn is_below(&self, point: &Point<N, 3>) -> bool {
        let across = [(self.axis + 1) % 3, (self.axis + 2) % 3];
        across.iter().all(|&axis| point[axis].abs() <= self.half[axis])
    }

    /// Clips the other box's face that faces this one to the side planes of this face, and returns
    /// the mean of the lowest corners of the result. If nothing is left, returns the mean of the
    /// lowest corners of the unclipped face. If the boxes are apart and a single corner is lowest,
    /// returns this corner without clipping. `other` are the half extents of the other box, `pose`
    /// is its pose in the frame of this box, and `distance` its known signed height above this
    /// face.
    fn deepest(&self, other: &Vector<N, 3>, pose: &Pose<N, 3>, distance: N) -> Point<N, 3> {
        let direction = Vector::<N, 3>::ith(self.axis, -self.sign());
        let facing = face_toward(other, &pose.inverse_vector(&direction));
        let facing: Polygon<N> = facing.iter().map(|corner| pose.point(corner)).collect();
        let size = self.half.sum() + other.sum() + distance.abs();
        let rounding_error = N::lit(16.0) * N::EPSILON * size;
        if let Some(corner) = self.alone(&facing, rounding_error) {
            // If the boxes are apart and the lowest corner projects beside the face, no lowest
            // point projects into it.
            if distance > N::ZERO || self.is_below(&corner) {
                return corner;
            }
        }
        // Rounding may leave no point over a face without width. If the boxes are apart, the other
        // box may lie beside the face.
        let mut above = self.above(&facing, N::ZERO);
        if above.is_empty() {
            above = self.above(&facing, rounding_error);
        }
        let polygon = if above.is_empty() { facing } else { above };
        let lowest = polygon.iter().fold(N::INFINITY, |low, p| min(self.height(p), low));
        let flat = lowest + rounding_error;
        let low: Polygon<N> = polygon.into_iter().filter(|p| self.height(p) <= flat).collect();
        crate::math::centroid(&low)
    }
}

/// Corners of a convex polygon; clipping a face with four planes gives at most 8.
type Polygon<N> = SmallVec<[Point<N, 3>; 8]>;

/// Returns the corners, in order, of the face of a box whose normal is most aligned with a
/// direction.
fn face_toward<N: Real>(half: &Vector<N, 3>, direction: &Vector<N, 3>) -> [Point<N, 3>; 4] {
    let axis = direction.iamax();
    let sign = if direction[axis] < N::ZERO { -N::ONE } else { N::ONE };
    [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].mapped(|(u, v)| {
        let mut corner = *half;
        corner[axis] *= sign;
        corner[(axis + 1) % 3] *= N::lit(u);
        corner[(axis + 2) % 3] *= N::lit(v);
        Point::from(corner)
    })
}

/// Clips a polygon to `sign · coordinate ≤ bound` on an axis (Sutherland and Hodgman, "Reentrant
/// polygon clipping", 1974).
fn clipped<N: Real>(polygon: &Polygon<N>, axis: usize, sign: N, bound: N) -> Polygon<N> {
    let inside = |p: &Point<N, 3>| bound - sign * p[axis];
    let mut kept = Polygon::new();
    for (at, from) in polygon.iter().enumerate() {
        let to = &polygon[(at + 1) % polygon.len()];
        let (inside1, inside2) = (inside(from), inside(to));
        if inside1 >= N::ZERO {
            kept.push(*from);
        }
        if (inside1 > N::ZERO && inside2 < N::ZERO) || (inside1 < N::ZERO && inside2 > N::ZERO) {
            kept.push(from + (to - from) * (inside1 / (inside1 - inside2)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Isometry3;
    use crate::shape::{Cuboid, Shape};

    fn of(half1: [f64; 3], half2: [f64; 3], pose12: &Isometry3<f64>) -> Separation<f64, 3> {
        let (cuboid1, cuboid2) = (Cuboid::new(half1.into()), Cuboid::new(half2.into()));
        let (first, second) = (cuboid1.geometry().0, cuboid2.geometry().0);
        let pair = Pair { first, second, pose12: Pose::from_isometry(pose12) };
        separation(&pair, f64::INFINITY).expect("nothing is beyond infinity")
    }

    #[test]
    fn one_on_the_other() {
        let found = of([4.0, 1.0, 4.0], [1.0; 3], &Isometry3::translation(1.0, 1.75, 0.0));
        assert_eq!((found.distance, found.normal.y), (-0.25, 1.0), "a quarter deep");
        assert_eq!(found.point1, Point::<f64, 3>::new(1.0, 1.0, 0.0), "under its middle");
        assert_eq!(found.point2, Point::<f64, 3>::new(1.0, 0.75, 0.0), "its middle");
    }

    #[test]
    fn a_corner_over_a_face() {
        let turn = [0.0, 0.0, core::f64::consts::FRAC_PI_4];
        let pose = Isometry3::new([0.5, 4.0, 0.0].into(), turn.into());
        let found = of([2.0, 1.0, 2.0], [1.0; 3], &pose);
        assert!((found.distance - (3.0 - 2.0_f64.sqrt())).abs() < 1e-15, "its edge is down");
        assert!((found.point1 - Point::<f64, 3>::new(0.5, 1.0, 0.0)).norm() < 1e-15, "below it");
    }

    #[test]
    fn edge_over_edge() {
        // Both boxes are rotated by 45°: an upper edge along x below a lower edge along z.
        let eighth = core::f64::consts::FRAC_PI_4;
        let pose1 = Isometry3::new([0.0; 3].into(), [eighth, 0.0, 0.0].into());
        let pose2 = Isometry3::new([0.25, 2.75, 0.25].into(), [0.0, 0.0, eighth].into());
        let found = of([3.0, 1.0, 1.0], [1.0, 1.0, 3.0], &pose1.inv_mul(&pose2));
        let expected = 2.75 - 2.0 * 2.0_f64.sqrt();
        assert!((found.distance - expected).abs() < 1e-15, "{}", found.distance);
        let world1 = pose1 * found.point1;
        assert!(
            (world1 - Point::<f64, 3>::new(0.25, 2.0_f64.sqrt(), 0.0)).norm() < 1e-9,
            "{world1}"
        );
    }
}
