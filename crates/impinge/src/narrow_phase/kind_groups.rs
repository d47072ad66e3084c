//! The groups of built-in pairs, one for each pair of shape kinds that occurs.

use crate::memory::clone_fields;
use crate::shape::ShapeKind;

/// Number of ordered pairs of shape kinds.
const KIND_PAIRS: usize = ShapeKind::COUNT * ShapeKind::COUNT;

/// Entry of a number that has no group, because no pair has had these kinds.
const NONE: u8 = u8::MAX;

/// Groups by the number of their pair of shape kinds
/// ([`kind_pair`](super::pair_groups::kind_pair)), without gaps and in ascending order of these
/// numbers.
///
/// A group is made for its first pair and then kept. Most worlds have pairs of few kinds, so
/// clones, marks and updates visit a few groups instead of hundreds of empty groups.
#[derive(Debug)]
pub(crate) struct KindGroups<G> {
    make: fn() -> G,
    /// By number: the index of the group in `groups`, or [`NONE`].
    places: [u8; KIND_PAIRS],
    /// The number of each group, by index in `groups`.
    numbers: Vec<u8>,
    groups: Vec<G>,
}

clone_fields!([G: Clone] KindGroups<G> { make, places, numbers, groups });

impl<G> KindGroups<G> {
    /// Creates a list without groups; `make` creates an empty group.
    pub(crate) const fn new(make: fn() -> G) -> Self {
        Self { make, places: [NONE; KIND_PAIRS], numbers: Vec::new(), groups: Vec::new() }
    }

    /// Returns the group of a number that has had a pair.
    #[inline]
    pub(crate) fn of(&self, number: u8) -> &G {
        &self.groups[usize::from(self.places[usize::from(number)])]
    }

    /// Returns the group of a number that has had a pair.
    #[inline]
    pub(crate) fn of_mut(&mut self, number: u8) -> &mut G {
        &mut self.groups[usize::from(self.places[usize::from(number)])]
    }

    /// Returns the group with this number; creates it if it does not exist yet.
    pub(crate) fn made(&mut self, number: u8) -> &mut G {
        if self.places[usize::from(number)] == NONE {
            let at = self.numbers.partition_point(|&other| other < number);
            self.numbers.insert(at, number);
            self.groups.insert(at, (self.make)());
            for (place, &number) in (0..).zip(&self.numbers).skip(at) {
                self.places[usize::from(number)] = place;
            }
        }
        self.of_mut(number)
    }

    /// Returns all groups, in ascending order of their numbers.
    pub(crate) fn all(&self) -> &[G] {
        &self.groups
    }

    /// Returns all groups, in ascending order of their numbers.
    pub(crate) fn all_mut(&mut self) -> &mut [G] {
        &mut self.groups
    }

    /// Iterates over all groups with their numbers, in ascending order.
    pub(crate) fn numbered_mut(&mut self) -> impl Iterator<Item = (u8, &mut G)> {
        self.numbers.iter().copied().zip(&mut self.groups)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_lie_in_the_order_of_their_numbers() {
        let mut groups = KindGroups::<Vec<u8>>::new(Vec::new);
        for number in [7, 3, 100, 0, 3, 100] {
            groups.made(number).push(number);
        }
        let all: Vec<_> = groups.numbered_mut().map(|(n, group)| (n, group.clone())).collect();
        let expected = [(0, vec![0]), (3, vec![3, 3]), (7, vec![7]), (100, vec![100, 100])];
        assert_eq!(all, expected, "each once, by number");
        assert_eq!((groups.of(7), groups.all().len()), (&vec![7], 4));
        let mut other = KindGroups::<Vec<u8>>::new(Vec::new);
        other.made(5);
        other.clone_from(&groups);
        assert_eq!(other.of(100), &[100, 100], "a copy has the same places");
    }
}
