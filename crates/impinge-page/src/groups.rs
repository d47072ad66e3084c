//! Describes collision groups as text.

use impinge::world::CollisionGroups;

use crate::answer::{GroupNumbers, ShownGroups};

/// Converts the groups of an object to their description.
pub(crate) fn shown(groups: &CollisionGroups) -> ShownGroups {
    ShownGroups {
        membership: numbers(groups.membership_mask()),
        whitelist: numbers(groups.whitelist_mask()),
        blacklist: numbers(groups.blacklist_mask()),
        self_collision: groups.can_interact_with_self(),
    }
}

/// Returns the indices of the groups in a mask: bit `g` is group `g`.
fn bits(mask: u32) -> impl Iterator<Item = usize> {
    (0..u32::BITS as usize).filter(move |group| mask >> group & 1 == 1)
}

fn numbers(mask: u32) -> GroupNumbers {
    // New groups have a membership in all groups.
    let is_all = mask == CollisionGroups::new().membership_mask();
    if is_all { GroupNumbers::All("all") } else { GroupNumbers::Some(bits(mask).collect()) }
}

/// Lists the groups of a mask, for use in a sentence.
fn listed(mask: u32) -> String {
    match numbers(mask) {
        GroupNumbers::All(all) => all.to_owned(),
        GroupNumbers::Some(some) if some.is_empty() => "none".to_owned(),
        GroupNumbers::Some(some) => {
            let some: Vec<String> = some.iter().map(usize::to_string).collect();
            some.join(", ")
        }
    }
}

/// The groups of an object, and the index by which texts refer to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Named<'a> {
    pub(crate) object: usize,
    pub(crate) groups: &'a CollisionGroups,
}

/// Explains why the groups of two objects allow or exclude a pair, according to
/// [`CollisionGroups::can_interact_with_groups`]. If there are several reasons for an exclusion,
/// the text has the first of them.
pub(crate) fn text(one: Named<'_>, two: Named<'_>) -> String {
    let refusals = [refusal(one, two), refusal(two, one)];
    let first = refusals.into_iter().flatten().next();
    first.unwrap_or_else(|| "each has a group that the other allows".to_owned())
}

/// Explains why the lists of `other` exclude the object `one`; `None` if the lists allow it. The
/// blacklist has precedence over the whitelist.
fn refusal(one: Named<'_>, other: Named<'_>) -> Option<String> {
    let membership = one.groups.membership_mask();
    let [whitelist, blacklist] = [other.groups.whitelist_mask(), other.groups.blacklist_mask()];
    if let Some(group) = bits(membership & blacklist).next() {
        let (one, other) = (one.object, other.object);
        return Some(format!("group {group} of {one} is in the blacklist of {other}"));
    }
    (membership & whitelist == 0).then(|| {
        let [groups, allowed] = [membership, whitelist].map(listed);
        let (one, other) = (one.object, other.object);
        format!("membership {groups} of {one} is not in the whitelist {allowed} of {other}")
    })
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
    fn a_reason_is_given_exactly_where_groups_refuse() {
        let lists: [&[usize]; 4] = [&[], &[0], &[1], &[0, 1]];
        let all = || lists.into_iter();
        let every = all().flat_map(move |member| {
            all().flat_map(move |white| all().map(move |black| groups(member, white, black)))
        });
        let every: Vec<_> = every.collect();
        for one in &every {
            for two in &every {
                let [one, two] =
                    [Named { object: 3, groups: one }, Named { object: 4, groups: two }];
                let is_refused = refusal(one, two).is_some() || refusal(two, one).is_some();
                let can_interact = one.groups.can_interact_with_groups(two.groups);
                assert_eq!(is_refused, !can_interact, "{one:?} {two:?}");
            }
        }
    }

    #[test]
    fn lists_are_named() {
        let [one, two] = [groups(&[2], &[0], &[]), groups(&[0], &[0, 1], &[])];
        let [one, two] = [Named { object: 3, groups: &one }, Named { object: 4, groups: &two }];
        assert_eq!(text(one, two), "membership 2 of 3 is not in the whitelist 0, 1 of 4");
        let every = CollisionGroups::new();
        assert_eq!(shown(&every).membership, GroupNumbers::All("all"), "of a new object");
    }
}
