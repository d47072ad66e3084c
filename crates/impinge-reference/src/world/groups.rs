//! Collision groups: which objects may interact.

/// The mask of all 30 groups.
pub const ALL: u32 = (1 << 30) - 1;

/// Membership, whitelist and blacklist of an object, as bit masks: bit i stands for group i, from 0
/// to 29.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Groups {
    /// The groups that the object belongs to.
    pub membership: u32,
    /// The groups with which the object interacts.
    pub whitelist: u32,
    /// The groups with which the object never interacts; it overrides the whitelist.
    pub blacklist: u32,
}

impl Default for Groups {
    fn default() -> Self {
        Self::new()
    }
}

impl Groups {
    /// Returns the default: a member of all groups, which whitelists all groups and blacklists
    /// none.
    #[must_use]
    pub fn new() -> Self {
        Self { membership: ALL, whitelist: ALL, blacklist: 0 }
    }

    /// Creates groups from lists of indices from 0 to 29.
    #[must_use]
    pub fn of(membership: &[u32], whitelist: &[u32], blacklist: &[u32]) -> Self {
        let mask = |groups: &[u32]| groups.iter().fold(0, |mask, group| mask | 1 << group);
        Self {
            membership: mask(membership),
            whitelist: mask(whitelist),
            blacklist: mask(blacklist),
        }
    }

    /// Whether two objects may interact: each is a member of a group that the other whitelists, and
    /// neither is a member of a group that the other blacklists.
    #[must_use]
    pub fn can_interact(self, other: Self) -> bool {
        let wanted =
            self.membership & other.whitelist != 0 && other.membership & self.whitelist != 0;
        let refused =
            self.membership & other.blacklist != 0 || other.membership & self.blacklist != 0;
        wanted && !refused
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worked_example() {
        let a = Groups::of(&[1, 3, 6], &[6, 7], &[1]);
        let b = Groups::of(&[1, 3, 7], &[3, 7], &[]);
        let c = Groups::of(&[6, 9], &[3, 7], &[]);
        for (one, two, expected) in [(a, b, false), (b, c, false), (a, c, true)] {
            assert_eq!(one.can_interact(two), expected);
            assert_eq!(two.can_interact(one), expected);
        }
    }

    #[test]
    fn members_of_nothing_interact_with_nobody() {
        let nobody = Groups { membership: 0, ..Groups::new() };
        assert!(Groups::new().can_interact(Groups::new()), "the default interacts");
        assert!(!nobody.can_interact(Groups::new()), "no membership");
        assert!(!nobody.can_interact(nobody), "no membership twice");
    }
}
