//! Pairs that share one algorithm, side by side.

/// The states of some pairs in no particular order, without gaps.
///
/// A pair's place changes when another pair of the group is removed; whoever keeps places is told.
/// Beside each state lies a view: what readers make of it, apart so that reading passes over little
/// memory.
#[derive(Debug)]
pub(crate) struct Group<S, V = ()> {
    keys: Vec<(u32, u32)>,
    states: Vec<S>,
    views: Vec<V>,
}

impl<S, V> Default for Group<S, V> {
    fn default() -> Self {
        Self { keys: Vec::new(), states: Vec::new(), views: Vec::new() }
    }
}

impl<S, V: Default> Group<S, V> {
    /// Adds a pair and answers its place.
    pub(crate) fn push(&mut self, key: (u32, u32), state: S) -> u32 {
        self.keys.push(key);
        self.states.push(state);
        self.views.push(V::default());
        u32::try_from(self.keys.len() - 1).expect("fewer than 2^32 pairs fit in memory")
    }

    /// Takes a pair out; the pair named in the answer, if any, now has its place.
    pub(crate) fn swap_remove(&mut self, place: u32) -> (S, Option<(u32, u32)>) {
        let place = place as usize;
        self.keys.swap_remove(place);
        self.views.swap_remove(place);
        (self.states.swap_remove(place), self.keys.get(place).copied())
    }

    /// The state of the pair at a place.
    pub(crate) fn state(&self, place: u32) -> &S {
        &self.states[place as usize]
    }

    /// The state of the pair at a place, to change.
    pub(crate) fn state_mut(&mut self, place: u32) -> &mut S {
        &mut self.states[place as usize]
    }

    /// The state of the pair at a place and its view, to change.
    pub(crate) fn parts_mut(&mut self, place: u32) -> (&mut S, &mut V) {
        (&mut self.states[place as usize], &mut self.views[place as usize])
    }

    /// The view of the pair at a place.
    pub(crate) fn view(&self, place: u32) -> &V {
        &self.views[place as usize]
    }

    /// The pair at a place.
    pub(crate) fn key(&self, place: u32) -> (u32, u32) {
        self.keys[place as usize]
    }

    /// All pairs with their states, in the order in which they lie.
    pub(crate) fn iter(&self) -> impl Iterator<Item = ((u32, u32), &S)> {
        self.keys.iter().copied().zip(&self.states)
    }

    /// All pairs, their states and their views.
    pub(crate) fn split_mut(&mut self) -> (&[(u32, u32)], &mut [S], &mut [V]) {
        (&self.keys, &mut self.states, &mut self.views)
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
}
