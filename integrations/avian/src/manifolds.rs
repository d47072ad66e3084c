//! From the contacts of impinge to numbers that either of Avian's crates takes.

use core::hash::{Hash, Hasher};

use bevy_impinge::Glam;
use impinge::math::{Point, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher,
};
use impinge::query::{ContactId, ContactManifold, TrackedContact};

use crate::Collider;
use crate::collider::{Isometry, Vec_};
use crate::pairs::PairState;
use crate::scaling::Dimension;

/// Two placed colliders, in a frame with the world's axes whose origin is that of the first collider: far from the
/// world's origin nothing is lost.
pub(crate) struct Meeting<'a, const D: usize>
where
    f32: Dimension<D>,
{
    pub(crate) colliders: [&'a Collider<D>; 2],
    /// Both rotations, with the place of the second beside the first.
    pub(crate) poses: [Isometry<D>; 2],
    /// Contacts up to this distance are wanted.
    pub(crate) prediction: f32,
}

/// A point of contact as Avian has it.
pub(crate) struct Touch<const D: usize>
where
    f32: Dimension<D>,
{
    /// The middle between the two surfaces, from the origin of either collider.
    pub(crate) anchors: [Vec_<D>; 2],
    /// Positive if they overlap.
    pub(crate) penetration: f32,
    /// The name of the contact, in two numbers of 30 bits; neither is zero.
    pub(crate) name: [u32; 2],
}

impl<const D: usize> Meeting<'_, D>
where
    f32: Dimension<D>,
{
    /// Brings the contacts of the pair up to date and calls `read` with its manifolds, none of which is empty.
    pub(crate) fn update(
        &self,
        state: &mut PairState<D>,
        read: impl FnOnce(&[&ContactManifold<f32, D>]),
    ) {
        let [Ok(shape1), Ok(shape2)] = self.colliders.map(Collider::shape_scaled) else {
            return read(&[]);
        };
        // A margin that is NaN or negative asks for what touches.
        let prediction = ContactPrediction::new(self.prediction.max(0.0), 0.0, 0.0);
        let [pose1, pose2] = &self.poses;
        let dispatcher = DefaultContactDispatcher::<D>::new();
        let PairState { generator, ids } = state;
        generator.update(&dispatcher, pose1, &**shape1, pose2, &**shape2, &prediction, ids);
        let mut manifolds = Vec::new();
        generator.contacts(&mut manifolds);
        read(&manifolds);
    }

    /// The normal of a manifold, from the first collider to the second.
    pub(crate) fn normal(manifold: &ContactManifold<f32, D>) -> Option<Vec_<D>> {
        manifold.contacts().first().map(|tracked| f32::vec(&tracked.contact.normal))
    }

    /// The points of a manifold.
    pub(crate) fn touches(
        &self,
        manifold: &ContactManifold<f32, D>,
    ) -> impl Iterator<Item = Touch<D>> {
        let between: Vector<f32, D> = f32::translation(&self.poses[1]);
        manifold.contacts().iter().map(move |tracked| touch(tracked, &between))
    }
}

/// `between` is the way from the first origin to the second.
fn touch<const D: usize>(tracked: &TrackedContact<f32, D>, between: &Vector<f32, D>) -> Touch<D>
where
    f32: Dimension<D>,
{
    let contact = &tracked.contact;
    let middle: Point<f32, D> = impinge::dim3::na::center(&contact.world1, &contact.world2);
    let anchors = [middle.coords, middle.coords - between].map(|anchor| f32::vec(&anchor));
    Touch { anchors, penetration: contact.depth, name: name(tracked.id) }
}

/// The name of a contact within its pair, spread over two numbers. Avian takes points for the same if both of their
/// features are, in either order, so both numbers are taken from a hash.
fn name(id: ContactId) -> [u32; 2] {
    let mut hasher = Fnv(0xCBF2_9CE4_8422_2325);
    id.hash(&mut hasher);
    let hash = hasher.finish();
    // The two upper bits are Avian's kinds of features, all of them zero: none. Zero in all is `UNKNOWN`.
    [hash, hash >> 32].map(|half| (half as u32 & 0x3FFF_FFFF).max(1))
}

/// The hash of Fowler, Noll and Vo, with a last step that brings the upper bits down.
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
