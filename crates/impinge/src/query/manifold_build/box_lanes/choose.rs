//! From the filled slots of one pair to its manifold: the rules of `choose`, in fixed arrays.

use super::clip::SLOTS;
use super::names::Key;
use crate::math::{Real, Vector, cross2};
use crate::query::RawManifold;
use crate::query::manifold_build::reduce::{ALMOST, NEW_POINT_WEIGHT};

/// The candidates of one pair, in the order of their slots.
pub(super) struct Candidates<N: Real> {
    len: usize,
    slots: [u8; SLOTS],
    keys: [Key; SLOTS],
    distances: [N; SLOTS],
    flat: [[N; 2]; SLOTS],
    /// The candidates that have the name of an old point, and its number.
    kept: u32,
    ids: [u32; SLOTS],
}

/// Indices of candidates.
pub(super) struct Chosen {
    len: usize,
    indices: [u8; SLOTS],
}

impl Chosen {
    fn first(len: usize) -> Self {
        const ALL: [u8; SLOTS] =
            [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23];
        Self { len, indices: ALL }
    }

    #[inline]
    pub(super) fn as_slice(&self) -> &[u8] {
        &self.indices[..self.len]
    }

    fn insert(&mut self, place: usize, index: u8) {
        self.indices.copy_within(place..self.len, place + 1);
        self.indices[place] = index;
        self.len += 1;
    }
}

impl<N: Real> Candidates<N> {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            slots: [0; SLOTS],
            keys: [Key::default(); SLOTS],
            distances: [N::ZERO; SLOTS],
            flat: [[N::ZERO; 2]; SLOTS],
            kept: 0,
            ids: [0; SLOTS],
        }
    }

    #[inline]
    pub(super) fn push(&mut self, slot: usize, key: Key, (flat, distance): ([N; 2], N)) {
        let at = self.len;
        self.slots[at] = slot.to_le_bytes()[0];
        self.keys[at] = key;
        self.flat[at] = flat;
        self.distances[at] = distance;
        self.len += 1;
    }

    /// Gives candidates the numbers of the old points of the same names, which no two of either have.
    #[inline]
    pub(super) fn inherit(&mut self, old: &RawManifold<N, 3>) {
        for point in &old.points {
            let key = Key::of([point.feature1, point.feature2]);
            let same = (0..self.len).fold(0, |same, at| same | u32::from(self.keys[at] == key) << at);
            let heir = same & !self.kept;
            if heir != 0 {
                self.ids[heir.trailing_zeros() as usize] = point.id;
                self.kept |= heir;
            }
        }
    }

    #[inline]
    fn is_kept(&self, index: usize) -> bool {
        self.kept >> index & 1 == 1
    }

    /// The candidate that stands for the witness gets its distance: of those at most `limit` deep one
    /// that the previous manifold held, then the deepest.
    #[inline]
    pub(super) fn take_deepest(&mut self, gap: N, tolerance: N) -> usize {
        let rank = |index: usize| {
            let is_level = self.distances[index] <= gap + tolerance;
            (!(is_level && self.is_kept(index)), self.distances[index])
        };
        let (mut best, mut least) = (0, rank(0));
        for index in 1..self.len {
            let new = rank(index);
            if (new.0, least.0) == (false, true) || new.0 == least.0 && new.1 < least.1 {
                (best, least) = (index, new);
            }
        }
        self.distances[best] = gap;
        best
    }

    /// At most `limit` of them.
    #[inline]
    pub(super) fn chosen(&self, deepest: usize, limit: usize, tolerance: N) -> Chosen {
        if self.len <= limit { Chosen::first(self.len) } else { self.outline(deepest, limit, tolerance) }
    }

    fn outline(&self, deepest: usize, limit: usize, tolerance: N) -> Chosen {
        let mut outline = Chosen { len: 1, indices: [0; SLOTS] };
        outline.indices[0] = deepest.to_le_bytes()[0];
        let order = self.by_depth();
        let mut left = (1_u32 << self.len) - 1 & !(1 << deepest);
        while outline.len < limit {
            let best = self.best_addition((&outline, left), &order, tolerance);
            let Some((index, place)) = best else { break };
            outline.insert(place, index);
            left &= !(1 << index);
        }
        outline
    }

    fn by_depth(&self) -> Chosen {
        let mut order = Chosen::first(self.len);
        let key = |index: u8| self.distances[usize::from(index)].as_f64();
        for end in 1..self.len {
            let (new, mut at) = (order.indices[end], end);
            while at > 0 && key(order.indices[at - 1]).total_cmp(&key(new)).is_gt() {
                order.indices[at] = order.indices[at - 1];
                at -= 1;
            }
            order.indices[at] = new;
        }
        order
    }

    fn best_addition(
        &self,
        (outline, left): (&Chosen, u32),
        order: &Chosen,
        tolerance: N,
    ) -> Option<(u8, usize)> {
        let (mut best, mut best_gain) = (None, N::ZERO);
        for &index in order.as_slice() {
            if left >> index & 1 == 0 {
                continue;
            }
            let (gain, place) = self.gain(outline, usize::from(index), tolerance);
            let is_kept = self.is_kept(usize::from(index));
            let gain = if is_kept { gain } else { gain * N::lit(NEW_POINT_WEIGHT) };
            if gain > best_gain * N::lit(ALMOST) {
                (best, best_gain) = (Some((index, place)), gain);
            }
        }
        best
    }

    fn flat(&self, index: usize) -> Vector<N, 2> {
        Vector::<N, 2>::from(self.flat[index])
    }

    fn gain(&self, outline: &Chosen, index: usize, tolerance: N) -> (N, usize) {
        let (corners, flat) = (outline.as_slice(), self.flat(index));
        let place = |at: usize| self.flat(usize::from(corners[at]));
        if corners.len() == 1 {
            let distance = (flat - place(0)).norm();
            return (if distance > tolerance { distance } else { N::ZERO }, 1);
        }
        let (mut gain, mut best) = (N::ZERO, 0);
        for at in 0..corners.len() {
            let from = place(at);
            let side = place(if at + 1 < corners.len() { at + 1 } else { 0 }) - from;
            let area = -cross2(&side, &(flat - from));
            if area > gain && area > tolerance * side.norm() {
                (gain, best) = (area, at + 1);
            }
        }
        (gain, best)
    }

    /// The slot, the name, the distance of a candidate and its number if it has one.
    #[inline]
    pub(super) fn get(&self, index: u8) -> (usize, Key, N, Option<u32>) {
        let at = usize::from(index);
        let id = self.is_kept(at).then_some(self.ids[at]);
        (usize::from(self.slots[at]), self.keys[at], self.distances[at], id)
    }
}
