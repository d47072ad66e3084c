//! Two solids and their relative pose: the input of every pair algorithm.
//!
//! ```text
//!   argument order   canonical order                 pose12: of `second` in the frame of `first`
//!   (A, B)  --->     first <= second by kind,        results are computed in canonical order, and
//!   (B, A)  --->     then position, pose, numbers    flipped back if `swapped`
//! ```
//!
//! `pose12` is computed from the difference of the positions, so the relative pose of close solids
//! has no large rounding error far from the world's origin. If the first solid is a ball, its
//! rotation is ignored.

use core::cmp::Ordering;

use crate::math::order::askew;
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::{CompositeShape, Geometry, Kind, SupportMap};

/// Two solids in the frame of the first, in which results are computed.
///
/// The kinds are in the fixed order of [`crate::shape::ShapeKind`]: `first ≤ second`.
#[derive(Clone, Copy)]
pub(crate) struct Pair<'a, N: Real, const D: usize> {
    pub(crate) first: Kind<'a, N, D>,
    pub(crate) second: Kind<'a, N, D>,
    /// Pose of the second solid in the frame of the first.
    pub(crate) pose12: Pose<N, D>,
}

impl<'a, N: Real, const D: usize> Pair<'a, N, D> {
    /// Makes a pair from two solids that are already in canonical order, and their world poses. If
    /// the first is a ball, its rotation is ignored.
    #[inline]
    pub(crate) fn new(
        [first, second]: [Geometry<'a, N, D>; 2],
        [pose1, pose2]: [&Pose<N, D>; 2],
    ) -> Self {
        let pose12 = pose_between(first.turns(), [pose1, pose2]);
        Self { first: first.0, second: second.0, pose12 }
    }
}

/// Returns the pose of the second solid in the frame of the first. `first_turns` is `false` if the
/// first is a ball, whose rotation is ignored.
#[inline]
pub(crate) fn pose_between<N: Real, const D: usize>(
    first_turns: bool,
    [pose1, pose2]: [&Pose<N, D>; 2],
) -> Pose<N, D> {
    if first_turns {
        return Pose::relative(pose1, pose2);
    }
    Pose { rotation: pose2.rotation, translation: pose2.translation - pose1.translation }
}

/// A solid and its pose in the world. [`Geometry::pose_at`] places a ball without its rotation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed<'a, N: Real, const D: usize> {
    pub(crate) pose: Pose<N, D>,
    pub(crate) shape: Geometry<'a, N, D>,
}

/// A placed shape whose rotation is converted to a matrix only by [`Self::placed`]. Tests that
/// reject distant pairs need only its position.
pub(crate) trait Placing<'a, N: Real, const D: usize> {
    fn shape(&self) -> Geometry<'a, N, D>;

    /// Returns the world position of the origin of the shape's frame.
    fn translation(&self) -> Vector<N, D>;

    fn placed(&self) -> Placed<'a, N, D>;
}

impl<'a, N: Real, const D: usize> Placing<'a, N, D> for Placed<'a, N, D> {
    #[inline]
    fn shape(&self) -> Geometry<'a, N, D> {
        self.shape
    }

    #[inline]
    fn translation(&self) -> Vector<N, D> {
        self.pose.translation
    }

    #[inline]
    fn placed(&self) -> Self {
        *self
    }
}

/// Returns the pair in an order that does not depend on the order of the arguments, and whether
/// that order is the reverse of the argument order.
///
/// Every result for two solids is computed in this order and flipped at the end, so that swapping
/// the arguments flips the result bit for bit. Kinds come in the order of
/// [`crate::shape::ShapeKind`]. Solids of one kind are ordered by their world translations along an
/// [`askew`] direction, then by all coordinates, then by rotation (balls are placed without one),
/// then by the numbers that define them. A user's support map is compared by its rounding radius
/// and its support points along the axes and the diagonals; composites by their number of parts,
/// then part by part. Except for user's support maps, solids that agree in all of these are
/// identical, so their order does not change the result.
#[inline]
pub(crate) fn canonical<'a, N: Real, const D: usize>(
    pose1: &Pose<N, D>,
    shape1: Geometry<'a, N, D>,
    pose2: &Pose<N, D>,
    shape2: Geometry<'a, N, D>,
) -> (Pair<'a, N, D>, bool) {
    let swapped = is_swapped(pose1, shape1, pose2, shape2);
    let pair = if swapped {
        Pair::new([shape2, shape1], [pose2, pose1])
    } else {
        Pair::new([shape1, shape2], [pose1, pose2])
    };
    (pair, swapped)
}

/// Two placed solids in the order of [`canonical`].
#[derive(Clone, Copy)]
pub(crate) struct Ordered<'p, 'a, N: Real, const D: usize> {
    pub(crate) first: &'p Placed<'a, N, D>,
    pub(crate) second: &'p Placed<'a, N, D>,
    /// Whether this order is the reverse of the argument order.
    pub(crate) swapped: bool,
}

impl<'p, 'a, N: Real, const D: usize> Ordered<'p, 'a, N, D> {
    #[inline]
    pub(crate) fn new(placed1: &'p Placed<'a, N, D>, placed2: &'p Placed<'a, N, D>) -> Self {
        if is_swapped(&placed1.pose, placed1.shape, &placed2.pose, placed2.shape) {
            Self { first: placed2, second: placed1, swapped: true }
        } else {
            Self { first: placed1, second: placed2, swapped: false }
        }
    }

    /// Returns the canonical pair.
    #[inline]
    pub(crate) fn pair(&self) -> Pair<'a, N, D> {
        let Self { first, second, .. } = self;
        Pair::new([first.shape, second.shape], [&first.pose, &second.pose])
    }

    /// Returns whether one of the two solids is a composite. The algorithms for such a pair use
    /// [`Between`](super::parts::Between).
    #[inline]
    pub(crate) fn has_composite(&self) -> bool {
        let is_composite = |placed: &Placed<'a, N, D>| placed.shape.as_composite().is_some();
        is_composite(self.first) || is_composite(self.second)
    }
}

/// Returns whether the order of [`canonical`] is the reverse of the argument order.
///
/// For solids of one kind, both orders are equally frequent. The result is computed as a value, not
/// by a branch, because a mispredicted branch would stall on loads from distant memory.
#[inline]
pub(crate) fn is_swapped<N: Real, const D: usize>(
    pose1: &Pose<N, D>,
    shape1: Geometry<'_, N, D>,
    pose2: &Pose<N, D>,
    shape2: Geometry<'_, N, D>,
) -> bool {
    let (kind1, kind2) = (shape1.kind(), shape2.kind());
    let signed_distance = signed_distance(pose1, pose2);
    let is_beyond = signed_distance < N::ZERO;
    if kind1 == kind2 && !(is_beyond | (signed_distance > N::ZERO)) {
        return compare_at_length(pose1, shape1, pose2, shape2) == Ordering::Greater;
    }
    if kind1 == kind2 { is_beyond } else { kind1 > kind2 }
}

/// Compares two placed solids by the order of [`canonical`]. `Equal` only if kinds, poses and
/// defining numbers are all equal.
#[inline]
pub(crate) fn order<N: Real, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
) -> Ordering {
    compare(&placed1.pose, placed1.shape, &placed2.pose, placed2.shape)
}

/// Compares two solids by the order of [`canonical`]. For solids of one kind, positions nearly
/// always decide.
#[inline]
fn compare<N: Real, const D: usize>(
    pose1: &Pose<N, D>,
    shape1: Geometry<'_, N, D>,
    pose2: &Pose<N, D>,
    shape2: Geometry<'_, N, D>,
) -> Ordering {
    let (kind1, kind2) = (shape1.kind(), shape2.kind());
    if kind1 != kind2 {
        return kind1.cmp(&kind2);
    }
    let signed_distance = signed_distance(pose1, pose2);
    if signed_distance > N::ZERO {
        Ordering::Less
    } else if signed_distance < N::ZERO {
        Ordering::Greater
    } else {
        compare_at_length(pose1, shape1, pose2, shape2)
    }
}

/// Returns the signed distance from the position of the first solid to that of the second along an
/// [`askew`] direction. Unlike along a coordinate axis, small vibrations do not change its sign for
/// solids that are stacked or stand in a grid.
#[inline]
fn signed_distance<N: Real, const D: usize>(pose1: &Pose<N, D>, pose2: &Pose<N, D>) -> N {
    askew(&(pose2.translation - pose1.translation))
}

/// Compares solids of one kind by poses, then by defining numbers. Needed only if their
/// [`signed_distance`] is zero or NaN.
#[cold]
fn compare_at_length<N: Real, const D: usize>(
    pose1: &Pose<N, D>,
    shape1: Geometry<'_, N, D>,
    pose2: &Pose<N, D>,
    shape2: Geometry<'_, N, D>,
) -> Ordering {
    compare_poses(pose1, pose2).then_with(|| compare_solids(&shape1.0, &shape2.0))
}

/// Compares two poses by translation, then by rotation.
fn compare_poses<N: Real, const D: usize>(pose1: &Pose<N, D>, pose2: &Pose<N, D>) -> Ordering {
    compare_numbers(pose1.translation.as_slice(), pose2.translation.as_slice())
        .then_with(|| compare_numbers(pose1.rotation.as_slice(), pose2.rotation.as_slice()))
}

/// Compares solids of one kind by their defining numbers.
fn compare_solids<N: Real, const D: usize>(
    solid1: &Kind<'_, N, D>,
    solid2: &Kind<'_, N, D>,
) -> Ordering {
    match (solid1, solid2) {
        (Kind::Composite(parts1), Kind::Composite(parts2)) => compare_parts(*parts1, *parts2),
        _ => compare_numbers(&numbers(solid1), &numbers(solid2)),
    }
}

/// Compares two composites by their numbers of parts, then part by part up to the first difference.
fn compare_parts<N: Real, const D: usize>(
    parts1: &dyn CompositeShape<N, D>,
    parts2: &dyn CompositeShape<N, D>,
) -> Ordering {
    let one = |index| {
        let (part1, part2) = (parts1.part(index), parts2.part(index));
        compare(&part1.pose, part1.solid.geometry(), &part2.pose, part2.solid.geometry())
    };
    let counts = parts1.num_parts().cmp(&parts2.num_parts());
    let mut orders = (0..parts1.num_parts()).map(one);
    counts.then_with(|| orders.find(|order| order.is_ne()).unwrap_or(Ordering::Equal))
}

/// Compares two lists lexicographically. Zeros of different sign are ordered by their bits, and so
/// are two numbers of which one is NaN. If one list begins with the other list, the shorter list
/// comes first.
fn compare_numbers<N: Real>(numbers1: &[N], numbers2: &[N]) -> Ordering {
    for (number1, number2) in numbers1.iter().zip(numbers2) {
        let by_value = number1.partial_cmp(number2).unwrap_or(Ordering::Equal);
        let order = by_value.then_with(|| number1.bits().cmp(&number2.bits()));
        if order != Ordering::Equal {
            return order;
        }
    }
    numbers1.len().cmp(&numbers2.len())
}

/// Returns the numbers that define a solid of its kind; empty for a composite. They decide the
/// order only if kinds and poses are equal.
fn numbers<N: Real, const D: usize>(kind: &Kind<'_, N, D>) -> Vec<N> {
    match kind {
        Kind::Ball(ball) => vec![ball.radius()],
        Kind::Segment(segment) => coordinates(&[*segment.a(), *segment.b()]),
        Kind::Capsule(capsule) => {
            let mut numbers = coordinates(&[*capsule.segment().a(), *capsule.segment().b()]);
            numbers.push(capsule.radius());
            numbers
        }
        Kind::Triangle(triangle) => coordinates(triangle.corners()),
        Kind::Cuboid(cuboid) => cuboid.half_extents().as_slice().to_vec(),
        Kind::Polytope(polytope) => coordinates(polytope.vertices()),
        Kind::Cylinder(cylinder, _) => vec![cylinder.half_height(), cylinder.radius()],
        Kind::Cone(cone, _) => vec![cone.half_height(), cone.radius()],
        Kind::Ellipsoid(ellipsoid) => ellipsoid.half_axes().as_slice().to_vec(),
        Kind::TaperedCapsule(capsule) => {
            let mut numbers = coordinates(&[*capsule.segment().a(), *capsule.segment().b()]);
            numbers.extend(capsule.radii());
            numbers
        }
        Kind::Rounded(solid) => {
            let mut numbers = numbers(&solid.inner().0);
            numbers.push(solid.radius());
            numbers
        }
        Kind::SupportMap(map) => probed(*map),
        Kind::Plane(plane) => plane.normal().as_slice().to_vec(),
        // Composites are compared part by part.
        Kind::Composite(_) => Vec::new(),
    }
}

/// Returns the coordinates of the points, one point after another.
fn coordinates<N: Real, const D: usize>(points: &[Point<N, D>]) -> Vec<N> {
    points.iter().flat_map(|point| point.coords.as_slice().to_vec()).collect()
}

/// Returns numbers that characterise a user-defined solid: its rounding radius, and its support
/// points along both directions of each axis and along the diagonals.
fn probed<N: Real, const D: usize>(map: &dyn SupportMap<N, D>) -> Vec<N> {
    let mut numbers = vec![map.rounding()];
    for axis in 0..D {
        let mut direction = Vector::<N, D>::zeros();
        direction[axis] = N::ONE;
        numbers.extend_from_slice(map.core_support(&direction).coords.as_slice());
        numbers.extend_from_slice(map.core_support(&-direction).coords.as_slice());
    }
    for signs in 0..1_usize << D {
        let diagonal =
            Vector::<N, D>::from_fn(
                |axis, _| {
                    if signs >> axis & 1 == 1 { N::ONE } else { -N::ONE }
                },
            );
        numbers.extend_from_slice(map.core_support(&diagonal).coords.as_slice());
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Ball, Cuboid, Shape, ShapeKind};

    fn at(x: f32, y: f32) -> Pose<f32, 2> {
        Pose::from_translation(Vector::<f32, 2>::new(x, y))
    }

    #[test]
    fn kinds_come_in_their_order() {
        let (ball, cuboid) = (Ball::new(1.0_f32), Cuboid::new(Vector::<f32, 2>::new(1.0, 1.0)));
        let (pose1, pose2) = (at(1.0, 0.0), at(4.0, 0.0));
        let (pair, swapped) = canonical(&pose1, cuboid.geometry(), &pose2, ball.geometry());
        assert!(swapped, "the ball comes first");
        assert_eq!(Geometry(pair.first).kind(), ShapeKind::Ball, "the ball comes first");
        assert_eq!(pair.pose12.translation.x, -3.0, "the box in the frame of the ball");
    }

    #[test]
    fn equal_kinds_come_by_position_then_size() {
        let (small, large) = (Ball::new(1.0_f32), Ball::new(2.0_f32));
        let geometry = |ball| Shape::<f32, 2>::geometry(ball);
        let order = |pose1, ball1, pose2, ball2| {
            canonical(&pose1, geometry(ball1), &pose2, geometry(ball2)).1
        };
        assert!(!order(at(0.0, 1.0), &large, at(0.0, 2.0), &small), "by position");
        assert!(order(at(0.0, 2.0), &small, at(0.0, 1.0), &large), "by position, swapped");
        assert!(order(at(0.0, 1.0), &large, at(0.0, 1.0), &small), "by size at one position");
        assert!(!order(at(0.0, 1.0), &small, at(0.0, 1.0), &large), "by size at one position");
    }
}
