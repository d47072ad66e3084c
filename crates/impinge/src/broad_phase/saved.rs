//! The broad phase in a saved world: the state that determines the pairs.
//!
//! The slot of an object in its tree affects only the running time (see [`rewind`](super::rewind)),
//! so the trees are not saved but built again.

use serde::{Deserialize, Serialize};

use super::finder::{Container, Waiting, small};
use super::handle::Handles;
use super::{DBVTBroadPhase, PairFinder, ProxyHandle};
use crate::bounding_volume::Aabb;
use crate::bvh::{Bounds, NONE};
use crate::generation::Generation;
use crate::math::numbers::{Damage, NumberSource, Numbers, ensure};
use crate::math::{Mapped, Real, Space};

/// The broad phase in the data of a saved world.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct BroadRecord<N: Real> {
    margin: Numbers<N>,
    /// By handle index: the generation of the present object; if there is none, of the next object.
    generations: Vec<u16>,
    free: Vec<u32>,
    boxes: Vec<BoxRecord<N>>,
    /// The id and the box of each waiting change, in the order in which the boxes were set.
    waiting: Vec<(u32, Numbers<N>)>,
    again: Vec<u32>,
    is_all_again: bool,
    clock: u32,
}

/// An object of the broad phase in the data of a saved world.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct BoxRecord<N: Real> {
    proxy: u32,
    /// The handle index of the object in its world.
    object: u32,
    home: Container,
    exact: Numbers<N>,
    /// The loosened box; `None` before the first update of the object.
    loose: Option<Numbers<f32>>,
    last_change: u32,
}

impl<N: Space<D>, const D: usize, T> DBVTBroadPhase<N, Aabb<N, D>, T> {
    /// Returns the margin of a broad phase to which no object was ever added; `None` for any other.
    pub(crate) fn unused_margin(&self) -> Option<Numbers<N>> {
        self.proxies.is_empty().then(|| Numbers::of([self.margin()]))
    }

    /// Returns the record of the broad phase. `index_of` returns the handle index of an object in
    /// its world from the data of its proxy.
    pub(crate) fn record(&self, index_of: impl Fn(&T) -> u32) -> BroadRecord<N> {
        let (generations, free) = self.handles.record();
        let present = (0..).zip(&self.proxies).filter_map(|(id, data)| Some((id, data.as_ref()?)));
        let finder = &self.finder;
        let waiting = finder.waiting.iter();
        BroadRecord {
            margin: Numbers::of([self.margin()]),
            generations,
            free,
            boxes: present.map(|(id, data)| finder.box_record(id, index_of(data))).collect(),
            waiting: waiting.map(|waiting| (waiting.id, numbers(&waiting.aabb))).collect(),
            // `changes` has entries here only if a filter panicked in the last update.
            again: finder.to_refilter.iter().chain(&finder.changes).copied().collect(),
            is_all_again: finder.refilters_all,
            clock: finder.clock,
        }
    }
}

fn numbers<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> Numbers<N> {
    Numbers::of_points(&[*aabb.mins(), *aabb.maxs()])
}

fn aabb<N: Real, const D: usize>(numbers: &Numbers<N>) -> Result<Aabb<N, D>, Damage> {
    let [mins, maxs] = numbers.all(NumberSource::points)?;
    Aabb::try_new(mins, maxs).map_err(|error| Damage::found(&error))
}

impl Handles {
    /// Returns the counts of the generations by index, and the free indices.
    fn record(&self) -> (Vec<u16>, Vec<u32>) {
        let count = |generation: &Generation| generation.count();
        (self.generations.iter().map(count).collect(), self.free.clone())
    }

    /// Creates a table with these generations and free indices, in which no index is in use.
    fn restored(generations: &[u16], free: Vec<u32>) -> Self {
        let first = Generation::of_new_table();
        let generations: Vec<_> =
            generations.iter().map(|&count| first.with_count(count)).collect();
        Self { first, is_present: vec![false; generations.len()], generations, free }
    }

    /// Marks an index as in use and returns its handle. Fails if the index does not exist or is
    /// already in use.
    fn restore_handle(&mut self, index: u32) -> Result<ProxyHandle, Damage> {
        let is_present = self.is_present.get_mut(index as usize);
        let is_unused = is_present.is_some_and(|is_present| !core::mem::replace(is_present, true));
        ensure(is_unused, "a proxy is there twice, or has no handle")?;
        Ok(self.at(index))
    }

    /// Checks that each free index exists, is not in use, and is listed only once.
    fn check_free(&self) -> Result<(), Damage> {
        let mut is_taken = self.is_present.clone();
        let is_free = |&index: &u32| {
            is_taken
                .get_mut(index as usize)
                .is_some_and(|is_taken| !core::mem::replace(is_taken, true))
        };
        ensure(self.free.iter().all(is_free), "a proxy is free and in use, or free twice")
    }
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    fn box_record(&self, id: u32, object: u32) -> BoxRecord<N> {
        let (home, index) = (self.containers[id as usize], id as usize);
        let loose = &self.loose[index];
        let loose = || Numbers::of(loose.lo.into_iter().chain(loose.hi));
        BoxRecord {
            proxy: id,
            object,
            home,
            exact: numbers(&self.exact[index]),
            loose: (home != Container::Nowhere).then(loose),
            last_change: self.last_change[index],
        }
    }

    /// Sets the length of the arrays indexed by id to `count`.
    fn resize(&mut self, count: usize) {
        self.exact.resize(count, Aabb::unbounded());
        self.loose.resize(count, Bounds::NOWHERE);
        self.containers.resize(count, Container::Nowhere);
        self.marks.resize(count, 0);
        self.last_change.resize(count, 0);
        self.waiting_at.resize(count, NONE);
    }

    /// Restores the boxes of an object, and inserts it in its container. Fails if the boxes do not
    /// match each other or the container.
    fn restore_box(&mut self, record: &BoxRecord<N>) -> Result<(), Damage> {
        let (id, index) = (record.proxy, record.proxy as usize);
        self.exact[index] = aabb(&record.exact)?;
        self.last_change[index] = record.last_change;
        let Some(loose) = &record.loose else {
            return ensure(record.home == Container::Nowhere, "a proxy has no loosened box");
        };
        let [lo, hi] = loose.all(|loose| Ok([loose.array()?, loose.array()?]))?;
        let loose = Bounds { lo, hi };
        let encloses_exact = loose.contains(&Bounds::enclosing(&self.exact[index]));
        ensure(encloses_exact, "a loosened box does not hold the exact one")?;
        match record.home {
            Container::Nowhere => return Err(Damage("a proxy is nowhere".into())),
            Container::Unbounded => self.unbounded.push(id),
            Container::Moving | Container::Still => {
                ensure(loose.is_finite(), "an unbounded box is in a tree")?;
                let tree = if record.home == Container::Still {
                    &mut self.still
                } else {
                    &mut self.moving
                };
                tree.insert_still(id, &loose);
            }
        }
        (self.containers[index], self.loose[index]) = (record.home, loose);
        Ok(())
    }
}

impl<N: Real> BroadRecord<N> {
    /// Restores the broad phase, without its pairs. `object` receives the handle index of an object
    /// in its world and the handle of its proxy; it returns the data of the proxy.
    pub(crate) fn restore<T, const D: usize>(
        &self,
        mut object: impl FnMut(u32, ProxyHandle) -> Result<T, Damage>,
    ) -> Result<DBVTBroadPhase<N, Aabb<N, D>, T>, Damage>
    where
        N: Space<D>,
    {
        let [margin] = self.margin.array()?;
        let phase = DBVTBroadPhase::<N, Aabb<N, D>, T>::try_new(margin);
        let mut phase = phase.map_err(|error| Damage::found(&error))?;
        let count = self.generations.len();
        phase.handles = Handles::restored(&self.generations, self.free.clone());
        phase.proxies.resize_with(count, || None);
        phase.finder.resize(count);
        for record in &self.boxes {
            let handle = phase.handles.restore_handle(record.proxy)?;
            phase.proxies[handle.uid()] = Some(object(record.object, handle)?);
            phase.finder.restore_box(record)?;
        }
        phase.handles.check_free()?;
        for (id, waiting) in &self.waiting {
            let is_there = matches!(phase.proxies.get(*id as usize), Some(Some(_)));
            ensure(is_there, "a box waits for no proxy")?;
            phase.finder.restore_waiting(*id, aabb(waiting)?)?;
        }
        ensure(self.again.iter().all(|&id| (id as usize) < count), "no proxy is to be filtered")?;
        phase.finder.to_refilter.clone_from(&self.again);
        (phase.finder.refilters_all, phase.finder.clock) = (self.is_all_again, self.clock);
        phase.finder.settle_trees();
        Ok(phase)
    }
}

impl<N: Space<D>, const D: usize, T> DBVTBroadPhase<N, Aabb<N, D>, T> {
    /// Returns the box that was last set for an object: its waiting box if there is one, else its
    /// exact box.
    pub(crate) fn given_volume(&self, handle: ProxyHandle) -> &Aabb<N, D> {
        let waiting = self.finder.waiting_at[handle.uid()];
        let waiting = self.finder.waiting.get(waiting as usize);
        waiting.map_or(&self.finder.exact[handle.uid()], |waiting| &waiting.aabb)
    }

    /// Adds the pairs of the last update. Fails if a pair is listed twice, lacks a proxy, or has
    /// loosened boxes that do not overlap.
    pub(crate) fn restore_pairs(
        &mut self,
        pairs: impl Iterator<Item = [ProxyHandle; 2]>,
    ) -> Result<(), Damage> {
        let Self { handles, finder, .. } = self;
        // If a filter panicked, boxes may be newer than pairs; `to_refilter` then has entries.
        let was_interrupted = !finder.to_refilter.is_empty();
        for [one, other] in pairs {
            ensure(handles.is_alive(one) && handles.is_alive(other), "a pair has no proxies")?;
            let [a, b] = [one, other].mapped(|handle| small(handle.uid()));
            let are_near = finder.loose[a as usize].overlaps(&finder.loose[b as usize]);
            ensure(a != b && (are_near || was_interrupted), "the boxes of a pair do not overlap")?;
            ensure(finder.pairs.insert(a, b).is_new, "a pair is there twice")?;
        }
        Ok(())
    }
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Adds a waiting box of an object; fails if the object already has one.
    fn restore_waiting(&mut self, id: u32, aabb: Aabb<N, D>) -> Result<(), Damage> {
        ensure(self.waiting_at[id as usize] == NONE, "two boxes wait for a proxy")?;
        self.waiting_at[id as usize] = small(self.waiting.len());
        self.waiting.push(Waiting { id, aabb });
        Ok(())
    }
}
