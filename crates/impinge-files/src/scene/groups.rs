//! Groups of objects, and groups for the disabled pairs of links.

use std::collections::BTreeSet;

use impinge::world::CollisionGroups;

use crate::Problem;
use crate::error::{Fault, Within};
use crate::format::{GroupsFile, SceneFile};

/// The number of groups.
const GROUPS: usize = 30;

/// The groups of a scene: those that the document names, and those that disable pairs of links.
///
/// Pairs of links are disabled by groups, so that a recording needs no pair filter. For each pair,
/// one link is the only member of a group that the other link blacklists. These groups are taken
/// from those that the document does not name. Objects that are members of all groups are not
/// members of these groups.
#[derive(Debug)]
pub(super) struct GroupPlan {
    /// The groups that the document does not name, the highest first.
    free: Vec<usize>,
    /// The groups that disable pairs.
    taken: BTreeSet<usize>,
}

/// The indices of two objects that have no contacts, the lower index first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct DisabledPair([usize; 2]);

impl DisabledPair {
    /// The pair of two indices in any order.
    pub(super) fn new([a, b]: [usize; 2]) -> Self {
        Self([a.min(b), a.max(b)])
    }

    /// Returns the other object of a pair with `object`; `None` if the pair does not contain it.
    fn partner(self, object: usize) -> Option<usize> {
        let [a, b] = self.0;
        if a == object { Some(b) } else { (b == object).then_some(a) }
    }
}

/// The groups that disabled pairs add to an object.
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
    /// pairs gets the next group, which its partners blacklist: a greedy vertex cover, since there
    /// are few groups. An error if the groups do not suffice.
    pub(super) fn separate(
        &mut self,
        objects: usize,
        pairs: &BTreeSet<DisabledPair>,
    ) -> Result<Vec<OwnGroups>, Problem> {
        let mut own = vec![OwnGroups::default(); objects];
        let mut left: Vec<DisabledPair> = pairs.iter().copied().collect();
        // Terminates: each iteration disables the pairs of an object that has some.
        while !left.is_empty() {
            let mut counts = vec![0_usize; objects];
            left.iter().flat_map(|pair| pair.0).for_each(|object| counts[object] += 1);
            let most = (0..objects).rev().max_by_key(|object| counts[*object]).unwrap_or_default();
            let free = self.taken.len() + self.free.len();
            let what = "groups for disabled pairs of links";
            let none = Problem::TooMany { what, given: free + 1, limit: free };
            let group = self.free.pop().ok_or(none)?;
            self.taken.insert(group);
            own[most].member = Some(group);
            let partners = left.iter().filter_map(|pair| pair.partner(most));
            partners.for_each(|partner| own[partner].refused.push(group));
            left.retain(|pair| !pair.0.contains(&most));
        }
        Ok(own)
    }

    /// Returns the groups of an object.
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
