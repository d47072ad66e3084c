//! Contact manifolds of two placed shapes, without a world and without state.

use super::generator::{PairContacts, conforming_points};
use super::traits::ContactPrediction;
use crate::collide::{AtIsometry, Placed, Solid};
use crate::math::{AbstractRotation, Isometry, IsometryRef, Mapped, Space};
use crate::query::{ContactManifold, ManifoldView};
use crate::shape::Shape;
use crate::tables::entries;

/// Returns the contact manifolds of `g1` placed at `m1` and `g2` placed at `m2`. They have the same
/// bits as those of a new world after its first update.
///
/// Two convex shapes have one manifold, and composites have one for each flat patch of contact;
/// none is empty. The list is empty if the shapes are farther apart than
/// [`ContactPrediction::linear`], if a pose is not finite, and for half-spaces that overlap without
/// bound. In a world the prediction of a pair is the sum of the predictions of both objects.
///
/// A manifold has at most `max_points` points (0 means 1); by default (`None`) two in 2D and four
/// in 3D. Points, normals and depths are in the world frame; normals point from the first shape to
/// the second. Swapping the shapes flips each manifold and changes nothing else.
///
/// Nothing is kept between calls. A [`ContactId`](crate::query::ContactId) identifies a contact
/// within one result only; ids that persist under motion come from a world or a
/// [`PairManifoldGenerator`](super::PairManifoldGenerator). For many pairs,
/// [`PairBatch::manifolds`](crate::batch::PairBatch::manifolds) is faster.
///
/// ```
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::query::{ContactPrediction, contact_manifolds};
/// use impinge::dim3::shape::Cuboid;
///
/// let (floor, parcel) = (Cuboid::new(Vector::new(9.0_f64, 1.0, 9.0)), Cuboid::new(Vector::repeat(0.5)));
/// let (here, there) = (Isometry::identity(), Isometry::translation(2.0, 1.5625, 0.0));
/// let near = ContactPrediction::new(0.125, 0.0, 0.0);
/// let manifolds = contact_manifolds(&here, &floor, &there, &parcel, &near, None);
/// assert_eq!((manifolds.len(), manifolds[0].len()), (1, 4), "the corners of a face");
/// let deepest = manifolds[0].deepest_contact().expect("four").contact;
/// assert_eq!((deepest.depth, deepest.normal.y), (-0.0625, 1.0), "above the floor");
///
/// let none = ContactPrediction::new(0.0, 0.0, 0.0);
/// assert!(contact_manifolds(&here, &floor, &there, &parcel, &none, None).is_empty());
/// ```
pub fn contact_manifolds<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    g2: &dyn Shape<N, D>,
    prediction: &ContactPrediction<N>,
    max_points: Option<usize>,
) -> Vec<ContactManifold<N, D>> {
    let mut manifolds = Vec::new();
    each_contact_manifold(m1, g1, m2, g2, prediction, max_points, |view| {
        manifolds.push(view.to_manifold());
    });
    manifolds
}

/// Calls `each` with a view of each manifold that [`contact_manifolds`] returns, in the same order.
///
/// For callers that need points, normals and depths alone: kinematics are not computed, and no list
/// of manifolds is built.
///
/// ```
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::query::{ContactPrediction, each_contact_manifold};
/// use impinge::dim3::shape::Cuboid;
///
/// let (floor, parcel) = (Cuboid::new(Vector::new(9.0_f64, 1.0, 9.0)), Cuboid::new(Vector::repeat(0.5)));
/// let (here, there) = (Isometry::identity(), Isometry::translation(2.0, 1.5625, 0.0));
/// let (near, mut depths) = (ContactPrediction::new(0.125, 0.0, 0.0), Vec::new());
/// each_contact_manifold(&here, &floor, &there, &parcel, &near, None, |manifold| {
///     depths.extend(manifold.contacts().map(|point| point.contact.depth));
/// });
/// assert_eq!(depths, [-0.0625; 4]);
/// ```
pub fn each_contact_manifold<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    g2: &dyn Shape<N, D>,
    prediction: &ContactPrediction<N>,
    max_points: Option<usize>,
    mut each: impl FnMut(ManifoldView<'_, N, D>),
) {
    let (isometry1, isometry2, each) = (R::view(m1), R::view(m2), &mut each);
    entries::each_contact_manifold(isometry1, g1, isometry2, g2, prediction, max_points, each);
}

/// Implements [`each_contact_manifold`]. The pair identifier in the contact ids is 0.
pub(crate) fn each_manifold_at<N: Space<D>, const D: usize>(
    isometry1: IsometryRef<'_, N, D>,
    shape1: &dyn Shape<N, D>,
    isometry2: IsometryRef<'_, N, D>,
    shape2: &dyn Shape<N, D>,
    prediction: &ContactPrediction<N>,
    max_points: Option<usize>,
    each: &mut dyn FnMut(ManifoldView<'_, N, D>),
) {
    let (one, other) = (AtIsometry::new(isometry1, shape1), AtIsometry::new(isometry2, shape2));
    let Some(placed) = Placed::within(&one, &other, prediction.linear()) else { return };
    if !placed.iter().all(|placed| placed.pose.is_finite()) {
        return;
    }
    let request = prediction.request(max_points.unwrap_or(conforming_points::<D>()).max(1));
    let has_composite = placed.iter().any(|placed| placed.shape.as_composite().is_some());
    let mut contacts = PairContacts::new(has_composite);
    let (poses, shapes) =
        (placed.each_ref().mapped(|placed| placed.pose), placed.map(|placed| placed.shape));
    let [one, other] = shapes.mapped(Solid::of);
    contacts.update((&poses, shapes), [one.as_ref(), other.as_ref()], &request);
    contacts.each_view(&placed, 0, each);
}
