//! Pairs that share one algorithm, side by side.

use std::sync::OnceLock;

use crate::memory::Look;

/// The states of some pairs in no particular order, without gaps.
///
/// A pair's place changes when another pair of the group is removed; whoever keeps places is told.
/// To each state belongs a view: what readers make of it. The views come into being, all together,
/// when the first is asked for: who never asks pays nothing for them.
#[derive(Debug)]
pub(crate) struct Group<S, V = ()> {
    keys: Vec<(u32, u32)>,
    states: Vec<S>,
    /// One for each state, or none at all.
    views: OnceLock<Vec<V>>,
}

/// The pairs of a group to work on, side by side.
pub(crate) struct Rows<'a, S, V> {
    pub(crate) keys: &'a [(u32, u32)],
    pub(crate) states: &'a mut [S],
    /// As many as states, or none.
    pub(crate) views: &'a mut [V],
}

impl<S, V> Default for Group<S, V> {
    fn default() -> Self {
        Self { keys: Vec::new(), states: Vec::new(), views: OnceLock::new() }
    }
}

impl<S, V: Default> Group<S, V> {
    /// Adds a pair and answers its place.
    pub(crate) fn push(&mut self, key: (u32, u32), state: S) -> u32 {
        self.keys.push(key);
        self.states.push(state);
        if let Some(views) = self.views.get_mut() {
            views.push(V::default());
        }
        u32::try_from(self.keys.len() - 1).expect("fewer than 2^32 pairs fit in memory")
    }

    /// Takes a pair out; the pair named in the answer, if any, now has its place.
    pub(crate) fn swap_remove(&mut self, place: u32) -> (S, Option<(u32, u32)>) {
        let place = place as usize;
        self.keys.swap_remove(place);
        if let Some(views) = self.views.get_mut() {
            views.swap_remove(place);
        }
        (self.states.swap_remove(place), self.keys.get(place).copied())
    }

    /// Gives back memory that a group which has stopped to grow does not need.
    pub(crate) fn fit(&mut self, look: Look) {
        look.fit(&mut self.keys);
        look.fit(&mut self.states);
    }

    /// The state of the pair at a place.
    pub(crate) fn state(&self, place: u32) -> &S {
        &self.states[place as usize]
    }

    /// The state of the pair at a place, to change.
    pub(crate) fn state_mut(&mut self, place: u32) -> &mut S {
        &mut self.states[place as usize]
    }

    /// The state of the pair at a place and its view, if there is one, to change.
    pub(crate) fn parts_mut(&mut self, place: u32) -> (&mut S, Option<&mut V>) {
        let place = place as usize;
        let view = self.views.get_mut().map(|views| &mut views[place]);
        (&mut self.states[place], view)
    }

    /// The view of the pair at a place.
    pub(crate) fn view(&self, place: u32) -> &V {
        let make = || self.keys.iter().map(|_| V::default()).collect();
        &self.views.get_or_init(make)[place as usize]
    }

    /// The pair at a place.
    pub(crate) fn key(&self, place: u32) -> (u32, u32) {
        self.keys[place as usize]
    }

    /// All pairs with their states, in the order in which they lie.
    pub(crate) fn iter(&self) -> impl Iterator<Item = ((u32, u32), &S)> {
        self.keys.iter().copied().zip(&self.states)
    }

    /// There is no pair.
    pub(crate) const fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// All pairs, their states and their views.
    pub(crate) fn rows(&mut self) -> Rows<'_, S, V> {
        let views = self.views.get_mut().map_or(&mut [][..], Vec::as_mut_slice);
        Rows { keys: &self.keys, states: &mut self.states, views }
    }
}

impl<'a, S, V> Rows<'a, S, V> {
    /// How many pairs there are; who cannot share work need not ask.
    #[cfg(feature = "parallel")]
    pub(crate) fn len(&self) -> usize {
        self.keys.len()
    }

    /// The same rows, to be used once more afterwards.
    pub(crate) fn reborrow(&mut self) -> Rows<'_, S, V> {
        Rows { keys: self.keys, states: self.states, views: self.views }
    }

    /// The rows in pieces of a constant size, the last one perhaps shorter.
    pub(crate) fn chunks(self, size: usize) -> impl Iterator<Item = Rows<'a, S, V>> {
        let mut views = self.views.chunks_mut(size);
        let pairs = self.keys.chunks(size).zip(self.states.chunks_mut(size));
        pairs.map(move |(keys, states)| Rows {
            keys,
            states,
            views: views.next().unwrap_or_default(),
        })
    }

    /// Every pair with its state and its view.
    pub(crate) fn each(self) -> impl Iterator<Item = ((u32, u32), &'a mut S, Option<&'a mut V>)> {
        let mut views = self.views.iter_mut();
        let pairs = self.keys.iter().zip(self.states);
        pairs.map(move |(&key, state)| (key, state, views.next()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_pair_fills_the_gap() {
        let mut group = Group::<u32>::default();
        for n in 0..3 {
            assert_eq!(group.push((n, n + 1), n), n, "places are dense");
        }
        assert_eq!(group.swap_remove(0), (0, Some((2, 3))), "the last moves to the front");
        assert_eq!((group.key(0), *group.state(0)), ((2, 3), 2), "with its state");
        assert_eq!(group.swap_remove(1), (1, None), "nobody moves when the last goes");
    }

    #[test]
    fn views_follow_their_pairs_once_there_are_any() {
        let mut group = Group::<u32, Option<u32>>::default();
        for n in 0..5 {
            group.push((n, n + 1), n);
        }
        assert!(group.rows().views.is_empty(), "nobody asked");
        assert_eq!(*group.view(3), None, "made now");
        for (_, state, view) in group.rows().each() {
            *view.expect("one for each") = Some(*state);
        }
        group.swap_remove(1);
        group.push((9, 9), 9);
        assert_eq!([1, 4].map(|place| *group.view(place)), [Some(4), None], "moved, and new");
        let sizes = group.rows().chunks(2).map(|rows| (rows.states.len(), rows.views.len()));
        assert_eq!(sizes.collect::<Vec<_>>(), [(2, 2), (2, 2), (1, 1)], "cut alike");
    }
}
