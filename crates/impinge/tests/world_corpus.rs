//! The scripts of the corpus: what went wrong in the worlds of others.

mod world_stage;

use std::collections::BTreeMap;

use impinge::math::{Point, Real};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent};
use impinge::query::Ray;
use impinge::shape::{Capsule, Cuboid, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld, WorldError};
use serde_json::Value;
use world_stage::{Stage, ball, contacts, half_space, step, vector};

const CASES: &str = include_str!("data/regression_cases.json");

/// Why a case is not run as it stands.
const EXEMPT: [(&str, &str); 3] = [
    ("rapier-734-reparent", "objects have no parents; filters by data are tested elsewhere"),
    ("parry-409-remove-to-single-leaf", "about a tree alone: the tests of the broad phase do it"),
    ("melonjs-1580-octree-depth", "about a tree alone: the tests of the broad phase do it"),
];

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

/// The filter of the corpus is a whitelist.
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

struct Script<N: Stage<D>, const D: usize> {
    world: CollisionWorld<N, D, ()>,
    handles: BTreeMap<String, CollisionObjectHandle>,
    log: Vec<ContactEvent>,
}

impl<N: Stage<D>, const D: usize> Script<N, D> {
    fn run(case: &Value) {
        let world = CollisionWorld::new(N::lit(0.1));
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
        let handle =
            self.world.add(position, shape(&value["shape"]), groups(value), contacts(0.0), ());
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
            "remove" => self.remove(value),
            "move_slowly" => self.move_slowly(value),
            "update" => self.log = step(&mut self.world),
            // There are no snapshots of worlds; the rest of the script holds without.
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

    /// Moves in steps, with an update after each; collects the events of all.
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
    let exempt = |case: &&Value| EXEMPT.iter().any(|(id, _)| case["id"] == *id);
    let cases = cases("world_scenario");
    assert_eq!(cases.iter().filter(exempt).count(), EXEMPT.len(), "exempted cases exist");
    let scripts = cases.iter().filter(|case| !exempt(case));
    scripts
        .map(|case| match case["dim"].as_u64() {
            Some(2) => Script::<N, 2>::run(case),
            _ => Script::<N, 3>::run(case),
        })
        .count()
}

#[test]
fn world_scenarios_f32() {
    assert_eq!(run_all::<f32>(), 11, "all but the exempted");
}

#[test]
fn world_scenarios_f64() {
    assert_eq!(run_all::<f64>(), 11, "all but the exempted");
}

/// The one case that asks a world about a point, in an empty world and in one that is filtered out.
#[test]
fn world_point_projection() {
    let cases = cases("world_point_projection");
    assert_eq!(cases.len(), 1, "rapier-923-empty-world");
    let point = Point::from(vector::<f64, 3>(numbers(&cases[0]["params"]["point"])));
    let mut world = CollisionWorld::<f64, 3, ()>::new(0.02);
    let mut nobody = CollisionGroups::new();
    nobody.set_blacklist(&(0..30).collect::<Vec<_>>());
    for _ in 0..2 {
        assert_eq!(world.interferences_with_point(&point, &nobody).count(), 0, "nothing");
        world.update();
        let position = <f64 as Stage<3>>::on_x(0.0);
        world.add(position, ball(1.0), CollisionGroups::new(), contacts(0.0), ());
    }
    let found = world.interferences_with_point(&point, &CollisionGroups::new()).count();
    assert_eq!(found, 2, "they are there");
}
