//! Rejects pairs of shapes that are certainly farther apart than a distance `limit`: by bounding
//! balls, which need no rotation, or by bounding boxes.
//!
//! ```text
//!     (  o1  ) - - - - between - - - - (   o2   )      balls around the origins hold the shapes
//!       extent1                          extent2       at any rotation
//!
//!       rejected if between² > (extent1 + extent2 + limit)² (1 + 2⁻⁶)
//! ```
//!
//! Each solid lies in a ball around the origin of its frame, however it is rotated. The radii of
//! the two balls cost little to read. Together with the difference of the positions they reject
//! most pairs before a rotation, the canonical order or a feature is computed.
//!
//! A pair is rejected only if the algorithms for its shapes would also find it beyond `limit`. The
//! errors of these algorithms are some hundred epsilons of the largest length that occurs in them:
//! a bounding radius or a distance of points. If the balls do not overlap, each of these lengths is
//! at most twice the distance of the origins. Squares are compared with a factor of 1 + 2⁻⁶. So the
//! balls of a rejected pair are farther apart than `limit` by 2⁻⁸ of the distance of the origins,
//! which is 2¹⁵ epsilons of `f32`.

use crate::math::{Mapped, Pose, Real, Vector, max, max_component, min};
use crate::shape::{Geometry, Kind, Shape};

/// Factor by which the squared distance of the origins must exceed the square of
/// `extent1 + extent2 + limit` for a pair to be rejected.
const ROOM: f64 = 1.0 + 1.0 / 64.0;

/// Two shapes and the vector from the origin of the first to the origin of the second, in any
/// frame.
#[derive(Clone, Copy)]
pub(crate) struct Apart<'a, N: Real, const D: usize> {
    pub(crate) shapes: [Geometry<'a, N, D>; 2],
    pub(crate) between: Vector<N, D>,
}

impl<N: Real, const D: usize> Apart<'_, N, D> {
    /// Returns whether each shape has a known bounding ball around the origin of its frame.
    #[inline]
    pub(crate) fn has_balls(&self) -> bool {
        let is_without = |shape: &Geometry<'_, N, D>| {
            matches!(shape.0, Kind::Plane(_) | Kind::Composite(_) | Kind::SupportMap(_))
        };
        !self.shapes.iter().any(is_without)
    }

    /// Returns the result of [`Self::is_beyond`] for pairs that cost less to decide here than by a
    /// call: two balls, and pairs that [`Self::has_balls`] excludes, for which the result is
    /// `false`. `None` for other pairs.
    #[inline]
    pub(crate) fn is_known_beyond(&self, limit: N) -> Option<bool> {
        if let [Kind::Ball(one), Kind::Ball(other)] = self.shapes.mapped(|shape| shape.0) {
            let extents = one.radius() + other.radius();
            return Some(exceeds(self.between.norm_squared(), max_distance(extents, limit)));
        }
        (!self.has_balls()).then_some(false)
    }

    /// Returns the result of [`Self::is_known_beyond`] if that is `Some`, else of
    /// [`Self::is_beyond`].
    #[inline]
    pub(crate) fn is_certainly_beyond(&self, limit: N) -> bool {
        self.is_known_beyond(limit).unwrap_or_else(|| are_beyond(self, limit))
    }

    /// Returns whether the shapes are certainly farther apart than `limit`; a negative limit and
    /// NaN count as zero.
    ///
    /// `false` proves nothing. It is also the result for half-spaces, composites and user-defined
    /// support maps, for which no ball is known.
    pub(crate) fn is_beyond(&self, limit: N) -> bool {
        exceeds(self.between.norm_squared(), max_distance(self.extents(), limit))
    }

    /// Returns the sum of the radii of both bounding balls; infinite if one of them is unknown.
    fn extents(&self) -> N {
        self.shapes[0].extent() + self.shapes[1].extent()
    }

    /// Returns whether the shapes certainly stay farther apart than `limit` from time zero to
    /// `end`, both included, while the second moves with `velocity` relative to the first. `false`
    /// proves nothing; it is also the result if the squared speed overflows or underflows.
    pub(crate) fn stays_beyond(&self, limit: N, velocity: &Vector<N, D>, end: N) -> bool {
        let (speed_squared, along) = (velocity.norm_squared(), self.between.dot(velocity));
        // If the squared speed overflows or underflows, the time of closest approach is unknown.
        let is_still = max_component(velocity) <= N::ZERO;
        let is_known = speed_squared > N::MIN_POSITIVE
            && speed_squared.is_finite_number()
            && along.is_finite_number();
        if !(is_still || is_known) {
            return false;
        }
        let nearest = if is_still { N::ZERO } else { -along / speed_squared };
        let offset = self.between + velocity * max(min(nearest, end), N::ZERO);
        // The offset has an error of some epsilons of the distance at time zero.
        let rounding = max_component(&self.between) * N::lit(4096.0) * N::EPSILON;
        exceeds(offset.norm_squared(), max_distance(self.extents(), limit) + rounding)
    }
}

/// Bounds of a shape in its own frame: a ball around the origin and a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReachBounds<N: Real, const D: usize> {
    /// Radius of the ball; infinite if no ball is known. Then [`Self::has_box_clear_of`] returns
    /// `false`.
    extent: N,
    middle: Vector<N, D>,
    half: Vector<N, D>,
    turns: bool,
}

impl<N: Real, const D: usize> ReachBounds<N, D> {
    /// Computes the bounds of a shape from its geometry and its local bounding box.
    pub(crate) fn of(shape: &dyn Shape<N, D>) -> Self {
        let (geometry, aabb) = (shape.geometry(), shape.local_aabb());
        Self {
            extent: geometry.extent(),
            middle: aabb.center().coords,
            half: aabb.half_extents(),
            turns: geometry.turns(),
        }
    }

    /// Returns whether a rotation changes the shape: [`Geometry::turns`].
    #[inline]
    pub(crate) const fn turns(&self) -> bool {
        self.turns
    }

    /// Returns an upper bound of the distance of the shape's points from the origin of its frame;
    /// infinite if no bound is known.
    pub(crate) fn reach(&self) -> N {
        // The box of a half-space is unbounded and gives NaN, for which `extent` is returned.
        let corner = (self.middle.abs() + self.half).norm();
        if corner < self.extent { corner } else { self.extent }
    }

    /// Returns the result of [`Apart::is_beyond`] for shapes with the bounds `self` and `other`;
    /// `between` is the vector between the origins of their frames.
    #[inline]
    pub(crate) fn is_clear_of(&self, other: &Self, between: &Vector<N, D>, limit: N) -> bool {
        exceeds(between.norm_squared(), max_distance(self.extent + other.extent, limit))
    }

    /// Returns whether the distance of the boxes along an axis of one of them exceeds `limit` by
    /// more than 2⁻⁸ of the pair's size: 2¹⁵ epsilons of `f32`. The size is the sum of the radii of
    /// both balls and the largest component of the translation. A negative `limit` counts as zero.
    /// `pose12` is the pose of the other shape in the frame of this shape.
    ///
    /// `false` proves nothing. It is also the result for NaN, and if the size is not finite.
    pub(crate) fn has_box_clear_of(&self, other: &Self, pose12: &Pose<N, D>, limit: N) -> bool {
        let turn = &pose12.rotation;
        let away = turn * other.middle + pose12.translation - self.middle;
        let back = turn.tr_mul(&away);
        let lengths = max_component(&pose12.translation) + self.extent + other.extent;
        let least = max(limit, N::ZERO) + lengths * N::lit(1.0 / 256.0);
        let mut widest = -N::INFINITY;
        for one in 0..D {
            let (mut first, mut second) = (self.half[one], other.half[one]);
            for two in 0..D {
                first += turn[(one, two)].abs() * other.half[two];
                second += turn[(two, one)].abs() * self.half[two];
            }
            widest = max(widest, max(away[one].abs() - first, back[one].abs() - second));
        }
        // Subnormal lengths have a large relative rounding error.
        widest > least && least > N::MIN_POSITIVE
    }
}

/// Returns the largest distance of the origins at which the shapes can be within `limit`. `extents`
/// is the sum of the radii of both balls.
#[inline]
fn max_distance<N: Real>(extents: N, limit: N) -> N {
    extents + max(limit, N::ZERO)
}

/// Returns whether `squared` exceeds the square of `distance` by the factor [`ROOM`]. False if
/// `squared` is subnormal, because its relative error is large, and if either is NaN or the square
/// of `distance` overflows. An infinite `squared` exceeds every finite square.
#[inline]
fn exceeds<N: Real>(squared: N, distance: N) -> bool {
    squared > distance * distance * N::lit(ROOM) && squared > N::MIN_POSITIVE
}

/// Calls [`Apart::is_beyond`]. Has no inline hint, so that the compiler need not copy the test to
/// each caller of [`Apart::is_certainly_beyond`].
pub(crate) fn are_beyond<N: Real, const D: usize>(apart: &Apart<'_, N, D>, limit: N) -> bool {
    apart.is_beyond(limit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::Pair;
    use crate::collide::separation::hulls::tests::Random;
    use crate::collide::separation::separation;
    use crate::math::na::{Rotation2, Rotation3, UnitComplex, UnitQuaternion};
    use crate::math::{Point, Pose, Space};
    use crate::shape::{
        Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, Plane,
        Rounded, Segment, Shape, TaperedCapsule, TriMesh, Triangle,
    };

    #[test]
    fn reaches_are_those_of_the_nearer_bound() {
        let half = Vector::<f64, 3>::new(1.0, 2.0, 2.0);
        let corners = [[0.0; 3], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]].mapped(Point::<f64, 3>::from);
        let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]);
        let plane = Plane::<f64, 3>::new(Vector::<f64, 3>::y_axis());
        assert_eq!(ReachBounds::of(&Cuboid::new(half)).reach(), 3.0, "its corner");
        assert_eq!(ReachBounds::of(&mesh).reach(), 5.0, "of the box, as there is no ball");
        assert_eq!(ReachBounds::of(&plane).reach(), f64::INFINITY, "it has no end");
    }

    /// Function that returns a random solid of the kind with the given number. Its radii, half
    /// extents and coordinates are at most about 1. All of these kinds have a known bounding ball.
    type Draw<N, const D: usize> = fn(&mut Random, usize) -> Box<dyn Shape<N, D>>;

    fn solid_2d<N: Real>(random: &mut Random, kind: usize) -> Box<dyn Shape<N, 2>> {
        let mut point = || Point::from(random.vector::<N>().xy());
        let [a, b, c] = [point(), point(), point()];
        let (one, other) = (a.x.abs(), a.y.abs());
        match kind {
            0 => Box::new(Ball::new(one)),
            1 => Box::new(Segment::new(a, b)),
            2 => Box::new(Capsule::<N, 2>::new(one, other)),
            3 => Box::new(Triangle::new(a, b, c)),
            4 => Box::new(Cuboid::new(a.coords.abs())),
            5 => Box::new(Rounded::new(Cuboid::new(a.coords.abs()), b.x.abs())),
            6 => Box::new(Ellipsoid::new(a.coords.abs().map(|x| x + N::EPSILON))),
            7 => Box::new(TaperedCapsule::<N, 2>::new(one, other, b.x.abs())),
            _ => match ConvexPolygon::try_from_points(&[a, b, c, point()]) {
                Ok(polygon) => Box::new(polygon),
                Err(_) => Box::new(Ball::new(one)),
            },
        }
    }

    fn solid_3d<N: Real>(random: &mut Random, kind: usize) -> Box<dyn Shape<N, 3>> {
        let mut point = || Point::from(random.vector::<N>());
        let [a, b, c] = [point(), point(), point()];
        let (one, other) = (a.x.abs(), a.y.abs());
        match kind {
            0 => Box::new(Ball::new(one)),
            1 => Box::new(Segment::new(a, b)),
            2 => Box::new(Capsule::<N, 3>::new(one, other)),
            3 => Box::new(Triangle::new(a, b, c)),
            4 => Box::new(Cuboid::new(a.coords.abs())),
            5 => Box::new(Rounded::new(Cylinder::new(one, other), b.x.abs())),
            6 => Box::new(Ellipsoid::new(a.coords.abs().map(|x| x + N::EPSILON))),
            7 => Box::new(TaperedCapsule::<N, 3>::new(one, other, b.x.abs())),
            8 => Box::new(Cylinder::new(one, other)),
            9 => Box::new(Cone::new(one, other)),
            _ => match ConvexHull::try_from_points(&[a, b, c, point(), point()]) {
                Ok(hull) => Box::new(hull),
                Err(_) => Box::new(Ball::new(one)),
            },
        }
    }

    /// Asserts that [`separation`] returns `None` for each pair that the balls or the boxes reject,
    /// and at 17 instants for each pair that [`Apart::stays_beyond`] rejects; and that each test
    /// rejects some of the pairs, but not all. The distance of the origins is 0.97 to 1.03 times
    /// the sum of the ball radii and the limit; for the boxes it is then multiplied by 0.4 to 1.
    fn rejects_no_more<N: Space<D>, const D: usize>(
        (draw, kinds): (Draw<N, D>, usize),
        turn: fn(&mut Random) -> Pose<N, D>,
    ) {
        let random = &mut Random(11);
        let (mut rejected, mut boxed, mut moved) = (0, 0, 0);
        for round in 0..4000 {
            let shapes = [draw(random, round % kinds), draw(random, round / kinds % kinds)];
            let bounds = [ReachBounds::of(shapes[0].as_ref()), ReachBounds::of(shapes[1].as_ref())];
            let shapes = [shapes[0].geometry(), shapes[1].geometry()];
            let apart = Apart { shapes, between: Vector::<N, D>::zeros() };
            let limit = N::lit([0.0, 0.25, -0.1][round % 3]);
            let max_distance = max_distance(apart.extents(), limit);
            let pose12 = turn(random);
            let share =
                N::lit(0.97 + 0.0005 * f64::from(u32::try_from(round % 120).expect("small")));
            let away = pose12.translation.normalize() * (max_distance * share);
            // In odd rounds, rounds the difference of the positions as for positions 10⁶ away from
            // the world's origin.
            let far = Vector::<N, D>::repeat(N::lit([0.0, 1e6][round % 2]));
            let between = (far + away) - far;
            let pair = Pair {
                first: shapes[0].0,
                second: shapes[1].0,
                pose12: Pose { translation: between, ..pose12 },
            };
            if (Apart { between, ..apart }).is_beyond(limit) {
                rejected += 1;
                assert!(
                    separation(&pair, limit).is_none(),
                    "in round {round}: {pair_poses:?}",
                    pair_poses = pair.pose12
                );
            }
            // Moves most pairs closer than the balls allow, where only the boxes can reject them.
            let mut nearer = pair;
            nearer.pose12.translation *= N::lit([1.0, 0.8, 0.6, 0.4][round % 4]);
            if bounds[0].has_box_clear_of(&bounds[1], &nearer.pose12, limit) {
                boxed += 1;
                assert!(
                    separation(&nearer, limit).is_none(),
                    "in round {round}, rejected by boxes"
                );
            }
            let velocity = turn(random).translation;
            if (Apart { between, ..apart }).stays_beyond(limit, &velocity, N::TWO) {
                moved += 1;
                for step in 0..=16 {
                    let mut pair = pair;
                    let time = N::TWO * N::lit(f64::from(step) / 16.0);
                    pair.pose12.translation += velocity * time;
                    assert!(separation(&pair, limit).is_none(), "in round {round} at {time}");
                }
            }
        }
        assert!(rejected > 500 && rejected < 3500, "{rejected} pairs are rejected");
        assert!(boxed > 500 && boxed < 3500, "the boxes of {boxed} pairs are rejected");
        assert!(moved > 100 && moved < 3500, "{moved} pairs stay apart");
    }

    fn turn2<N: Real>(random: &mut Random) -> Pose<N, 2> {
        let v = random.vector::<N>();
        let rotation = Rotation2::from(UnitComplex::from_angle(v.z * N::lit(3.0))).into_inner();
        Pose { rotation, translation: v.xy() }
    }

    fn turn3<N: Real>(random: &mut Random) -> Pose<N, 3> {
        let (axis, translation) = (random.vector::<N>(), random.vector::<N>());
        let turn = UnitQuaternion::from_scaled_axis(axis * N::lit(3.0));
        Pose { rotation: Rotation3::from(turn).into_inner(), translation }
    }

    #[test]
    fn what_is_rejected_is_beyond_for_the_algorithms() {
        rejects_no_more::<f32, 2>((solid_2d, 9), turn2);
        rejects_no_more::<f64, 2>((solid_2d, 9), turn2);
        rejects_no_more::<f32, 3>((solid_3d, 11), turn3);
        rejects_no_more::<f64, 3>((solid_3d, 11), turn3);
    }

    #[test]
    fn numbers_near_both_ends_of_the_range_are_not_rejected() {
        let (small, large) = (Ball::new(1e-23_f32), Ball::new(1.8e19_f32));
        let apart = |ball, x: f32| Apart {
            shapes: [Shape::<f32, 3>::geometry(ball); 2],
            between: Vector::<f32, 3>::new(x, 0.0, 0.0),
        };
        assert!(!apart(&small, 2.2e-23).is_beyond(0.0), "squares that underflow decide nothing");
        assert!(apart(&small, 1e-18).is_beyond(0.0), "these are numbers");
        assert!(!apart(&large, 3.7e19).is_beyond(0.0), "squares that overflow on both sides");
        assert!(!apart(&small, f32::NAN).is_beyond(0.0), "NaN");
        assert!(!apart(&small, 1.0).is_beyond(f32::INFINITY), "no limit");
        assert!(apart(&small, 1.0).is_beyond(f32::NAN), "nothing is within NaN");
        let creeps = Vector::<f32, 3>::new(-1e-25, 0.0, 0.0);
        let (unit, forever) = (Ball::new(0.25), f32::INFINITY);
        assert!(!apart(&unit, 1.0).stays_beyond(0.0, &creeps, forever), "it may arrive");
        let still = Vector::<f32, 3>::zeros();
        assert!(apart(&unit, 1.0).stays_beyond(0.0, &still, forever), "it stays");
        assert!(apart(&unit, 1.0).stays_beyond(0.0, &(-creeps * 1e25), forever), "it leaves");
        let rushes = Vector::<f32, 3>::new(-1e25, 0.0, 0.0);
        assert!(!apart(&unit, 1.0).stays_beyond(0.0, &rushes, forever), "its square overflows");
    }
}
