//! Runs the scripts of world operations in the corpus.

use crate::read::{ReadPose, cases, number, numbers, read, solid};
use impinge_reference::geometry::{Pose, Solid};
use impinge_reference::world::{ContactEvent, Groups, Handle, NaiveWorld, QueryType};
use serde_json::Value;
use std::collections::BTreeMap;

/// A naive world, and the handle of each name in the script.
struct Stage<const D: usize> {
    world: NaiveWorld<D>,
    handles: BTreeMap<String, Handle>,
    /// The contact events of the last step that updated the world.
    log: Vec<ContactEvent>,
}

impl<const D: usize> Stage<D>
where
    Pose<D>: ReadPose,
{
    fn new() -> Self {
        Self { world: NaiveWorld::new(), handles: BTreeMap::new(), log: Vec::new() }
    }

    /// Runs one step; returns `false` if the naive world does not support it.
    fn step(&mut self, step: &Value) -> bool {
        match step["op"].as_str().expect("an operation") {
            "add" if step["parent"].is_string() || step["margin"].is_number() => return false,
            "add" => self.add(step, step["id"].as_str().expect("a name")),
            "add_many" => (0..step["count"].as_u64().expect("a count"))
                .for_each(|k| self.add(step, &format!("many {k}"))),
            "set_pose" => {
                let pose = Pose::read(&step["pose"]);
                self.world.set_position(self.handle(&step["id"]), pose).expect("alive");
            }
            "set_shape" => {
                let handle = self.handle(&step["id"]);
                self.world.set_shape(handle, shape(step)).expect("alive");
            }
            "set_groups" => {
                let handle = self.handle(&step["id"]);
                self.world.set_groups(handle, groups(step)).expect("alive");
            }
            "remove" => {
                let done = self.world.remove(&[self.handle(&step["id"])]);
                assert_eq!(done.is_err(), step["expect"].is_string(), "{step}");
            }
            "update" => self.log = self.world.update().contacts,
            "note" => (),
            _ => return self.expect(step),
        }
        true
    }

    fn expect(&self, step: &Value) -> bool {
        let touching = self.world.touching_pairs();
        match step["op"].as_str().expect("an operation") {
            "expect_pair" => {
                let pair = self.pair(&step["pair"][0], &step["pair"][1]);
                assert_eq!(Some(touching.contains(&pair)), step["contact"].as_bool(), "{step}");
                if let Some(expected) = step["signed_distance"].as_f64() {
                    let [one, two] = [pair.0, pair.1].map(|h| self.world.object(h).expect("alive"));
                    let distance = self.world.signed_distance(one, two);
                    assert!((distance - expected).abs() < 1e-12, "{distance}: {step}");
                }
            }
            "expect_pairs_superset" => {
                for names in step["pairs"].as_array().expect("pairs") {
                    assert!(touching.contains(&self.pair(&names[0], &names[1])), "{step}");
                }
            }
            "expect_pair_count" => {
                assert_eq!(u64::try_from(touching.len()).ok(), step["count"].as_u64(), "{step}");
            }
            "expect_events" => self.expect_events(step),
            "expect_stale_handle" => {
                assert!(self.world.object(self.handle(&step["id"])).is_none(), "{step}");
            }
            "expect_ray" => self.expect_ray(step),
            _ => return false,
        }
        true
    }

    fn expect_events(&self, step: &Value) {
        let list = step.get("events").unwrap_or(&step["exactly"]).as_array().expect("events");
        let expected: Vec<ContactEvent> = list
            .iter()
            .map(|event| {
                let (handle1, handle2) = self.pair(&event[1], &event[2]);
                match event[0].as_str() {
                    Some("started") => ContactEvent::Started(handle1, handle2),
                    _ => ContactEvent::Stopped(handle1, handle2),
                }
            })
            .collect();
        assert_eq!(self.log, expected, "{step}");
    }

    fn expect_ray(&self, step: &Value) {
        let (origin, direction) = (numbers(&step["origin"]), numbers(&step["dir"]));
        let hits = self.world.interferences_with_ray(&origin, &direction, Groups::new());
        let hit = &step["hit"];
        assert_eq!(hits.is_empty(), hit.is_null(), "{step}");
        for (handle, t) in hits {
            assert_eq!(handle, self.handle(&hit["id"]), "{step}");
            assert!((t - number(&hit["t"])).abs() < 1e-10, "{t}: {step}");
        }
    }

    fn add(&mut self, step: &Value, name: &str) {
        let pose = Pose::read(&step["pose"]);
        let handle = self.world.add(pose, shape(step), groups(step), QueryType::Contacts(0.0));
        self.handles.insert(name.to_owned(), handle);
    }

    fn handle(&self, name: &Value) -> Handle {
        self.handles[name.as_str().expect("a name")]
    }

    fn pair(&self, name1: &Value, name2: &Value) -> (Handle, Handle) {
        let (handle1, handle2) = (self.handle(name1), self.handle(name2));
        (handle1.min(handle2), handle1.max(handle2))
    }
}

fn shape<const D: usize>(step: &Value) -> Solid<D> {
    solid(&step["shape"]).expect("a known shape").0
}

/// Reads the collision groups of a step: the mask `filter` becomes the whitelist. A missing mask
/// keeps its default.
fn groups(step: &Value) -> Groups {
    let mask = |key: &str| step[key].as_u64().map(|mask| u32::try_from(mask).expect("a mask"));
    let all = Groups::new();
    Groups {
        membership: mask("membership").unwrap_or(all.membership),
        whitelist: mask("filter").unwrap_or(all.whitelist),
        ..all
    }
}

/// Runs a script up to its first unsupported step; returns whether it ran to the end.
fn run<const D: usize>(case: &Value) -> bool
where
    Pose<D>: ReadPose,
{
    let mut stage = Stage::<D>::new();
    case["params"]["steps"].as_array().expect("steps").iter().all(|step| stage.step(step))
}

#[test]
fn world_scenarios() {
    let corpus = read("regression_cases.json");
    let mut left_out = Vec::new();
    let mut done = 0;
    for case in cases(&corpus).iter().filter(|case| case["query"] == "world_scenario") {
        let whole = if case["dim"] == 2 { run::<2>(case) } else { run::<3>(case) };
        if whole {
            done += 1;
        } else {
            left_out.push(case["id"].as_str().expect("an id"));
        }
    }
    // Scripts with parents, snapshots, margins of single objects, or access to trees are not
    // supported.
    let expected = [
        "rapier-734-reparent",
        "rapier.js-52-query-before-step",
        "avian-952-fat-aabb",
        "parry-409-remove-to-single-leaf",
        "melonjs-1580-octree-depth",
    ];
    assert_eq!(left_out, expected);
    assert_eq!(done, 9);
}
