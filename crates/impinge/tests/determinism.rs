//! The same scene gives the same bits: run by run, with every instruction set of the machine, with
//! any number of threads, in every build and on every platform.
//!
//! After each step everything that the world says goes into one number: manifolds (points, normals,
//! depths, features, names), proximities and events. `golden/state_hashes.txt` holds that number for
//! each scene, dimension and scalar. It is the same on every platform and in every build, because
//! the pipeline only adds, multiplies, divides, takes roots, compares and rounds, in a fixed order,
//! and takes sines from a software library. The file changes only together with a deliberate change
//! of answers; then run `IMPINGE_BLESS=1 cargo test -p impinge --test determinism` and commit it.

mod scene_stage;

use std::collections::BTreeMap;
use std::fs;
use std::hash::Hasher;
use std::path::PathBuf;
use std::sync::Mutex;

use impinge::broad_phase::DBVTBroadPhase;
use impinge::bvh::Lanes;
use impinge_scenes::{
    Scene, few_moving, mixed_shapes, mixed_sizes, pile, sparse_drift, spawn_and_despawn, tower,
};
use scene_stage::{Digest, Play, Player, digest_state};

/// What the number of a run stands for, and how much of it there was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Outcome {
    hash: u64,
    contacts: usize,
    events: usize,
}

/// A scene and how long it is played.
#[derive(Clone)]
struct Run<const D: usize> {
    scene: Scene<D>,
    steps: u32,
}

impl<const D: usize> Run<D> {
    /// Plays the scene in a world whose broad phase uses the given vectors.
    fn play<N: Play<D>>(&self, lanes: Option<Lanes>) -> Outcome {
        let mut player = Player::<N, D>::new(self.scene.clone(), 1.0);
        if let Some(lanes) = lanes {
            let margin = N::lit(self.scene.margin);
            let broad_phase = DBVTBroadPhase::with_lanes(margin, lanes).expect("a margin");
            player.world.set_broad_phase(Box::new(broad_phase));
        }
        let (mut digest, mut outcome) = (Digest::new(), Outcome::default());
        for _ in 0..self.steps {
            player.step();
            let world = &player.world;
            digest_state(world, &mut digest);
            outcome.contacts += world.contact_manifolds().map(|(_, _, m)| m.len()).sum::<usize>();
            outcome.events += world.contact_events().len() + world.proximity_events().len();
        }
        outcome.hash = digest.finish();
        outcome
    }

    /// Plays the scene in every way there is and answers what it always came to.
    fn in_every_way<N: Play<D>>(&self) -> Outcome {
        let outcome = self.play::<N>(None);
        assert_eq!(self.play::<N>(None), outcome, "a second run");
        for lanes in Lanes::available() {
            assert_eq!(self.play::<N>(Some(lanes)), outcome, "with {lanes:?}");
        }
        #[cfg(feature = "parallel")]
        for threads in [1, 2, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let here = pool.expect("a pool").install(|| self.play::<N>(None));
            assert_eq!(here, outcome, "on {threads} threads");
        }
        outcome
    }

    /// Plays the scene with both scalars and compares with the golden file.
    fn check(&self)
    where
        f32: Play<D>,
        f64: Play<D>,
    {
        let name = self.scene.name.replace(' ', "-").replace('%', "percent");
        for (scalar, outcome) in
            [("f32", self.in_every_way::<f32>()), ("f64", self.in_every_way::<f64>())]
        {
            assert!(outcome.contacts > 50 && outcome.events > 20, "too little: {outcome:?}");
            compare_with_golden(&format!("{name} {D} {scalar}"), outcome.hash);
        }
    }
}

fn golden_file() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden/state_hashes.txt")
}

/// The golden numbers: lines of a scene, a dimension, a scalar and 16 hexadecimal digits.
fn golden() -> BTreeMap<String, u64> {
    let text = fs::read_to_string(golden_file()).unwrap_or_default();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let entry = |line: &str| {
        let (key, hash) = line.rsplit_once(' ').expect("a key and a hash");
        (key.to_owned(), u64::from_str_radix(hash, 16).expect("16 digits"))
    };
    lines.map(entry).collect()
}

/// Held while the file is written anew.
static FILE: Mutex<()> = Mutex::new(());

fn compare_with_golden(key: &str, hash: u64) {
    let _alone = FILE.lock().expect("no other comparison panics while it holds this");
    let mut known = golden();
    if std::env::var_os("IMPINGE_BLESS").is_none() {
        let expected = known.get(key).copied();
        drop(_alone);
        assert_eq!(expected, Some(hash), "{key}: {hash:016x} (see the comment at the top)");
        return;
    }
    known.insert(key.to_owned(), hash);
    let lines = known.iter().map(|(key, hash)| format!("{key} {hash:016x}\n"));
    let head = "# Made by the test `determinism`; see the comment at its top.\n".to_owned();
    fs::write(golden_file(), std::iter::once(head).chain(lines).collect::<String>())
        .expect("the golden file can be written");
}

macro_rules! scenes {
    ($($name:ident: $scene:expr, $steps:expr;)*) => {
        $(
            #[test]
            fn $name() {
                Run { scene: $scene, steps: $steps }.check();
            }
        )*
    };
}

scenes! {
    pile_in_plane: pile::<2>(600), 20;
    pile_in_space: pile::<3>(150), 20;
    sparse_drift_in_plane: sparse_drift::<2>(2500), 12;
    sparse_drift_in_space: sparse_drift::<3>(600), 30;
    mixed_shapes_in_plane: mixed_shapes::<2>(300), 30;
    mixed_shapes_in_space: mixed_shapes::<3>(240), 20;
    mixed_sizes_in_plane: mixed_sizes::<2>(600), 30;
    mixed_sizes_in_space: mixed_sizes::<3>(600), 30;
    spawn_and_despawn_in_plane: spawn_and_despawn::<2>(500), 40;
    spawn_and_despawn_in_space: spawn_and_despawn::<3>(500), 30;
    tower_in_plane: tower::<2>(400), 20;
    tower_in_space: tower::<3>(400), 20;
    few_moving_in_plane: few_moving::<2>(3000), 60;
    few_moving_in_space: few_moving::<3>(3000), 40;
}
