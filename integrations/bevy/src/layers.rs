//! Components beside the collider: who may meet whom, sensors, and what does not move.

use bevy_ecs::prelude::Component;
use impinge::world::{CollisionGroups, GroupError};

/// Which colliders may meet: two do if each has a membership that the other filters for.
///
/// Layers are the bits 0 to 29 of masks. A collider without this component is a member of all and meets all. The
/// component may be changed at any time; pairs that are no longer allowed end at the next step.
///
/// ```
/// use bevy_impinge::CollisionLayers;
///
/// const PLAYER: u32 = 1 << 0;
/// const WALL: u32 = 1 << 1;
/// let player = CollisionLayers::new(PLAYER, WALL);
/// assert!(player.can_meet(&CollisionLayers::new(WALL, CollisionLayers::ALL)));
/// assert!(!player.can_meet(&player));
/// assert!(CollisionLayers::try_new(1 << 31, WALL).is_err(), "there are thirty");
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct CollisionLayers {
    memberships: u32,
    filters: u32,
}

impl CollisionLayers {
    /// The mask of all layers.
    pub const ALL: u32 = CollisionGroups::ALL;
    /// A member of nothing that meets nothing.
    pub const NONE: Self = Self { memberships: 0, filters: 0 };

    /// Member of the layers of the first mask, meets members of the second.
    ///
    /// # Panics
    /// On bit 30 or 31; [`Self::try_new`] returns it.
    #[must_use]
    #[track_caller]
    pub fn new(memberships: u32, filters: u32) -> Self {
        match Self::try_new(memberships, filters) {
            Ok(layers) => layers,
            Err(error) => panic!("{error}"),
        }
    }

    /// Member of the layers of the first mask, meets members of the second.
    ///
    /// # Errors
    /// On bit 30 or 31 of a mask.
    pub fn try_new(memberships: u32, filters: u32) -> Result<Self, GroupError> {
        let groups = CollisionGroups::new().try_with_membership_by_mask(memberships)?;
        groups.try_with_whitelist_by_mask(filters)?;
        Ok(Self { memberships, filters })
    }

    /// The layers that it is a member of.
    #[must_use]
    pub const fn memberships(&self) -> u32 {
        self.memberships
    }

    /// The layers whose members it meets.
    #[must_use]
    pub const fn filters(&self) -> u32 {
        self.filters
    }

    /// Two colliders with these layers may meet. Symmetric.
    #[must_use]
    pub const fn can_meet(&self, other: &Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }

    /// The groups of the library.
    pub(crate) fn groups(self) -> CollisionGroups {
        let groups = CollisionGroups::new().with_membership_by_mask(self.memberships);
        groups.with_whitelist_by_mask(self.filters)
    }
}

impl Default for CollisionLayers {
    fn default() -> Self {
        Self { memberships: Self::ALL, filters: Self::ALL }
    }
}

/// A marker: the collider reports what overlaps it, without contact points, and blocks no character.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sensor;

/// A marker: the collider has no pairs with others that have it, so that the parts of a level cost nothing. It may
/// still be moved.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedCollider;
