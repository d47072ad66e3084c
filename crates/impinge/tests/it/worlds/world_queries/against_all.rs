//! Compares queries of random worlds with the same query of every single object: the results must
//! be equal to the bit.

use std::cell::Cell;

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::math::{Point, Space};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::query::{ClosestPoints, ImpactOptions, Ray, RayBatch};
use impinge::shape::{Ball, Plane, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_reference::random::Random;

use super::stage::{
    Filter, Object, Row, Stage, Unordered, World, contacts, ground, neighbors, placed, point,
    random_shape, rows, vector,
};

/// Number of results compared, by query, so that a test can assert that there were enough.
#[derive(Debug, Default)]
struct Answers {
    rays: usize,
    points: usize,
    holders: usize,
    near: usize,
    overlaps: usize,
    boxes: usize,
    casts: usize,
}

/// A world, and its offset from the origin.
struct Scene<N: Space<D>, const D: usize> {
    world: World<N, D>,
    random: Random,
    offset: f64,
    answers: Answers,
}

type Counts<N, const D: usize> = dyn Fn(&Object<N, D>) -> bool;

/// A filter for the world, and the equivalent condition for the test.
struct Choice<'a, N: Space<D>, const D: usize> {
    filter: Filter<'a, N, D>,
    counts: Box<Counts<N, D>>,
}

fn random_groups(random: &mut Random) -> CollisionGroups {
    let mut groups = CollisionGroups::new();
    match random.below(4) {
        0 => groups.set_membership(&[random.below(3)]),
        1 => groups.set_whitelist(&[random.below(3)]),
        2 => groups.set_blacklist(&[random.below(3)]),
        _ => {}
    }
    groups
}

fn is_even<N: Space<D>, const D: usize>(object: &Object<N, D>) -> bool {
    object.data().is_multiple_of(2)
}

impl<N: Stage<D>, const D: usize> Scene<N, D> {
    fn new(seed: u64, offset: f64, is_ordered: bool) -> Self {
        let mut world = World::new(N::lit(0.1));
        if !is_ordered {
            world.set_broad_phase(Box::new(Unordered::<N, D>::new()));
        }
        let (random, answers) = (Random::new(seed), Answers::default());
        let mut scene = Self { world, random, offset, answers };
        scene.world.add(
            N::pose_at(core::array::from_fn(|_| offset - 9.0), 0.0),
            ground(),
            CollisionGroups::new(),
            contacts(),
            0,
        );
        scene.add(150);
        scene
    }

    fn place(&mut self) -> [f64; D] {
        self.random.vector::<D>(10.0).map(|x| self.offset + x)
    }

    fn pose(&mut self) -> N::Isometry {
        N::pose_at(self.place(), self.random.range(-3.0, 3.0))
    }

    /// Returns a random point, in half of the cases near the centre of an object.
    fn point_to_ask(&mut self) -> Point<N, D> {
        let anywhere = point::<N, D>(self.place());
        let objects: Vec<_> = self.world.collision_objects().collect();
        let middle = N::pose(self.random.pick(&objects).position()).translation;
        let beside = vector::<N, D>(self.random.vector::<D>(0.5));
        if self.random.chance(0.5) { anywhere } else { Point::from(middle + beside) }
    }

    /// Returns a random maximum distance.
    fn reach(&mut self) -> N {
        if self.random.chance(0.2) { N::INFINITY } else { N::lit(self.random.range(0.0, 3.0)) }
    }

    fn add(&mut self, count: usize) {
        for _ in 0..count {
            // Some objects are equal in everything except the handle.
            let (pose, shape) = (self.pose(), random_shape(&mut self.random));
            for _ in 0..1 + self.random.below(6) / 5 {
                let groups = random_groups(&mut self.random);
                let number = self.world.len();
                self.world.add(pose, shape.clone(), groups, contacts(), number);
            }
        }
    }

    /// Removes, moves or changes a quarter of the objects on average, and adds eight, without an
    /// update.
    fn disturb(&mut self) {
        let handles: Vec<_> = self.world.collision_objects().map(Object::handle).collect();
        for &handle in handles.iter().skip(1) {
            match self.random.below(16) {
                0 => self.world.remove(&[handle]),
                1 => {
                    let pose = self.pose();
                    self.world.set_position(handle, pose);
                }
                2 => self.world.set_shape(handle, random_shape(&mut self.random)),
                3 => self.world.set_collision_groups(handle, random_groups(&mut self.random)),
                _ => {}
            }
        }
        self.add(8);
    }

    /// Changes one or all objects without an update, or updates the world.
    fn change_one(&mut self) {
        let handles: Vec<_> = self.world.collision_objects().map(Object::handle).collect();
        let handle = *self.random.pick(&handles[1..]);
        match self.random.below(40) {
            0..3 => self.add(1),
            3..6 => self.world.remove(&[handle]),
            6..10 => self.world.set_shape(handle, random_shape(&mut self.random)),
            10 => self.world.set_shape(handle, ground()),
            11..13 => self.world.set_collision_groups(handle, random_groups(&mut self.random)),
            13 => self.world.update(),
            14..20 => {
                let pose = self.pose();
                self.world.set_position(handle, pose);
            }
            20 => self.shift_all(&handles[1..]),
            _ => self.shift_all(&[handle]),
        }
        let planes = |object: &&Object<N, D>| object.shape().is_shape::<Plane<N, D>>();
        let plane = self.world.collision_objects().skip(1).find(planes).map(Object::handle);
        if let Some(plane) = plane.filter(|_| self.random.chance(0.2)) {
            self.world.set_shape(plane, random_shape(&mut self.random));
        }
    }

    /// Moves the objects `handles` by up to 0.3, and gives them random rotations.
    fn shift_all(&mut self, handles: &[CollisionObjectHandle]) {
        for &handle in handles {
            let object = self.world.collision_object(handle).expect("it is there");
            let middle = N::pose(object.position()).translation;
            let shift = self.random.vector::<D>(0.3);
            let place = core::array::from_fn(|axis| middle[axis].as_f64() + shift[axis]);
            self.world.set_position(handle, N::pose_at(place, self.random.range(-3.0, 3.0)));
        }
    }

    fn choice<'a>(&mut self) -> Choice<'a, N, D> {
        let (groups, pick) = (random_groups(&mut self.random), self.random.below(4));
        let objects: Vec<_> = self.world.collision_objects().map(Object::handle).collect();
        let [first, second] = [0, 1].map(|_| *self.random.pick(&objects));
        let filter = Filter::new();
        match pick {
            0 => Choice { filter, counts: Box::new(|_| true) },
            1 => Choice {
                filter: groups.into(),
                counts: Box::new(move |object| {
                    object.collision_groups().can_interact_with_groups(&groups)
                }),
            },
            2 => Choice {
                filter: filter.exclude(first).exclude(second),
                counts: Box::new(move |object| ![first, second].contains(&object.handle())),
            },
            _ => Choice { filter: filter.predicate(&is_even), counts: Box::new(is_even) },
        }
    }

    /// Returns the results of all accepted objects, sorted by key, then by handle.
    fn ranked<A>(
        &self,
        choice: &Choice<'_, N, D>,
        answer: impl Fn(&Object<N, D>) -> Option<(N, A)>,
    ) -> Vec<Row<(N, A)>> {
        let objects = self.world.collision_objects().filter(|object| (choice.counts)(object));
        let mut all: Vec<Row<(N, A)>> =
            objects.filter_map(|object| Some((object.handle(), answer(object)?))).collect();
        all.sort_by(|a, b| {
            let by_key = a.1.0.partial_cmp(&b.1.0).expect("keys are numbers");
            by_key.then(a.0.cmp(&b.0))
        });
        all
    }

    fn ray(&mut self) {
        let (origin, target) = (point::<N, D>(self.place()), point::<N, D>(self.place()));
        let ray = Ray::new(origin, (target - origin) * N::HALF);
        let is_solid = self.random.chance(0.5);
        let max = if self.random.chance(0.3) { N::INFINITY } else { N::lit(self.random.share()) };
        let choice = self.choice();
        let expected: Vec<_> = self
            .ranked(&choice, |object| {
                let hit = N::ray(placed(object), &ray, is_solid)?;
                (hit.toi <= max).then_some((hit.toi, hit))
            })
            .into_iter()
            .map(|(handle, (_, hit))| (handle, hit))
            .collect();
        let found = rows(self.world.ray_hits(&ray, max, is_solid, &choice.filter));
        assert_eq!(found, expected, "{ray:?} until {max}, solid: {is_solid}");
        let first = self.world.first_ray_hit(&ray, max, is_solid, &choice.filter);
        assert_eq!(rows(first.into_iter().collect()), expected[..expected.len().min(1)], "{ray:?}");
        let rays = [ray; 3];
        let batch = RayBatch { rays: &rays, max_time: max, solid: is_solid };
        let mut hits = [None; 3];
        self.world.cast_rays(&batch, &choice.filter, &mut hits);
        let alone = first.map(|(object, hit)| (object.handle(), hit));
        assert_eq!(hits, [alone; 3], "{ray:?} in a batch");
        self.answers.rays += expected.len();
    }

    fn point(&mut self) {
        let p = self.point_to_ask();
        let (choice, is_solid) = (self.choice(), self.random.chance(0.5));
        let max = self.reach();
        let expected = self.ranked(&choice, |object| {
            let (nearest, distance) = N::project(placed(object), &p, is_solid);
            (distance <= max).then_some((distance, nearest))
        });
        let found = self.world.project_point(&p, max, is_solid, &choice.filter);
        let first = expected.first().map(|(handle, (_, nearest))| (*handle, *nearest));
        assert_eq!(found.map(|(object, nearest)| (object.handle(), nearest)), first, "{p}");
        self.answers.points += usize::from(first.is_some());

        let count = self.random.below(9);
        let expected = self.ranked(&choice, |object| {
            let (nearest, distance) = N::project(placed(object), &p, true);
            let apart = ClosestPoints::WithinMargin(p, nearest.point);
            let points = if nearest.is_inside { ClosestPoints::Intersecting } else { apart };
            (distance <= max).then_some((distance, points))
        });
        let found = self.world.nearest_to_point(&p, count, max, &choice.filter);
        assert_eq!(neighbors(&found), expected[..expected.len().min(count)], "{count} near {p}");

        let holders: Vec<_> =
            expected.iter().filter(|row| row.1.0 == N::ZERO).map(|row| row.0).collect();
        let found = self.world.objects_containing(&p, &choice.filter);
        assert_eq!(found.map(Object::handle).collect::<Vec<_>>(), holders, "{p}");
        self.answers.holders += holders.len();
    }

    fn solid(&mut self) {
        let (pose, shape, choice): (_, ShapeHandle<N, D>, _) =
            (self.pose(), random_shape(&mut self.random), self.choice());
        let max = self.reach();
        let own = (&pose, &*shape);
        let expected = self.ranked(&choice, |object| {
            let distance = N::distance(own, placed(object));
            let points = N::closest(own, placed(object), max);
            (distance <= max).then_some((distance, points))
        });
        let all = self.world.objects_within(&pose, &*shape, max, &choice.filter);
        assert_eq!(neighbors(&all), expected, "{shape:?} at {pose:?} up to {max}");
        let count = self.random.below(9);
        let found = self.world.nearest_objects(&pose, &*shape, count, max, &choice.filter);
        assert_eq!(neighbors(&found), expected[..expected.len().min(count)], "the first {count}");
        let found = self.world.closest_object(&pose, &*shape, max, &choice.filter);
        let found: Vec<_> = found.into_iter().collect();
        assert_eq!(neighbors(&found), expected[..expected.len().min(1)], "the first");
        self.answers.near += expected.len();

        let overlapped: Vec<_> =
            expected.iter().filter(|row| row.1.0 == N::ZERO).map(|row| row.0).collect();
        let found = self.world.objects_overlapping(&pose, &*shape, &choice.filter);
        assert_eq!(found.map(Object::handle).collect::<Vec<_>>(), overlapped, "{shape:?}");
        let any = self.world.overlaps_any(&pose, &*shape, &choice.filter);
        assert_eq!(any, !overlapped.is_empty(), "{shape:?}");
        self.answers.overlaps += overlapped.len();
    }

    fn boxes(&mut self) {
        let (lo, choice) = (self.place(), self.choice());
        let aabb = Aabb::new(point(lo), point(lo.map(|x| x + self.random.range(0.0, 3.0))));
        let meets = |object: &Object<N, D>| {
            let own = object.shape().aabb(&N::pose(object.position()));
            own.intersects(&aabb).then_some((N::ZERO, ()))
        };
        let expected: Vec<_> =
            self.ranked(&choice, meets).into_iter().map(|(handle, _)| handle).collect();
        let found = self.world.objects_in_aabb(&aabb, &choice.filter);
        assert_eq!(found.map(Object::handle).collect::<Vec<_>>(), expected, "{aabb:?}");
        self.answers.boxes += expected.len();
    }

    fn cast(&mut self) {
        let (pose, shape, choice): (_, ShapeHandle<N, D>, _) =
            (self.pose(), random_shape(&mut self.random), self.choice());
        let velocity = vector(self.random.vector::<D>(20.0));
        let mut options =
            ImpactOptions::new().with_target_distance(N::lit(match self.random.below(3) {
                0 => self.random.range(0.0, 1.0),
                _ => 0.0,
            }));
        if self.random.chance(0.7) {
            options.max_time = N::lit(self.random.share());
        }
        let expected: Vec<_> = self
            .ranked(&choice, |object| {
                let found = N::impact(((&pose, &*shape), velocity), placed(object), &options)?;
                Some((found.toi, found))
            })
            .into_iter()
            .map(|(handle, (_, found))| (handle, found))
            .collect();
        let found = self.world.cast_shape_all(&pose, &velocity, &*shape, &options, &choice.filter);
        assert_eq!(rows(found), expected, "{shape:?} at {pose:?} along {velocity}, {options:?}");
        let first = self.world.cast_shape(&pose, &velocity, &*shape, &options, &choice.filter);
        assert_eq!(rows(first.into_iter().collect()), expected[..expected.len().min(1)], "first");
        self.answers.casts += expected.len();
    }

    fn ask(&mut self, rounds: usize) {
        for _ in 0..rounds {
            self.ray();
            self.point();
            self.solid();
            self.boxes();
            self.cast();
        }
    }
}

/// Runs queries before the first update, after an update, after changes since that update, and
/// after the next update.
fn play<N: Stage<D>, const D: usize>(seed: u64, offset: f64, is_ordered: bool) {
    let mut scene = Scene::<N, D>::new(seed, offset, is_ordered);
    scene.ask(8);
    for _ in 0..3 {
        scene.world.update();
        scene.ask(12);
        scene.disturb();
        scene.ask(12);
    }
    let Answers { rays, points, holders, near, overlaps, boxes, casts } = scene.answers;
    let least = [rays, points, holders, near, overlaps, boxes, casts].into_iter().min();
    assert!(least >= Some(20), "every question found something: {:?}", scene.answers);
}

fn everywhere<N: Stage<D>, const D: usize>() {
    play::<N, D>(1, 0.0, true);
    play::<N, D>(2, 0.0, false);
    // At this offset the coordinates are coarse; the queries of single solids and pairs get the
    // same coordinates.
    play::<N, D>(3, 1e6, true);
}

/// Runs a query after each change, so that the boxes of the last update are valid for few or for
/// many objects.
fn changes_one_by_one<N: Stage<D>, const D: usize>() {
    let mut scene = Scene::<N, D>::new(5, 0.0, true);
    for change in 0..500 {
        scene.change_one();
        match change % 5 {
            0 => scene.ray(),
            1 => scene.point(),
            2 => scene.solid(),
            3 => scene.boxes(),
            _ => scene.cast(),
        }
    }
    let Answers { rays, points, holders, near, overlaps, boxes, casts } = scene.answers;
    let least = [rays, points, holders, near, overlaps, boxes, casts].into_iter().min();
    assert!(least >= Some(20), "every question found something: {:?}", scene.answers);
    scene.world.update();
    assert_eq!(scene.world.validate(), Ok(()), "the pairs after it");
}

/// Asserts that queries do not test all objects that moved since the last update: with up to 1500
/// moved objects of 2000, they test fewer than 1.5 times as many objects as with none.
fn moved_objects_are_found_by_their_boxes<N: Stage<D>, const D: usize>() {
    let tested = [0, 100, 450, 1500].map(|moved| {
        let mut world = World::<N, D>::new(N::lit(0.1));
        let (mut random, ball) = (Random::new(6), ShapeHandle::new(Ball::new(N::HALF)));
        let side = 2000_f64.powf(1.0 / D as f64);
        let mut place = || N::pose_at(random.vector::<D>(side), 0.0);
        for number in 0..2000 {
            world.add(place(), ball.clone(), CollisionGroups::new(), contacts(), number);
        }
        world.update();
        let handles: Vec<_> = world.collision_objects().map(Object::handle).collect();
        let asked = Cell::new(0);
        let count = |_: &Object<N, D>| {
            asked.set(asked.get() + 1);
            true
        };
        let filter = Filter::new().predicate(&count);
        for (question, &handle) in handles.iter().step_by(7).take(100).enumerate() {
            // Objects move before the first query and between queries.
            let some = handles.len() / 100 * question..handles.len() / 100 * (question + 1);
            for &other in handles[some].iter().take(moved / 100) {
                world.set_position(other, place());
            }
            let here = *world.collision_object(handle).expect("it is there").position();
            let (own, options) = (Ball::new(N::HALF), ImpactOptions::new());
            let velocity = vector([1.0; D]);
            let _ = world.cast_shape(&here, &velocity, &own, &options, &filter);
            let _ = world.nearest_objects(&here, &own, 3, N::INFINITY, &filter);
            let _ = world.objects_overlapping(&here, &own, &filter).count();
            let ray = Ray::new(Point::from(N::pose(&here).translation), velocity);
            let _ = world.first_ray_hit(&ray, N::INFINITY, true, &filter);
        }
        asked.get()
    });
    let most = tested.iter().max().expect("four");
    assert!(2 * most < 3 * tested[0], "objects tested, with 0, 100, 450, 1500 moved: {tested:?}");
}

/// Asserts that a query calls a predicate at most once for each object, and for fewer than half of
/// the objects.
fn predicates<N: Stage<D>, const D: usize>() {
    let mut scene = Scene::<N, D>::new(4, 0.0, true);
    scene.world.update();
    let asked = Cell::new(0);
    let count = |object: &Object<N, D>| {
        asked.set(asked.get() + 1);
        object.data() % 3 == 1
    };
    let filter = Filter::new().predicate(&count);
    let found = scene.world.nearest_to_point(&Point::origin(), 1, N::INFINITY, &filter);
    assert_eq!(found[0].object.data() % 3, 1, "a third of them");
    let total = scene.world.len();
    assert!(asked.get() > 1 && 2 * asked.get() < total, "{} of {total}", asked.get());
    asked.set(0);
    let all = scene.world.nearest_to_point(&Point::origin(), total, N::INFINITY, &filter);
    assert_eq!(asked.get(), total, "each once");
    assert!(all.len() > total / 4 && all.len() < total / 2, "{} of {total}", all.len());
}

in_tests!(everywhere, changes_one_by_one, moved_objects_are_found_by_their_boxes, predicates);
