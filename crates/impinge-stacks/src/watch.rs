//! Measures how contacts change from step to step.

use core::hash::Hash;
use std::collections::{HashMap, HashSet};

use impinge::math::Vector;

use crate::memory::{own_points, way};
use crate::{Body, Contact, Turn};

/// A contact point that has moved by more than this fraction of the smaller solid's extent counts
/// as a jump.
pub const JUMP: f64 = 0.05;

/// Counts of contacts over some steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// The number of contacts.
    pub contacts: usize,
    /// The number of contacts whose ids did not exist in the previous step.
    pub new: usize,
    /// The number of contacts of the previous step whose ids no longer exist.
    pub lost: usize,
    /// The number of contacts that have moved by more than the fraction [`JUMP`] of the extent
    /// since the previous step, on both solids. A contact with a new id is compared with the
    /// nearest old contact of its pair.
    pub jumps: usize,
    /// The largest distance by which a contact has moved since the previous step, as a fraction of
    /// the extent of the smaller solid.
    pub farthest: f64,
    /// The number of pairs of solids with contacts.
    pub pairs: usize,
    /// The number of pairs that lost all their contacts.
    pub parted: usize,
}

impl Counts {
    /// Returns the fraction of contacts with new ids.
    #[must_use]
    pub fn new_share(&self) -> f64 {
        self.new as f64 / self.contacts.max(1) as f64
    }

    /// Returns the number of lost contacts divided by that of all contacts.
    #[must_use]
    pub fn lost_share(&self) -> f64 {
        self.lost as f64 / self.contacts.max(1) as f64
    }

    /// Returns the fraction of contacts that jumped.
    #[must_use]
    pub fn jump_share(&self) -> f64 {
        self.jumps as f64 / self.contacts.max(1) as f64
    }

    /// Returns the counts over both periods.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            contacts: self.contacts + other.contacts,
            new: self.new + other.new,
            lost: self.lost + other.lost,
            jumps: self.jumps + other.jumps,
            farthest: self.farthest.max(other.farthest),
            pairs: self.pairs + other.pairs,
            parted: self.parted + other.parted,
        }
    }

    /// Returns the measures with their names, as columns of a table.
    #[must_use]
    pub fn columns(&self) -> [(&'static str, String); 3] {
        [
            ("new_%", format!("{:.2}", 100.0 * self.new_share())),
            ("jump_%", format!("{:.2}", 100.0 * self.jump_share())),
            ("farthest", format!("{:.4}", self.farthest)),
        ]
    }

    /// Returns the mean number of contacts per pair.
    #[must_use]
    pub fn points(&self) -> f64 {
        self.contacts as f64 / self.pairs.max(1) as f64
    }
}

/// The points of a contact in the frames of its bodies.
type Own<N, const D: usize> = [Vector<N, D>; 2];

/// The contacts of the last step, and the counts since the last call of [`Watch::take`].
#[derive(Debug)]
pub(crate) struct Watch<N: Turn<D>, const D: usize, K> {
    /// The extents of the bodies.
    extents: Vec<f64>,
    by_id: HashMap<K, Own<N, D>>,
    by_pair: HashMap<[usize; 2], Vec<Own<N, D>>>,
    counts: Counts,
}

impl<N: Turn<D>, const D: usize, K: Copy + Eq + Hash> Watch<N, D, K> {
    pub(crate) fn new(extents: Vec<f64>) -> Self {
        let (by_id, by_pair) = (HashMap::new(), HashMap::new());
        Self { extents, by_id, by_pair, counts: Counts::default() }
    }

    /// Returns the counts so far, and resets them to zero.
    pub(crate) fn take(&mut self) -> Counts {
        core::mem::take(&mut self.counts)
    }

    pub(crate) fn see(&mut self, bodies: &[Body<N, D>], contacts: &[Contact<N, D, K>]) {
        let mut ids = HashMap::new();
        let mut pairs: HashMap<_, Vec<_>> = HashMap::new();
        for contact in contacts {
            let own = own_points(bodies, contact);
            self.count(contact, &own);
            ids.insert(contact.id, own);
            pairs.entry(contact.bodies).or_default().push(own);
        }
        let (old, new): (HashSet<_>, HashSet<_>) =
            (self.by_pair.keys().collect(), pairs.keys().collect());
        self.counts.pairs += new.len();
        self.counts.lost += self.by_id.keys().filter(|id| !ids.contains_key(*id)).count();
        self.counts.parted += old.difference(&new).count();
        (self.by_id, self.by_pair) = (ids, pairs);
    }

    fn count(&mut self, contact: &Contact<N, D, K>, own: &Own<N, D>) {
        let Self { extents, by_id, by_pair, counts } = self;
        counts.contacts += 1;
        let same = by_id.get(&contact.id).map(|old| way(old, own).as_f64());
        counts.new += usize::from(same.is_none());
        let others = by_pair.get(&contact.bodies).into_iter().flatten();
        let nearest = others.map(|old| way(old, own).as_f64()).min_by(f64::total_cmp);
        let Some(way) = same.or(nearest) else { return };
        let [extent1, extent2] = contact.bodies.map(|n| extents[n]);
        let share = way / extent1.min(extent2);
        counts.jumps += usize::from(share > JUMP);
        counts.farthest = counts.farthest.max(share);
    }
}
