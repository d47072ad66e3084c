//! Tests worlds that are saved and restored: scenes that continue, refused input, and filters
//! without a name in the registry.

use std::hash::Hasher;

use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::Space;
use impinge::narrow_phase::DefaultNarrowPhase;
use impinge::shape::{Compound, ShapeHandle};
use impinge::world::{
    BroadPhasePairFilter, CollisionGroups, CollisionObject, CollisionWorld, Registry, RestoreError,
    SaveError, SavedWorld,
};
use impinge_scenes::Scene;

use crate::support::scene_stage::{Digest, Play, Player, digest_state};
use crate::support::world_stage::{Stage, ball, contacts};

/// Runs `steps` steps; returns the digest of their results, and the number of manifolds.
fn play<N: Play<D>, const D: usize>(player: &mut Player<N, D>, steps: u32) -> (u64, usize) {
    let (mut digest, mut found) = (Digest::new(), 0);
    for _ in 0..steps {
        player.step();
        digest_state(&player.world, &mut digest);
        found += player.world.contact_manifolds().count();
    }
    (digest.finish(), found)
}

/// Saves a scene in its 21st step, before the update, and restores it, both as text and as bytes.
/// Asserts that the next 200 steps have the results of an unsaved scene.
fn goes_on<N: Play<D>, const D: usize>(scene: &Scene<D>, is_reusing: bool) {
    let after = |steps, save: Option<bool>| {
        let mut player = Player::<N, D>::new(scene.clone(), 1.0);
        if is_reusing {
            let phase = DefaultNarrowPhase::new().reusing(N::lit(0.01));
            player.world.set_narrow_phase(Box::new(phase));
        }
        play(&mut player, steps);
        // The world is saved in the middle of a step, before its update.
        player.apply();
        if let Some(as_text) = save {
            let world = if as_text {
                let text = serde_json::to_string(&player.world).expect("it can be saved");
                serde_json::from_str(&text).expect("saved just now")
            } else {
                let bytes = postcard::to_allocvec(&player.world).expect("it can be saved");
                postcard::from_bytes(&bytes).expect("saved just now")
            };
            player.go_on_with(world);
        }
        player.update();
        play(&mut player, 200)
    };
    let (digest, found) = after(20, None);
    assert!(found > 1000, "{}: {found} manifolds", scene.name);
    for as_text in [true, false] {
        assert_eq!(after(20, Some(as_text)).0, digest, "{}, as text {as_text}", scene.name);
    }
}

#[test]
fn saved_scenes_go_on_in_plane() {
    goes_on::<f32, 2>(&impinge_scenes::mixed_shapes::<2>(120), false);
    goes_on::<f64, 2>(&impinge_scenes::pile::<2>(100), true);
    goes_on::<f32, 2>(&impinge_scenes::spawn_and_despawn::<2>(150), false);
}

#[test]
fn saved_scenes_go_on_in_space() {
    goes_on::<f64, 3>(&impinge_scenes::mixed_shapes::<3>(120), false);
    goes_on::<f32, 3>(&impinge_scenes::mixed_shapes::<3>(120), true);
    goes_on::<f32, 3>(&impinge_scenes::tower::<3>(100), false);
    goes_on::<f32, 3>(&impinge_scenes::spawn_and_despawn::<3>(150), false);
}

/// Returns a world of two touching balls, from which a third ball was removed after the update.
fn three_balls<N: Stage<D>, const D: usize>() -> CollisionWorld<N, D, u32> {
    let mut world = CollisionWorld::new(N::lit(0.02));
    let (ball, groups) = (ball::<N, D>(1.0), CollisionGroups::new());
    let handles =
        [0.0, 1.5, 3.0].map(|x| world.add(N::on_x(x), ball.clone(), groups, contacts(0.0), 7));
    world.update();
    world.remove(&handles[2..]);
    world
}

fn read<N: Space<D>, const D: usize>(
    text: &str,
) -> Result<CollisionWorld<N, D, u32>, RestoreError> {
    let saved: SavedWorld<N, D, u32> = serde_json::from_str(text).expect("the form is right");
    saved.restore(&Registry::new())
}

#[test]
fn worlds_of_another_kind_are_refused() {
    let text = serde_json::to_string(&three_balls::<f32, 2>()).expect("it can be saved");
    assert!(read::<f32, 2>(&text).is_ok(), "{text}");
    let refused = [
        (read::<f64, 2>(&text).err(), RestoreError::Scalar { found: 32 }),
        (read::<f32, 3>(&text).err(), RestoreError::Dimension { found: 2 }),
        (
            read::<f32, 2>(&text.replacen("\"version\":1", "\"version\":9", 1)).err(),
            RestoreError::Version { found: 9 },
        ),
    ];
    for (error, expected) in refused {
        assert_eq!(error, Some(expected));
    }
    let bytes = postcard::to_allocvec(&three_balls::<f64, 3>()).expect("it can be saved");
    let saved: SavedWorld<f32, 3, u32> = postcard::from_bytes(&bytes).expect("the kind is read");
    let error = saved.restore(&Registry::new()).err();
    assert_eq!(error, Some(RestoreError::Scalar { found: 64 }), "of bytes, too");
    let error = postcard::from_bytes::<CollisionWorld<f32, 3, u32>>(&bytes).err();
    assert!(error.is_some(), "without a type");
}

/// Tests that data that contradict themselves are refused as damaged.
#[test]
fn contradictions_are_refused() {
    let text = serde_json::to_string(&three_balls::<f32, 2>()).expect("it can be saved");
    let damages = [
        ("[{\"Ball\":\"1.0\"}]", "[{\"Ball\":\"-1.0\"}]"),
        ("[{\"Ball\":\"1.0\"}]", "[{\"Ball\":\"1.0 1.0\"}]"),
        ("[{\"Ball\":\"1.0\"}]", "[]"),
        ("[{\"Ball\":\"1.0\"}]", "[{\"Cone\":\"1.0 1.0\"}]"),
        ("[{\"Ball\":\"1.0\"}]", "[{\"Rounded\":[0,\"1.0\"]}]"),
        ("\"1.5 0.0 1.0 0.0\"", "\"1.5 0.0 2.0 0.0\""),
        ("\"1.5 0.0 1.0 0.0\"", "\"NaN:7fc00000 0.0 1.0 0.0\""),
        ("\"1.5 0.0 1.0 0.0\"", "\"2.5 0.0 1.0 0.0\""),
        ("\"vacant\":[2]", "\"vacant\":[1]"),
        ("\"vacant\":[2]", "\"vacant\":[2,2]"),
        ("\"vacant\":[2]", "\"vacant\":[4000000000]"),
        ("\"objects\":[0,1]", "\"objects\":[0,2]"),
        ("\"objects\":[0,1]", "\"objects\":[1,0]"),
        ("\"objects\":[0,1]", "\"objects\":[0,4000000000]"),
        ("\"home\":\"Moving\"", "\"home\":\"Nowhere\""),
        ("\"margin\":\"0.02\"", "\"margin\":\"-0.02\""),
    ];
    for (old, new) in damages {
        let damaged = text.replacen(old, new, 1);
        assert_ne!(damaged, text, "{old} is there");
        let error = read::<f32, 2>(&damaged).err();
        assert!(matches!(error, Some(RestoreError::Damaged { .. })), "{new}: {error:?}");
    }
}

#[test]
fn handles_and_events_of_restored_worlds() {
    let world = three_balls::<f64, 3>();
    let text = serde_json::to_string(&world).expect("it can be saved");
    let mut restored = read::<f64, 3>(&text).expect("saved just now");
    let handles = |world: &CollisionWorld<f64, 3, u32>| -> Vec<_> {
        world.collision_objects().map(CollisionObject::handle).collect()
    };
    for handle in handles(&world) {
        let own = restored.counterpart(handle).expect("it is there");
        assert!(!restored.contains(handle) && restored.contains(own), "each has its own");
    }
    let gone = world.contact_events()[1].handles().1;
    assert_eq!(restored.counterpart(gone), None, "stale ones stay stale");
    let gone = restored.contact_events()[1].handles().1;
    assert_eq!(restored.removed_object(gone).map(|object| *object.data()), Some(7), "named");
    restored.update();
    assert_eq!(restored.contact_events().len(), 1, "the removal ended a contact");
    let at = <f64 as Stage<3>>::on_x(9.0);
    let new = restored.add(at, ball(1.0), CollisionGroups::new(), contacts(0.0), 8);
    assert_eq!((new.uid(), restored.contains(gone)), (2, false), "the index is used again");
}

/// A filter that accepts all pairs. It can be restored only if the registry has its name.
struct All;

impl impinge::dim2::world::BroadPhasePairFilter<f32, u32> for All {
    fn is_pair_valid(
        &self,
        _: &impinge::dim2::world::CollisionObject<f32, u32>,
        _: &impinge::dim2::world::CollisionObject<f32, u32>,
    ) -> bool {
        true
    }
}

#[test]
fn what_has_no_name_cannot_be_restored() {
    fn is_filter<F: BroadPhasePairFilter<f32, 2, u32>>(filter: F) -> F {
        filter
    }
    let mut world = three_balls::<f32, 2>();
    world.register_broad_phase_pair_filter("all", is_filter(All));
    let text = serde_json::to_string(&world).expect("it can be saved");
    let error = read::<f32, 2>(&text).err();
    assert_eq!(error, Some(RestoreError::UnknownFilter("all".to_owned())));
    let registry = Registry::new().with_filter("all", All);
    let restored = registry.restore(&mut serde_json::Deserializer::from_str(&text));
    let names = restored.expect("it has a name").broad_phase_pair_filter_names().count();
    assert_eq!(names, 1);
}

/// Asserts that a world can be restored if an object was removed after its pair was computed between
/// two updates.
#[test]
fn removed_objects_of_computed_pairs_are_not_saved() {
    let mut world = three_balls::<f64, 3>();
    let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
    assert!(world.update_pair(handles[0], handles[1]), "they are a pair");
    world.remove(&handles[1..]);
    let text = serde_json::to_string(&world).expect("it can be saved");
    let restored = read::<f64, 3>(&text).expect("saved just now");
    assert_eq!(restored.len(), 1, "one ball is left");
}

#[test]
fn phases_that_are_to_take_over_are_saved() {
    let mut world = three_balls::<f32, 2>();
    world.set_broad_phase(Box::new(DBVTBroadPhase::new(0.5)));
    world.set_narrow_phase(Box::new(DefaultNarrowPhase::new().reusing(0.01)));
    let text = serde_json::to_string(&world).expect("it can be saved");
    let mut restored = read::<f32, 2>(&text).expect("saved just now");
    assert_eq!(format!("{world:?}"), format!("{restored:?}"), "they are to take over");
    world.update();
    restored.update();
    let both = [&world, &restored].map(|world| serde_json::to_string(world).expect("saved"));
    assert_eq!(both[0], both[1], "in both worlds");
}

/// Tests that compounds nested 30 deep, with two equal children each, are refused: they have 2³⁰
/// parts.
#[test]
fn compounds_that_multiply_are_refused() {
    let mut shape: ShapeHandle<f32, 2> = ball(1.0);
    for _ in 0..30 {
        let at = [0.0, 0.5].map(|x| (<f32 as Stage<2>>::on_x(x), shape.clone()));
        shape = ShapeHandle::new(Compound::new(at.to_vec()));
    }
    let mut world = CollisionWorld::<f32, 2, ()>::new(0.02);
    let at = <f32 as Stage<2>>::on_x(0.0);
    world.add(at, shape, CollisionGroups::new(), contacts(0.0), ());
    assert_eq!(world.saved().err(), Some(SaveError::TooManyParts));
}
