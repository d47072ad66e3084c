//! Assigns collision groups to objects: the groups that the document names, and further groups that
//! disable pairs of links.

use std::collections::BTreeSet;

use impinge::world::CollisionGroups;

use crate::Problem;
use crate::error::{Fault, Within};
use crate::format::{GroupsFile, SceneFile};

/// The number of groups that the library has.
const GROUPS: usize = 30;

/// The groups of a scene: the groups that the document names, and further groups that disable pairs
/// of links.
///
/// Groups disable the pairs, so a recording needs no pair filter. For each pair, one link is the
/// only member of a group that the other link blacklists. Only groups that the document does not
/// name are used for this. An object without a `membership` in the document is a member of all
/// groups that disable no pairs, and of the group of its own pairs if it has one.
#[derive(Debug)]
pub(super) struct GroupPlan {
    /// The groups that the document does not name and that are not taken, in ascending order. The
    /// last one is taken next.
    free: Vec<usize>,
    /// The groups that disable pairs.
    taken: BTreeSet<usize>,
}

/// The indices of two objects whose contacts are disabled, the lower index first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct DisabledPair([usize; 2]);

impl DisabledPair {
    /// Creates the pair of two indices given in any order.
    pub(super) fn new([a, b]: [usize; 2]) -> Self {
        Self([a.min(b), a.max(b)])
    }

    /// Returns the index that the pair contains besides `object`; `None` if the pair does not
    /// contain `object`.
    fn partner(self, object: usize) -> Option<usize> {
        let [a, b] = self.0;
        if a == object { Some(b) } else { (b == object).then_some(a) }
    }
}

/// The groups that an object gets from its disabled pairs: the group of which it is the only
/// member, if any, and the groups that it blacklists.
#[derive(Clone, Debug, Default)]
pub(super) struct OwnGroups {
    member: Option<usize>,
    refused: Vec<usize>,
}

impl GroupPlan {
    /// Creates a plan in which all groups that the document does not name are free.
    pub(super) fn new(file: &SceneFile) -> Self {
        let objects = file.objects.iter().map(|object| &object.groups);
        let meshes = file.meshes.iter().map(|meshes| &meshes.groups);
        let robots = file.robots.iter().map(|robot| &robot.groups);
        let all = objects.chain(meshes).chain(robots);
        let named: BTreeSet<usize> = all.flat_map(named).collect();
        let free = (0..GROUPS).filter(|group| !named.contains(group)).collect();
        Self { free, taken: BTreeSet::new() }
    }

    /// Assigns groups to objects until each pair is disabled. The object with the most remaining
    /// pairs gets the next group, which its partners blacklist. This greedy vertex cover uses few
    /// groups. An error if the groups do not suffice.
    pub(super) fn separate(
        &mut self,
        objects: usize,
        pairs: &BTreeSet<DisabledPair>,
    ) -> Result<Vec<OwnGroups>, Problem> {
        let mut own = vec![OwnGroups::default(); objects];
        let mut left: Vec<DisabledPair> = pairs.iter().copied().collect();
        // Terminates: each iteration disables at least one pair.
        while !left.is_empty() {
            let mut counts = vec![0_usize; objects];
            left.iter().flat_map(|pair| pair.0).for_each(|object| counts[object] += 1);
            let most = (0..objects).rev().max_by_key(|object| counts[*object]).unwrap_or_default();
            // One group stays untaken: objects without own groups are its members.
            let limit = (self.taken.len() + self.free.len()).min(GROUPS - 1);
            let what = "groups for disabled pairs of links";
            let none = Problem::TooMany { what, given: limit + 1, limit };
            let group = self.free.pop().filter(|_| self.taken.len() < limit).ok_or(none)?;
            self.taken.insert(group);
            own[most].member = Some(group);
            let partners = left.iter().filter_map(|pair| pair.partner(most));
            partners.for_each(|partner| own[partner].refused.push(group));
            left.retain(|pair| !pair.0.contains(&most));
        }
        Ok(own)
    }

    /// Returns the groups of an object: the groups in the document, and the groups from its
    /// disabled pairs.
    pub(super) fn groups(
        &self,
        file: &GroupsFile,
        own: &OwnGroups,
    ) -> Result<CollisionGroups, Fault> {
        let mut groups = CollisionGroups::new();
        let all = || (0..GROUPS).filter(|group| !self.taken.contains(group)).collect();
        let mut membership: Vec<usize> = file.membership.clone().unwrap_or_else(all);
        membership.extend(own.member);
        groups.try_set_membership(&membership).within("membership")?;
        if let Some(whitelist) = &file.whitelist {
            groups.try_set_whitelist(whitelist).within("whitelist")?;
        }
        groups.try_set_blacklist(&file.blacklist).within("blacklist")?;
        for group in &own.refused {
            groups.try_modify_blacklist(*group, true)?;
        }
        if file.self_collision {
            groups.enable_self_collision();
        }
        Ok(groups)
    }
}

fn named(groups: &GroupsFile) -> impl Iterator<Item = usize> {
    let lists = [groups.membership.as_ref(), groups.whitelist.as_ref(), Some(&groups.blacklist)];
    lists.into_iter().flatten().flatten().copied()
}
