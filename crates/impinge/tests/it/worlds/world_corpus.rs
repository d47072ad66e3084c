//! Runs the scripts of the corpus: cases in which worlds of other libraries failed.

use crate::support::query_support;
use crate::support::world_stage;

use std::collections::BTreeMap;

use impinge::bounding_volume::Aabb;
use impinge::dim2::world as dim2;
use impinge::dim3::world as dim3;
use impinge::math::{Isometry3, Point, Real, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent};
use impinge::query::{ImpactOptions, Ray};
use impinge::shape::{Ball, Capsule, Cuboid, ShapeHandle};
use impinge::world::{
    BroadPhasePairFilter, CollisionGroups, CollisionObject, CollisionWorld, QueryFilter, WorldError,
};
use query_support::random::Random;
use serde_json::Value;
use world_stage::{Stage, ball, contacts, half_space, step, vector};

const CASES: &str = include_str!("../../data/regression_cases.json");

/// Scripts whose steps are described in prose, so they cannot be run; each has its own test below.
const IN_WORDS: [&str; 2] = ["parry-409-remove-to-single-leaf", "melonjs-1580-octree-depth"];

/// Parent of an object, in the one script that filters by it; `None` for an object without a
/// parent.
type Parent = Option<String>;

fn numbers<const D: usize>(value: &Value) -> [f64; D] {
    std::array::from_fn(|axis| value[axis].as_f64().expect("a number"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn shape<N: Real, const D: usize>(value: &Value) -> ShapeHandle<N, D> {
    match value["type"].as_str().expect("a type") {
        "ball" => ball(number(&value["radius"])),
        "cuboid" => ShapeHandle::new(Cuboid::new(vector(numbers::<D>(&value["half_extents"])))),
        "capsule" => {
            let end = |key: &str| Point::from(vector::<N, D>(numbers(&value[key])));
            let radius = N::lit(number(&value["radius"]));
            let capsule = Capsule::try_from_ends(end("a"), end("b"), radius);
            ShapeHandle::new(capsule.expect("a capsule"))
        }
        "halfspace" => {
            let normal = numbers::<D>(&value["normal"]);
            let axis = normal.iter().position(|x| *x != 0.0).expect("a direction");
            half_space(axis, normal[axis])
        }
        other => panic!("no shape {other}"),
    }
}

/// Returns the collision groups that a step of a script describes by bit masks; the mask `filter`
/// becomes the whitelist.
fn groups(step: &Value) -> CollisionGroups {
    let list = |key: &str| {
        let mask = step[key].as_u64()?;
        Some((0..30).filter(|group| mask >> group & 1 == 1).collect::<Vec<usize>>())
    };
    let mut groups = CollisionGroups::new();
    list("membership").into_iter().for_each(|list| groups.set_membership(&list));
    list("filter").into_iter().for_each(|list| groups.set_whitelist(&list));
    groups
}

/// Filter that refuses pairs of objects with a common parent.
struct OfTwoParents;

impl OfTwoParents {
    fn allows(one: &Parent, two: &Parent) -> bool {
        one.is_none() || one != two
    }
}

impl<N: Real> dim2::BroadPhasePairFilter<N, Parent> for OfTwoParents {
    fn is_pair_valid(
        &self,
        one: &dim2::CollisionObject<N, Parent>,
        two: &dim2::CollisionObject<N, Parent>,
    ) -> bool {
        Self::allows(one.data(), two.data())
    }
}

impl<N: Real> dim3::BroadPhasePairFilter<N, Parent> for OfTwoParents {
    fn is_pair_valid(
        &self,
        one: &dim3::CollisionObject<N, Parent>,
        two: &dim3::CollisionObject<N, Parent>,
    ) -> bool {
        Self::allows(one.data(), two.data())
    }
}

struct Script<N: Stage<D>, const D: usize> {
    world: CollisionWorld<N, D, Parent>,
    handles: BTreeMap<String, CollisionObjectHandle>,
    log: Vec<ContactEvent>,
}

impl<N: Stage<D>, const D: usize> Script<N, D>
where
    OfTwoParents: BroadPhasePairFilter<N, D, Parent>,
{
    fn run(case: &Value) {
        let mut world = CollisionWorld::new(N::lit(0.1));
        world.register_broad_phase_pair_filter("parents", OfTwoParents);
        let mut script = Self { world, handles: BTreeMap::new(), log: Vec::new() };
        for step in case["params"]["steps"].as_array().expect("steps") {
            script.step(step);
        }
    }

    fn handle(&self, name: &Value) -> CollisionObjectHandle {
        self.handles[name.as_str().expect("a name")]
    }

    fn add(&mut self, value: &Value, name: String) {
        let position = N::at(numbers(&value["pose"]["t"]));
        let (shape, parent) = (shape(&value["shape"]), value["parent"].as_str().map(str::to_owned));
        let handle = self.world.add(position, shape, groups(value), contacts(0.0), parent);
        self.handles.insert(name, handle);
    }

    fn step(&mut self, value: &Value) {
        match value["op"].as_str().expect("an operation") {
            "add" => self.add(value, value["id"].as_str().expect("a name").to_owned()),
            "add_many" => {
                let count = value["count"].as_u64().expect("a count");
                (0..count).for_each(|k| self.add(value, format!("many {k}")));
            }
            "set_pose" => {
                let position = N::at(numbers(&value["pose"]["t"]));
                self.world.set_position(self.handle(&value["id"]), position);
            }
            "set_shape" => {
                self.world.set_shape(self.handle(&value["id"]), shape(&value["shape"]));
            }
            "set_groups" => {
                self.world.set_collision_groups(self.handle(&value["id"]), groups(value));
            }
            "set_parent" => {
                let handle = self.handle(&value["id"]);
                let object = self.world.collision_object_mut(handle).expect("it is there");
                *object.data_mut() = value["parent"].as_str().map(str::to_owned);
                // Setting the groups makes the world filter the object's pairs again, since the
                // filter depends on the data.
                let groups = *object.collision_groups();
                self.world.set_collision_groups(handle, groups);
            }
            "remove" => self.remove(value),
            "move_slowly" => self.move_slowly(value),
            "update" => self.log = step(&mut self.world),
            // Serialization has its own tests; the rest of the script is valid without it.
            "serialize_roundtrip" | "note" => (),
            _ => self.expect(value),
        }
    }

    fn remove(&mut self, value: &Value) {
        let handle = self.handle(&value["id"]);
        let done = self.world.try_remove(&[handle]);
        let stale = value["expect"].is_string();
        let expected = if stale { Err(WorldError::StaleHandle(handle)) } else { Ok(()) };
        assert_eq!(done, expected, "{value}");
    }

    /// Moves an object in steps with an update after each, and collects all events.
    fn move_slowly(&mut self, value: &Value) {
        let (from, to) = (numbers::<D>(&value["from"]), numbers::<D>(&value["to"]));
        let steps = number(&value["steps"]);
        self.log.clear();
        let mut done = 0.0;
        while done < steps {
            done += 1.0;
            let at = |axis: usize| from[axis] + (to[axis] - from[axis]) * (done / steps);
            let handle = self.handle(&value["id"]);
            self.world.set_position(handle, N::at(std::array::from_fn(at)));
            self.log.extend(step(&mut self.world));
        }
    }

    fn expect(&self, value: &Value) {
        match value["op"].as_str().expect("an operation") {
            "expect_pair" => self.expect_pair(value),
            "expect_pairs_superset" => {
                for pair in value["pairs"].as_array().expect("pairs") {
                    let pair =
                        self.world.contact_pair(self.handle(&pair[0]), self.handle(&pair[1]));
                    assert!(pair.expect("a pair").num_contacts() > 0, "{value}");
                }
            }
            "expect_pair_count" => {
                let count = u64::try_from(self.world.contact_pairs().count()).ok();
                assert_eq!(count, value["count"].as_u64(), "{value}");
            }
            "expect_events" => self.expect_events(value),
            "expect_stale_handle" => {
                assert!(!self.world.contains(self.handle(&value["id"])), "{value}");
            }
            "expect_ray" => self.expect_ray(value),
            other => panic!("no operation {other}"),
        }
    }

    fn expect_pair(&self, value: &Value) {
        let [a, b] = [0, 1].map(|place| self.handle(&value["pair"][place]));
        let mut manifolds = Vec::new();
        let pair = self.world.contact_pair(a, b);
        pair.into_iter().for_each(|pair| pair.contacts(&mut manifolds));
        assert_eq!(Some(!manifolds.is_empty()), value["contact"].as_bool(), "{value}");
        if let Some(expected) = value["signed_distance"].as_f64() {
            let deepest = manifolds[0].deepest_contact().expect("contacts").contact.depth;
            let slack = 64.0 * N::EPSILON.as_f64();
            assert!((deepest.as_f64() + expected).abs() < slack, "{deepest}: {value}");
        }
    }

    fn expect_events(&self, value: &Value) {
        let list = value.get("events").unwrap_or(&value["exactly"]).as_array().expect("events");
        let event = |event: &Value| {
            let (a, b) = (self.handle(&event[1]), self.handle(&event[2]));
            let (first, second) = if a < b { (a, b) } else { (b, a) };
            match event[0].as_str() {
                Some("started") => ContactEvent::Started(first, second),
                _ => ContactEvent::Stopped(first, second),
            }
        };
        assert_eq!(self.log, list.iter().map(event).collect::<Vec<_>>(), "{value}");
    }

    fn expect_ray(&self, value: &Value) {
        let origin = Point::from(vector::<N, D>(numbers(&value["origin"])));
        let ray = Ray::new(origin, vector(numbers(&value["dir"])));
        let hits = self.world.interferences_with_ray(&ray, &CollisionGroups::new());
        let hits: Vec<_> = hits.map(|(object, hit)| (object.handle(), hit.toi.as_f64())).collect();
        let hit = &value["hit"];
        let expected = (!hit.is_null()).then(|| (self.handle(&hit["id"]), number(&hit["t"])));
        assert_eq!(hits, expected.into_iter().collect::<Vec<_>>(), "{value}");
    }
}

fn cases(query: &str) -> Vec<Value> {
    let corpus: Value = serde_json::from_str(CASES).expect("the corpus is JSON");
    let cases = corpus["cases"].as_array().expect("cases").clone();
    cases.into_iter().filter(|case| case["query"] == query).collect()
}

fn run_all<N: Stage<2> + Stage<3>>() -> usize {
    let in_words = |case: &&Value| IN_WORDS.iter().any(|id| case["id"] == *id);
    let cases = cases("world_scenario");
    assert_eq!(cases.iter().filter(in_words).count(), IN_WORDS.len(), "tests of their own");
    let scripts = cases.iter().filter(|case| !in_words(case));
    scripts
        .map(|case| match case["dim"].as_u64() {
            Some(2) => Script::<N, 2>::run(case),
            _ => Script::<N, 3>::run(case),
        })
        .count()
}

#[test]
fn world_scenarios_f32() {
    assert_eq!(run_all::<f32>(), 12, "all scripts in operations");
}

#[test]
fn world_scenarios_f64() {
    assert_eq!(run_all::<f64>(), 12, "all scripts in operations");
}

/// Removes the balls of a world in the order `order`. Asserts after each removal that queries still
/// find the other balls, and finally that a ball can be added again.
fn remove_in_order<N: Stage<3>>(world: &mut CollisionWorld<N, 3, ()>, order: &[u32]) {
    let add = |world: &mut CollisionWorld<N, 3, ()>, place: u32| {
        let position = <N as Stage<3>>::on_x(f64::from(place) * 1.5);
        world.add(position, ball(1.0), CollisionGroups::new(), contacts(0.0), ())
    };
    let mut places: Vec<_> = (0..).take(order.len()).collect();
    let handles: Vec<_> = places.iter().map(|&place| add(world, place)).collect();
    world.update();
    for &place in order {
        world.remove(&[handles[place as usize]]);
        world.validate().expect("the parts of the world agree");
        places.retain(|&other| other != place);
        let far = Aabb::<N, 3>::unbounded();
        let found = world.interferences_with_aabb(&far, &CollisionGroups::new()).count();
        assert_eq!(found, places.len(), "{order:?} from {place}");
    }
    let again = add(world, 0);
    world.update();
    world.validate().expect("the parts of the world agree");
    assert_eq!(world.contact_pairs().count(), 0, "all others are gone");
    world.remove(&[again]);
}

/// Visits all orders of the first `count` elements (Heap's algorithm).
fn each_order(order: &mut Vec<u32>, count: usize, visit: &mut dyn FnMut(&[u32])) {
    if count <= 1 {
        return visit(order);
    }
    for at in 0..count {
        each_order(order, count - 1, visit);
        if at + 1 < count {
            order.swap(if count.is_multiple_of(2) { at } else { 0 }, count - 1);
        }
    }
}

#[test]
fn parry_409_remove_to_single_leaf() {
    let (mut single, mut double) = (CollisionWorld::new(0.02), CollisionWorld::new(0.02));
    let mut orders = 0;
    for count in 1..=7 {
        each_order(&mut (0..).take(count).collect(), count, &mut |order| {
            remove_in_order::<f32>(&mut single, order);
            remove_in_order::<f64>(&mut double, order);
            orders += 1;
        });
    }
    assert_eq!(orders, 1 + 2 + 6 + 24 + 120 + 720 + 5040, "all orders");
    // 500 random orders of the 362880 orders of nine balls.
    let (mut order, random) = ((0..9).collect::<Vec<_>>(), &mut Random(9, false));
    for _ in 0..500 {
        order.sort_by_cached_key(|_| random.bits());
        remove_in_order::<f32>(&mut single, &order);
    }
}

/// Moves random boxes on a grid, so that touching is exact, and compares the pairs with a scan of
/// all pairs.
fn all_pairs<N: Stage<3>>() {
    let random = &mut Random(1580, false);
    let mut quarter = |range: f64| (random.signed() * range * 4.0).round() / 4.0;
    let mut world = CollisionWorld::<N, 3, ()>::new(N::lit(0.05));
    let mut boxes = Vec::new();
    for _ in 0..300 {
        let (at, half) =
            ([(); 3].map(|()| quarter(8.0)), [(); 3].map(|()| 0.25 + quarter(0.75).abs()));
        let shape = ShapeHandle::new(Cuboid::new(vector::<N, 3>(half)));
        let handle = world.add(N::at(at), shape, CollisionGroups::new(), contacts(0.0), ());
        boxes.push((handle, at, half));
    }
    let mut found = 0;
    for _ in 0..12 {
        world.update();
        world.validate().expect("the parts of the world agree");
        for (index, (one, at1, half1)) in boxes.iter().enumerate() {
            for (two, at2, half2) in &boxes[..index] {
                let meets = (0..3).all(|i| (at1[i] - at2[i]).abs() <= half1[i] + half2[i]);
                let pair = world.contact_pair(*one, *two);
                assert_eq!(
                    pair.is_some_and(|pair| pair.num_contacts() > 0),
                    meets,
                    "{one:?} {two:?}"
                );
                found += u32::from(meets);
            }
        }
        for (handle, at, _) in &mut boxes {
            *at = at.map(|x| x + quarter(1.0));
            world.set_position(*handle, N::at(*at));
        }
    }
    assert!(found > 1000, "{found} pairs");
}

#[test]
fn melonjs_1580_octree_depth() {
    all_pairs::<f32>();
    all_pairs::<f64>();
}

/// Returns the number of results of every query of a world with a filter.
fn answers<N: Stage<3, Isometry = Isometry3<N>>>(
    world: &CollisionWorld<N, 3, ()>,
    point: &Point<N, 3>,
    filter: &QueryFilter<'_, N, 3, ()>,
) -> [usize; 13] {
    let (here, solid) = (N::at([0.0; 3]), Ball::new(N::ONE));
    let (ray, far) = (Ray::new(*point, Vector::<N, 3>::x()), N::lit(1e30));
    let (aabb, options) = (Aabb::unbounded(), ImpactOptions::new());
    [
        world.project_point(point, far, true, filter).into_iter().count(),
        world.project_point(point, N::INFINITY, false, filter).into_iter().count(),
        world.nearest_to_point(point, 9, far, filter).len(),
        world.objects_containing(point, filter).count(),
        world.first_ray_hit(&ray, far, true, filter).into_iter().count(),
        world.ray_hits(&ray, far, true, filter).len(),
        world.objects_in_aabb(&aabb, filter).count(),
        world.objects_overlapping(&here, &solid, filter).count(),
        world.closest_object(&here, &solid, far, filter).into_iter().count(),
        world.objects_within(&here, &solid, far, filter).len(),
        world.nearest_objects(&here, &solid, 9, far, filter).len(),
        world.cast_shape(&here, &ray.dir, &solid, &options, filter).into_iter().count(),
        world.cast_shape_all(&here, &ray.dir, &solid, &options, filter).len(),
    ]
}

/// Returns the number of results of the queries that take groups.
fn answers_to_groups<N: Stage<3>>(
    world: &CollisionWorld<N, 3, ()>,
    point: &Point<N, 3>,
    groups: &CollisionGroups,
) -> [usize; 4] {
    let ray = Ray::new(*point, Vector::<N, 3>::x());
    [
        world.interferences_with_point(point, groups).count(),
        world.interferences_with_ray(&ray, groups).count(),
        world.first_interference_with_ray(&ray, groups).into_iter().count(),
        world.interferences_with_aabb(&Aabb::unbounded(), groups).count(),
    ]
}

fn empty_worlds<N: Stage<3, Isometry = Isometry3<N>>>() {
    let cases = cases("world_point_projection");
    assert_eq!(cases.len(), 1, "rapier-923-empty-world");
    let point = Point::from(vector::<N, 3>(numbers(&cases[0]["params"]["point"])));
    let mut world = CollisionWorld::<N, 3, ()>::new(N::lit(0.02));
    let (all, mut nobody) = (CollisionGroups::new(), CollisionGroups::new());
    nobody.set_blacklist(&(0..30).collect::<Vec<_>>());
    let none = |_: &CollisionObject<N, 3, ()>| false;
    for _ in 0..2 {
        assert_eq!(answers(&world, &point, &QueryFilter::new()), [0; 13], "empty");
        assert_eq!(answers_to_groups(&world, &point, &all), [0; 4], "empty");
        world.update();
    }
    world.add(N::at([0.0; 3]), ball(1.0), CollisionGroups::new(), contacts(0.0), ());
    for _ in 0..2 {
        let filters = [QueryFilter::new().groups(nobody), QueryFilter::new().predicate(&none)];
        for filter in &filters {
            assert_eq!(answers(&world, &point, filter), [0; 13], "filtered out");
        }
        assert_eq!(answers_to_groups(&world, &point, &nobody), [0; 4], "filtered out");
        // The last two are casts of shapes that overlap at the start and part, so they hit nothing.
        let seen = answers(&world, &point, &QueryFilter::new());
        assert_eq!(seen[..11], [1; 11], "the ball is there");
        assert_eq!(answers_to_groups(&world, &point, &all), [1; 4], "the ball is there");
        world.update();
    }
}

/// Runs the one case that queries a world with a point: in an empty world, and in a world whose
/// objects are all filtered out.
#[test]
fn world_point_projection() {
    empty_worlds::<f32>();
    empty_worlds::<f64>();
}
