//! How contacts change from step to step.

use core::hash::Hash;
use std::collections::{HashMap, HashSet};

use impinge::math::Vector;

use crate::memory::{own_points, way};
use crate::{Body, Contact, Turn};

/// A point farther than this share of the smaller solid's extent from where it was has jumped.
pub const JUMP: f64 = 0.05;

/// Counts of the contacts of some steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// All contacts.
    pub contacts: usize,
    /// Contacts whose ids did not exist a step before.
    pub new: usize,
    /// Contacts of a step before whose ids are gone.
    pub lost: usize,
    /// Contacts whose point is farther than [`JUMP`] from its place a step before, on both solids. The place of a
    /// contact with a new id is the nearest one of the pair.
    pub jumps: usize,
    /// The longest distance of a point from its place a step before, as a share of the extent.
    pub farthest: f64,
    /// Pairs of solids with contacts.
    pub pairs: usize,
    /// Pairs that have no contact any more.
    pub parted: usize,
}

impl Counts {
    /// The share of contacts whose id is new.
    #[must_use]
    pub fn new_share(&self) -> f64 {
        self.new as f64 / self.contacts.max(1) as f64
    }

    /// The contacts whose ids are gone, as a share of all contacts.
    #[must_use]
    pub fn lost_share(&self) -> f64 {
        self.lost as f64 / self.contacts.max(1) as f64
    }

    /// The share of contacts that jumped.
    #[must_use]
    pub fn jump_share(&self) -> f64 {
        self.jumps as f64 / self.contacts.max(1) as f64
    }

    /// The counts of both spans of time together.
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

    /// The numbers for tables, with their names.
    #[must_use]
    pub fn columns(&self) -> [(&'static str, String); 3] {
        [
            ("new_%", format!("{:.2}", 100.0 * self.new_share())),
            ("jump_%", format!("{:.2}", 100.0 * self.jump_share())),
            ("farthest", format!("{:.4}", self.farthest)),
        ]
    }

    /// Contacts for each pair.
    #[must_use]
    pub fn points(&self) -> f64 {
        self.contacts as f64 / self.pairs.max(1) as f64
    }
}

/// The points of contacts in the frames of their bodies.
type Own<N, const D: usize> = [Vector<N, D>; 2];

/// The contacts of the last step, and counts since they were taken last.
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

    /// The counts so far; they begin again at zero.
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
