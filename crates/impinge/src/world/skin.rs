//! Contact skins: distances by which shapes are grown when their contacts are computed.

use super::entries;
use super::error::or_panic;
use super::{CollisionWorld, WorldError};
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;

/// Contact skins.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Sets the skin of an object: contacts are computed as if its shape were grown by this
    /// distance, with rounded edges, without building such a shape. Zero, the default, removes the
    /// skin.
    ///
    /// Contacts are those of the grown solids: `world1` and `world2` are on the grown surfaces, and
    /// `depth` exceeds the depth of the shapes by the sum of both skins. Normals and features are
    /// those of the shapes; kinematics include the skins. There are contact points, and the pair is
    /// in contact, while the grown solids overlap or are no farther apart than the sum of the
    /// predictions. So a solver that brings depths to zero keeps the shapes apart by the sum of
    /// both skins. At that distance normals are exact and cheap. This corresponds to the
    /// `contact_skin` of rapier, the radius of a polygon in Box2D, and the dilation of ncollide. It
    /// works for any shape: each part of a composite is grown.
    ///
    /// Proximities, queries and the algorithms of a custom dispatcher ignore the skin. Takes effect
    /// at the next update; contacts keep their ids. Costs nothing in a world without skins. The box
    /// of an object with a skin is larger by the skin, and its manifolds are built on first access.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Vector};
    /// use impinge::dim3::shape::{Cuboid, ShapeHandle};
    /// use impinge::dim3::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::<f64, ()>::new(0.02);
    /// let (cube, groups) =
    ///     (ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0, 1.0))), CollisionGroups::new());
    /// let [a, b] = [0.0, 2.25].map(|y| {
    ///     let position = Isometry::translation(0.0, y, 0.0);
    ///     world.add(position, cube.clone(), groups, ContactQuery::default(), ())
    /// });
    /// world.set_skin(a, 0.25);
    /// world.set_skin(b, 0.125);
    /// world.update();
    /// for (_, point) in world.contacts_with(a) {
    ///     assert_eq!(point.contact.depth, 0.125, "a quarter apart, three eighths of skins");
    ///     assert_eq!((point.contact.world1.y, point.contact.world2.y), (1.25, 1.125));
    /// }
    /// assert_eq!(world.contacts_with(a).count(), 4);
    /// ```
    ///
    /// # Panics
    /// If the handle is stale, or the skin is negative or not finite; [`Self::try_set_skin`]
    /// returns an error instead.
    #[doc(alias = "contact_skin")]
    #[track_caller]
    pub fn set_skin(&mut self, handle: CollisionObjectHandle, skin: N) {
        or_panic(self.try_set_skin(handle, skin));
    }

    /// Sets the skin of an object; see [`Self::set_skin`].
    ///
    /// # Errors
    /// If the handle is stale, or the skin is negative or not finite. Then the world is unchanged.
    pub fn try_set_skin(
        &mut self,
        handle: CollisionObjectHandle,
        skin: N,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut(handle)?;
        if skin < N::ZERO || !skin.is_finite_number() {
            return Err(WorldError::Skin { handle, value: skin.as_f64() });
        }
        entries::set_skin(body, changes, skin);
        Ok(())
    }

    /// Returns the skin of an object, zero by default; `None` for a stale handle.
    #[must_use]
    pub fn skin(&self, handle: CollisionObjectHandle) -> Option<N> {
        self.objects.get(handle)?;
        Some(self.objects.changes.skin(handle.index()))
    }
}
