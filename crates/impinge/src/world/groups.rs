//! Collision groups as bit masks, which decide which objects may interact.

use core::fmt;

/// The largest group number.
const LAST_GROUP: usize = 29;
/// The mask of all groups, 0 to 29.
pub(super) const ALL_GROUPS: u32 = (1 << (LAST_GROUP + 1)) - 1;

/// The groups to which an object belongs, and the groups that it accepts and refuses.
///
/// Two objects interact if each is a member of at least one group on the other's whitelist, and
/// neither is a member of a group on the other's blacklist: the blacklist wins. Groups are numbered
/// 0 to 29, in lists or as the bits of masks.
///
/// ```
/// use impinge::world::CollisionGroups;
///
/// let mut ghosts = CollisionGroups::new();
/// ghosts.set_membership(&[4]);
/// ghosts.set_blacklist(&[4, 7]);
/// let walls = CollisionGroups::new().with_membership(&[7]);
/// let players = CollisionGroups::new().with_membership(&[1]);
/// assert!(!ghosts.can_interact_with_groups(&walls), "the blacklist wins");
/// assert!(ghosts.can_interact_with_groups(&players));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "SerializedGroups", into = "SerializedGroups"))]
pub struct CollisionGroups {
    /// Bits 0 to 29 are groups, as in `whitelist` and `blacklist`; bit 31 is [`SELF_COLLISION`].
    membership: u32,
    whitelist: u32,
    blacklist: u32,
}

/// Bit that enables self-collision. It is in the membership mask, because a separate field would
/// cost every object four bytes.
const SELF_COLLISION: u32 = 1 << 31;

/// Groups with a field for each setting, for serialization and `Debug`.
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename = "CollisionGroups"))]
struct SerializedGroups {
    membership: u32,
    whitelist: u32,
    blacklist: u32,
    self_collision: bool,
}

impl From<CollisionGroups> for SerializedGroups {
    fn from(groups: CollisionGroups) -> Self {
        let CollisionGroups { membership, whitelist, blacklist } = groups;
        let self_collision = groups.can_interact_with_self();
        Self { membership: membership & ALL_GROUPS, whitelist, blacklist, self_collision }
    }
}

#[cfg(feature = "serde")]
impl From<SerializedGroups> for CollisionGroups {
    fn from(serialized: SerializedGroups) -> Self {
        // Bits of groups that do not exist are dropped.
        let [membership, whitelist, blacklist] =
            [serialized.membership, serialized.whitelist, serialized.blacklist]
                .map(|mask| mask & ALL_GROUPS);
        let mut groups = Self { membership, whitelist, blacklist };
        if serialized.self_collision {
            groups.enable_self_collision();
        }
        groups
    }
}

impl fmt::Debug for CollisionGroups {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let SerializedGroups { membership, whitelist, blacklist, self_collision } = (*self).into();
        f.debug_struct("CollisionGroups")
            .field("membership", &membership)
            .field("whitelist", &whitelist)
            .field("blacklist", &blacklist)
            .field("self_collision", &self_collision)
            .finish()
    }
}

/// A group number above 29.
///
/// ```
/// use impinge::world::{CollisionGroups, GroupError};
///
/// let refused = CollisionGroups::new().try_set_membership(&[3, 30]);
/// assert_eq!(refused, Err(GroupError(30)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GroupError(pub usize);

impl fmt::Display for GroupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "there is no group {}: groups are numbered 0 to {LAST_GROUP}", self.0)
    }
}

impl std::error::Error for GroupError {}

impl Default for CollisionGroups {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns the mask of a single group; an error for a group above 29.
fn bit(group: usize) -> Result<u32, GroupError> {
    if group > LAST_GROUP { Err(GroupError(group)) } else { Ok(1 << group) }
}

/// Returns the mask of several groups; an error for a group above 29. Callers compute the mask
/// before they change anything, so an error leaves their groups unchanged.
fn mask(groups: &[usize]) -> Result<u32, GroupError> {
    groups.iter().try_fold(0, |mask, &group| Ok(mask | bit(group)?))
}

/// Returns `mask` with one group set or cleared; an error for a group above 29.
fn with_group(mask: u32, group: usize, present: bool) -> Result<u32, GroupError> {
    let bit = bit(group)?;
    Ok(if present { mask | bit } else { mask & !bit })
}

/// Returns `true` if `mask` contains the group; `false` for a group above 29.
fn has(mask: u32, group: usize) -> bool {
    bit(group).is_ok_and(|bit| mask & bit != 0)
}

/// Panics with the text of the error, if there is one.
#[track_caller]
fn or_panic(result: Result<(), GroupError>) {
    if let Err(error) = result {
        panic!("{error}");
    }
}

impl CollisionGroups {
    /// Creates the groups of an object that is a member of all groups, whitelists all groups and
    /// blacklists none, without self-collision.
    #[must_use]
    pub const fn new() -> Self {
        Self { membership: ALL_GROUPS, whitelist: ALL_GROUPS, blacklist: 0 }
    }

    /// Creates groups from masks, which must have no bit above 29.
    pub(super) const fn of_masks(membership: u32, whitelist: u32, blacklist: u32) -> Self {
        Self { membership, whitelist, blacklist }
    }

    /// Returns the mask of the object's own groups: bit `g` is group `g`.
    #[must_use]
    pub const fn membership_mask(&self) -> u32 {
        self.membership & ALL_GROUPS
    }

    /// Returns the mask of the whitelist: bit `g` is group `g`.
    #[must_use]
    pub const fn whitelist_mask(&self) -> u32 {
        self.whitelist
    }

    /// Returns the mask of the blacklist: bit `g` is group `g`.
    #[must_use]
    pub const fn blacklist_mask(&self) -> u32 {
        self.blacklist
    }

    /// Sets the membership: the object is a member of these groups and of no others.
    ///
    /// # Panics
    /// If a group is above 29; [`Self::try_set_membership`] returns an error instead.
    #[track_caller]
    pub fn set_membership(&mut self, groups: &[usize]) {
        or_panic(self.try_set_membership(groups));
    }

    /// Sets the membership: the object is a member of these groups and of no others.
    ///
    /// # Errors
    /// If a group is above 29. Then nothing changes.
    pub fn try_set_membership(&mut self, groups: &[usize]) -> Result<(), GroupError> {
        self.membership = self.membership & SELF_COLLISION | mask(groups)?;
        Ok(())
    }

    /// Sets the whitelist: the object may interact only with members of these groups.
    ///
    /// # Panics
    /// If a group is above 29; [`Self::try_set_whitelist`] returns an error instead.
    #[track_caller]
    pub fn set_whitelist(&mut self, groups: &[usize]) {
        or_panic(self.try_set_whitelist(groups));
    }

    /// Sets the whitelist: the object may interact only with members of these groups.
    ///
    /// # Errors
    /// If a group is above 29. Then nothing changes.
    pub fn try_set_whitelist(&mut self, groups: &[usize]) -> Result<(), GroupError> {
        self.whitelist = mask(groups)?;
        Ok(())
    }

    /// Sets the blacklist: the object does not interact with members of these groups.
    ///
    /// # Panics
    /// If a group is above 29; [`Self::try_set_blacklist`] returns an error instead.
    #[track_caller]
    pub fn set_blacklist(&mut self, groups: &[usize]) {
        or_panic(self.try_set_blacklist(groups));
    }

    /// Sets the blacklist: the object does not interact with members of these groups.
    ///
    /// # Errors
    /// If a group is above 29. Then nothing changes.
    pub fn try_set_blacklist(&mut self, groups: &[usize]) -> Result<(), GroupError> {
        self.blacklist = mask(groups)?;
        Ok(())
    }

    /// Makes the object a member of the group if `add` is `true`, else ends its membership.
    ///
    /// # Panics
    /// If the group is above 29; [`Self::try_modify_membership`] returns an error instead.
    #[track_caller]
    pub fn modify_membership(&mut self, group: usize, add: bool) {
        or_panic(self.try_modify_membership(group, add));
    }

    /// Makes the object a member of the group if `add` is `true`, else ends its membership.
    ///
    /// # Errors
    /// If a group is above 29. Then nothing changes.
    pub fn try_modify_membership(&mut self, group: usize, add: bool) -> Result<(), GroupError> {
        self.membership = with_group(self.membership, group, add)?;
        Ok(())
    }

    /// Puts the group on the whitelist if `add` is `true`, else takes it off.
    ///
    /// # Panics
    /// If the group is above 29; [`Self::try_modify_whitelist`] returns an error instead.
    #[track_caller]
    pub fn modify_whitelist(&mut self, group: usize, add: bool) {
        or_panic(self.try_modify_whitelist(group, add));
    }

    /// Puts the group on the whitelist if `add` is `true`, else takes it off.
    ///
    /// # Errors
    /// If a group is above 29. Then nothing changes.
    pub fn try_modify_whitelist(&mut self, group: usize, add: bool) -> Result<(), GroupError> {
        self.whitelist = with_group(self.whitelist, group, add)?;
        Ok(())
    }

    /// Puts the group on the blacklist if `add` is `true`, else takes it off.
    ///
    /// # Panics
    /// If the group is above 29; [`Self::try_modify_blacklist`] returns an error instead.
    #[track_caller]
    pub fn modify_blacklist(&mut self, group: usize, add: bool) {
        or_panic(self.try_modify_blacklist(group, add));
    }

    /// Puts the group on the blacklist if `add` is `true`, else takes it off.
    ///
    /// # Errors
    /// If a group is above 29. Then nothing changes.
    pub fn try_modify_blacklist(&mut self, group: usize, add: bool) -> Result<(), GroupError> {
        self.blacklist = with_group(self.blacklist, group, add)?;
        Ok(())
    }

    /// Copies the membership of `other`; self-collision stays.
    pub const fn copy_membership(&mut self, other: &Self) {
        let own = self.membership & SELF_COLLISION;
        self.membership = own | other.membership & ALL_GROUPS;
    }

    /// Copies the whitelist of `other`.
    pub const fn copy_whitelist(&mut self, other: &Self) {
        self.whitelist = other.whitelist;
    }

    /// Copies the blacklist of `other`.
    pub const fn copy_blacklist(&mut self, other: &Self) {
        self.blacklist = other.blacklist;
    }

    /// Returns `true` if the object is a member of the group; `false` for a group above 29.
    #[must_use]
    pub fn is_member_of(&self, group: usize) -> bool {
        has(self.membership, group)
    }

    /// Returns `true` if the group is on the whitelist; `false` for a group above 29.
    #[must_use]
    pub fn is_group_whitelisted(&self, group: usize) -> bool {
        has(self.whitelist, group)
    }

    /// Returns `true` if the group is on the blacklist; `false` for a group above 29.
    #[must_use]
    pub fn is_group_blacklisted(&self, group: usize) -> bool {
        has(self.blacklist, group)
    }

    /// Makes the narrow phase test the object against itself. Contacts and events of this pair have
    /// the object's handle twice. For a composite, two parts are tested unless they are adjacent
    /// ([`CompositeShape::are_adjacent`](crate::shape::CompositeShape::are_adjacent)); a convex
    /// solid never touches itself. No filter applies. Off by default.
    pub const fn enable_self_collision(&mut self) {
        self.membership |= SELF_COLLISION;
    }

    /// Stops the narrow phase from testing the object against itself.
    pub const fn disable_self_collision(&mut self) {
        self.membership &= !SELF_COLLISION;
    }

    /// Returns `true` if objects with these groups and `other` may interact. Symmetric.
    #[must_use]
    #[inline]
    pub const fn can_interact_with_groups(&self, other: &Self) -> bool {
        self.membership & other.blacklist == 0
            && other.membership & self.blacklist == 0
            && self.membership & other.whitelist != 0
            && other.membership & self.whitelist != 0
    }

    /// Returns `true` if self-collision is enabled.
    #[must_use]
    pub const fn can_interact_with_self(&self) -> bool {
        self.membership & SELF_COLLISION != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(membership: &[usize], whitelist: &[usize], blacklist: &[usize]) -> CollisionGroups {
        let mut groups = CollisionGroups::new();
        groups.set_membership(membership);
        groups.set_whitelist(whitelist);
        groups.set_blacklist(blacklist);
        groups
    }

    #[test]
    fn three_objects() {
        let a = groups(&[1, 3, 6], &[6, 7], &[1]);
        let b = groups(&[1, 3, 7], &[3, 7], &[]);
        let c = groups(&[6, 9], &[3, 7], &[]);
        for (first, second, expected) in [(a, b, false), (b, c, false), (a, c, true)] {
            assert_eq!(first.can_interact_with_groups(&second), expected, "{first:?} {second:?}");
            assert_eq!(second.can_interact_with_groups(&first), expected, "symmetric");
        }
    }

    #[test]
    fn defaults_and_single_changes() {
        let mut groups = CollisionGroups::new();
        assert!((0..=29).all(|g| groups.is_member_of(g)), "member of all");
        assert!((0..=29).all(|g| groups.is_group_whitelisted(g)), "whitelists all");
        assert!(!(0..=29).any(|g| groups.is_group_blacklisted(g)), "blacklists none");
        assert!(!groups.can_interact_with_self(), "off by default");
        groups.modify_blacklist(29, true);
        assert!(!groups.can_interact_with_groups(&CollisionGroups::new()), "29 is refused");
        groups.modify_blacklist(29, false);
        assert_eq!(groups, CollisionGroups::new(), "and no longer");
        groups.enable_self_collision();
        assert!(groups.can_interact_with_self(), "on");
        groups.set_membership(&[]);
        groups.modify_membership(0, true);
        groups.copy_membership(&CollisionGroups::new());
        assert!(groups.can_interact_with_self(), "whatever the groups");
        assert!((0..=29).all(|g| groups.is_member_of(g)), "which it does not alter");
        assert!(!groups.is_member_of(31), "31 is no group");
        groups.set_whitelist(&[]);
        assert!(!groups.can_interact_with_groups(&groups), "nor is it one that could be met");
        groups.disable_self_collision();
        assert!(!groups.can_interact_with_self(), "off");
    }

    #[test]
    fn copies_take_one_mask_each() {
        let source = groups(&[1], &[2], &[3]);
        let mut target = CollisionGroups::new();
        target.copy_membership(&source);
        assert_eq!(
            target,
            {
                let mut g = CollisionGroups::new();
                g.set_membership(&[1]);
                g
            },
            "1"
        );
        target.copy_whitelist(&source);
        target.copy_blacklist(&source);
        assert_eq!(target, source, "all three");
    }

    #[test]
    fn groups_above_the_last_are_refused() {
        let mut groups = groups(&[4], &[5], &[6]);
        let before = groups;
        assert_eq!(groups.try_set_membership(&[1, 30]), Err(GroupError(30)), "30");
        assert_eq!(groups.try_modify_whitelist(64, true), Err(GroupError(64)), "64");
        assert_eq!(groups, before, "nothing changed");
        assert!(!groups.is_member_of(usize::MAX), "nobody is");
    }

    #[test]
    #[should_panic(expected = "no group 30")]
    fn the_panic_names_the_group() {
        CollisionGroups::new().set_blacklist(&[30]);
    }
}
