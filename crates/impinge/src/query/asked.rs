//! Two shapes at isometries of the user's, as a question about both finds them.
//!
//! Most pairs need their poses as matrices. A ball needs none, and a solid that is held against a ball or a
//! half-space only turns a few vectors, which takes a third of making the matrix or less.

use core::cmp::Ordering;

use super::far::Apart;
use super::pair::{Pair, Placed, is_swapped};
use super::separation::{of_balls, of_half_space};
use super::witness::Witness;
use crate::convex::Separation;
use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, Space, Vector};
use crate::shape::{Ball, Geometry, Kind, Shape, ShapeKind};

/// A shape where the user's isometry puts it.
type At<'q, 'a, N, R, const D: usize> = (&'q Isometry<N, R, D>, Geometry<'a, N, D>);

/// Two shapes in the order of the arguments.
pub(super) struct Asked<'q, 'a, N: Real, R, const D: usize> {
    one: At<'q, 'a, N, R, D>,
    two: At<'q, 'a, N, R, D>,
}

/// Two shapes of which the first is a ball or the second a half-space, in their canonical order, as
/// [`Ordered`](super::pair::Ordered) has it.
///
/// Answers are in the frame of the first: that of its solid or, of a ball, the axes of the world put
/// through its centre.
struct Simple<'q, 'a, N: Real, R, const D: usize> {
    first: At<'q, 'a, N, R, D>,
    second: At<'q, 'a, N, R, D>,
    /// The order is the opposite of that of the arguments.
    swapped: bool,
}

/// What two placed shapes are asked.
type OfPlaced<N, A, const D: usize> = fn(&Placed<'_, N, D>, &Placed<'_, N, D>, N) -> Option<A>;

impl<'q, 'a, N: Space<D>, R: AbstractRotation<N, D>, const D: usize> Asked<'q, 'a, N, R, D> {
    #[inline]
    pub(super) fn new(
        (isometry1, shape1): (&'q Isometry<N, R, D>, &'a dyn Shape<N, D>),
        (isometry2, shape2): (&'q Isometry<N, R, D>, &'a dyn Shape<N, D>),
    ) -> Self {
        Self { one: (isometry1, shape1.geometry()), two: (isometry2, shape2.geometry()) }
    }

    /// The distance of the two, of which any that is not positive will do; `None` beyond `limit`, and if
    /// a pose is not finite.
    #[inline]
    pub(super) fn distance(&self, limit: N) -> Option<N> {
        match self.simple().and_then(|simple| simple.separation(limit)) {
            Some(found) => found.map(|found| found.distance),
            None => self.placed(N::tables().distance_in_world, limit),
        }
    }

    /// The separation of the two in the world frame, as their arguments are ordered; `None` beyond `limit`,
    /// and if a pose is not finite. What has no closed form is asked of them where they are placed.
    #[inline]
    pub(super) fn separation(
        &self,
        limit: N,
        otherwise: OfPlaced<N, Separation<N, D>, D>,
    ) -> Option<Separation<N, D>> {
        let simple = self.simple();
        let known = simple.as_ref().and_then(|simple| simple.separation(limit));
        let (Some(simple), Some(found)) = (simple, known) else {
            return self.placed(otherwise, limit);
        };
        let found = simple.in_world(&found?);
        Some(if simple.swapped { found.swapped() } else { found })
    }

    /// The nearest points of the two with what they lie on.
    pub(super) fn witness(&self, limit: N) -> Option<Witness<N, D>> {
        let simple = self.simple();
        let known = simple.as_ref().and_then(|simple| simple.separation(limit));
        let (Some(simple), Some(found)) = (simple, known) else {
            return self.placed(N::tables().witness_in_world, limit);
        };
        let found = found.filter(|found| found.distance.is_finite_number())?;
        let features = (N::tables().witness_features)(&simple.pair(), &found);
        let witness = Witness::joined(&simple.in_world(&found), [0, 0], features);
        Some(if simple.swapped { witness.flipped() } else { witness })
    }

    /// They are certainly farther apart than `limit`. Not told of half-spaces, which have no end, and of two
    /// balls, whose distance costs no more.
    #[inline]
    pub(super) fn are_beyond(&self, limit: N) -> bool {
        if let (Kind::Plane(_), _) | (_, Kind::Plane(_)) | (Kind::Ball(_), Kind::Ball(_)) =
            (self.one.1.0, self.two.1.0)
        {
            return false;
        }
        let between = self.two.0.translation.vector - self.one.0.translation.vector;
        (N::tables().are_beyond)(&Apart { shapes: [self.one.1, self.two.1], between }, limit)
    }

    /// Asks them where they are placed.
    #[inline]
    fn placed<A>(&self, ask: OfPlaced<N, A, D>, limit: N) -> Option<A> {
        let [one, two] = [&self.one, &self.two];
        let placed1 = Placed { pose: Pose::from_isometry(one.0), shape: one.1 };
        let placed2 = Placed { pose: Pose::from_isometry(two.0), shape: two.1 };
        ask(&placed1, &placed2, limit)
    }

    /// The two in order, if one of them may make a closed form of it.
    #[inline]
    fn simple(&self) -> Option<Simple<'q, 'a, N, R, D>> {
        let (one, two) = (self.one, self.two);
        let (kind1, kind2) = (one.1.kind(), two.1.kind());
        let is_simple = |kind| matches!(kind, ShapeKind::Ball | ShapeKind::Plane);
        if !(is_simple(kind1) || is_simple(kind2)) {
            return None;
        }
        let [x1, x2] = [one.0, two.0].map(|isometry| isometry.translation.vector[0]);
        let swapped = match x1.partial_cmp(&x2) {
            _ if kind1 != kind2 => kind1 > kind2,
            Some(Ordering::Less) => false,
            Some(Ordering::Greater) => true,
            _ => is_swapped_at_length(&one, &two),
        };
        let (first, second) = if swapped { (two, one) } else { (one, two) };
        Some(Simple { first, second, swapped })
    }
}

impl<'a, N: Space<D>, R: AbstractRotation<N, D>, const D: usize> Simple<'_, 'a, N, R, D> {
    /// A separation in the frame of the first, in the world.
    #[inline]
    fn in_world(&self, found: &Separation<N, D>) -> Separation<N, D> {
        let (isometry, distance) = (self.first.0, found.distance);
        let outward = |v: &Vector<N, D>| self.out_of_first(v);
        let place = |p: &Point<N, D>| Point::from(outward(&p.coords) + isometry.translation.vector);
        let normal = outward(&found.normal);
        Separation { distance, normal, point1: place(&found.point1), point2: place(&found.point2) }
    }

    /// The two as algorithms see them.
    fn pair(&self) -> Pair<'a, N, D> {
        let [at1, at2] =
            [self.first, self.second].map(|(isometry, _)| Pose::from_isometry(isometry));
        let pose12 = match self.first.1.0 {
            Kind::Ball(_) => Pose { rotation: at2.rotation, translation: self.between() },
            _ => Pose::relative(&at1, &at2),
        };
        Pair { first: self.first.1.0, second: self.second.1.0, pose12 }
    }

    /// The separation of the two in the frame of the first, where that takes less than their poses.
    #[inline]
    fn separation(&self, limit: N) -> Option<Option<Separation<N, D>>> {
        match (self.first.1.0, self.second.1.0) {
            (Kind::Ball(ball1), Kind::Ball(ball2)) => Some(self.of_balls([ball1, ball2], limit)),
            (Kind::Ball(ball), kind) => self.of_ball(ball, kind, limit),
            (_, Kind::Plane(plane)) => {
                let solid = self.first.1.as_support_map()?;
                let normal = self.to_first(&self.out_of_second(plane.normal()));
                let place = self.to_first(&self.between());
                let is_known = is_finite(&(normal + place));
                Some(if is_known { of_half_space(solid, &normal, &place, limit) } else { None })
            }
            _ => None,
        }
    }

    #[inline]
    fn of_balls(&self, [ball1, ball2]: [&Ball<N>; 2], limit: N) -> Option<Separation<N, D>> {
        let [isometry1, isometry2] = [self.first.0, self.second.0];
        let center2 = self.between();
        let found = of_balls([ball1.radius(), ball2.radius()], &center2, limit, |axis| {
            isometry1.rotation.transform_vector(&axis)
        })?;
        let unknown = not_finite(&isometry1.rotation) + not_finite(&isometry2.rotation);
        is_finite(&(center2 + unknown)).then_some(found)
    }

    #[inline]
    fn of_ball(
        &self,
        ball: &Ball<N>,
        kind: Kind<'a, N, D>,
        limit: N,
    ) -> Option<Option<Separation<N, D>>> {
        let rotation = &self.second.0.rotation;
        let center = rotation.inverse_transform_vector(&-self.between());
        if !is_finite(&(center + not_finite(&self.first.0.rotation))) {
            return Some(None);
        }
        let seen = (N::tables().seen)(kind, &Point::from(center))?;
        let distance = seen.distance - ball.radius();
        Some((distance <= limit).then(|| {
            let normal = -rotation.transform_vector(&seen.outward);
            let point1 = Point::from(normal * ball.radius());
            let place = rotation.transform_vector(&seen.point.coords);
            Separation { distance, normal, point1, point2: Point::from(place + self.between()) }
        }))
    }

    /// From the first's origin to the second's, in the world.
    #[inline]
    fn between(&self) -> Vector<N, D> {
        self.second.0.translation.vector - self.first.0.translation.vector
    }

    /// A direction in the frame of the first, in the world.
    #[inline]
    fn out_of_first(&self, v: &Vector<N, D>) -> Vector<N, D> {
        match self.first.1.0 {
            Kind::Ball(_) => *v,
            _ => self.first.0.rotation.transform_vector(v),
        }
    }

    #[inline]
    fn to_first(&self, v: &Vector<N, D>) -> Vector<N, D> {
        self.first.0.rotation.inverse_transform_vector(v)
    }

    #[inline]
    fn out_of_second(&self, v: &Vector<N, D>) -> Vector<N, D> {
        self.second.0.rotation.transform_vector(v)
    }
}

/// Of shapes of one kind that their first coordinates do not tell apart.
#[cold]
fn is_swapped_at_length<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    one: &At<'_, '_, N, R, D>,
    two: &At<'_, '_, N, R, D>,
) -> bool {
    is_swapped(&Pose::from_isometry(one.0), one.1, &Pose::from_isometry(two.0), two.1)
}

/// Zero; NaN if the rotation is not finite.
#[inline]
fn not_finite<N: Real, R: AbstractRotation<N, D>, const D: usize>(rotation: &R) -> Vector<N, D> {
    // All of its numbers are in there.
    rotation.transform_vector(&Vector::<N, D>::repeat(N::ONE)) * N::ZERO
}

/// No component is NaN or infinite.
#[inline]
fn is_finite<N: Real, const D: usize>(v: &Vector<N, D>) -> bool {
    (0..D).fold(N::ZERO, |sum, axis| sum + v[axis] * N::ZERO) == N::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Isometry2, Isometry3, Unit};
    use crate::query::separation::in_world;
    use crate::shape::{
        Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Plane, Rounded, Segment,
        Triangle,
    };

    type Solids<const D: usize> = Vec<Box<dyn Shape<f64, D>>>;

    /// In the order of the arguments and in the other, as where they are placed, up to rounding.
    fn as_placed<R: AbstractRotation<f64, D>, const D: usize>(
        solids: &Solids<D>,
        places: &[Isometry<f64, R, D>],
    ) where
        f64: Space<D>,
    {
        let mut count = 0;
        let each = solids.iter().flat_map(|one| solids.iter().map(move |two| (one, two)));
        for ((one, two), (m1, m2)) in each.flat_map(|pair| {
            places.iter().flat_map(move |m1| places.iter().map(move |m2| (pair, (m1, m2))))
        }) {
            let asked = Asked::new((m1, &**one), (m2, &**two));
            let Some(simple) = asked.simple() else { continue };
            let Some(Some(local)) = simple.separation(f64::INFINITY) else { continue };
            let found = asked.separation(f64::INFINITY, in_world::<f64, D>).expect("the same");
            let expected = asked.placed(in_world::<f64, D>, f64::INFINITY).expect("finite");
            let off = (found.point1 - expected.point1).norm()
                + (found.point2 - expected.point2).norm()
                + (found.normal - expected.normal).norm()
                + (found.distance - expected.distance).abs();
            assert!(off < 1e-11, "{one:?} at {:?}, {two:?}: {off}", asked.two.1);
            assert_eq!(asked.distance(f64::INFINITY), Some(local.distance), "one number");
            count += 1;
            // One solid at one place has no order.
            if core::ptr::eq(one, two) && m1 == m2 {
                continue;
            }
            let swapped = Asked::new((m2, &**two), (m1, &**one));
            let swapped = swapped.separation(f64::INFINITY, in_world::<f64, D>).expect("finite");
            assert_eq!(swapped.swapped(), found, "swapped");
        }
        assert!(count > 100, "{count} have a closed form");
    }

    #[test]
    fn closed_forms_are_what_placed_solids_say_in_the_plane() {
        let p = |x: f64, y: f64| Point::<f64, 2>::new(x, y);
        let corners = [p(0.0, -1.0), p(1.2, 0.3), p(-0.4, 1.0)];
        let solids: Solids<2> = vec![
            Box::new(Ball::new(0.5)),
            Box::new(Ball::new(0.25)),
            Box::new(Segment::new(corners[0], corners[1])),
            Box::new(Capsule::<f64, 2>::new(0.7, 0.2)),
            Box::new(Triangle::new(corners[0], corners[1], corners[2])),
            Box::new(Cuboid::new(Vector::<f64, 2>::new(0.5, 0.8))),
            Box::new(Rounded::new(Cuboid::new(Vector::<f64, 2>::new(0.5, 0.3)), 0.1)),
            Box::new(ConvexPolygon::from_points(&corners)),
            Box::new(Plane::new(Unit::new_normalize(Vector::<f64, 2>::new(0.3, 1.0)))),
        ];
        let places = [(0.1, 0.2, 0.3), (2.5, -1.0, -2.0), (-0.6, 0.7, 1.1), (1e3, 2e3, 0.0)]
            .map(|(x, y, angle)| Isometry2::new(Vector::<f64, 2>::new(x, y), angle));
        as_placed(&solids, &places);
    }

    #[test]
    fn closed_forms_are_what_placed_solids_say_in_space() {
        let p = |x: f64, y: f64, z: f64| Point::<f64, 3>::new(x, y, z);
        let corners = [p(0.0, -1.0, 0.1), p(1.2, 0.3, 0.0), p(-0.4, 1.0, -0.2), p(0.2, 0.1, 1.0)];
        let solids: Solids<3> = vec![
            Box::new(Ball::new(0.5)),
            Box::new(Ball::new(0.25)),
            Box::new(Segment::new(corners[0], corners[1])),
            Box::new(Capsule::<f64, 3>::new(0.7, 0.2)),
            Box::new(Triangle::new(corners[0], corners[1], corners[2])),
            Box::new(Cuboid::new(Vector::<f64, 3>::new(0.5, 0.8, 0.3))),
            Box::new(Rounded::new(Cuboid::new(Vector::<f64, 3>::new(0.5, 0.3, 0.2)), 0.1)),
            Box::new(Cylinder::new(0.6, 0.4)),
            Box::new(Cone::new(0.6, 0.4)),
            Box::new(ConvexHull::from_points(&corners)),
            Box::new(Plane::new(Unit::new_normalize(Vector::<f64, 3>::new(0.3, 1.0, -0.2)))),
        ];
        let places = [(0.1, 0.3), (2.5, -2.0), (-0.6, 1.1), (1e3, 0.0)].map(|(x, angle)| {
            let turn = Vector::<f64, 3>::new(0.2, -0.7, 0.5) * angle;
            Isometry3::new(Vector::<f64, 3>::new(x, 0.4 * x + 0.1, 0.2 - 0.3 * x), turn)
        });
        as_placed(&solids, &places);
    }
}
