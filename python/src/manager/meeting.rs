//! Results about two crowds: the touching pairs, and the nearest pair.

use std::collections::BTreeSet;

use impinge::bounding_volume::BoundingVolume;

use super::crowd::{Crowd, Nearest, Object, Pair, between, depth, index_of, touch};

/// The cached results about two crowds.
#[derive(Debug)]
pub(super) struct Meeting {
    /// The unique number of the other manager.
    pub(super) other: u64,
    /// The number of changes of each crowd when `touching` was computed.
    then: [u64; 2],
    /// The pairs that touched at the changes `then`.
    pub(super) touching: BTreeSet<Pair>,
    /// The nearest pair, and the number of changes of each crowd when it was found.
    nearest: Option<(Nearest, [u64; 2])>,
}

/// The crowd of this manager, and the crowd of the other manager.
#[derive(Clone, Copy)]
pub(super) struct Crowds<'a>(pub(super) &'a Crowd, pub(super) &'a Crowd);

impl Meeting {
    /// Computes all touching pairs.
    pub(super) fn new(other: u64, crowds: Crowds<'_>) -> Self {
        Self { other, then: crowds.now(), touching: crowds.all_touching(), nearest: None }
    }

    /// Updates the touching pairs by the changes since `then`.
    pub(super) fn update(&mut self, crowds: Crowds<'_>) {
        let then = core::mem::replace(&mut self.then, crowds.now());
        let Some([changed1, changed2]) = crowds.changed(then) else {
            self.touching = crowds.all_touching();
            return;
        };
        self.touching.retain(|&(one, other)| {
            !changed1.contains(&index_of(one)) && !changed2.contains(&index_of(other))
        });
        let Crowds(own, others) = crowds;
        for object in changed1.iter().filter_map(|&index| own.object(index)) {
            self.touching.extend(touching_of(object, own, others));
        }
        for object in changed2.iter().filter_map(|&index| others.object(index)) {
            self.touching.extend(touching_of(object, others, own).map(|(other, one)| (one, other)));
        }
    }

    /// Returns the first cached touching pair, if it still touches.
    pub(super) fn touching_pair(&self, Crowds(own, others): Crowds<'_>) -> Option<Pair> {
        let pair = *self.touching.first()?;
        let (one, other) = (own.get(pair.0)?, others.get(pair.1)?);
        let has_changed =
            own.has_changed(pair.0, self.then[0]) || others.has_changed(pair.1, self.then[1]);
        (!has_changed || touch(one, other)).then_some(pair)
    }

    /// Returns the first cached touching pair with its signed distance (minus the depth), if it
    /// touches or overlaps now. `None` also if no touching pair is cached, or if one of the objects
    /// was removed.
    pub(super) fn overlap(&mut self, crowds: Crowds<'_>) -> Option<Nearest> {
        let (Crowds(own, others), pair) = (crowds, *self.touching.first()?);
        let known = self.nearest.filter(|(nearest, then)| {
            let is_same = nearest.pair == pair && nearest.distance <= 0.0;
            is_same && !own.has_changed(pair.0, then[0]) && !others.has_changed(pair.1, then[1])
        });
        let nearest = match known {
            Some((nearest, _)) => nearest,
            None => Nearest { pair, distance: -depth(own.get(pair.0)?, others.get(pair.1)?) },
        };
        if nearest.distance > 0.0 {
            return None;
        }
        self.nearest = Some((nearest, crowds.now()));
        Some(nearest)
    }

    /// Returns a pair of the smallest distance of two crowds that do not touch, and caches it. If
    /// several pairs have this distance, the cached pair is kept. `None` if a crowd is empty.
    pub(super) fn nearest_pair(&mut self, crowds: Crowds<'_>) -> Option<Nearest> {
        let known = self.nearest.take();
        let apart = known.filter(|(nearest, _)| nearest.distance > 0.0);
        let found = apart.and_then(|known| crowds.nearest_changed(known));
        let found = found.or_else(|| crowds.nearest_of_all(known.map(|(nearest, _)| nearest.pair)));
        self.nearest = found.map(|nearest| (nearest, crowds.now()));
        found
    }
}

impl Crowds<'_> {
    fn now(self) -> [u64; 2] {
        [self.0.changes.now(), self.1.changes.now()]
    }

    /// Returns the objects of each crowd that changed after its first `then` changes; `None` if a
    /// log no longer holds all these changes.
    fn changed(self, then: [u64; 2]) -> Option<[BTreeSet<u32>; 2]> {
        Some([self.0.changes.since(then[0])?, self.1.changes.since(then[1])?])
    }

    /// Returns all touching pairs. Searches the larger crowd for each object of the smaller crowd
    /// that is near the box around the larger crowd.
    fn all_touching(self) -> BTreeSet<Pair> {
        let Crowds(own, others) = self;
        let is_smaller = own.len() <= others.len();
        let (few, many) = if is_smaller { (own, others) } else { (others, own) };
        let (Some(around_few), Some(around)) = (few.reach.around(), many.reach.around()) else {
            return BTreeSet::new();
        };
        if !around_few.intersects(around) {
            return BTreeSet::new();
        }
        let near = few.reach.within(around, 0.0).into_iter();
        let objects = near.filter_map(|(_, index)| few.object(index));
        let pairs = objects.flat_map(|object| touching_of(object, few, many));
        pairs.map(|pair| if is_smaller { pair } else { (pair.1, pair.0) }).collect()
    }

    /// Returns the nearest pair, if the objects of the cached pair `best` have not changed since
    /// `then`. This is `best`, unless a pair with a changed object is now nearer. `None` if an
    /// object of `best` changed, or if a log no longer holds all changes.
    fn nearest_changed(self, (mut best, then): (Nearest, [u64; 2])) -> Option<Nearest> {
        let [changed1, changed2] = self.changed(then)?;
        let (one, other) = best.pair;
        if changed1.contains(&index_of(one)) || changed2.contains(&index_of(other)) {
            return None;
        }
        let Crowds(own, others) = self;
        for object in changed1.iter().filter_map(|&index| own.object(index)) {
            best = nearer(object, others, Some(best)).unwrap_or(best);
        }
        for object in changed2.iter().filter_map(|&index| others.object(index)) {
            best = nearer(object, own, Some(best)).map_or(best, Nearest::flipped);
        }
        Some(best)
    }

    /// Computes the nearest pair of the two crowds. The search distance begins with the current
    /// distance of `known`, an earlier nearest pair. The search visits the objects of the smaller
    /// crowd in ascending order of a lower bound of their distance from the box around the larger
    /// crowd. Objects whose bound is not below the smallest distance so far are skipped.
    fn nearest_of_all(self, known: Option<Pair>) -> Option<Nearest> {
        let Crowds(own, others) = self;
        let mut best = known.and_then(|pair| {
            let distance = between(own.get(pair.0)?, others.get(pair.1)?);
            Some(Nearest { pair, distance })
        });
        let is_smaller = own.len() <= others.len();
        let (few, many) = if is_smaller { (own, others) } else { (others, own) };
        let around = many.reach.around()?;
        let mut visit = |object: &Object| {
            let found = nearer(object, many, best);
            best = found.map(|found| if is_smaller { found } else { found.flipped() }).or(best);
            best.map_or(f64::INFINITY, |best| best.distance)
        };
        let mut limit = visit(few.object(few.reach.first(around)?)?);
        for (far, index) in few.reach.within(around, limit) {
            if far < limit
                && let Some(object) = few.object(index)
            {
                limit = visit(object);
            }
        }
        best
    }
}

impl Nearest {
    const fn flipped(self) -> Self {
        Self { pair: (self.pair.1, self.pair.0), ..self }
    }
}

/// Returns the touching pairs of an object of `own` and the objects of `others`.
fn touching_of<'a>(
    object: &'a Object,
    own: &Crowd,
    others: &'a Crowd,
) -> impl Iterator<Item = Pair> + use<'a> {
    let index = index_of(object.handle());
    let around = others.reach.around();
    let is_near = around.is_some_and(|around| own.reach.may_meet(index, around));
    let met = is_near.then(|| others.met_by(object.position(), &**object.shape()));
    met.into_iter().flatten().map(|other| (object.handle(), other.handle()))
}

/// Returns the pair of `object` and the nearest object of `others`, if its distance is smaller than
/// that of `best`, or if `best` is `None`.
fn nearer(object: &Object, others: &Crowd, best: Option<Nearest>) -> Option<Nearest> {
    let limit = best.map_or(f64::INFINITY, |best| best.distance);
    let (other, distance) = others.nearest_to(object.position(), &**object.shape(), limit)?;
    let is_nearer = distance < limit || best.is_none();
    is_nearer.then(|| Nearest { pair: (object.handle(), other), distance })
}
