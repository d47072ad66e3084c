//! Pairs that share one algorithm, side by side.

/// The states of some pairs in no particular order, without gaps.
///
/// A pair's place changes when another pair of the group is removed; whoever keeps places is told.
#[derive(Debug)]
pub(crate) struct Group<S> {
    keys: Vec<(u32, u32)>,
    states: Vec<S>,
}

impl<S> Default for Group<S> {
    fn default() -> Self {
        Self { keys: Vec::new(), states: Vec::new() }
    }
}

impl<S> Group<S> {
    /// Adds a pair and answers its place.
    pub(crate) fn push(&mut self, key: (u32, u32), state: S) -> u32 {
        self.keys.push(key);
        self.states.push(state);
        u32::try_from(self.keys.len() - 1).expect("fewer than 2^32 pairs fit in memory")
    }

    /// Takes a pair out; the pair named in the answer, if any, now has its place.
    pub(crate) fn swap_remove(&mut self, place: u32) -> (S, Option<(u32, u32)>) {
        let place = place as usize;
        self.keys.swap_remove(place);
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

    /// The pair at a place.
    pub(crate) fn key(&self, place: u32) -> (u32, u32) {
        self.keys[place as usize]
    }

    /// All pairs and their states.
    pub(crate) fn split_mut(&mut self) -> (&[(u32, u32)], &mut [S]) {
        (&self.keys, &mut self.states)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_pair_fills_the_gap() {
        let mut group = Group::default();
        for n in 0..3 {
            assert_eq!(group.push((n, n + 1), n), n, "places are dense");
        }
        assert_eq!(group.swap_remove(0), (0, Some((2, 3))), "the last moves to the front");
        assert_eq!((group.key(0), *group.state(0)), ((2, 3), 2), "with its state");
        assert_eq!(group.swap_remove(1), (1, None), "nobody moves when the last goes");
    }
}
