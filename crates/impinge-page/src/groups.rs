//! Collision groups in words.

use impinge::world::CollisionGroups;

use crate::answer::{GroupNumbers, ShownGroups};

/// The number of groups.
const GROUPS: usize = 30;

/// The groups of an object.
pub(crate) fn shown(groups: &CollisionGroups) -> ShownGroups {
    ShownGroups {
        membership: numbers(|group| groups.is_member_of(group)),
        whitelist: numbers(|group| groups.is_group_whitelisted(group)),
        blacklist: numbers(|group| groups.is_group_blacklisted(group)),
        self_collision: groups.can_interact_with_self(),
    }
}

fn numbers(has: impl Fn(usize) -> bool) -> GroupNumbers {
    let some: Vec<usize> = (0..GROUPS).filter(|group| has(*group)).collect();
    if some.len() == GROUPS { GroupNumbers::All("all") } else { GroupNumbers::Some(some) }
}

/// Groups in a sentence.
fn listed(has: impl Fn(usize) -> bool) -> String {
    match numbers(has) {
        GroupNumbers::All(all) => all.to_owned(),
        GroupNumbers::Some(some) if some.is_empty() => "none".to_owned(),
        GroupNumbers::Some(some) => {
            let some: Vec<String> = some.iter().map(usize::to_string).collect();
            some.join(", ")
        }
    }
}

/// The groups of an object, named in a text.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Named<'a> {
    pub(crate) object: usize,
    pub(crate) groups: &'a CollisionGroups,
}

/// Why the groups of two objects allow a pair, or do not: what [`CollisionGroups::can_interact_with_groups`] asks, with
/// the first thing that forbids it.
pub(crate) fn text(one: Named<'_>, two: Named<'_>) -> String {
    let refusals = [refusal(one, two), refusal(two, one)];
    let first = refusals.into_iter().flatten().next();
    first.unwrap_or_else(|| "each has a group that the other allows".to_owned())
}

/// Why an object may not meet another by the latter's lists.
fn refusal(one: Named<'_>, other: Named<'_>) -> Option<String> {
    let Named { object, groups } = one;
    let is_member = |group: usize| groups.is_member_of(group);
    let mut forbidden =
        (0..GROUPS).filter(|&group| is_member(group) && other.groups.is_group_blacklisted(group));
    if let Some(group) = forbidden.next() {
        return Some(format!("group {group} of {object} is in the blacklist of {}", other.object));
    }
    let is_allowed =
        (0..GROUPS).any(|group| is_member(group) && other.groups.is_group_whitelisted(group));
    let membership = listed(is_member);
    let whitelist = listed(|group| other.groups.is_group_whitelisted(group));
    let text = format!(
        "membership {membership} of {object} is not in the whitelist {whitelist} of {}",
        other.object
    );
    (!is_allowed).then_some(text)
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
