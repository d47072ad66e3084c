//! A contact: two points and a normal.

use crate::collide::{AtIsometry, Placed};
use crate::convex::Separation;
use crate::math::{AbstractRotation, Isometry, IsometryRef, Point, Real, Space, Unit, Vector};
use crate::shape::Shape;
use crate::tables::entries;

/// The nearest or deepest points of two solids that touch, overlap or are close, with the normal
/// and the depth, in the world frame.
///
/// `world2 = world1 − depth · normal` up to rounding.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::contact;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, there) = (Ball::new(1.0_f32), Isometry::translation(1.5, 0.0));
/// let found = contact(&Isometry::identity(), &ball, &there, &ball, 0.0).expect("they overlap");
/// assert_eq!((found.depth, *found.normal), (0.5, Vector::x()), "from the first to the second");
/// assert_eq!((found.world1.x, found.world2.x), (1.0, 0.5));
/// assert_eq!(found.flipped().world1, found.world2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<N: Real, const D: usize> {
    /// The point on the surface of the first solid.
    pub world1: Point<N, D>,
    /// The point on the surface of the second solid.
    pub world2: Point<N, D>,
    /// The unit vector from the first solid to the second.
    pub normal: Unit<Vector<N, D>>,
    /// The penetration depth along the normal: positive if the solids overlap, zero if they touch,
    /// minus the distance if they are apart.
    pub depth: N,
}

impl<N: Real, const D: usize> Contact<N, D> {
    /// Returns the contact of the solids inflated by the lengths `first` and `second`; its points
    /// are on the inflated surfaces.
    pub(crate) fn grown(&self, [first, second]: [N; 2]) -> Self {
        let normal = self.normal.into_inner();
        Self {
            world1: self.world1 + normal * first,
            world2: self.world2 - normal * second,
            normal: self.normal,
            depth: self.depth + (first + second),
        }
    }

    /// Returns the contact with the solids swapped.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self { world1: self.world2, world2: self.world1, normal: -self.normal, depth: self.depth }
    }
}

/// Returns the contact of two solids that overlap, touch, or are at most `prediction` apart.
///
/// If the solids overlap, the depth is the length of the shortest translation that separates them,
/// and the normal is the direction of that translation for the second solid. A distance equal to
/// `prediction` is within it. A negative `prediction` restricts the result to contacts of depth
/// `-prediction` or more. Returns `None` if the solids are farther apart, if `prediction` is NaN or
/// a pose is not finite, and for two half-spaces whose overlap is unbounded, as they have no depth.
///
/// For a composite the result is the deepest contact of its manifolds: the contact of a part, with
/// a normal of the whole surface ([`Surface`](crate::shape::Surface)). A one-sided surface has no
/// contacts from behind. The cost is the cost of [`distance`](crate::query::distance()) plus the
/// cost of the contacts of all parts that overlap.
///
/// ```
/// use impinge::math::{Isometry3, Vector};
/// use impinge::query::contact;
/// use impinge::shape::{Ball, Cuboid};
///
/// let floor = Cuboid::new(Vector::<f64, 3>::new(10.0, 1.0, 10.0));
/// let place = Isometry3::translation(0.0, 1.75, 0.0);
/// let found = contact(&Isometry3::identity(), &floor, &place, &Ball::new(1.0), 0.0);
/// let found = found.expect("the ball has sunk in");
/// assert_eq!((found.depth, found.normal.y), (0.25, 1.0));
/// ```
pub fn contact<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    g2: &dyn Shape<N, D>,
    prediction: N,
) -> Option<Contact<N, D>> {
    entries::contact(R::view(m1), g1, R::view(m2), g2, prediction)
}

/// Implements [`contact`] with poses by reference.
#[inline]
pub(crate) fn contact_at<N: Space<D>, const D: usize>(
    isometry1: IsometryRef<'_, N, D>,
    shape1: &dyn Shape<N, D>,
    isometry2: IsometryRef<'_, N, D>,
    shape2: &dyn Shape<N, D>,
    prediction: N,
) -> Option<Contact<N, D>> {
    let (one, other) = (AtIsometry::new(isometry1, shape1), AtIsometry::new(isometry2, shape2));
    let [placed1, placed2] = Placed::within(&one, &other, prediction)?;
    Contact::of_separation(&entries::contact_in_world(&placed1, &placed2, prediction)?)
}

impl<N: Real, const D: usize> Contact<N, D> {
    /// Converts a separation in the world frame to a contact; `None` for two half-spaces whose
    /// overlap is unbounded.
    #[inline]
    pub(crate) fn of_separation(found: &Separation<N, D>) -> Option<Self> {
        found.distance.is_finite_number().then(|| Self {
            world1: found.point1,
            world2: found.point2,
            normal: Unit::new_unchecked(found.normal),
            depth: -found.distance,
        })
    }
}
