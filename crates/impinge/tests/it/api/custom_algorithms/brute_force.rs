//! A custom broad phase that tests the boxes of every two proxies for overlap at every update.

use std::collections::BTreeSet;

use super::dim::bounding_volume::{Aabb, BoundingVolume};
use super::dim::broad_phase::{BroadPhase, BroadPhaseError, ProxyHandle};
use super::dim::math::{Point, Real};
use super::dim::query::Ray;

/// A broad phase with exact boxes, without a margin. Its only state is the boxes and the pairs.
#[derive(Clone, Debug)]
pub(super) struct BruteForce<N: Real, T> {
    /// Proxies by index; an index is never reused.
    proxies: Vec<Option<Proxy<N, T>>>,
    pairs: BTreeSet<(u32, u32)>,
}

#[derive(Clone, Debug)]
struct Proxy<N: Real, T> {
    volume: Aabb<N>,
    next: Aabb<N>,
    data: T,
    is_seen: bool,
}

impl<N: Real, T> BruteForce<N, T> {
    pub(super) fn new() -> Self {
        Self { proxies: Vec::new(), pairs: BTreeSet::new() }
    }

    fn at(&self, index: u32) -> &Proxy<N, T> {
        self.proxies[index as usize].as_ref().expect("pairs are of living proxies")
    }

    fn find(&self, handle: ProxyHandle) -> Option<&Proxy<N, T>> {
        self.proxies.get(handle.uid())?.as_ref()
    }

    fn find_mut(&mut self, handle: ProxyHandle) -> Result<&mut Proxy<N, T>, BroadPhaseError> {
        let proxy = self.proxies.get_mut(handle.uid()).and_then(Option::as_mut);
        proxy.ok_or(BroadPhaseError::StaleHandle(handle))
    }

    fn living(&self) -> impl Iterator<Item = (u32, &Proxy<N, T>)> {
        (0..).zip(&self.proxies).filter_map(|(index, proxy)| Some((index, proxy.as_ref()?)))
    }

    fn meeting(&self) -> BTreeSet<(u32, u32)> {
        let mut pairs = BTreeSet::new();
        for (index1, first) in self.living() {
            let later = self.living().filter(|(index2, _)| *index2 > index1);
            let meeting = later.filter(|(_, second)| first.volume.intersects(&second.volume));
            pairs.extend(meeting.map(|(index2, _)| (index1, index2)));
        }
        pairs
    }

    fn hit<'a>(&'a self, out: &mut Vec<&'a T>, hits: impl Fn(&Aabb<N>) -> bool) {
        let hit = self.living().filter(|(_, proxy)| proxy.is_seen && hits(&proxy.volume));
        out.extend(hit.map(|(_, proxy)| &proxy.data));
    }
}

impl<N: Real, T> BroadPhase<N, Aabb<N>, T> for BruteForce<N, T> {
    fn try_create_proxy(&mut self, bv: Aabb<N>, data: T) -> Result<ProxyHandle, BroadPhaseError> {
        let index = u32::try_from(self.proxies.len()).expect("few");
        self.proxies.push(Some(Proxy { volume: bv, next: bv, data, is_seen: false }));
        Ok(ProxyHandle::new(index, 0))
    }

    fn try_remove(
        &mut self,
        handles: &[ProxyHandle],
        callback: &mut dyn FnMut(&T, &T),
    ) -> Result<(), BroadPhaseError> {
        for &handle in handles {
            self.find_mut(handle)?;
        }
        let is_gone = |index: u32| handles.contains(&ProxyHandle::new(index, 0));
        let (gone, rest) = self.pairs.iter().partition(|(a, b)| is_gone(*a) || is_gone(*b));
        let gone: BTreeSet<(u32, u32)> = gone;
        gone.iter().for_each(|(a, b)| callback(&self.at(*a).data, &self.at(*b).data));
        self.pairs = rest;
        handles.iter().for_each(|handle| self.proxies[handle.uid()] = None);
        Ok(())
    }

    fn try_deferred_set_bounding_volume(
        &mut self,
        handle: ProxyHandle,
        bv: Aabb<N>,
    ) -> Result<(), BroadPhaseError> {
        self.find_mut(handle)?.next = bv;
        Ok(())
    }

    fn try_deferred_recompute_all_proximities_with(
        &mut self,
        handle: ProxyHandle,
    ) -> Result<(), BroadPhaseError> {
        self.find_mut(handle).map(|_| ())
    }

    /// Does nothing, because every update calls the filter for all pairs of overlapping boxes
    /// anyway.
    fn deferred_recompute_all_proximities(&mut self) {}

    fn update(
        &mut self,
        filter: &mut dyn FnMut(&T, &T) -> bool,
        callback: &mut dyn FnMut(&T, &T, bool),
    ) {
        for proxy in self.proxies.iter_mut().flatten() {
            proxy.volume = proxy.next;
            proxy.is_seen = true;
        }
        let mut pairs = self.meeting();
        pairs.retain(|(a, b)| filter(&self.at(*a).data, &self.at(*b).data));
        for (a, b) in self.pairs.symmetric_difference(&pairs) {
            callback(&self.at(*a).data, &self.at(*b).data, pairs.contains(&(*a, *b)));
        }
        self.pairs = pairs;
    }

    fn interferences_with_bounding_volume<'a>(&'a self, bv: &Aabb<N>, out: &mut Vec<&'a T>) {
        self.hit(out, |volume| volume.intersects(bv));
    }

    fn interferences_with_ray<'a>(&'a self, ray: &Ray<N>, out: &mut Vec<&'a T>) {
        self.hit(out, |volume| volume.intersects_ray(ray));
    }

    fn interferences_with_point<'a>(&'a self, point: &Point<N>, out: &mut Vec<&'a T>) {
        self.hit(out, |volume| volume.contains_point(point));
    }

    fn num_interferences(&self) -> usize {
        self.pairs.len()
    }

    fn proxy(&self, handle: ProxyHandle) -> Option<(&Aabb<N>, &T)> {
        self.find(handle).map(|proxy| (&proxy.volume, &proxy.data))
    }
}
