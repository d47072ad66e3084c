//! A world and its naive twin, on which the same operations are performed.

use std::collections::BTreeMap;

use impinge::bounding_volume::Aabb;
use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::Point;
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, DefaultNarrowPhase};
use impinge::query::{Proximity, Ray};
use impinge::world::{CollisionObject, CollisionWorld, WorldError};
use impinge_reference::geometry::Pose;
use impinge_reference::random::Random;
use impinge_reference::world::{Events, Handle, NaiveWorld};

use super::draw::{self, Grid};
use super::twins::{self, OnGrid, Twins};
use crate::support::world_stage::vector;

/// Counts of the events and operations of a run, with which a test asserts that each kind occurred
/// often enough.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) updates: usize,
    pub(crate) started: usize,
    pub(crate) transitions: usize,
    pub(crate) removal_events: usize,
    pub(crate) exchanges: usize,
    pub(crate) refusals: usize,
    /// Number of contact pairs that the broad phase keeps, summed over the updates; `touching`
    /// counts those with contacts.
    pub(crate) near: usize,
    pub(crate) touching: usize,
    pub(crate) queries: usize,
    pub(crate) hits: usize,
    /// Number of pairs of fixed objects that overlap, summed over the updates.
    pub(crate) fixed: usize,
    /// Number of events of earlier updates that an update kept, summed over the updates.
    pub(crate) kept: usize,
    /// Number of pairs computed between updates; `changed` counts those that started or stopped
    /// thereby.
    pub(crate) substeps: usize,
    pub(crate) changed: usize,
    /// Number of pairs for which a filter passed to the update was called.
    pub(crate) asked: usize,
    /// Number of removed objects to which events refer.
    pub(crate) named: usize,
    /// Number of pairs that have contacts only because of their skins.
    pub(crate) in_skins: usize,
}

/// Contact and proximity of each pair according to the events so far, with which new events must be
/// consistent.
#[derive(Default)]
struct Told {
    touching: BTreeMap<(CollisionObjectHandle, CollisionObjectHandle), ()>,
    proximity: BTreeMap<(CollisionObjectHandle, CollisionObjectHandle), Proximity>,
}

pub(crate) struct Both<N: Grid<D>, const D: usize> {
    pub(super) random: Random,
    pub(super) world: CollisionWorld<N, D, u64>,
    pub(super) naive: NaiveWorld<D, OnGrid<D>>,
    pub(super) twins: Twins,
    pub(super) alive: Vec<CollisionObjectHandle>,
    pub(super) stale: Vec<CollisionObjectHandle>,
    told: Told,
    /// The data of all objects that ever existed.
    pub(super) data: BTreeMap<CollisionObjectHandle, u64>,
    /// Removed objects whose data were taken.
    pub(super) taken: Vec<CollisionObjectHandle>,
    /// Number of the filter that is passed to each update, if any; see [`Grid::register`].
    pub(super) lent: Option<usize>,
    /// Whether the next update keeps the events of the last one.
    pub(super) keeps_events: bool,
    /// Events of the last update, including those that it kept.
    last: Events,
    pub(crate) tally: Tally,
}

impl<N: Grid<D>, const D: usize> Both<N, D> {
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let margin = *random.pick(&[0.0, 0.125, 0.5]);
        Self {
            random,
            world: CollisionWorld::new(N::lit(margin)),
            naive: NaiveWorld::new(),
            twins: Twins::new(),
            alive: Vec::new(),
            stale: Vec::new(),
            told: Told::default(),
            data: BTreeMap::new(),
            taken: Vec::new(),
            lent: None,
            keeps_events: false,
            last: Events::default(),
            tally: Tally::default(),
        }
    }

    /// Performs a random operation on the world and its twin.
    pub(crate) fn operate(&mut self) {
        match self.random.below(124) {
            0..10 => self.add(),
            10..17 => self.remove(),
            17..38 => self.shift(),
            38..44 => self.teleport(),
            44..48 => self.move_many(),
            48..53 => self.change_shape(),
            53..58 => self.change_groups(),
            58..64 => self.change_query_type(),
            64..66 => self.change_filters(),
            66..67 => self.exchange_phases(),
            67..71 => self.try_nonsense(),
            71..83 => self.ask(),
            83..100 => self.update(),
            _ => self.operate_as_engine(),
        }
    }

    /// Returns a random living object; `None` if there is none.
    pub(super) fn someone(&mut self) -> Option<(CollisionObjectHandle, Handle)> {
        let handle = (!self.alive.is_empty()).then(|| *self.random.pick(&self.alive))?;
        Some((handle, self.twins[&handle]))
    }

    fn add(&mut self) {
        if self.alive.len() >= 16 {
            return;
        }
        let random = &mut self.random;
        let (position, pose) = draw::pose::<N, D>(random);
        let (shape, solid) = draw::shape::<N, D>(random);
        let (groups, naive_groups) = draw::groups(random);
        let (query_type, naive_query) = draw::query_type(random);
        let data = random.bits();
        let handle = self.world.add(position, shape, groups, query_type, data);
        let twin = self.naive.add(pose, OnGrid(solid), naive_groups, naive_query);
        assert_eq!(handle.uid(), twin.index, "the same place");
        let known = self.twins.insert(handle, twin);
        assert!(known.is_none(), "a handle is never given twice");
        let object = self.world.collision_object(handle).expect("it was added");
        assert_eq!((object.position(), *object.data()), (&position, data), "as given");
        self.data.insert(handle, data);
        self.alive.push(handle);
    }

    fn remove(&mut self) {
        let count = self.random.below(4).min(self.alive.len());
        let mut handles = Vec::new();
        for _ in 0..count {
            let place = self.random.below(self.alive.len());
            handles.push(self.alive.swap_remove(place));
        }
        self.world.remove(&handles);
        let naive: Vec<Handle> = handles.iter().map(|handle| self.twins[handle]).collect();
        self.naive.remove(&naive).expect("they are alive");
        assert!(handles.iter().all(|&handle| !self.world.contains(handle)), "gone at once");
        self.stale.extend(handles);
        self.check_data();
    }

    pub(super) fn place(
        &mut self,
        handle: CollisionObjectHandle,
        (position, pose): (N::Isometry, Pose<D>),
    ) {
        self.world.set_position(handle, position);
        self.naive.set_position(self.twins[&handle], pose).expect("alive");
    }

    fn shift(&mut self) {
        let Some((handle, twin)) = self.someone() else { return };
        let from = self.naive.object(twin).expect("alive").pose;
        let to = draw::pose_near::<N, D>(&from, &mut self.random);
        self.place(handle, to);
    }

    fn teleport(&mut self) {
        let Some((handle, _)) = self.someone() else { return };
        let to = draw::pose::<N, D>(&mut self.random);
        self.place(handle, to);
    }

    fn move_many(&mut self) {
        let mut positions = Vec::new();
        for _ in 0..self.random.below(6) {
            let Some((handle, twin)) = self.someone() else { return };
            let (position, pose) = draw::pose::<N, D>(&mut self.random);
            positions.push((handle, position));
            self.naive.set_position(twin, pose).expect("alive");
        }
        self.world.set_positions(&positions);
    }

    fn change_shape(&mut self) {
        let Some((handle, twin)) = self.someone() else { return };
        let (shape, solid) = draw::shape::<N, D>(&mut self.random);
        self.world.set_shape(handle, shape);
        self.naive.set_shape(twin, OnGrid(solid)).expect("alive");
    }

    fn change_groups(&mut self) {
        let Some((handle, twin)) = self.someone() else { return };
        let (groups, naive) = draw::groups(&mut self.random);
        self.world.set_collision_groups(handle, groups);
        self.naive.set_groups(twin, naive).expect("alive");
    }

    fn change_query_type(&mut self) {
        let Some((handle, twin)) = self.someone() else { return };
        let (query_type, naive) = draw::query_type(&mut self.random);
        self.world.set_query_type(handle, query_type);
        self.naive.set_query_type(twin, naive).expect("alive");
    }

    fn change_filters(&mut self) {
        let name = *self.random.pick(&["one", "another"]);
        if self.random.chance(0.6) {
            self.world.unregister_broad_phase_pair_filter(name);
            self.naive.unregister_filter(name);
        } else {
            let number = 2 + self.random.below(4);
            N::register(&mut self.world, name, number);
            self.naive.register_filter(name, move |a, b| !(a + b).is_multiple_of(number));
        }
    }

    fn exchange_phases(&mut self) {
        if self.random.chance(0.6) {
            let margin = N::lit(*self.random.pick(&[0.0, 0.25, 1.0]));
            self.world.set_broad_phase(Box::new(DBVTBroadPhase::new(margin)));
        }
        if self.random.chance(0.6) {
            self.world.set_narrow_phase(Box::new(DefaultNarrowPhase::<N, D>::new()));
        }
        self.tally.exchanges += 1;
    }

    /// Makes calls that the world must refuse. Later comparisons with the twin would detect a
    /// change of the world.
    fn try_nonsense(&mut self) {
        let (position, _) = draw::pose::<N, D>(&mut self.random);
        if !self.stale.is_empty() {
            let stale = *self.random.pick(&self.stale);
            let refused = Err(WorldError::StaleHandle(stale));
            assert_eq!(self.world.try_set_position(stale, position), refused, "stale");
            let mut all = self.alive.clone();
            all.push(stale);
            assert_eq!(self.world.try_remove(&all), refused, "one of them is stale");
            let moves: Vec<_> = all.iter().map(|&handle| (handle, position)).collect();
            assert_eq!(self.world.try_set_positions(&moves), refused, "one of them is stale");
            self.tally.refusals += 1;
        }
        if let Some((handle, _)) = self.someone() {
            let refused = Err(WorldError::RepeatedHandle(handle));
            assert_eq!(self.world.try_remove(&[handle, handle]), refused, "twice");
            let mut coordinates = [0.0; D];
            coordinates[1] = f64::NAN;
            let refused = self.world.try_set_position(handle, N::at(coordinates));
            assert!(matches!(refused, Err(WorldError::Position { .. })), "not a number");
        }
    }

    fn update(&mut self) {
        self.update_world();
        let new = self.naive.update();
        let mut events = std::mem::take(&mut self.last);
        if !std::mem::take(&mut self.keeps_events) {
            events = Events::default();
        }
        let kept = (events.contacts.len(), events.proximities.len());
        events.append(&new);
        let contacts = twins::contact_events(&self.twins, self.world.contact_events());
        let proximities = twins::proximity_events(&self.twins, self.world.proximity_events());
        let different = contacts != events.contacts || proximities != events.proximities;
        let scene = if different { self.describe() } else { String::new() };
        assert_eq!(contacts, events.contacts, "contact events\n{scene}");
        assert_eq!(proximities, events.proximities, "proximity events\n{scene}");
        let touching = twins::touching(&self.twins, &self.world);
        assert_eq!(touching, self.naive.touching_pairs(), "pairs with contacts");
        let close = twins::close(&self.twins, &self.world);
        assert_eq!(close, self.naive.close_pairs(), "pairs that are not disjoint");
        self.listen(kept);
        self.last = events;
        self.check_pairs_of_objects();
        self.count_rare_pairs();
        self.check_data();
        self.check_removed();
        self.tally.updates += 1;
        self.tally.transitions += new.proximities.len();
        self.tally.removal_events += new.removed_contacts + new.removed_proximities;
        self.tally.kept += kept.0 + kept.1;
        self.tally.touching += touching.len();
        self.tally.near += self.world.contact_pairs().count();
    }

    /// Describes the pairs on which the world and its twin differ.
    fn describe(&self) -> String {
        let mut text = String::new();
        let (world, naive) =
            (twins::touching(&self.twins, &self.world), self.naive.touching_pairs());
        let (world2, naive2) = (twins::close(&self.twins, &self.world), self.naive.close_pairs());
        let pairs = world.iter().chain(&naive).copied();
        let pairs = pairs.chain(world2.iter().chain(&naive2).map(|&(a, b, _)| (a, b)));
        for (a, b) in pairs {
            let status = |list: &[(Handle, Handle, _)]| {
                list.iter().find(|other| (other.0, other.1) == (a, b)).map(|other| other.2)
            };
            let same = world.contains(&(a, b)) == naive.contains(&(a, b));
            if same && status(&world2) == status(&naive2) {
                continue;
            }
            let objects = [a, b].map(|handle| self.naive.object(handle).expect("alive"));
            let distance = self.naive.signed_distance(objects[0], objects[1]);
            text += &format!("distance {distance:e} of {:#?}\n", objects);
        }
        text
    }

    /// Asserts for each new event, after those that were kept, that a contact starts and stops in
    /// turn, and that a proximity's old status is the new status of the pair's previous event, or
    /// disjoint if there is none.
    fn listen(&mut self, kept: (usize, usize)) {
        for event in &self.world.contact_events()[kept.0..] {
            let consistent = match *event {
                ContactEvent::Started(a, b) => self.told.touching.insert((a, b), ()).is_none(),
                ContactEvent::Stopped(a, b) => self.told.touching.remove(&(a, b)).is_some(),
            };
            assert!(consistent, "{event:?} out of turn");
            self.tally.started += usize::from(matches!(event, ContactEvent::Started(..)));
        }
        for event in &self.world.proximity_events()[kept.1..] {
            let pair = (event.collider1, event.collider2);
            let before = self.told.proximity.insert(pair, event.new_status);
            assert_eq!(before.unwrap_or(Proximity::Disjoint), event.prev_status, "{event:?}");
        }
    }

    /// Removes everything and asserts that every pair has stopped.
    pub(crate) fn finish(&mut self) {
        self.world.remove(&self.alive);
        let naive: Vec<Handle> = self.alive.iter().map(|handle| self.twins[handle]).collect();
        self.naive.remove(&naive).expect("they are alive");
        self.update();
        assert!(self.told.touching.is_empty(), "each contact that started has stopped");
        let disjoint = self.told.proximity.values().all(|status| *status == Proximity::Disjoint);
        assert!(disjoint, "each proximity has ended");
    }

    /// Compares queries of the world and its twin, also between changes and the next update.
    fn ask(&mut self) {
        let (groups, naive_groups) = draw::groups(&mut self.random);
        let (a, b) = (draw::point::<D>(&mut self.random), draw::point::<D>(&mut self.random));
        let twin = |object: &CollisionObject<N, D, u64>| self.twins[&object.handle()];

        let point = Point::from(vector::<N, D>(a));
        let found: Vec<_> =
            self.world.interferences_with_point(&point, &groups).map(twin).collect();
        assert_eq!(found, self.naive.interferences_with_point(&a, naive_groups), "at {a:?}");
        self.tally.hits += usize::from(!found.is_empty());

        let least = std::array::from_fn(|axis| a[axis].min(b[axis]));
        let greatest = std::array::from_fn(|axis| a[axis].max(b[axis]));
        let aabb = Aabb::new(vector::<N, D>(least).into(), vector::<N, D>(greatest).into());
        let found: Vec<_> = self.world.interferences_with_aabb(&aabb, &groups).map(twin).collect();
        let expected = self.naive.interferences_with_aabb(&least, &greatest, naive_groups);
        assert_eq!(found, expected, "in {least:?} {greatest:?}");
        self.tally.hits += usize::from(!found.is_empty());

        let direction = draw::direction::<D>(&mut self.random);
        let ray = Ray::new(point, vector(direction));
        let hits: Vec<_> = self.world.interferences_with_ray(&ray, &groups).collect();
        let found: Vec<_> = hits.iter().map(|(object, _)| twin(object)).collect();
        let expected = self.naive.interferences_with_ray(&a, &direction, naive_groups);
        let handles: Vec<_> = expected.iter().map(|(handle, _)| *handle).collect();
        let scene = |handle: &Handle| {
            let object = self.naive.object(*handle).expect("alive");
            format!("{:?} at {:?}\n", object.shape, object.pose)
        };
        let scene: String = found.iter().chain(&handles).map(scene).collect();
        assert_eq!(found, handles, "from {a:?} along {direction:?}: {scene}");
        let slack = 1e-3 * if N::EPSILON.as_f64() < 1e-9 { 1e-6 } else { 1.0 };
        for ((_, hit), (_, t)) in hits.iter().zip(&expected) {
            assert!((hit.toi.as_f64() - t).abs() <= slack * (1.0 + t), "{} for {t}", hit.toi);
        }
        let first = self.world.first_interference_with_ray(&ray, &groups);
        let nearest = hits.iter().min_by(|(a, hit1), (b, hit2)| {
            let by_time = hit1.toi.partial_cmp(&hit2.toi).expect("times are numbers");
            by_time.then(a.handle().cmp(&b.handle()))
        });
        let name = |(object, hit): &(&CollisionObject<N, D, u64>, _)| (object.handle(), *hit);
        assert_eq!(first.as_ref().map(name), nearest.map(name), "the first of them");
        self.tally.hits += usize::from(!hits.is_empty());
        self.tally.queries += 3;
    }
}
