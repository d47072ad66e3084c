//! Tests each of the four conditions for two objects to touch, and the notes about stand-ins.

use impinge::bounding_volume::Aabb;
use impinge::dim2;
use impinge::dim3;
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Ball, Cuboid, Shape, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_page::{Engine, Recorded, Shown, Viewed};
use impinge_record::{Recordable, Registry};
use serde_json::{Value, json};

use crate::support::{Asker, Scene, all, place};

/// The explanation of a pair: the conditions, whether they are satisfied, and their texts.
struct Reasons(Value);

impl Reasons {
    fn of(asker: &mut Asker, a: u32, b: u32) -> Self {
        let pair = asker.ask(&format!(r#"{{"do": "pair", "a": {a}, "b": {b}}}"#));
        let why = pair["why"].clone();
        let names: Vec<_> =
            why["tests"].as_array().expect("a list").iter().map(|test| &test["name"]).collect();
        assert_eq!(names, ["groups", "filter", "boxes", "distance"], "all are asked");
        Self(why)
    }

    /// Asserts that exactly one condition is not satisfied, and that its text is the reason of the
    /// result.
    fn assert_only(&self, name: &str, text: &str) {
        let tests = self.0["tests"].as_array().expect("a list");
        let failing: Vec<_> = tests.iter().filter(|test| test["passes"] == false).collect();
        assert_eq!(failing.len(), 1, "{name}: {}", self.0);
        assert_eq!(
            (&failing[0]["name"], &failing[0]["text"]),
            (&name.into(), &text.into()),
            "{tests:?}"
        );
        assert_eq!(self.0["touch"], false, "{name}");
        assert_eq!(self.0["text"], format!("They do not touch: {text}."), "{name}");
    }
}

/// Records six objects, of which the first three are at the origin. The filter `teams` of the
/// registry rejects pairs of objects with equal data.
fn scene<N: Recordable<D>, const D: usize>(registry: Registry<N, D, Vec<u8>>) -> Vec<u8> {
    let [mut shy, mut other] = [CollisionGroups::new(); 2];
    shy.set_membership(&[2]);
    other.set_membership(&[0]);
    other.set_whitelist(&[0, 1]);
    let mut scene = Scene::<N, D>::new(registry);
    scene.0.register_broad_phase_pair_filter("teams").expect("the registry has it");
    let origin = [0.0; 3];
    let ball = || Ball::new(N::ONE);
    let objects = [
        scene.add_in(shy, origin, ball()),
        scene.add_in(other, origin, ball()),
        scene.add(origin, ball()),
        scene.add([1.5, 1.5, 0.0], ball()),
        scene.add([6.0, 0.0, 0.0], Cuboid::new(all::<N, D>(1.0))),
    ];
    let teams: [&[u8]; 5] = [b"a", b"b", b"c", b"d", b"e"];
    for (object, team) in objects.into_iter().zip(teams) {
        scene.0.set_data(object, team.to_vec()).expect("it is there");
    }
    let twin = scene.add([-1.0, 0.0, 0.0], ball());
    scene.0.set_data(twin, b"c".to_vec()).expect("it is there");
    scene.finish()
}

fn reasons<N: Viewed<D>, const D: usize>(registry: Registry<N, D, Vec<u8>>) {
    let bytes = scene(registry.clone());
    let recorded = Recorded::open(&bytes, registry).expect("it was just written");
    let mut asker = Asker(Engine::new());
    asker.0.show(Box::new(Shown::new(recorded)));

    let text = "membership 2 of 0 is not in the whitelist 0, 1 of 1";
    Reasons::of(&mut asker, 0, 1).assert_only("groups", text);
    Reasons::of(&mut asker, 5, 2).assert_only("filter", "the filter teams refuses the pair");
    let text = "0.1213 apart; contacts are kept up to 0";
    Reasons::of(&mut asker, 2, 3).assert_only("distance", text);

    // If the boxes do not overlap, the shapes are apart too, so two conditions fail.
    let far = Reasons::of(&mut asker, 2, 4).0;
    let [boxes, distance] = [2, 3].map(|test| &far["tests"][test]);
    assert_eq!((&boxes["passes"], &distance["passes"]), (&false.into(), &false.into()), "{far}");
    let text = boxes["text"].as_str().expect("a text");
    let apart =
        text.strip_prefix("the loosened boxes are ").and_then(|rest| rest.strip_suffix(" apart"));
    let apart: f64 = apart.and_then(|number| number.parse().ok()).expect(text);
    assert!((3.75..4.0).contains(&apart), "4 less both margins: {text}");
    assert_eq!(far["text"], format!("They do not touch: {text}."), "the first reason");
    assert_eq!(distance["text"], "4 apart; contacts are kept up to 0", "from 1 to 5");

    let touching = Reasons::of(&mut asker, 1, 5).0;
    assert_eq!(touching["touch"], true, "{touching}");
    assert_eq!(
        touching["text"], "They touch: 1 contact point, the deepest of depth 1.",
        "{touching}"
    );
    let passing =
        touching["tests"].as_array().expect("a list").iter().all(|test| test["passes"] == true);
    assert!(passing, "{touching}");
}

fn registry2<N: Viewed<2>>() -> Registry<N, 2, Vec<u8>> {
    type Object<N> = dim2::world::CollisionObject<N, Vec<u8>>;
    Registry::new().with_filter("teams", |a: &Object<N>, b: &Object<N>| a.data() != b.data())
}

fn registry3<N: Viewed<3>>() -> Registry<N, 3, Vec<u8>> {
    type Object<N> = dim3::world::CollisionObject<N, Vec<u8>>;
    Registry::new().with_filter("teams", |a: &Object<N>, b: &Object<N>| a.data() != b.data())
}

#[test]
fn each_reason_is_named() {
    reasons::<f32, 2>(registry2());
    reasons::<f64, 2>(registry2());
    reasons::<f32, 3>(registry3());
    reasons::<f64, 3>(registry3());
}

#[test]
fn what_lacks_in_a_page_is_stood_in_for() {
    let mut asker = Asker::of(&scene::<f64, 2>(registry2()));
    let reasons = Reasons::of(&mut asker, 5, 2).0;
    assert_eq!(reasons["touch"], true, "the filter is code that the page does not have");
    let text = reasons["tests"][1]["text"].as_str().expect("a text");
    assert!(text.contains("lets all pairs through here"), "{text}");
    let status = asker.ask(r#"{"do": "seek", "step": 1}"#);
    assert!(
        status["diverged"].as_str().is_some_and(|text| text.starts_with("step 1: ")),
        "{status}"
    );
    // The note about a lost part remains when the recording is read again for a stand-in.
    let bytes = scene::<f64, 2>(registry2());
    for (length, notes) in [(bytes.len(), 1), (bytes.len() - 1, 2)] {
        let open = r#"{"do": "open", "kind": "recording"}"#;
        let (info, _) = asker.ask_with(open, &bytes[..length]);
        assert_eq!(info["notes"].as_array().map(Vec::len), Some(notes), "{info}");
    }
}

/// Records five updates, registers the filter `teams`, and records two more updates.
fn late_filter() -> Vec<u8> {
    let mut scene = Scene::<f64, 2>::new(registry2());
    scene.add([0.0; 3], Ball::new(1.0));
    (0..5).for_each(|_| scene.0.update());
    scene.0.register_broad_phase_pair_filter("teams").expect("the registry has it");
    scene.0.update();
    scene.finish()
}

#[test]
fn a_stand_in_that_is_needed_after_the_opening_is_told_once() {
    let note = json!([
        "The pair filter teams is code of the program that was recorded; here it lets all pairs through."
    ]);
    let none = json!([]);
    let bytes = late_filter();
    let open = |kind: &str| format!(r#"{{"do": "open", "kind": "{kind}"}}"#);
    let mut recording = Asker::default();
    let (info, _) = recording.ask_with(&open("recording"), &bytes);
    assert_eq!(info["notes"], none, "step 1 needs no filter");
    let mut stream = Asker::default();
    stream.ask(&open("stream"));
    let (info, _) = stream.ask_with(r#"{"do": "push"}"#, &bytes);
    assert_eq!(info["notes"], none, "a stream stops at step 1, too");
    for mut asker in [recording, stream] {
        let mut go = |step: u32| asker.ask(&format!(r#"{{"do": "seek", "step": {step}}}"#));
        let found = [5, 6, 7, 1].map(|step| go(step)["notes"].clone());
        assert_eq!(found, [none.clone(), note.clone(), none.clone(), none.clone()]);
    }
}

/// A shape of a user-defined type.
#[derive(Debug)]
struct Coin(Ball<f64>);

impl Shape<f64, 2> for Coin {
    fn geometry(&self) -> dim2::shape::Geometry<'_, f64> {
        Shape::<f64, 2>::geometry(&self.0)
    }

    fn local_aabb(&self) -> Aabb<f64, 2> {
        self.0.local_aabb()
    }
}

#[test]
fn a_note_that_came_with_a_push_is_not_told_again() {
    let coin = ShapeHandle::new(Coin(Ball::new(1.0)));
    let registry = Registry::new().with_shape("coin", coin.clone());
    let mut scene = Scene::<f64, 2>::new(registry);
    scene.add([0.0; 3], Ball::new(1.0));
    scene.0.update();
    let start = scene.0.take_bytes();
    let (groups, query) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
    let at = place::<f64, 2>([5.0, 0.0, 0.0]);
    scene.0.add(at, coin, groups, query, Vec::new()).expect("it has a name");
    let rest = scene.finish();

    let note =
        "The shape coin is code of the program that was recorded; here it is a ball of radius 0.5.";
    let mut stream = Asker::default();
    stream.ask(r#"{"do": "open", "kind": "stream"}"#);
    for (bytes, notes) in [(start, json!([])), (rest, json!([note]))] {
        let (info, _) = stream.ask_with(r#"{"do": "push"}"#, &bytes);
        assert_eq!(info["notes"], notes);
        let status = stream.ask(r#"{"do": "seek", "step": 2}"#);
        assert_eq!(status["notes"], json!([]), "the page has {notes}");
    }
}
