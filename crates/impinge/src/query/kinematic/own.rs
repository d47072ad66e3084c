//! Kinematics of contacts found by a user's algorithm.

use super::{ContactKinematic, NeighborhoodGeometry, NormalRule};
use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, Vector};
use crate::query::Contact;
use crate::shape::FeatureId;

/// The data of one solid in a contact found by a user's algorithm.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point, Unit, Vector};
/// use impinge::dim2::query::{Contact, ContactKinematic, ContactSide, NeighborhoodGeometry};
/// use impinge::dim2::shape::FeatureId;
///
/// let (world1, world2) = (Point::new(0.0_f64, 0.0), Point::new(0.0, 0.5));
/// let contact = Contact { world1, world2, normal: Unit::new_normalize(Vector::y()), depth: -0.5 };
/// let plane = NeighborhoodGeometry::Plane(Vector::y());
/// let floor = ContactSide { feature: FeatureId::Face(0), geometry: plane, rounding: 0.0 };
/// let corner = ContactSide::point(FeatureId::Vertex(0));
/// let here = Isometry::identity();
/// let kinematic = ContactKinematic::from_contact(&contact, (&here, floor), (&here, corner));
/// assert_eq!(kinematic.contact(&here, &Isometry::translation(3.0, -0.25)).depth, -0.25);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSide<N: Real, const D: usize> {
    /// The touching feature of the solid.
    pub feature: FeatureId,
    /// The local geometry of the solid's core at the contact, in the solid's local frame.
    pub geometry: NeighborhoodGeometry<N, D>,
    /// The radius by which the core is inflated; for a ball, whose core is a point, the ball's
    /// radius.
    pub rounding: N,
}

impl<N: Real, const D: usize> ContactSide<N, D> {
    /// Returns a corner, or a small piece of a curved surface: a point that is fixed to the solid.
    #[must_use]
    pub fn point(feature: FeatureId) -> Self {
        Self { feature, geometry: NeighborhoodGeometry::Point, rounding: N::ZERO }
    }
}

impl<N: Real, const D: usize> ContactKinematic<N, D> {
    /// Builds the kinematic of a user's contact, given in the world frame; `m1` and `m2` are the
    /// poses at which it was found.
    ///
    /// For these poses [`Self::contact`] returns the contact, up to rounding. For other poses the
    /// normal rotates with the solid whose side is flat. If both sides are flat, it rotates with
    /// the solid whose face normal is nearer to the contact's normal. If no side is flat, the
    /// normal is along the shortest connection of the cores, provided that this direction equals
    /// the contact's normal at `m1` and `m2`; else the normal rotates with the first solid.
    #[must_use]
    pub fn from_contact<R: AbstractRotation<N, D>>(
        contact: &Contact<N, D>,
        (m1, side1): (&Isometry<N, R, D>, ContactSide<N, D>),
        (m2, side2): (&Isometry<N, R, D>, ContactSide<N, D>),
    ) -> Self {
        let (pose1, pose2) = (Pose::from_isometry(m1), Pose::from_isometry(m2));
        let (normal1, local1) = core(&pose1, &contact.world1, &contact.normal, side1.rounding);
        let (normal2, local2) = core(&pose2, &contact.world2, &-contact.normal, side2.rounding);
        let mut kinematic = Self {
            feature1: side1.feature,
            feature2: side2.feature,
            local1,
            local2,
            geometry1: side1.geometry,
            geometry2: side2.geometry,
            rounding1: side1.rounding,
            rounding2: side2.rounding,
            normal1,
            normal2: -normal2,
            rule: NormalRule::Geometry,
            turns: [true; 2],
        };
        if !kinematic.reproduces(&Pose::relative(&pose1, &pose2)) {
            let tilt1 = tilt(&side1.geometry, &normal1);
            let is_second = tilt(&side2.geometry, &normal2) < tilt1;
            kinematic.rule = if is_second { NormalRule::Second } else { NormalRule::First };
        }
        kinematic
    }
}

/// Returns the outward direction and the core point below a surface point, both in the solid's
/// frame.
fn core<N: Real, const D: usize>(
    pose: &Pose<N, D>,
    surface: &Point<N, D>,
    outward: &Vector<N, D>,
    rounding: N,
) -> (Vector<N, D>, Point<N, D>) {
    let outward = pose.inverse_vector(outward);
    (outward, pose.inverse_point(surface) - outward * rounding)
}

/// Returns the tilt of a flat side: the length of the difference of its normal and `outward`. For a
/// side that is not flat returns 4, which exceeds every tilt.
fn tilt<N: Real, const D: usize>(
    geometry: &NeighborhoodGeometry<N, D>,
    outward: &Vector<N, D>,
) -> N {
    match geometry {
        NeighborhoodGeometry::Plane(normal) => (normal - outward).norm(),
        _ => N::lit(4.0),
    }
}
