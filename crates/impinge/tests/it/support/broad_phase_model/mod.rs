//! A slow and simple broad phase, and random sequences of calls that compare the library's broad
//! phase with it.

use std::collections::BTreeMap;

use impinge::bounding_volume::{Aabb, BoundingVolume, Ray};
use impinge::broad_phase::Bounds;
use impinge::broad_phase::{BroadPhase, DBVTBroadPhase, ProxyHandle};
use impinge::math::{Point, Real, Space, Vector};

/// A linear congruential generator, of which only the upper bits are used.
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((self.0 >> 33) % u64::from(bound)).expect("below a u32")
    }

    /// Returns `true` once in `n` calls on average.
    pub(crate) fn one_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }
}

/// An object of the model.
struct Object<N: Real, const D: usize> {
    handle: ProxyHandle,
    /// The box of the last update, and the loosened box that the broad phase must keep for it;
    /// `None` before the object's first update.
    known: Option<(Aabb<N, D>, Bounds<D>)>,
    waiting: Option<Aabb<N, D>>,
}

/// A broad phase that tests every two objects at every update. A result of the filter holds as long
/// as the loosened boxes overlap, or until the pair is filtered again.
pub(crate) struct Model<N: Real, const D: usize> {
    margin: N,
    objects: BTreeMap<u32, Object<N, D>>,
    /// For each pair of uids whose loosened boxes overlap, whether the filter allowed the pair.
    decided: BTreeMap<(u32, u32), bool>,
    again: Vec<u32>,
    is_all_again: bool,
    /// Seed of the filter, [`allows`]; changes whenever all pairs are filtered again.
    rule: u32,
}

/// Two uids, and whether the pair started.
type Event = (u32, u32, bool);

/// Counts of what happened in a run, so that a test can assert that enough happened.
#[derive(Debug, Default)]
pub(crate) struct Reached {
    pub(crate) started: usize,
    pub(crate) stopped: usize,
    pub(crate) refused: usize,
    pub(crate) most_pairs: usize,
    pub(crate) removed_pairs: usize,
    pub(crate) query_hits: usize,
    pub(crate) query_misses: usize,
}

fn allows(rule: u32, a: u32, b: u32) -> bool {
    !(a * 7 + b * 13 + rule).is_multiple_of(5)
}

fn outwards<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> Bounds<D> {
    let (lo, hi) = (aabb.mins(), aabb.maxs());
    Bounds {
        lo: core::array::from_fn(|axis| lo[axis].as_f32_below()),
        hi: core::array::from_fn(|axis| hi[axis].as_f32_above()),
    }
}

impl<N: Space<D>, const D: usize> Model<N, D> {
    fn apply_waiting(&mut self) {
        for object in self.objects.values_mut() {
            let Some(aabb) = object.waiting.take() else { continue };
            let tight = outwards(&aabb);
            let kept = object.known.map(|(_, loose)| loose).filter(|loose| {
                loose.contains(&tight) && (loose.is_finite() || !tight.is_finite())
            });
            let loose = kept.unwrap_or_else(|| outwards(&aabb.loosened(self.margin)));
            object.known = Some((aabb, loose));
        }
    }

    /// Returns the events that an update must report and the pairs for which it must call the
    /// filter.
    fn update(&mut self) -> (Vec<Event>, Vec<(u32, u32)>) {
        self.apply_waiting();
        let (mut events, mut asked, mut decided) = (Vec::new(), Vec::new(), BTreeMap::new());
        let known: Vec<(u32, Bounds<D>)> =
            self.objects.iter().map(|(&uid, o)| (uid, o.known.expect("applied").1)).collect();
        for (i, (a, box1)) in known.iter().enumerate() {
            for (b, box2) in &known[i + 1..] {
                let key = (*a, *b);
                let is_again = self.is_all_again || self.again.iter().any(|x| x == a || x == b);
                let old = self.decided.get(&key).copied();
                let now = box1.overlaps(box2).then(|| match old {
                    Some(old) if !is_again => old,
                    _ => {
                        asked.push(key);
                        allows(self.rule, *a, *b)
                    }
                });
                match (old == Some(true), now == Some(true)) {
                    (true, false) => events.push((*a, *b, false)),
                    (false, true) => events.push((*a, *b, true)),
                    _ => {}
                }
                now.map(|now| decided.insert(key, now));
            }
        }
        self.decided = decided;
        self.again.clear();
        self.is_all_again = false;
        (events, asked)
    }

    fn pairs(&self) -> Vec<(u32, u32)> {
        self.decided.iter().filter(|&(_, &allowed)| allowed).map(|(&key, _)| key).collect()
    }

    /// Removes objects; returns the pairs that the removal must report.
    fn remove(&mut self, uids: &[u32]) -> Vec<(u32, u32)> {
        let concerns = |&(a, b): &(u32, u32)| uids.contains(&a) || uids.contains(&b);
        let ended = self.pairs().into_iter().filter(concerns).collect();
        self.decided.retain(|key, _| !concerns(key));
        self.objects.retain(|uid, _| !uids.contains(uid));
        self.again.retain(|uid| !uids.contains(uid));
        ended
    }
}

/// Parameters of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) seed: u64,
    pub(crate) objects: u32,
    pub(crate) updates: u32,
    /// Cells of the world along each axis.
    pub(crate) size: u32,
    /// Margin in quarters of a cell.
    pub(crate) margin: u32,
}

/// The two broad phases side by side.
struct Run<N: Space<D>, const D: usize> {
    plan: Plan,
    random: Random,
    model: Model<N, D>,
    /// The broad phase under test; the data of an object are its serial number.
    tested: DBVTBroadPhase<N, Aabb<N, D>, u32>,
    /// Uids by serial number.
    uids: Vec<u32>,
    reached: Reached,
}

fn uid(handle: ProxyHandle) -> u32 {
    u32::try_from(handle.uid()).expect("small")
}

/// Returns a coordinate on a grid of quarters. A third of them on average are moved by 1/3, so that
/// `f32` does not represent them exactly.
fn coordinate<N: Real>(random: &mut Random, size: u32) -> N {
    let quarters = N::lit(f64::from(random.below(size * 4)) / 4.0);
    if random.one_in(3) { quarters + N::lit(1.0 / 3.0) } else { quarters }
}

impl<N: Space<D>, const D: usize> Run<N, D> {
    fn new(plan: Plan) -> Self {
        let margin = N::lit(f64::from(plan.margin) / 4.0);
        Self {
            plan,
            random: Random(plan.seed),
            model: Model {
                margin,
                objects: BTreeMap::new(),
                decided: BTreeMap::new(),
                again: Vec::new(),
                is_all_again: false,
                rule: 1,
            },
            tested: DBVTBroadPhase::new(margin),
            uids: Vec::new(),
            reached: Reached::default(),
        }
    }

    /// Returns a random box. Most have extents of 0 to 1.75 cells; some are points, a few are as
    /// large as the world, unbounded, or extend to the largest number of `N` (for `f64` beyond the
    /// range of `f32`).
    fn random_box(&mut self) -> Aabb<N, D> {
        let random = &mut self.random;
        let kind = random.below(60);
        let (mut lo, mut hi) = (Vector::<N, D>::zeros(), Vector::<N, D>::zeros());
        for axis in 0..D {
            lo[axis] = coordinate(random, self.plan.size);
            let extent = match kind {
                0..8 => 0,
                8 => random.below(self.plan.size * 4),
                _ => random.below(8),
            };
            hi[axis] = lo[axis] + N::lit(f64::from(extent) / 4.0);
        }
        if kind == 59 {
            lo[0] = -N::INFINITY;
        } else if kind == 58 {
            hi[1] = N::MAX;
        }
        Aabb::new(Point::from(lo), Point::from(hi))
    }

    fn shifted(&mut self, aabb: &Aabb<N, D>, quarters: u32) -> Aabb<N, D> {
        let span = 2 * quarters + 1;
        let random = &mut self.random;
        let step = Vector::<N, D>::from_fn(|_, _| {
            N::lit((f64::from(random.below(span)) - f64::from(quarters)) / 4.0)
        });
        Aabb::new(aabb.mins() + step, aabb.maxs() + step)
    }

    fn create(&mut self) {
        let aabb = self.random_box();
        let serial = u32::try_from(self.uids.len()).expect("small");
        let handle = self.tested.create_proxy(aabb, serial);
        self.uids.push(uid(handle));
        assert_eq!(self.tested.proxy(handle), Some((&aabb, &serial)), "it is there");
        let object = Object { handle, known: None, waiting: Some(aabb) };
        let old = self.model.objects.insert(uid(handle), object);
        assert!(old.is_none(), "uids are unique among the living");
    }

    fn any(&mut self) -> Option<u32> {
        let count = u32::try_from(self.model.objects.len()).expect("small");
        let at = self.random.below(count.max(1)) as usize;
        self.model.objects.keys().nth(at).copied()
    }

    fn set(&mut self, uid: u32, aabb: Aabb<N, D>) {
        let object = self.model.objects.get_mut(&uid).expect("alive");
        object.waiting = Some(aabb);
        self.tested.deferred_set_bounding_volume(object.handle, aabb);
    }

    /// Moves a random object: anywhere, or by up to 1/4 or 3/4 of a cell along each axis. In one of
    /// ten calls, a second box replaces the first before the update.
    fn move_one(&mut self) {
        let Some(uid) = self.any() else { return };
        let object = &self.model.objects[&uid];
        let present = object.waiting.or(object.known.map(|known| known.0)).expect("one of both");
        let next = match self.random.below(12) {
            0 => self.random_box(),
            1..5 => self.shifted(&present, 1),
            _ => self.shifted(&present, 3),
        };
        self.set(uid, next);
        if self.random.one_in(10) {
            let last = self.shifted(&next, 2);
            self.set(uid, last);
        }
    }

    fn remove_some(&mut self) {
        let count = self.random.below(4);
        let mut uids: Vec<u32> = (0..count).filter_map(|_| self.any()).collect();
        uids.sort_unstable();
        uids.dedup();
        let handles: Vec<_> = uids.iter().map(|uid| self.model.objects[uid].handle).collect();
        let mut calls = Vec::new();
        let translate = &self.uids;
        self.tested.remove(&handles, &mut |&a, &b| {
            calls.push((translate[a as usize], translate[b as usize]));
        });
        self.reached.removed_pairs += calls.len();
        assert_eq!(calls, self.model.remove(&uids), "each pair of the removed, once, in order");
        for handle in handles {
            assert!(self.tested.proxy(handle).is_none(), "gone");
            let refused = self.tested.try_remove(&[handle], &mut |_, _| ());
            assert!(refused.is_err(), "not twice");
        }
    }

    fn recompute(&mut self) {
        if self.random.one_in(2) {
            self.model.rule += 1;
            self.model.is_all_again = true;
            self.tested.deferred_recompute_all_proximities();
        } else if let Some(uid) = self.any() {
            // The rule stays, and only the pairs of this object are filtered again.
            self.model.again.push(uid);
            let handle = self.model.objects[&uid].handle;
            self.tested.deferred_recompute_all_proximities_with(handle);
        }
    }

    fn update(&mut self) {
        let (events, asked) = self.model.update();
        let (mut got, mut questions) = (Vec::new(), Vec::new());
        let (translate, rule) = (&self.uids, self.model.rule);
        let pair = |a: &u32, b: &u32| (translate[*a as usize], translate[*b as usize]);
        self.tested.update(
            &mut |a, b| {
                let (a, b) = pair(a, b);
                questions.push((a, b));
                allows(rule, a, b)
            },
            &mut |a, b, started| got.push((pair(a, b).0, pair(a, b).1, started)),
        );
        assert_eq!(got, events, "{:?}: events", self.plan);
        assert_eq!(questions, asked, "{:?}: the filter is asked once, in order", self.plan);
        self.tested.validate().expect("sound");
        let reached = &mut self.reached;
        reached.started += events.iter().filter(|event| event.2).count();
        reached.stopped += events.iter().filter(|event| !event.2).count();
        reached.refused += self.model.decided.values().filter(|&&allowed| !allowed).count();
        self.compare_state();
    }

    fn compare_state(&mut self) {
        let mut pairs: Vec<_> = self.tested.pairs().map(|(a, b)| (uid(a), uid(b))).collect();
        pairs.sort_unstable();
        assert_eq!(pairs, self.model.pairs(), "{:?}: pairs", self.plan);
        assert_eq!(self.tested.num_interferences(), pairs.len(), "counted");
        self.reached.most_pairs = self.reached.most_pairs.max(pairs.len());
        for object in self.model.objects.values() {
            let (exact, loose) = object.known.expect("updated");
            assert_eq!(self.tested.loosened_volume(object.handle), Some(&loose), "loosened");
            assert_eq!(self.tested.proxy(object.handle).map(|p| p.0), Some(&exact), "exact");
            assert!(loose.contains(&outwards(&exact)), "the loosened box holds the exact one");
        }
    }

    /// Returns the uids of the objects known to the last update for whose exact box `pass` returns
    /// `true`.
    fn expected(&self, pass: impl Fn(&Aabb<N, D>) -> bool) -> Vec<u32> {
        let known = self.model.objects.iter().filter_map(|(uid, o)| Some((*uid, o.known?.0)));
        known.filter(|(_, exact)| pass(exact)).map(|(uid, _)| uid).collect()
    }

    fn compare_queries(&mut self) {
        let (query, target) = (self.random_box(), self.random_box());
        let mut dir = target.mins() - query.mins();
        dir[0] = if self.random.one_in(4) { N::ZERO } else { dir[0] };
        let finite = |p: &Point<N, D>| p.iter().all(|x| x.is_finite_number());
        let origin = if finite(query.mins()) { *query.mins() } else { Point::origin() };
        let ray = Ray::new(
            origin,
            if dir.iter().all(|x| x.is_finite_number()) {
                dir
            } else {
                Vector::<N, D>::repeat(N::ONE)
            },
        );
        let translate = |found: Vec<&u32>| -> Vec<u32> {
            found.iter().map(|&&serial| self.uids[serial as usize]).collect()
        };
        let (mut boxes, mut rays, mut points) = (Vec::new(), Vec::new(), Vec::new());
        self.tested.interferences_with_bounding_volume(&query, &mut boxes);
        self.tested.interferences_with_ray(&ray, &mut rays);
        self.tested.interferences_with_point(&origin, &mut points);
        assert_eq!(translate(boxes), self.expected(|exact| exact.intersects(&query)), "boxes");
        let hit = self.expected(|exact| exact.intersects_ray(&ray));
        assert_eq!(translate(rays), hit, "rays: {ray:?}");
        let held = self.expected(|exact| exact.contains_point(&origin));
        assert_eq!(translate(points), held, "points");
        self.compare_order(&ray, &hit);
        self.reached.query_hits += usize::from(!hit.is_empty());
        self.reached.query_misses += usize::from(hit.is_empty());
    }

    /// Asserts that the search visits hits in order of their times of entry, and that it visits no
    /// hit beyond the limit that the visitor returns.
    fn compare_order(&self, ray: &Ray<N, D>, hit: &[u32]) {
        let time = |uid: &u32| {
            let exact = self.model.objects[uid].known.expect("known").0;
            exact.ray_interval(ray).expect("a hit").0
        };
        let mut expected: Vec<(N, u32)> = hit.iter().map(|uid| (time(uid), *uid)).collect();
        expected.sort_by(|a, b| a.partial_cmp(b).expect("times are numbers"));
        let visit = |limit: N, mut next: Box<dyn FnMut(N) -> N>| {
            let mut visited = Vec::new();
            self.tested.visit_ray(ray, limit, &mut |serial| {
                let uid = self.uids[*serial as usize];
                visited.push((time(&uid), uid));
                next(time(&uid))
            });
            visited
        };
        assert_eq!(visit(N::INFINITY, Box::new(|_| N::INFINITY)), expected, "all, in order");
        // The limit becomes the first time of entry: further boxes entered at that time still
        // count.
        let first = expected.first().map(|first| first.0);
        expected.retain(|hit| Some(hit.0) == first);
        assert_eq!(visit(N::INFINITY, Box::new(|time| time)), expected, "the first ones");
    }

    fn step(&mut self, step: u32) {
        // Phases: all objects move, a few move, nearly none do (so that objects come to rest).
        let count = self.plan.objects;
        let moves = match step / 20 % 4 {
            0 => count,
            1 => count / 20 + 1,
            _ => self.random.below(3),
        };
        (0..moves).for_each(|_| self.move_one());
        if self.random.one_in(2) {
            self.remove_some();
        }
        while self.model.objects.len() < count as usize && !self.random.one_in(3) {
            self.create();
        }
        if self.random.one_in(12) {
            self.recompute();
        }
        if self.random.one_in(40) {
            // An object created and removed before any update.
            self.create();
            let handle = self.model.objects.values().find(|object| object.known.is_none());
            let handle = handle.expect("just created").handle;
            self.model.remove(&[uid(handle)]);
            self.tested.remove(&[handle], &mut |_, _| panic!("it had no pairs"));
        }
        self.update();
        (0..3).for_each(|_| self.compare_queries());
        // Moves that no update has applied must not affect searches.
        self.move_one();
        self.remove_some();
        self.compare_queries();
    }
}

/// Runs the plan, compares after each call, and returns what happened.
pub(crate) fn run<N: Space<D>, const D: usize>(plan: Plan) -> Reached {
    let mut run = Run::<N, D>::new(plan);
    (0..plan.objects).for_each(|_| run.create());
    (0..plan.updates).for_each(|step| run.step(step));
    // Finally all objects are removed: each start has exactly one stop.
    let all: Vec<u32> = run.model.objects.keys().copied().collect();
    let handles: Vec<_> = run.model.objects.values().map(|object| object.handle).collect();
    let mut last = 0;
    run.tested.remove(&handles, &mut |_, _| last += 1);
    assert_eq!(last, run.model.remove(&all).len(), "the pairs left");
    let reached = run.reached;
    assert_eq!(reached.started, reached.stopped + reached.removed_pairs + last, "{reached:?}");
    assert_eq!(run.tested.num_interferences(), 0, "nothing is left");
    run.tested.validate().expect("sound when empty");
    reached
}
