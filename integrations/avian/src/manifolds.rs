//! Converts impinge's contacts to the numbers that both crates of Avian use.

use core::hash::{Hash, Hasher};

use bevy_impinge::Glam;
use impinge::math::{Point, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher,
};
use impinge::query::{Contact, ContactId, ManifoldView};
use impinge::shape::{FeatureId, Shape};

use crate::Collider;
use crate::collider::{Isometry, Vec_};
use crate::pairs::PairState;
use crate::scaling::Dimension;

/// Two placed colliders. Their frame has the axes of the global frame and its origin at the first
/// collider's position, so contacts far from the global origin lose no digits.
pub(crate) struct Meeting<'a, const D: usize>
where
    f32: Dimension<D>,
{
    /// `None` if a collider has an error.
    shapes: Option<[&'a dyn Shape<f32, D>; 2]>,
    /// The poses of both colliders: the first has translation zero, the second is relative to the
    /// first position.
    poses: [Isometry<D>; 2],
    has_parts: bool,
}

/// A contact point in the form of Avian.
pub(crate) struct Touch<const D: usize>
where
    f32: Dimension<D>,
{
    /// The midpoint between the two surfaces, relative to the origin of each collider.
    pub(crate) anchors: [Vec_<D>; 2],
    /// The penetration depth, positive if the shapes overlap.
    pub(crate) penetration: f32,
    /// Avian's two feature ids, by which it matches a point with the points of the last step;
    /// neither is zero.
    pub(crate) name: [u32; 2],
}

impl<'a, const D: usize> Meeting<'a, D>
where
    f32: Dimension<D>,
{
    pub(crate) fn new(colliders: [&'a Collider<D>; 2], poses: [Isometry<D>; 2]) -> Self {
        let shapes = match colliders.map(Collider::shape_scaled) {
            [Ok(shape1), Ok(shape2)] => Some([&**shape1, &**shape2]),
            _ => None,
        };
        let is_composite = |shape: &&dyn Shape<f32, D>| shape.geometry().as_composite().is_some();
        let has_parts = shapes.is_some_and(|shapes| shapes.iter().any(is_composite));
        Self { shapes, poses, has_parts }
    }

    /// Whether either shape is a composite, whose contacts move from part to part.
    pub(crate) fn has_parts(&self) -> bool {
        self.has_parts
    }

    /// Computes the manifolds of the pair up to the distance `prediction`, without state, and passes
    /// each to `write`.
    pub(crate) fn contacts(&self, prediction: f32, write: impl FnMut(ManifoldView<'_, f32, D>)) {
        let Some(shapes) = self.shapes else { return };
        f32::each_manifold(&self.poses, shapes, &ahead(prediction), write);
    }

    /// Updates `state` and passes each manifold of the pair up to the distance `prediction` to
    /// `write`.
    pub(crate) fn update(
        &self,
        state: &mut PairState<D>,
        prediction: f32,
        write: impl FnMut(ManifoldView<'_, f32, D>),
    ) {
        let Some([shape1, shape2]) = self.shapes else { return };
        let ([pose1, pose2], prediction) = (&self.poses, ahead(prediction));
        let dispatcher = DefaultContactDispatcher::<D>::new();
        let PairState { generator, ids } = state;
        generator.update(&dispatcher, pose1, shape1, pose2, shape2, &prediction, ids);
        let mut manifolds = Vec::new();
        if generator.num_contacts() > 0 {
            generator.contacts(&mut manifolds);
        }
        manifolds.into_iter().filter_map(ManifoldView::of_manifold).for_each(write);
    }

    /// Returns the points of a manifold.
    pub(crate) fn touches<'v>(
        &self,
        manifold: ManifoldView<'v, f32, D>,
    ) -> impl Iterator<Item = Touch<D>> + use<'v, D> {
        let between: Vector<f32, D> = f32::translation(&self.poses[1]);
        let (has_parts, mut names) = (self.has_parts, FeatureNames::default());
        manifold.contacts().map(move |point| {
            let name = if has_parts {
                own_name(point.id)
            } else {
                names.next([point.feature1, point.feature2])
            };
            touch(&point.contact, &between, name)
        })
    }
}

/// Returns the prediction for a distance. A negative or NaN distance counts as zero: only touching
/// shapes have contacts.
fn ahead(prediction: f32) -> ContactPrediction<f32> {
    ContactPrediction::new(prediction.max(0.0), 0.0, 0.0)
}

/// Converts a contact; `between` is the vector from the first origin to the second.
fn touch<const D: usize>(
    contact: &Contact<f32, D>,
    between: &Vector<f32, D>,
    name: [u32; 2],
) -> Touch<D>
where
    f32: Dimension<D>,
{
    let middle: Point<f32, D> = impinge::math::na::center(&contact.world1, &contact.world2);
    let anchors = [middle.coords, middle.coords - between].map(|anchor| f32::vec(&anchor));
    Touch { anchors, penetration: contact.depth, name }
}

/// Encodes the features of the points of one manifold of two convex shapes as Avian does: the kind
/// in the two upper bits. The four bits below count the earlier points with equal features, such as
/// the points of a round cap.
#[derive(Default)]
struct FeatureNames {
    /// The features of the first points, of which two convex shapes have at most four.
    earlier: [Option<[FeatureId; 2]>; 4],
    count: usize,
}

impl FeatureNames {
    /// Returns the ids of the next point, which lies on these features.
    fn next(&mut self, features: [FeatureId; 2]) -> [u32; 2] {
        let equal = self.earlier.iter().filter(|earlier| **earlier == Some(features)).count();
        if let Some(slot) = self.earlier.get_mut(self.count) {
            *slot = Some(features);
        }
        self.count += 1;
        let code =
            |kind: u32, number: u32| kind << 30 | (equal as u32 & 0xF) << 26 | number & 0x3FF_FFFF;
        features.map(|feature| match feature {
            FeatureId::Vertex(number) => code(1, number),
            FeatureId::Edge(number) => code(2, number),
            FeatureId::Face(number) => code(3, number),
        })
    }
}

/// Encodes a contact id as two feature ids. Avian matches two points if both of their ids agree, in either order, so
/// both ids are bits of one hash.
fn own_name(id: ContactId) -> [u32; 2] {
    let mut hasher = Fnv(0xCBF2_9CE4_8422_2325);
    id.hash(&mut hasher);
    let hash = hasher.finish();
    // The two upper bits are Avian's kind of feature; 0 is no kind. An id of 0 would be `UNKNOWN`,
    // so it becomes 1.
    [hash, hash >> 32].map(|half| (half as u32 & 0x3FFF_FFFF).max(1))
}

/// The hash FNV-1a of Fowler, Noll and Vo, with a final step that mixes the upper bits into the
/// lower bits.
struct Fnv(u64);

impl Hasher for Fnv {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }

    fn finish(&self) -> u64 {
        (self.0 ^ (self.0 >> 29)).wrapping_mul(0x9E37_79B9_7F4A_7C15)
    }
}
