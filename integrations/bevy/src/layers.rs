//! Components in addition to the collider: collision layers, sensors, and fixed colliders.

use bevy_ecs::prelude::Component;
use impinge::world::{CollisionGroups, GroupError};

/// Collision layers: two colliders interact if the memberships of each overlap the filters of the
/// other.
///
/// Layers are the bits 0 to 29 of masks. A collider without this component is a member of all layers and interacts
/// with all. The component may be changed at any time; pairs that are no longer allowed end at the next step.
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
    /// Layers of a collider that is a member of no layer and interacts with no layer.
    pub const NONE: Self = Self { memberships: 0, filters: 0 };

    /// Creates the layers of a collider that is a member of the layers in `memberships`, and
    /// interacts with members of the layers in `filters`.
    ///
    /// # Panics
    /// If bit 30 or 31 of a mask is set; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(memberships: u32, filters: u32) -> Self {
        match Self::try_new(memberships, filters) {
            Ok(layers) => layers,
            Err(error) => panic!("{error}"),
        }
    }

    /// Creates the layers of a collider that is a member of the layers in `memberships`, and
    /// interacts with members of the layers in `filters`.
    ///
    /// # Errors
    /// If bit 30 or 31 of a mask is set.
    pub fn try_new(memberships: u32, filters: u32) -> Result<Self, GroupError> {
        let groups = CollisionGroups::new().try_with_membership_by_mask(memberships)?;
        groups.try_with_whitelist_by_mask(filters)?;
        Ok(Self { memberships, filters })
    }

    /// The mask of the layers to which the collider belongs.
    #[must_use]
    pub const fn memberships(&self) -> u32 {
        self.memberships
    }

    /// The mask of the layers with whose members the collider interacts.
    #[must_use]
    pub const fn filters(&self) -> u32 {
        self.filters
    }

    /// Whether two colliders with these layers may interact. Symmetric.
    #[must_use]
    pub const fn can_meet(&self, other: &Self) -> bool {
        self.memberships & other.filters != 0 && other.memberships & self.filters != 0
    }

    /// Converts to groups of the library.
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

/// A marker: the collider reports overlaps, without contact points, and does not block characters.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sensor;

/// A marker: two colliders with this marker have no pair, so the static parts of a level cost
/// nothing. A fixed collider may still be moved.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedCollider;
