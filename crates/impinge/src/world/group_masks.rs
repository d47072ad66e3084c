//! Groups built in one expression, from lists or from masks with one bit for each group.

use super::groups::{ALL_GROUPS, CollisionGroups, GroupError};

/// Returns the mask if it has neither bit 30 nor bit 31, which belong to no group; else an error
/// with the lower of the set bits.
fn checked(mask: u32) -> Result<u32, GroupError> {
    match mask & !ALL_GROUPS {
        0 => Ok(mask),
        beyond => Err(GroupError(beyond.trailing_zeros() as usize)),
    }
}

/// Returns the groups, or panics with the text of the error.
#[track_caller]
fn or_panic(result: Result<CollisionGroups, GroupError>) -> CollisionGroups {
    match result {
        Ok(groups) => groups,
        Err(error) => panic!("{error}"),
    }
}

/// Building groups from lists, in a chain of calls.
impl CollisionGroups {
    /// Creates groups with empty membership, whitelist and blacklist: the object interacts with
    /// nothing.
    #[must_use]
    pub const fn empty() -> Self {
        Self::of_masks(0, 0, 0)
    }

    /// Returns these groups with the membership replaced by `groups`.
    ///
    /// ```
    /// use impinge::world::CollisionGroups;
    ///
    /// let bullets = CollisionGroups::new().with_membership(&[2]).with_blacklist(&[2, 5]);
    /// assert!(bullets.can_interact_with_groups(&CollisionGroups::new().with_membership(&[1])));
    /// assert!(!bullets.can_interact_with_groups(&bullets));
    /// ```
    ///
    /// # Panics
    /// If a group is above 29; [`Self::try_set_membership`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn with_membership(mut self, groups: &[usize]) -> Self {
        self.set_membership(groups);
        self
    }

    /// Returns these groups with the whitelist replaced by `groups`.
    ///
    /// # Panics
    /// If a group is above 29; [`Self::try_set_whitelist`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn with_whitelist(mut self, groups: &[usize]) -> Self {
        self.set_whitelist(groups);
        self
    }

    /// Returns these groups with the blacklist replaced by `groups`.
    ///
    /// # Panics
    /// If a group is above 29; [`Self::try_set_blacklist`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn with_blacklist(mut self, groups: &[usize]) -> Self {
        self.set_blacklist(groups);
        self
    }
}

/// Building groups from masks: bit `g` is group `g`, for 0 to 29. Bits 30 and 31 are refused.
impl CollisionGroups {
    /// The mask of all groups, 0 to 29.
    pub const ALL: u32 = ALL_GROUPS;

    /// Returns these groups with the membership replaced by the groups in `mask`.
    ///
    /// ```
    /// use impinge::world::{CollisionGroups, GroupError};
    ///
    /// const PLAYER: u32 = 1 << 0;
    /// const WALL: u32 = 1 << 3;
    /// let player = CollisionGroups::new().with_membership_by_mask(PLAYER).with_whitelist_by_mask(WALL);
    /// let wall = CollisionGroups::new().with_membership_by_mask(WALL);
    /// assert!(player.can_interact_with_groups(&wall));
    /// assert!(!player.can_interact_with_groups(&player));
    /// assert_eq!(wall.membership_mask(), WALL);
    /// assert_eq!(wall.whitelist_mask(), CollisionGroups::ALL);
    /// assert_eq!(player.try_with_membership_by_mask(1 << 31), Err(GroupError(31)));
    /// ```
    ///
    /// # Panics
    /// If the mask has bit 30 or 31; [`Self::try_with_membership_by_mask`] returns an error
    /// instead.
    #[must_use]
    #[track_caller]
    pub fn with_membership_by_mask(self, mask: u32) -> Self {
        or_panic(self.try_with_membership_by_mask(mask))
    }

    /// Returns these groups with the membership replaced by the groups in `mask`.
    ///
    /// # Errors
    /// If the mask has bit 30 or 31; the error has the lower of these bits.
    pub fn try_with_membership_by_mask(self, mask: u32) -> Result<Self, GroupError> {
        let source = Self::of_masks(checked(mask)?, 0, 0);
        let mut groups = self;
        groups.copy_membership(&source);
        Ok(groups)
    }

    /// Returns these groups with the whitelist replaced by the groups in `mask`.
    ///
    /// # Panics
    /// If the mask has bit 30 or 31; [`Self::try_with_whitelist_by_mask`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn with_whitelist_by_mask(self, mask: u32) -> Self {
        or_panic(self.try_with_whitelist_by_mask(mask))
    }

    /// Returns these groups with the whitelist replaced by the groups in `mask`.
    ///
    /// # Errors
    /// If the mask has bit 30 or 31; the error has the lower of these bits.
    pub fn try_with_whitelist_by_mask(self, mask: u32) -> Result<Self, GroupError> {
        let source = Self::of_masks(0, checked(mask)?, 0);
        let mut groups = self;
        groups.copy_whitelist(&source);
        Ok(groups)
    }

    /// Returns these groups with the blacklist replaced by the groups in `mask`.
    ///
    /// # Panics
    /// If the mask has bit 30 or 31; [`Self::try_with_blacklist_by_mask`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn with_blacklist_by_mask(self, mask: u32) -> Self {
        or_panic(self.try_with_blacklist_by_mask(mask))
    }

    /// Returns these groups with the blacklist replaced by the groups in `mask`.
    ///
    /// # Errors
    /// If the mask has bit 30 or 31; the error has the lower of these bits.
    pub fn try_with_blacklist_by_mask(self, mask: u32) -> Result<Self, GroupError> {
        let source = Self::of_masks(0, 0, checked(mask)?);
        let mut groups = self;
        groups.copy_blacklist(&source);
        Ok(groups)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_and_lists_are_the_same_groups() {
        for list in [&[][..], &[0], &[29], &[3, 17, 29]] {
            let mask = list.iter().fold(0, |mask, group| mask | 1_u32 << group);
            let mut groups = CollisionGroups::new();
            groups.enable_self_collision();
            let lists = groups.with_membership(list).with_whitelist(list).with_blacklist(list);
            let masks = groups
                .with_membership_by_mask(mask)
                .with_whitelist_by_mask(mask)
                .with_blacklist_by_mask(mask);
            assert_eq!(lists, masks, "{list:?}");
            let read = [masks.membership_mask(), masks.whitelist_mask(), masks.blacklist_mask()];
            assert_eq!(read, [mask; 3], "as they were given, without the bit for self-collision");
            assert!(masks.can_interact_with_self(), "which stays");
        }
        let (new, empty) = (CollisionGroups::new(), CollisionGroups::empty());
        let all = CollisionGroups::ALL;
        assert_eq!(empty.with_membership_by_mask(all).with_whitelist_by_mask(all), new, "all");
        assert!(!empty.can_interact_with_groups(&new), "with nothing");
        assert!(!empty.can_interact_with_self(), "nor with itself");
    }

    #[test]
    fn bits_of_no_group_are_refused() {
        let groups = CollisionGroups::new();
        for (mask, source) in [(1 << 30, 30), (1 << 31, 31), (u32::MAX, 30), (1 << 31 | 5, 31)] {
            let refused = Err(GroupError(source));
            assert_eq!(groups.try_with_membership_by_mask(mask), refused, "{mask:x}");
            assert_eq!(groups.try_with_whitelist_by_mask(mask), refused, "{mask:x}");
            assert_eq!(groups.try_with_blacklist_by_mask(mask), refused, "{mask:x}");
        }
    }

    #[test]
    #[should_panic(expected = "no group 31")]
    fn the_panic_names_the_group() {
        let _ = CollisionGroups::new().with_whitelist_by_mask(1 << 31);
    }
}
